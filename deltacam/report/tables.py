"""Tables of an HTML page."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

_LONG_TABLE: Final = 25  # rows: a longer one of those that few people read is folded


def table(
    heads: Sequence[str], rows: Sequence[Sequence[str]], *, numbers: Iterable[int] = (), fold: bool = True
) -> str:
    """A table of cells that are HTML already, the first of each row its heading.

    ``numbers`` are the columns that are set to the right; ``fold`` is whether a long table has to be opened.
    """
    style = [' class="n"' if column in set(numbers) else "" for column in range(len(heads))]
    head = "".join(f'<th scope="col"{of}>{name}</th>' for name, of in zip(heads, style, strict=True))
    lines = []
    for first, *others in rows:
        cells = "".join(f"<td{of}>{cell}</td>" for cell, of in zip(others, style[1:], strict=True))
        lines.append(f'<tr><th scope="row"{style[0]}>{first}</th>{cells}</tr>\n')
    body = f"<thead><tr>{head}</tr></thead>\n<tbody>\n{''.join(lines)}</tbody>"
    whole = f'<div class="table" tabindex="0"><table>{body}</table></div>'
    if fold and len(rows) > _LONG_TABLE:
        return f"<details><summary>{len(rows)} rows</summary>{whole}</details>"
    return whole
