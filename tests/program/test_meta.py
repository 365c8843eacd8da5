"""How a drawing was read is in the program, and comes back out of it."""

import copy
import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from deltacam.errors import ProgramError
from deltacam.model import Drawing, Operation, Rule, Selection
from deltacam.program.meta import from_meta, to_meta
from deltacam.program.program import DrawingRef, Program

Change = Callable[[dict[str, Any]], object]


def through_json(program: Program) -> dict[str, Any]:
    values: dict[str, Any] = json.loads(json.dumps(to_meta(program, sha256="00")))
    return values


def test_rules_and_selection_come_back_as_they_were(program: Program) -> None:
    found = from_meta(through_json(program), "here")
    assert found.process == program.process
    assert found.drawing == program.drawing


def test_what_a_process_does_not_say_stays_unsaid(program: Program) -> None:
    process = replace(program.process, rules=(), engrave_feed=None, engrave_power=None)
    assert from_meta(through_json(replace(program, process=process)), "here").process == process


def test_a_program_knows_how_its_drawing_is_to_be_read_again(program: Program) -> None:
    selection = Selection(
        rules=(Rule(Operation.IGNORE, color=3),),
        open=Operation.CUT,
        layers=("A",),
        ignored_layers=("B*",),
        joining=2e-5,
        accept_loss=True,
    )
    drawing = Drawing("a.dxf", "cd" * 32, 1e-3, "mm", "header", (), (), selection=selection)
    process = replace(program.process, rules=selection.rules, open=selection.open)
    planned = replace(program, drawing=DrawingRef.of(drawing), process=process)
    assert planned.selection == selection
    assert (planned.drawing.file, planned.drawing.sha256) == ("a.dxf", "cd" * 32)
    assert planned.drawing.metres_per_unit == 1e-3


WRONG: dict[str, tuple[Change, str, str]] = {
    "a program from before": (lambda m: m["drawing"].pop("joining_m"), "drawing", "missing joining_m"),
    "rules from before": (lambda m: m["process"].pop("rules"), "process", "missing rules"),
    "no list of rules": (lambda m: m["process"].update(rules={}), "process", "rules is not a list"),
    "a rule with another key": (
        lambda m: m["process"]["rules"][1].update(tabs=1),
        "process, rules 1",
        "unknown 'tabs'",
    ),
    "a rule without a key": (lambda m: m["process"]["rules"][0].pop("open"), "process, rules 0", "missing open"),
    "an unknown operation": (
        lambda m: m["process"]["rules"][0].update(operation="weld"),
        "process, rules 0",
        "unknown operation 'weld'",
    ),
    "color 256": (
        lambda m: m["process"]["rules"][0].update(color=256),
        "process, rules 0",
        "color is outside 1 to 255",
    ),
    "a layer of nothing": (
        lambda m: m["process"]["rules"][0].update(layer=""),
        "process, rules 0",
        "0 characters",
    ),
    "an unknown way for open lines": (lambda m: m["process"].update(open="burn"), "process", "unknown open 'burn'"),
    "engraving at no speed": (lambda m: m["process"].update(engrave_feed=0), "process", "engrave_feed is outside"),
    "engraving with double power": (
        lambda m: m["process"].update(engrave_power=2),
        "process",
        "engrave_power is outside 0 to 1",
    ),
    "layers a text": (lambda m: m["drawing"].update(layers="CUT"), "drawing", "layers is not a list"),
    "joining over a metre": (lambda m: m["drawing"].update(joining_m=2), "drawing", "joining_m is outside 0 to 1"),
    "loss a number": (lambda m: m["drawing"].update(accept_loss=1), "drawing", "accept_loss is not true or false"),
}


@pytest.mark.parametrize("damage", WRONG)
def test_what_is_wrong_is_refused_with_its_place(program: Program, damage: str) -> None:
    change, where, what = WRONG[damage]
    values = copy.deepcopy(through_json(program))
    change(values)
    with pytest.raises(ProgramError, match=what) as caught:
        from_meta(values, "line 2")
    assert caught.value.where == f"line 2, {where}"


def test_a_file_from_before_says_what_to_do(program: Program) -> None:
    values = through_json(program)
    del values["drawing"]["layers"]
    with pytest.raises(ProgramError) as caught:
        from_meta(values, "line 2")
    assert "plan the drawing again" in caught.value.hint
