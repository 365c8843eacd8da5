"""A batch that is killed: what is there is whole, and the next run does the rest with the same bytes."""

from pathlib import Path

from tests.batch.killing import campaign, draw


def test_a_batch_that_is_killed_leaves_whole_files_only_and_the_next_run_ends_as_if_nothing_had_been(
    tmp_path: Path,
) -> None:
    draw(tmp_path / "parts", 3)
    found = list(campaign(tmp_path / "parts", tmp_path / "results", moments=5, seed=1, jobs=1))
    assert len(found) == 5
    assert [(one.when, one.flaws) for one in found if one.flaws] == []
