"""Damage to the bytes of the file, and to what it says about its rows."""

import hashlib
import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from deltacam.program.program import Program
from tests.damage.example import Example

FIRST_ROW = 3  # its line, from 0
DIGITS = b"0123456789"


def end_cut_off(case: Example, amount: float, _: np.random.Generator) -> bytes:
    """So many bytes missing at the end, at most half of the file."""
    return case.content[: -min(int(amount), len(case.content) // 2)]


def last_rows_lost(case: Example, amount: float, _: np.random.Generator) -> bytes:
    lines = case.content.splitlines(keepends=True)
    return b"".join(lines[: -_few(case, amount)])


def rows_lost(case: Example, amount: float, chance: np.random.Generator) -> bytes:
    lines = case.content.splitlines(keepends=True)
    first = _line(case, amount, chance)
    return b"".join(lines[:first] + lines[first + _few(case, amount) :])


def rows_doubled(case: Example, amount: float, chance: np.random.Generator) -> bytes:
    lines = case.content.splitlines(keepends=True)
    end = _line(case, amount, chance) + _few(case, amount)
    return b"".join(lines[:end] + lines[end - _few(case, amount) :])


def rows_swapped(case: Example, amount: float, chance: np.random.Generator) -> bytes:
    """Two rows as far from each other as the size says."""
    lines = case.content.splitlines(keepends=True)
    one = _line(case, amount, chance)
    other = one + _few(case, amount)
    lines[one], lines[other] = lines[other], lines[one]
    return b"".join(lines)


def digits_changed(case: Example, amount: float, chance: np.random.Generator) -> bytes:
    """So many digits of the rows."""
    content = bytearray(case.content)
    start = case.content.index(b"\n", case.content.index(b"tick,")) + 1
    places = start + np.flatnonzero(np.isin(np.frombuffer(case.content[start:], np.uint8), np.frombuffer(DIGITS, "u1")))
    for place in chance.choice(places, int(amount), replace=False).tolist():
        content[place] = DIGITS[(content[place] - DIGITS[0] + int(chance.integers(1, 10))) % 10]
    return bytes(content)


def not_a_number(case: Example, amount: float, chance: np.random.Generator) -> bytes:
    """A cell in each of so many rows."""
    lines = case.content.splitlines(keepends=True)
    for line in chance.choice(np.arange(FIRST_ROW, len(lines)), _few(case, amount), replace=False).tolist():
        cells = lines[line].rstrip(b"\n").split(b",")
        cells[int(chance.integers(6))] = [b"nan", b"inf", b"", b"0x1", b"1_0"][int(chance.integers(5))]
        lines[line] = b",".join(cells) + b"\n"
    return b"".join(lines)


def other_line_ends(case: Example, amount: float, chance: np.random.Generator) -> bytes:
    lines = case.content.splitlines(keepends=True)
    for line in chance.choice(np.arange(len(lines)), _few(case, amount), replace=False).tolist():
        lines[line] = lines[line].replace(b"\n", b"\r\n")
    return b"".join(lines)


def renumbered(case: Example, amount: float, chance: np.random.Generator) -> bytes:
    """Rows lost, ticks counted anew, number of rows and hash repaired; but the table of blocks is the old one."""
    lines = rows_lost(case, amount, chance).splitlines(keepends=True)
    rows = [b"%d,%b" % (tick, line.split(b",", 1)[1]) for tick, line in enumerate(lines[FIRST_ROW:])]

    def repair(meta: dict[str, Any]) -> None:
        meta["rows"] = len(rows)
        meta["sha256"] = hashlib.sha256(b"".join([lines[2], *rows])).hexdigest()

    return _with_meta(b"".join([*lines[:FIRST_ROW], *rows]), repair)


def in_meta(change: Callable[[dict[str, Any], float], None]) -> Callable[[Example, float, np.random.Generator], bytes]:
    """The damage that changes the meta object, and nothing else, by an amount."""

    def make(case: Example, amount: float, _: np.random.Generator) -> bytes:
        return _with_meta(case.content, lambda meta: change(meta, amount))

    return make


def other_hash(meta: dict[str, Any], amount: float) -> None:
    """So many of its digits."""
    digits = meta["sha256"]
    changed = "".join(f"{15 - int(digit, 16):x}" for digit in digits[: int(amount)])
    meta["sha256"] = changed + digits[int(amount) :]


def other_count(meta: dict[str, Any], amount: float) -> None:
    meta["rows"] += int(amount)


def other_rate(meta: dict[str, Any], amount: float) -> None:
    meta["rate_hz"] *= 1.0 + amount


def other_arm(meta: dict[str, Any], amount: float) -> None:
    """A robot whose fingerprint is that of the old one."""
    meta["robot"]["geometry"]["upper_arm"] += amount


def key_lost(meta: dict[str, Any], amount: float) -> None:
    for key in sorted(meta["process"])[: int(amount)]:
        del meta["process"][key]


def key_added(meta: dict[str, Any], amount: float) -> None:
    meta |= {f"remark{index}": "" for index in range(int(amount))}


def blocks_overlap(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """A block that is said to start some ticks earlier than it does."""
    blocks = list(case.program.blocks)
    index = int(chance.integers(1, len(blocks)))
    blocks[index] = replace(blocks[index], first=blocks[index].first - int(amount))
    return replace(case.program, blocks=tuple(blocks))


def blocks_end_early(case: Example, amount: float, _: np.random.Generator) -> Program:
    """The last blocks missing in the table, not in the column; at least one is left."""
    return replace(case.program, blocks=case.program.blocks[: -min(int(amount), len(case.program.blocks) - 1)])


def block_unknown(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """So many rows in a block that is not in the table."""
    column = case.program.block.copy()
    column[chance.choice(len(column), _few(case, amount), replace=False)] = chance.choice(
        [-1, len(case.program.blocks)]
    )
    return replace(case.program, block=column)


def _few(case: Example, amount: float) -> int:
    """A number of rows, at most a quarter of all."""
    return min(int(amount), len(case.program.q) // 4)


def _line(case: Example, amount: float, chance: np.random.Generator) -> int:
    """A line with a row that has at least as many rows as the amount says after it."""
    return FIRST_ROW + int(chance.integers(len(case.program.q) - _few(case, amount) - 1))


def _with_meta(content: bytes, change: Callable[[dict[str, Any]], None]) -> bytes:
    first, second, rest = content.split(b"\n", 2)
    meta = json.loads(second.removeprefix(b"# "))
    change(meta)
    return b"\n".join([first, b"# " + json.dumps(meta).encode(), rest])
