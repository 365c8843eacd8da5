"""Mean squares and bounds of the error at the tool, from its closed form.

Every independent error j is uniform within +- L_j, so that its variance is L_j^2 / 3, and it moves the tool by a_j
times itself. The mean square of the tool's distance is the sum of |a_j|^2 L_j^2 / 3. All errors of one arm move the
tool along one line, that in which the other two forearms let it: the farthest it can be is one of the corners of a box
with slanting sides.
"""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np

from deltacam.model import Array
from deltacam.robot.accuracy.sources import PER_ARM, Source, columns_of

AXES: Final = {"in_plane": slice(0, 2), "focus": slice(2, 3), "in_space": slice(0, 3)}
"""The three ways to look at an error: x and y, the height above the sheet, and both together."""

_VARIANCE: Final = 1.0 / 3.0  # of what is uniform in -1 to 1


def mean_squares(by_error: Array, limits: Array, view: str) -> Array:
    """The mean square of the tool's distance that each independent error causes: (N, COUNT) m^2.

    Args:
        by_error: (N, 3, COUNT), see `sensitivity.tool_by_error`.
        limits: of the errors, (COUNT,) rad or m.
        view: a key of `AXES`.
    """
    return np.asarray(np.square(by_error[:, AXES[view]] * limits).sum(axis=1) * _VARIANCE)


def corners(by_error: Array, limits: Array) -> Array:
    """Where the tool is when every error is at one of its limits, the farthest of them: (8, N, 3) m.

    The other eight are on the other side. Arguments as for `mean_squares`.
    """
    lines = by_error[:, :, columns_of(Source.FOREARM)]  # every other error of the arm is along it
    lengths = np.zeros((len(by_error), 3))
    for source in PER_ARM:
        moved = by_error[:, :, columns_of(source)] * limits[columns_of(source)]
        lengths += np.linalg.norm(moved, axis=1)
    sides = lines * (lengths / np.linalg.norm(lines, axis=1))[:, np.newaxis]
    sheet = (by_error * limits)[:, :, columns_of(Source.SHEET)][:, :, 0]
    return np.stack([sheet + sides @ np.array(signs) for signs in product((-1.0, 1.0), repeat=3)])
