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
from deltacam.model.motion import Block, BlockKind, Cut, Mode, Placement, Search, Stretch
from deltacam.model.process import (
    Corner,
    Gas,
    Grade,
    Heat,
    Lead,
    LeadShape,
    Loops,
    PowerLaw,
    Process,
    Provenance,
    Slower,
    StartRule,
    Tabs,
)
from deltacam.model.report import UNCHECKED, Check, Held, KerfEffect, Report, Size

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
    "Gas",
    "Grade",
    "Heat",
    "Held",
    "IntArray",
    "KerfEffect",
    "Layer",
    "Lead",
    "LeadShape",
    "LedgerEntry",
    "Loops",
    "Mode",
    "Operation",
    "Outcome",
    "Placement",
    "PowerLaw",
    "Process",
    "Provenance",
    "Report",
    "Rule",
    "Search",
    "Selection",
    "Size",
    "Slower",
    "StartRule",
    "Stretch",
    "Tabs",
    "readonly",
]
