"""Instants of the motion at which both loops of a six-bar close, and the second one transmits."""

from __future__ import annotations

from typing import cast

import casadi as ca
import numpy as np

from grashof.problems.values.arrays import TURN, FloatArray
from grashof.synth.programme.builder import Builder, always
from grashof.synth.programme.constraints import Fixed, second_loop
from grashof.synth.programme.plane import unit, vector
from grashof.synth.programme.second_loop import SecondLoop, links_of_first_loop
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import Form
from grashof.synth.programme.unknowns import LEAST_OF_TWO_LOOPS, SecondUnknowns, Unknowns

EVEN, WORST = 24, 8  # instants of a turn, or of the task motion: even ones, and the worst of the start
FINE = 360  # instants among which the worst are found
AGREES = 2e-3  # allowed drop of the sine of the transmission angle between the instants


def bound_second_loop(build: Builder, form: Form, x: Unknowns) -> None:
    """Closure over the full turn where it is required, and over the task motion; the angle where it counts.

    The first loop has bounds of its own, by its extremes: here it only closes.
    """
    if x.second is None:
        return
    for over_task in _motions(form):
        counts = over_task or not form.over_task
        _hold(build, form, x, x.second, x.tau if counts else LEAST_OF_TWO_LOOPS, over_task=over_task)


def _motions(form: Form) -> list[bool]:
    """Where the loops are held: round the turn (False), over the task motion (True)."""
    return [False] * (form.crank or not form.over_task) + [True] * form.over_task


def _hold(
    build: Builder, form: Form, x: Unknowns, second: SecondUnknowns, least: ca.SX | float, *, over_task: bool
) -> None:
    """Both loops close, and the second has an angle, at instants that the start decides."""
    fixed, dyad, count = Fixed(form, x), form.kind.dyad, EVEN + WORST
    shares = build.parameter(lambda _, start: instants(start, over_task=over_task), count)
    way = x.theta2[form.targets - 1] - x.theta2[0] if over_task else TURN
    theta2 = x.theta2[0] + way * shares
    wide, named = always(-100.0, 100.0), "over task" if over_task else "round turn"
    coupler = build.unknown(f"coupler {named}", count, lambda _, start: _at(start, over_task)[0], wide)
    turned = build.unknown(f"turned {named}", count, lambda _, start: _at(start, over_task)[1], wide)
    for k in range(count):
        driver, along = unit(theta2[k]), vector(unit(coupler[k]))
        a = vector(x.o2 + x.r[1] * driver)
        b = dyad.b(fixed, a, along)
        across = dyad.across(fixed, b, along)
        held = second_loop(form, second, links_of_first_loop(fixed, vector(driver), a, along, b), turned[k])
        build.zero(dyad.gap(fixed, a, b, across), held.gap)
        build.row(x.assembly * along.cross(across), second.side * held.sine - ca.sin(least))


def instants(start: Start, *, over_task: bool) -> FloatArray:
    """Even shares of a motion, and those where the second loop of a start transmits worst."""
    fine = np.linspace(0, 1, FINE, endpoint=over_task)
    sines = _sines(start, fine, over_task=over_task)
    around = np.concatenate([sines[-1:], sines, sines[:1]])
    lowest = np.flatnonzero((sines <= around[:-2]) & (sines <= around[2:]))
    worst = lowest[np.argsort(sines[lowest], kind="stable")][:WORST]
    others = (np.arange(WORST - len(worst)) + 0.5) / EVEN  # distinct ones
    return np.concatenate([np.linspace(0, 1, EVEN, endpoint=over_task), fine[worst], others])


def overlooked_instants(form: Form, start: Start, solved: Start) -> bool:
    """Whether a solved second loop transmits worse between the instants of its start."""
    for over_task in _motions(form):
        fine = _sines(solved, np.linspace(0, 1, FINE), over_task=over_task)
        held = _sines(solved, instants(start, over_task=over_task), over_task=over_task)
        if fine.min() < max(held.min() - AGREES, held.min() / 2):
            return True
    return False


def _sines(start: Start, shares: FloatArray, *, over_task: bool) -> FloatArray:
    """Sines of the transmission angle of a second loop, zero where it is open."""
    return _along(start, shares, over_task)[2]


def _at(start: Start, over_task: bool) -> tuple[FloatArray, FloatArray]:
    """Directions of link 3 and P's link at the instants."""
    return _along(start, instants(start, over_task=over_task), over_task)[:2]


def _along(start: Start, shares: FloatArray, over_task: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Directions of link 3 and P's link, rad, and sines of the transmission angle, at shares of a motion."""
    way = start.theta2[-1] - start.theta2[0] if over_task else TURN
    pivots, theta2 = (start.o2, start.o4), start.theta2[0] + way * shares
    second = cast("SecondLoop", start.second)
    return second.along(pivots, start.lengths, start.assembly, theta2)
