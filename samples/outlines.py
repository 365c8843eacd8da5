"""Plane outlines for the samples: pure functions that give vertices or Bezier curves, in millimetres.

A vertex is (x, y, bulge): the bulge is that of the segment that leaves it, the tangent of a quarter of its turn, as in
DXF. A corner is (x, y, radius). Closed outlines run counter-clockwise.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import Final

Point = tuple[float, float]
Vertex = tuple[float, float, float]
Bezier = tuple[Point, Point, Point, Point]

_LETTERS: Final = {  # 100 units high; an edge F bends a little to its left, into the ink, as a chisel leaves it
    "D": "M 0 0 L 30 0 C 62 0 82 22 82 50 C 82 78 62 100 30 100 L 0 100 F 0 0"
    " M 17 13 F 17 87 L 31 87 C 52 87 64 71 64 50 C 64 29 52 13 31 13 L 17 13",
    "E": "M 0 0 F 57 0 L 58 14 F 17 13 F 17 43 F 48 43 L 48 56 F 17 56 F 17 87 F 55 86 L 54 100 F 0 100 F 0 0",
    "L": "M 0 0 F 55 0 L 56 15 F 17 13 F 17 100 L 0 100 F 0 0",
    "T": "M 30 0 L 47 0 F 47 87 F 76 85 L 77 100 F 0 100 L 1 85 F 30 87 F 30 0",
    "A": "M 0 0 L 16 0 F 24 24 F 60 24 F 68 0 L 86 0 F 52 100 L 34 100 F 0 0 M 28 36 F 42 79 F 56 36 F 28 36",
    "C": "M 75 92 C 66 98 56 101 46 101 C 19 101 0 79 0 50 C 0 21 19 -1 46 -1 C 56 -1 66 2 75 8 L 71 24"
    " C 64 17 56 13 47 13 C 29 13 18 29 18 50 C 18 71 29 87 47 87 C 56 87 64 83 71 76 L 75 92",
    "M": "M 0 0 L 14 0 F 22 66 L 45 2 L 53 2 F 76 66 F 84 0 L 98 0 F 86 100 L 72 100 F 49 36 F 26 100 L 12 100 F 0 0",
}
_WIDTHS: Final = {"D": 82, "E": 58, "L": 56, "T": 77, "A": 86, "C": 75, "M": 98}
_KERNING: Final = {"LT": -16, "TA": -18, "DE": 2, "CA": -2, "AC": -3}
_GAP: Final = 13.0
_BEND: Final = 0.035


def polar(radius: float, angle: float) -> Point:
    """The point at ``radius`` and ``angle`` rad."""
    return radius * math.cos(angle), radius * math.sin(angle)


def bulge(turn: float) -> float:
    """The bulge of an arc that turns by ``turn`` rad; positive to the left."""
    return math.tan(turn / 4.0)


def place(outline: Iterable[Vertex], angle: float = 0.0, at: Point = (0.0, 0.0)) -> list[Vertex]:
    """The vertices turned by ``angle`` rad about the origin, then moved by ``at``."""
    cos, sin = math.cos(angle), math.sin(angle)
    return [(cos * x - sin * y + at[0], sin * x + cos * y + at[1], bend) for x, y, bend in outline]


def moved(bezier: Bezier, angle: float, at: Point) -> Bezier:
    """The curve turned by ``angle`` rad about the origin, then moved by ``at``."""
    a, b, c, d = (vertex[:2] for vertex in place([(x, y, 0.0) for x, y in bezier], angle, at))
    return a, b, c, d


def flipped(bezier: Bezier) -> Bezier:
    """The curve mirrored at the y axis and run the other way."""
    a, b, c, d = ((-x, y) for x, y in reversed(bezier))
    return a, b, c, d


def mirrored(outline: Sequence[Vertex]) -> list[Vertex]:
    """An open outline mirrored at the x axis and run the other way, so that it bends to the same side."""
    bends = [bend for _, _, bend in outline[:-1]]
    return [(x, -y, bend) for (x, y, _), bend in zip(reversed(outline), [*reversed(bends), 0.0], strict=True)]


def rounded(corners: Sequence[Vertex]) -> list[Vertex]:
    """The closed outline through ``corners`` with an arc of its radius at each; radius 0 leaves it sharp."""
    outline: list[Vertex] = []
    for i, (x, y, radius) in enumerate(corners):
        before, after = corners[i - 1], corners[(i + 1) % len(corners)]
        arrive = math.atan2(y - before[1], x - before[0])
        leave = math.atan2(after[1] - y, after[0] - x)
        turn = math.remainder(leave - arrive, math.tau)
        if radius == 0.0:
            outline.append((x, y, 0.0))
            continue
        reach = radius * math.tan(abs(turn) / 2.0)
        outline.append((x - reach * math.cos(arrive), y - reach * math.sin(arrive), bulge(turn)))
        outline.append((x + reach * math.cos(leave), y + reach * math.sin(leave), 0.0))
    return outline


def box(width: float, height: float, radius: float = 0.0, at: Point = (0.0, 0.0)) -> list[Vertex]:
    """A rectangle about ``at`` with round corners."""
    x, y = width / 2.0, height / 2.0
    return place(rounded([(-x, -y, radius), (x, -y, radius), (x, y, radius), (-x, y, radius)]), 0.0, at)


def hollow_box(width: float, height: float, radius: float) -> list[Vertex]:
    """A rectangle from the origin up with hollow round corners."""
    bend, right, top = bulge(-math.pi / 2), width - radius, height - radius
    return [
        (radius, 0.0, 0.0), (right, 0.0, bend), (width, radius, 0.0), (width, top, bend),
        (right, height, 0.0), (radius, height, bend), (0.0, top, 0.0), (0.0, radius, bend),
    ]  # fmt: skip


def slot(length: float, width: float) -> list[Vertex]:
    """A slot along x about the origin, ``length`` between the centres of its round ends."""
    x, y = length / 2.0, width / 2.0
    return [(-x, -y, 0.0), (x, -y, 1.0), (x, y, 0.0), (-x, y, 1.0)]


def hull(left: float, right: float, distance: float) -> list[Vertex]:
    """The outline around two circles on the x axis, ``distance`` apart, about the origin."""
    angle = math.acos((left - right) / distance)
    (ax, ay), (bx, by) = polar(left, angle), polar(right, angle)
    ax, bx = ax - distance / 2.0, bx + distance / 2.0
    return [(ax, -ay, 0.0), (bx, -by, bulge(2 * angle)), (bx, by, 0.0), (ax, ay, bulge(math.tau - 2 * angle))]


def window(inner: float, outer: float, half_spoke: float, radius: float, sector: float) -> list[Vertex]:
    """A window between two spokes that are parallel-sided: arcs of radii ``inner`` and ``outer``, round corners."""
    y = half_spoke + radius
    a, b = math.asin(y / (inner + radius)), math.asin(y / (outer - radius))
    half = [  # from the middle of the inner arc to the middle of the outer one, along the spoke at angle 0
        (*polar(inner, sector / 2), bulge(a - sector / 2)),
        (*polar(inner, a), bulge(math.pi / 2 - a)),
        (math.sqrt((inner + radius) ** 2 - y**2), half_spoke, 0.0),
        (math.sqrt((outer - radius) ** 2 - y**2), half_spoke, bulge(b + math.pi / 2)),
        (*polar(outer, b), bulge(sector / 2 - b)),
        (*polar(outer, sector / 2), 0.0),
    ]
    return [*half[:-1], *place(mirrored(half), sector)[:-1]]


def involute(base: float, roll: float, start: float, side: float, pieces: int = 4) -> list[Bezier]:
    """The involute of the circle of radius ``base``, unrolled from angle ``start`` by ``roll`` rad; side -1 mirrors.

    Cubic Hermite pieces of c + t s and s - t c, with c, s the cosine and sine of the roll angle t; for a tooth they are
    within a tenth of a micrometre.
    """
    found = []
    for i in range(pieces):
        a, b = roll * i / pieces, roll * (i + 1) / pieces
        handles = ((a, 0.0), (a, (b - a) / 3.0), (b, (a - b) / 3.0), (b, 0.0))
        x = [base * (math.cos(t) + t * math.sin(t) + step * t * math.cos(t)) for t, step in handles]
        y = [side * base * (math.sin(t) - t * math.cos(t) + step * t * math.sin(t)) for t, step in handles]
        found.append(moved(((x[0], y[0]), (x[1], y[1]), (x[2], y[2]), (x[3], y[3])), start, (0.0, 0.0)))
    return found


def petal(length: float, width: float, root: float) -> list[Bezier]:
    """A petal along x that begins ``root`` from the origin; pointed at both ends."""
    x, y = [root + length * share for share in (0.0, 0.25, 0.7, 1.0)], 0.62 * width
    lower: Bezier = ((x[0], 0.0), (x[1], -y), (x[2], -y), (x[3], 0.0))
    upper: Bezier = ((x[3], 0.0), (x[2], y), (x[1], y), (x[0], 0.0))
    return [lower, upper]


def snow_arm(reach: float, stem: float, branches: Sequence[Point]) -> Iterator[Vertex]:
    """The upper half of an arm along x, from its tip to the valley beside it; branches are (place, length)."""
    cos, sin = math.cos(math.pi / 3), math.sin(math.pi / 3)
    yield reach, 0.0, 0.0
    yield reach - 1.7 * stem, stem, 0.0
    for x, length in sorted(branches, reverse=True):
        width = 0.8 * stem
        shoulder = length - width
        for aside, t in ((width, None), (width, shoulder), (0.0, length), (-width, shoulder), (-width, None)):
            t = (stem + aside * cos) / sin if t is None else t  # None: where the branch leaves the stem
            yield x + t * cos + aside * sin, t * sin - aside * cos, 0.0
    yield 22.0, stem, 0.0
    yield *polar(17.0, math.pi / 6), 0.0


def word(text: str, scale: float, middle: Point) -> list[list[Bezier]]:
    """The closed outlines of a word of the letters above, its base line centred at ``middle``."""
    steps = [_WIDTHS[a] + _GAP + _KERNING.get(a + b, 0) for a, b in pairwise(text)]
    pen = middle[0] - scale * (sum(steps) + _WIDTHS[text[-1]]) / 2.0
    found = []
    for name, step in zip(text, [*steps, 0.0], strict=True):
        found += _letter(_LETTERS[name], scale, (pen, middle[1]))
        pen += scale * step
    return found


def _letter(text: str, scale: float, at: Point) -> list[list[Bezier]]:
    """The outlines of a letter: M starts one, L is a straight edge, F a bent one, C a cubic Bezier curve."""
    words = iter(text.split())
    outlines: list[list[Bezier]] = []
    here = at
    for verb in words:
        pairs = [(float(next(words)), float(next(words))) for _ in range(3 if verb == "C" else 1)]
        points = [(at[0] + scale * x, at[1] + scale * y) for x, y in pairs]
        if verb == "M":
            outlines.append([])
        elif verb == "C":
            outlines[-1].append((here, points[0], points[1], points[2]))
        else:
            outlines[-1].append(_edge(here, points[0], _BEND if verb == "F" else 0.0))
        here = points[-1]
    return outlines


def _edge(start: Point, end: Point, pull: float) -> Bezier:
    """A line from ``start`` to ``end`` whose middle is pulled to its left, by about this share of its length."""
    x, y = end[0] - start[0], end[1] - start[1]
    first, second = (
        (start[0] + share * x - pull * y, start[1] + share * y + pull * x) for share in (1.0 / 3.0, 2.0 / 3.0)
    )
    return start, first, second, end


def star(tip: float, valley: float, points: int) -> list[Vertex]:
    """A star about the origin with ``points`` sharp tips, one of them up."""
    step = math.pi / points
    return [(*polar((tip, valley)[k % 2], math.pi / 2 + k * step), 0.0) for k in range(2 * points)]


def strokes(text: str, height: float, at: Point) -> list[list[Point]]:
    """A word of single lines, as a laser engraves it, its base line beginning ``at``."""
    scale, found = height / 6.0, []
    for place, name in enumerate(text):
        for line in _STROKES.get(name, "").split(","):
            points = [(6.0 * place + float(x), float(y)) for x, y in line.split()]
            found.append([(at[0] + scale * x, at[1] + scale * y) for x, y in points])
    return [line for line in found if line]


_STROKES: Final = {  # 4 units wide and 6 high; one digit for each of x and y, lines apart by a comma
    "D": "00 30 41 45 36 06 00",
    "E": "40 00 06 46,03 33",
    "L": "06 00 40",
    "T": "06 46,26 20",
    "A": "00 26 40,12 32",
    "3": "06 46 24 34 43 41 30 10 01",
    "0": "10 01 05 16 36 45 41 30 10",
}
