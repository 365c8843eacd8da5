"""Draws the samples: `python samples/make_samples.py`, and `-o DIR` for another folder. Every run gives the same bytes.

Everything is in millimetres, on the layer CUT; what is not to be cut is on NOTES.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import ezdxf
import outlines as shapes
from ezdxf.math import bulge_to_arc
from outlines import Bezier, Point, Vertex, bulge, place, polar

CUT: Final = {"layer": "CUT"}


def tidy(*values: float) -> tuple[float, ...]:
    """The numbers to a picometre: the same on machines whose mathematics differs in the last digit."""
    return tuple(round(value, 9) + 0.0 for value in values)


def polyline(layout: Any, outline: Sequence[Vertex]) -> None:
    """Draw a closed outline as one LWPOLYLINE."""
    layout.add_lwpolyline([tidy(*vertex) for vertex in outline], format="xyb", close=True, dxfattribs=CUT)


def lines_and_arcs(layout: Any, outline: Sequence[Vertex], *, closed: bool = True) -> None:
    """Draw an outline as one LINE or ARC per segment, as many CAD programs export it."""
    for start, end in pairwise([*outline, outline[0]] if closed else outline):
        if start[2] == 0.0:
            layout.add_line(tidy(*start[:2]), tidy(*end[:2]), dxfattribs=CUT)
        else:
            centre, first, last, radius = bulge_to_arc(start[:2], end[:2], start[2])
            angles = tidy(math.degrees(first), math.degrees(last))
            layout.add_arc(tidy(*centre), *tidy(radius), *angles, dxfattribs=CUT)


def circle(layout: Any, x: float, y: float, radius: float) -> None:
    """Draw a CIRCLE."""
    layout.add_circle(tidy(x, y), *tidy(radius), dxfattribs=CUT)


def spline(layout: Any, chain: Sequence[Bezier]) -> None:
    """Draw cubic Bezier curves that follow each other as one SPLINE; it may have corners between them."""
    points = [chain[0][0], *(point for bezier in chain for point in bezier[1:])]
    drawn = layout.add_spline(dxfattribs={**CUT, "degree": 3})
    drawn.control_points = [(*tidy(*point), 0.0) for point in points]
    drawn.knots = [0, *(knot for knot in range(len(chain) + 1) for _ in range(3)), len(chain)]


def bracket(model: Any) -> None:
    """A mount for a NEMA 17 stepper motor, with slots to tension a belt."""
    foot_and_head = [(0, 0, 6), (120, 0, 6), (120, 22, 6), (95, 22, 14), (87, 96, 9), (33, 96, 9), (25, 22, 14)]
    lines_and_arcs(model, shapes.rounded([*foot_and_head, (0, 22, 6)]))
    polyline(model, place(shapes.slot(5.0, 23.0), math.pi / 2, (60, 65)))
    for x in (-15.5, 15.5):
        for y in (-15.5, 15.5):
            polyline(model, place(shapes.slot(5.0, 3.4), math.pi / 2, (60 + x, 65 + y)))
    for x in (12, 36, 84, 108):
        circle(model, x, 11, 2.75)
    lines_and_arcs(model, shapes.rounded([(42, 21, 4), (78, 21, 4), (75.5, 38, 4), (44.5, 38, 4)]))
    for x in (33.9, 86.1):
        polyline(model, shapes.box(3.2, 8.0, at=(x, 30)))
    model.add_text("MOTOR MOUNT, STEEL 1 mm", height=4, dxfattribs={"layer": "NOTES", "insert": (26, -10)})


def gear(model: Any, teeth: int = 24, module: float = 4.0, pressure_angle: float = math.radians(20.0)) -> None:
    """A spur gear with involute flanks, a bore of 20 mm with a keyway of 6 mm, and six windows."""
    pitch = teeth * module / 2.0
    base, tip, root, fillet = pitch * math.cos(pressure_angle), pitch + module, pitch - 1.25 * module, 0.38 * module
    half = math.pi / (2 * teeth) + math.tan(pressure_angle) - pressure_angle  # half a tooth, at the base circle
    roll = math.sqrt((tip / base) ** 2 - 1.0)  # angle from which the involute unrolls to the tip
    half_tip = half - roll + math.atan(roll)
    foot = math.asin(fillet / (root + fillet))
    inwards = [  # from the base circle down to the middle of the gap, for a flank at angle 0
        (base, 0.0, 0.0),
        (math.sqrt((root + fillet) ** 2 - fillet**2), 0.0, bulge(foot - math.pi / 2)),
        (*polar(root, foot), bulge(math.pi / teeth - half - foot)),
        (*polar(root, math.pi / teeth - half), 0.0),
    ]
    for tooth in range(teeth):
        middle = math.tau * tooth / teeth
        lines_and_arcs(model, place(shapes.mirrored(inwards), middle - half), closed=False)
        spline(model, shapes.involute(base, roll, middle - half, 1.0))
        ends = [polar(tip, middle - half_tip), polar(tip, middle + half_tip)]
        lines_and_arcs(model, [(*ends[0], bulge(2 * half_tip)), (*ends[1], 0.0)], closed=False)
        spline(model, shapes.involute(base, roll, middle + half, -1.0))
        lines_and_arcs(model, place(inwards, middle + half), closed=False)
    edge = math.sqrt(10.0**2 - 3.0**2)
    polyline(model, [(-3, edge, bulge(math.tau - 2 * math.asin(0.3))), (3, edge, 0), (3, 12.8, 0), (-3, 12.8, 0)])
    for spoke in range(6):
        polyline(model, place(shapes.window(19.0, root - 7.0, 4.0, 3.5, math.tau / 6), math.tau * spoke / 6))


def nameplate(model: Any) -> None:
    """A name plate: letters and petals of splines, in a plate with hollow corners."""
    width, height = 220.0, 84.0
    polyline(model, shapes.hollow_box(width, height, 11.0))
    for x in (14.0, width - 14.0):
        for y in (14.0, height - 14.0):
            circle(model, x, y, 1.6)
    for outline in shapes.word("DELTACAM", 0.25, middle=(width / 2, 43.0)):
        spline(model, outline)
    heart = (width / 2, 22.0)
    circle(model, *heart, 1.9)
    for k in range(8):
        spline(model, place_all(shapes.petal(7.0, 4.0, root=3.2), math.tau * k / 8, heart))
    for i in range(7):
        size, x = 1.0 - 0.085 * i, 17.0 + 9.0 * i
        for side in (1.0, -1.0):
            for lean in (0.7, -0.7):
                angle = lean if side > 0.0 else math.pi - lean
                leaf = shapes.petal(10.5 * size, 4.0 * size, root=1.4)
                spline(model, place_all(leaf, angle, (heart[0] + side * x, heart[1])))


def place_all(chain: Sequence[Bezier], angle: float, at: Point) -> list[Bezier]:
    """The Bezier curves turned by ``angle`` rad about the origin, then moved by ``at``."""
    return [shapes.moved(bezier, angle, at) for bezier in chain]


def panels(model: Any, gap: float = 0.15) -> None:
    """Nine cover plates in rows, as far apart as the kerf of the process steel-1mm-fibre is wide."""
    width, height = 60.0, 40.0
    for column in (-1, 0, 1):
        for row in (-1, 0, 1):
            x, y = column * (width + gap), row * (height + gap)
            polyline(model, shapes.box(width, height, at=(x, y)))
            circle(model, x - 24.0, y, 2.2)
            circle(model, x + 24.0, y, 2.2)


def snowflake(model: Any) -> None:
    """A snowflake of straight lines, all corners sharp: 216 in its outline."""
    half_arm = list(shapes.snow_arm(reach=88.0, stem=2.4, branches=((34.0, 26.0), (50.0, 19.0), (66.0, 11.0))))
    arm = [(x, -y, 0.0) for x, y, _ in reversed(half_arm)] + half_arm[1:-1]
    polyline(model, [vertex for k in range(6) for vertex in place(arm, math.tau * k / 6)])
    polyline(model, [(*polar(4.5, math.tau * k / 6), 0.0) for k in range(6)])
    rhombus = [(8.0, 0.0, 0.0), (13.0, -2.8, 0.0), (19.0, 0.0, 0.0), (13.0, 2.8, 0.0)]
    for k in range(6):
        polyline(model, place(rhombus, math.tau * k / 6))


def link(part: Any) -> None:
    """Two eyes and their common tangents."""
    lines_and_arcs(part, shapes.hull(8.0, 5.5, 24.0))
    circle(part, -12, 0, 4)
    circle(part, 12, 0, 2.5)


def hook(part: Any) -> None:
    """A hook with an eye; its mirror image is another part."""
    bends = [(11, 14, 1), (5, 14, 0), (5, -2, -1), (-5, -2, 1), (-11, -2, 1), (11, -2, 0)]
    polyline(part, [(float(x), float(y), float(bend)) for x, y, bend in bends])
    circle(part, 8, 13, 1.4)


def washer(part: Any) -> None:
    """Three parts in one place: a ring in a ring, and a disc in that."""
    for radius in (18.0, 12.0, 9.0, 6.0, 4.0):
        circle(part, 0, 0, radius)


def gusset(part: Any) -> None:
    """A corner brace with a window and two holes."""
    lines_and_arcs(part, shapes.rounded([(-16, -16, 4), (17, -16, 4), (-16, 17, 4)]))
    polyline(part, shapes.rounded([(-8.5, -8.5, 1.5), (3, -8.5, 1.5), (-8.5, 3, 1.5)]))
    circle(part, 7, -12, 1.6)
    circle(part, -12, 7, 1.6)


def cog(part: Any) -> None:
    """A little wheel with straight teeth and a square bore."""
    tooth = ((14.0, -0.32), (18.0, -0.16), (18.0, 0.16), (14.0, 0.32))
    polyline(part, [(*polar(r, math.tau * (k + share) / 12), 0.0) for k in range(12) for r, share in tooth])
    polyline(part, shapes.box(8.0, 8.0))


def badge(part: Any) -> None:
    """Circles and a slot; inserted with unequal scales the circles become ellipses."""
    circle(part, 0, 0, 18)
    polyline(part, shapes.slot(12.0, 7.0))


def pick(part: Any) -> None:
    """A guitar pick of one spline, with a hole to hang it up."""
    right: list[Bezier] = [((0, -17), (3.5, -17), (15, 4), (14.5, 9)), ((14.5, 9), (14, 14), (4, 15), (0, 15))]
    spline(part, [*right, *(shapes.flipped(bezier) for bezier in reversed(right))])
    circle(part, 0, 9, 2.2)


def strap(part: Any) -> None:
    """A strap with a slot and a hole."""
    polyline(part, shapes.box(38.0, 11.0, 3.0))
    polyline(part, place(shapes.slot(9.0, 4.0), 0.0, (-9, 0)))
    circle(part, 13, 0, 2)


def escutcheon(part: Any) -> None:
    """A plate around a keyhole."""
    polyline(part, place(shapes.hull(14.0, 8.0, 20.0), math.pi / 2, (0, 0)))
    turn = math.tau - 2 * math.asin(1.6 / 4.0)
    y = -5 - math.sqrt(4.0**2 - 1.6**2)
    polyline(part, [(1.6, y, bulge(turn)), (-1.6, y, 0), (-2.4, -16, 0), (2.4, -16, 0)])
    circle(part, 0, 11, 1.8)


def sheet(model: Any) -> None:
    """Small parts in four quarters that mirror each other: blocks in blocks, turned, scaled, mirrored and in arrays."""
    blocks = model.doc.blocks
    for part in (link, hook, washer, gusset, cog, badge, pick, strap, escutcheon):
        part(blocks.new(part.__name__.upper()))
    quarter = blocks.new("QUARTER")
    for name, column, row, scale, turn in (
        ("LINK", 0, 0, (1, 1), 45), ("HOOK", 1, 0, (1, 1), 0), ("GUSSET", 2, 0, (1, 1), 90),
        ("PICK", 0, 1, (1, 1), 315), ("WASHER", 1, 1, (1, 1), 0), ("STRAP", 2, 1, (1, 1), 45),
        ("COG", 0, 2, (1, 1), 0), ("BADGE", 1, 2, (1, 0.6), 45), ("ESCUTCHEON", 2, 2, (1, 1), 135),
    ):  # fmt: skip
        scales = {"xscale": scale[0], "yscale": scale[1], "rotation": turn, "layer": "CUT"}
        quarter.add_blockref(name, (24 + 46 * column, 24 + 46 * row), dxfattribs=scales)
    array = {"row_count": 2, "column_count": 2, "row_spacing": 46, "column_spacing": 46, "layer": "CUT"}
    quarter.add_blockref("WASHER", (47, 47), dxfattribs={"xscale": 0.4, "yscale": 0.4, **array})
    for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        model.add_blockref("QUARTER", (0, 0), dxfattribs={"xscale": x, "yscale": y, "layer": "CUT"})


def sign(model: Any, at: Point) -> None:
    """A plate with holes from small to large, a slot, and a name that is engraved in single lines."""
    x, y = at
    polyline(model, shapes.box(94.0, 44.0, 4.0, at=(x + 47, y + 22)))
    for place_x in (6, 88):
        for place_y in (6, 38):
            circle(model, x + place_x, y + place_y, 1.6)
    polyline(model, place(shapes.slot(26.0, 5.0), 0.0, (x + 62, y + 10)))
    for i, radius in enumerate((0.6, 1.0, 1.5, 2.2)):
        circle(model, x + 16 + 8 * i, y + 10, radius)
    for line in shapes.strokes("DELTA 300", 10.0, (x + 5.5, y + 22.0)):
        model.add_lwpolyline([tidy(*point) for point in line], dxfattribs={"layer": "ENGRAVE"})


def angle(model: Any, at: Point, turn: float) -> None:
    """A bracket with two legs of 44 mm, 14 mm wide, and a hole in each and in the corner."""
    corners = [(0, 0, 3), (44, 0, 3), (44, 14, 3), (14, 14, 5), (14, 44, 3), (0, 44, 3)]
    middle = place([(x - 22, y - 22, bend) for x, y, bend in shapes.rounded(corners)], turn, at)
    polyline(model, middle)
    for x, y, _ in place([(-15, -15, 0), (14, -15, 0), (-15, 14, 0)], turn, at):
        circle(model, x, y, 2.2)


def mixed(model: Any) -> None:
    """A sheet of mixed parts, 4 mm apart: for leads, loops at sharp corners, tabs, and a name that is engraved."""
    model.doc.layers.add("ENGRAVE", color=1)
    sign(model, (0, 0))
    angle(model, (120, 22), 0.0)
    angle(model, (138, 40), math.pi)
    tooth = ((18.0, -0.34), (22.0, -0.17), (22.0, 0.17), (18.0, 0.34))
    wheel = [(*polar(r, math.tau * (k + share) / 16), 0.0) for k in range(16) for r, share in tooth]
    polyline(model, place(wheel, 0.0, (22, 70)))
    polyline(model, place(shapes.box(9.0, 9.0), math.pi / 4, (22, 70)))
    for k in range(4):
        circle(model, *(22 + 11 * math.cos(math.pi * k / 2), 70 + 11 * math.sin(math.pi * k / 2)), 2.5)
    for radius in (22.0, 15.0, 11.0, 5.0):
        circle(model, 70, 70, radius)
    for turn in (0.0, math.pi):  # two triangles along their long sides, and what fits beside them
        polyline(model, place([(-31, -14, 0), (30, -14, 0), (-31, 10, 0)], turn, (128.5, 80)))
    for radius in (6.0, 2.0):
        circle(model, 104, 56, radius)
    for x, tips, valley in ((22, 5, 9.0), (68, 6, 11.0), (112, 8, 13.0)):
        polyline(model, place(shapes.star(22.0, valley, tips), 0.0, (x, 121)))
        circle(model, x, 121, 3.0)
    for y in (103.5, 119.5, 135.5):
        polyline(model, place(shapes.slot(8.0, 12.0), 0.0, (148, y)))
        polyline(model, place(shapes.slot(8.0, 4.0), 0.0, (148, y)))


DRAWINGS: Final[dict[str, Callable[[Any], None]]] = {
    "bracket": bracket,
    "gear": gear,
    "mixed": mixed,
    "nameplate": nameplate,
    "panels": panels,
    "sheet": sheet,
    "snowflake": snowflake,
}


def draw_all(folder: Path) -> Iterator[Path]:
    """Draw the samples into ``folder``, and give the path of each."""
    ezdxf.options.write_fixed_meta_data_for_testing = True  # no date, no random identifiers
    for name, draw in DRAWINGS.items():
        document = ezdxf.new("R2000", units=ezdxf.units.MM)
        document.layers.add("CUT", color=7)
        document.layers.add("NOTES", color=8)
        draw(document.modelspace())
        path = folder / f"{name}.dxf"
        document.saveas(path)
        yield path


def main() -> None:
    """Draw the samples into the folder that the command line names."""
    parser = argparse.ArgumentParser(description="Draw the samples of deltacam.")
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parent, help="folder for the files")
    for path in draw_all(parser.parse_args().output):
        print(path)


if __name__ == "__main__":
    main()
