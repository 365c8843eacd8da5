"""The report in a browser: it draws, it answers, it fetches nothing, and nothing in a drawing can make it act."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import ezdxf
import numpy as np
import pytest

from deltacam.model import Drawing
from deltacam.pipeline import plan_to_folder
from deltacam.program.program import Program
from deltacam.report.html import to_html
from deltacam.report.motion import deviations, motion_of
from deltacam.report.page import plotly_js
from deltacam.verification.energy import line_energy
from deltacam.verification.evidence import Evidence, gather
from deltacam.verification.verify import verify
from tests.bench import Bench
from tests.report import browser as browsers
from tests.report.browser import Browser
from tests.report.test_html import HOSTILE, hostile

pytestmark = pytest.mark.skipif(
    browsers.BROWSER is None or browsers.DRIVER is None,
    reason="needs chromium and chromedriver: apt-get install chromium chromium-driver",
)

FIGURES = ("part", "workspace", "motion", "deviation")


@dataclass(frozen=True)
class Shown:
    """A page on disk, and what it is of."""

    path: Path
    evidence: Evidence
    drawing: Drawing


@pytest.fixture(scope="module")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    found = Browser(tmp_path_factory.mktemp("profile"))
    yield found
    found.close()


@pytest.fixture(scope="module")
def shown(bench: Bench, tmp_path_factory: pytest.TempPathFactory) -> Shown:
    """The page of a program that is 30 um off at one setpoint."""
    program = bench.shifted_outwards(bench.program(), 30e-6)
    report = verify(program, drawing=bench.drawing)
    path = tmp_path_factory.mktemp("page") / "plate.report.html"
    path.write_text(to_html(report, program, drawing=bench.drawing, title="plate"), encoding="utf-8")
    return Shown(path, gather(program, program.robot), bench.drawing)


def ranges(chromium: Browser, figure: str) -> list[float]:
    return [float(end) for end in chromium.run(f"return {figure}._fullLayout.xaxis.range")]


def drawn(chromium: Browser, figure: str, series: int) -> tuple[np.ndarray, np.ndarray]:
    """The points of a line, which may be thinned."""
    x, y = chromium.run(f"const line = {figure}.data[{series}]; return [[...line.x], [...line.y]]")
    return np.array(x, dtype=float), np.array(y, dtype=float)


def test_the_pictures_are_drawn_and_nothing_is_fetched_or_complained_about(chromium: Browser, shown: Shown) -> None:
    chromium.open(shown.path)
    for figure in FIGURES:
        lines = chromium.run(
            f"return {figure}.querySelectorAll('path.js-line, path.js-fill, .point, .contourlevel').length"
        )
        assert lines > 0, figure
    assert chromium.run("return document.querySelector('.still').offsetHeight") == 0
    assert chromium.problems() == []
    assert chromium.requests() == {shown.path.as_uri()}


def test_no_button_of_a_picture_sends_anything_anywhere(chromium: Browser, shown: Shown) -> None:
    chromium.open(shown.path)
    titles = chromium.run("return [...document.querySelectorAll('.modebar-btn')].map((b) => b.dataset.title)")
    assert set(titles) == {"Zoom", "Pan", "Zoom in", "Zoom out", "Reset axes"}


def test_pointing_at_the_path_tells_the_values_of_the_nearest_tick(chromium: Browser, shown: Shown) -> None:
    chromium.open(shown.path)
    tick = shown.evidence.runs[1].first + 40
    x, y = 1e3 * shown.evidence.sheet[tick]
    words = chromium.point("part", x, y)
    assert words["tick"] == str(tick)
    assert words["time"] == f"{tick / 400.0:.4f} s"
    assert words["x, y"] == f"{x:.3f}, {y:.3f} mm"
    speed = 1e3 * motion_of(shown.evidence).speed[tick]
    assert float(words["speed"].removesuffix(" mm/s")) == pytest.approx(speed, rel=1e-3)
    energy = line_energy(shown.evidence)[tick]
    assert float(words["energy per mm"].partition(" ")[0]) == pytest.approx(energy, rel=1e-3)
    deviation = 1e6 * deviations(shown.evidence, shown.drawing)[tick]
    assert float(words["deviation"].removesuffix(" µm")) == pytest.approx(deviation, abs=1e-3)
    assert (words["does"], words["contour"], words["layer"], words["handle"]) == ("cut", "3", "CUT", "#3A")
    assert chromium.point("part", -25.0, -14.0) == {}


def test_a_time_in_the_charts_is_a_place_on_the_part_and_the_other_way_round(chromium: Browser, shown: Shown) -> None:
    chromium.open(shown.path)
    tick = shown.evidence.runs[2].first + 30
    words = chromium.point("motion", tick / 400.0)
    assert abs(int(words["tick"]) - tick) <= 2  # a pixel is more than a tick
    x, y = 1e3 * shown.evidence.sheet[int(words["tick"])]
    assert re.fullmatch(r"\S+°, \S+°/s, \S+°/s², \S+°/s³", words["joint 2"])
    mark = "const dot = part.querySelector('.over .tool'); return [dot.getAttribute('cx'), dot.getAttribute('cy')]"
    place = "const {xaxis: x, yaxis: y} = part._fullLayout; return [x._offset + x.d2p(%r), y._offset + y.d2p(%r)]"
    at = [float(value) for value in chromium.run(mark)]
    assert at == pytest.approx(chromium.run(place % (float(x), float(y))), abs=0.1)
    other = shown.evidence.runs[0].first + 20
    chromium.point("part", *(1e3 * shown.evidence.sheet[other]).tolist())
    line = chromium.run("return motion.querySelector('.over .time').getAttribute('d')")
    wanted = chromium.run(f"const x = motion._fullLayout.xaxis; return x._offset + x.d2p({other / 400.0})")
    assert float(re.match(r"M([\d.]+) ", line)[1]) == pytest.approx(wanted, abs=0.1)
    assert chromium.run("return document.querySelectorAll('#workspace .over .upperarm').length") == 3
    assert chromium.run("return document.getElementById('time').value") == str(other)


def test_zooming_into_a_time_shows_every_setpoint(chromium: Browser, shown: Shown) -> None:
    chromium.open(shown.path)
    speed = 1e3 * motion_of(shown.evidence).speed
    series = next(i for i in range(20) if chromium.run(f"return motion.data[{i}].yaxis") == "y2")
    x, y = drawn(chromium, "motion", series)
    assert len(x) < len(speed)
    assert y.max() == pytest.approx(speed.max(), rel=1e-5)
    chromium.drag("motion", 1.0, 2.0)
    left, right = ranges(chromium, "motion")
    assert (left, right) == pytest.approx((1.0, 2.0), abs=0.02)
    x, y = drawn(chromium, "motion", series)
    inside = (x >= left) & (x <= right)
    ticks = np.rint(x[inside] * 400.0).astype(int)
    assert ticks.tolist() == list(range(ticks[0], ticks[-1] + 1))
    assert len(ticks) == pytest.approx(400.0 * (right - left), abs=2)
    assert y[inside] == pytest.approx(speed[ticks], rel=1e-5, abs=1e-3)


def test_scrolling_zooms_the_part_until_its_setpoints_are_seen(chromium: Browser, shown: Shown) -> None:
    chromium.open(shown.path)
    x, y = 1e3 * shown.evidence.sheet[shown.evidence.runs[1].first + 40]
    left, top = chromium.run(browsers.PLACE, "part", float(x), float(y))
    before = np.ptp(ranges(chromium, "part"))
    dots = "return part.data.find((trace) => trace.marker?.size === 3.5).x.length"
    assert chromium.run(dots) == 0
    for _ in range(50):
        if chromium.run(dots):
            break
        chromium.command("Input.dispatchMouseEvent", type="mouseWheel", x=left, y=top, deltaX=0, deltaY=-240)
        chromium.run("return new Promise((done) => setTimeout(done, 60))")
    assert np.ptp(ranges(chromium, "part")) < 0.8 * before
    assert chromium.run(dots) > 0


def test_zooming_in_shows_more_arrows_and_keeps_the_numbers(chromium: Browser, shown: Shown) -> None:
    chromium.open(shown.path)
    marks = """
    const trace = (test) => part.data.find((one) => test(one) && one.x.length);
    return [trace((one) => one.marker?.symbol === "arrow").x.length, trace((one) => one.text).text.length]
    """
    arrows, numbers = chromium.run(marks)
    assert arrows >= 4
    assert numbers == 4
    zoom = "return Plotly.relayout(part, {'xaxis.range': [-20, 0], 'yaxis.range': [-10, 10]}).then(() => 0)"
    chromium.run(zoom)
    assert chromium.run(marks)[0] > arrows
    assert chromium.run(marks)[1] == numbers
    shapes = chromium.run("return part.querySelectorAll('.point').length")
    assert shapes >= chromium.run(marks)[0] / 2
    chromium.run("return Plotly.relayout(part, {'xaxis.range': [-400, 400]}).then(() => 0)")
    assert chromium.run("return part.data.some((one) => one.marker?.symbol === 'arrow' && one.x.length)") is False
    words = chromium.run("return [...document.querySelectorAll('.looks li')].map((one) => one.textContent)")
    assert words == ["cut", "rapid", "pierce, in order", "direction"]
    assert chromium.problems() == []


def test_the_path_is_coloured_by_what_is_chosen(chromium: Browser, shown: Shown) -> None:
    chromium.open(shown.path)
    seen = {}
    for name in ("Deviation", "Limit", "Energy", "Speed"):
        chromium.run(
            "[...document.querySelectorAll('#colours button')].find((b) => b.textContent === arguments[0]).click()",
            name,
        )
        colours = chromium.run("return [...part.querySelectorAll('path.js-line')].map((line) => line.style.stroke)")
        seen[name] = set(colours)
        pressed = chromium.run("return document.querySelector('#colours [aria-pressed=true]').textContent")
        assert pressed == name
        assert chromium.run("return document.querySelectorAll('#legend li').length") > 3
    assert "rgb(229, 32, 46)" in seen["Deviation"]
    assert len({frozenset(colours) for colours in seen.values()}) == 4


def test_the_row_of_a_failed_check_leads_to_its_place(chromium: Browser, shown: Shown) -> None:
    chromium.open(shown.path)
    rows = "[...document.querySelectorAll('tr')].find((row) => row.textContent.startsWith(arguments[0]))"
    chromium.run(f"{rows}.querySelector('button').click()", "deviation at ticks")
    row = int(np.nanargmax(deviations(shown.evidence, shown.drawing)))
    x = 1e3 * shown.evidence.sheet[row, 0]
    left, right = ranges(chromium, "part")
    assert left < x < right
    assert right - left < 25.0
    assert chromium.run("return getComputedStyle(part.querySelector('.over .mark')).display") != "none"
    assert chromium.run("return document.getElementById('time').value") == str(row)


def test_the_program_plays(chromium: Browser, shown: Shown) -> None:
    chromium.open(shown.path)
    chromium.run("play.click(); return new Promise((done) => setTimeout(done, 400))")
    assert 40 < int(chromium.run("const at = document.getElementById('time').value; play.click(); return at")) < 800
    assert chromium.run("return play.textContent") == "Play"


@pytest.mark.parametrize("width", [390, 768, 1280])
def test_no_width_makes_the_page_scroll_sideways(chromium: Browser, shown: Shown, width: int) -> None:
    chromium.open(shown.path, width=width)
    assert chromium.run("return document.documentElement.scrollWidth") <= width
    for figure in FIGURES:
        assert chromium.run(f"return {figure}.querySelector('.main-svg').clientWidth") <= width, figure


def test_a_swipe_is_left_to_the_page_and_a_tap_tells_the_values(chromium: Browser, shown: Shown) -> None:
    chromium.open(shown.path, width=390)
    left, top = chromium.run(browsers.PLACE, "motion", 2.0, None)
    touch = """
    const under = document.elementFromPoint(arguments[0], arguments[1]);
    const fingers = [new Touch({identifier: 1, target: under, clientX: arguments[0], clientY: arguments[1]})];
    const event = {touches: fingers, changedTouches: fingers, bubbles: true, cancelable: true};
    return [under.getAttribute("class"), under.dispatchEvent(new TouchEvent("touchstart", event))];
    """
    under, left_alone = chromium.run(touch, left, top)
    assert "drag" in under
    assert left_alone
    chromium.command("Input.synthesizeTapGesture", x=left, y=top)
    assert abs(int(chromium.words()["tick"]) - 800) < 12


def test_in_the_dark_every_text_is_light_and_in_the_light_dark(chromium: Browser, shown: Shown) -> None:
    script = """
    const light = (colour) => colour.match(/\\d+/g).slice(0, 3).map(Number).reduce((a, b) => a + b) / 765;
    const texts = [...document.querySelectorAll('.plot text')].map((text) => light(getComputedStyle(text).fill));
    const paths = [...document.querySelectorAll('.plot path.js-line')];
    const lines = paths.map((line) => light(getComputedStyle(line).stroke));
    return [light(getComputedStyle(document.querySelector('figure.moving')).backgroundColor), texts, lines];
    """
    chromium.open(shown.path, dark=True)
    paper, texts, lines = chromium.run(script)
    assert paper < 0.2
    assert min(texts) > 0.35
    assert min(lines) > 0.22
    chromium.open(shown.path)
    paper, texts, lines = chromium.run(script)
    assert paper > 0.9
    assert max(texts) < 0.6


def test_it_prints(chromium: Browser, shown: Shown) -> None:
    chromium.open(shown.path)
    pdf = chromium.pdf()
    assert pdf.startswith(b"%PDF")
    assert len(pdf) > 50_000
    width = "return motion._fullLayout.width"
    wide = chromium.run(width)
    chromium.run("window.dispatchEvent(new Event('beforeprint'))")
    assert chromium.run(width) == 660  # an A4 page has 718 pixels between its margins
    chromium.run("window.dispatchEvent(new Event('afterprint'))")
    assert chromium.run(width) == wide > 1000


def test_names_in_a_program_do_nothing(chromium: Browser, bench: Bench, tmp_path: Path) -> None:
    report, program, drawing = hostile(bench)
    path = tmp_path / "hostile.html"
    path.write_text(to_html(report, program, drawing=drawing, title=HOSTILE), encoding="utf-8")
    chromium.open(path)
    run = gather(program, program.robot).runs[1]
    words = chromium.point("part", *(1e3 * gather(program, program.robot).sheet[run.first + 40]).tolist())
    assert words["layer"].startswith("</style></title><script>alert(1)</script>\"'")
    assert chromium.run("return [window.dialogs, document.scripts.length]") == [0, 3]
    assert chromium.problems() == []
    assert chromium.requests() == {path.as_uri()}


def test_names_in_a_drawing_do_nothing(chromium: Browser, tmp_path: Path) -> None:
    layer = "x' onload %{x} &lt &amp"  # < > = ; " may not be in the name of a layer
    drawing = ezdxf.new(units=ezdxf.units.MM)
    drawing.layers.add(layer)
    drawing.modelspace().add_circle((0, 0), 10.0, dxfattribs={"layer": layer})
    source = tmp_path / "<img src=x onerror=window.pwned=1>&'\"{}.dxf"
    drawing.saveas(source)
    planned, outputs = plan_to_folder(source, tmp_path / "out")
    assert planned.report.passed
    chromium.open(outputs.report_html)
    evidence = gather(planned.program, planned.program.robot)
    words = chromium.point("part", *(1e3 * evidence.sheet[evidence.runs[0].first + 40]).tolist())
    assert words["layer"] == layer
    assert chromium.run("return [typeof window.pwned, window.dialogs]") == ["undefined", 0]
    assert chromium.problems() == []


def test_short_and_lost_programs_have_their_pictures(chromium: Browser, program: Program, tmp_path: Path) -> None:
    few = [
        replace(program, q=program.q[:rows], power=program.power[:rows], block=program.block[:rows]) for rows in (1, 3)
    ]
    lost = replace(program, q=np.where(np.arange(len(program.q))[:, None] == 3, 3.0, program.q))
    for one in (*few, lost):
        path = tmp_path / "page.html"
        path.write_text(to_html(verify(one, drawing=None), one, drawing=None, title="plate"), encoding="utf-8")
        chromium.open(path)
        assert chromium.run("return motion.querySelectorAll('path.js-line').length") > 0
        assert chromium.problems() == []


def test_pages_may_share_one_copy_of_the_library(chromium: Browser, program: Program, tmp_path: Path) -> None:
    (tmp_path / "plotly.min.js").write_text(plotly_js(), encoding="utf-8")
    path = tmp_path / "page.html"
    report = verify(program, drawing=None)
    path.write_text(to_html(report, program, drawing=None, title="plate", library="plotly.min.js"), encoding="utf-8")
    assert path.stat().st_size < 1_000_000
    chromium.open(path)
    assert chromium.run("return part.querySelectorAll('path.js-line').length") > 0
    assert chromium.problems() == []
