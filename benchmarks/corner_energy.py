"""Prints how much energy the laser leaves at sharp corners, and what time these take: round, stop, loop, by power law.

The part is a triangle with a tip of a given angle; it is planned and verified. Energy is that along the path of the
contour, as the verification adds it up: what a loop burns is waste. The time lost is that between two places on the
sides beside the tip, less what the path of the beam's centre between them, without a loop, takes at the feed.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final, NamedTuple

import ezdxf
import numpy as np

from deltacam.cutting.process import load_process
from deltacam.model import Array, BlockKind, BoolArray, Corner, PowerLaw
from deltacam.pipeline import Planned, plan
from deltacam.robot.reader import load_robot
from deltacam.units import to_mm
from deltacam.verification.energy import line_energy
from deltacam.verification.evidence import ON_PATH_KINDS, Evidence, gather

ANGLES: Final = (90.0, 30.0)  # degrees, of the tip
FEEDS: Final = (None, 0.03)  # m/s; None is that of the process
CORNERS: Final[dict[bool, tuple[Corner, ...]]] = {True: ("round", "stop", "loop"), False: ("round", "stop")}
"""At outer corners and at inner ones, which have no waste for a loop."""
LAWS: Final = {"constant": None, "0.1, v": PowerLaw(0.1), "0.3, v": PowerLaw(0.3), "0.1, v^2": PowerLaw(0.1, 2.0)}
"""The power at rest, and what it rises with."""
SIDE: Final = 0.04  # m, of the sides beside the tip
ABOUT: Final = 2.5e-3  # m, to either side of the corner: what the mean is over
AT: Final = (0.0, 0.06)  # m, of the part: its base is nearest to the park position, so that cuts begin there
FAR: Final = 0.015  # m from the tip: the places between which time is taken


class Row(NamedTuple):
    """What a corner comes to.

    Attributes:
        least: of the energy of a millimetre about the corner, times that at the feed.
        most: likewise.
        mean: of the energy up to `ABOUT` from the corner, likewise.
        lost: s.
        passed: whether the program passed every check.
    """

    least: float
    most: float
    mean: float
    lost: float
    passed: bool


def triangle(angle: float, path: Path, *, outer: bool) -> Array:
    """Draw a part with a tip of ``angle`` rad, or with a hole that has it.

    Returns:
        the directions of the two sides away from the tip, (2, 2); the tip is at the origin.
    """
    document = ezdxf.new("R2000", units=ezdxf.units.MM)
    half = 0.5 * angle
    sides = np.array([[-np.sin(half), -np.cos(half)], [np.sin(half), -np.cos(half)]])
    points = to_mm(1.0) * np.vstack([[0.0, 0.0], SIDE * sides])
    document.modelspace().add_lwpolyline(points.tolist(), close=True)
    if not outer:
        x, y = to_mm(1.5 * SIDE), to_mm(SIDE)
        document.modelspace().add_lwpolyline([(-x, -1.2 * y), (x, -1.2 * y), (x, 0.2 * y), (-x, 0.2 * y)], close=True)
    document.saveas(path)
    return sides


def measured(planned: Planned, sides: Array, *, outer: bool) -> Row:
    """What the corner at the origin of the drawing comes to."""
    evidence = gather(planned.program, planned.program.robot)
    process, times = planned.program.process, line_energy(evidence)
    on_path = evidence.is_kind(ON_PATH_KINDS)
    near = on_path & (np.hypot(*evidence.sheet.T) < ABOUT) & np.isfinite(times)
    return Row(
        float(times[near].min()),
        float(times[near].max()),
        mean_energy(evidence, near),
        passing(evidence, sides) - kerf_path(sides, process.kerf, outer=outer) / process.feed,
        planned.report.passed,
    )


def kerf_path(sides: Array, kerf: float, *, outer: bool) -> float:
    """How long the path of the beam's centre is from `FAR` on one side to `FAR` on the other, without a loop, m."""
    angle = float(np.arccos(np.dot(*sides)))
    return 2.0 * FAR + (0.5 * kerf * (np.pi - angle) if outer else -kerf / np.tan(0.5 * angle))


def mean_energy(evidence: Evidence, near: BoolArray) -> float:
    """All energy of the rows that are ``near`` the corner, (N,), over that of their way at the feed."""
    process, rows = evidence.program.process, np.flatnonzero(near)
    spent = evidence.program.power[rows].sum() / evidence.rate
    return float(spent * process.feed / (process.power * evidence.speed[rows].sum() / evidence.rate))


def passing(evidence: Evidence, sides: Array) -> float:
    """The time from one side to the other, s, in which the tool passes the corner."""
    works = evidence.is_kind(ON_PATH_KINDS | {BlockKind.LOOP})
    along = evidence.sheet @ sides.T  # how far from the tip along each side
    across = np.abs(evidence.sheet @ np.stack([-sides[:, 1], sides[:, 0]]))
    moments = []
    for side in (0, 1):
        rows = np.flatnonzero(works & (across[:, side] < 1e-3) & (np.abs(along[:, side] - FAR) < 2e-3))
        order = np.argsort(along[rows, side])
        moments.append(float(np.interp(FAR, along[rows[order], side], rows[order])))
    return abs(moments[1] - moments[0]) / evidence.rate


def cases() -> Iterator[tuple[bool, float, float | None, Corner]]:
    """Whether the corner is an outer one, the angle of its tip, the feed, and what is done at corners."""
    for outer, corners in CORNERS.items():
        for angle in ANGLES:
            for feed in FEEDS:
                yield from ((outer, angle, feed, corner) for corner in corners)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robot", default="delta-300")
    parser.add_argument("--no-jerk", action="store_true", help="the robot without its limit of jerk")
    parser.add_argument("--process", default="steel-1mm-fibre")
    asked = parser.parse_args()
    robot, usual = load_robot(asked.robot), load_process(asked.process)
    if asked.no_jerk:
        robot = replace(robot, joints=replace(robot.joints, max_jerk=None))
    print(f"| tip | feed, mm/s | corner | time lost, ms | {' | '.join(LAWS)} |")
    print("|---" * (4 + len(LAWS)) + "|")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "tip.dxf"
        for outer, angle, feed, corner in cases():
            sides = triangle(np.radians(angle), path, outer=outer)
            rows = []
            for law in LAWS.values():
                process = replace(usual, feed=feed or usual.feed, corner=corner, power_law=law)
                planned = plan(path, robot=robot, process=process, at=AT, what_if=False, jobs=1)
                rows.append(measured(planned, sides, outer=outer))
            cells = [f"{row.least:.2f} to {row.most:.2f}, mean {row.mean:.2f}" for row in rows]
            cells[:0] = [f"{angle:.0f}, {'outer' if outer else 'inner'}", f"{to_mm(process.feed):.0f}", corner]
            cells.insert(3, f"{1e3 * rows[0].lost:.0f}")
            failed = "" if all(row.passed for row in rows) else " FAILED"
            print(f"| {' | '.join(cells)} |{failed}", flush=True)


if __name__ == "__main__":
    main()
