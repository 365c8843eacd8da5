"""Colours, line types and layers as they are seen, against what the file says."""

from typing import Any

import ezdxf
import pytest

from deltacam.drawing.entities import layers, walk
from deltacam.model import Layer


def document() -> Any:
    """A document with the layers RED (red, dashed), OFF and ICE, and the block B."""
    made = ezdxf.new(setup=True)
    made.layers.add("RED", color=1, linetype="DASHED")
    made.layers.add("Off", color=3).off()
    made.layers.add("ICE", true_color=ezdxf.colors.rgb2int((0, 0, 250))).freeze()
    made.blocks.new("B")
    return made


def looks(made: Any) -> list[tuple[str, int, str]]:
    found = walk.read(made, 1e-3).entities
    return [(entity.layer, entity.color, entity.linetype) for entity in found if not entity.is_insert]


COLORS = {
    "own": ({"color": 30}, 30),
    "of the layer": ({}, 1),
    "of the layer by number": ({"color": 256}, 1),
    "of the block, outside of any": ({"color": 0}, 7),
    "unknown layer": ({"layer": "NEW"}, 7),
    "layer that is off": ({"layer": "OFF"}, 3),
    "true colour": ({"true_color": 0x00FE01}, 3),
    "true colour beside the index that the file gives": ({"true_color": 0x00FE01, "color": 40}, 40),
    "black": ({"true_color": 0}, 7),
    "not in the table": ({"color": 257}, 1),
}


@pytest.mark.parametrize(("attributes", "color"), COLORS.values(), ids=COLORS)
def test_a_colour_is_the_index_that_is_seen(attributes: Any, color: int) -> None:
    made = document()
    line = made.modelspace().add_line((0, 0), (1, 0), {"layer": "RED"})
    line.dxf.__dict__.update(attributes)
    assert looks(made)[0][1] == color


LINETYPES = {
    "own": ({"linetype": "CENTER"}, "CENTER"),
    "of the layer": ({}, "DASHED"),
    "of the layer by name": ({"linetype": "ByLayer"}, "DASHED"),
    "of the block, outside of any": ({"linetype": "BYBLOCK"}, "Continuous"),
    "unknown layer": ({"layer": "NEW"}, "Continuous"),
}


@pytest.mark.parametrize(("attributes", "linetype"), LINETYPES.values(), ids=LINETYPES)
def test_a_line_type_is_the_one_that_is_seen(attributes: Any, linetype: str) -> None:
    made = document()
    line = made.modelspace().add_line((0, 0), (1, 0), {"layer": "RED"})
    line.dxf.__dict__.update(attributes)
    assert looks(made)[0][2] == linetype


def test_a_block_hands_its_layer_colour_and_line_type_down() -> None:
    made = document()
    block = made.blocks.get("B")
    block.add_line((0, 0), (1, 0), {"color": 0, "linetype": "BYBLOCK"})
    block.add_line((0, 0), (1, 0))
    block.add_line((0, 0), (1, 0), {"layer": "Off"})
    outer = made.blocks.new("OUTER")
    outer.add_blockref("B", (0, 0), {"color": 0, "linetype": "BYBLOCK"})
    made.modelspace().add_blockref("OUTER", (0, 0), {"layer": "RED", "color": 5, "linetype": "DOT"})
    made.modelspace().add_blockref("B", (0, 0), {"layer": "RED"})
    assert looks(made) == [
        ("RED", 5, "DOT"),
        ("RED", 1, "DASHED"),
        ("Off", 3, "Continuous"),
        ("RED", 1, "DASHED"),
        ("RED", 1, "DASHED"),
        ("Off", 3, "Continuous"),
    ]


def test_the_table_counts_what_each_layer_holds_in_the_order_of_the_file() -> None:
    made = document()
    made.blocks.get("B").add_circle((0, 0), 1)
    msp = made.modelspace()
    msp.add_line((0, 0), (1, 0), {"layer": "ICE"})
    msp.add_text("a", dxfattribs={"layer": "off"})
    msp.add_line((0, 0), (1, 0), {"layer": "OFF"})
    msp.add_blockref("B", (0, 0), {"layer": "New", "row_count": 3, "row_spacing": 5})
    found = walk.read(made, 1e-3)
    assert layers.tabulate(made, found.entities, found.owner) == (
        Layer("ICE", "frozen", 5, "Continuous", 1, 1),
        Layer("Off", "off", 3, "Continuous", 2, 1),
        Layer("New", "on", 7, "Continuous", 4, 3),
    )
