"""From a DXF drawing to a verified joint-setpoint program for a delta-robot laser cutter.

The names below are the library's promise. They load on first use, so that ``import deltacam`` costs nothing.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from deltacam.cutting.process import load_process
    from deltacam.drawing.reader import read_drawing
    from deltacam.errors import DeltacamError
    from deltacam.examine import verify
    from deltacam.model import Report
    from deltacam.pipeline import plan
    from deltacam.program.formats import read_program, write_program
    from deltacam.program.program import Program
    from deltacam.robot.reader import load_robot
    from deltacam.robot.robot import Robot

__all__ = [
    "DeltacamError",
    "Program",
    "Report",
    "Robot",
    "load_process",
    "load_robot",
    "plan",
    "read_drawing",
    "read_program",
    "verify",
    "write_program",
]

_HOMES: Final = {
    "DeltacamError": "deltacam.errors",
    "Program": "deltacam.program.program",
    "Report": "deltacam.model",
    "Robot": "deltacam.robot.robot",
    "load_process": "deltacam.cutting.process",
    "load_robot": "deltacam.robot.reader",
    "plan": "deltacam.pipeline",
    "read_drawing": "deltacam.drawing.reader",
    "read_program": "deltacam.program.formats",
    "verify": "deltacam.examine",
    "write_program": "deltacam.program.formats",
}


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("deltacam")
    if name in _HOMES:
        return getattr(importlib.import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'deltacam' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
