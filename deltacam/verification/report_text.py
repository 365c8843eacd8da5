"""The report for a terminal: the verdict, the numbers that matter, the checks; it fits a screen."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from deltacam.model import Check, Report
from deltacam.verification.plain import plain

_WIDEST_PLACE: Final = 100  # characters
_MOST_FINDINGS: Final = 8


def to_text(report: Report) -> str:
    """The report as lines of text with a line feed at the end; nothing in it makes a terminal do anything."""
    rate = report.summary["program"]["rate_hz"]
    failed = [check for check in report.checks if not check.passed]
    lines = [_verdict(report, failed), *_figures(report.summary), ""]
    lines += _table(failed + [check for check in report.checks if check.passed], rate)
    for finding in report.findings[:_MOST_FINDINGS]:
        place = f" ({plain(finding.where)})" if finding.where else ""
        hint = f"; {plain(finding.hint, longest=_WIDEST_PLACE)}" if finding.hint else ""
        lines.append(f"note: {plain(finding.what, longest=2 * _WIDEST_PLACE)}{place}{hint}")
    if len(report.findings) > _MOST_FINDINGS:
        lines.append(f"note: and {len(report.findings) - _MOST_FINDINGS} more, in the JSON report")
    return "\n".join(lines) + "\n"


def _verdict(report: Report, failed: list[Check]) -> str:
    subject = f"{plain(report.summary['drawing'])} ({report.summary['mode']})"
    if report.passed:
        return f"PASSED  {subject}: all {len(report.checks)} checks"
    return f"FAILED  {subject}: {len(failed)} of {len(report.checks)} checks: {', '.join(c.name for c in failed)}"


def _figures(summary: Mapping[str, Any]) -> list[str]:
    program = summary["program"]
    rows = f"{program['rows']} rows at {_number(program['rate_hz'])} Hz"
    times = ", ".join(f"{kind} {_number(seconds)} s" for kind, seconds in summary["time_s"].items())
    lines = [f"  time     {program['duration_s']:.3f} s in {rows}: {times}"]
    if "cut_length_mm" in summary:
        contours = f"{summary['contours_cut']} contours"
        lengths = f"{summary['cut_length_mm']:.1f} mm cut, {summary['rapid_length_mm']:.1f} mm rapid"
        lines.append(f"  path     {lengths}, {contours}{_part_size(summary)}")
    process = f"kerf {_number(summary['kerf_mm'])} mm, feed {_number(summary['feed_mm_s'])} mm/s"
    lines.append(f"  robot    {plain(summary['robot'])}; {plain(summary['process'])}, {process}")
    if summary["share_of_limit"]:
        shares = ", ".join(f"{name} {100 * share:.0f} %" for name, share in summary["share_of_limit"].items())
        lines.append(f"  of limit {shares}")
    return lines


def _part_size(summary: Mapping[str, Any]) -> str:
    if "part_size_mm" not in summary:
        return ""
    width, height = summary["part_size_mm"]
    return f", part {width:.2f} x {height:.2f} mm"


def _table(checks: list[Check], rate: float) -> list[str]:
    """One line per check, the columns aligned, numbers to the right."""
    rows = [_cells(check, rate) for check in checks]
    widths = [max(len(row[column]) for row in rows) for column in range(4)]
    lines = []
    for verdict, name, worst, limit, place in rows:
        figures = f"{worst:>{widths[2]}}  {limit:<{widths[3]}}"
        lines.append(f"  {verdict:<{widths[0]}}  {name:<{widths[1]}}  {figures}  {place}".rstrip())
    return lines


def _cells(check: Check, rate: float) -> tuple[str, str, str, str, str]:
    """Verdict, name, worst value, limit and place; a passed check needs no place."""
    worst = "" if check.worst is None else _number(check.worst)
    limit = "" if check.limit is None else f"/ {_number(check.limit)} {check.unit}".rstrip()
    at = "" if check.tick is None else f"tick {check.tick} ({check.tick / rate:.4f} s) "
    place = "" if check.passed else f"{at}{plain(check.where, longest=_WIDEST_PLACE)}"
    return ("ok" if check.passed else "FAIL"), check.name, worst, limit, place


def _number(value: float) -> str:
    """Four significant digits, without an exponent where people would not write one."""
    if value == 0.0 or 1e-3 <= abs(value) < 1e6:
        digits = f"{value:.4g}"
        return digits if "e" not in digits else f"{value:.0f}"
    return f"{value:.1e}"
