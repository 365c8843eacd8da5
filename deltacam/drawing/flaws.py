"""What a person should know about how the lines of a drawing meet, with the place of each flaw."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Final

from deltacam.geometry.pack import Pack
from deltacam.model import Array, Finding
from deltacam.units import to_mm

Name = Callable[[int], str]
"""How messages name a curve, by its index: ``layer CUT, LINE #2F``."""

NEAR: Final = 2e-3
"""The ends of an open chain that are closer than this, m, are named as a gap: a micro-joint, or a mistake."""

APART: Final = 5e-4
"""Ends of two chains that are closer than this, m, are named as a gap between them."""

MOST: Final = 200
"""So many findings of a kind are listed; the last one counts the others."""

_BRANCH_HINT: Final = "lines that could be closed in more than one way stay open: draw each outline for itself"


def point_mm(point: Array) -> str:
    """A place for messages: ``(12.000, 3.500)``, mm."""
    return f"({to_mm(float(point[0])):.3f}, {to_mm(float(point[1])):.3f})"


def place(point: Array) -> tuple[float, float]:
    """A place for findings, m."""
    return float(point[0]), float(point[1])


def limited(findings: Sequence[Finding], total: int | None = None) -> list[Finding]:
    """Findings of one kind, no more than ``MOST``; one more counts the rest of the ``total``, and blocks as they do."""
    total = max(len(findings), total or 0)
    listed = list(findings[:MOST])
    if total > len(listed):
        last = replace(listed[-1], what=f"and {total - len(listed)} more like this", where="", place=None)
        listed.append(replace(last, blocks=any(finding.blocks for finding in findings)))
    return listed


def branches(places: Array) -> list[Finding]:
    """One finding per place, (K, 2) m, where more than two lines meet."""
    found = [
        Finding(
            "more than two lines meet",
            where=f"{point_mm(point)} mm",
            hint=_BRANCH_HINT,
            kind="branch",
            place=place(point),
        )
        for point in places[: MOST + 1]
    ]
    return limited(found, len(places))


def gap(size: float, point: Array, where: str) -> Finding:
    """The finding that a line does not close, or does not meet the next one, by ``size`` m."""
    what = f"gap of {to_mm(size):.3g} mm at {point_mm(point)} mm"
    hint = "close it in the drawing, or join wider gaps, if it is not meant to be open"
    return Finding(what, where=where, hint=hint, kind="gap", place=place(point))


def between(ends: Array, chain_of: Sequence[int], curve_of: Sequence[int], joining: float, name: Name) -> list[Finding]:
    """Gaps where ends of two chains nearly meet, each end being the nearest to the other.

    Args:
        ends: (E, 2) m, the free ends.
        chain_of: the chain of each.
        curve_of: a curve of each chain.
        joining: ends up to this distance, m, would have been joined.
        name: how messages name a curve.
    """
    if len(ends) < 2:
        return []
    from scipy.spatial import cKDTree

    distance, nearest = cKDTree(ends).query(ends, k=2, distance_upper_bound=APART)
    found = []
    for i, (size, j) in enumerate(zip(distance[:, 1].tolist(), nearest[:, 1].tolist(), strict=True)):
        if i < j < len(ends) and nearest[j, 1] == i and size > joining and chain_of[i] != chain_of[j]:
            found.append(gap(size, ends[i], name(curve_of[chain_of[i]])))
    return limited(found)


def joined(places: Array, apart: Array, curve_of: Sequence[int], name: Name) -> list[Finding]:
    """The findings that ends were joined because the user allows it: (N, 2) m, how far apart, (N,) m, and a curve."""
    return limited(
        [
            Finding(f"joined over {to_mm(size):.3g} mm as --join says", name(i), kind="joined", place=place(point))
            for point, size, i in zip(places, apart.tolist(), curve_of, strict=True)
        ]
    )


def copies(later_to_first: Mapping[int, int], found: Pack, name: Name) -> list[Finding]:
    """One finding per curve that others repeat."""
    groups: dict[int, list[int]] = {}
    for later, first in sorted(later_to_first.items()):
        groups.setdefault(first, []).append(later)
    findings = []
    for first in sorted(groups):
        others = groups[first]
        again = f"{name(others[0])} draws" if len(others) == 1 else f"{len(others)} others draw"
        what = f"drawn more than once, machined once: {again} the same line"
        at = place(found.points[found.first[first]])
        findings.append(Finding(what, where=name(first), kind="duplicate", place=at))
    return limited(findings)


def slivers(lines: Sequence[tuple[Array, str]]) -> list[Finding]:
    """One finding per closed line that encloses nothing, given a point of it, (2,) m, and its name."""
    what = "a closed line that encloses nothing counts as an open one"
    return limited([Finding(what, where=where, kind="sliver", place=place(point)) for point, where in lines])


def tiny(dropped: Sequence[int], kept: int, found: Pack, name: Name) -> list[Finding]:
    """The finding that counts lines shorter than 0.01 mm: those left out, and those kept as parts of longer lines."""
    count = len(dropped) + kept
    if not count:
        return []
    what = f"{'1 line is' if count == 1 else f'{count} lines are'} shorter than 0.01 mm"
    if not dropped:
        return [Finding(f"{what}: kept as part of longer lines", kind="tiny")]
    left = f"{len(dropped)} of them left out" if kept else "left out"
    at = place(found.points[found.first[dropped[0]]])
    return [Finding(f"{what}: {left}", where=name(dropped[0]), kind="tiny", place=at)]
