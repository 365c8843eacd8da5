"""Common edges in the planner: where cuts begin, and what comes after what."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
import shapely

from deltacam.cutting import order as module
from deltacam.cutting import ways as planner
from deltacam.cutting.kerf import offset
from deltacam.cutting.leads.starts import starts_off
from deltacam.cutting.process_file.reading import read_process
from deltacam.cutting.process_file.writing import to_toml
from deltacam.cutting.shaping import repeated
from deltacam.cutting.shared import share_edges
from deltacam.errors import ProcessError
from deltacam.geometry import curve as curves
from deltacam.model import BlockKind, Contour, Curve, Cut, Placement, Process, StartRule, Stretch
from deltacam.settings import Table
from tests.bench import Bench
from tests.strategies import contour, rectangle

KERF = 2e-4


def wall(seed: int) -> list[Contour]:
    """Rows of bricks of random widths, one kerf apart, each with a hole."""
    chance, contours = np.random.default_rng(seed), list[Contour]()
    for row in range(3):
        x = chance.uniform(0.0, 5e-3)
        for width in chance.uniform(5e-3, 15e-3, 4).tolist():
            outline = len(contours) + 1
            contours.append(contour(rectangle(width, 8e-3, at=(x, row * (8e-3 + KERF))), number=outline))
            hole = curves.circle(np.array([x + 2.5e-3, row * 8.2e-3 + 4e-3]), 1e-3)
            contours.append(contour(hole, number=outline + 1, depth=1, parent=outline))
            x += width + KERF
    return contours


@pytest.mark.parametrize("together", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_what_is_left_of_a_contour_comes_after_the_edges_that_it_lost(seed: int, together: bool) -> None:
    contours = wall(seed)
    shared = share_edges(offset(contours, kerf=KERF).cuts, contours, kerf=KERF, tolerance=5e-6)
    parents = {one.number: one.parent for one in contours}
    found = module.order(
        shared.cuts, parents=parents, start=(0.0, 0.0), after=shared.after, together=together, seed=seed, effort=300
    ).cuts
    assert sorted(one.contour for one in found) == sorted(one.contour for one in shared.cuts)
    first, last = {}, {}
    for index, cut in enumerate(found):
        first.setdefault(cut.contour, index)
        last[cut.contour] = index
    assert all(last[other] < first[number] for number, others in shared.after.items() for other in others)
    assert all(last[number] < first[parent] for number, parent in parents.items() if parent is not None)
    if together:
        outer = [parents[cut.contour] or cut.contour for cut in found]
        assert sum(one != two for one, two in itertools.pairwise(outer)) == len(set(outer)) - 1


@pytest.mark.parametrize("rule", ["best", "edge", "corner"])
def test_a_cut_begins_off_the_edges_that_it_shares(rule: StartRule) -> None:
    path = rectangle(0.03, 0.01)
    edges = [Curve(points=path.points[ends], bulges=np.zeros(1), closed=False) for ends in ([0, 1], [2, 3])]
    places = curves.evaluate(path, *starts_off(edges, path, rule, count=8, kerf=KERF))[0]
    assert len(places)
    away = shapely.distance(shapely.MultiLineString([edge.points for edge in edges]), shapely.points(places))
    assert away.min() > KERF


def test_a_cut_all_of_whose_path_is_shared_begins_by_its_rule() -> None:
    path = rectangle(0.03, 0.01)
    segment, distance = starts_off([curves.opened(path)], path, "edge", count=8, kerf=KERF)
    assert (segment.tolist(), distance.tolist()) == ([0], [pytest.approx(0.015)])


def test_nothing_is_shared_where_nobody_asks(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        pytest.fail("edges were shared")

    monkeypatch.setattr(planner, "share_edges", refuse)
    contours = bench.drawing.contours
    cuts: tuple[Cut, ...] = offset(contours, kerf=KERF).cuts
    where = Placement(x=0.0, y=0.0, rotation=0.0, z=bench.placement.z)
    found = planner.ways(cuts, contours, process=bench.process, robot=bench.robot, placement=where)
    assert len(found.cuts) == len(cuts)


def read(**values: object) -> Process:
    given = {"name": "steel", "kerf_mm": 0.2, "feed_m_min": 6.0, **values}
    return read_process(Table(given, file="steel.toml", error=ProcessError))


@pytest.mark.parametrize("asked", [True, False])
def test_a_process_file_says_whether_edges_are_shared(asked: bool) -> None:
    process = read(common_edges=asked)
    assert process.common_edges is asked
    assert ("common_edges = true" in to_toml(process)) is asked


def test_a_process_file_says_true_or_false() -> None:
    with pytest.raises(ProcessError, match="common_edges = 1 is not true or false"):
        read(common_edges=1)


def test_an_open_cut_is_run_to_and_fro_with_its_slow_bends(bench: Bench) -> None:
    ends = [Curve(points=np.array([[x, 0.0], [x + 0.01, 0.0]]), bulges=np.zeros(1), closed=False) for x in (0.0, 0.01)]
    way = (Stretch(BlockKind.CUT, ends[0]), Stretch(BlockKind.CUT, ends[1], feed=0.02))
    cut = Cut(contour=1, layer="0", handles=("1",), curve=curves.chain(ends), way=way)
    (found,) = repeated([cut], process=replace(bench.process, passes=3))
    assert [stretch.feed for stretch in found.way] == [None, 0.02, 0.02, None, None, 0.02]
    places = [stretch.curve.points[0, 0] for stretch in found.way] + [found.way[-1].curve.points[-1, 0]]
    assert places == pytest.approx([0.0, 0.01, 0.02, 0.01, 0.0, 0.01, 0.02])
