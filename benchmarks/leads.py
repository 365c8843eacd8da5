"""Leads of 500 random contours, planned and measured: whether the beam burns a part, and how fast the tool arrives.

Nothing here asks the planner how it chose a lead. What the beam burns is the way of the tool at the setpoints, as wide
as the kerf. How fast the contour can be passed where it begins comes from a flying lap: the tool has been on the
same contour for a while. Geometry leaves room where a lead of the least size that the robot's limits allow, without any
margin, fits at one of many places around the contour, and where the contour has an edge somewhere that is long enough
for twice the ticks that are measured: between the corners of a small gear there is no speed to reach.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
import shapely

from benchmarks.random_parts import KINDS, PER_SHEET, content, placed, sheet
from deltacam import pipeline
from deltacam.cutting import kerf
from deltacam.cutting.leads.approaches import approaches
from deltacam.cutting.leads.reach import Reach
from deltacam.cutting.process import load_process
from deltacam.cutting.waste import Waste
from deltacam.geometry import curve as curves
from deltacam.model import Array, BlockKind, Contour, Curve, Cut, Lead, Placement, Process, Stretch
from deltacam.motion import setpoints
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot

ROBOTS: Final = ("delta-300", "irb360-1600", "irb360-1130", "rl5-1450", "delta-x-s-d600", "delta-300 cubic")
FEEDS: Final = (0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4)
SHAPES: Final = ("arc", "line+arc")
REACHED: Final = 0.95
"""Part of the speed of the flying lap, at the first ticks, from which on it counts as reached."""

ALMOST: Final = 0.98
"""The same, more strictly."""

_TICKS: Final = 3
_CORNER: Final = np.radians(15.0)
_CORNER_SIZE: Final = 0.4e-3  # m, of a rounded corner
_PLACES: Final = 180
_FINE: Final = 8  # places per tick
_BEFORE: Final = 0.03  # m, before the start of a contour on a flying lap, and behind it


@dataclass(frozen=True, slots=True)
class Begun:
    """How the cut of a contour begins.

    Attributes:
        kind: of the contour.
        hole: whether it is one.
        share: the speed at the first tick, or in the first ticks together, as a part of that of the flying lap.
        at_feed: the speed at the first tick as a part of the feed.
        lacking: why geometry leaves no room to reach it; empty where it does.
        why: in words, where the speed is not reached.
    """

    kind: str
    hole: bool
    share: float
    at_feed: float
    lacking: str
    why: str


def robot_of(name: str) -> Robot:
    """A built-in robot; with ``cubic`` its controller interpolates so."""
    own, _, cubic = name.partition(" ")
    robot = load_robot(own)
    return replace(robot, controller=replace(robot.controller, interpolation="cubic")) if cubic else robot


def finished(contours: tuple[Contour, ...]) -> list[Any]:
    """The finished parts, polygons: what an even number of lines lies around."""
    areas = [shapely.Polygon(curves.flatten(one.curve, 1e-6)[0]) for one in contours]
    parts = []
    for contour, area in zip(contours, areas, strict=True):
        if contour.depth % 2 == 0:
            holes = [other for one, other in zip(contours, areas, strict=True) if one.parent == contour.number]
            parts.append(area.difference(shapely.union_all(holes)) if holes else area)
    return parts


def burnt(planned: pipeline.Planned, parts: list[Any]) -> tuple[float, float]:
    """How much nearer than half a kerf the tool comes to a part with the laser on, m, and the area burnt off, m2.

    The area is that beyond the tolerances.
    """
    program = planned.program
    rows = np.flatnonzero(program.power[:-1] > 0.0)
    share = np.arange(_FINE + 1)[:, None, None] / _FINE
    q = (1.0 - share) * program.q[rows] + share * program.q[rows + 1]
    fine = to_sheet(program.placement, program.robot.forward(q.reshape(-1, 3))).reshape(_FINE + 1, -1, 2)
    ways = shapely.linestrings(np.swapaxes(fine, 0, 1))
    half = 0.5 * program.process.kerf
    allowed = program.process.tolerance + program.process.chord_tolerance
    swept = shapely.union_all(shapely.buffer(ways, half - allowed, quad_segs=16))
    area = sum(float(swept.intersection(part).area) for part in parts)
    near = min(float(shapely.distance(ways, part).min()) for part in parts)
    return half - near, area


def to_sheet(where: Placement, tool: Array) -> Array:
    """Points (N, 3) m of the machine in the sheet frame, (N, 2) m."""
    cos, sin = np.cos(where.rotation), np.sin(where.rotation)
    return np.asarray((tool[:, :2] - (where.x, where.y)) @ np.array([[cos, -sin], [sin, cos]]))


def begun(planned: pipeline.Planned, drawn: dict[int, str], parts: list[Any]) -> list[Begun]:
    """How the cut of every contour of a program begins."""
    program, process = planned.program, planned.program.process
    place = to_sheet(program.placement, program.robot.forward(program.q))
    speed = np.hypot(*np.diff(place, axis=0).T) * program.rate_hz
    cuts = kerf.offset(planned.drawing.contours, kerf=process.kerf).cuts
    first: dict[int, tuple[int, Array]] = {}
    for before, block in zip(program.blocks, program.blocks[1:], strict=False):
        if block.kind is BlockKind.CUT and block.contour is not None:
            lead = speed[before.first : block.first] if before.kind is BlockKind.LEAD_IN else np.empty(0)
            first.setdefault(block.contour, (block.first, lead))
    rings = {number: _ring(cuts, number, place[row : row + 2]) for number, (row, _) in first.items()}
    laps = _flying(rings, planned)
    found = []
    for number, (row, lead) in first.items():
        contour = next(one for one in planned.drawing.contours if one.number == number)
        along = np.cumsum(np.concatenate([[0.0], speed[row : row + _TICKS]]) / program.rate_hz)
        needed = np.interp(along, *laps[number])[1:] - np.interp(0.0, *laps[number])
        # The first tick alone, and all of the first ticks together: a lap has its ticks at other places.
        shares = (needed * program.rate_hz / np.arange(1, _TICKS + 1))[[0, -1]]
        share = float(shares.min())
        at_feed, allowed = float(speed[row]) / process.feed, float(along[1] / needed[0])
        room = "" if share >= ALMOST else _lacking(rings[number], contour, allowed, planned, parts)
        why = "" if share >= REACHED else _why(number, planned, share, room or _reason(lead, allowed, float(shares[0])))
        found.append(Begun(drawn[number], contour.is_hole, share, at_feed, room, why))
    return found


def _ring(cuts: tuple[Cut, ...], number: int, way: Array) -> Curve:
    """The path of the beam's centre of a contour, run as the tool does on a way through (2, 2) m, from its first."""
    own = [cut.curve for cut in cuts if cut.contour == number]
    ring = min(own, key=lambda one: curves.nearest(one, way[0])[2])
    segment, distance, _ = curves.nearest(ring, way[0])
    _, heading = curves.evaluate(ring, np.array([segment]), np.array([distance]))
    if (way[1] - way[0]) @ np.array([np.cos(heading[0]), np.sin(heading[0])]) < 0.0:
        ring = curves.reverse(ring)
        segment, distance, _ = curves.nearest(ring, way[0])
    return curves.start_at(ring, segment, distance)


def _flying(rings: dict[int, Curve], planned: pipeline.Planned) -> dict[int, tuple[Array, Array]]:
    """By contour, distances behind the start of its ring, m, and when the tool passes them where it comes flying, s."""
    program = planned.program
    ways, starts = [], dict[int, float]()
    for number, ring in rings.items():
        once, length = curves.opened(ring), curves.length(ring)
        before = min(1.5 * length, max(0.5 * length, _BEFORE))
        twice = curves.chain([once, once, once])
        lap = curves.part(twice, 2.0 * length - before, 2.0 * length + min(_BEFORE, 0.5 * length))
        starts[number] = before
        ways.append(Cut(number, "", ("0",), ring, way=(Stretch(BlockKind.CUT, lap),)))
    moved = setpoints.plan_motion(
        ways,
        robot=program.robot,
        process=program.process,
        placement=program.placement,
        drawing_error=planned.drawing.conversion_error,
        jobs=1,
        what_if=False,
    )
    place = to_sheet(program.placement, program.robot.forward(moved.q))
    step = np.hypot(*np.diff(place, axis=0).T)
    found = {}
    for block in moved.blocks:
        if block.kind is BlockKind.CUT and block.contour is not None:
            own = np.concatenate([[0.0], np.cumsum(step[block.first : block.last + 1])])
            zero = _passed(
                place[block.first : block.last + 2], own, rings[block.contour].points[0], starts[block.contour]
            )
            found[block.contour] = (own - zero, np.arange(len(own)) / program.rate_hz)
    return found


def _passed(way: Array, so_far: Array, start: Array, expected: float) -> float:
    """How far along a way through (N, 2) m the tool passes a place; chords across corners make the way shorter."""
    arm, step = start - way[:-1], np.diff(way, axis=0)
    share = np.clip(np.sum(arm * step, axis=1) / np.maximum(np.sum(step**2, axis=1), 1e-18), 0.0, 1.0)
    off = np.hypot(*(arm - share[:, None] * step).T)
    at = so_far[:-1] + share * np.diff(so_far)
    off[np.abs(at - expected) > np.maximum(2e-3, 0.2 * expected)] = np.inf
    return float(at[np.argmin(off)])


def _lacking(ring: Curve, contour: Contour, speed: float, planned: pipeline.Planned, parts: list[Any]) -> str:
    """Why geometry leaves no room to reach a speed; empty where it does."""
    if _longest_edge(ring) <= 2.0 * _TICKS * speed / planned.program.rate_hz:
        return "no edge is long enough"
    return "" if _leaves_room(ring, contour, speed, planned, parts) else "no lead fits"


def _longest_edge(ring: Curve) -> float:
    """The longest way along a ring without a corner, or a bend as sharp as one, m."""
    length = curves.lengths(ring)
    angle = np.abs(np.roll(curves.corner_angles(ring), -1)) > _CORNER
    bend = (np.abs(curves.turns(ring)) > _CORNER) & (length < _CORNER_SIZE)
    sharp = np.flatnonzero(angle | bend)
    if not len(sharp):
        return float(length.sum())
    turned = np.roll(np.where(bend, 0.0, length), -int(sharp[0]) - 1)
    ends = np.roll(angle | bend, -int(sharp[0]) - 1)
    way = np.cumsum(turned)[ends]
    return float(np.diff(way, prepend=0.0).max())


def _leaves_room(ring: Curve, contour: Contour, speed: float, planned: pipeline.Planned, parts: list[Any]) -> bool:
    """Whether a quarter of a circle of the smallest radius on which the tool can go so fast fits anywhere."""
    program = planned.program
    robot, where = program.robot, program.placement
    ends = np.cumsum(curves.lengths(ring))
    at = (np.arange(_PLACES) + 0.5) * ends[-1] / _PLACES
    segment = np.minimum(np.searchsorted(ends, at), len(ends) - 1)
    place, heading = curves.evaluate(ring, segment, at - (ends - curves.lengths(ring))[segment])
    acceleration, jerk = _ability(robot, where, place.mean(axis=0))
    run_up = 0.5 * speed * (speed / acceleration + acceleration / jerk)
    if acceleration**2 / jerk > speed:
        run_up = speed * np.sqrt(speed / jerk)
    radius = max(speed**2 / acceleration, np.sqrt(speed**3 / jerk), 2.0 * run_up / np.pi)
    side = (1.0 if contour.is_hole else -1.0) * (1.0 if curves.signed_area(ring) > 0.0 else -1.0)
    back = np.linspace(0.0, 0.5 * np.pi, 20)
    normal = side * np.stack([-np.sin(heading), np.cos(heading)], axis=1)
    tangent = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    ways = place[:, None] - radius * np.sin(back)[:, None] * tangent[:, None]
    ways = ways + radius * (1.0 - np.cos(back))[:, None] * normal[:, None]
    lines = shapely.linestrings(ways)
    free = np.min([shapely.distance(lines, part) for part in parts], axis=0) >= 0.5 * program.process.kerf - 2e-6
    cos, sin = np.cos(where.rotation), np.sin(where.rotation)
    machine = ways.reshape(-1, 2) @ np.array([[cos, sin], [-sin, cos]]) + (where.x, where.y)
    inside = (robot.workspace.excess(machine) <= 0.0).reshape(len(ways), -1).all(axis=1)
    return bool((free & inside).any())


def _ability(robot: Robot, where: Placement, place: Array) -> tuple[float, float]:
    """The acceleration and the jerk that the joints allow at a place, in the worst direction."""
    cos, sin = np.cos(where.rotation), np.sin(where.rotation)
    x, y = np.array([[cos, -sin], [sin, cos]]) @ place + (where.x, where.y)
    needed = np.linalg.norm(robot.inverse_jacobian([[x, y, where.z]])[0, :, :2], axis=1)
    acceleration = min(float(np.min(robot.joints.max_acceleration / needed)), robot.tool.max_acceleration)
    jerk = np.inf if robot.joints.max_jerk is None else float(np.min(robot.joints.max_jerk / needed))
    return acceleration, jerk


def _reason(lead: Array, allowed: float, share: float) -> str:
    """Why the speed that is ``allowed``, m/s, is not reached, by the speeds on the lead-in, (N,) m/s."""
    if not len(lead):
        return "it is pierced on the contour"
    if lead.max() < REACHED * allowed:
        return "it does not come up to the speed on the lead-in"
    if share < REACHED:
        return "it slows down where the lead-in goes over into the contour"
    return "it slows down more than a lap just behind the start"


def _why(number: int, planned: pipeline.Planned, share: float, reason: str) -> str:
    return f"{planned.drawing.file}, contour {number}: {100.0 * share:.0f} % of the speed, {reason}"


def measure(index: int, seed: int) -> tuple[list[Begun], float, float, bool, str]:
    """A sheet: how its cuts begin, how deep the beam burns a part, m, and how much, m2, and the verifier's word."""
    chance = np.random.default_rng([seed, index])
    name, feed, lead = ROBOTS[index % len(ROBOTS)], FEEDS[index % len(FEEDS)], SHAPES[index // 2 % 2]
    robot = robot_of(name)
    reach = robot.workspace.radius or 0.5 * min(robot.workspace.width or 1.0, robot.workspace.depth or 1.0)
    lines = sheet(chance, min(1.1e3 * reach, 220.0))
    process = replace(
        load_process("steel-1mm-fibre"),
        kerf=float(chance.choice([0.1e-3, 0.15e-3, 0.3e-3])),
        feed=feed,
        lead_in=Lead(lead),
        lead_out=Lead(lead),
        overcut=float(chance.choice([0.0, 0.3e-3, 1e-3])),
        pierce_time=0.05,
    )
    title = f"sheet {index} ({name}, {1e3 * feed:.0f} mm per s, {lead})"
    planned = pipeline.plan(title, data=content(lines), robot=robot, process=process, what_if=False, jobs=1)
    parts = finished(planned.drawing.contours)
    kinds = {one.number: lines[one.number - 1].kind for one in planned.drawing.contours}
    deep, area = burnt(planned, parts)
    wrong = ", ".join(check.name for check in planned.report.checks if not check.passed and not check.warns)
    return begun(planned, kinds, parts), deep, area, planned.report.passed, f"{title}: {wrong}"


def cost(counts: tuple[int, ...]) -> Iterator[tuple[int, float]]:
    """How many contours `approaches` was asked for, and seconds."""
    robot = robot_of("irb360-1600")
    process: Process = replace(load_process("steel-1mm-fibre"), lead_in=Lead("arc"), lead_out=Lead("arc"))
    where = Placement(0.0, 0.0, 0.0, robot.workspace.sheet_z)
    chance = np.random.default_rng(1)
    drawn = [placed(KINDS[index % 6], 7.0, (0.0, 0.0), chance).vertices for index in range(60)]
    shapes = [Contour(1, Curve(points=1e-3 * one[:, :2], bulges=one[:, 2]), "CUT", ("0",), 0, None) for one in drawn]
    paths = [kerf.offset([one], kerf=process.kerf).cuts[0] for one in shapes]
    for count in counts:
        across = int(np.ceil(np.sqrt(count)))
        contours, cuts = [], []
        for number in range(1, count + 1):
            shift = 0.01 * (number % across - 0.5 * across), 0.01 * (number // across - 0.5 * across)
            own, path = shapes[number % 60], paths[number % 60]
            contours.append(replace(own, number=number, curve=curves.transform(own.curve, shift=shift)))
            cuts.append(replace(path, contour=number, curve=curves.transform(path.curve, shift=shift)))
        reach = Reach(robot, where)
        start = time.perf_counter()
        waste = Waste(contours, kerf=process.kerf, room=reach.area())
        approaches(cuts, contours, process=process, waste=waste, able=reach.able, tick=reach.tick)
        yield count, time.perf_counter() - start


def show(found: list[Begun]) -> None:
    """Print a line for every kind, and one for all."""
    print(f"{'kind':<20} {'all':>4} {'reached':>8} {'room':>5} {'of these':>9} {'at feed':>8}")
    rows = sorted({(one.kind, one.hole) for one in found})
    for kind, hole in [*rows, ("all", False)]:
        own = [one for one in found if kind == "all" or (one.kind, one.hole) == (kind, hole)]
        room = [one for one in own if not one.lacking]
        reached = sum(one.share >= REACHED for one in room)
        name = kind if kind == "all" or kind == "tiny hole" else f"{kind}, {'hole' if hole else 'outline'}"
        part = 100.0 * reached / max(len(room), 1)
        at_feed = sum(one.at_feed >= REACHED for one in own)
        print(f"{name:<20} {len(own):>4} {reached:>8} {len(room):>5} {part:>8.1f}% {at_feed:>8}")
    for part in (0.9, REACHED, ALMOST):
        counted = [one for one in found if not one.lacking or one.share >= part]
        reached = sum(one.share >= part for one in counted)
        edge = sum(one.lacking.startswith("no edge") and one.share < part for one in found)
        every = 100.0 * reached / (len(counted) + edge)
        print(
            f"{100.0 * part:.0f} % of the speed of the flying lap: reached by {reached} of {len(counted)} with room, "
            f"{100.0 * reached / max(len(counted), 1):.1f} %; {every:.1f} % with those counted that have no long edge"
        )


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--contours", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="the sheet to begin with")
    parser.add_argument("--no-cost", action="store_true", help="do not measure what leads cost")
    chosen = parser.parse_args()
    found, worst, area, failed = list[Begun](), 0.0, 0.0, list[str]()
    start = time.perf_counter()
    for index in range(chosen.first, chosen.first + chosen.contours // PER_SHEET):
        begins, deep, burns, passed, title = measure(index, chosen.seed)
        found += begins
        worst, area = max(worst, deep), area + burns
        failed += [] if passed else [title]
    show(found)
    print("\nnot reached:")
    for one in sorted((one for one in found if one.why), key=lambda one: one.share):
        print(f"  {one.why} ({one.kind}, {'hole' if one.hole else 'outline'})")
    print(
        f"\nburnt beyond the tolerances: {1e12 * area:.0f} um2; the tool came {1e6 * worst:.1f} um too near to a part"
    )
    print(f"verified: {failed or 'all'}; {time.perf_counter() - start:.0f} s")
    if not chosen.no_cost:
        for count, seconds in cost((2000, 10000)):
            print(f"leads of {count} contours: {seconds:.2f} s, {1e3 * seconds / count:.2f} ms each")


if __name__ == "__main__":
    main()
