"""Many sentences that differ only in numbers, places and handles, as one."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

_NUMBER: Final = r"(?<![\w.#])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w])"
_VARYING: Final = re.compile(rf"\({_NUMBER}, {_NUMBER}\)|#[0-9A-Za-z]+|{_NUMBER}")


def pattern(sentence: str) -> str:
    """The sentence without what may vary: equal for sentences that say the same of different things.

    A null character and its kind stand for what varies, so that a number is not taken for a handle in its place.
    """
    return _VARYING.sub(lambda found: f"\0{_kind(found[0])}", sentence.replace("\0", "\0\0"))


def summary(sentences: Iterable[str]) -> str:
    """What sentences of one `pattern` say together.

    Numbers become their range, ``gap of 0.02 to 0.3 mm``; of places and handles the first is named:
    ``from (1, 2) ... to (3, 4) ...``, ``#2F ...``.
    """
    sentences = list(sentences)
    columns = list(zip(*(_VARYING.findall(sentence) for sentence in sentences), strict=True))
    parts = _VARYING.split(sentences[0])
    told = [_together(column) for column in columns]
    return "".join(part + more for part, more in zip(parts, [*told, ""], strict=True))


def _kind(value: str) -> str:
    """A bracket for a place, the sign for a handle, a nought for a number."""
    return value[0] if value[0] in "(#" else "0"


def _together(values: tuple[str, ...]) -> str:
    if len(set(values)) == 1:
        return values[0]
    if _kind(values[0]) != "0":
        return f"{values[0]} ..."
    return f"{min(values, key=float)} to {max(values, key=float)}"
