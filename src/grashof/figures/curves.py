"""Plots over the driver angle: motion, forces, and the output of a function generator."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from grashof.analysis import function_curves
from grashof.figures.parts import COUPLER, COUPLER_2, DRIVER, GROUND, OUTPUT, OUTPUT_2, PATH, TARGET
from grashof.figures.subject import Linkage, Subject
from grashof.problems import Problem, ProblemError, Task
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import MECHANISMS
from grashof.study.kinds import forces_of, turning
from grashof.study.quantities import by_range, dynamic_quantities, kinematic_quantities, table_of
from grashof.study.study import Asked, LinkageStudy
from grashof.study.sweep import Sweep, dead_positions_unwarned

if TYPE_CHECKING:
    import pandas as pd

    from grashof.synth import Candidate

AxesArray = npt.NDArray[np.object_]
# Label of the axis of a panel, and the columns of the analysis with their names, for all kinds of linkages.
Panel = tuple[str, Mapping[str, str]]
_MOVING = tuple(dict.fromkeys(name for row in MECHANISMS for name in row.moving))
_MU = {"mu_deg": "transmission angle mu", "mu_2_deg": "mu of loop 2"}
_TURNING = tuple(dict.fromkeys(number for row in MECHANISMS for number in turning(row)))
KINEMATICS: Mapping[str, Panel] = {
    "angle": (
        "angle (deg)",
        {**{f"theta{n}_deg": f"theta{n}" for n in _TURNING}, **_MU},
    ),
    "angular velocity": ("angular velocity (rad/s)", {f"omega{n}": f"omega{n}" for n in _TURNING}),
    "speed": ("speed ({unit}/s)", {f"{name}_speed": name.upper() for name in _MOVING}),
    "angular acceleration": ("angular acceleration (rad/s²)", {f"alpha{n}": f"alpha{n}" for n in _TURNING}),
    "acceleration": (
        "acceleration ({unit}/s²)",
        {f"{name}_acceleration": name.upper() for name in _MOVING},
    ),
}
# Further panels of linkages with a slide.
SLIDE: Mapping[str, Panel] = {
    "slide travel": ("slide ({unit})", {"slide_travel": "travel"}),
    "slide velocity": ("slide velocity ({unit}/s)", {"slide_velocity": "velocity"}),
    "slide acceleration": ("slide acceleration ({unit}/s²)", {"slide_acceleration": "acceleration"}),
}
DYNAMICS: Mapping[str, Panel] = {
    "torque": ("drive torque (N m)", {"torque": "torque"}),
    "joint force": (
        "joint force (N)",
        {key: joint for row in reversed(MECHANISMS) for key, joint in forces_of(row).items()},
    ),
    "shaking force": (
        "shaking force (N)",
        {"shaking_force_x": "x", "shaking_force_y": "y", "shaking_force": "size"},
    ),
}
_DASHES = (0, (5, 2))  # of every second curve, so that both of two equal curves are visible
_PENS = (
    *((COUPLER, "-"), (OUTPUT, _DASHES), (PATH, "-"), (TARGET, _DASHES)),
    *((COUPLER_2, "-"), (OUTPUT_2, _DASHES), (DRIVER, "-"), (GROUND, _DASHES)),
)
_PEAK = 12.0  # times the typical size: limit of rates that grow without bound


def plot_kinematics(
    linkage: Linkage,
    problem: Problem | None = None,
    quantities: str | Sequence[str] = tuple(KINEMATICS),
    *,
    speed_rpm: float | None = None,
    ax: Axes | Iterable[Axes] | None = None,
) -> AxesArray:
    """Plot angles, velocities and accelerations over the driver angle, a panel for each quantity.

    Parameters
    ----------
    linkage : Linkage, LinkageSpec or Candidate
    problem : Problem, optional
    quantities : str or sequence of str
        Of "angle", "angular velocity", "speed", "angular acceleration", "acceleration"; all by default. Of
        linkages with a slide also "slide travel", "slide velocity", "slide acceleration".
    speed_rpm : float, optional
        Of the driver; by default the file's or problem's, or 1 rad/s.
    ax : Axes or iterable of Axes, optional
        One for each quantity.

    Returns
    -------
    ndarray of Axes, shape (Q,)

    Raises
    ------
    ProblemError
        Not a single linkage, one that closes nowhere, an unknown quantity, or a wrong number of axes.

    Examples
    --------
    >>> from grashof.problems import load_linkage_spec
    >>> from matplotlib.figure import Figure
    >>> jack, axes = load_linkage_spec("pumpjack"), Figure().subplots(2)
    >>> [panel.get_ylabel() for panel in plot_kinematics(jack, quantities=("angle", "speed"), ax=axes)]
    ['angle (deg)', 'speed (m/s)']
    """
    spec = Subject.of(linkage, problem).spec
    panels = _panels(quantities, {**KINEMATICS, **(SLIDE if spec.linkage.mechanism.slides else {})})
    sweep = Sweep.of(spec, speed_rpm)
    with dead_positions_unwarned():
        table = table_of(kinematic_quantities(sweep.spec), sweep.states_drawn())
    return draw_curves(sweep, table, panels, ax)


def plot_dynamics(
    linkage: Linkage,
    problem: Problem | None = None,
    quantities: str | Sequence[str] = tuple(DYNAMICS),
    *,
    speed_rpm: float | None = None,
    ax: Axes | Iterable[Axes] | None = None,
) -> AxesArray:
    """Plot drive torque, joint forces and shaking force over the driver angle; see `plot_kinematics`.

    Parameters
    ----------
    linkage : Linkage, LinkageSpec or Candidate
    problem : Problem, optional
    quantities : str or sequence of str
        Of "torque", "joint force", "shaking force"; all by default.
    speed_rpm : float, optional
    ax : Axes or iterable of Axes, optional
        One for each quantity.

    Returns
    -------
    ndarray of Axes, shape (Q,)

    Raises
    ------
    ProblemError
        As `plot_kinematics`; or neither the linkage's file nor the problem states masses.
    """
    panels = _panels(quantities, DYNAMICS)
    study = LinkageStudy.of(Subject.of(linkage, problem).spec, Asked(speed_rpm=speed_rpm))
    sweep, found = study.sweep, dynamic_quantities(study)
    if not found:
        raise ProblemError(f"{sweep.spec.name} has no masses; a table [dynamics] or a problem states them")
    with dead_positions_unwarned():
        table = table_of(found, sweep.states_drawn())
    return draw_curves(sweep, table, panels, ax)


def _panels(quantities: str | Sequence[str], known: Mapping[str, Panel]) -> list[Panel]:
    names = [quantities] if isinstance(quantities, str) else list(quantities)
    if not names:
        raise ProblemError(f"quantities names none; it must name some of {', '.join(known)}")
    for name in names:
        if name not in known:
            raise ProblemError(f"quantity {name!r} is unknown; it must be one of {', '.join(known)}")
    return [known[name] for name in names]


def draw_curves(
    sweep: Sweep, table: pd.DataFrame, panels: Sequence[Panel], ax: Axes | Iterable[Axes] | None
) -> AxesArray:
    """Draw columns of an analysis over the driver angle, each panel into one of the axes."""
    rows = _rows(len(panels), ax)
    theta2 = by_range(table, "theta2_deg")
    joints = forces_of(sweep.spec.linkage.mechanism)
    for axes, (label, every) in zip(rows, panels, strict=True):
        names = {name: joints.get(name, words) for name, words in every.items() if name in table}
        drawn = {name: by_range(table, name) for name in names}
        for (colour, dash), (name, values) in zip(_PENS, drawn.items(), strict=False):
            axes.plot(theta2, values, color=colour, linestyle=dash, linewidth=1.5, label=names[name])
        if not sweep.turns and not label.startswith("angle"):
            values = np.concatenate(list(drawn.values()))
            sizes = np.abs(values[np.isfinite(values)])
            limit = _PEAK * float(np.median(sizes)) if sizes.size else 0.0
            if sizes.max(initial=0.0) > limit > 0:
                cut(axes, values, limit)
        axes.axhline(0, color=GROUND, linewidth=0.6, zorder=0)
        axes.set_ylabel(label.format(unit=sweep.spec.unit), parse_math=False)
        dead = mark_driver(axes, theta2, turns=sweep.turns)
        if len(names) > 1:
            axes.legend(loc="best", fontsize="small")
    rows[-1].set_xlabel(f"driver angle theta2 (deg), driver at {sweep.speed_rpm:.4g} rpm{dead}")
    return rows


def _rows(count: int, ax: Axes | Iterable[Axes] | None) -> AxesArray:
    """An axes for each panel: those given, or of a new figure."""
    if ax is None:
        import matplotlib.pyplot as plt  # a user's own axes must not depend on it

        size = (7.0, 1.2 + 2.2 * count)
        return plt.subplots(count, 1, sharex=True, squeeze=False, figsize=size, layout="constrained")[1][:, 0]
    rows = np.atleast_1d(np.array(ax if isinstance(ax, Axes) else list(ax), dtype=object)).ravel()
    if len(rows) != count:
        raise ProblemError(f"ax has {len(rows)} axes; it must have {count}, one for each quantity")
    return rows


def cut(ax: Axes, values: FloatArray, most: float) -> None:
    """Show values up to a size, and zero."""
    known = values[np.isfinite(values)]
    low, high = max(float(known.min()) * 1.05, -most), min(float(known.max()) * 1.05, most)
    ax.set_ylim(min(low, -0.02 * most), max(high, 0.02 * most))


def mark_driver(ax: Axes, places: FloatArray, *, turns: bool) -> str:
    """Mark full turns by ticks, or dead positions, where NaN separates ranges, by lines with these words."""
    if turns:
        low, high = float(places.min()), float(places.max())
        ax.set_xlim(low, high)
        step = 45 * max(1, round((high - low) / 360))
        ax.set_xticks(np.arange(np.ceil(low / step - 1e-9), high / step + 1e-9) * step)
        return ""
    known = np.isfinite(np.concatenate([[np.nan], places, [np.nan]]))
    ends = known[1:-1] & ~(known[:-2] & known[2:])
    for angle in np.unique(places[ends]):
        ax.axvline(angle, color=GROUND, linestyle=":", linewidth=0.9)
    return "; dotted: dead positions"


def plot_function(task: Task, candidate: Candidate, *, ax: Sequence[Axes]) -> None:
    """Wanted and generated output of a design on the first axes, its structural error on the second."""
    output, error = ax
    curves = function_curves(candidate.linkage, task, candidate.verdict)
    if curves is not None:
        places, shown = task.counted_from.shown * curves.inputs, task.counted_in.shown
        output.plot(places, shown * curves.wanted, color=OUTPUT, linewidth=3, alpha=0.4, label="wanted")
        output.plot(places, shown * curves.generated, color=COUPLER, label="generated")
        error.plot(places, shown * curves.error, color=COUPLER)
        at = function_curves(candidate.linkage, task, candidate.verdict, at=task.inputs)
        if at is not None and not task.fits_range:
            pairs: dict[str, Any] = {"marker": "o", "markersize": 4, "color": TARGET}
            pairs |= {"linestyle": "none", "markerfacecolor": "none"}
            output.plot(task.counted_from.shown * at.inputs, shown * at.wanted, label="pairs", **pairs)
            error.plot(task.counted_from.shown * at.inputs, shown * at.error, **pairs)
    unit = candidate.problem.length_unit
    _label(output, task.output_words, task, unit)
    _label(error, "structural error", task, unit)
    if output.lines:
        output.legend(loc="best", fontsize="small")


def plot_wanted(axes: Axes, task: Task, length_unit: str) -> None:
    """The wanted function, with its pairs."""
    inputs, of_inputs, shown = np.linspace(*task.span, 361), task.counted_from.shown, task.counted_in.shown
    axes.plot(of_inputs * inputs, shown * task.output(inputs), color=OUTPUT, label="wanted")
    axes.plot(
        of_inputs * task.inputs, shown * task.outputs, linestyle="none", marker="o", color=TARGET,
        markerfacecolor="none", label="pairs",
    )  # fmt: skip
    _label(axes, task.output_words, task, length_unit)
    axes.legend(loc="best", fontsize="small")


def _label(axes: Axes, words: str, task: Task, length_unit: str) -> None:
    """Label both axes, the vertical one by words with the unit of the output."""
    axes.set_xlabel(task.input_axis(length_unit))
    axes.set_ylabel(f"{words} ({task.counted_in.of(length_unit)})")
