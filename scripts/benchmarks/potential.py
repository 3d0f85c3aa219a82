"""The potential of slow four-bars under weights, forces and springs, whose slope is the drive torque."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from grashof.problems import Problem
from grashof.problems.values.arrays import ComplexArray, FloatArray


@dataclass(frozen=True, slots=True)
class Potential:
    """Lengths in sizes of the task, as the middle of its points; energies in N m.

    `places` of joints, given to `energy`, have o2, o4, a, b, p (complex) and the lengths r2, r3, r4.
    """

    size: float  # m
    middle: complex  # m
    shares: FloatArray
    torques: FloatArray  # N m, at these shares of the motion
    weight: float  # sizes of the position error for 1 N m of the deviation (rms)
    gravity: complex
    per_length: float  # kg/m of bars
    payload: float
    forces: tuple[tuple[complex, complex], ...]  # on the coupler: its point (m, from A along AB), and N
    springs: tuple[tuple[complex, complex, float, float], ...]  # from the ground to the coupler, N/m and m

    @classmethod
    def of(cls, problem: Problem) -> "Potential":
        """That of a problem in metres, whose forces and springs act on the coupler."""
        spec, torque = problem.dynamics, problem.torque
        if spec is None or torque is None or torque.over != "share" or problem.length_unit != "m":
            raise ValueError("a wanted torque over shares, in metres, is known here")
        placed = problem.task.positions @ np.array([1, 1j])
        return cls(
            size=problem.task.size,
            middle=complex(placed.mean()),
            shares=torque.places,
            torques=torque.torques,
            weight=(torque.weight or 1.0) / torque.greatest / np.sqrt(len(torque.wanted)),
            gravity=complex(*spec.gravity),
            per_length=spec.mass_per_length or 0.0,
            payload=spec.payload,
            forces=tuple((complex(*load.at), complex(*(load.force or (0, 0)))) for load in spec.loads),
            springs=tuple(
                (
                    complex(*spring.between[0].at),
                    complex(*spring.between[1].at),
                    spring.stiffness,
                    spring.free_length,
                )
                for spring in spec.springs
            ),
        )

    def energy(self, places: Any) -> FloatArray:
        """The potential of linkages at their places, (B, K)."""
        a, b, p, o2, o4 = (
            self.size * each + self.middle for each in (places.a, places.b, places.p, places.o2, places.o4)
        )
        along = (b - a) / np.abs(b - a)
        total = self._falls(self.payload, p)
        for length, one, other in ((places.r2, o2, a), (places.r3, a, b), (places.r4, o4, b)):
            total = total + self._falls(self.per_length * self.size * length, (one + other) / 2)
        for at, force in self.forces:
            total = total - ((a + at * along) * force.conjugate()).real
        for ground, at, stiffness, free in self.springs:
            total = total + stiffness * (np.abs(a + at * along - ground) - free) ** 2 / 2
        return np.asarray(total)

    def _falls(self, mass: Any, at: ComplexArray) -> Any:
        return -mass * (at * self.gravity.conjugate()).real
