"""A process becomes a process file, with a comment at every value."""

from __future__ import annotations

from typing import Final

from deltacam.cutting.process_file.values import Section, quoted, sections
from deltacam.model import Process

MEANINGS: Final[dict[str, str]] = {
    "name": "goes into every program and report",
    "source": "where the numbers are from",
    "material": "for people",
    "thickness_mm": "of the material",
    "laser": "fibre, co2",
    "laser_power_w": "rated",
    "gas": "the assist gas in use",
    "kerf_mm": "width of the cut",
    "feed_m_min": "speed along the contour; an upper limit",
    "feed_range_m_min": "the slowest and the fastest that is sensible",
    "power": "share of the laser's rated power",
    "pierce_time_s": "rest with the laser on before each cut",
    "overcut_mm": "how far the laser stays on beyond the start of a closed cut",
    "start": "where a closed cut begins: best for the order, edge, corner",
    "corner": "sharp corners: round, stop, loop",
    "passes": "how often every cut is run",
    "common_edges": "whether edges of two parts, a kerf apart, are cut once",
    "tolerance_um": "of the path",
    "chord_tolerance_um": "of the motion between ticks",
    "open": "lines that do not close: ignore, engrave, cut",
    "operations": "no rules: everything is cut",
    "engrave.feed_m_min": "speed along the line",
    "engrave.power": "share of the laser's rated power",
    "shape": "none, line, arc, line+arc",
    "length_mm": 'a number, or "auto": as long as it takes to reach the feed',
    "radius_mm": "of the arc",
    "angle_deg": "of a line to the contour; what an arc turns by",
    "pierce.power": "share of the laser's rated power",
    "pierce.first": "all pierces before the first cut",
    "power_law.at_rest": "power at rest, as a part of that at the feed",
    "power_law.exponent": "of the speed, as a part of the feed",
    "power_law.lowest": "never less, of the rated power",
    "slower.factor": "of the feed",
    "slower.hole_diameter_mm": "in holes up to this size",
    "slower.radius_mm": "in bends up to this radius",
    "loops.angle_deg": "outer corners that turn by at least this",
    "loops.radius_mm": "of the loop",
    "tabs.width_mm": "of what is left",
    "tabs.count": "for every outline",
    "tabs.spacing_mm": "at most so far apart",
    "tabs.corner_mm": "so far from every corner at least",
    "tabs.holes": "whether what falls out of holes is held too",
    "heat.distance_mm": "the next cut begins so far away",
    "heat.time_s": "or so much later",
    "gases.pressure_bar": "",
    "gases.feed_factor": "the feed is feed_m_min times this",
}
"""What a value means, by its key, or by its section and key."""

EXAMPLES: Final = """\
[engrave]
feed_m_min = 6.0      # speed along the line
power = 0.2           # share of the laser's rated power

[lead_in]
shape = "line+arc"    # none, line, arc, line+arc; on the waste side
length_mm = "auto"    # as long as it takes to reach the feed, or a number
angle_deg = 90        # of a line to the contour; what an arc turns by

[lead_out]
shape = "line"        # with the laser off
length_mm = 1.0

[pierce]
power = 0.5           # share of the laser's rated power
first = true          # all pierces before the first cut

[power_law]
at_rest = 0.3         # power at rest, as a part of that at the feed
exponent = 1.0
lowest = 0.1          # never less, of the rated power

[[slower]]
factor = 0.5          # of the feed
hole_diameter_mm = 4  # in holes up to this size
radius_mm = 1         # and in bends up to this radius

[loops]
angle_deg = 60        # outer corners that turn by at least this, where corner = "loop"

[tabs]
width_mm = 0.5        # of what is left
count = 4             # for every outline; or spacing_mm = 50
corner_mm = 2         # so far from every corner at least
holes = false         # whether what falls out of holes is held too

[heat]
distance_mm = 20      # the next cut begins so far away
time_s = 1.0          # or so much later

[provenance]
kerf_mm = { grade = "measured", source = "kerf comb, caliper" }
"""
"""A section of every kind that a process may have none of."""

_COLUMN: Final = 26


def to_toml(process: Process, *, heading: str = "", examples: bool = False) -> str:
    """The process as its file: reading it gives the same process.

    Args:
        process: any that `check_process` lets pass.
        heading: lines of text that go above it as a comment.
        examples: whether the sections that the process has none of follow as comments, ready to be used.
    """
    lines = [f"# {line}".rstrip() for line in heading.splitlines()]
    for section in sections(process):
        lines += _section(section)
    lines += _provenance(process)
    if examples:
        lines += _examples(process)
    return "\n".join(lines) + "\n"


def _section(section: Section) -> list[str]:
    lines = []
    if section.name:
        lines = ["", f"[[{section.name}]]" if section.repeated else f"[{_dotted(section.name)}]"]
    for value in section.values:
        kind = section.name.partition(".")[0]
        meaning = MEANINGS.get(f"{kind}.{value.key}") or MEANINGS.get(value.key, "")
        written = f"{value.key} = {value.text}"
        lines.append(f"{written:<{_COLUMN}}  # {meaning}" if meaning and len(written) <= _COLUMN else written)
    return lines


def _dotted(name: str) -> str:
    """The name of a section; the name of a gas may hold anything."""
    kind, dot, rest = name.partition(".")
    if not dot or (rest.isascii() and rest.replace("-", "").replace("_", "").isalnum()):
        return name
    return f"{kind}.{quoted(rest)}"


def _provenance(process: Process) -> list[str]:
    if not process.provenance:
        return []
    lines = [
        "",
        "# Where the values are from: vendor, community, measured on a machine, or an estimate.",
        "[provenance]",
    ]
    for one in process.provenance:
        source = f", source = {quoted(one.source)}" if one.source else ""
        lines.append(f'{_dotted(one.key)} = {{ grade = "{one.grade}"{source} }}')
    return lines


def _examples(process: Process) -> list[str]:
    """The sections of `EXAMPLES` that the process lacks, as comments."""
    has = {section.name for section in sections(process)} | ({"provenance"} if process.provenance else set())
    lines = ["", "# Take away the # of what you need:"]
    for example in EXAMPLES.split("\n\n"):
        if example.partition("\n")[0].strip("[]") not in has:
            lines += ["#", *(f"# {line}" for line in example.splitlines())]
    return lines
