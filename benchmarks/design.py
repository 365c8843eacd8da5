"""Prints the smallest robots for the three published boxes on several seeds, and checks each one independently.

The check is a million random points of the box, half of them on its surface, with formulas of its own: the inverse
kinematics by the tangent of the half angle, the Jacobian by differences of that, the forearms from elbow to effector.
"""

from __future__ import annotations

import argparse
import time
from typing import Final, NamedTuple

import numpy as np

from deltacam.model import Array
from deltacam.robot.synthesis.shape import BoxShape
from deltacam.robot.synthesis.synthesis import Design, design
from deltacam.robot.synthesis.wish import Wish

BOXES: Final = {
    "cube, 200 mm": (BoxShape(0.2, 0.2, 0.2), 0.3952),
    "laser bed, 300 x 300 x 20 mm": (BoxShape(0.3, 0.3, 0.02), 0.4259),
    "150 x 130 x 150 mm": (BoxShape(0.15, 0.13, 0.15), 0.2883),
}
"""The published boxes, and the size that is to be reached, m."""

_CHUNK: Final = 100_000
_STEP: Final = 1e-6  # of the differences, m


class Sampled(NamedTuple):
    """The worst that a sampling found; angles in degrees."""

    unreached: int
    lowest_joint: float
    highest_joint: float
    inverse_condition: float
    mu2: float

    def keeps(self, wish: Wish) -> bool:
        """Whether every point is as the wish has it."""
        return (
            self.unreached == 0
            and self.lowest_joint >= np.degrees(wish.joint_min)
            and self.highest_joint <= np.degrees(wish.joint_max)
            and self.inverse_condition >= wish.min_inverse_condition
            and self.mu2 <= np.degrees(wish.max_transmission_angle)
        )


def sample(found: Design, count: int, seed: int = 1) -> Sampled:
    """The worst over random points of the box of a design."""
    shape = found.wish.shape
    if not isinstance(shape, BoxShape):
        raise TypeError("the check is for boxes")
    random, parts = np.random.default_rng(seed), []
    lengths = tuple(float(value) for value in found.candidate[:3])
    for start in range(0, count, _CHUNK):
        points = random.uniform(-1.0, 1.0, (min(_CHUNK, count - start), 3))
        surface = np.arange(len(points)) % 2 == 0
        side = random.integers(0, 3, len(points))
        rows = np.flatnonzero(surface)
        points[rows, side[rows]] = np.sign(points[rows, side[rows]])
        points[::97] = np.sign(points[::97])  # the corners
        points = points * np.array([shape.width, shape.depth, shape.height]) / 2.0 + [0.0, 0.0, found.middle]
        parts.append(_worst(lengths, points))
    columns = tuple(zip(*parts, strict=True))
    unreached, low, high, condition, mu2 = columns
    return Sampled(sum(unreached), min(low), max(high), min(condition), max(mu2))


def classic_inverse(lengths: tuple[float, float, float], points: Array) -> Array:
    """The joint angles (N, 3) rad by the tangent of the half angle; nan out of reach."""
    offset, La, Lb = lengths
    angles = np.full(points.shape, np.nan)
    for arm, azimuth in enumerate(np.radians([-90.0, 30.0, 150.0])):
        x = points[:, 0] * np.cos(azimuth) + points[:, 1] * np.sin(azimuth) - offset
        y = points[:, 1] * np.cos(azimuth) - points[:, 0] * np.sin(azimuth)
        z = points[:, 2]
        E, F, G = -2.0 * La * x, 2.0 * La * z, x**2 + y**2 + z**2 + La**2 - Lb**2
        root = np.sqrt(np.where(E**2 + F**2 >= G**2, E**2 + F**2 - G**2, np.nan))
        both = 2.0 * np.arctan2(np.stack((-F + root, -F - root)), G - E)
        # Elbow out: the knee lies outside of the straight line from the motor to the effector's joint.
        outside = -z * np.cos(both) - x * np.sin(both)
        angles[:, arm] = np.take_along_axis(both, outside.argmax(axis=0)[np.newaxis], axis=0)[0]
    return (angles + np.pi) % (2.0 * np.pi) - np.pi


def _worst(lengths: tuple[float, float, float], points: Array) -> tuple[int, float, float, float, float]:
    offset, La, Lb = lengths
    q = classic_inverse(lengths, points)
    unreached = int(np.isnan(q).any(axis=1).sum())
    if unreached:
        return unreached, -180.0, 180.0, 0.0, 90.0
    moved = [classic_inverse(lengths, points + s * _STEP * axis) for axis in np.eye(3) for s in (1.0, -1.0)]
    columns = [(moved[2 * k] - moved[2 * k + 1]) / (2.0 * _STEP) for k in range(3)]
    values = np.linalg.svd(np.nan_to_num(np.stack(columns, axis=2)), compute_uv=False)
    azimuths = np.radians([-90.0, 30.0, 150.0])
    out = offset + La * np.cos(q)
    elbows = np.stack((out * np.cos(azimuths), out * np.sin(azimuths), -La * np.sin(q)), axis=2)
    forearms = (points[:, np.newaxis] - elbows) / Lb
    mu2 = 0.0
    for i in range(3):
        normal = np.cross(forearms[:, (i + 1) % 3], forearms[:, (i + 2) % 3])
        normal /= np.linalg.norm(normal, axis=1)[:, np.newaxis]
        mu2 = max(mu2, float(np.degrees(np.arccos(np.abs((normal * forearms[:, i]).sum(axis=1)).clip(0, 1)).max())))
    degrees = np.degrees(q)
    return 0, float(degrees.min()), float(degrees.max()), float((values[:, 2] / values[:, 0]).min()), mu2


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--samples", type=int, default=1_000_000)
    asked = parser.parse_args()
    print("| box | seed | size, m | to reach | s | proved margin of 1/cond | smallest 1/cond | largest mu2 | verdict |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|---|")
    for name, (shape, bound) in BOXES.items():
        for seed in range(asked.seeds):
            start = time.perf_counter()
            found = design(Wish(shape), seed=seed)
            took = time.perf_counter() - start
            margins = {margin.name: margin.low for margin in found.certificate.margins}
            sampled = sample(found, asked.samples)
            good = found.certificate.certified and sampled.keeps(found.wish) and found.size <= bound
            print(
                f"| {name} | {seed} | {found.size:.6f} | {bound} | {took:.1f} | {margins['inverse_condition']:.1e} "
                f"| {sampled.inverse_condition:.6f} | {sampled.mu2:.3f} | {'holds' if good else 'FAILS'} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
