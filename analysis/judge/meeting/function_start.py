"""Where the driver of a function generator begins: where it errs least, and transmits well enough."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import TypeAlias

import numpy as np

from grashof.analysis.judge.meeting.inputs import Input
from grashof.analysis.judge.meeting.task_motion import valleys
from grashof.analysis.mechanism.closing import STEADY, close, move, operands_of
from grashof.analysis.mechanism.mobility import closes_everywhere, driver_ranges
from grashof.analysis.mechanism.position import Position, solve_position
from grashof.analysis.mechanism.transmission import worst_transmission
from grashof.problems import Linkage, ProblemError, Task
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray, IntArray, turned_from

Misses: TypeAlias = Callable[[FloatArray, int], FloatArray]

_STARTS = 720  # driver angles at the first pair that are tried, over the range of the driver
_VALLEYS = 5
_NEAR = 17  # places about the lowest ones of valleys, ever closer
_CLOSE = 1e-10  # rad, between starts: no closer
_SAMPLES, _FINE = 97, 385  # of the range, where the greatest error decides: in valleys, and at their bottoms
_SAME = 1 + 1e-9
_STEEP = 4.0  # times the steps of a value between places that were tried: it falls by no more between them
_BETWEEN = 0.25  # share of the change of a curve among the places by which it may be higher between them
_NOTHING = 1e-12  # rad, or shares of the travel: starts whose errors differ by less are as good
_SYMMETRIC = 1e-6  # share of r1: greatest distance from the mirror image at which a linkage is placed by it
_ROUNDING = 1e-9  # rad, of driver ranges and transmission angles


@dataclass(frozen=True, slots=True)
class Beginning:
    """Driver angle at the first pair of a function, in rad, the sense of the driver, and its input."""

    theta2: float
    direction: int
    by: Input

    def driver_turns(self, inputs: FloatArray) -> FloatArray:
        """Rotation of the driver from the first pair at inputs (N,), in its sense, rad."""
        return self.by.turned(np.array(self.theta2), self.direction, inputs)

    def driver_angles(self, inputs: FloatArray) -> FloatArray:
        """Driver angles at inputs (N,), rad."""
        return self.theta2 + self.direction * self.driver_turns(inputs)


def moved_output(task: Task, state: Position, direction: int, *, unwrapped: bool = True) -> FloatArray:
    """Output of a linkage in its positions: rotation in the sense of the driver, or travel of the slide."""
    if task.travels:
        return state.travel
    turned = state.angles[task.turning_link(state.linkage.mechanism)]
    moved: FloatArray = way_of(task, direction) * (np.unwrap(turned) if unwrapped else turned)
    return moved


def output_rate(linkage: Linkage, task: Task, theta2: FloatArray) -> FloatArray:
    """Derivative of the output, an angle or a travel, by the driver angle; not finite in dead positions."""
    loops, _ = close(linkage.mechanism, operands_of(linkage), theta2)
    moving, turns = move(loops, STEADY, dead_below=0.0, last_too=True)
    link = turns[task.turning_link(linkage.mechanism)]
    rate: FloatArray = moving[-1].orders[0].travel if task.travels else link.tangential[0]
    return rate


def generated_rates(
    linkage: Linkage, task: Task, by: Input, starts: FloatArray, direction: int, inputs: FloatArray
) -> FloatArray:
    """Leverage ratios d(output)/d(input) by starts (...) at inputs (R,), with the sign of the output."""
    theta2 = starts[..., None] + direction * by.turned(starts, direction, inputs)
    rates = output_rate(linkage, task, theta2) * by.rate(starts, direction, inputs)
    # Rotations of the output and of link 2 count in the sense of the driver.
    return (direction if task.travels else 1) * rates


def senses_of(task: Task) -> tuple[int, ...]:
    """The senses in which the output may follow the function."""
    return (1, -1) if task.sense == "either" else (1,)


def way_of(task: Task, direction: int) -> int:
    """Sense in which an output counts: a rotation in that of the driver, a travel along the slide."""
    return 1 if task.travels else direction


def begins(
    linkage: Linkage,
    task: Task,
    by: Input,
    exact: bool,
    theta2_start: float | None,
    directions: tuple[int, ...] = (1, -1),
    transmission: float = 0.0,
    misses: Misses | None = None,
) -> Beginning | None:
    """Where the driver begins so that a single linkage errs least; None where it covers no such range.

    The errors at the pairs count if `exact`; unless the start is given, from there on the transmission angle
    is at least `transmission` (rad), and `misses`, of starts (S,) in a sense, are zero. ProblemError for a
    linkage whose output does not move as the task's does.
    """
    if refused := task.impossible(linkage.mechanism.word):
        raise ProblemError(refused)
    if task.travels == linkage.mechanism.loops[-1].pinned:
        way = "slides" if task.travels else "turns"
        raise ProblemError(
            f"mechanism {linkage.mechanism.word} has no output that {way}; the function requires one"
        )
    search = _Search(linkage, task, by, exact or task.norm == "rms", transmission)
    if theta2_start is None:
        found = search.lowest(directions)
        if misses is not None and found:
            _, direction, start = min(found)
            if misses(np.array([start]), direction)[0] > 0:
                kept = [one for one in found if not misses(np.array([one[2]]), one[1])[0] > 0]
                found = kept + replace(search, misses=misses).lowest(directions)
    else:
        given = [(search.value(theta2_start, direction), direction, theta2_start) for direction in directions]
        found = sorted(one for one in given if np.isfinite(one[0]))[:1]
    if not found:
        return None
    least = min(value for value, _, _ in found)
    alike = least * _SAME + _NOTHING * task.output_unit
    _, direction, start = next(one for one in found if one[0] <= alike)
    return Beginning(start, direction, by)


def begins_mirrored(linkage: Linkage, task: Task, by: Input, directions: tuple[int, ...]) -> Beginning | None:
    """Beginning of a four-bar that is its own mirror image at a driver rotation; None where it is nowhere so.

    There the coupler is parallel to the ground: r1 = 2 r2 cos(theta2 - theta1) + r3, or - r3. Of several such
    positions of its assembly, the one of least error.
    """
    found: list[tuple[float, int, float]] = []
    search = _Search(linkage, task, by, task.norm == "rms", 0.0)
    r1, r2, r3, _ = (float(length) for length in linkage.lengths)
    for along in (r3, -r3):
        cosine = (r1 - along) / (2 * r2)
        if not abs(cosine) <= 1:
            continue
        for side, direction in product((1, -1), directions):
            at = float(linkage.theta1) + side * float(np.arccos(cosine))
            if off_mirror(linkage, at) <= _SYMMETRIC * r1:
                start = at - direction * task.mirror_turn
                value = float(search.value(start, direction))
                found += [(value, direction, start)] if np.isfinite(value) else []
    if not found:
        return None
    _, direction, start = min(found)
    return Beginning(start, direction, by)


def off_mirror(linkage: Linkage, theta2: float) -> float:
    """Distance of B from the mirror image of A about the perpendicular bisector of the ground link."""
    state = solve_position(linkage, theta2)
    o2, o4, a, b = (complex(*place) for place in (linkage.o2, linkage.o4, state.a, state.b))
    ahead = (o4 - o2) / abs(o4 - o2)
    image = o4 - ahead * ((a - o2) / ahead).conjugate()
    return float(np.nan_to_num(abs(b - image), nan=np.inf))


@dataclass(frozen=True, slots=True)
class _Search:
    """Least error over the driver angle at the first pair."""

    linkage: Linkage
    task: Task
    by: Input
    squares: bool
    transmission: float
    misses: Misses | None = None  # that have to be zero

    def lowest(self, directions: Sequence[int]) -> list[tuple[float, int, float]]:
        """Least errors with their senses and starts, of the lowest valleys."""
        lowest = sorted(valley for direction in directions for valley in self.valleys(direction))
        return self.bottoms(lowest[:_VALLEYS])

    def values(self, starts: FloatArray, direction: int, samples: int = _FINE) -> FloatArray:
        """RMS or greatest error for first angles (S,); infinite where a start is not allowed."""
        if not self.squares:
            return self._highest(self._crests(starts, direction, samples)[0], starts, direction)
        task, share = self.task, self.task.weights / self.task.weights.sum()
        moved = self._moved(starts, direction, task.inputs, unwrapped=False)
        best = np.full(len(starts), np.inf)
        for sense in senses_of(self.task):
            off = _from_first(task, moved - sense * task.outputs)
            off = off - (off @ share)[:, None]
            best = np.fmin(best, np.nan_to_num(np.sqrt(off**2 @ share), nan=np.inf))
        return self._allowed(best, starts, direction)

    def _moved(
        self, starts: FloatArray, direction: int, inputs: FloatArray, *, unwrapped: bool
    ) -> FloatArray:
        """Outputs (S, N) at inputs (N,) for first angles (S,)."""
        turned = self.by.turned(starts, direction, inputs)
        state = solve_position(self.linkage, starts[:, None] + direction * turned)
        return moved_output(self.task, state, direction, unwrapped=unwrapped)

    def _crests(
        self, starts: FloatArray, direction: int, samples: int, some: IntArray | None = None
    ) -> tuple[FloatArray, bool]:
        """The error and its negative about each inner sample, for each sense, shape (T, S, K).

        The greatest of three samples, or of the parabola through them if that has a crest; of `some` (K,) of
        the inner samples only where no output jumps by a turn. Last, whether one did.
        """
        inputs = np.linspace(*self.task.span, samples)
        wanted = self.task.output(inputs)
        beside: list[slice | IntArray] = [slice(k, samples - 2 + k) for k in range(3)]
        if some is not None:
            places = np.unique(np.concatenate([some, some + 1, some + 2]))
            inputs, wanted = inputs[places], wanted[places]
            beside = [np.searchsorted(places, some + k) for k in range(3)]
        moved = self._moved(starts, direction, inputs, unwrapped=some is None)
        off = [moved - sense * wanted for sense in senses_of(self.task)]
        crests = [_crest(*(sign * each[:, k] for k in beside)) for each in off for sign in (1, -1)]
        return np.stack(crests), not self.task.travels and bool((np.abs(moved) > np.pi).any())

    def _highest(self, crests: FloatArray, starts: FloatArray, direction: int) -> FloatArray:
        """Greatest errors (S,) of the best sense, as `values`."""
        highest = crests.max(axis=-1)
        best = np.nan_to_num((highest[::2] + highest[1::2]) / 2, nan=np.inf).min(axis=0)
        return self._allowed(best, starts, direction)

    def _allowed(self, values: FloatArray, starts: FloatArray, direction: int) -> FloatArray:
        """Values (S,), infinite below the least transmission angle, and where limits are missed."""
        if self.misses is not None:
            values = np.where(self.misses(starts, direction) > 0, np.inf, values)
        if not self.transmission > 0:
            return values
        ends = starts[:, None] + direction * self.by.turned(starts, direction, np.array(self.task.span))
        worst = np.full(len(starts), -1.0)
        known = np.isfinite(ends).all(axis=1)
        worst[known] = worst_transmission(self.linkage, *ends[known].T)
        return np.where(worst >= self.transmission - _ROUNDING, values, np.inf)

    def value(self, start: float, direction: int) -> float:
        return float(self.values(np.array([start]), direction)[0])

    def valleys(self, direction: int) -> list[tuple[float, int, float]]:
        """The lowest of their neighbours, over all that the driver can reach."""
        found = []
        for low, high in self._ranges(direction):
            starts = np.linspace(low, high, max(8, int(np.ceil(_STARTS * (high - low) / TURN))) + 1)
            value = self.values(starts, direction, _SAMPLES)
            found += [(float(value[k]), direction, float(starts[k])) for k in valleys(value)]
            found += self._narrow(starts, direction)
        return found

    def _narrow(self, starts: FloatArray, direction: int) -> list[tuple[float, int, float]]:
        """Starts between even ones where alone limits are kept, with their errors."""
        if self.misses is None:
            return []
        missed = self.misses(starts, direction)
        at, span = starts[[k for k in valleys(missed) if missed[k] > 0]], TURN / _STARTS
        share = np.linspace(-1, 1, _NEAR)
        while span > _CLOSE and at.size:
            near = at[:, None] + span * share
            lowest = self.misses(near.ravel(), direction).reshape(near.shape).argmin(axis=1)
            at = np.take_along_axis(near, lowest[:, None], axis=1)[:, 0]
            span *= 2 / (_NEAR - 1)
        return [
            (value, direction, start)
            for value, start in zip(self.values(at, direction).tolist(), at.tolist(), strict=True)
            if np.isfinite(value)
        ]

    def _ranges(self, direction: int) -> list[tuple[float, float]]:
        """Driver angles at the first pair from which the range is possible."""
        ranges = driver_ranges(self.linkage, self.transmission).tolist()
        if closes_everywhere(self.linkage) and ranges[0][1] - ranges[0][0] >= TURN:
            return list(self.by.starts_of_turn((ranges[0][0], ranges[0][1]), direction, self.task.span))
        span = self.task.span
        return [
            found
            for low, high in ranges
            if np.isfinite(high - low)
            for found in self.by.starts((low, high), direction, span)
        ]

    def bottoms(self, valleys: Sequence[tuple[float, int, float]]) -> list[tuple[float, int, float]]:
        """The same, with their bottoms in place of the starts within them."""
        found = list[tuple[float, int, float]]()
        for direction in dict.fromkeys(direction for _, direction, _ in valleys):
            starts = np.array([start for _, way, start in valleys if way == direction])
            known = min((value for value, _, _ in found), default=np.inf)
            for at in self._narrowed(starts, direction, known).tolist():
                bottom = self._newton(at, direction) if self.squares else at
                found.append((self.value(bottom, direction), direction, bottom))
        return found

    def _narrowed(self, starts: FloatArray, direction: int, known: float) -> FloatArray:
        """The lowest places within a step of some starts, which need not be smooth there, shape (at most S,).

        Those are left out that are higher than others, or than a known value, however they fall between the
        places that were tried.
        """
        at, span = starts, TURN / _STARTS
        share, some = np.linspace(-1, 1, _NEAR), None
        while span > _CLOSE and at.size:
            near = at[:, None] + span * share  # its middle is the lowest so far
            if self.squares:
                values = self.values(near.ravel(), direction).reshape(near.shape)
            else:
                crests, jump = self._crests(near.ravel(), direction, _FINE, some)
                values = self._highest(crests, near.ravel(), direction).reshape(near.shape)
                if not jump:
                    counts = _that_count(crests.reshape(len(crests), *near.shape, -1))
                    some = np.flatnonzero(counts) if some is None else some[counts]
            lowest = np.where(values.min(axis=1) < values[:, _NEAR // 2], values.argmin(axis=1), _NEAR // 2)
            at, least = (np.take_along_axis(each, lowest[:, None], axis=1)[:, 0] for each in (near, values))
            known = min(known, float(least.min()))
            at = at[_least_between(values) <= known * _SAME + _NOTHING * self.task.output_unit]
            span *= 2 / (_NEAR - 1)
        return at

    def _newton(self, at: float, direction: int) -> float:
        """Gauss-Newton: squares alone give half of the digits."""
        share = self.task.weights / self.task.weights.sum()
        way = way_of(self.task, direction)
        for _ in range(6):
            turned = self.by.turned(np.array(at), direction, self.task.inputs)
            state = solve_position(self.linkage, at + direction * turned)
            rate = output_rate(self.linkage, self.task, state.theta2)
            rate = rate * self.by.moved_by_start(at, direction, self.task.inputs)
            if not np.isfinite(rate).all():  # a dead position
                break
            output = moved_output(self.task, state, direction, unwrapped=False)
            off = min(
                (
                    _from_first(self.task, output - sense * self.task.outputs)
                    for sense in senses_of(self.task)
                ),
                key=lambda each: float(np.nan_to_num(share @ (each - share @ each) ** 2, nan=np.inf)),
            )
            off, rate = off - share @ off, way * (rate - share @ rate)
            curvature = float(share @ rate**2)
            if not curvature > 0:
                break
            moved = at - float(share @ (off * rate)) / curvature
            if not self.value(moved, direction) < self.value(at, direction):
                break
            at = moved
        return at


def _crest(before: FloatArray, here: FloatArray, after: FloatArray) -> FloatArray:
    """The greatest of three even samples, or of the parabola through them if that has a crest."""
    crest = (here >= before) & (here >= after)
    bend = np.where(crest, 2 * here - before - after, 0.0)
    rise = np.divide((after - before) ** 2, 8 * bend, out=np.zeros_like(bend), where=bend > 0)
    found: FloatArray = np.maximum(np.maximum(before, after), here + rise)
    return found


def _that_count(crests: FloatArray) -> BoolArray:
    """Which of several curves (T, V, S, K) may be the greatest of K somewhere among, or between, S starts."""
    reach, least = np.fmax.reduce(crests, axis=2), np.fmin.reduce(crests, axis=2)
    highest = np.fmin.reduce(crests.max(axis=-1), axis=2)
    counts: BoolArray = (reach + _BETWEEN * (reach - least) >= highest[..., None]).any(axis=(0, 1))
    return counts


def _least_between(values: FloatArray) -> FloatArray:
    """Bounds (V,) of the values at, and between, S starts each, (V, S); no bound where few are finite."""
    finite = np.isfinite(values)
    known = np.where(finite, values, 0.0)
    steps = np.where(finite[:, 1:] & finite[:, :-1], np.abs(np.diff(known)), 0.0).max(axis=1)
    least = values.min(axis=1) - _STEEP * steps
    return np.where(finite.sum(axis=1) > 2, least, -np.inf)


def _from_first(task: Task, outputs: FloatArray) -> FloatArray:
    """Differences from the first (last axis), those of angles moved into [-pi, pi)."""
    off: FloatArray = outputs - outputs[..., :1]
    return off if task.travels else turned_from(off, 0.0)
