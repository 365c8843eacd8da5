"""How the controller moves the joints between the ticks."""

from __future__ import annotations

import numpy as np

from deltacam.model import Array, IntArray
from deltacam.robot.robot import Controller


def between(controller: Controller, q: Array, rows: IntArray, share: float) -> Array:
    """The joint angles at ``share`` of the way in time from ``rows`` (M,) of ``q`` to the next rows, (M, 3) rad.

    Linear: on the straight line between them. Cubic: Hermite curves whose slopes are central differences; before the
    first row and after the last one the angles stay as they are.
    """
    here, there = q[rows], q[rows + 1]
    if controller.interpolation == "linear":
        return np.asarray(here + share * (there - here))
    leave, arrive = _slopes(q, rows)
    u = share
    blend = u**2 * (3.0 - 2.0 * u)
    return np.asarray(here + blend * (there - here) + u * (1.0 - u) ** 2 * leave - u**2 * (1.0 - u) * arrive)


def peaks(controller: Controller, q: Array) -> tuple[Array, Array]:
    """The largest speed and acceleration of every joint from each tick to the next, in closed form.

    A Hermite curve has the slope m0 + b u + c u^2 with b = 6 d - 4 m0 - 2 m1 and c = 3 (m0 + m1) - 6 d, d being the
    step and m0, m1 the slopes at its ends: it is largest at an end or where b + 2 c u = 0, and its own slope at an end.

    Args:
        controller: whose interpolation is cubic.
        q: (N, 3) rad.

    Returns:
        (N - 1, 3) rad/s and (N - 1, 3) rad/s^2.
    """
    m0, m1 = _slopes(q, np.arange(len(q) - 1))
    step = np.diff(q, axis=0)
    b, c = 6.0 * step - 4.0 * m0 - 2.0 * m1, 3.0 * (m0 + m1) - 6.0 * step
    at = np.clip(np.divide(-b, 2.0 * c, out=np.zeros_like(b), where=c != 0.0), 0.0, 1.0)
    speed = np.maximum(np.maximum(np.abs(m0), np.abs(m1)), np.abs(m0 + at * (b + at * c)))
    acceleration = np.maximum(np.abs(b), np.abs(b + 2.0 * c))
    return speed * controller.rate_hz, acceleration * controller.rate_hz**2


def _slopes(q: Array, rows: IntArray) -> tuple[Array, Array]:
    """Central differences at ``rows`` and at the rows after them, per tick; the ends are held."""
    leave = (q[rows + 1] - q[np.maximum(rows - 1, 0)]) / 2.0
    arrive = (q[np.minimum(rows + 2, len(q) - 1)] - q[rows]) / 2.0
    return leave, arrive
