"""Text from files in HTML and XML."""

from __future__ import annotations

from html import escape

from deltacam.plain import plain


def shown(text: str, *, longest: int = 200) -> str:
    """Text from a file for HTML and XML: on one line, invisible characters spelled out, quotes and all escaped."""
    return escape(plain(text, longest=longest), quote=True)
