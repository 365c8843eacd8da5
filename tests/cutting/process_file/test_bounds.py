"""The bounds of the numbers of a process."""

import math
import re
from pathlib import Path

import pytest

from deltacam.cutting.process_file.bounds import BOUNDS, Bound
from deltacam.cutting.process_file.reading import KEYS
from deltacam.cutting.process_file.sections import SECTIONS

PAGE = (Path(__file__).parents[3] / "docs" / "reference" / "process-file.md").read_text()


def part(section: str) -> str:
    """The part of the page about a section; its top where there is none."""
    if not section:
        return PAGE.partition("\n## ")[0]
    found = re.search(rf"^## \[+{'lead_in' if section == 'lead' else section}\]+\n(.*?)(?=^## |\Z)", PAGE, re.S | re.M)
    assert found is not None, section
    return found[1]


@pytest.mark.parametrize("name", BOUNDS)
def test_the_page_says_what_a_number_may_be(name: str) -> None:
    section, _, key = name.rpartition(".")
    bound = BOUNDS[name]
    allowed = f"{bound.minimum:.10g} to {bound.maximum:.10g}"
    assert re.search(rf"^\| `{key}` \| {re.escape(allowed)}[ ,]", part(section), re.M), allowed


@pytest.mark.parametrize("section", sorted(set(SECTIONS) - {"gases", "lead_out"}))
def test_the_page_has_a_row_for_every_key_of_a_section(section: str) -> None:
    rows = re.findall(r"^\| `(\w+)` \|", part(section), re.M)
    assert rows == list(SECTIONS[section])


def test_the_page_has_a_row_for_every_key_at_the_top() -> None:
    assert sorted(re.findall(r"^\| `(\w+)` \|", part(""), re.M)) == sorted(KEYS)


@pytest.mark.parametrize(
    ("name", "stated", "si"),
    [
        ("kerf_mm", 0.15, 0.15e-3),
        ("feed_m_min", 9.0, 0.15),
        ("tolerance_um", 20.0, 20e-6),
        ("lead.angle_deg", 90.0, 0.5 * math.pi),
        ("gases.pressure_bar", 12.0, 1.2e6),
        ("power", 0.7, 0.7),
    ],
)
def test_units_are_what_they_are_called(name: str, stated: float, si: float) -> None:
    assert BOUNDS[name].to_si(stated) == pytest.approx(si, rel=1e-15)
    assert BOUNDS[name].from_si(si) == pytest.approx(stated, rel=1e-15)


@pytest.mark.parametrize("bound", BOUNDS.values(), ids=BOUNDS)
def test_only_what_is_in_the_range_is_allowed(bound: Bound) -> None:
    low, high = bound.to_si(bound.minimum), bound.to_si(bound.maximum)
    assert bound.allows(low)
    assert bound.allows(high)
    assert not bound.allows(low - 1e-9 - abs(low) * 1e-9)
    assert not bound.allows(high * (1.0 + 1e-9))
    assert not bound.allows(math.nan)
