"""Random drawings, written to DXF and read back: every curve runs where the exact geometry runs, and nowhere else.

The truth is ezdxf's: its evaluation of splines, its object coordinates and its matrices of INSERTs. Lines, circles,
arcs, bulges and ellipses are evaluated in closed form. Distances are measured with nothing of ours.
"""

import io
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import ezdxf
import numpy as np
from ezdxf.math import OCS, BSpline, Vec3
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from deltacam.drawing.entities import walk
from deltacam.model import Array, Curve

MILLIMETRE = 1e-3
MICROMETRE = 1e-6
SAMPLES = 3000

NUMBERS = st.floats(-40.0, 40.0).map(lambda value: round(value, 5))
PLACES = st.tuples(NUMBERS, NUMBERS)
ANGLES = st.floats(0.0, 360.0).map(lambda value: round(value, 6))
FACTORS = st.builds(lambda size, sign: sign * size, st.floats(0.4, 1.8), st.sampled_from([1.0, -1.0]))
EXTRUSIONS = st.sampled_from([(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (0.0, 0.0, -3.0)])

Truth = Callable[[Array], Array]
"""From shares of the way along an entity, (K,) in [0, 1], to places in the coordinates of its block, (K, 3)."""


@dataclass(frozen=True)
class Drawn:
    """How an entity is added to a layout or block, and what it then draws."""

    add: Callable[[Any], Any]
    truth: Truth


def in_space(extrusion: tuple[float, float, float], points: Array) -> Array:
    """Object coordinates (K, 2) as those of the block, (K, 3)."""
    ocs = OCS(Vec3(extrusion))
    return points @ np.array([ocs.ux.xyz, ocs.uy.xyz])


@st.composite
def lines(draw: st.DrawFn) -> Drawn:
    ends = np.array(draw(st.lists(PLACES, min_size=2, max_size=2, unique=True)))
    return Drawn(
        lambda block: block.add_line(*ends),
        lambda share: np.column_stack([ends[0] + share[:, None] * (ends[1] - ends[0]), np.zeros(len(share))]),
    )


@st.composite
def arcs(draw: st.DrawFn) -> Drawn:
    centre, radius, start = draw(PLACES), draw(st.floats(0.5, 30.0)), draw(ANGLES)
    span, extrusion = draw(st.floats(1.0, 360.0)), draw(EXTRUSIONS)
    attributes = {"extrusion": extrusion}

    def truth(share: Array) -> Array:
        angle = np.radians(start + span * share)
        return in_space(extrusion, np.array(centre) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))

    if span == 360.0:
        return Drawn(lambda block: block.add_circle(centre, radius, attributes), truth)
    end = (start + span) % 360.0
    return Drawn(lambda block: block.add_arc(centre, radius, start, end, dxfattribs=attributes), truth)


def bulged(vertices: Array, closed: bool, share: Array) -> Array:
    """Places along a polyline (N, 3) of x, y, bulge, at shares (K,) of its segments; (K, 2)."""
    many = len(vertices) - (not closed)
    segment = np.minimum((share * many).astype(int), many - 1)
    part = share * many - segment
    place, bulge = vertices[:, 0] + 1j * vertices[:, 1], vertices[segment, 2]
    start, end = place[segment], np.roll(place, -1)[segment]
    bent = np.where(bulge == 0.0, 1.0, bulge)
    # The centre sees the chord under the angle 4 atan(bulge).
    centre = 0.5 * (start + end) + 0.5j * (end - start) * (1.0 - bent**2) / (2.0 * bent)
    arc = centre + (start - centre) * np.exp(4j * np.arctan(bent) * part)
    found = np.where(bulge == 0.0, start + part * (end - start), arc)
    return np.stack([found.real, found.imag], axis=1)


@st.composite
def polylines(draw: st.DrawFn) -> Drawn:
    bulge = st.one_of(st.just(0.0), st.floats(0.05, 3.0), st.floats(-3.0, -0.05))
    places = draw(st.lists(PLACES, min_size=2, max_size=5, unique=True))
    vertices = np.array([(x, y, draw(bulge)) for x, y in places])
    closed, extrusion, light = draw(st.booleans()), draw(EXTRUSIONS), draw(st.booleans())
    attributes = {"extrusion": extrusion}

    def add(block: Any) -> Any:
        make = block.add_lwpolyline if light else block.add_polyline2d
        return make(vertices, format="xyb", close=closed, dxfattribs=attributes)

    return Drawn(add, lambda share: in_space(extrusion, bulged(vertices, closed, share)))


@st.composite
def ellipses(draw: st.DrawFn) -> Drawn:
    centre, ratio, extrusion = np.array(draw(PLACES)), draw(st.floats(0.05, 1.0)), draw(EXTRUSIONS)
    angle, size = math.radians(draw(ANGLES)), draw(st.floats(1.0, 30.0))
    major = size * np.array([math.cos(angle), math.sin(angle)])
    start, span = draw(st.floats(0.0, 2.0 * math.pi)), draw(st.one_of(st.just(2.0 * math.pi), st.floats(0.1, 6.2)))
    minor = ratio * math.copysign(1.0, extrusion[2]) * np.array([-major[1], major[0]])

    def truth(share: Array) -> Array:
        t = (start + span * share)[:, None]
        return np.column_stack([centre + np.cos(t) * major + np.sin(t) * minor, np.zeros(len(share))])

    first, last = (0.0, 2.0 * math.pi) if span == 2.0 * math.pi else (start, start + span)
    return Drawn(lambda block: block.add_ellipse(centre, major, ratio, first, last, {"extrusion": extrusion}), truth)


@st.composite
def splines(draw: st.DrawFn) -> Drawn:
    degree = draw(st.integers(1, 5))
    points = draw(st.lists(PLACES, min_size=degree + 1, max_size=degree + 5, unique=True))
    weights = draw(st.one_of(st.none(), st.lists(st.floats(0.3, 3.0), min_size=len(points), max_size=len(points))))
    steps = draw(st.lists(st.sampled_from([0.5, 1.0, 2.0]), min_size=len(points) - degree, max_size=len(points)))
    inner = np.concatenate([[0.0], np.cumsum(steps)])[: len(points) - degree + 1]
    knots = [*[inner[0]] * degree, *inner, *[inner[-1]] * degree]
    tool = BSpline(points, degree + 1, knots, weights)

    def truth(share: Array) -> Array:
        return np.array([place.xyz for place in tool.points(inner[-1] * share)])

    return Drawn(lambda block: block.add_spline().apply_construction_tool(tool), truth)


@st.composite
def inserts(draw: st.DrawFn) -> dict[str, Any]:
    """The attributes of an INSERT: mirrored, squeezed, turned, seen from below, in an array."""
    return {
        "insert": draw(PLACES),
        "xscale": draw(FACTORS),
        "yscale": draw(FACTORS),
        "zscale": draw(FACTORS),
        "rotation": draw(ANGLES),
        "extrusion": draw(EXTRUSIONS),
        **draw(
            st.sampled_from([{}, {}, {"row_count": 2, "row_spacing": 9.0, "column_count": 2, "column_spacing": -7}])
        ),
    }


@settings(deadline=None, max_examples=40, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much])
@given(
    st.lists(st.one_of(lines(), arcs(), polylines(), ellipses(), splines()), min_size=1, max_size=3),
    st.lists(inserts(), max_size=3),
    PLACES,
)
def test_every_curve_runs_where_the_exact_geometry_runs(shapes: list[Drawn], nest: list[Any], base: Any) -> None:
    document = ezdxf.new()
    content = document.blocks.new("B0", base_point=base) if nest else document.modelspace()
    for shape in shapes:
        shape.add(content)
    matrices = [np.eye(4)]
    for depth, attributes in enumerate(nest, start=1):
        last = depth == len(nest)
        around = document.modelspace() if last else document.blocks.new(f"B{depth}")
        insert = around.add_blockref(f"B{depth - 1}", attributes["insert"], dict(attributes))
        places = [np.array(list(copy.matrix44())).reshape(4, 4) for copy in copies(insert)]
        matrices = [inner @ outer for outer in places for inner in matrices]
    stream = io.StringIO()
    document.write(stream)
    found = walk.read(ezdxf.read(io.StringIO(stream.getvalue())), MILLIMETRE)
    assert not found.findings
    assert len(found.curves) == len(shapes) * len(matrices)
    for k, curve in enumerate(found.curves):
        matrix, truth = matrices[k // len(shapes)], shapes[k % len(shapes)].truth

        def at(share: Array, truth: Truth = truth, matrix: Array = matrix) -> Array:
            return np.asarray(MILLIMETRE * (truth(share) @ matrix[:3, :3] + matrix[3, :3])[:, :2])

        error = found.entities[int(found.owner[k])].error
        assert error <= 0.6 * MICROMETRE
        assert from_curve(curve, at(np.linspace(0.0, 1.0, 97))).max() <= error + 1e-9
        assert from_truth(at, along(curve), error + 1e-7).max() <= error + 3e-7
        assert np.abs(curve.bulges).max() <= 1.0 + 1e-12


def copies(insert: Any) -> list[Any]:
    """An INSERT and the copies of its array, by ezdxf."""
    return list(insert.multi_insert()) if insert.mcount > 1 else [insert]


def segments(curve: Curve) -> tuple[Array, Array, Array]:
    """The start, the end (N,) as complex numbers, m, and the bulge of every segment."""
    places = curve.points[:, 0] + 1j * curve.points[:, 1]
    ends = np.roll(places, -1)
    return (places, ends, curve.bulges) if curve.closed else (places[:-1], ends[:-1], curve.bulges)


def along(curve: Curve) -> Array:
    """Places on a curve, (K, 2) m."""
    vertices = np.column_stack([curve.points, np.append(curve.bulges, [] if curve.closed else [0.0])])
    return bulged(vertices, curve.closed, np.linspace(0.0, 1.0, min(SAMPLES, 7 * len(vertices))))


def from_curve(curve: Curve, points: Array) -> Array:
    """How far places (K, 2) are from a curve, m."""
    start, end, bulge = (each[:, None] for each in segments(curve))
    place = (points[:, 0] + 1j * points[:, 1])[None]
    chord = end - start
    share = np.clip(((place - start) * chord.conj()).real / np.maximum(np.abs(chord) ** 2, 1e-300), 0.0, 1.0)
    straight = np.abs(place - start - share * chord)
    bent = np.where(bulge == 0.0, 1.0, bulge)
    centre = 0.5 * (start + end) + 0.5j * chord * (1.0 - bent**2) / (2.0 * bent)
    turned = np.angle((place - centre) / (start - centre)) * np.sign(bent) % (2.0 * math.pi)
    radial = np.abs(np.abs(place - centre) - np.abs(start - centre))
    ends = np.minimum(np.abs(place - start), np.abs(place - end))
    arc = np.where(turned <= 4.0 * np.arctan(np.abs(bent)), radial, ends)
    return np.asarray(np.where(bulge == 0.0, straight, arc).min(axis=0))


def from_truth(at: Callable[[Array], Array], points: Array, enough: float) -> Array:
    """How far places (K, 2) are from the exact geometry, m; looked at closely where that is more than ``enough``."""
    away = np.full(len(points), np.inf)
    for count in (SAMPLES, 20 * SAMPLES, 400 * SAMPLES):
        rest = np.flatnonzero(away > enough)
        if len(rest):
            dense = at(np.linspace(0.0, 1.0, count))
            _, nearest = cKDTree(dense).query(points[rest], 2)  # a closed line ends where it begins
            for k in range(2):
                away[rest] = np.minimum(away[rest], from_line(dense, nearest[:, k], points[rest]))
    return away


def from_line(dense: Array, nearest: Array, points: Array) -> Array:
    """How far places (K, 2) are from the chords of a dense line of points (N, 2) at the nearest one, m."""
    best = np.full(len(points), np.inf)
    for first in (nearest - 1, nearest):
        start, end = dense[np.maximum(first, 0)], dense[np.minimum(first + 1, len(dense) - 1)]
        chord = end - start
        share = np.sum((points - start) * chord, axis=1) / np.maximum(np.sum(chord**2, axis=1), 1e-300)
        away = points - start - np.clip(share, 0.0, 1.0)[:, None] * chord
        best = np.minimum(best, np.hypot(*away.T))
    return best
