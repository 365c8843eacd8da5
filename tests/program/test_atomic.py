"""Files appear whole or not at all, whatever happens while they are written."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from deltacam.errors import ProgramError
from deltacam.program.atomic import replace_when_done, write_whole

ENDLESS = """
import sys
from pathlib import Path
from deltacam.program.atomic import write_whole
path, size = Path(sys.argv[1]), int(sys.argv[2])
write_whole(path, b"0" * size)
print("first", flush=True)
for digit in range(1, 1_000_000):
    write_whole(path, bytes([48 + digit % 10]) * size)
"""


def test_the_content_appears_under_its_name_and_nothing_else_stays(tmp_path: Path) -> None:
    with replace_when_done(tmp_path / "a.program.csv") as temporary:
        assert temporary.parent == tmp_path
        assert temporary.name.startswith(".")
        assert temporary.name.endswith(".tmp")
        assert not (tmp_path / "a.program.csv").exists()
        temporary.write_bytes(b"content")
    assert [path.name for path in tmp_path.iterdir()] == ["a.program.csv"]
    assert (tmp_path / "a.program.csv").read_bytes() == b"content"


def test_the_file_gets_the_permissions_of_a_new_file(tmp_path: Path) -> None:
    write_whole(tmp_path / "a", b"")
    (tmp_path / "b").write_bytes(b"")
    assert (tmp_path / "a").stat().st_mode == (tmp_path / "b").stat().st_mode


@pytest.mark.parametrize("problem", [ValueError, KeyboardInterrupt, SystemExit])
def test_any_exception_leaves_the_older_file_and_no_temporary_one(tmp_path: Path, problem: type[BaseException]) -> None:
    path = tmp_path / "a"
    write_whole(path, b"older")

    def fail() -> None:
        with replace_when_done(path) as temporary:
            temporary.write_bytes(b"half")
            raise problem

    with pytest.raises(problem):
        fail()
    assert [found.name for found in tmp_path.iterdir()] == ["a"]
    assert path.read_bytes() == b"older"


def test_a_missing_folder_is_an_error_that_names_the_file(tmp_path: Path) -> None:
    with pytest.raises(ProgramError, match="no such file") as caught:
        write_whole(tmp_path / "no" / "a", b"")
    assert caught.value.where == str(tmp_path / "no" / "a")
    assert caught.value.hint


def test_a_folder_of_that_name_is_an_error_and_no_temporary_file_stays(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    with pytest.raises(ProgramError, match="is a directory"):
        write_whole(tmp_path / "a", b"x")
    assert [found.name for found in tmp_path.iterdir()] == ["a"]


def test_a_full_disk_is_an_error() -> None:
    if not Path("/dev/full").exists():
        pytest.skip("this system has no /dev/full")
    with pytest.raises(ProgramError, match="no space left"), replace_when_done(Path("a")):
        Path("/dev/full").write_bytes(b"x" * 100_000)


@pytest.mark.skipif(os.name != "posix", reason="needs SIGKILL")
@pytest.mark.parametrize("delay_ms", [0, 3, 11, 29])
def test_a_killed_writer_leaves_a_whole_file(tmp_path: Path, delay_ms: int) -> None:
    path, size = tmp_path / "a.program.csv", 3_000_000
    command = [sys.executable, "-c", ENDLESS, str(path), str(size)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as writer:
        assert writer.stdout is not None
        assert writer.stdout.readline() == "first\n"
        with pytest.raises(subprocess.TimeoutExpired):
            writer.wait(0.001 + delay_ms / 1e3)
        writer.send_signal(signal.SIGKILL)
    content = path.read_bytes()
    assert len(content) == size
    assert len(set(content)) == 1
    assert all(found == path or found.name.startswith(".deltacam-") for found in tmp_path.iterdir())
