"""Valid programs: what the pipeline plans for random drawings, robots, processes and placements."""

import tempfile
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from pathlib import Path

import numpy as np
import shapely

from deltacam import pipeline
from deltacam.geometry import curve as curves
from deltacam.model import (
    Array,
    BlockKind,
    Check,
    Contour,
    Drawing,
    IntArray,
    Lead,
    Process,
    Report,
    Tabs,
)
from deltacam.program.program import Program
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Controller, Robot
from tests.damage import drawings

JERKS = (None, 6388.0, 4000.0)  # rad/s3
SAGITTA = 0.2e-6  # of the flattened contours, m
WORKING = (BlockKind.CUT, BlockKind.ENGRAVE)
WITH_STRETCHES = 1000  # from this seed on programs may have leads


@dataclass(frozen=True, eq=False)
class Example:
    """A valid program, and what a forger has at hand to change it unseen.

    Attributes:
        seed: of everything.
        content: the bytes of the program file.
        program: as it was read from them.
        drawing: as it was read.
        report: of the check of the program.
    """

    seed: int
    content: bytes
    program: Program
    drawing: Drawing
    report: Report

    @cached_property
    def checks(self) -> dict[str, Check]:
        """What was checked, by name."""
        return {check.name: check for check in self.report.checks}

    @cached_property
    def tool(self) -> Array:
        """Where the tool is at every tick, (N, 3) m in the base frame."""
        return self.program.robot.forward(self.program.q)

    @cached_property
    def middles(self) -> Array:
        """Where the tool is half-way between the ticks, (N - 1, 3) m: cubic curves leave chords by their slopes."""
        q = self.program.q
        halves = 0.5 * (q[:-1] + q[1:])
        if self.robot.controller.interpolation == "cubic":
            slopes = 0.5 * np.diff(np.pad(q, ((1, 1), (0, 0)), mode="edge"), axis=0)
            slopes = slopes[:-1] + slopes[1:]
            halves += (slopes[:-1] - slopes[1:]) / 8.0
        return self.robot.forward(halves)

    @property
    def robot(self) -> Robot:
        return self.program.robot

    @property
    def rate(self) -> float:
        return self.program.rate_hz

    @cached_property
    def kind(self) -> np.ndarray:
        """The kind of every row."""
        return np.array([block.kind for block in self.program.blocks], dtype=object)[self.program.block]

    def rows(self, *kinds: BlockKind) -> IntArray:
        """The rows of some kinds, in order."""
        return np.flatnonzero(np.isin(self.kind.astype(str), kinds))

    def contour(self, row: int) -> Contour:
        """The contour of the drawing that a row works on."""
        number = self.program.blocks[int(self.program.block[row])].contour
        return next(one for one in self.drawing.contours if one.number == number)

    def sheet(self, tool: Array) -> Array:
        """Points (N, 3) of the base frame in the drawing's own, (N, 2) m."""
        return to_sheet(self.program, tool)

    def off_path(self, rows: IntArray, tool: Array) -> Array:
        """How far points (M, 3) are from the paths that belong to the rows (M,), m."""
        found = np.zeros(len(rows))
        sheet, numbers = self.sheet(tool), self.program.block[rows]
        for number in np.unique(numbers).tolist():
            mine = np.flatnonzero(numbers == number)
            line = beam_path(self.contour(int(rows[mine[0]])), self.program.process.kerf)
            found[mine] = shapely.distance(shapely.points(sheet[mine]), line)
        return found


def to_sheet(program: Program, tool: Array) -> Array:
    """Where points (N, 3) of the base frame are in the drawing, (N, 2) m."""
    where = program.placement
    cos, sin = np.cos(where.rotation), np.sin(where.rotation)
    return np.asarray((tool[:, :2] - (where.x, where.y)) @ np.array([[cos, -sin], [sin, cos]]))


@lru_cache(maxsize=256)
def beam_path(contour: Contour, kerf: float) -> shapely.Geometry:
    """Where the beam's centre belongs, by shapely alone: the edge of the contour grown or shrunk by half a kerf."""
    points, _ = curves.flatten(contour.curve, SAGITTA)
    if not contour.curve.closed:
        return shapely.LineString(points)
    half = kerf / 2.0 * (-1.0 if contour.is_hole else 1.0) * contour.has_kerf
    return shapely.Polygon(points).buffer(half, quad_segs=64).boundary


def random_robot(chance: np.random.Generator) -> Robot:
    """A built-in robot with another controller and another limit of jerk."""
    robot = load_robot(str(chance.choice(["delta-300", "irb360-1600"])))
    interpolation = "cubic" if chance.random() < 0.3 else "linear"
    controller = Controller(float(chance.choice([400.0, 400.0, 250.0, 1000.0])), interpolation)
    jerk = JERKS[int(chance.integers(len(JERKS)))]
    joints = replace(robot.joints, max_jerk=None if jerk is None else (jerk,) * 3)
    return replace(robot, controller=controller, joints=joints)


def random_process(chance: np.random.Generator) -> Process:
    """Any kerf, feed and time to pierce that a thin sheet may need."""
    return Process(
        name="a trial",
        source="",
        material="",
        thickness=1e-3,
        kerf=float(chance.choice([0.0, 0.1e-3, 0.15e-3, 0.3e-3, 0.4e-3])),
        feed=float(chance.choice([0.08, 0.15, 0.25])),
        power=float(chance.choice([1.0, 0.85, 0.6])),
        pierce_time=float(chance.choice([0.0, 0.02, 0.05, 0.1])),
        tolerance=float(chance.choice([10e-6, 20e-6, 40e-6])),
        chord_tolerance=float(chance.choice([10e-6, 20e-6])),
        corner="stop" if chance.random() < 0.3 else "round",
        engrave_feed=0.3,
        engrave_power=0.2,
    )


def has_stretches(seed: int) -> bool:
    """Whether the program of a seed has leads."""
    return seed >= WITH_STRETCHES and seed % 2 == 0


def with_stretches(process: Process, chance: np.random.Generator) -> Process:
    """The process with leads and an overcut, and with loops, tabs, both or neither."""
    return replace(
        process,
        lead_in=Lead(str(chance.choice(["line", "arc", "line+arc"]))),
        lead_out=Lead(str(chance.choice(["none", "line", "arc", "line+arc"]))),
        start=str(chance.choice(["best", "edge", "corner"])),
        overcut=float(chance.choice([0.0, 0.5e-3, 1.5e-3])),
        corner="loop" if chance.random() < 0.5 else process.corner,
        tabs=Tabs(width=float(chance.choice([0.3e-3, 0.6e-3])), count=2) if chance.random() < 0.5 else None,
    )


def example(seed: int) -> Example:
    """The valid program of a seed; of some seeds it has leads, an overcut, loops and tabs.

    Raises:
        DeltacamError: the pipeline did not plan it.
    """
    chance = np.random.default_rng(seed)
    robot, process, content = random_robot(chance), random_process(chance), drawings.drawing(chance)
    if has_stretches(seed):
        process = with_stretches(process, np.random.default_rng([seed, 1]))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part.dxf"
        path.write_bytes(content)
        planned = pipeline.plan(
            path,
            robot=robot,
            process=process,
            at=tuple(chance.uniform(-0.08, 0.08, 2).tolist()),
            rotation=float(chance.uniform(-np.pi, np.pi)),
            jobs=1,
            what_if=False,
        )
    return Example(seed, planned.content, planned.program, planned.drawing, planned.report)
