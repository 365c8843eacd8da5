"""What must be the same wherever parts of one batch are planned, so that a part gives the same bytes anywhere."""

from __future__ import annotations

import platform
from collections.abc import Callable, Collection, Iterable, Mapping
from importlib import metadata
from typing import Any, Final, Protocol

from deltacam.batch.planning.key import source

PACKAGES: Final = ("deltacam", "numpy", "scipy", "shapely", "toppra", "ezdxf", "plotly", "distributed")
"""Programs and reports follow from these; Dask itself wants the last to be the same."""

PYTHON: Final = "Python"
SOURCE: Final = "source of deltacam"
MISSING: Final = "missing"


class Run(Protocol):
    """Calls a function on workers; what it returns, or the exception that it raises, by their addresses."""

    def __call__(self, function: Callable[..., Any], *given: Any, workers: Collection[str]) -> dict[str, Any]:
        """None of the answers is missing but for workers that have gone."""


def here() -> dict[str, str]:
    """The versions on this machine, and what deltacam's own source is."""
    return {PYTHON: python(platform.python_version()), **{name: _version(name) for name in PACKAGES}, SOURCE: source()}


def python(full: str) -> str:
    """The major and minor version: 3.12 of 3.12.4."""
    return ".".join(full.split(".")[:2])


def differences(there: Mapping[str, str], ours: Mapping[str, str]) -> str:
    """In what another machine differs, in words; empty where it does not. What is not known of it does not count."""
    return ", ".join(
        f"{name} {found} (here {ours[name]})" for name, found in there.items() if name in ours and found != ours[name]
    )


def remedy(found: Iterable[Mapping[str, str]], ours: Mapping[str, str]) -> str:
    """What to do on the other machines so that none differs any more."""
    found = list(found)
    differing = [name for name in PACKAGES if any(there.get(name, ours[name]) != ours[name] for there in found)]
    if not differing:
        return "let all have the same Python, and deltacam from the same place; then start the workers again"
    return f"there, pip install {' '.join(f'{name}=={ours[name]}' for name in differing)}; then start them again"


def of_workers(run: Run, workers: Collection[str], ours: Mapping[str, str]) -> dict[str, dict[str, str]]:
    """The versions on workers, by their addresses, without those that do not answer.

    Args:
        run: what a function returns or raises on workers.
        workers: which.
        ours: where a worker has the same, it is asked for its source too.
    """
    if not workers:
        return {}
    # By functions of Python's own library: those of ours may not be there, or not run.
    answers = run(platform.python_version, workers=workers)
    found = {worker: {PYTHON: python(full)} for worker, full in answers.items() if isinstance(full, str)}
    for name in PACKAGES:
        answers = run(metadata.version, name, workers=list(found))
        for worker in list(found):
            answer = answers.get(worker)
            if isinstance(answer, (str, metadata.PackageNotFoundError)):
                found[worker][name] = answer if isinstance(answer, str) else MISSING
            else:
                del found[worker]
    same = [worker for worker, there in found.items() if not differences(there, ours)]
    for worker, answer in run(by_code("deltacam.batch.cluster.remote", "source"), workers=same).items():
        found[worker][SOURCE] = answer if isinstance(answer, str) else MISSING
    return found


def by_code(module: str, name: str) -> Callable[..., Any]:
    """A function of a module, made so that whoever gets it needs the module only once it is called.

    Of a function that is defined in another one, Dask sends the code and not the name.
    """

    def call(*given: Any) -> Any:
        from importlib import import_module

        return getattr(import_module(module), name)(*given)

    return call


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return MISSING
