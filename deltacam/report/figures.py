"""What all figures have in common: arrays, axes and layouts as plotly.js reads them."""

from __future__ import annotations

import base64
from collections.abc import Iterable
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from deltacam.model import Array
from deltacam.report import palette

Json = dict[str, Any]

FONT: Final = 'system-ui, "Segoe UI", Roboto, "Liberation Sans", sans-serif'
_CLEAR: Final = "rgba(0,0,0,0)"


def packed(values: npt.ArrayLike, kind: str = "f4") -> Json:
    """An array as plotly.js and our script read it: little-endian bytes in base64."""
    content = np.ascontiguousarray(values, dtype=f"<{kind}").tobytes()
    return {"dtype": kind, "bdata": base64.b64encode(content).decode("ascii")}


def axis(**changes: Any) -> Json:
    """An axis with a quiet grid."""
    return {
        "gridcolor": palette.GRID.light,
        "zeroline": False,
        "ticks": "",
        "automargin": False,
        "tickfont": {"size": 11, "color": palette.TEXT.light},
        **changes,
    }


def layout(**changes: Any) -> Json:
    """A layout on clear paper, so that the page shows through; the script handles what is under the pointer."""
    return {
        "font": {"family": FONT, "size": 12, "color": palette.TEXT.light},
        "paper_bgcolor": _CLEAR,
        "plot_bgcolor": _CLEAR,
        "hovermode": False,
        "showlegend": False,
        "modebar": {"bgcolor": _CLEAR},
        "uirevision": "kept",
        **changes,
    }


def map_layout(box: Array, **changes: Any) -> Json:
    """The layout of a picture with equal axes, in mm, of all that is in ``box``, (2, 2) mm."""
    room = 0.04 * float(np.ptp(box, axis=0).max()) + 0.5
    (left, bottom), (right, top) = box[0] - room, box[1] + room
    return layout(
        margin={"l": 40, "r": 10, "t": 10, "b": 28},
        dragmode="pan",
        xaxis=axis(range=[float(left), float(right)], nticks=9),
        yaxis=axis(range=[float(bottom), float(top)], scaleanchor="x", nticks=9),
        **changes,
    )


def lines(
    parts: Iterable[Array],
    ink: palette.Ink,
    *,
    width: float,
    dash: str = "solid",
    fill: palette.Ink | None = None,
    opacity: float = 1.0,
) -> Json:
    """Polylines, (K, 2) mm each, as one trace with gaps between them."""
    gap = np.full((1, 2), np.nan)
    points = np.concatenate([gap[:0], *(piece for part in parts for piece in (part, gap))])
    trace: Json = {
        "type": "scatter",
        "mode": "lines",
        "x": packed(points[:, 0]),
        "y": packed(points[:, 1]),
        "line": {"color": ink.light, "width": width, "dash": dash},
        "opacity": opacity,
    }
    return trace if fill is None else trace | {"fill": "toself", "fillcolor": fill.light}


def dots(points: Array, ink: palette.Ink, *, size: float, symbol: str = "circle") -> Json:
    """Marks at ``points``, (K, 2) mm."""
    return {
        "type": "scatter",
        "mode": "markers",
        "x": packed(points[:, 0]),
        "y": packed(points[:, 1]),
        "marker": {"color": ink.light, "size": size, "symbol": symbol},
    }
