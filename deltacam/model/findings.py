"""What a person should know."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that a person should know.

    Attributes:
        what: in words, one sentence without a full stop.
        where: the entity, contour or layer, in words.
        hint: what to do about it.
        kind: one word for programs: units, layer, text, duplicate, open, gap, branch, crossing, ...
        place: where in the sheet frame, (x, y) m, if it is in one place.
        blocks: whether nothing may be planned as long as it is so.
    """

    what: str
    where: str = ""
    hint: str = ""
    kind: str = "note"
    place: tuple[float, float] | None = None
    blocks: bool = False
