"""Conditions of one dyad: which pieces of the curve may hold a driver, or a driven dyad."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from grashof.problems import Box
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray, IntArray, Limits
from grashof.synth.proof.curve.asked import SLACK, Asked, Dyad
from grashof.synth.proof.curve.centres import Centres
from grashof.synth.proof.curve.curve import Curve
from grashof.synth.proof.curve.pieces import WIDER, Tubes


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
    """What pieces may be, shape (n,).

    Parameters
    ----------
    driver, driven : ndarray of bool
    sense : ndarray of int
        In which sense a driver meets the poses in order; 0 where that is open.
    """

    driver: BoolArray
    driven: BoolArray
    sense: IntArray


def possible_arms(asked: Asked, tubes: Tubes) -> BoolArray:
    """Which tubes may hold moving pivots at an allowed distance from P, and within circles not too large.

    This needs no centres: it disposes of the places where these run off to infinity.
    """
    curve = asked.curve
    reach = np.abs(tubes.along) + tubes.stray
    distance = np.abs(tubes.middle)
    arms = Range(distance - reach, distance + reach)
    keep = arms.within(asked.driver.arm) & np.isfinite(distance)
    shortest = min(asked.driver.length[0], asked.driven.length[0])
    chords = {
        (i, j): (
            (curve.rotation[j] - curve.rotation[i]) * tubes.middle + curve.shift[j] - curve.shift[i],
            abs(curve.rotation[j] - curve.rotation[i]) * reach + WIDER * (1.0 + distance),
        )
        for i, j in combinations(range(len(curve.shift)), 2)
    }
    for i, j, k in combinations(range(len(curve.shift)), 3):
        (u, du), (v, dv), (w, dw) = chords[i, j], chords[i, k], chords[j, k]
        longs = [(np.abs(x), dx) for x, dx in ((u, du), (v, dv), (w, dw))]
        least, most = np.ones(len(tubes)), np.ones(len(tubes))
        for size, spread in longs:
            least, most = least * np.maximum(size - spread, 0.0), most * (size + spread)
        cross = np.abs((u.conj() * v).imag)
        spread = longs[0][0] * dv + longs[1][0] * du + du * dv
        keep &= ~(least > 2 * asked.longest * (cross + spread) * (1 + SLACK))
        keep &= ~(most < 2 * shortest * (cross - spread) * (1 - SLACK))
    return keep


def roles_of(asked: Asked, tubes: Tubes, centres: Centres) -> Roles:
    """What pieces may be."""
    sense, ordered = _senses(asked.curve, tubes)
    driver = _allowed(asked, asked.driver, tubes, centres)
    driven = _allowed(asked, asked.driven, tubes, centres)
    if asked.ordered:
        driver &= ordered
        driver &= (sense == 0) | (asked.sense == 0) | (sense == asked.sense)
        driver &= _rotations(asked, tubes, centres, sense)
    if asked.theta2_start is not None:
        crank = (tubes.middle - centres.middle) * np.exp(-1j * asked.theta2_start)
        along = (tubes.along - centres.along) * np.exp(-1j * asked.theta2_start)
        off = tubes.stray + centres.rest + SLACK * (1.0 + np.abs(crank))
        driver &= np.abs(crank.imag) <= np.abs(along.imag) + off
        driver &= crank.real + np.abs(along.real) + off >= 0
    return Roles(driver, driven, sense)


def _allowed(asked: Asked, dyad: Dyad, tubes: Tubes, centres: Centres) -> BoolArray:
    """Which pieces may meet the limits of a dyad."""
    curve = asked.curve
    keep = lengths_of(tubes, centres).within(dyad.length)
    keep &= _inside(centres.middle, centres.along, centres.rest, dyad.ground)
    if dyad.keep_out:
        keep &= ~_within_areas(centres, dyad.keep_out)
    for rotation, shift in zip(curve.rotation, curve.shift, strict=True):
        keep &= _inside(rotation * tubes.middle + shift, rotation * tubes.along, tubes.stray, dyad.moving)
    turn = np.exp(-1j * asked.first_turn)
    keep &= _inside(turn * tubes.middle, turn * tubes.along, tubes.stray, dyad.on_body)
    return keep


def lengths_of(tubes: Tubes, centres: Centres) -> Range:
    """Distances from z to c."""
    middle, along = tubes.middle - centres.middle, tubes.along - centres.along
    rest = tubes.stray + centres.rest + WIDER * (1.0 + np.abs(tubes.middle) + np.abs(centres.middle))
    square = np.abs(along) ** 2
    nearest = np.clip(-(along.conj() * middle).real / np.where(square > 0, square, 1.0), -1.0, 1.0)
    least = np.abs(middle + nearest * along) - rest
    most = np.maximum(np.abs(middle + along), np.abs(middle - along)) + rest
    return Range(np.maximum(least, 0.0), most)


def _inside(middle: ComplexArray, along: ComplexArray, stray: FloatArray, box: Box) -> BoolArray:
    keep = np.ones(len(middle), dtype=bool)
    for part, step, side in ((middle.real, along.real, box.x), (middle.imag, along.imag, box.y)):
        if np.isfinite(side).any():
            reach = np.abs(step) + stray + WIDER * (1.0 + np.abs(part))
            keep &= Range(part - reach, part + reach).within(side)
    return keep


def _within_areas(centres: Centres, areas: tuple[FloatArray, ...]) -> BoolArray:
    """Which pieces surely have their ground pivot inside areas, by more than the slack of the judge."""
    import shapely  # takes a while to import, and few problems have areas

    from grashof.problems.values.areas import solid

    area = solid(areas)
    ends = np.stack([centres.middle - centres.along, centres.middle + centres.along], axis=1)
    lines = shapely.linestrings(np.stack([ends.real, ends.imag], axis=-1))
    far = shapely.distance(lines, shapely.boundary(area)) > centres.rest + SLACK
    inside: BoolArray = far & shapely.contains_xy(area, centres.middle.real, centres.middle.imag)
    return inside


def _senses(curve: Curve, tubes: Tubes) -> tuple[IntArray, BoolArray]:
    """In which sense pieces meet the poses, and whether that may be in order.

    Four points of a circle follow each other where the triangles 123 and 134 have one sense.
    """
    reach = np.abs(tubes.along) + tubes.stray
    chord = [(turn - 1) * tubes.middle + move for turn, move in zip(curve.rotation, curve.shift, strict=True)]
    spread = [abs(turn - 1) * reach + WIDER * (1.0 + np.abs(tubes.middle)) for turn in curve.rotation]
    signs = []
    for i, j in ((1, 2), (2, 3)):
        area = (chord[i].conj() * chord[j]).imag
        off = np.abs(chord[i]) * spread[j] + np.abs(chord[j]) * spread[i] + spread[i] * spread[j]
        signs.append(np.where(np.abs(area) > off, np.sign(area), 0.0).astype(np.int64))
    first, second = signs
    sense: IntArray = np.where(first != 0, first, second)
    return sense, first * second >= 0


def _rotations(asked: Asked, tubes: Tubes, centres: Centres, sense: IntArray) -> BoolArray:
    """Which pieces may turn from the first pose to the last by an allowed angle."""
    if asked.rotation[0] <= 0 and asked.rotation[1] >= TURN:
        return np.ones(len(tubes), dtype=bool)
    curve = asked.curve
    first = tubes.middle - centres.middle
    last = curve.rotation[-1] * tubes.middle + curve.shift[-1] - centres.middle
    reach = np.abs(tubes.along) + tubes.stray + np.abs(centres.along) + centres.rest
    with np.errstate(divide="ignore", invalid="ignore"):
        off = sum(np.arcsin(np.minimum(reach / np.abs(arm), 1.0)) for arm in (first, last)) + SLACK
        turned = (sense * np.angle(last * first.conj())) % TURN
    keep = np.zeros(len(tubes), dtype=bool)
    for turns in (-TURN, 0.0, TURN):
        keep |= Range(turned + turns - off, turned + turns + off).within(asked.rotation)
    keep |= (sense == 0) | ~(reach < np.minimum(np.abs(first), np.abs(last)))
    return keep
