"""Prints what ``verify`` costs by part, in seconds and peak memory, each program in a fresh process.

    python benchmarks/verifying.py [METRES ...] [--contours N]

The sheets are those of scale.py, cut by irb360-1600 at 12 mm/s: 30 m are about a million setpoints.
"""

import argparse
import itertools
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import scale

PARTS = ("start", "parse", "drawing", "kinematics", "limits", "geometry", "summary")


def measure(program: str, drawing: str) -> None:
    """Verify one program in this process and print the seconds by part as JSON."""
    marks = [time.perf_counter()]
    from deltacam.drawing.reader import read_drawing
    from deltacam.program.formats import read_program
    from deltacam.verification.checks.table import OF_CONTOURS, OF_POSITIONS, OF_SETPOINTS
    from deltacam.verification.comparison import compare
    from deltacam.verification.evidence import gather
    from deltacam.verification.summary import summarize

    marks.append(time.perf_counter())
    found = read_program(program)
    marks.append(time.perf_counter())
    part = read_drawing(drawing, metres_per_unit=found.drawing.metres_per_unit, selection=found.selection)
    marks.append(time.perf_counter())
    evidence = gather(found, found.robot)
    marks.append(time.perf_counter())
    checks = [check(evidence) for check in (*OF_SETPOINTS, *OF_POSITIONS)]
    marks.append(time.perf_counter())
    comparison = compare(evidence, part)
    checks += [check(comparison) for check in OF_CONTOURS]
    marks.append(time.perf_counter())
    summarize(evidence, part, checks)
    marks.append(time.perf_counter())
    seconds = [after - before for before, after in itertools.pairwise(marks)]
    failed = [check.name for check in checks if not check.passed]
    print(json.dumps({"rows": len(found.q), "seconds": seconds, "peak": scale.peak_memory(), "failed": failed}))


def show(metres: float, contours: int, folder: Path) -> None:
    """Plan one sheet, then verify its program in every format that holds one."""
    from deltacam import pipeline
    from deltacam.program.formats import FORMATS, read_program, write_program

    drawing = folder / "sheet.dxf"
    scale.draw(scale.sheet(contours, metres), drawing)
    _, outputs = pipeline.plan_to_folder(drawing, folder, robot=scale.ROBOT, process=scale.SLOW, what_if=False)
    for name, kept in ((name, kept) for name, kept in FORMATS.items() if kept.whole):
        program = folder / f"sheet{kept.suffix}"
        if program != outputs.program:
            write_program(read_program(outputs.program), program)
        command = [sys.executable, __file__, "--one", str(program), str(drawing)]
        run = subprocess.run(command, capture_output=True, text=True, check=True)
        found = json.loads(run.stdout)
        cells = " ".join(f"{seconds:10.2f}" for seconds in (*found["seconds"], sum(found["seconds"])))
        verdict = f"  FAILED: {', '.join(found['failed'])}" if found["failed"] else ""
        print(f"{found['rows']:9} {contours:8} {name:>8} {cells} {found['peak']:8.0f}{verdict}", flush=True)


def main() -> None:
    """Measure every sheet that is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("metres", nargs="*", type=float, default=[3.0, 10.0, 30.0], help="of all contours, each sheet")
    parser.add_argument("--contours", type=int, default=200)
    asked = parser.parse_args()
    print("setpoints contours   format " + " ".join(f"{name:>10}" for name in (*PARTS, "whole s")) + "  peak MB")
    for metres in asked.metres:
        with tempfile.TemporaryDirectory() as folder:
            show(metres, asked.contours, Path(folder))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--one"]:
        measure(*sys.argv[2:])
    else:
        main()
