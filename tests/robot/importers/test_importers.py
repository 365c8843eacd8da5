"""The robots of other programs move as those programs say, and nothing of their files is lost or made up."""

import csv
import math
import re
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.errors import DeltacamError, RobotError
from deltacam.model import Array
from deltacam.robot import kinematics
from deltacam.robot.importers.complete import Imported, Sheet, Wishes
from deltacam.robot.importers.description import Choices, Description
from deltacam.robot.importers.formats import FORMATS, describe, import_robot
from deltacam.robot.importers.ledger import MAX_BYTES, Source, read_source, to_source
from deltacam.robot.importers.wishes import to_millimetres, to_range, to_sheet
from deltacam.robot.reader import load_robot

DATA = Path(__file__).parents[2] / "data"
ROBOTS = DATA / "robots"
FILES = {
    "linuxcnc": ("machine.ini", "machine.hal"),
    "klipper": ("printer.cfg",),
    "reprapfirmware": ("config.g",),
    "classic": ("classic.txt",),
}
CHOICES = {"classic": Choices(joints_at=("middles", "middles"))}
TEXTS = {file: (ROBOTS / file).read_text() for files in FILES.values() for file in files}


def described(format_name: str, *changes: tuple[str, str], choices: Choices | None = None) -> Description:
    """What the files of a format say, with pieces of their text replaced."""
    texts = {file: TEXTS[file] for file in FILES[format_name]}
    for old, new in changes:
        assert sum(text.count(old) for text in texts.values()) == 1, old
        texts = {file: text.replace(old, new) for file, text in texts.items()}
    sources = [Source(file, text) for file, text in texts.items()]
    return describe(sources, None, choices or CHOICES.get(format_name, Choices()))


def imported(format_name: str, wishes: Wishes) -> Imported:
    paths = [ROBOTS / file for file in FILES[format_name]]
    return import_robot(paths, choices=CHOICES.get(format_name), wishes=wishes)


def angles_upwards(point: Array, *, radius: float, height: float, upper: float, lower: float, azimuth: float) -> float:
    """The angle of an arm, deg, positive upwards: two circles in the arm's plane, by the law of cosines.

    This is the machine that Klipper and RepRapFirmware describe: z from the bed, shoulders at ``height``.
    """
    along = point[0] * math.cos(azimuth) + point[1] * math.sin(azimuth) - radius
    across = point[1] * math.cos(azimuth) - point[0] * math.sin(azimuth)
    drop = point[2] - height
    distance = math.hypot(along, drop)
    bar_square = lower**2 - across**2
    at_shoulder = math.acos((distance**2 + upper**2 - bar_square) / (2.0 * distance * upper))
    angle = math.atan2(drop, along) + at_shoulder
    return math.degrees(math.remainder(angle, 2.0 * math.pi))


def points_mm() -> Array:
    return np.random.default_rng(5).uniform((-60.0, -60.0, 0.0), (60.0, 60.0, 100.0), (200, 3))


def agree(found: Description, arms: Callable[[int], dict[str, float]]) -> None:
    ours = np.degrees(kinematics.inverse(found.geometry, points_mm() / 1e3))
    theirs = [[angles_upwards(point, **arms(arm)) for arm in range(3)] for point in points_mm()]
    np.testing.assert_allclose(ours, -np.array(theirs), rtol=0.0, atol=1e-9)


def test_a_robot_of_klipper_moves_as_klipper_says() -> None:
    upper, lower, azimuths = (170.0, 170.2, 170.0), (320.0, 320.0, 319.8), np.radians((30.125, 150.0, 270.0))
    agree(
        described("klipper"),
        lambda arm: {
            "radius": 33.9,
            "height": 412.5,
            "upper": upper[arm],
            "lower": lower[arm],
            "azimuth": float(azimuths[arm]),
        },
    )


def test_a_robot_of_reprapfirmware_moves_as_the_firmware_says() -> None:
    lower, azimuths = (350.0, 350.0, 350.5), np.radians((-149.75, -30.0, 90.0))
    agree(
        described("reprapfirmware"),
        lambda arm: {
            "radius": 60.0,
            "height": 420.0,
            "upper": 180.0,
            "lower": lower[arm],
            "azimuth": float(azimuths[arm]),
        },
    )


@pytest.mark.parametrize(
    ("angles", "point"),
    [
        ((30.0, 30.0, 30.0), (0.0, 0.0, -10.9764510955)),
        ((10.0, 40.0, -15.0), (-2.33765491238, -0.379042874815, -4.75649418803)),
    ],
)
@pytest.mark.parametrize(("unit", "metres"), [("mm", 1e-3), ("inch", 25.4e-3)])
def test_the_defaults_of_linuxcnc_give_its_published_points(
    angles: tuple[float, ...], point: tuple[float, ...], unit: str, metres: float
) -> None:
    source = Source("a.ini", f"[KINS]\nKINEMATICS = rotarydeltakins\n[TRAJ]\nLINEAR_UNITS = {unit}\n")
    found = describe([source], None, Choices())
    forward = kinematics.forward(found.geometry, np.radians([angles]))[0]
    np.testing.assert_allclose(forward / metres, point, rtol=1e-11, atol=1e-10)
    assert [fact.value for fact in found.facts if "default" in fact.source] == ["10", "6", "10", "14"]


def test_a_robot_of_linuxcnc_moves_as_linuxcnc_says() -> None:
    lines = (DATA / "linuxcnc_rotarydelta.csv").read_text().splitlines()
    pins = re.findall(r"(\w+)=([\d.]+)", lines[1])
    hal = Source("a.hal", "loadrt rotarydeltakins\n" + "".join(f"setp rotarydeltakins.{k} {v}\n" for k, v in pins))
    found = describe([hal], None, Choices(millimetres_per_unit=1.0))
    rows = np.array(list(csv.reader(lines[5:])), dtype=float)
    forward = kinematics.forward(found.geometry, np.radians(rows[:, :3]))
    np.testing.assert_allclose(forward * 1e3, rows[:, 3:], rtol=0.0, atol=1e-8)


def test_the_classic_numbers_of_a_published_robot_give_its_published_points() -> None:
    # Williams 2015: the base's joints at the middles of 567 mm, the platform's at the vertices of 76 mm.
    source = Source("williams.txt", "f = 567\ne = 76\nrf = 524\nre = 1244\njoints_at = middles,vertices\n")
    found = describe([source], None, Choices(millimetres_per_unit=1.0))
    forward = kinematics.forward(found.geometry, np.radians([(0.0, 0.0, 0.0), (10.0, 20.0, 30.0)]))
    published = [(0.0, 0.0, -1064.4517), (108.1354, -180.3484, -1243.5413)]
    np.testing.assert_allclose(forward * 1e3, published, rtol=0.0, atol=1e-4)


def test_json_and_lines_give_the_same_robot() -> None:
    lines = Source("a.txt", "f=450\ne: 120\nrf = 300 # upper\nre = '700'\nunits = \"mm\"\njoints_at = vertices")
    pairs = '{"f": 450, "e": 120.0, "rf": 300, "re": "700", "units": "mm", "joints_at": "vertices"}'
    one, two = (describe([source], None, Choices()) for source in (lines, Source("a.json", pairs)))
    assert one.geometry == two.geometry
    assert one.geometry.base_radius == pytest.approx(0.45 / math.sqrt(3.0))


@pytest.mark.parametrize("format_name", FILES)
def test_every_value_of_a_file_is_read_or_listed_as_not_used(format_name: str) -> None:
    found = described(format_name)
    told = " ".join([*(fact.source + " " + fact.value for fact in found.facts), *found.unused, *found.notes])
    for file in FILES[format_name]:
        for number, line in enumerate(TEXTS[file].splitlines(), start=1):
            heading = re.match(r"\s*\[[^\]]*\]\s*$", line)
            words = re.sub(r"(?<=\s)[;#].*|^[;#](?!\*# \w+ =).*", "", line).strip()
            if words and not heading and not line[0].isspace():
                assert f"{file}:{number}" in told, line


IMPORTS = {
    "linuxcnc": Wishes(sheet=Sheet(width=0.3, depth=0.3, z=-0.65)),
    "klipper": Wishes(sheet=Sheet(radius=0.06)),
    "reprapfirmware": Wishes(),
    "classic": Wishes(sheet=Sheet(width=0.3, depth=0.3, z=-0.65), speed=1.0, acceleration=23.0),
}


@pytest.mark.parametrize("format_name", FILES)
def test_the_robot_file_of_an_import_is_the_imported_robot(format_name: str) -> None:
    found = imported(format_name, IMPORTS[format_name])
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "robot.toml"
        path.write_text(found.toml, encoding="utf-8")
        again = load_robot(path)
    assert again == found.robot
    assert again.fingerprint == found.robot.fingerprint
    for key, _ in found.estimates:
        name = key.split(".")[1]
        assert re.search(rf"# an estimate, to be replaced[^=]*\n{name} = ", found.toml)


def test_the_limits_of_the_file_are_those_of_the_robot() -> None:
    robot = imported("linuxcnc", IMPORTS["linuxcnc"]).robot
    assert np.degrees(robot.joints.max_speed) == pytest.approx([150.0] * 3)
    assert np.degrees(robot.joints.max_acceleration) == pytest.approx([3700.0] * 3)
    assert np.degrees([robot.joints.min, robot.joints.max]) == pytest.approx(np.array([[-45.0] * 3, [95.0] * 3]))
    assert (robot.tool.max_speed, robot.tool.max_acceleration) == (1.0, 23.0)
    firmware = imported("reprapfirmware", Wishes()).robot
    assert np.degrees([firmware.joints.min[0], firmware.joints.max[0]]) == pytest.approx([-30.0, 80.0])
    assert (firmware.tool.max_speed, firmware.tool.max_acceleration) == pytest.approx((0.25, 3.0))  # the lower, Y
    assert (firmware.workspace.radius, firmware.workspace.sheet_z) == (0.1, 0.0)


def test_the_endstop_of_klipper_is_the_smallest_angle() -> None:
    found = described("klipper")
    assert found.joint_min is not None
    highest = kinematics.forward(found.geometry, [found.joint_min])[0]
    assert np.degrees(found.joint_min) == pytest.approx([-44.7254, -44.4968, -44.4871], abs=1e-3)
    np.testing.assert_allclose(highest, (0.0, 0.0, 0.252), atol=1e-12)
    assert found.joint_max is None


def test_a_range_that_no_file_gives_is_what_the_sheet_needs_and_an_estimate() -> None:
    found = imported("classic", IMPORTS["classic"])
    assert {key for key, _ in found.estimates} == {"joints.min_deg", "joints.max_deg"}
    needed = np.degrees(found.robot.inverse(found.robot.workspace.grid()))
    low, high = math.degrees(found.robot.joints.min[0]), math.degrees(found.robot.joints.max[0])
    assert 0.0 <= needed.min() - low <= 1.001
    assert 0.0 <= high - needed.max() <= 1.001
    given_range = imported("classic", Wishes(Wishes().name, Sheet(0.3, 0.3, z=-0.65), 1.0, 23.0, (-1.0, 1.5)))
    assert given_range.estimates == ()
    assert given_range.robot.joints.max == (1.5, 1.5, 1.5)


def test_what_nobody_says_is_asked_for_all_at_once() -> None:
    with pytest.raises(RobotError, match="does not say the sheet, the speed of the tool, the acceleration") as caught:
        imported("classic", Wishes())
    assert "--sheet 300x300@-650 --speed 60m/min --acceleration 23" in caught.value.hint
    with pytest.raises(RobotError, match="does not say the sheet") as caught:
        imported("klipper", Wishes())
    assert "--sheet 300x300," in caught.value.hint, "the height of the bed is known"


def test_an_option_that_replaces_a_value_of_the_file_is_told() -> None:
    found = imported("reprapfirmware", Wishes(speed=0.1, sheet=Sheet(radius=0.05)))
    assert found.robot.tool.max_speed == 0.1
    assert {"--speed holds instead of what the file says", "--sheet holds instead of what the file says"} <= set(
        found.notes
    )


def test_a_speed_of_zero_is_refused_and_not_passed_over() -> None:
    with pytest.raises(RobotError, match="max_speed = 0"):
        imported("reprapfirmware", Wishes(speed=0.0))


REFUSED = [
    ("klipper", ("kinematics: rotary_delta", "kinematics: delta"), "describes no rotary delta"),
    ("klipper", ("shoulder_radius: 33.900", ""), "shoulder_radius is missing"),
    ("klipper", ("shoulder_radius: 33.900", "shoulder_radius: 33,9"), "is not a number"),
    ("klipper", ("max_accel: 3000", "max_accel: 3000\nshoulder_radius: 34"), "given twice: 34 and 33.900"),
    ("klipper", ("position_endstop: 252", "position_endstop: 800"), "position_endstop is no place of this robot"),
    ("klipper", ("upper_arm_length: 170.000", "upper_arm_length: inf"), "is not a number"),
    ("reprapfirmware", ("M669 K10", "M669 K3"), "describes no rotary delta"),
    ("reprapfirmware", ("H420", "H420:420:421"), "bearings are at different heights"),
    ("reprapfirmware", ("H420", "H420:421"), "must have 3 values"),
    ("reprapfirmware", ("A-80:30", "A-80"), "must have 2 values"),
    ("reprapfirmware", ("U180", "U{var.arm}"), "is not a number"),
    ("reprapfirmware", ("B100", "B100 R61"), "given twice: 60 and 61"),
    ("reprapfirmware", ("M906", "G20\nM906"), "switches to inches"),
    ("reprapfirmware", ("M906", "M669 K0\nM906"), "given twice"),
    ("reprapfirmware", ("M906", "M906 P" + "{" * 1000), "is no command"),
    ("linuxcnc", ("LINEAR_UNITS = mm", ""), "do not say the unit"),
    ("linuxcnc", ("LINEAR_UNITS = mm", "LINEAR_UNITS = furlong"), "is no unit of length"),
    ("linuxcnc", ("ANGULAR_UNITS = degree", "ANGULAR_UNITS = radian"), "is no unit of angle"),
    ("linuxcnc", ("THIGH = 300", ""), "which no INI file says"),
    ("linuxcnc", ("shinlength 700", "shinlength 700 x"), "is not a number"),
    (
        "linuxcnc",
        ("addf motion", "net shin calc.out => rotarydeltakins.shinlength\naddf motion"),
        "driven by the signal",
    ),
    ("linuxcnc", ("footradius 35", "footradius 35\nsetp rotarydeltakins.footradius 36"), "given twice: 35 and 36"),
    ("linuxcnc", ("footradius 35", "footradius -35"), "effector_radius = -0.035"),
    ("classic", ("re = 700", "re ="), "is not a number"),
    ("classic", ("rf = 300", "rf = 300\nrf = 301"), "given twice"),
    ("classic", ("units = mm", "units = ell"), "is no unit of length"),
    ("classic", ("units = mm", ""), "does not say its unit"),
    ("classic", ("units = mm", "units = mm\njoints_at = corners"), "no place of joints"),
    ("classic", ("units = mm", "units = mm\njoints_at = vertices"), "is not what the file says"),
]


@pytest.mark.parametrize(("format_name", "change", "what"), REFUSED)
def test_what_cannot_be_read_for_certain_is_refused(format_name: str, change: tuple[str, str], what: str) -> None:
    with pytest.raises(RobotError, match=re.escape(what)):
        described(format_name, change)


def test_without_the_place_of_the_joints_the_classic_numbers_are_refused() -> None:
    with pytest.raises(RobotError, match="does not say where") as caught:
        described("classic", choices=Choices(millimetres_per_unit=1.0))
    assert "--joints-at middles or --joints-at vertices" in caught.value.hint


@pytest.mark.parametrize("format_name", ["klipper", "reprapfirmware"])
def test_a_choice_that_a_format_fixes_is_refused(format_name: str) -> None:
    with pytest.raises(RobotError, match="--units has no meaning"):
        described(format_name, choices=Choices(millimetres_per_unit=1.0))


def test_a_unit_that_is_not_that_of_the_file_is_refused() -> None:
    for format_name in ("linuxcnc", "classic"):
        choices = Choices(
            millimetres_per_unit=25.4, joints_at=("middles", "middles") if format_name == "classic" else None
        )
        with pytest.raises(RobotError, match="--units is not that of the file"):
            described(format_name, choices=choices)


def test_what_a_file_refers_to_is_not_read_and_said() -> None:
    assert any("fans.cfg, which was not read" in note for note in described("klipper").notes)
    assert any('"network.g", which was not read' in note for note in described("reprapfirmware").notes)
    notes = described(
        "linuxcnc", ("[EMC]", "#INCLUDE other.inc\n[EMC]"), ("loadrt motmod", "source x.hal\nloadrt motmod")
    )
    assert all(any(name in note for note in notes.notes) for name in ("panel.hal", "other.inc", "x.hal"))
    assert not any("machine.hal, which" in note for note in notes.notes)


def test_dimensions_that_an_unread_file_may_set_are_not_taken_from_the_defaults() -> None:
    with pytest.raises(
        RobotError, match=r"sets rotarydeltakins.platformradius, but machine.ini names machine.hal"
    ) as caught:
        describe([Source("machine.ini", TEXTS["machine.ini"])], None, Choices())
    assert "name the HAL files" in caught.value.hint


def test_the_block_that_klipper_saves_holds_over_the_rest_of_its_file() -> None:
    assert described("klipper").geometry.mount.z == 0.4125
    assert described("klipper", ("#*# shoulder_height = 412.5", "#*#")).geometry.mount.z == 0.4129


def test_files_that_are_no_text_or_too_large_are_refused(tmp_path: Path) -> None:
    for content, what in ((b"\xff", "not UTF-8"), (b"a\0", "null"), (b"#" * (MAX_BYTES + 1), "larger")):
        path = tmp_path / "a.cfg"
        path.write_bytes(content)
        with pytest.raises(RobotError, match=what):
            read_source(path)
    with pytest.raises(RobotError, match="cannot be read"):
        read_source(tmp_path / "none.cfg")


def attempt(format_name: str, content: bytes) -> None:
    try:
        describe([to_source("a", content)], format_name, CHOICES.get(format_name, Choices()))
    except RobotError as problem:
        assert problem.what  # noqa: PT017 - any refusal will do; anything else is a crash


@given(st.sampled_from(sorted(FORMATS)), st.binary(max_size=300))
def test_random_bytes_are_read_or_refused(format_name: str, content: bytes) -> None:
    attempt(format_name, content)


WORDS = st.sampled_from(
    [
        *'[]{}()"\\=:;#\n\r\t -+',
        "M669",
        "K10",
        "setp",
        "net",
        "1e999",
        "nan",
        "\u2028",
        "\u0661",
        "[TRAJ]",
        "#*# ",
        "{",
        "[[",
    ]
)


@settings(max_examples=200)
@given(
    st.sampled_from(sorted(TEXTS)), st.lists(st.tuples(st.floats(0, 1), st.integers(0, 9), st.lists(WORDS)), max_size=4)
)
def test_damaged_files_are_read_or_refused(file: str, damage: list[tuple[float, int, list[str]]]) -> None:
    text = TEXTS[file]
    for place, removed, words in damage:
        at = int(place * len(text))
        text = text[:at] + "".join(words) + text[at + removed :]
    attempt(next(name for name, files in FILES.items() if file in files), text.encode())


@pytest.mark.parametrize(
    "piece", ["\n", " a\n", "(", "X{", "[", "[a]\n", "HALFILE = a ", "source a", "{", '{"a":', "M669 K1 "]
)
@pytest.mark.parametrize("format_name", FORMATS)
def test_a_large_file_of_one_piece_is_answered(piece: str, format_name: str) -> None:
    attempt(format_name, (piece * (200_000 // len(piece))).encode())  # what is quadratic takes minutes


@pytest.mark.parametrize(
    ("text", "sheet"),
    [
        ("300x200", Sheet(0.3, 0.2)),
        ("300 x 200@-650", Sheet(0.3, 0.2, z=-0.65)),
        ("r150@-26in", Sheet(radius=0.15, z=-0.6604)),
        ("12in X 0.3m", Sheet(0.3048, 0.3)),
    ],
)
def test_a_sheet_is_a_size_and_a_height(text: str, sheet: Sheet) -> None:
    found = to_sheet(text)
    for name in ("width", "depth", "radius", "z"):
        assert getattr(found, name) == pytest.approx(getattr(sheet, name))


@pytest.mark.parametrize(
    "text", ["", "300", "300x", "x", "r", "300x300@", "300x300x300", "300x300@-650@1", "nanx1", "150r"]
)
def test_what_is_no_sheet_is_refused(text: str) -> None:
    with pytest.raises(DeltacamError, match=r"is not a|unknown unit"):
        to_sheet(text)


def test_a_range_and_a_unit_are_read() -> None:
    assert np.degrees(to_range("-45..95")) == pytest.approx([-45.0, 95.0])
    assert to_millimetres("in") == 25.4
    with pytest.raises(RobotError, match="range"):
        to_range("-45-95")
