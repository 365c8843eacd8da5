"""Errors that travel from one process to another."""

import pickle

import pytest

from deltacam.errors import DeltacamError, DrawingError
from deltacam.motion.parametrize import UndrivableError


@pytest.mark.parametrize(
    "error",
    [DeltacamError("what"), DrawingError("what", where="where", hint="hint"), UndrivableError(3, 0.25, 1.0)],
    ids=lambda error: type(error).__name__,
)
def test_an_error_arrives_in_another_process_as_it_was(error: DeltacamError) -> None:
    found = pickle.loads(pickle.dumps(error))  # noqa: S301 - of our own bytes
    assert type(found) is type(error)
    assert vars(found) == vars(error)
    assert str(found) == str(error)
    assert found.args == error.args
