"""A part from its task to its result, and what names its content."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from deltacam import pipeline
from deltacam.batch.parts import Part, Status, Task
from deltacam.batch.planning import key as keys
from deltacam.batch.planning.key import key_of, sha256
from deltacam.batch.planning.task import get_ready, perform
from deltacam.batch.results.folder import ENDINGS
from deltacam.cutting.process import load_process
from deltacam.drawing.reader import read_drawing
from deltacam.errors import DrawingError
from deltacam.model import EVERYTHING, Mode
from deltacam.robot.reader import load_robot
from tests.batch.scene import OPTIONS, bow_tie, plate


def task(path: Path, name: str = "", **options: Any) -> Task:
    given = {**OPTIONS, **options}
    data = path.read_bytes()
    return Task(name or path.name, data, given, key_of(Part(path.name, path, given), data), "../plotly.min.js")


def test_a_part_has_the_program_and_the_report_that_plan_writes(tmp_path: Path) -> None:
    path = plate(tmp_path / "plate.dxf", holes=1)
    result = perform(task(path, "sub/plate.dxf"))
    _, written = pipeline.plan_to_folder(path, tmp_path / "out", **OPTIONS)
    assert result.outcome.status is Status.PASSED
    assert tuple(result.files) == ENDINGS
    assert result.files[".program.csv"] == written.program.read_bytes()
    assert result.files[".report.json"] == written.report_json.read_bytes()
    assert b'<script src="../plotly.min.js"></script>' in result.files[".report.html"]
    assert len(result.files[".report.html"]) < 1_000_000
    facts = result.outcome.facts
    assert facts is not None
    assert facts.size == pytest.approx((0.012, 0.008))
    assert (facts.contours, facts.failed) == (2, ())
    assert facts.time > 0.1
    drawn = 0.04 + 2e-3 * 3.1416  # to which the leads and the overcuts of two contours come
    assert drawn < facts.cut_length < drawn + 2 * 4e-3
    assert (result.outcome.robot, result.outcome.process) == ("delta-300", "steel-1mm-fibre")


def test_what_is_refused_says_where_without_the_name_of_the_file_and_shows_the_drawing(tmp_path: Path) -> None:
    result = perform(task(bow_tie(tmp_path / "bow.dxf")))
    assert result.files == {}
    outcome = result.outcome
    assert (outcome.status, outcome.facts) == (Status.REFUSED, None)
    assert outcome.where.startswith("contour 1")
    assert "crosses" in outcome.what
    assert outcome.thumbnail


def test_a_file_that_is_no_drawing_is_refused_without_a_picture(tmp_path: Path) -> None:
    (tmp_path / "a.dxf").write_bytes(b"\xff\x00 no drawing")
    outcome = perform(task(tmp_path / "a.dxf")).outcome
    assert outcome.status is Status.REFUSED
    assert outcome.what
    assert outcome.thumbnail == ()


def test_a_fault_is_the_outcome_with_its_kind(tmp_path: Path) -> None:
    outcome = perform(task(plate(tmp_path / "a.dxf"), jobs_that_do_not_exist=1)).outcome
    assert outcome.status is Status.FAULT
    assert outcome.what.startswith("a fault of deltacam: TypeError: ")
    assert outcome.hint == "report it with the drawing"


def _made_of(cause: Exception) -> Exception:
    """What a library makes of an error: ``raise ... from None``."""
    problem = DrawingError("the drawing cannot be read")
    problem.__context__, problem.__suppress_context__ = cause, True
    return problem


@pytest.mark.parametrize(
    "problem",
    [
        MemoryError(),
        RuntimeError("std::bad_alloc"),
        ImportError("x.so: failed to map segment from shared object"),
        OSError(12, "Cannot allocate memory"),
        _made_of(MemoryError()),
    ],
    ids=lambda problem: type(problem).__name__,
)
def test_want_of_memory_is_not_the_drawings_fault(
    problem: Exception, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise problem

    given = task(plate(tmp_path / "a.dxf"))
    monkeypatch.setattr(pipeline, "plan", fail)
    outcome = perform(given).outcome
    assert outcome.status is Status.MEMORY
    assert not outcome.status.lasts


def test_a_part_that_is_planned_first_or_later_has_the_same_bytes(tmp_path: Path) -> None:
    tasks = [task(plate(tmp_path / f"{n}.dxf", width=10.0 + n, holes=n)) for n in range(2)]
    forward = [perform(each) for each in tasks]
    get_ready()
    backward = [perform(each) for each in reversed(tasks)][::-1]
    assert [(one.outcome, one.files) for one in forward] == [(one.outcome, one.files) for one in backward]


def keys_of_changes(tmp_path: Path) -> dict[str, str]:
    """The key of a part, and of the same part with one thing changed."""
    path = plate(tmp_path / "a.dxf")
    data, part = path.read_bytes(), Part("a.dxf", path, OPTIONS)
    robot, process = OPTIONS["robot"], OPTIONS["process"]

    def given(**options: Any) -> str:
        return key_of(replace(part, options={**OPTIONS, **options}), data)

    return {
        "as it is": key_of(part, data),
        "drawing": key_of(part, data + b"\n"),
        "name": key_of(replace(part, name="sub/a.dxf"), data),
        "robot": given(robot=load_robot("irb360-1600")),
        "name of the robot": given(robot=replace(robot, name="other")),
        "a joint limit": given(robot=replace(robot, joints=replace(robot.joints, max_jerk=None))),
        "process": given(process=load_process("acrylic-3mm-co2")),
        "kerf": given(process=replace(process, kerf=process.kerf + 1e-9)),
        "a rule": given(process=replace(process, rules=process.rules[:-1])),
        "unit": given(unit="mm"),
        "default unit": given(default_unit="mm"),
        "selection": given(selection=replace(EVERYTHING, joining=1e-4)),
        "place": given(at=(1e-9, 0.0)),
        "rotation": given(rotation=1e-9),
        "mode": given(mode=Mode.FRAME),
        "what if": given(what_if=True),
        "chosen place": given(place="time"),
    }


def test_whatever_the_files_follow_from_changes_the_key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = keys_of_changes(tmp_path)
    monkeypatch.setattr(keys, "_version", lambda: "another")
    found["version"] = keys_of_changes(tmp_path)["as it is"]
    assert len(set(found.values())) == len(found)


def test_what_the_files_do_not_follow_from_changes_no_key(tmp_path: Path) -> None:
    path = plate(tmp_path / "a.dxf")
    data = path.read_bytes()
    options = {**OPTIONS, "robot": load_robot("delta-300"), "process": load_process("steel-1mm-fibre")}
    others = (
        Part("a.dxf", path, dict(reversed(options.items()))),
        Part("a.dxf", tmp_path / "elsewhere.dxf", options),
        Part("a.dxf", path, options, quantity=7),
    )
    assert {key_of(part, data) for part in others} == {key_of(Part("a.dxf", path, OPTIONS), data)}


def test_a_hash_is_that_of_the_bytes() -> None:
    assert sha256(b"abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"


def test_the_picture_of_a_part_is_that_of_its_drawing(tmp_path: Path) -> None:
    path = plate(tmp_path / "a.dxf", holes=2)
    lines = perform(task(path)).outcome.thumbnail
    assert len(lines) == len(read_drawing(path).contours)
