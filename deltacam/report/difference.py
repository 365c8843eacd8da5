"""The difference of two programs as text and for JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from deltacam.model import Check
from deltacam.plain import plain
from deltacam.report.text import number_in_words
from deltacam.verification.difference import ContourDifference, Difference

_SAME: Final = 1e-3  # um: less is rounding of the setpoints
_MOST: Final = 20  # rows of a part that are shown


def to_text(found: Difference) -> str:
    """The difference as lines of text with a line feed at the end, at most `_MOST` rows of each kind."""
    before, after = found.durations
    lines = ["what is different", f"  time: {before:.4f} s -> {after:.4f} s ({after - before:+.4f} s)"]
    lines += _some([f"  {plain(name)}: {_value(a)} -> {_value(b)}" for name, (a, b) in found.settings.items()])
    checks = [(name, a, b) for name, (a, b) in found.checks.items() if _matters(a, b)]
    lines += _some([f"  {name}: {_verdict(a)} -> {_verdict(b)}" for name, a, b in checks])
    changed = [one for one in found.contours if _differs(one)]
    lines += _some([f"  {_contour(one)}" for one in sorted(changed, key=_size, reverse=True)])
    alike = len(found.contours) - len(changed)
    if alike:
        lines.append(f"  {alike} {'contour is' if alike == 1 else 'contours are'} cut alike")
    return "\n".join(lines) + "\n"


def to_dict(found: Difference) -> dict[str, Any]:
    """The difference as dicts, lists, texts, numbers and None; pairs are lists of two."""
    return {
        "duration_s": list(found.durations),
        "settings": {name: list(pair) for name, pair in found.settings.items()},
        "checks": [
            {
                "name": name,
                "passed": [a and a.passed, b and b.passed],
                "worst": [a and a.worst, b and b.worst],
            }
            for name, (a, b) in found.checks.items()
        ],
        "contours": [
            {
                "contour": one.contour,
                "layer": one.layer,
                "time_s": list(one.times),
                "place": list(one.places),
                "distance_um": None if one.distance is None else one.distance * 1e6,
            }
            for one in found.contours
        ],
    }


def _some(lines: Sequence[str]) -> list[str]:
    more = len(lines) - _MOST
    return [*lines[:_MOST], f"  and {more} more, with --json"] if more > 0 else list(lines)


def _value(value: object) -> str:
    return plain(f"{value:.9g}" if isinstance(value, float) else str(value))


def _matters(a: Check | None, b: Check | None) -> bool:
    """Whether a check is worth a line: other verdicts, or worst values that differ by a thousandth of the limit."""
    if a is None or b is None or a.passed is not b.passed or a.worst is None or b.worst is None:
        return True
    scale = max(abs(value) for value in (a.worst, b.worst, a.limit or 0.0, b.limit or 0.0))
    return abs(a.worst - b.worst) > 1e-3 * scale


def _verdict(check: Check | None) -> str:
    if check is None:
        return "not made"
    worst = "" if check.worst is None else f"{number_in_words(check.worst)} {check.unit}".rstrip()
    return f"{worst} {'ok' if check.passed else 'WARN' if check.warns else 'FAIL'}".lstrip()


def _differs(one: ContourDifference) -> bool:
    return _size(one) > _SAME or one.times[0] != one.times[1] or one.places[0] != one.places[1]


def _size(one: ContourDifference) -> float:
    """How far apart, um; a contour that only one program cuts comes first."""
    return float("inf") if one.distance is None else one.distance * 1e6


def _contour(one: ContourDifference) -> str:
    name = f"contour {one.contour or '?'} (layer {plain(one.layer)})"
    before, after = one.times
    if before is None or after is None:
        return f"{name}: only in the {'second' if before is None else 'first'} program"
    apart = "no positions" if one.distance is None else "the same way"
    if one.distance is not None and _size(one) > _SAME:
        apart = f"{number_in_words(one.distance * 1e6)} um apart"
    moved = "" if one.places[0] == one.places[1] else f", cut as number {one.places[0]} -> {one.places[1]}"
    return f"{name}: {apart}, {before:.4f} s -> {after:.4f} s{moved}"
