"""What a file of another program says of a robot, in our frame and in SI."""

from __future__ import annotations

from dataclasses import dataclass

from deltacam.robot.dimensions import DeltaGeometry, Triple


@dataclass(frozen=True, slots=True)
class Fact:
    """Something that was read.

    Attributes:
        source: where it stands: ``printer.cfg:3 [printer] shoulder_radius``, or whose default it is.
        value: as it was written.
        became: what it is in the robot file: ``base_radius_mm = 33.9``.
    """

    source: str
    value: str
    became: str


@dataclass(frozen=True, slots=True)
class Choices:
    """What the user says of a file where the file does not.

    Attributes:
        millimetres_per_unit: of the lengths; None where nothing was said.
        joints_at: for the base and the effector, "middles" or "vertices" of the triangle; None as above.
    """

    millimetres_per_unit: float | None = None
    joints_at: tuple[str, str] | None = None


@dataclass(frozen=True, slots=True)
class Description:
    """A robot as far as the file describes it; None is what the file does not say.

    Attributes:
        name: a name for the robot.
        program: whose file it is.
        files: their names.
        geometry: the dimensions, joints in the order of the file.
        joint_min: rad; per joint.
        joint_max: rad.
        max_joint_speed: rad/s.
        max_joint_acceleration: rad/s^2.
        tool_speed: m/s.
        tool_acceleration: m/s^2.
        bed_z: height of the file's own bed in the machine, m.
        bed_radius: of a round bed, m.
        facts: what was read.
        unused: the entries of the file that were not used.
        notes: what a person should know.
        remarks: comments for the robot file, by ``section.key``.
    """

    name: str
    program: str
    files: tuple[str, ...]
    geometry: DeltaGeometry
    joint_min: Triple | None = None
    joint_max: Triple | None = None
    max_joint_speed: Triple | None = None
    max_joint_acceleration: Triple | None = None
    tool_speed: float | None = None
    tool_acceleration: float | None = None
    bed_z: float | None = None
    bed_radius: float | None = None
    facts: tuple[Fact, ...] = ()
    unused: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    remarks: tuple[tuple[str, str], ...] = ()
