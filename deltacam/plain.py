"""Making text from a file safe to show."""

from __future__ import annotations

from typing import Final

_SHOWN: Final = 60  # characters of one name


def plain(text: str, *, longest: int = _SHOWN) -> str:
    """The text on one line, without anything that a terminal acts on, and not longer than ``longest`` characters.

    Everything that is not printable becomes a backslash escape: control characters and with them escape sequences, line
    ends of all kinds, surrogates, and the marks that turn the direction of writing.
    """
    shown = text if len(text) <= longest else f"{text[: longest - 3]}..."
    return "".join(letter if letter.isprintable() else _escape(letter) for letter in shown)


def _escape(letter: str) -> str:
    return letter.encode("unicode_escape").decode("ascii")
