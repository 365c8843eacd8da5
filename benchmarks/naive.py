"""Prints what becomes of random contours when toppra is used in the way that comes naturally, and with deltacam.

The limits are those of the joints' speed and acceleration, by toppra's own constraints. Every way to use it gets the
same contours, closed chains of tangent lines and arcs; ways for corners get the polygons that these round.
"""

from __future__ import annotations

import argparse
import logging
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np
from scipy.ndimage import minimum_filter1d

from benchmarks.ways import WAYS, Case, Plan, deltacam, deltacam_corners, round_corners
from deltacam.geometry import curve as curves
from deltacam.model import Array, BoolArray, Curve
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot
from deltacam.units import to_um

JOINTS: Final = {"strong": 1.0, "weak": 0.2}
"""The share of their acceleration that the joints of the robots have."""

EXCEEDED: Final = 1.01
"""The share of a limit that counts as exceeding it."""

STOPPED: Final = 0.1
"""The speed over the least of deltacam near the same place that counts as a stop."""

_INSIDE: Final = (np.arange(8) + 0.5) / 8.0
_COMPARED: Final = 4000  # places along a contour
_NEAR: Final = 17  # of them


class Result(NamedTuple):
    """What came of one contour.

    Attributes:
        joints: the name of the robot's joints.
        always: the largest share of the limit of acceleration at any time but where the direction jumps.
        ticks: the same by second differences of setpoints.
        off: how far the setpoints leave the contour, m.
        stops: how often the motion all but stops.
        time: the planned time over that of deltacam.
    """

    joints: str
    always: float
    ticks: float
    off: float
    stops: int
    time: float


def cases(count: int, seed: int) -> Iterator[Case]:
    """Random contours of 5 to 80 mm across, at the centre of the sheet and at its rim."""
    whole = load_robot("delta-300")
    robots = {}
    for name, share in JOINTS.items():
        acceleration = tuple(share * limit for limit in whole.joints.max_acceleration)
        robots[name] = replace(whole, joints=replace(whole.joints, max_acceleration=acceleration, max_jerk=None))
    for number in range(count):
        rng = np.random.default_rng([seed, number])
        smooth, sharp = star(rng)
        angle, far = rng.uniform(0.0, 2.0 * np.pi), 0.1 * (number // 2 % 2)
        place: dict[str, Any] = {
            "scale": 5e-3 * 16.0 ** rng.uniform() / float(np.ptp(sharp.points, axis=0).max()),
            "rotation": rng.uniform(0.0, 2.0 * np.pi),
            "shift": (far * np.cos(angle), far * np.sin(angle)),
        }
        joints = list(JOINTS)[number % 2]
        yield Case(curves.transform(smooth, **place), curves.transform(sharp, **place), robots[joints], joints)


def star(rng: np.random.Generator) -> tuple[Curve, Curve]:
    """A star of 4 to 12 corners, and the same with every corner rounded by an arc; some arcs meet without a line."""
    count = int(rng.integers(4, 13))
    angle = 2.0 * np.pi * (np.arange(count) + rng.uniform(-0.3, 0.3, count)) / count
    points = rng.uniform(0.4, 1.0, count)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    side = np.hypot(*(np.roll(points, -1, axis=0) - points).T)
    # An arc begins and ends at one distance from its corner: at most half of the shorter side.
    room = 0.5 * np.minimum(side, np.roll(side, 1)) * np.where(rng.random(count) < 0.3, 1.0, rng.uniform(0.1, 0.9))
    return round_corners(points, room), curves.polygon(points)


def shares(plan: Plan, robot: Robot) -> tuple[Array, Array]:
    """The share of the joints' limit of acceleration along the path: distances (N,) m, and shares (N,).

    It is seen from both sides of every gridpoint and of every joint of the path, and between them.
    """
    edges = np.union1d(plan.distance, plan.breaks)
    start, end = edges[:-1], edges[1:]
    interval = np.clip(np.searchsorted(plan.distance, 0.5 * (start + end)) - 1, 0, len(plan.distance) - 2)
    x = plan.speed**2
    u = (np.diff(x) / (2.0 * np.diff(plan.distance)))[interval]
    found, places = [], []
    for part, side in ((0.0, "behind"), *((share, "behind") for share in _INSIDE), (1.0, "before")):
        place = start + part * (end - start)
        squared = np.maximum(x[interval] + 2.0 * u * (place - plan.distance[interval]), 0.0)
        acceleration = plan.joints(place, 1, side) * u[:, None] + plan.joints(place, 2, side) * squared[:, None]
        found.append((np.abs(acceleration) / robot.joints.max_acceleration).max(axis=1))
        places.append(place)
    return np.stack(places, axis=1).ravel(), np.stack(found, axis=1).ravel()


def setpoints(plan: Plan, robot: Robot) -> Array:
    """The joints at every tick, the first and the last setpoint held, (N, 3) rad."""
    rate = robot.controller.rate_hz
    time = np.arange(int(np.ceil(plan.duration * rate)) + 1) / rate
    q = plan.sample(np.minimum(time, plan.duration))
    return np.concatenate([q[:1], q, q[-1:]])


def distances(points: Array, curve: Curve) -> Array:
    """How far points (N, 2) m are from a curve, (N,) m."""
    least = np.full(len(points), np.inf)
    for segment in range(len(curve.bulges)):
        _, gap = curves.project(curve, np.full(len(points), segment), points)
        least = np.minimum(least, gap)
    return least


def stops(plan: Plan, good: Plan) -> int:
    """How often the speed falls below a part of that of another plan, places compared by their share of the length."""
    share = (np.arange(_COMPARED) + 0.5) / _COMPARED
    slow = _speed(plan, share) < STOPPED * minimum_filter1d(_speed(good, share), _NEAR)
    return int(np.count_nonzero(np.diff(slow.astype(int)) == 1))


def _speed(plan: Plan, share: Array) -> Array:
    return np.asarray(np.sqrt(np.interp(share * plan.distance[-1], plan.distance, plan.speed**2)))


def results(ways: Sequence[str], given: Sequence[Case]) -> dict[str, list[Result | None]]:
    """What comes of every contour, by way; None where nothing was planned."""
    logging.getLogger("toppra").setLevel(logging.ERROR)
    found: dict[str, list[Result | None]] = {way: [] for way in ways}
    for case in given:
        good = {False: deltacam(case), True: deltacam_corners(case)}
        for way in ways:
            sharp = "corners" in way
            plan = good[sharp] if way.startswith("deltacam") else WAYS[way](case)
            found[way].append(_result(case, plan, good[sharp], sharp=sharp) if plan else None)
    return found


def _result(case: Case, plan: Plan, good: Plan, *, sharp: bool) -> Result:
    q = setpoints(plan, case.robot)
    change = np.diff(q, n=2, axis=0) * case.robot.controller.rate_hz**2
    ticks = float((np.abs(change) / case.robot.joints.max_acceleration).max())
    off = float(distances(case.robot.forward(q)[:, :2], case.sharp if sharp else case.smooth).max())
    always = float(shares(plan, case.robot)[1].max())
    return Result(case.joints, always, ticks, off, stops(plan, good), plan.duration / good.duration)


def _row(way: str, joints: str, found: Sequence[Result | None]) -> str:
    """A line of the table."""
    done = [one for one in found if one is not None]
    head = f"{way:22} {joints:7} {len(found):5} {len(found) - len(done):7}"
    if not done:
        return head
    over = _percent([one.always > EXCEEDED for one in done]), _percent([one.ticks > EXCEEDED for one in done])
    worst, at_ticks = max(one.always for one in done), max(one.ticks for one in done)
    off = to_um(1.0) * np.array([one.off for one in done])
    slow = _percent([one.stops > 0 for one in done])
    time = np.array([one.time for one in done])
    return (
        f"{head} {over[0]:6} {worst:8.3f} {over[1]:6} {at_ticks:8.3f} {np.median(off):8.2f} {off.max():8.2f} {slow:6} "
        f"{np.median(time):7.3f} {time.max():7.3f}"
    )


def _percent(true: Sequence[bool] | BoolArray) -> str:
    return f"{100.0 * np.mean(true):.0f} %"


def main() -> None:
    """Run the campaign and print a row per way and robot."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--contours", type=int, default=200, help="random contours")
    parser.add_argument("--seed", type=int, default=0, help="of the random numbers")
    options = parser.parse_args()
    given = list(cases(options.contours, options.seed))
    found = results(list(WAYS), given)
    print(f"{'':44}  acceleration over its limit   off the path, um  {'':6}  time / deltacam")
    print(f"{'':23} {'':7} {'':5} {'':7}    at any time      at ticks")
    print(
        f"{'way':22} {'joints':7} {'paths':>5} {'no plan':>7} {'over':>6} {'worst':>8} {'over':>6} {'worst':>8} "
        f"{'median':>8} {'worst':>8} {'stops':>6} {'median':>7} {'worst':>7}"
    )
    for way, column in found.items():
        for joints in JOINTS:
            own = [one for one, case in zip(column, given, strict=True) if case.joints == joints]
            print(_row(way, joints, own))


if __name__ == "__main__":
    main()
