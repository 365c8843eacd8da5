"""``deltacam robot design``."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from deltacam.errors import DeltacamError
from deltacam_cli import options
from deltacam_cli.main import LONGEST_MESSAGE
from deltacam_cli.progress import ProgressLine
from deltacam_cli.studies import show, study_options

if TYPE_CHECKING:
    from deltacam.robot.synthesis.synthesis import Design
    from deltacam.robot.synthesis.wish import Wish


@click.command("design", no_args_is_help=True)
@click.option("--box", metavar="X,Y,Z", help="The workspace: a box of these sides, mm unless a unit is given.")
@click.option("--cylinder", metavar="D,H", help="The workspace: an upright cylinder of this diameter and height.")
@click.option("--joint-range", metavar="MIN,MAX", default="-50,90", show_default=True, help="Of the joints, deg.")
@click.option("--condition", type=float, default=0.33, show_default=True, help="Smallest 1/cond of the Jacobian.")
@click.option("--max-mu2", metavar="ANGLE", default="60", show_default=True, help="Largest pressure angle mu2, deg.")
@click.option("--max-mu1", metavar="ANGLE", help="Largest pressure angle mu1, deg.")
@click.option("--max-swing", metavar="ANGLE", help="Largest swing of the forearms out of their arms' planes, deg.")
@click.option("--base-radius-min", metavar="LENGTH", help="Least radius of the base: the room for the motors.")
@click.option("--head-radius", metavar="LENGTH", help="Radius of the effector: the room for the head.")
@click.option("--clearance", metavar="LENGTH", default="1", show_default=True, help="From base to workspace, at least.")
@click.option(
    "--max-size", metavar="LENGTH", help="Largest (R - r) + La + Lb; five diagonals of the workspace unless given."
)
@click.option("--speed", metavar="SPEED", help="Rated speed of the tool, mm/s unless a unit is given: 60m/min.")
@click.option("--acceleration", type=float, metavar="M/S2", help="Rated acceleration of the tool, m/s2.")
@click.option("--max-joint-speed", type=float, metavar="DEG/S", help="Most a joint may need for the rated speed.")
@click.option("--max-joint-acceleration", type=float, metavar="DEG/S2", help="Most a joint may need for both ratings.")
@click.option("--max-error", metavar="LENGTH", help="Most the tool may move when every joint errs by --encoder-step.")
@click.option("--encoder-step", metavar="ANGLE", help="Error of a joint, deg.")
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True, help="Of the search's random numbers.")
@click.option("--pareto", is_flag=True, help="The smallest robot for each of a row of 1/cond from 0.2 to 0.8.")
@click.option("--sheet-z", metavar="LENGTH", help="Height of the sheet in FILE; the middle unless given.")
@click.option("-o", "output", metavar="FILE", type=click.Path(path_type=Path), help="Write the robot file (.toml).")
@study_options
def command(*, html: Path | None, as_json: bool, **given: Any) -> None:
    """Find the smallest robot for a prescribed workspace.

    The robot reaches the whole box or cylinder within the demands, which is proved and not only sampled. It is sought
    by differential evolution, then polished; the same seed gives the same robot. The front of --pareto shows what
    dexterity costs in size.

    \b
    deltacam robot design --box 300,300,20 --base-radius-min 100 --head-radius 40 -o my-robot.toml
    deltacam robot design --cylinder 400,50 --condition 0.5 --html design.html
    deltacam robot design --box 300,300,20 --pareto --html front.html
    """
    from deltacam.report.studies import design as studies
    from deltacam.robot.synthesis.front import front
    from deltacam.robot.synthesis.synthesis import design

    output = given["output"]
    if given["pareto"] and output is not None:
        raise click.UsageError("--pareto finds several robots; write one with --condition and -o")
    if output is not None and output.suffix.lower() != ".toml":
        raise DeltacamError(f"{str(output)!r} is not the name of a robot file", where="-o", hint="end it in .toml")
    wish = _wish(given)
    with ProgressLine() as progress:
        if given["pareto"]:
            study = studies.front_study(front(wish, seed=given["seed"], progress=progress))
        else:
            found = design(wish, seed=given["seed"], progress=progress)
            study = studies.study(found)
    if output is not None:
        _write(found, output, options.length("--sheet-z", given["sheet_z"]))
    show(study, as_json=as_json, html=html)
    if output is not None and not as_json:
        from deltacam.plain import plain

        click.echo(f"wrote {plain(str(output), longest=LONGEST_MESSAGE)}")


def _wish(given: dict[str, Any]) -> Wish:
    """What the options ask.

    Raises:
        DeltacamError: a value is not what the option takes, or out of range.
    """
    from deltacam.robot.synthesis.wish import Wish

    low, high = (
        options.angle("--joint-range", text) for text in _parts("--joint-range", given["joint_range"], "-50,90")
    )
    lengths = ("base_radius_min", "head_radius", "clearance", "max_size", "max_error")
    measured = {name: options.length(_option(name), given[name]) for name in lengths}
    return Wish(
        shape=_shape(given["box"], given["cylinder"]),
        joint_min=low,
        joint_max=high,
        min_inverse_condition=given["condition"],
        max_transmission_angle=options.angle("--max-mu2", given["max_mu2"]),
        max_drive_angle=_angle("--max-mu1", given["max_mu1"]),
        max_forearm_swing=_angle("--max-swing", given["max_swing"]),
        base_radius_min=measured["base_radius_min"],
        head_radius=measured["head_radius"],
        clearance=measured["clearance"] or 0.0,
        max_size=measured["max_size"],
        speed=options.speed("--speed", given["speed"]),
        acceleration=given["acceleration"],
        max_joint_speed=_radians(given["max_joint_speed"]),
        max_joint_acceleration=_radians(given["max_joint_acceleration"]),
        max_error=measured["max_error"],
        encoder_step=_angle("--encoder-step", given["encoder_step"]),
    )


def _shape(box: str | None, cylinder: str | None) -> Any:
    from deltacam.robot.synthesis.shape import BoxShape, CylinderShape

    if (box is None) == (cylinder is None):
        hint = "write --box 300,300,20 or --cylinder 300,20"
        raise DeltacamError("the workspace must be either a box or a cylinder", where="--box, --cylinder", hint=hint)
    if box is not None:
        width, depth, height = (options.length("--box", part) or 0.0 for part in _parts("--box", box, "300,300,20"))
        return BoxShape(width, depth, height)
    diameter, height = (
        options.length("--cylinder", part) or 0.0 for part in _parts("--cylinder", cylinder or "", "300,20")
    )
    return CylinderShape(diameter, height)


def _parts(option: str, text: str, example: str) -> list[str]:
    """The parts of a text between commas, as many as the example has."""
    parts = text.split(",")
    count = len(example.split(","))
    if len(parts) != count:
        raise DeltacamError(f"{text!r} is not {count} numbers", where=option, hint=f"write it like {example}")
    return parts


def _option(name: str) -> str:
    return f"--{name.replace('_', '-')}"


def _angle(option: str, text: str | None) -> float | None:
    return None if text is None else options.angle(option, text)


def _radians(degrees: float | None) -> float | None:
    return None if degrees is None else math.radians(degrees)


def _write(design: Design, output: Path, sheet_z: float | None) -> None:
    """Write the robot file, whole or not at all.

    Raises:
        DeltacamError: it cannot be written, or the robot cannot do what the file says.
    """
    from deltacam.program.atomic import write_whole
    from deltacam.robot.synthesis.machine import machine
    from deltacam.robot.writer import to_toml

    write_whole(output, to_toml(machine(design, name=output.stem, sheet_z=sheet_z)).encode())
