"""The places where cuts may begin."""

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


def opened(rng: np.random.Generator, count: int) -> Curve:
    return Curve(points=closed(rng, count).points, bulges=rng.uniform(-0.9, 0.9, count - 1), closed=False)


def cut(curve: Curve) -> Cut:
    return Cut(contour=1, layer="0", handles=("1",), curve=curve)


@pytest.mark.parametrize("count", [2, 3, 8, 60])
def test_a_place_lies_so_far_along_its_curve(count: int) -> None:
    rng = np.random.default_rng(count)
    all_of_them = [closed(rng, count), opened(rng, count), closed(rng, 5)]
    beginnings = Beginnings([cut(curve) for curve in all_of_them])
    assert beginnings.lengths == pytest.approx([curves.length(curve) for curve in all_of_them])
    for index, curve in enumerate(all_of_them):
        ends = np.cumsum(curves.lengths(curve))
        along = rng.uniform(0.0, ends[-1], 20)
        segment = np.searchsorted(ends, along)
        points, _ = curves.evaluate(curve, segment, along - (ends[segment] - curves.lengths(curve)[segment]))
        assert beginnings.at(np.full(20, index), along) == pytest.approx(points, abs=1e-12)


def test_a_closed_cut_is_begun_at_its_place_and_an_open_one_at_either_end() -> None:
    rng = np.random.default_rng(1)
    cuts = [cut(closed(rng, 6)), cut(opened(rng, 6))]
    beginnings = Beginnings(cuts)
    for along in rng.uniform(-0.1, 1.0, 20).tolist():
        begun = beginnings.begun(0, along).curve
        assert begun.points[:1] == pytest.approx(beginnings.at(np.array([0]), np.array([along])), abs=1e-9)
        assert curves.length(begun) == pytest.approx(beginnings.lengths[0])
    assert beginnings.begun(1, 0.0) is cuts[1]
    assert (
        beginnings.begun(1, float(beginnings.lengths[1])).curve.points[0].tolist() == cuts[1].curve.points[-1].tolist()
    )


def test_the_nearest_corner_is_a_vertex_and_none_is_nearer() -> None:
    rng = np.random.default_rng(5)
    curve = closed(rng, 9)
    vertices = np.concatenate([[0.0], np.cumsum(curves.lengths(curve))])
    along = rng.uniform(0.0, vertices[-1], 200)
    found = Beginnings([cut(curve)]).corner(np.zeros(200, dtype=np.int64), along)
    assert np.abs(found - along) == pytest.approx(np.abs(vertices - along[:, None]).min(axis=1), abs=1e-12)
    assert np.abs(vertices - found[:, None]).min(axis=1) == pytest.approx(0.0, abs=1e-12)
