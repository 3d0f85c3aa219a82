"""Plots as JSON for the page: shared columns once, and no more rows than are visible."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from grashof.page.render import compact
from grashof.problems.values.arrays import FloatArray
from grashof.study.limits import greatest_drawn, middle
from grashof.study.section import DRIVER_ANGLE, Plot

Rows = slice | npt.NDArray[np.intp]
_MOST = 1500  # rows up to which a plot is shown completely
_DIGITS = 5  # of columns that vary as much as their size
_STEADY = 1e-9  # share of its size within which a column is constant
_NOISE = 1e-13  # share of its size below which a value is 0
_PLACES = 7  # digits of abscissae, so that steps of a long history stay even


class Columns:
    """Columns of numbers, each kept once."""

    def __init__(self) -> None:
        self.found: list[list[float | None]] = []
        self._known: dict[tuple[float | None, ...], int] = {}

    def add(self, values: FloatArray, digits: int = _DIGITS) -> int:
        """The number of a column with these values, to `digits`, or more where they hardly vary."""
        plain, digits = _plain(values, digits)
        column = compact(plain.tolist(), digits)
        number = self._known.setdefault(tuple(column), len(self.found))
        if number == len(self.found):
            self.found.append(column)
        return number


def _plain(values: FloatArray, digits: int) -> tuple[FloatArray, int]:
    """The values with rounding replaced by 0, and the digits that distinguish them."""
    known = values[np.isfinite(values)]
    if not known.any():
        return values, digits
    size = float(np.quantile(np.abs(known), 0.95))
    spread = float(np.ptp(np.quantile(known, [0.05, 0.95])))
    if spread > _STEADY * size:
        digits = max(digits, int(np.ceil(np.log10(size / spread))) + _DIGITS - 1)
    return np.where(np.abs(values) < _NOISE * size, 0.0, values), digits


def plot_data(plot: Plot, columns: Columns) -> dict[str, Any]:
    """A plot for the scripts, with the numbers of its columns, which are added to `columns`."""
    shown: dict[str, Any] = {"key": plot.key, "title": plot.title, "unit": plot.unit, **_bounds(plot)}
    rows = _rows(plot)
    if plot.places is None:
        shown["series"] = [
            {"label": label, "xy": _xy(track, rows[label], columns)} for label, track in plot.series.items()
        ]
    else:
        shared = next(iter(rows.values()), slice(None))
        shown |= {} if plot.over == DRIVER_ANGLE else {"over": plot.over}
        shown["places"] = columns.add(plot.places[shared], _PLACES)
        shown["series"] = [
            {"label": label, "values": columns.add(values[shared])} for label, values in plot.series.items()
        ]
    angles = plot.places if plot.over == DRIVER_ANGLE and plot.places is not None else plot.angles
    if angles is not None:
        shown["angles"] = columns.add(angles[next(iter(rows.values()), slice(None))], _PLACES)
    if plot.points:
        shown["points"] = [
            {"label": label, "xy": _xy(np.reshape(points, (-1, 2)), slice(None), columns)}
            for label, points in plot.points.items()
        ]
    return shown


def is_thinned(plot: Plot) -> bool:
    """Whether the page has only some of the rows of a plot.

    >>> time = np.linspace(0, 9, 2001)
    >>> is_thinned(Plot("swing", "swing", "deg", {"theta2": np.sin(time)}, time, "time (s)"))
    True
    """
    return any(not isinstance(rows, slice) for rows in _rows(plot).values())


def _bounds(plot: Plot) -> dict[str, Any]:
    """Size up to which it is drawn, and for tracks the middle; empty where all is drawn."""
    most = greatest_drawn(plot)
    if np.isinf(most):
        return {}
    return {"most": most} | ({"middle": middle(plot).tolist()} if plot.places is None else {})


def _xy(points: FloatArray, rows: Rows, columns: Columns) -> list[int]:
    return [columns.add(axis) for axis in points[rows].T]


def _rows(plot: Plot) -> dict[str, Rows]:
    """The rows of each line that determine its look; the same for all that share a column."""
    every = {label: line.reshape(len(line), -1) for label, line in plot.series.items()}
    if plot.places is None and plot.angles is None:
        return {label: _kept_rows(line) for label, line in every.items()}
    shared = _kept_rows(np.concatenate(list(every.values()), axis=1)) if every else slice(None)
    return dict.fromkeys(every, shared)


def _kept_rows(lines: FloatArray) -> Rows:
    """Rows of the ends, the extremes of every column and the gaps in each stretch of a long table."""
    if len(lines) <= _MOST:
        return slice(None)
    stretches = np.array_split(np.arange(len(lines)), max(1, _MOST // (2 + 2 * lines.shape[1])))
    kept = [rows[0] + each for rows in stretches for each in _kept_of(lines[rows])]
    return np.unique(np.concatenate(kept))


def _kept_of(lines: FloatArray) -> list[npt.NDArray[np.intp]]:
    gaps = np.isnan(lines)
    least = np.argmin(np.where(gaps, np.inf, lines), axis=0)
    largest = np.argmax(np.where(gaps, -np.inf, lines), axis=0)
    return [np.array([0, len(lines) - 1]), least, largest, np.flatnonzero(gaps.any(axis=1))]
