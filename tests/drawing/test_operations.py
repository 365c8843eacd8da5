"""Which operation is for which entity."""

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.drawing.operations import Choice, assign, check_patterns, matches
from deltacam.errors import DrawingError
from deltacam.model import Operation, Rule, Selection

CUT, ENGRAVE, IGNORE = Operation.CUT, Operation.ENGRAVE, Operation.IGNORE


@dataclass(frozen=True)
class Look:
    layer: str = "0"
    color: int = 7
    linetype: str = "CONTINUOUS"


def choice(look: Look, selection: Selection) -> Choice:
    (only,) = assign([look], selection).choices
    return only


@pytest.mark.parametrize(
    "layer",
    [
        "ENGRAVE",
        "Engraving",
        "laser_engrave",
        "TEXT ENGRAVED",
        "01-Engrave",
        "Gravur",
        "GRAVURE_TEXTE",
        "gravieren",
        "ETCH",
        "Etching",
        "Laser-Etch",
        "SCORE",
        "score_lines",
        "V-SCORE",
        "Scoring",
        "MARK",
        "Mark text",
        "Marking",
        "IV_MARK_SURFACE",
    ],
)
def test_a_layer_that_says_engrave_is_engraved_where_nobody_says_otherwise(layer: str) -> None:
    assert choice(Look(layer), Selection()) == Choice(ENGRAVE, ENGRAVE)


@pytest.mark.parametrize(
    "layer",
    [
        "0",
        "CUT",
        "SKETCH",
        "Sketch Geometry (ANSI)",
        "IV_UNCONSUMED_SKETCHES",
        "STRETCH",
        "UNDERSCORE",
        "SCOREBOARD",
        "MARKETING",
        "BENCHMARK",
        "MARKER",
        "Center_Marks",
        "CENTERMARK",
        "IV_MARK_THROUGH",
        "REMARKS",
        "GRAVEL",
        "IV_BEND",
    ],
)
def test_a_layer_that_only_sounds_like_it_is_cut_and_its_open_lines_are_ignored(layer: str) -> None:
    assert choice(Look(layer), Selection()) == Choice(CUT, IGNORE)


def test_what_cad_programs_never_plot_is_ignored() -> None:
    assert choice(Look("Defpoints"), Selection()) == Choice(IGNORE, IGNORE, "the process ignores layer Defpoints")


def test_the_first_rule_that_fits_in_everything_it_names_counts() -> None:
    rules = (
        Rule(IGNORE, layer="A*", color=1, linetype="dash*"),
        Rule(ENGRAVE, color=1, open=CUT),
        Rule(CUT, layer="a?", open=ENGRAVE),
    )
    selection = Selection(rules=rules, open=CUT)
    reason = "the process ignores layer A1 with color 1 and line type DASHED2"
    assert choice(Look("A1", 1, "DASHED2"), selection) == Choice(IGNORE, IGNORE, reason)
    assert choice(Look("A1", 1, "DOT"), selection) == Choice(ENGRAVE, CUT)
    assert choice(Look("A1", 2, "DASHED2"), selection) == Choice(CUT, ENGRAVE)
    assert choice(Look("A12", 2), selection) == Choice(CUT, CUT)


@pytest.mark.parametrize(
    ("rule", "reason"),
    [
        (Rule(IGNORE, color=3), "the process ignores color 3"),
        (Rule(IGNORE, layer="*", linetype="*"), "the process ignores layer X with line type DOT"),
        (Rule(IGNORE), "the process ignores everything else"),
    ],
)
def test_the_reason_says_what_made_the_rule_fit(rule: Rule, reason: str) -> None:
    assert choice(Look("X", 3, "DOT"), Selection(rules=(rule,))).reason == reason


def test_layers_that_were_not_asked_for_are_ignored_whatever_the_rules_say() -> None:
    selection = Selection(layers=("CUT*", "ENGRAVE"), ignored_layers=("cut-old",))
    assert choice(Look("cut1"), selection) == Choice(CUT, IGNORE)
    assert choice(Look("ENGRAVE"), selection) == Choice(ENGRAVE, ENGRAVE)
    assert choice(Look("0"), selection).reason == "layer 0 is not among --layer"
    assert choice(Look("CUT-OLD"), selection).reason == "layer CUT-OLD is ignored by --ignore-layer"


def test_every_entity_gets_its_own_choice_in_order() -> None:
    looks = [Look(layer) for layer in ("CUT", "ETCH", "CUT", "DEFPOINTS", "ETCH")]
    found = assign(looks, Selection())
    assert len(found) == 5
    assert [found[i].operation for i in range(5)] == [CUT, ENGRAVE, CUT, IGNORE, ENGRAVE]
    assert found.of(ENGRAVE).tolist() == [False, True, False, False, True]
    assert np.all(found.of(CUT) | found.of(ENGRAVE) | found.of(IGNORE))
    assert len(assign([], Selection())) == 0


def test_the_rules_are_asked_once_per_look_not_per_entity(monkeypatch: pytest.MonkeyPatch) -> None:
    from deltacam.drawing import operations

    asked = []
    choose = operations._choose
    monkeypatch.setattr(operations, "_choose", lambda *look: asked.append(look) or choose(*look))
    assign([Look("A", color) for color in range(1, 6)] * 1000, Selection())
    assert len(asked) == 5


def fits(pattern: str, name: str) -> bool:
    """Letter by letter."""
    if not pattern:
        return not name
    if pattern[0] == "*":
        return fits(pattern[1:], name) or (bool(name) and fits(pattern, name[1:]))
    return bool(name) and pattern[0] in {"?", name[0]} and fits(pattern[1:], name[1:])


@given(st.text("aB*?[]!.x", max_size=7), st.text("abB[]!.x", max_size=7))
def test_stars_and_question_marks_are_wild_and_nothing_else(pattern: str, name: str) -> None:
    assert matches(pattern, name) == fits(pattern.lower(), name.lower())


@pytest.mark.parametrize(
    ("pattern", "name"),
    [("CUT, ETCH*", "Etching"), ("a,b", "B"), ("a,b", "A,B"), ("TEIL (1)+", "Teil (1)+"), ("*A*", "x\nay")],
)
def test_commas_separate_patterns_and_a_name_fits_itself(pattern: str, name: str) -> None:
    assert matches(pattern, name)
    assert not matches(pattern, f"{name}-") or "*" in pattern


def test_many_stars_are_not_slow() -> None:
    assert not matches("*a" * 12 + "*b", "a" * 60)


def test_a_pattern_that_fits_no_layer_is_refused_with_the_layers_that_there_are() -> None:
    layers = ["CUT", "Engrave", "0"]
    check_patterns(Selection(layers=("cut", "eng*,0"), ignored_layers=("?",)), layers)
    for selection, what, where in (
        (Selection(layers=("cut", "ENGRAV")), "no layer of the drawing is called 'ENGRAV'", "--layer"),
        (Selection(ignored_layers=("Engrave,X*",)), "no layer fits 'X*'", "--ignore-layer"),
    ):
        with pytest.raises(DrawingError) as caught:
            check_patterns(selection, layers)
        assert (caught.value.what, caught.value.where) == (what, where)
        assert "the drawing has 'CUT', 'Engrave', '0'" in caught.value.hint


def test_the_layer_that_was_probably_meant_comes_first_and_many_are_cut_off() -> None:
    with pytest.raises(DrawingError) as caught:
        check_patterns(Selection(layers=("LAYER-7X",)), [f"LAYER-{n}" for n in range(50)])
    assert caught.value.hint.startswith("did you mean 'LAYER-7'? ")
    assert caught.value.hint.endswith("and 30 more")
