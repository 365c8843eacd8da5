"""Making text from a file safe to show."""

from __future__ import annotations

import unicodedata
from typing import Final

_SHOWN: Final = 60  # characters of one name


def plain(text: str, *, longest: int = _SHOWN) -> str:
    """The text on one line, without anything that a terminal acts on, and not longer than ``longest`` characters.

    Control characters, escape sequences, line and paragraph separators, surrogates and the marks that turn the
    direction of writing become backslash escapes.
    """
    shown = text if len(text) <= longest else f"{text[: longest - 3]}..."
    return "".join(map(_escaped, shown))


def _escaped(character: str) -> str:
    if unicodedata.category(character) in ("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"):
        return character.encode("unicode_escape").decode("ascii")
    return character
