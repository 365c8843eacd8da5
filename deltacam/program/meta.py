"""The meta object of a program file: everything but the rows, as JSON has it, in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, Final, NamedTuple

from deltacam.errors import ProgramError, RobotError
from deltacam.model import Block, BlockKind, Mode, Placement, Process
from deltacam.program.fields import MAX_WHOLE, Fields
from deltacam.program.process import from_meta as process_from_meta
from deltacam.program.process import to_meta as process_to_meta
from deltacam.program.program import DrawingRef, Program
from deltacam.robot.meta import from_meta as robot_from_meta
from deltacam.robot.meta import to_meta as robot_to_meta
from deltacam.robot.robot import Robot

KEYS: Final = (
    "blocks",
    "drawing",
    "from_contour",
    "mode",
    "placement",
    "process",
    "rate_hz",
    "robot",
    "rows",
    "sha256",
)
_BLOCK_KEYS: Final = tuple(field.name for field in fields(Block))
_DRAWING_KEYS: Final = ("accept_loss", "file", "ignored_layers", "joining_m", "layers", "metres_per_unit", "sha256")
_PLACEMENT_KEYS: Final = ("rotation_rad", "x_m", "y_m", "z_m")
_LARGEST: Final = 1e4  # m, s or m/s: far beyond any machine, and far from where a product could overflow


class Meta(NamedTuple):
    """What the meta object holds, checked; ``rows`` and ``sha256`` are claims about the rows."""

    robot: Robot
    placement: Placement
    process: Process
    drawing: DrawingRef
    mode: Mode
    blocks: tuple[Block, ...]
    from_contour: int | None
    rate_hz: float
    rows: int
    sha256: str


def to_meta(program: Program, *, sha256: str) -> dict[str, Any]:
    """The meta object of ``program`` whose rows have the hash ``sha256``."""
    placement = program.placement
    return {
        "blocks": [_block_to_meta(block) for block in program.blocks],
        "drawing": _drawing_to_meta(program.drawing),
        "from_contour": program.from_contour,
        "mode": program.mode.value,
        "placement": {
            "rotation_rad": placement.rotation,
            "x_m": placement.x,
            "y_m": placement.y,
            "z_m": placement.z,
        },
        "process": process_to_meta(program.process),
        "rate_hz": program.rate_hz,
        "robot": robot_to_meta(program.robot),
        "rows": len(program.q),
        "sha256": sha256,
    }


def from_meta(values: object, where: str) -> Meta:
    """What the meta object ``values`` says.

    Args:
        values: as JSON gives it.
        where: the file and line, for messages.

    Raises:
        ProgramError: a missing or unknown key, or a value of another type or out of its range.
    """
    top = Fields(values, where, KEYS)
    return Meta(
        robot=_robot(top),
        placement=_placement(top.section("placement", _PLACEMENT_KEYS)),
        process=process_from_meta(top),
        drawing=_drawing(top.section("drawing", _DRAWING_KEYS)),
        mode=top.choice("mode", Mode),
        blocks=_blocks(top),
        from_contour=None if top.raw("from_contour") is None else top.whole("from_contour", 1),
        rate_hz=top.number("rate_hz", 0.0, 1e9),
        rows=top.whole("rows", 0),
        sha256=top.text("sha256"),
    )


def _block_to_meta(block: Block) -> dict[str, Any]:
    """A block as JSON has it; `dataclasses.asdict` copies deeply and is slow on thousands of blocks."""
    return {
        "contour": block.contour,
        "first": block.first,
        "handles": list(block.handles),
        "kind": block.kind.value,
        "last": block.last,
        "layer": block.layer,
    }


def _drawing_to_meta(drawing: DrawingRef) -> dict[str, Any]:
    return {
        "accept_loss": drawing.accept_loss,
        "file": drawing.file,
        "ignored_layers": list(drawing.ignored_layers),
        "joining_m": drawing.joining,
        "layers": list(drawing.layers),
        "metres_per_unit": drawing.metres_per_unit,
        "sha256": drawing.sha256,
    }


def _robot(top: Fields) -> Robot:
    raw = top.raw("robot")
    if not isinstance(raw, Mapping):
        raise top.problem("robot is not an object")
    try:
        return robot_from_meta(raw)
    except RobotError as problem:
        where = f"{top.where}, {problem.where.removeprefix('meta.') or 'robot'}"
        raise ProgramError(problem.what, where=where, hint=problem.hint) from problem


def _placement(found: Fields) -> Placement:
    return Placement(
        x=found.number("x_m", -_LARGEST, _LARGEST),
        y=found.number("y_m", -_LARGEST, _LARGEST),
        rotation=found.number("rotation_rad", -_LARGEST, _LARGEST),
        z=found.number("z_m", -_LARGEST, _LARGEST),
    )


def _drawing(found: Fields) -> DrawingRef:
    return DrawingRef(
        file=found.text("file"),
        sha256=found.text("sha256", empty=True),
        metres_per_unit=found.number("metres_per_unit", 1e-12, 1e6),
        joining=found.number("joining_m", 0.0, 1.0),
        layers=found.texts("layers"),
        ignored_layers=found.texts("ignored_layers"),
        accept_loss=found.flag("accept_loss"),
    )


def _blocks(top: Fields) -> tuple[Block, ...]:
    found = []
    for index, values in enumerate(top.items("blocks")):
        block = Fields(values, f"{top.where}, block {index}", _BLOCK_KEYS)
        contour = None if block.raw("contour") is None else block.whole("contour", 1)
        found.append(
            Block(
                kind=block.choice("kind", BlockKind),
                first=block.whole("first", -MAX_WHOLE),
                last=block.whole("last", -MAX_WHOLE),
                contour=contour,
                layer=block.text("layer", empty=True),
                handles=block.texts("handles"),
            )
        )
    return tuple(found)
