"""Writes the lines of a test cut as a DXF file."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Final

import ezdxf
from ezdxf import filemanagement, units

from deltacam.drawing.testcuts.line import Line

_BLACK: Final = 7  # white on a black screen


def to_dxf(lines: Sequence[Line]) -> bytes:
    """The lines as a DXF file of AutoCAD 2000, in millimetres; the same lines give the same bytes."""
    with _without_dates():
        document = filemanagement.new("R2000", units=units.MM)
    for name in dict.fromkeys(line.layer for line in lines):
        document.layers.add(name, color=_BLACK)
    model = document.modelspace()
    for line in lines:
        points = [(round(x * 1e3, 6) + 0.0, round(y * 1e3, 6) + 0.0) for x, y in line.points.tolist()]
        model.add_lwpolyline(points, close=line.closed, dxfattribs={"layer": line.layer})
    stream = io.StringIO()
    with _without_dates():
        document.write(stream)
    return stream.getvalue().encode("utf-8")


@contextmanager
def _without_dates() -> Iterator[None]:
    """Within it ezdxf writes no dates and no random identifiers."""
    options = ezdxf.options  # type: ignore[attr-defined]  # it is exported without saying so
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before
