"""From a wish to a robot: search, polish, certify."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.region.certify import Certificate, certify
from deltacam.robot.region.requirements import Requirements
from deltacam.robot.region.shapes import Box, Cylinder
from deltacam.robot.synthesis.demands import Demand, bounds_excess, demands, excesses
from deltacam.robot.synthesis.polish import fine_cube, polish, worst_places
from deltacam.robot.synthesis.search import Problem, search
from deltacam.robot.synthesis.shape import BoxShape
from deltacam.robot.synthesis.wish import Wish

Progress = Callable[[str, int, int], None]
"""Called with what is done, how many rounds of it are done, and of how many at most."""

MARGINS: Final = (1e-4, 1e-3, 1e-2)
"""By how much the demands are tightened, in radians or without a unit, until the whole workspace can be certified."""

_MAX_CELLS: Final = 400_000  # of the certifier, per margin
_BINDING: Final = 2.0  # a demand binds where it is missed by less than so many margins
_MET: Final = 1e-9  # an excess that is rounding
_IMPOSSIBLE: Final = 10.0  # objectives of a relaxed problem from here on miss other demands


@dataclass(frozen=True, slots=True)
class Finding:
    """How a design does on one demand.

    Attributes:
        demand: with its name and limit.
        value: the worst that was found in the workspace, in the demand's unit.
        point: where, m.
        binding: whether it is at its limit, up to the margin.
        proved: whether the certificate covers it everywhere; otherwise it was searched for at points.
    """

    demand: Demand
    value: float
    point: tuple[float, float, float]
    binding: bool
    proved: bool


@dataclass(frozen=True, slots=True)
class Design:
    """The smallest robot that was found for a wish.

    Attributes:
        wish: what was asked.
        geometry: the dimensions.
        middle: height of the middle of the workspace, m, < 0.
        findings: one per demand.
        bounds: the bounds on the dimensions that bind, as sentences.
        certificate: that reach, joint range, 1/cond, pressure angles and swing hold everywhere.
        margin: by how much the demands were tightened.
        seed: of the search.
    """

    wish: Wish
    geometry: DeltaGeometry
    middle: float
    findings: tuple[Finding, ...]
    bounds: tuple[str, ...]
    certificate: Certificate
    margin: float
    seed: int

    @property
    def candidate(self) -> Array:
        """R - r, La, Lb and the middle's height, (4,) m."""
        lengths = self.geometry.offsets[0], self.geometry.upper_arms[0], self.geometry.forearms[0]
        return np.array([*lengths, self.middle])

    @property
    def size(self) -> float:
        """(R - r) + La + Lb, m."""
        return float(self.candidate[:3].sum())


def design(wish: Wish, *, seed: int = 0, progress: Progress | None = None, start: Array | None = None) -> Design:
    """The smallest robot that meets a wish everywhere in its workspace, certified.

    Args:
        wish: what is asked.
        seed: of the random numbers of the search; the same seed gives the same design.
        progress: called as the work goes on.
        start: a candidate (4,) to begin near.

    Raises:
        RobotError: no robot was found; which demand cannot be met, and how near it came.
    """
    problem = Problem(wish, demands(wish))
    candidate = search(problem, seed=seed, progress=_stage(progress, "search"), start=start)
    for step, margin in enumerate(MARGINS):
        if progress is not None:
            progress("certify", step, len(MARGINS))
        tightened = Problem(wish, problem.demands, margin)
        found = polish(tightened, candidate)
        if not _met(tightened, found):
            break
        geometry = geometry_of(wish, found)
        certificate = certify(
            geometry, region_of(wish, found[3]), requirements_of(wish), tightness=0.0, max_cells=_MAX_CELLS
        )
        if certificate.certified:
            return _designed(tightened, found, certificate, seed)
    if not _met(problem, polish(problem, candidate)):
        raise _impossible(problem, candidate, seed, progress)
    what = f"the robot that was found could not be certified with its demands tightened by up to {MARGINS[-1]:g}"
    raise RobotError(what, where="demands", hint="ask a little less, or choose another --seed")


def geometry_of(wish: Wish, candidate: Array) -> DeltaGeometry:
    """The dimensions of a candidate (4,), with the smallest radii that leave room for the motors and the head."""
    offset, La, Lb = (float(value) for value in candidate[:3])
    effector = max((wish.base_radius_min or 0.0) - offset, 0.0) if wish.head_radius is None else wish.head_radius
    return DeltaGeometry(max(effector + offset, 0.0), effector, La, Lb)


def region_of(wish: Wish, middle: float) -> Box | Cylinder:
    """The workspace at the height that was found for it."""
    shape, low, high = wish.shape, middle - wish.shape.height / 2.0, middle + wish.shape.height / 2.0
    if isinstance(shape, BoxShape):
        return Box((-shape.width / 2.0, -shape.depth / 2.0, low), (shape.width / 2.0, shape.depth / 2.0, high))
    return Cylinder((0.0, 0.0), shape.diameter / 2.0, low, high)


def requirements_of(wish: Wish) -> Requirements:
    """What the certificate is about."""
    return Requirements(
        joint_min=wish.joint_min,
        joint_max=wish.joint_max,
        max_mu1=wish.max_drive_angle,
        max_mu2=wish.max_transmission_angle,
        max_swing=wish.max_forearm_swing,
        min_inverse_condition=wish.min_inverse_condition,
    )


def _stage(progress: Progress | None, name: str) -> Callable[[int, int], None] | None:
    if progress is None:
        return None
    shown = progress
    return lambda done, total: shown(name, done, total)


def _met(problem: Problem, candidate: Array) -> bool:
    points = problem.wish.shape.place(fine_cube())
    return bool(problem.violations(candidate[np.newaxis], points).max() <= _MET)


_PROVED: Final = (
    "reach_margin",
    "joint_min_deg",
    "joint_max_deg",
    "inverse_condition",
    "transmission_angle_deg",
    "drive_angle_deg",
    "forearm_swing_deg",
)
"""The demands that a certificate covers."""


def _designed(problem: Problem, candidate: Array, certificate: Certificate, seed: int) -> Design:
    wish = problem.wish
    cube = np.vstack((fine_cube(), worst_places(wish, problem.demands, candidate, fine_cube())))
    points = wish.shape.place(cube)
    values = excesses(problem.demands, candidate[np.newaxis], points)[:, 0]
    findings = []
    for demand, row in zip(problem.demands, values, strict=True):
        x, y, z = points[int(row.argmax())]
        worst = float(row.max())
        findings.append(
            Finding(
                demand,
                demand.value(worst),
                (float(x), float(y), float(z + candidate[3])),
                worst > -_BINDING * problem.margin,
                demand.name in _PROVED,
            )
        )
    return Design(
        wish,
        geometry_of(wish, candidate),
        float(candidate[3]),
        tuple(findings),
        _binding_bounds(wish, candidate),
        certificate,
        problem.margin,
        seed,
    )


def _binding_bounds(wish: Wish, candidate: Array) -> tuple[str, ...]:
    sentences = (
        "the size is the largest allowed",
        "the workspace begins at the least distance below the base",
        "the base is as small as its motors allow" if wish.base_radius_min else "the base has shrunk to its middle",
        "the elbows are above the joints of the effector when the upper arms are horizontal (R - r = -La)",
    )
    near = bounds_excess(wish, candidate[np.newaxis])[0] > -1e-6 * wish.shape.diagonal
    return tuple(sentence for sentence, binds in zip(sentences, near, strict=True) if binds)


def _impossible(problem: Problem, candidate: Array, seed: int, progress: Progress | None) -> RobotError:
    """The error that says which demands cannot be met, and how near each came with the others kept."""
    wish, points = problem.wish, problem.wish.shape.place(fine_cube())
    missed = problem.violations(candidate[np.newaxis], points)[0]
    parts = []
    for index in np.flatnonzero(missed[:-1] > _MET):
        demand = problem.demands[index]
        relaxed = Problem(wish, problem.demands, relaxed=int(index))
        best = search(relaxed, seed=seed, progress=_stage(progress, f"how near: {demand.label}"))
        value = float(relaxed.objective(best[np.newaxis], points)[0])
        if value < _IMPOSSIBLE:
            parts.append(f"{_asked(demand)}: {demand.value(value):.4g} at best with the other demands kept")
        else:
            near = float(excesses((demand,), candidate[np.newaxis], points).max())
            parts.append(f"{_asked(demand)}: {demand.value(near):.4g} in the nearest design")
    if not parts:
        parts.append("the bounds on its size and radii leave no room")
    return RobotError(
        f"no robot up to {wish.size_limit * 1e3:.0f} mm in size meets all demands; {'; '.join(parts)}",
        where="demands",
        hint="ask less of what is missed, or let the robot be larger (--max-size)",
    )


def _asked(demand: Demand) -> str:
    return f"{demand.label} {'>=' if demand.at_least else '<='} {demand.limit:.6g} {demand.unit}".rstrip()
