"""Drawings of a design at its poses, as PNG and SVG."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from grashof.analysis import solve_position
from grashof.analysis.position import Position
from grashof.problems import Problem
from grashof.problems.checks import FloatArray
from grashof.synth import Candidate

DRIVER, COUPLER, OUTPUT = "#c0392b", "#1f618d", "#1e8449"
BODY, PATH, SCENE, GROUND = "#b9770e", "#7d3c98", "#5d6d7e", "#17202a"
# Fixed names inside the SVG and no date: the same design gives the same bytes.
_STYLE: Any = {
    "svg.hashsalt": "grashof",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
}


def draw_design(problem: Problem, candidate: Candidate, rank: int) -> Figure:
    """Drawing of a design at every pose, with the body, the coupler path and the scene.

    Parameters
    ----------
    problem : Problem
    candidate : Candidate
    rank : int
        Printed in the heading.

    Returns
    -------
    matplotlib.figure.Figure
        Equal axes, in the problem's unit; the linkage darkens from the first pose to the last.
    """
    with rc_context(_STYLE):
        figure = Figure(figsize=(8.5, 7.0))
        axes = figure.add_axes((0.08, 0.08, 0.89, 0.83))
        _scene(axes, problem)
        _paths(axes, candidate)
        state = solve_position(candidate.linkage, candidate.verdict.theta2, candidate.verdict.assembly)
        for pose in range(len(problem.task)):
            _linkage_at(axes, candidate, state, pose, shade=_shade(pose, len(problem.task)))
            _body_at(axes, problem, pose)
        _ground(axes, candidate)
        _dress(axes, problem, candidate, rank)
    return figure


def save(figure: Figure, paths: Iterable[Path]) -> None:
    """Write a figure to each path, in the format of its ending; the same figure gives the same bytes."""
    with rc_context(_STYLE):
        for path in paths:
            metadata = {"Date": None} if path.suffix == ".svg" else {"Software": None}
            figure.savefig(path, dpi=130, metadata=metadata)


def _shade(index: int, count: int) -> float:
    return 0.3 + 0.7 * index / max(count - 1, 1)


def _scene(axes: Axes, problem: Problem) -> None:
    for index, outline in enumerate(problem.outlines):
        label = "scene" if index == 0 else None
        axes.plot(*outline.T, color=SCENE, linewidth=3, solid_joinstyle="miter", label=label, zorder=1)


def _paths(axes: Axes, candidate: Candidate) -> None:
    linkage, verdict = candidate.linkage, candidate.verdict
    start, end = verdict.theta2.min(), verdict.theta2.max()
    if verdict.full_rotation:
        turn = solve_position(linkage, np.linspace(start, start + 2 * np.pi, 361))
        axes.plot(
            *turn.p.T, color=PATH, linewidth=0.8, linestyle=":", label="path of P, whole turn", zorder=2
        )
    way = solve_position(linkage, np.linspace(start, end, 181))
    axes.plot(*way.p.T, color=PATH, linewidth=1.6, label="path of P, first to last pose", zorder=2)


def _linkage_at(axes: Axes, candidate: Candidate, state: Position, pose: int, shade: float) -> None:
    linkage, last = candidate.linkage, pose == len(candidate.verdict.theta2) - 1
    a, b, p = state.a[pose], state.b[pose], state.p[pose]
    bars = (("driver O2-A", DRIVER, linkage.o2, a), ("output O4-B", OUTPUT, linkage.o4, b))
    for name, colour, pivot, joint in bars:
        label = name if last else None
        axes.plot(*_line(pivot, joint), color=colour, alpha=shade, linewidth=2.4, label=label, zorder=4)
    label = "coupler A-B-P" if last else None
    axes.fill(*_line(a, b, p), color=COUPLER, alpha=0.10 * shade, linewidth=0, zorder=3)
    axes.plot(*_line(a, b, p, a), color=COUPLER, alpha=shade, linewidth=1.6, label=label, zorder=4)
    axes.plot(*_line(a, b), "o", color="white", markeredgecolor=COUPLER, alpha=shade, markersize=5, zorder=5)
    axes.plot(*_line(p), "o", color=PATH, alpha=shade, markersize=4, zorder=6)
    if last:
        for name, point in (("A", a), ("B", b)):
            _name(axes, name, point)


def _body_at(axes: Axes, problem: Problem, pose: int) -> None:
    place, angle = problem.task.positions[pose], problem.task.angles[pose]
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    if problem.task.body is not None:
        corners = problem.task.body @ turn.T + place
        axes.fill(*corners.T, facecolor=BODY, alpha=0.15, zorder=2)
        axes.fill(*corners.T, facecolor="none", edgecolor=BODY, linewidth=1.2, zorder=5)
    arrow = place + turn[:, 0] * 0.08 * problem.task.size
    axes.annotate("", arrow, place, arrowprops={"arrowstyle": "->", "color": BODY}, zorder=6)
    axes.annotate(
        f"{pose + 1}", place, (-5, 5), textcoords="offset points", ha="right", color=PATH, weight="bold"
    )


def _ground(axes: Axes, candidate: Candidate) -> None:
    for name, pivot in (("O2", candidate.linkage.o2), ("O4", candidate.linkage.o4)):
        axes.plot(*_line(pivot), marker="^", color=GROUND, markersize=11, zorder=6)
        axes.plot(*_line(pivot), marker="o", color="white", markersize=3, zorder=7)
        _name(axes, name, pivot)


def _dress(axes: Axes, problem: Problem, candidate: Candidate, rank: int) -> None:
    linkage, verdict = candidate.linkage, candidate.verdict
    unit = f" ({problem.length_unit})" if problem.length_unit else ""
    lengths = "  ".join(f"r{i} {length:.4g}" for i, length in enumerate(linkage.lengths, start=1))
    task, cycle = np.degrees([verdict.transmission_min_task, verdict.transmission_min_cycle])
    whole = f", {cycle:.1f} over the turn" if verdict.full_rotation else ""
    axes.set_title(
        f"{problem.title or problem.name}: design {rank} ({candidate.id}), {verdict.grashof_class}\n"
        f"{lengths}{unit};  worst transmission angle {task:.1f} deg over the task{whole}",
        fontsize=10,
    )
    axes.set_xlabel(f"x{unit}")
    axes.set_ylabel(f"y{unit}")
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.08)
    axes.grid(visible=True, linewidth=0.4, alpha=0.5)
    axes.legend(loc="best", fontsize=8, framealpha=0.85)


def _name(axes: Axes, name: str, point: FloatArray) -> None:
    axes.annotate(name, tuple(point), (7, -12), textcoords="offset points", color=GROUND, zorder=8)


def _line(*points: FloatArray) -> tuple[FloatArray, FloatArray]:
    x, y = np.array(points).T
    return x, y
