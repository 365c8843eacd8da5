"""``deltacam verify``."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from deltacam.errors import DeltacamError
from deltacam_cli.main import EXIT_FAILED, EXIT_INPUT, LONGEST_MESSAGE, refused, show_json
from deltacam_cli.progress import ProgressLine

if TYPE_CHECKING:
    from deltacam.examine import Verified
    from deltacam.verification.difference import Difference

PATH = click.Path(path_type=Path)


@click.command("verify", no_args_is_help=True)
@click.argument("programs", metavar="PROGRAM...", nargs=-1, required=True, type=PATH)
@click.option("--drawing", type=PATH, help="Also check the cut against this DXF file, or that of its name in a folder.")
@click.option("--robot", help="Also check that the program is for this robot: a built-in name or a file.")
@click.option("--process", help="Also check that it cuts like this process: a built-in name or a file.")
@click.option("--against", metavar="PROGRAM", type=PATH, help="Also show what is different from this older program.")
@click.option("--strict", is_flag=True, help="Fail on warnings too, and where a check could not be made.")
@click.option("--checks", "every_check", is_flag=True, help="List every check, also those that passed.")
@click.option("--html", metavar="FILE", type=PATH, help="Write the report as a page; for several programs, a folder.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object instead of the summary.")
def command(
    programs: tuple[Path, ...],
    *,
    drawing: Path | None,
    robot: str | None,
    process: str | None,
    against: Path | None,
    strict: bool,
    every_check: bool,
    html: Path | None,
    as_json: bool,
) -> None:
    """Verify every PROGRAM, trusting nothing the planner said.

    Positions are recomputed from the joint setpoints, and the cut is measured against the drawing itself.

    \b
    deltacam verify out/part.program.csv --drawing part.dxf
    deltacam verify out/*.program.csv --drawing parts --strict
    deltacam verify new.program.csv --against old.program.csv
    """
    from deltacam.examine import examine

    several = len(programs) > 1
    if several and against is not None:
        raise click.UsageError("--against compares one program with one other")
    pages = {} if html is None else _pages(html, programs, drawing)
    given: dict[str, Any] = {"drawing": drawing, "robot": robot, "process": process}
    results = []
    for count, path in enumerate(programs):
        try:
            with ProgressLine() as progress:
                progress("verify", count, len(programs))
                verified = examine(path, **given)
                different = None if against is None else _difference(verified, against, given)
                if path in pages:
                    _write_page(verified, pages[path])
        except DeltacamError as problem:
            if not several:
                raise
            results.append(_unread(path, problem))
            continue
        passed = verified.report.passed and not (strict and verified.report.warnings)
        results.append(_listed(path, verified, different, passed=passed))
        if not as_json:
            _show(path, verified, different, every_check=every_check, strict=strict, several=several)
            _say_wrote(pages.get(path))
    _finish(results, as_json=as_json)


def _pages(html: Path, programs: tuple[Path, ...], drawing: Path | None) -> dict[Path, Path]:
    """Where the page of every program goes: in the folder ``html`` where there are several.

    Raises:
        DeltacamError: pages would overwrite each other, or what they are made from; or there can be no such folder.
    """
    if len(programs) == 1:
        for read in (*programs, *filter(None, (drawing,))):
            if html.exists() and read.exists() and html.samefile(read):
                what, hint = "the page would overwrite what it is made from", "give it a name of its own: part.html"
                raise DeltacamError(what, where=f"--html {html}", hint=hint)
        return {programs[0]: html}
    from deltacam.program.formats import name_of
    from deltacam.program.outputs import make_folder

    pages = {path: html / f"{name_of(path)}.report.html" for path in programs}
    twice = [page.name for page, count in Counter(pages.values()).items() if count > 1]
    if twice:
        what, hint = f"several programs would write {twice[0]}", "verify programs of one name one by one"
        raise DeltacamError(what, where=f"--html {html}", hint=hint)
    make_folder(html)
    return pages


def _write_page(verified: Verified, path: Path) -> None:
    """Write the page, whole or not at all.

    Raises:
        DeltacamError: the operating system refuses.
    """
    from deltacam.program.atomic import write_whole
    from deltacam.report.html import to_html

    program = replace(verified.program, process=verified.process)
    title = Path(program.drawing.file).stem
    page = to_html(verified.report, program, drawing=verified.drawing, title=title, robot=verified.robot)
    try:
        write_whole(path, page.encode())
    except DeltacamError as problem:
        hint = "choose another file with --html, in a folder that exists"
        raise DeltacamError(problem.what, where=problem.where, hint=hint) from problem


def _difference(verified: Verified, against: Path, given: Mapping[str, Any]) -> Difference:
    """From the older program to the one that is verified."""
    from deltacam.examine import examine
    from deltacam.verification.difference import difference

    older = examine(against, **given)
    return difference((older.program, verified.program), (older.report, verified.report))


def _listed(path: Path, verified: Verified, different: Difference | None, *, passed: bool) -> dict[str, Any]:
    """What JSON says of a program."""
    from deltacam.report.difference import to_dict as difference_to_dict
    from deltacam.report.listing import to_dict

    found = {"program": str(path), **to_dict(verified.report), "passed": passed}
    return found if different is None else {**found, "difference": difference_to_dict(different)}


def _unread(path: Path, problem: DeltacamError) -> dict[str, Any]:
    """Say that one of several programs cannot be read; the others are verified all the same."""
    refused(problem.what, problem.where, problem.hint, as_json=False)
    error = {"what": problem.what, "where": problem.where, "hint": problem.hint}
    return {"program": str(path), "passed": False, "error": error}


def _show(
    path: Path, verified: Verified, different: Difference | None, *, every_check: bool, strict: bool, several: bool
) -> None:
    from deltacam.plain import plain
    from deltacam.report.difference import to_text as difference_to_text
    from deltacam.report.text import to_text

    if several:
        click.echo(f"{plain(str(path), longest=LONGEST_MESSAGE)}:")
    click.echo(to_text(verified.report, every_check=every_check))
    if different is not None:
        click.echo(difference_to_text(different))
    if strict and verified.report.passed and verified.report.warnings:
        warnings = plain("; ".join(verified.report.warnings), longest=LONGEST_MESSAGE)
        click.echo(f"error: not passed with --strict: {warnings}", err=True)


def _say_wrote(page: Path | None) -> None:
    from deltacam.plain import plain

    if page is not None:
        click.echo(f"wrote {plain(str(page), longest=LONGEST_MESSAGE)}")


def _finish(results: list[dict[str, Any]], *, as_json: bool) -> None:
    """The total of several programs, and the exit code: that of the worst of them."""
    passed, unread = sum(one["passed"] for one in results), sum("error" in one for one in results)
    if as_json:
        show_json(results[0] if len(results) == 1 else {"passed": passed == len(results), "programs": results})
    elif len(results) > 1:
        click.echo(f"{passed} of {len(results)} programs passed")
    if passed < len(results):
        raise click.exceptions.Exit(EXIT_INPUT if unread else EXIT_FAILED)
