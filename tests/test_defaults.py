"""The user's own deltacam.toml."""

import os
from pathlib import Path

import pytest

from deltacam.defaults import FILE, JOINING, Defaults, find, read
from deltacam.errors import DeltacamError
from deltacam.units import METRES_PER


def write(folder: Path, text: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / FILE
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_gives_what_it_says_in_si_and_none_for_the_rest(tmp_path: Path) -> None:
    path = write(tmp_path, 'robot = "irb360-1600"\nunits = "inch"\njoining_mm = 0.05\n')
    assert read(path) == Defaults(file=str(path), robot="irb360-1600", units="inch", joining=pytest.approx(5e-5))
    assert read(write(tmp_path, "# nothing\n")) == Defaults(file=str(path))


def test_the_first_folder_that_has_a_file_counts_alone(tmp_path: Path) -> None:
    here, home = tmp_path / "here", tmp_path / "home"
    here.mkdir()
    assert find([here, home]) == Defaults()
    write(home, 'units = "mm"\nrobot = "delta-300"\n')
    assert find([here, home]).file == str(home / FILE)
    write(here, 'units = "in"\n')
    assert find([here, home]) == Defaults(file=str(here / FILE), units="in")


@pytest.mark.parametrize("key", ["robot", "process"])
def test_a_file_is_looked_for_beside_the_settings_and_a_name_is_left_alone(tmp_path: Path, key: str) -> None:
    (tmp_path / "mine").mkdir()
    for name in ("mine/card.toml", "card.TOML", "mine/card"):
        (tmp_path / name).touch()
        assert getattr(read(write(tmp_path, f'{key} = "{name}"\n')), key) == str(tmp_path / name)
    assert getattr(read(write(tmp_path, f'{key} = "mine"\n')), key) == "mine"
    absolute = tmp_path / "mine" / "card.toml"
    assert getattr(read(write(tmp_path / "other", f"{key} = '{absolute}'\n")), key) == str(absolute)


def test_a_file_called_like_a_built_in_robot_stays_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "delta-300").touch()
    write(tmp_path, 'robot = "./delta-300"\nprocess = "delta-300"\n')
    assert find([Path()]).robot == f".{os.sep}delta-300"
    assert find([Path()]).process == "delta-300"


@pytest.mark.parametrize("unit", METRES_PER)
def test_every_unit_may_be_the_default(tmp_path: Path, unit: str) -> None:
    assert read(write(tmp_path, f'units = "{unit}"\n')).units == unit


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("kerf_mm = 0.2", "unknown key 'kerf_mm'"),
        ("unit = 'mm'", "unknown key 'unit'; did you mean 'units'"),
        ("[process]\nname = 'x'", "process = .* is not text"),
        ("robot = 300", "robot = 300 is not text"),
        ("robot = ' '", "robot is empty"),
        ("process = 'mine.toml'", "process = 'mine.toml': there is no such file"),
        ("robot = '../mine'", "robot = '../mine': there is no such file"),
        (f"robot = '{'x' * 300}.toml'", "robot = .*: the file cannot be looked at: file name too long"),
        ("units = 'ell'", "units: unknown unit of length 'ell'"),
        ("units = 4", "units = 4 is not text"),
        ("joining_mm = 6", "joining_mm = 6 is outside 0.001 to 5"),
        ("joining_mm = 0", "joining_mm = 0 is outside"),
        ("joining_mm = nan", "joining_mm = nan is outside"),
        ("joining_mm = '0.1'", "joining_mm = '0.1' is not a number"),
        ("units mm", "not TOML"),
    ],
)
def test_what_is_wrong_is_refused_with_the_file_and_the_key(tmp_path: Path, text: str, what: str) -> None:
    path = write(tmp_path, text)
    with pytest.raises(DeltacamError, match=what) as caught:
        find([tmp_path / "none", tmp_path])
    assert caught.value.where == str(path)


def test_a_wrong_file_is_not_passed_over_for_the_next_one(tmp_path: Path) -> None:
    here, home = tmp_path / "here", tmp_path / "home"
    write(home, 'units = "mm"\n')
    (here / FILE).mkdir(parents=True)
    with pytest.raises(DeltacamError, match="cannot be read"):
        find([here, home])
    (here / FILE).rmdir()
    (here / FILE).symlink_to(tmp_path / "nowhere")
    with pytest.raises(DeltacamError, match="cannot be read"):
        find([here, home])


def test_the_bounds_of_joining_may_be_used(tmp_path: Path) -> None:
    for bound in JOINING:
        assert read(write(tmp_path, f"joining_mm = {bound * 1e3!r}\n")).joining == pytest.approx(bound)
