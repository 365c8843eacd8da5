"""The table of kinds of damage: which check must find each, what is tolerated, and how large the mutants are.

A new check needs a line here.
"""

from deltacam.model import BlockKind, Mode
from tests.damage import in_contours, in_drawing, in_file, in_laser, in_motion, in_place, in_robot, in_stretches
from tests.damage.in_motion import DOUBLED, LOST, SWAPPED, of_curve, of_joints, of_tool
from tests.damage.kind import READING, Kind

FILE = ("file integrity", READING)
LIMIT = "the limit and 0.1 %"
PATH = "the tolerance"
EDGE = "the sum of both tolerances"
MICROMETRE = "1 um"
IN_PLACE = "leads, loops and tabs in their place"
REST = "20 ms or 3 ticks"

OF_FILES: dict[str, Kind] = {
    "end cut off": Kind(in_file.end_cut_off, FILE, "no byte", 1, 10_000),
    "last rows lost": Kind(in_file.last_rows_lost, ("file integrity",), "no row", 1, 100),
    "rows lost": Kind(in_file.rows_lost, ("tick continuity",), "no row", 1, 100),
    "rows doubled": Kind(in_file.rows_doubled, ("tick continuity",), "no row", 1, 100),
    "rows swapped": Kind(in_file.rows_swapped, ("tick continuity",), "no row", 1, 100),
    "digits changed": Kind(in_file.digits_changed, FILE, "no digit", 1, 100),
    "cells that are no numbers": Kind(in_file.not_a_number, (READING,), "no cell", 1, 50),
    "other line ends": Kind(in_file.other_line_ends, FILE, "no line", 1, 50),
    "rows lost, the hash repaired": Kind(in_file.renumbered, ("block table",), "no row", 1, 100),
    "another hash in the meta": Kind(in_file.in_meta(in_file.other_hash), ("file integrity",), "no digit", 1, 64),
    "another count in the meta": Kind(in_file.in_meta(in_file.other_count), ("file integrity",), "no row", 1, 100),
    "another rate in the meta": Kind(in_file.in_meta(in_file.other_rate), ("file integrity",), "nothing", 1e-9, 1.0),
    "an arm changed in the meta": Kind(in_file.in_meta(in_file.other_arm), (READING,), "nothing", 1e-9, 1e-3),
    "keys lost in the meta": Kind(in_file.in_meta(in_file.key_lost), (READING,), "no key", 1, 5),
    "keys added to the meta": Kind(in_file.in_meta(in_file.key_added), (READING,), "no key", 1, 5),
    "blocks that overlap": Kind(in_file.blocks_overlap, ("block table",), "no tick", 1, 100),
    "blocks lost in the table": Kind(in_file.blocks_end_early, ("block table",), "no block", 1, 5),
    "rows of no block": Kind(in_file.block_unknown, ("block table",), "no row", 1, 50),
}
"""Damage that the file itself gives away."""

OF_MOTION: dict[str, Kind] = {
    "played faster: joint speed": Kind(
        in_motion.faster_controller(of_joints(1), 1), ("joint speed",), LIMIT, 1.01, 3.0, 0.99
    ),
    "played faster: joint acceleration": Kind(
        in_motion.faster_controller(of_joints(2), 2), ("joint acceleration",), LIMIT, 1.01, 9.0, 0.99
    ),
    "played faster: joint jerk": Kind(
        in_motion.faster_controller(of_joints(3), 3), ("joint jerk",), LIMIT, 1.01, 27.0, 0.99
    ),
    "played faster: tool speed": Kind(
        in_motion.faster_controller(of_tool(1), 1), ("tool speed",), LIMIT, 1.01, 3.0, 0.99
    ),
    "played faster: tool acceleration": Kind(
        in_motion.faster_controller(of_tool(2), 2), ("tool acceleration",), LIMIT, 1.01, 9.0, 0.99
    ),
    "played faster: feed": Kind(in_motion.faster_feed, ("feed while cutting",), LIMIT, 1.01, 3.0, 0.99),
    "a slower feed in the meta": Kind(in_motion.slower_feed_in_meta, ("feed while cutting",), LIMIT, 1.01, 3.0, 0.99),
    "a slower feed in holes in the meta": Kind(
        in_motion.slower_holes_in_meta, ("reduced feed",), LIMIT, 1.01, 3.0, 0.99
    ),
    "a slower feed in bends in the meta": Kind(in_motion.slower_bends_in_meta, ("reduced feed",), LIMIT, 1.01, 3.0),
    "a cut resampled faster": Kind(in_motion.faster_cut, ("feed while cutting",), LIMIT, 1.01, 3.0),
    "a jolt: joint speed": Kind(in_motion.jolt(of_joints(1)), ("joint speed",), LIMIT, 1.01, 10.0, 0.99),
    "a jolt: joint acceleration": Kind(in_motion.jolt(of_joints(2)), ("joint acceleration",), LIMIT, 1.01, 10.0, 0.99),
    "a jolt: joint jerk": Kind(in_motion.jolt(of_joints(3)), ("joint jerk",), LIMIT, 1.01, 10.0, 0.99),
    "a jolt: tool speed": Kind(in_motion.tool_jolt(1), ("tool speed",), LIMIT, 1.01, 10.0, 0.99),
    "a jolt: tool acceleration": Kind(in_motion.tool_jolt(2), ("tool acceleration",), LIMIT, 1.01, 10.0, 0.99),
    "all angles trembling": Kind(in_motion.trembling, ("joint acceleration",), LIMIT, 1.01, 10.0, 0.99),
    "a tick doubled": Kind(in_motion.rearranged(DOUBLED), ("tool acceleration",), LIMIT, 1.01, 2.0, 0.99),
    "a tick lost": Kind(in_motion.rearranged(LOST), ("tool acceleration",), LIMIT, 1.01, 2.0, 0.99),
    "two ticks swapped": Kind(in_motion.rearranged(SWAPPED), ("tool acceleration",), LIMIT, 1.01, 4.0, 0.99),
    "an end at speed": Kind(
        in_motion.end_at_speed, ("rest at both ends",), "a dt^2 / 2 at the tool's full acceleration", 1.01, 3.0
    ),
    "standing still in a cut": Kind(in_motion.standing_in_a_cut, ("laser on at rest",), REST, 1.05, 10.0),
    "a jolt: joint speed between ticks": Kind(
        in_motion.jolt(of_curve(1)), ("joint speed between ticks",), LIMIT, 1.01, 10.0, 0.99
    ),
    "swinging between ticks": Kind(in_motion.swinging, ("joint acceleration between ticks",), LIMIT, 1.01, 2.5),
}
"""Motion that the machine cannot follow, or that burns."""

OF_LASER: dict[str, Kind] = {
    "laser on in a rapid": Kind(in_laser.on_in_rapid, ("laser off outside cuts",), "no tick", 1, 1000),
    "laser off in a cut": Kind(
        in_laser.off_in(BlockKind.CUT, BlockKind.ENGRAVE), ("laser on in all cuts",), "no tick", 1, 1000
    ),
    "laser off in a pierce": Kind(in_laser.off_in(BlockKind.PIERCE), ("laser on in all cuts",), "no tick", 1, 1000),
    "laser weaker for a tick": Kind(in_laser.weaker, ("laser on in all cuts",), "nothing", 1e-9, 0.5),
    "a power beside its law": Kind(
        in_laser.beside_the_law, ("laser on in all cuts",), "a thousandth of the rated power", 1.1, 50.0, 0.9
    ),
    "a power of more than 1": Kind(in_laser.too_strong, ("laser power from 0 to 1",), "nothing", 1e-9, 1.0),
    "a power of less than 0": Kind(in_laser.negative, ("laser power from 0 to 1",), "nothing", 1e-9, 1.0),
    "another power in the meta": Kind(in_laser.other_power_in_meta, ("laser on in all cuts",), "nothing", 1e-9, 0.5),
    "a dry run with the laser on": Kind(
        in_laser.other_mode(Mode.DRY_RUN), ("laser off outside cuts",), "no tick", 1, 1000
    ),
    "a frame with the laser on": Kind(in_laser.other_mode(Mode.FRAME), ("laser off outside cuts",), "no tick", 1, 1000),
    "a dry run said to cut": Kind(in_laser.dry_run_said_to_cut, ("laser on in all cuts",), "no tick", 0.0, 1.0),
    "pierced too short": Kind(in_laser.pierce_shortened, ("pierce before every cut",), "half a tick", 1.01, 10.0),
    "pierced for too long": Kind(in_laser.pierced_too_long, ("laser on at rest",), REST, 1.05, 10.0),
    "not pierced": Kind(in_laser.not_pierced, ("pierce before every cut",), "half a tick", 1, 100),
    "a longer pierce in the meta": Kind(
        in_laser.longer_pierce_in_meta, ("pierce before every cut",), "half a tick", 0.51, 100.0, 0.49
    ),
    "pierced for another contour": Kind(in_laser.pierced_for_another, ("cut after every pierce",), "no pierce", 1, 100),
    "a hole burnt at the end": Kind(in_laser.hole_burnt, ("cut after every pierce",), "no tick", 1, 100),
    "a hole burnt after a cut": Kind(in_laser.rest_before_rapid, ("cut after every pierce",), "no tick", 1, 100),
}
"""The laser on where it should be off, off where it should be on, and pierces."""

OF_PLACES: dict[str, Kind] = {
    "a setpoint beside its path": Kind(in_place.beside_path, ("deviation at ticks",), PATH, 1.1, 30.0, 0.9),
    "a setpoint hidden by a wide tolerance": Kind(
        in_place.hidden_by_tolerance, ("deviation at ticks",), PATH, 1.1, 30.0, 0.9
    ),
    "a cut with a bulge": Kind(in_place.bulge, ("deviation at ticks",), PATH, 1.1, 30.0, 0.9),
    "a bulge into the part": Kind(in_place.into_the_part, ("part edge",), EDGE, 1.1, 10.0),
    "cuts too near to their lines": Kind(in_place.too_near_to_line, ("deviation at ticks",), PATH, 1.1, 3.0),
    "the kerf on the wrong side": Kind(in_place.kerf_side, ("deviation at ticks",), "the tolerance", 1.0, 2.0),
    "all parts too small": Kind(in_place.parts_too_small, ("part size",), EDGE, 1.1, 5.0),
    "a setpoint above the sheet": Kind(in_place.above_sheet, ("sheet plane",), MICROMETRE, 1.05, 1000.0, 0.9),
    "an end beside the park position": Kind(in_place.beside_park, ("park position",), MICROMETRE, 1.05, 1000.0, 0.9),
    "moved in a pierce": Kind(in_place.moved_in_pierce(False), ("rest while piercing",), MICROMETRE, 1.05, 100.0, 0.9),
    "moved as a pierce ends": Kind(
        in_place.moved_in_pierce(True), ("rest while piercing",), MICROMETRE, 1.05, 100.0, 0.9
    ),
    "off the sheet": Kind(in_place.off_the_sheet, ("sheet area",), MICROMETRE, 1.05, 5000.0, 0.9),
    "a smaller sheet": Kind(in_place.off_sheet_of_robot, ("sheet area",), MICROMETRE, 1.05, 5000.0, 0.9),
    "a smaller sheet, between ticks": Kind(
        in_place.off_sheet_between, ("sheet area between ticks",), "the tolerance of chords", 1.1, 100.0, 0.9
    ),
    "fewer rows: beside the path": Kind(in_place.fewer_rows(False), ("deviation between ticks",), EDGE, 1.1, 10.0),
    "fewer rows: above the sheet": Kind(
        in_place.fewer_rows(True), ("sheet plane between ticks",), "the tolerance of chords", 1.1, 10.0
    ),
}
"""The tool is not where it should be."""

OF_ROBOTS: dict[str, Kind] = {
    "another base radius": Kind(in_robot.dimension("base_radius"), ("sheet plane",), MICROMETRE, 1.05, 1000.0, 0.9),
    "another effector radius": Kind(
        in_robot.dimension("effector_radius"), ("sheet plane",), MICROMETRE, 1.05, 1000.0, 0.9
    ),
    "another upper arm": Kind(in_robot.dimension("upper_arm"), ("sheet plane",), MICROMETRE, 1.05, 1000.0, 0.9),
    "another forearm": Kind(in_robot.dimension("forearm"), ("sheet plane",), MICROMETRE, 1.05, 1000.0, 0.9),
    "an arm in another direction": Kind(in_robot.azimuth, ("sheet plane",), MICROMETRE, 1.05, 100.0, 0.9),
    "all arms in another direction": Kind(in_robot.all_azimuths, ("deviation at ticks",), PATH, 1.1, 30.0),
    "a joint offset": Kind(in_robot.joints_offset(0), ("sheet plane",), MICROMETRE, 1.05, 1000.0, 0.9),
    "all joints offset": Kind(in_robot.joints_offset(0, 1, 2), ("sheet plane",), MICROMETRE, 1.05, 1000.0, 0.9),
    "two joints swapped": Kind(in_robot.joints_swapped, ("deviation at ticks",), "no row", 1, 2),
    "an arm that does not close": Kind(in_robot.folded, ("possible poses",), "nothing", 0.0, 1.0),
    "another sheet in the placement": Kind(in_robot.other_plane, ("sheet plane",), MICROMETRE, 1.05, 1000.0, 0.9),
    "another sheet of the robot": Kind(in_robot.other_sheet, ("sheet plane",), MICROMETRE, 1.05, 1000.0, 0.9),
    "slightly another robot": Kind(in_robot.slightly_other_robot, ("robot",), "nothing", 1e-3, 1000.0),
    "quite another robot": Kind(in_robot.quite_another_robot, ("robot",), "nothing", 1, 2),
    "limits raised in the meta": Kind(in_robot.limits_raised, ("robot",), "nothing", 1e-9, 1.0),
    "a joint beyond its stop": Kind(
        in_robot.joint_stop, ("joint range (at least)",), "a millionth of a degree", 1.05, 1e6, 0.9
    ),
    "too large a pressure angle": Kind(
        in_robot.pressure, ("pressure angle",), "a millionth of a degree", 1.05, 1e6, 0.9
    ),
    "too large a swing": Kind(in_robot.swing, ("forearm swing",), "a millionth of a degree", 1.05, 1e5, 0.9),
}
"""The robot is another one."""

OF_DRAWINGS: dict[str, Kind] = {
    "other bytes": Kind(in_drawing.other_bytes, ("drawing",), "no digit of the hash", 1, 64),
    "another unit": Kind(in_drawing.other_unit, ("drawing",), "nothing", 1e-9, 24.4),
    "other ends joined": Kind(in_drawing.other_joining, ("drawing",), "nothing", 1e-9, 10.0),
    "other layers": Kind(in_drawing.other_layers, ("drawing",), "no layer", 1, 5),
    "a contour drawn elsewhere": Kind(in_drawing.contour_moved, ("deviation at ticks",), PATH, 1.1, 100.0),
    "drawn at another scale": Kind(in_drawing.scaled, ("deviation at ticks",), PATH, 1.1, 100.0),
    "drawn mirrored": Kind(in_drawing.mirrored, ("deviation at ticks",), "no contour", 1, 2),
    "a line that is not cut": Kind(in_drawing.line_added, ("every contour cut once",), "no line", 500.0, 10_000.0),
    "cuts that are not drawn": Kind(in_drawing.line_removed, ("cuts of drawn contours only",), "no cut", 1, 100),
    "another kerf in the meta": Kind(in_drawing.other_kerf, ("deviation at ticks",), PATH, 1.1, 30.0),
    "a finer tolerance in the meta": Kind(in_drawing.finer_tolerance, ("deviation at ticks",), PATH, 1.15, 5.0),
    "a wider tolerance in the meta": Kind(in_drawing.wider_tolerance, ("process",), "nothing", 1e-9, 10.0),
    "the placement shifted": Kind(in_drawing.placement_shifted, ("deviation at ticks",), PATH, 1.1, 100.0),
    "the placement turned": Kind(in_drawing.placement_turned, ("deviation at ticks",), PATH, 1.1, 100.0),
}
"""The drawing, or what the file says about it, is another one."""

OF_CONTOURS: dict[str, Kind] = {
    "contours missing": Kind(in_contours.missing, ("every contour cut once",), "no contour", 1, 100),
    "contours doubled": Kind(in_contours.doubled, ("every contour cut once",), "no contour", 1, 100),
    "an outline before what is in it": Kind(
        in_contours.outline_too_early, ("inner contours first",), "no contour", 1, 2
    ),
    "engraved after cuts": Kind(in_contours.engraved_late, ("contours cut last",), "no cut", 1, 2),
    "contours of unknown numbers": Kind(
        in_contours.unknown_number, ("cuts of drawn contours only",), "no contour", 1, 100
    ),
    "contours said to be each other": Kind(in_contours.numbers_swapped, ("deviation at ticks",), "no contour", 1, 2),
    "cuts said to be rapids": Kind(
        in_contours.cut_said_to_be(BlockKind.RAPID), ("laser off outside cuts",), "no cut", 1, 100
    ),
    "cuts said to be lead-ins": Kind(
        in_contours.cut_said_to_be(BlockKind.LEAD_IN), ("every contour cut once",), "no cut", 1, 100
    ),
    "cuts said to be engraved": Kind(
        in_contours.cut_said_to_be(BlockKind.ENGRAVE), ("cuts of drawn contours only",), "no cut", 1, 100
    ),
    "ended before its start": Kind(
        in_contours.ended_early, ("uncut length",), "both tolerances twice and 0.2 mm", 1.1, 10.0
    ),
    "an end that does not meet its start": Kind(
        in_contours.end_beside_start, ("gap at the end of a cut",), PATH, 1.1, 30.0
    ),
    "there and back instead of around": Kind(
        in_contours.there_and_back, ("uncut length",), "a tenth of the way", 0.4, 0.0
    ),
    "cut on beyond its end": Kind(
        in_contours.too_long, ("cut length",), "2 % and what the tolerances explain", 1.1, 5.0
    ),
    "a stretch cut again": Kind(in_contours.cut_again, ("material cut twice",), "1 mm", 1.2, 10.0),
    "pierced in the part": Kind(in_contours.pierced_in_part, ("pierce outside the part",), PATH, 1.1, 30.0, 0.9),
    "a lead-in through the part": Kind(
        in_contours.lead_through_part(BlockKind.LEAD_IN), ("leads outside the part",), EDGE, 1.1, 30.0, 0.9
    ),
    "a lead-out through the part": Kind(
        in_contours.lead_through_part(BlockKind.LEAD_OUT), ("leads outside the part",), EDGE, 1.1, 30.0, 0.9
    ),
    "a lead of a line through the part": Kind(
        in_contours.lead_through_part(BlockKind.LEAD_OUT, of_line=True),
        ("leads outside the part",),
        EDGE,
        1.1,
        30.0,
        0.9,
    ),
}
"""What is cut is not what is drawn, or not in an order that keeps parts in place."""

OF_STRETCHES: dict[str, Kind] = {
    "lead-ins said to be loops": Kind(in_stretches.lead_said_to_be_loop, (IN_PLACE,), "no lead-in", 1, 100),
    "lead-outs said to be tabs": Kind(in_stretches.lead_out_said_to_be_tab, (IN_PLACE,), "no lead-out", 1, 100),
    "a longer overcut in the meta": Kind(
        in_stretches.longer_overcut_in_meta, ("overcut",), "a tick and both tolerances", 1.05, 5.0, 0.9
    ),
    "a shorter overcut in the meta": Kind(
        in_stretches.shorter_overcut_in_meta, ("overcut",), "two ticks and both tolerances", 1.05, 2.0, 0.9
    ),
    "wider tabs in the meta": Kind(in_stretches.wider_tabs_in_meta, ("tab width",), EDGE, 1.05, 10.0, 0.9),
    "a longer time between cuts in the meta": Kind(
        in_stretches.heat_in_meta, ("time for heat to spread",), "half a tick", 1.05, 100.0, 0.9
    ),
    "begun with another contour": Kind(
        in_stretches.begun_elsewhere_in_meta, ("begins at its contour",), "no contour", 1, 2
    ),
    "tabs that nobody asked for": Kind(in_stretches.tabs_nobody_asked_for, ("tab width",), "no tab", 1, 100),
}
"""What is beside the cut itself is not what the process says, or not where it belongs."""

KINDS: dict[str, Kind] = (
    OF_FILES | OF_MOTION | OF_LASER | OF_PLACES | OF_ROBOTS | OF_DRAWINGS | OF_CONTOURS | OF_STRETCHES
)
