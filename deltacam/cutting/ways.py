"""From the cuts of a drawing to the ways of the tool along them: leads, the order, loops, tabs, slow bends, passes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from deltacam.cutting import feeds
from deltacam.cutting.leads.approaches import Approach, approaches, begun
from deltacam.cutting.leads.reach import Reach
from deltacam.cutting.leads.waste import Waste
from deltacam.cutting.order import order
from deltacam.cutting.shaping import looped, repeated, tabbed
from deltacam.model import Array, Contour, Cut, Finding, Placement, Process

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot


class Ways(NamedTuple):
    """The cuts in order, each with the way of the tool, and what a person should know about them."""

    cuts: tuple[Cut, ...]
    findings: tuple[Finding, ...]


def ways(
    cuts: Sequence[Cut], contours: Sequence[Contour], *, process: Process, robot: Robot, placement: Placement
) -> Ways:
    """Order the cuts and give each its leads.

    Args:
        cuts: with their kerf, sheet frame.
        contours: of the drawing.
        process: says what leads there are.
        robot: the machine, whose park position is where the program starts and ends.
        placement: of the sheet frame.
    """
    reach = Reach(robot, placement)
    cuts = feeds.in_holes(cuts, contours, process=process)
    parents = {contour.number: contour.parent for contour in contours}
    ordered = order(cuts, parents=parents, start=_to_sheet(robot.workspace.park, placement))
    waste = Waste(contours, kerf=process.kerf, is_allowed=reach.is_allowed)
    found, findings = approaches(ordered, contours, process=process, waste=waste, able=reach.able, tick=reach.tick)
    done: list[Cut] = []
    place = np.array(_to_sheet(robot.workspace.park, placement))
    for cut, choices in zip(ordered, found, strict=True):
        nearest = min(choices, key=lambda one: _away(cut, one, place), default=None)
        done.append(cut if nearest is None else begun(cut, nearest, process=process, tick=reach.tick))
        place = done[-1].way[-1].curve.ends[-1] if done[-1].way else done[-1].curve.ends[-1]
    with_loops, of_loops = looped(done, contours, process=process, waste=waste, reach=reach)
    with_tabs, of_tabs = tabbed(with_loops, contours, process=process)
    slowed = feeds.in_bends(with_tabs, contours, process=process)
    return Ways(repeated(slowed, process=process), (*findings, *of_loops, *of_tabs))


def _away(cut: Cut, approach: Approach, place: Array) -> float:
    begin = cut.curve.points[approach.segment] if approach.lead_in is None else approach.lead_in.points[0]
    return float(np.hypot(*(begin - place)))


def _to_sheet(place: tuple[float, float], where: Placement) -> tuple[float, float]:
    x, y = place[0] - where.x, place[1] - where.y
    cos, sin = np.cos(where.rotation), np.sin(where.rotation)
    return float(cos * x + sin * y), float(cos * y - sin * x)
