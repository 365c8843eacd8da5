"""The examples of docs/reference/program-format.md run on a real file."""

import re
from pathlib import Path

import pytest

from deltacam.program.formats import write_program
from deltacam.program.meta import KEYS
from deltacam.program.program import Program

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "program-format.md"
EXAMPLES = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL)


@pytest.mark.parametrize("example", EXAMPLES, ids=["pandas", "standard library", "deltacam"])
def test_the_examples_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, program: Program, example: str) -> None:
    if "pandas" in example:
        pytest.importorskip("pandas", reason="pandas is not installed")
    write_program(program, tmp_path / "plate.program.csv")
    monkeypatch.chdir(tmp_path)
    found: dict[str, object] = {}
    exec(compile(example, str(PAGE), "exec"), found)  # noqa: S102 - our own page
    assert len(found.get("rows", program.q)) == len(program.q)  # type: ignore[arg-type]


def test_the_page_names_every_key() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert all(f"| `{key}` |" in page for key in KEYS)
