"""The batched formulas of the search are those of the robot."""

import numpy as np
import pytest

from deltacam.model import Array
from deltacam.robot import kinematics, limits, measures
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.synthesis import kernel

RNG = np.random.default_rng(6)
ROBOTS = np.array([[0.03, 0.20, 0.40, -0.35], [-0.04, 0.204, 0.232, -0.175], [0.095, 0.30, 0.70, -0.65]])
POINTS = RNG.uniform(-0.08, 0.08, (400, 3))


def machine(row: Array) -> tuple[DeltaGeometry, Array]:
    offset, La, Lb, middle = row
    return DeltaGeometry(0.1 + offset, 0.1, La, Lb), POINTS + np.array([0.0, 0.0, middle])


@pytest.mark.parametrize("number", range(len(ROBOTS)))
def test_the_batched_measures_are_those_of_the_robot(number: int) -> None:
    geometry, points = machine(ROBOTS[number])
    at = kernel.poses(ROBOTS, POINTS)
    cosines = kernel.forearm_cosines(at)
    smallest, largest = kernel.singular_values(at, cosines)
    mu1, mu2 = measures.pressure_angles(geometry, points)
    near = pytest.approx

    def own(values: Array) -> Array:
        return values[:, number].T

    assert own(at.reach) == near(kinematics.reach_margin(geometry, points), abs=1e-12)
    assert own(kernel.joint_angles(at)) == near(kinematics.inverse(geometry, points), abs=1e-12)
    assert own(at.t) / ROBOTS[number, 2] == near(np.cos(mu1), abs=1e-12)
    assert own(kernel.transmission(cosines)) == near(np.cos(mu2), abs=1e-11)
    assert np.arcsin(np.abs(own(at.y)) / ROBOTS[number, 2]) == near(measures.forearm_swing(geometry, points), abs=1e-12)
    assert (smallest / largest)[number] == near(measures.inverse_condition(geometry, points), abs=1e-11)
    values = np.linalg.svd(kinematics.inverse_jacobian(geometry, points), compute_uv=False)
    assert smallest[number] == near(values[:, -1], rel=1e-10)
    assert own(kernel.joint_speeds(at, 2.0)) == near(limits.joint_speed_demand(geometry, points, speed=2.0), rel=1e-11)
    needed = limits.joint_acceleration_demand(geometry, points, speed=2.0, acceleration=3.0)
    assert own(kernel.joint_accelerations(at, 2.0, 3.0)) == near(needed, rel=1e-10)


def test_poses_out_of_reach_are_finite_and_say_how_far() -> None:
    far = POINTS + np.array([0.0, 0.0, -2.0])
    at = kernel.poses(ROBOTS, far)
    smallest, largest = kernel.singular_values(at, kernel.forearm_cosines(at))
    assert (at.reach.min(axis=0) < -0.5).all()
    for values in (kernel.joint_angles(at), kernel.transmission(kernel.forearm_cosines(at)), smallest, largest):
        assert np.isfinite(values).all()
