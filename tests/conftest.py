"""Settings that all tests share."""

import os
from pathlib import Path

import pytest
from hypothesis import settings

from deltacam.program.program import Program
from tests.bench import Bench, standard

# The same examples in every run and no time limit per example: the suite must not fail by chance or on a slow machine.
# Long random campaigns are in benchmarks/.
settings.register_profile("deltacam", deadline=None, derandomize=True)
settings.load_profile("deltacam")

# A developer's own deltacam.toml must not change what is tested; there is none in this folder.
os.environ["XDG_CONFIG_HOME"] = str(Path(__file__).parent / "data")


@pytest.fixture(scope="session")
def bench() -> Bench:
    """Builds programs of a test plate without the planner."""
    return standard()


@pytest.fixture(scope="session")
def program(bench: Bench) -> Program:
    """A valid program of the test plate."""
    return bench.program()
