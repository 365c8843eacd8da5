"""A robot that is written to a file is the same robot when it is read back."""

import math
import tempfile
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.errors import RobotError
from deltacam.robot.bounds import BOUNDS
from deltacam.robot.dimensions import Mount, Triple
from deltacam.robot.reader import load_robot, profile_names
from deltacam.robot.robot import Controller, JointLimits, Robot
from deltacam.robot.writer import decimal, to_toml

DELTA = load_robot("delta-300")

TEXTS = st.text(st.characters(exclude_categories=["Cs"]), max_size=40)
NAMES = st.text(st.characters(exclude_categories=["C", "Z"]), min_size=1, max_size=40)
SMALL_CHANGES = st.floats(-5.0, 5.0)


def read_back(text: str) -> Robot:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "robot.toml"
        path.write_text(text, encoding="utf-8")
        return load_robot(path)


@st.composite
def file_robots(draw: st.DrawFn) -> Robot:
    """Robots near delta-300 whose values are numbers of a file; all limits are given, which reads them fast."""

    def near(name: str, value: float) -> float:
        return BOUNDS[name].to_si(value + draw(SMALL_CHANGES))

    def three(name: str, low: float, high: float) -> tuple[float, float, float]:
        bound = BOUNDS[name]
        return tuple(bound.to_si(draw(st.floats(low, high))) for _ in range(3))  # type: ignore[return-value]

    geometry = replace(
        DELTA.geometry,
        base_radius=near("base_radius", 130.0),
        effector_radius=near("effector_radius", 35.0),
        upper_arm=near("upper_arm", 300.0),
        forearm=near("forearm", 700.0),
        azimuths=(near("azimuths", -90.0), near("azimuths", 30.0), near("azimuths", 150.0)),
    )
    joints = JointLimits(
        min=three("min", -90.0, -30.0),
        max=three("max", 70.0, 100.0),
        max_speed=three("max_speed", 1e-3, 1e6),
        max_acceleration=three("max_acceleration", 1e-3, 1e9),
        max_jerk=three("max_jerk", 1e-3, 1e12) if draw(st.booleans()) else None,
    )
    workspace = replace(
        DELTA.workspace,
        sheet_z=near("sheet_z", -650.0),
        width=near("width", 200.0),
        depth=near("depth", 200.0),
        park=(near("park", 0.0), near("park", 0.0)),
        max_forearm_swing=near("max_forearm_swing", 60.0),
    )
    controller = Controller(draw(st.floats(1.0, 1e5)), draw(st.sampled_from(("linear", "cubic"))))
    return Robot(draw(NAMES), geometry, joints, DELTA.tool, workspace, controller, draw(TEXTS), draw(TEXTS))


@pytest.mark.parametrize("name", profile_names())
def test_a_built_in_robot_reads_back_as_itself(name: str) -> None:
    robot = load_robot(name)
    again = read_back(to_toml(robot))
    assert again == robot
    assert again.fingerprint == robot.fingerprint
    assert again.joints.derived == robot.joints.derived == ("max_speed", "max_acceleration")
    assert (again.description, again.source) == (robot.description, robot.source)


@st.composite
def mounted_robots(draw: st.DrawFn) -> Robot:
    """Robots whose arms differ, and whose base may be turned, moved and upside down."""
    robot = draw(file_robots())

    def lengths(name: str, value: float) -> Triple:
        one, two, three = (BOUNDS[name].to_si(value + draw(SMALL_CHANGES)) for _ in range(3))
        return one, two, three

    z, up = draw(st.floats(-1000.0, 1000.0)), draw(st.booleans())
    mount = Mount(
        x=BOUNDS["mount_x"].to_si(draw(SMALL_CHANGES)),
        y=BOUNDS["mount_y"].to_si(draw(SMALL_CHANGES)),
        z=BOUNDS["mount_z"].to_si(z),
        rotation=BOUNDS["mount_rotation"].to_si(draw(st.floats(-360.0, 360.0))),
        upside_down=up,
    )
    geometry = replace(
        robot.geometry,
        base_radius=lengths("base_radius", 130.0),
        effector_radius=lengths("effector_radius", 35.0),
        upper_arm=lengths("upper_arm", 300.0),
        forearm=lengths("forearm", 700.0),
        mount=mount,
    )
    sheet_z = BOUNDS["sheet_z"].to_si(z + (650.0 if up else -650.0))
    return replace(robot, geometry=geometry, workspace=replace(robot.workspace, sheet_z=sheet_z))


@given(st.one_of(file_robots(), mounted_robots()))
def test_a_robot_of_a_file_reads_back_as_itself(robot: Robot) -> None:
    again = read_back(to_toml(robot))
    assert again == robot
    assert again.fingerprint == robot.fingerprint
    assert (again.description, again.source) == (robot.description, robot.source)


@given(st.sampled_from(sorted(BOUNDS)), st.data())
def test_a_number_of_a_file_is_written_as_the_same_float_and_no_longer(name: str, data: st.DataObject) -> None:
    bound = BOUNDS[name]
    given_number = data.draw(st.floats(bound.minimum, bound.maximum, allow_subnormal=False))
    if abs(given_number) < 1e-280:
        given_number = 0.0 if bound.minimum <= 0.0 else bound.minimum  # below this a unit's factor loses digits
    text = decimal(bound, bound.to_si(given_number))
    assert bound.to_si(float(text)) == bound.to_si(given_number)
    assert len(text) <= len(repr(given_number))
    assert tomllib.loads(f"x = {text}")["x"] == float(text)


@given(st.sampled_from(sorted(BOUNDS)), st.data())
def test_any_float_is_written_as_its_nearest_neighbour_at_worst(name: str, data: st.DataObject) -> None:
    bound = BOUNDS[name]
    value = data.draw(st.floats(bound.to_si(bound.minimum), bound.to_si(bound.maximum)))
    text = decimal(bound, value)
    assert bound.minimum <= float(text) <= bound.maximum
    assert bound.to_si(float(text)) == pytest.approx(value, rel=4e-16, abs=1e-290)


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("forearm", 0.7, "700"),
        ("sheet_z", -0.65, "-650"),
        ("min", math.radians(-45.0), "-45"),
        ("tool_max_speed", 1.0, "60"),
        ("upper_arm", 0.1 + 0.2, "300.00000000000006"),
        ("park", -0.0, "0"),
        ("max_jerk", math.radians(366_000.0), "366000"),
    ],
)
def test_a_number_is_as_short_as_a_person_would_write_it(name: str, value: float, text: str) -> None:
    assert decimal(BOUNDS[name], value) == text


def test_a_radius_that_only_a_side_leads_to_is_written_by_its_side() -> None:
    sides = (BOUNDS["base_side"].to_si(float(side)) for side in range(400, 1000))
    written = [to_toml(replace(DELTA, geometry=replace(DELTA.geometry, base_radius=radius))) for radius in sides]
    by_side = [text for text in written if "base_side_mm" in text]
    assert by_side, "no such side"
    assert all("base_radius_mm" not in text for text in by_side)


def test_a_robot_that_no_decimal_describes_settles_on_its_first_writing() -> None:
    lengths = 0.3 + np.arange(200) * 2.0**-54
    unreachable = [x for x in lengths if BOUNDS["upper_arm"].to_si(float(decimal(BOUNDS["upper_arm"], x))) != x]
    robot = replace(DELTA, geometry=replace(DELTA.geometry, upper_arm=float([*unreachable, 0.3][0])))
    settled = read_back(to_toml(robot))
    assert settled.geometry.upper_arm == pytest.approx(robot.geometry.upper_arm, rel=1e-15)
    assert read_back(to_toml(settled)) == settled


@pytest.mark.parametrize(
    "text", ['"', "\\", "\x00\x1f\x7f", "a\nb\r\n", "\u202e\u2028\x85", "\U0010ffff", "é漢🙂", "\\u0041"]
)
def test_any_text_survives(text: str) -> None:
    again = tomllib.loads(to_toml(replace(DELTA, description=text, source=text)))
    assert (again["description"], again["source"]) == (text, text)


def test_half_of_a_surrogate_pair_is_refused() -> None:
    with pytest.raises(RobotError, match="description holds half of a surrogate pair"):
        to_toml(replace(DELTA, description="\ud800"))


def test_a_remark_stands_above_its_key_and_cannot_add_one() -> None:
    text = to_toml(
        DELTA, header=["made\x0bby a test"], remarks={"tool.max_speed_m_min": "a guess\nrate_hz = 1\r\x1b[0m"}
    )
    assert text.startswith("# made by a test\n\n")
    assert "# a guess\n# rate_hz = 1  [0m\nmax_speed_m_min = 60\n" in text
    assert read_back(text) == DELTA


def test_a_remark_for_a_key_that_is_not_written_is_a_mistake() -> None:
    with pytest.raises(ValueError, match=r"joints\.max_speed_deg_s"):
        to_toml(DELTA, remarks={"joints.max_speed_deg_s": "derived"})
