"""The bytes of a file to an ezdxf document, or one clear sentence that says why not.

Two readers are tried: ezdxf's plain one, then ``ezdxf.recover`` for files with a damaged structure. What recover
reports as changed or lost geometry is an error here: it can read 2,5 as 2.0 and carry on.
"""

from __future__ import annotations

import io
import logging
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from ezdxf import filemanagement, recover
from ezdxf.audit import AuditError, Auditor
from ezdxf.document import Drawing as Document
from ezdxf.lldxf.tagger import binary_tags_loader

from deltacam.errors import DeltacamError, DrawingError

MAX_BYTES: Final = 256 * 2**20
"""Larger files are refused before they are read."""

_SENTINEL: Final = b"AutoCAD Binary DXF\r\n\x1a\x00"
_OTHER_FORMATS: Final = {
    b"%PDF": "a PDF",
    b"%!PS": "a PostScript file",
    b"AC10": "a DWG file",
    b"<svg": "an SVG or XML file",
    b"<?xml": "an SVG or XML file",
    b"<!DOCTYPE": "a web page",
    b"<html": "a web page",
    b"PK\x03\x04": "a ZIP archive",
    b"\x89PNG": "a PNG image",
    b"\xff\xd8\xff": "a JPEG image",
    b"version https://git-lfs": "a Git LFS pointer, not the file itself",
}
_GEOMETRY_LOST: Final = {
    int(AuditError.REMOVED_INVALID_GRAPHIC_ENTITY): "an entity would have to be left out",
    int(AuditError.UNDEFINED_BLOCK): "a block that is inserted is not in the file",
    int(AuditError.INVALID_FLOATING_POINT_VALUE): "a coordinate is not a number with a decimal point",
}
_SAVE_AGAIN: Final = "open it in a CAD program and save it again as DXF (ASCII, R2000 or newer)"

# ezdxf reports through logging; without a handler Python would print its warnings on the terminal.
logging.getLogger("ezdxf").addHandler(logging.NullHandler())


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


def load(data: bytes, file: str) -> Document:
    """The document in the bytes.

    Args:
        data: the whole file.
        file: its name, for messages.

    Raises:
        DrawingError: no DXF, damaged, cut off, or readable only with a loss of geometry.
    """
    data = data.removeprefix(b"\xef\xbb\xbf")
    head = data[:64].lstrip()
    for magic, what in _OTHER_FORMATS.items():
        if head.startswith(magic):
            raise DrawingError(f"this is {what}, not a DXF file", where=file, hint="export the drawing as DXF")
    if head.startswith(_SENTINEL[:18]) and not data.startswith(_SENTINEL):
        what = "a binary DXF file whose first line is damaged (line ends were converted)"
        raise DrawingError(what, where=file, hint="copy it again as binary, or export it as ASCII DXF")
    try:
        return _read_plain(data)
    except Exception as error:  # noqa: BLE001  # ezdxf raises whatever a damaged file makes it stumble over
        return _recover(data, file, error)


@contextmanager
def translated(where: str, kind: type[Exception] = Exception) -> Iterator[None]:
    """Turns the exceptions of a kind, by default whatever ezdxf raises, into a DrawingError at ``where``."""
    try:
        yield
    except (DeltacamError, MemoryError):
        raise
    except kind as error:
        raise DrawingError(f"the entity is damaged: {_one_line(error)}", where=where, hint=_SAVE_AGAIN) from error


def _read_plain(data: bytes) -> Document:
    """What ``ezdxf.readfile`` does, on bytes."""
    if data.startswith(_SENTINEL):
        return Document.load(binary_tags_loader(data, errors="surrogateescape"))
    info = filemanagement.dxf_stream_info(io.TextIOWrapper(io.BytesIO(data), encoding="utf-8", errors="ignore"))
    return filemanagement.read(io.TextIOWrapper(io.BytesIO(data), encoding=info.encoding, errors="surrogateescape"))


def _recover(data: bytes, file: str, reason: Exception) -> Document:
    """What ``ezdxf.recover`` makes of a file that the plain reader refused for ``reason``."""
    if data.startswith(_SENTINEL):
        what = f"a binary DXF file that is damaged or cut off: {_one_line(reason)}"
        raise DrawingError(what, where=file, hint="copy it again as binary, or export it as ASCII DXF") from reason
    if b"SECTION" not in data:
        raise DrawingError("this is not a DXF file", where=file, hint="export the drawing as DXF") from reason
    entities = data.rfind(b"ENTITIES")
    if not data.rstrip().endswith(b"EOF") and data.find(b"ENDSEC", max(entities, 0)) < 0:
        what = "the file is cut off before the end of its entities"
        raise DrawingError(what, where=file, hint="copy or export it again") from reason
    try:
        document, auditor = recover.read(io.BytesIO(data))
    except Exception as error:
        raise DrawingError(f"the file is damaged: {_one_line(error)}", where=file, hint=_SAVE_AGAIN) from error
    _refuse_losses(auditor, file)
    if not len(document.modelspace()):
        raise DrawingError(f"the file is damaged: {_one_line(reason)}", where=file, hint=_SAVE_AGAIN) from reason
    return document


def _refuse_losses(auditor: Auditor, file: str) -> None:
    """Raises where recovery changed or dropped geometry; names and handles do not matter."""
    for entry in (*auditor.errors, *auditor.fixes):
        if int(entry.code) in _GEOMETRY_LOST:
            what = f"the file is damaged: {_GEOMETRY_LOST[int(entry.code)]}"
            raise DrawingError(f"{what} ({_one_line(entry.message)})", where=file, hint=_SAVE_AGAIN)


def _one_line(error: object) -> str:
    """The first line of a foreign message, without its own prefix and full stop."""
    text = next(iter(str(error).splitlines()), "") or type(error).__name__
    return text.removeprefix("DXFStructureError: ").rstrip(". ")[:160]
