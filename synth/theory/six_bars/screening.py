"""Six-bars that meet five poses in one motion, in order and within limits; how well they transmit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from grashof.problems import Box, Requirements, Rotatability, TransmissionOver
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray
from grashof.synth.loop.chain import chained
from grashof.synth.loop.dyad import Bars, Sizes
from grashof.synth.loop.vector import Vector
from grashof.synth.theory.six_bars.constructions import FourBars, SixBars

SAMPLES = (25, 121)  # driver angles over a motion: of a first look, and of a second one at what it leaves
LEAST = 1e-3  # sine of a transmission angle that counts as a dead position
SPARE = np.radians(0.02)  # rad beyond the required angle, for peaks between samples
SHORTEST = 1e-9  # sizes, of a link


@dataclass(frozen=True, slots=True)
class Screen:
    """Requirements on six-bars, in the frame of their poses."""

    wanted: Requirements

    def loops(self, found: FourBars) -> BoolArray:
        """Whether first loops, driven at O2, meet them, (n,)."""
        wanted, lengths = self.wanted, found.lengths
        good = same_side(found.driver.apply(found.a), found.o4[:, None], found.output.apply(found.b))
        good &= self._driven(driver_turns(found)[:, -1]) & self._turning(*lengths) & self._sized(lengths)
        return good & _inside(found.o2, wanted.o2) & _inside(found.o4, wanted.o4)

    def second_loops(self, found: SixBars, point: complex) -> BoolArray:
        """Whether second loops meet them at the poses, (n,); P lies at `point` at the first."""
        joints = zip(found.hosts, (found.c, found.d), strict=True)
        c, d = (found.host(number).apply(joint) for number, joint in joints)
        good = same_side(c, d, found.body.apply(found.e)) & self._sized(found.lengths)
        if self.wanted.coupler_arms is not None:
            for joint in (found.c if found.carries == 5 else found.d, found.e):
                good &= _within(np.abs(joint - point), self.wanted.coupler_arms)
        return good

    def transmission(self, found: SixBars) -> FloatArray:
        """Sines of the least transmission angles over the motion for which they are required, (n,).

        NaN where they are less than required, and where a loop opens or passes a dead position: between the
        first pose and the last, or in a full turn where one is required.
        """
        wanted = self.wanted
        turning = wanted.rotatability is not Rotatability.ANY
        over_turn = wanted.transmission_over is TransmissionOver.CYCLE
        over_turn = over_turn and (turning or wanted.transmission_min_deg > 0)  # zero where travel ends
        required = max(LEAST, float(np.sin(np.radians(wanted.transmission_min_deg) + SPARE)))
        sines, left = np.full(len(found), np.nan), np.arange(len(found))
        for count in SAMPLES:
            some = found[left]
            least = least_sines(some, driver_turns(some.loop)[:, -1:] * np.linspace(0, 1, count))
            if turning or over_turn:
                around = np.broadcast_to(np.linspace(0, TURN, 2 * count), (len(some), 2 * count))
                round_turn = least_sines(some, around)
                least = round_turn if over_turn else np.where(round_turn > LEAST, least, np.nan)
            good = least > required
            left, least = left[good], least[good]
        sines[left] = least
        return sines

    def _driven(self, rotation: FloatArray) -> BoolArray:
        """Whether drivers turn in the sense and as far as required; NaN for no order."""
        low, high = self.wanted.ranges("driver_sense")[""]
        good = _within(np.sign(rotation), (low, high))
        if self.wanted.driver_rotation_deg is not None:
            good &= _within(np.degrees(np.abs(rotation)), self.wanted.driver_rotation_deg)
        return good

    def _turning(self, r1: FloatArray, r2: FloatArray, r3: FloatArray, r4: FloatArray) -> BoolArray:
        """Whether first loops turn as required."""
        wanted = self.wanted
        if wanted.rotatability is Rotatability.ANY:
            return np.ones(r1.shape, np.bool_)
        margins = Bars().margins(Sizes(r1, r2, r3, r4))
        good: BoolArray = np.asarray(np.min(margins, axis=0) >= wanted.rotatability_margin)
        if wanted.rotatability is Rotatability.CRANK_ROCKER:
            good &= r2 < r1
        elif wanted.rotatability is Rotatability.DOUBLE_CRANK:
            good &= r2 > r1
        return good

    def _sized(self, lengths: Sequence[FloatArray]) -> BoolArray:
        """Whether lengths r1, r2, ... are within their limits, and their ratio."""
        wanted = self.wanted
        shortest, longest = np.min(lengths, axis=0), np.max(lengths, axis=0)
        good: BoolArray = (shortest > SHORTEST) & (longest <= wanted.link_ratio_max * shortest)
        for number, length in enumerate(lengths, 1):
            limits = getattr(wanted, f"r{number}") or wanted.link_length
            if limits is not None:
                good &= _within(length, limits)
        return good


def driver_turns(found: FourBars) -> FloatArray:
    """Rotations of drivers from the first pose to every pose, (n, 5), rad.

    In the sense in which they meet the poses in order within a turn; NaN where neither does.
    """
    rotation = found.driver.rotation
    step = np.angle(rotation[:, 1:] * rotation[:, :-1].conj()) % TURN
    forward = step.sum(axis=1)
    backward = step.shape[1] * TURN - forward
    steps = np.where((forward < backward)[:, None], step, step - TURN)
    steps[~(np.minimum(forward, backward) < TURN)] = np.nan
    turned: FloatArray = np.concatenate([np.zeros((len(steps), 1)), steps.cumsum(axis=1)], axis=1)
    return turned


def same_side(start: ComplexArray, end: ComplexArray, joint: ComplexArray) -> BoolArray:
    """Whether all of joints (n, 5) lie on one side of the lines from `start` to `end`, (n,)."""
    side = ((end - start).conj() * (joint - start)).imag
    return np.asarray((side > 0).all(axis=1) | (side < 0).all(axis=1))


def assemblies(found: SixBars) -> tuple[FloatArray, FloatArray]:
    """Of both loops at the first pose, (n,)."""
    loop = found.loop
    first = ((loop.o4 - loop.a).conj() * (loop.b - loop.a)).imag
    second = ((found.d - found.c).conj() * (found.e - found.c)).imag
    return np.sign(first), np.sign(second)


def least_sines(found: SixBars, turned: FloatArray) -> FloatArray:
    """Sines of the least transmission angles of both loops, (n,), as drivers turn from the first pose.

    By rotations (n, K), rad, in order, and by parabolas between them. NaN where a loop is open.
    """
    crank = found.loop.a - found.loop.o2
    driver = (crank / np.abs(crank))[:, None] * np.exp(1j * turned)
    sides = [side[:, None] for side in assemblies(found)]
    frames, _ = chained(found.row, _dimensions(found), _vector(driver), sides)
    squares = [frames[first].along.cross(frames[second].along) ** 2 for first, second in ((3, 4), (5, 6))]
    lowest = np.minimum(*map(_lowest, squares))
    sines: FloatArray = np.sqrt(np.where(lowest > 0, lowest, np.nan))
    return sines


def _dimensions(found: SixBars) -> dict[str, Any]:
    """Parameters, (n, 1), with O2 in the origin."""
    loop, (c, d) = found.loop, found.arms
    d = d - loop.o2 if found.hosts[1] == 1 else d
    places = {"o4": loop.o4 - loop.o2, "c": c, "d": d}
    lengths = {f"r{number}": length[:, None] for number, length in enumerate(found.lengths, 1)}
    return lengths | {name: _vector(place[:, None]) for name, place in places.items()}


def _vector(places: ComplexArray) -> Vector:
    return Vector(places.real, places.imag)


def _lowest(values: FloatArray) -> FloatArray:
    """The least of values (n, K), or of the parabola through it and those beside it; NaN where one is."""
    at = np.clip(np.argmin(values, axis=1), 1, values.shape[1] - 2)[:, None]
    before, here, after = (np.take_along_axis(values, at + step, axis=1)[:, 0] for step in (-1, 0, 1))
    bend, slope = before - 2 * here + after, (after - before) / 2
    inside = bend > np.abs(slope)
    lowest: FloatArray = np.where(
        inside, here - slope**2 / (2 * np.where(inside, bend, 1.0)), values.min(axis=1)
    )
    return lowest


def _within(values: FloatArray, limits: tuple[float, float]) -> BoolArray:
    inside: BoolArray = (limits[0] <= values) & (values <= limits[1])
    return inside


def _inside(places: ComplexArray, box: Box | None) -> BoolArray:
    """Whether places (n,) lie in a box."""
    if box is None:
        return np.ones(places.shape, np.bool_)
    return _within(places.real, box.x) & _within(places.imag, box.y)
