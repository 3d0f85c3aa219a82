"""Limits that hold at single targets, and those of a function that depend on where its driver begins."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import Any, TypeAlias

import numpy as np

from grashof.analysis.four_bar.instant_centres import instant_centres
from grashof.analysis.judge.meeting.function_search import Misses
from grashof.analysis.judge.meeting.generated import generated_rates, senses_of
from grashof.analysis.judge.meeting.inputs import Input
from grashof.analysis.judge.regions import distances, slack_of
from grashof.analysis.judge.verdict import Defect, Verdict
from grashof.analysis.mechanism.kinematics import Kinematics, solve_kinematics
from grashof.analysis.mechanism.position import Position, solve_position
from grashof.analysis.mechanism.transmission import transmission_angle
from grashof.analysis.numerics.peaks import crests
from grashof.problems import DeadPositionWarning, Linkage, Region, Requirements, Task
from grashof.problems.values.arrays import FloatArray, IntArray, Limits, turned_from
from grashof.problems.values.requirements.distances import ends_of
from grashof.problems.values.requirements.target_limits import TargetLimits
from grashof.problems.values.units import Unit

SLACK = 1e-9  # sizes, rad or ratio
SAMPLES = 181  # of the motion from an end target
MOTION = 97  # inputs of the range, at which what is limited over the motion is compared
_AT_PAIRS = ("a", "b", "distances")
_OVER_MOTION = ("coupler_angle_deg", "coupler_rate", "mechanical_advantage_min")

Figure: TypeAlias = tuple[str, FloatArray, Limits, Unit]  # name, values, their limits and unit


def missed_at_targets(
    linkage: Linkage, task: Task, wanted: Requirements, verdict: Verdict
) -> Iterator[Defect]:
    """A defect for every missed limit at a single target."""
    if not np.isfinite(verdict.theta2).all():
        return
    for limits in wanted.at:
        figures = list(figures_at(linkage, limits, verdict.theta2, verdict.assembly, task.size))
        for row, number in enumerate(limits.targets):
            for what, values, allowed, unit in figures:
                found = float(values[row])
                miss = float(excess(values[row], allowed)) / task.size**unit.lengths
                if not miss <= SLACK:
                    shown = unit.shown * found
                    yield Defect("at", f"{what} at target {number}", shown, unit.range_text(allowed), miss)


def excess(values: FloatArray, allowed: Limits) -> FloatArray:
    """Excess of values over their limits; negative inside."""
    found: FloatArray = np.maximum(allowed[0] - values, values - allowed[1])
    return found


def figures_at(
    linkage: Linkage, limits: TargetLimits, theta2: FloatArray, assembly: IntArray, size: float
) -> Iterator[Figure]:
    """Each limited quantity at the targets of limits (..., T), of one linkage at driver angles (..., N).

    Assemblies (N,); the size is that of the task.
    """
    ks = np.array(limits.targets) - 1
    at, own = theta2[..., ks], np.asarray(assembly)[ks]
    state = solve_position(linkage, at, own)
    yield from _of_places(linkage, limits, state, at, own, size)
    if limits.past_deg is not None:
        low, high = np.radians(limits.past_deg).tolist()
        past = np.stack([past_toggle(linkage, theta2, assembly, k) for k in ks.tolist()], axis=-1)
        yield "driver and coupler past toggle in deg", past, (low, high), Unit.ANGLE
    if limits.coupler_angle_deg is not None:
        low, high = np.radians(limits.coupler_angle_deg).tolist()
        middle = (low + high) / 2
        theta3 = middle + turned_from(state.theta3, middle)
        yield "the direction of the coupler in deg", theta3, (low, high), Unit.ANGLE
    if limits.coupler_rate is not None:
        yield "the rate of the coupler", _moving(linkage, at, own).omega3, limits.coupler_rate, Unit.RATIO
    if limits.transmission_min_deg is not None:
        mu = transmission_angle(linkage, at)
        least = float(np.radians(limits.transmission_min_deg))
        yield "the transmission angle in deg", np.minimum(mu, np.pi - mu), (least, np.inf), Unit.ANGLE
    if limits.mechanical_advantage_min is not None:
        with np.errstate(divide="ignore"):
            advantage = 1.0 / np.abs(_moving(linkage, at, own).omega4)
        yield "the mechanical advantage", advantage, (limits.mechanical_advantage_min, np.inf), Unit.RATIO


def _of_places(
    linkage: Linkage, limits: TargetLimits, state: Position, at: FloatArray, own: IntArray, size: float
) -> Iterator[Figure]:
    """Places and distances at the targets, as `figures_at`."""
    for name in ("a", "b", "instant_centre"):
        box = getattr(limits, name)
        if box is None:
            continue
        centre = name == "instant_centre"
        places = instant_centres(linkage, at, own).i13 if centre else getattr(state, name)
        if isinstance(box, Region):
            words, most = "the instant centre" if centre else name.upper(), slack_of(box) * size
            away = distances(box, places[..., 0], places[..., 1])
            yield f"the distance of {words} from its region", away, (-np.inf, most), Unit.LENGTH
            continue
        for axis, side, values in zip("xy", (box.x, box.y), np.moveaxis(places, -1, 0), strict=True):
            yield f"{name}.{axis}", values, side, Unit.LENGTH
    for name, allowed in limits.named.get("distances", {}).items():
        one, other = (getattr(linkage if end in ("o2", "o4") else state, end) for end in ends_of(name))
        away = np.broadcast_to(np.hypot(*np.moveaxis(one - other, -1, 0)), at.shape)
        yield f"the distance {name}", away, allowed, Unit.LENGTH


def _moving(linkage: Linkage, theta2: FloatArray, assembly: IntArray) -> Kinematics:
    """The linkage at driver angles, its driver at 1 rad/s."""
    with warnings.catch_warnings(action="ignore", category=DeadPositionWarning):
        return solve_kinematics(linkage, theta2, 1.0, 0.0, assembly=assembly)


def past_toggle(linkage: Linkage, theta2: FloatArray, assembly: IntArray, k: int) -> FloatArray:
    """Angle of driver and coupler past toggle (O2, A and B in line) at target k (...), rad.

    Driver angles at the targets are (..., N), assemblies (N,). Positive where the motion from the first
    target (for the first target, back from the last) passes it.
    """
    start, end = theta2[..., 0 if k else -1], theta2[..., k]
    between = np.linspace(start, end, SAMPLES, axis=-1)
    turned: FloatArray = solve_position(linkage, between, assembly[k]).theta3 - between
    turned = np.unwrap(turned, axis=-1)
    first, last = turned[..., 0], turned[..., -1]
    line = np.pi * np.round(last / np.pi)
    found: FloatArray = -np.sign(first - line) * (last - line)
    return found


def start_limits(linkage: Linkage, task: Task, wanted: Requirements, by: Input) -> Misses | None:
    """Excess over limits (S,) by starts (S,) and a sense, in sizes, rad or ratios; None without any.

    Zero where they are kept; infinite where the linkage does not close.
    """
    at_pairs = _some(wanted, _AT_PAIRS, len(task))
    over_motion = _some(wanted, _OVER_MOTION, MOTION)
    if not (wanted.at or at_pairs or over_motion or task.rates is not None or by.limited):
        return None
    inputs = np.linspace(*task.span, MOTION)

    def misses(starts: FloatArray, direction: int) -> FloatArray:
        worst = np.maximum(by.missed(starts, direction, task), 0.0)
        worst = np.maximum(worst, _of_rates(linkage, task, by, starts, direction))
        for limits, places in (
            *((limits, task.inputs) for limits in (*wanted.at, *at_pairs)),
            *((limits, inputs) for limits in over_motion),
        ):
            theta2 = starts[:, None] + direction * by.turned(starts, direction, places)
            own = np.full(len(places), int(linkage.assembly))
            for _, values, allowed, unit in figures_at(linkage, limits, theta2, own, task.size):
                over = excess(values, allowed) / task.size**unit.lengths
                greatest = (_at_peaks(over) if limits in over_motion else over).max(axis=-1)
                worst = np.maximum(worst, np.nan_to_num(greatest, nan=np.inf))
        return np.where(worst > SLACK, worst, 0.0)

    return misses


def rate_misses(limited: FloatArray, rates: FloatArray) -> FloatArray:
    """Amounts by which leverage ratios (..., R) miss `FunctionTask.rates`, shares of the greatest limit."""
    _, low, high = limited.T
    greatest = np.maximum(np.abs(low), np.abs(high))
    missed: FloatArray = np.maximum(low - rates, rates - high) / np.where(greatest > 0, greatest, 1.0)
    return np.where(np.isnan(missed), np.inf, np.maximum(missed, 0.0))


def _of_rates(linkage: Linkage, task: Task, by: Input, starts: FloatArray, direction: int) -> FloatArray:
    """The worst miss of a leverage ratio by starts (S,), in the better sense of the output."""
    if task.rates is None:
        return np.zeros(len(starts))
    rates = generated_rates(linkage, task, by, starts, direction, task.rates[:, 0])
    missed = [rate_misses(task.rates, sense * rates).max(axis=-1) for sense in senses_of(task)]
    least: FloatArray = np.min(missed, axis=0)
    return least


def _some(wanted: Requirements, names: tuple[str, ...], count: int) -> tuple[TargetLimits, ...]:
    """Limits of requirements as limits at all of some targets."""
    stated: dict[str, Any] = {name: getattr(wanted, name) for name in names if name in wanted.limited}
    return (TargetLimits(targets=range(1, count + 1), **stated),) if stated else ()


def _at_peaks(values: FloatArray) -> FloatArray:
    """The greatest about each inner one of even samples, (..., K)."""
    reach = np.ones(values.shape[-1] - 2, dtype=np.intp)
    reach[[0, -1]] = 2  # it may lie beside the first or last one
    return crests(values[..., :-2], values[..., 1:-1], values[..., 2:], reach)
