"""The power-speed grid."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from deltacam.cutting.process import check_process, load_process, process_names
from deltacam.drawing.reader import read_drawing
from deltacam.drawing.testcuts.line import ENGRAVED
from deltacam.drawing.testcuts.power_grid import STEPS, feeds, power_grid, powers
from deltacam.drawing.testcuts.strokes import engraved, width
from deltacam.drawing.testcuts.write import to_dxf
from deltacam.model import PowerLaw, Selection

ACRYLIC = load_process("acrylic-3mm-co2")


@pytest.mark.parametrize("name", process_names())
def test_every_cell_is_a_possible_process_about_that_of_the_grid(name: str) -> None:
    process = load_process(name)
    for cell in power_grid(process).cells:
        if cell.power is not None and cell.feed is not None:
            check_process(replace(process, power=cell.power, feed=cell.feed))
    assert powers(process)[0] <= process.power <= powers(process)[-1]
    low, high = process.feeds or (process.feed, process.feed)
    np.testing.assert_allclose([min(feeds(process)[0], low), max(feeds(process)[-1], high)], [low, high], rtol=0.41)


def test_every_square_has_a_layer_and_a_place_of_its_own() -> None:
    cells = power_grid(ACRYLIC).cells
    assert len(cells) == STEPS**2 + 1
    assert len({cell.layer for cell in cells}) == len({cell.place for cell in cells}) == len(cells)


def test_the_place_of_a_cell_is_where_its_square_lies_in_the_grid(tmp_path: Path) -> None:
    grid = power_grid(ACRYLIC)
    path = tmp_path / "grid.dxf"
    path.write_bytes(to_dxf(grid.lines))
    squares = np.array([cell.place for cell in grid.cells if cell.power is not None])
    centre = {}
    for cell in grid.cells:
        drawing = read_drawing(path, selection=Selection(layers=(cell.layer,)))
        points = np.concatenate([contour.curve.points for contour in drawing.contours])
        centre[cell] = 0.5 * (points.min(axis=0) + points.max(axis=0))
        assert len(drawing.contours) == 1 or cell.layer == ENGRAVED
    middle = np.mean([place for cell, place in centre.items() if cell.power is not None], axis=0)
    np.testing.assert_allclose(squares.mean(axis=0), 0.0, atol=1e-9)
    for cell, place in centre.items():
        np.testing.assert_allclose(place - middle, cell.place, atol=1e-8)


def test_powers_go_upwards_and_feeds_to_the_right() -> None:
    cells = [cell for cell in power_grid(ACRYLIC).cells if cell.power is not None]
    assert [cell.power for cell in sorted(cells, key=lambda one: one.place[1])] == [
        power for power in powers(ACRYLIC) for _ in feeds(ACRYLIC)
    ]
    assert [cell.feed for cell in sorted(cells, key=lambda one: one.place[0])] == [
        feed for feed in feeds(ACRYLIC) for _ in powers(ACRYLIC)
    ]


def test_one_begins_with_what_burns_least() -> None:
    cells = power_grid(ACRYLIC).cells
    assert cells[0].layer == ENGRAVED
    assert (cells[1].power, cells[1].feed) == (powers(ACRYLIC)[0], feeds(ACRYLIC)[-1])
    assert (cells[-1].power, cells[-1].feed) == (powers(ACRYLIC)[-1], feeds(ACRYLIC)[0])


def test_no_power_is_below_what_the_power_law_allows() -> None:
    process = replace(ACRYLIC, power=0.15, power_law=PowerLaw(0.3, 1.0, 0.1404))
    assert min(powers(process)) >= 0.1404
    assert len(set(powers(process))) == len(powers(process))


def test_the_power_is_never_more_than_the_laser_has() -> None:
    assert powers(replace(ACRYLIC, power=1.0))[-1] == 1.0


def test_what_cannot_be_engraved_has_no_labels() -> None:
    grid = power_grid(replace(ACRYLIC, engrave_feed=None, engrave_power=None))
    assert all(cell.power is not None for cell in grid.cells)
    assert all(line.closed for line in grid.lines)


@pytest.mark.parametrize("letter", "0123456789.FKP")
def test_a_character_is_as_high_as_asked_and_narrower_than_its_room(letter: str) -> None:
    points = np.concatenate([line.points for line in engraved(letter, at=(1.0, 2.0), height=6e-3)])
    (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
    assert left >= 1.0
    assert right < 1.0 + width(letter, height=6e-3)
    assert bottom == pytest.approx(2.0)
    assert letter == "." or top == pytest.approx(2.006)
