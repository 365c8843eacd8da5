"""Chains and loops of curves between nodes: every curve in one of them, and nothing by a guess."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.drawing.joining import chains
from deltacam.drawing.joining.chains import Chains
from deltacam.drawing.joining.nodes import Nodes


def traced(*edges: tuple[int, int]) -> Chains:
    """The chains of curves between numbered nodes."""
    labels = np.array(edges, dtype=np.int64).reshape(-1, 2)
    count = int(labels.max()) + 1
    return chains.trace(Nodes(labels, np.zeros((count, 2)), np.zeros(len(labels), dtype=np.bool_)))


def curves_of(chain: list[int]) -> list[int]:
    return [step >> 1 for step in chain]


def test_a_loop_starts_with_its_first_curve_forwards() -> None:
    found = traced((1, 2), (0, 1), (0, 2))
    assert found.loops == [[0, 2 * 2 + 1, 2 * 1]]
    assert (found.open, found.ambiguous, found.branches.tolist()) == ([], [], [])


def test_a_chain_runs_its_first_curve_forwards() -> None:
    assert traced((1, 2), (1, 0), (2, 3)).open == [[2 * 1 + 1, 0, 2 * 2]]


def test_a_dead_end_leaves_the_loop_that_it_hangs_on() -> None:
    found = traced((0, 1), (1, 2), (2, 0), (2, 3), (3, 4))
    assert [curves_of(loop) for loop in found.loops] == [[0, 1, 2]]
    assert [curves_of(chain) for chain in found.open] == [[3, 4]]
    assert found.branches.tolist() == [2]


def test_loops_that_hang_on_loops_are_taken_out_one_after_the_other() -> None:
    # A row of triangles; only the two at its ends meet the others in one node.
    row = [edge for k in range(500) for edge in ((2 * k, 2 * k + 2), (2 * k + 2, 2 * k + 1), (2 * k + 1, 2 * k))]
    found = traced(*row)
    assert [sorted(curves_of(loop)) for loop in found.loops] == [[3 * k, 3 * k + 1, 3 * k + 2] for k in range(500)]
    assert found.ambiguous == []


def test_three_ways_between_two_nodes_are_ambiguous() -> None:
    found = traced((0, 1), (0, 2), (2, 1), (1, 0))
    assert found.loops == []
    assert [curves_of(chain) for chain in found.ambiguous] == [[0], [1, 2], [3]]
    assert found.branches.tolist() == [0, 1]


def test_a_curve_from_a_node_to_itself_is_a_loop() -> None:
    assert traced((0, 0), (0, 1), (1, 2)).loops == [[0]]


def test_specks_take_no_part() -> None:
    labels = np.array([[0, 1], [1, 0], [0, 0]])
    found = chains.trace(Nodes(labels, np.zeros((2, 2)), np.array([False, False, True])))
    assert (found.loops, found.open) == ([[0, 2]], [])


@settings(deadline=None, max_examples=300)
@given(st.lists(st.tuples(st.integers(0, 8), st.integers(0, 8)), min_size=1, max_size=16))
def test_every_curve_is_in_one_chain_and_no_loop_is_a_guess(edges: list[tuple[int, int]]) -> None:
    found = traced(*edges)
    every = [*found.loops, *found.open, *found.ambiguous]
    assert sorted(curve for chain in every for curve in curves_of(chain)) == list(range(len(edges)))
    ends = np.array(edges).reshape(-1)
    for chain in every:
        arrivals, departures = ends[[step ^ 1 for step in chain]], ends[chain]
        assert (arrivals[:-1] == departures[1:]).all()
        assert chain[0] == min(chain) if chain in found.loops else min(chain) % 2 == 0
    for loop in found.loops:
        assert ends[loop[-1] ^ 1] == ends[loop[0]]
    degree = np.bincount(ends, minlength=9)
    assert found.branches.tolist() == np.flatnonzero(degree > 2).tolist()
    left = np.bincount(
        ends[[end for chain in found.ambiguous for end in (chain[0], chain[-1] ^ 1)]].astype(np.int64), minlength=9
    )
    assert set(left.tolist()).isdisjoint({1, 2})


@pytest.mark.parametrize("seed", range(3))
def test_the_order_of_the_curves_does_not_change_what_is_a_loop(seed: int) -> None:
    random = np.random.default_rng(seed)
    edges = random.integers(0, 12, (18, 2))
    order = random.permutation(18)

    def sets(found: Chains, names: np.ndarray) -> set[frozenset[int]]:
        return {frozenset(int(names[curve]) for curve in curves_of(loop)) for loop in found.loops}

    as_given = traced(*(tuple(edge) for edge in edges.tolist()))
    shuffled = traced(*(tuple(edge) for edge in edges[order].tolist()))
    assert sets(as_given, np.arange(18)) == sets(shuffled, order)
