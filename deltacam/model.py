"""The frozen data that flows between the stages.

Everything is SI: metres, radians, seconds. Arrays are read-only copies. There is no algorithm here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any, Final, Literal

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]


def readonly(values: npt.ArrayLike, *, columns: int | None = None) -> Array:
    """A read-only float copy of ``values``: (N,), or (N, columns) where ``columns`` is given.

    Raises:
        ValueError: another shape, or a value that is not finite.
    """
    array = np.array(values, dtype=np.float64)
    if columns is None and array.ndim != 1:
        raise ValueError(f"expected shape (N,), got {array.shape}")
    if columns is not None and (array.ndim != 2 or array.shape[1] != columns):
        raise ValueError(f"expected shape (N, {columns}), got {array.shape}")
    if not np.isfinite(array).all():
        raise ValueError("values must be finite")
    array.flags.writeable = False
    return array


STRAIGHT: Final = 1e-12
"""Bulge of an arc that is a line: over a chord of 1 m it would rise by half a picometre."""


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """Lines and circular arcs joined end to end in the sheet plane.

    Segment i runs from ``points[i]`` to the next point; its bulge is the tangent of a quarter of the angle that it
    turns through: 0 for a line, 1 for half a circle counter-clockwise, -1 for half a circle clockwise. A bulge below
    ``STRAIGHT`` is kept as 0.

    Attributes:
        points: (N, 2) m; a closed curve does not repeat its first point.
        bulges: (N,) for a closed curve, (N - 1,) for an open one.
        closed: whether the last point joins the first.
    """

    points: Array
    bulges: Array
    closed: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", readonly(self.points, columns=2))
        bulges = np.asarray(self.bulges, dtype=np.float64)
        object.__setattr__(self, "bulges", readonly(np.where(np.abs(bulges) < STRAIGHT, 0.0, bulges)))
        if len(self.bulges) != len(self.points) - (not self.closed):
            raise ValueError(f"{len(self.points)} points do not go with {len(self.bulges)} bulges")

    @property
    def starts(self) -> Array:
        """The first point of every segment, (M, 2) m."""
        return self.points if self.closed else self.points[:-1]

    @property
    def ends(self) -> Array:
        """The last point of every segment, (M, 2) m."""
        return np.roll(self.points, -1, axis=0) if self.closed else self.points[1:]


class Outcome(StrEnum):
    """What became of an entity of the drawing."""

    CUT = "cut"
    MERGED = "merged"
    IGNORED = "ignored"
    LOST = "lost"


@dataclass(frozen=True, slots=True)
class LedgerEntry:
    """What became of one entity of the drawing, and why.

    Attributes:
        handle: the DXF handle, with a counter where the file gives none.
        kind: the DXF type: LINE, ARC, TEXT, ...
        layer: the layer it is drawn on.
        block: the names of the blocks that hold it, outermost first, joined by "/"; empty in the modelspace.
        outcome: cut, merged, ignored or lost.
        reason: why it is not cut, in words; empty when it is.
        contour: the number of the contour that it became part of, if any.
    """

    handle: str
    kind: str
    layer: str
    block: str
    outcome: Outcome
    reason: str = ""
    contour: int | None = None


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that a person should know, but that does not stop the work."""

    what: str
    where: str = ""
    hint: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Contour:
    """One closed line of the drawing.

    Attributes:
        number: counts from 1 in the order of the file; the same in every run.
        curve: closed, counter-clockwise, in the sheet frame, m.
        layer: the layer of its first entity.
        handles: the handles of its entities in the order of the curve.
        depth: how many contours contain it: even for outlines of material, odd for holes.
        parent: the number of the contour directly around it.
    """

    number: int
    curve: Curve
    layer: str
    handles: tuple[str, ...]
    depth: int = 0
    parent: int | None = None

    @property
    def where(self) -> str:
        """How messages name it: ``contour 3 (layer CUT, #2F)``."""
        return f"contour {self.number} (layer {self.layer}, #{self.handles[0]})"

    @property
    def is_hole(self) -> bool:
        """Whether the material is outside it."""
        return self.depth % 2 == 1


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """What was read from a drawing.

    Attributes:
        file: the file's name without its folder.
        sha256: of the file's bytes, hexadecimal.
        metres_per_unit: the scale that was applied to the file's numbers.
        unit: its name, and where it is from: "mm (header)", "in (--units)".
        contours: the closed contours, numbered from 1.
        ledger: one entry per entity.
        findings: what a person should know.
        conversion_error: largest distance of the contours from the exact geometry of the file, m.
    """

    file: str
    sha256: str
    metres_per_unit: float
    unit: str
    contours: tuple[Contour, ...]
    ledger: tuple[LedgerEntry, ...]
    findings: tuple[Finding, ...] = ()
    conversion_error: float = 0.0


Corner = Literal["round", "stop"]


@dataclass(frozen=True, slots=True)
class Process:
    """How a material is cut.

    Attributes:
        name: what the summary calls it.
        source: where the values are from.
        material: for people.
        thickness: m.
        kerf: width of the cut, m, >= 0.
        feed: speed along the contour, m/s, > 0.
        power: 0 < power <= 1 of the laser's rated power while cutting and piercing.
        pierce_time: rest with the laser on before a cut, s, >= 0.
        tolerance: largest distance of the planned path from the exact kerf path, m, > 0.
        chord_tolerance: how far the motion may leave the planned path between ticks, m, > 0.
        corner: whether sharp corners are rounded within the tolerance or stopped at.
        gas: for people.
    """

    name: str
    source: str
    material: str
    thickness: float
    kerf: float
    feed: float
    power: float
    pierce_time: float
    tolerance: float = 20e-6
    chord_tolerance: float = 20e-6
    corner: Corner = "round"
    gas: str = ""


@dataclass(frozen=True, slots=True)
class Placement:
    """Where the sheet frame lies in the base frame: base xy = Rz(rotation) * sheet xy + (x, y), at height z."""

    x: float
    y: float
    rotation: float
    z: float


@dataclass(frozen=True, slots=True, eq=False)
class Cut:
    """One closed path of the beam's centre.

    Attributes:
        contour: the number of the drawn contour.
        layer: of the drawn contour.
        handles: of the drawn contour.
        curve: closed, in the sheet frame; it starts and ends at ``curve.points[0]``.
    """

    contour: int
    layer: str
    handles: tuple[str, ...]
    curve: Curve


class BlockKind(StrEnum):
    """What a stretch of the program does."""

    RAPID = "rapid"
    PIERCE = "pierce"
    LEAD_IN = "lead_in"
    CUT = "cut"
    LEAD_OUT = "lead_out"


class Mode(StrEnum):
    """What a program is for: to cut, the same motion with the laser off, or the bounding box with the laser off."""

    CUT = "cut"
    DRY_RUN = "dry_run"
    FRAME = "frame"


@dataclass(frozen=True, slots=True)
class Block:
    """A stretch of the program from tick ``first`` to tick ``last``, both included."""

    kind: BlockKind
    first: int
    last: int
    contour: int | None = None
    layer: str = ""
    handles: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Check:
    """One thing that was checked.

    Attributes:
        name: in words, the same in every report.
        passed: whether the worst value is within the limit.
        worst: the worst value, in ``unit``; None where there was nothing to measure.
        limit: what it may be at most (or at least, as the name says), in ``unit``.
        unit: of both.
        tick: where the worst value is.
        where: the place, contour or joint in words.
    """

    name: str
    passed: bool
    worst: float | None = None
    limit: float | None = None
    unit: str = ""
    tick: int | None = None
    where: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Report:
    """What a check of a program found.

    Attributes:
        checks: in a fixed order.
        summary: figures for people, by name.
        ledger: of the drawing, where one was given.
        findings: what a person should know.
    """

    checks: tuple[Check, ...]
    summary: Mapping[str, Any]
    ledger: tuple[LedgerEntry, ...] = ()
    findings: tuple[Finding, ...] = field(default=())

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return all(check.passed for check in self.checks)
