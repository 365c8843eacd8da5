"""What both commands print for programs is what the documented schema says."""

import json
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from tests.cli.test_main import deltacam

ROOT = Path(__file__).parents[2]
SAMPLES = ROOT / "samples"
SCHEMA = json.loads((ROOT / "docs" / "reference" / "report.schema.json").read_text())


def problems(found: Any) -> list[str]:
    return [f"{problem.json_path}: {problem.message}" for problem in Draft202012Validator(SCHEMA).iter_errors(found)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a program of a sample."""
    folder = tmp_path_factory.mktemp("planned")
    run = deltacam("plan", SAMPLES / "bracket.dxf", "--json", folder=folder)
    (folder / "plan.json").write_text(run.stdout)
    return folder


def test_the_schema_is_one() -> None:
    Draft202012Validator.check_schema(SCHEMA)


def test_what_plan_writes_and_prints_is_as_the_schema_says(folder: Path) -> None:
    printed = json.loads((folder / "plan.json").read_text())
    written = json.loads((folder / "bracket.report.json").read_text())
    assert problems(printed) == problems(written) == []
    assert printed["held"]
    assert printed["sizes"]


@pytest.mark.parametrize(
    "options",
    [
        [],
        ["--drawing", SAMPLES / "bracket.dxf"],
        ["--drawing", SAMPLES, "--against", "bracket.program.csv"],
        ["--robot", "irb360-1600"],
    ],
    ids=str,
)
def test_what_verify_prints_is_as_the_schema_says(folder: Path, options: list[Any]) -> None:
    run = deltacam("verify", "bracket.program.csv", "--json", *options, folder=folder)
    found = json.loads(run.stdout)
    assert problems(found) == []
    assert found["passed"] == (run.returncode == 0)


def test_a_report_with_another_key_is_not_as_the_schema_says(folder: Path) -> None:
    found = json.loads((folder / "bracket.report.json").read_text())
    assert problems({**found, "another": 1})
    assert problems({**found, "checks": [{**found["checks"][0], "worst": "1"}]})
    assert problems({key: value for key, value in found.items() if key != "ledger"})
