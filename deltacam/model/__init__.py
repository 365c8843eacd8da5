"""The frozen data that flows between the stages.

Everything is SI: metres, radians, seconds. Arrays are read-only copies. There is no algorithm here.
"""

from deltacam.model.arrays import Array, BoolArray, IntArray, readonly
from deltacam.model.curve import STRAIGHT, Curve
from deltacam.model.drawing import (
    DEFAULT_JOINING,
    DEFAULT_RULES,
    EVERYTHING,
    Contour,
    Drawing,
    Layer,
    Operation,
    Rule,
    Selection,
)
from deltacam.model.findings import Finding
from deltacam.model.ledger import LedgerEntry, Outcome
from deltacam.model.motion import Block, BlockKind, Cut, Mode, Placement
from deltacam.model.process import Corner, Process
from deltacam.model.report import UNCHECKED, Check, Held, Report, Size

__all__ = [
    "DEFAULT_JOINING",
    "DEFAULT_RULES",
    "EVERYTHING",
    "STRAIGHT",
    "UNCHECKED",
    "Array",
    "Block",
    "BlockKind",
    "BoolArray",
    "Check",
    "Contour",
    "Corner",
    "Curve",
    "Cut",
    "Drawing",
    "Finding",
    "Held",
    "IntArray",
    "Layer",
    "LedgerEntry",
    "Mode",
    "Operation",
    "Outcome",
    "Placement",
    "Process",
    "Report",
    "Rule",
    "Selection",
    "Size",
    "readonly",
]
