"""Makes the screenshots of the README: `python docs/make_screenshots.py`, and `-o DIR` for another folder.

Needs the tools of a developer, and chromium and chromedriver.
"""

from __future__ import annotations

import argparse
import base64
import shutil
import tempfile
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Final

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

from deltacam.batch.parts import Limits, Part
from deltacam.batch.planning.local import results
from deltacam.batch.run import run
from deltacam.cutting.process import load_process
from deltacam.pipeline import plan_to_folder
from deltacam.report.studies.workspace import study
from deltacam.report.study import to_html
from deltacam.robot.reader import load_robot
from deltacam.robot.region.workspace_study import study_workspace

SAMPLE: Final = Path(__file__).parents[1] / "samples" / "bracket.dxf"
FEED: Final = 0.5  # m/s
SIZE: Final = (1200, 1290)  # pixels
ROBOT: Final = "delta-300"
STUDY_SIZE: Final = (1200, 740)
BATCH_SIZE: Final = (1200, 1205)
QUANTITIES: Final = {
    "brackets/bottom-plate-spline-inch": 4,
    "brackets/plate-solidworks-inch": 2,
    "brackets/motor-lock-wrong-units": 2,
    "brackets/wrench-inch": 10,
    "gears/cycloidal-inch": 6,
    "gears/gear": 12,
    "gears/gear-unitless": 12,
    "plates/chute-holder-lines": 1,
    "plates/key-plate-bulge": 1,
    "plates/nameplate": 25,
    "plates/redox-top-dims": 2,
    "plates/rational-spline-inch": 1,
}
"""Parts of the batch, in folders, and how many are wanted; the drawings are samples and those of the tests."""
PLACE: Final = (87.5, 88.0)  # mm on the part, at which the mouse is
SWITCHES: Final = ("--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--hide-scrollbars")
FIND: Final = """
const {xaxis, yaxis} = part._fullLayout, box = part.getBoundingClientRect();
return [box.left + xaxis._offset + xaxis.d2p(arguments[0]), box.top + yaxis._offset + yaxis.d2p(arguments[1])];
"""


def main() -> None:
    """Plan the sample, open its report, point at the path, and keep what is seen."""
    parser = argparse.ArgumentParser(description="Make the screenshots of the README.")
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parent / "images", help="folder")
    folder = parser.parse_args().output
    process = replace(load_process("steel-1mm-fibre"), feed=FEED)
    with tempfile.TemporaryDirectory() as scratch:
        _, outputs = plan_to_folder(SAMPLE, Path(scratch) / "out", process=process)
        picture = screenshot(outputs.report_html, Path(scratch) / "profile", SIZE, point=PLACE)
        page = Path(scratch) / "workspace.html"
        shown = study(study_workspace(load_robot(ROBOT)))
        page.write_text(
            to_html(replace(shown, facts=(), charts=shown.charts[:1], tables=(), notes=())), encoding="utf-8"
        )
        workspace = screenshot(page, Path(scratch) / "another", STUDY_SIZE)
        batch = screenshot(run_batch(Path(scratch) / "batch"), Path(scratch) / "third", BATCH_SIZE)
    (folder / "report.png").write_bytes(picture)
    (folder / "workspace.png").write_bytes(workspace)
    (folder / "batch.png").write_bytes(batch)


def run_batch(folder: Path) -> Path:
    """The page of a batch of `QUANTITIES`, some of which are refused."""
    root = SAMPLE.parents[1]
    options = {"robot": load_robot(ROBOT), "process": load_process("steel-1mm-fibre"), "what_if": False}
    parts = []
    for name, quantity in QUANTITIES.items():
        file = f"{Path(name).name}.dxf"
        path = next(path for path in (root / "samples" / file, root / "tests" / "data" / "dxf" / file) if path.exists())
        parts.append(Part(f"{name}.dxf", path, options, quantity))
    run(parts, folder, planner=partial(results, jobs=2, limits=Limits()))
    return folder / "index.html"


def screenshot(
    page: Path, profile: Path, extent: tuple[int, int], *, point: tuple[float, float] | None = None
) -> bytes:
    """The upper part of a page as PNG, of so many pixels, with the mouse at a point of the part.

    The profile is a folder to be made.
    """
    options = Options()
    options.binary_location = shutil.which("chromium") or ""
    for switch in (*SWITCHES, f"--user-data-dir={profile}"):
        options.add_argument(switch)
    driver = webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))
    try:
        size = {"width": extent[0], "height": extent[1], "deviceScaleFactor": 1, "mobile": False}
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        driver.get(page.resolve().as_uri())
        if point is not None:
            x, y = driver.execute_script(FIND, *point)
            driver.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": "mouseMoved", "x": x, "y": y})
        return base64.b64decode(driver.execute_cdp_cmd("Page.captureScreenshot", {"format": "png"})["data"])
    finally:
        driver.quit()


if __name__ == "__main__":
    main()
