"""Disturbs a batch at every single step at which it changes the disk, and lets it go on afterwards.

    python -m tests.batch.steps SCRATCH [--all]

Runs in a process of its own, which makes a copy of itself (fork) for every step, with the results of planning at hand.
Every step is disturbed in one way, or in all. Prints a line for every flaw, and last how many steps were disturbed.
"""

from __future__ import annotations

import errno
import os
import shutil
import signal
import sys
from collections.abc import Callable, Iterator
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import Any, Final

from deltacam.batch.parts import Batch
from deltacam.batch.planning.key import sha256
from deltacam.batch.run import run
from deltacam.errors import DeltacamError
from tests.batch.scene import bow_tie, damage, parts_of, plan_here, plate, tree

_WRITING: Final = os.O_WRONLY | os.O_RDWR | os.O_CREAT
_ENDED_WELL, _REFUSED, _INCONSISTENT = 0, 10, 20


class How(StrEnum):
    """What happens at a step."""

    KILL = "kill"
    """The process is killed."""
    FULL = "full"
    """From here on nothing can be written, but files can be removed."""
    FAIL = "fail"
    """This step fails, and no other."""
    INTERRUPT = "interrupt"
    """Somebody presses Ctrl-C."""


class Scene:
    """A folder with results of a batch, of whose drawings one has changed since, one is new and one is refused.

    Args:
        scratch: an empty folder.
    """

    def __init__(self, scratch: Path) -> None:
        self.parts, self._before, self._scratch = scratch / "parts", scratch / "before", scratch
        plate(self.parts / "changed.dxf")
        bow_tie(self.parts / "refused.dxf")
        run(parts_of(self.parts), self._before, planner=plan_here)
        plate(self.parts / "changed.dxf", width=13.0)
        plate(self.parts / "sub" / "new.dxf", holes=1)
        run(parts_of(self.parts), scratch / "after", planner=plan_here)
        self.after = tree(scratch / "after")

    def begin(self, name: str) -> Path:
        """A folder as it was before."""
        out = self._scratch / name
        shutil.copytree(self._before, out, copy_function=_copy)
        return out

    def run(self, out: Path) -> Batch:
        """The batch, with results that are at hand."""
        return run(parts_of(self.parts), out, planner=plan_here)


def _copy(source: str, target: str) -> None:
    """A file that is only ever replaced needs no copy."""
    (shutil.copyfile if source.endswith(".jsonl") else os.link)(source, target)


def count_steps(scene: Scene) -> int:
    """How often a batch that nobody disturbs changes the disk."""
    out, seen = scene.begin("count"), os.memfd_create("steps")
    _in_a_copy(partial(_count, scene, out, seen))
    steps = os.fstat(seen).st_size
    os.close(seen)
    return steps


def flaws_at(scene: Scene, step: int, how: How) -> Iterator[str]:
    """What is not as it should be after a batch was disturbed at a step, and after the next one."""
    out = scene.begin(f"{how}-{step}")
    code = _in_a_copy(partial(_disturbed, scene, out, step, how))
    expected = {
        How.KILL: {-signal.SIGKILL},
        How.INTERRUPT: {-signal.SIGINT},
    }.get(how, {_ENDED_WELL, _REFUSED})
    if code not in expected:
        yield f"it ended with {code}"
    yield from damage(out)
    if _in_a_copy(partial(_finish, scene, out)) != _ENDED_WELL:
        yield "the next run did not end well"
    found = tree(out)
    for name in sorted(found.keys() | scene.after.keys()):
        if found.get(name) != scene.after.get(name):
            yield f"{name} is not that of an undisturbed run"
    shutil.rmtree(out)


def _in_a_copy(action: Callable[[], int]) -> int:
    """What a copy of this process ends with that does something; minus the signal that ended it."""
    pid = os.fork()
    if pid == 0:
        code = 99
        try:
            code = action()
        except KeyboardInterrupt:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            os.kill(os.getpid(), signal.SIGINT)
        finally:
            os._exit(code)
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


def _count(scene: Scene, out: Path, seen: int) -> int:
    _at_every_step(out, lambda _event, _number: os.write(seen, b"."))
    scene.run(out)
    return _ENDED_WELL


def _finish(scene: Scene, out: Path) -> int:
    scene.run(out)
    return _ENDED_WELL


def _disturbed(scene: Scene, out: Path, step: int, how: How) -> int:
    def act(event: str, number: int) -> None:
        if how is How.FULL and number >= step and event != "os.remove":
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        if number != step:
            return
        if how is How.KILL:
            os.kill(os.getpid(), signal.SIGKILL)
        elif how is How.FAIL:
            raise OSError(errno.EIO, os.strerror(errno.EIO))
        elif how is How.INTERRUPT:
            raise KeyboardInterrupt

    _at_every_step(out, act)
    try:
        batch = scene.run(out)
    except DeltacamError:
        return _REFUSED
    return _ENDED_WELL if _says_what_is_there(batch, out, len(parts_of(scene.parts))) else _INCONSISTENT


def _says_what_is_there(batch: Batch, out: Path, parts: int) -> bool:
    """Whether every part has a row, and all files of the rows are there, and no others of parts."""
    named = {file.name for row in batch.rows for file in row.files}
    there = {name for name in tree(out) if ".program." in name or ".report." in name}
    unwritten = {row.part.removesuffix(".dxf") for row in batch.rows if row.outcome.status.value == "unwritten"}
    others = {name for name in there - named if name.split(".")[0] not in unwritten}
    whole = all(sha256((out / file.name).read_bytes()) == file.sha256 for row in batch.rows for file in row.files)
    return len(batch.rows) == parts and named <= there and not others and whole


def _at_every_step(out: Path, act: Callable[[str, int], Any]) -> None:
    """Call ``act`` just before this process changes something in a folder, from now on and for ever."""
    steps, root = iter(range(sys.maxsize)), str(out)

    def look(event: str, given: tuple[Any, ...]) -> None:
        if event not in ("open", "os.rename", "os.remove", "os.mkdir"):
            return
        if event == "open" and not given[2] & _WRITING:
            return
        if isinstance(given[0], (str, Path)) and str(given[0]).startswith(root):
            act(event, next(steps))

    sys.addaudithook(look)


def main() -> None:
    """Disturb the batch at every step."""
    scene = Scene(Path(sys.argv[1]))
    steps = count_steps(scene)
    ways = list(How)
    every = [(step, how) for step in range(steps) for how in ways]
    chosen = every if "--all" in sys.argv else [(step, ways[step % len(ways)]) for step in range(steps)]
    for step, how in chosen:
        for flaw in flaws_at(scene, step, how):
            print(f"{how} at step {step}: {flaw}", flush=True)  # noqa: T201
    print(len(chosen))  # noqa: T201


if __name__ == "__main__":
    main()
