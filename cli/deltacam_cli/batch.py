"""``deltacam batch``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from deltacam.errors import DeltacamError
from deltacam.units import parse_duration, parse_memory
from deltacam_cli import options
from deltacam_cli.main import EXIT_FAILED, EXIT_INTERRUPTED, LONGEST_MESSAGE, show_json
from deltacam_cli.planning import HOW_NAMES, JOBS, how, how_options, planning_options, settings
from deltacam_cli.progress import PartsProgress, stopping_cleanly

if TYPE_CHECKING:
    from deltacam.batch.choosing.find import Found
    from deltacam.batch.choosing.rules import Rules, Wanted
    from deltacam.batch.parts import Batch, Part
    from deltacam.batch.run import Planner
    from deltacam.defaults import Defaults

PATH: Final = click.Path(path_type=Path)
_MACHINES: Final = ("jobs", "time_limit", "memory", "scheduler", "tls_ca", "tls_cert", "tls_key")
_TIME: Final = (1.0, 7 * 86400.0)
_MEMORY: Final = (500e6, 1e15)


@click.command("batch", no_args_is_help=True)
@click.argument("folder", type=PATH)
@click.option("-o", "--output", type=PATH, default=Path("out"), show_default=True, help="Folder for the results.")
@click.option("--include", metavar="PATTERN", multiple=True, help="Only drawings like this: 'brackets/*'; repeatable.")
@click.option("--exclude", metavar="PATTERN", multiple=True, help="No drawings like this; may be repeated.")
@click.option("--list", "listed", metavar="FILE", help="Only the drawings that FILE names, one a line; - for stdin.")
@click.option("--rules", metavar="FILE", type=PATH, help="What is different for which parts; else FOLDER/batch.toml.")
@planning_options
@how_options
@click.option("--jobs", type=JOBS, help="Parts that are planned at a time. 0: as many as there are cores.")
@click.option("--time-limit", default="10min", show_default=True, help="What a part may take: 90s, 10min, none.")
@click.option("--memory", metavar="SIZE", help="What a process may take: 2GB, none; else its share of the machine's.")
@click.option("--force", is_flag=True, help="Plan also what is there and has not changed.")
@click.option("--scheduler", metavar="ADDRESS", help="Plan on a Dask cluster: tcp://host:8786, or tls://...")
@click.option("--tls-ca", metavar="FILE", type=PATH, help="For tls://: the certificate of your own authority.")
@click.option("--tls-cert", metavar="FILE", type=PATH, help="For tls://: our certificate.")
@click.option("--tls-key", metavar="FILE", type=PATH, help="For tls://: our key.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object instead of the summary.")
def command(
    folder: Path,
    output: Path,
    *,
    include: tuple[str, ...],
    exclude: tuple[str, ...],
    listed: str | None,
    rules: Path | None,
    as_json: bool,
    force: bool,
    **values: Any,
) -> None:
    """Plan and verify every drawing (DXF) in FOLDER and in its subfolders.

    Writes what plan writes, in the same subfolders, and batch.json, batch.csv and index.html over all. What is there
    and has not changed is not planned again, so a batch that was stopped goes on where it was.

    \b
    deltacam batch parts -o out
    deltacam batch parts -o out --include 'brackets/*' --process my-steel.toml
    find parts -name '*.dxf' -newer stamp | deltacam batch parts -o out --list -
    """
    from deltacam.batch.choosing.find import find
    from deltacam.batch.run import run

    found = find(folder, include=include, exclude=exclude, listed=None if listed is None else _names(listed))
    wanted = _rules(rules, folder)
    planner = _planner(**{name: values.pop(name) for name in _MACHINES})
    parts = _parts(found, wanted, values)
    notes = [*_laser_off(values), *found.notes, *_unused(wanted, parts)]
    with planner as planned_by, PartsProgress(parts) as progress, stopping_cleanly() as stop:
        batch = run(parts, output, planner=planned_by, force=force, notes=notes, stop=stop.event, tell=progress)
    _show(batch, output, as_json=as_json)
    if stop.asked:
        raise click.exceptions.Exit(EXIT_INTERRUPTED)
    if not batch.passed:
        raise click.exceptions.Exit(EXIT_FAILED)


def _names(listed: str) -> tuple[str, ...]:
    """The names in a file, or on stdin.

    Raises:
        DeltacamError: it cannot be read.
    """
    from deltacam.batch.choosing.find import names_in

    try:
        with click.open_file(listed, "rb") as stream:
            return names_in(stream.read())
    except OSError as problem:
        reason = (problem.strerror or str(problem)).lower()
        hint = "name a text file, or - for stdin"
        raise DeltacamError(f"the list cannot be read: {reason}", where=f"--list {listed}", hint=hint) from problem


def _rules(file: Path | None, folder: Path) -> Rules:
    from deltacam.batch.choosing import rules

    return rules.find_rules(folder) if file is None else rules.read(file)


def _laser_off(values: Mapping[str, Any]) -> list[str]:
    """What a person should know of programs that cut nothing."""
    if values["frame"]:
        return ["planned with --frame: every program traces a bounding box, with the laser off"]
    return ["planned with --dry-run: the laser is off in every program"] if values["dry_run"] else []


def _unused(rules: Rules, parts: Sequence[Part]) -> list[str]:
    """What a person should know of rules that say nothing about any part."""
    patterns = rules.unused([part.name for part in parts])
    return [f"{Path(rules.file).name}: no part of this batch is like {pattern!r}" for pattern in patterns]


def _parts(found: Found, rules: Rules, values: Mapping[str, Any]) -> list[Part]:
    """The parts with their options; a robot, a process and what goes with them are read once.

    Raises:
        DeltacamError: an option or a rule is wrong.
    """
    from deltacam.batch.parts import Part

    own = options.defaults()
    given = how(**{name: values[name] for name in HOW_NAMES})
    others = {name: value for name, value in values.items() if name not in HOW_NAMES}
    known: dict[tuple[str | None, ...], dict[str, Any]] = {}
    parts = []
    for name, path in found.drawings:
        wanted = rules.settings_of(name)
        key = (wanted.robot, wanted.process, wanted.units)
        if key not in known:
            known[key] = {**_settings(own, wanted, rules.file, others), **given}
        parts.append(Part(name, path, known[key], wanted.quantity))
    return parts


def _settings(own: Defaults, wanted: Wanted, file: str, values: Mapping[str, Any]) -> dict[str, Any]:
    """What the command line says, else the rules, else the user's own defaults."""
    from_rules = {"robot": wanted.robot, "process": wanted.process, "units": wanted.units}
    chosen = {name: value for name, value in from_rules.items() if values[name] is None and value is not None}
    try:
        return settings(own, **{**values, **chosen})
    except DeltacamError as problem:
        if problem.where or not chosen:
            raise
        raise DeltacamError(problem.what, where=file, hint=problem.hint) from problem


@contextmanager
def _planner(
    *, jobs: int | None, time_limit: str, memory: str | None, scheduler: str | None, **tls: Path | None
) -> Iterator[Planner]:
    """What plans: processes here, or those of a cluster.

    Raises:
        DeltacamError: a value is wrong, or the cluster cannot be used.
    """
    from deltacam.batch.cluster.scheduler import tls_of
    from deltacam.batch.parts import Limits
    from deltacam.batch.planning import local
    from deltacam.machine import cores, share_of_memory

    time = options.bounded("--time-limit", time_limit, parse_duration, _TIME, "from 1 s to 168 h")
    own = None if memory is None else options.bounded("--memory", memory, parse_memory, _MEMORY, "500 MB or more")
    files = tls_of(*(tls[name] for name in ("tls_ca", "tls_cert", "tls_key")))
    if scheduler is None:
        if files is not None:
            raise click.UsageError("--tls-ca, --tls-cert and --tls-key are for --scheduler tls://...")
        processes = jobs or cores()
        size = share_of_memory(processes) if memory is None else own
        yield partial(local.results, jobs=processes, limits=Limits(time, size))
        return
    from deltacam.batch.cluster.connection import connect
    from deltacam.batch.cluster.elsewhere import results

    if jobs:
        raise click.UsageError("--jobs is for this machine; a cluster plans as many parts as its workers have threads")
    with connect(scheduler, tls=files, tell=_say) as cluster:
        yield partial(results, cluster=cluster, limits=Limits(time, own), share_memory=memory is None)


def _say(what: str) -> None:
    click.echo(f"note: {what}", err=True)


def _show(batch: Batch, output: Path, *, as_json: bool) -> None:
    from deltacam.batch.results.listing import to_dict
    from deltacam.batch.results.text import to_text
    from deltacam.batch.run import SUMMARIES
    from deltacam.plain import plain

    if as_json:
        show_json(to_dict(batch))
        return
    click.echo(to_text(batch))
    for name in SUMMARIES:
        click.echo(f"wrote {plain(str(output / name), longest=LONGEST_MESSAGE)}")
