"""What is lost, not flat or wide: a finding, and the rest of the drawing is read all the same."""

import math
import re
from typing import Any

import ezdxf
import pytest
from ezdxf.math import Vec3

from deltacam.drawing.entities import walk

NOT_FLAT = {
    "two heights": (lambda msp: (msp.add_circle((0, 0, 0), 3), msp.add_circle((0, 0, 1), 3)), "not flat: this lies at"),
    "slope": (lambda msp: msp.add_line((0, 0, 0), (1, 1, 1)), "not flat: z runs from 0 to 1 mm"),
    "tilt": (lambda msp: msp.add_circle((0, 0), 3, dxfattribs={"extrusion": (0, 1, 1)}), "not flat"),
    "tilted bulge": (
        lambda msp: msp.add_lwpolyline([(0, 0, 1), (5, 0, 1)], format="xyb", dxfattribs={"extrusion": (0, 1, 1)}),
        "not flat",
    ),
}


LOST = {
    "nan": (lambda msp: msp.add_line((0, 0), (math.nan, 1)), "a coordinate is not a number"),
    "far": (lambda msp: msp.add_line((0, 0), (1e10, 1)), "beyond the limit"),
    "far circle": (lambda msp: msp.add_circle((1e10, 0), 3), "beyond the limit"),
    "endless arc": (lambda msp: msp.add_lwpolyline([(0, 0, 1e9), (5, 0, 0)], format="xyb"), "beyond the limit"),
    "radius": (lambda msp: msp.add_circle((0, 0), -3), "negative"),
    "same angles": (lambda msp: msp.add_arc((0, 0), 3, 90, 90), "same angle"),
    "missing block": (lambda msp: msp.add_blockref("NONE", (0, 0)), "NONE that is inserted here is not in the file"),
    "knots": (
        lambda msp: setattr(msp.add_spline_control_frame([(0, 0), (1, 2), (3, 0), (4, 4)]), "knots", [0, 0, 1, 1]),
        "knots do not go with",
    ),
    "falling knots": (
        lambda msp: setattr(
            msp.add_spline_control_frame([(0, 0), (1, 2), (3, 0), (4, 4)]), "knots", [1, 1, 1, 1, 0, 0, 0, 0]
        ),
        "do not increase",
    ),
    "weights": (
        lambda msp: setattr(msp.add_spline_control_frame([(0, 0), (1, 2), (3, 0), (4, 4)]), "weights", [1, 0, 1, 1]),
        "positive weight",
    ),
    "no radius": (lambda msp: without(msp.add_circle((0, 0), 3), "radius"), "it gives no radius"),
    "no end": (lambda msp: without(msp.add_line((0, 0), (3, 3)), "end"), "it gives no end"),
    "null axis": (lambda msp: put(msp.add_ellipse((0, 0), (3, 0), 0.5), major_axis=Vec3()), "its major axis"),
    "upright axis": (lambda msp: put(msp.add_ellipse((0, 0), (3, 0), 0.5), major_axis=Vec3(0, 0, 1)), "its major axis"),
    "no ratio": (lambda msp: put(msp.add_ellipse((0, 0), (3, 0), 0.5), ratio=0.0), "the ratio 0"),
    "array of nan": (
        lambda msp: put(msp.add_blockref("KNOWN", (0, 0), {"row_count": 2, "row_spacing": 1}), row_spacing=math.nan),
        "not a number",
    ),
    "vanishing": (lambda msp: put(msp.add_blockref("KNOWN", (0, 0)), xscale=0.0), "makes the block vanish"),
    "far block": (lambda msp: msp.add_blockref("KNOWN", (1e12, 0)), "beyond the limit"),
}


def put(entity: Any, **values: Any) -> None:
    """Numbers as a file may hold them, past the checks of ezdxf."""
    entity.dxf.__dict__.update(values)


def without(entity: Any, name: str) -> None:
    """The entity as a file may hold it, with a number missing."""
    entity.dxf.discard(name)


def drawn_by(draw: Any) -> walk.Drawn:
    """What is read of a sound line and what ``draw`` draws; the block KNOWN is in the file."""
    document = ezdxf.new()
    document.blocks.new("KNOWN").add_circle((0, 0), 1)
    document.modelspace().add_line((0, 0), (7, 7))
    draw(document.modelspace())
    return walk.read(document, 1e-3)


@pytest.mark.parametrize(("draw", "what"), LOST.values(), ids=LOST)
def test_what_cannot_be_right_is_lost_and_blocks_and_the_rest_is_read(draw: Any, what: str) -> None:
    found = drawn_by(draw)
    (finding,) = found.findings
    (lost,) = [entity for entity in found.entities if entity.lost]
    assert re.search(what, lost.reason)
    assert re.search(what, finding.what)
    assert (finding.kind, finding.blocks, finding.where) == ("lost", True, lost.where)
    assert finding.hint
    assert not lost.is_insert
    assert len(found.curves) == 1
    assert lost in found.without_curve()


@pytest.mark.parametrize(("draw", "what"), NOT_FLAT.values(), ids=NOT_FLAT)
def test_what_is_not_flat_is_projected_and_blocks(draw: Any, what: str) -> None:
    found = drawn_by(draw)
    finding = found.findings[0]
    assert re.search(what, finding.what)
    assert (finding.kind, finding.blocks, finding.place is None) == ("not_flat", True, False)
    assert "project" in finding.hint
    assert "#" in finding.where
    assert len(found.curves) == len(found.entities)
    assert not any(entity.lost for entity in found.entities)


def test_the_height_of_most_curves_is_the_height_of_the_drawing() -> None:
    document = ezdxf.new()
    for z in (3, 5, 5, 7, 5):
        document.modelspace().add_circle((0, 0, z), 1)
    first, second = walk.read(document, 1e-3).findings
    assert first.what == "the drawing is not flat: this lies at z = 3 mm, most others at 5 mm"
    assert second.what == "the drawing is not flat: this lies at z = 7 mm, most others at 5 mm"


def test_findings_about_many_entities_are_counted_not_listed() -> None:
    document = ezdxf.new()
    msp = document.modelspace()
    for i in range(30):
        msp.add_circle((i, 0), -1)
    msp.add_blockref("NONE", (0, 0))
    findings = walk.read(document, 1e-3).findings
    assert len(findings) == 22
    assert findings[-1].what == "10 more CIRCLE entities are lost"
    assert findings[-1].blocks


def test_one_damaged_entity_in_a_block_is_named_once_however_often_it_is_inserted() -> None:
    document = ezdxf.new()
    document.blocks.new("B").add_circle((0, 0), -1)
    grid = {"row_count": 30, "column_count": 20, "row_spacing": 10, "column_spacing": 10}
    document.modelspace().add_blockref("B", (0, 0), grid)
    found = walk.read(document, 1e-3)
    assert [entity.lost for entity in found.entities] == [False] + [True] * 600
    assert len(found.findings) == 1


def test_a_width_is_reported_and_the_centre_line_read() -> None:
    document = ezdxf.new()
    msp = document.modelspace()
    msp.add_lwpolyline([(0, 0), (5, 0)], dxfattribs={"const_width": 0.5})
    msp.add_lwpolyline([(0, 0, 0, 1), (5, 0, 0, 0)], format="xyse")
    msp.add_polyline2d([(0, 0, 1), (5, 5, 0)], format="xys")
    msp.add_lwpolyline([(0, 0), (5, 9)])
    found = walk.read(document, 1e-3)
    (finding,) = found.findings
    assert (finding.kind, finding.blocks) == ("wide", False)
    assert finding.what == "3 polylines have a width: their centre lines are used"
    assert len(found.curves) == 4
