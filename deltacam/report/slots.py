"""The places of the page that the script fills with pictures, and the words beside them."""

from __future__ import annotations

from collections.abc import Iterable

from deltacam.report.binding import LIMITS
from deltacam.report.figures import Json
from deltacam.report.palette import BINDING, JOINTS, Ink, css
from deltacam.units import to_um


def slots(data: Json) -> str:
    """The figures, without what the ``data`` has nothing for; they are hidden where no script runs."""
    return f"""<section class="moving" aria-label="Pictures">
<div class="pair">
<figure class="moving"><div class="bar"><h3>The part</h3>
<div class="group" id="colours" role="group" aria-label="Colour of the path"></div></div>
<div class="plot inked" id="part" role="img" aria-label="The part and the path of the tool over it"></div>
<div class="legend inked" id="legend"></div>
{_lines(data)}<div class="clock"><button type="button" id="play">Play</button>
<input type="range" id="time" min="0" value="0" aria-label="Time in the program"></div>
<figcaption>Scroll to zoom, drag to move, double-click for all. {_path(data)}</figcaption></figure>
<figure class="moving"><div class="bar"><h3>The machine from above</h3></div>
<div class="plot inked" id="workspace" role="img" aria-label="The sheet, the part and the arms from above"></div>
<figcaption>The sheet, the part with its bounding box, the joints (squares) on the base, park (cross), in mm in the
machine frame. Thin lines: the pressure angle in degrees.</figcaption></figure>
</div>
<figure class="moving"><div class="bar"><h3>Motion</h3>{_legend()}</div>
<div class="plot inked" id="motion" role="img" aria-label="Tool and joints over time, with their limits"></div>
<figcaption>Drag over a time to zoom, double-click for all. Dashed: limits; to the right: the most that is used,
of each joint. {_samples(data)}</figcaption></figure>
{_deviation(data)}</section>
"""


def _path(data: Json) -> str:
    """How exactly the path is drawn."""
    if "route" not in data:
        return "The tool has no place at some tick, so that there is no path."
    return f"The path is drawn within {to_um(data['route']['within'] / 1e3):.3g} µm of the setpoints."


def _lines(data: Json) -> str:
    """What the lines and marks of the path stand for."""
    items = "".join(f'<li><i class="{look}"></i>{name}</li>' for look, name in data["part"]["legend"])
    return f'<div class="legend looks"><ul>{items}</ul></div>\n' if items else ""


def _samples(data: Json) -> str:
    """What is thinned, and how."""
    if data["step"] == 1:
        return "Zoomed out, every column of pixels shows its smallest and its largest setpoint; zoomed in, every one."
    return f"Each point pair is the smallest and the largest of {data['step']} setpoints."


def _legend() -> str:
    joints = _colours(JOINTS, (f"joint {number}" for number in (1, 2, 3)))
    limits = _colours(BINDING, [*LIMITS, "none near"])
    return f"""<div class="legend inked"><span>lines</span><ul>{joints}</ul></div>
<div class="legend inked"><span>nearest limit</span><ul>{limits}</ul></div>"""


def _colours(inks: Iterable[Ink], names: Iterable[str]) -> str:
    pairs = zip(inks, names, strict=True)
    return "".join(f'<li><i style="background-color: {css(ink)}"></i>{name}</li>' for ink, name in pairs)


def _deviation(data: Json) -> str:
    if "deviation" not in data:
        return ""
    return """<figure class="moving"><div class="bar"><h3>Deviation</h3></div>
<div class="plot inked" id="deviation" role="img" aria-label="Deviation from the kerf path, with its limit"></div>
<figcaption>Over the length that is cut and engraved.</figcaption></figure>
"""
