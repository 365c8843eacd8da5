"""What names the content of a part, so that nothing is planned twice and nothing old is kept."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any, Final

import deltacam
from deltacam.batch.parts import Part

LAYOUT: Final = 1
"""Counts up when a batch writes other files for the same program, so that parts are planned again."""


_KINDS: Final = (".py", ".toml", ".js", ".css")


def sha256(data: bytes) -> str:
    """The SHA-256 of the bytes, hexadecimal."""
    return hashlib.sha256(data).hexdigest()


def key_of(part: Part, data: bytes) -> str:
    """Names all that the files of a part follow from: a SHA-256, hexadecimal.

    Args:
        part: its name is in the program, and the depth of its folder in the page.
        data: the bytes of the drawing.
    """
    content = {
        "deltacam": _version(),
        "layout": LAYOUT,
        "name": part.name,
        "drawing": sha256(data),
        "options": _plain(part.options),
    }
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return sha256(text.encode())


def source() -> str:
    """A short hash of all files of deltacam: two states of one version, as in a clone, differ in it."""
    package = Path(deltacam.__file__).parent
    total = hashlib.sha256()
    for path in sorted(path for path in package.rglob("*") if path.suffix in _KINDS):
        content = path.read_bytes().replace(b"\r\n", b"\n")  # as git checks them out on Windows
        total.update(f"{path.relative_to(package).as_posix()}\n{len(content)}\n".encode())
        total.update(content)
    return total.hexdigest()[:12]


@cache
def _version() -> str:
    return f"{metadata.version('deltacam')} {source()}"


def _plain(value: Any) -> Any:
    """The value as JSON has it."""
    if is_dataclass(value) and not isinstance(value, type):
        named = {field.name: _plain(getattr(value, field.name)) for field in fields(value)}
        return {"": type(value).__name__, **named}
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, Mapping):
        return {str(key): _plain(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    return value
