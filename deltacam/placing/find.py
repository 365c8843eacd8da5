"""The places and turns at which a part is cut fastest and most accurately.

A grid of places and turns is estimated, the best of them are moved and turned in smaller and smaller steps, and what
comes out is planned as `plan` would plan it. Only planned times count. The centre of the sheet is always among them,
so that a gain is one over what a person would do without looking.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, get_args

import numpy as np

from deltacam.cutting.fitting import Footprint, Spot
from deltacam.errors import InfeasibleError
from deltacam.model import Array
from deltacam.placing.estimate import Estimate, estimate
from deltacam.placing.sampled import Sampled
from deltacam.placing.trials import Trials, about, grid

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

By = Literal["both", "time", "accuracy"]
"""What is to be small: the time, the largest error of the tool, or the sum of both as shares of those at the centre."""

WISHES: Final[tuple[By, ...]] = get_args(By)

PLANNED: Final = 8
"""How many places are planned, beside the centre."""

SAMPLES: Final = 4_000_000
"""About how many intervals are looked at on the grid: the more a path has, the coarser is the grid."""

_ROUNDS: Final = 4
_APART: Final = 0.06  # of the sheet's extent
_TURNED: Final = np.radians(20.0)
_TURNS_SHOWN: Final = 72
_BATCH: Final = 100
_NONE: Final = np.zeros(0)


@dataclass(frozen=True, slots=True)
class Candidate:
    """A place and a turn that were planned.

    Attributes:
        spot: as they are typed.
        time: of the whole program, s.
        worst: m/rad, the largest error of the tool in the sheet's plane by that of the joints, over the cuts.
        rms: m/rad, its root mean square over the length of the cuts.
    """

    spot: Spot
    time: float
    worst: float
    rms: float


@dataclass(frozen=True, slots=True, eq=False)
class Maps:
    """Estimates over the sheet and over the turn; nan where the part is not on the sheet.

    Attributes:
        x: (M,) m, columns.
        y: (M,) m, rows.
        time: (M, M) s, the least over the turns.
        worst: (M, M) m/rad, the least over the turns.
        turn: (T,) rad, at the best place.
        time_by_turn: (T,) s.
        worst_by_turn: (T,) m/rad.
        excess_by_turn: (T,) m, by how much the part leaves the sheet there in the best place; <= 0 where it fits.
        estimated: how many places and turns were estimated.
    """

    x: Array
    y: Array
    time: Array
    worst: Array
    turn: Array
    time_by_turn: Array
    worst_by_turn: Array
    excess_by_turn: Array
    estimated: int


class Task(NamedTuple):
    """A part that is to be placed.

    Attributes:
        part: what it needs of the sheet.
        robot: the machine.
        sample: its motion, as it is planned at a place and a turn, m and rad.
        duration: how long its program takes there, planned in full, s.
    """

    part: Footprint
    robot: Robot
    sample: Callable[[tuple[float, float], float], Sampled]
    duration: Callable[[tuple[float, float], float], float]


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """What was found.

    Attributes:
        by: what was to be small.
        best: the places that were planned, the best first; the centre is among them where the part fits there.
        centre: the part at the centre of the sheet, unturned or else turned; None where it does not fit there.
        excess: m, by how much it leaves the sheet there unturned; 0 where it fits.
        maps: the estimates.
        task: what was asked for.
    """

    by: By
    best: tuple[Candidate, ...]
    centre: Candidate | None
    excess: float
    maps: Maps
    task: Task

    def gain(self, one: Candidate) -> tuple[float, float] | None:
        """How much less time and how much less error than at the centre, as shares; None where there is no centre."""
        if self.centre is None:
            return None
        return 1.0 - one.time / self.centre.time, 1.0 - one.worst / self.centre.worst


def find(task: Task, *, by: By = "both", progress: Callable[[int, int], None] = lambda _done, _total: None) -> Found:
    """The best places and turns of a part.

    Args:
        task: the part; it fits somewhere.
        by: what is to be small.
        progress: is told how many places are estimated or planned, and of how many.

    Raises:
        InfeasibleError: the part fits so barely that no place can be typed.
    """
    part, sheet = task.part, task.robot.workspace
    search, trials = _Search.of(task, by)
    total = len(trials.at) + PLANNED + 1
    for start in range(0, len(trials.at), _BATCH):
        progress(start, total)
        search.add(trials.at[start : start + _BATCH], trials.rotation[start : start + _BATCH])
    for k in range(_ROUNDS):
        seeds = search.best()
        step = trials.step / 2.0 ** (k + 1)
        search.add(*about(search.at[seeds], search.rotation[seeds], step, part, sheet))
    spots = [part.spot(sheet, _pair(search.at[one]), float(search.rotation[one])) for one in search.best()]
    planned: list[Candidate] = []
    for spot in dict.fromkeys(spot for spot in (search.centre, *spots) if spot is not None):
        progress(len(trials.at) + len(planned), total)
        about_it = search.estimate(np.array([spot.at]), np.array([spot.rotation]))
        worst, rms = float(about_it.worst[0]), float(about_it.rms[0])
        planned.append(Candidate(spot, task.duration(spot.at, spot.rotation), worst, rms))
    if not planned:
        what = "the part fits the sheet too barely to be placed with numbers of six decimals"
        raise InfeasibleError(what, hint="take a larger robot (--robot)")
    times, errors = np.array([one.time for one in planned]), np.array([one.worst for one in planned])
    order = np.argsort(search.score(times, errors, (planned[0].time, planned[0].worst)), kind="stable")
    best = tuple(planned[k] for k in order.tolist())
    progress(total, total)
    excess = max(0.0, part.excess_at(sheet, (0.0, 0.0), 0.0))
    return Found(by, best, planned[0] if search.centre else None, excess, search.maps(trials, best[0]), task)


class _Search:
    """The places and turns that were estimated so far; the first is the centre, where the part fits there.

    Attributes:
        centre: where the part is at the centre of the sheet.
        at: (N, 2) m.
        rotation: (N,) rad.
        found: (N,) each.
    """

    def __init__(self, task: Task, by: By, centre: Spot | None, sampled: Sampled) -> None:
        self._task, self._by, self._sampled = task, by, sampled
        self.centre = centre
        self.at, self.rotation, self.found = np.zeros((0, 2)), _NONE, Estimate(_NONE, _NONE, _NONE)

    @classmethod
    def of(cls, task: Task, by: By) -> tuple[_Search, Trials]:
        """A search that knows the centre, and what is to be tried first."""
        part, sheet = task.part, task.robot.workspace
        centre = part.spot(sheet, (0.0, 0.0), 0.0, digits=(2,)) or part.turned_spot(sheet, (0.0, 0.0))
        turn = part.best_turn(sheet)[0]
        first = centre or part.spot(sheet, part.places(sheet, turn).centre, turn)
        at, rotation = (first.at, first.rotation) if first else (part.places(sheet, turn).centre, turn)
        sampled = task.sample(at, rotation)
        search = cls(task, by, centre, sampled)
        search.add(np.array([at]), np.array([rotation]))
        return search, grid(part, sheet, most=SAMPLES // len(sampled.segment))

    def estimate(self, at: Array, rotation: Array) -> Estimate:
        """The estimate for places (P, 2) and turns (P,)."""
        return estimate(self._sampled, self._task.robot, at, rotation)

    def add(self, at: Array, rotation: Array) -> None:
        """Estimate more places and turns."""
        if len(at):
            new = self.estimate(at, rotation)
            self.at, self.rotation = np.concatenate([self.at, at]), np.concatenate([self.rotation, rotation])
            self.found = Estimate(*(np.concatenate(one) for one in zip(self.found, new, strict=True)))

    def score(self, time: Array, worst: Array, unit: tuple[float, float]) -> Array:
        """How bad times and errors are, in shares of a time and an error."""
        shares = {"time": time / unit[0], "accuracy": worst / unit[1]}
        return shares["time"] + shares["accuracy"] if self._by == "both" else shares[self._by]

    def best(self) -> list[int]:
        """The best places and turns that are apart from each other, at most `PLANNED`."""
        time, worst = self.found.time, self.found.worst
        score = self.score(time, worst, (float(time[0]), float(worst[0])))
        extent = _extent(self._task.robot)
        chosen: list[int] = []
        for one in np.argsort(score, kind="stable").tolist():
            turned = np.abs((self.rotation[chosen] - self.rotation[one] + np.pi) % (2.0 * np.pi) - np.pi)
            moved = np.hypot(*(self.at[chosen] - self.at[one]).T)
            if ((turned > _TURNED) | (moved > _APART * extent)).all():
                chosen.append(one)
            if len(chosen) == PLANNED:
                break
        return chosen

    def maps(self, trials: Trials, best: Candidate) -> Maps:
        """What was estimated, and how it changes where the part is turned in its best place."""
        side, part, sheet = len(trials.x), self._task.part, self._task.robot.workspace
        on_grid = np.flatnonzero(trials.cell >= 0)
        time, worst = np.full(side**2, np.inf), np.full(side**2, np.inf)
        np.minimum.at(time, trials.cell[on_grid], self.found.time[1 + on_grid])
        np.minimum.at(worst, trials.cell[on_grid], self.found.worst[1 + on_grid])
        turn = np.linspace(0.0, 2.0 * np.pi, _TURNS_SHOWN + 1)
        at = np.array([best.spot.at])
        held = np.array([bool(part.holds(sheet, one, at)[0]) for one in turn.tolist()])
        time_by_turn, worst_by_turn = np.full(len(turn), np.nan), np.full(len(turn), np.nan)
        if held.any():
            found = self.estimate(np.repeat(at, int(held.sum()), axis=0), turn[held])
            time_by_turn[held], worst_by_turn[held] = found.time, found.worst
        return Maps(
            x=trials.x,
            y=trials.y,
            time=np.where(np.isfinite(time), time, np.nan).reshape(side, side),
            worst=np.where(np.isfinite(worst), worst, np.nan).reshape(side, side),
            turn=turn,
            time_by_turn=time_by_turn,
            worst_by_turn=worst_by_turn,
            excess_by_turn=np.array([part.places(sheet, one).excess for one in turn.tolist()]),
            estimated=len(self.at),
        )


def _extent(robot: Robot) -> float:
    sheet = robot.workspace
    return 2.0 * sheet.radius if sheet.radius is not None else max(sheet.width or 0.0, sheet.depth or 0.0)


def _pair(place: Array) -> tuple[float, float]:
    return float(place[0]), float(place[1])
