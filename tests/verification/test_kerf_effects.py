"""What a kerf does to contours, against discs that are rolled into corners."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from deltacam.geometry import curve as curves
from deltacam.model import Contour, Curve, KerfEffect
from deltacam.verification.kerf_effects import inner_tips, kerf_effects
from deltacam.verification.kerf_path import rings
from tests.strategies import contour, rectangle, slot, star_curves

KERF = 2e-4
L_SHAPE = curves.polygon(np.array([[0, 0], [20, 0], [20, 10], [10, 10], [10, 20], [0, 20]]) * 1e-3)


def effects(*contours: Contour, kerf: float = KERF) -> tuple[KerfEffect, ...]:
    return kerf_effects(contours, [rings(one, kerf) for one in contours], kerf)


def test_a_square_hole_keeps_its_four_corners_and_a_square_part_loses_none() -> None:
    (hole,) = effects(contour(rectangle(0.02, 0.02), depth=1))
    assert (hole.paths, hole.meets, hole.corners) == (1, (), 4)
    assert hole.depth == pytest.approx(1e-4 * (math.sqrt(2.0) - 1.0))
    (part,) = effects(contour(rectangle(0.02, 0.02)))
    assert part == KerfEffect(1, 1, (), 0, 0.0, None)


def test_the_place_is_that_of_the_sharpest_inner_corner() -> None:
    wedge = contour(curves.polygon(np.array([[0.0, 0.0], [0.03, 4e-3], [0.03, 8e-3]])), depth=1)
    (found,) = effects(wedge)
    assert found.place == (0.0, 0.0)
    half = 0.5 * (math.atan2(8, 30) - math.atan2(4, 30))
    assert found.depth == pytest.approx(1e-4 * (1.0 / math.sin(half) - 1.0))
    assert found.corners == 3


@settings(max_examples=80)
@given(star_curves(arcs=False), st.floats(2e-5, 3e-4), st.booleans())
def test_no_tip_is_deeper_than_what_a_disc_that_is_rolled_along_the_edge_leaves(
    curve: Curve, radius: float, hole: bool
) -> None:
    ring = shapely.LinearRing(curve.points)
    assume(ring.is_simple and curves.signed_area(curve) > 1e-6)
    part = contour(curve, depth=int(hole))
    tips, depths = inner_tips(part, radius)
    sides = curves.lengths(part.curve)
    free = shapely.Polygon(part.curve.points)
    free = free if hole else shapely.box(*ring.bounds).buffer(0.01).difference(free)
    reached = free.buffer(-radius, quad_segs=256).buffer(radius * (1.0 - 1e-9), quad_segs=256)
    for tip, depth in zip(tips, depths, strict=True):
        left = reached.distance(shapely.Point(tip))
        # Long sides leave exactly this much; where a side is short, the disc may be held further out.
        assert left >= depth * (1.0 - 1e-3) - 1e-8
    corner = np.isclose(part.curve.points[:, None], tips[None, :]).all(axis=2)
    for at, which in zip(*np.nonzero(corner), strict=True):
        turn = abs(curves.corner_angles(part.curve)[at])
        reach = radius * math.tan(0.5 * turn)
        others = [shapely.LineString(part.curve.points[[k, (k + 1) % len(sides)]]) for k in range(len(sides))]
        others = [line for k, line in enumerate(others) if k not in (at, (at - 1) % len(sides))]
        near = min(line.distance(shapely.Point(tips[which])) for line in others)
        if near > 3.0 * (reach + radius):
            assert reached.distance(shapely.Point(tips[which])) == pytest.approx(depths[which], rel=2e-3, abs=1e-8)


def test_a_fillet_that_is_smaller_than_the_beam_leaves_less_than_a_corner() -> None:
    for fillet in (2e-5, 8e-5, 1e-4, 5e-4):
        bend = math.tan(math.pi / 8.0)
        points = np.array([[0, 0], [0.02 - fillet, 0], [0.02, fillet], [0.02, 0.02], [0, 0.02]])
        part = contour(Curve(points=points, bulges=np.array([0, bend, 0, 0, 0.0])), depth=1)
        tips, depths = inner_tips(part, 1e-4)
        expected = max(1e-4 - fillet, 0.0) * (math.sqrt(2.0) - 1.0)
        assert len(tips) == (4 if expected > 1e-6 else 3)
        if expected > 1e-6:
            assert depths[-1] == pytest.approx(expected)
            assert tips[-1] == pytest.approx([0.02 - fillet * (1 - math.sqrt(0.5)), fillet * (1 - math.sqrt(0.5))])


def test_swallowed_and_split_contours_are_told_by_their_paths() -> None:
    tiny = contour(curves.circle(np.array([0.05, 0.05]), 5e-5), number=2, depth=1)
    neck = [(0, 0), (10, 0), (10, 4.95), (20, 4.95), (20, 0), (30, 0)]
    neck += [(30, 10), (20, 10), (20, 5.05), (10, 5.05), (10, 10), (0, 10)]
    narrow = contour(curves.polygon(np.array(neck) / 1e3), number=3, depth=1)
    assert [one.paths for one in effects(contour(slot(0.02, 0.01)), tiny, narrow)] == [1, 0, 2]


@pytest.mark.parametrize(("gap", "meets"), [(1.5 * KERF, (1,)), (2.0 * KERF - 1e-5, (1,)), (2.1 * KERF, ())])
def test_slots_meet_where_nothing_is_left_between_them(gap: float, meets: tuple[int, ...]) -> None:
    left, right = rectangle(0.01, 0.01), rectangle(0.01, 0.01, at=(0.01 + gap, 0.0))
    first, second = effects(contour(left, number=1), contour(right, number=2))
    assert second.meets == meets
    assert bool(first.meets) == bool(meets)


def test_a_kerf_of_nothing_does_nothing() -> None:
    touching = contour(rectangle(0.01, 0.01, at=(0.01, 0.0)), number=2)
    for one in effects(contour(L_SHAPE), touching, kerf=0.0):
        assert (one.paths, one.meets, one.corners, one.depth) == (1, (), 0, 0.0)
