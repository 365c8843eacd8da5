"""Prints what the time law costs and how near it is to an independent bound, over many random paths."""

import argparse
import time

import numpy as np

from deltacam.motion.parametrize import Limits, TimeLaw, parametrize
from deltacam.motion.path import Path
from deltacam.robot.reader import load_robot
from tests.motion.test_parametrize import CAP, derivatives, random_path, reachability

ROBOT = load_robot("delta-300")


def worst_shares(path: Path, law: TimeLaw) -> tuple[float, float, float]:
    """The largest tool acceleration, joint speed and joint acceleration between gridpoints, as shares of the limits."""
    tool, speed, acceleration = 0.0, 0.0, 0.0
    width = np.diff(law.distance)
    u = np.diff(law.speed**2) / (2.0 * width)
    for share in (1e-6, 0.25, 0.5, 0.75, 1.0 - 1e-6):
        squared = law.speed[:-1] ** 2 * (1.0 - share) + law.speed[1:] ** 2 * share
        dq, ddq, curvature = derivatives(path, law.distance[:-1] + share * width)
        tool = max(tool, float(np.hypot(u, curvature * squared).max()) / CAP)
        speed = max(speed, float((np.abs(dq) * np.sqrt(squared)[:, None] / ROBOT.joints.max_speed).max()))
        joint = np.abs(dq * u[:, None] + ddq * squared[:, None]) / ROBOT.joints.max_acceleration
        acceleration = max(acceleration, float(joint.max()))
    return tool, speed, acceleration


def main() -> None:
    """Run the campaign and print one row per feed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--paths", type=int, default=100, help="paths per feed")
    count = parser.parse_args().paths
    print("feed m/s  paths  gridpoints  us/gridpoint   time / bound: median  worst   worst share of")
    print("                                                                         tool a  joint v  joint a")
    for feed in (0.05, 0.2, 0.5, 1.0):
        ratios, shares, points, spent = [], [], 0, 0.0
        for seed in range(count):
            path = random_path(seed)
            parametrize(path, ROBOT, Limits(feed, CAP), where="") if seed == 0 else None  # so that imports do not count
            started = time.perf_counter()
            law = parametrize(path, ROBOT, Limits(feed, CAP), where="")
            spent += time.perf_counter() - started
            points += len(law.time)
            ratios.append(law.duration / reachability(path, ROBOT, CAP, feed, 1e-4))
            shares.append(worst_shares(path, law))
        tool, speed, acceleration = np.max(shares, axis=0)
        print(
            f"{feed:8.2f} {count:6} {points:11} {spent / points * 1e6:13.1f} "
            f"{np.median(ratios):22.5f} {max(ratios):6.4f} {tool:9.5f} {speed:8.5f} {acceleration:8.5f}"
        )


if __name__ == "__main__":
    main()
