"""Reading a process."""

from dataclasses import replace
from pathlib import Path

import pytest

from deltacam.cutting.process import check_process, load_process, process_names
from deltacam.errors import ProcessError

GOOD = 'name = "card"\nkerf_mm = 0.2\nfeed_m_min = 6\n'


def write(folder: Path, text: str) -> Path:
    path = folder / "card.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", process_names())
def test_a_built_in_process_is_whole_and_names_its_source(name: str) -> None:
    process = check_process(load_process(name))
    assert process.name == name
    assert process.source
    assert process.material
    assert 0.0 < process.kerf < 1e-3


def test_values_become_si(tmp_path: Path) -> None:
    process = load_process(write(tmp_path, GOOD + "tolerance_um = 15\nthickness_mm = 2\ncorner = 'stop'\n"))
    assert (process.kerf, process.feed) == pytest.approx((2e-4, 0.1))
    assert (process.tolerance, process.thickness) == pytest.approx((15e-6, 2e-3))
    assert process.corner == "stop"
    assert (process.power, process.pierce_time) == (1.0, 0.0)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (GOOD + "pierce_times = 1\n", "pierce_time_s"),
        (GOOD.replace("0.2", "-0.2"), "kerf_mm"),
        (GOOD.replace("0.2", '"wide"'), "kerf_mm"),
        (GOOD.replace("0.2", "nan"), "kerf_mm"),
        (GOOD + "power = 1.5\n", "power"),
        (GOOD + "corner = 'sharp'\n", "round"),
        ('name = "card"\nkerf_mm = 0.2\n', "feed_m_min"),
        ("name = ", "card.toml"),
    ],
)
def test_what_is_wrong_in_a_file_is_named(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(ProcessError) as caught:
        load_process(write(tmp_path, text))
    assert says in f"{caught.value.what} {caught.value.where} {caught.value.hint}"


def test_an_unknown_name_is_answered_with_the_nearest() -> None:
    with pytest.raises(ProcessError, match="acrylic-3mm-co2"):
        load_process("acrylic-3mm")


@pytest.mark.parametrize(("key", "value"), [("kerf", -1e-4), ("kerf", 1.0), ("feed", 0.0), ("tolerance", 1e-7)])
def test_a_single_value_out_of_range_is_refused(key: str, value: float) -> None:
    with pytest.raises(ProcessError, match=key):
        check_process(replace(load_process("steel-1mm-fibre"), **{key: value}))
