"""``deltacam inspect`` as a user meets it."""

import json
import re
import shlex
from pathlib import Path
from xml.etree import ElementTree

import ezdxf
import pytest

from tests.cli.test_main import DXF, deltacam


def drawn(path: Path, *, layers: tuple[str, ...] = ("A", "B")) -> Path:
    """A DXF file with a square of 10 mm on each layer."""
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    for i, layer in enumerate(layers):
        corners = [(20 * i, 0), (20 * i + 10, 0), (20 * i + 10, 10), (20 * i, 10)]
        document.modelspace().add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})
    document.saveas(path)
    return path


def listed(folder: Path, *arguments: str | Path) -> dict:
    run = deltacam("inspect", *arguments, "--json", folder=folder)
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


def test_a_drawing_is_shown_without_being_planned(tmp_path: Path) -> None:
    run = deltacam("inspect", DXF / "wrench-inch.dxf", folder=tmp_path)
    assert (run.returncode, run.stderr) == (0, "")
    assert "unit     in (header)" in run.stdout
    assert "82.57 x 23.79 mm" in run.stdout
    assert "1 outer, 1 inner, 0 open" in run.stdout
    assert list(tmp_path.iterdir()) == []


def test_the_command_that_it_proposes_plans_the_drawing(tmp_path: Path) -> None:
    drawing = drawn(tmp_path / "my part.dxf")
    run = deltacam("inspect", drawing.name, "--ignore-layer", "B", "--join", "0.02", folder=tmp_path)
    proposed = shlex.split(run.stdout.splitlines()[-1].removeprefix("next: "))
    assert proposed == ["deltacam", "plan", "my part.dxf", "--ignore-layer", "B", "--join", "0.02"]
    assert deltacam(*proposed[1:], folder=tmp_path).returncode == 0


def test_a_drawing_that_plan_refuses_is_shown_with_the_reason(tmp_path: Path) -> None:
    drawing = DXF / "motor-lock-wrong-units.dxf"
    run = deltacam("inspect", drawing, folder=tmp_path)
    assert run.returncode == 0
    assert "13 inner" in run.stdout
    refused = deltacam("plan", drawing, folder=tmp_path)
    assert refused.returncode == 2
    reason = re.search(r"it crosses contour \d+", refused.stderr)
    assert reason
    assert re.search(rf"plan will refuse: .*{reason[0]}", run.stdout)


def test_without_a_unit_the_sizes_in_several_are_shown(tmp_path: Path) -> None:
    run = deltacam("inspect", DXF / "gear-unitless.dxf", folder=tmp_path)
    assert run.returncode == 0
    assert "32.19 x 32.02 mm if mm, 817.75 x 813.40 mm if in, 11.36 x 11.30 mm if pt" in run.stdout
    assert "plan will refuse: " in run.stdout
    assert run.stdout.rstrip().endswith("--units mm")
    found = listed(tmp_path, DXF / "gear-unitless.dxf")
    assert (found["unit"], found["unit_source"], found["metres_per_unit"]) == (None, "missing", 1e-3)
    assert listed(tmp_path, DXF / "gear-unitless.dxf", "--units", "in")["unit"] == "in"


def test_layers_are_chosen_by_their_options(tmp_path: Path) -> None:
    drawing = drawn(tmp_path / "a.dxf", layers=("A", "B", "C"))

    def machined(*options: str) -> set[str]:
        contours = listed(tmp_path, drawing, *options)["contours"]["list"]
        return {contour["layer"] for contour in contours if contour["operation"] == "cut"}

    assert machined() == {"A", "B", "C"}
    assert machined("--layer", "A", "--layer", "C") == {"A", "C"}
    assert machined("--ignore-layer", "A", "--ignore-layer", "C") == {"B"}


def test_the_rules_of_a_process_say_what_is_engraved(tmp_path: Path) -> None:
    drawing = drawn(tmp_path / "a.dxf")
    rules = 'name = "x"\nkerf_mm = 0.1\nfeed_m_min = 1.0\n[engrave]\nfeed_m_min = 2.0\npower = 0.1\n'
    (tmp_path / "own.toml").write_text(rules + '[[operations]]\nlayer = "B"\ndo = "engrave"\n')
    found = listed(tmp_path, drawing, "--process", "own.toml")
    assert [contour["operation"] for contour in found["contours"]["list"]] == ["cut", "engrave"]
    assert found["totals"] == {"entities": 2, "cut": 1, "engraved": 1, "merged": 0, "ignored": 0, "lost": 0}


def test_the_joining_distance_closes_a_gap(tmp_path: Path) -> None:
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    document.modelspace().add_lwpolyline([(0, 0.05), (0, 10), (10, 10), (10, 0), (0, 0)])
    document.saveas(tmp_path / "a.dxf")
    assert listed(tmp_path, "a.dxf")["contours"]["open"] == 1
    assert listed(tmp_path, "a.dxf", "--join", "0.1")["contours"]["closed"] == 1


def test_the_picture_is_written_beside_text_and_json(tmp_path: Path) -> None:
    run = deltacam("inspect", DXF / "wrench-inch.dxf", "--svg", "wrench.svg", folder=tmp_path)
    assert run.stdout.endswith("wrote wrench.svg\n")
    assert ElementTree.parse(tmp_path / "wrench.svg").getroot().tag.endswith("svg")  # noqa: S314 - our own file
    (tmp_path / "wrench.svg").write_text("old")
    listed(tmp_path, DXF / "wrench-inch.dxf", "--svg", "wrench.svg")
    assert "old" not in (tmp_path / "wrench.svg").read_text()
    assert [path.name for path in tmp_path.iterdir()] == ["wrench.svg"]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["none.dxf"], "no such file"),
        (["text.dxf"], "not a DXF"),
        ([str(DXF / "diamond-binary-damaged.dxf")], "binary DXF"),
        (["a.dxf", "--units", "ell"], "--units"),
        (["a.dxf", "--layer", "Z"], "layer"),
        (["a.dxf", "--join", "near"], "--join"),
        (["a.dxf", "--process", "steel"], "steel-1mm-fibre"),
        (["a.dxf", "--svg", "a.dxf"], "overwrite the drawing"),
        (["a.dxf", "--svg", "missing/a.svg"], "--svg"),
    ],
)
def test_what_leaves_nothing_to_look_at_exits_with_2(tmp_path: Path, arguments: list[str], says: str) -> None:
    before = drawn(tmp_path / "a.dxf").read_bytes()
    (tmp_path / "text.dxf").write_text("hello")
    run = deltacam("inspect", *arguments, folder=tmp_path)
    assert run.returncode == 2
    assert says in run.stderr
    assert "\nhint: " in run.stderr
    assert run.stdout == ""
    assert (tmp_path / "a.dxf").read_bytes() == before
    refused = deltacam("inspect", *arguments, "--json", folder=tmp_path)
    assert refused.returncode == 2
    assert json.loads(refused.stdout)["passed"] is False


def test_names_from_a_stranger_are_shown_but_do_nothing(tmp_path: Path) -> None:
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    document.modelspace().add_circle((0, 0), 5, dxfattribs={"layer": "STRANGE"})
    document.saveas(tmp_path / "a.dxf")
    content = (tmp_path / "a.dxf").read_text().replace("STRANGE", "\u202e</style><script>")
    (tmp_path / "a\x1b[31m.dxf").write_text(content)
    run = deltacam("inspect", "a\x1b[31m.dxf", "--svg", "a.svg", folder=tmp_path)
    assert run.returncode == 0, run.stderr
    assert "\x1b" not in run.stdout
    assert "\u202e" not in run.stdout
    picture = (tmp_path / "a.svg").read_text()
    assert "<script" not in picture
    assert not {"\x1b", "\u202e"} & set(picture)
    ElementTree.fromstring(picture)  # noqa: S314 - our own text


def test_the_users_own_defaults_count(tmp_path: Path) -> None:
    (tmp_path / "deltacam.toml").write_text('units = "in"\njoining_mm = 0.2\n')
    found = listed(tmp_path, DXF / "broken-loop.dxf")
    assert (found["unit"], found["unit_source"]) == ("in", "deltacam.toml")
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    document.modelspace().add_lwpolyline([(0, 0.15), (0, 10), (10, 10), (10, 0), (0, 0)])
    document.saveas(tmp_path / "a.dxf")
    assert listed(tmp_path, "a.dxf")["contours"]["closed"] == 1
