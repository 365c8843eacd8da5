import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from deltacam.inspection.labels import Paper

SQUARE = np.array([[100.0, 100.0], [160.0, 100.0], [160.0, 160.0], [100.0, 160.0], [100.0, 100.0]])


def paper(*lines: np.ndarray) -> Paper:
    sheet = Paper(400.0, 300.0, top=50.0)
    for line in lines:
        sheet.draw(line)
    return sheet


def test_a_number_goes_inside_or_beside_its_contour() -> None:
    assert paper(SQUARE).place(SQUARE, 12.0, 10.0, inside=True) == (130.0, 130.0)
    beside = paper(SQUARE).place(SQUARE, 12.0, 10.0, inside=False)
    assert beside is not None
    assert beside[1] < 100.0


def test_a_number_inside_a_bent_contour_is_on_it() -> None:
    channel = np.array([[100, 100], [200, 100], [200, 130], [130, 130], [130, 170], [200, 170], [200, 200], [100, 200]])
    channel = np.vstack([channel, channel[:1]]).astype(float)
    x, y = paper(channel).place(channel, 12.0, 10.0, inside=True) or (0.0, 0.0)
    assert 100.0 < x < 200.0
    assert 100.0 < y < 130.0 or 170.0 < y < 200.0 or x < 130.0


def test_a_small_contour_has_its_number_beside_it() -> None:
    small = 130.0 + 0.1 * (SQUARE - 130.0)
    place = paper(small).place(small, 12.0, 10.0, inside=True)
    assert place is not None
    assert abs(place[0] - 130.0) > 3.0 or abs(place[1] - 130.0) > 3.0


def test_where_all_is_taken_there_is_no_number() -> None:
    lines = [np.array([[0.0, y], [400.0, y]]) for y in range(0, 300, 4)]
    assert paper(*lines).place(SQUARE, 12.0, 10.0, inside=True) is None


def test_nothing_is_written_into_the_heading_or_off_the_paper() -> None:
    for shift in ((-100.0, -60.0), (240.0, 140.0)):
        edge = SQUARE + np.array(shift)
        x, y = paper(edge).place(edge, 12.0, 10.0, inside=False) or (0.0, 0.0)
        assert 6.0 <= x <= 394.0
        assert 50.0 <= y <= 295.0


@given(st.lists(st.tuples(st.floats(0, 400), st.floats(0, 300)), min_size=1, max_size=60))
def test_numbers_never_overlap(middles: list[tuple[float, float]]) -> None:
    sheet, placed = paper(), []
    for middle in middles:
        place = sheet.place(SQUARE * 0.5 + middle, 20.0, 10.0, inside=True)
        if place:
            placed.append(place)
    for i, (x, y) in enumerate(placed):
        assert all(abs(x - u) >= 20.0 or abs(y - v) >= 10.0 for u, v in placed[:i])
