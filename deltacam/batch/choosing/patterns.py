"""Patterns of names of parts: which of them a batch plans, and which of them a rule is for."""

from __future__ import annotations

import difflib
import re
import unicodedata
from collections.abc import Iterator, Sequence
from fnmatch import translate
from functools import lru_cache
from typing import Final

from deltacam.errors import DeltacamError
from deltacam.plain import plain

SHOWN: Final = 3
"""Names in a message; of more, only the first ones are written out."""

_LONGEST: Final = 200  # characters of one name


def matches(name: str, pattern: str) -> bool:
    """Whether the name of a part is like ``pattern``, in any case.

    ``*`` stands for any letters, also for none and for ``/``, and ``?`` for one; all others stand for themselves, so
    that a name is like itself. A pattern without ``/`` is compared with what follows the last ``/`` of the name.
    Letters that look the same are the same, whether their accents are letters of their own or not.
    """
    compared = name if "/" in pattern else name.rpartition("/")[2]
    return _compiled(pattern).match(unicodedata.normalize("NFC", compared)) is not None


def check_pattern(pattern: str) -> None:
    """Refuse a pattern that no name is like, and one that means something else in other programs.

    Raises:
        DeltacamError: says why.
    """
    if not pattern.strip():
        raise DeltacamError("the pattern is empty", hint="write '*' for all drawings")
    if "**" in pattern:
        simple = pattern.removeprefix("**/").replace("**/", "*").replace("**", "*")
        raise DeltacamError(f"{pattern!r} holds '**'", hint=f"* stands for folders too: write {simple!r}")
    bare = re.sub(r"^(\.{0,2}/)+", "", pattern)
    if bare != pattern:
        hint = f"names are as seen from the folder of the batch: {bare or '*'!r}"
        raise DeltacamError(f"no drawing is like {pattern!r}", hint=hint)


def suggestion(pattern: str, names: Sequence[str]) -> str:
    """What to write in the place of a pattern that none of the names is like."""
    near = next(_nearest(pattern, names), "")
    question = f"did you mean {near!r}? " if near else ""
    return f"{question}there is {written(names)}" if names else "there is no drawing"


def written(names: Sequence[str]) -> str:
    """The names, safe to show; of many only the first ones."""
    shown = ", ".join(plain(name, longest=_LONGEST) for name in names[:SHOWN])
    return f"{shown} and {len(names) - SHOWN} more" if len(names) > SHOWN else shown


@lru_cache(maxsize=4096)
def _compiled(pattern: str) -> re.Pattern[str]:
    # A bracket means itself; for fnmatch it would begin a set of characters.
    return re.compile(translate(unicodedata.normalize("NFC", pattern).replace("[", "[[]")), re.IGNORECASE)


def _nearest(pattern: str, names: Sequence[str]) -> Iterator[str]:
    """Patterns that were probably meant, the likeliest first; there is a name like each of them."""
    slashed = pattern.replace("\\", "/").rstrip("/")
    folder, _, last = slashed.rpartition("/")
    folders = sorted({name.rpartition("/")[0] for name in names} - {""})
    below = slashed.partition("/")[2]  # as seen from the folder that holds the folder of the batch
    others = [slashed, f"{slashed}/*"]
    others += [f"{near}/{last}" for near in difflib.get_close_matches(folder, folders)]
    if not set("*?") & set(slashed):
        others += difflib.get_close_matches(slashed, names)
        others += difflib.get_close_matches(slashed, [name.rpartition("/")[2] for name in names])
    others += [*(f"{near}/*" for near in difflib.get_close_matches(slashed, folders)), below]
    return (other for other in others if other and any(matches(name, other) for name in names))
