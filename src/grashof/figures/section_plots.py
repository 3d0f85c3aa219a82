"""Plots of an analysis: those of its sections, the path of P, curves of motion and forces."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from textwrap import wrap
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from grashof.drawing.scene import bodies_of
from grashof.figures.curves import DYNAMICS, KINEMATICS, SLIDE, Panel, cut, draw_curves, mark_driver
from grashof.figures.files import STYLE, fit_title, shortened
from grashof.figures.linkage import figure_of, new_axes, plane, plot_linkage
from grashof.figures.parts import BODY, COLOURS, COUPLER, DRIVER, GROUND, OUTPUT, PATH, SCENE
from grashof.problems.values.arrays import FloatArray
from grashof.study.limits import broken_beyond, greatest_drawn, middle
from grashof.study.section import DRIVER_ANGLE, Plot
from grashof.survey.report import LinkageReport, mass_tracks
from grashof.wording.numbers import with_unit

# Colours and dashes of the first eight lines, as on the page; the next eight are dotted.
PENS: tuple[tuple[str, tuple[int, ...]], ...] = (
    (COUPLER, ()),
    (DRIVER, (7, 3)),
    (PATH, ()),
    (OUTPUT, (3, 3)),
    (BODY, (10, 3, 3, 3)),
    (GROUND, ()),
    (SCENE, (7, 3)),
    ("#8a5a2b", (3, 3)),
)
_AGAIN = (1, 2)
_MARKERS = "osD^vP*X"
_LABEL = 42  # characters per line of an axis label
_CROWD = 6  # number of lines above which the legend has two columns
_KINEMATIC = {
    "angles": ("angle",),
    "velocities": ("angular velocity", "speed"),
    "accelerations": ("angular acceleration", "acceleration"),
}
_SLIDE = {"slide": tuple(SLIDE)}
_DYNAMIC = {"torque": ("torque",), "forces": ("joint force", "shaking force")}


def plot_section(plot: Plot, ax: Axes | None = None) -> Axes:
    """Draw a plot of a section.

    Parameters
    ----------
    plot : Plot
        Curves over their places, or tracks in a plane, and single points.
    ax : Axes, optional

    Returns
    -------
    Axes
        Of tracks with equal scales.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> time, angle = np.linspace(0, 2, 9), np.linspace(0, 90, 9)
    >>> plot = Plot("run-out", "run-out", "deg", {"theta2": angle}, time, "time (s)")
    >>> axes = plot_section(plot, Figure().subplots())
    >>> axes.get_xlabel(), axes.get_ylabel()
    ('time (s)', 'run-out (deg)')
    """
    ax = new_axes(ax)
    most = greatest_drawn(plot)
    drawn = _draw_tracks(ax, plot, most) if plot.places is None else _draw_curves(ax, plot, plot.places, most)
    look: dict[str, Any] = {"linestyle": "none", "markersize": 4.5, "markerfacecolor": "none", "zorder": 4}
    for number, (label, points) in enumerate(plot.points.items()):
        colour, marker = PENS[-1 - number % len(PENS)][0], _MARKERS[number % len(_MARKERS)]
        drawn += ax.plot(*points.T, marker=marker, color=colour, label=label, **look)
    if len(drawn) > 1:
        _name(ax, drawn)
    return ax


def _draw_curves(ax: Axes, plot: Plot, places: FloatArray, most: float) -> list[Line2D]:
    drawn = []
    for number, (label, values) in enumerate(plot.series.items()):
        drawn += ax.plot(places, broken_beyond(values, most), label=label, **_pen(number))
    if np.isfinite(most):
        cut(ax, np.concatenate(list(plot.series.values())), most)
    ax.axhline(0, color=GROUND, linewidth=0.6, zorder=0)
    ax.set_ylabel("\n".join(wrap(with_unit(plot.title, plot.unit), _LABEL)), parse_math=False)
    dead = mark_driver(ax, places, turns=not plot.swings) if plot.over == DRIVER_ANGLE else ""
    ax.set_xlabel(f"{plot.over}{dead}", parse_math=False)
    return drawn


def _draw_tracks(ax: Axes, plot: Plot, most: float) -> list[Line2D]:
    drawn, centre = [], middle(plot)
    for number, (label, track) in enumerate(plot.series.items()):
        near = np.hypot(*(track - centre).T) <= most
        drawn += ax.plot(*np.where(near[:, None], track, np.nan).T, label=label, **_pen(number))
    ax.set_title("\n".join(wrap(plot.title, 80)), parse_math=False)
    plane(ax, plot.unit)
    return drawn


def _pen(number: int) -> dict[str, Any]:
    colour, dashes = PENS[number % len(PENS)]
    lines = _AGAIN if number >= len(PENS) else dashes
    return {"color": colour, "linestyle": (0, lines) if lines else "-", "linewidth": 1.5}


def _name(ax: Axes, lines: list[Line2D]) -> None:
    """The legend, with every label as plain text: none is hidden for its underscore or read as a formula."""
    labels = [str(line.get_label()) for line in lines]
    names = [f" {label}" if label.startswith("_") else label for label in labels]
    legend = ax.legend(lines, names, loc="best", fontsize="small", ncols=1 + (len(lines) > _CROWD))
    for text in legend.get_texts():
        text.set_parse_math(False)


def plots(report: LinkageReport) -> Iterator[tuple[str, Figure]]:
    """Name and figure of each plot; torque and forces only with masses."""
    yield "path", _path(report)
    kinds = [("kinematics", KINEMATICS, _KINEMATIC), ("dynamics", DYNAMICS, _DYNAMIC)]
    if report.sweep.spec.linkage.mechanism.slides:
        kinds.insert(1, ("kinematics", SLIDE, _SLIDE))
    for table, known, files in kinds:
        for name, quantities in files.items() if table in report.tables else ():
            yield name, _curves(report, table, [known[quantity] for quantity in quantities])


def section_pictures(report: LinkageReport) -> Iterator[tuple[str, Figure]]:
    """Name and figure of each plot of a section."""
    for plot in (plot for section in report.sections for plot in section.plots):
        with rc_context(STYLE):
            size = (8.5, 7.0) if plot.places is None else (8.5, 4.0)
            axes = plot_section(plot, Figure(figsize=size, layout="constrained").subplots())
            fit_title(axes, _title(report) if plot.places is not None else f"{_title(report)}\n{plot.title}")
        yield f"plot-{plot.key}", figure_of(axes)


def _curves(report: LinkageReport, table: str, panels: list[Panel]) -> Figure:
    with rc_context(STYLE):
        figure = Figure(figsize=(8.5, 1.6 + 2.4 * len(panels)), layout="constrained")
        rows = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        draw_curves(report.sweep, report.drawn[table], panels, rows)
        fit_title(rows[0], _title(report))
    return figure


def _path(report: LinkageReport) -> Figure:
    with rc_context(STYLE):
        figure = Figure(figsize=(8.5, 7.0), layout="constrained")
        axes = plot_linkage(replace(report.sweep.spec, problem=None), ax=figure.subplots())
        halfway = "" if report.masses is not None else " (halfway)"
        bodies = bodies_of(report.sweep.spec.linkage.mechanism)
        colours = {f"link {body.link.number}": COLOURS[body.role] for body in bodies}
        for name, track in mass_tracks(report).items():
            label = f"centre of mass, {name}{'' if name == 'all links' else halfway}"
            width = 1.6 if name == "all links" else 1.0
            axes.plot(*track.T, "--", color=colours.get(name, GROUND), linewidth=width, label=label)
        axes.legend(loc="best", fontsize="small")
        fit_title(axes, _title(report))
    return figure


def _title(report: LinkageReport) -> str:
    return shortened(report.sweep.spec.title or report.sweep.spec.name)
