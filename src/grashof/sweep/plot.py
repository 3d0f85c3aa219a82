"""The trade-off of a sweep as a plot: over one varied number, over two, or of the best designs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib import colormaps, rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

from grashof.figures.files import STYLE, shortened
from grashof.figures.linkage import figure_of
from grashof.figures.parts import COUPLER, DRIVER, GROUND, KEPT_OUT, OUTPUT
from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.sweep.result import Sweep
from grashof.wording.numbers import with_unit

_WRITTEN = 144  # cells of a grid up to which each has its number
_ROUNDING = 1e-6  # of a value
_NAMED = 60  # points up to which each has the number of its combination


def plot_sweep(done: Sweep, frame: pd.DataFrame) -> Figure:
    """The trade-off of a sweep, whose table is `frame`.

    Over one varied number the deciding quantity and the size of the best designs; over two the same as grids;
    else one against the other, with the Pareto-optimal ones joined.
    """
    with rc_context(STYLE):
        best = frame.drop_duplicates("combination")
        decides, size = measures(done, best)
        keys = number_axes(done)
        if len(keys) == 1:
            figure = _over_one(best, keys[0], decides, size)
        elif len(keys) == 2:
            figure = Figure(figsize=(7.0, 8.0), layout="constrained")
            for axes, measure in zip(figure.subplots(2, 1), (decides, size), strict=True):
                _grid(axes, best, keys, measure)
        else:
            figure = _front(best, decides, size, joined=common_unit(done) is not None)
        figure.suptitle(shortened(done.study.title or done.study.name), fontsize=10, parse_math=False)
    return figure


def number_axes(done: Sweep) -> tuple[str, ...]:
    """The one or two varied numbers of the axes, of keys in step the first number; empty for other sweeps."""
    axes = [keys for keys in done.study.axes if len(done.study.vary[keys[0]]) > 1]
    numeric = [next((key for key in keys if _is_numeric(done.study.vary[key])), "") for keys in axes]
    return tuple(numeric) if all(numeric) and len(done.study.sources) == 1 and len(numeric) <= 2 else ()


def _is_numeric(values: Sequence[Any]) -> bool:
    return all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values)


def measures(done: Sweep, best: pd.DataFrame) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
    """The deciding quantity, where it is the same in all combinations, or the transmission angle; the size.

    An error within rounding decides nothing.
    """
    known = decisions(done)
    size = {"column": "size", "label": with_unit("size", common_unit(done) or ""), "better": -1}
    met = (best["error"].fillna(0.0) <= _ROUNDING * best["size"].fillna(1.0)).all()
    columns = {each["column"] for each in known}
    if len(columns) == 1 and not (met and columns == {"error"}):
        same = all(each["label"] == known[0]["label"] for each in known)
        return known[0] if same else {**known[0], "label": known[0]["label"].partition(" (")[0]}, size
    quantity = QUANTITIES["transmission_min_task"]
    return {"column": quantity.column, "label": f"{quantity.words} (deg)", "better": 1}, size


def decisions(done: Sweep) -> list[Mapping[str, Any]]:
    """The deciding quantity of each combination with designs, see `grashof.sweep.task.decides_of`."""
    return [result["decides"] for result in done.results.values() if result["decides"] is not None]


def common_unit(done: Sweep) -> str | None:
    """The length unit of all combinations with designs; None without any, or where it differs."""
    units = {each["length_unit"] for each in decisions(done)}
    return units.pop() if len(units) == 1 else None


def _over_one(best: pd.DataFrame, key: str, decides: Mapping[str, Any], size: Mapping[str, Any]) -> Figure:
    figure = Figure(figsize=(7.0, 6.0), layout="constrained")
    panels = figure.subplots(2, sharex=True)
    rows = best.sort_values(key, kind="stable")
    places = rows[key].to_numpy(dtype=np.float64)
    for axes, measure, colour in zip(panels, (decides, size), (COUPLER, DRIVER), strict=True):
        values = rows[measure["column"]].to_numpy(dtype=np.float64)
        axes.plot(places, np.where(np.isfinite(values), values, np.nan), marker="o", color=colour)
        axes.set_ylabel(measure["label"], parse_math=False)
        without = places[~np.isfinite(values)]
        axes.margins(y=0.12)
        axes.ticklabel_format(useOffset=False)
        if _alike(values):
            axes.set_ylim(*_about(values))
        if len(without):
            low = np.full(len(without), 0.03)
            at_bottom = {"transform": axes.get_xaxis_transform(), "label": "no design"}
            axes.plot(without, low, "x", color=GROUND, **at_bottom)
            axes.legend(loc="best", fontsize="small")
    panels[1].set_xlabel(key, parse_math=False)
    return figure


def _alike(values: FloatArray) -> bool:
    """Whether values differ by no more than a search leaves open, which would fill the axis."""
    known = values[np.isfinite(values)]
    return bool(known.size) and float(np.ptp(known)) <= _ROUNDING * float(np.abs(known).max())


def _about(values: FloatArray) -> tuple[float, float]:
    """Limits of an axis about values that are alike."""
    middle = float(np.nanmean(np.where(np.isfinite(values), values, np.nan)))
    return middle - 0.05 * (abs(middle) or 1.0), middle + 0.05 * (abs(middle) or 1.0)


def _grid(axes: Axes, best: pd.DataFrame, keys: Sequence[str], measure: Mapping[str, Any]) -> None:
    """Values as colours, the better ones bright, the first key to the right and the second one up."""
    across, up = (sorted(set(best[key])) for key in keys)
    values = np.full((len(up), len(across)), np.nan)
    for x, y, value in zip(*(best[name] for name in (*keys, measure["column"])), strict=True):
        values[up.index(y), across.index(x)] = value if np.isfinite(value) else np.nan
    scale = colormaps["viridis" if measure["better"] > 0 else "viridis_r"].with_extremes(bad="none")
    axes.set_facecolor("#e4e6e8")
    low, high = _about(values) if _alike(values) else (None, None)
    masked = np.ma.masked_invalid(values)
    shown = axes.imshow(masked, cmap=scale, vmin=low, vmax=high, origin="lower", aspect="auto")
    axes.grid(visible=False)
    for axis, key, numbers in ((axes.xaxis, keys[0], across), (axes.yaxis, keys[1], up)):
        labels = [f"{number:g}" for number in numbers]
        every = max(1, -(-len(labels) // 12))
        axis.set_ticks(range(0, len(labels), every), labels[::every])
        axis.set_label_text(key, parse_math=False)
    if values.size <= _WRITTEN:
        _write(axes, values, shown)
    if np.isfinite(values).any():
        figure_of(axes).colorbar(shown, ax=axes).set_label(measure["label"], parse_math=False)


def _write(axes: Axes, values: FloatArray, shown: AxesImage) -> None:
    colours = shown.to_rgba(np.ma.masked_invalid(values))
    for (row, column), value in np.ndenumerate(values):
        text, colour = "none", GROUND
        if np.isfinite(value):
            red, green, blue = colours[row, column, :3]
            text = f"{value:.4g}"
            colour = "white" if 0.3 * red + 0.59 * green + 0.11 * blue < 0.5 else "black"
        axes.text(column, row, text, ha="center", va="center", color=colour, fontsize="small")


def _front(
    best: pd.DataFrame, decides: Mapping[str, Any], size: Mapping[str, Any], *, joined: bool
) -> Figure:
    figure = Figure(figsize=(7.0, 5.8), layout="constrained")
    axes = figure.subplots()
    costs = np.array(best[["size", decides["column"]]], dtype=np.float64)
    known = np.isfinite(costs).all(axis=1)
    numbers, costs = best["combination"].to_numpy()[known], costs[known]
    axes.plot(*costs.T, "o", color=COUPLER, markersize=5, label="best design of a combination", zorder=3)
    front = costs[not_beaten(costs * [1.0, -decides["better"]])]
    if joined:  # sizes in different units do not compare
        style: dict[str, Any] = {"markersize": 10, "fillstyle": "none", "linewidth": 1}
        axes.plot(*front[np.argsort(front[:, 0])].T, "o--", color=OUTPUT, label="Pareto-optimal", **style)
    if len(costs) <= _NAMED:
        look: dict[str, Any] = {"textcoords": "offset points", "fontsize": "small", "color": KEPT_OUT}
        for number, place in zip(numbers, costs, strict=True):
            axes.annotate(f"{number}", tuple(place), (6, 5), **look)
    axes.set_xlabel(size["label"], parse_math=False)
    axes.set_ylabel(decides["label"], parse_math=False)
    axes.ticklabel_format(useOffset=False)
    if len(costs):
        axes.legend(loc="best", fontsize="small")
    else:
        axes.text(0.5, 0.5, "no design", ha="center", transform=axes.transAxes)
    return figure


def not_beaten(costs: FloatArray) -> BoolArray:
    """Which rows of costs (N, 2) no other row beats; shape (N,)."""
    rows, places = np.unique(costs, axis=0, return_inverse=True)
    least = np.minimum.accumulate(np.append(np.inf, rows[:, 1]))[:-1]  # of the rows before each
    kept: BoolArray = (rows[:, 1] < least)[places.ravel()]
    return kept
