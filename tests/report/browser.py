"""A headless Chromium for the tests of the page, and what they ask it."""

from __future__ import annotations

import base64
import json
import os
import shutil
from pathlib import Path
from typing import Any

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

BROWSER, DRIVER = (next(filter(None, map(shutil.which, names)), None) for names in (("chromium",), ("chromedriver",)))

_SWITCHES = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
)


class Browser:
    """One window, of which every test opens its page anew.

    Args:
        profile: an empty folder.
    """

    def __init__(self, profile: Path) -> None:
        options = Options()
        options.binary_location = BROWSER or ""
        for switch in (*_SWITCHES, f"--user-data-dir={profile}"):
            options.add_argument(switch)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        own = {**os.environ, "XDG_CONFIG_HOME": str(profile), "XDG_CACHE_HOME": str(profile)}
        # With the driver's place given selenium looks for none, and downloads none.
        self.driver = webdriver.Chrome(options=options, service=Service(DRIVER, env=own))
        self.command("Page.addScriptToEvaluateOnNewDocument", source=_WATCH)

    def command(self, name: str, **arguments: Any) -> dict[str, Any]:
        return dict(self.driver.execute_cdp_cmd(name, arguments))

    def open(self, page: Path, *, width: int = 1280, dark: bool = False) -> None:
        size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 600}
        self.command("Emulation.setDeviceMetricsOverride", **size)
        self.command("Emulation.setTouchEmulationEnabled", enabled=width < 600)
        scheme = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        self.command("Emulation.setEmulatedMedia", features=scheme)
        self.problems()
        self.requests()
        self.driver.get(page.as_uri())

    def run(self, script: str, *arguments: Any) -> Any:
        return self.driver.execute_script(script, *arguments)

    def problems(self) -> list[str]:
        """What the console says since the last call, and what the policy of the page refused."""
        log = [entry["message"] for entry in self.driver.get_log("browser")]
        return log + (self.run("return window.violations ?? []"))

    def requests(self) -> set[str]:
        """The addresses that were asked for since the last call, data inside the page left out."""
        messages = (json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance"))
        asked = (m["params"]["request"]["url"] for m in messages if m["method"] == "Network.requestWillBeSent")
        return {url for url in asked if not url.startswith(("data:", "blob:"))}

    def point(self, figure: str, x: float, y: float | None = None) -> dict[str, str]:
        """Move the mouse to a place of a figure, in the units of its axes; what the words beside it say."""
        left, top = self.run(PLACE, figure, x, y)
        self.command("Input.dispatchMouseEvent", type="mouseMoved", x=left, y=top)
        return self.words()

    def words(self) -> dict[str, str]:
        rows = self.run(
            "return [...document.querySelectorAll('.tip:not([hidden]) div')]"
            ".map((row) => [...row.children].map((cell) => cell.textContent))"
        )
        return dict(rows)

    def drag(self, figure: str, start: float, end: float) -> None:
        """Press the mouse at a time, move it to another one, and let go."""
        for kind, x in (("mousePressed", start), ("mouseMoved", end), ("mouseReleased", end)):
            left, top = self.run(PLACE, figure, x, None)
            event = {"type": kind, "x": left, "y": top, "button": "left", "buttons": 1, "clickCount": 1}
            self.command("Input.dispatchMouseEvent", **event)

    def pdf(self) -> bytes:
        return base64.b64decode(self.command("Page.printToPDF", paperWidth=8.27, paperHeight=11.69)["data"])

    def close(self) -> None:
        self.driver.quit()


_WATCH = """
window.violations = [];
window.dialogs = 0;
document.addEventListener("securitypolicyviolation", (event) => {
  window.violations.push(`${event.violatedDirective}: ${event.blockedURI}`);
});
window.alert = window.confirm = window.prompt = () => { window.dialogs += 1; };
"""

PLACE = """
const figure = document.getElementById(arguments[0]);
figure.scrollIntoView({block: "center", behavior: "instant"});
const {xaxis, yaxis, _size} = figure._fullLayout;
const box = figure.getBoundingClientRect();
const y = arguments[2] === null ? _size.t + _size.h / 2 : yaxis._offset + yaxis.d2p(arguments[2]);
return [box.left + xaxis._offset + xaxis.d2p(arguments[1]), box.top + y];
"""
