"""Limits that draw the search for paths inwards: lengths, pivots, angles of ground line and driver."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems import Requirements
from grashof.problems.checks import ComplexArray, FloatArray
from grashof.synth.path_loop import Loop, PathTarget

PULL = 0.03  # sizes of error that overstepping a limit e-fold, or by a size, counts as


def pulls(
    target: PathTarget, loop: Loop, by_start: FloatArray, z: ComplexArray, by_z: ComplexArray
) -> tuple[FloatArray, FloatArray]:
    """How far limits are overstepped, weighted (n, L), and the derivative by the unknowns (n, L, M)."""
    wanted = target.wanted
    lengths = np.stack([np.ones_like(loop.r2), loop.r2, loop.r3, loop.r4], axis=1)
    by_lengths = np.zeros((len(z), 4, by_z.shape[2]))
    by_lengths[:, 1:, :3] = loop.by_lengths
    by_log_length = by_lengths / lengths[..., None]
    by_log_z = (by_z / z[..., None]).real
    scale, by_scale = np.abs(z[:, 1]) / loop.r2, by_log_z[:, 1] - by_log_length[:, 1]
    low, high = np.array(wanted.link_lengths).T
    log = np.log(lengths * scale[:, None])
    over = _overstep(log, np.log(np.maximum(low, 1e-9)), np.log(high))
    by_over = np.where((over != 0)[..., None], by_log_length + by_scale[:, None], 0.0)
    rows, index = np.arange(len(z)), (np.argmax(log, axis=1), np.argmin(log, axis=1))
    ratio = np.maximum(log[rows, index[0]] - log[rows, index[1]] - np.log(wanted.link_ratio_max), 0.0)
    by_ratio = by_log_length[rows, index[0]] - by_log_length[rows, index[1]]
    by_ratio = np.where((ratio > 0)[:, None], by_ratio, 0.0)
    arm = _overstep(np.log(np.abs(z[:, 2])), -np.inf, np.log((wanted.coupler_arms or (0.0, np.inf))[1]))
    by_arm = np.where((arm != 0)[:, None], by_log_z[:, 2], 0.0)
    ground = _ComplexRow(np.log(z[:, 1] / loop.r2), by_z[:, 1] / z[:, 1, None] - by_log_length[:, 1])
    driver = _Row(loop.theta2[:, 0], by_start)
    others = [*_pivot_rows(wanted, z, by_z, ground), *_angle_rows(wanted, ground, driver)]
    pulls = np.concatenate([over, np.stack([ratio, arm, *(row.value for row in others)], axis=1)], axis=1)
    slopes = np.stack([by_ratio, by_arm, *(row.slope for row in others)], axis=1)
    return PULL * pulls, PULL * np.concatenate([by_over, slopes], axis=1)


@dataclass(frozen=True, slots=True)
class _Row:
    """A quantity of every linkage (n,), and its derivative by the unknowns (n, M)."""

    value: FloatArray
    slope: FloatArray


@dataclass(frozen=True, slots=True)
class _ComplexRow:
    value: ComplexArray
    slope: ComplexArray

    @property
    def real(self) -> _Row:
        return _Row(self.value.real, self.slope.real)

    @property
    def imag(self) -> _Row:
        return _Row(self.value.imag, self.slope.imag)


def _pivot_rows(
    wanted: Requirements, z: ComplexArray, by_z: ComplexArray, log_ground: _ComplexRow
) -> list[_Row]:
    """How far the ground pivots lie outside their boxes."""
    ground = np.exp(log_ground.value)
    o2 = _ComplexRow(z[:, 0], by_z[:, 0])
    o4 = _ComplexRow(o2.value + ground, o2.slope + ground[:, None] * log_ground.slope)
    rows = []
    for box, pivot in ((wanted.o2, o2), (wanted.o4, o4)):
        for side, part in ((box.x, pivot.real), (box.y, pivot.imag)) if box else ():
            outside = _overstep(part.value, *side)
            if side != (-np.inf, np.inf):
                rows.append(_Row(outside, np.where((outside != 0)[:, None], part.slope, 0.0)))
    return rows


def _angle_rows(wanted: Requirements, log_ground: _ComplexRow, driver: _Row) -> list[_Row]:
    """How far ground line and driver (from it) at the first point are turned from where they are wanted."""
    ground = log_ground.imag
    driver = _Row(ground.value + driver.value, ground.slope + driver.slope)
    wishes = ((wanted.ground_angle_deg, ground), (wanted.theta2_start_deg, driver))
    return [
        _Row(np.angle(np.exp(1j * (angle.value - np.radians(wish)))), angle.slope)
        for wish, angle in wishes
        if wish is not None
    ]


def _overstep(value: FloatArray, low: FloatArray | float, high: FloatArray | float) -> FloatArray:
    """Signed amount by which values lie above `high` (positive) or below `low` (negative)."""
    return np.maximum(value - high, 0.0) - np.maximum(low - value, 0.0)
