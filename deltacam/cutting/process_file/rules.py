"""Which lines of a drawing are cut, engraved or ignored, as a process file says it."""

from __future__ import annotations

from typing import Final

from deltacam.model import DEFAULT_RULES, Operation, Rule
from deltacam.settings import REQUIRED, Required, Table

COLORS: Final = {"red": 1, "yellow": 2, "green": 3, "cyan": 4, "blue": 5, "magenta": 6, "white": 7}
"""The names of AutoCAD's colours; white is shown black on white paper."""

_OPERATIONS: Final = tuple(Operation)


def read_rules(table: Table) -> tuple[tuple[Rule, ...], Operation]:
    """The rules, those of `DEFAULT_RULES` where the file has none, and what is done with open lines that none matches.

    Raises:
        DeltacamError: a rule is wrong, or one is never used.
    """
    open_lines = _operation(table, "open", Operation.IGNORE)
    if not table.has("operations"):
        return DEFAULT_RULES, open_lines
    tables = table.tables("operations")
    rules = tuple(_rule(one, open_lines) for one in tables)
    for one, rule in zip(tables[:-1], rules[:-1], strict=True):
        if rule.layer is None and rule.color is None and rule.linetype is None:
            hint = "move it to the end, or give it a layer, color or linetype"
            raise one.problem("it matches everything, so that those after it are never used", hint=hint)
    return rules, open_lines


def _rule(table: Table, open_lines: Operation) -> Rule:
    operation = _operation(table, "do")
    if operation is Operation.IGNORE and table.has("open"):
        raise table.problem('open says nothing where do = "ignore"', hint="leave one of them out")
    return Rule(
        operation=operation,
        layer=table.text("layer") if table.has("layer") else None,
        color=table.integer("color", minimum=1, maximum=255, names=COLORS) if table.has("color") else None,
        linetype=table.text("linetype") if table.has("linetype") else None,
        open=_operation(table, "open", open_lines if operation is Operation.CUT else operation),
    )


def _operation(table: Table, key: str, default: Operation | Required = REQUIRED) -> Operation:
    return Operation(table.choice(key, _OPERATIONS, default=default))
