"""Lengths, rates and forces of struts and springs in some positions of a linkage."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis.forces.from_spec import JOINT_OF
from grashof.analysis.forces.joints import joint_motion
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray, turned_from
from grashof.problems.values.dynamics.struts import BODY, EffortPlace, PartSize, PartSpec


@dataclass(frozen=True, slots=True, eq=False)
class PartState:
    """A part, with all its equal ones side by side, in some positions.

    Parameters
    ----------
    length : ndarray, shape (N,), length
        From pivot to pivot; for a torsion spring its turn from the free angle, deg.
    rate : ndarray, shape (N,), length
        Rate of the length in the virtual motion; for a torsion spring rate of its turn, rad.
    force : ndarray, shape (N,), N
        Force of all of them together at 20 deg C, positive where it lengthens the part; for a torsion spring
        N m over the length unit in metres.
    friction : float, N
        Friction in the same unit, against the motion.
    ends : ndarray, shape (2, N, 2), length
        Both pivots; empty for a torsion spring.
    """

    length: FloatArray
    rate: FloatArray
    force: FloatArray
    friction: float
    ends: FloatArray


def part_state(
    part: PartSpec, linkage: Linkage, metre: float, virtual: Kinematics, rest: Kinematics, sense: FloatArray
) -> PartState:
    """A placed part in some positions; velocities are those of `virtual` times `sense` (N,).

    Between its two stated lengths the force of a strut or spring changes linearly.
    """
    if not part.is_placed:
        raise ProblemError("a part of the effort is not placed yet; it must have one size, and points")
    size = part.sizes[0]
    if part.turns:
        return _turned(part, size, metre, virtual, rest, sense)
    (first, start), (second, end) = (place_on(linkage, place) for place in part.places)
    ends = part_ends(part, linkage, rest)
    way = ends[1] - ends[0]
    length = np.hypot(way[..., 0], way[..., 1])
    parting = virtual.point(second, end).velocity - virtual.point(first, start).velocity
    with np.errstate(invalid="ignore", divide="ignore"):
        rate = np.where(length > 0, sense * (way * parting).sum(axis=-1) / length, 0.0)
    return PartState(
        length, rate, part.count * part.sense * force_at(size, length), part.count * size.friction, ends
    )


def part_ends(part: PartSpec, linkage: Linkage, at: Kinematics) -> FloatArray:
    """Both pivots of a placed strut or straight spring, shape (2, N, 2), length."""
    places = (at.point(*place_on(linkage, place)).position for place in part.places)
    return np.stack(np.broadcast_arrays(*places))


def force_at(size: PartSize, length: FloatArray) -> FloatArray:
    """Force of a strut or straight spring at 20 deg C at some lengths, N, without its sense."""
    share = (size.extended - length) / size.stroke
    return size.force_extended + (size.force_compressed - size.force_extended) * share


def place_on(linkage: Linkage, place: EffortPlace) -> tuple[int, tuple[float, float]]:
    """Link and point, in its frame, of a place that is a single point.

    The guided body has its origin in P, and is turned by `body_angle` relative to the link that carries it.
    """
    u, v = place.point
    if place.link != BODY:
        return int(place.link), (u, v)
    angle = float(linkage.body_angle)
    turned = complex(u, v) * np.exp(1j * angle) + complex(*linkage.coupler_point)
    return linkage.mechanism.carries, (turned.real, turned.imag)


def _turned(
    part: PartSpec, size: PartSize, metre: float, virtual: Kinematics, rest: Kinematics, sense: FloatArray
) -> PartState:
    """A torsion spring, whose moment is proportional to its turn from the free angle, either way."""
    joint, free = JOINT_OF[part.joint], 0.0 if part.free_angle_deg is None else part.free_angle_deg[0]
    turned = turned_from(np.degrees(joint_motion(rest, joint)[0]), free, 360.0)
    rate = sense * joint_motion(virtual, joint)[1]
    moment = -part.count * size.moment * turned / size.turn_deg / metre
    return PartState(
        turned, rate, moment, part.count * size.friction / metre, np.zeros((2, *turned.shape, 2))[:0]
    )
