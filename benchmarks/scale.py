"""Prints how each stage of ``plan`` grows with the sheet, in seconds and peak memory, each sheet in a fresh process.

    python benchmarks/scale.py [CONTOURS ...] [--length METRES] [--slow]

A sheet is a disc of rounded rectangles with holes in them, circles, slots and polygons on irregular places, cut by
irb360-1600. It has about 50 mm of line per contour, at most 100 m; ``--slow`` cuts 30 m at 12 mm/s instead, which is
about a million setpoints.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from math import cos, pi, sin, sqrt, tan
from pathlib import Path

import numpy as np

ROBOT = "irb360-1600"
RADIUS = 690.0  # mm, of the sheet that is filled
FILLED = 0.465  # of the width of a cell, on either side of its centre; the rest keeps the kerfs apart
STAGES = ("read", "kerf", "order", "motion", "write", "verify", "report")
DEFAULT, SLOW = "steel-1mm-fibre", "acrylic-3mm-co2"

Shape = list[tuple[float, float, float]]  # x, y and bulge of each vertex


def rectangle(width: float, height: float, radius: float) -> Shape:
    """A rounded rectangle about the origin, counter-clockwise."""
    x, y, bulge = width / 2.0, height / 2.0, tan(pi / 8.0)
    right = [(x - radius, -y, bulge), (x, -y + radius, 0.0), (x, y - radius, bulge), (x - radius, y, 0.0)]
    left = [(-x + radius, y, bulge), (-x, y - radius, 0.0), (-x, -y + radius, bulge), (-x + radius, -y, 0.0)]
    return right + left


def slot(width: float, height: float) -> Shape:
    """Two straight sides with half circles at their ends, about the origin."""
    x, y = (width - height) / 2.0, height / 2.0
    return [(-x, -y, 0.0), (x, -y, 1.0), (x, y, 0.0), (-x, y, 1.0)]


def circle(radius: float, x: float = 0.0, y: float = 0.0) -> Shape:
    """Two half circles."""
    return [(x + radius, y, 1.0), (x - radius, y, 1.0)]


def polygon(rng: np.random.Generator, count: int) -> Shape:
    """An irregular one about the origin, within a radius of 1."""
    angles = 2.0 * pi * (np.arange(count) + rng.uniform(-0.3, 0.3, count)) / count
    return [(r * cos(a), r * sin(a), 0.0) for a, r in zip(angles, rng.uniform(0.5, 1.0, count), strict=True)]


def plate(rng: np.random.Generator) -> list[Shape]:
    """A rounded rectangle with one to four holes, within -1 to 1."""
    height = rng.uniform(1.3, 2.0)
    holes = [(-0.6, -0.35), (0.6, -0.35), (0.6, 0.35), (-0.6, 0.35)][: int(rng.integers(1, 5))]
    return [rectangle(2.0, height, rng.uniform(0.1, 0.3)), *(circle(rng.uniform(0.1, 0.22), *at) for at in holes)]


def part(rng: np.random.Generator) -> list[Shape]:
    """The contours of one part, turned at random, within a radius of about 1."""
    kind = rng.random()
    if kind < 0.35:
        shapes = [[(x / 1.3, y / 1.3, bulge) for x, y, bulge in shape] for shape in plate(rng)]
    elif kind < 0.6:
        shapes = [circle(rng.uniform(0.4, 1.0))]
    elif kind < 0.8:
        shapes = [slot(2.0, rng.uniform(0.3, 0.8))]
    else:
        shapes = [polygon(rng, int(rng.integers(3, 13)))]
    angle = rng.uniform(0.0, 2.0 * pi)
    return [[(cos(angle) * x - sin(angle) * y, sin(angle) * x + cos(angle) * y, b) for x, y, b in s] for s in shapes]


def length(shape: Shape) -> float:
    """Along the lines and arcs."""
    total = 0.0
    for (ax, ay, bulge), (bx, by, _) in zip(shape, [*shape[1:], shape[0]], strict=True):
        half = 2.0 * np.arctan(bulge)
        total += np.hypot(bx - ax, by - ay) * (half / np.sin(half) if half else 1.0)
    return float(total)


def sheet(contours: int, metres: float) -> list[Shape]:
    """So many contours of so much line, less where that does not fit, mm."""
    rng = np.random.default_rng(contours)
    parts: list[list[Shape]] = []
    missing = contours
    while missing:
        parts.append(part(rng)[:missing])
        missing -= len(parts[-1])
    pitch = RADIUS * sqrt(pi / len(parts))
    while len(places := cells(pitch)) < len(parts):
        pitch *= 0.995
    chosen = rng.permutation(len(places))[: len(parts)]
    scale = min(1e3 * metres / sum(length(shape) for shapes in parts for shape in shapes), FILLED * pitch)
    room = max(FILLED * pitch - scale, 0.0)
    shifted = []
    for shapes, index in zip(parts, chosen, strict=True):
        x, y = places[index] + rng.uniform(-room, room, 2)
        shifted += [[(x + scale * px, y + scale * py, bulge) for px, py, bulge in shape] for shape in shapes]
    return shifted


def cells(pitch: float) -> np.ndarray:
    """The centres of the squares of a grid that lie within the sheet."""
    side = np.arange(-int(RADIUS / pitch) - 1, int(RADIUS / pitch) + 2) * pitch
    centres = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    return centres[np.hypot(*centres.T) <= RADIUS - pitch / sqrt(2.0)]


def draw(shapes: list[Shape], path: Path) -> None:
    """Write a DXF file of CIRCLEs and LWPOLYLINEs."""
    import ezdxf

    document = ezdxf.new("R2010")
    document.units = ezdxf.units.MM
    space = document.modelspace()
    for shape in shapes:
        if len(shape) == 2:
            (ax, ay, _), (bx, by, _) = shape
            space.add_circle(((ax + bx) / 2.0, (ay + by) / 2.0), np.hypot(bx - ax, by - ay) / 2.0)
        else:
            space.add_lwpolyline(shape, format="xyb", close=True)
    document.saveas(path)


def peak_memory() -> float:
    """The most memory that this process has had since it was last told to forget, MB."""
    return int(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0]) / 1024


def measure(drawing: str, process: str, folder: str) -> None:
    """Plan one drawing in this process and print the seconds and the peak memory by stage as JSON."""
    from deltacam import pipeline

    seconds: dict[str, float] = {}
    peaks: dict[str, float] = {}
    current, since, begun = "", time.perf_counter(), time.perf_counter()

    def progress(stage: str, _done: int, _total: int) -> None:
        nonlocal current, since
        now = time.perf_counter()
        if current:
            seconds[current] = seconds.get(current, 0.0) + now - since
            peaks[current] = max(peaks.get(current, 0.0), peak_memory())
        if stage != current:
            with suppress(OSError):
                Path("/proc/self/clear_refs").write_text("5")
        current, since = stage, time.perf_counter()

    arrange = pipeline.ways

    def arranged(*arguments: object, **options: object) -> object:
        found = arrange(*arguments, **options)
        progress("motion", 0, 1)  # which says so itself only when all paths are made
        return found

    pipeline.ways = arranged
    planned, _ = pipeline.plan_to_folder(drawing, folder, robot=ROBOT, process=process, progress=progress)
    summary = planned.report.summary
    found = {
        "whole": time.perf_counter() - begun,
        "rows": len(planned.program.q),
        "cut": summary["cut_length_mm"] / 1e3,
        "rapid": summary["rapid_length_mm"] / 1e3,
        "passed": planned.report.passed,
    }
    print(json.dumps({"seconds": seconds, "peaks": peaks, **found}))


def show(contours: int, metres: float, process: str, folder: str) -> None:
    """Plan one sheet in a process of its own and print its two rows of the table."""
    drawing = Path(folder) / f"sheet-{contours}.dxf"
    draw(sheet(contours, metres), drawing)
    command = [sys.executable, __file__, "--one", str(drawing), process, folder]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode:
        sys.exit(run.stderr)
    found = json.loads(run.stdout.splitlines()[-1])
    seconds, peaks = ([found[what].get(name, 0.0) for name in STAGES] for what in ("seconds", "peaks"))
    verdict = "" if found["passed"] else "  FAILED"
    begin = f"{contours:8} {found['rows']:9} {found['cut']:6.1f} {found['rapid']:7.2f}"
    print(f"{begin} s  " + " ".join(f"{cell:7.2f}" for cell in (*seconds, found["whole"])) + verdict)
    print(f"{'':{len(begin)}} MB " + " ".join(f"{cell:7.0f}" for cell in (*peaks, max(peaks))), flush=True)


def main() -> None:
    """Measure every sheet that is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("contours", nargs="*", type=int, help="how many, of each sheet")
    parser.add_argument("--length", type=float, help="of all contours of a sheet, m")
    parser.add_argument("--slow", action="store_true", help="cut 30 m at 12 mm/s")
    asked = parser.parse_args()
    sizes = asked.contours or ([300] if asked.slow else [100, 300, 1000, 2000, 5000, 10000])
    print("contours setpoints  cut m rapid m    " + " ".join(f"{name:>7}" for name in (*STAGES, "whole")))
    with tempfile.TemporaryDirectory() as folder:
        for contours in sizes:
            metres = asked.length or (30.0 if asked.slow else min(0.05 * contours, 100.0))
            show(contours, metres, SLOW if asked.slow else DEFAULT, folder)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--one"]:
        measure(*sys.argv[2:])
    else:
        main()
