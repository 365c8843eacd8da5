"""Real drawings: what a person sees in them, what blocks a plan, and one file that cannot be read.

The expectations are those of a person who looked at pictures of the files, made without deltacam. They are kept beside
the files, in ``expected.toml``, which also says why where deltacam counts in another way.
"""

import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from deltacam.drawing.reader import read_drawing
from deltacam.errors import DrawingError
from deltacam.geometry import curve as curves
from deltacam.inspection.listing import to_dict
from deltacam.model import Drawing, Outcome

FILES = Path(__file__).parents[1] / "data" / "dxf"
EXPECTED: dict[str, dict[str, Any]] = tomllib.loads((FILES / "expected.toml").read_text())
UNREADABLE = {"diamond-binary-damaged"}
SHOWN = sorted(set(EXPECTED) - UNREADABLE)
REFUSED = sorted(name for name, row in EXPECTED.items() if "refused" in row)
PLANNED = sorted(set(EXPECTED) - set(REFUSED))

# file, what one of the findings says
NOTED = [
    ("motor-mount-open-lines", "7 open chains are not cut"),
    ("switch-mount-duplicates", "gap of 0.869 mm"),
    ("switch-mount-duplicates", "gap of 1.09 mm"),
    ("switch-mount-duplicates", "2 MTEXT are not cut: text is never cut"),
    ("switch-mount-duplicates", "52 contours lie in an outline that is open"),
    ("sliding-base-mtext-inch", "2 MTEXT are not cut: text is never cut"),
    ("redox-top-dims", "2 DIMENSION are not cut: a dimension is never cut"),
    ("insert-r14", "a closed line that encloses nothing"),
    ("drawing-r12-dims", "13 DIMENSION are not cut"),
    ("drawing-r12-dims", "looks like a drawing for people"),
    ("badges-illustrator", "3 HATCH are not cut: a fill, not a line"),
    ("diamond-3d-binary", "z runs from -78 to 0 mm"),
    ("motor-lock-wrong-units", "the file says its unit is in, but it is read in mm"),
]

# files that leave nothing to say: every entity is cut
CLEAN = ("drone-top-onshape", "sweep-plate-kicad", "key-plate-bulge", "wrench-inch", "plate-solidworks-inch")


def read(name: str, *, strict: bool = True) -> Drawing:
    """The drawing, in the unit that a person states where the file does not state it or lies."""
    row = EXPECTED[name]
    unit = None if row["unit_from"] == "the file" else row["unit"]
    return read_drawing(FILES / f"{name}.dxf", unit=unit, strict=strict)


def expected_loops(row: dict[str, Any]) -> list[int]:
    """Outer and inner contours and open chains; empty where a person sees none in the plane."""
    if "read" in row:
        assert row["why"]
        return list(row["read"])
    return [int(number) for number in re.findall(r"\d+", row["loops"])]


def test_every_file_has_an_expectation() -> None:
    assert {path.stem for path in FILES.glob("*.dxf")} == set(EXPECTED)


@pytest.mark.parametrize("name", SHOWN)
def test_a_real_drawing_has_the_loops_that_a_person_sees(name: str) -> None:
    contours = to_dict(read(name, strict=False))["contours"]
    expected = expected_loops(EXPECTED[name])
    assert len(expected) == (0 if name == "diamond-3d-binary" else 3)
    assert [contours[kind] for kind in ("outer", "inner", "open")[: len(expected)]] == expected


@pytest.mark.parametrize("name", SHOWN)
def test_a_real_drawing_has_the_size_that_a_person_sees(name: str) -> None:
    found, row = to_dict(read(name, strict=False)), EXPECTED[name]
    if "size" in row:
        assert found["size_mm"] == pytest.approx(row["size"], abs=0.06)
    sizes = np.array([contour["size_mm"] for contour in found["contours"]["list"]])
    for part in row.get("parts", []):
        assert np.abs(sizes - part).max(axis=1).min() < 0.1  # some are rounded to a hundredth of an inch


@pytest.mark.parametrize("name", SHOWN)
def test_the_warnings_are_those_that_a_person_expects(name: str) -> None:
    findings = read(name, strict=False).findings
    assert {finding.kind for finding in findings} == set(EXPECTED[name]["warnings"])
    assert any(finding.blocks for finding in findings) == (name in REFUSED)


@pytest.mark.parametrize("name", SHOWN)
def test_the_unit_is_the_one_of_the_file_or_missing(name: str) -> None:
    drawing, row = read_drawing(FILES / f"{name}.dxf", strict=False), EXPECTED[name]
    stated = {"the file": row["unit"], "a person": "", "a person, against the file": "in"}[row["unit_from"]]
    assert drawing.unit == stated
    assert any(finding.kind == "units" and finding.blocks for finding in drawing.findings) == (not stated)


@pytest.mark.parametrize("name", PLANNED)
def test_what_is_planned_is_numbered_closed_and_accounted_for(name: str) -> None:
    drawing = read(name)
    assert [contour.number for contour in drawing.contours] == list(range(1, len(drawing.contours) + 1))
    for contour in drawing.contours:
        assert contour.curve.closed
        assert curves.signed_area(contour.curve) > 0.0
        assert curves.lengths(contour.curve).min() >= 0.99e-6
    assert {entry.contour for entry in drawing.ledger if entry.outcome is Outcome.CUT} == {
        contour.number for contour in drawing.contours
    }
    assert all(entry.reason for entry in drawing.ledger if entry.outcome is not Outcome.CUT)


@pytest.mark.parametrize("name", REFUSED)
def test_a_drawing_that_cannot_be_cut_is_refused_in_one_sentence(name: str) -> None:
    with pytest.raises(DrawingError, match=EXPECTED[name]["refused"]) as caught:
        read(name)
    assert "\n" not in caught.value.what
    assert caught.value.where
    assert caught.value.hint


@pytest.mark.parametrize("name", sorted(UNREADABLE))
def test_what_cannot_be_read_cannot_be_looked_at_either(name: str) -> None:
    with pytest.raises(DrawingError, match=EXPECTED[name]["refused"]):
        read(name, strict=False)


@pytest.mark.parametrize(("name", "what"), NOTED)
def test_what_a_person_should_know_is_a_finding(name: str, what: str) -> None:
    assert any(what in finding.what for finding in read(name, strict=False).findings)


@pytest.mark.parametrize("name", CLEAN)
def test_a_clean_drawing_is_cut_whole_and_without_a_remark(name: str) -> None:
    drawing = read(name)
    assert {entry.outcome for entry in drawing.ledger} == {Outcome.CUT}
    assert drawing.findings == ()


def test_two_parts_in_inch_have_their_sizes() -> None:
    outer = [contour for contour in read("plate-solidworks-inch").contours if not contour.is_hole]
    sizes = sorted((box[2] - box[0], box[3] - box[1]) for box in (curves.bounds(part.curve) for part in outer))
    assert np.array(sizes) == pytest.approx(np.array([(0.0508, 0.06985), (0.14605, 0.1143)]), abs=1e-9)


def test_two_inserted_plates_have_their_size_and_their_blocks() -> None:
    drawing = read("insert-r14")
    for contour in drawing.contours:
        low_x, low_y, high_x, high_y = curves.bounds(contour.curve)
        assert (high_x - low_x, high_y - low_y) == pytest.approx((0.175, 0.1545), abs=1e-6)
    assert {entry.block for entry in drawing.ledger if entry.outcome is Outcome.CUT} == {"rect", "rect-0"}


def test_arcs_of_the_drawing_stay_arcs() -> None:
    drone = read("drone-top-onshape")
    arcs = sum(int((contour.curve.bulges != 0.0).sum()) for contour in drone.contours)
    assert arcs == 48 + 2 * 19
    assert drone.conversion_error < 1e-7


def test_a_file_without_a_header_states_no_unit() -> None:
    with pytest.raises(DrawingError, match=r"states no unit: it is 206 x 381\.5 mm if its unit is mm") as caught:
        read_drawing(FILES / "box-end-openscad.dxf")
    assert caught.value.hint == "state the unit: --units mm"


@pytest.mark.parametrize("name", ["drone-top-onshape", "tank-lid-inkscape", "nest-forms"])
def test_the_same_file_reads_the_same_twice(name: str) -> None:
    one, other = read(name), read(name)
    for first, second in zip(one.contours, other.contours, strict=True):
        assert first.curve.points.tobytes() == second.curve.points.tobytes()
        assert first.curve.bulges.tobytes() == second.curve.bulges.tobytes()
    assert (one.ledger, one.findings) == (other.ledger, other.findings)
