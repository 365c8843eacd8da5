"""Random drawings of small parts: outlines, holes, islands in holes, lines to engrave; the same for the same seed."""

import io
import math

import ezdxf
import numpy as np
from ezdxf.math import bulge_to_arc

Vertex = tuple[float, float, float]
"""x and y in mm, and the bulge to the next one."""

CUT = {"layer": "CUT"}
MARK = {"layer": "ENGRAVE"}
QUARTER = math.tan(math.pi / 8.0)
MM, INCH = 4, 1  # of $INSUNITS


class Pen:
    """Draws in mm into a layout whose unit may be another one, as single lines and arcs or as polylines."""

    def __init__(self, chance: np.random.Generator) -> None:
        ezdxf.options.write_fixed_meta_data_for_testing = True  # no date, no random identifiers
        self.document = ezdxf.new("R2000")
        unit = int(chance.choice([MM, MM, MM, INCH]))
        self.document.header["$INSUNITS"] = unit
        self._scale = 1.0 if unit == MM else 1.0 / 25.4
        self._model = self.document.modelspace()
        self._chance = chance

    def content(self) -> bytes:
        """The bytes of the file."""
        stream = io.StringIO()
        self.document.write(stream)
        return stream.getvalue().encode("ascii")

    def outline(self, vertices: list[Vertex]) -> None:
        """A closed outline, as a polyline or as an entity per segment."""
        scaled = [(x * self._scale, y * self._scale, bulge) for x, y, bulge in vertices]
        if self._chance.random() < 0.5:
            self._model.add_lwpolyline(scaled, format="xyb", close=True, dxfattribs=CUT)
            return
        for start, end in zip(scaled, [*scaled[1:], scaled[0]], strict=True):
            if start[2] == 0.0:
                self._model.add_line(start[:2], end[:2], dxfattribs=CUT)
            else:
                centre, first, last, radius = bulge_to_arc(start[:2], end[:2], start[2])
                self._model.add_arc(centre, radius, math.degrees(first), math.degrees(last), dxfattribs=CUT)

    def circle(self, x: float, y: float, radius: float, layer: dict[str, str] = CUT) -> None:
        self._model.add_circle((x * self._scale, y * self._scale), radius * self._scale, dxfattribs=layer)

    def ellipse(self, x: float, y: float, radius: float, ratio: float) -> None:
        centre, axis = (x * self._scale, y * self._scale), (radius * self._scale, 0.0)
        self._model.add_ellipse(centre, major_axis=axis, ratio=ratio, dxfattribs=CUT)

    def stroke(self, start: tuple[float, float], end: tuple[float, float], bulge: float) -> None:
        """An open line to engrave."""
        vertices = [(start[0] * self._scale, start[1] * self._scale, bulge), (*np.multiply(end, self._scale), 0.0)]
        self._model.add_lwpolyline(vertices, format="xyb", dxfattribs=MARK)


def drawing(chance: np.random.Generator) -> bytes:
    """The bytes of a DXF file: one or two parts of one to four cells, with a feature in most cells."""
    pen = Pen(chance)
    place = 0.0
    for _ in range(int(chance.choice([1, 1, 2]))):
        columns, rows = int(chance.integers(1, 3)), int(chance.integers(1, 3))
        cell = float(chance.uniform(11.0, 15.0))
        for index in range(columns * rows):
            if chance.random() < 0.85:
                x, y = place + (index % columns + 0.5) * cell, (index // columns + 0.5) * cell
                FEATURES[int(chance.integers(len(FEATURES)))](pen, x, y, 0.36 * cell, chance)
        _border(pen, place, columns * cell, rows * cell, chance)
        place += columns * cell + 12.0
    return pen.content()


def _border(pen: Pen, left: float, width: float, height: float, chance: np.random.Generator) -> None:
    """An outline around a rectangle: sharp, rounded, bevelled, or with sides that bulge or come to a point."""
    right = left + width
    corners = [(left, 0.0), (right, 0.0), (right, height), (left, height)]
    shape = int(chance.integers(5))
    if shape == 0:
        pen.outline([(x, y, 0.0) for x, y in corners])
    elif shape == 1:
        pen.outline([(x, y, float(chance.uniform(0.0, 0.4))) for x, y in corners])
    elif shape == 2:
        pen.outline(_cropped(corners, float(chance.uniform(0.8, 2.5)), 0.0))
    elif shape == 3:
        pen.outline(_cropped(corners, float(chance.uniform(0.8, 2.5)), QUARTER))
    else:
        middles = [(left + width / 2, -4.0), (right + 3.0, height / 2), (left + width / 3, height + 5.0)]
        points = [corner for pair in zip(corners, [*middles, (left - 2.0, height / 2)], strict=True) for corner in pair]
        pen.outline([(x, y, 0.0) for x, y in points])


def _cropped(corners: list[tuple[float, float]], size: float, bulge: float) -> list[Vertex]:
    """A rectangle with its corners cut off or rounded."""
    found = []
    for index, corner in enumerate(corners):
        here = np.array(corner)
        for other, bend in ((corners[index - 1], bulge), (corners[(index + 1) % 4], 0.0)):
            way = np.array(other) - here
            x, y = here + way * size / np.hypot(*way)
            found.append((float(x), float(y), bend))
    return found


def _star(x: float, y: float, radius: float, chance: np.random.Generator, bend: float) -> list[Vertex]:
    """Three to eight vertices around a point, the segments between them bent by up to ``bend``."""
    count = int(chance.integers(3, 9))
    angles = 2.0 * np.pi * (np.arange(count) + chance.uniform(-0.2, 0.2, count)) / count
    reach = radius * chance.uniform(0.65, 0.95, count)
    bulges = chance.uniform(-0.5 * bend, bend, count) if bend else np.zeros(count)
    points = zip(x + reach * np.cos(angles), y + reach * np.sin(angles), bulges, strict=True)
    return [(float(one), float(other), float(bulge)) for one, other, bulge in points]


def _hole(pen: Pen, x: float, y: float, radius: float, chance: np.random.Generator) -> None:
    pen.circle(x, y, float(chance.uniform(0.3, 1.0)) * radius)


def _oval(pen: Pen, x: float, y: float, radius: float, chance: np.random.Generator) -> None:
    pen.ellipse(x, y, radius, float(chance.uniform(0.4, 0.95)))


def _slot(pen: Pen, x: float, y: float, radius: float, chance: np.random.Generator) -> None:
    half, end = float(chance.uniform(0.2, 0.5)) * radius, 0.45 * radius
    pen.outline(
        [(x - end, y - half, 0.0), (x + end, y - half, 1.0), (x + end, y + half, 0.0), (x - end, y + half, 1.0)]
    )


def _polygon(pen: Pen, x: float, y: float, radius: float, chance: np.random.Generator) -> None:
    pen.outline(_star(x, y, radius, chance, 0.0))


def _blob(pen: Pen, x: float, y: float, radius: float, chance: np.random.Generator) -> None:
    pen.outline(_star(x, y, radius, chance, 0.2))


def _island(pen: Pen, x: float, y: float, radius: float, chance: np.random.Generator) -> None:
    """A hole with another part in it."""
    pen.circle(x, y, radius)
    pen.outline(_star(x, y, 0.6 * radius, chance, 0.0))


def _stroke(pen: Pen, x: float, y: float, radius: float, chance: np.random.Generator) -> None:
    pen.stroke((x - radius, y), (x + radius, y), float(chance.choice([0.0, 0.3])))


def _ring(pen: Pen, x: float, y: float, radius: float, chance: np.random.Generator) -> None:
    pen.circle(x, y, float(chance.uniform(0.5, 1.0)) * radius, MARK)


FEATURES = (_hole, _oval, _slot, _polygon, _blob, _island, _stroke, _ring)
