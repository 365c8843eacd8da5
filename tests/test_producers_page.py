"""The page of producers is that of the table."""

import importlib.util
from pathlib import Path

DOCS = Path(__file__).parent.parent / "docs"


def test_the_page_of_producers_is_made_from_the_table() -> None:
    spec = importlib.util.spec_from_file_location("make_producers_page", DOCS / "make_producers_page.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert module.PAGE.read_text(encoding="utf-8") == module.page(), "run docs/make_producers_page.py"
