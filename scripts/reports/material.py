"""Material of the items: analyses, figures of their plots, tables."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import cycle
from typing import Any

import numpy as np
import pandas as pd
from matplotlib import rc_context
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from grashof.figures import plot_section
from grashof.figures.files import STYLE
from grashof.problems import LinkageSpec
from grashof.problems.values.arrays import FloatArray
from grashof.sections import sections_of
from grashof.study.asked import Asked
from grashof.study.section import Plot
from grashof.study.study import LinkageStudy
from grashof.study.sweep import dead_positions_unwarned

WIDTH, HEIGHT = 8.5, 4.2
PUBLISHED = "as published"  # ending of the names of the report's lines
_RED, _DOTS = "#b03a2e", ((1, 1.2), (4, 1.2, 1, 1.2))


@dataclass(frozen=True, slots=True, eq=False)
class Made:
    """Counterpart of a figure or table: pictures, still or moving, and tables, by the ends of their names."""

    figures: Mapping[str, Figure | FuncAnimation] = field(default_factory=dict)
    tables: Mapping[str, pd.DataFrame] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class Analysis:
    """Plots and tables of the sections of an analysis, by key."""

    study: LinkageStudy
    plots: Mapping[str, Plot]
    tables: Mapping[str, pd.DataFrame]

    @classmethod
    def of(cls, spec: LinkageSpec, **asked: Any) -> "Analysis":
        """The analysis of a linkage, requested as by `grashof analyse`."""
        study = LinkageStudy.of(spec, Asked(**asked))
        with dead_positions_unwarned():
            sections = sections_of(study)
        plots = {plot.key: plot for section in sections for plot in section.plots}
        tables = {key: table for section in sections for key, table in section.tables.items()}
        return cls(study, plots, tables)

    def over_angle(self, key: str) -> Plot:
        """A plot over time as one over the driver's angle, counted on from turn to turn."""
        angle = self.tables["over-time"]["theta2_total_deg"].to_numpy()
        return replace(
            self.plots[f"{key}-over-time"],
            title=self.plots[f"{key}-over-time"].title.removesuffix(" over time"),
            places=angle, over="driver angle theta2, counted on (deg)",
        )  # fmt: skip


def lines(plot: Plot, wanted: Sequence[str] = (), besides: Mapping[str, FloatArray] | None = None) -> Plot:
    """Some or all lines of a plot, and additional ones; a single number is a level."""
    chosen = {label: values for label, values in plot.series.items() if not wanted or label in wanted}
    count = 0 if plot.places is None else len(plot.places)
    more = {label: np.broadcast_to(np.asarray(values), count) for label, values in (besides or {}).items()}
    return replace(plot, series={**chosen, **more}, bounded=True)


def pictured(height: float, plot: Callable[..., object], *given: Any, **named: Any) -> Figure:
    """A figure of what a function plots on its axes."""
    with rc_context(STYLE):
        figure = Figure(figsize=(WIDTH, height), layout="constrained")
        plot(*given, ax=figure.subplots(), **named)
    return figure


def drawn(*plots: Plot, beside: bool = False) -> Figure:
    """A figure with a panel for each plot, one above the other or beside it; published lines are dotted."""
    with rc_context(STYLE):
        tracks = plots[0].places is None
        size = (WIDTH, (5.2 if tracks else HEIGHT) if len(plots) == 1 or beside else 1.4 + 2.8 * len(plots))
        figure = Figure(figsize=size, layout="constrained")
        shape = (1, len(plots)) if beside else (len(plots), 1)
        for plot, axes in zip(plots, figure.subplots(*shape, squeeze=False).ravel(), strict=True):
            published = {label: values for label, values in plot.series.items() if label.endswith(PUBLISHED)}
            ours = {label: values for label, values in plot.series.items() if label not in published}
            plot_section(replace(plot, series=ours), axes)
            for (label, values), dots in zip(published.items(), cycle(_DOTS), strict=False):
                axes.plot(plot.places, values, color=_RED, linestyle=(0, dots), linewidth=1.3, label=label)
            if not tracks:
                _name_above(axes)
    return figure


def _name_above(axes: Axes) -> None:
    """The legend over the axes, where it hides no line."""
    if old := axes.get_legend():
        old.remove()
    named = [line for line in axes.lines if not str(line.get_label()).startswith("_")]
    if len(named) > 1:
        columns = min(len(named), 4)
        axes.legend(
            handles=named, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, frameon=False,
            fontsize="small", borderaxespad=0.2,
        )  # fmt: skip


def numbers_of(plot: Plot) -> pd.DataFrame:
    """The numbers that a plot shows."""
    if plot.places is not None:
        return pd.DataFrame({plot.over: plot.places, **plot.series}).dropna(subset=plot.over)
    parts = [
        pd.DataFrame({"line": label, "x": track[:, 0], "y": track[:, 1]}).dropna()
        for label, track in {**plot.series, **plot.points}.items()
    ]
    return pd.concat(parts, ignore_index=True)


def shown(*plots: Plot, beside: bool = False) -> Made:
    """Plots with their numbers."""
    tables = {plot.key if len(plots) > 1 else "": numbers_of(plot) for plot in plots}
    return Made({"": drawn(*plots, beside=beside)}, tables)
