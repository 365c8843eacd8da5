"""Makes the screenshot of the README: `python docs/make_screenshots.py`, and `-o DIR` for another folder.

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

SAMPLE: Final = Path(__file__).parents[1] / "samples" / "bracket.dxf"
FEED: Final = 0.5  # m/s
SIZE: Final = (1200, 1290)  # pixels
PLACE: Final = (87.5, 88.0)  # mm on the part, at which the mouse is
SWITCHES: Final = ("--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--hide-scrollbars")
FIND: Final = """
const {xaxis, yaxis} = part._fullLayout, box = part.getBoundingClientRect();
return [box.left + xaxis._offset + xaxis.d2p(arguments[0]), box.top + yaxis._offset + yaxis.d2p(arguments[1])];
"""


def main() -> None:
    """Plan the sample, open its report, point at the path, and keep what is seen."""
    parser = argparse.ArgumentParser(description="Make the screenshot of the README.")
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parent / "images", help="folder")
    folder = parser.parse_args().output
    process = replace(load_process("steel-1mm-fibre"), feed=FEED)
    with tempfile.TemporaryDirectory() as scratch:
        _, outputs = plan_to_folder(SAMPLE, Path(scratch) / "out", process=process)
        picture = screenshot(outputs.report_html, Path(scratch) / "profile")
    (folder / "report.png").write_bytes(picture)


def screenshot(page: Path, profile: Path) -> bytes:
    """The upper part of a report as PNG, with the mouse on the path; the profile is a folder to be made."""
    options = Options()
    options.binary_location = shutil.which("chromium") or ""
    for switch in (*SWITCHES, f"--user-data-dir={profile}"):
        options.add_argument(switch)
    driver = webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))
    try:
        size = {"width": SIZE[0], "height": SIZE[1], "deviceScaleFactor": 1, "mobile": False}
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        driver.get(page.resolve().as_uri())
        x, y = driver.execute_script(FIND, *PLACE)
        driver.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": "mouseMoved", "x": x, "y": y})
        return base64.b64decode(driver.execute_cdp_cmd("Page.captureScreenshot", {"format": "png"})["data"])
    finally:
        driver.quit()


if __name__ == "__main__":
    main()
