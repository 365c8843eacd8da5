"""The figures show what the setpoints do; their numbers are decoded as a browser does it."""

import base64
import json
import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from shapely import MultiLineString, Polygon, distance, points

from deltacam.model import Drawing, Mode
from deltacam.program.program import Program
from deltacam.report.bands import RAPID, bands
from deltacam.report.motion import motion_of
from deltacam.report.motion_figure import deviation_figure, motion_figure
from deltacam.report.palette import Ink, css, dark_rules
from deltacam.report.payload import payload, to_script
from deltacam.report.samples import Sampling
from deltacam.report.view import View
from deltacam.report.workspace_figure import workspace_figure
from deltacam.verification.evidence import gather
from tests.bench import Bench

KINDS = {"f4": "<f4", "u1": "u1", "u4": "<u4"}


def unpacked(array: dict[str, str]) -> np.ndarray:
    return np.frombuffer(base64.b64decode(array["bdata"]), dtype=KINDS[array["dtype"]]).astype(float)


def made(program: Program, drawing: Drawing | None) -> tuple[dict[str, Any], list[Ink]]:
    evidence = gather(program, program.robot)
    data, inks = payload(evidence, drawing, View.around(evidence, drawing))
    return json.loads(to_script(data)), inks


def long(program: Program) -> Program:
    """The program over and over, so long that it is thinned."""
    times = 1 + 40_000 // len(program.q)
    q, power, block = (np.concatenate([column] * times) for column in (program.q, program.power, program.block))
    return replace(program, q=q, power=power, block=block)


def route(data: dict[str, Any]) -> Iterator[tuple[int, list[int], np.ndarray]]:
    """Band, colours and points, mm, of every stretch."""
    way = np.column_stack([unpacked(data["route"][axis]) for axis in "xy"])
    first = unpacked(data["route"]["first"]).astype(int)
    ends = [*first[1:], len(way) - 1]
    colours = np.array([unpacked(column) for column in data["route"]["colours"]]).astype(int).T
    for start, end, band, colour in zip(first, ends, unpacked(data["route"]["band"]), colours, strict=True):
        yield int(band), colour.tolist(), way[start : end + 1]


@pytest.mark.parametrize("longer", [False, True])
def test_the_path_is_within_the_stated_distance_of_the_setpoints(bench: Bench, *, longer: bool) -> None:
    program = long(bench.program()) if longer else bench.program()
    data, _ = made(program, bench.drawing)
    evidence = gather(program, program.robot)
    lines = MultiLineString([way for _, _, way in route(data)])
    within = data["route"]["within"]
    assert within == pytest.approx(10e-3 if longer else 1e-3, rel=0.05)
    assert distance(lines, points(1e3 * evidence.sheet[:: 7 if longer else 1])).max() < within + 1e-5
    assert len(unpacked(data["route"]["x"])) < len(program.q)


def test_every_setpoint_lies_on_a_stretch_of_its_band_and_of_its_colours(bench: Bench) -> None:
    program = bench.shifted_outwards(bench.program(), 30e-6)
    data, _ = made(program, bench.drawing)
    evidence = gather(program, program.robot)
    band, speed = bands(evidence), 1e3 * motion_of(evidence).speed[:-1]
    names = [colouring["name"] for colouring in data["colourings"]]
    assert names == ["Speed", "Deviation", "Energy", "Limit"]
    step = float(data["colourings"][0]["labels"][1])
    slow = {colour[0] for kind, colour, _ in route(data) if kind != RAPID}
    assert max(slow) == pytest.approx(speed[band != RAPID].max() / step, abs=0.6)
    assert {kind for kind, _, _ in route(data)} == set(band.tolist())
    over = [way for _, colour, way in route(data) if colour[1] == 9]
    assert len(over) == 1
    assert data["colourings"][1]["labels"][9] == "over 20"
    row = int(np.argmax(np.hypot(*(1e3 * evidence.sheet - over[0].mean(axis=0)).T) < 0.5))
    assert evidence.block_of(row).contour == 2


def test_a_thinned_series_has_the_extremes_of_all_ticks(bench: Bench) -> None:
    program = bench.program()
    q = long(program).q.copy()
    q[31_234, 2] += 1e-3
    program = replace(long(program), q=q)
    data, _ = made(program, bench.drawing)
    motion = motion_of(gather(program, program.robot))
    assert data["step"] == Sampling.of(len(q)).step == 4
    jerk = np.degrees(motion.joints[3][2])
    low, high = (unpacked(part) for part in data["series"]["joint jerk 3"])
    assert (low.min(), high.max()) == pytest.approx((jerk.min(), jerk.max()), rel=1e-6)
    assert abs(int(high.argmax()) * 4 - 31_234) < 8
    x = unpacked(data["place"][0])
    assert x == pytest.approx(1e3 * gather(program, program.robot).sheet[::4, 0], abs=1e-4)


def test_the_block_of_a_sample_is_named_by_contour_layer_and_handle(bench: Bench) -> None:
    program = bench.program()
    data, _ = made(program, bench.drawing)
    at = unpacked(data["blocks"]["at"]).astype(int)
    kind, contour, layer, handle = data["blocks"]["of"][at[1500]]
    block = program.blocks[int(program.block[1500])]
    assert (kind, contour, handle) == (block.kind.value, block.contour, block.handles[0])
    assert data["blocks"]["layers"][layer] == "CUT"
    strange = replace(program, block=np.where(np.arange(len(at)) == 7, 999, program.block))
    data, _ = made(strange, bench.drawing)
    assert data["blocks"]["of"][int(unpacked(data["blocks"]["at"])[7])] == ["rapid", None, 0, ""]


def test_limits_are_levels_of_the_charts_in_one_colour_or_one_per_joint(program: Program) -> None:
    joints = replace(program.robot.joints, max_speed=(1.0, 2.0, 3.0), max_jerk=(1e4, 1e4, 1e4))
    evidence = gather(program, replace(program.robot, joints=joints))
    figure = motion_figure(evidence, motion_of(evidence))
    levels: dict[str, list[float]] = {}
    for shape in figure["layout"]["shapes"]:
        levels.setdefault(shape["yref"], []).append(shape["y0"])
    assert levels["y"] == [100.0]
    assert levels["y2"] == pytest.approx([1000.0, 100.0])
    assert levels["y3"] == pytest.approx([-45.0, 95.0])
    assert levels["y4"] == pytest.approx(np.degrees([-1.0, -2.0, -3.0, 1.0, 2.0, 3.0]))
    assert levels["y6"] == pytest.approx(np.degrees([-1e4, 1e4]))
    for name, values in levels.items():
        low, high = figure["layout"][name.replace("y", "yaxis")]["range"]
        assert low <= min(values)
        assert max(values) <= high
    assert [line["series"] for line in figure["lines"] if line["axis"] == "y4"] == [
        f"joint speed {i}" for i in (1, 2, 3)
    ]


def test_a_value_far_beyond_its_limit_does_not_flatten_the_others(program: Program) -> None:
    q = program.q.copy()
    q[1000] += 0.5
    program = replace(program, q=q)
    evidence = gather(program, program.robot)
    figure = motion_figure(evidence, motion_of(evidence))
    limit = np.degrees(program.robot.joints.max_speed[0])
    assert figure["layout"]["yaxis4"]["range"][1] < 2.5 * limit
    assert any("% " in word["text"] or word["text"].endswith("%") for word in figure["layout"]["annotations"])


def test_the_deviation_is_over_the_length_with_its_limit() -> None:
    figure = deviation_figure(np.array([np.nan, 3e-6, 5e-6]), 20e-6, 0.75)
    assert figure["layout"]["xaxis"]["range"] == [0.0, 750.0]
    assert [shape["y0"] for shape in figure["layout"]["shapes"]] == pytest.approx([20.0])
    assert "5 of 20" in [word["text"] for word in figure["layout"]["annotations"]]


def test_holes_are_left_out_of_the_material(bench: Bench) -> None:
    data, _ = made(bench.program(), bench.drawing)
    (filled,) = [trace for trace in data["part"]["below"] if trace.get("fill") == "toself"]
    x, y = unpacked(filled["x"]), unpacked(filled["y"])
    gaps = np.flatnonzero(np.isnan(x))
    rings = [np.column_stack([x, y])[start:end] for start, end in zip([0, *(gaps[:-1] + 1)], gaps, strict=True)]
    turns = [Polygon(ring).exterior.is_ccw for ring in rings]
    assert turns == [not contour.is_hole for contour in bench.drawing.contours]


def test_numbers_that_would_lie_on_each_other_go_around_their_dot_or_are_left_out(bench: Bench) -> None:
    program = bench.program()
    again = replace(program, **{name: np.concatenate([getattr(program, name)] * 6) for name in ("q", "power", "block")})
    data, _ = made(again, bench.drawing)
    (dots,) = data["part"]["above"]
    assert len(unpacked(dots["x"])) == 24
    numbers = data["part"]["marks"][-1]["trace"]
    shown = list(zip(unpacked(numbers["x"]), unpacked(numbers["y"]), numbers["textposition"], strict=True))
    assert numbers["text"][:4] == ["1", "2", "3", "4"]
    assert 8 <= len(shown) == len(numbers["text"]) == len(set(shown)) <= 16


def test_the_machine_is_seen_whole_with_the_part_where_it_is_placed(bench: Bench) -> None:
    program = bench.program()
    evidence = gather(program, program.robot)
    figure = workspace_figure(evidence, bench.drawing, View.around(evidence, bench.drawing))
    seen = {axis: figure["layout"][f"{axis}axis"]["range"] for axis in "xy"}
    for trace in figure["traces"]:
        for axis in "xy":
            values = unpacked(trace[axis]) if isinstance(trace[axis], dict) else np.array(trace[axis])
            assert seen[axis][0] <= np.nanmin(values) <= np.nanmax(values) <= seen[axis][1]
    assert seen["y"][0] < -(130.0 + 300.0)
    box = next(trace for trace in figure["traces"] if trace.get("line", {}).get("dash") == "3px,3px")
    # A rectangle with round corners is one without, grown by their radius.
    sides = [50.0 * np.cos(0.3) + 30.0 * np.sin(0.3) + 10.0, 50.0 * np.sin(0.3) + 30.0 * np.cos(0.3) + 10.0]
    assert [np.ptp(unpacked(box[axis])[:-1]) for axis in "xy"] == pytest.approx(sides, abs=0.1)
    (contours,) = [trace for trace in figure["traces"] if trace["type"] == "contour"]
    middle = contours["z"][20][20]
    mu = program.robot.pressure_angles([[0.0, 0.0, -0.65]])
    assert middle == pytest.approx(float(np.degrees(np.max(mu))), abs=0.01)


def test_every_colour_of_the_figures_has_a_dark_one(bench: Bench) -> None:
    whole = bench.shifted_outwards(bench.program(), 30e-6)
    lost = replace(whole, q=np.where(np.arange(len(whole.q))[:, None] == 3, 3.0, whole.q))
    for program, least in ((whole, 30), (lost, 15)):
        data, inks = made(program, bench.drawing)
        used = set(re.findall(r"#[0-9a-f]{6}", to_script(data)))
        rules = dark_rules(inks)
        assert len(used) > least
        for colour in used:
            assert f'[style*="stroke: {css(Ink(colour, colour))}"]' in rules, colour


def test_the_dark_and_the_light_colours_stand_out_from_their_paper() -> None:
    from deltacam.report import palette

    def luminance(colour: str) -> float:
        rgb = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
        return float(np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4) @ (0.2126, 0.7152, 0.0722))

    def contrast(one: str, other: str) -> float:
        low, high = sorted((luminance(one), luminance(other)))
        return (high + 0.05) / (low + 0.05)

    for ink in (palette.TEXT, palette.STRONG):
        assert min(contrast(ink.light, "#ffffff"), contrast(ink.dark, "#151b23")) > 4.5
    for ink in (*palette.JOINTS, palette.LIMIT, palette.TOOL, palette.OVER):
        assert min(contrast(ink.light, "#ffffff"), contrast(ink.dark, "#151b23")) > 3.0


def test_nothing_is_said_about_deviation_without_a_drawing_or_in_a_frame(bench: Bench) -> None:
    program = bench.program()
    for data, _ in (made(program, None), made(replace(program, mode=Mode.FRAME), bench.drawing)):
        assert "deviation" not in data
        assert "deviation" not in data["series"]
        names = [colouring["name"] for colouring in data["colourings"] if colouring["name"] != "Energy"]
        assert names == ["Speed", "Limit"]


def test_a_program_without_places_has_the_charts_of_its_joints(bench: Bench) -> None:
    program = bench.program()
    q = program.q.copy()
    q[3] = 3.0
    data, _ = made(replace(program, q=q), bench.drawing)
    assert not {"place", "route", "deviation"} & set(data)
    assert "speed" not in data["series"]
    assert {line["axis"] for line in data["motion"]["lines"]} == {"y2", "y3", "y4", "y5"}
