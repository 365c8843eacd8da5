"""The page of a batch: complete without a script, found and sorted with one, and no name can make it act."""

from __future__ import annotations

import json
import os
import re
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import unquote_to_bytes

import pytest

from deltacam.batch.parts import Batch, Part, Result, Row, Status, Task
from deltacam.batch.planning.task import perform
from deltacam.batch.results.index import to_html
from deltacam.batch.run import run
from deltacam.cutting.process import load_process
from deltacam.robot.reader import load_robot
from tests.batch.rows import HOSTILE, facts, failed, passed, without
from tests.report import browser as browsers
from tests.report.browser import Browser
from tests.report.parsed import Page

in_browser = pytest.mark.skipif(
    browsers.BROWSER is None or browsers.DRIVER is None,
    reason="needs chromium and chromedriver: apt-get install chromium chromium-driver",
)

MIXED = Batch(
    (
        passed("a.dxf", facts=facts(time=9.0)),
        without("b/one.dxf", Status.REFUSED, "a gap of 1 mm", where="layer 0", hint="join the ends"),
        without("b/two.dxf", Status.REFUSED, "a gap of 2 mm", where="layer 1", hint="join the ends"),
        failed("c.dxf", "part size"),
        passed("d.dxf", facts=facts(time=30.0, size=None), warnings=("nearly singular", "hot")),
        without("e.dxf", Status.LEFT, "the batch was stopped before"),
        without("f.dxf", Status.TIMEOUT, "it took longer than 9 s"),
    ),
    ("old.dxf is of an earlier batch",),
)

ODD = "sub folder/50% # of \"all\"? & 'so' <b>Gehäuse.dxf"
LATIN = os.fsdecode(b"caf\xe9.dxf")


def here(tasks: Iterator[Task], *, stop: threading.Event) -> Iterator[tuple[Task, Result]]:
    """Plans in this process."""
    for task in tasks:
        yield task, perform(task)


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of results of small drawings: two that pass and one that has nothing to cut."""
    folder = tmp_path_factory.mktemp("drawings")
    head = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"
    circle, line = "0\nCIRCLE\n8\n0\n10\n0\n20\n0\n40\n5\n", "0\nLINE\n8\n0\n10\n0\n20\n0\n11\n1\n21\n0\n"
    parts = []
    options = {"robot": load_robot("delta-300"), "process": load_process("steel-1mm-fibre"), "what_if": False}
    for name, entity in ((ODD, circle), (LATIN, circle), ("nothing.dxf", line)):
        path = folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(f"{head}{entity}0\nENDSEC\n0\nEOF\n")
        parts.append(Part(name, path, options))
    out = tmp_path_factory.mktemp("results")
    batch = run(parts, out, planner=here)
    assert [row.outcome.status for row in batch.rows] == ["passed", "refused", "passed"]
    return out


@pytest.fixture(scope="module")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    found = Browser(tmp_path_factory.mktemp("profile"))
    yield found
    found.close()


@pytest.fixture(scope="module")
def mixed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("page") / "index.html"
    path.write_text(to_html(MIXED), encoding="utf-8")
    return path


def rows(batch: Batch) -> list[dict[str, str]]:
    return Page(to_html(batch)).rows("Parts")


def visible(chromium: Browser) -> list[str]:
    """The names of the parts that are shown, in their order."""
    script = (
        "return [...document.querySelectorAll('#parts tr')].filter((row) => row.offsetHeight > 0)"
        ".map((row) => row.querySelector('.part').firstChild.textContent"
        " + row.querySelector('.part').childNodes[1].textContent)"
    )
    return [str(name) for name in chromium.run(script)]


def click(chromium: Browser, selector: str) -> None:
    chromium.run("document.querySelector(arguments[0]).click()", selector)


def find(chromium: Browser, words: str) -> None:
    script = "const w = document.getElementById('words'); w.value = arguments[0]; w.dispatchEvent(new Event('input'))"
    chromium.run(script, words)


def test_what_did_not_pass_comes_first_with_its_reason() -> None:
    found = rows(MIXED)
    assert [row["part"] for row in found][:5] == ["c.dxfJSON", "b/one.dxf", "b/two.dxf", "f.dxf", "e.dxf"]
    assert [row["verdict"] for row in found] == [
        "\u2717 failed46 checks",
        "\u2717 refused",
        "\u2717 refused",
        "\u2717 timeout",
        "\u2013 left",
        "\u2713 passed46 checks",
        "\u2713 passed46 checks! 2 warnings",
    ]
    assert found[0]["reason"] == "failed: part size"
    assert found[1]["reason"] == "layer 0: a gap of 1 mmjoin the ends"
    numbers = [found[5][head] for head in ("time, s", "cut, mm", "size, mm", "contours")]
    assert numbers == ["9.00", "120.0", "40.00 \u00d7 30.00", "2"]


def test_the_heading_says_how_many_passed_and_how_the_others_ended() -> None:
    found = Page(to_html(MIXED))
    assert found.text_in("title") == ["Batch: failed"]
    assert [text for tag, text in found.texts if tag in ("h1", "p")][:3] == [
        "Batch of 7 drawings",
        "Failed",
        "2 of 7 parts passed: 1 failed, 2 refused, 1 timeout, 1 left.",
    ]
    assert "Passed" in Page(to_html(Batch(MIXED.rows[:1]))).text_in("p")
    tiles = dict(zip(found.text_in("dt"), found.text_in("dd"), strict=True))
    assert (tiles["parts passed"], tiles["pieces to cut"], tiles["machine time, h:mm:ss"]) == ("2 of 7", "2", "0:00:39")
    assert "old.dxf is of an earlier batch" in found.text_in("li")


def test_quantities_and_settings_are_in_the_rows_where_they_differ_only() -> None:
    found = Page(to_html(MIXED))
    tiles = dict(zip(found.text_in("dt"), found.text_in("dd"), strict=True))
    assert (tiles["robot"], tiles["process"]) == ("delta-300", "steel")
    assert not {"pieces", "total, h:mm:ss"} & set(found.rows("Parts")[0])
    differ = Batch((passed("a.dxf", quantity=100), passed("b.dxf", robot="irb360-1600")))
    first, second = rows(differ)
    assert (first["pieces"], first["total, h:mm:ss"], second["pieces"]) == ("100", "0:04:10", "1")
    assert (first["part"], second["part"]) == (
        "a.dxfdelta-300, steelprogram JSON",
        "b.dxfirb360-1600, steelprogram JSON",
    )
    assert "robot" not in Page(to_html(differ)).text_in("dt")


def test_reasons_that_several_parts_share_are_together_above() -> None:
    (shared,) = Page(to_html(MIXED)).rows("Reasons of several parts")
    assert shared["parts"] == "2"
    assert shared["reason"] == "layer 0 ...: a gap of 1 to 2 mmjoin the ends"
    assert shared["which"] == "b/one.dxf, b/two.dxf"
    assert "Reasons of several parts" not in Page(to_html(Batch(MIXED.rows[:2]))).tables


def test_every_link_leads_to_a_file_of_the_folder(results: Path) -> None:
    found = Page((results / "index.html").read_text("utf-8"))
    links = [link["href"] for link in found.all_of("a")]
    assert all(re.fullmatch(r"[\w./~%-]+", link or "", flags=re.ASCII) for link in links)
    files = {os.fsdecode(unquote_to_bytes(link or "")) for link in links}
    written = {path.relative_to(results).as_posix() for path in results.rglob("*.*") if path.is_file()}
    hidden = {name for name in written if name.startswith(".deltacam-batch/")}
    assert files == written - hidden - {"index.html", "plotly.min.js"}
    assert len(files) == 2 + 2 * 3


def test_nothing_is_loaded_from_anywhere_and_the_page_is_small() -> None:
    content = to_html(MIXED)
    assert len(content) < 30_000
    assert not re.search(r"<script src|<link|<iframe|<img|url\(|@import|https?:", content)
    rules = dict(rule.strip().split(" ", 1) for rule in re.findall(r'content="(default[^"]*)"', content)[0].split(";"))
    assert rules["default-src"] == "'none'"
    assert re.fullmatch(r"'sha256-\S+'", rules["script-src"])


def test_a_thousand_parts_are_a_page_that_opens_fast() -> None:
    many = tuple(passed(f"{n}.dxf", thumbnail=((*range(100), *range(100)) * 3,)) for n in range(1000))
    assert len(to_html(Batch(many))) < 3e6


def hostile() -> tuple[Row, ...]:
    changes = {"robot": HOSTILE, "process": HOSTILE, "warnings": (HOSTILE,)}
    return (
        passed(HOSTILE, **changes),
        passed(f"{HOSTILE}/{HOSTILE}", quantity=2),
        failed(HOSTILE, HOSTILE, what=HOSTILE, where=HOSTILE, hint=HOSTILE),
        *(without(f"{HOSTILE}{n}", Status.REFUSED, HOSTILE, where=HOSTILE, hint=HOSTILE) for n in range(2)),
        passed("\ud800.dxf"),
    )


def test_names_from_files_are_shown_and_do_nothing() -> None:
    content = to_html(Batch(hostile(), (HOSTILE,)))
    assert content.encode()
    found, harmless = Page(content), Page(to_html(MIXED))
    assert len(found.all_of("script")) == content.count("<script") == 2
    data, script = found.text_in("script")
    assert script == harmless.text_in("script")[1]
    assert re.fullmatch(r'[\w{}\[\]":,.]+', data, flags=re.ASCII)
    for bad in ("]]>", "\u202e", "\x00", "\x1b", "\udce9", "\ud800", "\"' onload"):
        assert bad not in content, bad
    assert {tag for tag, _ in found.tags} == {tag for tag, _ in harmless.tags}
    attributes = {name for _, of in found.tags for name in of}
    assert attributes == {name for _, of in harmless.tags for name in of}
    assert not any(name.startswith("on") for name in attributes)
    assert all(re.fullmatch(r"[\w./~%-]+", link["href"] or "", flags=re.ASCII) for link in found.all_of("a"))
    assert "</script><script>alert(1)</script>\"' onload=x" in " ".join(text for _, text in found.texts)


def test_a_name_cannot_lead_elsewhere() -> None:
    names = (
        "javascript:alert(1).dxf",
        "https:..example.com.dxf",
        "data:text,x.dxf",
        "\\\\host\\x.dxf",
        "?.dxf",
        "#.dxf",
    )
    found = Page(to_html(Batch(tuple(map(passed, names)))))
    links = [link["href"] or "" for link in found.all_of("a")]
    assert len(links) == 2 + 4 * len(names)
    assert not any(re.search(r"[:?#\\]|^/", link) for link in links)


@in_browser
@pytest.mark.parametrize(("width", "dark"), [(1280, False), (400, True)])
def test_the_page_opens_with_every_part_in_sight(chromium: Browser, mixed: Path, width: int, dark: bool) -> None:
    chromium.open(mixed, width=width, dark=dark)
    assert len(visible(chromium)) == len(MIXED.rows)
    assert chromium.run("return document.documentElement.scrollWidth") <= width
    cells = "return [...document.querySelectorAll('#parts td, #parts th')].map((c) => c.getBoundingClientRect().right)"
    assert max(chromium.run(cells)) <= width
    assert chromium.run("return document.querySelector('#parts svg').getBoundingClientRect().width") == 80
    assert chromium.problems() == []
    assert chromium.requests() == {mixed.as_uri()}


@in_browser
def test_buttons_and_words_choose_parts(chromium: Browser, mixed: Path) -> None:
    chromium.open(mixed)
    texts = "return [...document.querySelectorAll('.find button')].map((button) => button.textContent)"
    assert chromium.run(texts) == ["all 7", "not passed 5", "passed 2", "failed 1", "refused 2", "timeout 1", "left 1"]
    click(chromium, ".find button:nth-child(2)")
    assert visible(chromium) == ["c.dxf", "b/one.dxf", "b/two.dxf", "f.dxf", "e.dxf"]
    find(chromium, "layer ONE")
    assert visible(chromium) == ["b/one.dxf"]
    assert chromium.run("return document.getElementById('count').textContent") == "1 of 7 parts"
    find(chromium, "nowhere")
    assert visible(chromium) == []
    assert chromium.run("return document.getElementById('none').offsetHeight") > 0
    find(chromium, "")
    click(chromium, ".find button:nth-child(3)")
    assert visible(chromium) == ["a.dxf", "d.dxf"]
    click(chromium, ".go")
    assert visible(chromium) == ["b/one.dxf", "b/two.dxf"]
    click(chromium, ".go")
    assert len(visible(chromium)) == len(MIXED.rows)
    assert chromium.problems() == []


@in_browser
def test_a_click_on_a_heading_sorts_and_another_one_turns_the_order(chromium: Browser, mixed: Path) -> None:
    chromium.open(mixed)
    click(chromium, "th.part button")
    assert visible(chromium) == [row.part for row in MIXED.rows]
    click(chromium, "th.part button")
    assert visible(chromium) == [row.part for row in MIXED.rows][::-1]
    click(chromium, "th.time button")
    assert visible(chromium)[:3] == ["d.dxf", "a.dxf", "c.dxf"]
    sorted_by = "return [...document.querySelectorAll('[aria-sort]')].map((h) => [h.textContent, h.ariaSort])"
    assert chromium.run(sorted_by) == [["time, s", "descending"]]
    click(chromium, "th.time button")
    assert visible(chromium)[:3] == ["c.dxf", "a.dxf", "d.dxf"]
    click(chromium, "th.size button")
    assert visible(chromium)[:2] == ["c.dxf", "a.dxf"]
    assert "d.dxf" in visible(chromium)[2:]


@in_browser
def test_links_lead_to_reports_that_draw_and_back_to_what_was_asked_for(chromium: Browser, results: Path) -> None:
    chromium.open(results / "index.html")
    plotly = (results / "plotly.min.js").as_uri()
    assert chromium.problems() == []
    assert chromium.requests() == {(results / "index.html").as_uri()}
    assert visible(chromium) == ["nothing.dxf", LATIN.replace("\udce9", "\\udce9"), ODD]
    for name, title in ((ODD, "50% # of"), (LATIN, "caf")):
        find(chromium, title.lower())
        click(chromium, "th.time button")
        click(chromium, "#parts tr:not([hidden]) .part a")
        assert chromium.run("return document.title").startswith(title), name
        lines = "return document.getElementById('part').querySelectorAll('path.js-line').length"
        assert chromium.run(lines) > 0
        assert chromium.problems() == []
        asked = chromium.requests()
        assert plotly in asked
        assert len(asked) == 2
        assert all(address.startswith("file:///") for address in asked)
        chromium.driver.back()
        assert chromium.requests() == {(results / "index.html").as_uri()}
        assert visible(chromium) == [name.replace("\udce9", "\\udce9")]
        assert chromium.run("return document.getElementById('words').value") == title.lower()
        assert chromium.run("return document.querySelector('[aria-sort]').className") == "time"


@in_browser
def test_links_without_a_script_work_and_nothing_dead_is_shown(chromium: Browser, results: Path) -> None:
    chromium.command("Emulation.setScriptExecutionDisabled", value=True)
    try:
        chromium.open(results / "index.html")
        (bar,) = chromium.driver.find_elements("css selector", ".find")
        assert not bar.is_displayed()
        link = chromium.driver.find_element("css selector", "#parts .part a")
        link.click()
        assert ".report.html" in chromium.driver.current_url
    finally:
        chromium.command("Emulation.setScriptExecutionDisabled", value=False)


@in_browser
def test_a_hostile_batch_does_nothing(chromium: Browser, tmp_path: Path) -> None:
    page = tmp_path / "index.html"
    page.write_text(to_html(Batch(hostile(), (HOSTILE,))), encoding="utf-8")
    chromium.open(page)
    find(chromium, "alert")
    assert chromium.run("return window.dialogs") == 0
    assert chromium.run("return document.images.length") == 0
    assert chromium.problems() == []
    assert chromium.requests() == {page.as_uri()}


def test_the_data_of_the_page_holds_numbers_only() -> None:
    (data, _) = Page(to_html(MIXED)).text_in("script")
    values: dict[str, Any] = json.loads(data)
    assert len(values["rows"]) == len(MIXED.rows)
    for row in values["rows"]:
        assert len(row) == len(values["columns"])
        assert all(value is None or isinstance(value, (int, float)) for value in row)
