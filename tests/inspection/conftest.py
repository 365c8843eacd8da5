"""A drawing with something of everything."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.geometry import curve as curves
from deltacam.model import Contour, Curve, Drawing, Finding, Layer, LedgerEntry, Operation, Outcome
from tests.strategies import rectangle, slot


def chain(*points: tuple[float, float]) -> Curve:
    """An open curve of lines through points in mm."""
    return Curve(points=np.array(points) * 1e-3, bulges=np.zeros(len(points) - 1), closed=False)


def numbered(number: int, curve: Curve, layer: str = "CUT", **options: object) -> Contour:
    """A contour of one entity."""
    return replace(Contour(number, curve, layer, (f"{number:X}",)), **options)  # type: ignore[arg-type]


@pytest.fixture(scope="session")
def drawing() -> Drawing:
    """120 x 80 mm with a hole around an island, a slot drawn twice, engraving, open lines and a frame to ignore."""
    engrave, ignore = Operation.ENGRAVE, Operation.IGNORE
    arcs = Curve(points=np.array([[0.09, 0.05], [0.1, 0.07], [0.11, 0.06]]), bulges=np.array([0.9, -0.3]), closed=False)
    machined = (
        numbered(1, rectangle(0.12, 0.08)),
        numbered(2, curves.circle(np.array([0.02, 0.02]), 0.01), depth=1, parent=1),
        numbered(3, curves.circle(np.array([0.02, 0.02]), 0.004), depth=2, parent=2),
        numbered(4, curves.transform(slot(0.03, 0.01), shift=(0.08, 0.03)), depth=1, parent=1),
        numbered(5, rectangle(0.02, 0.01, at=(0.05, 0.06)), "MARK", operation=engrave, depth=1, parent=1),
        numbered(7, chain((5, 60), (30, 60), (30, 75)), "MARK", operation=engrave),
        numbered(8, arcs),
    )
    ignored = (
        numbered(6, rectangle(0.13, 0.09, at=(-0.005, -0.005)), "FRAME", operation=ignore),
        numbered(9, chain((125, 0), (140, 0), (140, 30), (126, 30)), operation=ignore),
    )
    findings = (
        Finding("2 TEXT are not cut: text is never cut", where="layer TXT", kind="not_cut"),
        Finding("the ends are 0.02 mm apart", kind="gap", where="layer CUT", place=(0.14, 0.01), hint="raise --join"),
        Finding(
            "it crosses contour 2",
            kind="crossing",
            where="contour 3 (layer CUT, #3)",
            place=(0.02, 0.03),
            hint="separate the outlines",
            blocks=True,
        ),
        Finding("more than two lines meet", kind="branch", place=(0.06, 0.0)),
        Finding("a closed line encloses nothing", kind="sliver", place=(0.12, 0.08)),
    )
    ledger = (
        *(LedgerEntry(f"{n:X}", "LINE", "CUT", "", Outcome.CUT, "", n) for n in (1, 2, 3, 4, 8)),
        *(LedgerEntry(f"{n:X}", "LINE", "MARK", "", Outcome.ENGRAVED, "", n) for n in (5, 7)),
        LedgerEntry("6", "LWPOLYLINE", "FRAME", "sheet", Outcome.IGNORED, "its layer is left out", 6),
        LedgerEntry("9", "LINE", "CUT", "", Outcome.IGNORED, "an open line", 9),
        LedgerEntry("A", "LINE", "CUT", "", Outcome.MERGED, "duplicate of #4", 4),
        LedgerEntry("B", "TEXT", "TXT", "", Outcome.IGNORED, "text is never cut"),
        LedgerEntry("C", "TEXT", "TXT", "", Outcome.IGNORED, "text is never cut"),
        LedgerEntry("D", "SPLINE", "CUT", "", Outcome.LOST, "its knots are no numbers"),
    )
    return Drawing(
        file="part.dxf",
        sha256="0" * 64,
        metres_per_unit=1e-3,
        unit="mm",
        unit_source="header",
        contours=machined,
        ledger=ledger,
        findings=findings,
        conversion_error=1.3e-7,
        ignored=ignored,
        layers=(
            Layer("CUT", "on", 7, "CONTINUOUS", 7, 7),
            Layer("MARK", "on", 1, "DASHED", 2, 2),
            Layer("FRAME", "off", 8, "CONTINUOUS", 1, 1),
            Layer("TXT", "frozen", 2, "CONTINUOUS", 2, 0),
        ),
        extents=(-0.005, -0.005, 0.14, 0.085),
    )


@pytest.fixture(scope="session")
def empty() -> Drawing:
    """A drawing that holds nothing."""
    return Drawing("empty.dxf", "0" * 64, 1e-3, "", "missing", (), ())
