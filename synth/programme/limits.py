"""Limits and goals of quantities in the programme: as bounds of unknowns, as rows, as the objective."""

from __future__ import annotations

from collections.abc import Sequence

import casadi as ca
import numpy as np

from grashof.problems.values.arrays import FloatArray, Limits
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.requirements.limit_kinds import Kind
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.problems.values.units import Unit
from grashof.synth.loop.vector import Vector
from grashof.synth.programme.builder import Builder, Fill, always
from grashof.synth.programme.constraints import Positions, Symbols
from grashof.synth.programme.deviations import (
    cost_of_deviations,
    deviation_unit,
    driver_ends,
    instant_of,
)
from grashof.synth.programme.plane import column
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import Form
from grashof.synth.programme.unknowns import FAR, Unknowns, inset, lifted, near
from grashof.synth.quantities.along_motion import (
    AGREES,
    ALONG,
    BOTH_SIDES,
    INVERSE,
    MOST_PEAKS,
    allowed_along,
    magnitudes,
    middle_of,
    unit_along,
    value_of,
)
from grashof.synth.quantities.driver_motion import driver_at
from grashof.synth.quantities.formulas import Part, parts_of, range_of, smooth_ratio
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.wanted_torque import DEVIATIONS

ADDED = 2 * MOST_PEAKS  # driver angles, at most, that are added to the grid


def require_limits(build: Builder, form: Form, x: Unknowns, places: Positions) -> None:
    """Every limit of a quantity: of a plain unknown by its bounds, of anything else by rows."""
    design, formulas = Symbols(form, x, places), form.formulas
    smooth = {"link_ratio": smooth_ratio(*formulas["link_length"])}
    for name, part in parts_of(form.limited, smooth, formulas):
        if part.fixed:
            continue
        value, angle = ca.SX(part.of(design)), LIMITS[name].kind.is_angle
        allowed = _angle(name, part) if angle else _range(name, part)
        leaf = value.is_scalar() and value.is_leaf() and part.per is None and not part.squared
        if angle and name != "theta2_start_deg":  # that one is bounded among the unknowns
            (unknown,) = ca.symvar(value)
            ahead = float(ca.evalf(ca.substitute(value, unknown, 0)))
            build.bound(unknown, _less(allowed, ahead), gives=(name, part.name))
        elif leaf:
            build.bound(value, _inset(allowed), gives=(name, part.name))
        if LIMITS[name].kind is Kind.NAMED and build.slack is None:  # a single row, as it may be fixed
            build.row(value, limits=_named(name, part))
        elif leaf or angle:
            build.require_if_relaxed((name, part.name), *_rows(build, design, part, value, allowed))
        else:
            build.require((name, part.name), *_rows(build, design, part, value, allowed))
    if build.slack is not None:
        least = build.parameter(lambda scaled, _: np.radians(scaled.wanted.transmission_min_deg))
        build.require(("transmission_min_deg",), x.tau - least)


def _range(name: str, part: Part) -> Fill:
    def limits(scaled: ScaledProblem, start: Start) -> Limits:
        low, high = near(range_of(scaled.wanted, name, part))
        more, of_ratio = start.terms.tightened_by(name), LIMITS[name].quantity.unit is Unit.RATIO
        return low + more * (low if of_ratio else 1.0), high - more * (high if of_ratio else 1.0)

    return limits


def _named(name: str, part: Part) -> Fill:
    """Limits of a number by its name, free without any; those of distances are squared."""

    def limits(scaled: ScaledProblem, start: Start) -> Limits:
        (low, high), more = range_of(scaled.wanted, name, part), start.terms.tightened_by(name)
        if LIMITS[name].quantity.unit is Unit.RATIO:
            more = min(more, (high - low) / (high + low) if high < np.inf else np.inf)
            return low * (1 + more), high * (1 - more)
        more = min(more, (high - low) / 2)
        low, high = low + more, high - more
        return (low**2 if low > 0 else -np.inf, high**2) if part.squared else (low, high)

    return limits


def _angle(name: str, part: Part) -> Fill:
    def limits(scaled: ScaledProblem, start: Start) -> Limits:
        now = {
            "ground_angle_deg": start.theta1,
            "slide_angle_deg": start.theta1 - np.pi / 2,
            "theta2_start_deg": start.theta2[start.visit.index(0)],
        }[name]
        period = scaled.wanted.period(LIMITS[name].quantity.key)
        low, high = range_of(scaled.wanted, name, part)
        by = lifted((low + high) / 2, now, period) - (low + high) / 2
        return low + by, high + by

    return limits


def _less(allowed: Fill, by: float) -> Fill:
    return lambda scaled, start: np.subtract(allowed(scaled, start), by)


def _inset(allowed: Fill) -> Fill:
    return lambda scaled, start: inset(allowed(scaled, start))


def _rows(build: Builder, design: Symbols, part: Part, value: ca.SX, allowed: Fill) -> list[ca.SX]:
    """Rows that are not negative where a value lies within its limits."""
    if part.per is not None:
        return [part.per(design) - value / build.parameter(lambda scaled, start: allowed(scaled, start)[1])]
    squared: Fill = lambda scaled, start: np.square(np.maximum(inset(allowed(scaled, start)), 0.0))  # noqa: E731
    low, high = ca.vertsplit(build.parameter(squared if part.squared else allowed, 2))
    return [value - low, high - value]


def cost_of_goals(build: Builder, form: Form, x: Unknowns, places: Positions) -> ca.SX:
    """The cost: the goals by their weights. Quantities limited along the motion are bounded, too."""
    weights = {key: build.parameter(_share(form, key)) for key in form.goals}
    cost, design = ca.SX(0), Symbols(form, x, places)
    size = diagonal(build, form, x, places) if "size" in (*form.goals, *form.limited) else ca.SX(0)
    for key, weight in weights.items():
        if key == "transmission":
            cost -= weight * x.tau / (np.pi / 2)
        elif key == "size":
            cost += weight * size
        elif key in form.formulas:
            (part,) = form.formulas[key]
            cost -= weight * QUANTITIES[key].better * ca.SX(part.of(design))
    if "size" in form.limited:
        most = build.parameter(
            lambda scaled, start: scaled.wanted.ranges("size")[""][1] - start.terms.tightened_by("size")
        )
        build.require(("size",), most - size)
    cost += cost_of_deviations(build, form, x, places, weights)
    for key in form.along:
        value = value_of(key, _peak(build, form, x, places, key))
        cost -= weights.get(key, 0.0) * QUANTITIES[key].better * value
    return cost


def diagonal(build: Builder, form: Form, x: Unknowns, places: Positions) -> ca.SX:
    """Diagonal of a box around the pivots at all targets."""

    def corners(scaled: ScaledProblem, start: Start) -> FloatArray:
        every = np.concatenate([start.points, start.track.ravel(), scaled.targets])
        x, y = every.real, every.imag
        return np.array([[np.min(x), np.min(y)], [np.max(x), np.max(y)]])

    low, high = (
        build.unknown(name, 2, lambda *given, k=k: corners(*given)[k], always(-FAR, FAR))
        for k, name in enumerate(("low", "high"))
    )
    ground = (getattr(x, name) for name in form.kind.linkage.mechanism.ground)
    joints = [column(each) for loop in places.second for each in (loop.c, loop.d, loop.e)]
    for point in (*ground, *places.a, *places.b, *places.p, *joints):
        build.row(point - low, high - point)
    return ca.sqrt(ca.sumsqr(high - low) + 1e-12)


def _peak(build: Builder, form: Form, x: Unknowns, places: Positions, key: str) -> ca.SX:
    """An upper bound of a magnitude at the driver angles of an even grid, and those added to it."""
    one = build.parameter(lambda scaled, start: peak_unit(form, scaled, start, key))  # its peak at the start
    omega2 = build.parameter(lambda scaled, _: scaled.drive[1])
    middle = (
        build.parameter(lambda scaled, _: middle_of(scaled.wanted, key)) if key in BOTH_SIDES else ca.SX(0)
    )
    added = ca.vertsplit(build.parameter(lambda _, start: _padded(start.terms.peaks_at.get(key, ())), ADDED))
    peak = build.unknown(key, 1, lambda *_: 1.0, _most(form, key))
    ends, instant = driver_ends(form, x), instant_of(form, x, places)
    for share in (*np.linspace(0, 1, form.grid), *added):
        at = instant(driver_at(form.motor, omega2, share, *ends))
        for value in ALONG[key](at, form.loading, middle):
            if isinstance(value, Vector):
                build.row(peak**2 - (value / one).square)
            else:
                build.row(peak - value / one, peak + value / one)
    return peak


def _padded(shares: Sequence[float]) -> FloatArray:
    return np.pad(np.array(shares, dtype=np.float64), (0, ADDED - len(shares)))


def peak_unit(form: Form, scaled: ScaledProblem, start: Start, key: str) -> float:
    """The greatest magnitude of a quantity at the start, in `Problem.scale`."""
    ways = np.array([start.theta2]), np.array([start.direction]), np.array([start.assembly])
    peak = float(magnitudes(scaled, key, start.points[None], *ways, form.grid).max())
    return peak if 1e-9 < peak < np.inf else 1.0


def _most(form: Form, key: str) -> Fill:
    """Limits of a peak, in units of that at the start."""

    def limits(scaled: ScaledProblem, start: Start) -> Limits:
        low, most = allowed_along(scaled.wanted, key)
        if key in INVERSE:
            most = value_of(key, low) if low > 0 else np.inf
        return 0.0, most / (unit_along(scaled, key) * peak_unit(form, scaled, start, key)) * (1 - AGREES)

    return limits


def _share(form: Form, key: str) -> Fill:
    """Weight of a goal; all weights add up to 1."""

    def counted(scaled: ScaledProblem, start: Start, key: str) -> float:
        unit = value_of(key, peak_unit(form, scaled, start, key)) if key in ALONG else 1.0
        unit = deviation_unit(scaled, start) if key in DEVIATIONS else unit
        return (
            start.terms.goals[key] * unit / (scaled.scale(QUANTITIES[key]) if key in form.formulas else 1.0)
        )

    def share(scaled: ScaledProblem, start: Start) -> float:
        return counted(scaled, start, key) / sum(counted(scaled, start, each) for each in form.goals)

    return share
