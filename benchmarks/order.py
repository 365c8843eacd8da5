"""Prints how the ordering of cuts grows with their number, and what it saves over the order of the file."""

import time

import numpy as np

from deltacam.cutting.order import order
from deltacam.geometry import curve as curves
from deltacam.model import Cut


def travel(cuts: tuple[Cut, ...]) -> float:
    """The length of the rapids from the park position through all cuts and back, m."""
    places = np.array([(0.0, 0.0), *(cut.curve.points[0] for cut in cuts), (0.0, 0.0)])
    return float(np.hypot(*np.diff(places, axis=0).T).sum())


def main() -> None:
    """Order sheets of more and more small holes, half of them inside others."""
    print("contours  seconds  ms/contour     travel m  file order m")
    for count in (10, 30, 100, 300, 1000, 3000, 10000):
        rng = np.random.default_rng(count)
        cuts = tuple(
            Cut(contour=n, layer="0", handles=("1",), curve=curves.circle(rng.uniform(-0.14, 0.14, 2), 1e-3))
            for n in range(1, count + 1)
        )
        half = count // 2
        parents = {n: int(rng.integers(half, count)) + 1 if n <= half else None for n in range(1, count + 1)}
        started = time.perf_counter()
        ordered = order(cuts, parents=parents, start=(0.0, 0.0))
        seconds = time.perf_counter() - started
        print(f"{count:8} {seconds:8.3f} {seconds / count * 1e3:13.2f} {travel(ordered):10.3f} {travel(cuts):13.3f}")


if __name__ == "__main__":
    main()
