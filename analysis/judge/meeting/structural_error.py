"""The structural error of function generators over their range."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from grashof.analysis.judge.meeting.function_start import Beginning
from grashof.analysis.judge.meeting.generated import moved_output, senses_of, way_of
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.peaks import peaks
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import TURN, FloatArray, IntArray

DENSE = 721  # samples of the range
_GAUSS = 12  # points between two samples of the quadrature
_COARSE = 25

Errors: TypeAlias = tuple[FloatArray, dict[str, Any]]


def structural_errors(
    batch: Linkage, task: Task, begun: Sequence[Beginning], exact: bool
) -> list[Errors | None]:
    """Of each linkage (B,), its errors at the pairs (N,), rad or length, and figures of a verdict.

    None of one that cannot be assembled over the entire range. Extremes are refined, the mean square is a
    Gauss-Legendre sum between samples and pairs. The output's zero is the mean of the errors at the pairs, or
    the middle of the extremes where the greatest error counts and pairs need not be met; for a mirrored
    linkage it lies in the mirrored position.
    """
    dense = np.unique(np.concatenate([task.inputs, np.linspace(*task.span, DENSE)]))
    outputs = outputs_of(batch, task, begun, dense)
    covered = np.flatnonzero(np.isfinite(outputs).all(axis=1)).tolist()
    if not covered:
        return [None] * len(begun)
    senses = np.array(sorted(senses_of(task)))
    off = outputs[covered] - senses[:, None, None] * task.output(dense)
    best = np.ptp(off, axis=-1).argmin(axis=0)
    off = np.take_along_axis(off, best[None, :, None], axis=0)[0]
    error = _Error(batch[covered], task, [begun[row] for row in covered], senses[best], dense, off)
    found = dict(zip(covered, error.figures(exact), strict=True))
    return [found.get(row) for row in range(len(begun))]


def outputs_of(
    batch: Linkage, task: Task, begun: Sequence[Beginning], inputs: FloatArray, *, unwrapped: bool = True
) -> FloatArray:
    """Outputs (B, K) up to constants, positive in the sense of the driver, at growing inputs (K,) or (B, K).

    NaN where a linkage cannot be assembled.
    """
    rows = np.broadcast_to(inputs, (len(begun), inputs.shape[-1]))
    theta2 = np.empty(rows.shape)
    for at, (each, row) in enumerate(zip(begun, rows, strict=True)):
        theta2[at] = each.driver_angles(row)
    ways = np.array([each.direction for each in begun], dtype=int)[:, None]
    return moved_output(task, solve_position(batch[:, None], theta2), ways, unwrapped=unwrapped)


@dataclass(frozen=True, slots=True)
class _Error:
    """Structural errors of linkages (B,), whose outputs have senses (B,), known at dense samples, (B, K)."""

    batch: Linkage
    task: Task
    begun: Sequence[Beginning]
    senses: IntArray
    dense: FloatArray
    off: FloatArray

    def at(self, inputs: FloatArray) -> FloatArray:
        """The errors (B, M), up to constants, at inputs (M,) or (B, M)."""
        outputs = outputs_of(self.batch, self.task, self.begun, inputs, unwrapped=False)
        found = outputs - self.senses[:, None] * self.task.output(inputs)
        if self.task.travels:
            return found
        # Without the full turns by which they may differ from the dense samples.
        near = np.broadcast_to(np.searchsorted(self.dense, inputs), found.shape)
        near = np.minimum(near, len(self.dense) - 1)
        return found - TURN * np.round((found - np.take_along_axis(self.off, near, axis=1)) / TURN)

    def figures(self, exact: bool) -> Iterator[Errors]:
        """The errors of each at the pairs, and the figures of its verdict."""
        task, share = self.task, self.task.weights / self.task.weights.sum()
        # In rows: sums depend on the layout, in their last bits.
        at_pairs = np.ascontiguousarray(self.off[:, np.searchsorted(self.dense, task.inputs)])

        def both(inputs: FloatArray) -> FloatArray:
            errors = self.at(inputs)
            return np.stack([errors, -errors])

        samples = np.broadcast_to(self.dense, self.off.shape)
        (high, low), (high_at, low_at) = peaks(both, [samples])
        if task.mirror is not None:
            zero = self.at(np.array([task.mirror_turn]))[:, 0]
        elif task.norm == "max" and not exact:
            zero = (high - low) / 2
        else:
            zero = np.array([share @ each for each in at_pairs])
        squares = self._squares(zero)
        worst_above = high - zero >= low + zero
        worst = np.where(worst_above, high - zero, low + zero)
        worst_at = np.where(worst_above, high_at, low_at)
        for row, begun in enumerate(self.begun):
            yield (
                at_pairs[row] - zero[row],
                {
                    "structural_error_max": float(worst[row]),
                    "structural_error_rms": float(np.sqrt(squares[row])),
                    "structural_error_at": float(begun.driver_turns(worst_at[row, None])[0]),
                    "output_zero": float(way_of(task, begun.direction) * zero[row]),
                    "output_sense": int(self.senses[row]),
                },
            )

    def _squares(self, zero: FloatArray) -> list[float]:
        """Mean squares of the errors from zeros (B,)."""
        nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
        coarse = np.unique(np.concatenate([self.task.inputs, np.linspace(*self.task.span, _COARSE)]))
        middle, half = (coarse[1:] + coarse[:-1]) / 2, np.diff(coarse) / 2
        inner, shares = (middle[:, None] + half[:, None] * nodes).ravel(), (half[:, None] * weights).ravel()
        squares = (self.at(inner) - zero[:, None]) ** 2
        return [float(shares @ row) / float(np.ptp(coarse)) for row in squares]
