"""Deviations from a wanted torque in the programme: bounds, terms of the cost, and part of the squares."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import casadi as ca
import numpy as np

from grashof.problems.values.arrays import TURN
from grashof.synth.loop.instant import Instant, Moment
from grashof.synth.programme.builder import Builder, always
from grashof.synth.programme.constraints import Fixed, Positions, arm_of, misses_at_start
from grashof.synth.programme.plane import vector
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import Form
from grashof.synth.programme.unknowns import FAR, Unknowns
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.wanted_torque import rms

KEPT = 1 - 1e-7  # share of a limit that the programme uses; the rest is for rounding
_TINY = 1e-12  # added to a mean square under a root


def driver_ends(form: Form, x: Unknowns) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Driver angles at the ends of the task motion, and its sense."""
    last = x.theta2[0] + x.direction * TURN if form.closed else x.theta2[form.targets - 1]
    return x.theta2[0], last, x.direction


def instant_of(form: Form, x: Unknowns, places: Positions) -> Callable[[Moment], Instant]:
    """The linkage at moments of its driver."""
    arm, lengths = vector(arm_of(x, places)), ca.vertsplit(x.r)
    o2, ground = vector(x.o2), form.kind.dyad.ground(Fixed(form, x))
    return lambda driver: form.kind.instant(o2, ground, lengths, arm, x.assembly, driver)


def symbolic_misses(form: Form, x: Unknowns, places: Positions) -> ca.SX:
    """Drive torques minus the wanted ones (K,), in reference torques."""
    curve, found = form.torque, []
    if curve is None:
        return ca.SX(0, 1)
    ends, instant = driver_ends(form, x), instant_of(form, x, places)
    for place, torque in zip(curve.places, curve.torques, strict=True):
        at_target = x.theta2[round(place)] if curve.over == "target" else None
        at = instant(curve.moment(place, *ends, at_target))
        found.append(curve.miss(at, x.direction, torque))
    misses: ca.SX = ca.vertcat(*found)
    return misses


def squared_deviation(form: Form, x: Unknowns, places: Positions) -> ca.SX:
    """Share of a wanted torque in the squares by its weight, sizes squared."""
    if form.torque is None or not form.torque.weight:
        return ca.SX(0)
    square: ca.SX = ca.sumsqr(form.torque.counted(form.targets) * symbolic_misses(form, x, places))
    return square


def cost_of_deviations(
    build: Builder, form: Form, x: Unknowns, places: Positions, weights: Mapping[str, ca.SX]
) -> ca.SX:
    """The deviations that are goals, weighted, in units of the start's; limited ones are bounded.

    A root mean square that is the only goal counts by its square, which is smooth where it vanishes.
    """
    cost = ca.SX(0)
    if not form.deviations:
        return cost
    unit = build.parameter(deviation_unit)
    misses = symbolic_misses(form, x, places) / unit
    square = ca.sumsqr(misses) / misses.numel()
    if "torque_deviation" in form.limited:
        build.require(("torque_deviation",), 1 - square / _limit(build, "torque_deviation") ** 2)
    if "torque_deviation" in form.goals:
        alone = len(form.goals) == 1
        cost += square if alone else weights["torque_deviation"] * ca.sqrt(square + _TINY)
    if "torque_deviation_max" in form.deviations:
        most = build.unknown("torque_deviation_max", 1, lambda *_: 1.0, always(0.0, FAR))
        build.row(most - misses, most + misses)
        cost += weights.get("torque_deviation_max", 0.0) * most
        if "torque_deviation_max" in form.limited:
            build.require(("torque_deviation_max",), 1 - most / _limit(build, "torque_deviation_max"))
    return cost


def _limit(build: Builder, key: str) -> ca.SX:
    """The greatest value allowed, in units of the deviation at the start."""

    def limit(scaled: ScaledProblem, start: Start) -> float:
        most = scaled.wanted.ranges(key)[""][1] / scaled.problem.reference_torque
        return KEPT * (1 - start.terms.tightened_by(key)) * most / deviation_unit(scaled, start)

    return build.parameter(limit)


def deviation_unit(scaled: ScaledProblem, start: Start) -> float:
    """The root mean square deviation at the start, reference torques."""
    found = float(rms(misses_at_start(scaled, start)))
    return found if 1e-12 < found < np.inf else 1.0
