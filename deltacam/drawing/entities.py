"""Every entity of the modelspace, and of the blocks inserted there, with its curve in the sheet plane or a reason.

Entities on layers that are frozen or off are read like all others, with a finding per layer: exporters leave the real
part on such layers, and a missing contour is worse than one to switch off. Entities that are themselves marked
invisible are not read: dynamic blocks keep the variants that are not chosen that way.

The numbers of a layout or block are gathered in one pass and become curves as arrays. A block is read once for each
layer, colour and line type that an INSERT gives it, traced once for each way in which it is turned and scaled, and
then copied to its places.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from deltacam.drawing import batches, blocks, losses, reading, traces
from deltacam.drawing.reading import Content, Context, Insert
from deltacam.drawing.traces import Traces
from deltacam.errors import DrawingError
from deltacam.geometry.pack import Pack
from deltacam.model import Array, Finding, IntArray

MAX_REACH: Final = 1e6
"""No part is larger, m; a larger number is damage."""
