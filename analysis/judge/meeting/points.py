"""Points met in order, by dynamic programming and Newton's method in all angles, or singly."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np

from grashof.analysis.curves.coupler_curve import PIECES, Track, between, coupler_curve, range_around, tracks
from grashof.analysis.judge.meeting.assignment import Gaps, Guess, nearest_guess, ordered_guesses, slack_of
from grashof.analysis.judge.meeting.task_motion import as_good, squares
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.minimisation import Model, lowest, lowest_in_order
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray, IntArray

_VALLEYS = 3
_BASINS = 4
_BESIDE = 0.15  # rad
_LOOK = np.linspace(-1, 1, 25)
_AT_ONCE = 4000  # driver angles that are followed together, whose arrays fit into a cache

# Where targets are met: driver angles and assemblies, each (N,), and the sense of the driver, 0 in no order.
Met: TypeAlias = tuple[FloatArray, IntArray, int]


def met_singly(
    members: Sequence[Linkage], _: Linkage, task: Task, same_branch: bool, theta2_start: float | None
) -> list[Met | None]:
    """Each point as near as possible, on the motion of the least squares, of each linkage of a batch.

    None without an assembly.
    """
    return [_nearest(linkage, task, same_branch, theta2_start) for linkage in members]


def _nearest(linkage: Linkage, task: Task, same_branch: bool, theta2_start: float | None) -> Met | None:
    """The motion of one linkage, as of `met_singly`."""
    target = np.arange(len(task))
    best: Met | None = None
    least = np.inf
    for track in _tracks_through(linkage, same_branch, theta2_start):
        angle, low, high, assembly = nearest_guess(track, task.positions @ np.array([1, 1j]), _VALLEYS)
        if theta2_start is not None:
            angle[:, 0] = low[:, 0] = high[:, 0] = theta2_start
        angle, value = lowest(squares(linkage, task, assembly, weighted=False), angle, low, high)
        chosen = np.argmin(value, axis=0)
        total = float((task.meeting_weights * value[chosen, target]).sum())
        if total < least:
            best, least = (angle[chosen, target], assembly[chosen, target], 0), total
    return best


def _tracks_through(linkage: Linkage, same_branch: bool, theta2: float | None) -> list[Track]:
    every = tracks(linkage, PIECES, same_branch)
    if theta2 is None or len(every) == 1:
        return every
    return [track for track in every if (theta2 - track.low[0]) % TURN <= track.high[-1] - track.low[0]]


def met_in_order(
    members: Sequence[Linkage], batch: Linkage, task: Task, same_branch: bool, theta2_start: float | None
) -> list[Met | None]:
    """The least weighted squares over driver angles that do not go back, within one turn, of each of a batch.

    None when it cannot be assembled. The least found may be a local one where points must be met together far
    from the curve.
    """
    near = [_near(linkage, task, same_branch, theta2_start) for linkage in members]
    found = list[Met | None]()
    for some in _in_parts([len(each) for each in near], len(task)):
        found += _followed(batch[some], [near[row] for row in some.tolist()], task)
    return found


def _in_parts(rows: Sequence[int], count: int) -> list[IntArray]:
    """Numbers of linkages that have some rows of angles each, so divided that arrays fit into a cache."""
    part = np.cumsum(rows) * count // _AT_ONCE
    return np.split(np.arange(len(rows)), np.flatnonzero(np.diff(part)) + 1)


def _near(
    linkage: Linkage, task: Task, same_branch: bool, theta2_start: float | None
) -> list[tuple[Guess, _Passage]]:
    """Assignments of the points that are to be followed."""
    passages = _passages(linkage, task, same_branch, theta2_start)
    slack = max((slack_of(each.gaps.track, len(task)) for each in passages), default=0.0)
    guesses, least = list[tuple[Guess, _Passage]](), np.inf
    for passage in passages:
        guesses += [(guess, passage) for guess in passage.guesses(slack, least)]
        least = min((guess.distance for guess, _ in guesses), default=np.inf)
    guesses.sort(key=lambda item: item[0].distance)
    near = [item for item in guesses[:_BASINS] if item[0].distance <= least + 2 * slack]
    for crowded in {id(passage): passage for guess, passage in near if guess.crowded}.values():
        apart = replace(crowded, gaps=crowded.gaps.to_middles())
        near += [(guess, apart) for guess in apart.guesses(slack)]
    return near


def _followed(
    batch: Linkage, near: Sequence[Sequence[tuple[Guess, _Passage]]], task: Task
) -> Iterator[Met | None]:
    """Of each linkage the best that its assignments lead to."""
    every = [item for each in near for item in each]
    ends = np.cumsum([0, *map(len, near)])
    if every:
        linkages = batch[np.repeat(np.arange(len(near)), np.diff(ends))][:, None]
        theta2, floor, ceiling, assembly = (
            np.array([getattr(guess, name) for guess, _ in every])
            for name in ("theta2", "floor", "ceiling", "assembly")
        )
        order = np.array([passage.order(len(task)) for _, passage in every])
        low, high = np.array([passage.bounds(len(task)) for _, passage in every]).swapaxes(0, 1)
        model = squares(linkages, task, assembly, order)
        points = (task.positions @ np.array([1, 1j]))[order]

        def gaps(angle: FloatArray) -> FloatArray:
            p = solve_position(linkages[..., None], angle, assembly[..., None]).p @ np.array([1, 1j])
            return np.asarray(np.nan_to_num(np.abs(p - points[..., None]), nan=np.inf))

        theta2, value = lowest_in_order(model, theta2, (low, high), (floor, ceiling))
        moved = _beside(gaps, model, theta2, value, np.maximum(floor, low), np.minimum(ceiling, high))
        if (other := (moved != theta2).any(axis=1)).any():
            moved, depth = lowest_in_order(model, moved, (low, high), (floor, ceiling))
            deeper = (other & (depth.sum(axis=1) < value.sum(axis=1)))[:, None]
            theta2, value = np.where(deeper, moved, theta2), np.where(deeper, depth, value)
    for first, end in pairwise(ends.tolist()):
        if first == end:
            yield None
            continue
        level = as_good(task, value[first:end].sum(axis=1))
        row = first + int(np.argmin(np.where(level, np.ptp(theta2[first:end], axis=1), np.inf)))
        sense = every[row][1].direction
        yield theta2[row][::sense], assembly[row][::sense], sense


def _beside(
    gaps: Callable[[FloatArray], FloatArray],
    model: Callable[[FloatArray], Model],
    theta2: FloatArray,
    value: FloatArray,
    lowest_angle: FloatArray,
    highest_angle: FloatArray,
) -> FloatArray:
    """Angles moved over into the next valley where that is deeper, as it may be beside a cusp."""
    room = (TURN - (theta2[:, -1:] - theta2[:, :1])) / 2
    before = np.concatenate([theta2[:, :1] - room, theta2[:, :-1]], axis=1)
    after = np.concatenate([theta2[:, 1:], theta2[:, -1:] + room], axis=1)
    low = np.maximum.reduce([before, lowest_angle, theta2 - _BESIDE])
    high = np.minimum.reduce([after, highest_angle, theta2 + _BESIDE])
    angle = np.clip(theta2[..., None] + _BESIDE * _LOOK * np.abs(_LOOK), low[..., None], high[..., None])
    gap = gaps(angle)
    valley = (gap[..., 1:-1] < gap[..., :-2]) & (gap[..., 1:-1] < gap[..., 2:])
    valley[..., len(_LOOK) // 2 - 1] = False
    found: BoolArray = np.asarray(valley.any(axis=-1))
    if not found.any():
        return theta2
    chosen = np.argmin(np.where(valley, gap[..., 1:-1], np.inf), axis=-1)[..., None] + 1
    start = np.where(found, np.take_along_axis(angle, chosen, axis=-1)[..., 0], theta2)
    moved, depth = lowest(model, start, low, high)
    deeper = found & (depth < value * (1 - 1e-6))
    ordered = np.maximum.accumulate(np.where(deeper, moved, theta2), axis=1)
    rows: BoolArray = np.asarray(found.any(axis=1))
    return np.where(rows[:, None], ordered, theta2)  # no row depends on the others


@dataclass(frozen=True, slots=True)
class _Passage:
    """One sense of the driver on one of its motions, with the gaps of the points as growing angles meet them.

    `direction` is -1 when that reverses the task's order. Of a driver with a given angle at the task's first
    point, the gaps are those of the other points; `first` is that angle (rad), the nearer assembly and the
    weighted distance there.
    """

    gaps: Gaps
    direction: int
    first: tuple[float, int, float] | None = None

    def order(self, count: int) -> IntArray:
        """Numbers of the targets."""
        return np.arange(count)[:: self.direction]

    @property
    def at(self) -> int:
        """Where the first target of the task is."""
        return 0 if self.direction > 0 else -1

    def guesses(self, slack: float, least: float = np.inf) -> list[Guess]:
        """Assignments as of `ordered_guesses`; those of a driver with a given first angle have no `least`."""
        if self.first is None:
            return ordered_guesses(self.gaps, slack, least)
        return [_with(guess, *self.first, self.at) for guess in ordered_guesses(self.gaps, slack)]

    def bounds(self, count: int) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest driver angle at each of a number of points."""
        low, high = np.full(count, -np.inf), np.full(count, np.inf)
        if self.first is not None:
            theta2 = self.first[0]
            low[:] = theta2 if self.direction > 0 else theta2 - TURN
            high[:] = low + TURN
            low[self.at] = high[self.at] = theta2
        return low, high


def _with(guess: Guess, theta2: float, assembly: int, distance: float, at: int) -> Guess:
    """A guess for the other targets, with one more at a given driver angle before or after them."""
    place = 0 if at == 0 else len(guess.theta2)
    added = {"theta2": theta2, "floor": guess.floor[at], "ceiling": guess.ceiling[at], "assembly": assembly}
    fields: dict[str, Any] = {
        name: np.insert(getattr(guess, name), place, value) for name, value in added.items()
    }
    return replace(guess, **fields, distance=float(np.hypot(guess.distance, distance)))


def _passages(linkage: Linkage, task: Task, same_branch: bool, theta2_start: float | None) -> list[_Passage]:
    points, weights = task.positions @ np.array([1, 1j]), task.meeting_weights
    if theta2_start is None:
        every = [Gaps.of(track, points, weights) for track in tracks(linkage, PIECES, same_branch)]
        return [passage for gaps in every for passage in (_Passage(gaps, 1), _Passage(gaps.reversed(), -1))]
    ends = range_around(linkage, theta2_start)
    passages = []
    for sense in (1, -1):
        far = float(np.clip(theta2_start + sense * TURN, *ends))
        if far == theta2_start or np.isnan(far):
            continue
        low, high = sorted((theta2_start, far))
        track = between(linkage, low, high, ends, PIECES, same_branch)
        away = np.abs(coupler_curve(linkage, theta2_start, track.signs)[0] - points[0])
        first = theta2_start, int(track.signs[np.argmin(away)]), float(weights[0] ** 0.5 * away.min())
        gaps = Gaps.of(track, points[1:], weights[1:])
        passages.append(_Passage(gaps if sense > 0 else gaps.reversed(), sense, first))
    return passages
