"""Drawings written with ezdxf and read back."""

from collections.abc import Callable
from itertools import count
from typing import Any

import ezdxf
import pytest

from deltacam.drawing.reader import read_drawing
from deltacam.model import Drawing

Draw = Callable[[Any], None]
Reread = Callable[..., Drawing]


@pytest.fixture(scope="session")
def reread(tmp_path_factory: pytest.TempPathFactory) -> Reread:
    """A function that reads what ``draw(modelspace)`` draws, in mm unless told otherwise."""
    folder = tmp_path_factory.mktemp("dxf")
    numbers = count()

    def read(draw: Draw, *, insunits: int = 4, version: str = "R2010", **options: Any) -> Drawing:
        document = ezdxf.new(version)
        document.header["$INSUNITS"] = insunits
        draw(document.modelspace())
        path = folder / f"{next(numbers)}.dxf"
        document.saveas(path)
        return read_drawing(path, **options)

    return read
