"""The program: a joint setpoint per tick, what the laser does, and everything that is needed to check it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from deltacam.model import (
    DEFAULT_JOINING,
    Array,
    Block,
    Drawing,
    IntArray,
    Mode,
    Placement,
    Process,
    Selection,
    readonly,
)
from deltacam.robot.robot import Robot

TICK_COLUMN: Final = "tick column: "
"""What the messages of `Program.integrity` start with that are about missing, repeated or misplaced ticks."""

MAX_ANGLE: Final = 1e3
"""Largest joint angle, rad: up to here 12 decimals determine the angle, and no difference of angles overflows."""


@dataclass(frozen=True, slots=True)
class DrawingRef:
    """Which drawing a program was planned from, and how it was read; the rules are those of the process.

    Attributes:
        file: the drawing's name without its folder.
        sha256: of the drawing's bytes, hexadecimal.
        metres_per_unit: the scale that was applied to the drawing's numbers.
        joining: largest distance between ends that were joined, m.
        layers: patterns; where there are any, entities on other layers were ignored.
        ignored_layers: patterns; entities on these layers were ignored.
        accept_loss: whether it was planned although parts of a damaged file could not be read.
    """

    file: str
    sha256: str
    metres_per_unit: float
    joining: float = DEFAULT_JOINING
    layers: tuple[str, ...] = ()
    ignored_layers: tuple[str, ...] = ()
    accept_loss: bool = False

    @classmethod
    def of(cls, drawing: Drawing) -> DrawingRef:
        """The reference to a drawing as it was read."""
        selection = drawing.selection
        return cls(
            file=drawing.file,
            sha256=drawing.sha256,
            metres_per_unit=drawing.metres_per_unit,
            joining=selection.joining,
            layers=selection.layers,
            ignored_layers=selection.ignored_layers,
            accept_loss=selection.accept_loss,
        )


@dataclass(frozen=True, slots=True, eq=False)
class Program:
    """A setpoint every 1 / rate_hz seconds. Row k is the setpoint of tick k; its power and block hold until tick k + 1.

    The blocks and the block column are kept as they were given; whether they agree is for `verify` to say.

    Attributes:
        robot: the machine that it is for.
        placement: where the sheet frame lies in the machine frame.
        process: how the material is cut.
        drawing: what it was planned from.
        mode: what it is for.
        blocks: the stretches of the program, in order.
        q: joint angles, (N, 3) rad, N >= 1; read-only.
        power: of the laser's rated power, 0 = off, (N,); read-only.
        block: index into ``blocks``, (N,); read-only.
        from_contour: the contour that it goes on with after a stop; None where it begins with the first one.
        integrity: what is wrong with the file that it was read from, one message each; empty for a new program.

    Raises:
        ValueError: arrays of other shapes, of different length or empty, a value that is not finite, or a joint angle
            beyond `MAX_ANGLE`.
    """

    robot: Robot
    placement: Placement
    process: Process
    drawing: DrawingRef
    mode: Mode
    blocks: tuple[Block, ...]
    q: Array
    power: Array
    block: IntArray
    from_contour: int | None = None
    integrity: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "q", readonly(self.q, columns=3))
        object.__setattr__(self, "power", readonly(self.power))
        object.__setattr__(self, "block", _indices(self.block))
        object.__setattr__(self, "blocks", tuple(self.blocks))
        object.__setattr__(self, "integrity", tuple(self.integrity))
        if not 1 <= len(self.q) == len(self.power) == len(self.block):
            raise ValueError(f"{len(self.q)} setpoints, {len(self.power)} powers and {len(self.block)} block indices")
        if np.abs(self.q).max() > MAX_ANGLE:
            raise ValueError(f"a joint angle is {np.abs(self.q).max():.6g} rad; at most {MAX_ANGLE:g} is possible")

    @property
    def selection(self) -> Selection:
        """How the drawing was read, and is to be read again for a check."""
        return Selection(
            rules=self.process.rules,
            open=self.process.open,
            layers=self.drawing.layers,
            ignored_layers=self.drawing.ignored_layers,
            joining=self.drawing.joining,
            accept_loss=self.drawing.accept_loss,
        )

    @property
    def rate_hz(self) -> float:
        """Setpoints per second."""
        return self.robot.controller.rate_hz

    @property
    def duration(self) -> float:
        """The time from the first setpoint to the last, s."""
        return (len(self.q) - 1) / self.rate_hz


def _indices(values: npt.ArrayLike) -> IntArray:
    """A read-only integer copy of ``values`` (N,).

    Raises:
        ValueError: another shape, or not whole numbers.
    """
    array = np.array(values)
    if array.ndim != 1 or array.dtype.kind not in "iu":
        raise ValueError(f"expected whole numbers of shape (N,), got {array.dtype} of shape {array.shape}")
    array = array.astype(np.int64)
    array.flags.writeable = False
    return array
