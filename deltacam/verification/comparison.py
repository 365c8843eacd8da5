"""A program beside the drawing that it should cut."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import shapely
from shapely import Polygon

from deltacam.model import Array, Contour, Drawing, Operation, Size
from deltacam.verification.evidence import Evidence
from deltacam.verification.kerf_path import flattened, rings
from deltacam.verification.near import Lines
from deltacam.verification.runs import Run
from deltacam.verification.sharing import BETWEEN_TICKS, Beside, Outline, beside, open_runs
from deltacam.verification.sizes import size
from deltacam.verification.way import motion

_RIM: Final = 2e-3  # m, more than the way of a tick


@dataclass(frozen=True, slots=True, eq=False)
class Target:
    """A contour of the drawing, its path, and what the program does there.

    Attributes:
        contour: of the drawing.
        rings: its kerf path, or the line itself, (K, 2) m each, in the sheet frame; closed like the contour.
        path: the same, for distances; None where there is no ring.
        runs: the runs of the program that say they do with it what the drawing wants.
        open_runs: those of them that are left of an outline which shares edges, and do not go around.
        beside: where there are such, what is cut along its path for other outlines.
    """

    contour: Contour
    rings: tuple[Array, ...]
    path: Lines | None
    runs: tuple[Run, ...]
    open_runs: tuple[Run, ...] = ()
    beside: tuple[Beside, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Comparison:
    """A program beside the drawing that it should cut.

    Attributes:
        evidence: of the program.
        drawing: read by the checker itself.
        targets: one per contour, in the drawing's order.
        sizes: what is left of every closed contour that is cut, in the same order.
        parts: what is to stay of the sheet, as `finished_parts` finds it.
    """

    evidence: Evidence
    drawing: Drawing
    targets: tuple[Target, ...]
    sizes: tuple[Size, ...]
    parts: tuple[shapely.Geometry, ...]

    @property
    def due(self) -> tuple[Target, ...]:
        """The targets that the program is to cut: all, but those before the contour that it goes on with."""
        resumes = self.evidence.program.from_contour is not None
        return tuple(target for target in self.targets if target.runs or not resumes)


def compare(evidence: Evidence, drawing: Drawing) -> Comparison:
    """Put the cuts of a program beside the contours of a drawing."""
    runs: defaultdict[tuple[int | None, Operation], list[Run]] = defaultdict(list)
    for run in evidence.runs:
        runs[run.contour, run.operation].append(run)
    process, targets, sizes = evidence.program.process, [], []
    kerf, exact_above = process.kerf, (process.tolerance + process.chord_tolerance) / 2.0
    lines = [Outline(one, rings(one, kerf), tuple(runs[one.number, one.operation])) for one in drawing.contours]
    near = beside(evidence, [one for one in lines if one.contour.has_kerf and not one.contour.is_hole])
    for outline in lines:
        contour, found, done = outline
        targets.append(_target(evidence, outline, near))
        if contour.has_kerf and found and done:
            ways = [motion(evidence, run.begin, run.end, BETWEEN_TICKS) for run in done]
            ways += [way for cut in targets[-1].beside for way in cut.ways]
            sizes.append(size(contour, found, ways, kerf=kerf, exact_above=exact_above))
    return Comparison(evidence, drawing, tuple(targets), tuple(sizes), finished_parts(drawing))


def _target(evidence: Evidence, outline: Outline, beside: Mapping[int, tuple[Beside, ...]]) -> Target:
    contour, found, done = outline
    path = Lines(found, closed=contour.curve.closed) if found else None
    if contour.number not in beside:
        return Target(contour, found, path, done)
    return Target(contour, found, path, done, open_runs(evidence, outline), beside[contour.number])


def finished_parts(drawing: Drawing) -> tuple[shapely.Geometry, ...]:
    """What is to stay of the sheet: every outline that is cut, without the holes directly in it.

    Of a part whose outline is not cut, such as one with a gap, its holes alone tell: what is right around them stays.
    """
    cut = {contour.number: contour for contour in drawing.contours if contour.has_kerf}
    lines = {number: line for number, contour in cut.items() if len(line := flattened(contour)) > 2}
    holes: defaultdict[int | None, list[Array]] = defaultdict(list)
    for number, line in lines.items():
        if cut[number].is_hole:
            holes[cut[number].parent].append(line)
    parts = [Polygon(line, holes[number]) for number, line in lines.items() if not cut[number].is_hole]
    alone = [line for parent, found in holes.items() if parent not in lines for line in found]
    if alone:
        burnt = shapely.union_all([Polygon(line) for found in holes.values() for line in found])
        parts += [Polygon(line).buffer(_RIM).difference(burnt) for line in alone]
    return tuple(parts)
