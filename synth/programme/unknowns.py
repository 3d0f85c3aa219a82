"""The unknowns of the programme: pivots at the first target, lengths, angles, worst transmission angle."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np

from grashof.problems import Rotatability
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, Limits, turned_from
from grashof.synth.programme.builder import Builder, Fill, always
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import Form
from grashof.synth.quantities.kind import Kind
from grashof.synth.quantities.scaled_problem import ScaledProblem

FAR = 1e3  # sizes: stands for "no limit"
INSET = 1e-8  # sizes, rad: by which limits are tightened, so that the polished design keeps them
SHORTEST = 1e-6  # sizes, of a link
LEAST_TRANSMISSION = 1e-3  # rad: keeps the motion away from dead positions
LEAST_OF_TWO_LOOPS = 0.05  # rad: where one closes at instants alone, it opens between them below that
LIFTED = 10 * np.pi  # rad: angles are unwrapped along the motion


@dataclass(frozen=True, slots=True)
class Unknowns:
    """Symbols of a design: the unknowns, and the discrete choices of a start; sizes and rad.

    Angles are lifted, so that order is a linear constraint and no arc function is differentiated. `theta3`
    and `arm` (u, v) follow where whole poses are met exactly; `body_angle` is there for others. Pivots are
    (2,), the moving ones at the first target; an inverted slider-crank has no B here, a slider-crank no O4.
    """

    o2: ca.SX
    o4: ca.SX
    a: ca.SX
    b: ca.SX
    r: ca.SX  # (4,); of slider kinds the offset in place of r4, and 0 for what they lack
    theta1: ca.SX  # direction of the ground line
    theta2: ca.SX  # (N,), in the order of visit, as theta3
    tau: ca.SX  # the worst transmission angle
    theta3: ca.SX
    arm: ca.SX  # (2,)
    body_angle: ca.SX
    direction: ca.SX  # sense of the driver, +1 or -1
    assembly: ca.SX  # +1 or -1
    at_first: ca.SX  # (N,); 1 at the first target, else 0
    turns: ca.SX  # 1 where the driver of the start turns fully, else 0
    double_crank: ca.SX  # 1 where r2 stays longer than r1, else 0
    body_turn: ca.SX  # of the body against the frame that AP is in: the first pose, or `body_angle`
    second: SecondUnknowns | None = None

    @property
    def carrying(self) -> ca.SX:
        """Directions of P's link at the targets, (N,), in the order of visit."""
        return self.theta3 if self.second is None else self.second.turned

    @classmethod
    def of(cls, build: Builder, form: Form) -> Unknowns:
        """The unknowns of a form, in their order."""
        n, none = form.targets, ca.SX(0, 1)
        wide, turns = always(-FAR, FAR), always(-100.0, 100.0)
        found = dict.fromkeys(("o4", "b"), none)
        found |= {
            name: build.unknown(name, 2, *_pivot(form.kind, name))
            for name in form.kind.linkage.mechanism.pivots
        }
        found["r"] = _lengths(build, form.kind)
        found["theta1"] = build.unknown("theta1", 1, lambda _, start: start.theta1, always(-LIFTED, LIFTED))
        found["theta2"] = build.unknown("theta2", n, lambda _, start: start.theta2, _first_fixed)
        found["tau"] = build.unknown("tau", 1, lambda _, start: start.transmission, _least_transmission)
        found |= dict.fromkeys(("theta3", "arm", "body_angle"), none)
        if not form.poses:
            found["theta3"] = build.unknown("theta3", n, lambda _, start: start.theta3, turns)
            found["arm"] = build.unknown("arm", 2, lambda _, start: interleaved(start.arm), wide)
        if any(form.angles) and not form.poses:
            found["body_angle"] = build.unknown("body_angle", 1, lambda _, start: start.body_angle, turns)
        first_turn = build.parameter(lambda scaled, _: scaled.turns[0])
        return cls(
            **found,
            direction=build.parameter(lambda _, start: start.direction),
            assembly=build.parameter(lambda _, start: start.assembly),
            at_first=build.parameter(lambda _, start: [float(target == 0) for target in start.visit], n),
            turns=build.parameter(_turns),
            double_crank=build.parameter(_double_crank),
            body_turn=first_turn if form.poses else found["body_angle"],
            second=SecondUnknowns.of(build, form) if form.two_loops else None,
        )

    @property
    def theta2_start(self) -> ca.SX:
        """Driver angle at the first target."""
        return ca.dot(self.at_first, self.theta2)


@dataclass(frozen=True, slots=True)
class SecondUnknowns:
    """Symbols of a second loop, see `SecondLoop`; P's arm is among the others."""

    c: ca.SX  # (2,), as d and the bars
    d: ca.SX
    bars: ca.SX
    turned: ca.SX  # (N,)
    side: ca.SX  # +1 or -1

    @classmethod
    def of(cls, build: Builder, form: Form) -> SecondUnknowns:
        """The unknowns of a form."""

        def given(name: str) -> Fill:
            return lambda _, start: getattr(start.second, name)

        wide = always(-FAR, FAR)
        return cls(
            c=build.unknown("c", 2, lambda _, start: interleaved(given("c")(_, start)), wide),
            d=build.unknown("d", 2, lambda _, start: interleaved(given("d")(_, start)), wide),
            bars=build.unknown("bars", 2, given("bars"), always(SHORTEST, FAR)),
            turned=build.unknown("turned", form.targets, given("turned"), always(-100.0, 100.0)),
            side=build.parameter(given("side")),
        )


def _lengths(build: Builder, kind: Kind) -> ca.SX:
    """Those of r1, r2, r3, r4 that the kind has, and its offset."""
    has = [k for k, name in enumerate(("r1", "r2", "r3", "r4")) if name in kind.linkage.mechanism.lengths]
    found = build.unknown("r", len(has), lambda _, start: np.array(start.lengths)[has], always(SHORTEST, FAR))
    if len(has) == 4:
        return found
    r = ca.SX(4, 1)
    r[has] = found
    r[3] = build.unknown("offset", 1, lambda _, start: start.lengths[3], always(-FAR, FAR))
    return r


def _pivot(kind: Kind, name: str) -> tuple[Fill, Fill]:
    """Guess and limits of a pivot, which may move by the radius of a start."""
    far = (-FAR, FAR) if name in kind.linkage.mechanism.ground else inset((-FAR, FAR))

    def guess(_: ScaledProblem, start: Start) -> FloatArray:
        return interleaved(getattr(start, name))

    def limits(_: ScaledProblem, start: Start) -> tuple[FloatArray, FloatArray]:
        middle = interleaved(getattr(start, name))
        return np.maximum(far[0], middle - start.terms.radius), np.minimum(
            far[1], middle + start.terms.radius
        )

    return guess, limits


def _first_fixed(scaled: ScaledProblem, start: Start) -> tuple[FloatArray, FloatArray]:
    """Driver angles are free, except a required one at the first target."""
    low, high = np.full(len(start.visit), -LIFTED), np.full(len(start.visit), LIFTED)
    required = scaled.wanted.theta2_start_deg
    if required is not None and not start.terms.relaxes("theta2_start_deg"):
        first = start.visit.index(0)
        low[first] = high[first] = lifted(np.radians(required), start.theta2[first])
    return low, high


def _least_transmission(scaled: ScaledProblem, start: Start) -> Limits:
    least = (
        np.radians(scaled.wanted.transmission_min_deg)
        + INSET
        + start.terms.tightened_by("transmission_min_deg")
    )
    least = 0.0 if start.terms.relaxes("transmission_min_deg") else min(least, np.pi / 2 - INSET)
    return max(LEAST_TRANSMISSION if start.second is None else LEAST_OF_TWO_LOOPS, least), np.pi / 2


def _turns(scaled: ScaledProblem, start: Start) -> float:
    required = scaled.wanted.rotatability is not Rotatability.ANY
    return float(required or start.turns_fully)


def _double_crank(scaled: ScaledProblem, start: Start) -> float:
    r1, r2, _, _ = start.lengths
    asked = {Rotatability.CRANK_ROCKER: 0.0, Rotatability.DOUBLE_CRANK: 1.0}
    return asked.get(scaled.wanted.rotatability, float(0 < r1 <= r2))


def inset(limits: Limits) -> Limits:
    """Limits tightened by `INSET`, where there is room between them."""
    low, high = limits
    return (low + INSET, high - INSET) if high - low > 4 * INSET else limits


def near(limits: Limits) -> Limits:
    """Limits that are finite."""
    return max(limits[0], -FAR), min(limits[1], FAR)


def lifted(required: float, start: float, period: float = TURN) -> float:
    """A required angle moved by whole periods to be nearest to that of a start; rad."""
    return start + float(turned_from(required, start, period))


def interleaved(points: ComplexArray | complex) -> FloatArray:
    """Real and imaginary parts of points, one after the other."""
    parts: list[FloatArray] = [np.real(points), np.imag(points)]
    return np.stack(parts, axis=-1).ravel()
