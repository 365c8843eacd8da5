"""``deltacam robot budget``."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

from deltacam.errors import DeltacamError
from deltacam_cli import options
from deltacam_cli.studies import show, study_options

if TYPE_CHECKING:
    from deltacam.robot.accuracy.sources import Errors

Command = TypeVar("Command", bound=Callable[..., Any])

_OPTIONS: Final = {
    "encoder": ("--encoder", "16bit", "ANGLE", "Step of the encoders of the joints: 16bit, 20arcsec, 0.01deg."),
    "backlash": ("--backlash", "1arcmin", "ANGLE", "Play of the joints, its whole width."),
    "upper_arm": ("--arm-error", "0.05", "LENGTH", "+- of the length of each upper arm, mm unless a unit is given."),
    "forearm": ("--forearm-error", "0.05", "LENGTH", "+- of the length of each forearm."),
    "base_radius": ("--base-error", "0.05", "LENGTH", "+- of each joint's distance from the centre of the base."),
    "effector_radius": ("--effector-error", "0.05", "LENGTH", "+- likewise, of each forearm's joint on the effector."),
    "azimuth": ("--azimuth-error", "1arcmin", "ANGLE", "+- of the direction in which each arm stands."),
    "sheet": ("--sheet-error", "0.2", "LENGTH", "+- of the height of the sheet."),
}
"""For each error its option, the default, what it is, and its help."""

_LARGEST_WANTED: Final = 0.1  # m


def _error_options(command: Command) -> Command:
    for name, (option, default, kind, text) in reversed(_OPTIONS.items()):
        command = click.option(option, name, metavar=kind, default=default, show_default=True, help=text)(command)
    return command


@click.command("budget")
@click.argument("robot", required=False)
@_error_options
@click.option("--wanted", metavar="LENGTH", help="Accuracy in x and y to find the errors for.  [default: tolerance]")
@click.option("--process", help="Whose kerf and tolerance to compare with: a built-in name, or a file (.toml).")
@study_options
def command(
    robot: str | None,
    *,
    wanted: str | None,
    process: str | None,
    html: Path | None,
    as_json: bool,
    **errors: str,
) -> None:
    """Show how exactly ROBOT can cut: what errors of its joints and lengths do at the tool.

    A table of what each source of errors does, where it is worst, and its share; all of them together against the kerf
    and the tolerance; and what each must be for a wanted accuracy. Angles are degrees, lengths mm unless a unit is
    given. The defaults are assumptions about a machine built with care: give what you know of yours.

    \b
    deltacam robot budget delta-300
    deltacam robot budget my-robot.toml --encoder 20bit --backlash 20arcsec --wanted 0.05
    """
    from deltacam.cutting.process import DEFAULT_PROCESS, load_process
    from deltacam.report.studies.budget import study
    from deltacam.robot.accuracy.budget import budget
    from deltacam.robot.accuracy.wanted import needs

    own = options.defaults()
    machine = options.robot(robot, own)
    cutting = options.load(load_process, process, own.process, DEFAULT_PROCESS, f"{own.file}: process")
    assumed, accuracy = _errors(errors), _wanted(wanted)
    found = budget(machine, assumed)
    asked = needs(machine, found, wanted=cutting.tolerance if accuracy is None else accuracy)
    shown = study(machine, found, asked, process=cutting.name, kerf=cutting.kerf, tolerance=cutting.tolerance)
    show(shown, as_json=as_json, html=html)


def _errors(given: dict[str, str]) -> Errors:
    """The errors that the options state.

    Raises:
        DeltacamError: a value is wrong; names its option.
    """
    from deltacam.robot.accuracy.sources import Errors

    read = {"ANGLE": options.fine_angle, "LENGTH": options.length}
    values = {name: read[kind](option, given[name]) for name, (option, _, kind, _) in _OPTIONS.items()}
    try:
        return Errors(**{name: value or 0.0 for name, value in values.items()})
    except DeltacamError as problem:
        raise DeltacamError(problem.what, where=_OPTIONS[problem.where][0], hint=problem.hint) from problem


def _wanted(text: str | None) -> float | None:
    wanted = options.length("--wanted", text)
    if wanted is not None and not 0.0 < wanted <= _LARGEST_WANTED:
        hint = f"it must be more than 0 and at most {_LARGEST_WANTED * 1e3:g} mm"
        raise DeltacamError(f"an accuracy of {wanted * 1e3:.6g} mm is out of range", where="--wanted", hint=hint)
    return wanted
