"""How a material is cut."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from deltacam.model.drawing import DEFAULT_RULES, Operation, Rule

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
        rules: which lines of a drawing are cut, engraved or ignored; the first that matches counts, and what none
            matches is cut.
        open: what is done with lines that do not close and that no rule matches.
        engrave_feed: speed while engraving, m/s, > 0; None where nothing is known about engraving.
        engrave_power: 0 < power <= 1 of the laser's rated power while engraving; None likewise.
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
    rules: tuple[Rule, ...] = DEFAULT_RULES
    open: Operation = Operation.IGNORE
    engrave_feed: float | None = None
    engrave_power: float | None = None
