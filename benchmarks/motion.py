"""Prints how fast known shapes are, and what a limit of jerk and the time stage cost; rest to rest, without kerf."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from math import radians
from typing import Final

import numpy as np

from deltacam.geometry import clothoid
from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve
from deltacam.motion.corners import pieces
from deltacam.motion.jerk import limited
from deltacam.motion.law import Law
from deltacam.motion.parametrize import parametrize, solve
from deltacam.motion.path import Path
from deltacam.motion.route import Grid, Limits, Route
from deltacam.motion.rows import Rows
from deltacam.motion.run import run
from deltacam.motion.sample import sample
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Controller, JointLimits, Robot, ToolRating
from deltacam.robot.workspace import Workspace

TOOTH: Final = (
    (0.0, 27.0), (0.12, 27.0), (0.20, 27.3), (0.28, 28.5), (0.36, 29.7),
    (0.44, 30.0), (0.56, 30.0), (0.64, 29.7), (0.72, 28.5), (0.80, 27.3),
)  # fmt: skip
"""Share of the pitch and radius, mm, of the vertices of a tooth."""

FREE: Final = 1e4
"""m/s2, no cap on the acceleration of the tool."""


def robot(dimensions: tuple[float, float, float, float], z: float, speed: float, acceleration: float) -> Robot:
    """A robot of base and effector radius, upper arm and forearm, m, and joint limits, rad/s and rad/s2."""
    joints = JointLimits((radians(-60.0),) * 3, (radians(100.0),) * 3, (speed,) * 3, (acceleration,) * 3)
    sheet = Workspace(sheet_z=z, radius=0.06)
    return Robot("benchmark", DeltaGeometry(*dimensions), joints, ToolRating(16.0, FREE), sheet, Controller())


SMALL: Final = replace(
    robot((0.13201114, 0.03319764, 0.112, 0.232), -0.18043, radians(180.0), radians(3000.0)),
    controller=Controller(interpolation="cubic"),
)
"""The robot of the comparison with LinuxCNC."""

LARGE: Final = robot((0.11547, 0.02887, 0.25, 0.60), -0.55, 8.0, 150.0)
"""The robot of the comparison of limits of jerk."""


def gear() -> Curve:
    """40 teeth of ten straight segments each."""
    places = [(tooth + share, radius) for tooth in range(40) for share, radius in TOOTH]
    angle, radius = 2.0 * np.pi * np.array([share for share, _ in places]) / 40.0, np.array([r for _, r in places])
    return curves.polygon(1e-3 * radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]))


def square() -> Curve:
    """Of 60 mm, from the middle of an edge."""
    corners = [(0.0, -30.0), (30.0, -30.0), (30.0, 30.0), (-30.0, 30.0), (-30.0, -30.0)]
    return curves.polygon(1e-3 * np.array(corners))


SHAPES: Final = (
    ("gear of 400 segments", gear(), 0.2, 5.45, 7.206),
    ("square of 60 mm", square(), 0.2, 1.348, 1.393),
    ("circle of 60 mm", curves.circle(np.zeros(2), 0.03), 0.2, 0.979, 0.976),
    ("circle of 60 mm", curves.circle(np.zeros(2), 0.03), 0.5, 0.556, 0.596),
)
"""Name, curve, feed m/s, the time that we want, and the time that LinuxCNC takes, s."""


def shortest(curve: Curve, feed: float) -> float:
    """The time of a shape on the small robot within 10 um, s."""
    parts = pieces(curve, corner="round", deviation=10e-6, ramps=False, z=SMALL.workspace.sheet_z)
    return float(parametrize(Route.of([(part, Limits(feed, FREE)) for part in parts]), SMALL).durations.sum())


def clothoid_rectangle() -> Path:
    """60 x 40 mm, the corners pairs of clothoids with a smallest radius of 2.5 mm, from the middle of an edge."""
    bend, length = 1.0 / 2.5e-3, 0.5 * np.pi * 2.5e-3
    sharp = bend / length
    zero, one = np.zeros(1), np.ones(1)
    middle, _ = clothoid.advance(np.zeros((1, 2)), zero, zero, sharp * one, length * one)
    corner = float(middle.sum())  # the pair is symmetric about the diagonal through its middle
    place, heading, rows = np.array([0.0, -0.02]), 0.0, []
    for side, edge in enumerate((0.03, 0.04, 0.06, 0.04, 0.03)):
        straight = edge - corner * (1.0 if side in {0, 4} else 2.0)
        todo = [(0.0, 0.0, straight), (0.0, sharp, length), (bend, -sharp, length)][: 1 if side == 4 else 3]
        for curvature, sharpness, way in todo:
            rows.append((*place, heading, curvature, sharpness, way))
            ends = clothoid.advance(place[None], heading * one, curvature * one, sharpness * one, way * one)
            place, heading = ends[0][0], float(ends[1][0])
    table = np.array(rows)
    columns = (table[:, :2], *table[:, 2:6].T, np.zeros(len(table)), np.full(len(table), np.inf))
    return Path(*columns, LARGE.workspace.sheet_z)


def arc_rectangle(*, ramps: bool) -> Path:
    """The same size with arcs of 5 mm, smoothed within 18 um."""
    x, y, r = 0.03, 0.02, 0.005
    right, left = [(x - r, -y), (x, r - y), (x, y - r), (x - r, y)], [(r - x, y), (-x, y - r), (-x, r - y), (r - x, -y)]
    drawn = Curve(
        np.array([(0.0, -y), *right, *left, (0.0, -y)]),
        np.array([0.0, *(4 * [np.tan(np.pi / 8.0), 0.0])]),
        closed=False,
    )
    (path,) = pieces(drawn, corner="round", deviation=18e-6, ramps=ramps, z=LARGE.workspace.sheet_z)
    return path


def peak_jerk(path: Path, law: Law, machine: Robot, *, rate: float = 400.0) -> float:
    """The largest third difference of the joints over all phases of the ticks, rad/s3."""
    duration, largest = float(law.durations[0]), 0.0
    for phase in np.arange(20) / 20.0:
        ticks = (np.arange(-4, int(duration * rate) + 6) + phase) / rate
        place = law.at(np.zeros(len(ticks), dtype=np.int64), np.clip(ticks, 0.0, duration))
        q = machine.inverse(path.evaluate(*path.locate(place))[0])
        largest = max(largest, float(np.abs(np.diff(q, 3, axis=0)).max()) * rate**3)
    return largest


def with_jerk(path: Path, jerk: float) -> tuple[float, float]:
    """The time, s, and the largest jerk at 400 Hz, rad/s3, under a limit of jerk, rad/s3."""
    machine = replace(LARGE, joints=replace(LARGE.joints, max_jerk=(jerk,) * 3))
    route = Route.of([(path, Limits(1.0, 23.0))])
    grid = Grid.over(route, machine)
    tempo = limited(route, grid, Rows.over(route, grid, machine), machine, np.ones(len(grid.segment)))
    return float(tempo.durations[0]), peak_jerk(path, tempo, machine)


def show_jerk(name: str, path: Path, free: Path) -> None:
    """Time against the limit of jerk, both as shares of what they are without a limit."""
    law = parametrize(Route.of([(free, Limits(1.0, 23.0))]), LARGE)
    time_, peak = float(law.durations[0]), peak_jerk(free, law, LARGE)
    print(f"\n{name}: {time_:.4f} s and {peak:.0f} rad/s3 at 400 Hz without a limit of jerk")
    print("limit, in continuous time   largest at 400 Hz   time")
    shares = [1.0, 0.8, 0.6, 0.5, 0.45, 0.4, 0.34, 0.3, 0.25, 0.2]
    low, high = 0.3, 0.45
    for _ in range(7):  # the limit for which 400 Hz show 0.34
        middle = 0.5 * (low + high)
        low, high = (middle, high) if with_jerk(path, middle * peak)[1] < 0.34 * peak else (low, middle)
    for share in sorted([*shares, low], reverse=True):
        slower, seen = with_jerk(path, share * peak)
        print(f"{share:24.3f} {seen / peak:19.3f} {100.0 * (slower / time_ - 1.0):+8.2f} %")


def circles() -> Iterator[tuple[str, Curve]]:
    """A circle of 25 mm as it may be drawn."""
    yield "CIRCLE", curves.circle(np.zeros(2), 0.025)
    corners = 0.025 * np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    yield "4 bulges", Curve(corners, np.full(4, np.tan(np.pi / 8.0)))
    angle = 2.0 * np.pi * np.arange(720) / 720.0
    yield "720 chords", curves.polygon(0.025 * np.column_stack([np.cos(angle), np.sin(angle)]))


def circle_time(curve: Curve, feed: float, machine: Robot) -> float:
    """Of a circle, s."""
    ramps = machine.joints.max_jerk is not None
    parts = pieces(curve, corner="round", deviation=18e-6, ramps=ramps, z=machine.workspace.sheet_z)
    return sum(one.duration for one in run(Route.of([(part, Limits(feed, 23.0, 20e-6)) for part in parts]), machine))


def show_cost() -> None:
    """Microseconds of this process per gridpoint, and per tick with a limit of jerk."""
    machine = replace(load_robot("delta-300"), joints=replace(load_robot("delta-300").joints, max_jerk=None))
    (path,) = pieces(gear(), corner="round", deviation=18e-6, ramps=False, z=machine.workspace.sheet_z)
    paths = [path] * 4
    route = Route.of([(one, Limits(0.15, 23.0, 20e-6)) for one in paths])
    grid, law = Grid.over(route, machine), parametrize(route, machine)
    rows = Rows.over(route, grid, machine)
    steps: tuple[tuple[str, Callable[[], object]], ...] = (
        ("grid", lambda: Grid.over(route, machine)),
        ("rows", lambda: Rows.over(route, grid, machine)),
        ("solver", lambda: solve(grid, rows)),
        ("setpoints", lambda: sample(route.path, law, machine)),
        ("all", lambda: run(route, machine)),
    )
    print(f"\ntime stage, {len(law.time)} gridpoints, {law.durations.sum() * 400.0:.0f} ticks: us per gridpoint")
    for name, step in steps:
        spent = []
        for _ in range(3):
            started = time.process_time()
            step()
            spent.append(time.process_time() - started)
        print(f"  {name:10} {1e6 * min(spent) / len(law.time):6.2f}")


def show_circles() -> None:
    """The times of all circles, and by how much they differ."""
    delta = load_robot("delta-300")
    free = replace(delta, joints=replace(delta.joints, max_jerk=None))
    print("\ncircle of radius 25 mm    " + " ".join(f"{name:>11}" for name, _ in circles()) + "   differ by")
    for feed in (0.15, 0.5, 1.0):
        for name, machine in (("", free), (", jerk", delta)):
            times: Array = np.array([circle_time(curve, feed, machine) for _, curve in circles()])
            cells = " ".join(f"{one:9.4f} s" for one in times)
            print(f"  at {feed:4.2f} m/s{name:13} {cells}   {100.0 * np.ptp(times) / times.min():8.3f} %")


def main() -> None:
    """Print all tables."""
    print("small robot, 10 um, cubic        feed m/s   time s   wanted   LinuxCNC")
    for name, curve, feed, wanted, other in SHAPES:
        print(f"{name:32} {feed:8.2f} {shortest(curve, feed):8.4f} {wanted:8.3f} {other:10.3f}")
    show_jerk("rectangle with pairs of clothoids", clothoid_rectangle(), clothoid_rectangle())
    show_jerk("rectangle with arcs and ramps", arc_rectangle(ramps=True), arc_rectangle(ramps=False))
    show_circles()
    show_cost()


if __name__ == "__main__":
    main()
