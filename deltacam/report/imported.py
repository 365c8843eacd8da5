"""An imported robot for people and as JSON: what was read, what it became, what was not used, what is an estimate."""

from __future__ import annotations

from typing import Any, Final

from deltacam.plain import plain
from deltacam.robot.importers.complete import Imported

_LISTED: Final = 12  # entries of the file that were not used
_LINE: Final = 160


def to_text(imported: Imported) -> str:
    """The listing for people."""
    rows = [(plain(fact.source), plain(fact.value), plain(fact.became, longest=_LINE)) for fact in imported.facts]
    first, second = (max((len(row[column]) for row in rows), default=0) for column in (0, 1))
    robot = imported.robot
    lines = [f"robot {plain(robot.name)}, {robot.source and plain(robot.source, longest=_LINE)}", "read:"]
    lines += [f"  {source:{first}}  {value:{second}}  ->  {became}" for source, value, became in rows]
    lines += ["estimates, to be replaced:"] if imported.estimates else ["estimates: none"]
    lines += [f"  {key}: {remark}" for key, remark in imported.estimates]
    if robot.joints.derived:
        lines.append(f"derived from the rating of the tool: {', '.join(robot.joints.derived)} of the joints")
    lines += _unused(imported)
    lines += [f"note: {plain(note, longest=_LINE * 2)}" for note in imported.notes]
    return "\n".join(lines)


def to_dict(imported: Imported) -> dict[str, Any]:
    """The object of ``--json``; it also holds the robot file."""
    return {
        "program": imported.program,
        "robot": {
            "name": imported.robot.name,
            "fingerprint": imported.robot.fingerprint,
            **imported.robot.motion_values(),
        },
        "read": [{"source": fact.source, "value": fact.value, "became": fact.became} for fact in imported.facts],
        "unused": list(imported.unused),
        "estimates": [{"key": key, "remark": remark} for key, remark in imported.estimates],
        "derived": list(imported.robot.joints.derived),
        "notes": list(imported.notes),
        "toml": imported.toml,
    }


def _unused(imported: Imported) -> list[str]:
    if not imported.unused:
        return ["not used: nothing"]
    shown = [f"  {plain(entry, longest=_LINE)}" for entry in imported.unused[:_LISTED]]
    more = len(imported.unused) - _LISTED
    return [f"not used: {len(imported.unused)}", *shown, *([f"  and {more} more, see --json"] if more > 0 else [])]
