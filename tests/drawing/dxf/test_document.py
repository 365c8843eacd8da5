"""The readers: what they read, what they give up, and that they say so."""

import io
from pathlib import Path

import ezdxf
import pytest

from deltacam.drawing.dxf import document, tags
from deltacam.drawing.dxf.document import Loaded, load
from deltacam.drawing.dxf.repair import repair
from deltacam.drawing.reader import read_drawing
from deltacam.errors import DrawingError
from deltacam.model import Outcome

FILES = Path(__file__).parents[2] / "data" / "dxf"
ASCII = [path for path in sorted(FILES.glob("*.dxf")) if "binary" not in path.stem]

LINE = "0\nLINE\n5\n1A\n8\nA\n10\n0\n20\n0\n11\n5\n21\n0\n"
CIRCLE = "0\nCIRCLE\n5\n2A\n8\nB\n10\n1\n20\n2\n40\n5\n"
POLYLINE = "0\nPOLYLINE\n5\n3A\n8\nC\n66\n1\n70\n1\n"
VERTEX = "0\nVERTEX\n8\nC\n10\n1\n20\n2\n42\n0.5\n"
SEQEND = "0\nSEQEND\n8\nC\n"
INSERT = "0\nINSERT\n5\n4A\n8\nD\n2\nX\n10\n0\n20\n0\n"
LWPOLYLINE = "0\nLWPOLYLINE\n8\nE\n90\n2\n70\n1\n10\n0\n20\n0\n42\n1\n10\n4\n20\n0\n42\n1\n"
SPLINE = "0\nSPLINE\n8\nF\n71\n1\n40\n0\n40\n0\n40\n1\n40\n1\n10\n0\n20\n0\n10\n1\n20\n1\n"
BLOCK = "0\nBLOCK\n2\nX\n10\n0\n20\n0\n"


def entities(*parts: str) -> str:
    return f"0\nSECTION\n2\nENTITIES\n{''.join(parts)}0\nENDSEC\n0\nEOF\n"


def blocks(*parts: str) -> str:
    return f"0\nSECTION\n2\nBLOCKS\n{''.join(parts)}0\nENDSEC\n"


def read(text: str | bytes) -> Loaded:
    return load(text if isinstance(text, bytes) else text.encode(), "part.dxf")


def kinds(loaded: Loaded) -> list[str]:
    return [entity.dxftype() for entity in loaded.document.modelspace()]


def blocking(loaded: Loaded) -> bool:
    assert all(finding.kind in ("lost", "recovered") and finding.what and finding.hint for finding in loaded.findings)
    assert all(finding.blocks == (finding.kind == "lost") for finding in loaded.findings)
    return any(finding.blocks for finding in loaded.findings)


@pytest.mark.parametrize("path", ASCII, ids=lambda path: path.stem)
def test_the_tolerant_reader_reads_what_the_others_read(path: Path, tmp_path: Path) -> None:
    repaired = repair(tags.split(path.read_bytes()), path.name, bare=False)
    assert (repaired.lost, repaired.cut_off) == ((), "")
    again = tmp_path / path.name
    again.write_text(repaired.text, encoding="utf-8", errors="surrogateescape")
    one, other = (read_drawing(file, unit="mm", strict=False) for file in (path, again))
    for first, second in zip((*one.contours, *one.ignored), (*other.contours, *other.ignored), strict=True):
        assert first.curve.points.tobytes() == second.curve.points.tobytes()
        assert first.curve.bulges.tobytes() == second.curve.bulges.tobytes()
        assert first.layer == second.layer
    keys = [(entry.kind, entry.layer, entry.block, entry.outcome) for entry in one.ledger]
    assert keys == [(entry.kind, entry.layer, entry.block, entry.outcome) for entry in other.ledger]


@pytest.mark.parametrize("path", ASCII, ids=lambda path: path.stem)
def test_every_real_file_is_read_whole(path: Path) -> None:
    loaded = load(path.read_bytes(), path.name)
    expected = {"cut-test-needs-recover": "recover", "square-no-subclass": "tolerant"}
    assert loaded.reader == expected.get(path.stem, "plain")
    assert loaded.lost == ()
    assert not blocking(loaded)
    assert bool(loaded.findings) == (loaded.reader != "plain")


def test_a_polyline_without_subclass_markers_is_read_exactly() -> None:
    loaded = load((FILES / "square-no-subclass.dxf").read_bytes(), "square.dxf")
    (polyline,) = loaded.document.modelspace()
    assert polyline.closed
    assert polyline.dxf.layer == "OpenJsCad"
    assert list(polyline.get_points("xy")) == [(-10, 10), (-10, -10), (10, -10), (10, 10), (-10, 10)]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (LINE + CIRCLE + "0\nEOF\n", ["LINE", "CIRCLE"]),
        (entities(LINE, CIRCLE).removesuffix("0\nEOF\n"), ["LINE", "CIRCLE"]),
        (entities(LINE, CIRCLE).replace("0\nENDSEC\n", ""), ["LINE", "CIRCLE"]),
        (entities(LINE).removesuffix("0\nEOF\n") + entities(CIRCLE), ["LINE", "CIRCLE"]),
        (entities(LINE) + "\n\n\x1a", ["LINE"]),
        (entities(LWPOLYLINE, SPLINE), ["LWPOLYLINE", "SPLINE"]),
        (entities("0\nHATCH\n8\n0\n", LINE), ["HATCH", "LINE"]),
        (entities("0\nACAD_TABLE\n8\n0\n", LINE), ["ACAD_TABLE", "LINE"]),
        (entities("0\nTEXT\n8\n0\n100\nAcDbEntity\n102\n{\n100\nAcDbText\n", LWPOLYLINE), ["TEXT", "LWPOLYLINE"]),
        (entities("0\nTEXT\n8\n0\n10\n0\n20\n0\n1\ntwo\nlines\n", LINE), ["TEXT", "LINE"]),
        (entities("0\nTEXT\n8\n0\n10\n0\n20\n0\n1\ntwo\n\n", LINE), ["TEXT", "LINE"]),
        (entities(POLYLINE, VERTEX, VERTEX, LINE), ["POLYLINE", "LINE"]),
        (blocks(BLOCK, CIRCLE) + entities(INSERT), ["INSERT"]),
        (entities(CIRCLE.replace("2A", "XYZ")), ["CIRCLE"]),
        (entities(CIRCLE.replace("2A", "1A"), LINE), ["CIRCLE", "LINE"]),
        (entities(LINE, CIRCLE).lower(), ["LINE", "CIRCLE"]),
        (entities("0\nLINE\n8\n0\n10\n0\n11\n1\n20\n2\n21\n3\n"), ["LINE"]),
        (entities("0\nCIRCLE\n8\n0\n20\n0\n40\n1\n10\n2\n"), ["CIRCLE"]),
        ("0\nSECTION\n2\nHEADER\n9\n$EXTMIN\n10\n1.#QNAN\n20\n0\n0\nENDSEC\n" + entities(LINE), ["LINE"]),
    ],
)
def test_a_sloppy_file_is_read_whole_and_a_repair_is_mentioned(text: str, found: list[str]) -> None:
    loaded = read(text)
    assert kinds(loaded) == found
    assert loaded.lost == ()
    assert not blocking(loaded)
    assert [finding.kind for finding in loaded.findings] == ([] if loaded.reader == "plain" else ["recovered"])


@pytest.mark.parametrize(
    ("text", "found", "lost", "why"),
    [
        (entities(LINE, CIRCLE.replace("40\n5", "40\n2x5")), ["LINE"], "CIRCLE", "'2x5' is not a number"),
        (entities(LINE, CIRCLE.replace("40\n5\n", "")), ["LINE"], "CIRCLE", "group code 40 is missing"),
        (entities(LINE, CIRCLE.replace("20\n2\n", "")), ["LINE"], "CIRCLE", "group code 20"),
        (entities(CIRCLE, LINE.replace("11\n5\n21\n0\n", "")), ["CIRCLE"], "LINE", "group code 11"),
        (entities(CIRCLE, LINE.replace("20\n0\n", "20\n")), ["CIRCLE"], "LINE", "missing or damaged"),
        (entities(CIRCLE, LINE, LINE.replace("0\nLINE\n", "", 1)), ["CIRCLE"], "LINE", "ran together"),
        (entities(CIRCLE, LWPOLYLINE.replace("20\n0\n", "", 1)), ["CIRCLE"], "LWPOLYLINE", "2 x but 1 y"),
        (entities(CIRCLE, SPLINE.replace("71\n1\n", "")), ["CIRCLE"], "SPLINE", "no degree"),
        (entities(CIRCLE, POLYLINE, VERTEX, VERTEX.replace("20\n2\n", ""), SEQEND), ["CIRCLE"], "POLYLINE", "vertex"),
        (entities(CIRCLE, LINE.replace("LINE", "LAYER")), ["CIRCLE"], "LAYER", "no kind of entity"),
        (entities(CIRCLE, LINE.replace("LINE", "XRECORD")), ["CIRCLE"], "XRECORD", "no kind of entity"),
        (entities(CIRCLE, VERTEX), ["CIRCLE"], "VERTEX", "without its polyline"),
        (entities(INSERT.replace("2\nX\n", ""), LINE), ["LINE"], "INSERT", "group code 2"),
        (blocks(*(BLOCK, CIRCLE, "0\nENDBLK\n") * 2) + entities(INSERT), ["INSERT"], "CIRCLE", "in the file twice"),
        (blocks(BLOCK.replace("2\nX\n", ""), CIRCLE, "0\nENDBLK\n") + entities(LINE), ["LINE"], "CIRCLE", "no name"),
        (
            blocks(BLOCK.replace("10\n0", "10\nx"), CIRCLE, "0\nENDBLK\n") + entities(INSERT),
            ["INSERT"],
            "CIRCLE",
            "'x'",
        ),
        (entities(LINE, POLYLINE, VERTEX, SEQEND.rstrip(), LINE[2:]), ["LINE"], "?", "without its start"),
    ],
)
def test_what_cannot_be_read_is_lost_and_never_guessed(text: str, found: list[str], lost: str, why: str) -> None:
    if lost == "?":
        text = entities(LINE, POLYLINE, VERTEX, SEQEND, LINE.removeprefix("0\nLINE\n"))
        found = ["LINE", "POLYLINE"]
    loaded = read(text)
    assert kinds(loaded) == found
    assert [(entry.kind, entry.outcome) for entry in loaded.lost] == [(lost, Outcome.LOST)]
    assert why in loaded.lost[0].reason
    assert blocking(loaded)
    assert any(finding.what.startswith(f"1 {lost} could not be read") for finding in loaded.findings)


def test_a_lost_entity_has_its_handle_layer_and_block() -> None:
    damaged = CIRCLE.replace("40\n5", "40\n?")
    (one,) = read(entities(LINE, damaged)).lost
    assert (one.handle, one.layer, one.block) == ("2A", "B", "")
    (other,) = read(blocks(BLOCK, damaged, "0\nENDBLK\n") + entities(INSERT)).lost
    assert (other.handle, other.layer, other.block) == ("2A", "B", "x")


@pytest.mark.parametrize(
    "text",
    [
        LINE + CIRCLE,
        entities(LINE, CIRCLE)[: -len("0\nENDSEC\n0\nEOF\n")],
        entities(LINE, CIRCLE)[: -len("40\n5\n0\nENDSEC\n0\nEOF\n")],
        entities(LINE, LWPOLYLINE)[: -len("20\n0\n42\n1\n0\nENDSEC\n0\nEOF\n")],
        entities(LINE, CIRCLE).removeprefix("0\nSECTION\n2\nENTITIES\n"),
        "0\nSECTION\n2\nTABLES\n" + entities(LINE, CIRCLE).removeprefix("0\nSECTION\n2\nENTITIES\n"),
    ],
)
def test_a_file_without_its_start_or_its_end_is_never_taken_for_complete(text: str) -> None:
    loaded = read(text)
    assert "LINE" in kinds(loaded)
    assert blocking(loaded)
    assert any("cut off before the" in finding.what for finding in loaded.findings)


def test_a_polyline_with_fewer_vertices_than_announced_blocks() -> None:
    text = LWPOLYLINE.replace("8\nE\n90\n2\n", "100\nAcDbEntity\n8\nE\n100\nAcDbPolyline\n90\n3\n")
    loaded = read("0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n0\nENDSEC\n" + entities(text))
    assert loaded.reader == "plain"
    assert blocking(loaded)


@pytest.mark.parametrize("number", ["2,5", "-0,5", ",5"])
def test_decimal_commas_are_an_error(number: str) -> None:
    with pytest.raises(DrawingError, match="not a number with a decimal point") as caught:
        read(entities(LINE, CIRCLE.replace("40\n5", f"40\n{number}")))
    assert caught.value.where == "part.dxf, CIRCLE #2A"


@pytest.mark.parametrize("text", ["0\nEOF\n", "", entities(), "0\nSECTION\n2\nENTITIES\n"])
def test_nothing_left_after_a_repair_is_an_error(text: str) -> None:
    damaged = text + CIRCLE.replace("40\n5", "40\nfive")
    with pytest.raises(DrawingError, match=r"damaged|cut off") as caught:
        read(damaged)
    assert caught.value.hint


def test_units_layers_and_blocks_survive_a_repair() -> None:
    header = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n     1\n9\n$MEASUREMENT\n70\n0\n0\nENDSEC\n"
    layers = (
        "0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n0\nLAYER\n2\nD\n70\n1\n62\n-3\n6\nDASHED\n0\nENDTAB\n0\nENDSEC\n"
    )
    block = BLOCK.replace("10\n0\n20\n0", "10\n3\n20\n4")
    insert = INSERT + "41\n-2\n42\n0.5\n50\n30\n70\n2\n71\n3\n44\n9\n45\n8\n210\n0\n220\n0\n230\n-1\n"
    loaded = read(header + layers + blocks(block, LWPOLYLINE, "0\nENDBLK\n") + entities(insert))
    assert loaded.reader == "tolerant"
    source = loaded.document
    assert (source.header["$INSUNITS"], source.header["$MEASUREMENT"]) == (1, 0)
    layer = source.layers.get("D")
    assert (layer.is_frozen(), layer.is_off(), layer.dxf.color, layer.dxf.linetype) == (True, True, -3, "DASHED")
    (one,) = source.modelspace()
    names = ("name", "handle", "layer", "xscale", "yscale", "rotation", "column_count", "row_count", "row_spacing")
    assert [one.dxf.get(name) for name in names] == ["X", "4A", "D", -2, 0.5, 30, 2, 3, 8]
    assert tuple(one.dxf.extrusion) == (0, 0, -1)
    assert tuple(source.blocks.get("X").base_point) == (3, 4, 0)
    assert [list(entity.get_points("xyb")) for entity in source.blocks.get("X")] == [[(0, 0, 1), (4, 0, 1)]]


def test_the_code_page_of_a_damaged_file_is_respected() -> None:
    header = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$DWGCODEPAGE\n3\nANSI_1252\n0\nENDSEC\n"
    loaded = read((header + entities(LWPOLYLINE.replace("8\nE", "8\nÜß"))).encode("cp1252"))
    assert [entity.dxf.layer for entity in loaded.document.modelspace()] == ["Üß"]


def test_a_binary_file_that_is_incomplete_goes_to_the_tolerant_reader() -> None:
    source = ezdxf.new("R2000")
    source.modelspace().add_circle((1, 2), 3)
    source.modelspace().add_line((0, 0), (5, 0))
    stream = io.BytesIO()
    source.write(stream, fmt="bin")
    data = stream.getvalue()
    assert load(data, "part.dxf").reader == "plain"
    radius = b"\x28\x00" + b"\0\0\0\0\0\0\x08\x40"
    assert data.count(radius) == 1
    loaded = load(data.replace(radius, b"\x27" + radius[1:]), "part.dxf")
    assert loaded.reader == "tolerant"
    assert kinds(loaded) == ["LINE"]
    assert [entry.kind for entry in loaded.lost] == ["CIRCLE"]


@pytest.mark.parametrize(
    ("data", "what"),
    [
        (b"0\nSECTION\n" + b"0\nA\n" * 900_000, "900001 objects in 1800002 lines"),
        (b"0\nLINE\n" * 3_000_001, "more than 3000000"),
        (b"0\n" * 3_000_001, "not a DXF"),
        (b"A" * 10_000_000, "not a DXF"),
        (b" " * 10_000_000 + b"0", "not a DXF"),
        (b"0\nSECTION\n2\n" + b"9" * 5_000_000, "cut off"),
        (b"GIF89a...", "a GIF image"),
        (b"ISO-10303-21;\nHEADER;", "a STEP file"),
        (b"<!DocType HTML>", "a web page"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1", "a CAD or Office document"),
    ],
)
def test_hostile_and_foreign_files_are_refused_in_one_sentence(data: bytes, what: str) -> None:
    with pytest.raises(DrawingError, match=what) as caught:
        load(data, "part.dxf")
    assert "\n" not in caught.value.what
    assert len(caught.value.what) < 250
    assert caught.value.hint


@pytest.mark.parametrize("number", ["9" * 400, "9" * 5000, "nan", "inf", "1e400", "1_0"])
@pytest.mark.parametrize("code", [5, 10, 40, 62, 67, 210, 370])
def test_absurd_numbers_crash_nothing(code: int, number: str) -> None:
    assert read(entities(LINE, f"0\nCIRCLE\n8\n0\n10\n0\n20\n0\n40\n1\n{code}\n{number}\n")).document


def test_ezdxf_is_not_asked_to_recover_large_files(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(document, "_MAX_RECOVERED", 100)
    monkeypatch.setattr(document.recover, "read", lambda _: pytest.fail("it was recovered"))
    loaded = read(entities(LINE * 100).removesuffix("0\nEOF\n"))
    assert (loaded.reader, len(kinds(loaded)), loaded.lost) == ("tolerant", 100, ())


MTEXT = "0\nMTEXT\n5\n9A\n100\nAcDbEntity\n8\nN\n100\nAcDbMText\n10\n1\n20\n2\n40\n3\n1\nnote\n"
EMBEDDED = "101\nEmbedded Object\n70\n1\n10\n1\n20\n0\n11\n1\n21\n2\n40\n7\n"


def test_a_text_that_holds_another_object_is_not_two_texts() -> None:
    loaded = read(entities(LINE, MTEXT + EMBEDDED))
    assert (loaded.reader, loaded.lost, loaded.findings) == ("plain", (), ())
    assert kinds(loaded) == ["LINE", "MTEXT"]


def test_a_text_with_its_layer_in_an_odd_place_beside_a_damaged_header_is_kept() -> None:
    header = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n0\nENDSEC\n9\n$EXTMIN\n10\n0\n20\n0\n0\nENDSEC\n"
    odd = MTEXT.replace("100\nAcDbEntity\n8\nN\n100\nAcDbMText\n", "100\nAcDbMText\n8\nN\n")
    loaded = read(header + entities(LINE, odd))
    assert (loaded.reader, loaded.lost) == ("tolerant", ())
    assert [finding.kind for finding in loaded.findings] == ["recovered"]
    assert kinds(loaded) == ["LINE", "MTEXT"]


def test_a_file_that_begins_inside_an_entity_is_never_taken_for_complete() -> None:
    assert blocking(read("10\n5\n20\n5\n0\nENDSEC\n" + entities(LINE)))


def test_blocks_without_names_and_nothing_else_are_nothing_to_cut() -> None:
    with pytest.raises(DrawingError, match="nothing to cut: the file holds no line"):
        read(blocks("0\nBLOCK\n2\n\n0\nENDBLK\n", "0\nBLOCK\n2\n\n0\nENDBLK\n") + entities())
