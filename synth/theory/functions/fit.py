"""Least squares of the output of many function generators at once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray
from grashof.synth.loop.dual import Dual
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.stopping import raise_if_overdue

Limits: TypeAlias = Callable[[Generators], Dual]  # as `ShapeLimits.of`

HALVES = ((6, 400), (12, 120), (20, 48))  # after these steps this number of the best continue
STEPS = 60
CELL = 0.1  # in logarithms of lengths and rad: of generators in one cell only the best continues
VARIED = 0.5  # the same, of those that are different in kind
FLAT = 1e-15  # share of the square below which a step gains nothing
_TINY = 1e-30


@dataclass(frozen=True, slots=True)
class DesiredOutput:
    """The desired output of a generator, or of each of several."""

    turned: FloatArray  # (N,) or (M, N), rad: driver rotations from the first, growing from zero
    output: FloatArray  # (N,) or (M, N): outputs there, but for a constant: angles in rad, or travel
    weights: FloatArray  # (N,), of the squared errors

    def some(self, index: IntArray | BoolArray) -> DesiredOutput:
        """Those of some of the generators."""
        turned, output = (each[index] if each.ndim > 1 else each for each in (self.turned, self.output))
        return DesiredOutput(turned, output, self.weights)

    def errors(self, batch: Generators) -> FloatArray:
        """Output less the desired one, with the best zero of least squares, shape (M, N); NaN: open."""
        errors: FloatArray = batch.outputs(self.turned) - self.output
        return self.centred(errors)

    def centred(self, values: FloatArray) -> FloatArray:
        """Values (M, N, ...) less their weighted mean over the second axis."""
        mean = np.einsum("n,mn...->m...", self.weights / self.weights.sum(), values)
        centred: FloatArray = values - mean[:, None]
        return centred

    def square(self, errors: FloatArray) -> FloatArray:
        """Weighted sum of squares, shape (M,)."""
        total: FloatArray = np.einsum("n,mn->m", self.weights, errors**2)
        return total


def fitted(
    desired: DesiredOutput,
    starts: Generators,
    limits: Limits | None = None,
    *,
    pull: float = 1.0,
    held: bool = False,
    steps: int = STEPS,
    taken: int = 0,
) -> tuple[Generators, FloatArray]:
    """The best of many starts moved to least squares, best first, and their weighted sums of squares.

    Those open somewhere are left out, and of very many only the most promising continue, for at most `steps`
    steps, of which some may be `taken`. Negative `limits` (as `ShapeLimits.of`) count as errors of `pull`
    times as much, in rad or in units of the travel, and in the sums. The first driver angle stays if `held`.
    Levenberg-Marquardt over the batch; the zero of the output is linear and eliminated (variable projection,
    Golub & Pereyra 1973).
    """
    model = _Model(desired, limits, pull, held)
    batch = starts.finite
    square = model.square(batch)
    batch, square = batch[np.isfinite(square)], square[np.isfinite(square)]
    damping = np.full(len(batch), 1e-3)
    done: BoolArray = np.zeros(len(batch), dtype=bool)
    for step in range(taken, steps):
        raise_if_overdue()
        batch, square, damping, done = _fewer(step, batch, square, damping, done)
        active = np.flatnonzero(~done)
        if not active.size:
            break
        moved, fresh, gain = model.step(batch[active], square[active], damping[active])
        better = gain > 0
        shape = batch.shape.copy()
        shape[active[better]] = moved.shape[better]
        done[active] = better & (gain <= FLAT * square[active] + _TINY)
        square[active[better]] = fresh[better]
        damping[active] *= np.where(better, 0.2, 6.0)
        done[active] |= (damping[active] > 1e8) | (square[active] < _TINY)
        damping = np.clip(damping, 1e-14, 1e9)
        batch = batch.changed(shape)
    order = np.argsort(square, kind="stable")
    return batch[order], square[order]


def _fewer(
    step: int, batch: Generators, square: FloatArray, damping: FloatArray, done: BoolArray
) -> tuple[Generators, FloatArray, FloatArray, BoolArray]:
    most = dict(HALVES).get(step, len(batch))
    if most >= len(batch):
        return batch, square, damping, done
    best = np.sort(best_apart(batch, square, CELL)[:most])
    return batch[best], square[best], damping[best], done[best]


def best_apart(batch: Generators, square: FloatArray, cell: float) -> IntArray:
    """Indices (K,) of the best, those of least `square` (M,), among generators that are alike; best first.

    Those that share a cell of size `cell`, in logarithms of lengths and in rad, are alike.

    >>> shape = np.array([[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.01]])
    >>> from grashof.synth.theory.functions.four_bar import FourBars
    >>> best_apart(FourBars(shape, np.ones(3)), np.array([2.0, 3.0, 1.0]), 0.1).tolist()
    [2, 1]
    """
    order = np.argsort(square, kind="stable")
    shape = batch.own_shape.copy()
    shape[:, -1] %= 2 * np.pi
    keys = np.column_stack([np.round(shape / cell), batch.assembly])[order]
    first = np.unique(keys, axis=0, return_index=True)[1]
    best: IntArray = order[np.sort(first)]
    return best


def best_varied(batch: Generators, square: FloatArray, cell: float) -> IntArray:
    """The same, of each large cell (`VARIED`) the best before all others: a wide valley is not all there is.

    Both parts are best first.
    """
    fine = best_apart(batch, square, cell)
    ahead = best_apart(batch[fine], square[fine], VARIED)
    order: IntArray = np.concatenate([fine[ahead], np.delete(fine, ahead)])
    return order


@dataclass(frozen=True, slots=True)
class _Model:
    desired: DesiredOutput
    limits: Limits | None
    pull: float
    held: bool

    def square(self, batch: Generators) -> FloatArray:
        """Sums of squares with pulls; infinite where the loop is open."""
        total = self.desired.square(self.desired.errors(batch))
        if self.limits is not None:
            short = np.minimum(self.limits(batch).value, 0.0)
            total = total + self.pull**2 * (short**2).sum(axis=1)
        return np.where(np.isfinite(total), total, np.inf)

    def step(
        self, batch: Generators, square: FloatArray, damping: FloatArray
    ) -> tuple[Generators, FloatArray, FloatArray]:
        """One damped step each: its end, the square there, and its gain."""
        normal, side = self._normal(batch)
        scale = np.einsum("mii->mi", normal)
        floor = 1e-12 * scale.max(axis=1, keepdims=True) + 1e-300
        normal = normal + np.eye(batch.UNKNOWNS) * (damping[:, None] * np.maximum(scale, floor))[:, None]
        moved = -np.linalg.solve(normal, side[..., None])[..., 0]
        moved /= np.maximum(1.0, np.abs(moved).max(axis=1, keepdims=True))
        there = batch.changed(batch.shape + moved)
        fresh = self.square(there)
        return there, fresh, square - fresh

    def _normal(self, batch: Generators) -> tuple[FloatArray, FloatArray]:
        desired = self.desired
        output = batch.outputs(desired.turned)
        errors = desired.centred(output - desired.output)
        slopes = desired.centred(batch.slopes(desired.turned))
        weighed = slopes * desired.weights[:, None]
        normal = weighed.swapaxes(1, 2) @ slopes
        side = (weighed.swapaxes(1, 2) @ errors[..., None])[..., 0]
        if self.limits is not None:
            rows = self.limits(batch)
            short = self.pull * np.minimum(rows.value, 0.0)
            pulled = self.pull * rows.slope * (rows.value < 0)[..., None]
            normal = normal + pulled.swapaxes(1, 2) @ pulled
            side = side + (pulled.swapaxes(1, 2) @ short[..., None])[..., 0]
        if self.held:
            normal[:, -1], normal[:, :, -1], side[:, -1] = 0.0, 0.0, 0.0
            normal[:, -1, -1] = 1.0
        normal = np.nan_to_num(normal, nan=0.0, posinf=0.0, neginf=0.0)
        return normal, np.nan_to_num(side, nan=0.0, posinf=0.0, neginf=0.0)
