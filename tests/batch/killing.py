"""Kills a batch at seeded moments, looks at what is left, and lets it go on."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from deltacam.batch.results.folder import PRIVATE
from tests.batch.scene import children, damage, ended, plate, tree

_PAUSE: Final = 1e-3  # s between two looks at what there is
_AGAIN: Final = 0.5  # of the batches that were killed are killed again before one may end
_ENDED: Final = 1  # one drawing is refused


@dataclass(frozen=True, slots=True)
class Moment:
    """When a batch was killed, and what was wrong afterwards.

    Attributes:
        when: in words.
        after: how long the batch had run, s.
        files: how many files of results there were.
        unfinished: how many files were there that nobody sees, because they were not whole.
        flaws: what was not as it should be; empty where nothing was.
    """

    when: str
    after: float
    files: int
    unfinished: int
    flaws: tuple[str, ...]


def draw(folder: Path, parts: int) -> None:
    """Small parts of different sizes, some of them in a subfolder, and one that is refused."""
    for number in range(parts):
        subfolder = "more" if number % 2 else ""
        plate(folder / subfolder / f"part{number}.dxf", width=10.0 + number, holes=number % 3)
    (folder / "broken.dxf").write_text("this is no drawing\n")


def batch(folder: Path, output: Path, *, jobs: int = 2) -> subprocess.Popen[bytes]:
    """A batch as the command runs it."""
    code = "from deltacam_cli.main import main; main()"
    options = ("--no-what-if", "--jobs", str(jobs), "--memory", "none")
    path = [*os.environ.get("PYTHONPATH", "").split(os.pathsep), *sys.path]
    return subprocess.Popen(
        [sys.executable, "-c", code, "batch", str(folder), "-o", str(output), *options],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, path))},
        start_new_session=True,
    )


def campaign(folder: Path, scratch: Path, *, moments: int, seed: int, jobs: int = 2) -> Iterator[Moment]:
    """Kill a batch so many times, and let it go on after each; some are killed several times before one may end.

    A batch that ended before its moment came does not count, but its results do.

    Args:
        folder: of drawings, as `draw` makes them.
        scratch: an empty folder.
        moments: how many times a batch is killed.
        seed: for when.
        jobs: of the batch.
    """
    begin = time.monotonic()
    assert batch(folder, scratch / "undisturbed", jobs=jobs).wait() == _ENDED
    usual, expected = time.monotonic() - begin, tree(scratch / "undisturbed")
    chance = random.Random(seed)  # noqa: S311 - no secret
    outputs = (scratch / str(number) for number in range(sys.maxsize))
    output, killed = next(outputs), 0
    while killed < moments:
        when, comes = _moment(output, chance, usual, len(expected))
        process = batch(folder, output, jobs=jobs)
        after, flaws = _kill(process, comes)
        found = tree(output)
        unfinished = sum(name.endswith(".tmp") for name in found)
        flaws += damage(output)
        if is_over := process.returncode != -signal.SIGKILL:
            flaws += [] if process.returncode == _ENDED else [f"it ended with {process.returncode}"]
        elif is_over := killed + 1 == moments or chance.random() >= _AGAIN:
            flaws += [] if batch(folder, output, jobs=jobs).wait() == _ENDED else ["the next run did not end well"]
        if is_over:
            flaws += _differences(tree(output), expected)
            output = next(outputs)
        if flaws or process.returncode == -signal.SIGKILL:
            killed += 1
            yield Moment(when, after, len(found) - unfinished, unfinished, tuple(flaws))


def _moment(output: Path, chance: random.Random, usual: float, files: int) -> tuple[str, Callable[[float], bool]]:
    """When a batch is to be killed, in words, and whether that is now, so many seconds after its beginning."""
    kind = chance.choice(("time", "files", "unfinished"))
    there, skipped = _names(output, "*.*"), chance.randrange(max(files - len(_names(output, "*.*")), 1))
    if kind == "time":
        time_wanted = chance.uniform(0.0, usual)
        return f"after {time_wanted:.2f} s", lambda after: after >= time_wanted
    if kind == "files":
        number = len(there) + skipped
        return f"with more than {number} files", lambda _: len(_names(output, "*.*")) > number
    seen = _names(output / PRIVATE, "*.tmp")
    number = len(seen) + skipped

    def is_writing(_: float) -> bool:
        new = _names(output / PRIVATE, "*.tmp") - seen
        seen.update(new)
        return bool(new) and len(seen) > number

    return f"while file {skipped + 1} is written", is_writing


def _kill(process: subprocess.Popen[bytes], comes: Callable[[float], bool]) -> tuple[float, list[str]]:
    """Kill a batch when the moment comes; when that was, and what was wrong with it."""
    begin = time.monotonic()
    while process.poll() is None and not comes(time.monotonic() - begin):
        time.sleep(_PAUSE)
    after = time.monotonic() - begin
    family = children(process.pid)
    process.send_signal(signal.SIGKILL)
    process.wait()
    return after, [] if ended(family) else ["processes of it are left"]


def _names(folder: Path, pattern: str) -> set[Path]:
    return set(folder.rglob(pattern)) if folder.exists() else set()


def _differences(found: dict[str, bytes], expected: dict[str, bytes]) -> list[str]:
    names = sorted(found.keys() | expected.keys())
    return [f"{name} is not that of an undisturbed run" for name in names if found.get(name) != expected.get(name)]
