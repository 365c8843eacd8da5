"""Times of known shapes against those of others, and of one circle that is drawn in four ways."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path as File

import ezdxf
import numpy as np
import pytest
import shapely
from ezdxf.document import Drawing as Document

from deltacam.cutting.kerf import offset
from deltacam.drawing.reader import read_drawing
from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve
from deltacam.motion.corners import pieces
from deltacam.motion.parametrize import parametrize
from deltacam.motion.route import Limits, Route
from deltacam.motion.run import Run, run
from deltacam.motion.setpoints import FIT_ALLOWANCE
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Controller, JointLimits, Robot, ToolRating
from deltacam.robot.workspace import Workspace
from tests.motion.shares import at_ticks

NO_CAP = 1e4
TOLERANCE = 10e-6
SMALL = Robot(
    "small",
    DeltaGeometry(0.13201114, 0.03319764, 0.112, 0.232),
    JointLimits(*((math.radians(value),) * 3 for value in (-60.0, 100.0, 180.0, 3000.0))),
    ToolRating(16.0, NO_CAP),
    Workspace(sheet_z=-0.18043, radius=0.06),
    Controller(400.0, "cubic"),
)
TOOTH = [(0.0, 27.0), (0.12, 27.0), (0.2, 27.3), (0.28, 28.5), (0.36, 29.7)]
TOOTH += [(0.44, 30.0), (0.56, 30.0), (0.64, 29.7), (0.72, 28.5), (0.8, 27.3)]
"""Share of the pitch and radius in mm of the vertices of a tooth."""


def gear() -> Curve:
    share, radius = np.tile(TOOTH, (40, 1)).T
    angle = 2.0 * np.pi * (np.repeat(np.arange(40), len(TOOTH)) + share) / 40.0
    return curves.polygon(1e-3 * radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def square() -> Curve:
    return curves.polygon(np.array([[0.0, -0.03], [0.03, -0.03], [0.03, 0.03], [-0.03, 0.03], [-0.03, -0.03]]))


def circle() -> Curve:
    return curves.circle(np.zeros(2), 0.03)


SHAPES: dict[str, tuple[Callable[[], Curve], float, float]] = {
    "gear": (gear, 0.2, 5.45),
    "square": (square, 0.2, 1.348),
    "circle": (circle, 0.2, 0.979),
    "fast circle": (circle, 0.5, 0.556),
}
"""Curve, feed in m/s, and the time that it may take, s; LinuxCNC takes 7.206, 1.393, 0.976 and 0.596 s."""


def small_route(shape: str) -> Route:
    drawn, feed, _ = SHAPES[shape]
    (path,) = pieces(drawn(), corner="round", deviation=TOLERANCE, ramps=False, z=SMALL.workspace.sheet_z)
    return Route.of([(path, Limits(feed, NO_CAP, TOLERANCE))])


@cache
def small_run(shape: str) -> tuple[Route, Run]:
    route = small_route(shape)
    return route, run(route, SMALL)[0]


@pytest.mark.parametrize("shape", SHAPES)
def test_shapes_take_no_longer_than_a_clothoid_at_every_corner_would(shape: str) -> None:
    assert small_run(shape)[1].duration <= SHAPES[shape][2]


@pytest.mark.parametrize("shape", SHAPES)
def test_the_programs_of_the_shapes_are_within_the_limits_of_the_joints(shape: str) -> None:
    route, _ = small_run(shape)
    assert max(at_ticks(route, parametrize(route, SMALL), SMALL)) <= 1.001


@pytest.mark.parametrize("shape", SHAPES)
def test_the_programs_of_the_shapes_stay_within_the_tolerance_of_the_drawn_line(shape: str) -> None:
    route, found = small_run(shape)
    last = len(route.path.length) - 1
    end, *_ = route.path.evaluate(np.array([last]), route.path.length[-1:])
    q = np.vstack([found.q, SMALL.inverse(end)])
    drawn = shapely.LinearRing(curves.flatten(SHAPES[shape][0](), 1e-8)[0])
    shapely.prepare(drawn)
    assert off_line(SMALL.forward(q), drawn).max() <= TOLERANCE * 1.001
    # Between ticks: cubic curves with central differences for slopes.
    held = np.vstack([q[:1], q, q[-1:]])
    slope = 0.5 * (held[2:] - held[:-2])
    for u in (0.25, 0.5, 0.75):
        blend = u**2 * (3.0 - 2.0 * u)
        between = q[:-1] + blend * np.diff(q, axis=0) + u * (1 - u) ** 2 * slope[:-1] - u**2 * (1 - u) * slope[1:]
        assert off_line(SMALL.forward(between), drawn).max() <= 1.5 * TOLERANCE


def off_line(tool: Array, line: shapely.LinearRing) -> Array:
    return np.asarray(
        np.hypot(shapely.distance(shapely.points(tool[:, :2]), line), tool[:, 2] - SMALL.workspace.sheet_z)
    )


def chords(document: Document) -> None:
    angle = 2.0 * np.pi * np.arange(720) / 720.0
    points = 25.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    document.modelspace().add_lwpolyline(points.tolist(), close=True)


def bulges(document: Document) -> None:
    corners = [(25.0, 0.0), (0.0, 25.0), (-25.0, 0.0), (0.0, -25.0)]
    rows = [(x, y, math.tan(math.pi / 8.0)) for x, y in corners]
    document.modelspace().add_lwpolyline(rows, format="xyb", close=True)


def spline(document: Document) -> None:
    corners = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    weights = [1.0, math.sqrt(0.5)] * 4 + [1.0]
    document.modelspace().add_rational_spline(
        [(25.0 * x, 25.0 * y, 0.0) for x, y in corners], weights, degree=2, knots=[0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]
    )


def whole(document: Document) -> None:
    document.modelspace().add_circle((0.0, 0.0), 25.0)


WAYS = {"720 chords": chords, "4 bulges": bulges, "SPLINE": spline, "CIRCLE": whole}


@pytest.fixture(scope="module")
def drawn_circles(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[Curve, float]]:
    """The kerf path of the circle for every way to draw it, and how far the drawing may be from it, m."""
    folder: File = tmp_path_factory.mktemp("circles")
    found = {}
    for name, draw in WAYS.items():
        document = ezdxf.new(units=4)
        draw(document)
        document.saveas(folder / "circle.dxf")
        drawing = read_drawing(folder / "circle.dxf")
        (cut,) = offset(drawing.contours, kerf=0.0).cuts
        found[name] = cut.curve, drawing.conversion_error
    return found


@pytest.mark.parametrize("jerk", [None, 6388.0, 1500.0])
@pytest.mark.parametrize("feed", [0.1, 0.5, 1.0])
def test_a_circle_takes_the_same_time_however_it_is_drawn(
    feed: float, jerk: float | None, drawn_circles: dict[str, tuple[Curve, float]]
) -> None:
    delta = load_robot("delta-300")
    robot = replace(delta, joints=replace(delta.joints, max_jerk=jerk and (jerk,) * 3))
    times = {}
    for name, (curve, error) in drawn_circles.items():
        left = 20e-6 - error - FIT_ALLOWANCE
        parts = pieces(curve, corner="round", deviation=left, ramps=jerk is not None, z=robot.workspace.sheet_z)
        limits = Limits(feed, robot.tool.max_acceleration, 20e-6)
        (times[name],) = (one.duration for one in run(Route.of([(part, limits) for part in parts]), robot))
    assert max(times.values()) <= 1.005 * min(times.values()), times
