"""Makes the screenshots of the README: `python docs/make_screenshots.py`, and `-o DIR` for another folder.

Needs the tools of a developer, and chromium and chromedriver.
"""

from __future__ import annotations

import argparse
import base64
import shutil
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Final

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

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
    (folder / "report.png").write_bytes(picture)
    (folder / "workspace.png").write_bytes(workspace)


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
