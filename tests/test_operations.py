"""From layers and colours to a verified program: what is drawn is cut, engraved or left out as the process says."""

from dataclasses import replace
from pathlib import Path

import ezdxf
import pytest

from deltacam.cutting.process import load_process
from deltacam.errors import DrawingError, ProcessError
from deltacam.examine import verify
from deltacam.model import Lead, Mode, Operation, Process, Rule, Selection
from deltacam.pipeline import plan, plan_to_folder


@pytest.fixture(scope="module")
def plate(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A plate with a hole, an engraved ring and angle, two slits and a stray line."""
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    space = document.modelspace()
    space.add_lwpolyline([(0, 0), (60, 0), (60, 40), (0, 40)], close=True, dxfattribs={"layer": "CUT"})
    space.add_circle((15, 20), 6, dxfattribs={"layer": "CUT"})
    space.add_circle((40, 20), 8, dxfattribs={"layer": "Engraving"})
    space.add_line((30, 5), (55, 5), dxfattribs={"layer": "Engraving"})
    space.add_line((30, 5), (30, 12), dxfattribs={"layer": "Engraving"})
    space.add_line((5, 35), (25, 35), dxfattribs={"color": 1})
    space.add_line((45, 40), (45, 32), dxfattribs={"color": 1})
    space.add_line((0, 0), (60, 40), dxfattribs={"color": 2})
    path = tmp_path_factory.mktemp("plate") / "plate.dxf"
    document.saveas(path)
    return path


@pytest.fixture(scope="module")
def process() -> Process:
    built_in = load_process("steel-1mm-fibre")
    built_in = replace(built_in, lead_in=Lead(), lead_out=Lead(), overcut=0.0)
    return replace(built_in, rules=(*built_in.rules, Rule(Operation.CUT, color=1, open=Operation.CUT)))


def test_every_line_is_run_as_its_rule_says_and_the_file_verifies(
    plate: Path, process: Process, tmp_path: Path
) -> None:
    planned, outputs = plan_to_folder(plate, tmp_path, process=process)
    assert planned.report.passed, [check for check in planned.report.checks if not check.passed]
    kinds = [block.kind for block in planned.program.blocks if block.kind != "rapid"]
    assert kinds == ["engrave"] * 2 + ["pierce", "cut"] * 4
    summary = planned.report.summary
    assert (summary["contours_cut"], summary["contours_engraved"]) == (4, 2)
    assert [finding for finding in planned.report.findings if finding.kind == "touching"]
    assert verify(outputs.program, drawing=plate).passed


def test_a_program_of_some_layers_is_checked_against_the_same_layers(plate: Path, tmp_path: Path) -> None:
    selection = Selection(layers=("cut", "engr*"), ignored_layers=("Engraving",))
    planned, outputs = plan_to_folder(plate, tmp_path, selection=selection)
    assert planned.report.passed
    assert planned.report.summary["contours_engraved"] == 0
    assert verify(outputs.program, drawing=plate).passed


@pytest.mark.parametrize("mode", [Mode.DRY_RUN, Mode.FRAME])
def test_without_the_laser_nothing_is_engraved_either(plate: Path, process: Process, mode: Mode) -> None:
    planned = plan(plate, process=process, mode=mode)
    assert planned.report.passed, [check for check in planned.report.checks if not check.passed]
    assert not planned.program.power.any()


def test_what_cannot_be_done_is_refused(plate: Path, process: Process) -> None:
    with pytest.raises(ProcessError, match="does not say how"):
        plan(plate, process=replace(process, engrave_power=None))
    with pytest.raises(DrawingError, match="'CUTT'"):
        plan(plate, process=process, selection=Selection(layers=("CUTT",)))
