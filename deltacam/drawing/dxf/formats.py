"""Files that are not DXF, told by their first bytes."""

from __future__ import annotations

from typing import Final

from deltacam.errors import DrawingError

SENTINEL: Final = b"AutoCAD Binary DXF\r\n\x1a\x00"
"""How a binary DXF file starts."""

_OTHERS: Final = {
    b"%PDF": "a PDF",
    b"%!PS": "a PostScript file",
    b"\xc5\xd0\xd3\xc6": "a PostScript file",
    b"AC10": "a DWG file",
    b"<svg": "an SVG or XML file",
    b"<?xml": "an SVG or XML file",
    b"<!doctype": "a web page",
    b"<html": "a web page",
    b"PK\x03\x04": "a ZIP archive",
    b"\x1f\x8b": "a compressed archive",
    b"7z\xbc\xaf": "a compressed archive",
    b"Rar!": "a compressed archive",
    b"\x89PNG": "a PNG image",
    b"\xff\xd8\xff": "a JPEG image",
    b"GIF8": "a GIF image",
    b"II*\0": "a TIFF image",
    b"MM\0*": "a TIFF image",
    b"\xd0\xcf\x11\xe0": "a CAD or Office document",
    b"ISO-10303-21": "a STEP file",
    b"solid ": "an STL file",
    b"AutoCAD DXB": "a DXB file",
    b"version https://git-lfs": "a Git LFS pointer, not the file itself",
}
_DAMAGED_SENTINEL: Final = SENTINEL[:18]


def refuse_others(data: bytes, file: str) -> None:
    """Raises where the bytes are of another format.

    Raises:
        DrawingError: which format it is, or a binary DXF file whose line ends were converted.
    """
    head = data[:64].removeprefix(b"\xef\xbb\xbf").lstrip()
    for magic, what in _OTHERS.items():
        if head.lower().startswith(magic) or head.startswith(magic):
            raise DrawingError(f"this is {what}, not a DXF file", where=file, hint="export the drawing as DXF")
    if head.startswith(_DAMAGED_SENTINEL) and not data.startswith(SENTINEL):
        what = "a binary DXF file whose first line is damaged (line ends were converted)"
        raise DrawingError(what, where=file, hint="copy it again as binary, or export it as ASCII DXF")
