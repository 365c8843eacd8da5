"""Kills a batch at seeded moments, looks at what is left, and lets it go on."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import ezdxf
import psutil

from deltacam.batch.results.folder import PRIVATE
from tests.batch.scene import damage, tree

_PATIENCE = 60.0  # s


@dataclass(frozen=True, slots=True)
class Moment:
    """When a batch was killed, and what was wrong afterwards.

    Attributes:
        number: of the moment.
        when: in words.
        after: how long the batch had run, s.
        files: how many files of results there were.
        flaws: what was not as it should be; empty where nothing was.
    """

    number: int
    when: str
    after: float
    files: int
    flaws: tuple[str, ...]


def draw(folder: Path, parts: int) -> None:
    """Small parts of different sizes, some of them in a subfolder, and one that is refused."""
    (folder / "more").mkdir(parents=True)
    for number in range(parts):
        document = ezdxf.new(units=4)
        space = document.modelspace()
        for ring in range(1, 2 + number % 3):
            space.add_circle((0.0, 0.0), (3.0 + 0.25 * number) * ring)
        document.saveas(folder / ("more" if number % 2 else "") / f"part{number}.dxf")
    (folder / "broken.dxf").write_text("this is no drawing\n")


def batch(folder: Path, output: Path) -> subprocess.Popen[bytes]:
    """A batch as the command runs it."""
    code = "from deltacam_cli.main import main; main()"
    options = ("--no-what-if", "--jobs", "2", "--memory", "none")
    path = [*os.environ.get("PYTHONPATH", "").split(os.pathsep), *sys.path]
    return subprocess.Popen(
        [sys.executable, "-c", code, "batch", str(folder), "-o", str(output), *options],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, path))},
        start_new_session=True,
    )


def campaign(folder: Path, scratch: Path, *, moments: int, seed: int) -> Iterator[Moment]:
    """Kill a batch so many times, and let it go on after each; some are killed more than once before they may end.

    Args:
        folder: of drawings, as `draw` makes them.
        scratch: an empty folder.
        moments: how many times a batch is killed.
        seed: for when.
    """
    begin = time.monotonic()
    assert batch(folder, scratch / "undisturbed").wait() == 1  # one drawing is refused
    usual = time.monotonic() - begin
    expected = tree(scratch / "undisturbed")
    chance = random.Random(seed)  # noqa: S311 - no secret
    output = scratch / "0"
    for number in range(moments):
        when, after = _kill(batch(folder, output), output, chance, usual, len(expected))
        files = len(tree(output)) if output.exists() else 0
        flaws = damage(output)
        if number + 1 == moments or chance.random() < 0.6:  # else it is killed again
            assert batch(folder, output).wait() == 1
            flaws += _differences(tree(output), expected)
            output = scratch / str(number + 1)
        yield Moment(number, when, after, files, tuple(flaws))


def _kill(
    process: subprocess.Popen[bytes], output: Path, chance: random.Random, usual: float, files: int
) -> tuple[str, float]:
    """Kill the batch at some time, or as soon as so many files or a file that is not whole are there."""
    begin = time.monotonic()
    kind = chance.choice(("time", "files", "unfinished"))
    there, unfinished = (
        _names(output, "*.*"),
        _names(output / PRIVATE, "*.tmp"),
    )  # from the batch that was killed before
    wanted = chance.uniform(0.0, 1.05 * usual) if kind == "time" else len(there) + chance.randrange(files)
    skipped = chance.randrange(files)
    while process.poll() is None:
        if kind == "time" and time.monotonic() - begin >= wanted:
            break
        if kind == "files" and len(_names(output, "*.*")) > wanted:
            break
        if kind == "unfinished" and (new := _names(output / PRIVATE, "*.tmp") - unfinished):
            unfinished |= new
            skipped -= 1
            if skipped < 0:
                break
        time.sleep(2e-4)
    after = time.monotonic() - begin
    family = _family(process.pid)
    process.send_signal(signal.SIGKILL)
    process.wait()
    _, alive = psutil.wait_procs(family, timeout=_PATIENCE)
    words = {"time": f"after {after:.2f} s", "files": f"with more than {wanted} files"}
    left = f"; {len(alive)} processes are left" if alive else ""
    return words.get(kind, "in the middle of a file") + left, after


def _family(pid: int) -> list[psutil.Process]:
    try:
        return psutil.Process(pid).children(recursive=True)
    except psutil.NoSuchProcess:
        return []


def _names(folder: Path, pattern: str) -> set[Path]:
    return set(folder.rglob(pattern)) if folder.exists() else set()


def _differences(found: dict[str, bytes], expected: dict[str, bytes]) -> Iterator[str]:
    for name in sorted(found.keys() | expected.keys()):
        if found.get(name) != expected.get(name):
            yield f"{name} is not that of an undisturbed run"
