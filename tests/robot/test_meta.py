"""The robot in a program file: it survives the way through JSON, and nothing hostile does."""

import copy
import json
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.errors import RobotError
from deltacam.robot.meta import from_meta, to_meta
from deltacam.robot.reader import load_robot, profile_names

ROBOTS = [load_robot(name) for name in profile_names()]
META = to_meta(ROBOTS[0])


def leaves(value: object, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The way to every value of a JSON object, and to the objects and lists that hold it."""
    keys = value.keys() if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ()
    return [path, *(leaf for key in keys for leaf in leaves(value[key], (*path, key)))]


def changed(path: tuple[Any, ...], value: object) -> Any:
    if not path:
        return value
    meta = copy.deepcopy(META)
    holder = meta
    for key in path[:-1]:
        holder = holder[key]
    holder[path[-1]] = value
    return meta


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.name)
def test_a_robot_survives_the_way_through_json(robot: Any) -> None:
    meta = to_meta(robot)
    text = json.dumps(meta, sort_keys=True)
    assert json.loads(text) == meta
    again = from_meta(json.loads(text))
    assert again == robot
    assert json.dumps(to_meta(again), sort_keys=True) == text


@given(st.floats(0.1, 0.16), st.floats(0.29, 0.31), st.floats(1e3, 1e6))
def test_every_float_survives_the_way_through_json(base: float, arm: float, jerk: float) -> None:
    geometry = replace(ROBOTS[0].geometry, base_radius=base, upper_arm=arm)
    robot = replace(ROBOTS[0], geometry=geometry, joints=replace(ROBOTS[0].joints, max_jerk=(jerk, jerk, jerk / 3)))
    assert from_meta(json.loads(json.dumps(to_meta(robot)))) == robot


def test_the_meta_has_the_keys_of_the_program_format() -> None:
    assert sorted(META) == ["controller", "fingerprint", "geometry", "joints", "name", "tool", "workspace"]
    assert sorted(META["geometry"]) == ["azimuths", "base_radius", "effector_radius", "forearm", "upper_arm"]
    assert sorted(META["joints"]) == ["max", "max_acceleration", "max_jerk", "max_speed", "min"]
    assert all(len(META["joints"][key]) == 3 for key in ("min", "max", "max_speed", "max_acceleration"))
    assert all(to_meta(robot)["joints"]["max_jerk"] is None for robot in ROBOTS if robot.joints.max_jerk is None)
    assert any(robot.joints.max_jerk is None for robot in ROBOTS)
    assert META["tool"] == {"max_speed": 1.0, "max_acceleration": 23.0}


@pytest.mark.parametrize(
    ("path", "value", "problem"),
    [
        ((), [], "expected an object, got list"),
        (("geometry",), None, "expected an object, got NoneType"),
        (("geometry", "weight"), 1.0, "unknown weight"),
        (("geometry", "upper_arm"), "0.3", "upper_arm is not a number but str"),
        (("geometry", "upper_arm"), True, "upper_arm is not a number but bool"),
        (("geometry", "upper_arm"), None, "upper_arm is not a number but NoneType"),
        (("geometry", "upper_arm"), float("nan"), "upper_arm = nan m is outside"),
        (("geometry", "upper_arm"), float("inf"), "upper_arm = inf m is outside"),
        (("geometry", "upper_arm"), 10**400, "upper_arm is too large"),
        (("geometry", "upper_arm"), -0.3, "upper_arm = -0.3 m is outside 0.001 to 10"),
        (("geometry", "azimuths"), [0.0, 2.0], "azimuths is not a list of 3 numbers"),
        (("geometry", "azimuths"), "abc", "azimuths is not a list of 3 numbers"),
        (("geometry", "azimuths"), [0.0, 0.0, 2.0], "at least 10 degrees apart"),
        (("joints", "max_speed"), 2.5, "max_speed is not a list of 3 numbers"),
        (("joints", "max_speed", 1), 0.0, "max_speed = 0 rad/s is outside"),
        (("joints", "min", 0), 2.0, "joint 1: min .* is not below max"),
        (("joints", "max_jerk"), [1.0, 2.0], "max_jerk is not a list"),
        (("tool", "max_speed"), 100.0, "max_speed = 100 m/s is outside"),
        (("workspace", "radius"), 0.1, "either width and depth, or a radius"),
        (("workspace", "park"), [0.2, 0.0], "park is 50.000 mm outside the sheet"),
        (("controller", "interpolation"), "none", "not linear or cubic"),
        (("controller", "rate_hz"), [400], "rate_hz is not a number but list"),
        (("name",), 3, "name is not text but int"),
        (("name",), "a\nb", "name must be one line"),
        (("fingerprint",), "0" * 64, "fingerprint is not that of the robot's values"),
        (("geometry", "upper_arm"), 0.300001, "fingerprint is not that of the robot's values"),
    ],
)
def test_a_hostile_value_is_refused(path: tuple[Any, ...], value: object, problem: str) -> None:
    with pytest.raises(RobotError, match=problem):
        from_meta(changed(path, value))


@pytest.mark.parametrize("path", [path for path in leaves(META) if path and not isinstance(path[-1], int)])
def test_a_missing_key_is_refused(path: tuple[Any, ...]) -> None:
    meta = copy.deepcopy(META)
    holder = meta
    for key in path[:-1]:
        holder = holder[key]
    del holder[path[-1]]
    with pytest.raises(RobotError, match=f"missing {path[-1]}"):
        from_meta(meta)


def test_a_robot_that_does_not_reach_its_sheet_is_refused() -> None:
    robot = replace(ROBOTS[0], workspace=replace(ROBOTS[0].workspace, sheet_z=-1.1))
    with pytest.raises(RobotError, match="does not reach its whole sheet"):
        from_meta(to_meta(robot))


anything = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)


@given(st.sampled_from(leaves(META)), anything)
def test_no_value_makes_another_robot_or_another_error(path: tuple[Any, ...], value: object) -> None:
    meta = changed(path, value)
    try:
        robot = from_meta(meta)
    except RobotError:
        return
    assert robot.fingerprint == META["fingerprint"]
