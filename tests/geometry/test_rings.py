"""Measures of many curves at once, against those of single curves."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.geometry import curve as curves
from deltacam.geometry import rings
from deltacam.geometry.pack import Pack
from deltacam.model import Curve
from tests.strategies import star_curves

SHAPES = st.lists(star_curves(), min_size=1, max_size=6)


@settings(deadline=None, max_examples=40)
@given(SHAPES)
def test_areas_and_segments_are_those_of_each_curve(shapes: list[Curve]) -> None:
    pack = Pack.of([*shapes, curves.circle(np.ones(2), 3e-3)])
    assert rings.signed_areas(pack) == pytest.approx([curves.signed_area(curve) for curve in pack], rel=1e-12)
    assert rings.segment_lengths(pack) == pytest.approx(np.concatenate([curves.lengths(curve) for curve in pack]))


@settings(deadline=None, max_examples=40)
@given(SHAPES, st.lists(st.booleans(), min_size=6, max_size=6))
def test_some_curves_are_run_the_other_way(shapes: list[Curve], turn: list[bool]) -> None:
    which = np.array(turn[: len(shapes)])
    for curve, turned, before in zip(rings.reverse(Pack.of(shapes), which), which, shapes, strict=True):
        expected = curves.reverse(before) if turned else before
        assert curve.points.tobytes() == expected.points.tobytes()
        assert curve.bulges.tobytes() == expected.bulges.tobytes()


@settings(deadline=None, max_examples=40)
@given(SHAPES, st.floats(1e-7, 1e-3))
def test_points_lie_on_the_curves_and_their_chords_near_them(shapes: list[Curve], sagitta: float) -> None:
    points, curve_of = rings.flatten(Pack.of(shapes), sagitta)
    for i, shape in enumerate(shapes):
        own = points[curve_of == i]
        assert {tuple(point) for point in shape.points} <= {tuple(point) for point in own}
        assert max(curves.nearest(shape, point)[2] for point in own) <= 1e-12
        middles = 0.5 * (own + np.roll(own, -1, axis=0))
        assert max(curves.nearest(shape, point)[2] for point in middles) <= sagitta * (1.0 + 1e-6)


def test_batches_of_curves_are_numbered_on() -> None:
    many = Pack.of([curves.circle(np.array([i, 0.0]), 0.4) for i in range(5000)])
    points, curve_of = rings.flatten(many, 1.0)
    assert np.array_equal(np.round(points[:, 0]), curve_of)
