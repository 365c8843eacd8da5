"""The JSON object is what its page says, key by key."""

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from deltacam.inspection.listing import to_dict
from deltacam.model import Drawing

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "inspection.md"


def documented(section: str) -> set[str]:
    """The keys in the table of a section."""
    text = PAGE.read_text()
    part = text.partition(f"## {section}\n")[2] if section else text
    table = part.partition("\n## ")[0]
    return {
        key for row in re.findall(r"^\| (`.*?) \|", table, flags=re.MULTILINE) for key in re.findall(r"`(\w+)`", row)
    }


def test_every_key_is_documented_and_given(drawing: Drawing) -> None:
    found = to_dict(drawing)
    assert set(found) == documented("")
    assert set(found["contours"]) == {"closed", "outer", "inner", "open", "list"}
    assert set(found["totals"]) == {"entities", "cut", "engraved", "merged", "ignored", "lost"}
    for section, rows in (
        ("contours", found["contours"]["list"]),
        ("layers", found["layers"]),
        ("warnings", found["warnings"]),
        ("ledger", found["ledger"]),
    ):
        assert rows
        assert all(set(row) == documented(section) for row in rows)


def test_lengths_are_in_mm(drawing: Drawing) -> None:
    found = to_dict(drawing)
    assert found["extents_mm"] == [-5.0, -5.0, 140.0, 85.0]
    assert found["size_mm"] == [145.0, 90.0]
    assert found["conversion_error_um"] == 0.13
    hole = found["contours"]["list"][1]
    assert hole == {
        "number": 2,
        "kind": "inner",
        "operation": "cut",
        "layer": "CUT",
        "handles": ["2"],
        "parent": 1,
        "depth": 1,
        "size_mm": [20.0, 20.0],
        "bounds_mm": [10.0, 10.0, 30.0, 30.0],
        "length_mm": pytest.approx(62.831853),
        "segments": 2,
        "arcs": 2,
    }


def test_all_joined_contours_are_counted_machined_or_not(drawing: Drawing) -> None:
    contours = to_dict(drawing)["contours"]
    assert {key: contours[key] for key in ("closed", "outer", "inner", "open")} == {
        "closed": 6,
        "outer": 3,
        "inner": 3,
        "open": 3,
    }
    assert [contour["number"] for contour in contours["list"]] == list(range(1, 10))
    assert {contour["operation"] for contour in contours["list"]} == {"cut", "engrave", "ignore"}


def test_a_warning_says_what_where_and_whether_it_blocks(drawing: Drawing) -> None:
    warnings = to_dict(drawing)["warnings"]
    assert [warning["kind"] for warning in warnings] == ["not_cut", "gap", "crossing", "branch", "sliver"]
    assert warnings[0]["where_mm"] is None
    assert warnings[2] == {
        "kind": "crossing",
        "message": "it crosses contour 2",
        "where_mm": [20.0, 30.0],
        "where": "contour 3 (layer CUT, #3)",
        "hint": "separate the outlines",
        "blocks": True,
    }


def test_a_missing_unit_is_null(empty: Drawing) -> None:
    found = to_dict(empty)
    assert (found["unit"], found["unit_source"]) == (None, "missing")
    assert (found["extents_mm"], found["size_mm"]) == (None, None)
    assert found["contours"] == {"closed": 0, "outer": 0, "inner": 0, "open": 0, "list": []}


def test_it_is_json_whatever_the_names_hold(drawing: Drawing) -> None:
    layers = tuple(replace(layer, name="\ud800\x00\u202e") for layer in drawing.layers)
    strange = replace(drawing, file="\udcff.dxf", layers=layers)
    again = json.loads(json.dumps(to_dict(strange), allow_nan=False).encode("ascii"))
    assert again == to_dict(strange)
