"""A linkage at samples of its travel, and its effort there with parts of given sizes at given places."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from grashof.analysis.effort.case import EffortCase
from grashof.analysis.effort.parts import place_on
from grashof.problems import Linkage, Region
from grashof.problems.values.arrays import ComplexArray, FloatArray, IntArray, turned_from
from grashof.problems.values.dynamics.struts import BODY, EffortPlace, PartSpec
from grashof.synth.quantities.regions import nearest

_ABOUT_STROKES = 49  # samples of the travel at which strokes are checked
INSET = 1e-5  # share of a stroke by which it is tightened, so that the judge finds it kept
_SAMPLES, _LEAST = 41, 7  # samples of a demand over the entire travel, and least number over a part of it


class Frame(NamedTuple):
    """The frame of a link at I samples: origin and unit vector of u, and their velocities."""

    origin: ComplexArray
    axis: ComplexArray
    drift: ComplexArray
    turn: FloatArray


class Area(NamedTuple):
    """The places of an end in the frame of a link: corner + s along + t across, s and t in [0, 1].

    Those in a polygon are in a region of the plane of s and t.
    """

    link: int
    corner: complex
    along: complex
    across: complex
    region: Region | None = None

    @classmethod
    def of(cls, linkage: Linkage, place: EffortPlace) -> Area:
        """The area of a place; that of the guided body is turned and moved onto the link that carries it."""
        corner, along, across = place.spanned
        region = None
        if isinstance(place.at, Region) and place.at.inside is not None:
            shares = (place.at.corners - [corner.real, corner.imag]) / [along.real, across.imag]
            region = Region(inside=shares.tolist())
        if place.link != BODY:
            return cls(int(place.link), corner, along, across, region)
        turned = np.exp(1j * float(linkage.body_angle))
        corner = complex(*linkage.coupler_point) + turned * corner
        return cls(linkage.mechanism.carries, corner, turned * along, turned * across, region)


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A part: its sizes as arrays (R,), and its areas, or the angle (I,) of the joint of a torsion spring."""

    spec: PartSpec
    warmth: FloatArray  # (T,)
    force: FloatArray  # (R,): of all side by side, at the greatest length; of a torsion spring for a degree
    slope: FloatArray  # (R,): increase of the force for a unit of length less
    longest: FloatArray
    shortest: FloatArray
    friction: FloatArray
    ends: tuple[Area, ...] = ()
    angle: FloatArray | None = None  # deg, from the middle of the range of free angles
    turn: FloatArray | None = None

    @property
    def unknowns(self) -> int:
        """The number of unknowns: two for each end, or the free angle."""
        return 2 * len(self.ends) or 1


class Found(NamedTuple):
    """Excess (K, M) of candidates over limits of the effort, N; margins (K, P, 2, S) of strokes, shares."""

    excess: FloatArray
    margins: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Aim:
    """Limits of the effort at I samples, N, and its relation to the power of parts."""

    frames: dict[int, Frame]
    parts: tuple[Part, ...]
    without: FloatArray  # (I,): effort in the sense in which it is limited
    per: FloatArray  # (I,): effort for a unit of power, with that sense
    least: FloatArray
    most: FloatArray
    friction: FloatArray  # (I,): of the joints
    times: FloatArray  # (I,): multiple of the friction that is added to limits
    strokes: int  # number of the first samples, spread over the travel for strokes
    scale: float  # N

    @classmethod
    def of(cls, case: EffortCase) -> Aim:
        """The aim of a linkage over its travel; its parts need not be placed."""
        bare = EffortCase(
            case.linkage, replace(case.dynamics, effort=replace(case.spec, parts=())), case.metre, case.travel
        )
        places, limits = _samples(case)
        state = bare.at(places)
        virtual, rest, sense = bare.motion(places)
        link, point = place_on(case.linkage, case.spec.on)
        hand = _complex(virtual.point(link, point).velocity) * sense
        if isinstance(case.spec.direction, str):
            along = np.abs(hand)
        else:
            towards = complex(*case.spec.direction)
            along = np.real(hand * np.conj(towards / abs(towards)))
        least, most, times, opening = limits
        counted = np.where(opening, state.sense, 1.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            per = np.where(along != 0, counted / along, 0.0)
        ends = {place.link for part in case.spec.parts for place in part.places}
        links = {case.linkage.mechanism.carries if end == BODY else int(end) for end in ends}
        frames = {}
        for each in links:
            origin = virtual.point(each, (0.0, 0.0))
            axis = np.exp(1j * rest.frame_angle(each)) if each > 1 else np.ones(len(places), dtype=complex)
            turn = sense * virtual.angular(each).omega if each > 1 else np.zeros(len(places))
            drift = np.broadcast_to(_complex(origin.velocity) * sense, axis.shape)
            frames[each] = Frame(np.broadcast_to(_complex(origin.position), axis.shape), axis, drift, turn)
        known = np.isfinite(state.without)
        without = np.where(known, counted * state.without, 0.0)
        sizes = np.abs(np.concatenate([without, least, most]))
        scale = float(sizes[np.isfinite(sizes)].max(initial=0.0)) or 1.0
        parts = tuple(_part(part, bare, places) for part in case.spec.parts)
        return cls(frames, parts, without, per, least, most, state.friction, times, _ABOUT_STROKES, scale)

    @property
    def unknowns(self) -> int:
        """The number of unknowns of all parts, each from 0 to 1."""
        return sum(part.unknowns for part in self.parts)

    @property
    def polygons(self) -> list[tuple[int, Region]]:
        """Polygons in which ends lie, each with the number of the first of its two unknowns."""
        first, found = 0, []
        for part in self.parts:
            regions = [(first + 2 * end, area.region) for end, area in enumerate(part.ends)]
            found += [(at, region) for at, region in regions if region is not None]
            first += part.unknowns
        return found

    def inside(self, x: FloatArray) -> FloatArray:
        """Unknowns (..., n) with the ends outside their polygons moved to the nearest places in them."""
        found = x.copy()
        for first, region in self.polygons:
            place = nearest(region, x[..., first] + 1j * x[..., first + 1])
            found[..., first], found[..., first + 1] = place.real, place.imag
        return found

    def thinned(self, step: int) -> Aim:
        """The same at every `step`-th sample."""
        rows = slice(None, None, step)
        frames = {
            link: Frame(each.origin[rows], each.axis[rows], each.drift[rows], each.turn[rows])
            for link, each in self.frames.items()
        }
        parts = tuple(
            replace(
                part,
                angle=None if part.angle is None else part.angle[rows],
                turn=None if part.turn is None else part.turn[rows],
            )
            for part in self.parts
        )
        arrays = {
            name: getattr(self, name)[rows]
            for name in ("without", "per", "least", "most", "friction", "times")
        }
        strokes = len(range(0, self.strokes, step))
        return replace(self, frames=frames, parts=parts, strokes=strokes, **arrays)

    def lengths(self, part: int, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Lengths of a part and their rates, (K, I), for unknowns (K, n); of torsion springs turns, deg."""
        one = self.parts[part]
        first = sum(each.unknowns for each in self.parts[:part])
        if one.angle is not None and one.turn is not None:
            low, high = one.spec.free_angle_deg or (0.0, 0.0)
            free = (high - low) * (x[:, first, None] - 0.5)
            return turned_from(one.angle, free, 360.0), np.broadcast_to(one.turn, (len(x), len(one.turn)))
        out: Any = 0.0j
        speed: Any = 0.0j
        for end, (area, sign) in enumerate(zip(one.ends, (-1, 1), strict=True)):
            s, t = (x[:, first + 2 * end + axis, None] for axis in (0, 1))
            frame = self.frames[area.link]
            arm = (area.corner + s * area.along + t * area.across) * frame.axis
            out = out + sign * (frame.origin + arm)
            speed = speed + sign * (frame.drift + 1j * frame.turn * arm)
        length = np.abs(out)
        rate = np.real(np.conj(out) * speed) / np.maximum(length, 1e-300)
        return length, rate

    def at(self, x: FloatArray, rows: IntArray) -> Found:
        """Excess and margins of candidates: unknowns (K, n) and sizes (K, P) by their rows."""
        known = [self.lengths(part, x) for part in range(len(self.parts))]
        return self.of_lengths(known, rows)

    def of_lengths(self, known: Sequence[tuple[FloatArray, FloatArray]], rows: IntArray) -> Found:
        """The same for known lengths and rates of parts."""
        count = len(rows)
        temperatures = {len(part.warmth) for part in self.parts} or {1}
        gained = np.zeros((count, max(temperatures), len(self.without)))
        friction = np.broadcast_to(self.friction, (count, len(self.without)))
        margins = np.empty((count, len(self.parts), 2, self.strokes))
        for number, (part, (length, rate)) in enumerate(zip(self.parts, known, strict=True)):
            row = rows[:, number]
            force, slope, longest, shortest, rubbed = (
                each[row][:, None]
                for each in (part.force, part.slope, part.longest, part.shortest, part.friction)
            )
            pushed = (
                part.spec.sense * (force + slope * (longest - length)) * rate
                if part.angle is None
                else -force * length * rate
            )
            gained = gained + part.warmth[:, None] * pushed[:, None]
            friction = friction + rubbed * np.abs(rate) * np.abs(self.per)
            over_travel = length[:, : self.strokes]
            ends = np.stack([longest - over_travel, over_travel - shortest], axis=1)
            margins[:, number] = _between_samples(ends / (longest - shortest)[..., None])
        effort = self.without - self.per * gained
        loss = (self.times * friction)[:, None]
        over = np.maximum(effort - self.most + loss, self.least - effort + loss)
        return Found(over.reshape(count, -1), margins - INSET)


def _between_samples(values: FloatArray) -> FloatArray:
    """Values (..., S) of smooth curves with the least ones moved to the vertex of the parabola about them."""
    before, middle, after = values[..., :-2], values[..., 1:-1], values[..., 2:]
    bend, slope = before - 2 * middle + after, after - before
    with np.errstate(divide="ignore", invalid="ignore"):
        lower = np.where((middle < before) & (middle <= after), slope**2 / (8 * bend), 0.0)
    found = values.copy()
    found[..., 1:-1] -= lower
    return found


def _samples(case: EffortCase) -> tuple[FloatArray, tuple[FloatArray, FloatArray, FloatArray, FloatArray]]:
    """Places for strokes and demands; their limits, multiples of friction, and flags `opening`."""
    travel, parts = case.travel, []
    share = (1 - np.cos(np.linspace(0, np.pi, _ABOUT_STROKES))) / 2
    everywhere = travel.start + (travel.end - travel.start) * share
    none = np.full(len(everywhere), np.inf)
    parts.append((everywhere, -none, none, 0 * share, 0 * share))
    for demand in case.spec.demands:
        if demand.start > case.total_deg:
            continue
        first, last = case.place_at(demand.start), case.place_at(demand.end)
        span = (min(demand.end, case.total_deg) - demand.start) / case.total_deg
        count = max(_LEAST, int(np.ceil(_SAMPLES * span)))
        share = (1 - np.cos(np.linspace(0, np.pi, count))) / 2
        places = first + (last - first) * share
        end = demand.end if np.isfinite(demand.end) else demand.start + 1
        angles = case.angle_deg(places)
        least, most = (np.interp(angles, (demand.start, end), side) for side in (demand.least, demand.most))
        same = np.ones(len(places))
        parts.append((places, least, most, demand.friction * same, demand.opening * same))
    places, least, most, times, opening = (np.concatenate(each) for each in zip(*parts, strict=True))
    return places, (least, most, times, opening)


def _part(part: PartSpec, case: EffortCase, places: FloatArray) -> Part:
    warmth = np.unique([part.warmth(each) for each in case.spec.temperatures_c])[[0, -1]]
    sizes = part.sizes
    friction = np.array([part.count * size.friction for size in sizes])
    if not part.turns:
        longest, stroke, last, first = np.array(
            [(s.extended, s.stroke, s.force_extended, s.force_compressed) for s in sizes]
        ).T
        ends = tuple(Area.of(case.linkage, place) for place in part.places)
        slope = part.count * (first - last) / stroke
        return Part(part, warmth, part.count * last, slope, longest, longest - stroke, friction, ends)
    turned, rate = case.joint_turn(part.joint, places)
    low, high = part.free_angle_deg or (0.0, 0.0)
    turned = turned_from(turned, (low + high) / 2, 360.0)
    moment = np.array([part.count * size.moment / size.turn_deg for size in sizes]) / case.metre
    most = np.array([size.turn_deg for size in sizes])
    return Part(part, warmth, moment, 0 * moment, most, -most, friction / case.metre, angle=turned, turn=rate)


def _complex(vectors: FloatArray) -> ComplexArray:
    return np.asarray(vectors[..., 0] + 1j * vectors[..., 1])
