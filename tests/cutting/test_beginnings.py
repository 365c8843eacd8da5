"""The place where a cut may begin that is nearest."""

import numpy as np
import pytest

from deltacam.cutting.beginnings import Beginnings
from deltacam.geometry import curve as curves
from deltacam.model import Curve, Cut


def closed(rng: np.random.Generator, count: int) -> Curve:
    """About the origin, of lines and of arcs either way."""
    angle = 2.0 * np.pi * (np.arange(count) + rng.uniform(-0.3, 0.3, count)) / count
    points = rng.uniform(0.02, 0.05, (count, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return Curve(points=points, bulges=np.where(rng.random(count) < 0.4, 0.0, rng.uniform(-0.9, 0.9, count)))


def cut(curve: Curve) -> Cut:
    return Cut(contour=1, layer="0", handles=("1",), curve=curve)


@pytest.mark.parametrize("count", [2, 3, 8, 60])
def test_the_place_is_the_one_that_projecting_on_every_segment_finds(count: int) -> None:
    rng = np.random.default_rng(count)
    for _ in range(20):
        curve = closed(rng, count)
        point = rng.uniform(-0.08, 0.08, 2)
        place = Beginnings([cut(curve)]).nearest(0, *point.tolist())
        _, _, gap = curves.nearest(curve, point)
        assert np.hypot(*(np.array(place.begin) - point)) == pytest.approx(gap, abs=1e-12)
        assert place.end == place.begin
        assert Beginnings([cut(curve)]).begun(0, place).curve.points[0] == pytest.approx(place.begin, abs=1e-12)


def test_the_centre_of_a_circle_is_near_to_all_of_it() -> None:
    place = Beginnings([cut(curves.circle(np.array([0.1, 0.2]), 0.01))]).nearest(0, 0.1, 0.2)
    assert np.hypot(place.begin[0] - 0.1, place.begin[1] - 0.2) == pytest.approx(0.01)


def test_samples_lie_where_cuts_may_begin() -> None:
    rng = np.random.default_rng(5)
    line = Curve(points=np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.1]]), bulges=np.zeros(2), closed=False)
    cuts = [cut(closed(rng, 6)), cut(line), cut(closed(rng, 30))]
    points, owner = Beginnings(cuts).samples(50)
    assert points[owner == 1].tolist() == [[0.0, 0.0], [0.1, 0.1]]
    for index in (0, 2):
        assert (owner == index).sum() > 30
        assert max(curves.nearest(cuts[index].curve, point)[2] for point in points[owner == index]) < 1.1e-4
