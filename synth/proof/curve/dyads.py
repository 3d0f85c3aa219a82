"""Conditions of one dyad: which pieces of its curve, or its plane, may hold a driver, or a driven dyad."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, pairwise, product

import numpy as np

from grashof.problems import Box
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray, IntArray, Limits
from grashof.synth.proof.curve.curve import Curve
from grashof.synth.proof.curve.pieces import WIDER
from grashof.synth.proof.curve.required import SLACK, Dyad, Required
from grashof.synth.proof.forms.forms import Span
from grashof.synth.theory.burmester import Displacements


@dataclass(frozen=True, slots=True)
class Range:
    """Real numbers between bounds, shape (n,)."""

    low: FloatArray
    high: FloatArray

    def within(self, limits: Limits) -> BoolArray:
        """Whether some of them may be within limits."""
        some: BoolArray = (self.high >= limits[0]) & (self.low <= limits[1])
        return some


@dataclass(frozen=True, slots=True)
class Roles:
    """Roles that pieces may have, shape (n,)."""

    driver: BoolArray
    driven: BoolArray
    sense: IntArray  # in which a driver meets the poses in order; 0 where that is open


def possible_arms(required: Required, z: Span) -> BoolArray:
    """Which pieces may hold moving pivots at an allowed distance from P, and within circles not too large.

    This needs no centres: it disposes of the places where these run off to infinity.
    """
    distance = np.abs(z.middle)
    arms = Range(distance - z.reach, distance + z.reach)
    shortest = min(required.driver.length[0], required.driven.length[0])
    round_ = possible_radii(required.curve, z, (shortest, required.longest))
    return arms.within(required.driver.arm) & np.isfinite(distance) & round_


def possible_radii(motion: Curve | Displacements, points: Span, radii: Limits) -> BoolArray:
    """Which pieces may hold points whose circles through three places have allowed radii."""
    reach, distance = points.reach, np.abs(points.middle)
    keep = np.ones(len(points), dtype=bool)
    turn, move = motion.rotation, motion.shift
    chords = {
        (i, j): (
            (turn[j] - turn[i]) * points.middle + move[j] - move[i],
            abs(turn[j] - turn[i]) * reach + WIDER * (1.0 + distance),
        )
        for i, j in combinations(range(len(move)), 2)
    }
    for i, j, k in combinations(range(len(move)), 3):
        (u, du), (v, dv), (w, dw) = chords[i, j], chords[i, k], chords[j, k]
        longs = [(np.abs(x), dx) for x, dx in ((u, du), (v, dv), (w, dw))]
        least, most = np.ones(len(points)), np.ones(len(points))
        for size, spread in longs:
            least, most = least * np.maximum(size - spread, 0.0), most * (size + spread)
        cross = np.abs((u.conj() * v).imag)
        spread = longs[0][0] * dv + longs[1][0] * du + du * dv
        keep &= ~(least > 2 * radii[1] * (cross + spread) * (1 + SLACK))
        keep &= ~(most < 2 * radii[0] * (cross - spread) * (1 - SLACK))
    return keep


def same_lengths(motion: Curve | Displacements, z: Span, c: Span) -> BoolArray:
    """Where the distance from z to c may be the same at all poses."""
    poses = zip(motion.rotation, motion.shift, strict=True)
    ranges = [lengths_of(z.placed(complex(turn), complex(move)), c) for turn, move in poses]
    low, high = np.max([each.low for each in ranges], axis=0), np.min([each.high for each in ranges], axis=0)
    some: BoolArray = low <= high
    return some


def roles_of(required: Required, z: Span, c: Span) -> Roles:
    """Roles that pieces with these moving and ground pivots may have."""
    sense, ordered = _senses(required.curve, z)
    driver = allowed(required, required.driver, z, c)
    driven = allowed(required, required.driven, z, c)
    if required.ordered:
        driver &= ordered
        driver &= (sense == 0) | (required.sense == 0) | (sense == required.sense)
        driver &= _rotations(required, z, c, sense)
    if required.theta2_start is not None:
        crank = (z - c).placed(complex(np.exp(-1j * required.theta2_start)))
        off = crank.rest + SLACK * (1.0 + np.abs(crank.middle))
        driver &= np.abs(crank.middle.imag) <= np.abs(crank.steps.imag).sum(axis=0) + off
        driver &= crank.middle.real + np.abs(crank.steps.real).sum(axis=0) + off >= 0
    return Roles(driver, driven, sense)


def allowed(required: Required, dyad: Dyad, z: Span, c: Span) -> BoolArray:
    """Which pieces may meet the limits of a dyad."""
    curve = required.curve
    keep = lengths_of(z, c).within(dyad.length)
    keep &= _inside(c, dyad.ground)
    if dyad.keep_out:
        keep &= ~_within_areas(c, dyad.keep_out)
    for rotation, shift in zip(curve.rotation, curve.shift, strict=True):
        keep &= _inside(z.placed(complex(rotation), complex(shift)), dyad.moving)
    keep &= _inside(z.placed(complex(np.exp(-1j * required.first_turn))), dyad.on_body)
    return keep


def lengths_of(z: Span, c: Span) -> Range:
    """Distances from z to c."""
    length = (z - c).norm
    rest = WIDER * (1.0 + np.abs(z.middle) + np.abs(c.middle))
    return Range(np.maximum(length.inf - rest, 0.0), length.sup + rest)


def _inside(points: Span, box: Box) -> BoolArray:
    keep = np.ones(len(points), dtype=bool)
    middle, steps = points.middle, points.steps
    for part, step, side in ((middle.real, steps.real, box.x), (middle.imag, steps.imag, box.y)):
        if np.isfinite(side).any():
            reach = np.abs(step).sum(axis=0) + points.rest + WIDER * (1.0 + np.abs(part))
            keep &= Range(part - reach, part + reach).within(side)
    return keep


def _within_areas(c: Span, areas: tuple[FloatArray, ...]) -> BoolArray:
    """Which pieces surely have their ground pivot inside areas, by more than the slack of the judge."""
    import shapely  # takes a while to import, and few problems have areas

    from grashof.problems.values.areas import solid

    area = solid(areas)
    signs = np.array(list(product((-1.0, 1.0), repeat=len(c.steps))))
    corners = (c.middle + signs @ c.steps).T
    hulls = shapely.convex_hull(shapely.multipoints(np.stack([corners.real, corners.imag], axis=-1)))
    far = shapely.distance(hulls, shapely.boundary(area)) > c.rest + SLACK
    inside: BoolArray = far & shapely.contains_xy(area, c.middle.real, c.middle.imag)
    return inside


def _senses(curve: Curve, z: Span) -> tuple[IntArray, BoolArray]:
    """The sense in which pieces meet the poses, and whether that may be in order.

    Four points of a circle follow each other where the triangles 123 and 134 have one sense, three always.
    """
    reach = z.reach
    chord = [(turn - 1) * z.middle + move for turn, move in zip(curve.rotation, curve.shift, strict=True)]
    spread = [abs(turn - 1) * reach + WIDER * (1.0 + np.abs(z.middle)) for turn in curve.rotation]
    signs = []
    for i, j in pairwise(range(1, len(chord))):
        area = (chord[i].conj() * chord[j]).imag
        off = np.abs(chord[i]) * spread[j] + np.abs(chord[j]) * spread[i] + spread[i] * spread[j]
        signs.append(np.where(np.abs(area) > off, np.sign(area), 0.0).astype(np.int64))
    first, last = signs[0], signs[-1]
    sense: IntArray = np.where(first != 0, first, last)
    return sense, first * last >= 0


def _rotations(required: Required, z: Span, c: Span, sense: IntArray) -> BoolArray:
    """Which pieces may turn from the first pose to the last by an allowed angle."""
    if required.rotation[0] <= 0 and required.rotation[1] >= TURN:
        return np.ones(len(z), dtype=bool)
    curve = required.curve
    first = z.middle - c.middle
    last = curve.rotation[-1] * z.middle + curve.shift[-1] - c.middle
    reach = z.reach + c.reach
    with np.errstate(divide="ignore", invalid="ignore"):
        off = sum(np.arcsin(np.minimum(reach / np.abs(arm), 1.0)) for arm in (first, last)) + SLACK
        turned = (sense * np.angle(last * first.conj())) % TURN
    keep = np.zeros(len(z), dtype=bool)
    for turns in (-TURN, 0.0, TURN):
        keep |= Range(turned + turns - off, turned + turns + off).within(required.rotation)
    keep |= (sense == 0) | ~(reach < np.minimum(np.abs(first), np.abs(last)))
    return keep
