"""The kinds of charts that studies have, as plotly.js draws them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from deltacam.model import Array
from deltacam.report import palette
from deltacam.report.figures import Json, axis, layout, lines, map_layout
from deltacam.report.study import Chart

_DIGITS: Final = 6
_LINES: Final = (*palette.JOINTS, palette.TOOL, palette.LIMIT, *palette.BINDING)


def heat_map(
    heading: str,
    caption: str,
    *,
    x_mm: Array,
    y_mm: Array,
    values: Array,
    unit: str,
    marks: Sequence[tuple[float, float, str]] = (),
    outlines: Sequence[Array] = (),
    axes: tuple[str, str] = ("x", "y"),
) -> Chart:
    """A field over a plane, with equal axes in mm.

    Args:
        heading: what it shows.
        caption: how to read it.
        x_mm: (K,) mm.
        y_mm: (L,) mm.
        values: (L, K); nan where there is nothing.
        unit: of the values, beside the scale.
        marks: places with a name, mm.
        outlines: lines over the field, (M, 2) mm each.
        axes: the names of the two directions.
    """
    field: Json = {
        "type": "heatmap",
        "x": _listed(x_mm),
        "y": _listed(y_mm),
        "z": [_listed(row) for row in values],
        "colorscale": "Viridis",
        "hoverongaps": False,
        "hovertemplate": f"{axes[0]} %{{x:.1f}} mm<br>{axes[1]} %{{y:.1f}} mm<br>%{{z:.4g}} {unit}<extra></extra>",
        "colorbar": {"title": {"text": unit}, "outlinewidth": 0, "thickness": 14},
    }
    corners = np.array([[x_mm.min(), y_mm.min()], [x_mm.max(), y_mm.max()]])
    seen = np.vstack([corners, *outlines])
    places = np.stack([seen.min(axis=0), seen.max(axis=0)])
    drawn = [lines([outline], palette.STRONG, width=1.6) | {"hoverinfo": "skip"} for outline in outlines]
    return Chart(heading, caption, (field, *drawn, *_marks(marks)), _of_map(places, axes))


def line_chart(
    heading: str,
    caption: str,
    *,
    x_title: str,
    y_title: str,
    lines: Sequence[tuple[str, npt.ArrayLike, npt.ArrayLike]],
) -> Chart:
    """Lines with names, each of x and y."""
    traces = tuple(
        {
            "type": "scatter",
            "mode": "lines+markers",
            "name": name,
            "x": _listed(x),
            "y": _listed(y),
            "line": {"color": _LINES[number % len(_LINES)].light, "width": 2},
            "marker": {"color": _LINES[number % len(_LINES)].light, "size": 6},
        }
        for number, (name, x, y) in enumerate(lines)
    )
    return Chart(heading, caption, traces, _of_numbers(x_title, y_title, legend=len(traces) > 1))


def scatter_chart(
    heading: str,
    caption: str,
    *,
    x_title: str,
    y_title: str,
    points: Sequence[tuple[str, npt.ArrayLike, npt.ArrayLike, Sequence[str]]],
) -> Chart:
    """Groups of points with names, each of x, y and what is said of every point."""
    traces = tuple(
        {
            "type": "scatter",
            "mode": "markers",
            "name": name,
            "x": _listed(x),
            "y": _listed(y),
            "text": list(texts),
            "hovertemplate": "%{text}<br>%{x:.4g}, %{y:.4g}<extra></extra>",
            "marker": {"color": _LINES[number % len(_LINES)].light, "size": 10},
        }
        for number, (name, x, y, texts) in enumerate(points)
    )
    return Chart(heading, caption, traces, _of_numbers(x_title, y_title, legend=len(traces) > 1))


def _marks(marks: Sequence[tuple[float, float, str]]) -> list[Json]:
    if not marks:
        return []
    return [
        {
            "type": "scatter",
            "mode": "markers+text",
            "x": [x for x, _, _ in marks],
            "y": [y for _, y, _ in marks],
            "text": [name for _, _, name in marks],
            "textposition": ["bottom center" if y > 0.0 else "top center" for _, y, _ in marks],
            "hoverinfo": "skip",
            "marker": {"color": palette.LIMIT.light, "size": 9, "symbol": "x-thin-open"},
            "textfont": {"color": palette.STRONG.light, "size": 12},
        }
    ]


def _of_map(box: Array, axes: tuple[str, str]) -> Json:
    found = map_layout(box, hovermode="closest")
    found["margin"] = {"l": 60, "r": 10, "t": 10, "b": 48}
    for key, name in (("xaxis", axes[0]), ("yaxis", axes[1])):
        found[key] |= {"title": {"text": f"{name}, mm"}, "zeroline": False}
    return found


def _of_numbers(x_title: str, y_title: str, *, legend: bool) -> Json:
    def named(title: str) -> dict[str, Any]:
        return axis(title={"text": title}, automargin=True)

    margin = {"l": 60, "r": 10, "t": 10, "b": 48}
    return layout(hovermode="closest", showlegend=legend, margin=margin, xaxis=named(x_title), yaxis=named(y_title))


def _listed(values: npt.ArrayLike) -> list[float | None]:
    """Numbers for JSON in a few digits; None where there is none."""
    flat = np.asarray(values, dtype=np.float64)
    return [float(f"{value:.{_DIGITS}g}") if np.isfinite(value) else None for value in flat.tolist()]
