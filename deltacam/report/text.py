"""The report for a terminal: the verdict, the numbers that matter, the checks; it fits a screen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import zip_longest
from typing import Any, Final

from deltacam.model import Check, Report
from deltacam.plain import plain
from deltacam.report import kerf
from deltacam.report.held_back import in_words

_WIDEST_PLACE: Final = 100  # characters
_LONGEST_FINDING: Final = 400
_MOST_FINDINGS: Final = 8
_ROUNDING: Final = 1e-3  # um
_OF_THE_CUT: Final = {
    "deviation at ticks": "off its path",
    "deviation between ticks": "between ticks",
    "part size": "part size",
    "part edge": "part edge",
}


def to_text(report: Report, *, every_check: bool = False) -> str:
    """The report as lines of text with a line feed at the end; nothing in it makes a terminal do anything.

    Args:
        report: any.
        every_check: whether the checks that passed are listed too; the text may then be longer than a screen.
    """
    rate = report.summary["program"]["rate_hz"]
    failed = [check for check in report.checks if not check.passed]
    lines = [_verdict(report, failed), *_figures(report.summary)]
    lines += [f"  cut      {cut}"] if (cut := _cut(report.checks)) else []
    lines += [f"  energy   {energy}"] if (energy := _energy(report)) else []
    lines += [f"  held by  {in_words(report.held)}"] if report.held else []
    lines += [f"  kerf     {of_kerf}"] if (of_kerf := kerf.in_words(report.kerf)) else []
    lines += ["", *_failures(failed, rate)] if failed else []
    lines += ["", *_in_two_columns([check for check in report.checks if check.passed])] if every_check else []
    lines += [""] if report.findings else []
    for finding in report.findings[:_MOST_FINDINGS]:
        place = f" ({plain(finding.where)})" if finding.where else ""
        hint = f"; {plain(finding.hint, longest=_WIDEST_PLACE)}" if finding.hint else ""
        lines.append(f"note: {plain(finding.what, longest=_LONGEST_FINDING)}{place}{hint}")
    if len(report.findings) > _MOST_FINDINGS:
        lines.append(f"note: and {len(report.findings) - _MOST_FINDINGS} more, in the JSON report")
    return "\n".join(lines) + "\n"


def _verdict(report: Report, failed: list[Check]) -> str:
    subject = f"{plain(report.summary['drawing'])} ({report.summary['mode']})"
    wrong = [check.name for check in failed if not check.warns]
    warned = [check.name for check in failed if check.warns]
    warnings = f"; warning: {', '.join(warned)}" if warned else ""
    if wrong:
        return f"FAILED  {subject}: {len(wrong)} of {len(report.checks)} checks: {', '.join(wrong)}{warnings}"
    compared = "part_size_mm" in report.summary or report.summary["mode"] == "frame"
    missing = "" if compared else "; not compared with the drawing (--drawing)"
    passed = f"{len(report.checks) - len(warned)} of {len(report.checks)}" if warned else f"all {len(report.checks)}"
    return f"PASSED  {subject}: {passed} checks{warnings}{missing}"


def _cut(checks: Sequence[Check]) -> str:
    """How far the cut is from what was drawn, each with its limit, um."""
    found = {check.name: check for check in checks if check.worst is not None and check.limit is not None}
    parts = [
        f"{words} {number_in_words(found[name].worst or 0.0)} / {number_in_words(found[name].limit or 0.0)}"
        for name, words in _OF_THE_CUT.items()
        if name in found
    ]
    return f"{', '.join(parts)} um" if parts else ""


def _energy(report: Report) -> str:
    """The least and the most energy of a millimetre, and where that is."""
    found = report.summary.get("line_energy")
    worst = next((check for check in report.checks if check.name == "energy per mm"), None)
    if not found or worst is None:
        return ""
    joules = f", {number_in_words(found['at_feed_j_mm'])} J/mm" if "at_feed_j_mm" in found else ""
    most = f"{found['least']:.2f} to {found['most']:.2f} times that at the feed{joules}"
    return f"{most}; most at {plain(worst.where, longest=_WIDEST_PLACE)}"


def _figures(summary: Mapping[str, Any]) -> list[str]:
    program = summary["program"]
    rows = f"{program['rows']} rows at {number_in_words(program['rate_hz'])} Hz"
    times = ", ".join(f"{kind} {number_in_words(seconds)} s" for kind, seconds in summary["time_s"].items())
    lines = [*_drawing(summary), f"  time     {program['duration_s']:.3f} s in {rows}: {times}"]
    if "cut_length_mm" in summary:
        names = ("cut", "engraved", "rapid") if summary["contours_engraved"] else ("cut", "rapid")
        lengths = ", ".join(f"{summary[f'{name}_length_mm']:.1f} mm {name}" for name in names)
        engraved = f", {summary['contours_engraved']} engraved" if summary["contours_engraved"] else ""
        lines.append(f"  path     {lengths}, {summary['contours_cut']} contours{engraved}")
    process = f"kerf {number_in_words(summary['kerf_mm'])} mm, feed {number_in_words(summary['feed_mm_s'])} mm/s"
    derived = " (joint limits derived from the tool rating)" if summary.get("derived_joint_limits") else ""
    lines.append(f"  robot    {plain(summary['robot'])}{derived}; {plain(summary['process'])}, {process}")
    if summary["share_of_limit"]:
        lines.append(f"  of limit {_shares(summary['share_of_limit'])}")
    return lines


def _shares(used: Mapping[str, float]) -> str:
    """The share of every limit, those of the joints, of the tool and of the process together."""
    groups: dict[str, list[str]] = {}
    for name, share in used.items():
        whose, _, what = name.removesuffix(" while cutting").partition(" ")
        group = groups.setdefault(whose, [])
        group.append(f"{what if group else f'{whose} {what}'.rstrip()} {100 * share:.0f} %")
    return "; ".join(map(", ".join, groups.values()))


def _drawing(summary: Mapping[str, Any]) -> list[str]:
    """The size of the part, what the drawing's unit was taken as, and how exactly it was read."""
    if "unit" not in summary:
        return []
    size = " x ".join(f"{side:.2f}" for side in summary.get("part_size_mm", ()))
    part = f"part {size} mm, " if size else ""
    error = summary["conversion_error_um"]
    exact = f"read to within {number_in_words(error)} um" if error >= _ROUNDING else "read exactly"
    return [f"  drawing  {part}unit {plain(summary['unit'])}, {exact}"]


def _failures(checks: list[Check], rate: float) -> list[str]:
    """One line per check that failed or warns: name, worst value, limit, tick, time and place."""
    rows = [(check.name, *_values(check)) for check in checks]
    name, worst, limit = (max((len(row[column]) for row in rows), default=0) for column in range(3))
    lines = []
    for check, row in zip(checks, rows, strict=True):
        at = "" if check.tick is None else f"tick {check.tick} ({check.tick / rate:.4f} s) "
        place = f"{at}{plain(check.where, longest=_WIDEST_PLACE)}"
        word = "WARN" if check.warns else "FAIL"
        lines.append(f"  {word}  {row[0]:<{name}}  {row[1]:>{worst}} {row[2]:<{limit}}  {place}".rstrip())
    return lines


def _in_two_columns(checks: list[Check]) -> list[str]:
    """The passed checks with their worst values and limits, two on a line, the first half to the left."""
    half = (len(checks) + 1) // 2
    columns = zip_longest(_aligned(checks[:half]), _aligned(checks[half:]), fillvalue="")
    return ["  ".join(pair).rstrip() for pair in columns]


def _aligned(checks: list[Check]) -> list[str]:
    cells = [(check.name, *_values(check)) for check in checks]
    name, worst, limit = (max((len(cell[column]) for cell in cells), default=0) for column in range(3))
    return [f"  ok  {cell[0]:<{name}}  {cell[1]:>{worst}} {cell[2]:<{limit}}" for cell in cells]


def _values(check: Check) -> tuple[str, str]:
    """The worst value, and the limit with its unit; empty where there was nothing to measure."""
    worst = "" if check.worst is None else number_in_words(check.worst)
    if check.limit is None:
        return worst, f"{check.unit}, no limit" if worst else ""
    return worst, f"/ {number_in_words(check.limit)} {check.unit}".rstrip()


def number_in_words(value: float) -> str:
    """Four significant digits, without an exponent where people would not write one."""
    if value == 0.0 or 1e-3 <= abs(value) < 1e9:
        digits = f"{value:.4g}"
        return digits if "e" not in digits else f"{value:.0f}"
    return f"{value:.1e}"
