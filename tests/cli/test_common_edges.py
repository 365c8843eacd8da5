"""The option that asks for common edges."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import click
import pytest
from click.testing import CliRunner

from deltacam import pipeline
from deltacam.cutting.process import load_process
from deltacam.cutting.process_file.writing import to_toml
from deltacam_cli.plan import command


@pytest.mark.parametrize(
    ("options", "asked"),
    [
        ((), False),
        (("--common-edges",), True),
        (("--process", "shared.toml"), True),
        (("--process", "shared.toml", "--no-common-edges"), False),
    ],
)
def test_the_command_line_wins_over_the_process(
    options: tuple[str, ...], asked: bool, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    given: dict[str, Any] = {}

    def ask(*_: Any, **values: Any) -> None:
        given.update(values)
        raise click.exceptions.Exit(0)

    monkeypatch.setattr(pipeline, "plan_to_folder", ask)
    monkeypatch.setattr(click, "get_app_dir", lambda _: str(tmp_path / "settings"))
    monkeypatch.chdir(tmp_path)
    Path("shared.toml").write_text(to_toml(replace(load_process("steel-1mm-fibre"), common_edges=True)))
    result = CliRunner().invoke(command, ["part.dxf", *options], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    assert given["process"].common_edges is asked
