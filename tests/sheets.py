"""Drawings of plates, some of them nested one kerf apart, as DXF."""

import io
from collections.abc import Sequence

import ezdxf

KERF_MM = 0.15

Box = tuple[float, float, float, float]
"""Left, bottom, width and height, mm."""


def rows(columns: int, count: int, *, width: float = 12.0, height: float = 9.0, gap: float = KERF_MM) -> list[Box]:
    """Rectangles in rows and columns, a kerf apart."""
    return [
        (column * (width + gap), row * (height + gap), width, height)
        for row in range(count)
        for column in range(columns)
    ]


def drawn(
    boxes: Sequence[Box],
    circles: Sequence[tuple[float, float, float]] = (),
    outlines: Sequence[Sequence[tuple[float, float]]] = (),
) -> bytes:
    """The bytes of a drawing of rectangles, of circles (x, y, radius), and of other closed outlines, mm."""
    document = ezdxf.new("R2010", units=ezdxf.units.MM)
    corners = [[(x, y), (x + width, y), (x + width, y + height), (x, y + height)] for x, y, width, height in boxes]
    for points in (*corners, *outlines):
        document.modelspace().add_lwpolyline(points, close=True)
    for x, y, radius in circles:
        document.modelspace().add_circle((x, y), radius)
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode()
