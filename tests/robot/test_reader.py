"""Robot files: the built-in ones load, and every mistake is named with its place."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from deltacam.errors import RobotError
from deltacam.robot.dimensions import Mount
from deltacam.robot.meta import from_meta, to_meta
from deltacam.robot.reader import load_robot, profile_names

ROOT = Path(__file__).parents[2]
DELTA_300 = (ROOT / "deltacam/robot/profiles/delta-300.toml").read_text(encoding="utf-8")

Write = Callable[..., Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes the file of delta-300 with pieces of its text replaced."""

    def write_file(*changes: tuple[str, str]) -> Path:
        text = DELTA_300
        for old, new in changes:
            assert text.count(old) == 1, old
            text = text.replace(old, new)
        path = tmp_path / "mine.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write_file


def test_every_built_in_robot_loads_under_its_file_name() -> None:
    assert profile_names() == (
        "delta-300",
        "delta-x-s-d600",
        "dr3ib-8l",
        "irb360-1130",
        "irb360-1600",
        "rl5-1450",
        "tutorial-112",
    )
    assert [load_robot(name).name for name in profile_names()] == list(profile_names())
    assert all(load_robot(name).source for name in profile_names())


def test_the_values_of_the_file_are_converted_to_si(write: Write) -> None:
    robot = load_robot(write())
    assert (robot.geometry.base_radius, robot.geometry.effector_radius) == (0.13, 0.035)
    assert (robot.geometry.upper_arm, robot.geometry.forearm) == (0.3, 0.7)
    assert np.degrees(robot.geometry.azimuths) == pytest.approx((-90.0, 30.0, 150.0), rel=1e-15)
    assert (robot.tool.max_speed, robot.tool.max_acceleration) == (1.0, 23.0)
    assert (robot.workspace.sheet_z, robot.workspace.width, robot.workspace.depth) == (-0.65, 0.3, 0.3)
    assert np.degrees(robot.workspace.max_pressure_angle) == pytest.approx(60.0)
    assert robot.workspace.max_forearm_swing is None
    assert (robot.controller.rate_hz, robot.controller.interpolation) == (400.0, "linear")
    assert robot == load_robot("delta-300")


def test_the_sample_is_delta_300_under_another_name() -> None:
    sample = load_robot(ROOT / "samples" / "robot.toml")
    assert sample.name == "my-robot"
    assert replace(sample, name="delta-300") == load_robot("delta-300")


def test_the_keys_that_the_sample_shows_as_comments_are_right(tmp_path: Path) -> None:
    text = (ROOT / "samples" / "robot.toml").read_text(encoding="utf-8")
    keys = re.findall(r"^# \w+ = .*", text, re.MULTILINE)
    assert len(keys) == 10
    for line in keys:
        text = text.replace(line, line[2:])
    path = tmp_path / "all.toml"
    path.write_text(text, encoding="utf-8")
    robot = load_robot(path)
    assert robot.geometry == load_robot("delta-300").geometry
    assert robot.joints.derived == ()
    assert robot.joints.max_speed == pytest.approx(load_robot("delta-300").joints.max_speed, rel=1e-3)
    assert np.degrees(robot.joints.max_jerk) == pytest.approx([3.66e5] * 3)
    assert np.degrees(robot.workspace.max_forearm_swing) == pytest.approx(30.0)


def test_limits_that_the_file_gives_hold(write: Write) -> None:
    robot = load_robot(write(("max_deg = 95", "max_deg = [95, 94, 93]\nmax_speed_deg_s = [100, 110, 120]")))
    assert np.degrees(robot.joints.max) == pytest.approx([95, 94, 93])
    assert np.degrees(robot.joints.max_speed) == pytest.approx([100, 110, 120])
    assert robot.joints.max_acceleration == load_robot("delta-300").joints.max_acceleration
    assert robot.joints.derived == ("max_acceleration",)


def test_sides_of_triangles_stand_for_radii(write: Write) -> None:
    side = 130 * 2 * np.sqrt(3)
    robot = load_robot(write(("base_radius_mm = 130", f"base_side_mm = {side}")))
    assert robot.geometry.base_radius == pytest.approx(0.13, rel=1e-15)
    with pytest.raises(RobotError, match="base_radius_mm and base_side_mm are both given"):
        load_robot(write(("base_radius_mm = 130", "base_radius_mm = 130\nbase_side_mm = 450")))


def test_arms_of_their_own_and_a_base_of_its_own_are_read(write: Write) -> None:
    lengths = {
        "base_radius_mm = 130": "base_radius_mm = [130, 131, 129]",
        "effector_radius_mm = 35": "effector_radius_mm = [35, 35, 36]",
        "upper_arm_mm = 300": "upper_arm_mm = [300, 300.5, 299.5]",
        "forearm_mm = 700": "forearm_mm = [700, 700, 701]\nazimuths_deg = [-90.5, 30, 150]",
    }
    mount = "[mount]\nx_mm = 2\ny_mm = -3\nz_mm = 250\nrotation_deg = 60\nupside_down = true\n\n[joints]"
    robot = load_robot(write(*lengths.items(), ("sheet_z_mm = -650", "sheet_z_mm = 900"), ("[joints]", mount)))
    assert robot.geometry.base_radii == pytest.approx([0.130, 0.131, 0.129])
    assert robot.geometry.effector_radii == pytest.approx([0.035, 0.035, 0.036])
    assert robot.geometry.upper_arms == pytest.approx([0.3, 0.3005, 0.2995])
    assert robot.geometry.forearms == pytest.approx([0.7, 0.7, 0.701])
    assert np.degrees(robot.geometry.azimuths) == pytest.approx((-90.5, 30.0, 150.0))
    assert robot.geometry.mount == Mount(x=0.002, y=-0.003, z=0.25, rotation=np.radians(60.0), upside_down=True)
    assert from_meta(json.loads(json.dumps(to_meta(robot)))) == robot


def test_a_disc_and_a_cubic_controller_are_read(write: Write) -> None:
    sheet = ("width_mm = 300\ndepth_mm = 300", "radius_mm = 180")
    robot = load_robot(write(sheet, ('interpolation = "linear"', 'interpolation = "cubic"')))
    assert (robot.workspace.radius, robot.workspace.width) == (0.18, None)
    assert robot.controller.interpolation == "cubic"
    with pytest.raises(RobotError, match="radius_mm is given beside width_mm or depth_mm"):
        load_robot(write(("width_mm = 300", "radius_mm = 180")))


def test_a_name_wins_over_a_folder_of_that_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "delta-300").mkdir()
    monkeypatch.chdir(tmp_path)
    assert load_robot("delta-300").name == "delta-300"


def test_a_file_of_any_ending_is_read(write: Write, tmp_path: Path) -> None:
    path = write().rename(tmp_path / "robot.txt")
    assert load_robot(str(path)).name == "delta-300"


def test_an_unknown_name_lists_the_robots_and_names_the_nearest() -> None:
    with pytest.raises(RobotError, match="unknown robot 'delta300'") as caught:
        load_robot("delta300")
    assert caught.value.hint == (
        f"did you mean 'delta-300'? built-in: {', '.join(profile_names())}; or give a .toml file"
    )


def test_a_missing_file_is_named() -> None:
    with pytest.raises(RobotError, match="the file cannot be read: no such file"):
        load_robot("nowhere/delta-300.toml")


@pytest.mark.parametrize(
    ("old", "new", "section", "problem"),
    [
        ("upper_arm_mm = 300", "uper_arm_mm = 300", "geometry", "upper_arm_mm is missing"),
        ("upper_arm_mm = 300", "upper_arm_mm = 300\nweight_kg = 3", "geometry", "unknown key 'weight_kg'"),
        ("upper_arm_mm = 300", "upper_arm_mm = nan", "geometry", "upper_arm_mm = nan is outside 1 to 10000"),
        ("upper_arm_mm = 300", "upper_arm_mm = 0.3", "geometry", "upper_arm_mm = 0.3 is outside 1 to 10000"),
        ("upper_arm_mm = 300", 'upper_arm_mm = "300"', "geometry", "upper_arm_mm = '300' is not a number"),
        ("forearm_mm = 700", "forearm_mm = 700\nazimuths_deg = [0, 5, 180]", "geometry", "10 degrees apart"),
        ("forearm_mm = 700", "forearm_mm = 700\nazimuths_deg = 0", "geometry", "must be a list of 3 numbers"),
        ("max_deg = 95", "max_deg = 95\nmax_sped_deg_s = 99", "joints", "did you mean 'max_speed_deg_s'?"),
        ("max_deg = 95", "max_deg = -45", "joints", "joint 1: min -45 deg is not below max -45 deg"),
        ("max_deg = 95", "max_deg = [95, 95]", "joints", "must be a list of 3 numbers"),
        ("max_jerk_deg_s3 = 366_000", "max_jerk_deg_s3 = 0", "joints", "max_jerk_deg_s3 = 0 is outside"),
        ("max_speed_m_min = 60", "max_speed_m_min = 1001", "tool", "max_speed_m_min = 1001 is outside"),
        ("\n[tool]", "\n[tools]", "", "the section [tool] is missing"),
        ("sheet_z_mm = -650", "sheet_z_mm = 650", "workspace", "sheet_z_mm = 650 is not below the base, which"),
        ("sheet_z_mm = -650", "sheet_z_mm = -1100", "workspace", "does not reach its whole sheet"),
        ("park_mm = [0, 0]", "park_mm = [0, 151]", "workspace", "park is 1.000 mm outside the sheet"),
        ("min_deg = -45", "min_deg = 0", "workspace", "min_deg 0 deg is exceeded by 4.143 deg with the tool at"),
        ("rate_hz = 400", "rate_hz = inf", "controller", "rate_hz = inf is outside"),
        ('interpolation = "linear"', 'interpolation = "line"', "controller", "is not \"linear\" or \"cubic\""),
        ('name = "delta-300"', 'name = ""', "", "name is empty"),
        ('name = "delta-300"', 'name = "a\\nb"', "", "name must be one line"),
    ],
)  # fmt: skip
def test_a_mistake_is_named_with_its_file_and_section(
    write: Write, old: str, new: str, section: str, problem: str
) -> None:
    with pytest.raises(RobotError) as caught:
        load_robot(write((old, new)))
    assert problem in caught.value.what
    assert caught.value.where == (f"mine.toml [{section}]" if section else "mine.toml")


def test_a_huge_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "huge.toml"
    path.write_bytes(b"#" * 2_000_000)
    with pytest.raises(RobotError, match="larger than 1,000,000 bytes"):
        load_robot(path)
