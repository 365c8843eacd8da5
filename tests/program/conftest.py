"""A small robot and programs of arbitrary numbers; no motion is meant by them."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from deltacam.model import Block, BlockKind, Mode, Operation, Placement, Process, Rule
from deltacam.program.program import DrawingRef, Program
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.robot import JointLimits, Robot, ToolRating
from deltacam.robot.workspace import Workspace
from tests.bench import Bench

ROBOT = Robot(
    name="bench",
    geometry=DeltaGeometry(base_radius=0.13, effector_radius=0.035, upper_arm=0.3, forearm=0.7),
    joints=JointLimits(min=(-0.7,) * 3, max=(1.6,) * 3, max_speed=(2.7,) * 3, max_acceleration=(66.0,) * 3),
    tool=ToolRating(max_speed=1.0, max_acceleration=23.0),
    workspace=Workspace(sheet_z=-0.65, width=0.3, depth=0.3),
)
PROCESS = Process(
    name="test steel",
    source="a test",
    material="steel",
    thickness=1e-3,
    kerf=0.2e-3,
    feed=0.1,
    power=0.85,
    pierce_time=0.1,
    rules=(
        Rule(Operation.ENGRAVE, layer="*GRAV*", color=1, linetype="DASHED", open=Operation.CUT),
        Rule(Operation.IGNORE),
    ),
    open=Operation.ENGRAVE,
    engrave_feed=0.3,
    engrave_power=0.1,
)
BLOCKS = (
    Block(BlockKind.RAPID, 0, 1),
    Block(BlockKind.PIERCE, 2, 2, 1, "CUT", ("2F", "30")),
    Block(BlockKind.CUT, 3, 4, 1, "CUT", ("2F", "30")),
    Block(BlockKind.ENGRAVE, 5, 5, 2, "TEXT", ("31",)),
)
PROGRAM = Program(
    robot=ROBOT,
    placement=Placement(x=0.1 / 3, y=-1e-17, rotation=0.1 + 0.2, z=-0.65),
    process=PROCESS,
    drawing=DrawingRef(
        file="plate.dxf",
        sha256="ab" * 32,
        metres_per_unit=0.0254,
        joining=3e-5,
        layers=("CUT*", "\u56f3"),
        ignored_layers=("CUT-OLD",),
        accept_loss=True,
    ),
    mode=Mode.CUT,
    blocks=BLOCKS,
    q=np.linspace(0.1, 0.9, 18).reshape(6, 3),
    power=np.array([0.0, 0.0, 1.0, 0.85, 0.85, 0.0]),
    block=np.array([0, 0, 1, 2, 2, 3]),
)


@pytest.fixture(scope="session")
def program() -> Program:
    """A program of six rows."""
    return PROGRAM


@pytest.fixture(scope="session")
def with_rows() -> Callable[..., Program]:
    """The same program with other rows."""

    def build(q: np.ndarray, power: np.ndarray | None = None, block: np.ndarray | None = None) -> Program:
        rows = len(q)
        power = np.zeros(rows) if power is None else power
        block = np.zeros(rows, dtype=np.int64) if block is None else block
        return replace(PROGRAM, q=q, power=power, block=block)

    return build


@pytest.fixture(scope="session")
def bench_program(bench: Bench) -> Program:
    """A valid program of thousands of rows."""
    return bench.program()
