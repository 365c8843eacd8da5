"""Making a damage just as large as it should be."""

from collections.abc import Callable

LARGEST = 1e9  # how much larger than its start a size may become


class NoPlaceError(Exception):
    """A program has no place for a damage: nothing is engraved, no limit of jerk is set."""


def aim(measure: Callable[[float], float], target: float, *, start: float) -> float:
    """The smallest size found at which the measure is ``target``, or up to a thousandth more.

    Args:
        measure: of the damage at a size; continuous, not necessarily increasing.
        target: > 0.
        start: a size to begin with, of the sign of the sizes wanted.

    Raises:
        NoPlaceError: no size is large enough.
    """
    low, high = 0.0, start
    while measure(high) < target:
        low, high = high, 2.0 * high
        if abs(high) > LARGEST * abs(start):
            raise NoPlaceError
    for _ in range(60):
        if measure(high) <= 1.001 * target:
            break
        middle = 0.5 * (low + high)
        if measure(middle) < target:
            low = middle
        else:
            high = middle
    return high
