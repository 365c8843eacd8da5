"""Prints what the kerf path costs, how exact it is and how often it could not be traced, over random contours."""

import argparse
import time

import numpy as np
import shapely

from deltacam.cutting import trace
from deltacam.cutting.kerf import offset
from deltacam.errors import InfeasibleError
from deltacam.geometry import curve as curves
from deltacam.model import Contour, Curve


def random_curve(rng: np.random.Generator, count: int) -> Curve | None:
    """A closed curve of lines and arcs around the origin, 2 to 100 mm across; None where it crosses itself."""
    angle = 2.0 * np.pi * (np.arange(count) + rng.uniform(-0.45, 0.45, count)) / count
    radius = 10.0 ** rng.uniform(-3.0, -1.3, count)
    bulges = np.where(rng.random(count) < 0.4, 0.0, rng.uniform(-0.4, 0.6, count) * 10.0 ** rng.uniform(-4, 0, count))
    curve = Curve(points=radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1), bulges=bulges)
    flat, _ = curves.flatten(curve, 1e-7)
    simple = len(flat) > 3 and shapely.LinearRing(flat).is_simple and curves.signed_area(curve) > 1e-8
    return curve if simple else None


def main() -> None:
    """Run the campaign and print one row per number of segments."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--contours", type=int, default=500, help="contours per row")
    wanted = parser.parse_args().contours
    untraced = 0
    matches = trace._matches

    def counted(*arguments: object) -> bool:
        nonlocal untraced
        found = matches(*arguments)
        untraced += not found
        return found

    trace._matches = counted
    print("segments  contours  refused   cuts  untraced  us/segment  worst distance error um")
    for count in (4, 16, 64, 256):
        rng = np.random.default_rng(count)
        done = refused = cuts = 0
        untraced, spent, worst = 0, 0.0, 0.0
        while done < wanted:
            curve = random_curve(rng, count)
            if curve is None:
                continue
            done += 1
            kerf = 10.0 ** rng.uniform(-4.5, -2.5)
            contour = Contour(number=1, curve=curve, layer="0", handles=("1",), depth=int(rng.integers(2)))
            started = time.perf_counter()
            try:
                result = offset([contour], kerf=kerf)
            except InfeasibleError:
                refused += 1
                continue
            finally:
                spent += time.perf_counter() - started
            cuts += len(result.cuts)
            drawn = shapely.LinearRing(curves.flatten(curve, 1e-8)[0])
            for cut in result.cuts:
                points = shapely.points(curves.flatten(cut.curve, 1e-6)[0])
                worst = max(worst, float(np.abs(shapely.distance(points, drawn) - kerf / 2.0).max()))
        cost = spent / done / count * 1e6
        print(f"{count:8} {done:9} {refused:8} {cuts:6} {untraced:9} {cost:11.0f} {worst * 1e6:24.3f}")


if __name__ == "__main__":
    main()
