"""What a kerf does to every contour, from the drawing alone: no program is looked at.

A beam of the radius h reaches into an inner corner, whose tip points into the material, until its round touches both
sides: where the sides turn by t, the half angle between them is (pi - t) / 2, and the tip that is left is
h (1 / sin((pi - t) / 2) - 1) deep. In a fillet of the radius r < h it is that of a beam of the radius h - r. The sides
are taken as long enough for that; with shorter ones less is left.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Array, Contour, KerfEffect

_CORNER: Final = np.radians(10.0)  # that a corner turns by at least, to be one
_SHARPEST: Final = np.radians(179.0)
_DEPTH: Final = 1e-6  # m; less than that is nothing
_SLACK: Final = 3e-6  # m; above the errors of reading and flattening


def kerf_effects(contours: Sequence[Contour], rings: Sequence[Sequence[Array]], kerf: float) -> tuple[KerfEffect, ...]:
    """What the kerf does to each contour that is cut beside its line, in their order.

    Args:
        contours: of a drawing.
        rings: the kerf path of each, (K, 2) m each, the first point not repeated.
        kerf: width of the cut, m, >= 0.
    """
    shifted = [index for index, contour in enumerate(contours) if contour.has_kerf]
    met = _met([contours[index].number for index in shifted], [rings[index] for index in shifted], kerf)
    effects = []
    for index, others in zip(shifted, met, strict=True):
        tips, depths = inner_tips(contours[index], kerf / 2.0)
        deepest = int(np.argmax(depths)) if len(depths) else None
        effects.append(
            KerfEffect(
                contour=contours[index].number,
                paths=len(rings[index]),
                meets=others,
                corners=len(depths),
                depth=0.0 if deepest is None else float(depths[deepest]),
                place=None if deepest is None else (float(tips[deepest, 0]), float(tips[deepest, 1])),
            )
        )
    return tuple(effects)


def inner_tips(contour: Contour, radius: float) -> tuple[Array, Array]:
    """The inner corners that a beam does not reach, (K, 2) m, and how deep the material in each tip is, (K,) m.

    Args:
        contour: closed, counter-clockwise; its corners and its arcs are looked at.
        radius: of the beam, m, >= 0.
    """
    curve = contour.curve
    inwards = 1.0 if contour.is_hole else -1.0
    corner = inwards * curves.corner_angles(curve)
    bend, curvature = inwards * curves.turns(curve), inwards * curves.curvatures(curve)
    fillet = np.divide(1.0, curvature, out=np.full_like(curvature, np.inf), where=curvature > 0.0)
    middles, _ = curves.evaluate(curve, np.arange(len(bend)), 0.5 * curves.lengths(curve))
    tips = np.concatenate([curve.points, middles])
    turn = np.concatenate([corner, bend])
    missing = np.concatenate([np.full(len(corner), radius), radius - fillet])
    real = np.flatnonzero((turn > _CORNER) & (missing > 0.0))
    depth = missing[real] * (1.0 / np.cos(0.5 * np.minimum(turn[real], _SHARPEST)) - 1.0)
    deep = depth > _DEPTH
    return tips[real[deep]], depth[deep]


def _met(numbers: Sequence[int], rings: Sequence[Sequence[Array]], kerf: float) -> list[tuple[int, ...]]:
    """For each contour the numbers of those whose slot runs into its own: their paths are less than a kerf apart."""
    paths = [shapely.LinearRing(ring) for found in rings for ring in found]
    owner = np.repeat(np.array(numbers, dtype=np.int64), [len(found) for found in rings])
    met: dict[int, set[int]] = {number: set() for number in numbers}
    if kerf > _SLACK and paths:
        lines = np.array(paths, dtype=object)
        one, other = shapely.STRtree(lines).query(lines, predicate="dwithin", distance=kerf - _SLACK)
        for first, second in zip(owner[one].tolist(), owner[other].tolist(), strict=True):
            if first != second:
                met[first].add(second)
    return [tuple(sorted(met[number])) for number in numbers]
