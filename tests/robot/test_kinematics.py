"""Kinematics, against published numbers, another implementation, and numerical differences."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot import kinematics
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.reader import load_robot, profile_names
from deltacam.robot.robot import Robot

DATA = Path(__file__).parents[1] / "data"
ROBOTS = {name: load_robot(name) for name in profile_names()}
LINUXCNC_CSV = DeltaGeometry(0.13201113905020793, 0.033197640478403486, 0.112, 0.232)
LINUXCNC_DEFAULT = DeltaGeometry(0.10, 0.06, 0.10, 0.14)  # a hundredth of its numbers, so that they are metres
WILLIAMS = DeltaGeometry(0.567 / np.sqrt(12.0), 0.076 / np.sqrt(3.0), 0.524, 1.244)

robots = st.sampled_from(list(ROBOTS.values()))


@st.composite
def points_on(draw: st.DrawFn, robot: Robot, count: int = 8, inside: float = 1.0) -> Array:
    """Points of the robot's sheet, and up to 20 mm above and below it."""
    unit, area = st.floats(-inside, inside), robot.workspace
    rows = []
    for _ in range(count):
        u, v, up = draw(unit), draw(unit), draw(st.floats(-0.02, 0.02))
        if area.radius is None:
            rows.append([u * area.width / 2, v * area.depth / 2, area.sheet_z + up])
        else:
            rows.append([u * area.radius * np.cos(np.pi * v), u * area.radius * np.sin(np.pi * v), area.sheet_z + up])
    return np.array(rows)


def linuxcnc_poses() -> tuple[Array, Array]:
    rows = np.loadtxt(DATA / "linuxcnc_rotarydelta.csv", delimiter=",", skiprows=5)
    assert rows.shape == (200, 6)
    return rows[:, :3], rows[:, 3:]


def test_forward_meets_the_poses_of_linuxcnc() -> None:
    angles_deg, points_mm = linuxcnc_poses()
    found_mm = 1e3 * kinematics.forward(LINUXCNC_CSV, np.radians(angles_deg))
    assert np.abs(found_mm - points_mm).max() < 1e-9


def test_inverse_meets_the_poses_of_linuxcnc() -> None:
    angles_deg, points_mm = linuxcnc_poses()
    found_deg = np.degrees(kinematics.inverse(LINUXCNC_CSV, points_mm / 1e3))
    assert np.abs(found_deg - angles_deg).max() < 1e-9


@pytest.mark.parametrize(
    ("geometry", "angles_deg", "point_mm", "digits"),
    [
        (WILLIAMS, (0, 0, 0), (0, 0, -1064.4517), 4),
        (WILLIAMS, (10, 20, 30), (108.1354, -180.3484, -1243.5413), 4),
        (LINUXCNC_DEFAULT, (30, 30, 30), (0, 0, -109.764510955), 9),
        (LINUXCNC_DEFAULT, (10, 40, -15), (-23.3765491238, -3.79042874815, -47.5649418803), 10),
        (LINUXCNC_DEFAULT, (27.8282791375, 30.1881783357, 56.0444829552), (30, -20, -130), 8),
    ],
)
def test_published_poses_are_met_to_the_digits_printed(
    geometry: DeltaGeometry, angles_deg: tuple[float, ...], point_mm: tuple[float, ...], digits: int
) -> None:
    unit = 0.5000001 * 10.0**-digits
    assert 1e3 * kinematics.forward(geometry, np.radians([angles_deg]))[0] == pytest.approx(point_mm, abs=unit)


def test_the_published_inverse_is_met_to_the_digits_printed() -> None:
    angles = kinematics.inverse(LINUXCNC_DEFAULT, [[0.03, -0.02, -0.13]])[0]
    assert np.degrees(angles) == pytest.approx((27.8282791375, 30.1881783357, 56.0444829552), abs=0.51e-10)


def test_the_published_unreachable_point_is_refused() -> None:
    """(0, 0, -24) in LinuxCNC's units; straight below, so that the missing length follows from one triangle."""
    missing_mm = 1e3 * (np.hypot(0.04, 0.24) - 0.24)
    with pytest.raises(RobotError, match="1 of 1 points are out of reach") as caught:
        kinematics.inverse(LINUXCNC_DEFAULT, [[0.0, 0.0, -0.24]])
    assert f"{missing_mm:.3f} mm too far for arm" in caught.value.what


def test_the_profile_of_the_irb_has_the_published_geometry() -> None:
    point = ROBOTS["irb360-1600"].forward(np.radians([[10.0, 20.0, 30.0]]))[0]
    assert 1e3 * point == pytest.approx((108.1354, -180.3484, -1243.5413), abs=0.51e-4)


@given(robots.flatmap(lambda robot: st.tuples(st.just(robot), points_on(robot))))
def test_forward_undoes_inverse(case: tuple[Robot, Array]) -> None:
    robot, points = case
    assert np.abs(robot.forward(robot.inverse(points)) - points).max() < 1e-12


@given(robots.flatmap(lambda robot: st.tuples(st.just(robot), points_on(robot))))
def test_the_forearms_keep_their_length(case: tuple[Robot, Array]) -> None:
    robot, points = case
    geometry, q = robot.geometry, robot.inverse(points)
    for arm, azimuth in enumerate(geometry.azimuths):
        outwards = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        elbow = (geometry.base_radius + geometry.upper_arm * np.cos(q[:, arm, np.newaxis])) * outwards
        elbow[:, 2] -= geometry.upper_arm * np.sin(q[:, arm])
        hand = points + geometry.effector_radius * outwards
        assert np.linalg.norm(hand - elbow, axis=1) == pytest.approx(geometry.forearm, abs=1e-13)


@given(
    st.lists(st.floats(-80, 120), min_size=3, max_size=3),
    st.sampled_from([LINUXCNC_CSV, LINUXCNC_DEFAULT, WILLIAMS, ROBOTS["delta-300"].geometry]),
)
def test_inverse_undoes_forward_where_forward_answers(angles_deg: list[float], geometry: DeltaGeometry) -> None:
    """Forward refuses elbows that are folded inwards, so that no pose has a second set of angles."""
    angles = np.radians([angles_deg])
    try:
        points = kinematics.forward(geometry, angles)
        sensitivity = np.abs(kinematics.inverse_jacobian(geometry, points)).max()
    except RobotError:
        return
    assert np.abs(kinematics.inverse(geometry, points) - angles).max() < 1e-12 * max(1.0, sensitivity) ** 2


@given(st.lists(st.floats(0.0, 1.0), min_size=3, max_size=3), robots)
def test_inverse_undoes_forward_within_the_joint_range_of_every_robot(shares: list[float], robot: Robot) -> None:
    """Over the whole reach of the joints, not only over the sheet."""
    low, high = np.array(robot.joints.min), np.array(robot.joints.max)
    angles = (low + np.array(shares) * (high - low))[np.newaxis]
    try:
        points = robot.forward(angles)
        sensitivity = np.abs(robot.inverse_jacobian(points)).max()
    except RobotError:
        return
    assert np.abs(robot.inverse(points) - angles).max() < 1e-12 * max(1.0, sensitivity) ** 2


@given(st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3), robots)
def test_forward_undoes_inverse_wherever_every_robot_reaches(shares: list[float], robot: Robot) -> None:
    """In a box about the whole region. The forearms meet in two points, and `forward` gives the lower one."""
    length = float(np.max(robot.geometry.upper_arms + robot.geometry.forearms))
    point = length * np.array([[shares[0], shares[1], -abs(shares[2])]])
    try:
        angles = robot.inverse(point)
        found = robot.forward(angles)
        singular = max(mu.max() for mu in robot.pressure_angles(found)) > np.radians(89.0)
    except RobotError:
        return
    assume(not singular)
    assert np.abs(robot.inverse(found) - angles).max() < 1e-10
    assert np.abs(found - point).max() < 1e-10 or found[0, 2] < point[0, 2]


def complex_inverse(robot: Robot, points: Array) -> Array:
    """The inverse kinematics for complex points: for derivatives by a complex step, which lose no digits."""
    geometry, columns = robot.geometry, []
    arms = zip(geometry.azimuths, geometry.offsets, geometry.upper_arms, geometry.forearms, strict=True)
    for azimuth, offset, upper, forearm in arms:
        x = points[:, 0] * np.cos(azimuth) + points[:, 1] * np.sin(azimuth) - offset
        y, z = points[:, 1] * np.cos(azimuth) - points[:, 0] * np.sin(azimuth), points[:, 2]
        k = (x * x + y * y + z * z + upper**2 - forearm**2) / (2 * upper)
        t = np.sqrt(x * x + z * z - k * k)
        columns.append((np.log((x * k - z * t) - 1j * (z * k + x * t)) - np.log(x * x + z * z)) / 1j)
    return np.stack(columns, axis=-1)


@given(robots.flatmap(lambda robot: st.tuples(st.just(robot), points_on(robot))))
def test_the_inverse_jacobian_is_the_complex_step_of_the_inverse(case: tuple[Robot, Array]) -> None:
    robot, points = case
    assert np.abs(complex_inverse(robot, points).real - robot.inverse(points)).max() < 1e-12
    J = robot.inverse_jacobian(points)
    for axis in range(3):
        # The inverse is analytic but its values are real parts: its complex derivative is taken along a circle.
        step = 1e-5 * np.eye(3)[axis]
        turns = np.exp(2j * np.pi * np.arange(8) / 8)
        around = [complex_inverse(robot, points + turn * step) / turn for turn in turns]
        assert np.abs(np.mean(around, axis=0) / 1e-5 - J[:, :, axis]).max() < 1e-8 * np.abs(J).max()


def test_forward_refuses_angles_that_no_point_has() -> None:
    cases = {
        "the forearms do not meet": (170.0, 20.0, 20.0),
        "above the base": (130.0, 0.0, 0.0),
        "an elbow is folded inwards": (160.0, 60.0, 60.0),
    }
    good = (30.0, 30.0, 30.0)
    for why, bad in cases.items():
        with pytest.raises(RobotError, match=f"1 of 2 poses are impossible: .*{why}") as caught:
            kinematics.forward(LINUXCNC_DEFAULT, np.radians([good, bad]))
        assert caught.value.where == "pose 1"


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e200])
def test_a_value_that_is_not_finite_never_passes(bad: float) -> None:
    geometry, good = ROBOTS["delta-300"].geometry, np.array([[0.0, 0.0, -0.65], [0.01, 0.0, -0.65]])
    wrong = good.copy()
    wrong[1, 1] = bad
    for call in (kinematics.inverse, kinematics.forward, kinematics.inverse_jacobian, kinematics.reach_margin):
        with pytest.raises(RobotError, match=r"1 of 2 .* are not finite"):
            call(geometry, wrong)
    for arguments in ((wrong, good, good), (good, wrong, good), (good, good, wrong)):
        with pytest.raises(RobotError, match="are not finite"):
            kinematics.path_derivatives(geometry, *arguments)


@pytest.mark.parametrize("z", [0.0, -1e-200, 0.65])
def test_a_point_that_is_not_below_the_base_is_refused(z: float) -> None:
    with pytest.raises(RobotError, match="1 of 1 points are not below the base"):
        kinematics.inverse(ROBOTS["delta-300"].geometry, [[0.0, 0.0, z]])


def test_a_point_too_near_or_too_far_aside_is_refused() -> None:
    geometry = ROBOTS["delta-300"].geometry
    with pytest.raises(RobotError, match="mm too near for arm"):
        kinematics.inverse(geometry, [[0.0, 0.0, -0.2]])
    with pytest.raises(RobotError, match=r"1 of 2 .*mm too far for arm") as caught:
        kinematics.inverse(geometry, [[0.0, 0.0, -0.65], [0.9, 0.0, -0.1]])
    assert caught.value.where == "point 1"


@given(st.floats(-0.6, 0.6), st.floats(-0.6, 0.6), st.floats(-1.2, -0.1))
def test_moving_the_point_by_the_missing_length_brings_it_to_the_edge_of_reach(x: float, y: float, z: float) -> None:
    geometry = ROBOTS["delta-300"].geometry
    try:
        kinematics.inverse(geometry, [[x, y, z]])
    except RobotError as problem:
        amount, words = re.findall(r"([0-9.]+) mm (too far|too near) for arm", problem.what)[0]
        arm = int(problem.what[-1]) - 1
    else:
        return
    azimuth = geometry.azimuths[arm]
    u, w = np.array([np.cos(azimuth), np.sin(azimuth), 0.0]), np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    assume(
        abs(np.array([x, y, z]) @ w) < geometry.forearm
    )  # else the arm's plane is too far, and no motion in it helps
    joint = geometry.offsets[arm] * u + (np.array([x, y, z]) @ w) * w  # beside the joint, in the point's own plane
    away = np.array([x, y, z]) - joint
    away *= 1.0 + (-1.0 if words == "too far" else 1.0) * float(amount) * 1e-3 / np.linalg.norm(away)
    assert abs(kinematics.reach_margin(geometry, [joint + away])[0, arm]) < 1e-5


@pytest.mark.parametrize("shape", [(3,), (2, 2), (1, 3, 3)])
def test_another_shape_is_refused(shape: tuple[int, ...]) -> None:
    for call in (kinematics.inverse, kinematics.forward):
        with pytest.raises(ValueError, match=r"expected shape \(N, 3\)"):
            call(LINUXCNC_CSV, np.zeros(shape))


def test_no_points_give_no_angles() -> None:
    assert kinematics.inverse(LINUXCNC_CSV, np.zeros((0, 3))).shape == (0, 3)
    assert kinematics.forward(LINUXCNC_CSV, np.zeros((0, 3))).shape == (0, 3)


def test_stretched_arms_reach_but_have_no_speed() -> None:
    """Straight below, at exactly the length of both arms: a legal place, but a singular one."""
    geometry = DeltaGeometry(0.13, 0.035, 0.3, 0.7)
    point = [[0.0, 0.0, -np.sqrt(1.0 - 0.095**2)]]
    angles = np.full((1, 3), np.pi / 2 + np.arcsin(0.095))
    assert kinematics.inverse(geometry, point) == pytest.approx(angles, abs=1e-6)
    assert kinematics.forward(geometry, angles) == pytest.approx(np.array(point), abs=1e-12)
    assert kinematics.reach_margin(geometry, point) == pytest.approx(np.zeros((1, 3)), abs=1e-12)
    with pytest.raises(RobotError, match="at the edge of its reach"):
        kinematics.inverse_jacobian(geometry, point)


def test_elbows_in_one_line_hold_no_point() -> None:
    """With equal radii and all arms down the elbows are one point, and the forearms swing freely."""
    with pytest.raises(RobotError, match="the forearms do not meet"):
        kinematics.forward(DeltaGeometry(0.1, 0.1, 0.3, 0.7), np.full((1, 3), np.pi / 2))


@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(-1.2, -0.05))
def test_the_reach_margin_is_negative_exactly_where_inverse_refuses(x: float, y: float, z: float) -> None:
    geometry = ROBOTS["delta-300"].geometry
    margin = kinematics.reach_margin(geometry, [[x, y, z]]).min()
    if abs(margin) < 1e-9:
        return
    try:
        kinematics.inverse(geometry, [[x, y, z]])
        assert margin > 0
    except RobotError:
        assert margin < 0


@given(robots.flatmap(lambda robot: st.tuples(st.just(robot), points_on(robot, inside=0.99))))
def test_the_inverse_jacobian_is_the_derivative_of_inverse(case: tuple[Robot, Array]) -> None:
    robot, points = case
    step = 1e-4
    J = robot.inverse_jacobian(points)
    for axis in range(3):
        d = step * np.eye(3)[axis]
        fine = (robot.inverse(points + d) - robot.inverse(points - d)) / (2 * step)
        wide = (robot.inverse(points + 2 * d) - robot.inverse(points - 2 * d)) / (4 * step)
        assert np.abs((4 * fine - wide) / 3 - J[:, :, axis]).max() < 1e-9 * np.abs(J).max()


@given(robots.flatmap(lambda robot: st.tuples(st.just(robot), points_on(robot, inside=0.99))))
def test_the_joint_curvatures_are_the_derivative_of_the_inverse_jacobian(case: tuple[Robot, Array]) -> None:
    robot, points = case
    step = 1e-4
    H = kinematics.joint_curvatures(robot.geometry, points)
    for axis in range(3):
        d = step * np.eye(3)[axis]
        fine = (robot.inverse_jacobian(points + d) - robot.inverse_jacobian(points - d)) / (2 * step)
        wide = (robot.inverse_jacobian(points + 2 * d) - robot.inverse_jacobian(points - 2 * d)) / (4 * step)
        assert np.abs((4 * fine - wide) / 3 - H[..., axis]).max() < 1e-8 * np.abs(H).max()


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=lambda robot: robot.name)
def test_path_derivatives_are_the_differences_of_inverse_along_a_path(robot: Robot) -> None:
    size = 0.14 if robot.workspace.radius is None else 0.6 * robot.workspace.radius
    scale, rate, phase = np.array([size, size, 0.05]), np.array([2.0, 3.0, 1.0]), np.array([0.3, 1.1, 0.0])

    def path(s: Array) -> Array:
        return scale * np.sin(np.outer(s, rate) + phase) + [0.0, 0.0, robot.workspace.sheet_z]

    s, h = np.linspace(0.0, 6.0, 500), 2e-3
    angle = np.outer(s, rate) + phase
    q, dq, ddq = robot.path_derivatives(path(s), scale * rate * np.cos(angle), -scale * rate**2 * np.sin(angle))
    near = [robot.inverse(path(s + k * h)) for k in range(-3, 4)]
    first = np.array([-1, 9, -45, 0, 45, -9, 1]) / 60.0
    second = np.array([2, -27, 270, -490, 270, -27, 2]) / 180.0
    assert np.array_equal(q, near[3])
    assert np.abs(np.tensordot(first, near, 1) / h - dq).max() < 1e-9 * np.abs(dq).max()
    assert np.abs(np.tensordot(second, near, 1) / h**2 - ddq).max() < 1e-8 * np.abs(ddq).max()


@pytest.mark.parametrize("robot", ROBOTS.values(), ids=lambda robot: robot.name)
def test_the_third_derivative_is_the_difference_of_the_second_along_a_path(robot: Robot) -> None:
    size = 0.14 if robot.workspace.radius is None else 0.6 * robot.workspace.radius
    scale, rate, phase = np.array([size, size, 0.05]), np.array([2.0, 3.0, 1.0]), np.array([0.3, 1.1, 0.0])

    def derivatives(s: Array) -> list[Array]:
        angle, middle = np.outer(s, rate) + phase, np.array([0.0, 0.0, robot.workspace.sheet_z])
        first, second = scale * rate * np.cos(angle), -scale * rate**2 * np.sin(angle)
        return [scale * np.sin(angle) + middle, first, second, -scale * rate**3 * np.cos(angle)]

    s, h = np.linspace(0.0, 6.0, 500), 1e-3
    near = [robot.path_derivatives(*derivatives(s + k * h)[:3])[2] for k in range(-3, 4)]
    wanted = np.tensordot(np.array([-1, 9, -45, 0, 45, -9, 1]) / 60.0, near, 1) / h
    found = robot.third_derivative(*derivatives(s))
    assert np.abs(found - wanted).max() < 1e-8 * np.abs(found).max()
    with pytest.raises(ValueError, match="500 points, 1 third derivatives"):
        robot.third_derivative(*derivatives(s)[:3], np.zeros((1, 3)))


def test_path_derivatives_of_different_lengths_are_refused() -> None:
    one, two = np.array([[0.0, 0.0, -0.65]]), np.zeros((2, 3))
    with pytest.raises(ValueError, match="1 points, 2 first and 2 second derivatives"):
        kinematics.path_derivatives(ROBOTS["delta-300"].geometry, one, two, two)


def test_arms_in_the_same_direction_are_refused() -> None:
    with pytest.raises(RobotError, match="at least 10 degrees apart"):
        DeltaGeometry(0.13, 0.035, 0.3, 0.7, (0.0, 2 * np.pi - 0.1, 3.0))


def test_azimuths_turn_the_robot() -> None:
    geometry, turned = LINUXCNC_CSV, DeltaGeometry(0.13201113905020793, 0.033197640478403486, 0.112, 0.232, (0, 2, 4))
    shifted = DeltaGeometry(0.13201113905020793, 0.033197640478403486, 0.112, 0.232, (0.5, 2.5, 4.5))
    point = np.array([[0.02, -0.03, -0.2]])
    c, s = np.cos(0.5), np.sin(0.5)
    rotated = point @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    assert kinematics.inverse(shifted, rotated) == pytest.approx(kinematics.inverse(turned, point), abs=1e-14)
    assert kinematics.inverse(geometry, point) != pytest.approx(kinematics.inverse(turned, point), abs=1e-3)
