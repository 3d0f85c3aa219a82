"""The columns of candidates.csv, from the quantities that are declared."""

from __future__ import annotations

from marking import row

from grashof.problems.schema.docstrings import code, sentence
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.problems.values.requirements.quantities import Needs, Quantity, Scope
from grashof.synth.designs.table import ABOUT, COLUMNS, LISTED, NAMES, OWN

_BY_COLUMN = {quantity.column: quantity for quantity in (*LISTED, OWN)}


def column_table() -> str:
    """All columns in their order as a table in Markdown."""
    head = [row("column", "unit", "better", "meaning", "taken over"), "|---|---|---|---|---|"]
    return "\n".join([*head, *(_row(name) for name in (*COLUMNS, OWN.column))])


def _row(name: str) -> str:
    quantity = _BY_COLUMN.get(name)
    if quantity is None:
        words = "" if NAMES[name].replace(" ", "_").lower() == name else NAMES[name]
        text = ": ".join(filter(None, (words, ABOUT.get(name, ""))))
        return row(code(name), "", "", sentence(text), "")
    better = {1: "greater", -1: "smaller", 0: ""}[quantity.better]
    over = "" if quantity.over is Scope.DESIGN else str(quantity.over).partition(",")[0]
    return row(code(name), str(quantity.unit), better, _meaning(quantity), over)


def _meaning(quantity: Quantity) -> str:
    known = (quantity.full, str(quantity.over), "from the first target to the last")
    about = "" if quantity.about in known else quantity.about
    parts = [sentence(quantity.full), sentence(about)]
    if quantity.needs is not Needs.NOTHING:
        parts.append(f"Needs {quantity.needs.value}.")
    if set(quantity.kinds) != set(ONE_LOOP):
        parts.append(f"Of {', '.join(quantity.kinds)}.")
    return " ".join(filter(None, parts))
