"""Figures in files: how they are styled and saved, and the pictures of a design."""

from __future__ import annotations

from collections.abc import Iterable
from io import BytesIO
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from grashof.figures.animation import animate
from grashof.figures.curves import plot_function
from grashof.figures.linkage import figure_of, plot_linkage
from grashof.figures.parts import missing_glyphs_unwarned
from grashof.figures.subject import Linkage, Subject
from grashof.problems import Problem
from grashof.wording.numbers import class_text

if TYPE_CHECKING:
    from grashof.synth import Candidate

# Settings of matplotlib. Fixed names inside the SVG and no date: the same design gives the same bytes.
STYLE: Any = {
    "svg.hashsalt": "grashof",
    "svg.fonttype": "none",  # text stays text, to be searched and edited
    "pdf.fonttype": 42,
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.linewidth": 0.4,
    "grid.alpha": 0.5,
}

_TITLE_WIDTHS = (120, 110, 100, 90, 80, 70, 60, 50, 40, 30, 20)  # characters per line that are tried
_LONGEST = 300  # characters of a title that a drawing shows


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
    task = problem.task
    generates = bool(task.has_output.any())
    with rc_context(STYLE):
        figure = Figure(figsize=(11.0, 8.5) if generates else (8.5, 7.0))
        room = (0.07, 0.4, 0.9, 0.5) if generates else (0.08, 0.08, 0.89, 0.83)
        axes = plot_linkage(candidate, problem, ax=figure.add_axes(room))
        fit_title(axes, _heading(problem, candidate, rank))
        if generates:  # below it wanted and generated output, and the structural error
            below = figure.add_axes((0.07, 0.07, 0.41, 0.25)), figure.add_axes((0.56, 0.07, 0.41, 0.25))
            plot_function(task, candidate, ax=below)
    return figure


def draw_motion(
    linkage: Linkage,
    problem: Problem | None = None,
    *,
    seconds: float = 4.0,
    fps: float = 25.0,
    annotated: bool = False,
) -> FuncAnimation:
    """Moving picture of a linkage, 600 by 500 pixels; see `animate`."""
    with rc_context(STYLE):
        axes = Figure(figsize=(6.0, 5.0)).add_axes((0.1, 0.1, 0.87, 0.81))
        title = Subject.of(linkage, problem).spec.title
        fit_title(axes, shortened(title))
        return animate(linkage, problem, seconds=seconds, fps=fps, annotated=annotated, ax=axes)


def fit_title(axes: Axes, text: str) -> None:
    """Give axes a title in lines that fit in the figure, and room for it."""
    figure = figure_of(axes)
    place = axes.get_position()
    middle = (place.x0 + place.x1) / 2
    room = (2 * min(middle, 1 - middle) - 0.02) * figure.bbox.width
    with missing_glyphs_unwarned():
        lines = [_wrapped(axes, part, room) for part in text.split("\n")]
        # With y given matplotlib skips its slow search for overlaps.
        taken = axes.set_title("\n".join(lines), y=1.0, parse_math=False).get_window_extent()
    if figure.get_layout_engine() is None:
        top = 1 - (taken.height + 0.17 * figure.dpi) / figure.bbox.height
        axes.set_position((place.x0, place.y0, place.width, min(place.height, top - place.y0)))


def _wrapped(axes: Axes, text: str, room: float) -> str:
    """Text in lines of up to `room` pixels, as a title; matplotlib's own wrap reads $ as math."""
    for width in _TITLE_WIDTHS:
        lines = "\n".join(wrap(text, width, break_on_hyphens=False))
        if axes.set_title(lines, parse_math=False).get_window_extent().width <= room:
            break
    return lines


def shortened(title: str) -> str:
    """A title that leaves room for the drawing below it."""
    return title if len(title) <= _LONGEST else f"{title[:_LONGEST].rstrip()}…"


def save(figure: Figure, paths: Iterable[Path]) -> None:
    """Write a figure to each path, in the format of its ending; the same figure gives the same bytes."""
    for path in paths:
        path.write_bytes(drawn(figure, path.suffix))


def drawn(figure: Figure, ending: str) -> bytes:
    """A figure as a file with an ending such as `.svg`."""
    dated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    file = BytesIO()
    with rc_context(STYLE), missing_glyphs_unwarned():
        figure.savefig(file, format=ending[1:], dpi=130, metadata=dated.get(ending, {"Software": None}))
    return file.getvalue()


def _heading(problem: Problem, candidate: Candidate, rank: int) -> str:
    linkage, verdict = candidate.linkage, candidate.verdict
    unit = f" ({problem.length_unit})" if problem.length_unit else ""
    made = {name: getattr(linkage, name) for name in linkage.mechanism.sizes}
    lengths = "  ".join(f"{name} {length:.4g}" for name, length in made.items())
    task, cycle = np.degrees([verdict.transmission_min_task, verdict.transmission_min_cycle])
    over = [f"{task:.1f} deg over the task"] if not problem.task.closed else []
    over += [f"{cycle:.1f} deg over the turn"] if verdict.full_rotation else []
    exact = problem.requirements.is_exact(problem.task)
    fit = "" if exact else f", error rms {candidate.values['error']:.3g}"  # as the list has it
    if problem.task.has_output.any():
        worst = problem.task.shown(verdict.structural_error_max, problem.length_unit)
        fit = f", structural error {worst}"
    ok = verdict.circuit_ok and verdict.branch_ok
    defect = "" if ok else f", {'branch' if verdict.circuit_ok else 'circuit'} defect"
    return (
        f"{shortened(problem.title or problem.name)}: design {rank} ({candidate.id}), "
        f"{class_text(candidate)}{fit}{defect}\n"
        f"{lengths}{unit};  worst transmission angle {', '.join(over)}"
    )
