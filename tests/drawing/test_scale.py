"""The unit of a drawing: who states it, and what is said where nobody does or where it cannot be right."""

from pathlib import Path
from types import SimpleNamespace

import ezdxf
import pytest

from deltacam.drawing import scale
from deltacam.drawing.scale import Header, Scale, choose, findings
from deltacam.errors import DeltacamError, DrawingError
from deltacam.model import Finding

FILES = Path(__file__).parents[1] / "data" / "dxf"
NONE = Header()
INCH, MM = Header(1), Header(4)

# $INSUNITS: how many make a metre; a survey foot is 1200/3937 m
PER_METRE = {
    1: 39.37007874,
    2: 3.28083989501312,
    4: 1000.0,
    5: 100.0,
    6: 1.0,
    8: 39370078.74,
    9: 39370.07874,
    10: 1.09361329833771,
    13: 1e6,
    14: 10.0,
    21: 3937 / 1200,
    22: 3937 / 100,
    23: 3937 / 3600,
}


def about(header: Header, width: float, height: float, **stated: str) -> tuple[Finding, ...]:
    """What is said about a drawing of that size in its own numbers."""
    chosen = choose(header, unit=stated.get("unit"), default=stated.get("default"))
    return findings(chosen, (width * chosen.metres, height * chosen.metres), header)


def only(found: tuple[Finding, ...]) -> Finding:
    assert len(found) == 1, found
    return found[0]


@pytest.mark.parametrize(
    ("header", "stated", "expected"),
    [
        (MM, {}, Scale(1e-3, "mm", "header")),
        (MM, {"default": "in"}, Scale(1e-3, "mm", "header")),
        (MM, {"unit": "in"}, Scale(25.4e-3, "in", "--units")),
        (MM, {"unit": "points", "default": "in"}, Scale(25.4e-3 / 72, "pt", "--units")),
        (NONE, {"default": "inch"}, Scale(25.4e-3, "in", "deltacam.toml")),
        (Header(0), {"default": "cm"}, Scale(1e-2, "cm", "deltacam.toml")),
        (Header(0), {"unit": "cm", "default": "in"}, Scale(1e-2, "cm", "--units")),
        (MM, {"unit": "in", "default": "cm", "metres_per_unit": 0.0254}, Scale(0.0254, "in", "given")),
        (MM, {"metres_per_unit": 0.002}, Scale(0.002, "0.002 m", "given")),
        (NONE, {}, Scale(1e-3, "", "missing")),
        (Header(0), {}, Scale(1e-3, "", "missing")),
        (Header(7), {}, Scale(1e-3, "", "missing")),
        (Header(7), {"default": "mm"}, Scale(1e-3, "", "missing")),  # the file does state one, a wrong one
    ],
)
def test_the_factor_wins_over_the_user_the_user_over_the_file_the_file_over_the_default(
    header: Header, stated: dict[str, object], expected: Scale
) -> None:
    assert choose(header, **stated) == expected  # type: ignore[arg-type]


@pytest.mark.parametrize("factor", [0.0, -1e-3, float("nan"), float("inf")])
def test_a_factor_that_is_not_a_positive_number_is_refused(factor: float) -> None:
    with pytest.raises(DrawingError, match="not a positive number"):
        choose(MM, metres_per_unit=factor)


@pytest.mark.parametrize("stated", [{"unit": "ell"}, {"default": "ell"}])
def test_an_unknown_unit_is_refused(stated: dict[str, str]) -> None:
    with pytest.raises(DeltacamError, match="ell"):
        choose(NONE, unit=stated.get("unit"), default=stated.get("default"))


@pytest.mark.parametrize("code", range(1, 25))
def test_every_code_of_the_format_has_its_length_or_a_reason(code: int) -> None:
    chosen = choose(Header(code))
    if chosen.source == "header":
        assert chosen.metres == pytest.approx(PER_METRE[code] ** -1, rel=1e-8)
        return
    assert code not in PER_METRE
    finding = only(about(Header(code), 100.0, 50.0))
    assert finding.blocks
    assert f"($INSUNITS = {code}), is not one that a part is drawn in: it is 100 x 50 mm" in finding.what


@pytest.mark.parametrize("code", [25, -1, 70, 10**6])
def test_a_code_that_does_not_exist_blocks(code: int) -> None:
    finding = only(about(Header(code), 100.0, 50.0))
    assert (finding.kind, finding.blocks) == ("units", True)
    assert f"$INSUNITS = {code}, does not exist" in finding.what


@pytest.mark.parametrize(
    ("width", "height", "what", "hint"),
    [
        (206.0, 381.5, "206 x 381.5 mm if its unit is mm, 5232.4 x 9690.1 mm if it is inch", "--units mm"),
        (6.38, 4.98, "6.38 x 4.98 mm if its unit is mm, 162.052 x 126.492 mm if it is inch", "--units in"),
        (843.17, 841.89, "21384 mm if it is inch, 297.452 x 297 mm if it is pt (1/72 inch)", "--units pt"),
        (0.2, 0.3, "5.08 x 7.62 mm if it is inch, 200 x 300 mm if it is m", "--units m"),
        (1e9, 2e9, "1e+09 x 2e+09 mm if its unit is mm", "--units mm"),
    ],
)
def test_a_missing_unit_blocks_and_proposes_the_one_that_would_fit(
    width: float, height: float, what: str, hint: str
) -> None:
    finding = only(about(NONE, width, height))
    assert (finding.kind, finding.blocks) == ("units", True)
    assert finding.what.startswith("the drawing states no unit: it is ")
    assert what in finding.what
    assert finding.hint == f"state the unit: {hint}"


@pytest.mark.parametrize(
    ("header", "clue"),
    [
        (Header(0, measurement=1), "metric, $MEASUREMENT = 1"),
        (Header(None, measurement=0), "inch, $MEASUREMENT = 0"),
        (Header(None, measurement=0, lunits=4), "feet and inches: $LUNITS = 4"),
        (Header(0, measurement=1, lunits=2), "metric, $MEASUREMENT = 1"),
    ],
)
def test_what_the_header_gives_away_is_a_hint_and_never_a_unit(header: Header, clue: str) -> None:
    assert choose(header).source == "missing"
    assert clue in only(about(header, 100.0, 50.0)).hint


def test_a_missing_unit_of_a_drawing_without_curves_is_said_without_a_size() -> None:
    assert only(findings(choose(NONE), None, NONE)).what == "the drawing states no unit"
    assert only(findings(choose(NONE), (0.0, 0.0), NONE)).what == "the drawing states no unit"


def test_a_unit_from_the_settings_is_named() -> None:
    finding = only(about(NONE, 100.0, 50.0, default="mm"))
    assert finding.what == "the file states no unit: it is read in mm as deltacam.toml says"
    assert (finding.kind, finding.blocks) == ("units", False)


@pytest.mark.parametrize(("code", "name", "hint"), [(4, "mm", True), (21, "US survey foot", True), (7, "kilometre", 0)])
def test_a_file_that_says_another_unit_than_the_user_is_named(code: int, name: str, hint: bool) -> None:
    finding = only(about(Header(code), 10.0, 5.0, unit="ft" if code == 21 else "in"))
    assert f"the file says its unit is {name}, but it is read in" in finding.what
    assert (finding.kind, finding.blocks, bool(finding.hint)) == ("units", False, bool(hint))


@pytest.mark.parametrize("header", [INCH, NONE, Header(0)])
def test_a_user_who_agrees_with_the_file_hears_nothing(header: Header) -> None:
    assert about(header, 10.0, 5.0, unit="in") == ()


@pytest.mark.parametrize(("header", "width"), [(MM, 10.0), (MM, 2500.0), (INCH, 40.0), (INCH, 0.5), (Header(5), 100.0)])
def test_a_usual_size_leaves_nothing_to_say(header: Header, width: float) -> None:
    assert about(header, width, width / 2) == ()


@pytest.mark.parametrize(
    ("header", "width", "sizes", "unit"),
    [
        (INCH, 96.0, "96 x 48 mm if it were mm", "mm"),
        (INCH, 340.0, "340 x 170 mm if it were mm", "mm"),
        (Header(2), 30.0, "30 x 15 mm if it were mm, 762 x 381 mm if it were inch", "mm"),
        (Header(5), 900.0, "900 x 450 mm if it were mm", "mm"),
        (Header(6), 2.0, "50.8 x 25.4 mm if it were inch, 20 x 10 mm if it were cm", "in"),
    ],
)
def test_a_large_part_in_a_large_unit_is_doubted_and_still_planned(
    header: Header, width: float, sizes: str, unit: str
) -> None:
    finding = only(about(header, width, width / 2))
    assert (finding.kind, finding.blocks) == ("units", False)
    assert sizes in finding.what
    assert finding.hint == f"state the unit: --units {unit} if the unit is wrong"


@pytest.mark.parametrize(
    ("header", "width", "sizes"),
    [
        (MM, 6.38, "162.052 x 81.026 mm if it were inch, 63.8 x 31.9 mm if it were cm, 6380 x 3190 mm if it were m"),
        (INCH, 0.2, "200 x 100 mm if it were m"),
        (Header(13), 5000.0, "5000 x 2500 mm if it were mm"),
        (Header(8), 11811.0, "299.999 x 150 mm if it were mil"),
    ],
)
def test_a_small_part_is_named_with_its_other_sizes(header: Header, width: float, sizes: str) -> None:
    finding = only(about(header, width, width / 2))
    assert (finding.kind, finding.blocks) == ("size", False)
    assert sizes in finding.what


@pytest.mark.parametrize(("header", "width"), [(MM, 12000.0), (INCH, 400.0), (Header(6), 300.0), (MM, 0.05)])
def test_an_absurd_size_blocks_until_the_user_states_the_unit(header: Header, width: float) -> None:
    finding = only(about(header, width, width / 2))
    assert (finding.kind, finding.blocks) == ("size", True)
    name = choose(header).name
    assert f"--units {name} if the size is right" in finding.hint
    stated = only(about(header, width, width / 2, unit=name))
    assert (stated.kind, stated.blocks) == ("size", False)


def test_what_the_user_states_is_doubted_only_where_it_is_absurd() -> None:
    assert about(NONE, 3.0, 2.0, unit="mm") == ()
    assert about(NONE, 96.0, 48.0, unit="in") == ()
    assert about(NONE, 0.05, 0.02, unit="mm") != ()


def test_a_size_that_is_absurd_in_every_unit_still_has_a_hint() -> None:
    finding = only(about(Header(8), 1e12, 1e12))
    assert finding.blocks
    assert finding.hint == "draw it again in mm"


def test_an_exact_factor_leaves_nothing_to_say() -> None:
    assert findings(choose(INCH, metres_per_unit=1.0), (1e3, 1e3), INCH) == ()


@pytest.mark.parametrize(
    ("name", "header"),
    [
        ("wrench-inch", Header(1, 0, 2)),
        ("channel-bulge-inch", Header(1, 1, 3)),
        ("gear-unitless", Header(0, None, 2)),
        ("eco-user-kicad", Header(None, 1, None)),
        ("box-end-openscad", Header()),
    ],
)
def test_only_what_the_file_itself_says_is_its_header(name: str, header: Header) -> None:
    path = FILES / f"{name}.dxf"
    assert scale.read_header(ezdxf.readfile(path), path.read_bytes()) == header


def test_a_header_with_text_in_place_of_a_number_says_nothing() -> None:
    document = SimpleNamespace(header={"$INSUNITS": "4", "$MEASUREMENT": (1.0, 2.0), "$LUNITS": 2})
    assert scale.read_header(document, b"$INSUNITS $MEASUREMENT $LUNITS") == Header(None, None, 2)
