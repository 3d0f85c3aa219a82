"""All pairs of dyads judged at once, either one driving; in sizes, points complex, poses as columns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems import Requirements
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.quantities.driver_motion import follow, meeting_order
from grashof.synth.quantities.kinds import FOUR_BAR
from grashof.synth.quantities.screening import (
    GROUPS,
    Configurations,
    Screened,
    dyad_violations,
    judge,
    keep_out_violation,
    met,
)
from grashof.synth.theory.burmester import Displacements, Dyads


@dataclass(frozen=True, slots=True)
class _Side:
    """Dyads by themselves, as drivers or as driven ones: places, violations, driver angles."""

    dyads: Dyads
    places: ComplexArray
    violations: FloatArray
    visit: IntArray
    theta2: FloatArray
    direction: FloatArray

    def __getitem__(self, index: IntArray | BoolArray | slice) -> _Side:
        return _Side(*(getattr(self, name)[index] for name in self.__slots__))

    def __len__(self) -> int:
        return len(self.dyads)


def screen(motion: Displacements, body: complex, dyads: Dyads, wanted: Requirements, pairs: int) -> Screened:
    """All feasible pairs of the given dyads; `body` is the guided point at the first pose."""
    driver, driven = _sides(motion, body, dyads, wanted)
    driver, driven = driver[met(driver.violations)], driven[met(driven.violations)]
    # where there are more pairs, dyads are thinned
    stride = max(1, int(np.ceil(np.sqrt(len(driver) * len(driven) / pairs))))
    driver, driven = driver[::stride], driven[::stride]
    if not len(driver) or not len(driven):
        return _judged(motion, body, driver[:0], driven[:0], wanted)
    first, second = np.nonzero(_promising(motion, driver, driven, wanted))
    judged = _judged(motion, body, driver[first], driven[second], wanted)
    return judged[judged.feasible]


def near_misses(
    motion: Displacements, body: complex, dyads: Dyads, wanted: Requirements, pairs: int
) -> Screened:
    """All pairs of (thinned) dyads and the violations of each, feasible or not."""
    driver, driven = _sides(motion, body, dyads, wanted)
    stride = max(1, int(np.ceil(len(driver) / np.sqrt(pairs))))
    driver, driven = driver[::stride], driven[::stride]
    apart = np.abs(driver.dyads.moving[:, None] - driven.dyads.moving) > 1e-6
    apart &= np.abs(driver.dyads.ground[:, None] - driven.dyads.ground) > 1e-6
    long = np.abs(driver.dyads.moving - driver.dyads.ground) > 1e-6
    first, second = np.nonzero(apart & long[:, None] & long)
    return _judged(motion, body, driver[first], driven[second], wanted)


def judged_pairs(
    motion: Displacements, body: complex, drivers: Dyads, driven: Dyads, wanted: Requirements
) -> Screened:
    """Given pairs, entry by entry, and the violations of each."""
    driver, _ = _sides(motion, body, drivers, wanted)
    _, other = _sides(motion, body, driven, wanted)
    return _judged(motion, body, driver, other, wanted)


def _sides(motion: Displacements, body: complex, dyads: Dyads, wanted: Requirements) -> tuple[_Side, _Side]:
    places = motion.apply(dyads.moving)
    visit, theta2, direction, disorder = _visiting_order(
        np.angle(places - dyads.ground[:, None]), wanted.order
    )
    p = np.full(len(dyads), body)
    sides = []
    for pivot in ("o2", "o4"):
        violations = dyad_violations(pivot, dyads.ground, places, p, wanted, FOUR_BAR)
        if pivot == "o2":
            violations[:, GROUPS.index("order")] = disorder
            violations[:, GROUPS.index("keep_out")] += keep_out_violation("p", motion.apply(p[:1]), wanted)
        sides.append(_Side(dyads, places, violations, visit, theta2, direction))
    return sides[0], sides[1]


def _visiting_order(angle: FloatArray, ordered: bool) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    """Order of the poses along the driver's motion, angles, its sense, and the departure from order."""
    count = angle.shape[1]
    if not ordered:
        return *meeting_order(angle), np.zeros(len(angle))
    visit = np.broadcast_to(np.arange(count), angle.shape)
    step = (np.diff(angle, axis=1)) % TURN
    forward = step.sum(axis=1)
    backward = TURN * (count - 1) - forward
    direction = np.where(forward <= backward, 1.0, -1.0)
    gone = np.where(direction > 0, forward, backward)
    back = np.where(direction[:, None] > 0, TURN - step, step)
    disorder = np.where(gone < TURN, 0.0, back.min(axis=1))
    return visit, follow(angle, direction), direction, disorder


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


def _judged(
    motion: Displacements, body: complex, driver: _Side, driven: _Side, wanted: Requirements
) -> Screened:
    """Pairs taken entry by entry."""
    found = Configurations(
        driver.dyads.ground,
        driven.dyads.ground,
        driver.places,
        driven.places,
        driver.visit,
        driver.theta2,
        driver.direction,
        FOUR_BAR,
    )
    p, exact, turned = (np.full(len(driver), each) for each in (body, 0.0, motion.first_turn))
    return judge(found, p, exact, driver.violations + driven.violations, wanted, first_turn=turned)
