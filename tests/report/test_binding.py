"""The nearest limit is the one of which the largest share is used."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.model import Operation
from deltacam.program.program import Program
from deltacam.report.binding import LIMITS, NEAR, NONE, Binding, binding, limit_of
from deltacam.report.motion import motion_of
from deltacam.robot.robot import JointLimits, ToolRating
from deltacam.verification.evidence import gather
from deltacam.verification.verify import verify
from tests.bench import Bench


def nearest(program: Program) -> Binding:
    evidence = gather(program, program.robot)
    return binding(evidence, motion_of(evidence))


def limited(program: Program, *, tool: dict[str, float], joints: dict[str, float]) -> Program:
    """The program on a robot with limits that are these shares of what the program needs, else far away."""
    motion = motion_of(gather(program, program.robot))
    far = {"max_speed": 0.1, "max_acceleration": 0.1, "max_jerk": 0.1} | joints
    needs = {name: np.abs(values).max() for name, values in zip(far, motion.joints[1:], strict=True)}
    triples = {name: (float(needs[name] / share),) * 3 for name, share in far.items()}
    shares = {"max_speed": 0.1, "max_acceleration": 0.1} | tool
    rating = ToolRating(
        max_speed=float(motion.speed.max() / shares["max_speed"]),
        max_acceleration=float(motion.acceleration.max() / shares["max_acceleration"]),
    )
    old: JointLimits = program.robot.joints
    robot = replace(program.robot, tool=rating, joints=JointLimits(old.min, old.max, **triples))
    return replace(program, robot=robot, process=replace(program.process, feed=10.0))


@pytest.mark.parametrize(
    ("limit", "tool", "joints"),
    [
        ("tool speed", {"max_speed": 0.99}, {}),
        ("tool acceleration", {"max_acceleration": 0.99}, {}),
        ("joint speed", {}, {"max_speed": 0.99}),
        ("joint acceleration", {}, {"max_acceleration": 0.99}),
        ("joint jerk", {}, {"max_jerk": 0.99}),
    ],
)
def test_the_only_limit_that_is_near_is_the_one_that_is_shown(
    program: Program, limit: str, tool: dict[str, float], joints: dict[str, float]
) -> None:
    found = nearest(limited(program, tool=tool, joints=joints))
    assert found.share.max() == pytest.approx(0.99)
    assert {LIMITS[index] for index in np.unique(found.limit[found.share > 0.2])} == {limit}
    assert set(np.unique(found.shown())) == {LIMITS.index(limit), NONE}


def test_the_largest_share_is_that_of_the_report(bench: Bench) -> None:
    program = bench.program()
    shares = verify(program, drawing=bench.drawing).summary["share_of_limit"]
    assert nearest(program).share.max() == pytest.approx(max(shares.values()))


def test_the_feed_counts_while_the_laser_moves_and_engraving_has_its_own(bench: Bench) -> None:
    contours = [replace(c, operation=Operation.ENGRAVE) if c.number == 2 else c for c in bench.drawing.contours]
    paths = bench.paths
    program = bench.but(
        drawing=replace(bench.drawing, contours=tuple(contours)),
        order=(2, 4, 3, 1),
        paths=lambda half: paths(half) | {2: paths(0.0)[2]},
    ).program()
    found = nearest(program)
    feed = found.shown() == LIMITS.index("feed")
    kinds = np.array([block.kind.value for block in program.blocks])[program.block[feed]]
    assert set(kinds) == {"cut", "engrave"}
    speed = motion_of(gather(program, program.robot)).speed[feed]
    wanted = np.where(kinds == "engrave", 0.2, 0.1)
    assert (speed >= NEAR * wanted * (1 - 1e-9)).all()


def test_what_stands_for_several_ticks_is_the_limit_of_the_largest_share() -> None:
    found = Binding(np.array([0, 5, 2, 1], dtype=np.uint8), np.array([0.95, 0.99, 0.97, 0.3]))
    assert limit_of(found.ranked()).tolist() == [0, 5, 2, NONE]
    assert limit_of(found.ranked().max(keepdims=True)).tolist() == [5]
    assert limit_of(found.ranked()[[0, 2, 3]].max(keepdims=True)).tolist() == [2]
