"""Lines that could be closed in more than one way, and what they enclose."""

import numpy as np

from deltacam.drawing.joining.join import Joined, join
from deltacam.geometry.pack import Pack
from deltacam.model import Curve, Finding

MM = 1e-3


def line(*points: tuple[float, float]) -> Curve:
    """An open polyline through points in mm."""
    return Curve(points=MM * np.array(points), bulges=np.zeros(len(points) - 1), closed=False)


def joined(*shapes: Curve) -> Joined:
    return join(Pack.of(shapes), name=lambda i: f"LINE #{i:X}")


def blocking(result: Joined) -> list[Finding]:
    return [finding for finding in result.findings if finding.blocks]


def test_a_nest_with_common_edges_counts_its_outlines() -> None:
    rails = [line((10 * i, y), (10 * i + 10, y)) for i in range(4) for y in (0, 10)]
    rungs = [line((10 * i, 0), (10 * i, 10)) for i in range(5)]
    (finding,) = blocking(joined(*rails, *rungs))
    assert finding.kind == "common_edge"
    assert finding.what.startswith("4 outlines share lines, for one at (10.000, 5.000) mm")
    assert finding.where == "LINE #0"
    assert finding.hint


def test_every_group_of_parts_has_its_own_finding() -> None:
    def pair(x: float) -> list[Curve]:
        return [
            line((x + 10, 0), (x, 0), (x, 10), (x + 10, 10)),
            line((x + 10, 0), (x + 10, 10)),
            line((x + 10, 0), (x + 20, 0), (x + 20, 10), (x + 10, 10)),
        ]

    findings = blocking(joined(*pair(0), *pair(50)))
    assert [(finding.kind, finding.where) for finding in findings] == [
        ("common_edge", "LINE #0"),
        ("common_edge", "LINE #3"),
    ]
    assert [finding.place for finding in findings] == [(0.01, 0.005), (0.06, 0.005)]


def test_lines_that_lean_on_a_branch_without_enclosing_anything_block_nothing() -> None:
    result = joined(line((0, 0), (10, 0)), line((0, 0), (0, 10)), line((0, 0), (-7, -7)))
    assert blocking(result) == []
    assert [finding.kind for finding in result.findings] == ["branch"]
    assert len(result.chains) == 3


def test_what_closes_in_several_ways_without_a_shared_line_blocks_too() -> None:
    # From node to node lead three ways, two of which run through each other, so no more than one face is found.
    over = line((0, 0), (5, 8), (10, 0))
    under = line((0, 0), (5, -8), (10, 0))
    across = line((0, 0), (5, 20), (5, -20), (10, 0))
    findings = blocking(joined(over, under, across))
    assert len(findings) == 1
    assert findings[0].kind in ("branch", "common_edge")


def test_a_grid_of_many_lines_is_one_finding() -> None:
    steps = range(60)
    lines = [line((i, j), (i + 1, j)) for i in steps for j in steps] + [
        line((i, j), (i, j + 1)) for i in steps for j in steps
    ]
    result = joined(*lines)
    assert [finding.kind for finding in blocking(result)] == ["common_edge"]
    branches = [finding for finding in result.findings if finding.kind == "branch"]
    assert len(branches) == 201
    assert branches[-1].what.startswith("and ")
