"""Moving planes of a linkage at samples of its motion, and what cylinders between them and the ground do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from grashof.problems import FourBar
from grashof.problems.values.arrays import ComplexArray, FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Plane:
    """The frame of a moving link at M samples of the motion, in its order.

    Parameters
    ----------
    origin, axis : ndarray of complex, shape (M,), length and 1
        O2, A or O4, and the unit vector along the link.
    slide : ndarray of complex, shape (M,)
        How the origin moves.
    turn : ndarray, shape (M,)
        How the link turns.
    power : ndarray, shape (M,), or None
        What a drive has to give in that motion, in N times the length; None where nothing limits the force.
    """

    origin: ComplexArray
    axis: ComplexArray
    slide: ComplexArray
    turn: FloatArray
    power: FloatArray | None = None


class Driven(NamedTuple):
    """What K cylinders do in a motion, each of shape (K,), but for `levers`, shape (K, M).

    Levers are signed so that they are positive where a cylinder lengthens, or all turned round.
    """

    levers: FloatArray
    least: FloatArray
    closed: FloatArray
    ratio: FloatArray
    force: FloatArray


def planes_of(
    linkage: FourBar, theta2: FloatArray, theta3: FloatArray, theta4: FloatArray, power: FloatArray | None
) -> dict[str, Plane]:
    """The planes of links 2, 3 and 4, by their names.

    Parameters
    ----------
    linkage : FourBar
        A single linkage.
    theta2, theta3, theta4 : ndarray, shape (M,), rad
    power : ndarray, shape (M,), or None
        Of a driver of link 2 at 1 rad/s, N times the length: the drive torque.

    Notes
    -----
    The links turn as the sides of the loop let them: i (w2 A + w3 (B - A)) = i w4 (B - O4) with all three
    rates times the area of A-B-O4, so that none is infinite in a dead position.
    """
    o2, o4 = complex(*linkage.o2), complex(*linkage.o4)
    r2, r3, r4 = (float(length) for length in (linkage.r2, linkage.r3, linkage.r4))
    e2, e3, e4 = (np.exp(1j * angle) for angle in (theta2, theta3, theta4))
    crank, coupler, output = r2 * e2, r3 * e3, r4 * e4
    w2, w3, w4 = (
        np.imag(np.conj(one) * other) for one, other in ((output, coupler), (crank, output), (crank, coupler))
    )
    size = (r2 + r3 + r4) ** 2
    w2, w3, w4 = w2 / size, w3 / size, w4 / size
    given = None if power is None else power * w2
    still = np.zeros_like(crank)
    return {
        "driver": Plane(still + o2, e2, still, w2, given),
        "coupler": Plane(o2 + crank, e3, 1j * w2 * crank, w3, given),
        "output": Plane(still + o4, e4, still, w4, given),
    }


def driven(plane: Plane, point: ComplexArray, base: ComplexArray) -> Driven:
    """What cylinders do between points of a plane and bases on the ground, each of shape (K,)."""
    arm = point[:, None] * plane.axis
    out = plane.origin + arm - base[:, None]
    way = plane.slide + 1j * plane.turn * arm
    length, speed = np.abs(out), np.abs(way)
    with np.errstate(invalid="ignore", divide="ignore"):
        change = (out.real * way.real + out.imag * way.imag) / length
        levers = np.nan_to_num(change / speed)
        force = np.zeros(len(point))
        if plane.power is not None:
            force = np.nan_to_num(np.abs(plane.power / change), nan=np.inf).max(axis=1)
    sign = np.where(levers.sum(axis=1) < 0, -1.0, 1.0)
    levers = sign[:, None] * levers
    first, last = length[:, 0], length[:, -1]
    closed = np.minimum(first, last)
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = np.nan_to_num(np.maximum(first, last) / closed, nan=np.inf)
    return Driven(levers, levers.min(axis=1), closed, ratio, force)
