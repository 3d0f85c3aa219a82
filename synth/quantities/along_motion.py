"""Quantities along the task motion, such as torque, joint forces and velocities: their greatest magnitude.

Written once for arrays and for CasADi symbols, as in `grashof.synth.quantities.formulas`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from grashof.problems import Requirements
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, Limits
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.synth.loop.instant import Instant, Moment
from grashof.synth.loop.vector import Vector
from grashof.synth.quantities.drive_torque import drive_torque, joint_forces
from grashof.synth.quantities.driver_motion import driver_at
from grashof.synth.quantities.loading import NOTHING, Loading
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.wanted_torque import DEVIATIONS

SCREENED = 25  # instants at which many linkages are compared
INSPECTED = 30 * SCREENED  # instants at which one linkage is inspected
AGREES = 2e-3  # share of its bound by which a magnitude may exceed it
MOST_PEAKS = 4  # that are reported at once


# Quantities bounded over the task motion, by their keys, in `Problem.scale`: the magnitude of scalars and
# vectors, the greatest of several. Of quantities with limits on both sides, the distance from the middle.
Along: TypeAlias = Callable[[Instant, Loading | None, Any], list[Any]]
ALONG: dict[str, Along] = {
    "mechanical_advantage": lambda at, *_: [at.rates.speed4],
    "omega4_max": lambda at, *_: [at.driver.pace * at.rates.speed4],
    "point_speed_max": lambda at, *_: [at.velocity(3, at.point)],
    "point_acceleration_max": lambda at, *_: [at.acceleration(3, at.point)],
    "output_acceleration_max": lambda at, *_: [at.turned(4)],
    "coupler_angle": lambda at, _, middle: [_beside(at, middle)],
    "coupler_rate": lambda at, _, middle: [np.arctan(at.rates.speed3) - middle],
    "torque_peak": lambda at, loading, _: drive_torque(at, loading or NOTHING),
    "joint_force_peak": lambda at, loading, _: joint_forces(at, loading or NOTHING),
}


def _beside(at: Instant, middle: Any) -> Any:
    """Angle of the coupler from a direction."""
    return Vector(np.cos(middle), np.sin(middle)).angle_to(at.coupler)


# Those limited on both sides, with the limits of what stands for them: a rate may be without one.
BOTH_SIDES: dict[str, Callable[[FloatArray], FloatArray]] = {
    "coupler_angle": lambda limits: limits,
    "coupler_rate": np.arctan,
}
# Those whose value is one over the greatest magnitude.
INVERSE = frozenset({"mechanical_advantage"})


def value_of(key: str, peak: Any) -> Any:
    """The value of a quantity whose greatest magnitude is known, and vice versa."""
    return 1 / peak if key in INVERSE else peak


def middle_of(wanted: Requirements, key: str) -> float:
    """The middle of the limits of a quantity that is limited on both sides."""
    return float(np.mean(_sides(wanted, key))) if key in BOTH_SIDES else 0.0


def allowed_along(wanted: Requirements, key: str) -> Limits:
    """Limits of a quantity of `ALONG`, or of its distance from the middle."""
    if key in BOTH_SIDES:
        low, high = _sides(wanted, key)
        return 0.0, min((high - low) / 2, np.pi)
    every = [wanted.ranges(name)[""] for name, limit in wanted.limited.items() if limit.quantity.key == key]
    return every[0] if every else (-np.inf, np.inf)


def unit_along(scaled: ScaledProblem, key: str) -> float:
    """The unit of the magnitudes of a quantity."""
    return 1.0 if key in BOTH_SIDES else scaled.scale(QUANTITIES[key])


def _sides(wanted: Requirements, key: str) -> list[float]:
    (name,) = (name for name, limit in wanted.limited.items() if limit.quantity.key == key)
    sides: list[float] = BOTH_SIDES[key](np.array(wanted.ranges(name)[""])).tolist()
    return sides


def along_motion(
    scaled: ScaledProblem,
    key: str,
    points: ComplexArray,
    theta2: FloatArray,
    direction: FloatArray,
    assembly: FloatArray,
) -> FloatArray:
    """A quantity of `ALONG` or `DEVIATIONS` of many linkages (n,), given as for `magnitudes`, as screened."""
    ways = points, theta2, direction, assembly
    if key in DEVIATIONS:
        return DEVIATIONS[key](torque_misses(scaled, *ways))
    found: FloatArray = value_of(key, magnitudes(scaled, key, *ways, SCREENED).max(axis=1))
    return found


def magnitudes(
    scaled: ScaledProblem,
    key: str,
    points: ComplexArray,
    theta2: FloatArray,
    direction: FloatArray,
    assembly: FloatArray,
    count: int,
) -> FloatArray:
    """A quantity of `ALONG` at `count` even times over the task motion of many linkages, (n, count).

    In `Problem.scale` of the quantity; infinite where a linkage does not close. From points O2, O4, and A, B,
    P at the first target (n, 5) in sizes, driver angles in the order of visit (n, N) in rad, direction and
    assembly (n,).
    """
    ends = _ends(scaled, theta2, direction)
    with np.errstate(all="ignore"):
        driver = driver_at(*scaled.drive, np.linspace(0, 1, count), *ends)
        middle = middle_of(scaled.problem.requirements, key)
        values = ALONG[key](_instants(scaled, points, assembly, driver), scaled.loading, middle)
        found = [np.hypot(v.x, v.y) if isinstance(v, Vector) else np.abs(v) for v in values]
    greatest: FloatArray = np.nan_to_num(np.max(found, axis=0), nan=np.inf)
    return greatest


def torque_misses(
    scaled: ScaledProblem,
    points: ComplexArray,
    theta2: FloatArray,
    direction: FloatArray,
    assembly: FloatArray,
) -> FloatArray:
    """Drive torques minus the wanted ones (n, K) of linkages given as for `magnitudes`, reference torques."""
    curve = scaled.wanted_torque
    if curve is None:
        raise TypeError("a problem without a wanted torque has no deviation from it")
    first, last, sense = _ends(scaled, theta2, direction)
    at_targets = theta2[:, curve.targets] if curve.over == "target" else None
    with np.errstate(all="ignore"):
        driver = curve.moment(np.array(curve.places), first, last, sense, at_targets)
        at = _instants(scaled, points, assembly, driver)
        misses: FloatArray = np.nan_to_num(curve.miss(at, sense, np.array(curve.torques)), nan=np.inf)
    return misses


def _ends(
    scaled: ScaledProblem, theta2: FloatArray, direction: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """First and last driver angle of the task motions, and their sense, (n, 1) each."""
    closed = scaled.problem.task.closed
    last = theta2[:, 0] + direction * TURN if closed else theta2[:, -1]
    return theta2[:, :1], last[:, None], direction[:, None]


def _instants(scaled: ScaledProblem, points: ComplexArray, assembly: FloatArray, driver: Moment) -> Instant:
    """Linkages (n,) at the angles of their drivers (n, K)."""
    ground, lengths, arm = scaled.kind.sides(points[:, None])
    base, along, point = (Vector(each.real, each.imag) for each in (points[:, :1], ground, arm))
    return scaled.kind.instant(base, along, lengths, point, assembly[:, None], driver)


def overlooked(
    scaled: ScaledProblem,
    key: str,
    points: ComplexArray,
    theta2: FloatArray,
    direction: int,
    assembly: int,
    bound: float,
) -> list[float]:
    """The worst few peaks of a linkage above a bound, as shares of the motion.

    Points (5,) in sizes and driver angles (N,) in rad as in `magnitudes`; the bound in `Problem.scale`.
    """
    ways = theta2[None], np.array([direction]), np.array([assembly])
    (curve,) = magnitudes(scaled, key, points[None], *ways, INSPECTED)
    beside = np.concatenate([[-np.inf], curve, [-np.inf]])
    peaks = np.flatnonzero((curve >= beside[:-2]) & (curve > beside[2:]) & (curve > bound * (1 + AGREES)))
    worst = peaks[np.argsort(-curve[peaks], kind="stable")][:MOST_PEAKS]
    return [float(peak) / (INSPECTED - 1) for peak in worst]
