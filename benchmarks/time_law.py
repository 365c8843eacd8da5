"""Prints what the time law costs and how near it is to an independent bound, over many random paths."""

import argparse
import time

import numpy as np

from deltacam.motion.parametrize import Limits, TimeLaw, parametrize
from deltacam.motion.path import Path
from deltacam.robot.robot import Robot
from tests.motion.test_parametrize import CAP, ROBOT, WEAK, derivatives, random_path, shortest_time


def worst_shares(path: Path, law: TimeLaw, robot: Robot) -> tuple[float, float, float]:
    """The largest tool acceleration, joint speed and joint acceleration between gridpoints, as shares of the limits."""
    tool, speed, acceleration = 0.0, 0.0, 0.0
    width = np.diff(law.distance)
    u = np.diff(law.speed**2) / (2.0 * width)
    for share in np.clip(np.arange(11) / 10, 1e-6, 1.0 - 1e-6):
        squared = law.speed[:-1] ** 2 * (1.0 - share) + law.speed[1:] ** 2 * share
        dq, ddq, curvature = derivatives(path, law.distance[:-1] + share * width)
        tool = max(tool, float(np.hypot(u, curvature * squared).max()) / CAP)
        speed = max(speed, float((np.abs(dq) * np.sqrt(squared)[:, None] / robot.joints.max_speed).max()))
        joint = np.abs(dq * u[:, None] + ddq * squared[:, None]) / robot.joints.max_acceleration
        acceleration = max(acceleration, float(joint.max()))
    return tool, speed, acceleration


def main() -> None:
    """Run the campaign and print one row per robot and feed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--paths", type=int, default=50, help="paths per row")
    count = parser.parse_args().paths
    print("joints  feed m/s  paths  gridpoints  us/gridpoint  time / bound: median   worst  worst share of")
    print("                                                                                 tool a  joint v  joint a")
    parametrize(random_path(0), ROBOT, Limits(1.0, CAP), where="")  # so that imports do not count
    for name, robot in (("strong", ROBOT), ("weak", WEAK)):
        for feed in (0.05, 0.2, 0.5, 1.0):
            ratios, shares, points, spent = [], [], 0, 0.0
            for seed in range(count):
                path = random_path(seed)
                started = time.perf_counter()
                law = parametrize(path, robot, Limits(feed, CAP), where="")
                spent += time.perf_counter() - started
                points += len(law.time)
                ratios.append(law.duration / shortest_time(path, robot, CAP, feed, 1e-4))
                shares.append(worst_shares(path, law, robot))
            tool, speed, acceleration = np.max(shares, axis=0)
            print(
                f"{name:6} {feed:9.2f} {count:6} {points:11} {spent / points * 1e6:13.1f} "
                f"{np.median(ratios):21.5f} {max(ratios):7.4f} {tool:9.5f} {speed:8.5f} {acceleration:8.5f}"
            )


if __name__ == "__main__":
    main()
