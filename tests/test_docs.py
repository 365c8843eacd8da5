"""The documentation is true: its commands run, its tables are complete, its links lead somewhere."""

from __future__ import annotations

import ast
import contextlib
import importlib
import io
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple, cast

import click
import numpy as np
import pytest

import deltacam
from deltacam.errors import DeltacamError
from deltacam.pipeline import plan
from deltacam.robot.bounds import BOUNDS
from deltacam.units import parse_length
from deltacam_cli import main as command_line

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES = [*(ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")), *sorted(DOCS.rglob("*.md"))]
FORMATS = [DOCS / "reference" / "program-format.md", *(DOCS / "reference" / "formats").glob("*.md")]
"""Their snippets need pandas and others, and name files that are not there: see tests/program."""


class Block(NamedTuple):
    kind: str
    text: str


class Command(NamedTuple):
    line: str
    expected: str


def name(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


def blocks(page: Path) -> list[Block]:
    """The fenced blocks of a page; those in a list are indented."""
    found = re.finditer(r"^( *)```(\w+)\n(.*?)^\1```$", page.read_text(), flags=re.DOTALL | re.MULTILINE)
    return [Block(match[2], re.sub(f"^{match[1]}", "", match[3], flags=re.MULTILINE)) for match in found]


def commands(block: Block) -> list[Command]:
    """The commands of a console block with the output that it shows."""
    found = []
    for part in re.split(r"^\$ ", block.text, flags=re.MULTILINE)[1:]:
        line, _, expected = part.partition("\n")
        found.append(Command(line, expected))
    return found


def is_run(block: Block) -> bool:
    """Whether a block is run: all but those that install something with make."""
    used = {command.line.split()[0] for command in commands(block)} if block.kind == "console" else set()
    return block.kind == "python" or bool(used and "make" not in used)


def run(line: str) -> tuple[int, str]:
    """The exit code and the output, both streams, of a command."""
    if not line.startswith("deltacam "):
        path = os.pathsep.join([str(ROOT), str(ROOT / "cli")])
        line = line.replace("python", sys.executable, 1) if line.startswith("python ") else line
        done = subprocess.run(
            ["sh", "-c", line], capture_output=True, text=True, env={**os.environ, "PYTHONPATH": path}, check=False
        )
        return done.returncode, done.stdout + done.stderr
    words = line.split()
    assert not set("'\"\\|><;&") & set(line), "a deltacam command in the documentation needs no shell"
    shown = io.StringIO()
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(shown), contextlib.redirect_stderr(shown):
        patch.setattr(sys, "argv", words)
        with pytest.raises(SystemExit) as stopped:
            command_line.main()
    return int(stopped.value.code or 0), shown.getvalue()


def matches(expected: str, shown: str) -> bool:
    """Whether the output is as documented.

    ``...`` stands for anything, also for nothing and for several lines. Numbers may differ by half a percent: another
    machine may plan a tick more or less.
    """
    wanted, got = (re.sub(r"[ \t]+$", "", text, flags=re.MULTILINE).strip("\n") for text in (expected, shown))
    numbers: list[float] = []
    pattern = ""
    for part in re.split(r"(\d+(?:\.\d+)?|\.\.\.(?!\.))", wanted):
        if part == "...":
            pattern += ".*?"
        elif part[:1].isdigit():
            pattern += r"(\d+(?:\.\d+)?)"
            numbers.append(float(part))
        else:
            pattern += re.escape(part)
    found = re.fullmatch(pattern, got, flags=re.DOTALL)
    return found is not None and np.allclose([float(text) for text in found.groups()], numbers, rtol=5e-3, atol=0.0)


def run_console(block: Block) -> None:
    """Run the commands of a block; each succeeds unless ``$ echo $?`` shows another code."""
    todo = commands(block)
    for i, command in enumerate(todo):
        if command.line == "echo $?":
            continue
        code, shown = run(command.line)
        asked = i + 1 < len(todo) and todo[i + 1].line == "echo $?"
        expected = int(todo[i + 1].expected) if asked else 0
        assert code == expected, f"$ {command.line}\n{shown}"
        if command.expected.strip():
            assert matches(command.expected, shown), f"$ {command.line}\n{shown}"


RUN = [page for page in PAGES if page not in FORMATS and any(map(is_run, blocks(page)))]


@pytest.mark.parametrize("page", RUN, ids=name)
def test_the_commands_of_a_page_do_what_it_says(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in ("samples", "tests/data/dxf"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    monkeypatch.chdir(tmp_path)
    namespace: dict[str, object] = {}
    for block in filter(is_run, blocks(page)):
        if block.kind == "console":
            run_console(block)
        else:
            with contextlib.redirect_stdout(io.StringIO()):
                exec(compile(block.text, name(page), "exec"), namespace)  # noqa: S102 - our own page


def test_documented_output_matches_up_to_wildcards_and_half_a_percent() -> None:
    shown = "time 7.393 s in 2958 rows\na\nb\nwrote x\n"
    assert matches("time 7.393 s in 2957 rows\n...\nwrote x\n", shown)
    assert matches("time 7.... rows\n...\nwrote x\n", shown)
    assert not matches("time 7.5 s in 2958 rows\n...\nwrote x\n", shown)
    assert not matches("time 7.393 s in 2958 rows\n", shown)
    assert not matches("30 checks", "31 checks")


def of_plan(option: click.Option) -> bool:
    """Whether `plan` has an option alike, whose row says all about it."""
    others = importlib.import_module("deltacam_cli.plan").command.params
    return any((other.opts, other.to_info_dict()["help"]) == (option.opts, option.help) for other in others)


def test_the_options_of_plan_that_batch_has_are_listed_there() -> None:
    page = (DOCS / "reference" / "commands.md").read_text()
    section = page.partition("## deltacam batch")[2].partition("\n## ")[0]
    for option in importlib.import_module("deltacam_cli.batch").command.params:
        if isinstance(option, click.Option) and of_plan(option):
            assert f"{option.opts[-1]}" in section, option.opts


def test_every_option_of_every_command_has_its_row() -> None:
    page = (DOCS / "reference" / "commands.md").read_text()
    name = r"^##+ deltacam ([a-z]+(?: [a-z]+)?)\b"
    sections = dict(re.findall(rf"{name}(.*?)(?=^##|\Z)", page, flags=re.DOTALL | re.MULTILINE))
    groups = {name: importlib.import_module(f"deltacam_cli.{name}").COMMANDS for name in ("robot", "process")}
    inside = [f"{group} {name}" for group, names in groups.items() for name in names]
    assert sorted(sections) == sorted([*command_line.COMMANDS, *inside])
    for command, section in sections.items():
        found: click.Command = command_line.cli
        for name in command.split():
            group = cast("click.Group", found)
            found = cast("click.Command", group.get_command(click.Context(group), name))
        options = found.params
        for option in options:
            if isinstance(option, click.Option) and not (command == "batch" and of_plan(option)):
                rows = [row for row in section.splitlines() if row.startswith("| ") and f"{option.opts[-1]}" in row]
                assert rows, f"{command}: {option.opts}"
                if option.show_default:
                    assert f"`{option.default}`" in rows[0], f"{command}: the default of {option.opts}"


def known_keys(folder: Path, load: object, text: str, section: str = "") -> list[str]:
    """The keys of a section, as the message about an unknown one lists them."""
    wrong = folder / "wrong.toml"
    head, mark, tail = text.partition(f"[{section}]\n") if section else ("", "", text)
    wrong.write_text(f"{head}{mark}zz = 1\n{tail}")
    with pytest.raises(DeltacamError) as refused:
        load(wrong)  # type: ignore[operator]
    return refused.value.hint.removeprefix("known: ").split(", ")


def test_every_key_of_a_process_file_has_its_row(tmp_path: Path) -> None:
    page = (DOCS / "reference" / "process-file.md").read_text()
    text = (ROOT / "samples" / "process.toml").read_text()
    for key in known_keys(tmp_path, deltacam.load_process, text):
        assert f"\n| `{key}` | " in page, key


@pytest.mark.parametrize("section", ["", "geometry", "joints", "mount", "tool", "workspace", "controller"])
def test_every_key_of_a_robot_file_has_its_row_with_its_bounds(section: str, tmp_path: Path) -> None:
    page = (DOCS / "reference" / "robot-file.md").read_text()
    text = (ROOT / "samples" / "robot.toml").read_text()
    bounds = {bound.key: f"{bound.minimum:g} to {bound.maximum:g}" for bound in BOUNDS.values()}
    for key in known_keys(tmp_path, deltacam.load_robot, text, section):
        if f"[{key}]" in text:
            assert f"\n## [{key}]\n" in page
        else:
            assert f"\n| `{key}` | {bounds.get(key, '')}" in page, key


def test_every_check_has_its_row() -> None:
    page = (DOCS / "explanation" / "verification.md").read_text()
    checks = [check.name for check in plan(ROOT / "samples" / "bracket.dxf").report.checks]
    rows = re.findall(r"^\| ([^|]+?) \| ", page.partition("## What is checked")[2], flags=re.MULTILINE)
    assert sorted(rows) == sorted(["check", "process", *checks])


def test_the_constants_are_those_of_the_code() -> None:
    page = (DOCS / "explanation" / "pipeline.md").read_text()
    listed = re.findall(r"^\| `([\w.]+)\.(\w+)` \| ([\w.]+) \|$", page, flags=re.MULTILINE)
    assert len(listed) > 10
    for module, constant, text in listed:
        value = getattr(importlib.import_module(f"deltacam.{module}"), constant)
        stated = float(text) if re.fullmatch(r"[\d.]+", text) else parse_length(text)
        np.testing.assert_allclose(stated, value, rtol=1e-12, err_msg=f"{module}.{constant}")
    for mentioned in re.findall(r"`((?:drawing|cutting|motion|verification)\.[\w.]+)`", page):
        assert f"| `{mentioned}` |" in page, mentioned


def test_every_kind_of_finding_is_explained() -> None:
    page = (DOCS / "reference" / "inspection.md").read_text()
    table = page[page.index("## Kinds of warnings") :]
    explained = set(re.findall(r"`(\w+)`", "".join(line.split("|")[1] for line in table.splitlines() if "| `" in line)))
    used = set()
    for path in (ROOT / "deltacam" / "drawing").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Finding":
                given = [word.value for word in node.keywords if word.arg == "kind"] or node.args[3:4]
                used |= {kind.value for kind in given if isinstance(kind, ast.Constant)}
    assert used > {"units", "crossing", "lost"}
    assert used <= explained


@pytest.mark.parametrize("page", [*PAGES, ROOT / "samples" / "README.md"], ids=name)
def test_every_link_leads_to_a_file_and_a_heading(page: Path) -> None:
    for target in re.findall(r"\]\(([^)]+)\)", page.read_text()):
        if re.match(r"https?://", target):
            continue
        path, _, heading = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        assert file.exists(), target
        if heading:
            headings = re.findall(r"^#+ (.+)$", file.read_text(), flags=re.MULTILINE)
            assert heading in {re.sub(r"[^\w -]", "", text.lower()).replace(" ", "-") for text in headings}, target


BY_HAND = ("leads.svg",)
"""Pictures of ideas rather than of programs."""


def test_the_pictures_are_made_by_the_script(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "cli")])}
    subprocess.run([sys.executable, DOCS / "make_pictures.py", "-o", tmp_path], check=True, env=environment)
    made = sorted(path.name for path in tmp_path.glob("*.svg"))
    assert sorted([*made, *BY_HAND]) == sorted(path.name for path in (DOCS / "images").glob("*.svg"))
