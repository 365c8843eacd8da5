"""Bounds of what a pose is like over a whole cell, a box of poses, from the pose at its middle.

A cell holds the points c + d with |d_x| <= h_x and so on; h is its half side, and rho = |h| its half diagonal. In the
notation of `deltacam.robot.arms`, with hyp = sqrt(D) and r = (x, y, z) from the base joint to the effector's joint,
seen from one arm:

- A linear term G.d is at most |G_x| h_x + |G_y| h_y + |G_z| h_z, its *span*.
- hyp is the length of (x, z), a norm: it is convex, so it lies above its tangent plane, and because sqrt is concave
  it is at most rho^2 / (2 hyp) above it. k(c + d) = k + r.d / La + |d|^2 / (2 La) exactly.
  So hyp - k and hyp + k, whose smaller one is the reach margin times La, are known to second order.
- t^2 = D - k^2 = t_c^2 + (2 (x, 0, z) - 2 k r / La).d + d_x^2 + d_z^2 - k |d|^2 / La - (k(c + d) - k)^2 exactly, which
  bounds t from below and above; so does the product (hyp - k)(hyp + k).
- The forearm S = P - C(q) changes by dS = (1 - b g^T) dP with g = S / (S.b) the gradient of the joint angle. With
  |b| = La, |S| = Lb and S.b = La t this is 1 less a projection along b, whose norm, as that of the projection itself,
  is |b||S| / (S.b) = Lb / t. The forearm, of length Lb, therefore turns by at most rho / t_low.
- The joint angle is q + g.d + d.H d / 2 with the curvature H of `kinematics.joint_curvatures` somewhere on the way,
  H = (A - B) / (La t) with A = (1 - b g^T)^T (1 - b g^T), |A| = (Lb / t)^2, and B = La (La - k) g g^T,
  |B| = |La - k| Lb^2 / (La t^2); A has no negative eigenvalue, and B none of one sign.
- mu1: cos mu1 = t / Lb. Swing: sin = |y| / Lb, and y is linear.
- mu2 is the angle between S_i and the normal n of the plane of the other two, S_j and S_k. With unit vectors,
  n.s_j = n.s_k = 0 gives dn = -(n.ds_j) s_j* - (n.ds_k) s_k* with the dual basis in the plane, whose vectors are
  1 / sin(s_j, s_k) long. So n turns by at most (turn_j + turn_k) / sin, where sin is the smallest on the way, and mu2
  changes by at most this and turn_i.
- The rows of the inverse Jacobian are the g_i, which change by at most |H_i| rho; singular values change by at most
  the norm of the change of the matrix (Weyl 1912), which is at most its Frobenius norm.
- |q'''| along a straight line is bounded term by term from `kinematics.third_derivative`: S.b q''' = 3 S'.S'' -
  3 (S.db/dq) q' q'' + S.b q'^3 with |S'| <= Lb / t and S'' = -b q'' - db/dq q'^2. `matrix_bounds` makes of it bounds of
  mu2 and of the condition number to second order, which are far closer where cells are small.

All of it is exact arithmetic; `margins` adds an allowance for rounding.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from deltacam.model import Array, BoolArray
from deltacam.robot.arms import Arms, forearm_vectors, loop_constant, machine_vectors, seen_from_arms
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.region.matrix_bounds import MatrixBounds, matrix_bounds

_SINGULAR: Final = 1e-4  # of the inverse condition number: below it a matrix is not inverted
STEADY: Final = 1e-3
"""Of the forearm: where t is not above it throughout a cell, mu1 may pass 89.94 degrees and nothing else is bounded."""


class Interval(NamedTuple):
    """The smallest and the largest that a quantity can be over every cell; at the middle it is ``at``."""

    at: Array
    low: Array
    high: Array


@dataclass(frozen=True, slots=True, eq=False)
class PoseBounds:
    """What the poses of N cells are like.

    Attributes:
        reach: the reach margin of every arm, (N, 3), and the depth below the base by the upper arm.
        steady: whether every arm drives the tool well throughout the cell, (N,); the rest says nothing where not.
        angle: joint angles, (N, 3) rad.
        along: cos mu1 = t / Lb, (N, 3).
        aside: |y| / Lb, the sine of the forearm's swing, (N, 3).
        mu2: (N, 3) rad, 0 to pi; above pi/2 on the other side of the parallel singularity.
        inverse_condition: (N,), 0 to 1; nan where it was left out.
    """

    reach: Interval
    steady: BoolArray
    angle: Interval
    along: Interval
    aside: Interval
    mu2: Interval
    inverse_condition: Interval


def pose_bounds(geometry: DeltaGeometry, centres: Array, half: Array, *, conditioned: bool = True) -> PoseBounds:
    """What the poses of cells about ``centres`` (N, 3) m with half sides ``half`` (3,) m are like.

    With half sides of 0 every interval is the value at the point, and the condition number may be left out: it is half
    of the work. Points out of reach are allowed.
    """
    cells = _Cells.of(geometry, centres, half)
    La, Lb, x, y, z, k = geometry.upper_arms, geometry.forearms, cells.x, cells.y, cells.z, cells.k
    reach, t = cells.reach()
    usable = np.where(t.at > 0.0, t.at, Lb)  # the values of arms out of reach are not used
    D = np.where(cells.hyp > 0.0, cells.hyp, 1.0) ** 2
    arms = Arms(x, y, z[:, :1], k, usable, (x * k - z * usable) / D, -(z * k + x * usable) / D)
    forearms = forearm_vectors(geometry, arms)
    gradients = forearms / (La * usable)[:, :, np.newaxis]
    floor = np.maximum(t.low, STEADY * Lb)
    bend = cells.curvature(floor)
    steady = (t.low > STEADY * Lb).all(axis=1) & (reach.low.min(axis=1) > 0.0)
    angle = np.arctan2(arms.sin, arms.cos)
    turn = np.abs(gradients) @ cells.half + 0.5 * bend * cells.rho**2
    aside, shift = np.abs(y), cells.span(np.zeros_like(x), 1.0, np.zeros_like(x))
    mu2 = _mu2(geometry, forearms / Lb[:, np.newaxis], cells.rho / floor)
    if conditioned or cells.rho > 0.0:
        condition = _inverse_condition(gradients, np.linalg.norm(bend, axis=1) * cells.rho)
    else:
        condition = Interval(*np.full((3, len(centres)), np.nan))
    if cells.rho > 0.0:
        third = cells.third_derivative(floor, bend)
        sharp = _sharpen(geometry, arms, gradients, third, half, steady & (condition.at > _SINGULAR))
        mu2 = _sharper_mu2(mu2, La * t.low / Lb, La * t.high / Lb, sharp)
        low, high = np.maximum(condition.low, sharp.low), np.minimum(condition.high, sharp.high)
        condition = Interval(condition.at, low, high)
    return PoseBounds(
        reach=reach,
        steady=steady,
        angle=Interval(angle, angle - turn, angle + turn),
        along=Interval(t.at / Lb, t.low / Lb, np.minimum(t.high / Lb, 1.0)),
        aside=Interval(aside / Lb, np.maximum(aside - shift, 0.0) / Lb, (aside + shift) / Lb),
        mu2=mu2,
        inverse_condition=condition,
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Cells:
    """N cells seen from the arms: half sides (3,) m, their length, and of every middle x, y, z, hyp and k (N, 3)."""

    geometry: DeltaGeometry
    half: Array
    rho: float
    x: Array
    y: Array
    z: Array
    hyp: Array
    k: Array

    @classmethod
    def of(cls, geometry: DeltaGeometry, centres: Array, half: Array) -> _Cells:
        x, y, z = seen_from_arms(geometry, centres)
        z = np.broadcast_to(z, x.shape)
        k = loop_constant(geometry, x, y, z)
        return cls(geometry, half, float(np.linalg.norm(half)), x, y, z, np.hypot(x, z), k)

    def span(self, along: Array, across: Array | float, upwards: Array) -> Array:
        """The largest that a linear term can be whose gradient has these components along u_i, w_i and z: (N, 3)."""
        return np.asarray(np.abs(machine_vectors(self.geometry, along, across, upwards)) @ self.half)

    def reach(self) -> tuple[Interval, Interval]:
        """The margins of the reach, (N, 4): of every arm, and the depth below the base; and t, (N, 3) m."""
        La, rho, hyp, k = self.geometry.upper_arms, self.rho, self.hyp, self.k
        whole = np.where(hyp > 0.0, hyp, 1.0)
        ex, ez, kx, ky, kz = self.x / whole, self.z / whole, self.x / La, self.y / La, self.z / La
        far, near = hyp - k, hyp + k
        far_span, near_span = self.span(ex - kx, -ky, ez - kz), self.span(ex + kx, ky, ez + kz)
        drop = rho**2 / (2.0 * La)
        rise = np.minimum(rho**2 / (2.0 * whole), 2.0 * rho)
        low = np.stack((far - far_span - drop, near - near_span))
        high = np.stack((far + far_span + rise, near + near_span + rise + drop))
        deep = Interval(-self.z[:, :1], -self.z[:, :1] - self.half[2], -self.z[:, :1] + self.half[2])
        margins = Interval(np.minimum(far, near), low.min(axis=0), high.min(axis=0))
        scaled = (np.hstack((arms, depth)) / np.append(La, La.min()) for arms, depth in zip(margins, deep, strict=True))
        return Interval(*scaled), self._drive(far * near, low, high, self.span(kx, ky, kz) + drop)

    def _drive(self, square: Array, low: Array, high: Array, change: Array) -> Interval:
        """The drive t by its square, bounds of hyp - k and hyp + k, and the largest change of k; 0 out of reach."""
        La, rho, x, y, z, k = self.geometry.upper_arms, self.rho, self.x, self.y, self.z, self.k
        slope = self.span(2.0 * (x - k * x / La), -2.0 * k * y / La, 2.0 * (z - k * z / La))
        least = square - slope - change**2 - np.maximum(k, 0.0) * rho**2 / La
        most = square + slope + rho**2 + np.maximum(-k, 0.0) * rho**2 / La
        product = np.maximum(low, 0.0).prod(axis=0)
        bounds = square, np.maximum(least, product), np.minimum(most, np.maximum(high, 0.0).prod(axis=0))
        return Interval(*(np.sqrt(np.maximum(value, 0.0)) for value in bounds))

    def curvature(self, t: Array) -> Array:
        """The largest |H| of every joint while its t is not below ``t``, (N, 3) rad/m^2."""
        La, Lb = self.geometry.upper_arms, self.geometry.forearms
        change = self.span(self.x / La, self.y / La, self.z / La) + self.rho**2 / (2.0 * La)
        stretch = (Lb / t) ** 2
        positive = np.maximum(La - self.k + change, 0.0) * stretch / La
        negative = np.maximum(self.k + change - La, 0.0) * stretch / La
        return np.asarray(np.maximum(stretch + negative, positive) / (La * t))

    def third_derivative(self, t: Array, bend: Array) -> Array:
        """The largest third derivative of every joint while t >= ``t`` and |H| <= ``bend``, (N, 3) rad/m^3."""
        La, Lb = self.geometry.upper_arms, self.geometry.forearms
        change = self.span(self.x / La, self.y / La, self.z / La) + self.rho**2 / (2.0 * La)
        slope = Lb / (La * t)
        turned = 3.0 * (np.abs(La - self.k) + change) * slope * bend
        return np.asarray((3.0 * (Lb / t) * (bend + slope**2) + turned + t * slope**3) / t)


def _sharpen(
    geometry: DeltaGeometry, arms: Arms, gradients: Array, third: Array, half: Array, which: BoolArray
) -> MatrixBounds:
    """`matrix_bounds` of the cells ``which`` (N,); nothing is known of the others."""
    La = geometry.upper_arms
    b = -machine_vectors(geometry, La * arms.sin, 0.0, La * arms.cos)[which]
    g = gradients[which]
    moved = np.eye(3) - b[..., :, np.newaxis] * g[..., np.newaxis, :]
    turned = (La * (La - arms.k[which]))[..., np.newaxis, np.newaxis] * (g[..., :, np.newaxis] * g[..., np.newaxis, :])
    drive = (La * arms.t[which])[..., np.newaxis, np.newaxis]
    found = matrix_bounds(g, (np.swapaxes(moved, -1, -2) @ moved - turned) / drive, third[which], half)
    count = len(which)
    unknown = MatrixBounds(np.zeros(count), np.full(count, np.inf), np.zeros((count, 3)), np.full((count, 3), np.inf))
    for every, known in zip(unknown, found, strict=True):
        every[which] = known
    return unknown


def _sharper_mu2(mu2: Interval, least: Array, most: Array, sharp: MatrixBounds) -> Interval:
    """The bounds of mu2 (N, 3), closer where those of J are; 1 / |row_i| is between ``least`` and ``most``, m/rad."""
    known = (mu2.at < np.pi / 2) & np.isfinite(sharp.longest)  # the sign of det M does not change
    high = np.arccos(np.minimum(least / sharp.longest, 1.0))
    cos = np.divide(most, sharp.shortest, out=np.ones_like(most), where=sharp.shortest > most)
    low = np.arccos(cos)
    return Interval(
        mu2.at,
        np.where(known, np.maximum(mu2.low, low), mu2.low),
        np.where(known, np.minimum(mu2.high, high), mu2.high),
    )


def _mu2(geometry: DeltaGeometry, forearms: Array, turns: Array) -> Interval:
    """mu2 (N, 3) of unit ``forearms`` (N, 3, 3) that turn by up to ``turns`` (N, 3) rad; signed by the side."""
    after, last = forearms[:, [1, 2, 0]], forearms[:, [2, 0, 1]]
    normals = np.cross(after, last)
    sines = np.linalg.norm(normals, axis=2)
    volume = _usual_side(geometry) * np.einsum("nij,nij->ni", forearms, normals)
    across = np.divide(volume, sines, out=np.zeros_like(volume), where=sines > 0.0)
    between = np.arctan2(sines, np.einsum("nij,nij->ni", after, last))
    both = turns[:, [1, 2, 0]] + turns[:, [2, 0, 1]]
    least = np.minimum(np.sin(np.maximum(between - both, 0.0)), np.sin(np.minimum(between + both, np.pi)))
    tilt = np.divide(both, least, out=np.full_like(both, np.inf), where=least > 0.0)
    at = np.arccos(np.clip(across, -1.0, 1.0))
    change = np.where(both > 0.0, turns + tilt, 0.0)
    return Interval(at, np.maximum(at - change, 0.0), np.minimum(at + change, np.pi))


def _usual_side(geometry: DeltaGeometry) -> float:
    """The sign of det[S1 S2 S3] with the tool beneath the elbows: against the sense in which the arms go round."""
    u = geometry.outwards
    after = np.roll(u, -1, axis=0)
    turn = float(np.sum(u[:, 0] * after[:, 1] - u[:, 1] * after[:, 0]))
    return -geometry.up * float(np.sign(turn))


def _inverse_condition(rows: Array, changes: Array) -> Interval:
    """Of matrices ``rows`` (N, 3, 3) that change by up to ``changes`` (N,) in the Frobenius norm."""
    values = np.linalg.svd(rows, compute_uv=False)
    largest, smallest = values[:, 0], values[:, -1]
    below = np.maximum(largest - changes, 0.0)
    high = np.divide(smallest + changes, below, out=np.ones_like(below), where=below > 0.0)
    low = np.maximum(smallest - changes, 0.0) / (largest + changes)
    return Interval(smallest / largest, low, np.minimum(high, 1.0))
