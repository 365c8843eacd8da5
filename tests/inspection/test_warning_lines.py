from deltacam.inspection.warning_lines import warning_lines
from deltacam.model import Finding

GAPS = [Finding(f"gap of {n / 50:g} mm", kind="gap", where="layer CUT", place=(n / 1000, 0.0)) for n in range(1, 13)]


def test_many_of_a_kind_are_one_warning_with_the_first_place() -> None:
    assert warning_lines(GAPS, width=120) == [
        "  warning: 12 times: gap of 0.02 to 0.24 mm, the first time on layer CUT at (1.000, 0.000) mm"
    ]


def test_few_of_a_kind_are_listed_one_by_one() -> None:
    assert warning_lines(GAPS[:3], width=120) == [
        f"  warning: layer CUT at ({n}.000, 0.000) mm: gap of {n / 50:g} mm" for n in (1, 2, 3)
    ]


def test_what_plan_refuses_comes_first_and_is_not_mixed_with_the_rest() -> None:
    blocking = [Finding(gap.what, kind="gap", blocks=True) for gap in GAPS]
    lines = warning_lines([*GAPS, *blocking], width=120)
    assert [line.split(":")[0].strip() for line in lines] == ["plan will refuse", "warning"]


def test_a_place_is_said_once() -> None:
    said = Finding("gap at (1.000, 2.000) mm", kind="gap", place=(0.001, 0.002))
    assert warning_lines([said], width=120) == ["  warning: gap at (1.000, 2.000) mm"]
    unsaid = Finding("a gap", kind="gap", place=(0.001, 0.002), hint="close it")
    assert warning_lines([unsaid], width=120) == ["  warning: (1.000, 2.000) mm: a gap; close it"]


def test_lines_are_no_wider_than_they_may_be() -> None:
    lines = warning_lines([Finding("word " * 40, hint="more " * 40)], width=60)
    assert len(lines) > 5
    assert max(map(len, lines)) <= 60


def test_what_does_not_fit_a_screen_is_counted() -> None:
    findings = [Finding(f"thing {'x' * n}") for n in range(40)]
    lines = warning_lines(findings, width=120)
    assert len(lines) < 20
    assert lines[-1].strip() == "warning: and 26 more, all of them with --json"
