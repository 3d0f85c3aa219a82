"""A problem in words: task, objective, extent of the search; and the verdict on a user's linkage."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from grashof.problems import (
    DwellTask,
    FunctionTask,
    LinkageSpec,
    MotionTask,
    Problem,
    ProblemError,
    Region,
    Requirements,
    StrokeTask,
    TandemTask,
    Task,
)
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.errors import listing
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.problems.values.linkages.mechanisms import kinds_text
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.requirements.quantities import Scope
from grashof.problems.values.requirements.target_limits import TargetLimits
from grashof.problems.values.tasks.dwell_task import SWING_WITHIN
from grashof.problems.values.tasks.task import row_of
from grashof.problems.values.text import counted
from grashof.problems.values.units import Unit
from grashof.synth.designs.candidate import Candidate, same_error
from grashof.synth.designs.efforts import with_parts
from grashof.synth.designs.families import caution
from grashof.synth.designs.judging import driven_verdict
from grashof.synth.designs.ranking import pareto_goals
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.results.trade_offs import FACTORS
from grashof.synth.search.finder import asked_first
from grashof.wording.loads import cylinder_text, effort_text, loads_text, torque_text
from grashof.wording.numbers import class_text, value_text

# Quantities that a verdict reports besides missed requirements, where they have a value.
_KEYS = (
    "error_max", "error_rms", "structural_error_max", "structural_error_rms", "transmission_min_task",
    "transmission_min_cycle", "band", "slide_band", "band_made", "slide_band_made", "swing",
    "swing_4", "swing_6", "time_ratio_4", "time_ratio_6", "synchrony_error",
    "driver_rotation", "output_swing", "stroke", "time_ratio", "size", "torque_peak", "torque_deviation",
)  # fmt: skip


def ends_with_enough(problem: Problem) -> bool:
    """Whether the search ends once it has enough designs, as it does where it begins with exact ones."""
    first = asked_first(problem)
    return first.requirements.is_exact(first.task)


def error_meaning(problem: Problem) -> str:
    """Explanation of a least-squares error that includes angles; empty for others."""
    task = problem.task
    if problem.requirements.is_exact(task):
        return ""
    unit = f" {problem.length_unit}" if problem.length_unit else ""
    counted_as = [f"1 rad counted as {task.angle_length:.6g}{unit}"] if task.has_angle.any() else []
    parts, torque = ["positions", *(["angles"] if counted_as else [])], problem.torque
    if torque is not None and torque.weight:
        parts.append("torques")
        length = torque.weight * task.size / torque.greatest
        counted_as.append(f"1 N m {'' if len(counted_as) else 'counted '}as {length:.6g}{unit}")
    return f"of {listing(parts, 'and')} together, {' and '.join(counted_as)}" if counted_as else ""


def goals(problem: Problem) -> str:
    """The goals of the Pareto mark, in words."""
    names = [] if problem.requirements.is_exact(problem.task) else ["error"]
    names += [goal.short.removesuffix(" task").removesuffix(" turn") for goal in pareto_goals(problem)]
    return f"{', '.join(names[:-1])} and {names[-1]}"


def summary(problem: Problem) -> list[str]:
    """A problem in a few lines, with its requirements except default limits."""
    task, usual = problem.task, Requirements()
    wanted = problem.requirements.resolved(task.size, scale_free=task.scale_free)
    unit = f" {problem.length_unit}" if problem.length_unit else ""
    lines = [
        f"{problem.name}: {problem.title}" if problem.title else problem.name,
        f"  {row_of(_TASKS, task)(task, unit)}; {_exactness(problem)}",
        *([f"  mechanism {kinds}"] if (kinds := kinds_text(problem.mechanism)) else []),
        f"  rotatability {wanted.rotatability}, margin {wanted.rotatability_margin:g}; "
        f"order {value_text(wanted.order)}, same branch {value_text(wanted.same_branch)}",
        *(
            f"  {_limit(problem, wanted, name)}"
            for name, limit in wanted.limited.items()
            if limit.quantity.key not in task.without
            and getattr(problem.requirements, name) != getattr(usual, name)
        ),
    ]
    if wanted.keep_out:
        names = ", ".join(wanted.keep_out_for)
        lines.append(f"  kept out of {counted(len(wanted.keep_out), 'area')}: {names}")
    lines += [f"  {_at_targets(limits, unit)}" for limits in wanted.at]
    if problem.manufacturing is not None:
        made = problem.manufacturing
        band = "" if problem.task.dwell is not None else f", band {made.band:g}{unit}"
        lines.append(f"  made to within {made.length_tolerance:g}{unit}{band}")
    if problem.dynamics is not None:
        lines.append(f"  {loads_text(problem.dynamics)}")
        lines += [f"  {effort_text(effort)}"] if (effort := problem.dynamics.effort) is not None else []
    if problem.torque is not None:
        lines.append(f"  {torque_text(problem.torque)}")
    if problem.driver is not None:
        lines.append(f"  {cylinder_text(problem.driver, unit)}")
    return [*lines, f"  best: {_best(problem)}", f"  search: {_search(problem)}"]


def _limit(problem: Problem, wanted: Requirements, name: str) -> str:
    """The quantity that a field of the requirements limits, with its limits."""
    limited = wanted.limited[name]
    quantity = wanted.as_required(limited.quantity)
    if (region := wanted.regions.get(name)) is not None:
        return f"{quantity.words}: {_region(region)} {problem.length_unit}".strip()
    sides = {part: limited.range_text(limits) for part, limits in wanted.ranges(name).items()}
    unit = problem.length_unit if quantity.unit is Unit.LENGTH else quantity.unit
    limits = ", ".join(f"{part} {side}".strip() for part, side in sides.items() if side)
    return f"{quantity.words}: {limits} {unit}".strip()


def _region(region: Region) -> str:
    """A region of joints in words."""
    (left, right), (low, high) = region.x, region.y
    if region.on is not None:
        return "on the line from ({:g}, {:g}) to ({:g}, {:g})".format(*region.corners.ravel().tolist())
    corners = counted(len(region.corners), "corner")
    return f"inside a polygon of {corners}, x {left:g} to {right:g}, y {low:g} to {high:g}"


def _at_targets(limits: TargetLimits, unit: str) -> str:
    """Limits at single targets."""
    where = f"at {'targets' if len(limits.targets) > 1 else 'target'} {listing(limits.targets, 'and')}"
    said = []
    for name, box in (("A", limits.a), ("B", limits.b), ("instant centre", limits.instant_centre)):
        if isinstance(box, Region):
            said.append(f"{name} {_region(box)}{unit}")
            continue
        sides = {} if box is None else {"x": box.x, "y": box.y}
        texts = {axis: Unit.LENGTH.range_text(side) for axis, side in sides.items()}
        said += [f"{name}.{axis} {text}{unit}" for axis, text in texts.items() if text]
    for name, allowed in limits.named.get("distances", {}).items():
        said.append(f"distance {name} {Unit.LENGTH.range_text(allowed)}{unit}")
    if limits.past_deg is not None:
        said.append("driver and coupler {:g} to {:g} deg past toggle".format(*limits.past_deg))
    if limits.coupler_angle_deg is not None:
        said.append("coupler at {:g} to {:g} deg".format(*limits.coupler_angle_deg))
    if limits.coupler_rate is not None:
        said.append("rate of the coupler {:g} to {:g}".format(*limits.coupler_rate))
    if limits.transmission_min_deg is not None:
        said.append(f"mu from {limits.transmission_min_deg:g} deg")
    if limits.mechanical_advantage_min is not None:
        said.append(f"mechanical advantage from {limits.mechanical_advantage_min:g}")
    return f"{where}: {', '.join(said)}"


def _best(problem: Problem) -> str:
    """The criterion of the ranking, as `ranking_key` applies it."""
    degree = {1: "greatest", -1: "smallest"}
    weights = {f"{degree[goal.better]} {goal.words}": weight for goal, weight in problem.goals}
    best = next(iter(weights))
    if len(weights) > 1:
        best = f"a weighted sum: {', '.join(f'{word} {weight:g}' for word, weight in weights.items())}"
    missed = _missed(problem)
    if problem.task.has_output.any() and not problem.by_objective:
        greatest = "greatest" in _exactness(problem)
        error = "greatest structural error" if greatest else "error at the pairs (rms)"
        return f"least {error}; the list offers more transmission besides"
    if problem.by_objective:
        return f"{best}{missed and f', {missed}'}"
    offered = "more transmission besides"
    if not set(ONE_LOOP).isdisjoint(problem.mechanism):
        offered = f"more transmission or less size within {FACTORS[-1]:g} times that error"
    same = f"errors up to {same_error(problem):g} sizes are equal, then {best}"
    return f"least error (rms; {same}); the list offers {offered}"


def _missed(problem: Problem) -> str:
    """Permitted deviations from targets while the objective decides; empty where these are met."""
    factor, zones = problem.requirements.error_factor, problem.zones
    if factor is not None:
        return f"as long as the error (rms) is at most {factor:g} times the least"
    if zones is None:
        return ""
    unit = f" {problem.length_unit}" if problem.length_unit else ""
    spans = [_span(zones[0], unit), _span(np.degrees(zones[1]), " deg")]
    return f"as long as each target is missed by at most {' and '.join(filter(None, spans))}"


def _span(sizes: FloatArray, unit: str) -> str:
    """A number, or the range of some, with its unit; empty where all are infinite."""
    known = sizes[np.isfinite(sizes)]
    if not len(known):
        return ""
    low, high = f"{known.min():.6g}", f"{known.max():.6g}"
    return f"{low}{unit}" if low == high else f"{low} to {high}{unit}"


def _search(problem: Problem) -> str:
    """The extent of the search."""
    search = problem.search
    enough = f", {search.enough} designs" if ends_with_enough(problem) else ""
    effort = f", effort {search.effort:g}" if search.effort != 1 else ""
    return f"up to {search.starts} starts{enough}, seed {search.seed}{effort}"


def _targets(task: Task, unit: str) -> str:
    kind = f"closed {task.kind}" if task.closed else task.kind
    timing = f" timed over {np.degrees(task.driver_turns[-1]):g} deg" if task.is_timed else ""
    ratio = "" if task.length_ratio_max is None else f", length ratio up to {task.length_ratio_max:g}"
    return f"{kind} through {len(task)} {task.target}s{timing}, size {task.size:g}{unit}{ratio}"


def _motion(task: Task, unit: str) -> str:
    return f"{_targets(task, unit)}, angle_length {task.angle_length:g}{unit}"


def _stroke(task: Task, unit: str) -> str:
    way, free = _way(task, unit)
    return f"{way}, time ratio {task.time_ratio:g}, {free} free"


def _tandem(task: TandemTask, _unit: str) -> str:
    each = [
        f"swing {np.degrees(one.swing):g} deg of link {one.link}"
        + ("" if one.time_ratio is None else f" with time ratio {one.time_ratio:g}")
        for one in task.strokes
    ]
    return f"two outputs: {' and '.join(each)}, place and scale free"


def _dwell(task: Task, unit: str) -> str:
    way, free = _way(task, unit)
    return f"dwell of {np.degrees(task.dwell or 0.0):g} deg, {way}, {free} free"


def _way(task: Task, unit: str) -> tuple[str, str]:
    """The stroke or the swing, and what it leaves free."""
    if task.swing is None:
        return f"stroke {task.stroke:g}{unit}", "place"
    return f"swing {np.degrees(task.swing):g} deg", "place and scale"


def _function(task: Task, unit: str) -> str:
    """A function by its pairs or its law, with its ranges and senses."""
    first, last = task.counted_from.shown * np.array(task.span)
    swept = f"driver over {last - first:g} deg"
    if task.lengthens:
        swept = f"cylinder longer by {last - first:g}{unit}"
    law, moved = task.law, task.link
    if law is None:
        said = f"function through {counted(len(task), 'pair')}, {swept}"
    else:
        power = "" if law.exponent is None else f" {law.exponent:g}"
        over = f"{task.counted_in.shown * law.output_range:g}{unit if task.travels else ' deg'}"
        ranges = f"x from {law.x[0]:g} to {law.x[1]:g}, {swept}, {moved} over {over}"
        chosen = "" if task.fits_range else f", at {counted(len(task), 'pair')} by Chebyshev spacing"
        said = f"function {law.name}{power}, {ranges}{chosen}"
    given = "along the slide" if task.travels else "in the sense of the driver"
    sense = given if task.sense == "given" else "in either sense"
    if task.mirror is not None:
        sense += f"; its own mirror image at {np.degrees(task.mirror):g} deg"
    return f"{said}; {moved} {sense}"


# The words for each kind of task, given the unit of lengths.
_TASKS: Mapping[type, Callable[[Any, str], str]] = {
    Task: _targets,
    MotionTask: _motion,
    StrokeTask: _stroke,
    TandemTask: _tandem,
    DwellTask: _dwell,
    FunctionTask: _function,
}


def _exactness(problem: Problem) -> str:
    if problem.task.zones is not None:
        return "zones about the targets"
    exact = problem.requirements.is_exact(problem.task)
    if problem.task.has_output.any() and (exact or problem.task.norm == "max"):
        if not exact:
            return "least greatest structural error"
        unit = "of the travel" if problem.task.travels else "rad"
        return f"every pair met within {problem.requirements.tolerance:g} {unit}"
    if not exact:
        return "least squares"
    within = f"met within {problem.requirements.tolerance:g}"
    if problem.task.at_limits or problem.task.swings is not None:
        return f"{within} (rad, and as a share)"
    if problem.task.dwell is not None:
        return (
            f"met within {np.degrees(SWING_WITHIN):.2g} deg"
            if problem.task.stroke is None
            else f"met within {SWING_WITHIN:.2g} of it"
        )
    return f"every target {within} sizes"


def judged_for(problem: Problem, spec: LinkageSpec) -> Candidate:
    """A user's own linkage with the verdict of the judge that every listed design has passed.

    Its kind need not be one of the problem's. It is driven by its own cylinder or, where the problem requires
    one and it has none, by the best; its struts likewise. ProblemError for different length units,
    or a kind that the task excludes.
    """
    if problem.length_unit and spec.length_unit and problem.length_unit != spec.length_unit:
        raise ProblemError(
            f"{spec.name}: lengths are in {spec.length_unit}, those of {problem.name} in "
            f"{problem.length_unit}; they must be in the same unit"
        )
    of = problem.for_kind(spec.linkage.mechanism.word)
    verdict = driven_verdict(ScaledProblem.of(of), spec.linkage, known=spec.cylinder)
    stated = None if spec.dynamics is None else spec.dynamics.effort
    known = () if stated is None else stated.parts
    return with_parts(Candidate(spec.linkage, verdict, of, 0, 0), known)


def verdict_lines(candidate: Candidate, name: str) -> list[str]:
    """The verdict on a linkage: whether it meets all requirements, those that it misses, its quantities."""
    problem, verdict = candidate.problem, candidate.verdict
    missed = [str(defect) for defect in verdict.defects]
    lines = [f"{name} {'does not meet' if missed else 'meets'} the requirements of {problem.name}"]
    lines += [f"  missed: {line}" for line in missed]
    if not missed and (doubt := caution(problem, candidate)):
        lines.append(f"  but {doubt}")
    lines.append(f"  {class_text(candidate)}; driver {'turns fully' if verdict.full_rotation else 'swings'}")
    for key in _KEYS:
        quantity = QUANTITIES[key]
        if quantity.over is Scope.CYCLE and not verdict.full_rotation:
            continue
        if candidate.linkage.mechanism.word in quantity.kinds and np.isfinite(value := candidate.values[key]):
            unit = quantity.unit.of(problem.length_unit)
            lines.append(f"  {quantity.full}: {value * quantity.unit.shown:.6g} {unit}".rstrip())
    return lines
