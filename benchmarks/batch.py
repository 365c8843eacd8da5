"""Plans a folder of generated parts with one process, with two, and on a Dask cluster, and prints a table.

    .venv/bin/python benchmarks/batch.py [--parts 1000] [--processes 1 2] [--dask] [--seed 0]

Every part is another plate of 25 to 60 mm with one to four round holes or slots. With ``--dask`` a scheduler and two
workers are started on this machine. Memory is read while the batch runs. The exit code is 1 where the results differ.
"""

import argparse
import hashlib
import json
import random
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import ezdxf
import psutil
from ezdxf.layouts import Modelspace

DELTACAM = (sys.executable, "-c", "from deltacam_cli.main import main; main()", "batch")
MARKS = (0.1, 0.5, 1.0)
"""Shares of the parts at which memory is looked at."""

HEAD = ("planned by", "parts", "wall s", "parts/s", "ratio", "parent MB", "largest worker MB at", "same bytes")
ROW = "{:14} {:>6} {:>8} {:>8} {:>6} {:>16} {:>22} {:>11}"


class Measured(NamedTuple):
    """One run: its time, s, and the memory of the parent and of the largest worker at every mark, MB."""

    seconds: float
    parent: list[float]
    worker: list[float]
    digest: str


def draw(path: Path, chance: random.Random) -> None:
    """A plate with round holes and slots."""
    document = ezdxf.new(units=4)
    space = document.modelspace()
    width, height = chance.uniform(25, 60), chance.uniform(25, 60)
    space.add_lwpolyline([(0, 0), (width, 0), (width, height), (0, height)], close=True)
    for number in range(chance.randint(1, 4)):
        x = (0.25 + 0.5 * (number % 2)) * width
        y = (0.25 + 0.5 * (number // 2)) * height
        _opening(space, x, y, chance)
    document.saveas(path)


def _opening(space: Modelspace, x: float, y: float, chance: random.Random) -> None:
    radius = chance.uniform(1.0, 2.5)
    if chance.random() < 0.7:
        space.add_circle((x, y), radius)
        return
    half = chance.uniform(0.5, 2.5)
    ends = [(x - half, y - radius, 0), (x + half, y - radius, 1), (x + half, y + radius, 0), (x - half, y + radius, 1)]
    space.add_lwpolyline(ends, format="xyb", close=True)


def run(folder: Path, output: Path, parts: int, *options: str) -> Measured:
    """A batch in a process of its own, watched."""
    command = [*DELTACAM, str(folder), "-o", str(output), "--no-what-if", "--memory", "none", *options]
    begin = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None  # noqa: S101 - for types
    marks = [max(round(share * parts), 1) for share in MARKS]
    parent, worker = [], []
    with _Watch(process.pid) as watch:
        for count, _line in enumerate(process.stderr, start=1):
            if count in marks:
                parent.append(watch.parent)
                worker.append(watch.worker)
    if process.wait():
        sys.exit(f"the batch ended with exit code {process.returncode}")
    return Measured(time.perf_counter() - begin, parent, worker, _digest(output))


class _Watch:
    """Reads the memory of a process and of the largest that plans, here or under a worker of Dask, MB."""

    def __init__(self, pid: int) -> None:
        self.parent = self.worker = 0.0
        self._process = psutil.Process(pid)
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._look)

    def __enter__(self) -> "_Watch":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()

    def _look(self) -> None:
        while not self._over.wait(0.5):
            try:
                self.parent = self._process.memory_info().rss / 1e6
                # Those of this batch, or of the workers of Dask that we have started.
                planning = [each for each in psutil.Process().children(recursive=True) if _plans(each.cmdline())]
                self.worker = max((each.memory_info().rss / 1e6 for each in planning), default=0.0)
            except psutil.Error:
                continue  # it has ended meanwhile


def _plans(command: list[str]) -> bool:
    return "deltacam.batch.planning.worker" in command


def _digest(folder: Path) -> str:
    """Of the names and the bytes of all results."""
    total = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.name != "lock":
            total.update(f"{path.relative_to(folder)}\n{hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    return total.hexdigest()


@contextmanager
def cluster(scratch: Path) -> Iterator[str]:
    """The address of a scheduler with two workers of one thread."""
    file = scratch / "scheduler.json"
    own = ("--no-dashboard", "--scheduler-file", str(file))
    module = (sys.executable, "-m")
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    started = [
        subprocess.Popen(
            [*module, "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", *own], **quiet
        )
    ]
    try:
        while not file.exists():
            time.sleep(0.1)
        place = ("--local-directory", str(scratch), "--nworkers", "2", "--nthreads", "1")
        started.append(subprocess.Popen([*module, "distributed.cli.dask_worker", *place, *own], **quiet))
        yield json.loads(file.read_text())["address"]
    finally:
        for process in reversed(started):
            process.terminate()
            process.wait()


def main() -> None:
    """Generate the parts, run every batch, and print a line for each."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--parts", type=int, default=1000)
    parser.add_argument("--processes", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--dask", action="store_true", help="also on a cluster of two workers")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        folder = scratch / "parts"
        folder.mkdir()
        for number in range(options.parts):
            draw(folder / f"part{number:04}.dxf", random.Random(f"{options.seed} {number}"))  # noqa: S311 - no secret
        print(ROW.format(*HEAD), flush=True)
        first = None
        same = True
        for processes in options.processes:
            found = run(folder, scratch / f"out{processes}", options.parts, "--jobs", str(processes))
            first = first or found
            same &= show(f"{processes} process{'es' * (processes > 1)}", options.parts, found, first)
        if options.dask:
            with cluster(scratch) as address:
                found = run(folder, scratch / "outdask", options.parts, "--scheduler", address)
            same &= show("Dask, 2", options.parts, found, first or found)
    sys.exit(0 if same else 1)


def show(name: str, parts: int, found: Measured, first: Measured) -> bool:
    """Print one run; whether its results are those of the first."""
    same = found.digest == first.digest
    rate, ratio = parts / found.seconds, first.seconds / found.seconds
    memory = [" / ".join(f"{value:.0f}" for value in values) for values in (found.parent, found.worker)]
    print(
        ROW.format(
            name, parts, f"{found.seconds:.1f}", f"{rate:.2f}", f"{ratio:.2f}", *memory, "yes" if same else "NO"
        ),
        flush=True,
    )
    return same


if __name__ == "__main__":
    main()
