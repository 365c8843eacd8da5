"""``deltacam process show``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from deltacam_cli.main import LONGEST_MESSAGE, show_json

if TYPE_CHECKING:
    from deltacam.cutting.process_file.values import Section
    from deltacam.model import Process


@click.command("show")
@click.argument("process")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object instead of the table.")
def command(process: str, *, as_json: bool) -> None:
    """Show every value of PROCESS, a built-in name or a process file, with its unit, its grade and its source.

    \b
    deltacam process show steel-1mm-fibre
    deltacam process show my-steel.toml --json
    """
    from deltacam.cutting.process import check_process, load_process
    from deltacam.cutting.process_file.values import sections

    found = check_process(load_process(process))
    values = [_as_dict(found, section, number) for section in sections(found) for number in range(len(section.values))]
    if as_json:
        show_json({"name": found.name, "values": values})
        return
    _show(values, found.source)


def _as_dict(process: Process, section: Section, number: int) -> dict[str, Any]:
    from deltacam.cutting.process_file.values import provenance_of

    value = section.values[number]
    said = provenance_of(process, section.name, value.key)
    return {
        "section": section.name,
        "key": value.key,
        "value": value.text,
        "unit": value.unit,
        "grade": None if said is None else said.grade,
        "source": None if said is None else said.source,
    }


def _show(values: list[dict[str, Any]], source: str) -> None:
    """A table of the values, with the sources below it, each once."""
    from deltacam.inspection.table import aligned

    sources = list(dict.fromkeys(value["source"] for value in values if value["source"]))
    rows = []
    for value in values:
        if value["key"] == "source":
            continue
        name = f"{value['section']}.{value['key']}" if value["section"] else value["key"]
        note = f"[{sources.index(value['source']) + 1}]" if value["source"] else ""
        rows.append([_plain(cell) for cell in (name, value["value"], value["unit"], value["grade"] or "", note)])
    lines = aligned(rows, indent="")
    lines += ["", *(f"[{number}] {_plain(text)}" for number, text in enumerate(sources, start=1))] if sources else []
    lines += ["", _plain(source)] if source else []
    click.echo("\n".join(lines))


def _plain(text: str) -> str:
    from deltacam.plain import plain

    return plain(text, longest=LONGEST_MESSAGE)
