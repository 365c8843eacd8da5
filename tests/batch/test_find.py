"""Which drawings a batch plans."""

from __future__ import annotations

import os
import unicodedata
from pathlib import Path, PurePosixPath

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from deltacam.batch.choosing.find import Found, find, names_in, refuse_clashes
from deltacam.batch.parts import Part
from deltacam.errors import DeltacamError

AS_ROOT = hasattr(os, "geteuid") and os.geteuid() == 0


def make(folder: Path, *names: str) -> Path:
    """The folder, with empty files of these names."""
    for name in names:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    folder.mkdir(exist_ok=True)
    return folder


def names(found: Found) -> list[str]:
    return [name for name, _ in found.drawings]


def refusal(folder: Path, **options: list[str]) -> DeltacamError:
    with pytest.raises(DeltacamError) as refused:
        find(folder, **options)
    return refused.value


def test_drawings_are_found_at_any_depth_in_any_case_and_in_the_order_of_their_names(tmp_path: Path) -> None:
    folder = make(tmp_path / "parts", "b.dxf", "a.DXF", "c/d/e/f.Dxf", "c.dxf", "notes.txt", "x.dxf.bak", "dxf")
    found = find(folder)
    assert found.drawings == tuple((name, folder / name) for name in ("a.DXF", "b.dxf", "c.dxf", "c/d/e/f.Dxf"))
    assert found.notes == ()


def test_every_drawing_is_found_by_its_name_whatever_is_in_it(tmp_path: Path) -> None:
    strange = [
        "<script>.dxf",
        "a'\"b.dxf",
        "two\nlines.dxf",
        "bytes\udcff.dxf",
        "\x1b[31m.dxf",
        " .dxf",
        "[*?].dxf",
        "-.dxf",
    ]
    folder = make(tmp_path / "parts", *strange)
    assert names(find(folder)) == sorted(strange)
    for name in strange:
        assert names(find(folder, listed=[str(folder / name)])) == [name]
        assert name in names(find(folder, include=[name]))


def test_a_folder_called_like_a_drawing_is_a_folder(tmp_path: Path) -> None:
    assert names(find(make(tmp_path / "parts", "a.dxf/b.dxf"))) == ["a.dxf/b.dxf"]


def test_include_and_exclude_choose_by_name_or_by_folder(tmp_path: Path) -> None:
    folder = make(tmp_path / "parts", "gear.dxf", "brackets/left.dxf", "brackets/old/left.dxf", "plates/left.dxf")
    assert names(find(folder, include=["brackets/*"])) == ["brackets/left.dxf", "brackets/old/left.dxf"]
    assert names(find(folder, include=["gear.dxf", "plates/*"])) == ["gear.dxf", "plates/left.dxf"]
    assert names(find(folder, exclude=["LEFT.dxf"])) == ["gear.dxf"]
    assert names(find(folder, include=["left.dxf"], exclude=["*/old/*"])) == ["brackets/left.dxf", "plates/left.dxf"]


@pytest.mark.parametrize("option", ["include", "exclude"])
def test_a_pattern_that_fits_nothing_is_refused_with_the_nearest_one(tmp_path: Path, option: str) -> None:
    folder = make(tmp_path / "parts", "gear.dxf", "brackets/left.dxf")
    problem = refusal(folder, **{option: ["gear.dxf", "bracket/*"]})
    assert (problem.what, problem.where) == ("no drawing is like 'bracket/*'", f"--{option}")
    assert problem.hint == "did you mean 'brackets/*'? there is brackets/left.dxf, gear.dxf"
    problem = refusal(folder, **{option: ["**/gear.dxf"]})
    assert (problem.what, problem.where) == ("'**/gear.dxf' holds '**'", f"--{option}")


def test_patterns_that_leave_nothing_are_refused(tmp_path: Path) -> None:
    folder = make(tmp_path / "parts", "gear.dxf", "left.dxf")
    problem = refusal(folder, include=["gear.dxf"], exclude=["gear.dxf"])
    assert problem.what == "--include and --exclude leave no drawing"
    assert "gear.dxf, left.dxf" in problem.hint


def test_what_is_left_out_is_told(tmp_path: Path) -> None:
    folder = make(
        tmp_path / "parts", "a.dxf", "._a.dxf", "s/.b.dxf", ".dxf", ".git/c.dxf", ".DS_Store", "s/d.DWG", "e.pdf"
    )
    make(tmp_path / "elsewhere", "f.dxf")
    (folder / "linked").symlink_to(tmp_path / "elsewhere")
    os.mkfifo(folder / "pipe.dxf")
    found = find(folder)
    assert names(found) == ["a.dxf"]
    assert found.notes == (
        "hidden, and so left out: ._a.dxf, .dxf, s/.b.dxf",
        "hidden, and so not looked into: .git/",
        "links to folders, and so not looked into: linked/",
        "neither files nor folders, and so left out: pipe.dxf",
        "not DXF, and so left out: e.pdf, s/d.DWG",
    )


def test_of_many_left_out_only_the_first_are_named_on_one_line(tmp_path: Path) -> None:
    folder = make(tmp_path / "parts", "a.dxf", "1\n\x1b.dwg", *(f"{n}.dwg" for n in range(2, 9)))
    assert find(folder).notes == ("not DXF, and so left out: 1\\n\\x1b.dwg, 2.dwg, 3.dwg and 5 more",)


def test_nothing_is_told_of_files_that_the_patterns_leave_out(tmp_path: Path) -> None:
    folder = make(tmp_path / "parts", "a.dxf", "b.dwg", "old/c.dwg", ".git/d", "old/._e.dxf")
    assert find(folder, include=["*.dxf"], exclude=["old/*", ".git/*"]).notes == ()
    assert find(folder, exclude=["old/*"]).notes == (
        "hidden, and so not looked into: .git/",
        "not DXF, and so left out: b.dwg",
    )


def test_the_folder_may_itself_be_hidden_or_the_folder_of_the_results(tmp_path: Path) -> None:
    folder = make(tmp_path / ".parts", "a.dxf", "out/.deltacam-batch/record.jsonl", "out/index.html")
    before = find(folder)
    assert (names(before), before.notes) == (["a.dxf"], ())


def test_rules_in_a_folder_below_are_told_not_to_count(tmp_path: Path) -> None:
    folder = make(tmp_path / "parts", "batch.toml", "a.dxf", "s/batch.toml")
    told = "not read, because batch.toml counts in the folder of the batch only: s/batch.toml"
    assert find(folder).notes == (told,)
    assert find(folder, include=["a.dxf"]).notes == (told,)


def test_links_to_files_count_and_links_to_folders_are_not_followed(tmp_path: Path) -> None:
    folder = make(tmp_path / "parts", "s/a.dxf")
    make(tmp_path, "elsewhere.dxf")
    (folder / "s" / "loop").symlink_to(folder)
    (folder / "link.dxf").symlink_to(tmp_path / "elsewhere.dxf")
    (folder / "folder.dxf").symlink_to(tmp_path)
    assert names(find(folder)) == ["link.dxf", "s/a.dxf"]


def test_a_link_to_nowhere_is_a_drawing_so_that_planning_it_says_what_is_wrong(tmp_path: Path) -> None:
    folder = make(tmp_path / "parts")
    (folder / "gone.dxf").symlink_to(tmp_path / "nowhere.dxf")
    (folder / "round.dxf").symlink_to(folder / "round.dxf")
    assert names(find(folder)) == ["gone.dxf", "round.dxf"]
    assert names(find(folder, listed=[str(folder / "gone.dxf")])) == ["gone.dxf"]


@pytest.mark.skipif(AS_ROOT, reason="root may read everything")
def test_a_folder_that_cannot_be_read_is_refused(tmp_path: Path) -> None:
    folder = make(tmp_path / "parts", "a.dxf", "closed/b.dxf")
    (folder / "closed").chmod(0)
    try:
        problem = refusal(folder)
    finally:
        (folder / "closed").chmod(0o700)
    assert (problem.what, problem.where) == ("the folder cannot be read: permission denied", str(folder / "closed"))


def test_a_folder_that_is_too_deep_to_be_read_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = make(tmp_path / "parts", "a.dxf")
    monkeypatch.chdir(folder)
    for _ in range(18):
        Path("d" * 240).mkdir()
        os.chdir("d" * 240)
    problem = refusal(folder)
    assert problem.what == "the folder cannot be read: file name too long"
    assert problem.where.startswith(str(folder / "ddd"))
    assert "--list" in problem.hint


def test_a_folder_that_is_none_is_refused(tmp_path: Path) -> None:
    make(tmp_path, "my part.dxf", "notes.txt")
    problem = refusal(tmp_path / "my part.dxf")
    assert problem.what == "this is a drawing, not a folder"
    assert problem.hint == f"deltacam plan '{tmp_path / 'my part.dxf'}'"
    assert refusal(tmp_path / "notes.txt").what == "this is a file, not a folder"
    for missing in ("parts", "notes.txt/parts"):
        problem = refusal(tmp_path / missing)
        assert (problem.what, problem.where) == ("there is no such folder", str(tmp_path / missing))
    assert "cannot be read" in refusal(tmp_path / "null\0").what
    assert "cannot be read" in refusal(tmp_path / ("long" * 100)).what


def test_a_folder_without_drawings_is_refused_with_what_is_there_instead(tmp_path: Path) -> None:
    folder = make(tmp_path / "parts", "notes.txt")
    problem = refusal(folder)
    assert (problem.what, problem.where) == ("no drawing (.dxf) in this folder and below", str(folder))
    assert problem.hint == "name the folder that holds the drawings"
    assert refusal(make(folder, "a.dwg")).hint == "not DXF, and so left out: a.dwg"


# Lists


def test_a_list_names_drawings_as_seen_from_the_current_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = make(tmp_path / "parts", "a.dxf", "s/b.dxf", "s/c.dxf")
    monkeypatch.chdir(tmp_path)
    listed = ["parts/s/b.dxf", "", " ", "./parts/a.dxf", str(folder / "a.dxf"), "parts/s/../a.dxf", "parts//s/b.dxf"]
    found = find(Path("parts"), listed=listed)
    assert found.drawings == (("a.dxf", Path("parts/a.dxf")), ("s/b.dxf", Path("parts/s/b.dxf")))
    monkeypatch.chdir(folder / "s")
    assert names(find(Path("..") / ".." / "parts", listed=["c.dxf", "../a.dxf"])) == ["a.dxf", "s/c.dxf"]
    assert names(find(Path(), listed=["c.dxf"])) == ["c.dxf"]


def test_the_places_of_listed_drawings_are_those_that_links_lead_to(tmp_path: Path) -> None:
    folder = make(tmp_path / "parts", "s/a.dxf", "b.dxf")
    make(tmp_path / "elsewhere", "c.dxf")
    (tmp_path / "link").symlink_to(folder)
    (folder / "inner").symlink_to(folder / "s")
    (folder / "outer").symlink_to(tmp_path / "elsewhere")
    (folder / "file.dxf").symlink_to(tmp_path / "elsewhere" / "c.dxf")
    for seen_as in (folder, tmp_path / "link"):
        for root in (folder, tmp_path / "link"):
            listed = [str(seen_as / name) for name in ("inner/a.dxf", "s/a.dxf", "inner/../b.dxf", "file.dxf")]
            assert names(find(root, listed=listed)) == ["b.dxf", "file.dxf", "s/a.dxf"]
        assert "is not in the folder" in refusal(folder, listed=[str(seen_as / "outer" / "c.dxf")]).what
        # Not parts/c.dxf, which would be there if .. were taken away with the name before it.
        make(folder, "c.dxf")
        assert (
            "is not in the folder" in refusal(folder, listed=[str(seen_as / "outer" / ".." / "elsewhere/c.dxf")]).what
        )


def test_what_is_listed_and_is_no_drawing_of_the_folder_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make(tmp_path, "parts/s/a.dxf", "parts/b.dwg", "parts/c.txt", "parts/s/batch.toml", "parts-2/a.dxf", "a.dxf")
    monkeypatch.chdir(tmp_path)
    expected = {
        "parts/gone.dxf": "there is no file 'parts/gone.dxf'",
        "s/a.dxf": "there is no file 's/a.dxf'",
        "parts/s/a.dxf ": "there is no file 'parts/s/a.dxf '",
        "a.dxf/b.dxf": "there is no file 'a.dxf/b.dxf'",
        "parts-2/a.dxf": "'parts-2/a.dxf' is not in the folder 'parts'",
        "parts/../a.dxf": "'parts/../a.dxf' is not in the folder 'parts'",
        "parts/s": "'parts/s' is a folder, not a drawing",
        "parts/b.dwg": "'parts/b.dwg' is not a drawing (.dxf)",
        "parts/c.txt": "'parts/c.txt' is not a drawing (.dxf)",
        "parts/s/batch.toml": "'parts/s/batch.toml' is not a drawing (.dxf)",
        "x" * 5000: "cannot be found: file name too long",
        "null\0.dxf": "cannot be found: embedded null",
    }
    for listed, what in expected.items():
        problem = refusal(Path("parts"), listed=["parts/s/a.dxf", listed])
        assert what in problem.what
        assert problem.where == "--list"
    assert refusal(Path("parts"), listed=["s/a.dxf"]).hint.endswith("one a line: 'parts/s/a.dxf'")
    assert refusal(Path("none"), listed=["a.dxf"]).what == "there is no such folder"


def test_a_list_without_a_name_is_refused(tmp_path: Path) -> None:
    for listed in ([], [" "]):
        assert refusal(make(tmp_path / "parts", "a.dxf"), listed=listed).what == "the list names no drawing"


def test_hidden_drawings_and_pipes_are_left_out_of_a_list_too(tmp_path: Path) -> None:
    folder = make(tmp_path / "parts", "a.dxf", ".git/b.dxf", "s/._c.dxf")
    os.mkfifo(folder / "pipe.dxf")
    found = find(folder, listed=[str(folder / name) for name in ("a.dxf", ".git/b.dxf", "s/._c.dxf", "pipe.dxf")])
    assert names(found) == ["a.dxf"]
    assert found.notes == (
        "hidden, and so left out: .git/b.dxf, s/._c.dxf",
        "neither files nor folders, and so left out: pipe.dxf",
    )
    problem = refusal(folder, listed=[str(folder / "pipe.dxf")])
    assert (problem.what, problem.hint) == (
        "no drawing (.dxf) in the list",
        "neither files nor folders, and so left out: pipe.dxf",
    )


def test_patterns_choose_among_what_is_listed_and_one_that_fits_nothing_is_told(tmp_path: Path) -> None:
    folder = make(tmp_path / "parts", "a.dxf", "b.dxf", "draft-c.dxf")
    listed = [str(folder / "a.dxf"), str(folder / "b.dxf")]
    found = find(folder, listed=listed, include=["a.dxf"], exclude=["draft*"])
    assert names(found) == ["a.dxf"]
    assert found.notes == ("--exclude: nothing in the list is like 'draft*'",)
    assert "leave no drawing" in refusal(folder, listed=listed, include=["draft*"]).what


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"", ()),
        (b"a.dxf\nb c.dxf", ("a.dxf", "b c.dxf")),
        (b"a.dxf\r\n\r\n  \nb.dxf\r\n", ("a.dxf", "b.dxf")),
        (b" a.dxf \n", (" a.dxf ",)),
        (b"a.dxf\0two\nlines\r.dxf\0", ("a.dxf", "two\nlines\r.dxf")),
        (b"one\rname.dxf\n", ("one\rname.dxf",)),
        (b"\xef\xbb\xbfa.dxf\n", ("a.dxf",)),
        ("\N{LATIN SMALL LETTER E WITH ACUTE}.dxf\r\n".encode("utf-16"), ("\N{LATIN SMALL LETTER E WITH ACUTE}.dxf",)),
        (b"bytes\xff.dxf\n", ("bytes\udcff.dxf",)),
    ],
)
def test_the_names_in_a_list_are_those_between_line_ends_or_nulls(data: bytes, expected: tuple[str, ...]) -> None:
    assert names_in(data) == expected


def test_a_list_that_is_damaged_utf_16_is_refused() -> None:
    with pytest.raises(DeltacamError, match="damaged UTF-16"):
        names_in(b"\xff\xfea")


@given(st.lists(st.binary(min_size=1, max_size=8).filter(lambda name: b"\0" not in name), min_size=1))
def test_any_names_but_blank_ones_pass_through_a_list_between_nulls(those: list[bytes]) -> None:
    wanted = tuple(name for name in map(os.fsdecode, those) if name.strip())
    assume(not those[0].startswith((b"\xff\xfe", b"\xfe\xff", b"\xef\xbb\xbf")))
    assert names_in(b"\0".join(those) + b"\0") == wanted


# Names that clash


@pytest.mark.parametrize(
    ("one", "two"),
    [("a.DXF", "a.dxf"), ("A.dxf", "a.dxf"), ("Sub/a.dxf", "sub/A.DXF"), ("caf\u00e9.dxf", "cafe\u0301.dxf")],
)
def test_two_drawings_whose_results_would_have_one_name_are_refused_with_both(
    tmp_path: Path, one: str, two: str
) -> None:
    folder = make(tmp_path / "parts", one, two, "other.dxf")
    if len([path for path in folder.rglob("*") if path.is_file()]) < 3:
        pytest.skip("this disk takes both for one")
    problem = refusal(folder)
    shown = ascii if "caf" in one else repr
    assert shown(one) in problem.what
    assert shown(two) in problem.what
    assert problem.hint == "rename one of them, or plan a list of drawings: --list"
    for kept, other in ((one, two), (two, one)):
        listed = [str(folder / kept), str(folder / "other.dxf")]
        assert other not in names(find(folder, listed=listed))
    assert names(find(folder, exclude=[one])) == ["other.dxf"]


def test_where_a_pattern_can_tell_clashing_names_apart_it_is_suggested() -> None:
    with pytest.raises(DeltacamError, match="same names") as refused:
        refuse_clashes(["STRASSE.dxf", "stra\u00dfe.dxf"])
    assert refused.value.hint == "rename one of them, or leave one out: --exclude 'stra\u00dfe.dxf'"


@given(
    st.text(st.characters(exclude_characters="/\0.", exclude_categories=["Cs"]), min_size=1, max_size=12),
    st.sampled_from(["NFC", "NFD"]),
    st.sampled_from([str.upper, str.lower, str.swapcase, str.title, str]),
)
def test_a_name_clashes_with_itself_written_in_another_way(stem: str, form: str, rewrite: type[str]) -> None:
    # A capital may be written with a letter that has no way back, such as the dotless i; those are other names.
    other = unicodedata.normalize(form, rewrite(stem))  # type: ignore[arg-type]
    assume(rewrite(stem).casefold() == stem.casefold())
    assume(f"{other}.dxf" != f"{stem}.dxf")
    with pytest.raises(DeltacamError, match="same names"):
        refuse_clashes([f"s/{stem}.dxf", f"S/{other}.DXF"])


@given(st.sets(st.text(st.sampled_from("abc/."), min_size=1, max_size=6), max_size=8))
def test_no_clash_means_that_the_results_differ_also_without_capitals(stems: set[str]) -> None:
    those = sorted({str(PurePosixPath("x") / f"{stem.strip('/')}x.dxf") for stem in stems})
    refuse_clashes(those)
    assert len({Part(name, Path(name), {}).stem.lower() for name in those}) == len(those)
