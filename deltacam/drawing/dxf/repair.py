"""A damaged or sloppy file rewritten as one that ezdxf reads: the tolerant reader.

Units, layers, blocks and entities are kept; everything else of the file is left out. Every entity of the file is either
in the new text or in the list of those that are lost.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Final

from deltacam.drawing.dxf import clean
from deltacam.drawing.dxf.census import DRAWN, ELSEWHERE, flaw, is_entity, is_object
from deltacam.drawing.dxf.clean import DamagedError
from deltacam.drawing.dxf.tags import Group, Groups
from deltacam.errors import DrawingError
from deltacam.model import LedgerEntry, Outcome

_CHILDREN: Final = {"POLYLINE": "VERTEX", "INSERT": "ATTRIB"}
_MARKED: Final = ("LWPOLYLINE", "SPLINE", "ELLIPSE")
"""Kinds that are never written without subclass markers by the book."""

_FIXED: Final = ("LINE", "CIRCLE", "ARC")
"""Kinds that are whole if they have all that they need; others may miss more."""


@dataclass(frozen=True, slots=True)
class Repaired:
    """What was made of a file.

    Attributes:
        text: DXF text.
        kept: how many entities of each kind are in the text.
        lost: those that are not.
        repairs: what was wrong with the file besides, in words.
        cut_off: "start" or "end" where the file has none, so that nobody knows what else it held; else empty.
    """

    text: str
    kept: Counter[str]
    lost: tuple[LedgerEntry, ...]
    repairs: tuple[str, ...]
    cut_off: str


def repair(groups: Groups, file: str, *, bare: bool) -> Repaired:
    """The text of a valid file with what the groups hold.

    Args:
        groups: of a file in UTF-8.
        file: its name, for messages.
        bare: leave out the contents of entities that draw nothing, in case ezdxf does not like them.

    Raises:
        DrawingError: coordinates with a decimal comma, which could be read as other numbers.
    """
    walk = _Walk(groups, file, bare=bare)
    for i in range(len(groups)):
        walk.visit(i)
    return walk.finish()


@dataclass(slots=True)
class _Parent:
    """A POLYLINE or INSERT whose vertices or attributes may follow."""

    group: Group
    parts: list[str]
    problem: str = ""


@dataclass(slots=True)
class _Block:
    """The block that the walk is in.

    Attributes:
        problem: why its entities cannot be used.
    """

    name: str
    problem: str = ""


@dataclass(slots=True)
class _Walk:
    """One pass over the groups of a file."""

    groups: Groups
    file: str
    bare: bool
    section: str = ""
    block: _Block | None = None
    parent: _Parent | None = None
    opened: bool = False
    any_section: bool = False
    started: bool = True
    ended: bool = True
    handles: set[bytes] = field(default_factory=set)
    layers: dict[str, str] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    blocks: dict[str, list[str]] = field(default_factory=dict)
    model: list[str] = field(default_factory=list)
    kept: Counter[str] = field(default_factory=Counter)
    lost: list[LedgerEntry] = field(default_factory=list)
    repairs: Counter[str] = field(default_factory=Counter)

    def visit(self, index: int) -> None:
        """Take up one group."""
        group = self.groups.group(index)
        kind = group.kind.upper()
        if kind != group.kind:
            group = Group(kind, group.tags, group.whole)
        if self.parent and kind != _CHILDREN[self.parent.group.kind]:
            self._close_parent(self.parent)
        if kind not in DRAWN and flaw(group):
            self._lose(Group("?", group.tags, group.whole), flaw(group))
        if kind == "SECTION":
            self._open_section(group)
        elif kind in ("ENDSEC", "EOF"):
            self._close_section(kind)
        elif kind == "BLOCK":
            self._open_block(group)
        elif kind == "ENDBLK":
            self._close_block()
        elif kind == "LAYER" and self.section not in ("ENTITIES", "BLOCKS"):
            self._layer(group)
        elif is_entity(kind, self.section):
            self.ended = False
            self.started = self.started and self.section not in ELSEWHERE
            self._entity(group, is_last=index + 1 == len(self.groups))

    def finish(self) -> Repaired:
        """The text, once every group was visited."""
        cut_off = "" if self.ended else "end"
        if self.parent:
            if cut_off:
                self.parent.problem = "the file ends inside it"
            self._close_parent(self.parent)
        header = "".join(f"9\n{name}\n70\n{value}\n" for name, value in self.units.items())
        # One join for each part: a large file is not copied entity by entity.
        blocks = "".join("".join(parts) + "0\nENDBLK\n" for parts in self.blocks.values())
        text = (
            f"0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1024\n{header}0\nENDSEC\n"
            f"0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n{''.join(self.layers.values())}0\nENDTAB\n0\nENDSEC\n"
            f"0\nSECTION\n2\nBLOCKS\n{blocks}0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{''.join(self.model)}0\nENDSEC\n0\nEOF\n"
        )
        repairs = tuple(f"{count} {what}" for what, count in self.repairs.items())
        return Repaired(text, self.kept, tuple(self.lost), repairs, cut_off or ("" if self.started else "start"))

    def _open_section(self, group: Group) -> None:
        self._close_block()
        self.opened = self.any_section = True
        self.section = clean.text(group.first(2)).upper()
        if self.section != "HEADER":
            return
        names = [value for code, value in group.tags if code == 9]
        after = {group.tags[i][1]: group.tags[i + 1] for i in range(len(group.tags) - 1) if group.tags[i][0] == 9}
        for name in ("$INSUNITS", "$MEASUREMENT", "$LUNITS"):
            code, value = after.get(name.encode(), (0, b""))
            if name.encode() in names:
                self.units[name] = str(int(value)) if code == 70 and value.isdigit() and len(value) < 4 else "0"

    def _close_section(self, kind: str) -> None:
        """The end of a section; where it was never opened the start of the file is missing."""
        self._close_block()
        if kind == "ENDSEC" and not self.opened and not (self.any_section and self.ended):
            self.started = False
        self.opened, self.section, self.ended = False, "", True

    def _layer(self, group: Group) -> None:
        """A layer's name, flags, colour and line type; without numbers that are none."""
        name = clean.text(group.first(2))
        if not name or name.casefold() in self.layers:
            return
        parts = [f"0\nLAYER\n100\nAcDbSymbolTableRecord\n100\nAcDbLayerTableRecord\n2\n{name}\n"]
        for code in (70, 62):
            value = group.first(code)
            if value.lstrip(b"-").isdigit() and len(value) < 6:
                parts.append(f"{code}\n{clean.text(value)}\n")
        parts.append(f"6\n{clean.text(group.first(6)) or 'Continuous'}\n")
        self.layers[name.casefold()] = "".join(parts)

    def _open_block(self, group: Group) -> None:
        self._close_block()
        self.ended = False
        name = clean.text(group.first(2))
        key = name.casefold()
        self.block = _Block(key)
        if not name:
            self.block.problem = "its block has no name"
            return
        if key in self.blocks:
            self.block.problem = f"its block {name} is in the file twice"
            return
        last = dict(group.tags)
        flags = last.get(70, b"0")
        parts = [
            f"0\nBLOCK\n100\nAcDbEntity\n8\n{clean.layer(group)}\n100\nAcDbBlockBegin\n2\n{name}\n",
            f"70\n{int(flags) if flags.isdigit() and len(flags) < 6 else 0}\n",
        ]
        base = ["0", "0", "0"]
        if not group.whole:
            self.block.problem = f"lines at the start of its block {name} are missing or damaged"
        try:
            base = [clean.number(last.get(code, b"0")) for code in (10, 20, 30)]
        except DamagedError as error:
            self.block.problem = f"the start of its block {name} is damaged: {error}"
        parts.append(f"10\n{base[0]}\n20\n{base[1]}\n30\n{base[2]}\n3\n{name}\n")
        self.blocks[key] = ["".join(parts)]

    def _close_block(self) -> None:
        self.block = None

    def _entity(self, group: Group, *, is_last: bool) -> None:
        """Write an entity, or say why not."""
        if is_last and group.kind in DRAWN and group.kind not in _FIXED:
            self._lose(group, "the file ends inside it")
            return
        try:
            parts = self._written(group)
        except DamagedError as error:
            self._refuse_commas(group)
            self._lose(group, str(error))
            return
        if self.parent:
            self.parent.parts += parts
        elif group.kind in _CHILDREN:
            self.parent = _Parent(group, parts)
        elif group.kind == "VERTEX":
            self._lose(group, "a vertex without its polyline")
        else:
            self._keep(group.kind, parts)

    def _written(self, group: Group) -> list[str]:
        """The text of one entity."""
        if self.block and self.block.problem:
            raise DamagedError(self.block.problem)
        if not group.kind.replace("_", "").isalnum() or not group.kind.isascii():
            raise DamagedError("it has no kind")
        if is_object(group.kind):
            raise DamagedError(f"{group.kind} is no kind of entity")
        if group.kind not in DRAWN:
            return [clean.write_bare(group, self.handles) if self.bare else clean.write(group, self.handles)]
        if group.kind in _MARKED and not group.first(100):
            self.repairs[f"{group.kind} without subclass markers"] += 1
        return [clean.write(group, self.handles)]

    def _close_parent(self, parent: _Parent) -> None:
        """Write a POLYLINE or INSERT with all that belongs to it; a polyline that lacks a vertex is lost."""
        self.parent = None
        if parent.problem:
            self._lose(parent.group, parent.problem)
            return
        kind, children = parent.group.kind, len(parent.parts) - 1
        if kind == "POLYLINE" or children:
            parent.parts.append("0\nSEQEND\n100\nAcDbEntity\n8\n0\n")
        self.kept[_CHILDREN[kind]] += children
        self._keep(kind, parent.parts, attributes=bool(children))

    def _keep(self, kind: str, parts: list[str], *, attributes: bool = False) -> None:
        self.kept[kind] += 1
        if kind == "INSERT":
            flag = f"66\n{int(attributes)}\n"
            parts[0] = parts[0].replace("100\nAcDbBlockReference\n", f"100\nAcDbBlockReference\n{flag}", 1)
        place = self.model if self.block is None else self.blocks[self.block.name]
        place += parts

    def _lose(self, group: Group, reason: str) -> None:
        """Note an entity that cannot be read; a vertex takes its polyline with it."""
        if self.parent and group.kind == "VERTEX":
            self.parent.problem = f"a vertex cannot be read: {reason}"
            return
        name = self.block.name if self.block else ""
        kind = group.kind if group.kind.isprintable() and group.kind.isascii() else "?"
        entry = LedgerEntry(clean.handle(group), kind or "?", clean.layer(group), name, Outcome.LOST, reason)
        self.lost.append(entry)

    def _refuse_commas(self, group: Group) -> None:
        """Raises where an entity is damaged because its numbers have decimal commas."""
        for code, value in group.tags:
            if (10 <= code < 60 or 210 <= code <= 230) and clean.COMMA.fullmatch(value):
                what = f"a coordinate is not a number with a decimal point: {clean.text(value)[:24]}"
                where = f"{self.file}, {group.kind} #{clean.handle(group)}"
                raise DrawingError(what, where=where, hint="export the drawing with decimal points")
