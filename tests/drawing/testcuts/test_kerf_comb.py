"""The kerf comb."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely

from deltacam.cutting.process import load_process
from deltacam.drawing.reader import read_drawing
from deltacam.drawing.testcuts.kerf_comb import BARS, SMALLEST, bar_width, kerf_comb, kerf_from_gap, planned_gap
from deltacam.drawing.testcuts.write import to_dxf
from deltacam.model import Operation, Process

STEEL = load_process("steel-1mm-fibre")


def cut_lines(process: Process) -> list[shapely.Polygon]:
    return [shapely.Polygon(line.points) for line in kerf_comb(process) if line.closed]


@pytest.mark.parametrize("true", [0.05e-3, 0.15e-3, 0.31e-3])
def test_the_gap_of_bars_that_are_cut_tells_the_kerf(true: float) -> None:
    """Cut along the planned path with another kerf, and push the bars together."""
    _, window, *bars = cut_lines(STEEL)
    over = 0.5 * (true - STEEL.kerf)
    opening = window.buffer(over, join_style="mitre")
    left = [bar.buffer(-over, join_style="mitre") for bar in bars]
    widths = [bar.bounds[2] - bar.bounds[0] for bar in left]
    gap = opening.bounds[2] - opening.bounds[0] - sum(widths)
    assert len(widths) == BARS
    assert kerf_from_gap(gap, STEEL) == pytest.approx(true, abs=1e-6)


def test_the_planned_gap_is_the_planned_kerf() -> None:
    assert kerf_from_gap(planned_gap(STEEL), STEEL) == STEEL.kerf


@pytest.mark.parametrize("thickness", [0.0, 1e-3, 10e-3])
def test_bars_and_gaps_are_as_wide_as_thick_material_is_thick(thickness: float) -> None:
    process = replace(STEEL, thickness=thickness)
    frame, window, *bars = cut_lines(process)
    unit = max(SMALLEST, thickness)
    assert bar_width(process) == unit
    assert frame.contains_properly(window)
    assert all(window.contains_properly(bar) for bar in bars)
    apart = [one.distance(two) for i, one in enumerate(bars) for two in bars[:i]]
    assert min(apart) == pytest.approx(unit)
    assert min(bar.distance(window.exterior) for bar in bars) == pytest.approx(unit)


def test_the_planned_kerf_is_engraved_into_the_frame() -> None:
    lines = kerf_comb(STEEL)
    frame, window = (shapely.Polygon(line.points) for line in lines[:2])
    strokes = [shapely.LineString(line.points) for line in lines if not line.closed]
    assert strokes
    assert all(frame.contains_properly(stroke) and window.disjoint(stroke) for stroke in strokes)
    assert all(line.closed for line in kerf_comb(replace(STEEL, engrave_feed=None, engrave_power=None)))


def test_a_comb_is_read_as_bars_in_a_window_in_a_frame(tmp_path: Path) -> None:
    path = tmp_path / "comb.dxf"
    path.write_bytes(to_dxf(kerf_comb(STEEL)))
    drawing = read_drawing(path)
    depths = [contour.depth for contour in drawing.contours if contour.operation is Operation.CUT]
    assert sorted(depths) == [0, 1, *[2] * BARS]
    assert drawing.metres_per_unit == 1e-3
    assert not drawing.findings


def test_the_same_process_gives_the_same_bytes() -> None:
    assert to_dxf(kerf_comb(STEEL)) == to_dxf(kerf_comb(STEEL))
    assert to_dxf(kerf_comb(STEEL)) != to_dxf(kerf_comb(replace(STEEL, kerf=0.2e-3)))


def test_lines_are_locked() -> None:
    with pytest.raises(ValueError, match="read-only"):
        kerf_comb(STEEL)[0].points[0] = np.zeros(2)
