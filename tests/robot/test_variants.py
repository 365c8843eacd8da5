"""Robots with unequal arms, and bases that are turned, moved or upside down: against a drawing of them in space."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot import kinematics, measures
from deltacam.robot.dimensions import DeltaGeometry, Mount
from deltacam.robot.reader import load_robot

ROBOT = load_robot("delta-300")


def around(middle: float, by: float) -> st.SearchStrategy[tuple[float, float, float]]:
    one = st.floats(middle - by, middle + by)
    return st.tuples(one, one, one)


mounts = st.builds(
    Mount,
    x=st.floats(-0.5, 0.5),
    y=st.floats(-0.5, 0.5),
    z=st.floats(-1.0, 1.0),
    rotation=st.floats(-6.0, 6.0),
    upside_down=st.booleans(),
)
variants = st.builds(
    DeltaGeometry,
    base_radius=around(0.13, 0.01),
    effector_radius=around(0.035, 0.01),
    upper_arm=around(0.3, 0.02),
    forearm=around(0.7, 0.04),
    azimuths=st.tuples(st.floats(-1.8, -1.3), st.floats(0.3, 0.8), st.floats(2.4, 2.9)),
    mount=mounts,
)
places = st.tuples(st.floats(-0.15, 0.15), st.floats(-0.15, 0.15), st.floats(-0.7, -0.6))


def in_machine(geometry: DeltaGeometry, own: Array) -> Array:
    """Vectors (..., 3) of the base's own frame in the machine, as rotations one after the other."""
    mount = geometry.mount
    over = np.diag([1.0, -1.0, -1.0]) if mount.upside_down else np.eye(3)
    c, s = np.cos(mount.rotation), np.sin(mount.rotation)
    return own @ over.T @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]).T


def tool(geometry: DeltaGeometry, own: tuple[float, float, float]) -> Array:
    mount = geometry.mount
    return in_machine(geometry, np.array([own])) + np.array([mount.x, mount.y, mount.z])


def forearms(geometry: DeltaGeometry, q: Array, point: Array) -> Array:
    """From the elbows to the wrists, (3, 3) m, all drawn in the machine from the one side and from the other."""
    mount, rows = geometry.mount, []
    lengths = zip(geometry.base_radii, geometry.effector_radii, geometry.upper_arms, strict=True)
    for arm, (base, effector, upper) in enumerate(lengths):
        azimuth = geometry.azimuths[arm]
        outwards = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        elbow = (base + upper * np.cos(q[arm])) * outwards - (0.0, 0.0, upper * np.sin(q[arm]))
        wrist = point + in_machine(geometry, effector * outwards)
        rows.append(wrist - in_machine(geometry, elbow) - (mount.x, mount.y, mount.z))
    return np.array(rows)


@given(variants, places)
def test_every_forearm_of_any_variant_has_its_own_length(
    geometry: DeltaGeometry, own: tuple[float, float, float]
) -> None:
    point = tool(geometry, own)
    q = kinematics.inverse(geometry, point)
    drawn = forearms(geometry, q[0], point[0])
    assert np.linalg.norm(drawn, axis=1) == pytest.approx(geometry.forearms, abs=1e-13)
    assert kinematics.forward(geometry, q) == pytest.approx(point, abs=1e-12)
    directions, _ = kinematics.forearm_directions(geometry, point)
    assert directions[0] == pytest.approx(drawn / geometry.forearms[:, np.newaxis], abs=1e-12)


@given(variants, places, st.tuples(*[st.floats(-1.0, 1.0)] * 3))
def test_the_derivatives_of_any_variant_are_differences_of_its_positions(
    geometry: DeltaGeometry, own: tuple[float, float, float], direction: tuple[float, float, float]
) -> None:
    point, way, step = tool(geometry, own), np.array([direction]), 3e-3
    near = [kinematics.inverse(geometry, point + k * step * way) for k in range(-3, 4)]
    first = np.tensordot(np.array([-1, 9, -45, 0, 45, -9, 1]) / 60.0, near, 1) / step
    second = np.tensordot(np.array([2, -27, 270, -490, 270, -27, 2]) / 180.0, near, 1) / step**2
    _, dq, ddq = kinematics.path_derivatives(geometry, point, way, np.zeros((1, 3)))
    assert dq == pytest.approx(first, abs=1e-9)
    assert ddq == pytest.approx(second, abs=1e-8)
    J, H = kinematics.inverse_jacobian(geometry, point), kinematics.joint_curvatures(geometry, point)
    assert J[0] @ way[0] == pytest.approx(dq[0], abs=1e-12)
    assert np.einsum("ijk,j,k->i", H[0], way[0], way[0]) == pytest.approx(ddq[0], abs=1e-11)


@given(variants, places)
def test_no_measure_depends_on_how_the_base_is_mounted(
    geometry: DeltaGeometry, own: tuple[float, float, float]
) -> None:
    hanging, point = replace(geometry, mount=Mount()), np.array([own])
    mounted = tool(geometry, own)
    for measure in (measures.forearm_swing, measures.inverse_condition, kinematics.reach_margin, kinematics.inverse):
        assert measure(geometry, mounted) == pytest.approx(measure(hanging, point), abs=1e-10)
    for one, other in zip(
        measures.pressure_angles(geometry, mounted), measures.pressure_angles(hanging, point), strict=True
    ):
        assert one == pytest.approx(other, abs=1e-7)  # near 0 an angle has half the digits of its cosine


@given(variants, places)
def test_the_swing_is_measured_to_the_plane_of_the_arm_itself(
    geometry: DeltaGeometry, own: tuple[float, float, float]
) -> None:
    point = tool(geometry, own)
    drawn = forearms(geometry, kinematics.inverse(geometry, point)[0], point[0])
    azimuths = np.array(geometry.azimuths)
    normals = in_machine(geometry, np.stack([-np.sin(azimuths), np.cos(azimuths), np.zeros(3)], axis=1))
    expected = np.arcsin(np.abs((drawn * normals).sum(axis=1)) / geometry.forearms)
    assert measures.forearm_swing(geometry, point)[0] == pytest.approx(expected, abs=1e-12)


def test_equal_lengths_are_held_as_one() -> None:
    robot = replace(ROBOT, geometry=replace(ROBOT.geometry, upper_arm=(0.3, 0.3, 0.3)))
    assert robot.geometry.upper_arm == 0.3
    assert robot == ROBOT
    assert robot.fingerprint == ROBOT.fingerprint


@pytest.mark.parametrize(
    "mount",
    [Mount(x=1e-6), Mount(y=1e-6), Mount(z=1e-6), Mount(rotation=1e-6), Mount(upside_down=True)],
)
def test_another_mount_is_another_robot(mount: Mount) -> None:
    assert replace(ROBOT, geometry=replace(ROBOT.geometry, mount=mount)).fingerprint != ROBOT.fingerprint


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), 25.0])
@pytest.mark.parametrize("name", ["x", "y", "z", "rotation"])
def test_a_mount_out_of_bounds_is_refused(name: str, bad: float) -> None:
    with pytest.raises(RobotError, match=f"{name} = .* is outside") as caught:
        Mount(**{name: bad})
    assert caught.value.where == "mount"


@pytest.mark.parametrize("name", ["base_radius", "effector_radius", "upper_arm", "forearm"])
def test_one_arm_out_of_bounds_is_refused(name: str) -> None:
    with pytest.raises(RobotError, match=rf"{name} = -1 m is outside"):
        replace(ROBOT.geometry, **{name: (0.2, 0.2, -1.0)})


def test_a_point_on_the_wrong_side_of_a_standing_base_is_refused() -> None:
    standing = replace(ROBOT.geometry, mount=Mount(upside_down=True))
    assert kinematics.inverse(standing, [[0.0, 0.0, 0.65]])[0] == pytest.approx(
        kinematics.inverse(ROBOT.geometry, [[0.0, 0.0, -0.65]])[0]
    )
    with pytest.raises(RobotError, match=r"1 of 2 points are not above the base; the lowest is \(0.000, 0.000, -650"):
        kinematics.inverse(standing, [[0.0, 0.0, -0.65], [0.0, 0.0, 0.65]])
