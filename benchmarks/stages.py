"""Prints how long each stage of ``plan`` takes, each drawing in a fresh process so that imports count."""

import json
import resource
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).parent.parent
DRAWINGS = [
    (ROOT / "tests/data/dxf/drone-top-onshape.dxf", "mm", "delta-300"),
    (ROOT / "tests/data/dxf/key-plate-bulge.dxf", None, "delta-300"),
    (ROOT / "tests/data/dxf/nest-forms.dxf", None, "irb360-1600"),
    *((ROOT / f"samples/{name}.dxf", None, "delta-300") for name in ("bracket", "gear", "nameplate", "sheet")),
]
STAGES = ("read", "kerf", "order", "motion", "write", "verify", "report")


def measure(drawing: str, unit: str, robot: str, folder: str) -> None:
    """Plan one drawing in this process and print the seconds by stage as JSON."""
    started = time.perf_counter()
    from deltacam.pipeline import plan_to_folder

    seconds = {"import": time.perf_counter() - started}
    current, since = "", time.perf_counter()

    def progress(stage: str, _done: int, _total: int) -> None:
        nonlocal current, since
        now = time.perf_counter()
        if current:
            seconds[current] = seconds.get(current, 0.0) + now - since
        current, since = stage, now

    planned, _ = plan_to_folder(drawing, folder, unit=unit or None, robot=robot, progress=progress)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        json.dumps({"seconds": seconds, "rows": len(planned.program.q), "peak": peak, "passed": planned.report.passed})
    )


def main() -> None:
    """Measure every drawing in a process of its own."""
    import tempfile

    chosen = [(Path(name), "", "delta-300") for name in sys.argv[1:]] or DRAWINGS
    columns = ("import", *STAGES, "whole")
    print(f"{'drawing':24} {'setpoints':>9} " + " ".join(f"{name:>7}" for name in columns) + "  peak MB   (seconds)")
    with tempfile.TemporaryDirectory() as folder:
        for drawing, unit, robot in chosen:
            started = time.perf_counter()
            command = [sys.executable, __file__, "--one", str(drawing), unit or "", robot, folder]
            run = subprocess.run(command, capture_output=True, text=True, check=True)
            whole = time.perf_counter() - started
            found = json.loads(run.stdout.splitlines()[-1])
            cells = [*(found["seconds"].get(name, 0.0) for name in ("import", *STAGES)), whole]
            figures = " ".join(f"{cell:7.2f}" for cell in cells)
            verdict = "" if found["passed"] else "  FAILED"
            print(f"{drawing.stem:24} {found['rows']:9} {figures} {found['peak']:8.0f}{verdict}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--one"]:
        measure(*sys.argv[2:])
    else:
        main()
