"""Shapes that the tests draw at random."""

import numpy as np
from hypothesis import strategies as st

from deltacam.geometry import curve as curves
from deltacam.model import Contour, Curve


def contour(curve: Curve, *, number: int = 1, depth: int = 0, parent: int | None = None) -> Contour:
    """A contour around a curve, as the reader would make it."""
    curve = curve if curves.signed_area(curve) > 0.0 else curves.reverse(curve)
    return Contour(number=number, curve=curve, layer="CUT", handles=(f"{number:X}",), depth=depth, parent=parent)


@st.composite
def star_curves(draw: st.DrawFn, *, low: float = 4e-3, high: float = 25e-3, arcs: bool = True) -> Curve:
    """Closed curves around the origin that do not cross themselves, of lines and of arcs that bulge by up to 0.15."""
    count = draw(st.integers(3, 14))
    radius = np.array(draw(st.lists(st.floats(low, high), min_size=count, max_size=count)))
    jitter = np.array(draw(st.lists(st.floats(-0.25, 0.25), min_size=count, max_size=count)))
    angle = 2.0 * np.pi * (np.arange(count) + jitter) / count
    points = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    bulge = st.one_of(st.just(0.0), st.floats(-0.08, 0.15)) if arcs else st.just(0.0)
    bulges = np.array(draw(st.lists(bulge, min_size=count, max_size=count)))
    return Curve(points=points, bulges=bulges)


def slot(length: float, width: float) -> Curve:
    """A slot about the origin: two lines and two half circles, ``length`` m between their centres."""
    x, y = length / 2.0, width / 2.0
    return Curve(points=np.array([[-x, -y], [x, -y], [x, y], [-x, y]]), bulges=np.array([0.0, 1.0, 0.0, 1.0]))


def rectangle(width: float, height: float, *, at: tuple[float, float] = (0.0, 0.0)) -> Curve:
    """A rectangle with its lower left corner at ``at``."""
    corners = np.array([[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]])
    return curves.polygon(corners + np.asarray(at))
