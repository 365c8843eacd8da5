"""The places and turns that are looked at: a grid of them, and smaller and smaller steps about the best."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from deltacam.cutting.fitting import Footprint, Places
from deltacam.model import Array, IntArray

if TYPE_CHECKING:
    from deltacam.robot.workspace import Workspace

_GRIDS: Final = ((9, 24), (7, 24), (5, 24), (5, 12), (5, 8), (3, 8))  # places to a side, and turns
_OWN: Final = 3


@dataclass(frozen=True, slots=True, eq=False)
class Trials:
    """Places and turns at which the part is on the sheet.

    Attributes:
        at: (N, 2) m.
        rotation: (N,) rad.
        x: (M,) m, the columns of the grid.
        y: (M,) m, its rows.
        cell: (N,) the place on the grid, row by row; -1 for what is beside it.
        turns: how many turns a full one is divided into.
    """

    at: Array
    rotation: Array
    x: Array
    y: Array
    cell: IntArray
    turns: int

    @property
    def step(self) -> Array:
        """From one place of the grid to the next along x and y, m, and from one turn to the next, rad, (3,)."""
        return np.array([self.x[1] - self.x[0], self.y[1] - self.y[0], 2.0 * np.pi / self.turns])


def grid(part: Footprint, sheet: Workspace, *, most: int) -> Trials:
    """A grid of places and turns that is about as fine as ``most`` trials allow, where the part is on the sheet.

    Turns with little room get a few places of their own, and so does the turn with the most room.
    """
    for side, count in _GRIDS:
        rooms = _rooms(part, sheet, count)
        if side**2 * len(rooms) <= most:
            break
    low = np.min([room.low for _, room in rooms], axis=0)
    high = np.maximum(np.max([room.high for _, room in rooms], axis=0), low + 1e-6)
    x, y = np.linspace(low[0], high[0], side), np.linspace(low[1], high[1], side)
    lattice = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    at, rotation, cell = [], [], []
    for turn, room in rooms:
        share = np.linspace(0.0, 1.0, _OWN)
        own = room.low + (room.high - room.low) * np.stack(np.meshgrid(share, share), axis=-1).reshape(-1, 2)
        places = np.concatenate([lattice, own])
        held = np.flatnonzero(part.holds(sheet, turn, places))
        at.append(places[held])
        rotation.append(np.full(len(held), turn))
        cell.append(np.where(held < len(lattice), held, -1))
    return Trials(np.concatenate(at), np.concatenate(rotation), x, y, np.concatenate(cell), count)


def _rooms(part: Footprint, sheet: Workspace, count: int) -> list[tuple[float, Places]]:
    """The turns with which the part fits, of ``count`` all around and those with the most room, and where it does."""
    best, _ = part.best_turn(sheet)
    turns = np.unique([*(2.0 * np.pi * np.arange(count) / count), best, best + np.pi])
    return [(turn, room) for turn in turns.tolist() if (room := part.places(sheet, turn)).any]


def about(at: Array, rotation: Array, step: Array, part: Footprint, sheet: Workspace) -> tuple[Array, Array]:
    """Places and turns one ``step`` (3,) from the given ones, in x, in y or turned, that are on the sheet."""
    moves = np.concatenate([np.diag(step), -np.diag(step)])
    near = (np.column_stack([at, rotation])[:, None] + moves).reshape(-1, 3)
    held = [bool(part.holds(sheet, float(turn), np.array([[x, y]]))[0]) for x, y, turn in near]
    near = near[np.array(held, dtype=np.bool_)]
    return near[:, :2], near[:, 2] % (2.0 * np.pi)
