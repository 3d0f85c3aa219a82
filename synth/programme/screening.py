"""Screened linkages of a search, and how far each violates the requirements."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from grashof.problems import Box, Requirements, Rotatability, TransmissionOver
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray, IntArray, Limits

# The requirements that can stand in the way, named by their keys.
GROUPS = (
    "order",
    "same_branch",
    "rotatability",
    "transmission_min_deg",
    "link_length",
    "link_ratio_max",
    "coupler_arms",
    "o2",
    "o4",
    "a",
    "b",
    "ground_angle_deg",
    "theta2_start_deg",
    "constraints",
    "keep_out",
    "within",
)


@dataclass(frozen=True, slots=True)
class Screened:
    """Linkages in the frame of the search, and how far each violates the requirements.

    Parameters
    ----------
    points : ndarray of complex, shape (n, 5), sizes
        O2, O4, and A, B, P at the first target.
    visit : ndarray of int, shape (n, N)
        Targets in the order in which the driver meets them.
    theta2 : ndarray, shape (n, N), rad
        Driver angles in that order, each step in the driver's sense and less than a turn.
    direction, assembly : ndarray, shape (n,)
        Sense of the driver and sign of sin(theta4 - theta3) that fits most targets.
    violations : ndarray, shape (n, len(GROUPS))
        By how much each requirement is missed, zero when met: sizes, radians or ratios.
    transmission : ndarray, shape (n,), rad
        Worst over the task or the cycle, as required.
    coupler : ndarray of complex, shape (n, N), sizes
        From A to B at every target, in the order of the targets.
    error : ndarray, shape (n,), sizes
        Root mean square distance from the targets.
    body_angle : ndarray, shape (n,), rad
        From the coupler to the body, where the first pose does not say it; else zero.
    """

    points: ComplexArray
    visit: IntArray
    theta2: FloatArray
    direction: FloatArray
    assembly: FloatArray
    violations: FloatArray
    transmission: FloatArray
    coupler: ComplexArray
    error: FloatArray
    body_angle: FloatArray

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, index: IntArray | BoolArray | slice) -> Screened:
        return Screened(*(getattr(self, name)[index] for name in self.__slots__))

    @property
    def feasible(self) -> BoolArray:
        """Which linkages violate nothing, shape (n,)."""
        return met(self.violations)


@dataclass(frozen=True, slots=True)
class Configurations:
    """Linkages at all their targets; arrays of shape (n,) and, with targets as columns, (n, N).

    Parameters
    ----------
    o2, o4 : ndarray of complex, shape (n,), sizes
    a, b : ndarray of complex, shape (n, N), sizes
        In the order of the targets.
    visit : ndarray of int, shape (n, N)
    theta2 : ndarray, shape (n, N), rad
        In the order of visit, counted on along the motion.
    direction : ndarray, shape (n,)
    """

    o2: ComplexArray
    o4: ComplexArray
    a: ComplexArray
    b: ComplexArray
    visit: IntArray
    theta2: FloatArray
    direction: FloatArray


def judge(
    found: Configurations,
    p: ComplexArray,
    error: FloatArray,
    violations: FloatArray,
    wanted: Requirements,
    body_angle: FloatArray | None = None,
) -> Screened:
    """Judge linkages by everything but what single dyads decide.

    Parameters
    ----------
    found : Configurations
    p : ndarray of complex, shape (n,), sizes
        The coupler point at the first target.
    error : ndarray, shape (n,), sizes
        Root mean square distance from the targets.
    violations : ndarray, shape (n, len(GROUPS))
        Violations known already (see `dyad_violations`).
    wanted : Requirements
        In the frame of the search.
    body_angle : ndarray, shape (n,), rad, optional

    Returns
    -------
    Screened
    """
    ground, coupler = found.o4 - found.o2, found.b - found.a
    output = found.b - found.o4[:, None]
    r1, r3 = np.abs(ground), np.abs(coupler[:, 0])
    r2, r4 = np.abs(found.a[:, 0] - found.o2), np.abs(output[:, 0])
    with np.errstate(divide="ignore", invalid="ignore"):
        sine = (coupler.conj() * output).imag / (r3 * r4)[:, None]
        assembly = np.where(np.sum(np.sign(sine), axis=1) >= 0, 1.0, -1.0)
        found, violations, span, cycle = _ways(found, violations, wanted.order)

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
    # Where the targets are not joined but have to be, that alone is what is missing.
    judged = joined if wanted.same_branch else np.ones_like(joined)
    violate("transmission_min_deg", judged * (np.radians(wanted.transmission_min_deg) - transmission))
    violate("rotatability", _rotatability_violation(r1, r2, r3, r4, wanted))
    for length, limits in ((r1, wanted.link_lengths[0]), (r3, wanted.link_lengths[2])):
        violate("link_length", outside(length, (max(limits[0], 1e-9), limits[1])))
    longest, shortest = np.maximum.reduce([r1, r2, r3, r4]), np.minimum.reduce([r1, r2, r3, r4])
    violate("link_ratio_max", longest / wanted.link_ratio_max - shortest)
    if wanted.ground_angle_deg is not None:
        turned = ground * np.exp(-1j * np.radians(wanted.ground_angle_deg))
        violate("ground_angle_deg", np.abs(np.angle(turned)))
    points = np.stack([found.o2, found.o4, found.a[:, 0], found.b[:, 0], p], axis=1)
    if wanted.keep_out:
        from grashof.synth.programme.keep_out_depth import depth_on_the_way

        sound = met(violations)  # the others need not be looked at so closely
        deep = depth_on_the_way(points[sound], assembly[sound], found.theta2[sound], wanted)
        violations[sound, GROUPS.index("keep_out")] = deep
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
    )


def dyad_violations(
    pivot: str, ground: ComplexArray, places: ComplexArray, p: ComplexArray, wanted: Requirements
) -> FloatArray:
    """What dyads lack by themselves: length, coupler arm, place of the ground pivot and of the joint.

    Parameters
    ----------
    pivot : {"o2", "o4"}
        As driver or as driven dyad.
    ground : ndarray of complex, shape (n,), sizes
    places : ndarray of complex, shape (n, N), sizes
        The moving pivot at every target.
    p : ndarray of complex, shape (n,), sizes
        The coupler point at the first target.
    wanted : Requirements

    Returns
    -------
    ndarray, shape (n, len(GROUPS))
    """
    joint, link = ("a", 1) if pivot == "o2" else ("b", 3)
    violations = np.zeros((len(ground), len(GROUPS)))
    length = np.abs(places - ground[:, None]).mean(axis=1)
    violations[:, GROUPS.index("link_length")] = outside(length, wanted.link_lengths[link])
    violations[:, GROUPS.index("coupler_arms")] = outside(np.abs(places[:, 0] - p), wanted.coupler_arms)
    for name, points in ((pivot, ground[:, None]), (joint, places)):
        box = getattr(wanted, name) or Box()
        missed = outside(points.real, box.x) + outside(points.imag, box.y)
        violations[:, GROUPS.index(name)] = missed.max(axis=1)
        violations[:, GROUPS.index("keep_out")] += keep_out_violation(name, points, wanted)
    if pivot == "o2" and wanted.theta2_start_deg is not None:
        off = np.angle(places[:, 0] - ground) - np.radians(wanted.theta2_start_deg)
        violations[:, GROUPS.index("theta2_start_deg")] = np.abs(np.angle(np.exp(1j * off)))
    return violations


def keep_out_violation(name: str, points: ComplexArray, wanted: Requirements) -> FloatArray:
    """How deep a pivot or the coupler point lies in areas kept out, deepest of its places (n, k); (n,)."""
    if not wanted.keep_out:
        return np.zeros(len(points))
    # Here, not above: shapely takes a while to import, and few problems have areas.
    from grashof.synth.programme.keep_out_depth import depth

    deepest: FloatArray = depth(wanted, name, points).max(axis=1)
    return deepest


def as_they_come(angle: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
    """Order in which a driver meets targets on the shortest arc that holds them all.

    Parameters
    ----------
    angle : ndarray, shape (n, N), rad
        Driver angle at each target.

    Returns
    -------
    visit : ndarray of int, shape (n, N)
    theta2 : ndarray, shape (n, N), rad
        In that order, counted on, counter-clockwise.
    direction : ndarray, shape (n,)
    """
    count, sense = angle.shape[1], np.ones(len(angle))
    visit = np.argsort(angle % TURN, axis=1)
    turned = np.take_along_axis(angle, visit, axis=1)
    gap = (np.roll(turned, -1, axis=1) - turned) % TURN
    begin = (gap.argmax(axis=1)[:, None] + 1 + np.arange(count)) % count
    visit = np.take_along_axis(visit, begin, axis=1)
    return visit, follow(np.take_along_axis(angle, visit, axis=1), sense), sense


def follow(angle: FloatArray, direction: FloatArray) -> FloatArray:
    """Driver angles (n, N) counted on in the driver's sense, each step less than a turn."""
    steps = direction[:, None] * ((direction[:, None] * np.diff(angle, axis=1)) % TURN)
    return np.concatenate([angle[:, :1], angle[:, :1] + np.cumsum(steps, axis=1)], axis=1)


def outside(values: FloatArray, limits: Limits | None) -> FloatArray:
    """By how much values lie outside limits."""
    low, high = limits if limits is not None else (-np.inf, np.inf)
    missed: FloatArray = np.maximum(np.maximum(low - values, values - high), 0.0)
    return missed


def met(violations: FloatArray) -> BoolArray:
    """Which rows of violations, shape (n, len(GROUPS)), are all zero."""
    nothing: BoolArray = violations.max(axis=1, initial=0.0) <= 0
    return nothing


def _ways(
    found: Configurations, violations: FloatArray, ordered: bool
) -> tuple[Configurations, FloatArray, FloatArray, FloatArray]:
    """The way that each linkage lets its driver go, violations, greatest |cos mu| over it and over a turn.

    Above 1 the linkage does not close. A driver that cannot turn, with all targets in one of its
    ranges, has no way around.
    """
    ground = found.o4 - found.o2
    r1, r2 = np.abs(ground), np.abs(found.a[:, 0] - found.o2)
    r3, r4 = np.abs(found.b[:, 0] - found.a[:, 0]), np.abs(found.b[:, 0] - found.o4)

    def cos_mu(diagonal2: FloatArray) -> FloatArray:
        cosine: FloatArray = np.abs((r3**2 + r4**2 - diagonal2) / (2 * r3 * r4))
        return cosine

    folded, stretched, theta1 = cos_mu((r1 - r2) ** 2), cos_mu((r1 + r2) ** 2), np.angle(ground)[:, None]
    ends = found.theta2[:, [0, -1]] - theta1
    inside = found.theta2 - theta1
    inside = np.where((stretched > 1)[:, None], (inside + np.pi) % TURN - np.pi, inside % TURN)
    one_side = (folded <= 1) | (stretched <= 1) | (np.ptp(np.sign(inside), axis=1) == 0)
    rows = np.flatnonzero(one_side & ((folded > 1) | (stretched > 1)))
    ends[rows] = np.stack([inside[rows].min(axis=1), inside[rows].max(axis=1)], axis=1)
    found, violations = _kept_inside(found, violations, rows, (inside + theta1)[rows], ordered)
    crossed = np.floor(np.sort(ends, axis=1) / np.pi)
    count = crossed[:, 1] - crossed[:, 0]
    even = (count >= 2) | ((count == 1) & (crossed[:, 1] % 2 == 0))
    odd = (count >= 2) | ((count == 1) & (crossed[:, 1] % 2 == 1))
    span = np.maximum(np.where(even, folded, 0.0), np.where(odd, stretched, 0.0))
    for end in ends.T:
        span = np.maximum(span, cos_mu((r1 - r2) ** 2 + 4 * r1 * r2 * np.sin(end / 2) ** 2))
    return found, violations, span, np.maximum(folded, stretched)


def _kept_inside(
    found: Configurations, violations: FloatArray, rows: IntArray, inside: FloatArray, ordered: bool
) -> tuple[Configurations, FloatArray]:
    """Drivers of which some, `rows`, meet the targets at the angles `inside` of a range they cannot leave."""
    visit, theta2, violations = found.visit.copy(), found.theta2.copy(), violations.copy()
    if ordered:  # out of order, the angles stay those of a driver that could turn
        step = np.diff(inside, axis=1)
        violations[rows, GROUPS.index("order")] = np.minimum(
            (-step).max(axis=1, initial=0.0), step.max(axis=1, initial=0.0)
        )
    else:
        sequence = np.argsort(inside, axis=1)
        visit[rows] = np.take_along_axis(visit[rows], sequence, axis=1)
        theta2[rows] = np.take_along_axis(inside, sequence, axis=1)
    return replace(found, visit=visit, theta2=theta2), violations


def _rotatability_violation(
    r1: FloatArray, r2: FloatArray, r3: FloatArray, r4: FloatArray, wanted: Requirements
) -> FloatArray:
    if wanted.rotatability is Rotatability.ANY:
        return np.zeros(len(r1))
    difference = {
        Rotatability.FULL_CRANK: np.abs(r1 - r2),
        Rotatability.CRANK_ROCKER: r1 - r2,
        Rotatability.DOUBLE_CRANK: r2 - r1,
    }[wanted.rotatability]
    least = np.minimum(r3 + r4 - r1 - r2, difference - np.abs(r3 - r4)) / (r1 + r2 + r3 + r4)
    lack: FloatArray = wanted.rotatability_margin - least
    return lack
