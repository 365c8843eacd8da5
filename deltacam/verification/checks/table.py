"""The table of checks. A new check is a function in its file and one line here; the order is that of every report."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from deltacam.model import Check
from deltacam.verification.checks import (
    common,
    contours,
    file,
    heat,
    laser,
    limits,
    overlap,
    parts,
    path,
    reach,
    reduced,
    stretches,
)
from deltacam.verification.comparison import Comparison
from deltacam.verification.evidence import Evidence

OF_SETPOINTS: Final[tuple[Callable[[Evidence], Check], ...]] = (
    file.integrity,
    file.tick_continuity,
    file.block_table,
    file.robot,
    limits.joint_range,
    limits.joint_speed,
    limits.joint_acceleration,
    limits.joint_jerk,
    limits.joint_speed_between,
    limits.joint_acceleration_between,
    laser.power_range,
    laser.laser_off,
    laser.laser_on,
    laser.pierce_before_cut,
    laser.cut_after_pierce,
    stretches.in_order,
    reach.poses,
)
"""Checks that need the rows alone."""

OF_POSITIONS: Final[tuple[Callable[[Evidence], Check], ...]] = (
    reach.reach_margin,
    reach.pressure_angle,
    reach.forearm_swing,
    reach.sheet_plane,
    reach.sheet_area,
    reach.sheet_plane_between,
    reach.sheet_area_between,
    reach.park,
    limits.rest_at_ends,
    limits.tool_speed,
    limits.tool_acceleration,
    limits.feed,
    laser.pierce_at_rest,
    laser.laser_at_rest,
    heat.time_to_spread,
    laser.line_energy,
)
"""Checks that need the tool's position at every tick."""

OF_CONTOURS: Final[tuple[Callable[[Comparison], Check], ...]] = (
    contours.known_contours,
    contours.cut_once,
    contours.resumed,
    path.deviation,
    path.deviation_between,
    path.uncut,
    path.cut_length,
    overlap.cut_again,
    reduced.reduced_feed,
    parts.part_size,
    parts.part_edge,
    parts.pierce_outside,
    parts.leads_outside,
    stretches.overcut,
    stretches.tab_width,
    contours.closed,
    contours.holes_first,
    contours.contours_last,
)
"""Checks that need the drawing too."""

OF_COMMON_EDGES: Final[tuple[Callable[[Comparison], Check], ...]] = (common.parts_free, common.shared_first)
"""Checks that there are besides where the process lets outlines share edges."""
