"""Formulas of what varies along the task motion: torque, joint forces, velocities; their greatest magnitude.

Written once for arrays and for CasADi symbols, as in `grashof.synth.programme.formulas`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from grashof.problems import Problem
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray
from grashof.problems.values.dynamics_spec import metres
from grashof.synth.programme.vector import Vector

LOADS = 10  # numbers that drive torque and forces
SCREENED = 25  # driver angles where many linkages are compared
LOOKED_AT = 30 * SCREENED  # driver angles where one linkage is looked at
AGREES = 2e-3  # share of its bound by which a magnitude may exceed it
MOST_PEAKS = 4  # that are reported at once


@dataclass(frozen=True, slots=True)
class Instant:
    """A linkage at a driver angle, or at many; rates are derivatives by theta2, lengths in sizes.

    Parameters
    ----------
    crank, coupler, output : Vector
        O2A, AB, O4B.
    point : Vector
        AP.
    speed3, speed4, rate3, rate4
        First and second derivatives of theta3 and theta4.
    load : sequence of LOADS numbers
        See `loads`.
    """

    crank: Vector
    coupler: Vector
    output: Vector
    point: Vector
    speed3: Any
    speed4: Any
    rate3: Any
    rate4: Any
    load: Any

    @classmethod
    def of(cls, ground: Vector, lengths: Any, arm: Vector, assembly: Any, theta2: Any, load: Any) -> Instant:
        """The linkage with ground O2O4, lengths r1 to r4 and coupler point (u, v) at driver angles.

        Where the loop does not close its numbers are NaN, and Ipopt shortens its step.
        """
        r2, r3, r4 = lengths[1], lengths[2], lengths[3]
        crank = r2 * Vector(np.cos(theta2), np.sin(theta2))
        diagonal = ground - crank
        square = diagonal.square
        along = (r3**2 - r4**2 + square) / (2 * square)
        coupler = along * diagonal + (assembly * np.sqrt(r3**2 / square - along**2)) * diagonal.left
        output = coupler - diagonal
        sine = coupler.cross(output)
        speed3, speed4 = (-crank.left.dot(link) / sine for link in (output, coupler))
        bend = -crank - speed3**2 * coupler + speed4**2 * output
        rate3, rate4 = (-bend.dot(link) / sine for link in (output, coupler))
        point = (arm.x * coupler + arm.y * coupler.left) / r3
        return cls(crank, coupler, output, point, speed3, speed4, rate3, rate4, load)

    @property
    def masses(self) -> tuple[Any, Any, Any, Any]:
        """Of links 2, 3, 4 and of the payload."""
        lengths = (np.sqrt(link.square) for link in (self.crank, self.coupler, self.output))
        m2, m3, m4 = (self.load[4 + k] + self.load[3] * length for k, length in enumerate(lengths))
        return m2, m3, m4, self.load[9]

    @property
    def inertias(self) -> tuple[Any, Any]:
        """Of links 3 and 4 about their middles."""
        r3, r4 = (np.sqrt(link.square) for link in (self.coupler, self.output))
        return self.load[7] + self.load[3] * r3**3 / 12, self.load[8] + self.load[3] * r4**3 / 12

    def velocity(self, on_coupler: Vector) -> Vector:
        """Of a place given from A."""
        velocity: Vector = self.crank.left + self.speed3 * on_coupler.left
        return velocity

    def acceleration(self, on_coupler: Vector) -> Vector:
        """Of a place given from A."""
        acceleration: Vector = self.rate3 * on_coupler.left - self.crank - self.speed3**2 * on_coupler
        return acceleration

    def inertia_force(self, mass: Any, acceleration: Vector) -> Vector:
        """What a mass takes besides its weight: m (a - g)."""
        force: Vector = mass * (self.load[0] * acceleration - Vector(self.load[1], self.load[2]))
        return force


def drive_torque(at: Instant) -> list[Any]:
    """T omega2 = sum of m (a - g) . v + I alpha omega (d'Alembert; Norton, the method of virtual work)."""
    m2, m3, m4, payload = at.masses
    i3, i4 = at.inertias
    middle2, middle3, middle4 = (link / 2 for link in (at.crank, at.coupler, at.output))
    swing = at.rate4 * middle4.left - at.speed4**2 * middle4
    power = at.inertia_force(m2, -middle2).dot(middle2.left)
    for mass, place in ((m3, middle3), (payload, at.point)):
        power = power + at.inertia_force(mass, at.acceleration(place)).dot(at.velocity(place))
    power = power + at.inertia_force(m4, swing).dot(at.speed4 * middle4.left)
    return [power + at.load[0] * (i3 * at.speed3 * at.rate3 + i4 * at.speed4 * at.rate4)]


def joint_forces(at: Instant) -> list[Any]:
    """Forces in O2, A, B and O4, from moments of link 3 about A and of link 4 about O4."""
    m2, m3, m4, payload = at.masses
    i3, i4 = at.inertias
    middle2, middle3, middle4 = (link / 2 for link in (at.crank, at.coupler, at.output))
    swing = at.rate4 * middle4.left - at.speed4**2 * middle4
    on_link2 = at.inertia_force(m2, -middle2)
    on_middle3 = at.inertia_force(m3, at.acceleration(middle3))
    on_point = at.inertia_force(payload, at.acceleration(at.point))
    on_link4 = at.inertia_force(m4, swing)
    about_a = middle3.cross(on_middle3) + at.point.cross(on_point) + at.load[0] * i3 * at.rate3
    about_o4 = middle4.cross(on_link4) + at.load[0] * i4 * at.rate4
    # F43, by link 4 on link 3: AB x F43 = about_a and O4B x F43 = -about_o4.
    in_b = (-about_o4 * at.coupler - about_a * at.output) / at.output.cross(at.coupler)
    in_a = on_middle3 + on_point - in_b  # by link 2 on link 3
    return [on_link2 + in_a, in_a, in_b, on_link4 + in_b]


# What is bounded over the task motion, by the key of the quantity, in `Problem.scale`: of scalars and vectors
# the magnitude, of several the greatest.
Along: TypeAlias = Callable[[Instant], list[Any]]
ALONG: dict[str, Along] = {
    "mechanical_advantage": lambda at: [at.speed4],
    "omega4_max": lambda at: [at.speed4],
    "point_speed_max": lambda at: [at.velocity(at.point)],
    "point_acceleration_max": lambda at: [at.acceleration(at.point)],
    "torque_peak": drive_torque,
    "joint_force_peak": joint_forces,
}


# Those whose value is one over the greatest magnitude.
INVERSE = frozenset({"mechanical_advantage"})


def value_of(key: str, peak: Any) -> Any:
    """The value of a quantity whose greatest magnitude is known, and the other way round."""
    return 1 / peak if key in INVERSE else peak


def loads(problem: Problem) -> FloatArray:
    """What drives torque and forces, shape (LOADS,), which then come in reference torques and forces.

    Acceleration of a point one size from O2 in a steady turn and gravity (x, y), m/s2; then, over
    those: mass of a bar one size long, of links 2, 3, 4 besides, inertia of links 3 and 4, payload.
    """
    spec = problem.dynamics
    if spec is None:
        return np.zeros(LOADS)
    size = problem.task.size
    radius = size * metres(problem.length_unit)
    masses, inertias = spec.masses or (0.0, 0.0, 0.0), spec.inertias or (0.0, 0.0, 0.0)
    bar = (spec.mass_per_length or 0.0) * size
    moved = np.array([bar, *masses, *(np.array(inertias[1:]) / size**2), spec.payload])
    return np.concatenate(
        [[spec.omega2**2 * radius], spec.gravity, moved * (radius / problem.reference_torque)]
    )


def magnitudes(
    problem: Problem,
    key: str,
    points: ComplexArray,
    theta2: FloatArray,
    direction: FloatArray,
    assembly: FloatArray,
    count: int,
) -> FloatArray:
    """A quantity at an even grid over the task motion of each of many linkages.

    Parameters
    ----------
    problem : Problem
    key : str
        Of `ALONG`.
    points : ndarray of complex, shape (n, 5), sizes
        O2, O4, and A, B, P at the first target.
    theta2 : ndarray, shape (n, N), rad
        In the order of visit.
    direction, assembly : ndarray, shape (n,)
    count : int
        Driver angles that are looked at.

    Returns
    -------
    ndarray, shape (n, count)
        In `Problem.scale` of the quantity; infinite where a linkage does not close.
    """
    o2, o4, a, b, p = points.T[..., None]
    coupler, ground = b - a, o4 - o2
    last = theta2[:, 0] + direction * TURN if problem.task.closed else theta2[:, -1]
    arm = (p - a) * np.abs(coupler) / coupler
    lengths = [np.abs(link) for link in (ground, a - o2, coupler, b - o4)]
    angles = np.linspace(theta2[:, 0], last, count, axis=1)
    with np.errstate(all="ignore"):
        at = Instant.of(
            Vector(ground.real, ground.imag), lengths, Vector(arm.real, arm.imag), assembly[:, None], angles,
            loads(problem),
        )  # fmt: skip
        found = [np.hypot(v.x, v.y) if isinstance(v, Vector) else np.abs(v) for v in ALONG[key](at)]
    greatest: FloatArray = np.nan_to_num(np.max(found, axis=0), nan=np.inf)
    return greatest


def overlooked(
    problem: Problem,
    key: str,
    points: ComplexArray,
    theta2: FloatArray,
    direction: int,
    assembly: int,
    bound: float,
) -> list[float]:
    """Where a linkage has peaks above a bound, as shares of the motion; the worst few.

    Parameters
    ----------
    problem : Problem
    key : str
        Of `ALONG`.
    points : ndarray of complex, shape (5,), sizes
    theta2 : ndarray, shape (N,), rad
        In the order of visit.
    direction, assembly : int
    bound : float
        In `Problem.scale` of the quantity.
    """
    ways = theta2[None], np.array([direction]), np.array([assembly])
    (curve,) = magnitudes(problem, key, points[None], *ways, LOOKED_AT)
    beside = np.concatenate([[-np.inf], curve, [-np.inf]])
    peaks = np.flatnonzero((curve >= beside[:-2]) & (curve > beside[2:]) & (curve > bound * (1 + AGREES)))
    worst = peaks[np.argsort(-curve[peaks], kind="stable")][:MOST_PEAKS]
    return [float(peak) / (LOOKED_AT - 1) for peak in worst]
