"""The constraints of the programme: closure, targets, order, branch, transmission and user functions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import casadi as ca
import numpy as np

from grashof.analysis.judge.design import Constraint, Design, OwnObjective
from grashof.problems.values.arrays import TURN, FloatArray, Limits
from grashof.synth.loop.chain import Frame
from grashof.synth.loop.vector import Vector
from grashof.synth.programme.builder import FREE, NONNEGATIVE, Builder, Fill, always
from grashof.synth.programme.plane import column, cross, quarter_turn, rotated, track, unit, vector
from grashof.synth.programme.second_loop import Joined, joined, links_of_first_loop
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import PLANES, Form, points_held
from grashof.synth.programme.unknowns import INSET, SecondUnknowns, Unknowns, interleaved
from grashof.synth.programme.user_functions import magnitude_at, on_symbols
from grashof.synth.quantities.along_motion import torque_misses
from grashof.synth.quantities.formulas import View
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.target_constraints import AtTarget
from grashof.synth.quantities.wanted_torque import rms

OWN_INSET = 1e-8  # by which the user's constraints are tightened, so that the polished design keeps them
LEAST_STEP = 1e-4  # rad, of the driver between two targets that are both met
LEAST_SQUARE = 1e-8  # sizes squared: scales the squared distances to about 1


@dataclass(frozen=True, slots=True)
class Positions:
    """A, B and P at every target, in the order of visit, and the vectors from A and B to P in one frame."""

    a: list[ca.SX]
    b: list[ca.SX]
    p: list[ca.SX]
    ap: ca.SX
    bp: ca.SX
    # `ClosingDyad.across` at a target. Made anew each time: shared expressions change the last digits of the
    # derivatives.
    across: Callable[[int], Vector]
    fixed: Fixed
    second: list[Joined] = field(default_factory=list)  # at every target, of two loops


class Fixed(View):
    """Quantities of the design that are the same at all targets."""

    def __init__(self, form: Form, x: Unknowns) -> None:
        for name in form.kind.linkage.mechanism.ground:
            setattr(self, name, vector(getattr(x, name)))
        self.normal = vector(unit(x.theta1))
        self.r1, self.r2, self.r3, self.r4 = ca.vertsplit(x.r)
        self.offset = self.r4
        if x.second is not None:
            self.r5, self.r6 = ca.vertsplit(x.second.bars)


class Symbols(Fixed):
    """The design as formulas see it."""

    def __init__(self, form: Form, x: Unknowns, places: Positions) -> None:
        super().__init__(form, x)
        self.theta1, self.theta2_start = x.theta1, x.theta2_start
        self.ap, self.bp = vector(places.ap), vector(places.bp)
        self.a, self.b = (track(points) for points in (places.a, places.b))
        self.body_turn, self.direction = x.body_turn, x.direction
        self.driver_turn = x.direction * (x.theta2[form.targets - 1] - x.theta2[0])
        self.turns, self.double_crank = x.turns, x.double_crank
        first, last = (places.across(k) for k in (0, form.targets - 1))
        self.output_turn = first.angle_to(last)
        self.output_travel = vector(places.b[-1] - places.b[0]).dot(-self.normal.left)


@dataclass(frozen=True, slots=True)
class Targets:
    """The targets as parameters in the order of visit."""

    points: list[ca.SX]  # (2,) each, sizes
    turns: ca.SX  # (N,), rad; angles of the body, moved by whole turns to be nearest to the start
    weights: ca.SX  # (2 N,), of the squared distances, then of the squared turns
    error_scale: ca.SX  # reciprocals of the squared misses of the targets at the start

    @classmethod
    def of(cls, build: Builder, form: Form) -> Targets:
        """Parameters for a form."""
        n = form.targets
        places = build.parameter(lambda scaled, start: interleaved(scaled.targets[list(start.visit)]), 2 * n)
        return cls(
            points=ca.vertsplit(places, 2),
            turns=build.parameter(_turns, n),
            weights=build.parameter(_target_weights, 2 * n),
            error_scale=build.parameter(
                lambda scaled, start: 1.0 / max(_square(scaled, start), LEAST_SQUARE)
            ),
        )


def close_at_poses(build: Builder, form: Form, x: Unknowns) -> Positions:
    """Points of the body are displaced with it; A and B stay at their distances from O2 and O4."""
    n = form.targets

    def in_order(name: str) -> ca.SX:
        return build.parameter(
            lambda scaled, start: interleaved(getattr(scaled.motion, name)[list(start.visit)]), 2 * n
        )

    turned, moved = in_order("rotation"), in_order("shift")
    body = build.parameter(lambda scaled, _: interleaved(scaled.targets[:1]), 2)

    def displaced(point: ca.SX, k: int) -> ca.SX:
        cos, sin = turned[2 * k], turned[2 * k + 1]
        return (
            ca.vertcat(cos * point[0] - sin * point[1], sin * point[0] + cos * point[1])
            + moved[2 * k : 2 * k + 2]
        )

    fixed, dyad = Fixed(form, x), form.kind.dyad
    a, b, p = ([displaced(point, k) for k in range(n)] for point in (x.a, x.b, body))
    at_a, at_b = ([vector(point) for point in each] for each in (a, b))
    along = [(end - begin) / fixed.r3 for begin, end in zip(at_a, at_b, strict=True)]

    def across(k: int) -> Vector:
        return dyad.across(fixed, at_b[k], along[k])

    for k in range(n):
        build.zero(a[k] - x.o2 - x.r[1] * unit(x.theta2[k]))
        build.zero(dyad.gap(fixed, at_a[k], at_b[k], across(k)))
    build.zero((ca.sumsqr(x.b - x.a) - x.r[2] ** 2) / 2)
    return Positions(a, b, p, body - x.a, body - x.b, across, fixed)


def close_at_points(build: Builder, form: Form, x: Unknowns, targets: Targets) -> Positions:
    """The loop O2-A-B-O4 closes at every driver angle; P is fixed to the coupler."""
    n, fixed, dyad = form.targets, Fixed(form, x), form.kind.dyad
    a = [x.o2 + x.r[1] * unit(x.theta2[k]) for k in range(n)]
    at_a, along = [vector(point) for point in a], [vector(unit(x.theta3[k])) for k in range(n)]
    at_b = [dyad.b(fixed, at, turned) for at, turned in zip(at_a, along, strict=True)]
    b = [column(point) for point in at_b]
    p, second = [a[k] + rotated(x.arm, x.theta3[k]) for k in range(n)], list[Joined]()
    if x.second is not None:
        frames = [
            links_of_first_loop(fixed, vector(unit(x.theta2[k])), at_a[k], along[k], at_b[k])
            for k in range(n)
        ]
        second = [second_loop(form, x.second, frames[k], x.second.turned[k]) for k in range(n)]
        p = [column(each.frame.point(vector(x.arm))) for each in second]

    def across(k: int) -> Vector:
        return dyad.across(fixed, at_b[k], along[k])

    timing = build.parameter(lambda scaled, start: scaled.timing[list(start.visit)], n)
    for k in range(n):
        build.zero(dyad.gap(fixed, at_a[k], at_b[k], across(k)))
        build.zero(*(each.gap for each in second[k : k + 1]))
        if form.exact and form.positions[k]:
            build.zero(p[k] - targets.points[k])
        if form.exact and form.angles[k]:
            build.zero(off(x, targets, k))
        if form.timed and k:
            build.zero(x.theta2[k] - x.theta2[0] - x.direction * (timing[k] - timing[0]))
    for point, at in ((x.a, a), (x.b, b)):
        if not point.is_empty():
            build.zero(point - sum((x.at_first[k] * at[k] for k in range(n)), ca.SX.zeros(2)))
    bar = second[0].loop.r3 if second else x.r[2]
    return Positions(a, b, p, x.arm, x.arm - ca.vertcat(bar, 0), across, fixed, second)


def second_loop(form: Form, second: SecondUnknowns, frames: Mapping[int, Frame], turned: ca.SX) -> Joined:
    """The second dyad between the links of a first loop, P's link in a direction."""
    arms = vector(second.c), vector(second.d)
    return joined(form.row, frames, arms, ca.vertsplit(second.bars), vector(unit(turned)))


def require_modes(build: Builder, form: Form, x: Unknowns, places: Positions) -> None:
    """The ground line, the order of the targets, one branch, and a driver that turns fully."""
    for name in form.kind.linkage.mechanism.ground[1:]:  # O4, where it is a pivot
        build.zero(getattr(x, name) - x.o2 - x.r[0] * unit(x.theta1))
    for k in range(form.targets - 1):
        least = LEAST_STEP if form.exact else 0.0
        build.row(x.direction * (x.theta2[k + 1] - x.theta2[k]), limits=always(least, np.inf))
    build.row(x.direction * (x.theta2[form.targets - 1] - x.theta2[0]), limits=always(0.0, TURN))
    if form.same_branch:
        for k, (a, b) in enumerate(zip(places.a, places.b, strict=True)):
            lever = vector(b - a).cross(places.across(k))
            sine = lever / form.kind.dyad.most_lever(places.fixed)
            build.require(("same_branch",), x.assembly * sine - 1e-6)
        if x.second is not None:
            sides = (x.second.side * each.sine for each in places.second)
            build.require(("same_branch",), *(side - 1e-6 for side in sides))
    if form.crank:
        margin = build.parameter(lambda scaled, _: scaled.wanted.rotatability_margin + INSET)
        margins = form.kind.dyad.margins(Symbols(form, x, places))
        build.require(("rotatability",), *(share - margin for share in margins))


def stand_nearest(build: Builder, form: Form, x: Unknowns, places: Positions, targets: Targets) -> None:
    """The derivative of a target's square by its driver angle is zero, where the judge will place it."""
    total = ca.SX(0)  # timed targets have one driver angle: the sum of their derivatives is zero
    for k in np.flatnonzero(form.nearest).tolist():
        a, b, p = places.a[k], places.b[k], places.p[k]
        # d theta3 / d theta2 = n / d from the loop projected on e4; rows are multiplied by d
        d = places.across(k).dot(vector(b - a).left)
        n = -places.across(k).dot(vector(a - x.o2).left)
        row = ca.SX(0)
        if form.positions[k]:
            missed = targets.weights[k] * (p - targets.points[k])
            row += d * ca.dot(missed, quarter_turn(a - x.o2)) + n * ca.dot(missed, quarter_turn(p - a))
        if form.angles[k]:
            row += n * targets.weights[form.targets + k] * off(x, targets, k)
        if form.timed:
            total += row / d
        else:
            build.zero(ca.sqrt(targets.error_scale) * row)
    if form.timed and any(form.nearest):
        build.zero(ca.sqrt(targets.error_scale) * total)


def bound_transmission(build: Builder, form: Form, x: Unknowns, places: Positions) -> None:
    """cos(tau) bounds |cos(mu)|, monotone between the ends of the task motion and the ground line."""
    design, dyad = Symbols(form, x, places), form.kind.dyad

    def bound(reach: ca.SX) -> tuple[ca.SX, ca.SX]:
        cosine = dyad.cos_mu(design, reach)
        return ca.cos(x.tau) - cosine, ca.cos(x.tau) + cosine

    for number, reach in enumerate(dyad.along_ground(design)):
        build.row(*bound(reach), limits=_passing(form, number))
    if form.over_task:
        for k in (0, form.targets - 1):
            build.row(*bound(dyad.reach_at(places.fixed, vector(places.a[k]))))
        for end in (0, 1):
            at = x.theta2[(0, form.targets - 1)[end]]
            build.row(at - x.theta1, limits=_half_turn(form, end))


def _passing(form: Form, number: int) -> Fill:
    """Limits of a position with O2A folded over the ground line (0), or stretched along it (1)."""

    def limits(scaled: ScaledProblem, start: Start) -> Limits:
        first, last = sorted(start.half_turns)
        passed = any(count % 2 == number for count in range(first + 1, last + 1))
        return NONNEGATIVE if not form.over_task or (passed and not _bare(form, scaled)) else FREE

    return limits


def _half_turn(form: Form, end: int) -> Fill:
    """The driver starts, or ends, in the half turn in which the start has it."""

    def limits(scaled: ScaledProblem, start: Start) -> Limits:
        half = start.half_turns[end]
        return FREE if _bare(form, scaled) else (half * np.pi, (half + 1) * np.pi)

    return limits


def _bare(form: Form, scaled: ScaledProblem) -> bool:
    """Where only the error counts, a crank may start and end in any half turn."""
    return form.fits and form.crank and scaled.wanted.transmission_min_deg == 0


def keep_out(build: Builder, form: Form, x: Unknowns, places: Positions) -> None:
    """Each point that keeps out lies in every half-plane of its free region."""
    where = {"o2": [x.o2], "o4": [x.o4], "a": places.a, "b": places.b, "p": places.p}
    held = [place for name in form.keep_out for place in where[name]]
    planes = build.parameter(_planes, 3 * PLANES * len(held)) if held else ca.SX(0, 1)
    for k, plane in enumerate(ca.vertsplit(planes, 3) if held else ()):
        build.require(("keep_out",), ca.dot(plane[:2], held[k // PLANES]) - plane[2])


def require_own(
    build: Builder, form: Form, x: Unknowns, places: Positions, constraints: Sequence[Constraint]
) -> None:
    """The user's own constraints, on the symbols of the design in the problem's unit."""
    for constraint in constraints:
        design = symbolic_design(build, form, x, places)
        if isinstance(constraint, AtTarget) and build.slack is None:
            build.zero(*on_symbols(constraint.fixed, design))
            value = on_symbols(constraint.free, design)
        else:
            value = on_symbols(constraint, design)
        for one in value if isinstance(value, (list, tuple)) else [value]:
            build.require((getattr(constraint, "group", "constraints"),), -ca.vec(ca.SX(one)) - OWN_INSET)


def own_goal(build: Builder, form: Form, x: Unknowns, places: Positions, objective: OwnObjective) -> ca.SX:
    """The user's own objective, in units of its value at the start."""
    unit = build.parameter(lambda scaled, start: magnitude_at(scaled, start, objective))
    return ca.SX(on_symbols(objective, symbolic_design(build, form, x, places))) / unit


def arm_of(x: Unknowns, places: Positions) -> ca.SX:
    """P in the coupler's frame, sizes."""
    if not x.arm.is_empty():
        return x.arm
    coupler, to_p = places.b[0] - places.a[0], places.p[0] - places.a[0]
    return ca.vertcat(ca.dot(coupler, to_p) / x.r[2], cross(coupler, to_p) / x.r[2])


def symbolic_design(build: Builder, form: Form, x: Unknowns, places: Positions) -> Design:
    """The argument of a user's function, made of the unknowns."""
    scale = build.parameter(lambda scaled, _: scaled.frame.scale)
    origin = build.parameter(lambda scaled, _: interleaved(scaled.frame.origin), 2)
    arm = arm_of(x, places)
    named = form.kind.named([scale * length for length in ca.vertsplit(x.r)], x.theta1)
    o2, o4 = scale * x.o2 + origin, None if x.o4.is_empty() else scale * x.o4 + origin
    a, b, p = ([scale * point + origin for point in track] for track in (places.a, places.b, places.p))
    return Design(o2=o2, o4=o4, coupler_point=scale * arm, theta2=x.theta2, a=a, b=b, p=p, **named)


def off(x: Unknowns, targets: Targets, k: int) -> ca.SX:
    """Angle of the body from a pose."""
    return x.carrying[k] + x.body_angle - targets.turns[k]


def _turns(scaled: ScaledProblem, start: Start) -> FloatArray:
    """Angles of the body in the order of visit, moved by whole turns to be nearest to the start."""
    turned = np.array(start.carrying) + start.body_angle
    off = scaled.turns[list(start.visit)] - turned
    nearest: FloatArray = turned + np.angle(np.exp(1j * off))
    return nearest


def _target_weights(scaled: ScaledProblem, start: Start) -> FloatArray:
    visit = list(start.visit)
    return np.concatenate([scaled.weights[visit], scaled.turn_weights[visit]])


def _square(scaled: ScaledProblem, start: Start) -> float:
    """Weighted squared misses of the targets at the start."""
    order = np.argsort(start.visit)
    turned = np.array(start.carrying)[order] + start.body_angle
    missed = float(scaled.missed(start.track[2][order], turned)) ** 2 * len(order)
    if (curve := scaled.wanted_torque) is not None and curve.weight:
        missed += len(order) * float(curve.weight * rms(misses_at_start(scaled, start))) ** 2
    return missed


def misses_at_start(scaled: ScaledProblem, start: Start) -> FloatArray:
    """Drive torques of a start minus the wanted ones (K,), reference torques."""
    ways = np.array([start.theta2]), np.array([start.direction]), np.array([start.assembly])
    misses: FloatArray = torque_misses(scaled, start.points[None], *ways)[0]
    return misses


def _planes(scaled: ScaledProblem, start: Start) -> FloatArray:
    """Half-planes of the free regions about the points that keep out of areas."""
    from grashof.synth.programme.free_region import free_regions

    planes = free_regions(scaled.wanted, start, points_held(scaled))
    planes[..., 2] += INSET
    return planes.ravel()
