"""A page as a browser would read it, and the page of a report."""

from html.parser import HTMLParser

from deltacam.model import Drawing, Report
from deltacam.program.program import Program
from deltacam.report.html import to_html

VOID = {"meta", "input"}


class Page(HTMLParser):
    """What a browser would make of the page; refuses tags that do not nest."""

    def __init__(self, content: str) -> None:
        super().__init__(convert_charrefs=True)
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[tuple[str, str]] = []
        self.tables: dict[str, list[list[str]]] = {}
        self.folded: set[str] = set()
        self.heading = ""
        self.feed(content)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID and not self.get_starttag_text().endswith("/>"):
            self.open.append(tag)
        if tag == "h2":
            self.heading = ""
        elif tag == "tr":
            self.tables.setdefault(self.heading, []).append([])
        elif tag in ("td", "th"):
            self.tables[self.heading][-1].append("")
        elif tag == "details":
            self.folded.add(self.heading)

    def handle_endtag(self, tag: str) -> None:
        if not self.tags or tag != self.tags[-1][0] or self.open[-1:] == [tag]:
            assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append((self.open[-1] if self.open else "", data))
        if self.open[-1:] == ["h2"]:
            self.heading += data
        if {"td", "th"} & set(self.open) and self.open[-1] != "button":
            self.tables[self.heading][-1][-1] += data

    def rows(self, heading: str) -> list[dict[str, str]]:
        head, *rows = self.tables[heading]
        return [dict(zip(head, row, strict=True)) for row in rows]

    def all_of(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.tags if name == tag]

    def text_in(self, tag: str) -> list[str]:
        return [text for name, text in self.texts if name == tag]


def page(report: Report, program: Program, drawing: Drawing | None = None, title: str = "plate") -> Page:
    return Page(to_html(report, program, drawing=drawing, title=title))
