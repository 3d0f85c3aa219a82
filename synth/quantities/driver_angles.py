"""Driver angles at the targets, unwrapped along the driver's motion."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import TURN, FloatArray, IntArray


def as_they_come(angle: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
    """Order in which a driver meets targets on the shortest arc that holds them all.

    From its angles (n, N) in rad: that order (n, N), the angles in it, unwrapped and counter-clockwise, and
    the direction (n,).
    """
    count, sense = angle.shape[1], np.ones(len(angle))
    visit = np.argsort(angle % TURN, axis=1)
    turned = np.take_along_axis(angle, visit, axis=1)
    gap = (np.roll(turned, -1, axis=1) - turned) % TURN
    begin = (gap.argmax(axis=1)[:, None] + 1 + np.arange(count)) % count
    visit = np.take_along_axis(visit, begin, axis=1)
    return visit, follow(np.take_along_axis(angle, visit, axis=1), sense), sense


def follow(angle: FloatArray, direction: FloatArray) -> FloatArray:
    """Driver angles (n, N) unwrapped in the driver's sense, each step less than a turn."""
    steps = direction[:, None] * ((direction[:, None] * np.diff(angle, axis=1)) % TURN)
    return np.concatenate([angle[:, :1], angle[:, :1] + np.cumsum(steps, axis=1)], axis=1)


def shorter_way(angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Driver angles (n, N) unwrapped in the sense that makes them turn less, and that sense (n,)."""
    forth, back = (follow(angle, np.full(len(angle), sense)) for sense in (1.0, -1.0))
    shorter = np.ptp(forth, axis=1) <= np.ptp(back, axis=1)
    return np.where(shorter[:, None], forth, back), np.where(shorter, 1.0, -1.0)
