"""Samples of the motion over the driver angle or over time, with tables and plots of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from grashof.analysis import Kinematics, solve_kinematics
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.study.section import DRIVER_ANGLE, Plot
from grashof.study.study import LinkageStudy

Columns = Mapping[str, FloatArray]
TIME = "time (s)"
_LATE = 1e-12  # share of the motion


@dataclass(frozen=True, slots=True, eq=False)
class History:
    """The motion over time (N,), s, in equal steps; `total` is the driver angle over all turns, rad.

    In `state` (N,) that angle is reduced to the first turn, for which loads are stated. It is `complete`
    unless a driver that does not turn fully stops at a dead position.
    """

    time: FloatArray
    total: FloatArray
    state: Kinematics
    complete: bool

    @classmethod
    def of(cls, study: LinkageStudy) -> History | None:
        """The requested history, if any; ProblemError where the linkage is open at its start."""
        wanted = time = study.asked.times
        if wanted is None or time is None:
            return None
        if not study.sweep.turns:
            law, gone = study.law_at_start
            time = time[gone + time <= law.duration * (1 + _LATE)]
        motion = study.driver(time)
        angle = motion.theta2 % TURN if study.sweep.turns else motion.theta2
        state = solve_kinematics(study.linkage, *motion._replace(theta2=angle))
        return cls(time, motion.theta2, state, len(time) == len(wanted))

    @property
    def theta2_deg(self) -> FloatArray:
        """Driver angle from 0 to 360 deg, shape (N,)."""
        angle: FloatArray = np.asarray(np.round(np.degrees(self.total), 12), dtype=np.float64) % 360
        return angle


@dataclass(frozen=True, slots=True, eq=False)
class Samples:
    """Samples of a motion (a state for each range, or that of a history), with tables and plots over it.

    `columns` begin each table, a row of NaN between two ranges; with `turns` no rate grows without bound;
    `mark` is appended to the keys of plots and tables, `words` to the titles of plots.
    """

    states: tuple[Kinematics, ...]
    columns: Mapping[str, FloatArray]
    over: str
    turns: bool
    mark: str = ""
    words: str = ""

    @classmethod
    def over_driver(cls, study: LinkageStudy) -> Samples:
        """At the driver angles of the tables."""
        return cls.of(study, tuple(study.states))

    @classmethod
    def of(cls, study: LinkageStudy, states: tuple[Kinematics, ...]) -> Samples:
        """Over the driver angle, in each of its ranges."""
        columns = {"theta2_deg": study.joined([np.degrees(state.theta2) for state in states])}
        if len(states) > 1:
            numbers = [np.full(state.shape, float(number)) for number, state in enumerate(states, start=1)]
            columns = {"range": study.joined(numbers), **columns}
        return cls(states, columns, DRIVER_ANGLE, study.sweep.turns)

    @classmethod
    def over_time(cls, study: LinkageStudy, history: History) -> Samples:
        """At the times of a history."""
        columns = {"time_s": history.time, "theta2_deg": history.theta2_deg}
        return cls((history.state,), columns, TIME, study.sweep.turns, "-over-time", " over time")

    @classmethod
    def requested(cls, study: LinkageStudy) -> Samples:
        """Over time where a history is requested, or else over the driver angle."""
        history = History.of(study)
        return cls.over_driver(study) if history is None else cls.over_time(study, history)

    @property
    def places(self) -> FloatArray:
        """Abscissae of the curves, shape (N,)."""
        return self.columns["theta2_deg" if self.over == DRIVER_ANGLE else "time_s"]

    def plot(self, key: str, title: str, unit: str, series: Mapping[str, FloatArray]) -> Plot:
        """Curves over these samples."""
        angles = None if self.over == DRIVER_ANGLE else self.columns["theta2_deg"]
        shown = np.array if self.turns else line
        finite = {label: shown(values) for label, values in series.items()}
        key, title = f"{key}{self.mark}", f"{title}{self.words}"
        return Plot(key, title, unit, finite, self.places, self.over, angles=angles, bounded=self.turns)

    def table(self, columns: Mapping[str, FloatArray]) -> pd.DataFrame:
        """A row for each sample; empty where a value is not finite."""
        return table({**self.columns, **columns})


def over_driver(study: LinkageStudy, of: Callable[[Kinematics], Columns]) -> dict[str, FloatArray]:
    """Columns (N,), and `key_x`, `key_y` of vectors (N, 2), over the driver angles of the tables.

    They follow "theta2_deg" and, with several ranges, "range"; a row of NaN separates two ranges.
    """
    samples = Samples.over_driver(study)
    joined, parts = dict(samples.columns), [of(state) for state in samples.states]
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
    """Plot of some columns over the driver angle; `labels` has the column of each line."""
    lines = {label: line(columns[column]) for label, column in labels.items()}
    return Plot(key, title, unit, lines, columns["theta2_deg"], DRIVER_ANGLE)


def tracks(
    columns: Columns, key: str, title: str, unit: str, labels: Mapping[str, str], axes: str = "xy"
) -> Plot:
    """Plot of some vectors as tracks in a plane; `labels` has the key of each."""
    series = {label: track(columns, name, axes) for label, name in labels.items()}
    return Plot(key, title, unit, series, angles=columns["theta2_deg"])


def track(columns: Columns, key: str, axes: str = "xy") -> FloatArray:
    """The track of a vector, shape (N, 2); NaN where it is not finite."""
    points = np.stack([columns[f"{key}_{axis}"] for axis in axes], axis=-1)
    return np.where(np.isfinite(points).all(axis=1, keepdims=True), points, np.nan)


def line(values: FloatArray) -> FloatArray:
    """Values of a curve, NaN where it is not finite and where it returns from the other infinity.

    >>> line(np.array([1.0, np.inf, 2.0, 3.0, -3.0, -1.0, 1.0])).tolist()
    [1.0, nan, 2.0, nan, -3.0, -1.0, 1.0]
    """
    found = np.where(np.isfinite(values), values, np.nan)
    # On both sides of a change of sign sizes fall if it is a zero, and grow if it is a pole.
    sizes = np.abs(found)
    before, after = np.append(0.0, sizes[:-2]), np.append(sizes[2:], 0.0)
    with np.errstate(invalid="ignore"):
        through = (found[:-1] * found[1:] < 0) & (sizes[:-1] > before) & (sizes[1:] > after)
    found[:-1][through] = np.nan
    return found
