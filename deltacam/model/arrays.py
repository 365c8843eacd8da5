"""Arrays as the stages pass them on: read-only copies of finite numbers."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]


def readonly(values: npt.ArrayLike, *, columns: int | None = None) -> Array:
    """A read-only float copy of ``values``: (N,), or (N, columns) where ``columns`` is given.

    Raises:
        ValueError: another shape, or a value that is not finite.
    """
    array = np.array(values, dtype=np.float64)
    if columns is None and array.ndim != 1:
        raise ValueError(f"expected shape (N,), got {array.shape}")
    if columns is not None and (array.ndim != 2 or array.shape[1] != columns):
        raise ValueError(f"expected shape (N, {columns}), got {array.shape}")
    if not np.isfinite(array).all():
        raise ValueError("values must be finite")
    array.flags.writeable = False
    return array
