"""Small drawings, and folders of results to look into, for the tests of a batch."""

from __future__ import annotations

import json
import os
import threading
import time
from collections.abc import Generator, Iterator, Mapping
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

from deltacam.batch.parts import Part, Result, Task
from deltacam.batch.planning.key import sha256
from deltacam.batch.planning.task import perform
from deltacam.batch.results.folder import PLOTLY, PRIVATE
from deltacam.cutting.process import load_process
from deltacam.errors import DeltacamError
from deltacam.program.formats import read_program
from deltacam.report.page import plotly_js
from deltacam.robot.reader import load_robot

ROOT: Final = Path(__file__).parents[2]
_FAULTS: Final = str(Path(__file__).parent / "faults")

OPTIONS: Final[Mapping[str, Any]] = {
    "robot": load_robot("delta-300"),
    "process": load_process("steel-1mm-fibre"),
    "what_if": False,
}


def plate(path: Path, *, width: float = 12.0, holes: int = 0) -> Path:
    """A drawing, mm: a rectangle 8 mm high with holes in a row; it is planned within half a second."""
    corners = [(0.0, 0.0), (width, 0.0), (width, 8.0), (0.0, 8.0)]
    shapes = [
        f"0\nLINE\n8\nCUT\n10\n{ax}\n20\n{ay}\n11\n{bx}\n21\n{by}\n"
        for (ax, ay), (bx, by) in zip(corners, [*corners[1:], corners[0]], strict=True)
    ]
    shapes += [f"0\nCIRCLE\n8\nCUT\n10\n{width * (n + 1) / (holes + 1)}\n20\n4.0\n40\n1.0\n" for n in range(holes)]
    return written(path, "".join(shapes))


def bow_tie(path: Path) -> Path:
    """A drawing that is refused: its outline crosses itself."""
    corners = [(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0), (0.0, 0.0)]
    pairs = pairwise(corners)
    return written(path, "".join(f"0\nLINE\n8\nCUT\n10\n{a}\n20\n{b}\n11\n{c}\n21\n{d}\n" for (a, b), (c, d) in pairs))


def written(path: Path, entities: str) -> Path:
    """A drawing of these entities, mm."""
    path.parent.mkdir(parents=True, exist_ok=True)
    header = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n"
    path.write_text(f"{header}0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n")
    return path


def parts_of(folder: Path, **options: Any) -> list[Part]:
    """The drawings of a folder, with options besides `OPTIONS`."""
    given = {**OPTIONS, **options}
    return [Part(path.relative_to(folder).as_posix(), path, given) for path in sorted(folder.rglob("*.dxf"))]


_KNOWN: Final[dict[str, Result]] = {}


def plan_here(tasks: Iterator[Task], *, stop: threading.Event) -> Generator[tuple[Task, Result]]:
    """A planner without processes of its own, which plans what has one key once: the key names all that counts."""
    for task in tasks:
        if stop.is_set():
            return
        if task.key not in _KNOWN:
            _KNOWN[task.key] = perform(task)
        yield task, _KNOWN[task.key]


def tree(folder: Path) -> dict[str, bytes]:
    """Every file of a folder of results but the lock."""
    files = (path for path in folder.rglob("*") if path.is_file() and path.name != "lock")
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def damage(folder: Path) -> list[str]:
    """What is not as it should be in a folder of results, whatever happened to the batch: nothing."""
    found = []
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if path.is_file() and not name.startswith(f"{PRIVATE}/"):
            try:
                problem = _problem(path, folder)
            except (DeltacamError, ValueError, LookupError, OSError) as error:
                problem = repr(error)
            found += [f"{name}: {problem}"] if problem else []
    return found


def _problem(path: Path, folder: Path) -> str:
    """Why a file is not as it should be; empty where it is."""
    if path.name.endswith(".program.csv"):
        return _problem_of_program(path)
    if path.name == "batch.json":
        files = [file for row in json.loads(path.read_bytes())["parts"] for file in row["files"]]
        others = [file["name"] for file in files if sha256((folder / file["name"]).read_bytes()) != file["sha256"]]
        return f"says something else of {others}" if others else ""
    if path.name.endswith(".report.json"):
        return "" if json.loads(path.read_bytes()) else "empty"
    if path.name == PLOTLY:
        return "" if path.read_bytes() == plotly_js().encode() else "another"
    end = {".html": b"</html>\n", ".csv": b"\n"}.get(path.suffix)
    if end is None:
        return "not a file of a batch"
    return "" if path.read_bytes().endswith(end) else "cut off"


def _problem_of_program(path: Path) -> str:
    rows = len(read_program(path).q)  # which compares the hash of its rows
    stem = path.name.removesuffix(".program.csv")
    if not path.with_name(f"{stem}.report.html").exists():
        return "a program without its report"
    report = json.loads(path.with_name(f"{stem}.report.json").read_bytes())
    return "" if report["passed"] and report["summary"]["program"]["rows"] == rows else "the report of another program"


def with_faults(enabled: bool = True) -> str:
    """A PYTHONPATH with which a process that plans fails as the name of the drawing says."""
    before = [path for path in os.environ.get("PYTHONPATH", "").split(os.pathsep) if path and path != _FAULTS]
    ours = [str(ROOT), str(ROOT / "cli")]
    return os.pathsep.join([*([_FAULTS] if enabled else []), *ours, *before])


def children(pid: int) -> list[int]:
    """The processes that a process has started and that have not ended: Linux."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            state, parent = stat.read_text().rpartition(")")[2].split()[:2]
            # Python starts a tracker of its own once a process is spawned.
            tracks = b"resource_tracker" in (stat.parent / "cmdline").read_bytes()
            if int(parent) == pid and state not in "ZX" and not tracks:
                found.append(int(stat.parent.name))
    return sorted(found)


def ended(pids: list[int], within: float = 20.0) -> bool:
    """Whether none of the processes is there any more, or at the latest after so many seconds."""
    until = time.monotonic() + within
    while any(_is_there(pid) for pid in pids):
        if time.monotonic() > until:
            return False
        time.sleep(0.02)
    return True


def _is_there(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False
