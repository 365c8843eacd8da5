"""A batch that is disturbed at every step at which it changes the disk."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from tests.batch.scene import ROOT

MEMORY = Path("/dev/shm")  # noqa: S108 - where there is one: a disk that need not be waited for


@pytest.mark.skipif(sys.platform != "linux", reason="makes copies of a process")
def test_a_batch_that_is_killed_fails_to_write_or_is_interrupted_at_any_step_goes_on_as_if_nothing_had_been(
    tmp_path: Path,
) -> None:
    with tempfile.TemporaryDirectory(dir=MEMORY if MEMORY.is_dir() else tmp_path) as scratch:
        command = [sys.executable, "-m", "tests.batch.steps", scratch]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    *flaws, steps = done.stdout.splitlines() or [done.stderr]
    assert flaws == []
    assert int(steps) > 50
