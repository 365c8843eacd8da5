"""What holds a program back, in words."""

from deltacam.model import Held
from deltacam.report.held_back import HEADS, in_words, rows

HELD = (
    Held(7, 2.0, {"feed": 1.5, "joint 1 jerk": 0.2, "none": 0.3}, {"feed": 1.0}),
    Held(9, 2.0, {"joint 2 jerk": 1.0, "corners": 1.0}, {"joint jerk": 1.5, "feed": 1.9}),
)


def test_the_joints_are_taken_together_and_the_largest_comes_first() -> None:
    assert (
        in_words(HELD)
        == "feed 38 %, joint jerk 30 %, corners 25 % of 4 s along contours; without feed 2.9 s, joint jerk 3.5 s"
    )


def test_without_times_nothing_is_said_of_them() -> None:
    assert in_words([Held(1, 1.0, {"feed": 1.0}, {})]) == "feed 100 % of 1 s along contours"


def test_the_table_has_a_row_per_contour() -> None:
    found = rows(HELD)
    assert [len(row) for row in found] == [len(HEADS)] * 2
    assert found[1] == ["9", "2.000", "joint 2 jerk 50 %, corners 50 %", "joint jerk 1.500, feed 1.900"]
