"""Plots of an analysed linkage: what turns how fast, the path of P, torque and forces."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from matplotlib import rc_context
from matplotlib.figure import Figure

from grashof.drawing.scene import bodies_of
from grashof.figures.curves import DYNAMICS, KINEMATICS, SLIDE, Panel, draw_curves
from grashof.figures.files import STYLE, fit_title, shortened
from grashof.figures.linkage import figure_of, plot_linkage
from grashof.figures.parts import COLOURS, GROUND
from grashof.figures.section_plots import plot_section
from grashof.survey.report import LinkageReport, mass_tracks

_KINEMATIC = {
    "angles": ("angle",),
    "velocities": ("angular velocity", "speed"),
    "accelerations": ("angular acceleration", "acceleration"),
}
_SLIDE = {"slide": tuple(SLIDE)}
_DYNAMIC = {"torque": ("torque",), "forces": ("joint force", "shaking force")}


def plots(report: LinkageReport) -> Iterator[tuple[str, Figure]]:
    """Name and figure of each plot, with units; torque and forces only with masses."""
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
