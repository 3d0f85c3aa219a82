"""Four-bars as function generators: link 4 turns with the driver, or the coupler does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from grashof.problems import FourBar, Requirements
from grashof.problems.values.arrays import ComplexArray, FloatArray, IntArray, Limits
from grashof.problems.values.requirements.function_ground import FunctionGround
from grashof.synth.loop.dyad import Bars, Closed
from grashof.synth.loop.vector import Vector
from grashof.synth.theory.five_poses import five_pose_dyads_of_sets
from grashof.synth.theory.functions.output import Generators, crank_ratios, solved, weighed

_TRIVIAL = 1e-6  # of the ground: with a pivot nearer to O2 or O4 it is the ground link itself
_EXCHANGED = [0, 2, 1, 3]  # of a shape, r3 and r4


@dataclass(frozen=True, slots=True)
class FourBars(Generators):
    """Four-bars on the ground O2 = 0, O4 = 1 with the driver angle at which they begin.

    The shape has the logarithms of r2, r3, r4, each over r1, and the first driver angle; the assembly is the
    sign of sin(theta4 - theta3).
    """

    UNKNOWNS = 4
    EXACT = 5
    LINEAR = 3
    LINKS = 3
    dyad = Bars()

    @classmethod
    def of_pivots(cls, a: ComplexArray, b: ComplexArray) -> Self:
        """Those with A and B at given places at the first driver angle, each of shape (M,)."""
        with np.errstate(divide="ignore"):
            sizes = np.log([np.abs(a), np.abs(b - a), np.abs(b - 1)])
        shape = np.stack([*sizes, np.angle(a)], axis=-1)
        return cls(shape, np.where(((b - a).conj() * (b - 1)).imag >= 0, 1.0, -1.0))

    @classmethod
    def of_linkage(cls, linkage: Any, unit: float, driver: int, theta2: float) -> Self:
        r1, *others = linkage.lengths
        shape = np.append(np.log(np.array(others) / r1), driver * (theta2 - linkage.theta1))
        return cls(shape[None], np.array([driver * float(linkage.assembly)]))

    @staticmethod
    def sizes_of(shape: Sequence[Any]) -> tuple[Any, Any, Any, Any]:
        r2, r3, r4, _ = shape
        return 1.0, np.exp(r2), np.exp(r3), np.exp(r4)

    def moves(self, crank: Vector, loop: Closed) -> list[Vector]:
        return [crank, loop.along, -loop.across, crank.left]

    @classmethod
    def through(cls, turned: FloatArray, output: FloatArray) -> tuple[Self, IntArray]:
        """All four-bars through five pairs, both start angles free: one or three of most sets.

        Function generation is motion generation: seen from link 4, link 2 moves through known poses, and the
        unknown coupler is an RR dyad of that motion (Erdman & Sandor; families of five poses: Burmester). One
        of its roots is the ground link itself, which is left out: what remains is a cubic.
        """
        rotation = np.exp(1j * (turned - output))
        shift = 1.0 - np.exp(-1j * output)
        dyads = five_pose_dyads_of_sets(rotation, shift)
        a, b = dyads.moving, dyads.ground
        with np.errstate(invalid="ignore"):
            real = (np.abs(a) > _TRIVIAL) & (np.abs(b - 1) > _TRIVIAL) & (np.abs(b - a) > _TRIVIAL)
        which, root = np.nonzero(real)
        return cls.of_pivots(a[which, root], b[which, root]), which

    @classmethod
    def at_starts(cls, turned: FloatArray, output: FloatArray, driver: FloatArray, place: FloatArray) -> Self:
        """Those through three pairs, where Freudenstein's equation gives a negative length by half a turn.

        K1 cos psi - K2 cos phi + K3 = cos(phi - psi) with K1 = r1 / r2, K2 = r1 / r4 and
        K3 = (r1^2 + r2^2 - r3^2 + r4^2) / (2 r2 r4) (Freudenstein, *Trans. ASME* 77, 1955) is linear in K.
        Its residual over its derivative by psi is the error of the output (structural instead of design
        error), by which more than three pairs are weighted in a second step.
        """
        phi, psi = driver[:, None] + turned, place[:, None] + output
        rows = np.stack([np.cos(psi), -np.cos(phi), np.ones_like(phi)], axis=-1)
        right = np.cos(phi - psi)
        k = solved(rows, right)
        if len(turned) > 3:
            slope = np.abs(-k[:, :1] * np.sin(psi) - np.sin(phi - psi))
            k = solved(*weighed(rows, right, slope))
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            r2, r4 = 1.0 / k[:, 0], 1.0 / k[:, 1]
            r3 = np.sqrt(1.0 + r2**2 + r4**2 - 2 * r2 * r4 * k[:, 2])
            middle = len(turned) // 2
            a, b = r2 * np.exp(1j * phi[:, middle]), 1.0 + r4 * np.exp(1j * psi[:, middle])
            first = driver + np.pi * (r2 < 0)
            shape = np.stack([np.log(np.abs(r2)), np.log(r3), np.log(np.abs(r4)), first], axis=-1)
            assembly = np.where(((b - a).conj() * (b - 1)).imag >= 0, 1.0, -1.0)
        shape[~np.isfinite(shape).all(axis=1)] = np.nan
        return cls(shape, assembly)

    @staticmethod
    def full_cranks(rng: np.random.Generator, count: int, shortest: int) -> FloatArray:
        """All full cranks, and no other linkages, whatever b and c are, and r2 below or above 1.

        With r1 = 1 they have r3 + r4 = 1 + r2 + exp(b) and r3 - r4 = abs(1 - r2) tanh(c).

        >>> r1, r2, r3, r4 = FourBars.cranks(np.random.default_rng(0), 100).lengths.T
        >>> bool((r3 + r4 > r1 + r2).all() and (abs(r1 - r2) > abs(r3 - r4)).all())
        True
        """
        crank = crank_ratios(rng, count)
        longer = rng.random(count) < 0.5 if not shortest else np.full(count, shortest < 0)
        r2 = np.where(longer, 1 / crank, crank)
        total, difference = (
            1 + r2 + np.exp(rng.normal(-1, 1.5, count)),
            np.abs(1 - r2) * np.tanh(rng.normal(0, 1, count)),
        )
        lengths = np.stack([r2, (total + difference) / 2, (total - difference) / 2], axis=-1)
        return np.asarray(np.log(lengths))

    @staticmethod
    def any_shape(rng: np.random.Generator, count: int) -> FloatArray:
        """Lengths from 0.05 to 20."""
        return np.asarray(np.log(20) * rng.uniform(-1, 1, (count, 3)))

    @staticmethod
    def sizes(wanted: Requirements, unit: float) -> tuple[tuple[str, ...], list[Limits]]:
        ground = FunctionGround.of(wanted)
        first = (
            max(wanted.link_lengths[0][0], ground.lengths[0]),
            min(wanted.link_lengths[0][1], ground.lengths[1]),
        )
        return ("r1", "r2", "r3", "r4"), [first, *wanted.link_lengths[1:]]

    def linkage(self, wanted: Requirements, unit: float, driver: int) -> FourBar:
        ground, shares = FunctionGround.of(wanted), self.lengths[0]
        low, high = np.array(wanted.link_lengths).T
        least = max(ground.lengths[0], float((low / shares).max()))
        most = min(ground.lengths[1], float((high / shares).min()))
        r1 = float(np.clip(ground.length, least, max(least, most)))
        o2, o4 = ground.placed(r1)
        r2, r3, r4 = (r1 * shares[1:]).tolist()
        return FourBar(o2=o2, o4=o4, r2=r2, r3=r3, r4=r4, assembly=driver * self.assembly[0])

    def at_b(self, output: FloatArray) -> ComplexArray:
        return np.asarray(1 + self.lengths[:, 3:] * np.exp(1j * output))


class CouplerFourBars(FourBars):
    """Four-bars whose coupler follows a function, in the shape of the four-bars whose link 4 does.

    r2 e2 + r3 e3 = r1 + r4 e4 is r2 e2 - r4 e4 = r1 - r3 e3: a four-bar with r3 and r4 exchanged, of the same
    driver, whose coupler has the direction -e4 and whose link 4 that of -e3, from O4 to O4 + A - B. So its
    link 4 turns as the coupler does, on the other assembly, since sin(theta4 - theta3) changes its sign. The
    transmission angle is the same, and so are full rotation and r1 - r2, which decides on the kind of crank.
    Shape, `lengths` and `outputs` are those of the exchanged four-bar; `sizes`, `extent` and `linkage` those
    of the four-bar itself.
    """

    __slots__ = ()

    @property
    def itself(self) -> FourBars:
        """The four-bars whose coupler it is, with r3 and r4 in their places."""
        return FourBars(self.shape[:, _EXCHANGED], -self.assembly)

    def closing(self, shape: Sequence[Any]) -> tuple[tuple[Any, Any, Any, Any], FloatArray]:
        r1, r2, r4, r3 = self.sizes_of(shape)
        return (r1, r2, r3, r4), -self.assembly

    @classmethod
    def of_linkage(cls, linkage: Any, unit: float, driver: int, theta2: float) -> Self:
        made = FourBars.of_linkage(linkage, unit, driver, theta2)
        return cls(made.shape[:, _EXCHANGED], -made.assembly)

    @staticmethod
    def sizes(wanted: Requirements, unit: float) -> tuple[tuple[str, ...], list[Limits]]:
        names, (r1, r2, r3, r4) = FourBars.sizes(wanted, unit)
        return (*names[:2], *names[:1:-1]), [r1, r2, r4, r3]

    def linkage(self, wanted: Requirements, unit: float, driver: int) -> FourBar:
        return self.itself.linkage(wanted, unit, driver)

    def extent(self, span: float, ground: float) -> FloatArray:
        return self.itself.extent(span, ground)
