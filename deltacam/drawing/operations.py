"""What is done with each entity of a drawing: cut, engraved or ignored, by its layer, colour and line type."""

from __future__ import annotations

import difflib
import re
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import translate
from functools import lru_cache
from typing import Final, NamedTuple, Protocol

import numpy as np

from deltacam.errors import DrawingError
from deltacam.model import BoolArray, IntArray, Operation, Rule, Selection

_MOST_NAMES: Final = 20  # of layers in a message


class Styled(Protocol):
    """What the rules look at, of an entity."""

    @property
    def layer(self) -> str:
        """The layer it is drawn on."""

    @property
    def color(self) -> int:
        """AutoCAD colour index as it is seen."""

    @property
    def linetype(self) -> str:
        """The name of its line type as it is seen."""


class Choice(NamedTuple):
    """What is done with an entity.

    Attributes:
        operation: what is done with it.
        open: what is done with it as part of a chain that does not close.
        reason: why it is ignored, in words; empty where it is not.
    """

    operation: Operation
    open: Operation
    reason: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Assignment:
    """What is done with each of N entities.

    Attributes:
        choices: the different ones, in the order in which they first come up.
        index: (N,) which of them is for each entity.
    """

    choices: tuple[Choice, ...]
    index: IntArray

    def __getitem__(self, entity: int) -> Choice:
        return self.choices[int(self.index[entity])]

    def __len__(self) -> int:
        return len(self.index)

    def of(self, operation: Operation) -> BoolArray:
        """Which entities ``operation`` is for, (N,)."""
        return np.array([choice.operation is operation for choice in self.choices], dtype=np.bool_)[self.index]


def assign(entities: Sequence[Styled], selection: Selection) -> Assignment:
    """What is done with each entity.

    An entity outside ``selection.layers`` or on one of ``selection.ignored_layers`` is ignored, whatever the rules say.

    Args:
        entities: N of them.
        selection: the patterns and rules.

    Returns:
        a choice per entity, in their order.
    """
    styles: dict[tuple[str, int, str], int] = {}
    style = [styles.setdefault((one.layer, one.color, one.linetype), len(styles)) for one in entities]
    choices: dict[Choice, int] = {}
    choice = [choices.setdefault(_choose(*one, selection), len(choices)) for one in styles]
    index = np.array(choice, dtype=np.int64)[np.array(style, dtype=np.int64)]
    return Assignment(tuple(choices), index)


def check_patterns(selection: Selection, layers: Sequence[str]) -> None:
    """Refuse a pattern that was given for layers and that fits none of them.

    Args:
        selection: its ``layers`` and ``ignored_layers`` are looked at.
        layers: the names of the layers that hold something.

    Raises:
        DrawingError: names the pattern, and the layers that there are.
    """
    given = (("--layer", selection.layers), ("--ignore-layer", selection.ignored_layers))
    for option, patterns in given:
        for part in (part for pattern in patterns for part in _parts(pattern, layers)):
            if any(matches(part, layer) for layer in layers):
                continue
            near = difflib.get_close_matches(part, layers, n=1)
            what = f"no layer of the drawing is called {part!r}" if _is_name(part) else f"no layer fits {part!r}"
            raise DrawingError(what, where=option, hint=_names(layers, near))


def left_out(layer: str, selection: Selection) -> str:
    """Why the user leaves a layer out, in words; empty where that is not so."""
    if selection.layers and not any(matches(pattern, layer) for pattern in selection.layers):
        return f"layer {layer} is not among --layer"
    if any(matches(pattern, layer) for pattern in selection.ignored_layers):
        return f"layer {layer} is ignored by --ignore-layer"
    return ""


def matches(pattern: str, name: str) -> bool:
    """Whether ``name`` fits ``pattern``, in any case.

    ``*`` stands for any text, ``?`` for one character, a comma separates patterns of which one must fit. A name fits
    itself, whatever is in it.
    """
    return name.casefold() == pattern.casefold() or _compiled(pattern).fullmatch(name.casefold()) is not None


@lru_cache(maxsize=1024)
def _compiled(pattern: str) -> re.Pattern[str]:
    # A bracket means itself; for fnmatch it would begin a set of characters.
    parts = [part.strip().replace("[", "[[]") for part in pattern.casefold().split(",")]
    return re.compile("|".join(f"(?:{translate(part)})" for part in parts))


def _parts(pattern: str, layers: Sequence[str]) -> list[str]:
    """The patterns between the commas; only one where a layer is called so."""
    if any(layer.casefold() == pattern.casefold() for layer in layers):
        return [pattern]
    return [part.strip() for part in pattern.split(",")]


def _is_name(pattern: str) -> bool:
    return not set("*?") & set(pattern)


def _names(layers: Sequence[str], near: Sequence[str]) -> str:
    """The layers that there are, and the one that was probably meant."""
    if not layers:
        return "the drawing has no layer that holds anything"
    more = f" and {len(layers) - _MOST_NAMES} more" if len(layers) > _MOST_NAMES else ""
    names = f"the drawing has {', '.join(map(repr, layers[:_MOST_NAMES]))}{more}"
    return f"did you mean {near[0]!r}? {names}" if near else names


def _choose(layer: str, color: int, linetype: str, selection: Selection) -> Choice:
    """What is done with entities of this look."""
    reason = left_out(layer, selection)
    if reason:
        return _ignored(reason)
    for rule in selection.rules:
        if _applies(rule, layer, color, linetype):
            if rule.operation is Operation.IGNORE:
                return _ignored(f"the process ignores {_look(rule, layer, color, linetype)}")
            return Choice(rule.operation, rule.open)
    return Choice(Operation.CUT, selection.open)


def _ignored(reason: str) -> Choice:
    return Choice(Operation.IGNORE, Operation.IGNORE, reason)


def _applies(rule: Rule, layer: str, color: int, linetype: str) -> bool:
    return (
        (rule.layer is None or matches(rule.layer, layer))
        and (rule.color is None or rule.color == color)
        and (rule.linetype is None or matches(rule.linetype, linetype))
    )


def _look(rule: Rule, layer: str, color: int, linetype: str) -> str:
    """What of an entity made the rule fit, in words."""
    parts = [f"layer {layer}"] if rule.layer is not None else []
    parts += [f"color {color}"] if rule.color is not None else []
    parts += [f"line type {linetype}"] if rule.linetype is not None else []
    return " with ".join(parts[:2]) + "".join(f" and {part}" for part in parts[2:]) if parts else "everything else"
