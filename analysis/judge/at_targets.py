"""Limits that hold at single targets, as the judge measures them there."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from grashof.analysis.four_bar.instant_centres import instant_centres
from grashof.analysis.judge.missed_limits import lifted
from grashof.analysis.judge.regions import distances, slack_of
from grashof.analysis.judge.verdict import Defect, Verdict
from grashof.analysis.mechanism.kinematics import Kinematics, solve_kinematics
from grashof.analysis.mechanism.position import Position, solve_position
from grashof.analysis.mechanism.transmission import transmission_angle
from grashof.problems import Linkage, Region, Requirements, Task
from grashof.problems.values.arrays import FloatArray, Limits
from grashof.problems.values.requirements.distances import ends_of
from grashof.problems.values.requirements.target_limits import TargetLimits
from grashof.problems.values.units import Unit

SLACK = 1e-9  # sizes, rad or ratio
SAMPLES = 181  # of the motion from an end target


def missed_at_targets(
    linkage: Linkage, task: Task, wanted: Requirements, verdict: Verdict
) -> Iterator[Defect]:
    """A defect for every missed limit at a single target."""
    if not np.isfinite(verdict.theta2).all():
        return
    state = solve_position(linkage, verdict.theta2, verdict.assembly)
    for limits in wanted.at:
        for number in limits.targets:
            figures = _figures(linkage, verdict, state, limits, number - 1, task.size)
            for what, found, allowed, unit in figures:
                miss = max(allowed[0] - found, found - allowed[1]) / task.size**unit.lengths
                if not miss <= SLACK:
                    shown = unit.shown * found
                    yield Defect("at", f"{what} at target {number}", shown, unit.range_text(allowed), miss)


def _figures(
    linkage: Linkage, verdict: Verdict, state: Position, limits: TargetLimits, k: int, size: float
) -> Iterator[tuple[str, float, Limits, Unit]]:
    """Name, value, limits and unit of each limited quantity at a target."""
    for name in ("a", "b", "instant_centre"):
        box = getattr(limits, name)
        if box is None:
            continue
        if name == "instant_centre":
            place = instant_centres(linkage, verdict.theta2[k], verdict.assembly[k]).i13
        else:
            place = getattr(state, name)[k]
        if isinstance(box, Region):
            words, most = "the instant centre" if len(name) > 1 else name.upper(), slack_of(box) * size
            away = float(distances(box, *place[:, None])[0])
            yield f"the distance of {words} from its region", away, (-np.inf, most), Unit.LENGTH
            continue
        for axis, side, value in zip("xy", (box.x, box.y), place.tolist(), strict=True):
            yield f"{name}.{axis}", value, side, Unit.LENGTH
    for name, allowed in limits.named.get("distances", {}).items():
        one, other = (getattr(linkage if end in ("o2", "o4") else state, end) for end in ends_of(name))
        away = (one if one.ndim == 1 else one[k]) - (other if other.ndim == 1 else other[k])
        yield f"the distance {name}", float(np.hypot(*away)), allowed, Unit.LENGTH
    if limits.past_deg is not None:
        low, high = np.radians(limits.past_deg).tolist()
        past = past_toggle(linkage, verdict, k)
        yield "driver and coupler past toggle in deg", past, (low, high), Unit.ANGLE
    if limits.coupler_angle_deg is not None:
        low, high = np.radians(limits.coupler_angle_deg).tolist()
        (theta3,) = lifted(state.theta3[[k]], (low, high)).tolist()
        yield "the direction of the coupler in deg", theta3, (low, high), Unit.ANGLE
    if limits.coupler_rate is not None:
        moving = _moving(linkage, verdict, k)
        yield "the rate of the coupler", float(moving.omega3), limits.coupler_rate, Unit.RATIO
    if limits.transmission_min_deg is not None:
        mu = float(transmission_angle(linkage, verdict.theta2[k]))
        least = float(np.radians(limits.transmission_min_deg))
        yield "the transmission angle in deg", min(mu, float(np.pi) - mu), (least, np.inf), Unit.ANGLE
    if limits.mechanical_advantage_min is not None:
        moving = _moving(linkage, verdict, k)
        with np.errstate(divide="ignore"):
            advantage = float(1.0 / np.abs(moving.omega4))
        yield "the mechanical advantage", advantage, (limits.mechanical_advantage_min, np.inf), Unit.RATIO


def _moving(linkage: Linkage, verdict: Verdict, k: int) -> Kinematics:
    """The linkage at target k, its driver at 1 rad/s."""
    return solve_kinematics(linkage.changed(assembly=verdict.assembly[k]), verdict.theta2[k], 1.0, 0.0)


def past_toggle(linkage: Linkage, verdict: Verdict, k: int) -> float:
    """Angle of driver and coupler past toggle (O2, A and B in line) at target k, rad.

    Positive where the motion from the first target (for the first target, back from the last) passes it.
    """
    start, end = verdict.theta2[[0 if k else -1, k]].tolist()
    theta2 = np.linspace(start, end, SAMPLES)
    turned: FloatArray = solve_position(linkage, theta2, verdict.assembly[k]).theta3 - theta2
    turned = np.unwrap(turned)
    line = np.pi * np.round(turned[-1] / np.pi)
    return float(-np.sign(turned[0] - line) * (turned[-1] - line))
