"""Rows of numbers that loads, rods and motors follow, given under the key `values`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import GREATEST, finite_rows
from grashof.problems.values.errors import ProblemError

Rows = tuple[tuple[float, ...], ...]
_TURN = 360.0  # deg


def rising_rows(
    values: object, columns: int, means: str, rising: Sequence[str], *, least: str = "two"
) -> FloatArray:
    """Checked rows (N, `columns`), as `means` tells; the first columns, named in `rising`, have to rise."""
    table = finite_rows(values, columns, "values", means, GREATEST)  # type: ignore[arg-type]
    if len(table) < {"two": 2, "three": 3}[least]:
        raise ProblemError(f"values has {len(table)} rows; it must have {least} or more")
    for column, name in enumerate(rising):
        for row in np.flatnonzero(~(np.diff(table[:, column]) > 0)) + 1:
            given = f"values[{row}] has {name} {table[row, column]:.15g}"
            raise ProblemError(f"{given}; it must rise from row to row")
    return table


def refuse_open(table: FloatArray, over: str) -> None:
    """Refuse rows over an angle (deg) that do not cover a turn, or end otherwise than they begin."""
    first, last = table[0, 0], table[-1, 0]
    if abs(last - first - _TURN) > 1e-9:
        raise ProblemError(
            f"values cover {over} {first:.15g} to {last:.15g} deg; they must cover a turn, as 0 to 360"
        )
    if (table[0, 1:] != table[-1, 1:]).any():
        raise ProblemError("values end otherwise than they begin; a turn ends as it begins")


def as_rows(table: FloatArray) -> Rows:
    """The rows as tuples."""
    return tuple(tuple(row) for row in table.tolist())
