"""Damage to the motion: too fast, too hard, too abrupt; every size is a share of the limit that it breaks."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from deltacam.model import Array, BlockKind, IntArray, Slower
from deltacam.program.program import Program
from tests.damage.aim import NoPlaceError, aim
from tests.damage.example import WORKING, Example
from tests.damage.rows import at_points, gathered, with_q

ALLOWED = 1.001
"""Differences may be that much above a limit."""

DOUBLED, LOST, SWAPPED = (-2, -1, 0, 0, 1, 2), (-2, -1, 1, 2), (-2, -1, 1, 0, 2, 3)
"""The rows around a row after it was doubled, lost, or swapped with the next one."""

Make = Callable[[Example, float, np.random.Generator], Program]
Share = Callable[[Example, Array, Array], float]
"""The largest share of a limit that rows of joint angles (N, 3) rad and tool points (N, 3) m have, ends not held."""


def of_joints(order: int) -> Share:
    """The share of the joints' limit of speed (1), acceleration (2) or jerk (3)."""

    def share(case: Example, q: Array, _: Array) -> float:
        joints = case.robot.joints
        limit = (joints.max_speed, joints.max_acceleration, joints.max_jerk)[order - 1]
        if limit is None:
            raise NoPlaceError
        return float((np.abs(np.diff(q, n=order, axis=0)) * case.rate**order / limit).max()) / ALLOWED

    return share


def of_tool(order: int) -> Share:
    """The share of the tool's rating of speed (1) or acceleration (2)."""

    def share(case: Example, _: Array, tool: Array) -> float:
        limit = (case.robot.tool.max_speed, case.robot.tool.max_acceleration)[order - 1]
        size = np.linalg.norm(np.diff(tool, n=order, axis=0), axis=1).max()
        return float(size) * case.rate**order / limit / ALLOWED

    return share


def of_curve(order: int) -> Share:
    """The share of the joints' limit of speed (1) or acceleration (2) that Hermite curves between the rows have."""

    def share(case: Example, q: Array, _: Array) -> float:
        if case.robot.controller.interpolation != "cubic":
            raise NoPlaceError
        slopes, steps = (q[2:] - q[:-2]) / 2.0, np.diff(q[1:-1], axis=0)
        start, end, u = slopes[:-1], slopes[1:], np.linspace(0.0, 1.0, 41)[:, np.newaxis, np.newaxis]
        if order == 1:
            limit = case.robot.joints.max_speed
            found = 6.0 * u * (1.0 - u) * steps + (1.0 - 4.0 * u + 3.0 * u**2) * start + (3.0 * u**2 - 2.0 * u) * end
        else:
            limit = case.robot.joints.max_acceleration
            found = 6.0 * (1.0 - 2.0 * u) * steps + (6.0 * u - 4.0) * start + (6.0 * u - 2.0) * end
        return float((np.abs(found) * case.rate**order / limit).max()) / ALLOWED

    return share


def faster_controller(share: Share, order: int) -> Make:
    """A rate of setpoints at which the same rows have just this share of a limit."""

    def make(case: Example, amount: float, _: np.random.Generator) -> Program:
        used = share(case, _held(case.program.q), _held(case.tool))
        return _at_rate(case, (amount / used) ** (1.0 / order))

    return make


def faster_feed(case: Example, amount: float, _: np.random.Generator) -> Program:
    """The same for the feed, that of cutting or that of engraving."""
    return _at_rate(case, amount / max(_feed_share(case, kind) for kind in WORKING))


def slower_feed_in_meta(case: Example, amount: float, _: np.random.Generator) -> Program:
    """A process whose feed is exceeded by the same rows."""
    process, used = case.program.process, _feed_share(case, BlockKind.CUT)
    return replace(case.program, process=replace(process, feed=process.feed * used / amount))


def slower_holes_in_meta(case: Example, amount: float, _: np.random.Generator) -> Program:
    """A process with a rule for holes that the same rows exceed."""
    holes = {one.number for one in case.drawing.contours if one.is_hole and one.has_kerf}
    rows = np.array([row for row in case.rows(BlockKind.CUT).tolist() if case.contour(row).number in holes], dtype=int)
    if not len(rows):
        raise NoPlaceError
    fastest = float(np.linalg.norm(case.tool[rows + 1] - case.tool[rows], axis=1).max()) * case.rate
    process = case.program.process
    rule = Slower(min(fastest / (process.feed * ALLOWED * amount), 1.0), diameter=1.0)
    return replace(case.program, process=replace(process, slower=(rule,)))


def slower_bends_in_meta(case: Example, amount: float, _: np.random.Generator) -> Program:
    """A process with a rule for bends that the rows of a circle exceed."""
    cut = [one for one in case.drawing.contours if one.has_kerf]
    circles = {one.number: one.curve for one in cut if (one.curve.bulges == 1.0).all()}
    blocks = [one for one in case.program.blocks if one.kind is BlockKind.CUT and one.contour in circles]
    if not blocks:
        raise NoPlaceError
    block = blocks[0]
    quarter = (block.last - block.first) // 4
    tool = case.tool[block.first + quarter : block.last - quarter]
    fastest = float(np.linalg.norm(np.diff(tool, axis=0), axis=1).max()) * case.rate
    radius = 0.5 * float(np.ptp(circles[block.contour or 0].points, axis=0).max())
    process = case.program.process
    rule = Slower(min(fastest / (process.feed * ALLOWED * amount), 1.0), radius=1.03 * radius)
    return replace(case.program, process=replace(process, slower=(rule,)))


def faster_cut(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """The rows of one cut resampled, so that it takes less time."""
    cuts = [block for block in case.program.blocks if block.kind is BlockKind.CUT]
    block = cuts[int(chance.integers(len(cuts)))]
    limit = case.program.process.feed * ALLOWED
    q = case.program.q[block.first : block.last + 2]

    def sampled(gain: float) -> Array:
        times = np.append(np.arange(0.0, len(q) - 1, 1.0 + gain), len(q) - 1)
        return np.stack([np.interp(times, np.arange(len(q)), joint) for joint in q.T], axis=1)

    def measure(gain: float) -> float:
        steps = np.diff(case.robot.forward(sampled(gain)), axis=0)
        return float(np.linalg.norm(steps, axis=1).max()) * case.rate / limit

    found = sampled(aim(measure, amount, start=1e-3))[:-1]
    index = np.r_[: block.first + len(found), block.last + 1 : len(case.program.q)]
    return with_q(gathered(case.program, index), block.first + np.arange(len(found)), found)


def jolt(share: Share) -> Make:
    """One joint of one setpoint moved, to this share of a limit of the joints."""

    def make(case: Example, amount: float, chance: np.random.Generator) -> Program:
        rows, here = _window(case, chance)
        way = np.eye(3)[int(chance.integers(3))] * chance.choice([-1.0, 1.0])

        def moved(size: float) -> Array:
            q = case.program.q[rows].copy()
            q[here] += size * way
            return q

        size = aim(lambda size: share(case, moved(size), moved(size)), amount, start=1e-9)
        return with_q(case.program, rows, moved(size))

    return make


def tool_jolt(order: int) -> Make:
    """One setpoint moved in the plane of the sheet, to this share of the tool's rating."""
    share = of_tool(order)

    def make(case: Example, amount: float, chance: np.random.Generator) -> Program:
        rows, here = _window(case, chance)
        angle = chance.uniform(0.0, 2.0 * np.pi)
        way = np.array([np.cos(angle), np.sin(angle), 0.0])

        def moved(size: float) -> Array:
            tool = case.tool[rows].copy()
            tool[here] += size * way
            return tool

        size = aim(lambda size: share(case, moved(size), moved(size)), amount, start=1e-9)
        return at_points(case.program, rows[[here]], moved(size)[[here]])

    return make


def trembling(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """All angles of all setpoints a little off, at random, to this share of the joints' acceleration."""
    noise = chance.uniform(-1.0, 1.0, case.program.q.shape)
    share = of_joints(2)
    size = aim(lambda size: share(case, _held(case.program.q + size * noise), noise), amount, start=1e-9)
    return replace(case.program, q=case.program.q + size * noise)


def rearranged(pattern: tuple[int, ...]) -> Make:
    """Rows doubled, lost or swapped where that gives the tool just this share of its acceleration."""

    def make(case: Example, amount: float, _: np.random.Generator) -> Program:
        rows = np.arange(2, len(case.tool) - 3)
        around = case.tool[rows[:, np.newaxis] + np.array(pattern)]
        second = np.linalg.norm(np.diff(around, n=2, axis=1), axis=2).max(axis=1) * case.rate**2
        row = int(rows[_nearest(second / case.robot.tool.max_acceleration / ALLOWED, amount)])
        middle = row + np.array(pattern)
        return gathered(case.program, np.r_[: middle[0], middle, middle[-1] + 1 : len(case.tool)])

    return make


def end_at_speed(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """Rows lost at the start or at the end, such that the first or last step is this share of what a rest allows."""
    at_end = bool(chance.integers(2))
    steps = np.linalg.norm(np.diff(case.tool, axis=0), axis=1)
    allowed = 0.5 * case.robot.tool.max_acceleration / case.rate**2 * ALLOWED
    count = int(np.argmax((steps[::-1] if at_end else steps) >= amount * allowed))
    if not count:
        raise NoPlaceError
    rows = np.arange(len(case.tool))
    return gathered(case.program, rows[:-count] if at_end else rows[count:])


def standing_in_a_cut(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """The tool stays where it is slowest inside a cut, for so many times what a corner may take."""
    cuts = [block for block in case.program.blocks if block.kind is BlockKind.CUT]
    block = cuts[int(chance.integers(len(cuts)))]
    margin = (block.last - block.first) // 4
    rows = np.arange(block.first + margin, block.last - margin)
    steps = np.linalg.norm(case.tool[rows + 1] - case.tool[rows], axis=1)
    row = int(rows[np.argmin(steps)])
    ticks = int(amount * longest_rest(case) * case.rate) + 1
    return gathered(case.program, np.r_[:row, np.repeat(row, ticks), row : len(case.tool)])


def longest_rest(case: Example) -> float:
    """How long the laser may be on at rest, the pierce not counted, s."""
    return max(0.02, 3.0 / case.rate)


def swinging(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """A joint to and fro at every tick, so that it has this share of its acceleration between the ticks.

    At the ticks it has less: where second differences a and b follow each other, a Hermite curve has 2 a - b.
    """
    rows, _ = _window(case, chance)
    joint = np.eye(3)[int(chance.integers(3))]
    swing = np.zeros((len(rows), 3))
    swing[3:-3] = np.outer((-1.0) ** np.arange(len(rows) - 6), joint)
    share, q = of_curve(2), case.program.q[rows]
    size = aim(lambda size: share(case, q + size * swing, q), amount, start=1e-9)
    return with_q(case.program, rows, q + size * swing)


def _held(values: Array) -> Array:
    """Rows (N, k) with the ends held for two rows more."""
    return np.pad(values, ((2, 2), (0, 0)), mode="edge")


def _at_rate(case: Example, factor: float) -> Program:
    controller = replace(case.robot.controller, rate_hz=case.rate * factor)
    return replace(case.program, robot=replace(case.robot, controller=controller))


def _feed_share(case: Example, kind: BlockKind) -> float:
    """The largest share of its feed that a program has in blocks of a kind."""
    rows = case.rows(kind)
    feed = case.program.process.feed if kind is BlockKind.CUT else case.program.process.engrave_feed
    steps = np.linalg.norm(case.tool[rows + 1] - case.tool[rows], axis=1)
    return float(steps.max(initial=0.0)) * case.rate / (feed or 1.0) / ALLOWED


def _window(case: Example, chance: np.random.Generator) -> tuple[IntArray, int]:
    """Rows around a random one, and its place among them."""
    row = int(chance.integers(5, len(case.tool) - 5))
    return np.arange(row - 5, row + 6), 5


def _nearest(values: Array, amount: float) -> int:
    """The index of the smallest value that is not below ``amount``; for less than 1, of the largest not above it."""
    found = np.flatnonzero(values <= amount if amount < 1.0 else values >= amount)
    if not len(found):
        raise NoPlaceError
    return int(found[np.argmin(np.abs(values[found] - amount))])
