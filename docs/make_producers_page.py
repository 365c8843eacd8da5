"""Write docs/reference/producers.md from the table of producers.

python docs/make_producers_page.py
"""

from __future__ import annotations

from pathlib import Path

from deltacam.robot.producers import UNITS, Produced, read_producers

PAGE = Path(__file__).parent / "reference" / "producers.md"

HEAD = """# Delta robots as published

Made from `deltacam/robot/producers.toml` by `docs/make_producers_page.py`; a test checks that both agree. Numbers are
written as published; `deltacam robot compare --json` has them in SI. A dash is a number that was not found, never zero.

| grade | where a row is from |
|---|---|
| `producer` | a page or data sheet of the producer's, read as a stored copy |
| `library` | public robot libraries and catalogues of others; **not checked against the producer** |
| `paper` | a paper |
| `estimate` | ours |

Look at the data sheet before you rely on a row. Repeatability says how well a place is met again, not how well a path
is kept.

"""


def page() -> str:
    """The text of the page."""
    robots = read_producers()
    heads = ["maker", "model", *(quantity.replace("_", " ") for quantity in UNITS), "grade"]
    lines = [HEAD + "| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    lines += [f"| {' | '.join(_cells(robot))} |" for robot in robots]
    lines += ["", "## Sources", ""]
    lines += [f"- {robot.maker} {robot.model}: {_source(robot)}." for robot in robots]
    return "\n".join(lines) + "\n"


def _cells(robot: Produced) -> list[str]:
    published = dict(robot.published)
    return [robot.maker, robot.model, *(published.get(quantity, "-") for quantity in UNITS), robot.grade]


def _source(robot: Produced) -> str:
    source = f"[{robot.source}]({robot.url})" if robot.url else robot.source
    return f"{source}; {robot.note}" if robot.note else source


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
