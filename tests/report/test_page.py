"""The frame of the page allows exactly its own scripts."""

import base64
import hashlib
import re

import pytest

from deltacam.report.page import frame, plotly_js

SCRIPT = re.compile(r"<script>(.*?)</script>", flags=re.DOTALL)


def framed(library: str | None = None) -> str:
    return frame(title="a &lt;title&gt;", style=".x{}", body="<p>body</p>\n", data="{}", library=library)


def policy(content: str) -> dict[str, str]:
    (found,) = re.findall(r'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', content)
    return dict(rule.strip().split(" ", 1) for rule in found.split(";"))


@pytest.mark.parametrize("library", [None, "../plotly.min.js", ""])
def test_only_the_scripts_of_the_page_and_the_shared_one_may_run(library: str | None) -> None:
    content = framed(library)
    hashes = [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in SCRIPT.findall(content)]
    allowed = [f"'sha256-{digest}'" for digest in hashes] + (["'self'"] if library else [])
    rules = policy(content)
    assert rules.pop("script-src").split() == allowed
    assert rules == {
        "default-src": "'none'",
        "style-src": "'unsafe-inline'",
        "img-src": "data:",
        "base-uri": "'none'",
        "form-action": "'none'",
    }
    assert content.index("Content-Security-Policy") < content.index("<title>")


def test_the_library_is_in_the_page_or_beside_it() -> None:
    alone, shared = framed(), framed('a"b.js')
    assert plotly_js() in alone
    assert len(shared) < 60_000
    assert '<script src="a&quot;b.js"></script>' in shared
    assert not re.search(r"<script src|<link|<iframe|<img|url\(|@import", alone.replace(plotly_js(), ""))


def test_a_page_can_do_without_the_library_and_have_sheets_of_its_own() -> None:
    given = {"title": "t", "style": "", "body": "", "data": "null", "library": "", "scripts": ("index.js",)}
    content = frame(**given, sheets=("page.css", "index.css"))
    assert "plotly" not in content
    assert len(SCRIPT.findall(content)) == 1
    assert ".parts" in content
    assert ".parts" not in frame(**given)


def test_the_library_can_stand_in_a_script_element() -> None:
    assert not re.search(r"</?script|<!--", plotly_js(), flags=re.IGNORECASE)
    assert plotly_js().startswith("/**\n* plotly.js")  # its licence asks for this
