"""The bytes of a file to an ezdxf document, with what was lost on the way, or one clear sentence that says why not.

Three readers are tried: ezdxf's plain one, ``ezdxf.recover`` for files with a damaged structure, and our own tolerant
one. A reader's document is taken only if it holds every entity of the file unchanged; the tolerant reader, the last,
says itself what it could not read. ezdxf's recovery can read 2,5 as 2.0 and carry on, and it removes entities.
"""

from __future__ import annotations

import io
import logging
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from ezdxf import filemanagement, recover
from ezdxf.document import Drawing as Document
from ezdxf.lldxf.tagger import binary_tags_loader
from ezdxf.tools.codepage import toencoding

from deltacam.drawing.dxf import census, formats, tags
from deltacam.drawing.dxf.repair import Repaired, repair
from deltacam.drawing.dxf.tags import Groups
from deltacam.errors import DrawingError
from deltacam.model import Finding, LedgerEntry

MAX_BYTES: Final = 256 * 2**20
"""Larger files are refused before they are read."""

MAX_GROUPS: Final = 3_000_000
"""Files with more entities, layers, vertices and so on are refused before ezdxf makes an object of each."""

_GROUP_BYTES, _LINES_OF_GROUP, _LINE_BYTES = 1000, 10, 150
"""What an object of ezdxf takes in memory, about; with so many lines of the file, and then for each further line."""

_MEMORY_FACTOR, _MEMORY_FIXED = 30, 512 * 2**20
"""Files that would need more bytes than this times their size, and this, are refused."""

_MAX_RECOVERED: Final = 400_000
"""Damaged files with more lines go to the tolerant reader at once: ezdxf's recovery is slow, partly quadratic."""

_REORDERED: Final = frozenset(("LINE",))
"""Kinds whose coordinates ezdxf's recovery puts in order."""

_HARMLESS: Final = frozenset({1, 2, 3, 4, 7, 9, 10, 12, 14, 118, 202, 213, 223}).union(
    range(100, 103), range(105, 108), range(110, 115), range(204, 208)
)
"""What ezdxf's audit may mend without a change of what is drawn: names, owners, colours, dictionaries, ...

Not among them: 117, a coordinate that is no number; 11 and 103, an entity that is removed; 116, a whole number that is
none. That no entity was removed is seen by counting.
"""

_SAVE_AGAIN: Final = "open it in a CAD program and save it again as DXF (ASCII, R2000 or newer)"
_EXPORT_AGAIN: Final = "copy or export the drawing again"
_INCOMPLETE: Final = "entities lie outside of the sections for entities, are doubled or lack coordinates"
_MOST_REASONS: Final = 20

# ezdxf reports through logging; without a handler Python would print its warnings on the terminal.
logging.getLogger("ezdxf").addHandler(logging.NullHandler())


@dataclass(frozen=True, slots=True, eq=False)
class Loaded:
    """What was read from a file.

    Attributes:
        document: of ezdxf.
        reader: plain, recover or tolerant.
        lost: the entities that could not be read.
        findings: what a person should know; those about lost entities block.
    """

    document: Document
    reader: str
    lost: tuple[LedgerEntry, ...] = ()
    findings: tuple[Finding, ...] = ()


def read_bytes(path: Path) -> bytes:
    """The bytes of the file.

    Raises:
        DrawingError: it cannot be read, is a folder, is empty or is larger than ``MAX_BYTES``.
    """
    where = path.name
    try:
        if path.is_dir():
            raise DrawingError("this is a folder, not a drawing", where=where, hint="name one DXF file")
        size = path.stat().st_size
        if size > MAX_BYTES:
            limit = f"{size / 2**20:.0f} MB is more than the limit of {MAX_BYTES // 2**20} MB"
            raise DrawingError(f"the file is too large: {limit}", where=where, hint="save only what is to be cut")
        data = path.read_bytes()
    except FileNotFoundError:
        raise DrawingError("there is no such file", where=str(path), hint="check the name and the folder") from None
    except PermissionError:
        raise DrawingError("no permission to read the file", where=where, hint=f"chmod u+r {path.name}") from None
    except (OSError, ValueError) as error:
        raise DrawingError(f"the file cannot be read: {error}", where=where) from error
    if not data.strip():
        raise DrawingError("the file is empty", where=where, hint="export the drawing again")
    return data


def load(data: bytes, file: str) -> Loaded:
    """The document in the bytes.

    Args:
        data: the whole file.
        file: its name, for messages.

    Raises:
        DrawingError: no DXF, absurdly large, damaged beyond use, or written with decimal commas.
    """
    formats.refuse_others(data, file)
    if data.startswith(formats.SENTINEL):
        return _load_binary(data, file)
    groups = tags.split(data)
    _refuse_absurd(groups, len(data), file)
    reason = _INCOMPLETE
    try:
        document = _read_plain(data.removeprefix(b"\xef\xbb\xbf"))
        if census.is_ordered(groups) and census.is_complete(document, groups):
            return Loaded(document, "plain", findings=_miscounted(groups))
        del document
    except Exception as error:  # noqa: BLE001  # ezdxf raises whatever a damaged file makes it stumble over
        reason = _one_line(error)  # the error itself would keep all that was read so far in memory
    return _recover(groups, reason) or _tolerate(tags.split(_in_utf8(data)), file, reason)


def _load_binary(data: bytes, file: str) -> Loaded:
    """A binary file; whatever of it is incomplete goes to the tolerant reader as text."""
    try:
        groups = tags.split(tags.from_binary(binary_tags_loader(data, errors="surrogateescape")))
        _refuse_absurd(groups, len(data), file)
        document = Document.load(binary_tags_loader(data, errors="surrogateescape"))
    except DrawingError:
        raise
    except Exception as error:
        what = f"a binary DXF file that is damaged or cut off: {_one_line(error)}"
        raise DrawingError(what, where=file, hint="copy it again as binary, or export it as ASCII DXF") from error
    if census.is_ordered(groups) and census.is_complete(document, groups):
        return Loaded(document, "plain", findings=_miscounted(groups))
    return _tolerate(groups, file, _INCOMPLETE)


def _refuse_absurd(groups: Groups, size: int, file: str) -> None:
    """Raises where there is nothing of a DXF file, or so much of it that ezdxf would take absurdly much memory."""
    known = census.DRAWN | {"SECTION"}
    if known.isdisjoint(kind.upper() for kind in set(groups.kinds)):
        raise DrawingError("this is not a DXF file", where=file, hint="export the drawing as DXF")
    count = len(groups)
    if count > MAX_GROUPS:
        what = f"the file is too large: {count} entities and other objects are more than {MAX_GROUPS}"
        raise DrawingError(what, where=file, hint="save only what is to be cut")
    further = max(len(groups.starts) - _LINES_OF_GROUP * count, 0)
    if count * _GROUP_BYTES + further * _LINE_BYTES > _MEMORY_FACTOR * size + _MEMORY_FIXED:
        lines = len(groups.starts)
        what = f"this is no drawing: {count} objects in {lines} lines in {size / 2**20:.3g} MB, nearly without content"
        raise DrawingError(what, where=file, hint=_EXPORT_AGAIN)


def _read_plain(data: bytes) -> Document:
    """What ``ezdxf.readfile`` does, on bytes."""
    info = filemanagement.dxf_stream_info(io.TextIOWrapper(io.BytesIO(data), encoding="utf-8", errors="ignore"))
    return filemanagement.read(io.TextIOWrapper(io.BytesIO(data), encoding=info.encoding, errors="surrogateescape"))


def _recover(groups: Groups, reason: str) -> Loaded | None:
    """What ``ezdxf.recover`` makes of a file, if that is all of it and unchanged."""
    if len(groups.starts) > _MAX_RECOVERED or not census.is_ordered(groups, _REORDERED):
        return None
    try:
        document, auditor = recover.read(io.BytesIO(groups.text))
    except Exception:  # noqa: BLE001  # the tolerant reader says what is wrong
        return None
    mended = {int(entry.code) for entry in (*auditor.errors, *auditor.fixes)}
    if not (mended <= _HARMLESS and len(document.modelspace()) and census.is_complete(document, groups)):
        return None
    return Loaded(document, "recover", findings=(_recovered(reason), *_miscounted(groups)))


def _tolerate(groups: Groups, file: str, reason: str) -> Loaded:
    """What our own reader makes of a file."""
    for bare in (False, True):
        repaired = repair(groups, file, bare=bare)
        _refuse_empty(repaired, groups, file, reason)
        text = repaired.text.encode("utf-8", "surrogateescape")
        try:
            # A StringIO would take four bytes for each character.
            stream = io.TextIOWrapper(io.BytesIO(text), encoding="utf-8", errors="surrogateescape")
            document = filemanagement.read(stream)
        except Exception as error:
            if bare:
                raise DrawingError(f"the file is damaged: {_one_line(error)}", where=file, hint=_SAVE_AGAIN) from error
            continue
        break
    if not census.is_complete(document, tags.split(text)):
        raise DrawingError(f"the file is damaged: {reason}", where=file, hint=_SAVE_AGAIN)
    how = ", ".join(repaired.repairs) or reason
    return Loaded(document, "tolerant", repaired.lost, (*_lost(repaired), _recovered(how), *_miscounted(groups)))


def _refuse_empty(repaired: Repaired, groups: Groups, file: str, reason: str) -> None:
    """Raises where nothing that can be cut is left of a damaged file."""
    if census.DRAWN.intersection(kind for kind, count in repaired.kept.items() if count):
        return
    if "EOF" not in groups.kinds and (repaired.cut_off or not repaired.lost):
        raise DrawingError(
            "the file is cut off before the end of its entities: none is left", where=file, hint=_EXPORT_AGAIN
        )
    if not repaired.lost and census.DRAWN.isdisjoint(groups.kinds):
        raise DrawingError("nothing to cut: the file holds no line", where=file, hint=_EXPORT_AGAIN)
    what = f"the file is damaged: {reason}"
    if repaired.lost:
        what = f"the file is damaged: none of its {len(repaired.lost)} entities can be read: {repaired.lost[0].reason}"
    raise DrawingError(what, where=file, hint=_SAVE_AGAIN)


def _lost(repaired: Repaired) -> Iterator[Finding]:
    """What is not in the document, counted by kind and reason."""
    if repaired.cut_off:
        what = f"the file is cut off before the {repaired.cut_off} of its entities: nobody knows how many are missing"
        yield Finding(what, hint=_EXPORT_AGAIN, kind="lost", blocks=True)
    counts = Counter((entry.kind, entry.reason) for entry in repaired.lost).most_common()
    for (kind, reason), count in counts[:_MOST_REASONS]:
        what = f"{count} {kind} could not be read: {reason}"
        yield Finding(what, hint=_SAVE_AGAIN, kind="lost", blocks=True)
    more = sum(count for _, count in counts[_MOST_REASONS:])
    if more:
        what = f"{more} more entities could not be read"
        yield Finding(what, hint=_SAVE_AGAIN, kind="lost", blocks=True)


def _miscounted(groups: Groups) -> tuple[Finding, ...]:
    """The finding about polylines that announce more or fewer vertices than they have."""
    count = census.miscounted(groups)
    if not count:
        return ()
    what = f"{count} LWPOLYLINE with another number of vertices than announced (group code 90): some may be missing"
    return (Finding(what, hint=_SAVE_AGAIN, kind="lost", blocks=True),)


def _recovered(how: str) -> Finding:
    """The finding about a file that had to be repaired."""
    return Finding(
        f"the file does not follow the DXF format and was repaired: {how}", hint=_SAVE_AGAIN, kind="recovered"
    )


def _in_utf8(data: bytes) -> bytes:
    """The bytes as UTF-8; from the code page that the file states where they are none."""
    try:
        data.decode()
    except UnicodeDecodeError:
        if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
            return data
        page = re.search(rb"\$DWGCODEPAGE\s+3\s+(\w+)", data)
        encoding = toencoding(page[1].decode("ascii")) if page else "cp1252"
        return data.decode(encoding, "surrogateescape").encode("utf-8", "surrogateescape")
    return data


def _one_line(error: object) -> str:
    """The first line of a foreign message, without its own prefix and full stop."""
    text = next(iter(str(error).splitlines()), "")
    if text in ("", "None"):
        text = "its structure is broken"
    text = text.removeprefix("DXFStructureError: ").rstrip(". ")[:160]
    return "".join(character if character.isprintable() else "?" for character in text)
