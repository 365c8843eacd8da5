"""Where ends of curves meet, and how far apart they may be."""

import numpy as np
import pytest

from deltacam.drawing.joining import nodes
from deltacam.drawing.joining.join import Joined, join
from deltacam.errors import DrawingError
from deltacam.geometry import curve as curves
from deltacam.geometry.pack import Pack
from deltacam.model import Curve

MM = 1e-3


def line(*points: tuple[float, float]) -> Curve:
    """An open polyline through points in mm."""
    return Curve(points=MM * np.array(points), bulges=np.zeros(len(points) - 1), closed=False)


def joined(*shapes: Curve, joining: float) -> Joined:
    return join(Pack.of(shapes), joining=joining, name=lambda i: f"LINE #{i:X}")


def outline(gap: float) -> tuple[Curve, Curve]:
    """A square of 10 mm in two pieces, with a gap of so many mm at the origin."""
    return line((0, 0), (10, 0), (10, 10), (0, 10)), line((0, 10), (0, gap))


@pytest.mark.parametrize("joining", [1e-7, 1e-6, 1e-5, 1e-4, 1e-3])
def test_gaps_up_to_the_joining_tolerance_are_closed_and_wider_ones_are_not(joining: float) -> None:
    assert len(joined(*outline(0.99e3 * joining), joining=joining).loops) == 1
    opened = joined(*outline(1.01e3 * joining), joining=joining)
    assert opened.loops == []
    (chain,) = opened.chains
    assert chain.gap == pytest.approx(1.01 * joining)
    assert [finding.kind for finding in opened.findings] == ["gap"]


def test_a_small_gap_moves_an_end_and_a_wide_one_is_bridged_by_a_straight_piece() -> None:
    (near,) = joined(*outline(0.009), joining=1e-3).loops
    assert len(near.curve.points) == 4
    assert near.error == pytest.approx(9e-6)
    (wide,) = joined(*outline(0.5), joining=1e-3).loops
    assert wide.error == 0.0
    assert {tuple(point) for point in wide.curve.points} == {
        (0.0, 0.0), (0.01, 0.0), (0.01, 0.01), (0.0, 0.01), (0.0, 0.0005)
    }  # fmt: skip
    assert curves.signed_area(wide.curve) == pytest.approx(1e-4)


def test_an_arc_stays_exact_where_a_gap_is_bridged() -> None:
    arc = Curve(MM * np.array([[0.0, 0.0], [10.0, 0.0]]), np.array([1.0]), closed=False)
    (loop,) = joined(arc, line((10.3, 0), (10, 5), (0, 5), (0, 0.4)), joining=5e-4).loops
    assert len(loop.curve.points) == 6
    at = int(np.flatnonzero(loop.curve.bulges)[0])
    assert loop.curve.bulges[at] == 1.0
    assert loop.curve.starts[at].tolist() == [0.0, 0.0]
    assert loop.curve.ends[at].tolist() == [0.01, 0.0]


def test_of_two_ends_that_are_about_as_near_none_is_taken() -> None:
    square, last = outline(0.3)
    result = joined(square, last, line((0.35, -0.1), (5, -5)), joining=1e-3)
    assert result.loops == []
    assert len(result.chains) == 2
    far = joined(square, last, line((0.9, -0.9), (5, -5)), joining=1e-3)
    assert [loop.members for loop in far.loops] == [(0, 1)]


def test_a_short_line_does_not_close_upon_itself_and_keeps_its_place_in_a_chain() -> None:
    alone = joined(line((0, 0), (0.5, 0)), joining=1e-3)
    assert (alone.loops, len(alone.chains)) == ([], 1)
    assert alone.chains[0].reason == "an open line, from (0.000, 0.000) to (0.500, 0.000) mm"
    square = line((0.5, 0), (10, 0), (10, 10), (0, 10), (0, 0))
    (loop,) = joined(square, line((0, 0), (0.5, 0)), joining=1e-3).loops
    assert len(loop.curve.points) == 5


def test_ends_that_coincide_leave_other_ends_alone() -> None:
    # The ends at the origin meet exactly; the third, 0.4 mm away, is no business of theirs.
    result = joined(*outline(0.0), line((-0.4, 0), (-5, 0)), joining=1e-3)
    assert [loop.members for loop in result.loops] == [(0, 1)]
    assert len(result.chains) == 1


def test_an_end_near_to_ends_that_have_met_is_joined_to_none() -> None:
    one, other = line((0, 0), (-10, 0), (-10, -10)), line((0, 0), (0, 10), (-20, 10))
    result = joined(one, other, line((0.4, 0), (30, 0)), joining=1e-3)
    assert [set(chain.members) for chain in result.chains] == [{0, 1}, {2}]


def test_ends_of_two_chains_that_nearly_meet_are_a_gap_with_its_place() -> None:
    def gaps(distance: float) -> list[tuple[float, float] | None]:
        one, other = line((0, 0), (10, 0), (20, 5)), line((20, 5 + distance), (20, 20), (0, 20))
        result = joined(one, other, joining=1e-5)
        assert all("gap of" in finding.what and not finding.blocks for finding in result.findings)
        return [finding.place for finding in result.findings if finding.kind == "gap"]

    assert gaps(0.3) == [pytest.approx((0.02, 0.005))]
    assert gaps(0.6) == []


def test_no_more_gaps_are_listed_than_a_person_reads() -> None:
    rows = [line((0, i), (5, i)) for i in range(300)] + [line((5.1, i), (9, i)) for i in range(300)]
    gaps = [finding for finding in joined(*rows, joining=1e-5).findings if finding.kind == "gap"]
    assert len(gaps) == 201
    assert gaps[-1].what == "and 100 more like this"


def test_thousands_of_ends_around_one_place_are_refused_at_once() -> None:
    ends = np.zeros((4000, 2, 2))
    ends[:, 0, 0] = 1e-8 * np.arange(4000)
    ends[:, 1] = np.random.default_rng(1).uniform(1.0, 2.0, (4000, 2))
    with pytest.raises(DrawingError, match="crowd in one place"):
        nodes.find(ends, np.ones(4000))


def test_thousands_of_ends_exactly_in_one_place_are_one_node() -> None:
    ends = np.zeros((20_000, 2, 2))
    ends[:, 1] = np.random.default_rng(1).uniform(1.0, 2.0, (20_000, 2))
    found = nodes.find(ends, np.ones(20_000))
    assert len(np.unique(found.labels[:, 0])) == 1
    assert len(np.unique(found.labels[:, 1])) == 20_000
