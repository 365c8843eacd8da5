"""The table of producers: units become SI, what is missing stays missing, what is wrong is refused."""

from pathlib import Path

import pytest

from deltacam.errors import RobotError
from deltacam.robot.producers import GRADES, UNITS, read_producers

HEAD = '[[robot]]\nmaker = "A"\nmodel = "B"\ngrade = "library"\nsource = "there"\n'


def one(tmp_path: Path, line: str) -> Path:
    path = tmp_path / "producers.toml"
    path.write_text(HEAD + line, encoding="utf-8")
    return path


def test_the_built_in_table_has_a_source_and_a_grade_for_every_robot() -> None:
    robots = read_producers()
    assert len(robots) >= 15
    assert all(robot.source and robot.grade in GRADES for robot in robots)
    assert all(robot.url for robot in robots if robot.grade == "producer")


def test_the_numbers_of_delta_x_are_those_of_its_pages_in_si() -> None:
    robots = {robot.model: robot for robot in read_producers()}
    two, six = robots["Delta X 2"], robots["Delta X S D600"]
    assert (two.payload, two.speed, two.acceleration) == pytest.approx((0.7, 0.8, 20.0))
    assert (six.payload, six.speed, six.acceleration) == pytest.approx((2.0, 3.0, 50.0))
    assert (two.workspace_diameter, two.repeatability) == pytest.approx((0.32, 0.15e-3))


@pytest.mark.parametrize(
    ("line", "name", "si"),
    [
        ("workspace_diameter_mm = 1130", "workspace_diameter", 1.13),
        ("workspace_diameter_m = 1.13", "workspace_diameter", 1.13),
        ("payload_g = 700", "payload", 0.7),
        ("repeatability_um = 40", "repeatability", 40e-6),
        ("speed_m_min = 60", "speed", 1.0),
        ("speed_mm_s = 800", "speed", 0.8),
        ("acceleration_g = 10", "acceleration", 98.0665),
        ("cycle_per_min = 120", "cycle", 0.5),
        ("cycle_s = 0.5", "cycle", 0.5),
    ],
)
def test_a_unit_becomes_si(tmp_path: Path, line: str, name: str, si: float) -> None:
    (robot,) = read_producers(one(tmp_path, line))
    assert getattr(robot, name) == pytest.approx(si, rel=1e-12)
    missing = [quantity for quantity in UNITS if quantity != name]
    assert all(getattr(robot, quantity) is None for quantity in missing)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("payload_kg = 0", "payload_kg = 0 is outside"),
        ("payload_kg = nan", "payload_kg = nan is outside"),
        ("payload = 1", "unknown key 'payload'"),
        ("payload_kg = 1\npayload_g = 1000", "payload_kg and payload_g are both given"),
        (HEAD, "A B is there twice"),
    ],
)
def test_what_is_wrong_is_refused(tmp_path: Path, line: str, message: str) -> None:
    with pytest.raises(RobotError, match=message):
        read_producers(one(tmp_path, line))


@pytest.mark.parametrize("grade", ["", "hearsay"])
def test_another_grade_is_refused(tmp_path: Path, grade: str) -> None:
    path = tmp_path / "producers.toml"
    path.write_text(HEAD.replace("library", grade), encoding="utf-8")
    with pytest.raises(RobotError, match=r"grade = .* is not"):
        read_producers(path)
