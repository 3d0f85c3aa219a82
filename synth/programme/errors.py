"""The error of a programme: the squares of all misses, and their bounds."""

from __future__ import annotations

import casadi as ca
import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.programme.builder import Builder
from grashof.synth.programme.constraints import Positions, Targets, off
from grashof.synth.programme.deviations import squared_deviation
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import Form
from grashof.synth.programme.unknowns import FAR, Unknowns
from grashof.synth.quantities.scaled_problem import ScaledProblem

MOST_ZONE = 0.5  # sizes, rad: greater ones lead the solver astray
ZONE_INSET = 1e-7  # share of a zone that the programme leaves to the judge


def square(form: Form, x: Unknowns, places: Positions, targets: Targets) -> ca.SX:
    """Weighted sum of squared distances and turns from the targets, and of torque deviations."""
    cost = ca.SX(0)
    for k in range(form.targets):
        if form.positions[k]:
            cost += targets.weights[k] * ca.sumsqr(places.p[k] - targets.points[k])
        if form.angles[k]:
            cost += targets.weights[form.targets + k] * off(x, targets, k) ** 2
    return cost + squared_deviation(form, x, places)


def bound_error(build: Builder, form: Form, x: Unknowns, places: Positions, targets: Targets) -> None:
    """Bound the sum of the squares, or each target's square, as a share of its bound."""
    if form.most_error:
        most = build.parameter(lambda _, start: min(start.terms.most_error, FAR) ** 2 * form.targets)
        build.row(1 - square(form, x, places, targets) / most)
    if not form.zoned:
        return
    zones = build.parameter(_zones, 2 * form.targets)
    for k in range(form.targets):
        if form.positions[k]:
            build.require(("within",), 1 - ca.sumsqr(places.p[k] - targets.points[k]) / zones[k] ** 2)
        if form.angles[k]:
            build.require(("within",), 1 - (off(x, targets, k) / zones[form.targets + k]) ** 2)


def _zones(scaled: ScaledProblem, start: Start) -> FloatArray:
    """Permitted miss of each target, slightly tightened: sizes, then rad."""
    zones = np.full((2, len(scaled.targets)), FAR) if scaled.zones is None else scaled.zones
    kept = 1 - ZONE_INSET - start.terms.tightened_by("within")
    return (np.minimum(zones, MOST_ZONE) * kept)[:, list(start.visit)].ravel()
