"""Figures of a linkage, its coupler curve, and the designs of a result."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from grashof.analysis import Position, solve_position
from grashof.figures import parts
from grashof.figures.curves import plot_wanted
from grashof.figures.shapes import Drawn, placements, shapes_of
from grashof.figures.subject import Linkage, Subject
from grashof.problems import AssemblyError, Problem, ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.text import near_miss
from grashof.synth.designs.ranking import pareto_optimal
from grashof.wording.numbers import with_unit

if TYPE_CHECKING:
    from grashof.synth import Result

_NUMBERED = 10  # designs that are labelled with their rank


def plot_linkage(
    linkage: Linkage,
    problem: Problem | None = None,
    *,
    theta2: npt.ArrayLike | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw a linkage with the path of P and, for a problem, with its task and scene.

    Parameters
    ----------
    linkage : Linkage, LinkageSpec or Candidate
    problem : Problem, optional
    theta2 : array_like, shape (N,) or (), rad, optional
        Driver angles to draw it at, light to dark. By default at the targets, of many at the first, the
        middle and the last; without a problem at 60 deg, or half way between the driver's limits.
    ax : Axes, optional

    Returns
    -------
    Axes
        Equal scales, in the linkage's unit.

    Raises
    ------
    AssemblyError
        The linkage cannot close at an angle of `theta2`.
    ProblemError
        No single linkage, or one that closes nowhere.

    Examples
    --------
    >>> from grashof.problems import load_linkage_spec
    >>> from matplotlib.figure import Figure
    >>> plot_linkage(load_linkage_spec("pumpjack"), ax=Figure().subplots()).get_xlabel()
    'x (m)'
    """
    subject = Subject.of(linkage, problem)
    state = _state(subject, theta2)
    scene = subject.scene
    positions = placements(subject, scene, state)
    ax = new_axes(ax)
    if subject.problem is not None:
        parts.draw_scene(ax, subject.problem)
    parts.draw_path(ax, subject, scene)
    shades = np.linspace(0.3, 1, len(positions)) if len(positions) > 1 else [1.0]
    for placement, shade in zip(positions, shades, strict=True):
        Drawn(ax, shapes_of(subject, scene, placement, named=placement is positions[-1]), placement, shade)
    parts.draw_task(ax, subject)
    parts.draw_ground(ax, scene)
    parts.draw_sense(ax, subject)
    plane(ax, subject.spec.length_unit)
    names: dict[tuple[float, ...], str] = {}
    for name in subject.linkage.mechanism.points:
        place = positions[-1][name]
        names.setdefault(tuple(place), name.upper())  # P may coincide with a joint
    parts.name_points(ax, {name: np.array(place) for place, name in names.items()})
    last = "target" if subject.problem is not None and theta2 is None else "position"
    ends = f"first to last {last}"
    if subject.problem is not None and subject.problem.task.dwell is not None:
        ends = "over the dwell"
    heading = f"light to dark: {ends}" if len(positions) > 1 else None
    ax.legend(loc="best", title=heading, title_fontsize="small", fontsize="small")
    return ax


def plot_task(problem: Problem, *, ax: Axes | None = None) -> Axes:
    """Draw the task of a problem: its scene, and its points or the body in its poses.

    Parameters
    ----------
    problem : Problem
    ax : Axes, optional

    Returns
    -------
    Axes
        Equal scales, in the problem's unit. A pose without a position is not drawn. For a function
        its wanted output over the driver rotation.

    Examples
    --------
    >>> from grashof import load
    >>> from matplotlib.figure import Figure
    >>> plot_task(load("luggage"), ax=Figure().subplots()).get_xlabel()
    'x (m)'
    """
    ax, task = new_axes(ax), problem.task
    if task.has_output.any():
        plot_wanted(ax, task, problem.length_unit)
        return ax
    parts.draw_scene(ax, problem)
    parts.draw_targets(ax, task, np.full((len(task), 2), np.nan), np.full(len(task), np.nan))
    plane(ax, problem.length_unit)
    if ax.get_legend_handles_labels()[0]:
        ax.legend(loc="best", fontsize="small")
    return ax


def plot_coupler_curve(linkage: Linkage, problem: Problem | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw the path of P with a dot at every tenth degree of the driver, and the targets of a problem.

    Parameters
    ----------
    linkage : Linkage, LinkageSpec or Candidate
    problem : Problem, optional
    ax : Axes, optional

    Returns
    -------
    Axes
        Equal scales, in the linkage's unit.

    Raises
    ------
    ProblemError
        No single linkage, or one that closes nowhere.

    Notes
    -----
    Where the dots lie close P is slow (after Hrones & Nelson, *Analysis of the Four-Bar Linkage*, 1951,
    whose dashes are 10 deg of the crank).

    Examples
    --------
    >>> from grashof.problems import load_linkage
    >>> from matplotlib.figure import Figure
    >>> axes = plot_coupler_curve(load_linkage("pumpjack"), ax=Figure().subplots())
    >>> [line.get_label() for line in axes.lines]
    ['path of P', 'every 10 deg of the driver']
    """
    subject = Subject.of(linkage, problem)
    step = np.radians(10)
    tens = [step * np.arange(np.ceil(low / step), np.ceil(high / step)) for low, high in subject.sweep.ranges]
    dots = solve_position(subject.linkage, np.concatenate(tens)).p
    ax = new_axes(ax)
    parts.draw_path(ax, subject, subject.scene)
    look: dict[str, Any] = {"marker": "o", "markersize": 3.5, "color": parts.PATH, "zorder": 3}
    ax.plot(*dots.T, linestyle="none", label="every 10 deg of the driver", **look)
    parts.draw_task(ax, subject)
    plane(ax, subject.spec.length_unit)
    ax.legend(loc="best", fontsize="small")
    return ax


def plot_design_space(
    result: Result, *, x: str = "size", y: str = "transmission", ax: Axes | None = None
) -> Axes:
    """Plot two quantities of all designs against each other, the Pareto-optimal ones ringed.

    The colour is the peak torque where the problem has dynamics, or else the position error where the
    targets are not met exactly; grey where it is not finite. The best ten carry their rank, where there is
    room for it.

    Parameters
    ----------
    result : Result
    x, y : str
        Keys of quantities: columns of `Result.to_frame`, without "_deg".
    ax : Axes, optional
        A scale of colours is added to its figure.

    Returns
    -------
    Axes

    Raises
    ------
    NoSolutionError
        There are no designs; it states why.
    ProblemError
        A key is unknown.
    """
    _ = result.best
    problem, candidates = result.problem, result.candidates
    (x_values, x_label), (y_values, y_label) = _values_of(result, x), _values_of(result, y)
    front = pareto_optimal(problem, candidates)
    ax = new_axes(ax)
    error = "structural_error_max" if problem.task.has_output.any() else "error"
    third = "torque_peak" if problem.dynamics is not None else error
    if third == "error" and problem.requirements.is_exact(problem.task):
        ax.scatter(x_values, y_values, color=parts.COUPLER, label="design", zorder=3)
    else:
        values, label = _values_of(result, third)
        known = np.where(np.isfinite(values), values, np.nan)
        scale = colormaps["viridis"].with_extremes(bad=parts.KEPT_OUT)
        dots = ax.scatter(
            x_values, y_values, c=known, cmap=scale, plotnonfinite=True, label="design", zorder=3
        )
        figure_of(ax).colorbar(dots, ax=ax).set_label(label, parse_math=False)
    ax.scatter(
        x_values[front], y_values[front], s=110, facecolors="none", edgecolors=parts.GROUND, linewidths=1.2,
        label="Pareto-optimal", zorder=4,
    )  # fmt: skip
    best = np.column_stack([x_values, y_values])[:_NUMBERED]
    taken: list[FloatArray] = []
    for rank, (place, there) in enumerate(zip(best, parts.in_points(ax, best), strict=True), start=1):
        if parts.apart(there, taken):
            ax.annotate(
                f"{rank}", tuple(place), (6, 5), textcoords="offset points", fontsize="small", zorder=5
            )
            taken.append(there)
    ax.set_xlabel(x_label, parse_math=False)
    ax.set_ylabel(y_label, parse_math=False)
    ax.legend(loc="best", fontsize="small")
    return ax


def _values_of(result: Result, key: str) -> tuple[FloatArray, str]:
    """A quantity of all designs, as tables show it, and its label."""
    if key not in (known := result.best.values):
        meant = near_miss(key, list(known))
        raise ProblemError(
            f"{key!r} is not a quantity of designs{f'; did you mean {meant}?' if meant else ''}"
        )
    quantity = result.problem.as_required(QUANTITIES[key])
    values = [candidate.values[quantity.key] * quantity.unit.shown for candidate in result.candidates]
    return np.array(values), with_unit(quantity.words, quantity.unit.of(result.problem.length_unit))


def new_axes(ax: Axes | None) -> Axes:
    """The axes given, or those of a new figure."""
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt  # a user's own axes must not depend on it

    return plt.subplots(figsize=(7.0, 5.8), layout="constrained")[1]


def figure_of(ax: Axes) -> Figure:
    """The figure that the axes are in."""
    figure = ax.get_figure(root=True)
    if figure is None:
        raise ProblemError("ax is in no figure; it must be axes of a figure")
    return figure


def _state(subject: Subject, theta2: npt.ArrayLike | None) -> Position:
    """The positions in which the linkage is drawn."""
    assembly: npt.ArrayLike = subject.linkage.assembly
    if theta2 is not None:
        angles = np.ravel(np.asarray(theta2, dtype=np.float64))
        if not angles.size:
            raise ProblemError("theta2 is empty; it must have one driver angle or more")
    elif subject.problem is not None and subject.verdict is not None:
        shown = parts.targets_shown(subject.problem.task)
        angles, assembly = subject.verdict.theta2[shown], subject.verdict.assembly[shown]
    else:
        sweep = subject.sweep
        angles = np.array([np.radians(60) if sweep.turns else np.mean(sweep.ranges[0])])
    state = solve_position(subject.linkage, angles, assembly)
    moving = subject.linkage.mechanism.moving
    open_ = np.isnan(sum(getattr(state, point).sum(axis=-1) for point in moving))
    if theta2 is not None and open_.any():
        open_at = np.degrees(angles[open_][0])
        raise AssemblyError(f"{subject.spec.name} cannot close at theta2 = {open_at:.6g} deg")
    return state


def plane(ax: Axes, length_unit: str) -> None:
    """Equal scales, and the unit on both axes."""
    ax.set_xlabel(with_unit("x", length_unit), parse_math=False)
    ax.set_ylabel(with_unit("y", length_unit), parse_math=False)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)
