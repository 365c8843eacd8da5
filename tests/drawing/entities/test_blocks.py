"""Where INSERTs put their blocks, and drawings that would grow without end."""

import math
from typing import Any

import ezdxf
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.drawing.entities import blocks, walk
from deltacam.errors import DrawingError
from deltacam.model import Array


def read(document: Any) -> walk.Drawn:
    return walk.read(document, 1e-3)


def centres(found: walk.Drawn) -> Array:
    """The centres of circles, mm, (K, 2)."""
    boxes = 1e3 * found.curves.bounds()
    return 0.5 * (boxes[:, :2] + boxes[:, 2:])


def test_a_block_that_holds_itself_is_refused() -> None:
    document = ezdxf.new()
    document.blocks.new("A").add_blockref("B", (0, 0))
    document.blocks.new("B").add_blockref("A", (0, 0))
    document.modelspace().add_blockref("A", (0, 0))
    with pytest.raises(DrawingError, match=r"nested without end: A/B/A$"):
        read(document)


def test_arrays_that_multiply_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blocks, "MAX_ENTITIES", 1000)
    document = ezdxf.new()
    document.blocks.new("A").add_circle((0, 0), 1)
    grid = {"row_count": 20, "column_count": 20, "row_spacing": 10, "column_spacing": 10}
    document.blocks.new("B").add_blockref("A", (0, 0), grid)
    document.modelspace().add_blockref("B", (0, 0), grid)
    with pytest.raises(DrawingError, match="more than 1000 entities"):
        read(document)
    document.modelspace().delete_all_entities()
    document.modelspace().add_blockref("A", (0, 0), {**grid, "row_count": 30000, "column_count": 30000})
    with pytest.raises(DrawingError, match="an array of 900000000 copies"):
        read(document)


NUMBERS = st.floats(-50.0, 50.0)


@given(
    st.tuples(NUMBERS, NUMBERS, NUMBERS),
    st.tuples(st.floats(0.1, 4.0), st.floats(-4.0, -0.1), st.floats(0.1, 4.0)),
    st.floats(-400.0, 400.0),
    st.sampled_from([(0, 0, 1), (0, 0, -2), (0.3, -0.4, 0.5), (1, 0, 0)]),
    st.tuples(NUMBERS, NUMBERS, NUMBERS),
)
def test_a_block_is_put_where_ezdxf_puts_it(insert: Any, scale: Any, rotation: float, up: Any, base: Any) -> None:
    document = ezdxf.new()
    document.blocks.new("B", base_point=base)
    attributes = {"rotation": rotation, "extrusion": up}
    attributes |= dict(zip(("xscale", "yscale", "zscale"), scale, strict=True))
    raw = document.modelspace().add_blockref("B", insert, attributes)
    found = blocks.placement(raw)
    exact = np.array(list(raw.matrix44())).reshape(4, 4)
    assert found.matrix == pytest.approx(exact[:3, :3], abs=1e-12)
    assert found.offsets == pytest.approx(exact[3:, :3], abs=1e-9)


@pytest.mark.parametrize("extrusion", [(0, 0, 1), (0, 0, -1)])
def test_an_array_turns_with_its_insert_and_is_not_scaled(extrusion: Any) -> None:
    document = ezdxf.new()
    document.blocks.new("HOLE", base_point=(1, 2)).add_circle((3, 0), 1)
    grid = {"row_count": 3, "column_count": 4, "row_spacing": 10, "column_spacing": -20}
    turned = {"rotation": 30, "xscale": 2, "yscale": -2, "extrusion": extrusion}
    raw = document.modelspace().add_blockref("HOLE", (100, 7), {**grid, **turned})
    circles = [entity for one in raw.multi_insert() for entity in one.virtual_entities()]
    exact = [circle.ocs().to_wcs(circle.dxf.center).vec2 for circle in circles]
    assert centres(read(document)) == pytest.approx(np.array(exact), abs=1e-9)


def test_copies_of_an_array_that_lie_on_each_other_are_read_once() -> None:
    document = ezdxf.new()
    document.blocks.new("HOLE").add_circle((0, 0), 1)
    document.modelspace().add_blockref("HOLE", (0, 0), {"row_count": 3, "column_count": 2, "row_spacing": 10})
    assert len(read(document).curves) == 3


def test_a_block_within_an_array_within_an_array_keeps_the_order_of_the_file() -> None:
    document = ezdxf.new()
    document.blocks.new("A").add_circle((0, 0), 1)
    middle = document.blocks.new("B")
    middle.add_line((0, 0), (1, 0))
    middle.add_blockref("A", (5, 0), {"row_count": 2, "row_spacing": 3})
    middle.add_line((0, 0), (2, 0))
    document.modelspace().add_blockref("B", (0, 0), {"column_count": 2, "column_spacing": 100})
    document.modelspace().add_line((0, 0), (3, 0))
    found = read(document)
    kinds = ["LINE", "INSERT", "CIRCLE", "CIRCLE", "LINE"]
    assert [entity.kind for entity in found.entities] == ["INSERT", *kinds, *kinds, "LINE"]
    assert [found.entities[i].kind for i in found.owner] == [*(["LINE", "CIRCLE", "CIRCLE", "LINE"] * 2), "LINE"]
    around = 2.0 * math.pi
    assert 1e3 * found.curves.lengths() == pytest.approx([1, around, around, 2, 1, around, around, 2, 3])
    assert centres(found)[:, 0] == pytest.approx([0.5, 5, 5, 1, 100.5, 105, 105, 101, 1.5])
    assert centres(found)[:, 1] == pytest.approx([0, 0, 3, 0, 0, 0, 3, 0, 0])


REFERENCES = {"external": 4, "overlay": 8, "depends on an external one": 16}


@pytest.mark.parametrize("flags", REFERENCES.values(), ids=REFERENCES)
def test_a_block_in_another_file_is_lost_and_its_path_is_not_opened(flags: int) -> None:
    document = ezdxf.new()
    block = document.blocks.new("PART")
    block.block.dxf.flags = flags
    block.block.dxf.xref_path = "/etc/passwd"
    document.modelspace().add_blockref("PART", (0, 0))
    found = read(document)
    (finding,) = found.findings
    assert finding.what == "the INSERT is lost: the block PART that is inserted here is in another file"
    assert "bind" in finding.hint


def test_blocks_that_double_at_each_level_are_counted_before_they_are_built() -> None:
    document = ezdxf.new()
    document.blocks.new("B0").add_circle((0, 0), 1)
    for i in range(1, 31):
        block = document.blocks.new(f"B{i}")
        block.add_blockref(f"B{i - 1}", (0, 0))
        block.add_blockref(f"B{i - 1}", (5, 0))
    document.modelspace().add_blockref("B30", (0, 0))
    with pytest.raises(DrawingError, match="more than 5000000 entities"):
        read(document)


@pytest.mark.parametrize("levels", [40, 3000])
def test_blocks_that_are_nested_too_deep_are_refused(levels: int) -> None:
    document = ezdxf.new()
    document.blocks.new("B0").add_circle((0, 0), 1)
    for i in range(1, levels):
        document.blocks.new(f"B{i}").add_blockref(f"B{i - 1}", (0, 0))
    document.modelspace().add_blockref(f"B{levels - 1}", (0, 0))
    with pytest.raises(DrawingError, match="more than 32 deep"):
        read(document)


def test_copies_with_too_many_vertices_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(walk, "MAX_VERTICES", 1000)
    document = ezdxf.new()
    document.blocks.new("A").add_lwpolyline([(i, i * i) for i in range(60)])
    document.modelspace().add_blockref("A", (0, 0), {"row_count": 20, "row_spacing": 10})
    with pytest.raises(DrawingError, match="more than 1000 vertices"):
        read(document)
