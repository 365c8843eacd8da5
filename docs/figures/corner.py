"""A corner magnified with its blend and the curvature along it; a chain of chords and the arcs in its place."""

from __future__ import annotations

from typing import Final

import numpy as np
from figures.chart import Axes, label, legend, picture
from figures.example import ACROSS, DEVIATION, LEFT

from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve
from deltacam.motion.chains import fit
from deltacam.motion.corners import CHAINS, pieces
from deltacam.motion.path import Path

CHORDS: Final = 720
RADIUS: Final = 1e-2

_LEG: Final = 1e-3
_SHOWN: Final = 17  # chords


def draw() -> str:
    """The picture as SVG."""
    drawn = Curve(points=np.array([[-_LEG, 0], [0, 0], [0, _LEG]]), bulges=np.zeros(2), closed=False)
    (path,) = pieces(drawn, corner="round", deviation=DEVIATION, ramps=False, z=0.0)
    reach = _LEG - float(path.length[0])
    blend = path.part(1, len(path.length) - 1)
    about = "An arc that leaves the corner by as much is dashed"
    return picture(
        "A corner with its blend, and a chain", about, 644, [*_magnified(blend, reach), *_bend(blend), *_chain()]
    )


def _along(path: Path, count: int) -> tuple[Array, Array, Array]:
    """Distances, points and curvatures along a path, at ``count`` places in every segment."""
    segment = np.repeat(np.arange(len(path.length)), count)
    inside = np.tile(np.linspace(0.0, 1.0, count), len(path.length)) * path.length[segment]
    points, _, _, _ = path.evaluate(segment, inside)
    offset = np.cumsum(path.length) - path.length
    return offset[segment] + inside, points[:, :2], path.curvature[segment] + path.sharpness[segment] * inside


def _arc() -> float:
    """How far from a right angle an arc begins that leaves it by the deviation, which is its radius, m."""
    return float(DEVIATION / np.tan(np.pi / 8.0))


def _magnified(blend: Path, reach: float) -> list[str]:
    axes = Axes(LEFT, 40, 330, 330, (-85, 25), (-25, 85))
    _, points, _ = _along(blend, 25)
    turn, radius = np.linspace(-np.pi / 2.0, 0.0, 40), _arc()
    arc = radius * np.stack([np.cos(turn) - 1.0, np.sin(turn) + 1.0])
    legs = np.array([[-85.0, 0.0, 0.0], [0.0, 0.0, 85.0]])
    return [
        axes.line(*legs, "part", width=2.0 * DEVIATION * 1e6 * axes.width / 110.0),
        axes.frame([-75, -50, -25, 0, 25], [-25, 0, 25, 50, 75], x_name="µm", y_name="a right angle, µm"),
        axes.line(*legs, "line", width=1.2),
        axes.line(*np.hstack([[[-85.0], [0.0]], arc * 1e6, [[0.0], [85.0]]]), "orange", dashed=True),
        axes.line(*np.vstack([[-85, 0], points * 1e6, [0, 85]]).T, "blue", width=2.2),
        legend(LEFT, 430, [(f"blend, begins {reach * 1e6:.0f} µm before the corner", "blue", "line")]),
        legend(LEFT + 305, 430, [(f"arc, {radius * 1e6:.0f} µm", "orange", "dashed")]),
        legend(LEFT + 435, 430, [(f"within {DEVIATION * 1e6:.0f} µm of the corner as it is drawn", "line", "band")]),
    ]


def _bend(blend: Path) -> list[str]:
    axes = Axes(LEFT + 450, 40, 358, 330, (-75, 75), (0, 30))
    at, _, bend = _along(blend, 2)
    way = np.concatenate([[-75e-6], at - 0.5 * blend.total, [75e-6]])
    radius = _arc()
    end = np.pi / 4.0 * radius
    arc = np.array([-75e-6, -end, -end, end, end, 75e-6]), np.array([0, 0, 1, 1, 0, 0]) / radius
    return [
        axes.frame([-50, -25, 0, 25, 50], [0, 10, 20, 30], x_name="length, µm", y_name="curvature, 1/mm"),
        axes.line(arc[0] * 1e6, arc[1] * 1e-3, "orange", dashed=True),
        axes.line(way * 1e6, np.concatenate([[0.0], bend, [0.0]]) * 1e-3, "blue", width=2.2),
    ]


def _chain() -> list[str]:
    """The direction along a circle that was flattened, and along the arcs that replace its chords."""
    angle = 2.0 * np.pi * np.arange(CHORDS) / CHORDS
    chain = curves.polygon(RADIUS * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    found, off, _ = fit(chain, allowance=CHAINS * DEVIATION)
    length, heading = curves.lengths(chain)[:_SHOWN] * 1e3, np.degrees(curves.headings(chain)[0][:_SHOWN])
    ends = np.cumsum(length)
    steps = np.stack([ends - length, ends], axis=1).ravel(), np.repeat(heading, 2)
    first, bend = np.degrees(curves.headings(found)[0][0]), np.degrees(curves.curvatures(found)[0]) * 1e-3
    axes = Axes(LEFT, 484, ACROSS, 110, (0, 1.5), (90, 100))
    about = f"a circle of {RADIUS * 2e3:g} mm, of {CHORDS} chords, and the {len(found.bulges)} arcs in their place"
    return [
        axes.frame([0, 0.5, 1.0, 1.5], [90, 95, 100], x_name="length, mm", y_name=f"{about}: direction, degrees"),
        axes.line(*steps, "line", width=1.4),
        axes.line(np.array([0.0, ends[-1]]), first + bend * np.array([0.0, ends[-1]]), "blue", width=2.2),
        label(LEFT + 12, 506, f"the arcs are at most {off.max() * 1e6:.2f} µm from the chords"),
    ]
