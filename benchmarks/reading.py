"""Prints how reading and joining grow with the size of a drawing, each in a fresh process so that peak memory counts.

    python benchmarks/reading.py [CURVES ...]       1000 10000 100000 1000000 where none is given

``lines`` are squares of four LINEs each on one sheet; ``mixed`` repeats a square, a circle, a slot of LINEs and ARCs
and a rounded LWPOLYLINE, with every tenth square open.
"""

import gc
import json
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

SIZES = (1_000, 10_000, 100_000, 1_000_000)
PITCH = 10.0  # mm between neighbours
HEAD = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"
TAIL = "0\nENDSEC\n0\nEOF\n"


def line(ax: float, ay: float, bx: float, by: float) -> str:
    """A LINE entity."""
    subclasses = "100\nAcDbEntity\n8\n0\n100\nAcDbLine\n"
    return f"0\nLINE\n{subclasses}10\n{ax:.4f}\n20\n{ay:.4f}\n11\n{bx:.4f}\n21\n{by:.4f}\n"


def arc(x: float, y: float, radius: float, start: float, end: float) -> str:
    """An ARC entity, degrees."""
    circle = f"100\nAcDbEntity\n8\n0\n100\nAcDbCircle\n10\n{x:.4f}\n20\n{y:.4f}\n40\n{radius:.4f}\n"
    return f"0\nARC\n{circle}100\nAcDbArc\n50\n{start:.4f}\n51\n{end:.4f}\n"


def circle(x: float, y: float, radius: float) -> str:
    """A CIRCLE entity."""
    return f"0\nCIRCLE\n100\nAcDbEntity\n8\n0\n100\nAcDbCircle\n10\n{x:.4f}\n20\n{y:.4f}\n40\n{radius:.4f}\n"


def polyline(vertices: list[tuple[float, float, float]]) -> str:
    """A closed LWPOLYLINE entity of x, y and bulge."""
    body = "".join(f"10\n{x:.4f}\n20\n{y:.4f}\n42\n{bulge:.6f}\n" for x, y, bulge in vertices)
    return f"0\nLWPOLYLINE\n100\nAcDbEntity\n8\n0\n100\nAcDbPolyline\n90\n{len(vertices)}\n70\n1\n{body}"


def square(x: float, y: float, *, sides: int = 4) -> Iterator[str]:
    """The sides of a square of 8 mm."""
    corners = [(x, y), (x + 8, y), (x + 8, y + 8), (x, y + 8), (x, y)]
    for (ax, ay), (bx, by) in list(pairwise(corners))[:sides]:
        yield line(ax, ay, bx, by)


def places(count: int) -> Iterator[tuple[float, float]]:
    """A square grid of places."""
    side = math.isqrt(count) + 1
    return ((PITCH * (i % side), PITCH * (i // side)) for i in range(count))


def lines(count: int) -> Iterator[str]:
    """So many LINEs, four to a square."""
    for x, y in places(count // 4):
        yield from square(x, y)


def mixed(count: int) -> Iterator[str]:
    """So many entities of several kinds."""
    for i, (x, y) in enumerate(places(count // 10)):
        yield from square(x, y, sides=3 if i % 10 == 0 else 4)
        yield circle(x + 4, y + 4, 0.5)
        yield from (line(x + 1, y + 1, x + 3, y + 1), arc(x + 3, y + 1.5, 0.5, -90, 90))
        yield from (line(x + 3, y + 2, x + 1, y + 2), arc(x + 1, y + 1.5, 0.5, 90, 270))
        yield polyline([(x + 1, y + 5, 0.0), (x + 3, y + 5, 0.41421356), (x + 4, y + 6, 0.0), (x + 1, y + 7, 0.0)])


KINDS = {"lines": lines, "mixed": mixed}


def peak_memory() -> float:
    """The most memory that this process has had, MB; getrusage would count what its parent had before it."""
    status = Path("/proc/self/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) / 1024


def measure(path: str) -> None:
    """Read one drawing in this process, as ``read_drawing`` does, and print seconds by stage and memory as JSON."""
    gc.disable()
    from deltacam.drawing import assemble, operations
    from deltacam.drawing.dxf import document
    from deltacam.drawing.entities import walk
    from deltacam.model import EVERYTHING

    base = peak_memory()
    marks = [time.perf_counter()]
    data = Path(path).read_bytes()
    loaded = document.load(data, "drawing.dxf")
    marks.append(time.perf_counter())
    found = walk.read(loaded.document, 1e-3)
    del loaded
    gc.collect()
    marks.append(time.perf_counter())
    joined = assemble.assemble(found, operations.assign(found.entities, EVERYTHING), EVERYTHING.joining)
    marks.append(time.perf_counter())
    peak = peak_memory() - base
    seconds = [b - a for a, b in pairwise(marks)]
    print(json.dumps({"seconds": seconds, "peak": peak, "curves": len(found.curves), "contours": len(joined.contours)}))


def main() -> None:
    """Measure every kind and size."""
    sizes = [int(text) for text in sys.argv[1:]] or SIZES
    names = (
        "curves",
        "contours",
        "file MB",
        "load s",
        "entities s",
        "join s",
        "whole s",
        "us/curve",
        "peak MB",
        "/file",
    )
    print(f"{'':6}" + "".join(f"{name:>11}" for name in names))
    with tempfile.TemporaryDirectory() as folder:
        for kind, make in KINDS.items():
            for size in sizes:
                path = Path(folder) / f"{kind}.dxf"
                with path.open("w") as stream:
                    stream.writelines((HEAD, *make(size), TAIL))
                command = [sys.executable, __file__, "--one", str(path)]
                run = subprocess.run(command, capture_output=True, text=True, check=True)
                found = json.loads(run.stdout.splitlines()[-1])
                whole, megabytes = sum(found["seconds"]), path.stat().st_size / 2**20
                print(
                    f"{kind:6}{found['curves']:11}{found['contours']:11}{megabytes:11.2f}"
                    + "".join(f"{seconds:11.2f}" for seconds in (*found["seconds"], whole))
                    + f"{1e6 * whole / found['curves']:11.1f}{found['peak']:11.0f}{found['peak'] / megabytes:11.1f}"
                )


if __name__ == "__main__":
    if sys.argv[1:2] == ["--one"]:
        measure(*sys.argv[2:])
    else:
        main()
