"""What is shown of the sheet in a picture, and at which pixels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.geometry.pack import Pack
from deltacam.model import Array, Drawing
from deltacam.report.bands import RAPID, bands
from deltacam.report.thin import thin_lines
from deltacam.robot.workspace import Workspace
from deltacam.units import to_mm, to_um
from deltacam.verification.evidence import Evidence, to_sheet

WIDTH: Final = 900.0
"""Of the still picture, pixels."""
MARGIN: Final = 36.0
"""Around the part in it, pixels."""
_TALLEST: Final = 620.0  # of the part
_ERROR: Final = 1 / 6000  # of the part: how far a drawn path may leave the setpoints
_SHEET_SHOWN: Final = 1.4  # how many times smaller the sheet may make the part


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """What is shown of the sheet frame, and where.

    Attributes:
        caption: the size of the part in words.
        error: how far drawn paths may be off, m.
        per_metre: pixels.
        height: pixels.
        origin: where x = y = 0 lies, pixels.
        sheet: the sheet's edge, (K, 2) m; empty where it is not shown.
        box: the lower left and the upper right corner of all that is shown, (2, 2) m.
    """

    caption: str
    error: float
    per_metre: float
    height: float
    origin: tuple[float, float]
    sheet: Array
    box: Array

    @classmethod
    def around(cls, evidence: Evidence, drawing: Drawing | None) -> View:
        """Room for the part, everything that is worked, and the sheet where it is not much larger."""
        boxes = Pack.of(contour.curve for contour in drawing.contours).bounds() if drawing else np.zeros((0, 4))
        subject = bands(evidence) != RAPID
        places = (
            evidence.sheet[np.append(subject, False) | np.append(False, subject)] if len(subject) else evidence.sheet
        )
        places = _corners(places)
        part = _corners(boxes.reshape(-1, 2)) if len(boxes) else places if len(places) else np.zeros((1, 2))
        width, depth = np.ptp(part, axis=0)
        seen, sheet = np.vstack([part, places]), to_sheet(evidence.program, sheet_edge(evidence.robot.workspace))
        if _scale(seen) > _SHEET_SHOWN * _scale(np.vstack([seen, sheet])):
            sheet = np.zeros((0, 2))
        seen = np.vstack([seen, sheet])
        low, extent, scale = seen.min(axis=0), np.ptp(seen, axis=0), _scale(seen)
        height = max(float(extent[1]) * scale, 120.0) + 2 * MARGIN
        x, y = ((WIDTH, height) + np.array((-1.0, 1.0)) * (2.0 * low + extent) * scale) / 2.0
        caption = f"{'part' if len(boxes) else 'path'} {to_mm(width):.2f} \u00d7 {to_mm(depth):.2f} mm"
        error, box = _ERROR * max(width, depth, 1e-3), np.stack([low, low + extent])
        return cls(caption, error, scale, height, (float(x), float(y)), sheet, box)

    def pixel(self, point: Array) -> tuple[float, float]:
        """The pixel of a point, (2,) m."""
        x, y = (point * (1.0, -1.0) * self.per_metre + self.origin).tolist()
        return x, y

    def place(self, point: Array, turn: float) -> str:
        """The attribute that moves a mark to a point, (2,) m, and turns it clockwise, degrees."""
        x, y = self.pixel(point)
        return f'transform="translate({x:.2f} {y:.2f}) rotate({turn:.1f})"'

    def path(self, lines: Sequence[Array], *, width: float, style: str) -> str:
        """A path of polylines (K, 2) m as relative moves, without the points that it can spare."""
        if not lines:
            return ""
        thinned = thin_lines(lines, self.error)
        grains = np.rint(to_um(1.0) * np.vstack(thinned)).astype(np.int64)
        way, last = np.diff(grains, axis=0, prepend=[[0, 0]]), np.cumsum([len(line) for line in thinned])
        moves = "".join("m" + " ".join(map(str, line.ravel())) for line in np.split(way, last[:-1]))
        (x, y), k = self.origin, self.per_metre * 1e-6
        place = f'transform="translate({x:.3f} {y:.3f}) scale({k:.9g} {-k:.9g})"'
        return f'<path {place} {style} stroke-width="{width / k:.4g}" d="{moves.replace(" -", "-")}"/>'


def _corners(points: Array) -> Array:
    """The lower left and the upper right corner of ``points``, (2, 2) m; nothing of nothing."""
    if not len(points):
        return points
    x, y = np.ascontiguousarray(points.T)  # a column after the other is several times as fast
    return np.array([[x.min(), y.min()], [x.max(), y.max()]])


def _scale(points: Array) -> float:
    """The pixels per metre at which the points fill the picture."""
    width, height = np.maximum(np.ptp(points, axis=0), 1e-3)
    return float(min((WIDTH - 2 * MARGIN) / width, _TALLEST / height))


def sheet_edge(sheet: Workspace) -> Array:
    """The edge of the sheet in the machine frame, (K, 2) m."""
    if sheet.radius is not None:
        turn = np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False)
        return sheet.radius * np.column_stack((np.cos(turn), np.sin(turn)))
    return np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * (sheet.width or 0.0, sheet.depth or 0.0) / 2.0
