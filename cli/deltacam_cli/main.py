"""The command ``deltacam`` and what its commands share: loading late, errors and exit codes."""

from __future__ import annotations

import difflib
import importlib
import json
import keyword
import sys
import traceback
from collections.abc import Mapping
from typing import Any, Final, NoReturn

import click

from deltacam.errors import DeltacamError

COMMANDS: Final = {
    "inspect": "Show what is in DRAWING, and what plan would make of it.",
    "plan": "Plan DRAWING and verify the program.",
    "batch": "Plan and verify every drawing in FOLDER.",
    "verify": "Verify PROGRAM, trusting nothing the planner said.",
    "export": "Write PROGRAM in another format.",
    "process": "Choose a process, make one of your own, draw test cuts.",
    "robot": "Study a robot: what it can do, where, and how exactly.",
}
"""The commands and their short help. A command ``x`` is ``deltacam_cli.x:command``; it is imported when it is used."""

EXIT_FAILED: Final = 1
EXIT_INPUT: Final = 2
EXIT_FAULT: Final = 3
EXIT_INTERRUPTED: Final = 130
EXIT_PIPE_CLOSED: Final = 141

LONGEST_MESSAGE: Final = 4000
"""Characters of a message that are shown; a hostile file may hold a name of any length."""


class LateGroup(click.Group):
    """A group whose commands are imported when they are used, so that ``--help`` is instant."""

    def __init__(self, *args: Any, table: Mapping[str, str], package: str, **options: Any) -> None:
        """Take the short help of every command from ``table``; a command ``x`` is in the module ``x`` of a package."""
        super().__init__(*args, **options)
        self._table = table
        self._package = package

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The names of the commands."""
        return list(self._table)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        """The command of that name, imported."""
        if name not in self._table:
            return None
        module = f"{name}_" if keyword.iskeyword(name) else name
        command: click.Command = importlib.import_module(f"{self._package}.{module}").command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(self._table.items()))

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command that the first argument names; a drawing in its place is answered with what to type."""
        if args and args[0].lower().endswith(".dxf") and "plan" in self._table:
            ctx.fail(f"no command given; did you mean `deltacam plan {args[0]}`?")
        if args and args[0] not in self._table:
            near = difflib.get_close_matches(args[0], self._table, n=1)
            ctx.fail(f"no such command {args[0]!r}" + (f"; did you mean {near[0]!r}?" if near else ""))
        return super().resolve_command(ctx, args)


@click.group(
    cls=LateGroup, table=COMMANDS, package="deltacam_cli", context_settings={"help_option_names": ["-h", "--help"]}
)
@click.version_option(package_name="deltacam", prog_name="deltacam")
@click.option("--traceback", is_flag=True, help="On a fault of deltacam itself, show where it happened.")
def cli(traceback: bool) -> None:
    """From a DXF drawing to a verified robot program for a delta-robot laser cutter.

    \b
    deltacam inspect part.dxf               shows what is in the drawing
    deltacam plan part.dxf                  writes part.program.csv and its reports
    deltacam batch parts -o out             does that for every drawing in a folder
    deltacam verify part.program.csv        checks it again, independently
    deltacam export part.program.csv --to gcode
    deltacam process list                   lists materials and lasers that are known
    deltacam robot show delta-300           shows what a robot can do

    Exit codes: 0 done and every check passed; 1 a check failed; 2 the command line, robot, process or drawing must be
    changed; 3 a fault of deltacam; 130 interrupted.
    """


def main() -> NoReturn:
    """Run the command line and exit with the documented code."""
    arguments = sys.argv[1:]
    as_json = "--json" in arguments
    try:
        # Not cli.main, which turns a closed pipe into exit code 1: here that means a failed check.
        with cli.make_context("deltacam", list(arguments)) as context:
            code = cli.invoke(context)
    except (click.exceptions.Abort, KeyboardInterrupt):
        code = _interrupted()
    except click.exceptions.Exit as problem:
        code = problem.exit_code
    except click.ClickException as problem:
        code = _refused_by_click(problem, as_json)
    except DeltacamError as problem:
        code = refused(problem.what, problem.where, problem.hint, as_json)
    except BrokenPipeError:
        # Who read the result has gone; without this Python complains once more while it shuts down.
        sys.stdout = None
        code = EXIT_PIPE_CLOSED
    except Exception as problem:  # noqa: BLE001 - the last resort, so that no bare traceback reaches the user
        code = _fault(problem, "--traceback" in arguments, as_json)
    sys.exit(code if isinstance(code, int) else 0)


def _interrupted() -> int:
    click.echo("interrupted; nothing half-written is left", err=True)
    return EXIT_INTERRUPTED


def _refused_by_click(problem: click.ClickException, as_json: bool) -> int:
    if isinstance(problem, click.exceptions.NoArgsIsHelpError):
        problem.show()
        return EXIT_INPUT
    context = problem.ctx if isinstance(problem, click.UsageError) else None
    command = context.command_path if context else "deltacam"
    what = problem.format_message().rstrip(".")
    return refused(what[:1].lower() + what[1:], "", f"see `{command} --help`", as_json)


def refused(what: str, where: str, hint: str, as_json: bool) -> int:
    """Say what the user must change, and where and how; returns the exit code for it."""
    if as_json:
        show_json({"passed": False, "error": {"what": what, "where": where, "hint": hint}})
    from deltacam.plain import plain

    message = f"{where}: {what}" if where else what
    click.echo(f"error: {plain(message, longest=LONGEST_MESSAGE)}", err=True)
    if hint:
        click.echo(f"hint: {plain(hint, longest=LONGEST_MESSAGE)}", err=True)
    return EXIT_INPUT


def _fault(problem: Exception, show: bool, as_json: bool) -> int:
    what = f"a fault of deltacam: {type(problem).__name__}: {problem}"
    if show:
        click.echo("".join(traceback.format_exception(problem)), err=True)
    refused(what, "", "report it with the drawing and the output of `deltacam --traceback ...`", as_json)
    return EXIT_FAULT


def show_json(result: dict[str, Any]) -> None:
    """Print the one JSON object of ``--json``."""
    click.echo(json.dumps(result, allow_nan=False, indent=2))
