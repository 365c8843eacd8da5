"""What is cut again is as long as it is, and what is only near is not cut again."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.geometry import curve as curves
from deltacam.model import BlockKind, Contour, Curve, Drawing
from deltacam.verification.verify import verify
from tests.bench import Bench

NAME = "material cut twice"


def sheet(*shapes: Curve) -> Drawing:
    contours = tuple(Contour(i, shape, "CUT", (f"{i}A",)) for i, shape in enumerate(shapes, start=1))
    return Drawing("webs.dxf", "ab" * 32, 1e-3, "mm", "header", contours, ())


def rectangle(left: float, bottom: float, right: float, top: float) -> Curve:
    return curves.polygon(np.array([(left, bottom), (right, bottom), (right, top), (left, top)]) * 1e-3)


@pytest.mark.parametrize("again", [2.0, 5.0, 20.0])
def test_what_is_cut_again_is_as_long_as_it_is(bench: Bench, again: float) -> None:
    """Contour 2 has 36.4 mm of way; it goes on for ``again`` mm past its start."""
    length = 2.0 * np.pi * 5.9
    changed = bench.but(order=(2,), turns=1.0 + again / length).program()
    found = bench.check(verify(changed, drawing=bench.drawing), NAME)
    assert found.worst == pytest.approx(again, abs=1.0)
    assert found.passed == (found.worst <= 1.0)
    assert found.contour == 2


@pytest.mark.parametrize("steps", [1, 3, 4, 6])
def test_the_last_step_before_a_lead_out_is_no_second_cut(bench: Bench, steps: int) -> None:
    """A step is 0.8 mm long there; what follows is said to be a lead-out."""
    fast = bench.but(order=(2,), turns=1.3, feed=0.4)
    program = fast.program()
    cut = next(block for block in program.blocks if block.kind is BlockKind.CUT)
    tool = fast.robot.forward(program.q[cut.first : cut.last + 1])[:, :2]
    ways, around = np.cumsum(np.hypot(*np.diff(tool, axis=0).T)), 2.0 * np.pi * (6e-3 - bench.process.kerf / 2.0)
    end = int(np.searchsorted(ways, around)) + steps
    changed = fast.said(program, 2, [BlockKind.CUT, BlockKind.LEAD_OUT], rows=[end])
    again = 1e3 * max(float(ways[end - 2]) - around, 0.0)
    assert fast.check(verify(changed, drawing=fast.drawing), NAME).worst == pytest.approx(again, abs=0.3)


def test_two_parts_whose_cuts_nearly_touch_are_not_cut_twice(bench: Bench) -> None:
    """The paths of two rectangles run 0.02 mm beside each other for 20 mm."""
    one, other = rectangle(0.0, 0.0, 10.0, 20.0), rectangle(10.22, 0.0, 20.0, 20.0)
    paths = {1: rectangle(-0.1, -0.1, 10.1, 20.1), 2: rectangle(10.12, -0.1, 20.1, 20.1)}
    near = bench.but(drawing=sheet(one, other), paths=lambda _: paths, order=(1, 2))
    assert bench.check(verify(near.program(), drawing=near.drawing), NAME).worst == 0.0


def test_the_sides_of_a_sharp_tip_are_not_cut_twice(bench: Bench) -> None:
    tip = curves.polygon(np.array([(0.0, 0.0), (30.0, -0.3), (30.0, 0.3)]) * 1e-3)
    sharp = bench.but(
        drawing=sheet(tip), paths=lambda _: {1: tip}, order=(1,), process=replace(bench.process, kerf=0.0)
    )
    assert bench.check(verify(sharp.program(), drawing=sharp.drawing), NAME).worst == 0.0
