"""Lines drawn more than once and split at other vertices: cut at each other's vertices, each piece is kept once."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from deltacam.geometry.pack import Pack
from deltacam.model import IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Strands:
    """Open curves, or pieces of curves.

    Attributes:
        pack: M open curves.
        owner: (M,) the curve of the drawing that each is, or is a piece of; ascending.
    """

    pack: Pack
    owner: IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Untangled:
    """What is left when pieces that others cover are taken away.

    Attributes:
        strands: the curves and pieces that are kept.
        copies: curves of the drawing that others cover whole: index to index.
    """

    strands: Strands
    copies: dict[int, int] = field(default_factory=dict)


def untangle(strands: Strands, tangled: Iterable[int]) -> Untangled | None:
    return None
