"""The batch as a page: a picture, the time and the verdict of every part, with links to the reports."""

from __future__ import annotations

from deltacam.batch.parts import Batch
from deltacam.report.page import frame
from deltacam.report.picture import shown
from deltacam.report.tables import table


def to_html(batch: Batch) -> str:
    """The page; everything in it is escaped."""
    rows = [(shown(row.part), shown(row.outcome.status.value)) for row in batch.rows]
    body = f"<main>{table(('part', 'verdict'), rows)}</main>"
    return frame(title="Batch", style="", body=body, data="null", library=None, scripts=())
