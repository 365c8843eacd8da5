"""The folder of results: who may write to it, what is cleared up, and disks that are full or read-only."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

import pytest

from deltacam.batch.parts import Batch, Part, Status
from deltacam.batch.results.folder import ENDINGS, PRIVATE, hold, library_of, share_plotly
from deltacam.batch.run import run
from deltacam.errors import DeltacamError, ProgramError
from tests.batch.scene import ROOT, damage, parts_of, plan_here, plate, tree
from tests.cli.test_main import deltacam

PART: Final = Part("sub/plate.dxf", Path("plate.dxf"), {})
FILES: Final = dict(zip(ENDINGS, (b"{}", b"<html></html>", b"program"), strict=True))


@pytest.fixture(scope="module")
def parts(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Six small drawings."""
    folder = tmp_path_factory.mktemp("parts")
    for number in range(6):
        plate(folder / f"plate{number}.dxf", width=10.0 + number)
    return folder


@pytest.fixture(scope="module")
def undisturbed(parts: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """What a batch of them gives where nothing goes wrong."""
    out = tmp_path_factory.mktemp("undisturbed")
    run(parts_of(parts), out, planner=plan_here)
    return tree(out)


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[tuple[Path, Callable[[str], None]]]:
    """A disk of its own, and what changes its options: needs the right to mount one."""
    path = tmp_path / "disk"
    path.mkdir()

    def mount(options: str) -> None:
        subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", path], check=True, capture_output=True)

    try:
        mount("size=64m")
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("no right to mount a disk")
    yield path, lambda options: mount(f"remount,{options}")
    subprocess.run(["umount", "--lazy", path], check=True)


def statuses(batch: Batch) -> list[str]:
    return [row.outcome.status.value for row in batch.rows]


def test_a_full_disk_ends_the_batch_with_whole_files_and_the_next_run_completes_it(
    parts: Path, undisturbed: dict[str, bytes], disk: tuple[Path, Callable[[str], None]]
) -> None:
    path, change = disk
    with hold(path / "out") as folder:
        share_plotly(folder)
    used = shutil.disk_usage(path).used
    change(f"size={used // 1024 + 500}k")  # for three parts or so
    first = run(parts_of(parts), path / "out", planner=plan_here)
    found = statuses(first)
    assert found.count("unwritten") == 1
    assert found.count("passed") >= 1
    assert found.count("left") >= 1
    said = {row.outcome.status: row.outcome for row in first.rows}
    assert said[Status.UNWRITTEN].what == "the file cannot be written: no space left on device"
    assert "make room" in said[Status.UNWRITTEN].hint
    assert said[Status.LEFT].what == "the batch was stopped because the disk is full"
    assert damage(path / "out") == []
    assert json.loads((path / "out" / "batch.json").read_bytes())["passed"] is False
    change("size=64m")
    second = run(parts_of(parts), path / "out", planner=plan_here)
    assert sum(row.again for row in second.rows) == found.count("passed")
    assert tree(path / "out") == undisturbed


@pytest.mark.parametrize("room", [0, 8, 24, 60, 120])
def test_a_disk_that_is_full_from_the_beginning_ends_with_what_to_do(
    parts: Path, undisturbed: dict[str, bytes], disk: tuple[Path, Callable[[str], None]], room: int
) -> None:
    path, change = disk
    with hold(path / "out") as folder:
        share_plotly(folder)
    change(f"size={shutil.disk_usage(path).used // 1024 + room}k")
    with suppress(DeltacamError):
        assert "passed" not in statuses(run(parts_of(parts), path / "out", planner=plan_here))
    assert damage(path / "out") == []
    change("size=64m")
    assert run(parts_of(parts), path / "out", planner=plan_here).passed
    assert tree(path / "out") == undisturbed


def test_on_a_full_disk_the_command_says_so(parts: Path, disk: tuple[Path, Callable[[str], None]]) -> None:
    path, change = disk
    change("size=4m")  # less than plotly.js
    done = deltacam("batch", parts, "-o", path / "out", "--jobs", "1", folder=path)
    assert done.returncode == 2
    assert "no space left on device" in done.stderr
    assert "make room" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_disk_that_is_read_only_is_refused(parts: Path, disk: tuple[Path, Callable[[str], None]]) -> None:
    path, change = disk
    change("ro")
    with pytest.raises(ProgramError, match=r"the folder cannot be written to: read-only file system"):
        run(parts_of(parts), path / "out", planner=plan_here)


def test_a_folder_that_has_become_read_only_is_refused(
    parts: Path, disk: tuple[Path, Callable[[str], None]], undisturbed: dict[str, bytes]
) -> None:
    path, change = disk
    run(parts_of(parts)[:1], path / "out", planner=plan_here)
    before = tree(path / "out")
    change("ro")
    with pytest.raises(ProgramError, match=r"the folder cannot be locked: .*read-only file system") as caught:
        run(parts_of(parts), path / "out", planner=plan_here)
    assert caught.value.hint
    assert tree(path / "out") == before
    change("rw")
    run(parts_of(parts), path / "out", planner=plan_here)
    assert tree(path / "out") == undisturbed


@contextmanager
def largest_file(size: int) -> Iterator[None]:
    """Within the block this process may write no larger file."""
    import resource

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.skipif(sys.platform == "win32", reason="no such limit")
def test_a_file_that_may_not_be_as_large_is_the_row_of_its_part_and_the_others_go_on(
    parts: Path, undisturbed: dict[str, bytes], tmp_path: Path
) -> None:
    out = tmp_path / "out"
    with hold(out) as folder:
        share_plotly(folder)
    pages = sorted(len(content) for name, content in undisturbed.items() if name.endswith(".report.html"))
    with largest_file(pages[2]):
        first = run(parts_of(parts), out, planner=plan_here)
    assert statuses(first).count("passed") == 3
    assert statuses(first).count("unwritten") == 3
    assert {row.outcome.what for row in first.rows if row.outcome.status is Status.UNWRITTEN} == {
        "the file cannot be written: file too large"
    }
    assert damage(out) == []
    assert {name.split(".")[0] for name in tree(out) if name.startswith("plate")} == {
        row.part.removesuffix(".dxf") for row in first.rows if row.outcome.status is Status.PASSED
    }
    run(parts_of(parts), out, planner=plan_here)
    assert tree(out) == undisturbed


def test_a_second_batch_in_the_same_folder_is_refused_and_the_first_is_not_disturbed(
    parts: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    with hold(out) as folder:
        stored = folder.store(PART, FILES)
        unfinished = folder.private / ".deltacam-0.tmp"
        unfinished.touch()
        done = deltacam("batch", parts, "-o", out, "--jobs", "1", folder=tmp_path)
        assert done.returncode == 2
        assert "another batch is writing to this folder" in done.stderr
        assert "choose another folder with -o" in done.stderr
        assert folder.has_any(stored)
        assert unfinished.exists()
        assert folder.holds(PART, Status.PASSED, stored)
    with hold(out):
        assert not unfinished.exists()


def test_a_folder_is_free_again_when_its_batch_was_killed(tmp_path: Path) -> None:
    code = (
        "import os, sys\nfrom pathlib import Path\nfrom deltacam.batch.results.folder import hold\n"
        "with hold(Path(sys.argv[1])):\n    os.kill(os.getpid(), 9)\n"
    )
    path = os.pathsep.join((str(ROOT), *sys.path))
    done = subprocess.run([sys.executable, "-c", code, tmp_path], env={**os.environ, "PYTHONPATH": path}, check=False)
    assert done.returncode == -9
    with hold(tmp_path):
        pass


def test_what_is_not_of_a_batch_stays_where_it_is(parts: Path, tmp_path: Path) -> None:
    mine = {"notes.txt": b"mine", "sub/a.tmp": b"mine", "plate0.gcode": b"mine", f"{PRIVATE}/mine.txt": b"mine"}
    for name, content in mine.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(content)
    run(parts_of(parts)[:1], tmp_path, planner=plan_here)
    found = tree(tmp_path)
    assert {name: found.get(name) for name in mine} == mine


def test_a_link_in_the_place_of_a_file_is_replaced_and_what_it_leads_to_stays(tmp_path: Path) -> None:
    (tmp_path / "mine.csv").write_bytes(b"mine")
    with hold(tmp_path / "out") as folder:
        folder.store(PART, FILES)
        target = folder.path / "sub" / "plate.program.csv"
        target.unlink()
        target.symlink_to(tmp_path / "mine.csv")
        folder.store(PART, FILES)
        assert not target.is_symlink()
        target.unlink()
        target.symlink_to(tmp_path / "mine.csv")
        folder.clear(PART)
        assert not target.is_symlink()
    assert (tmp_path / "mine.csv").read_bytes() == b"mine"


def test_files_count_as_there_only_where_all_are_and_none_is_another(tmp_path: Path) -> None:
    with hold(tmp_path) as folder:
        stored = folder.store(PART, FILES)
        assert folder.holds(PART, Status.PASSED, stored)
        assert not folder.holds(PART, Status.PASSED, stored[:-1])
        assert not folder.holds(PART, Status.PASSED, ())
        assert not folder.holds(PART, Status.FAILED, stored)
        assert folder.holds(PART, Status.FAILED, stored[:-1])
        assert folder.holds(PART, Status.REFUSED, ())
        assert not folder.holds(Part("plate.dxf", PART.path, {}), Status.PASSED, stored)


def test_plotly_is_put_right_where_it_is_another(tmp_path: Path) -> None:
    with hold(tmp_path) as folder:
        share_plotly(folder)
        good = tree(tmp_path)
        (tmp_path / "plotly.min.js").write_bytes(b"alert(1)")
        share_plotly(folder)
    assert tree(tmp_path) == good


@pytest.mark.parametrize(
    ("part", "path"), [("a.dxf", "plotly.min.js"), ("b/a.dxf", "../plotly.min.js"), ("c/b/a", "../../plotly.min.js")]
)
def test_a_page_names_plotly_as_seen_from_itself(part: str, path: str) -> None:
    assert library_of(part) == path
