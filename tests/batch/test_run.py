"""A batch as a whole: nothing twice, nothing lost, and nothing that is only half there."""

from __future__ import annotations

import csv
import json
import os
import shutil
import threading
from collections.abc import Callable, Generator, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from deltacam.batch.parts import Batch, Part, Result, Row, Status, Task
from deltacam.batch.planning.key import sha256
from deltacam.batch.planning.task import perform
from deltacam.batch.results import folder as folders
from deltacam.batch.run import run
from deltacam.errors import DeltacamError, DrawingError
from deltacam.model import Mode
from tests.batch.scene import OPTIONS, bow_tie, damage, parts_of, plan_here, plate, tree


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A batch that is over: ``parts``, and ``out`` of it; two passed, and one was refused."""
    folder = tmp_path_factory.mktemp("done")
    plate(folder / "parts" / "plate.dxf")
    plate(folder / "parts" / "sub" / "plate.dxf", holes=1)
    bow_tie(folder / "parts" / "twisted.dxf")
    run(parts_of(folder / "parts"), folder / "out", planner=plan_here)
    return folder


@pytest.fixture
def again(done: Path, tmp_path: Path) -> Path:
    """A copy of it."""
    shutil.copytree(done, tmp_path, dirs_exist_ok=True)
    return tmp_path


def batch(folder: Path, **given: Any) -> Batch:
    return run(parts_of(folder / "parts"), folder / "out", **{"planner": plan_here, **given})


def planned(result: Batch) -> list[str]:
    """The parts that were planned, and not only found."""
    return [row.part for row in result.rows if not row.again]


def statuses(result: Batch) -> dict[str, str]:
    return {row.part: row.outcome.status.value for row in result.rows}


def test_nothing_is_planned_again_where_nothing_has_changed_and_no_byte_is_other(done: Path, again: Path) -> None:
    second = batch(again)
    assert planned(second) == []
    assert statuses(second) == {"plate.dxf": "passed", "sub/plate.dxf": "passed", "twisted.dxf": "refused"}
    assert tree(again / "out") == tree(done / "out")
    assert damage(again / "out") == []


def test_a_part_is_planned_again_where_its_drawing_has_changed(again: Path) -> None:
    before = tree(again / "out")
    plate(again / "parts" / "plate.dxf", width=13.0)
    assert planned(batch(again)) == ["plate.dxf"]
    changed = {name for name, content in tree(again / "out").items() if content != before[name]}
    assert changed == {
        *(f"plate{ending}" for ending in folders.ENDINGS),
        *("batch.json", "batch.csv", "index.html", ".deltacam-batch/record.jsonl"),
    }


@pytest.mark.parametrize(
    "options",
    [
        {"robot": replace(OPTIONS["robot"], name="another")},
        {"process": replace(OPTIONS["process"], kerf=OPTIONS["process"].kerf * 1.01)},
        {"at": (0.001, 0.0)},
        {"mode": Mode.DRY_RUN},
    ],
    ids=["robot", "process", "place", "mode"],
)
def test_all_parts_are_planned_again_where_what_they_are_planned_with_has_changed(
    again: Path, options: dict[str, Any]
) -> None:
    changed = [replace(part, options={**part.options, **options}) for part in parts_of(again / "parts")]
    for expected in (["plate.dxf", "sub/plate.dxf", "twisted.dxf"], []):
        assert planned(run(changed, again / "out", planner=plan_here)) == expected


@pytest.mark.parametrize("ending", folders.ENDINGS)
@pytest.mark.parametrize("change", [Path.unlink, lambda path: path.write_bytes(path.read_bytes()[:-1])])
def test_a_part_is_planned_again_where_a_file_of_it_is_gone_or_another(
    done: Path, again: Path, ending: str, change: Callable[[Path], object]
) -> None:
    change(again / "out" / "sub" / f"plate{ending}")
    assert planned(batch(again)) == ["sub/plate.dxf"]
    assert tree(again / "out") == tree(done / "out")


def test_force_plans_all_again_to_the_same_bytes(done: Path, again: Path) -> None:
    assert planned(batch(again, force=True)) == ["plate.dxf", "sub/plate.dxf", "twisted.dxf"]
    assert tree(again / "out") == tree(done / "out")


def test_a_drawing_that_is_refused_now_leaves_no_program_of_before(again: Path) -> None:
    bow_tie(again / "parts" / "plate.dxf")
    assert statuses(batch(again))["plate.dxf"] == "refused"
    assert sorted(path.name for path in (again / "out").glob("plate.*")) == []
    assert planned(batch(again)) == []


@pytest.mark.parametrize("change", [Path.unlink, lambda path: path.write_bytes(b"")])
def test_a_drawing_that_cannot_be_read_is_a_row_and_leaves_no_program_of_before(
    done: Path, again: Path, change: Callable[[Path], object]
) -> None:
    parts = parts_of(again / "parts")
    change(again / "parts" / "plate.dxf")
    second = run(parts, again / "out", planner=plan_here)
    assert statuses(second) == {"plate.dxf": "refused", "sub/plate.dxf": "passed", "twisted.dxf": "refused"}
    assert second.rows[0].outcome.reason
    assert not (again / "out" / "plate.program.csv").exists()
    shutil.copy(done / "parts" / "plate.dxf", again / "parts" / "plate.dxf")
    assert planned(batch(again)) == ["plate.dxf"]
    assert tree(again / "out") == tree(done / "out")


def test_a_drawing_that_changes_while_others_are_planned_is_planned_as_it_is_then(again: Path) -> None:
    plate(again / "parts" / "plate.dxf", width=14.0)

    def late(tasks: Iterator[Task], *, stop: threading.Event) -> Generator[tuple[Task, Result]]:
        plate(again / "parts" / "plate.dxf", width=15.0)
        yield from plan_here(tasks, stop=stop)

    first = batch(again, planner=late)
    assert planned(batch(again)) == []
    assert first.rows[0].drawing_sha256 == sha256((again / "parts" / "plate.dxf").read_bytes())
    assert first.rows[0].outcome.facts is not None
    assert first.rows[0].outcome.facts.size == pytest.approx((0.015, 0.008))


def test_a_drawing_that_goes_while_others_are_planned_is_a_row(again: Path) -> None:
    plate(again / "parts" / "plate.dxf", width=14.0)

    def late(tasks: Iterator[Task], *, stop: threading.Event) -> Generator[tuple[Task, Result]]:
        (again / "parts" / "plate.dxf").unlink()
        yield from plan_here(tasks, stop=stop)

    assert statuses(batch(again, planner=late))["plate.dxf"] == "refused"


def test_a_part_that_failed_a_check_has_reports_and_no_program_and_is_not_planned_again(tmp_path: Path) -> None:
    plate(tmp_path / "parts" / "plate.dxf")

    def failing(tasks: Iterator[Task], *, stop: threading.Event) -> Generator[tuple[Task, Result]]:
        for task in tasks:
            result = perform(task)
            outcome = replace(result.outcome, status=Status.FAILED, what="failed: feed")
            yield task, Result(outcome, {key: result.files[key] for key in folders.ENDINGS[:-1]})

    for expected in (["plate.dxf"], []):
        result = batch(tmp_path, planner=failing)
        assert planned(result) == expected
        assert statuses(result) == {"plate.dxf": "failed"}
        assert sorted(path.name for path in (tmp_path / "out").glob("plate.*")) == [
            "plate.report.html",
            "plate.report.json",
        ]


@pytest.mark.parametrize("status", [Status.FAULT, Status.CRASHED, Status.TIMEOUT, Status.MEMORY])
def test_what_may_end_otherwise_the_next_time_is_planned_again(done: Path, again: Path, status: Status) -> None:
    def ending(tasks: Iterator[Task], *, stop: threading.Event) -> Generator[tuple[Task, Result]]:
        for task in tasks:
            yield task, Result(replace(perform(task).outcome, status=status, what="it did not work"))

    plate(again / "parts" / "plate.dxf", width=13.0)
    assert statuses(batch(again, planner=ending))["plate.dxf"] == status.value
    assert not (again / "out" / "plate.program.csv").exists()
    shutil.copy(done / "parts" / "plate.dxf", again / "parts" / "plate.dxf")
    assert planned(batch(again)) == ["plate.dxf"]
    assert tree(again / "out") == tree(done / "out")


def test_a_stop_leaves_the_rest_for_the_next_run_which_ends_with_the_same_bytes(done: Path, tmp_path: Path) -> None:
    shutil.copytree(done / "parts", tmp_path / "parts")
    stop = threading.Event()
    told: list[Row] = []

    def tell(row: Row) -> None:
        told.append(row)
        stop.set()

    first = batch(tmp_path, stop=stop, tell=tell)
    assert sorted(statuses(first).values()) == ["left", "left", "passed"]
    assert sorted(row.part for row in told) == sorted(statuses(first))
    assert [row.outcome.hint for row in first.rows if row.outcome.status is Status.LEFT] == ["run it again"] * 2
    assert damage(tmp_path / "out") == []
    assert len(planned(batch(tmp_path))) == 2
    assert tree(tmp_path / "out") == tree(done / "out")


def test_a_stop_before_the_first_part_plans_nothing(again: Path) -> None:
    stop = threading.Event()
    stop.set()
    assert set(statuses(batch(again, stop=stop)).values()) == {"left"}
    assert planned(batch(again)) == []


def test_an_interrupt_ends_what_plans_and_lets_go_of_the_folder(done: Path, tmp_path: Path) -> None:
    shutil.copytree(done / "parts", tmp_path / "parts")
    ended = []

    def planner(tasks: Iterator[Task], *, stop: threading.Event) -> Generator[tuple[Task, Result]]:
        try:
            yield from plan_here(tasks, stop=stop)
        finally:
            ended.append(True)

    def interrupt(_row: Row) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        batch(tmp_path, planner=planner, tell=interrupt)
    assert ended
    assert damage(tmp_path / "out") == []
    batch(tmp_path)
    assert tree(tmp_path / "out") == tree(done / "out")


def test_parts_of_one_name_are_refused(done: Path, tmp_path: Path) -> None:
    one, *_ = parts_of(done / "parts")
    for other in (one, Part("plate.DXF", one.path, one.options)):
        with pytest.raises(DeltacamError, match=r"plate\.(dxf|DXF)"):
            run([one, other], tmp_path / "out", planner=plan_here)
    assert not (tmp_path / "out").exists()


def test_names_of_any_bytes_are_written_in_all_summaries(tmp_path: Path) -> None:
    names = ["a\udcff\n.dxf", "</script><b>&\"'.dxf", "=1+2\t.dxf"]
    for name in names:
        plate(tmp_path / "parts" / name)
    result = batch(tmp_path)
    assert statuses(result) == dict.fromkeys(names, "passed")
    assert [row["part"] for row in json.loads((tmp_path / "out" / "batch.json").read_text())["parts"]] == sorted(names)
    with (tmp_path / "out" / "batch.csv").open(newline="", encoding="utf-8") as stream:
        assert len(list(csv.reader(stream))) == 1 + len(names)
    assert "<b>" not in (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert planned(batch(tmp_path)) == []
    (tmp_path / "parts" / names[0]).unlink()
    assert batch(tmp_path, notes=["\udcff"]).notes[0] == "\udcff"
    assert damage(tmp_path / "out") == []


def test_what_an_earlier_batch_left_is_said_as_long_as_it_is_there(again: Path) -> None:
    (again / "parts" / "plate.dxf").unlink()
    (note,) = batch(again).notes
    assert "plate.dxf" in note
    assert (again / "out" / "plate.program.csv").exists()
    for path in (again / "out").glob("plate.*"):
        path.unlink()
    assert batch(again).notes == ()


def test_a_file_in_the_place_of_a_subfolder_is_the_row_of_its_parts_alone(done: Path, tmp_path: Path) -> None:
    shutil.copytree(done / "parts", tmp_path / "parts")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "sub").write_text("mine\n")
    first = batch(tmp_path)
    assert statuses(first) == {"plate.dxf": "passed", "sub/plate.dxf": "unwritten", "twisted.dxf": "refused"}
    assert "file exists" in first.rows[1].outcome.reason
    assert first.rows[1].files == ()
    assert (tmp_path / "out" / "sub").read_text() == "mine\n"
    (tmp_path / "out" / "sub").unlink()
    assert planned(batch(tmp_path)) == ["sub/plate.dxf"]
    assert tree(tmp_path / "out") == tree(done / "out")


@pytest.mark.parametrize("ending", folders.ENDINGS)
def test_a_folder_in_the_place_of_a_file_is_the_row_of_its_part_alone(done: Path, again: Path, ending: str) -> None:
    (again / "out" / f"plate{ending}").unlink()
    (again / "out" / f"plate{ending}").mkdir()
    first = batch(again)
    assert statuses(first) == {"plate.dxf": "unwritten", "sub/plate.dxf": "passed", "twisted.dxf": "refused"}
    (again / "out" / f"plate{ending}").rmdir()
    assert planned(batch(again)) == ["plate.dxf"]
    assert tree(again / "out") == tree(done / "out")


def test_a_name_that_is_too_long_for_the_results_is_the_row_of_its_part_alone(tmp_path: Path) -> None:
    plate(tmp_path / "parts" / "plate.dxf")
    plate(tmp_path / "parts" / f"{'x' * 249}.dxf")
    result = batch(tmp_path)
    assert sorted(statuses(result).values()) == ["passed", "unwritten"]
    assert "name too long" in result.rows[1].outcome.reason


def test_a_drawing_is_named_as_where_it_lies_and_not_by_its_whole_path(again: Path) -> None:
    for name in ("batch.json", "batch.csv", "index.html", ".deltacam-batch/record.jsonl", "plate.report.json"):
        assert os.fsencode(again.parent) not in (again / "out" / name).read_bytes()


def test_a_file_in_the_place_of_the_folder_is_refused(done: Path, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("mine\n")
    with pytest.raises(DeltacamError, match="this is a file"):
        run(parts_of(done / "parts"), tmp_path / "out", planner=plan_here)
    assert (tmp_path / "out").read_text() == "mine\n"


def test_an_error_of_what_plans_leaves_what_is_done_for_the_next_run(done: Path, tmp_path: Path) -> None:
    shutil.copytree(done / "parts", tmp_path / "parts")

    def planner(tasks: Iterator[Task], *, stop: threading.Event) -> Generator[tuple[Task, Result]]:
        for task in tasks:
            yield task, perform(task)
            raise DrawingError("the cluster has gone")

    with pytest.raises(DeltacamError, match="the cluster has gone"):
        batch(tmp_path, planner=planner)
    assert damage(tmp_path / "out") == []
    assert len(planned(batch(tmp_path))) == 2
    assert tree(tmp_path / "out") == tree(done / "out")
