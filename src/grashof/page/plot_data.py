"""Plots as JSON for the page: columns once, however many plots share them, and no longer than one can see."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from grashof.page.render import compact
from grashof.problems.values.arrays import FloatArray
from grashof.study.limits import greatest_drawn, middle
from grashof.study.section import DRIVER_ANGLE, Plot

Rows = slice | npt.NDArray[np.intp]
_MOST = 1500  # rows of a plot that are shown whole
_DIGITS = 5  # of what varies as much as it is large
_STEADY = 1e-9  # share of its size within which a column is constant
_NOISE = 1e-13  # share of its size below which a value is 0
_PLACES = 7  # digits: steps of a long history have to stay even


class Columns:
    """Columns of numbers, each kept once."""

    def __init__(self) -> None:
        self.found: list[list[float | None]] = []
        self._known: dict[tuple[float | None, ...], int] = {}

    def add(self, values: FloatArray, digits: int = _DIGITS) -> int:
        """The number of a column that has these values, to so many digits or more where they hardly vary."""
        plain, digits = _plain(values, digits)
        column = compact(plain.tolist(), digits)
        number = self._known.setdefault(tuple(column), len(self.found))
        if number == len(self.found):
            self.found.append(column)
        return number


def _plain(values: FloatArray, digits: int) -> tuple[FloatArray, int]:
    """Values of which those are 0 that rounding alone keeps from it, and digits that tell them apart."""
    known = values[np.isfinite(values)]
    if not known.any():
        return values, digits
    size = float(np.quantile(np.abs(known), 0.95))
    spread = float(np.ptp(np.quantile(known, [0.05, 0.95])))
    if spread > _STEADY * size:
        digits = max(digits, int(np.ceil(np.log10(size / spread))) + _DIGITS - 1)
    return np.where(np.abs(values) < _NOISE * size, 0.0, values), digits


def plot_data(plot: Plot, columns: Columns) -> dict[str, Any]:
    """A plot as the scripts draw and save it, with the numbers of its values, which go to `columns`."""
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
    """Up to which size it is drawn, and about which point if it is a track; nothing where all is drawn."""
    most = greatest_drawn(plot)
    if np.isinf(most):
        return {}
    return {"most": most} | ({"middle": middle(plot).tolist()} if plot.places is None else {})


def _xy(points: FloatArray, rows: Rows, columns: Columns) -> list[int]:
    return [columns.add(axis) for axis in points[rows].T]


def _rows(plot: Plot) -> dict[str, Rows]:
    """Rows of each line without which it would look different; the same for all that share a column."""
    every = {label: line.reshape(len(line), -1) for label, line in plot.series.items()}
    if plot.places is None and plot.angles is None:
        return {label: _telling(line) for label, line in every.items()}
    shared = _telling(np.concatenate(list(every.values()), axis=1)) if every else slice(None)
    return dict.fromkeys(every, shared)


def _telling(lines: FloatArray) -> Rows:
    """Of each stretch of a long table the ends, the extremes of every column, and the gaps."""
    if len(lines) <= _MOST:
        return slice(None)
    stretches = np.array_split(np.arange(len(lines)), max(1, _MOST // (2 + 2 * lines.shape[1])))
    kept = [rows[0] + each for rows in stretches for each in _telling_of(lines[rows])]
    return np.unique(np.concatenate(kept))


def _telling_of(lines: FloatArray) -> list[npt.NDArray[np.intp]]:
    gaps = np.isnan(lines)
    least = np.argmin(np.where(gaps, np.inf, lines), axis=0)
    largest = np.argmax(np.where(gaps, -np.inf, lines), axis=0)
    return [np.array([0, len(lines) - 1]), least, largest, np.flatnonzero(gaps.any(axis=1))]
