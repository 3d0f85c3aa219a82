"""Plots of an analysed linkage: what turns how fast, the path of P, torque and forces."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from grashof.analysis import solve_position
from grashof.draw import COUPLER, DRIVER, GROUND, OUTPUT, PATH, TARGET, save_style
from grashof.linkage_report import LinkageReport, mass_tracks
from grashof.problems.checks import FloatArray

_PEAK = 12.0  # a rate is drawn up to so many times its typical size, where it grows without bound
_TRACKS = {"link 2": DRIVER, "link 3": COUPLER, "link 4": OUTPUT, "all links": TARGET}


def plots(report: LinkageReport) -> Iterator[tuple[str, Figure]]:
    """Name and figure of each plot, with units; torque and forces only with masses."""
    unit = report.unit
    table = report.tables["kinematics"]
    yield "path", _path(report)
    angles = {"theta3_deg": "theta3", "theta4_deg": "theta4", "mu_deg": "transmission angle mu"}
    yield "angles", _curves(report, table, [("angle (deg)", angles)])
    rates = {"omega3": "omega3", "omega4": "omega4"}
    speeds = {"a_speed": "A", "b_speed": "B", "p_speed": "P"}
    yield (
        "velocities",
        _curves(report, table, [("angular velocity (rad/s)", rates), (f"speed ({unit}/s)", speeds)]),
    )
    rates = {"alpha3": "alpha3", "alpha4": "alpha4"}
    pushes = {"a_acceleration": "A", "b_acceleration": "B", "p_acceleration": "P"}
    panels = [("angular acceleration (rad/s²)", rates), (f"acceleration ({unit}/s²)", pushes)]
    yield "accelerations", _curves(report, table, panels)
    if "dynamics" in report.tables:
        table = report.tables["dynamics"]
        yield "torque", _curves(report, table, [("drive torque (N m)", {"torque": "torque"})])
        joints = {"f12": "O2", "f32": "A", "f43": "B", "f14": "O4"}
        shaking = {"shaking_force_x": "x", "shaking_force_y": "y", "shaking_force": "size"}
        yield "forces", _curves(report, table, [("joint force (N)", joints), ("shaking force (N)", shaking)])


def _curves(report: LinkageReport, table: pd.DataFrame, panels: list[tuple[str, dict[str, str]]]) -> Figure:
    dashes = (0, (5, 2))  # of every second one, so that equal curves both show
    pens = ((COUPLER, "-"), (OUTPUT, dashes), (PATH, "-"), (TARGET, dashes))
    with rc_context(save_style()):
        figure = Figure(figsize=(8.5, 3.2 + 2.4 * (len(panels) - 1) + 0.8), layout="constrained")
        rows = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        theta2 = _by_range(table, "theta2_deg")
        for axes, (label, names) in zip(rows, panels, strict=True):
            drawn = {name: _by_range(table, name) for name in names}
            for (colour, dash), (name, values) in zip(pens, drawn.items(), strict=False):
                axes.plot(theta2, values, color=colour, linestyle=dash, linewidth=1.5, label=names[name])
            if not report.turns and not label.startswith("angle"):
                _bounded(axes, np.concatenate(list(drawn.values())))
            axes.axhline(0, color=GROUND, linewidth=0.6, zorder=0)
            axes.set_ylabel(label, parse_math=False)
            axes.grid(visible=True, linewidth=0.4, alpha=0.5)
            for angle in [] if report.turns else {end for each in report.ranges for end in each}:
                axes.axvline(np.degrees(angle), color=GROUND, linestyle=":", linewidth=0.9)
            if len(names) > 1:
                axes.legend(loc="best", fontsize=8, framealpha=0.85)
        if report.turns:
            rows[-1].set_xlim(0, 360)
            rows[-1].set_xticks(np.arange(0, 361, 45))
        dead = "" if report.turns else "; dotted: dead positions"
        rows[-1].set_xlabel(f"driver angle theta2 (deg){dead}")
        rows[0].set_title(_title(report), fontsize=10, parse_math=False)
    return figure


def _bounded(axes: Axes, values: FloatArray) -> None:
    """Cut off what grows without bound towards a dead position."""
    known = values[np.isfinite(values)]
    limit = _PEAK * float(np.median(np.abs(known))) if known.size else 0.0
    if limit > 0 and np.abs(known).max() > limit:
        low = max(float(known.min()) * 1.05, -limit)
        axes.set_ylim(min(low, -0.02 * limit), min(float(known.max()) * 1.05, limit))


def _path(report: LinkageReport) -> Figure:
    linkage, table = report.spec.linkage, report.tables["kinematics"]
    with rc_context(save_style()):
        figure = Figure(figsize=(8.5, 7.0), layout="constrained")
        axes = figure.add_subplot()
        axes.plot(
            _by_range(table, "p_x"), _by_range(table, "p_y"), color=PATH, linewidth=1.8, label="path of P"
        )
        halfway = "" if report.masses is not None else " (halfway)"
        for name, track in mass_tracks(report).items():
            label = f"centre of mass, {name}{'' if name == 'all links' else halfway}"
            width = 1.6 if name == "all links" else 1.0
            axes.plot(*track.T, "--", color=_TRACKS[name], linewidth=width, label=label)
        low, high = report.ranges[0]
        theta2 = np.radians(60) if report.turns else (low + high) / 2
        state = solve_position(linkage, theta2)
        bars = ((linkage.o2, state.a, DRIVER, "driver O2-A"), (linkage.o4, state.b, OUTPUT, "output O4-B"))
        for pivot, joint, colour, label in bars:
            axes.plot(*np.array([pivot, joint]).T, color=colour, linewidth=2.6, label=label)
        corners = np.array([state.a, state.b, state.p])
        axes.fill(*corners.T, color=COUPLER, alpha=0.12, linewidth=0)
        axes.plot(*corners[[0, 1, 2, 0]].T, color=COUPLER, linewidth=1.8, label="coupler A-B-P")
        for name, point, style in (
            ("O2", linkage.o2, "^"), ("O4", linkage.o4, "^"), ("A", state.a, "o"), ("B", state.b, "o"),
            ("P", state.p, "o"),
        ):  # fmt: skip
            axes.plot(*point, style, color=GROUND, markersize=9 if style == "^" else 5, zorder=5)
            if name != "P" or min(np.abs(state.p - other).max() for other in (state.a, state.b)) > 0:
                axes.annotate(name, (float(point[0]), float(point[1])), (7, -12), textcoords="offset points")
        axes.set_aspect("equal", adjustable="datalim")
        axes.margins(0.08)
        axes.grid(visible=True, linewidth=0.4, alpha=0.5)
        axes.set_xlabel(f"x ({report.unit})", parse_math=False)
        axes.set_ylabel(f"y ({report.unit})", parse_math=False)
        drawn = f"linkage drawn at theta2 = {np.degrees(theta2):.4g} deg"
        axes.set_title(f"{_title(report)}\n{drawn}", fontsize=10, parse_math=False)
        axes.legend(loc="best", fontsize=8, framealpha=0.85)
    return figure


def _title(report: LinkageReport) -> str:
    spec = report.spec
    return f"{spec.title or spec.name}, {report.speed_rpm:.4g} rpm"


def _by_range(table: pd.DataFrame, name: str) -> FloatArray:
    """A column, with a gap between the ranges of the driver."""
    values = table[name].to_numpy(dtype=np.float64)
    if "range" not in table:
        return values
    return np.insert(values, np.flatnonzero(np.diff(table["range"])) + 1, np.nan)
