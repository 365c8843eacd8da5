"""The rooms: who may import whom, and where the heavy libraries may appear."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent

MAY_IMPORT = {
    "errors": set(),
    "machine": set(),
    "plain": set(),
    "units": {"errors"},
    "settings": {"errors", "units"},
    "defaults": {"errors", "units", "settings"},
    "model": {"errors", "units"},
    "geometry": {"errors", "units", "model"},
    "robot": {"errors", "units", "settings", "model", "geometry"},
    "drawing": {"errors", "units", "model", "geometry"},
    "cutting": {"errors", "units", "settings", "model", "geometry", "robot"},
    "motion": {"errors", "machine", "units", "model", "geometry", "robot"},
    "placing": {"errors", "units", "model", "geometry", "robot", "cutting", "motion"},
    "program": {"errors", "units", "model", "geometry", "robot"},
    "verification": {"errors", "units", "model", "geometry", "robot", "drawing", "program"},
    "report": {"errors", "plain", "units", "model", "geometry", "robot", "program", "verification", "placing"},
    "inspection": {"errors", "plain", "units", "model", "geometry"},
    "examine": {"errors", "model", "robot", "drawing", "cutting", "program", "verification"},
    "compare": {"errors", "model", "robot", "drawing", "cutting", "pipeline"},
    "batch": {
        "errors",
        "machine",
        "plain",
        "units",
        "settings",
        "defaults",
        "model",
        "geometry",
        "drawing",
        "inspection",
        "program",
        "report",
        "pipeline",
    },
    "pipeline": {
        "errors",
        "units",
        "model",
        "geometry",
        "robot",
        "drawing",
        "cutting",
        "motion",
        "placing",
        "program",
        "verification",
        "report",
    },
}
"""For each room, the rooms that it may import besides itself."""

ONLY_IN = {
    "ezdxf": ("deltacam/drawing/",),
    "toppra": ("deltacam/motion/parametrize.py",),
    "click": ("cli/",),
    "distributed": ("deltacam/batch/cluster/connection.py",),
    "filelock": ("deltacam/batch/results/folder.py",),
    "pyarrow": ("deltacam/program/parquet.py",),
    "shapely": ("deltacam/drawing/", "deltacam/cutting/", "deltacam/verification/"),
}
"""For each library, the only places that may import it."""

SOURCES = sorted([*ROOT.glob("deltacam/**/*.py"), *ROOT.glob("cli/**/*.py")])


def imports(path: Path) -> Iterator[str]:
    """The dotted names that a file imports, wherever in the file."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            yield from (f"{node.module}.{name.name}" for name in node.names)


def room(dotted: str) -> str | None:
    """The room of ours that a dotted name lies in."""
    parts = dotted.split(".")
    return parts[1] if parts[0] == "deltacam" and len(parts) > 1 else None


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_room_imports_only_the_rooms_above_it(path: Path) -> None:
    parts = path.relative_to(ROOT).with_suffix("").parts
    if parts[0] == "cli" or parts == ("deltacam", "__init__"):
        return
    own = parts[1]
    assert own in MAY_IMPORT, f"a new room {own!r}: say here what it may import"
    found = {there for name in imports(path) if (there := room(name)) is not None and there != own}
    assert found <= MAY_IMPORT[own]


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_heavy_libraries_appear_only_in_their_rooms(path: Path) -> None:
    place = path.relative_to(ROOT).as_posix()
    for library, homes in ONLY_IN.items():
        if any(name.split(".")[0] == library for name in imports(path)):
            assert place.startswith(homes), f"{place} imports {library}"


def test_the_picture_of_the_rooms_has_no_way_around() -> None:
    # The rule is only worth something if it is an order: nobody reaches themselves.
    def reach(start: str) -> set[str]:
        return set().union(*({one} | reach(one) for one in MAY_IMPORT[start]))

    assert all(own not in reach(own) for own in MAY_IMPORT)
    assert {"cutting", "motion"}.isdisjoint(reach("verification"))


def test_no_source_file_is_longer_than_it_should_be() -> None:
    long = {
        str(path.relative_to(ROOT)): n for path in SOURCES if (n := len(path.read_text("utf-8").splitlines())) > 350
    }
    assert long == {}
