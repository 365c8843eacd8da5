"""Files as groups of tags."""

from pathlib import Path

import numpy as np
import pytest
from ezdxf.lldxf.tagger import ascii_tags_loader, binary_tags_loader
from hypothesis import given
from hypothesis import strategies as st

from deltacam.drawing.dxf import tags

FILES = Path(__file__).parents[2] / "data" / "dxf"
ASCII = [path for path in sorted(FILES.glob("*.dxf")) if "binary" not in path.stem]
SMALL = b"  0\nSECTION\n  2\nENTITIES\n  0\nLINE\n  8\nA layer\n 10\n1.5\n  0\nENDSEC\n  0\nEOF\n"


def content(groups: tags.Groups) -> list[tags.Group]:
    return [groups.group(i) for i in range(len(groups))]


@pytest.mark.parametrize("path", ASCII, ids=lambda path: path.stem)
def test_the_tags_of_a_real_file_are_those_that_ezdxf_finds(path: Path) -> None:
    groups = tags.split(path.read_bytes())
    ours = [tag for group in content(groups) for tag in ((0, group.kind.encode("latin-1")), *group.tags)]
    with path.open(encoding="latin-1") as stream:
        theirs = [(tag.code, tag.value.strip(" \t\0\v\f").encode("latin-1")) for tag in ascii_tags_loader(stream)]
    assert groups.paired
    assert ours == theirs[next(i for i, (code, _) in enumerate(theirs) if code == 0) :]


@pytest.mark.parametrize(
    "variant",
    [
        SMALL.replace(b"\n", b"\r\n"),
        SMALL.replace(b"\n", b"\r"),
        SMALL.replace(b"\n", b"\r\r\n"),
        SMALL.replace(b"\n", b"\n\n"),
        SMALL.replace(b"\n", b" \t\n"),
        SMALL.replace(b"\n", b"\n" + b" " * 100),
        SMALL.replace(b"  0", b"0"),
        b"\xef\xbb\xbf" + SMALL,
        SMALL.decode().encode("utf-16"),
        b"999\nwritten by hand\n" + SMALL,
        SMALL + b"\r\n\r\n\x1a",
        SMALL.rstrip(),
    ],
)
def test_how_lines_are_ended_and_indented_does_not_matter(variant: bytes) -> None:
    assert content(tags.split(variant)) == content(tags.split(SMALL))


@given(st.integers(0, 14), st.sampled_from([b"", b"foo", b"12.5", b"0"]))
def test_damage_in_one_group_does_not_reach_the_next(place: int, line: bytes) -> None:
    entity = [b"0", b"LINE", b"8", b"A", b"10", b"1", b"20", b"2", b"11", b"3", b"21", b"4", b"62", b"5"]
    rest = [b"0", b"CIRCLE", b"10", b"1", b"20", b"2", b"40", b"3", b"0", b"EOF"]
    damaged = [*entity[:place], line, *entity[place:]]
    last_two = content(tags.split(b"\n".join([*damaged, *rest])))[-2:]
    assert [group.kind for group in last_two] == ["CIRCLE", "EOF"]
    assert last_two[0].tags == [(10, b"1"), (20, b"2"), (40, b"3")]
    assert last_two[0].whole


def test_a_group_with_a_line_too_much_is_not_whole_but_blank_lines_do_not_count() -> None:
    def whole(middle: bytes) -> bool:
        return tags.split(b"0\nLINE\n10\n1\n" + middle + b"20\n2\n0\nEOF\n").group(0).whole

    assert whole(b"")
    assert whole(b"\n")
    assert not whole(b"foo\n")
    assert not whole(b"30\n")


@pytest.mark.parametrize("line", [b"1072", b"-1", b"x", b"1.0", b"12345", b"", b"1 0"])
def test_what_is_no_group_code_breaks_the_pairs(line: bytes) -> None:
    assert tags.split(b"0\nLINE\n1071\nfoo\n").paired
    assert not tags.split(b"0\nLINE\n" + line + b"\nfoo\n").paired


def test_group_codes_are_those_of_the_lines() -> None:
    assert tags.split(SMALL).codes().tolist() == [0, 2, 0, 8, 10, 0, 0]


@given(st.binary(max_size=300))
def test_any_bytes_are_split(data: bytes) -> None:
    groups = tags.split(data)
    assert len(groups.heads) == len(groups)
    assert (np.diff(groups.heads) > 0).all()
    for group in content(groups):
        assert all(0 <= code <= tags.MAX_CODE for code, _ in group.tags)


def test_a_binary_file_gives_the_tags_that_it_holds() -> None:
    data = (FILES / "diamond-3d-binary.dxf").read_bytes()
    groups = tags.split(tags.from_binary(binary_tags_loader(data)))
    assert groups.kinds.count("LINE") == 12
    x = [float(value) for group in content(groups) for code, value in group.tags if code == 10]
    assert x == [tag.value for tag in binary_tags_loader(data) if tag.code == 10]
