"""The table of a sweep: a row for each combination and design that is listed."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from grashof.sweep.combinations import Combination
from grashof.sweep.task import OBJECTIVE
from grashof.synth.designs.table import COLUMNS, LISTED

_FIRST = ("combination", "status", "designs")
_WHOLE = {"combination", "designs", "rank", "direction", "assembly", "start", "iterations"}
_TRUTH = {"pareto", "circuit_ok", "branch_ok", "order_ok", "full_rotation"}
_NUMBERS = {quantity.column for quantity in LISTED} | {OBJECTIVE}


def varied_columns(combinations: Sequence[Combination]) -> tuple[str, ...]:
    """Columns that distinguish the combinations."""
    return tuple(dict.fromkeys(key for one in combinations for key in one.cells))


def sweep_frame(
    combinations: Sequence[Combination], results: Mapping[int, Mapping[str, Any]]
) -> pd.DataFrame:
    """A row for each design of the combinations finished (`results` of `solve_task`), in their order.

    It has ``combination`` (from 1), the varied keys, ``status``, ``designs`` (number found), the columns of
    candidates.csv and ``note``, the obstacle.
    """
    varied = varied_columns(combinations)
    rows = [
        {
            "combination": number + 1,
            **{key: _cell(value) for key, value in combinations[number].cells.items()},
            "status": result["status"],
            "designs": result["found"],
            **design,
            "note": result["note"] or None,
        }
        for number, result in sorted(results.items())
        for design in result["designs"] or [{}]
    ]
    own = [OBJECTIVE] if any(OBJECTIVE in row for row in rows) else []
    names = [_FIRST[0], *varied, *_FIRST[1:], *COLUMNS, *own, "note"]
    return pd.DataFrame({name: _series(name, [row.get(name) for row in rows], varied) for name in names})


def _series(name: str, values: list[Any], varied: Sequence[str]) -> pd.Series[Any]:
    """A column of one type, so that missing values do not turn integers into floats."""
    if name in varied:
        return _of_any(values)
    if name in _NUMBERS:
        return pd.Series([None if value is None else float(value) for value in values], dtype="float64")
    kind = "Int64" if name in _WHOLE else "boolean" if name in _TRUTH else "string"
    return pd.Series(values, dtype=kind)


def _of_any(values: list[Any]) -> pd.Series[Any]:
    known = [value for value in values if value is not None]
    kinds = {type(value) for value in known}
    if known and kinds == {bool}:
        return pd.Series(values, dtype="boolean")
    if known and kinds == {int} and all(abs(value) < 2**63 for value in known):
        return pd.Series(values, dtype="Int64")
    if known and kinds <= {int, float}:
        return pd.Series([None if value is None else float(value) for value in values], dtype="float64")
    return pd.Series([value if value is None else _text(value) for value in values], dtype="string")


def _cell(value: Any) -> Any:
    """A value of the problem file in a cell; lists and tables as text."""
    return json.dumps(value, ensure_ascii=False, default=str) if isinstance(value, (list, dict)) else value


def _text(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
