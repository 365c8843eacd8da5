"""What is different for which parts of a batch: batch.toml."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.batch.choosing.rules import FILE, MOST, Rule, Rules, Wanted, find_rules, read
from deltacam.errors import DeltacamError
from deltacam.units import METRES_PER

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "batch-file.md").read_text(encoding="utf-8")


def write(folder: Path, text: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / FILE
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_gives_its_rules_in_order_and_none_for_what_it_does_not_say(tmp_path: Path) -> None:
    path = write(
        tmp_path,
        """
        [[part]]
        pattern = "brackets/*.dxf"
        robot = "irb360-1600"
        process = "acrylic-3mm-co2"
        units = "in"
        quantity = 4

        [[part]]
        pattern = "left.dxf"
        quantity = 1_000_000
        """,
    )
    rules = read(path)
    assert rules.file == str(path)
    assert rules.rules == (
        Rule("brackets/*.dxf", "irb360-1600", "acrylic-3mm-co2", "in", 4),
        Rule("left.dxf", quantity=MOST),
    )
    assert rules.settings_of("brackets/left.dxf") == Wanted("irb360-1600", "acrylic-3mm-co2", "in", MOST)
    assert rules.settings_of("Brackets/Right.DXF") == Wanted("irb360-1600", "acrylic-3mm-co2", "in", 4)
    assert rules.settings_of("gear.dxf") == Wanted(None, None, None, 1)


@given(st.lists(st.tuples(st.sampled_from(["*", "a*", "*b.dxf", "s/*"]), *[st.none() | st.integers(1, 9)] * 4)))
def test_for_each_key_the_last_rule_that_gives_it_wins(given: list[tuple[str, int, int, int, int]]) -> None:
    texts = [(pattern, *(None if one is None else str(one) for one in three), last) for pattern, *three, last in given]
    rules = Rules("batch.toml", tuple(Rule(*one) for one in texts))  # type: ignore[arg-type]
    fitting = {"ab.dxf": {"*", "a*", "*b.dxf"}, "s/b.dxf": {"*", "*b.dxf", "s/*"}, "c.dxf": {"*"}}
    for name, patterns in fitting.items():
        wanted = rules.settings_of(name)
        for column, key in enumerate(("robot", "process", "units", "quantity"), start=1):
            said = [one[column] for one in texts if one[0] in patterns and one[column] is not None]
            assert getattr(wanted, key) == (said[-1] if said else 1 if key == "quantity" else None)


def test_the_rules_of_a_folder_are_those_of_its_own_file(tmp_path: Path) -> None:
    assert find_rules(tmp_path) == Rules()
    assert Rules().settings_of("a.dxf") == Wanted()
    write(tmp_path / "s", '[[part]]\npattern = "*"\nquantity = 2\n')
    assert find_rules(tmp_path) == Rules()
    assert find_rules(tmp_path / "s").settings_of("a.dxf").quantity == 2
    path = write(tmp_path, "# nothing yet\n")
    assert find_rules(tmp_path) == Rules(str(path))


def test_a_link_to_nowhere_and_a_folder_are_refused(tmp_path: Path) -> None:
    path = tmp_path / FILE
    path.symlink_to(tmp_path / "nowhere")
    with pytest.raises(DeltacamError, match="cannot be read: no such file") as refused:
        find_rules(tmp_path)
    assert refused.value.where == str(path)
    path.unlink()
    path.mkdir()
    with pytest.raises(DeltacamError, match="cannot be read: is a directory") as refused:
        find_rules(tmp_path)
    assert refused.value.where == str(path)


@pytest.mark.parametrize("key", ["robot", "process"])
def test_a_file_is_looked_for_beside_the_rules_and_a_name_is_left_alone(
    tmp_path: Path, key: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "parts" / "mine").mkdir(parents=True)
    for name in ("mine/card.toml", "card.TOML", "delta-300"):
        (tmp_path / "parts" / name).touch()
    text = f"[[part]]\npattern = 'a.dxf'\n{key} = "
    monkeypatch.chdir(tmp_path)
    for name, expected in {"mine/card.toml": "parts/mine/card.toml", "card.TOML": "parts/card.TOML"}.items():
        write(tmp_path / "parts", f"{text}'{name}'")
        assert getattr(find_rules(Path("parts")).settings_of("a.dxf"), key) == expected
        assert getattr(find_rules(tmp_path / "parts").settings_of("a.dxf"), key) == str(tmp_path / expected)
    for name in ("delta-300", "no-such"):
        assert getattr(read(write(tmp_path / "parts", f"{text}'{name}'")).settings_of("a.dxf"), key) == name
    path = write(tmp_path / "parts", f"{text}'parts/card.TOML'")
    with pytest.raises(DeltacamError, match="there is no such file") as refused:
        read(path)
    assert refused.value.hint == "name it as seen from batch.toml"


@pytest.mark.parametrize("unit", METRES_PER)
def test_every_unit_may_be_given(tmp_path: Path, unit: str) -> None:
    assert read(write(tmp_path, f"[[part]]\npattern = '*'\nunits = '{unit}'")).settings_of("a.dxf").units == unit


def test_the_patterns_that_fit_no_part_are_told_once_each() -> None:
    rules = Rules("", tuple(Rule(pattern, quantity=2) for pattern in ("a*", "no*", "*", "s/*", "no*")))
    assert rules.unused(["a.dxf", "t/a.dxf"]) == ("no*", "s/*")
    assert rules.unused([]) == ("a*", "no*", "*", "s/*")
    assert Rules().unused(["a.dxf"]) == ()


@pytest.mark.parametrize(
    ("text", "what", "place", "hint"),
    [
        ("quantity = 2", "pattern is missing", " [part 1]", "add pattern"),
        ("patern = 'a*'\nquantity = 2", "pattern is missing", " [part 1]", "did you mean 'pattern'"),
        ("pattern = ''\nquantity = 2", "pattern is empty", " [part 1]", ""),
        ("pattern = ['a*']\nquantity = 2", "pattern = .* is not text", " [part 1]", ""),
        ("pattern = '**/a'\nquantity = 2", r"pattern: '\*\*/a' holds", " [part 1]", "write 'a'"),
        ("pattern = './a'\nquantity = 2", "pattern: no drawing is like './a'", " [part 1]", "'a'"),
        ("pattern = 'a'", "nothing is said of these parts", " [part 1]", "robot, process, units, quantity"),
        (
            "pattern = 'a'\nquantty = 2",
            "unknown key 'quantty' .*did you mean 'quantity'",
            " [part 1]",
            "known: pattern",
        ),
        ("pattern = 'a'\nquantity = 0", "quantity = 0 is outside 1 to 1000000", " [part 1]", ""),
        ("pattern = 'a'\nquantity = 1_000_001", "quantity = 1000001 is outside", " [part 1]", ""),
        ("pattern = 'a'\nquantity = 2.0", "quantity = 2.0 is not a whole number", " [part 1]", ""),
        ("pattern = 'a'\nquantity = true", "quantity = true is not a whole number", " [part 1]", ""),
        ("pattern = 'a'\nunits = 'ell'", "units: unknown unit of length 'ell'", " [part 1]", ""),
        ("pattern = 'a'\nrobot = 300", "robot = 300 is not text", " [part 1]", ""),
        ("pattern = 'a'\nrobot = 'my.toml'", "robot = 'my.toml': there is no such file", " [part 1]", "batch.toml"),
        ("pattern = 'a'\nrobot = 'm/\\u0000'", "robot = .*: ", " [part 1]", ""),
        (f"pattern = 'a'\nrobot = '{'x' * 300}.toml'", "cannot be looked at: file name too long", " [part 1]", ""),
        ("pattern = 'a'\nquantity = 1\n[[part]]\npattern = 'b'", "nothing is said", " [part 2]", ""),
        ("pattern = 'a'\nquantity = 1\n[[parts]]\n", "unknown key 'parts'; did you mean 'part'", "", ""),
        ("pattern = ", "not TOML", "", ""),
    ],
)
def test_what_is_wrong_is_refused_with_the_file_the_section_and_the_key(
    tmp_path: Path, text: str, what: str, place: str, hint: str
) -> None:
    path = write(tmp_path, f"[[part]]\n{text}\n")
    with pytest.raises(DeltacamError, match=what) as refused:
        find_rules(tmp_path)
    assert refused.value.where == f"{path}{place}"
    assert hint in refused.value.hint


def test_one_section_in_single_brackets_is_refused_with_how_to_write_it(tmp_path: Path) -> None:
    with pytest.raises(DeltacamError, match=r"part = .* must be sections") as refused:
        read(write(tmp_path, "[part]\npattern = 'a'\nquantity = 1\n"))
    assert refused.value.hint == "write [[part]] above each of them"


def test_a_file_of_another_name_is_named_in_messages(tmp_path: Path) -> None:
    path = tmp_path / "tonight.toml"
    path.write_text("[[part]]\npattern = 'a'\nrobot = 'my.toml'\n")
    with pytest.raises(DeltacamError) as refused:
        read(path)
    assert (refused.value.where, refused.value.hint) == (f"{path} [part 1]", "name it as seen from tonight.toml")


def test_every_key_has_its_row_in_the_reference(tmp_path: Path) -> None:
    with pytest.raises(DeltacamError) as refused:
        read(write(tmp_path, "[[part]]\npattern = 'a'\nzz = 1\n"))
    for key in refused.value.hint.removeprefix("known: ").split(", "):
        assert f"\n| `{key}` | " in PAGE
    assert f"| `quantity` | 1 to {MOST} |" in PAGE


def test_the_example_of_the_reference_does_what_is_said_there(tmp_path: Path) -> None:
    example = re.search(r"```toml\n(.*?)```", PAGE, flags=re.DOTALL)
    assert example
    rules = read(write(tmp_path, example[1]))
    assert rules.settings_of("acrylic/left.dxf") == Wanted(process="acrylic-3mm-co2", quantity=12)
    assert rules.settings_of("acrylic/old/lid-inch.dxf") == Wanted(process="acrylic-3mm-co2", units="in", quantity=4)
    assert rules.settings_of("left.dxf") == Wanted()
