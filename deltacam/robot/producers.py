"""The table of delta robots as their producers publish them, in SI."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Final

from deltacam.errors import RobotError
from deltacam.settings import Table, read_table

GRADES: Final = ("producer", "library", "paper", "estimate")
"""Where a row may be from, the best first."""

_FILE: Final = resources.files("deltacam.robot") / "producers.toml"


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit that a quantity may be published in.

    Attributes:
        suffix: of the key in the file.
        factor: of a value, to get SI.
        minimum: smallest value allowed, in that unit.
        maximum: largest value allowed, in that unit.
    """

    suffix: str
    factor: float
    minimum: float
    maximum: float


UNITS: Final[dict[str, tuple[Unit, ...]]] = {
    "workspace_diameter": (Unit("mm", 1e-3, 10.0, 20_000.0), Unit("m", 1.0, 0.01, 20.0)),
    "payload": (Unit("kg", 1.0, 1e-3, 1_000.0), Unit("g", 1e-3, 1.0, 1e6)),
    "repeatability": (Unit("mm", 1e-3, 1e-4, 10.0), Unit("um", 1e-6, 0.1, 10_000.0)),
    "speed": (Unit("m_s", 1.0, 1e-3, 100.0), Unit("mm_s", 1e-3, 1.0, 1e5), Unit("m_min", 1.0 / 60.0, 0.06, 6_000.0)),
    "acceleration": (Unit("m_s2", 1.0, 1e-2, 10_000.0), Unit("mm_s2", 1e-3, 10.0, 1e7), Unit("g", 9.80665, 1e-3, 1e3)),
    "cycle": (Unit("s", 1.0, 0.01, 100.0), Unit("per_min", 1.0, 0.6, 6_000.0)),
}
"""The units of every quantity of the table; a cycle per minute is turned into its time."""


@dataclass(frozen=True, slots=True)
class Produced:
    """A robot as it is published; what is missing is None, never zero.

    Attributes:
        maker: of the robot.
        model: its name.
        workspace_diameter: m.
        payload: kg.
        repeatability: m.
        speed: of the tool, m/s.
        acceleration: of the tool, m/s^2.
        cycle: time of the producer's own pick-and-place cycle, s.
        grade: one of `GRADES`.
        source: in words.
        url: empty where there is none.
        note: what to know about the numbers; may be empty.
        published: the numbers as published, as ``(quantity, "value unit")``.
    """

    maker: str
    model: str
    workspace_diameter: float | None
    payload: float | None
    repeatability: float | None
    speed: float | None
    acceleration: float | None
    cycle: float | None
    grade: str
    source: str
    url: str
    note: str
    published: tuple[tuple[str, str], ...]


def read_producers(path: Path | None = None) -> tuple[Produced, ...]:
    """The table of producers, in the order of the file.

    Args:
        path: of a file like the built-in one, which is read where this is None.

    Raises:
        RobotError: a key or value is wrong, a quantity is given in two units, or a robot is there twice.
    """
    if path is None:
        with resources.as_file(_FILE) as built_in:
            return read_producers(built_in)
    top = read_table(path, error=RobotError)
    tables = top.tables("robot")
    robots = tuple(_robot(table) for table in tables)
    top.finish()
    names = [(robot.maker, robot.model) for robot in robots]
    for index, name in enumerate(names):
        if name in names[:index]:
            raise tables[index].problem(f"{' '.join(name)} is there twice", hint="keep one of them")
    return robots


def _robot(table: Table) -> Produced:
    maker, model = table.text("maker"), table.text("model")
    found = {quantity: _quantity(table, quantity) for quantity in UNITS}
    values = {quantity: None if one is None else one[0] for quantity, one in found.items()}
    return Produced(
        maker=maker,
        model=model,
        grade=table.choice("grade", GRADES),
        source=table.text("source"),
        url=table.text("url", default=""),
        note=table.text("note", default=""),
        published=tuple((quantity, one[1]) for quantity, one in found.items() if one is not None),
        **values,
    )


def _quantity(table: Table, quantity: str) -> tuple[float, str] | None:
    """The value in SI and as published; None where the robot has none.

    Raises:
        RobotError: it is given in two units, or out of its bounds.
    """
    given = [unit for unit in UNITS[quantity] if table.has(f"{quantity}_{unit.suffix}")]
    if not given:
        return None
    if len(given) > 1:
        keys = " and ".join(f"{quantity}_{unit.suffix}" for unit in given)
        raise table.problem(f"{keys} are both given", hint="keep the one that is published")
    unit = given[0]
    value = table.number(f"{quantity}_{unit.suffix}", minimum=unit.minimum, maximum=unit.maximum)
    words = f"{value:g} {unit.suffix.replace('m_', 'm/')}"
    return (60.0 / value if unit.suffix == "per_min" else value * unit.factor), words
