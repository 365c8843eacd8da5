"""The bytes of an ASCII DXF file as groups of tags, read as loosely as can be done without guessing.

A tag is two lines: a group code and a value. A group is the tags from one group code 0 to the next: a section's head, a
layer, an entity. Any line ends, indentation, byte order marks and UTF-16 are accepted. Where group codes and values do
not simply alternate, groups are found by their heads, a line ``0`` followed by a line that can be the name of a kind,
so that damage in one group does not reach the next.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

MAX_CODE: Final = 1071
"""The highest group code of the DXF reference."""

Tag = tuple[int, bytes]

_KIND: Final = re.compile(rb"[A-Z0-9_]*[A-Z][A-Z0-9_]*")
_BLANK: Final = b" \t\v\f\0"
_BLANKS: Final = np.isin(np.arange(256), np.frombuffer(_BLANK, np.uint8))
_Lines = npt.NDArray[np.int32]


@dataclass(frozen=True, slots=True)
class Group:
    """The tags between two heads.

    Attributes:
        kind: the value of its group code 0: LINE, SECTION, ...
        tags: group codes and values after the head; values without surrounding blanks.
        whole: whether every line of it belongs to a tag.
    """

    kind: str
    tags: list[Tag]
    whole: bool

    def first(self, code: int) -> bytes:
        """The value of the first tag with a group code; empty where there is none."""
        return next((value for own, value in self.tags if own == code), b"")


@dataclass(frozen=True, slots=True, eq=False)
class Groups:
    r"""All groups of a file.

    Attributes:
        text: the bytes with ``\n`` as line end.
        starts: (L,) where each line starts, blanks left out.
        ends: (L,) where each line ends, blanks left out.
        heads: (M,) the line with the group code 0 of each group.
        kinds: the M values of these.
        paired: whether group codes and values alternate from the first line to the last.
    """

    text: bytes
    starts: _Lines
    ends: _Lines
    heads: _Lines
    kinds: list[str]
    paired: bool

    def __len__(self) -> int:
        return len(self.kinds)

    def line(self, number: int) -> bytes:
        """One line without surrounding blanks."""
        return self.text[self.starts[number] : self.ends[number]]

    def group(self, index: int) -> Group:
        """One group with its tags."""
        first = int(self.heads[index]) + 2
        last = int(self.heads[index + 1]) if index + 1 < len(self) else len(self.starts)
        starts, ends = self.starts[first:last].tolist(), self.ends[first:last].tolist()
        tags, whole = _tags([self.text[start:end] for start, end in zip(starts, ends, strict=True)])
        return Group(self.kinds[index], tags, whole)

    def codes(self) -> npt.NDArray[np.int16]:
        """The group codes of a paired file, in order."""
        return _codes(self.text, self.starts[::2], self.ends[::2])


def split(data: bytes) -> Groups:
    """The groups of a file.

    Args:
        data: the whole file; ASCII DXF in any encoding.
    """
    text = _one_line_end(data)
    starts, ends = _strip(text, *_lines(text))
    starts, ends = _without_gaps(starts, ends)
    codes = _codes(text, starts, ends)
    paired = len(codes) % 2 == 0 and bool((codes[::2] >= 0).all())
    if paired:
        heads = 2 * np.flatnonzero(codes[::2] == 0)
    else:
        heads = np.flatnonzero(codes[:-1] == 0)
        named = (_KIND.fullmatch(text[starts[i + 1] : ends[i + 1]]) is not None for i in heads.tolist())
        heads = heads[np.fromiter(named, bool, len(heads))]
    names: dict[bytes, str] = {}
    kinds = []
    for start, end in zip(starts[heads + 1].tolist(), ends[heads + 1].tolist(), strict=True):
        name = text[start:end]
        kinds.append(names.setdefault(name, name.decode("utf-8", "surrogateescape")))
    return Groups(text, starts, ends, heads.astype(np.int32), kinds, paired)


def _one_line_end(data: bytes) -> bytes:
    r"""The bytes in one byte per ASCII character, lines ended by ``\n``, blank lines at the end left out."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        data = data.decode("utf-16", "replace").encode()
    data = data.removeprefix(b"\xef\xbb\xbf")
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return data.rstrip(b"\x1a\0 \t\n") + b"\n"


def _lines(text: bytes) -> tuple[_Lines, _Lines]:
    """Where lines start and end, (L,) each."""
    ends = np.flatnonzero(np.frombuffer(text, np.uint8) == ord("\n")).astype(np.int32)
    return np.concatenate([np.zeros(1, np.int32), ends[:-1] + np.int32(1)]), ends


def _strip(text: bytes, starts: _Lines, ends: _Lines) -> tuple[_Lines, _Lines]:
    """The lines without the blanks around them."""
    raw = np.frombuffer(text, np.uint8)
    for bounds, offset, step in ((starts, 0, 1), (ends, -1, -1)):
        left = np.arange(len(bounds))
        for _ in range(32):
            left = left[(starts[left] < ends[left]) & _BLANKS[raw[bounds[left] + offset]]]
            bounds[left] += np.int32(step)
        for i in left.tolist():  # long runs of blanks, each looked at once
            line = text[starts[i] : ends[i]]
            rest = line.lstrip(_BLANK) if step > 0 else line.rstrip(_BLANK)
            bounds[i] += step * (len(line) - len(rest))
    return starts, ends


def _without_gaps(starts: _Lines, ends: _Lines) -> tuple[_Lines, _Lines]:
    """The lines themselves, or where every second one is blank, as after two conversions of their ends, the others."""
    if len(starts) > 2 and (starts[1::2] == ends[1::2]).all():
        return starts[::2].copy(), ends[::2].copy()
    return starts, ends


def _codes(text: bytes, starts: _Lines, ends: _Lines) -> npt.NDArray[np.int16]:
    """Each line as a group code; -1 where it is none."""
    raw = np.frombuffer(text, np.uint8)
    width = ends - starts
    good = (width >= 1) & (width <= 4)
    value = np.zeros(len(starts), np.int16)
    for place in range(4):
        active = np.flatnonzero(good & (width > place))
        digits = raw[starts[active] + place] - np.uint8(ord("0"))  # what is no digit wraps round to 10 or more
        good[active] = digits <= 9
        value[active] = value[active] * 10 + digits
    return np.where(good & (value <= MAX_CODE), value, np.int16(-1))


def _tags(lines: list[bytes]) -> tuple[list[Tag], bool]:
    """The tags of a group's lines, and whether no line but blank ones had to be left out."""
    tags: list[Tag] = []
    whole = True
    rest = iter(lines)
    for line in rest:
        code = _code(line)
        if code < 0:
            whole = whole and not line
            continue
        value = next(rest, None)
        if value is None:
            whole = False
        elif code != COMMENT:
            tags.append((code, value))
    return tags, whole


COMMENT: Final = 999


def _code(line: bytes) -> int:
    """A line as a group code; -1 where it is none."""
    code = int(line) if line.isdigit() and len(line) <= 4 else -1
    return code if code <= MAX_CODE else -1


def from_binary(tags: Iterable[Any]) -> bytes:
    """The lines that stand for the tags of a binary file, in UTF-8."""
    return b"".join(b"%d\n%s\n" % (code, _value(value)) for code, value in tags)


def _value(value: object) -> bytes:
    """A value of a binary file as one line; floats keep every bit."""
    if isinstance(value, bytes):
        return value.hex().encode()
    text = value if isinstance(value, str) else repr(value)
    return " ".join(text.splitlines()).encode("utf-8", "surrogateescape")
