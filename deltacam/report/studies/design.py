"""What ``deltacam robot design`` shows."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from deltacam.model import Array
from deltacam.report.charts import heat_map, line_chart
from deltacam.report.study import Chart, Study, Table
from deltacam.robot.synthesis.demands import REACH_MARGIN, View
from deltacam.robot.synthesis.front import Front
from deltacam.robot.synthesis.shape import BoxShape
from deltacam.robot.synthesis.synthesis import Design, Finding
from deltacam.robot.synthesis.wish import Wish
from deltacam.units import to_mm

_GRID: Final = 121  # points per side of the section
_BEYOND: Final = 0.6  # of the workspace's sides that the section shows around it


def study(design: Design) -> Study:
    """The study of one design."""
    return Study(
        title=f"the smallest robot found for {_shape(design.wish)}: {to_mm(design.size):.1f} mm",
        facts=_facts(design),
        tables=(_demands(design),),
        charts=(_section(design),),
        notes=_notes(design),
        data=_data(design),
    )


def front_study(front: Front) -> Study:
    """The study of a front of designs."""
    designs = front.designs
    rows = tuple(
        (
            f"{design.wish.min_inverse_condition:g}",
            f"{to_mm(design.size):.1f}",
            f"{to_mm(float(design.geometry.base_radii[0])):.1f}",
            f"{to_mm(float(design.geometry.effector_radii[0])):.1f}",
            f"{to_mm(float(design.candidate[1])):.1f}",
            f"{to_mm(float(design.candidate[2])):.1f}",
            f"{to_mm(design.middle):.1f}",
            ", ".join(finding.demand.label for finding in design.findings if finding.binding),
        )
        for design in designs
    )
    heads = ("1/cond", "size, mm", "R", "r", "La", "Lb", "middle z", "at its limit")
    chart = line_chart(
        "size against dexterity",
        "The smallest robot that was found for every demanded 1/cond; each is certified over the whole workspace.",
        x_title="1/cond everywhere, at least",
        y_title="(R - r) + La + Lb, mm",
        lines=(
            (
                "smallest robot",
                [design.wish.min_inverse_condition for design in designs],
                [to_mm(design.size) for design in designs],
            ),
        ),
    )
    return Study(
        title=f"size against dexterity for {_shape(designs[0].wish)}",
        facts=(("designs", str(len(designs))), ("seed", str(designs[0].seed))),
        tables=(Table("the smallest robots, certified", heads, rows),),
        charts=(chart, *(_section(design) for design in designs[-1:])),
        notes=(*(f"1/cond >= {value:g}: {why}" for value, why in front.refused), *_notes(designs[0])),
        data={
            "front": [_data(design) for design in designs],
            "refused": [{"inverse_condition": value, "why": why} for value, why in front.refused],
        },
    )


def _facts(design: Design) -> tuple[tuple[str, str], ...]:
    geometry = design.geometry
    half = design.wish.shape.height / 2.0
    low, high = to_mm(design.middle - half), to_mm(design.middle + half)
    return (
        ("size", f"{to_mm(design.size):.2f} mm = (R - r) + La + Lb"),
        ("base radius R", f"{to_mm(float(geometry.base_radii[0])):.2f} mm"),
        ("effector radius r", f"{to_mm(float(geometry.effector_radii[0])):.2f} mm"),
        ("upper arm La", f"{to_mm(float(geometry.upper_arms[0])):.2f} mm"),
        ("forearm Lb", f"{to_mm(float(geometry.forearms[0])):.2f} mm"),
        ("workspace", f"{_shape(design.wish)}, z = {low:.2f} to {high:.2f} mm"),
        ("certificate", f"{design.certificate.verdict} over the whole workspace, {design.certificate.cells} cells"),
        ("seed", str(design.seed)),
    )


def _demands(design: Design) -> Table:
    rows = tuple(
        (
            finding.demand.label,
            f"{'>=' if finding.demand.at_least else '<='} {finding.demand.limit:.6g} {finding.demand.unit}".rstrip(),
            f"{finding.value:.6g}",
            "binds" if finding.binding else "",
            "certified" if finding.proved else "sampled",
            "({:.1f}, {:.1f}, {:.1f})".format(*(to_mm(value) + 0.0 for value in finding.point)),
        )
        for finding in design.findings
    )
    return Table("demands everywhere in the workspace", ("demand", "limit", "worst", "", "", "at, mm"), rows)


def _notes(design: Design) -> tuple[str, ...]:
    wish = design.wish
    notes = [sentence + "." for sentence in design.bounds]
    if wish.head_radius is None or wish.base_radius_min is None:
        notes.append("no room was asked for motors and head: give --base-radius-min and --head-radius to build it.")
    if any(not finding.proved for finding in design.findings):
        notes.append("demands marked sampled were searched for at points; the certificate does not cover them.")
    return tuple(notes)


def _section(design: Design) -> Chart:
    """1/cond over the plane of arm 1, where the joints reach within their range, with the workspace in it."""
    shape, middle = design.wish.shape, design.middle
    half_y = (shape.depth if isinstance(shape, BoxShape) else shape.diameter) / 2.0
    half_z = shape.height / 2.0
    beyond = _BEYOND * max(half_y, half_z)
    y = np.linspace(-half_y - beyond, half_y + beyond, _GRID)
    z = np.linspace(-half_z - beyond, min(half_z + beyond, -middle - 1e-3), _GRID)
    plane = np.stack(np.meshgrid(y, z), axis=-1).reshape(-1, 2)
    values = _dexterity(design, np.column_stack((np.zeros(len(plane)), plane))).reshape(len(z), len(y))
    box = np.array([[-half_y, -half_z], [half_y, -half_z], [half_y, half_z], [-half_y, half_z], [-half_y, -half_z]])
    return heat_map(
        "the workspace in a section through arm 1",
        "1/cond in the plane x = 0 where reach and joint range allow the tool to be; the frame is the workspace.",
        x_mm=to_mm(1.0) * y,
        y_mm=to_mm(1.0) * (z + middle),
        values=values,
        unit="1/cond",
        outlines=[to_mm(1.0) * (box + np.array([0.0, middle]))],
        axes=("y", "z"),
    )


def _dexterity(design: Design, points: Array) -> Array:
    """1/cond at points (N, 3) m about the middle of the workspace: (N,), nan where the tool cannot be."""
    view = View(design.candidate[np.newaxis], points)
    smallest, largest = view.singular_values
    wish, angles = design.wish, view.angles
    within = (angles.min(axis=0) >= wish.joint_min) & (angles.max(axis=0) <= wish.joint_max)
    return np.asarray(np.where(within & (view.poses.reach.min(axis=0) > REACH_MARGIN), smallest / largest, np.nan)[0])


def _shape(wish: Wish) -> str:
    shape = wish.shape
    if isinstance(shape, BoxShape):
        return f"a box of {to_mm(shape.width):g} x {to_mm(shape.depth):g} x {to_mm(shape.height):g} mm"
    return f"a cylinder of {to_mm(shape.diameter):g} mm, {to_mm(shape.height):g} mm high"


def _data(design: Design) -> dict[str, Any]:
    geometry, half = design.geometry, design.wish.shape.height / 2.0
    return {
        "size_mm": to_mm(design.size),
        "base_radius_mm": to_mm(float(geometry.base_radii[0])),
        "effector_radius_mm": to_mm(float(geometry.effector_radii[0])),
        "upper_arm_mm": to_mm(float(geometry.upper_arms[0])),
        "forearm_mm": to_mm(float(geometry.forearms[0])),
        "workspace_z_mm": [to_mm(design.middle - half), to_mm(design.middle + half)],
        "demands": {finding.demand.name: _finding(finding) for finding in design.findings},
        "binding_bounds": list(design.bounds),
        "certificate": {
            "verdict": design.certificate.verdict,
            "cells": design.certificate.cells,
            "margins": {
                margin.name: {
                    "proved": margin.low if math.isfinite(margin.low) else None,
                    "sampled": margin.sampled,
                    "at_mm": [to_mm(value) for value in margin.point],
                }
                for margin in design.certificate.margins
            },
        },
        "seed": design.seed,
    }


def _finding(finding: Finding) -> dict[str, Any]:
    return {
        "limit": finding.demand.limit,
        "worst": finding.value,
        "at_mm": [to_mm(value) for value in finding.point],
        "binds": finding.binding,
        "certified": finding.proved,
    }
