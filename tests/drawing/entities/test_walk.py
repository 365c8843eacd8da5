"""Entities of every kind, in any extrusion and nesting, against ezdxf's own transformation and evaluation."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
from ezdxf.math import OCS, ConstructionArc, Vec3
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.drawing.entities import walk
from deltacam.errors import DrawingError
from deltacam.geometry import curve as curves
from deltacam.model import Curve

SCALES = st.sampled_from([1.0, -1.0, 2.5, -0.4])


@dataclass(frozen=True)
class Read:
    """An entity with its curve."""

    entity: walk.Entity
    curve: Curve | None

    def __getattr__(self, name: str) -> Any:
        return getattr(self.entity, name)


def read(document: Any) -> list[Read]:
    found = walk.read(document, 1e-3)
    drawn = dict(zip(found.owner.tolist(), found.curves, strict=True))
    return [Read(entity, drawn.get(i)) for i, entity in enumerate(found.entities)]


def only(document: Any) -> Curve:
    (drawn,) = [entity.curve for entity in read(document) if entity.curve is not None]
    return drawn


def farthest(curve: Curve, points: Iterable[Any]) -> float:
    """The largest distance of the points, mm, from the curve, m."""
    return max(curves.nearest(curve, 1e-3 * np.array(Vec3(point).vec2))[2] for point in points)


def samples(entity: Any) -> list[Vec3]:
    """Places that lie on the entity, mm, by ezdxf."""
    if entity.dxftype() == "LINE":
        return [entity.dxf.start.lerp(entity.dxf.end, share) for share in (0.0, 0.3, 1.0)]
    if entity.dxftype() == "LWPOLYLINE":
        return [place for part in entity.virtual_entities() for place in samples(part)]
    if entity.dxftype() in ("ARC", "CIRCLE"):
        ends = (entity.dxf.start_angle, entity.dxf.end_angle) if entity.dxftype() == "ARC" else (0.0, 360.0)
        span = (ends[1] - ends[0]) % 360.0 or 360.0
        return list(entity.vertices([ends[0] + span * share for share in (0.0, 0.21, 0.5, 0.8, 1.0)]))
    tool = entity.construction_tool()
    if entity.dxftype() == "ELLIPSE":
        return list(tool.vertices(tool.params(23)))
    return list(tool.points(np.linspace(tool.knots()[tool.order - 1], tool.knots()[tool.count], 23)))


def everything(block: Any) -> None:
    """One curve of each kind."""
    block.add_line((1, 2), (8, -3))
    block.add_arc((4, 1), 6, 30, 250)
    block.add_circle((-3, 2), 5)
    block.add_lwpolyline([(0, 0, 0.5), (10, 0, 0), (10, 8, -1.8), (2, 9, 0)], format="xyb", close=True)
    block.add_ellipse((2, 3), (6, 2), 0.4, 0.3, 5.0)
    block.add_spline_control_frame([(0, 0), (4, 9), (9, -3), (14, 4), (15, 5)])


@settings(deadline=None, max_examples=12)
@given(SCALES, SCALES, st.floats(0.0, 360.0), SCALES, SCALES, st.booleans())
def test_inserts_mirrored_squeezed_and_nested_draw_what_ezdxf_explodes_them_to(
    xscale: float, yscale: float, rotation: float, inner_x: float, inner_y: float, turned: bool
) -> None:
    document = ezdxf.new()
    inner, outer = document.blocks.new("INNER", base_point=(1, 2)), document.blocks.new("OUTER")
    everything(inner)
    outer.add_blockref("INNER", (5, -7), {"xscale": inner_x, "yscale": inner_y, "rotation": 20.0})
    flip = {"extrusion": (0, 0, -1)} if turned else {}
    attributes = {"xscale": xscale, "yscale": yscale, "rotation": rotation, **flip}
    insert = document.modelspace().add_blockref("OUTER", (30, 40), attributes)
    drawn = [entity for entity in read(document) if entity.curve is not None]
    assert [entity.block for entity in drawn] == ["OUTER/INNER"] * 6
    for entity, raw in zip(drawn, inner, strict=True):
        places = insert.matrix44().transform_vertices(outer[0].matrix44().transform_vertices(samples(raw)))
        assert farthest(entity.curve, places) < (1e-6 if entity.error else 1e-9)
        assert np.abs(entity.curve.bulges).max() <= 1.0 + 1e-12
    if abs(xscale) == abs(yscale) and abs(inner_x) == abs(inner_y):
        (nested,) = insert.virtual_entities()
        for entity, exact in zip(drawn, nested.virtual_entities(), strict=True):
            assert farthest(entity.curve, samples(exact)) < 1e-6


def test_layer_0_in_a_block_is_the_layer_of_the_insert() -> None:
    document = ezdxf.new()
    block = document.blocks.new("B")
    block.add_circle((0, 0), 1)
    block.add_circle((5, 0), 1, dxfattribs={"layer": "OWN"})
    document.modelspace().add_blockref("B", (0, 0), {"layer": "CUT"})
    assert [entity.layer for entity in read(document)] == ["CUT", "CUT", "OWN"]


@pytest.mark.parametrize("extrusion", [(0, 0, 1), (0, 0, -1), (0, 0, -5)])
def test_entities_in_object_coordinates_lie_where_the_extrusion_puts_them(extrusion: Any) -> None:
    document = ezdxf.new()
    msp = document.modelspace()
    attributes = {"extrusion": extrusion}
    msp.add_arc((4, 1), 6, 30, 100, dxfattribs=attributes)
    msp.add_lwpolyline([(0, 0, 0.5), (10, 0, -2), (10, 8, 0)], format="xyb", close=True, dxfattribs=attributes)
    msp.add_polyline2d([(0, 0, 0.5), (10, 0, 0), (10, 8, 0)], format="xyb", dxfattribs=attributes)
    ocs = OCS(Vec3(extrusion))
    arc, light, heavy = (entity.curve for entity in read(document))
    exact = ConstructionArc((4, 1), 6, 30, 100)
    assert farthest(arc, [ocs.to_wcs(Vec3(place)) for place in exact.vertices(exact.angles(9))]) < 1e-9
    assert curves.length(arc) == pytest.approx(6e-3 * math.radians(70), rel=1e-12)
    for curve, entity in ((light, msp[1]), (heavy, msp[2])):
        for part in entity.virtual_entities():
            assert farthest(curve, samples(part)) < 1e-9
    assert np.abs(light.bulges).max() <= 1.0


def test_an_extrusion_of_zero_means_upright() -> None:
    document = ezdxf.new()
    circle = document.modelspace().add_circle((3, 4), 1)
    circle.dxf.set("extrusion", (0, 0, 1))
    circle.dxf.__dict__["extrusion"] = Vec3(0, 0, 0)
    assert curves.bounds(only(document)) == pytest.approx((0.002, 0.003, 0.004, 0.005))


@pytest.mark.parametrize("ratio", [0.05, 0.5, 1.0])
def test_an_ellipse_is_followed_within_a_micrometre(ratio: float) -> None:
    document = ezdxf.new()
    whole = document.modelspace().add_ellipse((1, 2), (30, 10), ratio)
    part = document.modelspace().add_ellipse((1, 2), (30, 10), ratio, 1.0, 6.0, dxfattribs={"extrusion": (0, 0, -1)})
    first, second = read(document)
    assert first.curve is not None
    assert second.curve is not None
    assert farthest(first.curve, whole.vertices(np.linspace(0, 2 * math.pi, 300))) < 1e-6
    assert farthest(second.curve, part.vertices(np.linspace(1.0, 6.0, 300))) < 1e-6
    assert len(first.curve.bulges) == 2 or ratio != 1.0


def test_a_fitted_polyline_is_its_fitted_vertices_without_the_frame() -> None:
    document = ezdxf.new()
    line = document.modelspace().add_polyline2d([(0, 0), (1, 5), (2, 0), (3, 1)])
    line.dxf.flags = 4
    for vertex, flag in zip(line.vertices, (16, 8, 8, 16), strict=True):
        vertex.dxf.flags = flag
    assert only(document).points == pytest.approx(1e-3 * np.array([(1, 5), (2, 0)]))


def test_a_flat_polyline_in_space_is_read_as_lines() -> None:
    document = ezdxf.new()
    document.modelspace().add_polyline3d([(0, 0, 4), (1, 5, 4), (2, 0, 4)])
    assert only(document).points == pytest.approx(1e-3 * np.array([(0, 0), (1, 5), (2, 0)]))


def test_a_constant_height_is_flat() -> None:
    document = ezdxf.new()
    document.modelspace().add_circle((0, 0, 12), 3)
    document.modelspace().add_lwpolyline([(0, 0), (1, 1)], dxfattribs={"elevation": 12})
    assert len(read(document)) == 2


def test_an_entity_of_an_unknown_kind_is_listed_with_its_layer(tmp_path: Path) -> None:
    document = ezdxf.new()
    document.modelspace().add_circle((0, 0), 1, dxfattribs={"layer": "CUT"})
    document.saveas(tmp_path / "a.dxf")
    text = (tmp_path / "a.dxf").read_text()
    (tmp_path / "b.dxf").write_text(text.replace("\nCIRCLE\n", "\nAEC_WALL\n", 1))
    (entity,) = read(ezdxf.readfile(tmp_path / "b.dxf"))
    assert (entity.kind, entity.layer) == ("AEC_WALL", "CUT")
    assert entity.reason == "an object that only the program that made it can draw"
    (tmp_path / "c.dxf").write_text(text.replace("\nCIRCLE\n", "\n47.9\n", 1))
    (entity,) = read(ezdxf.readfile(tmp_path / "c.dxf"))
    assert (entity.kind, entity.lost) == ("UNKNOWN", True)
    assert entity.reason == "where a kind of entity is expected the file says '47.9'"


def test_a_file_without_a_modelspace_is_refused() -> None:
    document = ezdxf.new()
    del document.layouts._layouts["MODEL"]
    with pytest.raises(DrawingError, match="no modelspace"):
        read(document)


def test_a_name_with_bytes_of_no_encoding_is_printable() -> None:
    document = ezdxf.new()
    document.modelspace().add_circle((0, 0), 1, dxfattribs={"layer": "M\udcfcll"})
    (entity,) = read(document)
    entity.where.encode("utf-8")
    assert entity.layer == "M�ll"
