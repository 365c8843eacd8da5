"""Prints what a better place on the sheet gains over its centre, and how good the estimate is.

Both places are planned and verified. The error of the tool is that of the program: the largest with the laser on.
"""

import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.stats import spearmanr

from deltacam.pipeline import Planned, best_places, plan
from deltacam.placing.estimate import estimate
from deltacam.placing.find import Found
from deltacam.robot.measures import tool_error_per_joint_error_in_plane
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot

ROOT = Path(__file__).parents[1]
PARTS = {
    "bracket": (ROOT / "samples" / "bracket.dxf", None),
    "gear": (ROOT / "samples" / "gear.dxf", None),
    "nameplate": (ROOT / "samples" / "nameplate.dxf", None),
    "wrench": (ROOT / "tests" / "data" / "dxf" / "wrench-inch.dxf", None),
    "key-plate": (ROOT / "tests" / "data" / "dxf" / "key-plate-bulge.dxf", None),
}
CHECKED = 10


def robots() -> dict[str, Robot]:
    """The built-in one, one with weak joints, and one with weak joints that waits in a corner of a large sheet."""
    delta, irb = load_robot("delta-300"), load_robot("irb360-1600")
    weak = replace(delta.joints, max_acceleration=(15.0,) * 3, max_speed=(0.8,) * 3)
    heavy = replace(irb.joints, max_acceleration=(10.0,) * 3, max_speed=(0.5,) * 3)
    return {
        "delta-300": delta,
        "delta-300, weak": replace(delta, joints=weak),
        "irb360-1600, weak": replace(irb, joints=heavy, workspace=replace(irb.workspace, park=(0.45, 0.35))),
    }


def error(planned: Planned) -> float:
    """The largest error of the tool at a tick with the laser on, um by mrad of the joints."""
    program = planned.program
    tool = program.robot.forward(program.q[program.power > 0.0])
    return 1e3 * float(tool_error_per_joint_error_in_plane(program.robot.geometry, tool).max())


def quality(robot: Robot, found: Found) -> tuple[float, float, float]:
    """Of the estimate, turned as the best place: rank correlation, least and largest share of the planned time."""
    best, sampled = found.best[0].spot, found.maps
    places = np.stack(np.meshgrid(sampled.x, sampled.y), axis=-1).reshape(-1, 2)
    task = found.task
    held = places[task.part.holds(robot.workspace, best.rotation, places)]
    some = np.random.default_rng(0).permutation(len(held))[:CHECKED]
    turns = np.full(len(some), best.rotation)
    estimated = estimate(task.sample(best.at, best.rotation), robot, held[some], turns).time
    planned = [task.duration((float(x), float(y)), best.rotation) for x, y in held[some]]
    ratio = np.array(estimated) / np.array(planned)
    return float(spearmanr(estimated, planned)[0]), float(ratio.min()), float(ratio.max())


def main() -> None:
    """Place every part on every robot."""
    print(
        "part       robot              best place                       time s at centre, best   gain   "
        "error um/mrad   gain  search s  rank  estimate/plan"
    )
    for label, robot in robots().items():
        for name, (path, unit) in PARTS.items():
            if sys.argv[1:] and name not in sys.argv[1:]:
                continue
            started = time.perf_counter()
            found, _ = best_places(path, robot=robot, unit=unit)
            seconds = time.perf_counter() - started
            best = found.best[0].spot
            there = plan(path, robot=robot, unit=unit, at=best.at, rotation=best.rotation, what_if=False)
            here = plan(path, robot=robot, unit=unit, what_if=False)
            if not (there.report.passed and here.report.passed):
                sys.exit(f"{name} on {label}: a check failed")
            times = here.program.duration, there.program.duration
            errors = error(here), error(there)
            rank, low, high = quality(robot, found)
            print(
                f"{name:10} {label:18} {best.options:32} {times[0]:10.3f} {times[1]:10.3f} "
                f"{100 * (1 - times[1] / times[0]):6.2f} % {errors[0]:7.1f} {errors[1]:7.1f} "
                f"{100 * (1 - errors[1] / errors[0]):6.2f} % {seconds:7.1f}  {rank:5.2f}  {low:.3f}..{high:.3f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
