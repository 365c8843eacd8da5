"""Studies as text, page and JSON: nothing from a file acts, and columns stand under each other."""

import json
import re
from html import unescape

import numpy as np
import pytest

from deltacam.report.charts import heat_map, line_chart, scatter_chart
from deltacam.report.study import Chart, Study, Table, to_html, to_text

HOSTILE = "</script><script>alert(1)</script>\x1b[31m\nnext"
STUDY = Study(
    title=f"title {HOSTILE}",
    facts=(("short", "1 mm"), ("a longer name", HOSTILE)),
    tables=(Table("a table", ("name", "value"), (("one", "1"), (HOSTILE, "22"))),),
    charts=(Chart("a chart", HOSTILE, ({"type": "scatter", "name": HOSTILE, "x": [0.0], "y": [1.0]},), {}),),
    notes=(HOSTILE,),
)


def test_a_name_from_a_file_cannot_command_the_terminal() -> None:
    text = to_text(STUDY)
    assert "\x1b" not in text
    assert "\nnext" not in text


def test_a_name_from_a_file_opens_no_element_of_the_page() -> None:
    page = to_html(STUDY, library="plotly.js")
    assert "<script>alert" not in page
    scripts = re.findall(r"<script.*?</script>", page, flags=re.DOTALL)
    data = next(script for script in scripts if 'type="application/json"' in script)
    drawn = json.loads(re.sub(r"^<script[^>]*>|</script>$", "", data))
    assert drawn[0]["traces"][0]["name"] == HOSTILE
    assert "alert(1)" in unescape(page)


def test_columns_stand_under_each_other() -> None:
    study = Study("t", (("a", "1"), ("bcd", "2")), (Table("h", ("name", "x", "yy"), (("n", "1.5", "2"),)),))
    assert to_text(study).splitlines() == [
        "t",
        "  a    1",
        "  bcd  2",
        "",
        "h",
        "  name    x  yy",
        "  n     1.5   2",
    ]


def test_nothing_is_drawn_where_there_is_no_value() -> None:
    x, y = np.array([0.0, 10.0, 20.0]), np.array([0.0, 5.0])
    values = np.array([[1.0, 2.0, np.nan], [np.inf, 5.0, 6.0]])
    edge = [np.array([[0.0, 0.0], [20.0, 5.0]])]
    chart = heat_map("h", "c", x_mm=x, y_mm=y, values=values, unit="um", marks=[(0.0, 5.0, "here")], outlines=edge)
    assert chart.traces[0]["z"] == [[1.0, 2.0, None], [None, 5.0, 6.0]]
    assert [trace["type"] for trace in chart.traces] == ["heatmap", "scatter", "scatter"]
    json.dumps(chart.traces, allow_nan=False)


@pytest.mark.parametrize("count", [1, 2])
def test_lines_and_points_have_a_legend_where_there_are_several(count: int) -> None:
    lines = line_chart("h", "c", x_title="x", y_title="y", lines=[(f"l{i}", [0, 1], [1, 2]) for i in range(count)])
    points = scatter_chart("h", "c", x_title="x", y_title="y", points=[("p", [0], [1], ["here"])] * count)
    for chart in (lines, points):
        assert len(chart.traces) == count
        assert chart.layout["showlegend"] is (count > 1)
