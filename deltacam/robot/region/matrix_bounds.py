"""Bounds of the inverse Jacobian M over cells, to second order: its condition number, and mu2.

M(c + d) = M + E with E = L(d) + R. Row i of L(d) is H_i d with the curvature H_i at the middle, and row i of R is at
most T_i rho^2 / 2 with T_i the largest third derivative of the joint angle (a symmetric trilinear form is largest with
three equal arguments: Banach 1938). Its inverse J(c + d) = J - J E J + J E J E J - ..., the series of Neumann, so

    |J(c + d) - (J - J L(d) J)| <= |J|^2 |R| + |J|^3 |E|^2 / (1 - |J| |E|)      where |J| |E| < 1,

and there det M keeps its sign. |M + L(d)| and |J - J L(d) J| are norms of functions that are linear in d, which makes
them convex: over a cell they are largest at one of its eight corners. What is wanted is made of such norms:
1 / cond = 1 / (|M| |J|); and as M J = 1, row i of M and column i of J give 1 / cos mu2_i = |row_i| |column_i|, since
row i lies along forearm i and column i along the normal of the plane of the other two; |row_i| = Lb / (La t).
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from deltacam.model import Array

_CORNERS: Final = np.stack(np.meshgrid(*[[-1.0, 1.0]] * 3, indexing="ij"), axis=-1).reshape(8, 3)


class MatrixBounds(NamedTuple):
    """What M is like over N cells.

    Attributes:
        inverse_condition: the smallest, (N,); 0 where nothing is known.
        column: the largest length of every column of J, (N, 3) m/rad; infinite where nothing is known.
    """

    inverse_condition: Array
    column: Array


def matrix_bounds(rows: Array, curvatures: Array, third: Array, half: Array) -> MatrixBounds:
    """Bounds of the matrices ``rows`` over cells.

    Args:
        rows: M at the middles, (N, 3, 3), none singular.
        curvatures: H_i at the middles, (N, 3, 3, 3).
        third: the largest third derivative of every joint over the cells, (N, 3) rad/m^3.
        half: half of the sides of every cell, (3,) m.

    Returns:
        The bounds.
    """
    rho = float(np.linalg.norm(half))
    rest = 0.5 * rho**2 * np.linalg.norm(third, axis=1)
    inverse: Array = np.linalg.inv(rows).astype(np.float64)
    along = np.moveaxis(curvatures, 3, 1) * half[:, np.newaxis, np.newaxis]  # (N, axis, row, column)
    there = np.einsum("ca,naij->ncij", _CORNERS, along)
    back = inverse[:, np.newaxis] @ there @ inverse[:, np.newaxis]
    change = np.sqrt((there**2).sum(axis=(2, 3)).max(axis=1)) + rest
    size = _norm(inverse)
    part = size * change
    tail = np.where(part < 1.0, size * part**2 / np.maximum(1.0 - part, 1e-9) + size**2 * rest, np.inf)
    turned = inverse[:, np.newaxis] - back
    largest = _norm(rows[:, np.newaxis] + there).max(axis=1) + rest
    column = np.sqrt((turned**2).sum(axis=2).max(axis=1)) + tail[:, np.newaxis]
    return MatrixBounds(1.0 / (largest * (_norm(turned).max(axis=1) + tail)), column)


def _norm(matrices: Array) -> Array:
    """The largest singular value of matrices (..., 3, 3)."""
    square = np.swapaxes(matrices, -1, -2) @ matrices
    return np.asarray(np.sqrt(np.linalg.eigvalsh(square)[..., -1]), dtype=np.float64)
