"""Outlines that share edges, each of which one cut serves: which cuts do not go around, and what is cut beside them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple

import numpy as np
import shapely

from deltacam.model import Array, Contour
from deltacam.verification.evidence import MOVING_KINDS, Evidence
from deltacam.verification.near import Lines
from deltacam.verification.runs import Run
from deltacam.verification.way import motion

BETWEEN_TICKS: Final = 0.5e-6
"""How far ways may be off between ticks, m."""

_SHORTEST: Final = 1e-3  # m; shorter edges are not shared


class Beside(NamedTuple):
    """What is cut along the path of another outline.

    Attributes:
        contour: that it is a cut of.
        run: None where the program says that it was cut before a stop.
        ways: of the beam, (K, 2) m each.
    """

    contour: Contour
    run: Run | None
    ways: tuple[Array, ...]


class Outline(NamedTuple):
    """A contour that may share edges.

    Attributes:
        contour: an outline that is cut.
        rings: its path, (K, 2) m each.
        runs: that are said to be of it.
    """

    contour: Contour
    rings: tuple[Array, ...]
    runs: tuple[Run, ...]


def open_runs(evidence: Evidence, outline: Outline) -> tuple[Run, ...]:
    """The runs of an outline that do not go around any of its rings, tabs included.

    Without edges that are shared there are none: what leaves a part of its ring out is wrong then.
    """
    if not evidence.program.process.common_edges or not outline.rings:
        return ()
    return tuple(run for run in outline.runs if not any(_goes_around(evidence, run, ring) for ring in outline.rings))


def _goes_around(evidence: Evidence, run: Run, ring: Array) -> bool:
    """Whether a run leaves out no more of a ring than loops at its corners, and what is too short to be shared."""
    process = evidence.program.process
    near = process.tolerance + process.chord_tolerance
    path = Lines([ring], closed=True)
    way = Lines([motion(evidence, run.first, run.end, BETWEEN_TICKS)], closed=False)
    far = way.distance(path.samples, exact_above=near / 2.0) > near
    if far.all():
        return False
    first = int(np.argmin(far))  # a sample that is near, so that no stretch lies across the ends
    far, share = np.roll(far, -first), np.roll(path.share, -first)
    longest = np.bincount(np.cumsum(~far)[far], share[far], minlength=1).max()
    return bool(longest < _SHORTEST + 0.5 * np.pi * process.kerf)


def burnt(evidence: Evidence, run: Run) -> tuple[Array, ...]:
    """The ways of a run along which the laser is on, (K, 2) m each."""
    return tuple(motion(evidence, first, end, BETWEEN_TICKS) for first, end in evidence.stretches(run, MOVING_KINDS))


def beside(evidence: Evidence, outlines: Sequence[Outline]) -> Mapping[int, tuple[Beside, ...]]:
    """What is cut along the paths of outlines that have cuts which do not go around, by their numbers.

    In a program that goes on after a stop the contours without a cut were cut before.
    """
    some = [outline for outline in outlines if open_runs(evidence, outline)]
    if not some:
        return {}
    process = evidence.program.process
    cuts = [Beside(one.contour, run, burnt(evidence, run)) for one in outlines for run in one.runs]
    if evidence.program.from_contour is not None:
        before = [one for one in outlines if not one.runs]
        cuts += [Beside(one.contour, None, tuple(map(_closed, one.rings))) for one in before]
    lines = np.array([shapely.multilinestrings([*map(shapely.LineString, cut.ways)]) for cut in cuts], dtype=object)
    paths = np.array([shapely.multilinestrings([*map(_ring, one.rings)]) for one in some], dtype=object)
    reach = 0.5 * process.kerf + 2.0 * (process.tolerance + process.chord_tolerance)
    which, cut = shapely.STRtree(lines).query(paths, predicate="dwithin", distance=reach)
    found: dict[int, tuple[Beside, ...]] = {one.contour.number: () for one in some}
    for of, index in sorted(zip(which.tolist(), cut.tolist(), strict=True)):
        number = some[of].contour.number
        if cuts[index].contour.number != number:
            found[number] += (cuts[index],)
    return found


def _closed(ring: Array) -> Array:
    return np.vstack([ring, ring[:1]])


def _ring(ring: Array) -> shapely.LineString:
    return shapely.LineString(_closed(ring))
