"""Where the curves of a section are sampled: over the driver angle, or over time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from grashof.analysis import Kinematics
from grashof.problems.values.arrays import FloatArray
from grashof.study.columns import line, table
from grashof.study.history import TIME, History
from grashof.study.section import DRIVER_ANGLE, Plot
from grashof.study.study import LinkageStudy


@dataclass(frozen=True, slots=True, eq=False)
class Samples:
    """Samples of a motion (a state for each range, or a history's), with tables and plots over it.

    A row of NaN divides two ranges in `columns`, which begin each table; with `turns` no rate grows without
    bound; `mark` is added to the keys of plots and tables, `words` to the titles of plots.
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
    def asked(cls, study: LinkageStudy) -> Samples:
        """Over time where a history is asked for, or else over the driver angle."""
        history = History.of(study)
        return cls.over_driver(study) if history is None else cls.over_time(study, history)

    @property
    def places(self) -> FloatArray:
        """Where curves are drawn, shape (N,)."""
        return self.columns["theta2_deg" if self.over == DRIVER_ANGLE else "time_s"]

    def plot(self, key: str, title: str, unit: str, series: Mapping[str, FloatArray]) -> Plot:
        """Curves over these samples."""
        angles = None if self.over == DRIVER_ANGLE else self.columns["theta2_deg"]
        shown = np.array if self.turns else line
        finite = {label: shown(values) for label, values in series.items()}
        return Plot(
            f"{key}{self.mark}", f"{title}{self.words}", unit, finite, self.places, self.over, angles=angles,
            bounded=self.turns,
        )  # fmt: skip

    def table(self, columns: Mapping[str, FloatArray]) -> pd.DataFrame:
        """A row for each sample; empty where a value is not finite."""
        return table({**self.columns, **columns})
