"""Prints how far estimated times of rapids are from planned ones, for robots with and without limits that bind."""

from __future__ import annotations

import sys
import time
from dataclasses import replace
from itertools import pairwise

import numpy as np

from deltacam.model import Array
from deltacam.motion.path import straight
from deltacam.motion.route import Route
from deltacam.motion.run import run
from deltacam.motion.setpoints import rapid_limits
from deltacam.robot.rapid import Rapids
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot

COUNT = 200
CHUNK = 50
BOUNDS = (1e-3, 3e-3, 1e-2, 3e-2, 0.1, 2.0)


def robots() -> dict[str, Robot]:
    """Built-in ones, some with a limit of jerk, and some whose joints bind more than the tool's rating."""
    names = ("delta-300", "irb360-1600", "delta-x-s-d600", "tutorial-112")
    found = {name: load_robot(name) for name in names}
    for name, jerk in (("irb360-1600", 4000.0), ("delta-x-s-d600", 20000.0)):
        found[f"{name}, jerk"] = replace(found[name], joints=replace(found[name].joints, max_jerk=(jerk,) * 3))
    delta, irb = found["delta-300"], found["irb360-1600"]
    weak = {"max_acceleration": (15.0,) * 3, "max_speed": (0.8,) * 3}
    found["delta-300, weak"] = replace(delta, joints=replace(delta.joints, **weak))
    weak = {"max_acceleration": (10.0,) * 3, "max_speed": (0.5,) * 3, "max_jerk": (400.0,) * 3}
    found["irb360-1600, weak"] = replace(irb, joints=replace(irb.joints, **weak))
    return found


def moves(robot: Robot, count: int, seed: int = 0) -> tuple[Array, Array]:
    """Where rapids begin and end on the sheet, (count, 2) m; their lengths are spread evenly on a logarithmic scale."""
    rng = np.random.default_rng(seed)
    grid = robot.workspace.grid(41)[:, :2]
    begin = grid[rng.integers(len(grid), size=8 * count)]
    length = np.exp(rng.uniform(np.log(BOUNDS[0]), np.log(np.ptp(grid[:, 0])), (8 * count, 1)))
    turn = rng.uniform(0.0, 2.0 * np.pi, 8 * count)
    end = begin + length * np.column_stack([np.cos(turn), np.sin(turn)])
    held = np.flatnonzero(robot.workspace.excess(end) == 0.0)[:count]
    return begin[held], end[held]


def planned(robot: Robot, begin: Array, end: Array) -> Array:
    """How long the rapids take as they are planned, (N,) s."""
    limits, z, times = rapid_limits(robot), robot.workspace.sheet_z, list[float]()
    for at in range(0, len(begin), CHUNK):
        ends = zip(begin[at : at + CHUNK], end[at : at + CHUNK], strict=True)
        times += [one.duration for one in run(Route.of([(straight(*each, z), limits) for each in ends]), robot)]
    return np.array(times)


def main() -> None:
    """Compare, robot by robot."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else COUNT
    print(
        "robot                  rapids  median %  90th %  99th %  worst %  bias %  of 1-3, 3-10, 10-30, 30-100, >100 mm"
    )
    for name, robot in robots().items():
        begin, end = moves(robot, count)
        off = Rapids(robot)(begin, end) / planned(robot, begin, end) - 1.0
        length = np.hypot(*(end - begin).T)
        size, numbers = np.abs(100.0 * off), [100.0 * float(np.median(off))]
        groups = [size[(length >= low) & (length < high)] for low, high in pairwise(BOUNDS)]
        numbers = [*np.quantile(size, [0.5, 0.9, 0.99, 1.0]).tolist(), *numbers]
        text = " ".join(f"{number:8.2f}" for number in numbers)
        print(f"{name:22} {len(begin):6} {text}   " + ", ".join(f"{np.median(one):.2f}" for one in groups if len(one)))
    rapids, many = Rapids(load_robot("delta-300")), 100_000
    begin, end = np.random.default_rng(0).uniform(-0.14, 0.14, (2, many, 2))
    started = time.perf_counter()
    rapids(begin, end)
    print(f"{(time.perf_counter() - started) / many * 1e6:.2f} us for each estimate of {many}")


if __name__ == "__main__":
    main()
