"""Settings files are read strictly: nothing is skipped, clipped or guessed."""

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.errors import ProcessError, RobotError
from deltacam.settings import MAX_BYTES, Table, read_table

Write = Callable[[str | bytes], Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def write_file(content: str | bytes) -> Path:
        path = tmp_path / "some.toml"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write_file


def table(**values: object) -> Table:
    return Table(values, file="some.toml", section="joints", error=RobotError)


def test_every_kind_of_value_is_read(write: Write) -> None:
    top = read_table(
        write('word = "a"\ncount = 3\n[part]\nlength_mm = 2\nlist = [1, 2.5]\nsame = 7\nkind = "b"\n'), error=RobotError
    )
    part = top.table("part")
    assert top.text("word") == "a"
    assert top.integer("count", minimum=0, maximum=9) == 3
    assert part.number("length_mm", minimum=0, maximum=9) == 2.0
    assert isinstance(part.number("length_mm", minimum=0, maximum=9), float)
    assert part.numbers("list", length=2, minimum=0, maximum=9) == (1.0, 2.5)
    assert part.numbers("same", length=3, minimum=0, maximum=9, repeat=True) == (7.0, 7.0, 7.0)
    assert part.choice("kind", ("a", "b")) == "b"
    top.finish()


def test_defaults_stand_in_for_missing_keys_only() -> None:
    empty = table()
    assert empty.number("a", minimum=0, maximum=1, default=0.5) == 0.5
    assert empty.numbers("b", length=2, minimum=0, maximum=1, default=(0.0, 1.0)) == (0.0, 1.0)
    assert empty.integer("c", minimum=0, maximum=1, default=1) == 1
    assert empty.text("d", default="") == ""
    assert empty.choice("e", ("x", "y"), default="y") == "y"
    assert not empty.has("f")
    assert not empty.table("g", required=False).has("h")
    with pytest.raises(RobotError, match="a = 7 is outside 0 to 1"):
        table(a=7).number("a", minimum=0, maximum=1, default=0.5)


@pytest.mark.parametrize(
    ("value", "problem"),
    [
        (True, "speed = true is not a number"),
        ("12", "speed = '12' is not a number"),
        ([1.0], r"speed = \[1.0\] is not a number"),
        (float("nan"), "speed = nan is outside 1 to 100"),
        (float("inf"), "speed = inf is outside 1 to 100"),
        (0.999, "speed = 0.999 is outside 1 to 100"),
        pytest.param(10**400, r"speed = 10+\.\.\. is outside 1 to 100", id="10**400"),
        pytest.param(16**5000, "speed = a huge number is outside 1 to 100", id="16**5000"),
    ],
)
def test_a_value_that_is_no_number_in_bounds_is_refused(value: object, problem: str) -> None:
    with pytest.raises(RobotError, match=problem) as caught:
        table(speed=value).number("speed", minimum=1, maximum=100)
    assert caught.value.where == "some.toml [joints]"


@given(st.floats(-10, 10), st.floats(-10, 10), st.floats(allow_nan=True, allow_infinity=True))
def test_a_number_is_taken_if_and_only_if_it_is_within_its_bounds(one: float, two: float, value: float) -> None:
    low, high = sorted((one, two))
    try:
        assert table(x=value).number("x", minimum=low, maximum=high) == value
        assert low <= value <= high
    except RobotError:
        assert not low <= value <= high


@pytest.mark.parametrize("value", [[1, 2], [1, 2, 3, 4], 1, "abc", [1, 2, "3"], [1, 2, 300], [1, 2, True]])
def test_a_list_of_another_length_or_kind_is_refused(value: object) -> None:
    with pytest.raises(RobotError, match="park = "):
        table(park=value).numbers("park", length=3, minimum=0, maximum=9)


@pytest.mark.parametrize(
    ("read", "problem"),
    [
        (lambda t: t.integer("x", minimum=0, maximum=9), "is not a whole number"),
        (lambda t: t.text("x"), "is not text"),
        (lambda t: t.table("x"), "must be a section"),
        (lambda t: t.choice("x", ("a", "b")), 'is not "a" or "b"'),
    ],
)
@pytest.mark.parametrize("value", [True, 1.5, [3]])
def test_a_value_of_another_kind_is_refused(read: Callable[[Table], object], problem: str, value: object) -> None:
    with pytest.raises(RobotError, match=problem):
        read(table(x=value))


def test_text_that_must_be_given_is_not_empty() -> None:
    with pytest.raises(RobotError, match="name is empty"):
        table(name="  ").text("name")


def test_a_wrong_choice_names_the_nearest() -> None:
    with pytest.raises(RobotError) as caught:
        table(mode="cubik").choice("mode", ("linear", "cubic"))
    assert caught.value.hint == "did you mean 'cubic'?"


def test_an_unknown_key_names_the_nearest_right_one_and_its_section(write: Write) -> None:
    top = read_table(write("[joints]\nmax_sped_deg_s = 3\n"), error=RobotError)
    top.table("joints").has("max_speed_deg_s")
    with pytest.raises(RobotError) as caught:
        top.finish()
    assert caught.value.what == "unknown key 'max_sped_deg_s' in [joints]; did you mean 'max_speed_deg_s'?"
    assert caught.value.where == "some.toml [joints]"


def test_an_unknown_section_is_refused(write: Write) -> None:
    top = read_table(write("[joint]\n"), error=RobotError)
    top.table("joints", required=False)
    with pytest.raises(RobotError, match="unknown section 'joint'; did you mean 'joints'"):
        top.finish()


def test_a_missing_key_says_what_to_add_or_which_key_was_meant() -> None:
    with pytest.raises(RobotError, match="min_deg is missing") as caught:
        table(max_deg=1).number("min_deg", minimum=-180, maximum=180)
    assert caught.value.hint == "add min_deg = a number from -180 to 180"
    with pytest.raises(RobotError, match="upper_arm_mm is missing") as caught:
        table(upper_arm_m=1).number("upper_arm_mm", minimum=1, maximum=9)
    assert caught.value.hint == "the file has 'upper_arm_m'; did you mean 'upper_arm_mm'?"


def test_a_missing_section_is_named(write: Write) -> None:
    with pytest.raises(RobotError, match=r"the section \[tool\] is missing"):
        read_table(write("a = 1\n"), error=RobotError).table("tool")


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        ("a = 1\nb == 2\n", "not TOML: .*line 2"),
        ("a = 1\na = 2\n", "not TOML"),
        (b"a = 1\nb = '\xff'\n", r"not UTF-8 text \(at line 2\)"),
        ("a = " + "9" * 5000, "not TOML"),
        ("a = " + "[" * 100_000, "not TOML"),
        (b"\0", "not TOML"),
        ("#" * (MAX_BYTES + 1), "larger than 1,000,000 bytes"),
    ],
)
def test_a_file_that_is_not_toml_is_refused(write: Write, content: str | bytes, problem: str) -> None:
    with pytest.raises(ProcessError, match=problem) as caught:
        read_table(write(content), error=ProcessError)
    assert caught.value.where == "some.toml"


@pytest.mark.parametrize("name", ["missing.toml", ".", "nul\0.toml"])
def test_a_file_that_cannot_be_read_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(RobotError, match="the file cannot be read: ") as caught:
        read_table(tmp_path / name, error=RobotError)
    assert caught.value.where == str(tmp_path / name)


def test_a_byte_order_mark_and_windows_line_ends_are_read(write: Write) -> None:
    top = read_table(write(b'\xef\xbb\xbfname = "a"\r\ncount = 1\r\n'), error=RobotError)
    assert top.text("name") == "a"


@given(st.binary(max_size=200))
def test_no_content_gives_another_error(tmp_path_factory: pytest.TempPathFactory, content: bytes) -> None:
    path = tmp_path_factory.mktemp("any") / "some.toml"
    path.write_bytes(content)
    with suppress(RobotError):
        read_table(path, error=RobotError).finish()


def test_tables_that_come_several_times_are_read_one_by_one(write: Write) -> None:
    top = read_table(write("[[part]]\nn = 1\n[[part]]\nn = 2\nm = 3\n"), error=RobotError)
    first, second = top.tables("part")
    assert (first.integer("n", minimum=0, maximum=9), second.integer("n", minimum=0, maximum=9)) == (1, 2)
    assert second.where == "some.toml [part 2]"
    with pytest.raises(RobotError, match=r"unknown key 'm' in \[part 2\]"):
        top.finish()
    assert read_table(write("a = 1\n"), error=RobotError).tables("part") == ()


@pytest.mark.parametrize("content", ["[part]\nn = 1\n", "part = 1\n", "part = [1]\n", "part = [{n = 1}, 2]\n"])
def test_what_should_come_several_times_must_be_tables(write: Write, content: str) -> None:
    with pytest.raises(RobotError, match="must be sections") as caught:
        read_table(write(content), error=RobotError).tables("part")
    assert "[[part]]" in caught.value.hint


def test_a_name_may_stand_for_a_whole_number() -> None:
    names = {"red": 1, "yellow": 2}
    assert table(color="yellow").integer("color", minimum=1, maximum=9, names=names) == 2
    assert table(color=7).integer("color", minimum=1, maximum=9, names=names) == 7
    with pytest.raises(RobotError, match="is not") as caught:
        table(color="yelow").integer("color", minimum=1, maximum=9, names=names)
    assert "yellow" in caught.value.hint
    with pytest.raises(RobotError, match="not a whole number"):
        table(color="yellow").integer("color", minimum=1, maximum=9)


def test_a_word_may_stand_in_place_of_a_number() -> None:
    one = table(length=2, other="auto", wrong="long")
    bounds = {"minimum": 0.0, "maximum": 9.0}
    assert one.number_or("length", "auto", **bounds) == 2.0
    assert one.number_or("other", "auto", **bounds) is None
    assert one.number_or("missing", "auto", **bounds) is None
    with pytest.raises(RobotError, match="wrong = 'long' is not \"auto\""):
        one.number_or("wrong", "auto", **bounds)
    with pytest.raises(RobotError, match="outside 0 to 1"):
        one.number_or("length", "auto", minimum=0.0, maximum=1.0)


def test_the_keys_of_a_table_are_those_of_the_file_in_its_order() -> None:
    one = table(b=1, a=2)
    assert one.keys == ("b", "a")
    with pytest.raises(RobotError, match="unknown key 'b'"):
        one.finish()
