"""G-code: its moves run along the tool path of the setpoints, in the same order, time and power."""

import io
import itertools
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from deltacam.errors import ProgramError
from deltacam.geometry import curve as curves
from deltacam.model import Mode, Operation
from deltacam.program import contents, csv, gcode, gcode_writer
from deltacam.program.gcode import HEAD, Moves
from deltacam.program.program import Program
from tests.bench import Bench

HEADER = "".join(f"{word}\n" for word in HEAD).encode()
NASTY = st.text(alphabet=st.characters(codec=None, categories=None), min_size=1, max_size=300)


def written(program: Program) -> bytes:
    stream = io.BytesIO()
    gcode_writer.write(program, stream)
    return stream.getvalue()


def read(content: bytes) -> Moves:
    return gcode.read(io.BytesIO(content), name="plate.gcode")


def refused(content: bytes) -> ProgramError:
    with pytest.raises(ProgramError) as caught:
        read(content)
    assert caught.value.what.isprintable()
    return caught.value


def tool_path(program: Program) -> np.ndarray:
    """Where the tool is at every tick, in the drawing, (N, 2)."""
    base = program.robot.forward(program.q)[:, :2] - (program.placement.x, program.placement.y)
    turn = np.exp(-1j * program.placement.rotation) * (base[:, 0] + 1j * base[:, 1])
    return np.column_stack([turn.real, turn.imag])


def lengths(moves: Moves) -> np.ndarray:
    """From the centres, as complex numbers: another route than that of the writer."""
    ends = moves.ends @ (1.0, 1j)
    starts = np.concatenate([[moves.start @ (1.0, 1j)], ends[:-1]])
    centres = starts + moves.centres @ (1.0, 1j)
    ratio = np.divide(ends - centres, starts - centres, out=np.ones_like(ends), where=starts != centres)
    turn = np.where(moves.motion == 3, np.angle(ratio) % (2 * np.pi), np.angle(1 / ratio) % (2 * np.pi))
    arcs = (moves.motion == 2) | (moves.motion == 3)
    return np.where(arcs, turn * np.abs(starts - centres), np.abs(ends - starts))


def durations(moves: Moves) -> np.ndarray:
    moving = moves.motion != 4
    return np.where(moving, lengths(moves) / np.where(moving, moves.feed, 1.0), moves.dwell)


def distance(moves: Moves, index: int, points: np.ndarray) -> np.ndarray:
    """How far points (N, 2) are from one move, (N,)."""
    start, end = moves.start if index == 0 else moves.ends[index - 1], moves.ends[index]
    if moves.motion[index] in (2, 3):
        centre = start + moves.centres[index]
        return np.abs(np.hypot(*(points - centre).T) - np.hypot(*moves.centres[index]))
    chord = end - start
    share = np.clip((points - start) @ chord / max(chord @ chord, 1e-30), 0.0, 1.0)
    return np.hypot(*(points - start - share[:, None] * chord).T)


def assert_follows(moves: Moves, program: Program) -> None:
    """The setpoints that are played during a move lie on it, and the laser has the same power."""
    path = tool_path(program)
    ticks = np.concatenate([[0.0], np.cumsum(durations(moves))]) * program.rate_hz
    knots = np.rint(ticks).astype(int)
    assert np.abs(ticks - knots).max() < 0.05
    assert knots[-1] == len(path) - 1
    for index, (first, last) in enumerate(itertools.pairwise(knots)):
        assert distance(moves, index, path[first : last + 1]).max() < gcode_writer.TOLERANCE + 5e-9, index
        assert np.abs(path[last] - moves.ends[index]).max() < 1e-9
        assert np.abs(program.power[first:last] - moves.power[index]).max() <= 1e-6
        assert len(set(program.block[first:last].tolist())) == 1
    walked = np.hypot(*np.diff(path, axis=0).T).sum()
    assert lengths(moves).sum() == pytest.approx(walked, rel=2e-3)


def test_every_setpoint_lies_on_the_move_of_its_time(bench_program: Program) -> None:
    assert_follows(read(written(bench_program)), bench_program)


def test_circles_and_rounded_corners_are_arcs(bench_program: Program) -> None:
    moves = read(written(bench_program))
    assert len(moves.motion) < len(bench_program.q) / 50
    assert set(moves.motion.tolist()) == {0, 1, 3, 4}
    radii = np.hypot(*moves.centres[moves.motion == 3].T)
    assert np.abs(radii[:, None] - [5.9e-3, 3.1e-3, 2.9e-3, 5.1e-3]).min(axis=1).min() < 1e-6


def test_engraving_and_cutting_keep_their_power(bench: Bench) -> None:
    drawing = bench.drawing
    engraved = tuple(
        replace(contour, operation=Operation.ENGRAVE) if contour.number == 4 else contour
        for contour in drawing.contours
    )
    program = bench.but(drawing=replace(drawing, contours=engraved)).program()
    moves = read(written(program))
    assert_follows(moves, program)
    assert sorted(set(moves.power.tolist())) == pytest.approx([0.0, 0.15, 0.85])


def test_contours_are_in_order_with_a_wait_at_each_pierce(bench: Bench, bench_program: Program) -> None:
    moves = read(written(bench_program))
    assert moves.dwell[moves.motion == 4] == pytest.approx([0.05] * len(bench.order))
    pierced = moves.ends[moves.motion == 4]
    paths = bench.paths(bench_program.process.kerf / 2)
    for number, place in zip(bench.order, pierced, strict=True):
        _, _, off = curves.nearest(paths[number], place)
        assert off < 1e-8


def test_a_dry_run_cuts_with_the_laser_off_at_the_feed(bench: Bench) -> None:
    program = bench.but(mode=Mode.DRY_RUN).program()
    content = written(program)
    moves = read(content)
    assert_follows(moves, program)
    assert b"M3" not in content
    assert 3 in moves.motion


def test_a_power_at_every_tick_is_followed_and_summed_up_in_the_head(bench_program: Program) -> None:
    on = bench_program.power > 0.0
    power = np.where(on, np.round(0.2 + 0.6 * (np.arange(len(on)) % 97) / 97.0, 3), 0.0)
    program = replace(bench_program, power=power)
    content = written(program)
    assert_follows(read(content), program)
    lines = content.decode("ascii").split("\n")
    assert lines[2] == "(mode cut, power S200 to S794 of S1000)"
    assert max(map(len, lines)) < 250


def test_the_file_looks_as_documented(bench_program: Program) -> None:
    lines = written(bench_program).decode("ascii").split("\n")
    assert lines[0] == "(motion of plate.dxf, made by deltacam)"
    assert lines[2] == "(mode cut, power S850 of S1000)"
    assert tuple(lines[3:9]) == HEAD
    assert re.fullmatch(r"G0 X-?[\d.]+ Y-?[\d.]+", lines[9])
    assert lines[10] == "(block 0: rapid)"
    assert re.fullmatch(r"G0 X15\.1 Y2 F[\d.]+", lines[11])
    assert lines[12:16] == ["(block 1: pierce, contour 4, layer CUT)", "M3 S850", "G4 P0.05", lines[15]]
    assert lines[15] == "(block 2: cut, contour 4, layer CUT)"
    assert lines[-3:] == ["M5", "M2", ""]


@given(layer=NASTY, file=NASTY)
@example(layer="x" * 5_000, file=")\nM3 S1000")
def test_no_name_can_end_a_comment_or_mean_anything_in_it(bench_program: Program, layer: str, file: str) -> None:
    blocks = tuple(replace(block, layer=layer) for block in bench_program.blocks)
    named = replace(bench_program, blocks=blocks, drawing=replace(bench_program.drawing, file=file))
    content = written(named)
    plain = written(bench_program)
    assert len(content.split(b"\n")) == len(plain.split(b"\n"))
    without = [line for line in content.split(b"\n") if not line.startswith(b"(")]
    assert without == [line for line in plain.split(b"\n") if not line.startswith(b"(")]
    for line in content.split(b"\n"):
        assert len(line) < 200
        if line.startswith(b"("):
            assert re.fullmatch(rb"\((motion|robot|mode|block) [A-Za-z0-9 _.+:,-]*\)", line), line
    read(content)


def test_blocks_that_are_not_in_the_list_are_moves_all_the_same(bench_program: Program) -> None:
    content = written(replace(bench_program, blocks=bench_program.blocks[:3]))
    assert b"\n(block 3)\n" in content
    assert_follows(read(content), bench_program)


@pytest.fixture(scope="session")
def through(bench_program: Program) -> Callable[..., Program]:
    """A program in one block through places of the sheet."""

    def build(places: np.ndarray, power: np.ndarray | None = None) -> Program:
        robot, z, count = bench_program.robot, bench_program.placement.z, len(places)
        return replace(
            bench_program,
            q=robot.inverse(np.column_stack([places, np.full(count, z)])),
            power=np.zeros(count) if power is None else power,
            block=np.full(count, 2),
            placement=replace(bench_program.placement, x=0.0, y=0.0, rotation=0.0),
        )

    return build


def test_a_motion_of_nanometres_has_a_feed_above_zero(through: Callable[..., Program]) -> None:
    content = written(through(np.outer(np.linspace(0.0, 4e-9, 401), [1.0, 0.0])))
    assert b"F0.001\n" in content
    assert (read(content).feed > 0.0).all()


def test_zero_has_no_sign(through: Callable[..., Program]) -> None:
    content = written(through(np.array([[0.0, 0.0], [0.01, -1e-10], [-1e-10, 0.01]])))
    assert not re.search(rb"-0\b(?!\.)", content)


def test_the_laser_changes_within_a_block_where_its_power_does(through: Callable[..., Program]) -> None:
    line = np.outer(np.linspace(0.0, 0.01, 9), [1.0, 0.0])
    power = np.array([0.5] * 4 + [1e-7] * 3 + [0.25, 0.25])
    moves = read(written(through(line, power)))
    assert moves.power.tolist() == [0.5, 1e-6, 0.25]  # never so little that it would be off
    assert moves.ends[:, 0] == pytest.approx([5e-3, 8.75e-3, 0.01], abs=1e-9)


def test_a_program_from_a_file_gives_the_same_bytes(through: Callable[..., Program]) -> None:
    program = through(np.random.default_rng(4).uniform(-0.1, 0.1, (50_000, 2)))
    stream = io.BytesIO()
    csv.write(program, stream)
    stream.seek(0)
    assert written(csv.read(stream, name="a")) == written(program)


def test_a_program_of_one_row_has_no_moves(bench_program: Program) -> None:
    one = replace(bench_program, q=bench_program.q[:1], power=[0.0], block=np.array([0]))
    assert len(read(written(one)).motion) == 0


@pytest.mark.parametrize("power", [-0.1, 1.1])
def test_a_power_that_no_laser_has_is_refused(bench_program: Program, power: float) -> None:
    with pytest.raises(ProgramError, match="not from 0 to 1"):
        written(replace(bench_program, power=np.full(len(bench_program.q), power)))


def test_a_motion_that_leaves_the_sheet_is_refused(bench: Bench, bench_program: Program) -> None:
    q = bench_program.q.copy()
    q[7] = bench.robot.inverse(bench.robot.forward(q[[7]]) + np.array([0.0, 0.0, 1e-5]))[0]
    with pytest.raises(ProgramError, match=r"0\.01 mm out of the sheet's plane at tick 7") as caught:
        written(replace(bench_program, q=q))
    assert "deltacam verify" in caught.value.hint


def test_angles_without_a_tool_position_are_refused(bench_program: Program) -> None:
    q = bench_program.q.copy()
    q[7] = (3.0, -3.0, 3.0)
    with pytest.raises(ProgramError) as caught:
        written(replace(bench_program, q=q))
    assert "deltacam verify" in caught.value.hint


START = HEADER + b"G0 X0 Y0\n"
END = b"M5\nM2\n"


@pytest.mark.parametrize(
    ("content", "where", "what"),
    [
        (b"", "line 1", "there is no M2"),
        (b"G20\n", "line 1", "'G20' is not a line that deltacam writes"),
        (b"G90\n", "line 1", "expected G21, found G90"),
        (HEADER + b"G1 X0 Y0 F1\n", "line 7", "expected G0 XY, found G1 XYF"),
        (START + b"G1 X1 Y1\n" + END, "line 8", "'G1 X1 Y1' is not a line"),
        (START + b"G1 Y1 X1 F1\n" + END, "line 8", "is not a line"),
        (START + b"G1  X1 Y1 F1\n" + END, "line 8", "is not a line"),
        (START + b"G1 X1 Y1 Fnan\n" + END, "line 8", "is not a line"),
        (START + b"G1 X1 Y1 F1e9\n" + END, "line 8", "is not a line"),
        (START + b"G1 X1 Y1 F1\r\n" + END, "line 8", "is not a line"),
        (START + b"G1 X12345678901 Y1 F1\n" + END, "line 8", "is not a line"),
        (START + b"(a comment (in a comment))\n" + END, "line 8", "is not a line"),
        (START + b"\n" + END, "line 8", "'' is not a line"),
        (START + b"\xff\n" + END, "line 8", "is not a line"),
        (START + b"G1 X1 Y1 F" + b"1" * 500 + b"\n" + END, "line 8", "is not a line"),
        (START + b"G21\n" + END, "line 8", "G21 has no place here"),
        (START + b"G1 X1 Y1 F0\n" + END, "line 8", "the feed is not above 0"),
        (START + b"G4 P0\n" + END, "line 8", "the wait is not above 0"),
        (START + b"M3 S1001\nG1 X1 Y1 F1\n" + END, "line 9", "the power is not from 0 to 1000"),
        (START + b"M3 S1\nG0 X1 Y1 F1\n" + END, "line 9", "a rapid has the laser on"),
        (START + b"G2 X1 Y1 I1 J0.5 F1\n" + END, "line 8", "the arc has not one radius"),
        (START + b"G3 X0 Y0 I0 J0 F1\n" + END, "line 8", "the arc has not one radius"),
        (START + b"G1 X1 Y1 F1\n", "line 9", "there is no M2: the file was cut off"),
        (START + b"G1 X1 Y1 F1\nM5\nM2", "line 10", "'M2' is not a line"),
        (START + b"M3 S1\nM2\n", "line 9", "the laser is on at the end"),
        (START + END + b"M2\n", "line 10", "there is something after M2"),
    ],
)
def test_what_deltacam_does_not_write_is_refused_with_its_line(content: bytes, where: str, what: str) -> None:
    problem = refused(content)
    assert problem.where == f"plate.gcode, {where}"
    assert what in problem.what


@given(st.data())
def test_a_mutated_file_is_refused_or_read_and_never_a_traceback(bench_program: Program, data: st.DataObject) -> None:
    content = bytearray(written(bench_program))
    first = data.draw(st.integers(0, len(content) - 1))
    content[first : first + data.draw(st.integers(0, 20))] = data.draw(
        st.one_of(st.binary(max_size=8), st.from_regex(rb"\AG[0-4] X[0-9]{1,3} Y1 F-?[0-9]\n\Z"))
    )
    try:
        found = read(bytes(content))
    except ProgramError as problem:
        assert problem.what.isprintable()  # noqa: PT017 - most mutations are refused, not all
    else:
        assert len(found.motion) == len(found.ends) == len(found.power)


def test_what_is_too_large_is_refused(bench_program: Program, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contents, "MAX_ROWS", 5)
    assert "5 rows" in refused(written(bench_program)).what
