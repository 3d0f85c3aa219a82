"""Free points met in order: dynamic programming for the assignment, then Newton's method in all angles."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from grashof.analysis.curves.coupler_curve import (
    PIECES,
    ROUNDING,
    Track,
    between,
    coupler_curve,
    range_around,
    squared_distance,
    tracks,
)
from grashof.analysis.judge.assignment import Guess, ordered_guesses
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.minimisation import lowest, lowest_in_order
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray

_BASINS = 4
_BESIDE = 0.15  # rad
_LOOK = np.linspace(-1, 1, 25)


# Where targets are met: driver angles and assemblies, each (N,), and the sense of the driver, 0 in no order.
Met: TypeAlias = tuple[FloatArray, IntArray, int]


def met_in_order(linkage: Linkage, task: Task, same_branch: bool, theta2_start: float | None) -> Met | None:
    """The least weighted squares over driver angles that do not go back, within one turn.

    None when it cannot be assembled. Where points have to stand together far from the curve, the least found
    may be a local one.
    """
    passages = _passages(linkage, task, same_branch, theta2_start)
    guesses = [(guess, passage) for passage in passages for guess in passage.guesses(middles=False)]
    if not guesses:
        return None
    guesses.sort(key=lambda item: item[0].distance)
    first = guesses[0][0]
    near = [item for item in guesses[:_BASINS] if item[0].distance <= first.distance + 2 * first.slack]
    for crowded in {id(passage): passage for guess, passage in near if guess.crowded}.values():
        near += [(guess, crowded) for guess in crowded.guesses(middles=True)]
    theta2, value = _refined(linkage, near)
    moved = _beside(linkage, near, theta2, value)
    if (moved != theta2).any():
        shifted = [(replace(item[0], theta2=row), item[1]) for item, row in zip(near, moved, strict=True)]
        moved, depth = _refined(linkage, shifted)
        deeper = (depth.sum(axis=1) < value.sum(axis=1))[:, None]
        theta2, value = np.where(deeper, moved, theta2), np.where(deeper, depth, value)
    total = value.sum(axis=1)
    level = total <= total.min() * (1 + 1e-9) + len(task) * (ROUNDING * task.size) ** 2
    row = int(np.argmin(np.where(level, np.ptp(theta2, axis=1), np.inf)))
    guess, passage = near[row]
    sense = passage.direction
    return theta2[row][::sense], guess.assembly[::sense], sense


def _beside(
    linkage: Linkage, guesses: list[tuple[Guess, _Passage]], theta2: FloatArray, value: FloatArray
) -> FloatArray:
    """Angles moved over into the next valley where that is deeper, as it may be beside a cusp."""
    room = (TURN - (theta2[:, -1:] - theta2[:, :1])) / 2
    before = np.concatenate([theta2[:, :1] - room, theta2[:, :-1]], axis=1)
    after = np.concatenate([theta2[:, 1:], theta2[:, -1:] + room], axis=1)
    bounds = np.array([passage.bounds() for _, passage in guesses]).swapaxes(0, 1)
    floor, ceiling = (
        np.array([getattr(guess, name) for guess, _ in guesses]) for name in ("floor", "ceiling")
    )
    low = np.maximum.reduce([before, floor, bounds[0], theta2 - _BESIDE])
    high = np.minimum.reduce([after, ceiling, bounds[1], theta2 + _BESIDE])
    assembly = np.array([guess.assembly for guess, _ in guesses])
    points, weights = (np.array([getattr(one, name) for _, one in guesses]) for name in ("points", "weights"))
    angle = np.clip(theta2[..., None] + _BESIDE * _LOOK * np.abs(_LOOK), low[..., None], high[..., None])
    p = solve_position(linkage, angle, assembly[..., None]).p @ np.array([1, 1j])
    gap = np.nan_to_num(np.abs(p - points[..., None]), nan=np.inf)
    valley = (gap[..., 1:-1] < gap[..., :-2]) & (gap[..., 1:-1] < gap[..., 2:])
    valley[..., len(_LOOK) // 2 - 1] = False
    other = np.where(valley, gap[..., 1:-1], np.inf)
    if np.isinf(other).all():
        return theta2
    chosen = np.argmin(other, axis=-1)[..., None] + 1
    start = np.where(valley.any(axis=-1), np.take_along_axis(angle, chosen, axis=-1)[..., 0], theta2)
    moved, depth = lowest(squared_distance(linkage, points, assembly, weights), start, low, high)
    return np.maximum.accumulate(np.where(depth < value * (1 - 1e-6), moved, theta2), axis=1)


@dataclass(frozen=True, slots=True)
class _Passage:
    """One sense of the driver on one of its motions.

    Points and weights (N,) as growing driver angles meet them. `direction` is -1 when that reverses the
    task's order; `first` the driver angle (rad) given at the task's first point, and `start` P there on each
    assembly.
    """

    track: Track
    points: ComplexArray
    weights: FloatArray
    direction: int
    first: float | None = None
    start: ComplexArray | None = None

    def guesses(self, *, middles: bool) -> list[Guess]:
        if self.first is None or self.start is None:
            return ordered_guesses(self.track, self.points, self.weights, middles=middles)
        at = 0 if self.direction > 0 else -1
        gaps = np.abs(self.start - self.points[at])
        sign, distance = int(self.track.signs[np.argmin(gaps)]), float(self.weights[at] ** 0.5 * gaps.min())
        rest, weights = np.delete(self.points, at), np.delete(self.weights, at)
        found = ordered_guesses(self.track, rest, weights, middles=middles)
        return [_with(guess, self.first, sign, distance, at) for guess in found]

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest driver angle at each point."""
        low, high = np.full(len(self.points), -np.inf), np.full(len(self.points), np.inf)
        if self.first is not None:
            low[:] = self.first if self.direction > 0 else self.first - TURN
            high[:] = low + TURN
            at = 0 if self.direction > 0 else -1
            low[at] = high[at] = self.first
        return low, high


def _with(guess: Guess, theta2: float, assembly: int, distance: float, at: int) -> Guess:
    """A guess for the other targets, with one more at a given driver angle before or after them."""
    place = 0 if at == 0 else len(guess.theta2)
    return replace(
        guess,
        theta2=np.insert(guess.theta2, place, theta2),
        floor=np.insert(guess.floor, place, guess.floor[at]),
        ceiling=np.insert(guess.ceiling, place, guess.ceiling[at]),
        assembly=np.insert(guess.assembly, place, assembly),
        distance=float(np.hypot(guess.distance, distance)),
    )


def _passages(linkage: Linkage, task: Task, same_branch: bool, theta2_start: float | None) -> list[_Passage]:
    points = task.positions @ np.array([1, 1j])
    if theta2_start is None:
        every = tracks(linkage, PIECES, same_branch)
        return [
            _Passage(track, points[::sense], task.weights[::sense], sense)
            for track in every
            for sense in (1, -1)
        ]
    ends = range_around(linkage, theta2_start)
    passages = []
    for sense in (1, -1):
        far = float(np.clip(theta2_start + sense * TURN, *ends))
        if far == theta2_start or np.isnan(far):
            continue
        low, high = sorted((theta2_start, far))
        track = between(linkage, low, high, ends, PIECES, same_branch)
        start = coupler_curve(linkage, theta2_start, track.signs)[0]
        ordered = points[::sense], task.weights[::sense]
        passages.append(_Passage(track, *ordered, sense, theta2_start, start))
    return passages


def _refined(linkage: Linkage, guesses: list[tuple[Guess, _Passage]]) -> tuple[FloatArray, FloatArray]:
    theta2, floor, ceiling, assembly = (
        np.array([getattr(guess, name) for guess, _ in guesses])
        for name in ("theta2", "floor", "ceiling", "assembly")
    )
    points, weights = (np.array([getattr(one, name) for _, one in guesses]) for name in ("points", "weights"))
    low, high = np.array([passage.bounds() for _, passage in guesses]).swapaxes(0, 1)
    model = squared_distance(linkage, points, assembly, weights)
    return lowest_in_order(model, theta2, (low, high), (floor, ceiling))
