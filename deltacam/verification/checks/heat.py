"""The check that heat has time to spread between cuts that are near each other."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np

from deltacam.model import BlockKind, Check
from deltacam.verification.checks.measure import at_most
from deltacam.verification.evidence import KINDS, Evidence

NAME: Final = "time for heat to spread"

_RAPID: Final = KINDS.index(BlockKind.RAPID)


def time_to_spread(evidence: Evidence) -> Check:
    """Between two cuts that are nearer than the process says, the laser is off for as long as it says.

    That is from where the tool leaves a cut to where the next one, or its pierce, begins.
    """
    heat, limit = evidence.program.process.heat, 0.5e3 / evidence.rate
    if heat is None:
        return Check(NAME, True, limit=limit, unit="ms missing")
    missing, ticks = [], []
    for one, other in pairwise(evidence.runs):
        between = np.flatnonzero(evidence.kind[one.end : other.begin] == _RAPID) + one.end
        if not len(between):
            continue
        first, last = int(between[0]), int(between[-1]) + 1
        away = float(np.hypot(*(evidence.sheet[last] - evidence.sheet[first])))
        if away < heat.distance:
            missing.append(1e3 * (heat.time - (last - first) / evidence.rate))
            ticks.append(last)
    return at_most(evidence, NAME, np.array(missing), limit, "ms missing", ticks=np.array(ticks, dtype=np.int64))
