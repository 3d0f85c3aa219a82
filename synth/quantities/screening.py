"""Screened linkages of a search, and their violations of the requirements."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from grashof.problems import FourBar, Requirements, Rotatability, TransmissionOver
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray, IntArray, turned_beyond
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.loop.dyad import as_vector
from grashof.synth.loop.vector import Vector
from grashof.synth.quantities.formulas import Part, View, parts_of, range_of
from grashof.synth.quantities.kind import LENGTHS, Kind
from grashof.synth.quantities.regions import outside, pairs_of

ROUNDING = 1e-10  # sizes, rad: up to which a limit counts as kept
TOUCHING = 1e-10  # sizes: a point no deeper inside an area counts as on its boundary
# The requirements that linkages can violate, named by their fields.
GROUPS = ("order", "same_branch", "rotatability", *LIMITS, "constraints", "at", "keep_out", "within")


@dataclass(frozen=True, slots=True)
class Screened:
    """Linkages in the frame of the search, and their violations of the requirements."""

    points: ComplexArray  # (n, 5), sizes; O2, O4, and A, B, P at the first target
    visit: IntArray  # (n, N); targets in the order in which the driver meets them
    theta2: FloatArray  # (n, N), rad, in that order, each step in the driver's sense and less than a turn
    direction: FloatArray  # (n,), sense of the driver
    assembly: FloatArray  # (n,), sign of sin(theta4 - theta3) that fits most targets
    # (n, len(GROUPS)); amount by which each requirement is missed, zero when met: sizes, radians or ratios
    violations: FloatArray
    transmission: FloatArray  # (n,), rad; worst over the task or the cycle, as required
    coupler: ComplexArray  # (n, N), sizes; from A to B at every target, in the order of the targets
    error: FloatArray  # (n,), sizes; root mean square distance from the targets
    body_angle: FloatArray  # (n,), rad; coupler to body, where the first pose does not fix it; else zero
    kind: Kind

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, index: IntArray | BoolArray | slice) -> Screened:
        arrays: dict[str, Any] = {name: getattr(self, name)[index] for name in self.arrays()}
        return replace(self, **arrays)

    @classmethod
    def arrays(cls) -> tuple[str, ...]:
        """Names of the fields that have a row for each linkage."""
        return tuple(each.name for each in fields(cls) if each.name != "kind")

    @classmethod
    def joined(cls, parts: Sequence[Screened]) -> Screened:
        """Several of one kind as one."""
        arrays: dict[str, Any] = {
            name: np.concatenate([getattr(part, name) for part in parts]) for name in cls.arrays()
        }
        return replace(parts[0], **arrays)

    @property
    def feasible(self) -> BoolArray:
        """Which linkages violate nothing, shape (n,)."""
        return met(self.violations)

    @property
    def track(self) -> ComplexArray:
        """A, B and P at every target in the order of visit, shape (3, n, N), sizes."""
        o2, _, a, b, p = self.points.T[..., None]
        coupler = np.take_along_axis(self.coupler, self.visit, axis=1)
        at_a = o2 + np.abs(a - o2) * np.exp(1j * self.theta2)
        turned = coupler if self.kind.dyad.bars else coupler * np.abs(b - a) / np.abs(coupler)
        return np.stack([at_a, at_a + coupler, at_a + (p - a) / (b - a) * turned])


@dataclass(frozen=True, slots=True)
class Configurations:
    """Linkages at all their targets; arrays of shape (n,) and, with targets as columns, (n, N); sizes."""

    o2: ComplexArray
    o4: ComplexArray  # of a slider-crank the point of its slide's line r3 ahead of B at the first target
    a: ComplexArray  # (n, N), as b, in the order of the targets
    b: ComplexArray
    visit: IntArray
    theta2: FloatArray  # (n, N), rad, in the order of visit, unwrapped along the motion
    direction: FloatArray
    kind: Kind


class Many(View):
    """Many linkages as formulas see them, or of each the dyad O2A or O4B alone.

    Pivots (n,), A and B (n, N), and P at the first target (n,) in sizes; theta2 (n, N) in rad in the order of
    visit; the angle of the body at the first target (n,) in rad. `sine` (n, N) is the signed sin mu at the
    targets, of whole linkages.
    """

    def __init__(
        self,
        p: ComplexArray,
        o2: ComplexArray | None = None,
        a: ComplexArray | None = None,
        o4: ComplexArray | None = None,
        b: ComplexArray | None = None,
        theta2: FloatArray | None = None,
        body_turn: FloatArray | None = None,
        *,
        kind: Kind,
    ) -> None:
        self._p, self.kind = p, kind
        if o2 is not None and a is not None:
            crank = a - o2[:, None]
            self.o2, self.a, self.ap = as_vector(o2[:, None]), as_vector(a), self.p_from(a)
            self.r2, self.theta2_start = np.abs(crank[:, :1]), np.angle(crank[:, :1])
        if o4 is not None and b is not None:
            self.o4, self.b, self.bp = as_vector(o4[:, None]), as_vector(b), self.p_from(b)
            self.r4 = np.abs(b[:, :1] - o4[:, None])
        if o2 is not None and o4 is not None and a is not None and b is not None:
            first = o2[:, None], o4[:, None], a[:, :1], b[:, :1]
            with np.errstate(divide="ignore", invalid="ignore"):
                *lengths, self.offset = kind.dyad.lengths_of(*first)
                for name, length in zip(LENGTHS, (*lengths, self.offset), strict=True):
                    if name in kind.linkage.mechanism.lengths:
                        setattr(self, name, length)
                self.theta1 = kind.theta1_of(*first[:2], first[3])
                self.sine = kind.sine(self, o4, a, b)
            self.double_crank = self.r2 > getattr(self, "r1", np.inf)
            self.turns = kind.dyad.turns_fully(self)
        if theta2 is not None:
            gone = theta2[:, -1:] - theta2[:, :1]
            self.driver_turn, self.direction = np.abs(gone), np.sign(gone)
        if body_turn is not None:
            self.body_turn = body_turn[:, None]

    def p_from(self, pivot: ComplexArray) -> Vector:
        """From a pivot (n, N) to the coupler point, at the first target."""
        return as_vector((self._p - pivot[:, 0])[:, None])


def _oversteps(view: Many, wanted: Requirements, dyad: int | None) -> Iterator[tuple[str, FloatArray]]:
    """Excess over limits at the worst target, (n,), of the parts that one dyad decides, or both (None)."""
    missed: dict[str, FloatArray] = {}  # the parts of a quantity add up at every target
    for name, part in parts_of(wanted.limited, view.kind.formulas):
        if part.dyad == dyad:
            missed[name] = missed.get(name, 0.0) + _overstep(view, name, part, wanted)
    for name, region, x, y in pairs_of(wanted, view.kind.formulas):
        if x.dyad == dyad:  # instead of the box around the region
            amount = outside(region, x.of(view), y.of(view))
            missed[name] = np.where(amount > ROUNDING, amount, 0.0)
    yield from ((name, amount.max(axis=1)) for name, amount in missed.items())


def _overstep(view: View, name: str, part: Part, wanted: Requirements) -> FloatArray:
    value, (low, high) = part.of(view), range_of(wanted, name, part)
    if LIMITS[name].kind.is_angle:
        period = wanted.period(LIMITS[name].quantity.key)
        amount: FloatArray = np.abs(turned_beyond(value, (low, high), period))
    elif part.per is not None:
        amount = np.maximum(value / high - part.per(view), 0.0)
    else:
        value = np.sqrt(value) if part.squared else value
        amount = np.maximum(np.maximum(low - value, value - high), 0.0)
    return np.where(amount > ROUNDING, amount, 0.0)


def judge(
    found: Configurations,
    p: ComplexArray,
    error: FloatArray,
    violations: FloatArray,
    wanted: Requirements,
    body_angle: FloatArray | None = None,
    first_turn: FloatArray | None = None,
) -> Screened:
    """Judge linkages by everything but what single dyads decide, which is known already (`dyad_violations`).

    P at the first target (n,) and the root mean square distance from the targets (n,) in sizes, requirements
    in the frame of the search. `first_turn` (n,) in rad is the angle of the body at the first target, where
    it is not the coupler's and `body_angle`.
    """
    coupler = found.b - found.a
    if first_turn is None:
        first_turn = np.angle(coupler[:, 0]) + (0.0 if body_angle is None else body_angle)
    view = Many(p, found.o2, found.a, found.o4, found.b, found.theta2, first_turn, kind=found.kind)
    sine = view.sine
    with np.errstate(divide="ignore", invalid="ignore"):
        assembly = np.where(np.sum(np.sign(sine), axis=1) >= 0, 1.0, -1.0)
        found, violations, span, cycle = _ways(found, view, violations, wanted.order)

    def violate(group: str, amount: FloatArray) -> None:
        violations[:, GROUPS.index(group)] += np.maximum(amount, 0.0)

    reach = span
    joined = ((assembly[:, None] * sine > 0).all(axis=1)) & (span <= 1)
    span = np.where(joined, span, 1.0)  # no motion joins the targets: nothing is transmitted
    over = cycle if wanted.transmission_over is TransmissionOver.CYCLE else span
    transmission = np.nan_to_num(np.arccos(np.minimum(over, 1.0)))
    if wanted.same_branch:
        violate("same_branch", (-assembly[:, None] * sine).max(axis=1, initial=-1.0) + 1e-6)
        violate("same_branch", reach - 1.0)
    # Where the targets are not joined but have to be, nothing else counts as missing.
    judged = joined if wanted.same_branch else np.ones_like(joined)
    violate("transmission_min_deg", judged * (np.radians(wanted.transmission_min_deg) - transmission))
    violate("rotatability", _rotatability_violation(view, wanted))
    for name, amount in _oversteps(view, wanted, None):
        violate(name, amount)
    shortest = np.minimum.reduce([getattr(view, name) for name in found.kind.linkage.mechanism.lengths])
    violate("link_length", 1e-9 - shortest[:, 0])
    points = np.stack([found.o2, found.o4, found.a[:, 0], found.b[:, 0], p], axis=1)
    return Screened(
        points=points,
        visit=found.visit,
        theta2=found.theta2,
        direction=found.direction,
        assembly=assembly,
        violations=violations,
        transmission=transmission,
        coupler=coupler,
        error=error,
        body_angle=np.zeros(len(points)) if body_angle is None else body_angle,
        kind=found.kind,
    )


def dyad_violations(
    pivot: str,
    ground: ComplexArray,
    places: ComplexArray,
    p: ComplexArray,
    wanted: Requirements,
    kind: Kind,
) -> FloatArray:
    """Violations by dyads alone, driver ("o2") or driven ("o4"), (n, len(GROUPS)).

    Such as length, coupler arm, places of ground pivot (n,) and joint at every target (n, N), all in sizes; P
    (n,) at the first target.
    """
    joint, dyad = ("a", 2) if pivot == "o2" else ("b", 4)
    violations = np.zeros((len(ground), len(GROUPS)))
    view = Many(p, ground, places, kind=kind) if dyad == 2 else Many(p, o4=ground, b=places, kind=kind)
    for name, amount in _oversteps(view, wanted, dyad):
        violations[:, GROUPS.index(name)] = amount
    for name, points in ((pivot, ground[:, None]), (joint, places)):
        if name in kind.linkage.mechanism.points:
            violations[:, GROUPS.index("keep_out")] += keep_out_violation(name, points, wanted)
    return violations


def violations_apart(
    found: Configurations, p: ComplexArray, track: ComplexArray, wanted: Requirements
) -> FloatArray:
    """Violations by each dyad, and by P on its `track` (n, k), alone; see `dyad_violations`."""
    violations = dyad_violations("o2", found.o2, found.a, p, wanted, found.kind)
    violations += dyad_violations("o4", found.o4, found.b, p, wanted, found.kind)
    violations[:, GROUPS.index("keep_out")] += keep_out_violation("p", track, wanted)
    return violations


def keep_out_violation(name: str, points: ComplexArray, wanted: Requirements) -> FloatArray:
    """Greatest depth (n,) of a pivot or the coupler point, at places (n, k), in areas kept out.

    Requirements in the frame of the points; `name` is "o2", "o4", "a", "b" or "p".

    >>> square = Requirements(keep_out=[[[0, 0], [4, 0], [4, 4], [0, 4]]])
    >>> points = np.array([[1 + 2j], [4 + 1j], [9]])
    >>> keep_out_violation("o2", points, square).tolist(), keep_out_violation("a", points, square).tolist()
    ([1.0, 0.0, 0.0], [0.0, 0.0, 0.0])
    """
    if name not in points_kept_out(wanted):
        return np.zeros(len(points))
    deepest: FloatArray = inside(wanted, points).max(axis=1)
    return deepest


def points_kept_out(wanted: Requirements) -> tuple[str, ...]:
    """Those of o2, o4, a, b, p that must keep out of areas: the stated ones, and the ends of links."""
    if not wanted.keep_out:
        return ()
    return tuple(name for name in FourBar.mechanism.points if {name, "links"} & set(wanted.keep_out_for))


def inside(wanted: Requirements, points: ComplexArray) -> FloatArray:
    """Depth of points (...) inside the areas of the requirements; zero outside."""
    # Here, not above: shapely takes a while to import, and few problems have areas.
    from grashof.problems.values.areas import solid

    return depth_in(solid(wanted.keep_out), points)


def depth_in(area: Any, points: ComplexArray) -> FloatArray:
    """Depth of points (...) inside a geometry of shapely; zero outside."""
    import shapely  # as above

    found = np.zeros(points.shape)
    within = shapely.contains_xy(area, points.real, points.imag)
    places = shapely.points(points.real[within], points.imag[within])
    found[within] = shapely.distance(shapely.boundary(area), places)
    return np.where(found > TOUCHING, found, 0.0)


def met(violations: FloatArray) -> BoolArray:
    """Which rows of violations, shape (n, len(GROUPS)), are all zero."""
    nothing: BoolArray = violations.max(axis=1, initial=0.0) <= 0
    return nothing


def _ways(
    found: Configurations, view: Many, violations: FloatArray, ordered: bool
) -> tuple[Configurations, FloatArray, FloatArray, FloatArray]:
    """The driver's motion in each linkage, violations, and the greatest |cos mu| over it and over a turn."""
    dyad = found.kind.dyad
    fold, stretch = (np.abs(dyad.cos_mu(view, reach))[:, 0] for reach in dyad.along_ground(view))
    ends = found.theta2[:, [0, -1]] - view.theta1
    inside = found.theta2 - view.theta1
    inside = np.where((stretch > 1)[:, None], (inside + np.pi) % TURN - np.pi, inside % TURN)
    # a driver that cannot turn, with all targets in one of its ranges, has no way around
    one_side = (fold <= 1) | (stretch <= 1) | (np.ptp(np.sign(inside), axis=1) == 0)
    rows = np.flatnonzero(one_side & ((fold > 1) | (stretch > 1)))
    ends[rows] = np.stack([inside[rows].min(axis=1), inside[rows].max(axis=1)], axis=1)
    found, violations = _kept_inside(found, violations, rows, (inside + view.theta1)[rows], ordered)
    crossed = np.floor(np.sort(ends, axis=1) / np.pi)
    count = crossed[:, 1] - crossed[:, 0]
    even = (count >= 2) | ((count == 1) & (crossed[:, 1] % 2 == 0))
    odd = (count >= 2) | ((count == 1) & (crossed[:, 1] % 2 == 1))
    span = np.maximum(np.where(even, fold, 0.0), np.where(odd, stretch, 0.0))
    at_ends = dyad.cos_mu(view, dyad.reach(view, ends))
    span = np.maximum(span, np.abs(at_ends).max(axis=1))
    # where |cos mu| is above 1 the linkage does not close
    return found, violations, span, np.maximum(fold, stretch)


def _kept_inside(
    found: Configurations, violations: FloatArray, rows: IntArray, inside: FloatArray, ordered: bool
) -> tuple[Configurations, FloatArray]:
    """Drivers, some of which (`rows`) meet the targets at angles `inside` of a range they cannot leave."""
    visit, theta2, violations = found.visit.copy(), found.theta2.copy(), violations.copy()
    direction = found.direction.copy()
    if ordered:  # out of order, the angles stay those of a driver that could turn
        step = np.diff(inside, axis=1)
        disorder = np.minimum((-step).max(axis=1, initial=0.0), step.max(axis=1, initial=0.0))
        violations[rows, GROUPS.index("order")] = disorder
        # two targets are in order either way; here only one is open
        back = (disorder <= 0) & ((inside[:, -1] - inside[:, 0]) * direction[rows] < 0)
        theta2[rows[back]] = inside[back]
        direction[rows[back]] *= -1
    else:
        sequence = np.argsort(inside, axis=1)
        visit[rows] = np.take_along_axis(visit[rows], sequence, axis=1)
        theta2[rows] = np.take_along_axis(inside, sequence, axis=1)
    return replace(found, visit=visit, theta2=theta2, direction=direction), violations


def _rotatability_violation(view: Many, wanted: Requirements) -> FloatArray:
    if wanted.rotatability is Rotatability.ANY:
        return np.zeros(len(view.r2))
    asked = {Rotatability.CRANK_ROCKER: False, Rotatability.DOUBLE_CRANK: True}.get(wanted.rotatability)
    if asked is not None:
        view.double_crank = np.full_like(view.double_crank, asked)
    least: FloatArray = np.minimum.reduce([margin[:, 0] for margin in view.kind.dyad.margins(view)])
    violation: FloatArray = wanted.rotatability_margin - least
    return violation
