"""The program file: what is written comes back, and what is damaged is refused or reported, never believed."""

import hashlib
import io
import json
from collections.abc import Callable
from dataclasses import asdict, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.errors import ProgramError
from deltacam.model import Block, BlockKind
from deltacam.program import contents, csv
from deltacam.program.program import Program

NASTY = st.text(alphabet=st.characters(codec=None, categories=None), min_size=1, max_size=20)


def written(program: Program) -> bytes:
    stream = io.BytesIO()
    csv.write(program, stream)
    return stream.getvalue()


def read(content: bytes) -> Program:
    return csv.read(io.BytesIO(content), name="plate.program.csv")


def refused(content: bytes) -> ProgramError:
    with pytest.raises(ProgramError) as caught:
        read(content)
    assert caught.value.where.startswith("plate.program.csv")
    return caught.value


def with_meta(content: bytes, change: Callable[[dict], None]) -> bytes:
    magic, meta, rest = content.split(b"\n", 2)
    values = json.loads(meta[2:])
    change(values)
    return b"\n".join([magic, b"# " + json.dumps(values).encode(), rest])


@settings(deadline=None)
@given(layer=NASTY, handle=NASTY)
def test_any_name_survives_and_stays_on_its_line(program: Program, layer: str, handle: str) -> None:
    block = Block(BlockKind.CUT, 0, 5, 1, layer, (handle,))
    renamed = replace(program, blocks=(block, *program.blocks[1:]))
    content = written(renamed)
    assert content.count(b"\n") == 3 + len(program.q)
    assert read(content).blocks[0] == block


def test_the_file_looks_as_documented(program: Program) -> None:
    lines = written(program).decode("ascii").split("\n")
    assert lines[0] == "# deltacam-program 1"
    meta = json.loads(lines[1].removeprefix("# "))
    assert lines[1] == "# " + json.dumps(meta, sort_keys=True, separators=(",", ":"))
    assert lines[2] == "tick,q1_rad,q2_rad,q3_rad,power,block"
    assert lines[3].endswith(",0,0")
    assert lines[5].startswith("2,0.3823529")
    assert lines[5].endswith(",1,1")
    assert lines[6].endswith(",0.85,2")
    assert lines[-1] == ""
    assert len(lines) == 3 + 6 + 1
    assert meta["rows"] == 6
    assert meta["process"] == json.loads(json.dumps(asdict(program.process)))
    assert meta["sha256"] == hashlib.sha256("\n".join(lines[2:]).encode()).hexdigest()


def test_zero_has_no_sign(with_rows: Callable[..., Program]) -> None:
    tiny = np.array([[-0.0, -5e-13, 5e-13], [-1e-300, -4e-13, -5.1e-13]])
    rows = written(with_rows(tiny)).split(b"\n")[3:5]
    assert rows[0] == b"0,0.000000000000,0.000000000000,0.000000000000,0,0"
    assert rows[1] == b"1,0.000000000000,0.000000000000,-0.000000000001,0,0"


def test_the_stream_may_already_hold_something(program: Program) -> None:
    stream = io.BytesIO()
    stream.write(b"before")
    csv.write(program, stream)
    assert stream.getvalue() == b"before" + written(program)
    assert stream.tell() == len(stream.getvalue())


def body_edit(old: bytes, new: bytes) -> Callable[[bytes], bytes]:
    def edit(content: bytes) -> bytes:
        magic, meta, rest = content.split(b"\n", 2)
        assert old in rest
        return b"\n".join([magic, meta, rest.replace(old, new, 1)])

    return edit


DAMAGES: dict[str, tuple[Callable[[bytes], bytes], str]] = {
    "a digit changed": (body_edit(b"0.1000", b"0.1001"), "SHA-256"),
    "a row lost": (body_edit(b"\n2,", b"\n3,"), "expected tick 2, found 3 in line 6; 1 of 6"),
    "the last line cut off after a digit": (lambda c: c[:-1], "the last line has no end"),
    "the last row lost": (lambda c: c[: c.rstrip(b"\n").rindex(b"\n") + 1], "states 6 rows, the file has 5"),
    "ticks from 1": (body_edit(b"\n0,", b"\n1,"), "expected tick 0, found 1"),
    "a row appended": (lambda c: c + b"6,0,0,0,0,3\n", "states 6 rows, the file has 7"),
    "line ends of another system": (lambda c: c.replace(b"\n", b"\r\n"), "line 1 does not end"),
    "the header line with a carriage return": (body_edit(b"block\n", b"block\r\n"), "line 3 does not end"),
    "another hash": (lambda c: with_meta(c, lambda m: m.update(sha256="0" * 64)), "SHA-256"),
    "other rows in the meta": (lambda c: with_meta(c, lambda m: m.update(rows=7)), "states 7 rows"),
    "another rate": (lambda c: with_meta(c, lambda m: m.update(rate_hz=500)), "rate_hz is 500"),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_damage_that_can_be_read_is_reported(program: Program, damage: str) -> None:
    edit, message = DAMAGES[damage]
    found = read(edit(written(program)))
    assert any(message in problem for problem in found.integrity), found.integrity


REFUSED: dict[str, tuple[Callable[[bytes], bytes], str, str]] = {
    "empty": (lambda _: b"", "line 1", "not a deltacam program"),
    "something else": (lambda c: b"PK\x03\x04" + c, "line 1", "not a deltacam program"),
    "byte order mark": (lambda c: b"\xef\xbb\xbf" + c, "line 1", "not a deltacam program"),
    "version 2": (lambda c: c.replace(b"program 1\n", b"program 2\n"), "line 1", "format version '2' is not 1"),
    "no meta": (lambda c: c[:21], "line 2", "does not end"),
    "meta cut off": (lambda c: c[:200], "line 2", "does not end"),
    "meta not a comment": (lambda c: c.replace(b"# {", b"{"), "line 2", "expected '# {'"),
    "meta not UTF-8": (lambda c: c.replace(b"plate", b"pl\xffte"), "line 2", "UTF-8"),
    "meta not JSON": (lambda c: c.replace(b"# {", b"# {{"), "line 2", "not JSON"),
    "meta a list": (lambda _: b"# deltacam-program 1\n# []\n", "line 2", "expected an object, got list"),
    "meta a bomb": (lambda _: b"# deltacam-program 1\n# " + b"[" * 200_000 + b"\n", "line 2", "nested too deeply"),
    "meta with nan": (lambda c: c.replace(b'"kerf":0.0002', b'"kerf":NaN'), "line 2", "NaN is not a number"),
    "meta with 1e999": (lambda c: c.replace(b'"kerf":0.0002', b'"kerf":1e999'), "line 2", "too large"),
    "a number of 5000 digits": (lambda c: c.replace(b'"rows":6', b'"rows":' + b"9" * 5000), "line 2", "not JSON"),
    "400 digits": (
        lambda c: c.replace(b'"kerf":0.0002', b'"kerf":' + b"9" * 400),
        "line 2",
        "kerf is outside",
    ),
    "a key twice": (lambda c: c.replace(b'"rows":6', b'"rows":6,"rows":6'), "line 2", "given twice"),
    "kerf negative": (lambda c: c.replace(b'"kerf":0.0002', b'"kerf":-1'), "line 2, process", "kerf is outside 0 to 1"),
    "kerf true": (lambda c: c.replace(b'"kerf":0.0002', b'"kerf":true'), "line 2, process", "not a number but bool"),
    "no process": (lambda c: with_meta(c, lambda m: m.pop("process")), "line 2", "missing process"),
    "an unknown key": (lambda c: with_meta(c, lambda m: m.update(tabs=1)), "line 2", "unknown 'tabs'"),
    "process a text": (lambda c: with_meta(c, lambda m: m.update(process="x")), "line 2, process", "got str"),
    "rows a float": (lambda c: with_meta(c, lambda m: m.update(rows=6.0)), "line 2", "rows is not a whole number"),
    "rows negative": (lambda c: with_meta(c, lambda m: m.update(rows=-1)), "line 2", "rows is outside 0"),
    "an unknown mode": (lambda c: with_meta(c, lambda m: m.update(mode="burn")), "line 2", "unknown mode 'burn'"),
    "an unknown corner": (lambda c: c.replace(b'"round"', b'"sharp"'), "line 2, process", "unknown corner 'sharp'"),
    "blocks an object": (lambda c: with_meta(c, lambda m: m.update(blocks={})), "line 2", "blocks is not a list"),
    "an unknown kind": (lambda c: c.replace(b'"pierce"', b'"weld"'), "line 2, block 1", "unknown kind 'weld'"),
    "a handle a number": (lambda c: c.replace(b'["2F","30"]', b"[47]"), "line 2, block 1", "handles is not text"),
    "robot a list": (lambda c: with_meta(c, lambda m: m.update(robot=[])), "line 2", "robot is not an object"),
    "robot changed": (lambda c: c.replace(b'"upper_arm":0.3', b'"upper_arm":0.301'), "line 2, robot", "fingerprint"),
    "no header": (lambda c: c.replace(b"tick,", b"tock,"), "line 3", "the columns are not"),
    "no rows": (lambda c: c[: c.index(b"block\n") + 6], "line 4", "no setpoint"),
    "an empty line": (body_edit(b"\n3,", b"\n\n3,"), "line 7", "1 fields instead of 6"),
    "empty lines only": (lambda c: c[: c.index(b"block\n") + 6] + b"\n\n", "line 4", "1 fields"),
    "a field too many": (body_edit(b"\n3,", b"\n3,3,"), "line 7", "7 fields instead of 6"),
    "a comment": (body_edit(b"\n3,", b"\n#3,"), "line 7", "tick is '#3'"),
    "nan": (body_edit(b"0.100000000000", b"nan"), "line 4", "q1_rad is 'nan'"),
    "inf": (body_edit(b"0.100000000000", b"-inf"), "line 4", "q1_rad is '-inf'"),
    "1e999": (body_edit(b"0.100000000000", b"1e999"), "line 4", "q1_rad is '1e999'"),
    "an angle of a million": (body_edit(b"0.100000000000", b"1e6"), "", "a joint angle is 1e+06 rad"),
    "an underscore": (body_edit(b"0.100000000000", b"1_0"), "line 4", "q1_rad is '1_0'"),
    "a space": (body_edit(b"0.100000000000", b" 0.1"), "line 4", "q1_rad is ' 0.1'"),
    "a semicolon": (body_edit(b"0.100000000000,", b"0.1;"), "line 4", "5 fields"),
    "no number": (body_edit(b"0.100000000000", b""), "line 4", "q1_rad is ''"),
    "half a tick": (body_edit(b"\n3,", b"\n2.5,"), "line 7", "tick is '2.5', which is not a whole number"),
    "a huge tick": (body_edit(b"\n3,", b"\n1e300,"), "line 7", "tick is '1e300'"),
    "half a block": (body_edit(b",0,0\n", b",0,0.5\n"), "line 4", "block is '0.5'"),
    "a row cut off": (lambda c: c[:-20], "line 9", "fields instead of 6"),
    "a null": (body_edit(b"\n3,", b"\n\x003,"), "line 7", "tick is '\\x003'"),
    "an endless line": (lambda c: c + b"1" * (9 * 2**20), "", "longer than"),
}


@pytest.mark.parametrize("damage", REFUSED)
def test_a_file_that_cannot_be_interpreted_is_refused_with_its_line(program: Program, damage: str) -> None:
    edit, where, what = REFUSED[damage]
    problem = refused(edit(written(program)))
    assert where in problem.where
    assert what in problem.what
    assert problem.what.isprintable()


@settings(deadline=None)
@given(st.data())
def test_a_change_of_any_byte_of_the_rows_is_refused_or_reported(program: Program, data: st.DataObject) -> None:
    content = bytearray(written(program))
    first_row = content.index(b"tick,q1")
    place = data.draw(st.integers(first_row, len(content) - 1))
    content[place] = data.draw(st.integers(0, 255).filter(lambda byte: byte != content[place]))
    try:
        found = read(bytes(content))
    except ProgramError:
        return
    assert found.integrity


def test_too_many_rows_are_refused(program: Program, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contents, "MAX_ROWS", 5)
    assert "5 rows" in refused(written(program)).what
