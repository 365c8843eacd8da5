"""Rows of a batch for the tests of what is shown of them."""

from __future__ import annotations

from typing import Any, Final

from deltacam.batch.parts import Facts, Outcome, Row, Status, Stored

HOSTILE: Final = (
    "</script><script>alert(1)</script>\"' onload=x <img src=x onerror=alert(1)> ]]>&lt;\u202e\x00\x1b[31m\udce9\n.dxf"
)
"""What a file may be called where everything but a slash is allowed, and worse."""

ENDINGS: Final = (".report.json", ".report.html", ".program.csv")
TRIANGLE: Final = (0, 0, 160, 0, 80, 90, 0, 0)
DIAGONAL: Final = (0, 90, 160, 0)


def facts(**changes: Any) -> Facts:
    """Of a part of 40 x 30 mm that is cut in 2.5 s."""
    return Facts(**{"time": 2.5, "cut_length": 0.12, "size": (0.04, 0.03), "contours": 2, "checks": 46, **changes})


def passed(part: str, *, quantity: int = 1, again: bool = False, **changes: Any) -> Row:
    """A part that passed, with its three files."""
    outcome = {"status": Status.PASSED, "robot": "delta-300", "process": "steel", "facts": facts()}
    outcome |= {"thumbnail": (TRIANGLE, DIAGONAL), **changes}
    return Row(part, quantity, Outcome(**outcome), files(part), "d" * 64, "e" * 64, again=again)


def failed(part: str, *checks: str, **changes: Any) -> Row:
    """A part of which checks failed, with its reports."""
    given = {"what": f"failed: {', '.join(checks)}", "facts": facts(failed=checks), **changes}
    outcome = Outcome(Status.FAILED, robot="delta-300", process="steel", **given)
    return Row(part, 1, outcome, files(part)[:2], "d" * 64, "e" * 64)


def without(part: str, status: Status, what: str, *, where: str = "", hint: str = "", quantity: int = 1) -> Row:
    """A part without a program."""
    outcome = Outcome(status, what, where, hint, robot="delta-300", process="steel")
    return Row(part, quantity, outcome)


def files(part: str) -> tuple[Stored, ...]:
    stem = part.removesuffix(".dxf")
    return tuple(Stored(f"{stem}{ending}", str(number) * 64, 1000 + number) for number, ending in enumerate(ENDINGS))
