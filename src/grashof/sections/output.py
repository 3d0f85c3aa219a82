"""The output link: the function it generates, its dwells, its mechanical advantage."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from grashof.analysis import (
    Dwell,
    FunctionCurves,
    Kinematics,
    Verdict,
    advantage,
    dwell,
    function_curves,
    holding,
    output_stroke,
    verify,
)
from grashof.problems import AssemblyError, Task
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.checks import number_within
from grashof.study.quantities import counted_on, counted_with
from grashof.study.samples import Columns, curves, over_driver, table
from grashof.study.section import Fact, Plot, Section, angle_fact
from grashof.study.study import LinkageStudy
from grashof.study.sweep import INSET
from grashof.study.turn import degrees, extreme_facts, turn_extremes

_AT_REST = 1e-9  # |omega4 / omega2| below which the output is at rest


def function_section(study: LinkageStudy) -> Section | None:
    """Output and structural error of a design that generates a function; None for other tasks."""
    problem = study.spec.problem
    if problem is None or not problem.task.has_output.any():
        return None
    task = problem.task
    verdict = verify(study.linkage, task, problem.requirements, problem=problem, cylinder=study.spec.cylinder)
    curves = function_curves(study.linkage, task, verdict)
    if curves is None:
        return None
    at_pairs = function_curves(study.linkage, task, verdict, at=task.inputs)
    places, over = task.counted_from.shown * curves.inputs, task.input_axis(problem.length_unit)
    shown = task.counted_in.shown
    unit = task.counted_in.of(problem.length_unit)
    output = {"wanted": shown * curves.wanted, "generated": shown * curves.generated}
    plots = tuple(
        Plot(key, title, unit, lines, places, over, bounded=True)
        for key, title, lines in (
            ("function-output", task.output_words, output),
            ("structural-error", "structural error", {"error": shown * curves.error}),
        )
    )
    tables = {} if at_pairs is None else {"function": _pairs(task, verdict, at_pairs)}
    way = "along the slide" if task.travels else "in the sense of the driver"
    between = "between pairs the wanted output is the cubic spline through them"
    notes = (
        f"error is generated less wanted output, {way}",
        between if task.law is None else f"wanted is the law {task.law.name}",
    )
    facts = _function_facts(task, verdict, unit, task.turning_link(study.linkage.mechanism))
    return Section("function", "Function", tuple(facts), tables, plots, notes)


def _function_facts(task: Task, verdict: Verdict, unit: str, link: int) -> Iterator[Fact]:
    zero = "travel of the slide" if task.travels else f"theta{link}"
    names = {
        "structural_error_max": "structural error, greatest",
        "structural_error_rms": "structural error, root mean square",
        "output_zero": f"{zero} at the wanted output zero",
    }
    ending = "" if task.travels else "_deg"
    for key, label in names.items():
        yield Fact(f"{key}{ending}", label, float(task.counted_in.shown * getattr(verdict, key)), unit)
        if key == "structural_error_max":
            where = f"{label}: driver rotation from the first pair"
            yield angle_fact("structural_error_at", where, verdict.structural_error_at)
    yield angle_fact("theta2_first", "theta2 at the first pair", verdict.theta2[0])
    yield Fact("driver_sense", "sense of the driver (1: counter-clockwise)", verdict.direction)


def _pairs(task: Task, verdict: Verdict, at_pairs: FunctionCurves) -> pd.DataFrame:
    """A row for each pair."""
    outputs = {"wanted": at_pairs.wanted, "generated": at_pairs.generated, "error": at_pairs.error}
    ending, of_inputs = "" if task.travels else "_deg", "" if task.lengthens else "_deg"
    columns = {
        f"input{of_inputs}": task.counted_from.shown * at_pairs.inputs,
        "theta2_deg": np.degrees(verdict.theta2),
    }
    columns |= {f"{name}{ending}": task.counted_in.shown * values for name, values in outputs.items()}
    table = pd.DataFrame(columns)
    table.insert(0, "pair", np.arange(1, len(table) + 1))
    return table


def dwell_section(study: LinkageStudy) -> Section | None:
    """The longest dwell of the output within a band; None unless a band is requested."""
    if study.asked.dwell_deg is None:
        return None
    band = np.radians(number_within(study.asked.dwell_deg, 1e-6, 360.0, "dwell_deg"))
    found = [_rest(study, band, low, high) for low, high in study.sweep.ranges]
    theta, key = f"theta{study.output}", f"theta{study.output}_deg"
    columns = over_driver(study, lambda state: {key: counted_on(np.degrees(getattr(state, theta)), 360.0)})
    swing = float(np.nanmin(columns[key])), float(np.nanmax(columns[key]))
    facts = [fact for n, rest in enumerate(found, start=1) for fact in _dwell_facts(study, rest, n, swing)]
    at = columns["theta2_deg"]
    dwelling = np.zeros(at.shape, dtype=bool)
    for rest in found:
        start, end = np.degrees([rest.start, rest.end])
        dwelling |= (at - start) % 360 <= end - start if study.sweep.turns else (at >= start) & (at <= end)
    columns["dwelling"] = np.where(dwelling, columns[key], np.nan)
    title = f"dwell of link {study.output} within {study.asked.dwell_deg:g} deg"
    plot = curves(columns, "dwell", title, "deg", {theta: key, "dwell": "dwelling"})
    return Section("dwell", "Dwell", tuple(facts), {}, (plot,))


def _rest(study: LinkageStudy, band: float, low: float, high: float) -> Dwell:
    def theta(state: Kinematics) -> FloatArray:
        return state.angular(study.output).theta

    if study.sweep.turns:
        return dwell(study.linkage, theta, band, period=TURN)
    try:
        return dwell(study.linkage, theta, band, low, high, TURN)
    except AssemblyError:  # rounding at the end of a range
        return dwell(study.linkage, theta, band, low + INSET, high - INSET, TURN)


def _dwell_facts(study: LinkageStudy, rest: Dwell, number: int, swing: tuple[float, float]) -> Iterator[Fact]:
    mark, where = (f"_{number}", f", range {number}") if len(study.sweep.ranges) > 1 else ("", "")
    theta = f"theta{study.output}"
    what = f"dwell of {theta} within {study.asked.dwell_deg:g} deg{where}"
    yield angle_fact(f"dwell{mark}", f"{what}: turn of the driver", rest.duration)
    for name, angle in (("from", rest.start), ("to", rest.end)):
        yield angle_fact(f"dwell{mark}_{name}", f"{what}: {name} theta2", angle)
    middle = float(np.degrees(rest.low + rest.high)) / 2
    turned = counted_with(middle, [swing], 360.0) - middle
    for name, angle in (("low", rest.low), ("high", rest.high)):
        label = f"{what}: {theta}, {name} end of the band"
        yield Fact(f"dwell{mark}_{name}_{theta}_deg", label, float(np.degrees(angle)) + turned, "deg")
    if study.sweep.speed_rpm != 0:
        seconds = float(np.degrees(rest.duration)) / 6 / abs(study.sweep.speed_rpm)
        yield Fact(f"dwell{mark}_seconds", f"{what}: time at the driver's speed", seconds, "s")


def mechanical_advantage(study: LinkageStudy) -> Section:
    """Velocity ratio, mechanical advantage and force ratio; the holding forces of weights and loads."""
    columns, n = over_driver(study, lambda state: _ratios(study, state)), study.output
    plots = [
        curves(columns, "velocity-ratio", f"velocity ratio ω{n} / ω2", "", {"ratio": "velocity_ratio"}),
        curves(columns, "torque-ratio", f"mechanical advantage T{n} / T2", "", {"ratio": "torque_ratio"}),
        curves(columns, "force-ratio", "force at P for a force on A", "", {"ratio": "force_ratio"}),
    ]
    notes = [f"friction is left out; T{n} is what link {n} gives, the force at P acts along its path"]
    if "holding_torque" in columns:
        plots += _holding_plots(columns, n)
        notes.append("each holding torque, moment and force keeps the linkage at rest by itself")
    facts = tuple(_ratio_facts(study))
    key, title = "mechanical-advantage", "Mechanical advantage"
    return Section(key, title, facts, {key: table(columns)}, tuple(plots), tuple(notes))


def _ratios(study: LinkageStudy, state: Kinematics) -> Columns:
    found = advantage(study.linkage, state.theta2)
    columns: dict[str, FloatArray] = {
        "velocity_ratio": found.velocity_ratio,
        "torque_ratio": found.torque_ratio,
        "p_way": found.way,
        "force_ratio": found.force_ratio,
    }
    masses, loads = study.masses, study.loads
    if masses is None or not (loads.any or loads.gravity_vector().any()):
        return columns
    held = holding(study.linkage, state.theta2, masses, loads)
    metre, sense = study.metre, -1.0 if study.sweep.speed_rpm < 0 else 1.0
    return columns | {
        "holding_torque": held.torque * metre**2,
        f"holding_moment_on_{study.output}": held.moment * metre**2,
        "holding_force_at_p": sense * held.force * metre,
        "holding_force": held.force[:, None] * held.direction * metre,
    }


def _holding_plots(columns: Columns, n: int) -> Iterator[Plot]:
    for key, what in (("torque", "torque on link 2"), ("moment", f"moment on link {n}")):
        column = "holding_torque" if key == "torque" else f"holding_moment_on_{n}"
        yield curves(columns, f"holding-{key}", f"holding at rest: {what}", "N m", {key: column})
    forces = {"along its path": "holding_force_at_p", "x": "holding_force_x", "y": "holding_force_y"}
    yield curves(columns, "holding-force", "holding at rest: force at P", "N", forces)


def _ratio_facts(study: LinkageStudy) -> Iterator[Fact]:
    linkage, n = study.linkage, study.output
    if study.sweep.turns:
        found = turn_extremes(study, lambda state: advantage(linkage, state.theta2).velocity_ratio)
        yield from extreme_facts("velocity_ratio", f"velocity ratio omega{n} / omega2", found)
        if most := max(abs(found.low), abs(found.high)):
            yield Fact("mechanical_advantage_least", f"mechanical advantage |T{n} / T2|, least", 1 / most)
    if len(linkage.mechanism.dyads) == 1:
        rests = output_stroke(linkage).theta2
    else:
        rests = np.concatenate([each.theta2 for each in study.limit_positions()]) % TURN
    rests = np.sort(rests[np.abs(advantage(linkage, rests).velocity_ratio) < _AT_REST])
    for number, at in enumerate(rests, start=1):
        label = f"mechanical advantage without limit, {number}: theta2"
        yield Fact(f"toggle_{number}_theta2_deg", label, degrees(at), "deg")
