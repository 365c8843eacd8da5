"""Files, units, the ledger and the refusals."""

import gc
import hashlib
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import ezdxf
import pytest

from deltacam.drawing.dxf import document
from deltacam.drawing.reader import read_drawing
from deltacam.errors import DeltacamError, DrawingError
from deltacam.geometry import curve as curves
from deltacam.model import Outcome, Selection

FILES = Path(__file__).parents[1] / "data" / "dxf"
SQUARE = [(0, 0), (1000, 0), (1000, 1000), (0, 1000)]


def square(msp: Any) -> None:
    msp.add_lwpolyline(SQUARE, close=True)


@pytest.mark.parametrize(
    ("content", "what"),
    [
        (b"", "empty"),
        (b" \r\n \n", "empty"),
        (b"%PDF-1.7 ...", "a PDF"),
        (b"AC1032\0\0\0", "a DWG"),
        (b'<?xml version="1.0"?><svg/>', "an SVG or XML"),
        (b"<svg/>", "an SVG"),
        (b"<!DOCTYPE html>", "a web page"),
        (b"version https://git-lfs.github.com/spec/v1", "a Git LFS pointer"),
        (b"solid part\nfacet normal 0 0 1\n", "not a DXF"),
        (bytes(range(256)), "not a DXF"),
        (b"AutoCAD Binary DXF\n\x1a\x00\x00SECTION", "first line is damaged"),
        (b"AutoCAD Binary DXF\r\n\x1a\x00\x00SECTION\x00\x02ENTI", "binary DXF file that is damaged or cut off"),
        (b"  0\nEOF\n", "nothing to cut|not a DXF"),
    ],
)
def test_a_file_that_is_no_drawing_is_named(tmp_path: Path, content: bytes, what: str) -> None:
    path = tmp_path / "part.dxf"
    path.write_bytes(content)
    with pytest.raises(DrawingError, match=what) as caught:
        read_drawing(path, unit="mm")
    assert caught.value.where == "part.dxf"
    assert caught.value.hint


def test_a_folder_a_missing_file_and_a_bad_name_are_named(tmp_path: Path) -> None:
    with pytest.raises(DrawingError, match="folder"):
        read_drawing(tmp_path)
    with pytest.raises(DrawingError, match="no such file"):
        read_drawing(tmp_path / "none.dxf")
    with pytest.raises(DrawingError, match="cannot be read"):
        read_drawing("a\0b.dxf")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_a_file_without_permission_is_named(tmp_path: Path) -> None:
    path = tmp_path / "part.dxf"
    path.touch(mode=0o000)
    with pytest.raises(DrawingError, match="permission"):
        read_drawing(path)


def test_a_file_over_the_limit_is_refused_unread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "part.dxf"
    path.write_bytes(b"0" * 2048)
    monkeypatch.setattr(document, "MAX_BYTES", 1024)
    monkeypatch.setattr(Path, "read_bytes", lambda _: pytest.fail("it was read"))
    with pytest.raises(DrawingError, match="too large"):
        read_drawing(path)


@pytest.mark.parametrize("share", [0.2, 0.3, 0.35, 0.5])
def test_a_file_that_is_cut_off_inside_its_entities_is_refused(tmp_path: Path, share: float) -> None:
    data = (FILES / "drone-top-onshape.dxf").read_bytes()
    begin, end = data.find(b"ENTITIES"), data.find(b"ENDSEC", data.find(b"ENTITIES"))
    path = tmp_path / "part.dxf"
    path.write_bytes(data[: int(begin + share * (end - begin))])
    with pytest.raises(DrawingError, match=r"no end|cut off"):
        read_drawing(path, unit="mm")


def test_a_decimal_comma_is_refused_and_never_read_as_another_number(tmp_path: Path) -> None:
    data = (FILES / "cut-test-needs-recover.dxf").read_bytes()
    path = tmp_path / "part.dxf"
    path.write_bytes(data.replace(b"57.2", b"57,2"))
    assert path.read_bytes() != data
    with pytest.raises(DrawingError, match="not a number with a decimal point"):
        read_drawing(path, unit="mm")


@pytest.mark.parametrize(
    ("insunits", "unit", "metres", "name"),
    [
        (4, None, 1e-3, "mm (header)"),
        (1, None, 25.4e-3, "in (header)"),
        (2, None, 0.3048, "ft (header)"),
        (5, None, 1e-2, "cm (header)"),
        (9, None, 25.4e-6, "mil (header)"),
        (0, "pt", 25.4e-3 / 72, "pt (--units)"),
        (0, "um", 1e-6, "um (--units)"),
        (1, "mm", 1e-3, "mm (--units)"),
        (4, "inch", 25.4e-3, "in (--units)"),
    ],
)
def test_the_unit_scales_the_drawing(reread: Any, insunits: int, unit: str | None, metres: float, name: str) -> None:
    drawing = reread(lambda msp: msp.add_circle((10, 10), 10), insunits=insunits, unit=unit)
    assert (drawing.metres_per_unit, drawing.unit_in_words) == (metres, name)
    assert curves.bounds(drawing.contours[0].curve) == pytest.approx((0, 0, 20 * metres, 20 * metres), abs=1e-12)
    differs = unit is not None and insunits != 0
    assert sum(finding.what.startswith("the file says") for finding in drawing.findings) == differs


def test_an_exact_factor_wins_over_everything(reread: Any) -> None:
    drawing = reread(square, unit="in", metres_per_unit=0.002)
    assert drawing.metres_per_unit == 0.002
    assert curves.bounds(drawing.contours[0].curve) == pytest.approx((0, 0, 2.0, 2.0))
    with pytest.raises(DrawingError, match="positive"):
        reread(square, metres_per_unit=-1.0)


def test_a_drawing_without_a_unit_is_refused_with_both_sizes(reread: Any) -> None:
    with pytest.raises(DrawingError, match="1000 x 1000 mm if its unit is mm, 25400 x 25400 mm if it is inch"):
        reread(square, insunits=0)


def test_an_unknown_unit_is_refused(reread: Any) -> None:
    with pytest.raises(DeltacamError, match="furlong"):
        reread(square, unit="furlong")
    with pytest.raises(DrawingError, match="INSUNITS = 7"):
        reread(square, insunits=7)


def draw_one_of_each(msp: Any) -> None:
    square(msp)
    msp.add_text("text")
    msp.add_mtext("mtext")
    msp.add_point((1, 1))
    msp.add_solid([(0, 0), (1, 0), (1, 1)])
    msp.add_3dface([(0, 0), (1, 0), (1, 1)])
    msp.add_hatch().paths.add_polyline_path(SQUARE)
    msp.add_ray((0, 0), (1, 0))
    with msp.add_mesh().edit_data() as mesh:
        mesh.vertices, mesh.faces = [(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(0, 1, 2)]
    msp.add_polymesh((3, 3))
    msp.add_line((20, 0), (25, 0))
    msp.add_line((30, 0), (30, 0))
    block = msp.doc.blocks.new("PART")
    block.add_circle((0, 0), 3)
    block.add_attdef("NAME")
    msp.add_blockref("PART", (50, 50)).add_attrib("NAME", "a")


def test_every_entity_has_one_line_in_the_ledger(reread: Any) -> None:
    drawing = reread(draw_one_of_each)
    lines = [(entry.kind, entry.outcome, entry.block) for entry in drawing.ledger]
    ignored = ("TEXT", "MTEXT", "POINT", "SOLID", "3DFACE", "HATCH", "RAY", "MESH", "POLYLINE", "LINE", "LINE")
    assert lines == [
        ("LWPOLYLINE", Outcome.CUT, ""),
        *((kind, Outcome.IGNORED, "") for kind in ignored),
        ("INSERT", Outcome.MERGED, ""),
        ("ATTRIB", Outcome.IGNORED, ""),
        ("CIRCLE", Outcome.CUT, "PART"),
        ("ATTDEF", Outcome.IGNORED, "PART"),
    ]
    reasons = [entry.reason for entry in drawing.ledger if entry.outcome is Outcome.IGNORED]
    assert all(reasons)
    assert any(reason.startswith("lies along") for reason in reasons)
    assert [entry.contour for entry in drawing.ledger if entry.outcome is Outcome.CUT] == [1, 2]


def test_entities_on_frozen_layers_are_read_and_reported(reread: Any) -> None:
    def draw(msp: Any) -> None:
        msp.doc.layers.add("Cold").freeze()
        msp.doc.layers.add("Dark").off()
        msp.add_circle((0, 0), 5, dxfattribs={"layer": "Cold"})
        msp.add_circle((20, 0), 5, dxfattribs={"layer": "dark"})
        msp.add_circle((40, 0), 5, dxfattribs={"invisible": 1})

    drawing = reread(draw)
    assert len(drawing.contours) == 2
    assert [(finding.what, finding.where) for finding in drawing.findings] == [
        ("the layer is frozen, but its 1 curve is read like all others", "layer Cold"),
        ("the layer is off, but its 1 curve is read like all others", "layer Dark"),
        ("1 CIRCLE is not cut: marked as invisible", "layer 0, #33"),
    ]
    left_out = reread(draw, selection=Selection(ignored_layers=("dark",)))
    assert [finding.what for finding in left_out.findings if finding.kind == "layer"] == [
        "1 entity is left out as --layer and --ignore-layer say",
        "the layer is frozen, but its 1 curve is read like all others",
    ]
    assert [(layer.name, layer.state, layer.curves) for layer in drawing.layers[:2]] == [
        ("Cold", "frozen", 1),
        ("Dark", "off", 1),
    ]


@pytest.mark.parametrize(
    ("draw", "what"),
    [
        (lambda _: None, "nothing to cut: it holds no entities"),
        (lambda msp: [msp.add_mtext("a"), msp.add_mtext("b")], "nothing to cut: 2 MTEXT"),
        (lambda msp: [msp.add_line((0, 0), (9, 0)), msp.add_text("a")], "nothing to cut: 1 open chain, 1 TEXT"),
        (lambda msp: msp.doc.layout("Layout1").add_circle((0, 0), 5), "nothing to cut: 1 entity in paper space"),
        (lambda msp: msp.add_lwpolyline([(0, 0), (1, 0)], close=True), "nothing to cut"),
        (lambda msp: msp.add_line((1, 1), (1, 1)), "nothing to cut"),
    ],
)
@pytest.mark.parametrize("insunits", [0, 4])
def test_a_drawing_with_nothing_to_cut_says_what_it_holds(reread: Any, draw: Any, what: str, insunits: int) -> None:
    if insunits == 0 and ("chain" in what or what == "nothing to cut"):
        what = "states no unit"
    with pytest.raises(DrawingError, match=what) as caught:
        reread(draw, insunits=insunits)
    assert caught.value.hint


def test_the_hash_is_that_of_the_bytes() -> None:
    path = FILES / "wrench-inch.dxf"
    drawing = read_drawing(path)
    assert drawing.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    assert drawing.file == "wrench-inch.dxf"


def test_what_ezdxf_logs_is_not_printed() -> None:
    script = "import deltacam.drawing.reader, logging; logging.getLogger('ezdxf').warning('noise')"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, check=True, timeout=60)
    assert (done.stdout, done.stderr) == (b"", b"")


def test_a_duplicate_is_listed_with_the_contour_that_it_repeats(reread: Any) -> None:
    drawing = reread(lambda msp: [msp.add_circle((x, 0), 5) for x in (0, 20, 20)])
    assert [(entry.outcome, entry.contour) for entry in drawing.ledger] == [
        (Outcome.CUT, 1),
        (Outcome.CUT, 2),
        (Outcome.MERGED, 2),
    ]
    assert drawing.ledger[2].reason == f"duplicate of #{drawing.ledger[1].handle}"


def test_binary_dxf_other_line_ends_and_a_mark_need_no_recovery(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(document.recover, "read", lambda _: pytest.fail("it was recovered"))
    source = ezdxf.new("R12")
    source.header["$INSUNITS"] = 4
    source.modelspace().add_circle((5, 5), 5)
    source.saveas(tmp_path / "text.dxf")
    source.saveas(tmp_path / "binary.dxf", fmt="bin")
    (tmp_path / "cr.dxf").write_bytes(
        (tmp_path / "text.dxf").read_bytes().replace(b"\r\n", b"\n").replace(b"\n", b"\r")
    )
    (tmp_path / "bom.dxf").write_bytes(b"\xef\xbb\xbf" + (tmp_path / "text.dxf").read_bytes())
    for name in ("text", "binary", "cr", "bom"):
        drawing = read_drawing(tmp_path / f"{name}.dxf", unit="mm")
        assert curves.bounds(drawing.contours[0].curve) == pytest.approx((0, 0, 0.01, 0.01), abs=1e-15)


@pytest.mark.parametrize("was_on", [True, False])
def test_the_collector_of_garbage_is_left_as_it_was(reread: Any, was_on: bool) -> None:
    (gc.enable if was_on else gc.disable)()
    try:
        reread(square)
        with pytest.raises(DrawingError):
            reread(lambda msp: msp.add_text("a"))
        assert gc.isenabled() == was_on
    finally:
        gc.enable()
