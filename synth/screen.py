"""Screening: all pairs of dyads judged at once, either one as the driver, under all requirements.

Lengths are in sizes of the task, points are complex, poses are columns.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems import Requirements, Rotatability, TransmissionOver
from grashof.problems.checks import BoolArray, ComplexArray, FloatArray, IntArray, Limits
from grashof.synth.burmester import Displacements, Dyads

TURN = 2 * np.pi


@dataclass(frozen=True, slots=True)
class Pairs:
    """Pairs of a driving and a driven dyad: linkages, with what each lacks.

    Parameters
    ----------
    driver, driven : Dyads
        Of n pairs, one entry a pair.
    visit : ndarray of int, shape (n, N)
        Poses in the order in which the driver meets them.
    theta2 : ndarray, shape (n, N), rad
        Driver angles in that order, each step in the driver's sense and less than a turn.
    direction, assembly : ndarray, shape (n,)
        Sense of the driver and sign of sin(theta4 - theta3) that fits most poses.
    lacks : ndarray, shape (n, len(GROUPS))
        By how much each requirement is missed, zero when met: sizes, radians or ratios.
    transmission : ndarray, shape (n,), rad
        Worst over the task or the cycle, as required.
    """

    driver: Dyads
    driven: Dyads
    visit: IntArray
    theta2: FloatArray
    direction: FloatArray
    assembly: FloatArray
    lacks: FloatArray
    transmission: FloatArray

    def __len__(self) -> int:
        return len(self.driver)

    def __getitem__(self, index: IntArray | BoolArray | slice) -> Pairs:
        return Pairs(*(getattr(self, name)[index] for name in self.__slots__))

    @property
    def feasible(self) -> BoolArray:
        """Which pairs lack nothing, shape (n,)."""
        return _met(self.lacks)

    @property
    def points(self) -> ComplexArray:
        """O2, O4, and A, B at the first pose; shape (n, 4)."""
        sides = [self.driver.ground, self.driven.ground, self.driver.moving, self.driven.moving]
        return np.stack(sides, axis=1)


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
)


@dataclass(frozen=True, slots=True)
class _Side:
    """What is known of dyads by themselves, as drivers or as driven ones."""

    dyads: Dyads
    lacks: FloatArray
    length: FloatArray
    visit: IntArray
    theta2: FloatArray
    direction: FloatArray

    def __getitem__(self, index: IntArray | BoolArray | slice) -> _Side:
        return _Side(*(getattr(self, name)[index] for name in self.__slots__))

    def __len__(self) -> int:
        return len(self.dyads)


def screen(motion: Displacements, body: complex, dyads: Dyads, wanted: Requirements, pairs: int) -> Pairs:
    """All feasible pairs of the given dyads.

    Parameters
    ----------
    motion : Displacements
    body : complex
        The guided point at the first pose.
    dyads : Dyads
    wanted : Requirements
        In the frame of the search.
    pairs : int
        Most pairs to judge; beyond it the dyads are thinned.

    Returns
    -------
    Pairs
    """
    driver, driven = _sides(motion, body, dyads, wanted)
    driver, driven = driver[_met(driver.lacks)], driven[_met(driven.lacks)]
    stride = max(1, int(np.ceil(np.sqrt(len(driver) * len(driven) / pairs))))
    driver, driven = driver[::stride], driven[::stride]
    if not len(driver) or not len(driven):
        return _judge(motion, driver[:0], driven[:0], wanted)
    first, second = np.nonzero(_promising(motion, driver, driven, wanted))
    judged = _judge(motion, driver[first], driven[second], wanted)
    return judged[judged.feasible]


def near_misses(
    motion: Displacements, body: complex, dyads: Dyads, wanted: Requirements, pairs: int
) -> Pairs:
    """All pairs of (thinned) dyads with what each lacks, feasible or not."""
    driver, driven = _sides(motion, body, dyads, wanted)
    stride = max(1, int(np.ceil(len(driver) / np.sqrt(pairs))))
    driver, driven = driver[::stride], driven[::stride]
    apart = np.abs(driver.dyads.moving[:, None] - driven.dyads.moving) > 1e-6
    apart &= np.abs(driver.dyads.ground[:, None] - driven.dyads.ground) > 1e-6
    first, second = np.nonzero(apart & (driver.length[:, None] > 1e-6) & (driven.length > 1e-6))
    return _judge(motion, driver[first], driven[second], wanted)


def _sides(motion: Displacements, body: complex, dyads: Dyads, wanted: Requirements) -> tuple[_Side, _Side]:
    arm = motion.apply(dyads.moving) - dyads.ground[:, None]
    length = np.abs(arm).mean(axis=1)
    visit, theta2, direction, disorder = _visiting_order(np.angle(arm), wanted.order)
    sides = []
    for pivot, joint, limits in (("o2", "a", wanted.link_lengths[1]), ("o4", "b", wanted.link_lengths[3])):
        lacks = np.zeros((len(dyads), len(GROUPS)))
        lacks[:, GROUPS.index("link_length")] = _outside(length, limits)
        lacks[:, GROUPS.index("coupler_arms")] = _outside(np.abs(dyads.moving - body), wanted.coupler_arms)
        box = getattr(wanted, pivot)
        lacks[:, GROUPS.index(pivot)] = _outside(dyads.ground.real, box.x) + _outside(
            dyads.ground.imag, box.y
        )
        box, places = getattr(wanted, joint), motion.apply(dyads.moving)
        missed = _outside(places.real, box.x) + _outside(places.imag, box.y)
        lacks[:, GROUPS.index(joint)] = missed.max(axis=1)
        if pivot == "o2":
            lacks[:, GROUPS.index("order")] = disorder
            if wanted.theta2_start_deg is not None:
                start = np.angle(arm[:, 0]) - np.radians(wanted.theta2_start_deg)
                lacks[:, GROUPS.index("theta2_start_deg")] = np.abs(np.angle(np.exp(1j * start)))
        sides.append(_Side(dyads, lacks, length, visit, theta2, direction))
    return sides[0], sides[1]


def _visiting_order(angle: FloatArray, ordered: bool) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    """Order of the poses on the driver's way, angles along it, its sense, and how far from in order."""
    count = angle.shape[1]
    if not ordered:  # the shortest arc that holds all targets, counter-clockwise
        visit = np.argsort(angle % TURN, axis=1)
        turned = np.take_along_axis(angle, visit, axis=1)
        gap = (np.roll(turned, -1, axis=1) - turned) % TURN
        begin = (gap.argmax(axis=1)[:, None] + 1 + np.arange(count)) % count
        visit = np.take_along_axis(visit, begin, axis=1)
        angle = np.take_along_axis(angle, visit, axis=1)
        theta2 = _follow(angle, np.ones(len(angle)))
        return visit, theta2, np.ones(len(angle)), np.zeros(len(angle))
    visit = np.broadcast_to(np.arange(count), angle.shape)
    step = (np.diff(angle, axis=1)) % TURN
    forward = step.sum(axis=1)
    backward = TURN * (count - 1) - forward
    direction = np.where(forward <= backward, 1.0, -1.0)
    gone = np.where(direction > 0, forward, backward)
    back = np.where(direction[:, None] > 0, TURN - step, step)
    disorder = np.where(gone < TURN, 0.0, back.min(axis=1))
    return visit, _follow(angle, direction), direction, disorder


def _follow(angle: FloatArray, direction: FloatArray) -> FloatArray:
    steps = direction[:, None] * ((direction[:, None] * np.diff(angle, axis=1)) % TURN)
    return np.concatenate([angle[:, :1], angle[:, :1] + np.cumsum(steps, axis=1)], axis=1)


def _promising(motion: Displacements, driver: _Side, driven: _Side, wanted: Requirements) -> BoolArray:
    """Which pairs, shape (n, m), pass the cheap tests: link lengths and one assembly sign at all poses."""
    joints = np.abs(driver.dyads.moving[:, None] - driven.dyads.moving)
    pivots = np.abs(driver.dyads.ground[:, None] - driven.dyads.ground)
    keep = np.ones(joints.shape, dtype=bool)
    for length, limits in ((pivots, wanted.link_lengths[0]), (joints, wanted.link_lengths[2])):
        keep &= (length >= max(limits[0], 1e-9)) & (length <= limits[1])
    if wanted.same_branch:
        signs = []
        for rotation, shift in zip(motion.rotation, motion.shift, strict=True):
            # AB x O4B in the body's frame is linear in A, so every pose is one matrix product.
            output = rotation.conjugate() * (driven.dyads.moving * rotation + shift - driven.dyads.ground)
            coupler = driver.dyads.moving
            left = np.stack([np.ones(len(coupler)), coupler.real, coupler.imag], axis=1)
            offset = (driven.dyads.moving.conj() * output).imag
            right = np.stack([offset, -output.imag, output.real])
            signs.append(left @ right > 0)
        keep &= np.all(signs, axis=0) | ~np.any(signs, axis=0)
    return keep


def _judge(motion: Displacements, driver: _Side, driven: _Side, wanted: Requirements) -> Pairs:
    """Pairs taken entry by entry, with all that each lacks."""
    ground = driven.dyads.ground - driver.dyads.ground
    coupler = driven.dyads.moving - driver.dyads.moving
    r1, r2, r3, r4 = np.abs(ground), driver.length, np.abs(coupler), driven.length
    lacks = driver.lacks + driven.lacks

    def lack(group: str, amount: FloatArray) -> None:
        lacks[:, GROUPS.index(group)] += np.maximum(amount, 0.0)

    with np.errstate(divide="ignore", invalid="ignore"):
        output = motion.apply(driven.dyads.moving) - driven.dyads.ground[:, None]
        sine = ((coupler[:, None] * motion.rotation).conj() * output).imag / (r3 * r4)[:, None]
        assembly = np.where(np.sum(np.sign(sine), axis=1) >= 0, 1.0, -1.0)
        way, span, cycle = _ways(driver, ground, r1, r2, r3, r4, wanted.order)
    lacks[:, GROUPS.index("order")] = way.lacks[:, GROUPS.index("order")]
    over = cycle if wanted.transmission_over is TransmissionOver.CYCLE else span
    transmission = np.nan_to_num(np.arccos(np.minimum(over, 1.0)))
    if wanted.same_branch:
        lack("same_branch", (-assembly[:, None] * sine).max(axis=1, initial=-1.0) + 1e-6)
        lack("same_branch", span - 1.0)
    lack("transmission_min_deg", np.radians(wanted.transmission_min_deg) - transmission)
    lack("rotatability", _rotatability_lack(r1, r2, r3, r4, wanted))
    for length, limits in ((r1, wanted.link_lengths[0]), (r3, wanted.link_lengths[2])):
        lack("link_length", _outside(length, (max(limits[0], 1e-9), limits[1])))
    longest, shortest = np.maximum.reduce([r1, r2, r3, r4]), np.minimum.reduce([r1, r2, r3, r4])
    lack("link_ratio_max", longest / wanted.link_ratio_max - shortest)
    if wanted.ground_angle_deg is not None:
        turned = ground * np.exp(-1j * np.radians(wanted.ground_angle_deg))
        lack("ground_angle_deg", np.abs(np.angle(turned)))
    return Pairs(
        driver.dyads,
        driven.dyads,
        way.visit,
        way.theta2,
        way.direction,
        assembly,
        lacks,
        transmission,
    )


def _ways(
    driver: _Side,
    ground: ComplexArray,
    r1: FloatArray,
    r2: FloatArray,
    r3: FloatArray,
    r4: FloatArray,
    ordered: bool,
) -> tuple[_Side, FloatArray, FloatArray]:
    """Drivers with the way that each linkage lets them go, greatest |cos mu| over it and over a turn.

    Above 1 the linkage does not close. A driver that cannot turn, with all targets in one of its
    ranges, has no way around.
    """

    def cos_mu(diagonal2: FloatArray) -> FloatArray:
        return np.abs((r3**2 + r4**2 - diagonal2) / (2 * r3 * r4))

    folded, stretched, theta1 = cos_mu((r1 - r2) ** 2), cos_mu((r1 + r2) ** 2), np.angle(ground)[:, None]
    ends = driver.theta2[:, [0, -1]] - theta1
    inside = driver.theta2 - theta1
    inside = np.where((stretched > 1)[:, None], (inside + np.pi) % TURN - np.pi, inside % TURN)
    one_side = (folded <= 1) | (stretched <= 1) | (np.ptp(np.sign(inside), axis=1) == 0)
    rows = np.flatnonzero(one_side & ((folded > 1) | (stretched > 1)))
    ends[rows] = np.stack([inside[rows].min(axis=1), inside[rows].max(axis=1)], axis=1)
    way = _kept_inside(driver, rows, (inside + theta1)[rows], ordered)
    crossed = np.floor(np.sort(ends, axis=1) / np.pi)
    count = crossed[:, 1] - crossed[:, 0]
    even = (count >= 2) | ((count == 1) & (crossed[:, 1] % 2 == 0))
    odd = (count >= 2) | ((count == 1) & (crossed[:, 1] % 2 == 1))
    span = np.maximum(np.where(even, folded, 0.0), np.where(odd, stretched, 0.0))
    for end in ends.T:
        span = np.maximum(span, cos_mu((r1 - r2) ** 2 + 4 * r1 * r2 * np.sin(end / 2) ** 2))
    return way, span, np.maximum(folded, stretched)


def _kept_inside(driver: _Side, rows: IntArray, inside: FloatArray, ordered: bool) -> _Side:
    """Drivers of which some, `rows`, meet the targets at the angles `inside` of a range they cannot leave."""
    visit, theta2, lacks = driver.visit.copy(), driver.theta2.copy(), driver.lacks.copy()
    if ordered:  # out of order, the angles stay those of a driver that could turn
        step = np.diff(inside, axis=1)
        lacks[rows, GROUPS.index("order")] = np.minimum(
            (-step).max(axis=1, initial=0.0), step.max(axis=1, initial=0.0)
        )
    else:
        sequence = np.argsort(inside, axis=1)
        visit[rows] = np.take_along_axis(visit[rows], sequence, axis=1)
        theta2[rows] = np.take_along_axis(inside, sequence, axis=1)
    return _Side(driver.dyads, lacks, driver.length, visit, theta2, driver.direction)


def _rotatability_lack(
    r1: FloatArray, r2: FloatArray, r3: FloatArray, r4: FloatArray, wanted: Requirements
) -> FloatArray:
    if wanted.rotatability is Rotatability.ANY:
        return np.zeros(len(r1))
    margin = wanted.rotatability_margin * (r1 + r2 + r3 + r4)
    difference = {
        Rotatability.FULL_CRANK: np.abs(r1 - r2),
        Rotatability.CRANK_ROCKER: r1 - r2,
        Rotatability.DOUBLE_CRANK: r2 - r1,
    }[wanted.rotatability]
    lack: FloatArray = margin - np.minimum(r3 + r4 - r1 - r2, difference - np.abs(r3 - r4))
    return lack


def _outside(values: FloatArray, limits: Limits | None) -> FloatArray:
    low, high = limits if limits is not None else (-np.inf, np.inf)
    missed: FloatArray = np.maximum(np.maximum(low - values, values - high), 0.0)
    return missed


def _met(lacks: FloatArray) -> BoolArray:
    met: BoolArray = lacks.max(axis=1, initial=0.0) <= 0
    return met
