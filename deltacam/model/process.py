"""How a material is cut."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from deltacam.model.drawing import DEFAULT_RULES, Operation, Rule

Corner = Literal["round", "stop", "loop"]
LeadShape = Literal["none", "line", "arc", "line+arc"]
StartRule = Literal["best", "edge", "corner"]
Grade = Literal["vendor", "community", "measured", "estimate"]


@dataclass(frozen=True, slots=True)
class Lead:
    """How the tool comes to a contour, or leaves it; always on the waste side.

    Attributes:
        shape: a line ends at the contour at an angle, an arc touches it, line+arc is a line that an arc continues.
        length: of all of it, m, > 0; None is as long as it takes to reach the feed at the contour.
        radius: of the arc, m, > 0; None is chosen.
        angle: between a line and the contour where they meet, 0 to pi / 2 rad, 0 being along it; for an arc how far it
            turns.
    """

    shape: LeadShape = "none"
    length: float | None = None
    radius: float | None = None
    angle: float = 0.5 * math.pi


@dataclass(frozen=True, slots=True)
class PowerLaw:
    """The laser's power by the speed v of the tool: P0 + (P1 - P0) (v / feed)^n, P1 being the power at the feed.

    Attributes:
        at_rest: P0 as a part of P1, 0 to 1.
        exponent: n, > 0.
        lowest: the power is never less, of the laser's rated power.
    """

    at_rest: float
    exponent: float = 1.0
    lowest: float = 0.0


@dataclass(frozen=True, slots=True)
class Slower:
    """A feed that is reduced where a hole or a bend is small.

    Attributes:
        factor: of the feed, 0 < factor <= 1.
        diameter: holes up to this size, the diameter of a circle of their area, m; None is no rule for holes.
        radius: bends up to this radius of the drawn line, m; None is no rule for bends.
    """

    factor: float
    diameter: float | None = None
    radius: float | None = None


@dataclass(frozen=True, slots=True)
class Loops:
    """Corners that are passed by a loop through the waste, where the process says so for corners.

    Attributes:
        angle: outer corners that turn by at least this get one, rad.
        radius: of the loop, m; None is what the feed needs there.
    """

    angle: float = math.radians(60.0)
    radius: float | None = None


@dataclass(frozen=True, slots=True)
class Tabs:
    """Bridges that hold a part in its sheet.

    Attributes:
        width: of the material that is left, m, > 0.
        count: so many for every outline; None where spacing is given.
        spacing: at most so far apart along the outline, m; None where count is given.
        corner: so far from every corner at least, m.
        holes: whether what falls out of holes is held too.
    """

    width: float
    count: int | None = None
    spacing: float | None = None
    corner: float = 2e-3
    holes: bool = False


@dataclass(frozen=True, slots=True)
class Heat:
    """How long heat is given to spread: the next cut is so far away, or begins so much later.

    Attributes:
        distance: from the end of a cut to the beginning of the next, m.
        time: from the end of a cut to the beginning of a nearer one, s.
    """

    distance: float
    time: float


@dataclass(frozen=True, slots=True)
class Gas:
    """An assist gas that the process knows.

    Attributes:
        name: nitrogen, oxygen, air.
        pressure: Pa; None where nobody says.
        feed_factor: of the feed, > 0.
    """

    name: str
    pressure: float | None = None
    feed_factor: float = 1.0


@dataclass(frozen=True, slots=True)
class Provenance:
    """Where a value of a process is from.

    Attributes:
        key: of the process file.
        grade: how far it can be trusted.
        source: who says so.
    """

    key: str
    grade: Grade
    source: str = ""


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
        corner: whether sharp corners are rounded within the tolerance, stopped at, or passed by a loop.
        gas: the name of the assist gas that is used.
        rules: which lines of a drawing are cut, engraved or ignored; the first that matches counts, and what none
            matches is cut.
        open: what is done with lines that do not close and that no rule matches.
        engrave_feed: speed while engraving, m/s, > 0; None where nothing is known about engraving.
        engrave_power: 0 < power <= 1 of the laser's rated power while engraving; None likewise.
        lead_in: how a cut begins, of closed contours.
        lead_out: how it ends, with the laser off.
        start: where on a closed contour a cut begins: where it is best for the order, in the middle of the longest
            edge, or at a corner.
        overcut: how far the laser stays on beyond the start of a closed cut, m, >= 0.
        pierce_power: of the laser's rated power while piercing; None is that of the cut.
        pre_pierce: whether all pierces are made before the first cut.
        power_law: how the power follows the speed; None keeps it.
        slower: where the feed is reduced; of several rules that match the smallest factor counts.
        loops: how corners are passed where ``corner`` is loop.
        tabs: None for none.
        heat: None for no rule.
        passes: how often every cut is run, >= 1.
        common_edges: whether edges that two outlines share, a kerf apart, are cut once.
        gases: what the process knows of gases; the feed is that of ``gas``.
        laser: fibre, co2; may be empty.
        laser_power: rated, W; 0 where nobody says.
        feeds: the slowest and the fastest that is sensible, m/s; None where nobody says.
        provenance: of its values.
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
    lead_in: Lead = Lead()
    lead_out: Lead = Lead()
    start: StartRule = "best"
    overcut: float = 0.0
    pierce_power: float | None = None
    pre_pierce: bool = False
    power_law: PowerLaw | None = None
    slower: tuple[Slower, ...] = ()
    loops: Loops = Loops()
    tabs: Tabs | None = None
    heat: Heat | None = None
    passes: int = 1
    common_edges: bool = False
    gases: tuple[Gas, ...] = ()
    laser: str = ""
    laser_power: float = 0.0
    feeds: tuple[float, float] | None = None
    provenance: tuple[Provenance, ...] = ()
