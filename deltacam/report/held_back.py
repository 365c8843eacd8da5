"""What holds a program back, in words and as rows of a table: what to change to make it faster."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from deltacam.model import Held

HEADS: Final = ("contour", "time, s", "at its limit, share of the time", "time without it, s")
"""Of the columns of `rows`."""

_LEAST: Final = 0.005  # of the time; less is not worth a word
_MOST: Final = 3


def in_words(held: Sequence[Held]) -> str:
    """The limits that bind for most of the time along all contours, and what leaving them out would save."""
    time = sum(one.time for one in held)
    bound = _summed(one.bound for one in held)
    shares = [f"{name} {100.0 * seconds / time:.0f} %" for name, seconds in _largest(bound) if name != "none"]
    saved = _summed({name: one.time - less for name, less in one.without.items()} for one in held)
    faster = [f"{name} {time - seconds:.3g} s" for name, seconds in _largest(saved)]
    words = f"{', '.join(shares[:_MOST])} of {time:.4g} s along contours"
    return f"{words}; without {', '.join(faster[:_MOST])}" if faster else words


def rows(held: Sequence[Held]) -> list[list[str]]:
    """A row per contour: its number, its time, what binds for how much of it, and its time without each limit."""
    return [
        [
            str(one.contour),
            f"{one.time:.3f}",
            ", ".join(f"{name} {100.0 * seconds / one.time:.0f} %" for name, seconds in _largest(one.bound)),
            ", ".join(
                f"{name} {seconds:.3f}" for name, seconds in sorted(one.without.items(), key=lambda item: item[1])
            ),
        ]
        for one in held
    ]


def _summed(parts: Iterable[Mapping[str, float]]) -> dict[str, float]:
    """By kind: the three joints together."""
    total: defaultdict[str, float] = defaultdict(float)
    for part in parts:
        for name, seconds in part.items():
            joint = name.startswith("joint ") and name[6].isdigit()
            total[f"joint {name[8:]}" if joint else name] += seconds
    return total


def _largest(values: Mapping[str, float]) -> list[tuple[str, float]]:
    """The values that matter, the largest first."""
    least = _LEAST * sum(values.values())
    return sorted(((name, value) for name, value in values.items() if value > least), key=_by_value, reverse=True)


def _by_value(item: tuple[str, float]) -> float:
    return item[1]
