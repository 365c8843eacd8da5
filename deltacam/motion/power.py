"""The power of the laser at every tick: by what the tool does there, and by how fast it truly is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from deltacam.model import Array, BlockKind, IntArray, PowerLaw, Process
from deltacam.motion.sample import halfway

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

DECIMALS: Final = 3
"""Powers that follow the speed are whole thousandths of the rated power: no laser is set more finely."""

_OFF: Final = frozenset({BlockKind.RAPID, BlockKind.TAB, BlockKind.LEAD_OUT})


def powers(q: Array, block: IntArray, kinds: Sequence[BlockKind], *, robot: Robot, process: Process) -> Array:
    """The power of the laser from every tick to the next, (N,) of its rated power.

    Pierces have the power of the process for piercing. What moves has the power of the cut or of engraving, or follows
    the speed v of the tool by the process's power law, P0 + (P1 - P0) (v / feed)^n, where the feed is that of the
    process, also where the cut itself is run more slowly by a rule.

    Args:
        q: (N, 3) rad, the setpoints.
        block: (N,) index into ``kinds``.
        kinds: what every block does.
        robot: the machine.
        process: how to cut.
    """
    full = np.array([_full(kind, process) for kind in kinds])[block]
    if process.power_law is None:
        return full
    feeds = np.array([_feed(kind, process) for kind in kinds])[block]
    followed = _followed(process.power_law, full, tool_speeds(q, robot) / feeds)
    return np.where((full > 0.0) & np.isfinite(feeds), followed, full)


def tool_speeds(q: Array, robot: Robot) -> Array:
    """The mean speed of the tool from every tick to the next as the controller interpolates, (N,) m/s; the last is 0.

    The way between two ticks is taken as two chords, by way of the tool half-way between them.
    """
    ticks, middles = robot.forward(q), robot.forward(halfway(q, robot))
    way = np.linalg.norm(middles - ticks[:-1], axis=1) + np.linalg.norm(ticks[1:] - middles, axis=1)
    return np.append(way * robot.controller.rate_hz, 0.0)


def _followed(law: PowerLaw, full: Array, share: Array) -> Array:
    """The power by the law where ``full`` (N,) is that at the feed, and ``share`` (N,) how much of it the speed is."""
    least = law.at_rest * full
    power = np.round(least + (full - least) * np.minimum(share, 1.0) ** law.exponent, DECIMALS)
    return np.asarray(np.minimum(np.maximum(power, law.lowest), full))


def _full(kind: BlockKind, process: Process) -> float:
    """The power of a kind of block, at the feed where it moves."""
    if kind in _OFF:
        return 0.0
    if kind is BlockKind.ENGRAVE:
        return process.engrave_power or 0.0
    if kind is BlockKind.PIERCE and process.pierce_power is not None:
        return process.pierce_power
    return process.power


def _feed(kind: BlockKind, process: Process) -> float:
    """The speed at which a kind of block has its full power, m/s; infinite where the power does not follow a speed."""
    if kind is BlockKind.PIERCE or kind in _OFF:
        return np.inf
    return (process.engrave_feed or np.inf) if kind is BlockKind.ENGRAVE else process.feed
