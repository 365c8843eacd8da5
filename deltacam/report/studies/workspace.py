"""``deltacam robot workspace`` as a study."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deltacam.model import Array
from deltacam.report.charts import heat_map
from deltacam.report.figures import Json
from deltacam.report.study import Chart, Study, Table
from deltacam.robot.region.certify import Certificate
from deltacam.robot.region.largest import Fitted
from deltacam.robot.region.requirements import REACH
from deltacam.robot.region.shapes import Cylinder
from deltacam.robot.region.survey import Poses, Slice
from deltacam.robot.region.workspace_study import WorkspaceStudy
from deltacam.robot.workspace import Workspace

_NAMES = {
    REACH: "reach",
    "joint_min": "smallest joint angle",
    "joint_max": "largest joint angle",
    "mu1": "pressure angle mu1",
    "mu2": "pressure angle mu2",
    "swing": "forearm swing",
    "inverse_condition": "1/cond",
}
_AXES = "xyz"


@dataclass(frozen=True, slots=True)
class _Worst:
    """The smallest or largest of a measure over some poses, and where."""

    value: float
    point: Array

    @classmethod
    def of(cls, poses: Poses, values: Array, sense: float) -> _Worst:
        at = int(np.nanargmax(np.where(poses.kept, sense * values, np.nan)))
        return cls(float(values[at]), poses.points[at])


def study(found: WorkspaceStudy) -> Study:
    """What is shown of a robot's workspace."""
    region, sheet = found.region, found.sheet
    worst = _Worst.of(region, region.inverse_condition, -1.0)
    mean = float(region.inverse_condition[region.kept].mean())
    sheet_worst = _Worst.of(sheet, sheet.inverse_condition, -1.0)
    sheet_mean = float(sheet.inverse_condition[sheet.kept].mean())
    volume = found.usable
    facts = (
        ("usable volume", f"{volume.low:.4f} to {volume.high:.4f} m3 proved, about {found.volume:.4f} m3"),
        ("1/cond over it", f"mean {mean:.3f} (GCI), worst {worst.value:.3f} at {_place(worst.point)}"),
        ("1/cond on the sheet", f"mean {sheet_mean:.3f}, worst {sheet_worst.value:.3f} at {_place(sheet_worst.point)}"),
        ("sheet", f"{found.sheet_certificate.verdict}: {_closest(found.sheet_certificate)}"),
        *((f"largest {name}", _fitted(one)) for name, one in (("cylinder", found.cylinder), ("box", found.box))),
        *_singularities(found),
    )
    margins = tuple(
        (label, certificate)
        for label, certificate in (
            ("sheet", found.sheet_certificate),
            ("cylinder", found.cylinder.certificate),
            ("box", found.box.certificate),
        )
    )
    return Study(
        title=f"{found.robot.name}: where it can work",
        facts=facts,
        tables=(_margin_table(margins), _slice_table(found.slices)),
        charts=_charts(found),
        notes=(
            "a proved margin holds at every point, also between the points that were looked at",
            "the means, the worst of 1/cond and the slices are of a grid of points, not proved",
        ),
        data=_data(found, mean=mean, worst=worst),
    )


def _singularities(found: WorkspaceStudy) -> tuple[tuple[str, str], ...]:
    region, joints = found.region, found.within_joints
    near_serial, near_parallel = _Worst.of(region, region.mu1, 1.0), _Worst.of(region, region.mu2, 1.0)
    beyond = int((joints.kept & (joints.mu2 >= math.pi / 2)).sum())
    count = int(joints.kept.sum())
    parallel = (
        f"{beyond} of {count} poses looked at in the joint range are beyond it"
        if beyond
        else f"mu2 is at most {_degrees(np.nanmax(np.where(joints.kept, joints.mu2, np.nan)))} at {count} poses in it"
    )
    return (
        ("nearest to the serial singularity", f"mu1 {_degrees(near_serial.value)} at {_place(near_serial.point)}"),
        (
            "nearest to the parallel singularity",
            f"mu2 {_degrees(near_parallel.value)} at {_place(near_parallel.point)}",
        ),
        (
            "serial, by the joint range alone",
            f"mu1 is at most {_degrees(np.nanmax(np.where(joints.kept, joints.mu1, np.nan)))}",
        ),
        ("parallel, by the joint range alone", parallel),
    )


def _closest(certificate: Certificate) -> str:
    one = certificate.worst
    where = _place(np.array(one.point))
    return f"{_NAMES[one.name]} is closest to its limit, by {_margin(one.name, one.sampled)} at {where}"


def _fitted(one: Fitted) -> str:
    shape = one.region
    low, high = shape.bounds[0][2], shape.bounds[1][2]
    size = (
        f"diameter {2e3 * shape.radius:.1f}"
        if isinstance(shape, Cylinder)
        else f"{1e3 * (shape.high[0] - shape.low[0]):.1f} x {1e3 * (shape.high[1] - shape.low[1]):.1f}"
    )
    return f"{size} mm, {1e3 * (high - low):.1f} mm high, z = {1e3 * low:.1f} to {1e3 * high:.1f} mm, certified"


def _margin_table(rows: tuple[tuple[str, Certificate], ...]) -> Table:
    names = [margin.name for margin in rows[0][1].margins]
    cells = []
    for column, name in enumerate(names):
        values = [one.margins[column] for _, one in rows]
        cells.append((_NAMES[name], *(f"{_margin(name, v.low)} / {_margin(name, v.sampled)}" for v in values)))
    heads = ("requirement", *(f"{label}: {one.verdict}" for label, one in rows))
    return Table("Margins, proved / found at a point", heads, tuple(cells))


def _slice_table(slices: tuple[Slice, ...]) -> Table:
    rows = []
    for one in slices:
        poses, kept = one.poses, one.poses.kept
        z = f"{1e3 * poses.points[0, 2]:.1f}"
        if not kept.any():
            rows.append((z, "0", *["-"] * 8))
            continue
        condition = poses.inverse_condition[kept]
        rows.append(
            (
                z,
                f"{1e4 * one.area:.0f}",
                f"{condition.min():.3f}",
                f"{condition.mean():.3f}",
                *(f"{math.degrees(values[kept].max()):.1f}" for values in (poses.mu1, poses.mu2, poses.swing)),
                f"{math.degrees(poses.angles[kept].min()):.1f} to {math.degrees(poses.angles[kept].max()):.1f}",
                f"{1e3 * poses.manipulability[kept].min():.3g}",
                f"{1e6 * math.radians(1.0 / 60.0) * poses.tool_error[kept].max():.0f}",
            )
        )
    heads = (
        "z, mm",
        "area, cm2",
        "1/cond worst",
        "mean",
        "mu1, deg",
        "mu2, deg",
        "swing, deg",
        "joints, deg",
        "|det J|, l/rad3",
        "um/arcmin",
    )
    return Table("Slices of the usable region", heads, tuple(rows))


def _charts(found: WorkspaceStudy) -> tuple[Chart, ...]:
    sections = ((found.sections[0], "Section along x"), (found.sections[1], "Section along y"))
    caption = "1/cond where every requirement is kept; the lines are the sheet and the largest certified cylinder."
    upright = [
        _map(one, heading, caption, one.poses.inverse_condition, "1/cond", _uprights(found, one.axes[0]))
        for one, heading in sections
    ]
    level, edge = found.level, (_sheet_outline(found.robot.workspace),)
    poses = level.poses
    pressure, swing = np.degrees(np.maximum(poses.mu1, poses.mu2)), np.degrees(poses.swing)
    kept = "Where every requirement is kept; the line is the sheet."
    return (
        *upright,
        _map(level, "1/cond at the height of the sheet", kept, poses.inverse_condition, "1/cond", edge),
        _map(
            level,
            "Pressure angle at the height of the sheet",
            f"The larger of mu1 and mu2. {kept}",
            pressure,
            "deg",
            edge,
        ),
        _map(level, "Forearm swing at the height of the sheet", kept, swing, "deg", edge),
        _map(
            level,
            "Manipulability at the height of the sheet",
            f"|det J|. {kept}",
            1e3 * poses.manipulability,
            "l/rad3",
            edge,
        ),
    )


def _map(one: Slice, heading: str, caption: str, values: Array, unit: str, outlines: tuple[Array, ...]) -> Chart:
    return heat_map(
        heading,
        caption,
        x_mm=1e3 * one.first,
        y_mm=1e3 * one.second,
        values=one.field(values),
        unit=unit,
        outlines=outlines,
        axes=(_AXES[one.axes[0]], _AXES[one.axes[1]]),
    )


def _uprights(found: WorkspaceStudy, axis: int) -> tuple[Array, ...]:
    """The sheet and the largest cylinder, seen from the side, mm."""
    low, high = found.cylinder.region.bounds
    left, right, bottom, top = low[axis], high[axis], low[2], high[2]
    sheet = _sheet_outline(found.robot.workspace)[:, axis]
    z = found.robot.workspace.sheet_z
    cylinder = np.array([[left, bottom], [right, bottom], [right, top], [left, top], [left, bottom]])
    return 1e3 * cylinder, np.array([[sheet.min(), 1e3 * z], [sheet.max(), 1e3 * z]])


def _sheet_outline(sheet: Workspace) -> Array:
    """Its edge from above, closed, (N, 2) mm."""
    if sheet.radius is not None:
        turn = np.linspace(0.0, 2.0 * np.pi, 97)
        return 1e3 * sheet.radius * np.stack((np.cos(turn), np.sin(turn)), axis=1)
    x, y = 500.0 * (sheet.width or 0.0), 500.0 * (sheet.depth or 0.0)
    return np.array([[-x, -y], [x, -y], [x, y], [-x, y], [-x, -y]])


def _data(found: WorkspaceStudy, *, mean: float, worst: _Worst) -> Json:
    return {
        "robot": found.robot.name,
        "volume_m3": {"proved_at_least": found.usable.low, "proved_at_most": found.usable.high, "about": found.volume},
        "inverse_condition": {"mean": mean, "worst": worst.value, "worst_at_mm": _mm(worst.point)},
        "sheet": _certificate_data(found.sheet_certificate),
        "cylinder": _shape_data(found.cylinder),
        "box": _shape_data(found.box),
        "slices": [
            {
                "z_mm": 1e3 * float(one.poses.points[0, 2]),
                "area_m2": one.area,
                "worst_inverse_condition": float(one.poses.inverse_condition[one.poses.kept].min(initial=1.0)),
            }
            for one in found.slices
        ],
    }


def _shape_data(one: Fitted) -> Json:
    low, high = one.region.bounds
    size = {"radius_mm": 1e3 * one.region.radius} if isinstance(one.region, Cylinder) else {}
    return {"low_mm": _mm(low), "high_mm": _mm(high), **size, **_certificate_data(one.certificate)}


def _certificate_data(one: Certificate) -> Json:
    return {
        "verdict": one.verdict,
        "margins": {
            margin.name: {
                "proved": margin.low if math.isfinite(margin.low) else None,
                "found": margin.sampled if math.isfinite(margin.sampled) else None,
                "at_mm": _mm(np.array(margin.point)),
            }
            for margin in one.margins
        },
    }


def _margin(name: str, value: float) -> str:
    if not math.isfinite(value):
        return "unknown"
    return f"{value:.3f}" if name in (REACH, "inverse_condition") else _degrees(value)


def _degrees(value: float) -> str:
    return f"{math.degrees(value):.2f} deg"


def _place(point: Array) -> str:
    return "({:.1f}, {:.1f}, {:.1f}) mm".format(*(1e3 * point))


def _mm(point: Array) -> list[float]:
    return [float(value) for value in 1e3 * point]
