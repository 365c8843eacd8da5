"""Damaged DXF files: real ones with a few random faults, the same for the same seed, and what reading them comes to."""

import random
import re
import resource
import signal
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

from deltacam.drawing.reader import read_drawing
from deltacam.errors import DeltacamError

FILES = sorted((Path(__file__).parent / "data" / "dxf").glob("*.dxf"))
TIME_LIMIT = 10  # s for one file
MEMORY_LIMIT = 2**30  # bytes for the whole process

NUMBERS = b"nan inf -inf 1e308 -1e308 1e400 1e-320 0 -0 -1 1,5 1.5.2 1e5 99999999999 65536 1.#QNAN 0x10 1_0".split()
CODES = b"0 1 2 5 8 10 11 20 21 30 40 41 42 50 51 62 66 67 70 71 72 73 74 90 91 100 102 210".split()
CODES += b"230 330 999 1001 1071 9999 -1".split()
KINDS = (
    b"LINE ARC CIRCLE ELLIPSE SPLINE LWPOLYLINE POLYLINE VERTEX SEQEND INSERT BLOCK ENDBLK SECTION ENDSEC TEXT".split()
)
KINDS += b"HATCH EOF TABLE ENDTAB LAYER DIMENSION ATTRIB FOO".split()
NUMBER = re.compile(rb"\s*[-+]?\d+(\.\d*)?(e[-+]?\d+)?\s*", re.IGNORECASE)


def mutant(seed: int) -> tuple[str, bytes]:
    """The name of a real file, and its bytes with one to six faults."""
    chance = random.Random(seed)  # noqa: S311  # nothing here is secret
    path = chance.choice(FILES)
    data = path.read_bytes()
    for _ in range(chance.choice((1, 1, 1, 2, 3, 6))):
        data = chance.choice(FAULTS)(data, chance)
    return path.name, data


def _flip(data: bytes, chance: random.Random) -> bytes:
    """One to eight bytes changed."""
    changed = bytearray(data)
    for _ in range(chance.randint(1, 8)):
        if changed:
            changed[chance.randrange(len(changed))] ^= 1 << chance.randrange(8)
    return bytes(changed)


def _cut(data: bytes, chance: random.Random) -> bytes:
    """The end, the start or a piece missing."""
    first, last = sorted(chance.randrange(len(data) + 1) for _ in range(2))
    return chance.choice((data[:first], data[first:], data[:first] + data[last:]))


def _with_lines(change: Callable[[list[bytes], random.Random], None]) -> Callable[[bytes, random.Random], bytes]:
    """A fault in the lines of a file."""

    def fault(data: bytes, chance: random.Random) -> bytes:
        end = b"\r\n" if b"\r\n" in data else b"\n"
        lines = data.split(end)
        change(lines, chance)
        return end.join(lines)

    return fault


def _pair(lines: list[bytes], chance: random.Random) -> int:
    """Where a tag starts, if the lines are still in pairs."""
    return 2 * chance.randrange(max(len(lines) // 2, 1))


def _drop_tags(lines: list[bytes], chance: random.Random) -> None:
    for _ in range(chance.randint(1, 4)):
        at = _pair(lines, chance)
        del lines[at : at + 2]


def _double_tags(lines: list[bytes], chance: random.Random) -> None:
    at = _pair(lines, chance)
    lines[at:at] = lines[at : at + 2 * chance.choice((1, 1, 5, 50))]


def _swap_tags(lines: list[bytes], chance: random.Random) -> None:
    for _ in range(chance.randint(1, 4)):
        one = _pair(lines, chance)
        other = chance.choice((one + 2, _pair(lines, chance)))
        lines[one : one + 2], lines[other : other + 2] = lines[other : other + 2], lines[one : one + 2]


def _drop_line(lines: list[bytes], chance: random.Random) -> None:
    del lines[chance.randrange(len(lines))]


def _blank_line(lines: list[bytes], chance: random.Random) -> None:
    lines.insert(chance.randrange(len(lines) + 1), chance.choice((b"", b"  ", b"0", b"foo")))


def _damage_numbers(lines: list[bytes], chance: random.Random) -> None:
    numbers = [i for i in range(1, len(lines), 2) if NUMBER.fullmatch(lines[i])]
    for _ in range(chance.randint(1, 5)):
        if numbers:
            lines[chance.choice(numbers)] = chance.choice(NUMBERS)


def _damage_counts(lines: list[bytes], chance: random.Random) -> None:
    counts = [i + 1 for i in range(0, len(lines) - 1, 2) if lines[i].strip() in b"70 71 72 73 74 90 91 92 93".split()]
    if counts:
        lines[chance.choice(counts)] = chance.choice(b"0 -1 3 100000 2147483647 99999999999999 1.5 x".split())


def _damage_code(lines: list[bytes], chance: random.Random) -> None:
    lines[min(_pair(lines, chance), len(lines) - 1)] = chance.choice(CODES)


def _damage_kind(lines: list[bytes], chance: random.Random) -> None:
    kinds = [i + 1 for i in range(0, len(lines) - 1, 2) if lines[i].strip() == b"0"]
    if kinds:
        lines[chance.choice(kinds)] = chance.choice(KINDS)


def _decimal_commas(lines: list[bytes], chance: random.Random) -> None:
    for i in range(1, len(lines), 2):
        if NUMBER.fullmatch(lines[i]):
            lines[i] = lines[i].replace(b".", b",")


def _line_ends(data: bytes, chance: random.Random) -> bytes:
    data = data.replace(b"\r\n", b"\n")
    return data.replace(b"\n", chance.choice((b"\r", b"\r\n", b"\r\r\n", b"\n\n", b"\n\r")))


FAULTS: tuple[Callable[[bytes, random.Random], bytes], ...] = (
    *(_flip, _flip, _cut, _line_ends),
    *(
        _with_lines(change)
        for change in (
            *(_drop_tags, _drop_tags, _double_tags, _swap_tags, _drop_line, _blank_line),
            *(_damage_numbers, _damage_numbers, _damage_numbers, _damage_counts, _damage_code, _damage_kind),
            _decimal_commas,
        )
    ),
)


@dataclass(frozen=True)
class Trial:
    """What reading a mutant came to.

    Attributes:
        seed: of the mutant.
        file: that it was made from.
        outcome: read, looked at (read, but not to be planned), refused or failed.
        what: the message of a refusal or failure.
        seconds: that it took.
        memory: peak of the whole process so far, bytes.
    """

    seed: int
    file: str
    outcome: str
    what: str
    seconds: float
    memory: int


def read(path: Path) -> bool:
    """Whether a file may be planned; it is read as far as that goes."""
    return not any(finding.blocks for finding in read_drawing(path, unit="mm", strict=False).findings)


def attempt(seed: int, folder: Path) -> Trial:
    """Read one mutant, for at most ``TIME_LIMIT`` s."""
    file, data = mutant(seed)
    path = folder / "mutant.dxf"
    path.write_bytes(data)
    before = signal.signal(signal.SIGALRM, _stop)
    signal.alarm(TIME_LIMIT)
    known = _peak()
    started = time.perf_counter()
    try:
        outcome, what = ("read" if read(path) else "looked at"), ""
    except DeltacamError as error:
        outcome, what = "refused", error.what
    except (Exception, _TooLong) as error:  # noqa: BLE001  # whatever else comes out is what is looked for
        outcome, what = "failed", f"{type(error).__name__}: {error}"
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
    seconds = time.perf_counter() - started
    memory = _peak()
    if outcome == "refused" and ("\n" in what or not what):
        outcome = "failed"
    if seconds >= TIME_LIMIT or memory > max(known, MEMORY_LIMIT):
        outcome, what = "failed", f"{seconds:.1f} s, {memory / 2**20:.0f} MB"
    return Trial(seed, file, outcome, what, seconds, memory)


def _peak() -> int:
    """The most memory that the process ever held, bytes."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def _stop(_signal: int, _frame: FrameType | None) -> None:
    # No Exception, so that nothing that catches those goes on.
    raise _TooLong(f"more than {TIME_LIMIT} s")


class _TooLong(BaseException):
    """The time is up."""
