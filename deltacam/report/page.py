"""The frame of the page: its head, its policy, its scripts and its data.

The policy lets nothing in from outside and runs no script but plotly.js and ours. Where pages share one copy of
plotly.js, scripts from the place of the page itself are let in as well: browsers do not take hashes for files.
"""

from __future__ import annotations

import base64
import hashlib
from functools import cache
from html import escape
from importlib import resources
from typing import Final

_SCRIPTS: Final = ("series.js", "overlay.js", "pictures.js", "charts.js", "page.js")
_SHEETS: Final = ("page.css",)


def frame(
    *,
    title: str,
    style: str,
    body: str,
    data: str,
    library: str | None,
    scripts: tuple[str, ...] = _SCRIPTS,
    sheets: tuple[str, ...] = _SHEETS,
) -> str:
    """The whole page.

    Args:
        title: of the window, HTML.
        style: rules besides those of the style sheets.
        body: HTML.
        data: JSON for the script, in which nothing opens or closes an element.
        library: where a copy of `plotly_js` lies, relative to the page; None puts it into the page, and an empty text
            is for a page that does without.
        scripts: ours, by the names of their files.
        sheets: our style sheets, likewise.
    """
    own = _script(scripts)
    inside = (plotly_js(), own) if library is None else (own,)
    elements = "\n".join(f"<script>{script}</script>" for script in inside)
    if library:
        elements = f'<script src="{escape(library)}"></script>\n{elements}'
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{_policy(inside, shared=bool(library))}">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<meta name="color-scheme" content="light dark">\n'
        f"<title>{title}</title>\n<style>{''.join(map(_resource, sheets))}{style}</style>\n</head>\n"
        f"<body>\n{body}"
        f'<script type="application/json" id="data">{data}</script>\n{elements}\n</body>\n</html>\n'
    )


def _policy(scripts: tuple[str, ...], *, shared: bool) -> str:
    hashes = (base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts)
    allowed = " ".join([*(f"'sha256-{digest}'" for digest in hashes), *(["'self'"] if shared else [])])
    return (
        f"default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; img-src data:; "
        f"base-uri 'none'; form-action 'none'"
    )


@cache
def plotly_js() -> str:
    """plotly.js, as it comes with its Python package, which is not imported: that would take longer than the page."""
    return (resources.files("plotly") / "package_data" / "plotly.min.js").read_text("utf-8")


@cache
def _script(names: tuple[str, ...]) -> str:
    """Our scripts as one, in a scope of its own."""
    parts = "\n".join(map(_resource, names))
    return f'"use strict";\n(() => {{\n{parts}}})();\n'


def _resource(name: str) -> str:
    return (resources.files("deltacam.report") / "web" / name).read_text("utf-8")
