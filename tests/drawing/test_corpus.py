"""Real drawings: contours and sizes that a person sees in them, or a refusal in one sentence.

The expectations come from looking at pictures of the files, made without deltacam.
"""

from pathlib import Path

import numpy as np
import pytest

from deltacam.drawing.reader import read_drawing
from deltacam.errors import DrawingError
from deltacam.geometry import curve as curves
from deltacam.model import Drawing, Outcome

FILES = Path(__file__).parents[1] / "data" / "dxf"

# file, unit that the user states, outer contours, inner contours, width and height of all of them in mm
READABLE = [
    ("bottom-plate-spline-inch", None, 1, 16, 357.9, 134.2),
    ("box-end-openscad", "mm", 1, 4, 206.0, 381.5),
    ("box-end-vents-openscad", "mm", 1, 14, 206.0, 381.5),
    ("case-top-inch", None, 1, 6, 609.6, 609.6),
    ("channel-bulge-inch", None, 1, 0, 93.22, 304.8),
    ("chute-holder-lines", None, 8, 35, 282.9, 179.3),
    ("cut-test-needs-recover", "mm", 1, 0, 72.0, 57.2),
    ("cycloidal-inch", None, 4, 19, None, None),
    ("drawing-r12-dims", "mm", 1, 14, 284.0, 208.0),
    ("drone-top-onshape", "mm", 1, 27, 150.0, 150.0),
    ("eco-user-kicad", "mm", 30, 29, None, None),  # 29 stroked outlines and a dot of 0.1 mm
    ("gear-logo-inkscape", "mm", 1, 0, 107.1, 96.4),
    ("gear-unitless", "mm", 1, 1, 32.2, 32.0),
    ("insert-r14", "mm", 2, 0, None, None),
    ("key-plate-bulge", None, 1, 42, 145.4, 116.3),
    ("key-plate-inkscape", "mm", 1, 30, 137.2, 109.2),
    ("key-plate-r12-lines", "mm", 1, 105, 428.6, 123.8),
    ("motor-mount-open-lines", "mm", 1, 48, 90.0, 157.7),
    ("nest-forms", None, 23, 17, 1016.0, 831.3),
    ("plate-solidworks-inch", None, 2, 17, None, None),
    ("rational-spline-inch", None, 1, 0, 38.4, 38.4),
    ("redox-r12-polylines", "in", 1, 40, 162.2, 126.5),
    ("redox-top-dims", None, 1, 40, 172.6, 138.4),
    ("sliding-base-mtext-inch", None, 4, 5, None, None),
    ("splines-deg123", None, 4, 0, None, None),
    ("sweep-plate-kicad", "mm", 1, 25, 111.6, 95.2),
    ("switch-mount-duplicates", None, 0, 52, None, None),
    ("tank-lid-inkscape", "mm", 1, 7, 294.6, 61.7),
    ("tray-bottom-inch", None, 1, 23, 355.6, 355.6),
    ("wrench-inch", None, 1, 1, 82.6, 23.8),
]

# file, unit that the user states, what the refusal says
REFUSED = [
    ("badges-illustrator", "pt", "crosses"),
    ("broken-loop", "mm", r"nothing to cut: 1 open chain .*gap of 0\.1 mm"),
    ("diamond-3d-binary", "mm", "not flat"),
    ("diamond-binary-damaged", "mm", "binary DXF file whose first line is damaged"),
    ("motor-lock-wrong-units", "mm", "crosses"),
    ("square-no-subclass", "mm", "AcDbPolyline"),
]

# file, what one of the findings says
NOTED = [
    ("motor-mount-open-lines", "mm", "7 open chains are not cut"),
    ("switch-mount-duplicates", None, "4 open chains are not cut"),
    ("switch-mount-duplicates", None, "6 entities are drawn twice and cut once"),
    ("switch-mount-duplicates", None, "2 MTEXT are not cut: text is never cut"),
    ("switch-mount-duplicates", None, "52 contours lie in an outline that is open"),
    ("sliding-base-mtext-inch", None, "2 MTEXT are not cut: text is never cut"),
    ("redox-top-dims", None, "2 DIMENSION are not cut: a dimension is never cut"),
    ("insert-r14", "mm", "a closed line encloses nothing"),
    ("drawing-r12-dims", "mm", "13 DIMENSION are not cut"),
]

# files that leave nothing to say: every entity is cut
CLEAN = ("drone-top-onshape", "sweep-plate-kicad", "key-plate-bulge", "wrench-inch", "plate-solidworks-inch")


def read(name: str, unit: str | None) -> Drawing:
    return read_drawing(FILES / f"{name}.dxf", unit=unit)


def size_mm(drawing: Drawing) -> tuple[float, float]:
    boxes = [curves.bounds(contour.curve) for contour in drawing.contours]
    low_x, low_y, high_x, high_y = zip(*boxes, strict=True)
    return 1e3 * (max(high_x) - min(low_x)), 1e3 * (max(high_y) - min(low_y))


def test_every_file_has_an_expectation() -> None:
    assert {path.stem for path in FILES.glob("*.dxf")} == {row[0] for row in (*READABLE, *REFUSED)}


@pytest.mark.parametrize(("name", "unit", "outer", "inner", "width", "height"), READABLE, ids=lambda v: str(v))
def test_a_real_drawing_has_the_contours_and_the_size_that_a_person_sees(
    name: str, unit: str | None, outer: int, inner: int, width: float | None, height: float | None
) -> None:
    drawing = read(name, unit)
    assert sum(not contour.is_hole for contour in drawing.contours) == outer
    assert sum(contour.is_hole for contour in drawing.contours) == inner
    if width is not None:
        assert size_mm(drawing) == pytest.approx((width, height), abs=0.06)
    assert [contour.number for contour in drawing.contours] == list(range(1, outer + inner + 1))
    for contour in drawing.contours:
        assert contour.curve.closed
        assert curves.signed_area(contour.curve) > 0.0
        assert curves.lengths(contour.curve).min() >= 0.99e-6
    assert {entry.contour for entry in drawing.ledger if entry.outcome is Outcome.CUT} == {
        contour.number for contour in drawing.contours
    }
    assert all(entry.reason for entry in drawing.ledger if entry.outcome is not Outcome.CUT)


@pytest.mark.parametrize(("name", "unit", "what"), REFUSED, ids=lambda v: str(v))
def test_a_drawing_that_cannot_be_cut_is_refused_in_one_sentence(name: str, unit: str, what: str) -> None:
    with pytest.raises(DrawingError, match=what) as caught:
        read(name, unit)
    assert "\n" not in caught.value.what
    assert caught.value.where
    assert caught.value.hint


@pytest.mark.parametrize(("name", "unit", "what"), NOTED)
def test_what_a_person_should_know_is_a_finding(name: str, unit: str | None, what: str) -> None:
    assert any(what in finding.what for finding in read(name, unit).findings)


@pytest.mark.parametrize("name", CLEAN)
def test_a_clean_drawing_is_cut_whole_and_without_a_remark(name: str) -> None:
    drawing = read(name, "mm" if name in ("drone-top-onshape", "sweep-plate-kicad") else None)
    assert {entry.outcome for entry in drawing.ledger} == {Outcome.CUT}
    assert drawing.findings == ()


def test_two_parts_in_inch_have_their_sizes() -> None:
    outer = [contour for contour in read("plate-solidworks-inch", None).contours if not contour.is_hole]
    sizes = sorted((box[2] - box[0], box[3] - box[1]) for box in (curves.bounds(part.curve) for part in outer))
    assert np.array(sizes) == pytest.approx(np.array([(0.0508, 0.06985), (0.14605, 0.1143)]), abs=1e-9)


def test_two_inserted_plates_have_their_size_and_their_blocks() -> None:
    drawing = read("insert-r14", "mm")
    for contour in drawing.contours:
        low_x, low_y, high_x, high_y = curves.bounds(contour.curve)
        assert (high_x - low_x, high_y - low_y) == pytest.approx((0.175, 0.1545), abs=1e-6)
    assert {entry.block for entry in drawing.ledger if entry.outcome is Outcome.CUT} == {"rect", "rect-0"}


def test_arcs_of_the_drawing_stay_arcs() -> None:
    drone = read("drone-top-onshape", "mm")
    arcs = sum(int((contour.curve.bulges != 0.0).sum()) for contour in drone.contours)
    assert arcs == 48 + 2 * 19
    assert drone.conversion_error < 1e-7


def test_a_file_without_a_header_states_no_unit() -> None:
    with pytest.raises(DrawingError, match=r"states no unit: it is 206 x 381\.5 mm if its unit is mm") as caught:
        read("box-end-openscad", None)
    assert caught.value.hint == "state the unit: --units mm"


@pytest.mark.parametrize("name", ["drone-top-onshape", "tank-lid-inkscape", "nest-forms"])
def test_the_same_file_reads_the_same_twice(name: str) -> None:
    one, other = read(name, "mm"), read(name, "mm")
    for first, second in zip(one.contours, other.contours, strict=True):
        assert first.curve.points.tobytes() == second.curve.points.tobytes()
        assert first.curve.bulges.tobytes() == second.curve.bulges.tobytes()
    assert (one.ledger, one.findings) == (other.ledger, other.findings)
