"""From the cuts of a drawing to the ways of the tool along them, in order.

Edges that two outlines share are cut once where the process says so. Leads say where every closed cut may begin, the
order chooses among these places, and then loops, tabs, slow bends and further passes are put on the way that was
chosen.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from deltacam.cutting import feeds
from deltacam.cutting.leads.approaches import Approach, approaches, begun, has_leads
from deltacam.cutting.leads.reach import Reach
from deltacam.cutting.leads.starts import given_starts
from deltacam.cutting.order import Ordered, effort_for, order
from deltacam.cutting.shaping import looped, repeated, tabbed
from deltacam.cutting.shared import SHORTEST, Shared, share_edges
from deltacam.cutting.waste import Waste
from deltacam.model import Array, Contour, Cut, Finding, Placement, Process, Search
from deltacam.robot.rapid import Rapids

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

_APART: Final = 0.5
"""Part of the tolerance that the paths of two outlines may be apart where one cut serves both."""

_WITHIN: Final = 0.1
"""How much less than estimated a rapid may take: what has to wait for heat waits so much longer."""


class Ways(NamedTuple):
    """The cuts in order, each with the way of the tool, and what a person should know about them."""

    cuts: tuple[Cut, ...]
    findings: tuple[Finding, ...]


class _Spot(NamedTuple):
    """Where the tool comes to, and where it leaves, for one approach."""

    begin: tuple[float, float]
    end: tuple[float, float]


def ways(
    cuts: Sequence[Cut],
    contours: Sequence[Contour],
    *,
    process: Process,
    robot: Robot,
    placement: Placement,
    search: Search = Search(),  # noqa: B008 - it cannot be changed
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> Ways:
    """Give the cuts their leads, order them, and shape the way along each.

    Args:
        cuts: with their kerf, sheet frame.
        contours: of the drawing.
        process: says what leads, loops and tabs there are.
        robot: the machine, whose park position is where the program starts and ends.
        placement: of the sheet frame.
        search: for the order, and where cuts begin.
        progress: is told how far the order is.

    Raises:
        InfeasibleError: a cut should begin where there is none.
    """
    reach = Reach(robot, placement)
    waste = Waste(contours, kerf=process.kerf, room=reach.area())
    cuts = feeds.in_holes(cuts, contours, process=process)
    cuts, after, edges, of_edges = _shared(cuts, contours, process)
    choices, of_leads = approaches(
        cuts,
        contours,
        process=process,
        waste=waste,
        able=reach.able,
        tick=reach.tick,
        clear=edges,
        given=given_starts(search.starts, cuts, contours),
    )
    places = [
        [_spot(cut, one, process, reach.tick) for one in several] or None
        for cut, several in zip(cuts, choices, strict=True)
    ]
    found = order(
        cuts,
        parents={contour.number: contour.parent for contour in contours},
        start=_to_sheet(robot.workspace.park, placement),
        cost=Rapids(robot, placement),
        places=places,
        seed=search.seed,
        effort=None if search.time is None else effort_for(search.time, len(cuts)),
        together=search.together,
        heat=process.heat,
        after=after,
        progress=progress,
    )
    led = _with_leads(found, choices, process, reach.tick)
    with_loops, of_loops = looped(led, contours, process=process, waste=waste, reach=reach)
    with_tabs, of_tabs = tabbed(with_loops, contours, process=process, clear=edges)
    slowed = feeds.in_bends(with_tabs, contours, process=process)
    return Ways(repeated(slowed, process=process), (*of_edges, *of_leads, *of_loops, *of_tabs))


def _shared(cuts: Sequence[Cut], contours: Sequence[Contour], process: Process) -> Shared:
    """The cuts with common edges cut once where the process asks for it, and what that takes away from others."""
    if not process.common_edges:
        return Shared(tuple(cuts), {}, {}, ())
    shortest = SHORTEST + 2.0 * process.kerf
    found = share_edges(cuts, contours, kerf=process.kerf, tolerance=_APART * process.tolerance, shortest=shortest)
    left = [cut for cut in found.cuts if cut.contour in found.after and not cut.curve.closed]
    asked = has_leads(process) or process.tabs is not None or process.corner == "loop"
    if not left or not asked:
        return found
    what = f"{len(left)} open cuts are left of contours with shared edges, without leads, loops and tabs: they begin "
    what += "and end in the kerf of another cut"
    return found._replace(findings=(*found.findings, Finding(what, where=left[0].where, kind="common")))


def _with_leads(
    found: Ordered, choices: Sequence[Sequence[Approach]], process: Process, tick: float
) -> tuple[Cut, ...]:
    """The ordered cuts, begun as the order chose, with the time that each waits for heat to spread."""
    done = []
    for cut, index, place, wait in zip(found.cuts, found.index, found.place, found.wait, strict=True):
        led = cut if place is None else begun(cut, choices[index][place], process=process, tick=tick)
        heat = process.heat.time if wait and process.heat is not None else 0.0
        done.append(replace(led, wait=wait + _WITHIN * (heat - wait)) if wait else led)
    return tuple(done)


def _spot(cut: Cut, approach: Approach, process: Process, tick: float) -> _Spot:
    """Where the tool is before and after a cut that is begun by an approach."""
    if approach.lead_in is not None and approach.lead_out is not None:
        return _Spot(_pair(approach.lead_in.points[0]), _pair(approach.lead_out.points[-1]))
    way = begun(cut, approach, process=process, tick=tick).way
    return _Spot(_pair(way[0].curve.points[0]), _pair(way[-1].curve.points[-1]))


def _pair(point: Array) -> tuple[float, float]:
    return float(point[0]), float(point[1])


def _to_sheet(place: tuple[float, float], where: Placement) -> tuple[float, float]:
    x, y = place[0] - where.x, place[1] - where.y
    cos, sin = np.cos(where.rotation), np.sin(where.rotation)
    return float(cos * x + sin * y), float(cos * y - sin * x)
