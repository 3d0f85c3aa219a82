"""Columns of values over the driver angle, for the tables and plots of a section."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import pandas as pd

from grashof.analysis import Kinematics
from grashof.problems.values.arrays import FloatArray
from grashof.study.section import DRIVER_ANGLE, Plot
from grashof.study.study import LinkageStudy

Columns = Mapping[str, FloatArray]


def over_driver(study: LinkageStudy, of: Callable[[Kinematics], Columns]) -> dict[str, FloatArray]:
    """Columns (N,), and `key_x`, `key_y` of vectors (N, 2), over the driver angles of the tables.

    After "theta2_deg", and "range" where there are two, which a row of NaN divides.
    """
    states = study.states
    joined = {"theta2_deg": study.joined([np.degrees(state.theta2) for state in states])}
    if len(states) > 1:
        ranges = [np.full(state.shape, float(number)) for number, state in enumerate(states, start=1)]
        joined = {"range": study.joined(ranges), **joined}
    parts = [of(state) for state in states]
    for key in parts[0]:
        values = study.joined([part[key] for part in parts])
        joined |= components(key, values) if values.ndim == 2 else {key: values}
    return joined


def components(key: str, vectors: FloatArray) -> dict[str, FloatArray]:
    """The columns of a vector, shape (N, 2)."""
    return {f"{key}_{axis}": vectors[:, index] for index, axis in enumerate("xy")}


def table(columns: Columns) -> pd.DataFrame:
    """A row for each driver angle; empty where a value is not finite."""
    frame = pd.DataFrame(columns).replace([np.inf, -np.inf], np.nan).dropna(subset="theta2_deg")
    frame["theta2_deg"] = frame["theta2_deg"].round(12)
    return frame.astype({"range": int}) if "range" in frame else frame


def curves(columns: Columns, key: str, title: str, unit: str, labels: Mapping[str, str]) -> Plot:
    """Plot of some columns over the driver angle; `labels` gives the column of each line."""
    lines = {label: line(columns[column]) for label, column in labels.items()}
    return Plot(key, title, unit, lines, columns["theta2_deg"], DRIVER_ANGLE)


def tracks(
    columns: Columns, key: str, title: str, unit: str, labels: Mapping[str, str], axes: str = "xy"
) -> Plot:
    """Plot of some vectors as tracks in a plane; `labels` gives the key of each."""
    series = {label: track(columns, name, axes) for label, name in labels.items()}
    return Plot(key, title, unit, series, angles=columns["theta2_deg"])


def track(columns: Columns, key: str, axes: str = "xy") -> FloatArray:
    """The track of a vector, shape (N, 2); NaN where it is not finite."""
    points = np.stack([columns[f"{key}_{axis}"] for axis in axes], axis=-1)
    return np.where(np.isfinite(points).all(axis=1, keepdims=True), points, np.nan)


def line(values: FloatArray) -> FloatArray:
    """Values of a curve, NaN where it is not finite and where it comes back from the other infinity.

    >>> line(np.array([1.0, np.inf, 2.0, 3.0, -3.0, -1.0, 1.0])).tolist()
    [1.0, nan, 2.0, nan, -3.0, -1.0, 1.0]
    """
    found = np.where(np.isfinite(values), values, np.nan)
    # Towards zero sizes fall on both sides of a change of sign, towards infinity they grow.
    sizes = np.abs(found)
    before, after = np.append(0.0, sizes[:-2]), np.append(sizes[2:], 0.0)
    with np.errstate(invalid="ignore"):
        through = (found[:-1] * found[1:] < 0) & (sizes[:-1] > before) & (sizes[1:] > after)
    found[:-1][through] = np.nan
    return found
