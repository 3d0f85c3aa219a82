"""Inverted slider-cranks as function generators: the block turns with the driver."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from grashof.problems import InvertedSliderCrank, Requirements
from grashof.problems.values.arrays import ComplexArray, FloatArray, IntArray, Limits
from grashof.problems.values.requirements.function_ground import FunctionGround
from grashof.synth.loop.dyad import Block, Closed
from grashof.synth.loop.vector import Vector
from grashof.synth.theory.functions.output import Generators, crank_ratios, weighed

_TRIVIAL = 1e-9  # share of a null vector: without O4 it is not a linkage


@dataclass(frozen=True, slots=True)
class InvertedSliderCranks(Generators):
    """Inverted slider-cranks on the ground O2 = 0, O4 = 1 with the driver angle at which they begin.

    The shape has the logarithm of r2 and the offset, each over r1, and the first driver angle. B always lies
    ahead of A along the rod: the other assembly is the opposite offset.
    """

    UNKNOWNS = 3
    EXACT = 4
    LINEAR = 2
    LINKS = 1
    dyad = Block()

    @classmethod
    def of_linkage(cls, linkage: Any, unit: float, driver: int, theta2: float) -> Self:
        r1, first = float(linkage.lengths[0]), driver * (theta2 - float(linkage.theta1))
        side = driver * float(linkage.assembly)
        shape = np.array([[np.log(float(linkage.r2) / r1), side * float(linkage.offset) / r1, first]])
        return cls(shape, np.ones(1))

    @property
    def other_assembly(self) -> Self:
        return self.changed(self.shape * [1.0, -1.0, 1.0])

    @staticmethod
    def sizes_of(shape: Sequence[Any]) -> tuple[Any, Any, Any, Any]:
        return 1.0, np.exp(shape[0]), 0.0, shape[1]

    def moves(self, crank: Vector, loop: Closed) -> list[Vector]:
        return [crank, -loop.across, crank.left]

    @classmethod
    def through(cls, turned: FloatArray, output: FloatArray) -> tuple[Self, IntArray]:
        """The inverted slider-crank through four pairs: one of most sets.

        With c = e^(i psi0) and w = r2 e^(i (phi0 - psi0)) of the start angles, O4 lies beside the rod's line
        by offset = Im(e^(i psi) c + e^(i (phi - psi)) w): four equations, linear in five numbers with a free
        scale.
        """
        swung, seen = np.exp(1j * output), np.exp(1j * (turned - output))
        rows = np.stack([swung.imag, swung.real, seen.imag, seen.real, -np.ones_like(turned)], axis=-1)
        null = np.linalg.svd(rows)[2][:, -1]
        c, w = null[:, 0] + 1j * null[:, 1], null[:, 2] + 1j * null[:, 3]
        which = np.flatnonzero((np.abs(c) > _TRIVIAL) & (np.abs(w) > _TRIVIAL))
        size, (c, w) = np.abs(c[which]), (c[which], w[which])
        return cls._of(w / size, c / size, null[which, 4] / size), which

    @classmethod
    def at_starts(cls, turned: FloatArray, output: FloatArray, driver: FloatArray, place: FloatArray) -> Self:
        """Offset - r2 sin(theta2 - theta3) = sin(theta3) is linear in r2 and the offset."""
        theta2, theta3 = driver[:, None] + turned, place[:, None] + output
        rows = np.stack([-np.sin(theta2 - theta3), np.ones_like(theta2)], axis=-1)
        found = _solved_by_two(rows, np.sin(theta3))
        if len(turned) > 2:
            rod = np.abs(np.cos(theta3) - found[:, :1] * np.cos(theta2 - theta3))
            found = _solved_by_two(*weighed(rows, np.sin(theta3), rod))
        r2, offset = found.T
        c = np.exp(1j * place)
        batch = cls._of(r2 * np.exp(1j * (driver - place)), c, offset)
        shape = batch.shape.copy()
        shape[:, 2] = driver + np.pi * (r2 < 0)
        shape[~np.isfinite(shape).all(axis=1)] = np.nan
        return batch.changed(shape)

    @classmethod
    def _of(cls, w: ComplexArray, c: ComplexArray, offset: FloatArray) -> Self:
        """Those with such a w, c and offset, each of shape (M,); the rod is taken from A to B."""
        with np.errstate(divide="ignore", invalid="ignore"):
            rod = c.real - w.real
            side = np.where(rod < 0, -1.0, 1.0)
            shape = np.stack([np.log(np.abs(w)), side * offset, np.angle(w * c)], axis=-1)
        return cls(shape, np.ones(len(shape)))

    @staticmethod
    def full_cranks(rng: np.random.Generator, count: int, _shortest: int) -> FloatArray:
        """abs(offset) < abs(1 - r2)."""
        crank = crank_ratios(rng, count)
        r2 = np.where(rng.random(count) < 0.5, 1 / crank, crank)
        offset = np.abs(1 - r2) * np.tanh(rng.normal(0, 1, count))
        return np.column_stack([np.log(r2), offset])

    @staticmethod
    def any_shape(rng: np.random.Generator, count: int) -> FloatArray:
        """r2 from 0.05 to 20, the offset up to the longer of r1 and r2."""
        r2 = np.log(20) * rng.uniform(-1, 1, count)
        offset = np.maximum(1.0, np.exp(r2)) * rng.uniform(-1, 1, count)
        return np.column_stack([r2, offset])

    @staticmethod
    def assemblies(_rng: np.random.Generator, count: int) -> FloatArray:
        return np.ones(count)

    @staticmethod
    def sizes(wanted: Requirements, unit: float) -> tuple[tuple[str, ...], list[Limits]]:
        (low, high), second = wanted.link_lengths[:2]
        least, most = FunctionGround.of(wanted).lengths
        return ("r1", "r2"), [(max(low, least), min(high, most)), second]

    def linkage(self, wanted: Requirements, unit: float, driver: int) -> InvertedSliderCrank:
        ground, (_, share), offset = FunctionGround.of(wanted), self.lengths[0], driver * self.shape[0, 1]
        (low1, high1), (low2, high2) = ground.lengths, wanted.link_lengths[1]
        low, high = wanted.link_lengths[0]
        least, most = max(low, low1, low2 / share), min(high, high1, high2 / share)
        if wanted.offset is not None and offset:
            ends = sorted(edge / offset for edge in wanted.offset)
            least, most = max(least, ends[0]), min(most, ends[1])
        r1 = float(np.clip(ground.length, least, max(least, most)))
        o2, o4 = ground.placed(r1)
        size = float(np.clip(r1 * offset, *(wanted.offset or (-np.inf, np.inf))))
        return InvertedSliderCrank(o2=o2, o4=o4, r2=r1 * share, offset=size, assembly=1)

    def at_b(self, output: FloatArray) -> ComplexArray:
        return np.asarray(1 + 1j * self.shape[:, 1:2] * np.exp(1j * output))


def _solved_by_two(rows: FloatArray, right: FloatArray) -> FloatArray:
    """Least squares of many systems in two unknowns, (M, N, 2) and (M, N) to (M, 2); NaN where singular."""
    normal = rows.swapaxes(1, 2) @ rows
    side = (rows.swapaxes(1, 2) @ right[..., None])[..., 0]
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        determinant = normal[:, 0, 0] * normal[:, 1, 1] - normal[:, 0, 1] ** 2
        first = normal[:, 1, 1] * side[:, 0] - normal[:, 0, 1] * side[:, 1]
        second = normal[:, 0, 0] * side[:, 1] - normal[:, 0, 1] * side[:, 0]
        found: FloatArray = np.stack([first, second], axis=-1) / determinant[:, None]
    return found
