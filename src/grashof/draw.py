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
from grashof.problems import MotionTask, PathTask, Problem
from grashof.problems.checks import FloatArray
from grashof.synth import Candidate

DRIVER, COUPLER, OUTPUT = "#c0392b", "#1f618d", "#1e8449"
BODY, PATH, SCENE, GROUND, TARGET = "#b9770e", "#7d3c98", "#5d6d7e", "#17202a", "#d35400"
KEPT_OUT = "#909497"
# Targets up to which the linkage is drawn at each, and up to which each carries its number.
_CROWD = {"path": 6, "motion": 8}
_NUMBERED = 24
# Fixed names inside the SVG and no date: the same design gives the same bytes.
_STYLE: Any = {
    "svg.hashsalt": "grashof",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
}


def draw_design(problem: Problem, candidate: Candidate, rank: int) -> Figure:
    """Drawing of a design at its targets, with the coupler path and the scene.

    Of a motion with the body in every pose, or in about a dozen of many; of a path with its points,
    numbered. The linkage is drawn at all of them or, when there are many, at the first, the middle
    and the last.

    Parameters
    ----------
    problem : Problem
    candidate : Candidate
    rank : int
        Printed in the heading.

    Returns
    -------
    matplotlib.figure.Figure
        Equal axes, in the problem's unit; the linkage darkens from the first target to the last.
    """
    with rc_context(_STYLE):
        figure = Figure(figsize=(8.5, 7.0))
        axes = figure.add_axes((0.08, 0.08, 0.89, 0.83))
        _keep_out(axes, problem)
        _scene(axes, problem)
        _paths(axes, problem, candidate)
        state = solve_position(candidate.linkage, candidate.verdict.theta2, candidate.verdict.assembly)
        shown = _shown(problem)
        for target in shown:
            shade = _shade(target, len(problem.task))
            _linkage_at(axes, candidate, state, target, shade, last=target == shown[-1])
        if isinstance(problem.task, MotionTask):
            for pose in _dozen(len(problem.task)):
                _body_at(axes, problem.task, candidate, state, pose)
        else:
            _points(axes, problem.task)
        _ground(axes, candidate)
        _sense(axes, candidate)
        _dress(axes, problem, candidate, rank)
    return figure


def save_style() -> Any:
    """Settings of matplotlib that every figure is made with."""
    return _STYLE


def save(figure: Figure, paths: Iterable[Path]) -> None:
    """Write a figure to each path, in the format of its ending; the same figure gives the same bytes."""
    with rc_context(_STYLE):
        for path in paths:
            metadata = {"Date": None} if path.suffix == ".svg" else {"Software": None}
            figure.savefig(path, dpi=130, metadata=metadata)


def _shown(problem: Problem) -> list[int]:
    """Targets at which the linkage is drawn."""
    task = problem.task
    count = len(task) - (isinstance(task, PathTask) and _returns(task))
    return list(range(count)) if count <= _CROWD[task.kind] else [0, count // 2, count - 1]


def _dozen(count: int) -> range:
    """All of the targets, or about a dozen of many."""
    return range(0, count, 1 if count <= _NUMBERED else round(count / 12))


def _closed(problem: Problem) -> bool:
    return isinstance(problem.task, PathTask) and problem.task.closed


def _returns(task: PathTask) -> bool:
    """Whether the last point is the first again."""
    return bool((task.points[0] == task.points[-1]).all())


def _shade(index: int, count: int) -> float:
    return 0.3 + 0.7 * index / max(count - 1, 1)


def _scene(axes: Axes, problem: Problem) -> None:
    for index, outline in enumerate(problem.outlines):
        label = "scene" if index == 0 else None
        axes.plot(*outline.T, color=SCENE, linewidth=3, solid_joinstyle="miter", label=label, zorder=1)


def _keep_out(axes: Axes, problem: Problem) -> None:
    """Areas kept out, hatched; the legend says for what."""
    wanted = problem.requirements
    names = ", ".join(name if name == "links" else name.upper() for name in wanted.keep_out_for)
    for index, corners in enumerate(wanted.keep_out):
        label = f"kept out: {names}" if index == 0 else None
        axes.fill(
            *corners.T, facecolor="#d5d8dc", edgecolor=KEPT_OUT, hatch="///", linewidth=0.8, alpha=0.6,
            label=label, zorder=0.5,
        )  # fmt: skip


def _paths(axes: Axes, problem: Problem, candidate: Candidate) -> None:
    linkage, verdict = candidate.linkage, candidate.verdict
    start, end = verdict.theta2.min(), verdict.theta2.max()
    if _closed(problem):
        turn = solve_position(linkage, np.linspace(start, start + 2 * np.pi, 361))
        axes.plot(*turn.p.T, color=PATH, linewidth=1.6, label="path of P", zorder=2)
        return
    if verdict.full_rotation:
        for index, assembly in enumerate(sorted(set(verdict.assembly))):
            turn = solve_position(linkage, np.linspace(start, start + 2 * np.pi, 361), assembly)
            label = "path of P, whole turn" if index == 0 else None
            axes.plot(*turn.p.T, color=PATH, linewidth=0.8, linestyle=":", label=label, zorder=2)
    if not verdict.branch_ok:  # no motion joins the targets
        return
    way = solve_position(linkage, np.linspace(start, end, 181), verdict.assembly[0])
    axes.plot(*way.p.T, color=PATH, linewidth=1.6, label="path of P, first to last target", zorder=2)


def _linkage_at(
    axes: Axes, candidate: Candidate, state: Position, target: int, shade: float, *, last: bool
) -> None:
    linkage = candidate.linkage
    a, b, p = state.a[target], state.b[target], state.p[target]
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
        for name, point in (("A", a), ("B", b), ("P", p)):
            _name(axes, name, point)


def _body_at(axes: Axes, task: MotionTask, candidate: Candidate, state: Position, pose: int) -> None:
    """The body in a pose; what the pose leaves free is as the design has it, and the body then dashed."""
    placed, oriented = task.has_position[pose], task.has_angle[pose]
    place = task.positions[pose] if placed else state.p[pose]
    angle = task.angles[pose] if oriented else state.theta3[pose] + candidate.linkage.body_angle
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    if task.body is not None and task.has_angle.any():  # else it has no orientation
        corners, style = task.body @ turn.T + place, "solid" if placed and oriented else "dashed"
        label = "body" if pose == 0 else None
        axes.fill(*corners.T, facecolor=BODY, alpha=0.15, zorder=2)
        axes.fill(
            *corners.T,
            facecolor="none",
            edgecolor=BODY,
            linewidth=1.2,
            linestyle=style,
            zorder=5,
            label=label,
        )
    if oriented:
        arrow = place + turn[:, 0] * 0.08 * task.size
        axes.annotate("", arrow, place, arrowprops={"arrowstyle": "->", "color": BODY}, zorder=6)
    _number(axes, pose, place)


def _points(axes: Axes, task: PathTask) -> None:
    """Target points as open circles under the path; about a dozen of many are numbered."""
    count = len(task) - _returns(task)
    size = float(np.clip(200 / count, 3, 8))
    axes.plot(
        *task.points.T, linestyle="none", marker="o", markersize=size, markerfacecolor="none",
        markeredgecolor=TARGET, markeredgewidth=size / 6, label="target points", zorder=1.5,
    )  # fmt: skip
    for index in _dozen(count):
        _number(axes, index, task.points[index])


def _number(axes: Axes, index: int, place: FloatArray) -> None:
    axes.annotate(
        f"{index + 1}", tuple(place), (-5, 5), textcoords="offset points", ha="right", color=PATH,
        weight="bold", zorder=8,
    )  # fmt: skip


def _ground(axes: Axes, candidate: Candidate) -> None:
    for name, pivot in (("O2", candidate.linkage.o2), ("O4", candidate.linkage.o4)):
        axes.plot(*_line(pivot), marker="^", color=GROUND, markersize=11, zorder=6)
        axes.plot(*_line(pivot), marker="o", color="white", markersize=3, zorder=7)
        _name(axes, name, pivot)


def _sense(axes: Axes, candidate: Candidate) -> None:
    """A quarter of a turn about O2, in the sense of the driver."""
    linkage, verdict = candidate.linkage, candidate.verdict
    radius = max(0.4 * linkage.r2, 0.05 * verdict.size)
    angles = verdict.theta2[0] + verdict.direction * np.array([0, np.pi / 2])
    tail, head = linkage.o2 + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    style = {
        "arrowstyle": "-|>", "color": DRIVER, "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0,
        "connectionstyle": f"arc3,rad={0.5 * verdict.direction}",
    }  # fmt: skip
    axes.annotate("", tuple(head), tuple(tail), arrowprops=style, zorder=7)


def _dress(axes: Axes, problem: Problem, candidate: Candidate, rank: int) -> None:
    linkage, verdict = candidate.linkage, candidate.verdict
    unit = f" ({problem.length_unit})" if problem.length_unit else ""
    lengths = "  ".join(f"r{i} {length:.4g}" for i, length in enumerate(linkage.lengths, start=1))
    task, cycle = np.degrees([verdict.transmission_min_task, verdict.transmission_min_cycle])
    over = [f"{task:.1f} deg over the task"] if not _closed(problem) else []
    over += [f"{cycle:.1f} deg over the turn"] if verdict.full_rotation else []
    fit = "" if problem.requirements.is_exact(problem.task) else f", rms error {verdict.error_rms:.3g}"
    remarks = fit + _defect(candidate)
    axes.set_title(
        f"{problem.title or problem.name}: design {rank} ({candidate.id}), {verdict.grashof_class}{remarks}\n"
        f"{lengths}{unit};  worst transmission angle {', '.join(over)}",
        fontsize=10,
        parse_math=False,
    )
    axes.set_xlabel(f"x{unit}", parse_math=False)
    axes.set_ylabel(f"y{unit}", parse_math=False)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.08)
    axes.grid(visible=True, linewidth=0.4, alpha=0.5)
    axes.legend(
        loc="best", fontsize=8, framealpha=0.85, title="light to dark: first to last target", title_fontsize=8
    )


def _defect(candidate: Candidate) -> str:
    if not candidate.verdict.circuit_ok:
        return ", circuit defect"
    return "" if candidate.verdict.branch_ok else ", branch defect"


def _name(axes: Axes, name: str, point: FloatArray) -> None:
    axes.annotate(name, tuple(point), (7, -12), textcoords="offset points", color=GROUND, zorder=8)


def _line(*points: FloatArray) -> tuple[FloatArray, FloatArray]:
    x, y = np.array(points).T
    return x, y
