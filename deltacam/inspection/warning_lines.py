"""The warnings about a drawing, as lines: what would be refused first, many of a kind as one."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Final

from deltacam.inspection.similar import pattern, summary
from deltacam.model import Finding
from deltacam.plain import plain
from deltacam.units import to_mm

_LONGEST: Final = 600  # characters of one text
_MOST: Final = 14
_FEW: Final = 3  # of a kind, which are listed one by one


def warning_lines(findings: Sequence[Finding], *, width: int) -> list[str]:
    """A paragraph per warning, or per kind of warning where there are many, each line ``width`` characters at most."""
    groups: dict[tuple[bool, str, str], list[Finding]] = {}
    for finding in findings:
        groups.setdefault((not finding.blocks, finding.kind, pattern(finding.what)), []).append(finding)
    listed: list[list[Finding]] = []
    for _, alike in sorted(groups.items(), key=lambda item: item[0][0]):
        listed += [alike] if len(alike) > _FEW else [[finding] for finding in alike]
    lines = [line for alike in listed[:_MOST] for line in _wrapped(_sentence(alike), width)]
    rest = sum(map(len, listed[_MOST:]))
    return [*lines, f"warning: and {rest} more, all of them with --json"] if rest else lines


def _sentence(alike: Sequence[Finding]) -> str:
    """What findings of one kind say, like an error: where, what, hint; of many, those of the first one."""
    first = alike[0]
    mark = "plan will refuse" if first.blocks else "warning"
    what, where = plain(summary(finding.what for finding in alike), longest=_LONGEST), _where(first)
    if len(alike) > 1:
        before = "at" if where.startswith("(") else "on"
        what = f"{len(alike)} times: {what}" + (f", the first time {before} {where}" if where else "")
    elif where:
        what = f"{where}: {what}"
    return f"{mark}: {what}" + (f"; {plain(first.hint, longest=_LONGEST)}" if first.hint else "")


def _where(finding: Finding) -> str:
    """Where it is in words, with the place in the drawing unless the finding itself says it."""
    where = plain(finding.where, longest=_LONGEST)
    if finding.place is None:
        return where
    place = f"({to_mm(finding.place[0]):.3f}, {to_mm(finding.place[1]):.3f})"
    if place in finding.what or place in where:
        return where
    return f"{where} at {place} mm" if where else f"{place} mm"


def _wrapped(sentence: str, width: int) -> list[str]:
    return textwrap.wrap(
        sentence, width, initial_indent="  ", subsequent_indent="    ", break_on_hyphens=False, break_long_words=False
    )
