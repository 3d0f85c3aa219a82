"""Moving planes of a linkage at samples of its motion, and cylinders between them and the ground."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from grashof.problems import CylinderSpec, Linkage
from grashof.problems.values.arrays import ComplexArray, FloatArray, Limits

INSET = 1e-7  # share by which limits are tightened, so that the judge finds them met
_BETWEEN = 2e-4  # the same for rates, whose extremes lie between samples
_TINY = float(np.finfo(np.float64).tiny)


@dataclass(frozen=True, slots=True, eq=False)
class Plane:
    """The frame of a moving link at M samples of the motion, in its order; places are x + i y, u + i v."""

    origin: ComplexArray  # (M,): O2, A, and O4 or B of a slider
    axis: ComplexArray  # (M,): the unit vector along u
    slide: ComplexArray  # (M,): velocity of the origin, up to a factor for each sample
    turn: FloatArray  # (M,): angular velocity of the link, up to the same factor
    joints: ComplexArray  # (J,): the link's own points, in its frame
    middle: complex  # in its frame: its pivot of the ground, or half way from A to B
    reach: float  # greatest distance from there to pivots: the link's length, or r2 for a slider or block
    power: FloatArray | None = None  # (M,): of the drive, N length; None without limit of force
    output: FloatArray | None = None  # (M,): `turn` of link 4; None without limits of the rate


class Performance(NamedTuple):
    """Performance of K cylinders in a motion, each of shape (K,), but for `levers`, shape (K, M).

    Levers are signed so that they are positive where a cylinder lengthens, or all turned round.
    """

    levers: FloatArray
    least: FloatArray
    closed: FloatArray
    ratio: FloatArray
    force: FloatArray
    slow: FloatArray  # least change of the length for a radian of link 4; 1 without limits of the rate
    quick: FloatArray  # greatest change


def planes_of(
    linkage: Linkage,
    theta2: FloatArray,
    theta3: FloatArray,
    theta4: FloatArray,
    power: FloatArray | None,
    *,
    rates: bool = False,
) -> dict[str, Plane]:
    """The planes of links 2, 3 and 4 of a single linkage, by the words for them.

    Angles are of shape (M,); so is the power of a driver of link 2 at 1 rad/s, N length: the drive torque.
    Planes whose cylinders have limits of their rates (`rates`) know how fast link 4 turns.
    The motion of link 4 has no component along n = e^(i theta4): with the crank k and c = B - A, that is
    w2 : w3 = n x c : k x n in every kind of loop, also where c is a part of a rod. Link 4 turns as the link
    that it slides on, or else i (w2 k + w3 c) = i w4 (B - O4). None of this is infinite in a dead position.
    """
    e2, e3, e4 = (np.exp(1j * angle) for angle in (theta2, theta3, theta4))
    sizes = dict(zip(linkage.mechanism.lengths, linkage.lengths.tolist(), strict=True))
    ground = {name: complex(*getattr(linkage, name)) for name in linkage.mechanism.ground}
    o2, r2 = ground["o2"], sizes["r2"]
    crank, r4 = r2 * e2, sizes.get("r4", r2)  # any length suits a link that slides
    if "r3" in sizes:
        farthest, coupler = sizes["r3"], sizes["r3"] * e3
    else:  # a rod, up to the foot of O4 on it
        along = np.real(np.conj(e3) * (ground["o4"] - o2 - crank))
        farthest, coupler = float(along[np.argmax(np.abs(along))]), along * e3
    output = r4 * e4
    size = (r2 + abs(farthest) + r4) ** 2
    w2, w3, w4 = (
        np.imag(np.conj(one) * other) / size
        for one, other in ((output, coupler), (crank, output), (crank, coupler))
    )
    slides = {link: on for on, link in linkage.mechanism.slides}
    turn4 = {1: np.zeros_like(w2), 2: w2, 3: w3, 4: w4}[slides.get(4, 4)]
    given = (None if power is None else power * w2), (turn4 if rates else None)
    still, way = np.zeros_like(crank), 1j * w2 * crank
    far, p = complex(farthest), complex(*linkage.coupler_point)
    corners, length = np.array([0j, far, p]), max(abs(far), abs(p), abs(p - far))
    if "o4" in ground:  # about O4
        arm = float(getattr(linkage, "r4" if "r4" in sizes else "offset"))
        end, reach = np.array([complex(arm)]), max(r4, abs(arm))
        link4 = Plane(still + ground["o4"], e4, still, turn4, end, 0j, reach, *given)
    else:  # with B along a slide of the ground
        b, way_b = o2 + crank + coupler, 1j * (w2 * crank + w3 * coupler)
        link4 = Plane(b, e4 / 1j, way_b, turn4, np.array([0j]), 0j, r4, *given)
    return {
        "driver": Plane(still + o2, e2, still, w2, np.array([complex(r2)]), 0j, r2, *given),
        "coupler": Plane(o2 + crank, e3, way, w3, corners, far / 2, length, *given),
        "output": link4,
    }


def performance(plane: Plane, point: ComplexArray, base: ComplexArray) -> Performance:
    """Performance of cylinders between points of a plane and bases on the ground, each of shape (K,)."""
    out = plane.origin + point[:, None] * plane.axis - base[:, None]
    way = plane.slide + point[:, None] * (1j * plane.turn * plane.axis)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        length, speed = _magnitude(out), _magnitude(way)
        change = (out.real * way.real + out.imag * way.imag) / length
        levers = finite_or(change / speed, 0.0)
        force = np.zeros(len(point))
        if plane.power is not None:
            force = finite_or(np.abs(plane.power / change), np.inf).max(axis=1)
        rate = np.ones((len(point), 1))
        if plane.output is not None:
            rate = finite_or(np.abs(change / plane.output), np.inf)
    sign = np.where(levers.sum(axis=1) < 0, -1.0, 1.0)
    levers = sign[:, None] * levers
    first, last = length[:, 0], length[:, -1]
    closed = np.minimum(first, last)
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = finite_or(np.maximum(first, last) / closed, np.inf)
    extremes = rate.min(axis=1), rate.max(axis=1)
    return Performance(levers, levers.min(axis=1), closed, ratio, force, *extremes)


def _magnitude(values: ComplexArray) -> FloatArray:
    """Absolute values, quicker than by np.abs, which guards against the ends of the range of floats."""
    return np.sqrt(values.real**2 + values.imag**2)


def finite_or(values: FloatArray, otherwise: float) -> FloatArray:
    """Values, replaced where they are not finite."""
    return np.where(np.isfinite(values), values, otherwise)


@dataclass(frozen=True, slots=True, eq=False)
class Room:
    """The limits of a cylinder on one link."""

    middle: complex  # of the link, as `joints` and `reach`, see `Plane`: its pivot may be that far from there
    joints: ComplexArray
    reach: float
    low: FloatArray  # corners (2,) of the box in which its base may be
    high: FloatArray
    closed: Limits
    ratio: float  # limit of the greatest length over the closed one
    force: float
    rate: Limits

    @classmethod
    def of(
        cls,
        plane: Plane,
        spec: CylinderSpec,
        around: ComplexArray,
        force: float = np.inf,
        rate: Limits = (0.0, np.inf),
    ) -> Room:
        """The room of a cylinder on the link of a plane.

        Sides of the base that the problem leaves open are those of the box around the places (N,) that the
        linkage reaches, further out by its diagonal, or as the least closed length requires.
        """
        corners = np.array([[np.min(part), np.max(part)] for part in (around.real, around.imag)])
        closed = (0.0, np.inf) if spec.closed is None else spec.closed
        out = max(float(np.hypot(*np.ptp(corners, axis=1))), spec.ratio_max * closed[0])
        low, high = corners[:, 0] - out, corners[:, 1] + out
        if spec.base is not None:
            sides = np.array([spec.base.x, spec.base.y])
            fixed_low, fixed_high = np.isfinite(sides).T
            low = np.where(fixed_low, sides[:, 0], np.minimum(low, sides[:, 1]))
            high = np.where(fixed_high, sides[:, 1], np.maximum(high, sides[:, 0]))
        ratio = 1 + (spec.ratio_max - 1) * (1 - INSET)
        least, most = closed[0] * (1 + INSET), closed[1] * (1 - INSET)
        if least > most:
            least = most = closed[0] / 2 + closed[1] / 2
        carried = plane.middle, plane.joints, plane.reach
        tight = min(_BETWEEN, (1 - rate[0] / max(rate[1], _TINY)) / 4)
        rates = rate[0] * (1 + tight), rate[1] * (1 - tight)
        return cls(*carried, low, high, (least, most), ratio, force * (1 - INSET), rates)

    def left(self, found: Performance) -> FloatArray:
        """Margins of K cylinders to the limits, in logarithms, a column each, negative beyond."""
        with np.errstate(divide="ignore"):
            closed, force = (np.log(np.maximum(each, _TINY)) for each in (found.closed, found.force))
            columns = [np.log(self.ratio) - np.log(found.ratio)]
            columns += [closed - np.log(self.closed[0])] if self.closed[0] > 0 else []
            columns += [np.log(self.closed[1]) - closed] if np.isfinite(self.closed[1]) else []
            columns += [np.log(self.force) - force] if np.isfinite(self.force) else []
            slow, quick = (np.log(np.maximum(each, _TINY)) for each in (found.slow, found.quick))
            columns += [slow - np.log(self.rate[0])] if self.rate[0] > 0 else []
            columns += [np.log(self.rate[1]) - quick] if np.isfinite(self.rate[1]) else []
        return np.stack(columns, axis=1)

    def beyond(self, found: Performance) -> FloatArray:
        """Excess of cylinders over the limits, in logarithms; shape (K,), 0 where all are met."""
        return np.asarray(np.maximum(-self.left(found), 0.0).sum(axis=1))

    def kept(self, points: ComplexArray, bases: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Pivots moved back to where they are allowed."""
        off = points - self.middle
        size = np.abs(off)
        points = self.middle + off * np.where(size > self.reach, self.reach / np.maximum(size, 1e-300), 1.0)
        x = np.clip(bases.real, self.low[0], self.high[0])
        return points, x + 1j * np.clip(bases.imag, self.low[1], self.high[1])
