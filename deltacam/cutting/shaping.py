"""What happens to the way along a cut once its leads are there: loops at its corners, and tabs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Final

import numpy as np
import shapely

from deltacam.cutting.leads import sizes
from deltacam.cutting.leads.places import waste_side
from deltacam.cutting.leads.reach import Reach
from deltacam.cutting.loops import Side, with_loops
from deltacam.cutting.tabs import with_tabs
from deltacam.cutting.waste import Waste
from deltacam.geometry import curve as curves
from deltacam.model import Array, BlockKind, Contour, Curve, Cut, Finding, Operation, Process, Stretch

BLENDED: Final = 0.4
"""Part of the tolerance that a blend between a lead or a loop and the cut is taken to have."""

_ENDS: Final = frozenset({BlockKind.LEAD_IN, BlockKind.OVERCUT, BlockKind.LEAD_OUT})
_FLATTENING: Final = 1e-5  # m
_MOST_FINDINGS: Final = 5

Shaped = tuple[tuple[Cut, ...], tuple[Finding, ...]]


def looped(cuts: Sequence[Cut], contours: Sequence[Contour], *, process: Process, waste: Waste, reach: Reach) -> Shaped:
    """The cuts with loops at their outer corners, where the process says so for corners.

    Args:
        cuts: with their leads.
        contours: of the drawing.
        process: says which corners.
        waste: where loops may lie.
        reach: what the robot can do where.
    """
    if process.corner != "loop":
        return tuple(cuts), ()
    drawn = {contour.number: contour for contour in contours}
    done, findings = [], list[Finding]()
    for cut in cuts:
        contour = drawn[cut.contour]
        if not (cut.curve.closed and contour.has_kerf):
            done.append(cut)
            continue
        feed = np.array([cut.feed or process.feed])

        def needed(place: Array, feed: Array = feed) -> float:
            return float(sizes.bend(feed, reach.able(place[None]), BLENDED * process.tolerance)[0])

        side: Side = "left" if waste_side(cut, contour, process.kerf) > 0.0 else "right"
        found = with_loops(
            way_of(cut), contour, side=side, kerf=process.kerf, rule=process.loops, needed=needed, waste=waste
        )
        done.append(replace(cut, way=found.way))
        findings += found.findings
    return tuple(done), _few(findings)


def tabbed(
    cuts: Sequence[Cut],
    contours: Sequence[Contour],
    *,
    process: Process,
    clear: Mapping[int, Sequence[Curve]] = MappingProxyType({}),
) -> Shaped:
    """The cuts with the tabs that the process asks for.

    Args:
        cuts: with their leads and loops.
        contours: of the drawing.
        process: says how many tabs, and how wide.
        clear: by number of contour, edges that no tab may be at: another part is right behind them.
    """
    rule = process.tabs
    if rule is None:
        return tuple(cuts), ()
    drawn = {contour.number: contour for contour in contours}
    lines = np.array([_line(cut) for cut in cuts], dtype=object)
    tree = shapely.STRtree(lines)
    done, findings = [], list[Finding]()
    for index, cut in enumerate(cuts):
        contour = drawn[cut.contour]
        if not (cut.curve.closed and contour.has_kerf):
            done.append(cut)
            continue
        near = tree.query(shapely.buffer(shapely.box(*lines[index].bounds), 2.0 * (rule.width + process.kerf)))
        others = shapely.STRtree(lines[near[near != index]])
        side: Side = "left" if waste_side(cut, contour, process.kerf) > 0.0 else "right"
        edges = clear.get(cut.contour, ())
        found = with_tabs(way_of(cut), contour, side=side, kerf=process.kerf, rule=rule, others=others, clear=edges)
        done.append(replace(cut, way=found.way))
        findings += found.findings
    return tuple(done), _few(findings)


def repeated(cuts: Sequence[Cut], *, process: Process) -> tuple[Cut, ...]:
    """The cuts run as often as the process says: round and round, or to and fro where they are open."""
    if process.passes == 1:
        return tuple(cuts)
    return tuple(_repeated(cut, process.passes) if cut.operation is Operation.CUT else cut for cut in cuts)


def _repeated(cut: Cut, passes: int) -> Cut:
    if not cut.curve.closed:
        to = cut.way or (Stretch(BlockKind.CUT, cut.curve),)
        fro = tuple(replace(stretch, curve=curves.reverse(stretch.curve)) for stretch in reversed(to))
        return replace(cut, way=tuple(stretch for number in range(passes) for stretch in (fro if number % 2 else to)))
    way = way_of(cut)
    around = [index for index, stretch in enumerate(way) if stretch.kind not in _ENDS]
    first, end = around[0], around[-1] + 1
    return replace(cut, way=(*way[:first], *(way[first:end] * passes), *way[end:]))


def way_of(cut: Cut) -> tuple[Stretch, ...]:
    """The way of the tool along a closed cut."""
    return cut.way or (Stretch(BlockKind.CUT, curves.opened(cut.curve)),)


def _line(cut: Cut) -> shapely.LineString:
    """All that is cut on the way of a cut."""
    way: Curve = curves.chain([stretch.curve for stretch in cut.way]) if cut.way else cut.curve
    points = curves.flatten(way, _FLATTENING)[0]
    return shapely.LineString(np.concatenate([points, points[:1]]) if way.closed else points)


def _few(findings: Sequence[Finding]) -> tuple[Finding, ...]:
    """The first findings, and how many more there are."""
    if len(findings) <= _MOST_FINDINGS:
        return tuple(findings)
    left = len(findings) - _MOST_FINDINGS
    more = Finding(
        f"the same goes for {left} more contours", where=findings[_MOST_FINDINGS].where, kind=findings[0].kind
    )
    return (*findings[:_MOST_FINDINGS], more)
