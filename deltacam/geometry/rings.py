"""Measures of many curves at once, and their points along arcs."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.geometry.pack import Pack
from deltacam.model import Array, BoolArray, IntArray

_BATCH: Final = 4096

_MOST: Final = 10_000
"""Pieces of an arc; only circles with a radius of more than 20 m would need more for a micrometre."""


def signed_areas(pack: Pack) -> Array:
    """The area that each curve encloses, closed by a straight line where it is open, (M,) m2; see ``curve``.

    Positive where it runs counter-clockwise.
    """
    counts = pack.counts
    arm = pack.points - np.repeat(pack.points[pack.first[:-1]], counts, axis=0)
    step, chord = pack.chords()
    twice = arm[:, 0] * step[:, 1] - arm[:, 1] * step[:, 0]
    turn = 4.0 * np.arctan(pack.bulges)
    small = np.abs(turn) < 1e-2
    safe = np.where(small, 1.0, turn)
    factor = np.where(
        small, turn / 12.0 * (1.0 + turn**2 / 30.0), (safe - np.sin(safe)) / (8.0 * np.sin(safe / 2.0) ** 2)
    )
    return np.asarray(np.add.reduceat(0.5 * twice + chord**2 * factor, pack.first[:-1]))


def segment_lengths(pack: Pack) -> Array:
    """The length of the segment that begins at each vertex, (P,) m; inf where none does."""
    _, chord = pack.chords()
    reach = chord / np.sinc(2.0 * np.arctan(pack.bulges) / np.pi)
    reach[(pack.first[1:] - 1)[~pack.closed]] = np.inf
    return np.asarray(reach)


def reverse(pack: Pack, which: BoolArray) -> Pack:
    """The closed curves, those of ``which``, (M,), run the other way; each keeps its first point."""
    curve = np.repeat(np.arange(len(pack)), pack.counts)
    offset = np.arange(len(pack.points)) - pack.first[curve]
    counts = pack.counts[curve]
    turned = which[curve]
    vertex = np.where(turned, pack.first[curve] + (-offset) % counts, np.arange(len(pack.points)))
    leaving = np.where(turned, pack.first[curve] + (-offset - 1) % counts, np.arange(len(pack.points)))
    bulges = np.where(turned, -pack.bulges[leaving], pack.bulges[leaving])
    return Pack(pack.points[vertex], bulges, pack.first, pack.closed)


def flatten(pack: Pack, sagitta: float) -> tuple[Array, IntArray]:
    """Points along the curves, and which curve each is on: (N, 2) m and (N,).

    The vertices are among them; a chord between neighbours leaves its arc by no more than ``sagitta`` m, and a piece
    of an arc turns by no more than a quarter. A closed curve does not repeat its first point.
    """
    parts = [_flattened(pack.take(which), sagitta) for which in batches(len(pack))]
    points = np.concatenate([np.zeros((0, 2)), *(part[0] for part in parts)])
    curve = [part[1] + k * _BATCH for k, part in enumerate(parts)]
    return points, np.concatenate([np.zeros(0, dtype=np.int64), *curve])


def batches(count: int) -> list[IntArray]:
    """The indices of ``count`` curves in batches that keep what is worked out on the way small."""
    return [np.arange(first, min(first + _BATCH, count)) for first in range(0, count, _BATCH)]


def _flattened(pack: Pack, sagitta: float) -> tuple[Array, IntArray]:
    """What ``flatten`` returns, in one go."""
    step, chord = pack.chords()
    turn = 4.0 * np.arctan(pack.bulges)
    half = 0.5 * np.abs(turn)
    radius = 0.5 * np.divide(chord, np.sin(half), out=np.zeros_like(chord), where=half > 0.0)
    rise = np.divide(sagitta, radius, out=np.full_like(radius, 2.0), where=radius > 0.0)
    piece = np.minimum(2.0 * np.arccos(np.clip(1.0 - rise, -1.0, 1.0)), 0.5 * np.pi)
    pieces = np.clip(np.ceil(2.0 * half / np.maximum(piece, 1e-9)), 1.0, _MOST).astype(np.int64)
    vertex = np.repeat(np.arange(len(chord)), pieces)
    index = np.arange(len(vertex)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    curve = np.repeat(np.repeat(np.arange(len(pack)), pack.counts), pieces)
    points = pack.points[vertex]
    inner = np.flatnonzero(index)
    at = vertex[inner]
    # The chord to a point of the arc that has turned by b leaves the whole chord by (turn - b) / 2 to the right.
    part = turn[at] * index[inner] / pieces[at]
    swing = 0.5 * (part - turn[at])
    share = np.sin(0.5 * part) / np.sin(0.5 * turn[at])
    cos, sin = share * np.cos(swing), share * np.sin(swing)
    points[inner, 0] += cos * step[at, 0] - sin * step[at, 1]
    points[inner, 1] += sin * step[at, 0] + cos * step[at, 1]
    return points, curve


def both(one: Pack, other: Pack) -> Pack:
    """The curves of two packs."""
    return Pack(
        np.concatenate([one.points, other.points]),
        np.concatenate([one.bulges, other.bulges]),
        np.concatenate([one.first, len(one.points) + other.first[1:]]),
        np.concatenate([one.closed, other.closed]),
    )


def full(points: Array, curve: IntArray) -> tuple[Array, IntArray]:
    """The points and curves of ``flatten`` of closed curves, with as many points as a ring needs.

    Returns:
        the points, (N, 2) m, and the curve of each, (N,); a curve that is too short has its last point several times.
    """
    counts = np.bincount(curve)
    last = np.cumsum(counts) - 1
    shut = (points[last] == points[last - counts + 1]).all(axis=1)
    short = np.flatnonzero((counts < 3) | ((counts == 3) & shut))
    if not len(short):
        return points, curve
    at = np.repeat(last[short], 4 - counts[short])
    return np.insert(points, at, points[at], axis=0), np.insert(curve, at, curve[at])
