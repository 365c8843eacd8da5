"""What a check of a program found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from deltacam.model.findings import Finding
from deltacam.model.ledger import LedgerEntry

UNCHECKED: Final = "unchecked"
"""The kind of a finding about checks that could not be made."""


@dataclass(frozen=True, slots=True)
class Check:
    """One thing that was checked.

    Attributes:
        name: in words, the same in every report.
        passed: whether the worst value is within the limit.
        worst: the worst value, in ``unit``; None where there was nothing to measure.
        limit: what it may be at most (or at least, as the name says), in ``unit``; None where there is none.
        unit: of both.
        tick: where the worst value is.
        where: the place, contour or joint in words.
        time: of the tick, s.
        place: where the tool is at the tick, (x, y) m in the sheet frame.
        contour: the number of the contour that is worked on there, or that is wrong.
        layer: of the contour.
        handle: of the contour's first entity in the drawing.
        warns: whether to fail it is a warning only, which does not make the program fail.
    """

    name: str
    passed: bool
    worst: float | None = None
    limit: float | None = None
    unit: str = ""
    tick: int | None = None
    where: str = ""
    time: float | None = None
    place: tuple[float, float] | None = None
    contour: int | None = None
    layer: str = ""
    handle: str = ""
    warns: bool = False


@dataclass(frozen=True, slots=True)
class Size:
    """What is left of a closed contour when the beam has passed.

    Attributes:
        contour: the number of the drawn contour.
        drawn: its area, m^2.
        area: of what is left: the part inside an outline, the opening of a hole, m^2.
        offset: the difference to what an exact cut would leave, as an even shift of the edge, m.
        edge: the largest distance from the edge that an exact cut would leave, m; at a corner that of its sides.
        place: where that is, (x, y) m in the sheet frame.
        exact: the area that an exact cut would leave, m^2: other than drawn where the beam does not reach.
        drawn_box: width and height as drawn, m.
        box: width and height of what is left, m.
    """

    contour: int
    drawn: float
    area: float
    offset: float
    edge: float
    place: tuple[float, float]
    exact: float
    drawn_box: tuple[float, float]
    box: tuple[float, float]


@dataclass(frozen=True, slots=True)
class KerfEffect:
    """What the kerf does to a closed contour that is cut.

    Attributes:
        contour: the number of the drawn contour.
        paths: how many closed paths the beam runs: none where the kerf swallows the contour, several where it splits.
        meets: the numbers of the contours whose slot runs into that of this one.
        corners: how many inner corners the beam does not reach.
        depth: of the material that is left in the tip of the worst of them, m.
        place: of its tip, (x, y) m in the sheet frame.
    """

    contour: int
    paths: int
    meets: tuple[int, ...]
    corners: int
    depth: float
    place: tuple[float, float] | None


@dataclass(frozen=True, slots=True)
class Held:
    """What holds back the motion along one contour.

    Attributes:
        contour: the number of the drawn contour.
        time: of its motion with the laser on, s, before it is stretched to whole ticks.
        bound: for how long each limit binds, s, by name; what binds never is not there.
        without: about how long it would take without each limit, s, where that is less; empty where nobody asked.
    """

    contour: int
    time: float
    bound: Mapping[str, float]
    without: Mapping[str, float]


@dataclass(frozen=True, slots=True, eq=False)
class Report:
    """What a check of a program found.

    Attributes:
        checks: in a fixed order.
        summary: figures for people, by name.
        ledger: of the drawing, where one was given.
        findings: what a person should know.
        sizes: what is left of every closed contour that is cut; empty where nothing was compared.
        held: what holds back the motion along every contour, as the planner says; empty where nothing was planned.
        kerf: what the kerf does to every closed contour that is to be cut; empty where nothing was compared.
    """

    checks: tuple[Check, ...]
    summary: Mapping[str, Any]
    ledger: tuple[LedgerEntry, ...] = ()
    findings: tuple[Finding, ...] = field(default=())
    sizes: tuple[Size, ...] = ()
    held: tuple[Held, ...] = ()
    kerf: tuple[KerfEffect, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether every check passed; those that warn do not count."""
        return all(check.passed or check.warns for check in self.checks)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is no failure and still not as it should be: the checks that warn, and those that were not made."""
        warned = [check.name for check in self.checks if check.warns and not check.passed]
        return (*warned, *(finding.what for finding in self.findings if finding.kind == UNCHECKED))
