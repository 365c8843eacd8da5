"""Prints how near the planned motion is to the fastest there can be, and to every limit, over many random contours."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from benchmarks.bound import by_chord, profiles
from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve
from deltacam.motion.corners import pieces
from deltacam.motion.law import TimeLaw
from deltacam.motion.parametrize import parametrize
from deltacam.motion.path import Path, straight
from deltacam.motion.route import Limits, Route
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot

GOALS: Final = (1.005, 1.001)
"""How long a motion may take over the bound, and which share of a limit it may use."""

LIMITS: Final = ("joint v", "joint a", "tool v", "tool a", "feed", "chord")
"""The limits, in the order of the columns."""

DEVIATION: Final = 18e-6
"""How far the path may leave the contour, m."""

CHORD: Final = 3e-6
"""A chord limit that binds, m; the other contours have none."""

JOINTS: Final = {"strong": (1.0, 1.0), "slow": (0.15, 0.3), "weak": (1.0, 0.2)}
"""The share of their speed and acceleration that the joints of the robots have; half of the contours get the first."""

WITHIN: Final = 10
"""Places in every interval at which the limits are looked at, besides its ends."""


@dataclass(frozen=True, slots=True, eq=False)
class Case:
    """A contour and what runs it.

    Attributes:
        moves: its paths from rest to rest, each with what bounds the tool.
        robot: the machine.
        group: names of the robot, of the ramps and of the chord limit.
    """

    moves: tuple[tuple[Path, Limits], ...]
    robot: Robot
    group: tuple[str, str, str]

    @property
    def limits(self) -> Limits:
        """What bounds the tool, the same in all moves."""
        return self.moves[0][1]


class Result(NamedTuple):
    """What came of one contour.

    Attributes:
        case: the contour.
        law: the planned motion.
        spent: s of planning.
        ratio: the planned time over the bound, of the worst move.
        shares: (6,) the largest share of every limit, at any time.
        sampled: (6,) likewise by the differences of setpoints; 0 for the chord.
    """

    case: Case
    law: TimeLaw
    spent: float
    ratio: float
    shares: Array
    sampled: Array


def worst(count: int, seed: int) -> tuple[float, float]:
    """The largest time over the bound, and the largest share of any limit, of ``count`` random contours."""
    found = results(count, seed)
    return max(one.ratio for one in found), max(float(np.maximum(one.shares, one.sampled).max()) for one in found)


def results(count: int, seed: int) -> list[Result]:
    """What comes of ``count`` random contours, each without ramps and with them."""
    found = [case for ramps in (False, True) for case in cases(count, seed, ramps=ramps)]
    bounds: dict[int, Array] = {}
    for robot in {case.robot for case in found}:
        own = [number for number, case in enumerate(found) if case.robot == robot]
        times = [one.time for one in profiles([move for number in own for move in found[number].moves], robot)]
        ends = np.cumsum([len(found[number].moves) for number in own])
        bounds.update(zip(own, np.split(np.array(times), ends[:-1]), strict=True))
    return [_result(case, bounds[number]) for number, case in enumerate(found)]


def _result(case: Case, bound: Array) -> Result:
    started = time.perf_counter()
    law = parametrize(Route.of(case.moves), case.robot)
    spent = time.perf_counter() - started
    ratio = float((law.durations / bound).max())
    return Result(case, law, spent, ratio, shares(case, law).max(axis=0), at_ticks(case, law).max(axis=0))


def cases(count: int, seed: int, *, ramps: bool) -> Iterator[Case]:
    """Random contours of 5 to 80 mm across with random limits, at the centre of the sheet and at its rim."""
    robots = {name: _with_joints(load_robot("delta-300"), *shares) for name, shares in JOINTS.items()}
    for number in range(count):
        rng = np.random.default_rng([seed, number])
        shape = (_star, _rounded, _polygon)[number % 3](rng)
        across = float(np.ptp(shape.points, axis=0).max())
        angle, far = rng.uniform(0.0, 2.0 * np.pi), 0.1 * (number // 4 % 2)
        curve = curves.transform(
            shape,
            scale=5e-3 * 16.0 ** rng.uniform() / across,
            rotation=rng.uniform(0.0, 2.0 * np.pi),
            shift=(far * np.cos(angle), far * np.sin(angle)),
        )
        name = ("strong", "slow", "strong", "weak")[number % 4]
        robot, chord = robots[name], CHORD if number % 5 < 2 else np.inf
        limits = Limits(0.05 * 20.0 ** rng.uniform(), robot.tool.max_acceleration, chord)
        parts = pieces(curve, corner="round", deviation=DEVIATION, ramps=ramps, z=robot.workspace.sheet_z)
        group = (name, "ramps" if ramps else "-", "chord" if np.isfinite(chord) else "-")
        yield Case(tuple((part, limits) for part in parts), robot, group)


def _with_joints(robot: Robot, speed: float, acceleration: float) -> Robot:
    """A robot whose joints have the given shares of their speed and acceleration."""
    speeds = tuple(speed * limit for limit in robot.joints.max_speed)
    accelerations = tuple(acceleration * limit for limit in robot.joints.max_acceleration)
    return replace(robot, joints=replace(robot.joints, max_speed=speeds, max_acceleration=accelerations))


def _around(count: int, jitter: float, rng: np.random.Generator) -> Array:
    """Points on the unit circle, (count, 2), with their angles moved by up to ``jitter`` of the distance between."""
    angle = 2.0 * np.pi * (np.arange(count) + rng.uniform(-jitter, jitter, count)) / count
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _star(rng: np.random.Generator) -> Curve:
    """Lines and arcs that meet in corners."""
    count = int(rng.integers(3, 12))
    radius = 10.0 ** rng.uniform(-0.6, 0.0, count)
    bulges = np.where(rng.random(count) < 0.5, 0.0, rng.uniform(-0.3, 0.5, count))
    return Curve(points=radius[:, None] * _around(count, 0.3, rng), bulges=bulges)


def _polygon(rng: np.random.Generator) -> Curve:
    """A polygon of 3 to 24 sides, more or less regular."""
    count = int(rng.integers(3, 25))
    radius = rng.uniform(1.0 - 0.5 * rng.uniform(), 1.0, count)
    return curves.polygon(radius[:, None] * _around(count, 0.2, rng))


def _rounded(rng: np.random.Generator) -> Curve:
    """Lines and tangent arcs in turn: a slot, or a convex polygon with round corners."""
    count = int(rng.integers(2, 7))
    corners = _around(count, 0.25, rng)
    behind = np.roll(corners, -1, axis=0)
    way = (behind - corners) @ np.array([1.0, 1j])
    out = -1j * way / np.abs(way) * 10.0 ** rng.uniform(-1.5, 0.0)
    out = np.stack([out.real, out.imag], axis=1)
    points = np.stack([corners + out, behind + out], axis=1).reshape(-1, 2)
    turns = np.mod(np.angle(np.roll(way, -1) / way), 2.0 * np.pi)
    return Curve(points=points, bulges=np.stack([np.zeros(count), np.tan(turns / 4.0)], axis=1).ravel())


def shares(case: Case, law: TimeLaw) -> Array:
    """The share of every limit at the ends of all intervals, seen from inside, and within: (N, 6)."""
    route, robot = Route.of(case.moves), case.robot
    path, width = route.path, np.diff(law.distance)
    segment, _ = path.locate(law.distance[:-1] + 0.5 * width)
    offset = (np.cumsum(path.length) - path.length)[segment]
    u = np.diff(law.squared) / (2.0 * width)
    found = []
    for part in (0.0, *((np.arange(WITHIN) + 0.5) / WITHIN), 1.0):
        place = np.clip(law.distance[:-1] + part * width - offset, 0.0, path.length[segment])
        squared = (1.0 - part) * law.squared[:-1] + part * law.squared[1:]
        position, tangent, bend, _ = path.evaluate(segment, place)
        _, dq, ddq = robot.path_derivatives(position, tangent, bend)
        chord = squared / by_chord(robot, position, tangent, ddq, case.limits.chord)
        joint_v, joint_a = dq * np.sqrt(squared)[:, None], dq * u[:, None] + ddq * squared[:, None]
        tool_a = tangent * u[:, None] + bend * squared[:, None]
        found.append(np.column_stack([_over_limits(case, joint_v, joint_a, np.sqrt(squared), tool_a), chord]))
    return np.concatenate(found)


def at_ticks(case: Case, law: TimeLaw) -> Array:
    """The share of every limit by differences of the setpoints, the first and the last one held: (N, 6)."""
    route, robot = Route.of(case.moves), case.robot
    rate = robot.controller.rate_hz
    time_of = np.clip(np.arange(-1, np.ceil(law.time[-1] * rate) + 2) / rate, 0.0, law.time[-1])
    begins = law.time[law.rest[:-1]]
    move = np.searchsorted(begins, time_of, side="right") - 1
    distance = law.at(move, time_of - begins[move])
    position, _, _, _ = route.path.evaluate(*route.path.locate(distance))
    joint_v, tool_v = (rate * np.diff(one, axis=0) for one in (robot.inverse(position), position))
    joint_a, tool_a = (rate * np.diff(one, axis=0) for one in (joint_v, tool_v))
    found = _over_limits(case, joint_v[1:], joint_a, np.linalg.norm(tool_v[1:], axis=1), tool_a)
    return np.column_stack([found, np.zeros(len(found))])


def _over_limits(case: Case, joint_v: Array, joint_a: Array, tool_v: Array, tool_a: Array) -> Array:
    """Speeds and accelerations of the joints (N, 3) and the tool (N,) and (N, 3) over their limits: (N, 5)."""
    joints, limits = case.robot.joints, case.limits
    by_joints = [np.abs(joint_v) / joints.max_speed, np.abs(joint_a) / joints.max_acceleration]
    tool = [tool_v / case.robot.tool.max_speed, np.linalg.norm(tool_a, axis=1) / limits.acceleration]
    return np.column_stack([*(one.max(axis=1) for one in by_joints), *tool, tool_v / limits.speed])


def _print(name: str, found: Sequence[Result]) -> None:
    """Two rows of the table."""
    points = sum(len(one.law.time) for one in found)
    cost = sum(one.spent for one in found) / points * 1e6
    ratios = [one.ratio for one in found]
    always, sampled = (np.max([getattr(one, kind) for one in found], axis=0) for kind in ("shares", "sampled"))
    text = f"{name:18} {len(found):6} {points:8} {cost:7.1f} {np.median(ratios):9.5f} {max(ratios):9.5f}"
    print(text, *(f"{share:8.5f}" for share in always))
    print(" " * len(text), *(f"{share:8.5f}" for share in sampled[:-1]), " at ticks")


def main() -> None:
    """Run the campaign and print two rows per group."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--contours", type=int, default=200, help="random contours, each run with ramps and without")
    parser.add_argument("--seed", type=int, default=0, help="of the random numbers")
    options = parser.parse_args()
    robot = load_robot("delta-300")
    line = straight(np.zeros(2), np.array([0.01, 0.0]), robot.workspace.sheet_z)
    parametrize(Route.of([(line, Limits(1.0, 1.0))]), robot)  # so that imports do not count
    found = results(options.contours, options.seed)
    print(f"{'':18} {'':6} {'':8} {'':7} {'time over bound':>19}  largest share of")
    print(f"{'joints ramps chord':18} {'paths':>6} {'points':>8} {'us/pt':>7} {'median':>9} {'worst':>9}", end=" ")
    print(*(f"{limit:>8}" for limit in LIMITS))
    for group in sorted({one.case.group for one in found}):
        _print("{:6} {:5} {:5}".format(*group), [one for one in found if one.case.group == group])
    _print("all", found)
    ratio = max(one.ratio for one in found)
    share = max(float(np.maximum(one.shares, one.sampled).max()) for one in found)
    held = "holds" if ratio <= GOALS[0] else "is missed", "holds" if share <= GOALS[1] else "is missed"
    print(f"worst time over bound {ratio:.5f}: {GOALS[0]} {held[0]}; worst share {share:.5f}: {GOALS[1]} {held[1]}")


if __name__ == "__main__":
    main()
