"""The report as JSON, for programs: the same keys in the same order every time, and never nan."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

from deltacam.model import Report


def to_json(report: Report) -> str:
    """The report as one JSON object, indented, ASCII, with a line feed at its end.

    Raises:
        ValueError: a number is not finite, which no check may give.
    """
    return json.dumps(to_dict(report), indent=2, allow_nan=False) + "\n"


def to_dict(report: Report) -> dict[str, Any]:
    """The report as dicts, lists, texts, numbers, booleans and None."""
    return {
        "passed": report.passed,
        "warnings": list(report.warnings),
        "checks": [asdict(check) for check in report.checks],
        "summary": dict(report.summary),
        "ledger": [asdict(entry) for entry in report.ledger],
        "findings": [asdict(finding) for finding in report.findings],
        "sizes": [
            {
                "contour": one.contour,
                "drawn_mm2": one.drawn * 1e6,
                "left_mm2": one.area * 1e6,
                "offset_um": one.offset * 1e6,
                "edge_um": one.edge * 1e6,
                "place": one.place,
                "exact_mm2": one.exact * 1e6,
                "drawn_box_mm": [side * 1e3 for side in one.drawn_box],
                "left_box_mm": [side * 1e3 for side in one.box],
            }
            for one in report.sizes
        ],
        "held": [
            {"contour": one.contour, "time_s": one.time, "bound_s": dict(one.bound), "without_s": dict(one.without)}
            for one in report.held
        ],
        "kerf": [
            {
                "contour": one.contour,
                "paths": one.paths,
                "meets": list(one.meets),
                "inner_corners": one.corners,
                "depth_um": one.depth * 1e6,
                "place": one.place,
            }
            for one in report.kerf
        ],
    }
