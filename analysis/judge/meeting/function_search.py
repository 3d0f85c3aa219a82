"""Where the driver of a function generator begins so that it errs least, over all that it can reach."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from grashof.analysis.judge.meeting.generated import moved_output, output_rate, senses_of, way_of
from grashof.analysis.judge.meeting.inputs import Input
from grashof.analysis.judge.meeting.task_motion import valleys
from grashof.analysis.mechanism.mobility import closes_everywhere, driver_ranges
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.mechanism.transmission import worst_transmission
from grashof.analysis.numerics.brackets import closer, five
from grashof.analysis.numerics.peaks import crests
from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray, IntArray, Limits, turned_from

Misses: TypeAlias = Callable[[FloatArray, int], FloatArray]

SAME = 1 + 1e-9  # times the least error: as good
NOTHING = 1e-12  # rad, or shares of the travel: starts whose errors differ by less are as good
_STARTS = 720  # driver angles at the first pair that are tried, over the range of the driver
_VALLEYS = 5
_COARSE = 1.05  # times the least error at some samples: the greatest that may be as low at its bottom
_NEAR = 17  # places about the lowest ones of valleys
_REACH = 2 * TURN / _STARTS  # from the lowest start that was tried to the bottom
_CLOSE = 1e-10  # rad, between starts: no closer
_ROUNDS = 20  # of closer places; three suffice where the error has no steps
_SAMPLES, _FINE = 97, 385  # of the range, where the greatest error decides: in valleys, and at their bottoms
_STEEP = 4.0  # times the steps of a value between places that were tried: it falls by no more between them
_BETWEEN = 0.25  # share of the change of a curve among the places by which it may be higher between them
_ROUNDING = 1e-9  # rad, of driver ranges and transmission angles


class Valley(NamedTuple):
    """A driver angle at the first pair, in rad, its error, the senses of driver and output, and the range."""

    value: float
    direction: int
    start: float
    sense: int
    reach: Limits


@dataclass(frozen=True, slots=True)
class Search:
    """Least error over the driver angle at the first pair."""

    linkage: Linkage
    task: Task
    by: Input
    squares: bool
    transmission: float
    misses: Misses | None = None  # that have to be zero

    def lowest(self, directions: Sequence[int]) -> list[Valley]:
        """The bottoms of the lowest valleys."""
        valleys = [valley for direction in directions for valley in self._valleys(direction)]
        if not valleys:
            return []
        most = min(valley.value for valley, _ in valleys) * _COARSE
        lowest = sorted(valley for valley, least in valleys if least <= most)
        return self._bottoms(lowest[:_VALLEYS])

    def at(self, start: float, direction: int) -> Valley:
        """One start, in the sense of least error."""
        return min(
            Valley(self._value(start, direction, sense), direction, start, sense, (start, start))
            for sense in senses_of(self.task)
        )

    def _values(self, starts: FloatArray, direction: int, sense: int) -> FloatArray:
        """RMS or greatest error for first angles (S,); infinite where a start is not allowed."""
        return self._allowed(self._unlimited(starts, direction, sense), starts, direction)

    def _unlimited(self, starts: FloatArray, direction: int, sense: int, samples: int = _FINE) -> FloatArray:
        """The same without limits; NaN where the linkage does not close."""
        if not self.squares:
            return np.asarray(self._errors(starts, direction, sense, samples)[0].max(axis=(0, -1)))
        task, share = self.task, self.task.weights / self.task.weights.sum()
        moved = self._moved(starts, direction, task.inputs, unwrapped=False)
        off = _from_first(task, moved - sense * task.outputs)
        off = off - (off @ share)[:, None]
        return np.asarray(np.sqrt(off**2 @ share))

    def _moved(
        self, starts: FloatArray, direction: int, inputs: FloatArray, *, unwrapped: bool
    ) -> FloatArray:
        """Outputs (S, N) at inputs (N,) for first angles (S,)."""
        turned = self.by.turned(starts, direction, inputs)
        state = solve_position(self.linkage, starts[:, None] + direction * turned)
        return moved_output(self.task, state, direction, unwrapped=unwrapped)

    def _errors(
        self, starts: FloatArray, direction: int, sense: int, samples: int, some: IntArray | None = None
    ) -> tuple[FloatArray, bool]:
        """The error from its middle, and its negative, about each inner sample, shape (2, S, K).

        The greatest of three samples, or of the parabola through them if that has a crest; of `some` (K,) of
        the inner samples only where no output jumps by a turn. Last, whether one did.
        """
        some = np.arange(samples - 2) if some is None else some
        places = np.unique(np.concatenate([some, some + 1, some + 2]))
        inputs = np.linspace(*self.task.span, samples)[places]
        moved = self._moved(starts, direction, inputs, unwrapped=len(some) == samples - 2)
        off = (moved - sense * self.task.output(inputs)).T
        before, here, after = (off[np.searchsorted(places, some + k)].T for k in range(3))
        # A crest may lie beside the first or last sample.
        reach = np.where((some == 0) | (some == samples - 3), 2, 1)
        above, below = crests(before, here, after, reach), crests(-before, -here, -after, reach)
        zero = (above.max(axis=-1, keepdims=True) - below.max(axis=-1, keepdims=True)) / 2
        jumps = not self.task.travels and bool((np.abs(moved) > np.pi).any())
        return np.stack([above - zero, below + zero]), jumps

    def _allowed(self, values: FloatArray, starts: FloatArray, direction: int) -> FloatArray:
        """Values (..., S), infinite where there are none, transmission is too low, or limits are missed."""
        values = np.nan_to_num(values, nan=np.inf)
        if self.misses is not None:
            values = np.where(self.misses(starts, direction) > 0, np.inf, values)
        if not self.transmission > 0:
            return values
        ends = starts[:, None] + direction * self.by.turned(starts, direction, np.array(self.task.span))
        worst = np.full(len(starts), -1.0)
        known = np.isfinite(ends).all(axis=1)
        worst[known] = worst_transmission(self.linkage, *ends[known].T)
        return np.where(worst >= self.transmission - _ROUNDING, values, np.inf)

    def _valleys(self, direction: int) -> Iterator[tuple[Valley, float]]:
        """The lowest of their neighbours, over all that the driver can reach; bounds of errors there."""
        for reach in self._ranges(direction):
            starts, values = self._tried(*reach, direction)
            for sense, errors in zip(senses_of(self.task), values, strict=True):
                at = valleys(errors)
                beside = np.clip(at[:, None] + np.arange(-1, 2), 0, len(starts) - 1)
                for k, bound in zip(at, _least_between(errors[beside]).tolist(), strict=True):
                    yield Valley(float(errors[k]), direction, float(starts[k]), sense, reach), bound
            yield from ((valley, -np.inf) for valley in self._narrow(starts, direction, reach))

    def _tried(self, low: float, high: float, direction: int) -> tuple[FloatArray, FloatArray]:
        """Starts (S,) from low to high, and the error of each at some samples, of each sense (T, S)."""
        steps = max(8, int(np.ceil(_STARTS * (high - low) / TURN)))
        if steps > 8 and not self.squares and self.by.even:
            return self._at_common_angles(low, high, direction)
        starts = np.linspace(low, high, steps + 1)
        found = [self._unlimited(starts, direction, sense, _SAMPLES) for sense in senses_of(self.task)]
        return starts, self._allowed(np.stack(found), starts, direction)

    def _at_common_angles(self, low: float, high: float, direction: int) -> tuple[FloatArray, FloatArray]:
        """The same where samples of one start are at driver angles of samples of others."""
        inputs, step = np.linspace(*self.task.span, _SAMPLES, retstep=True)
        parts = int(np.ceil(step / (TURN / _STARTS)))
        step = step / parts
        count = int((high - low) / step) + 1
        first = low + min(direction * self.task.span[0], direction * self.task.span[1])
        every = solve_position(self.linkage, first + step * np.arange(count + parts * (_SAMPLES - 1)))
        output = moved_output(self.task, every, direction, unwrapped=False)
        if not self.task.travels:
            closed = np.isfinite(output)
            output[closed] = np.unwrap(output[closed])
        moved = sliding_window_view(output, parts * (_SAMPLES - 1) + 1)[:, ::parts][:, ::direction]
        starts, found = low + step * np.arange(count), list[FloatArray]()
        for sense in senses_of(self.task):
            off = moved - sense * self.task.output(inputs)
            found.append((off.max(axis=1) - off.min(axis=1)) / 2)
        return starts, self._allowed(np.stack(found), starts, direction)

    def _narrow(self, starts: FloatArray, direction: int, reach: Limits) -> list[Valley]:
        """Starts between even ones where alone limits are kept."""
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
            Valley(value, direction, start, sense, reach)
            for sense in senses_of(self.task)
            for value, start in zip(self._values(at, direction, sense).tolist(), at.tolist(), strict=True)
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

    def _bottoms(self, valleys: Sequence[Valley]) -> list[Valley]:
        """The same, with their bottoms in place of the starts within them."""
        found = list[Valley]()
        for direction, sense in dict.fromkeys((each.direction, each.sense) for each in valleys):
            group = [each for each in valleys if (each.direction, each.sense) == (direction, sense)]
            known = min((each.value for each in found), default=np.inf)
            for at, valley in self._narrowed(group, known):
                bottom = self._newton(at, direction, sense) if self.squares else at
                tried = np.array([bottom, valley.start])
                values = self._values(tried, direction, sense)
                lowest = int(values.argmin())
                found.append(valley._replace(value=float(values[lowest]), start=float(tried[lowest])))
        return found

    def _value(self, start: float, direction: int, sense: int) -> float:
        return float(self._values(np.array([start]), direction, sense)[0])

    def _narrowed(self, group: Sequence[Valley], known: float) -> list[tuple[float, Valley]]:
        """The bottoms of valleys of the same senses, which need not be smooth there.

        Those are left out that are higher than others, or than a known value, however they fall between the
        places that were tried.
        """
        direction, sense = group[0].direction, group[0].sense
        low, high = np.array([each.reach for each in group]).T[..., None]
        places = np.array([[each.start] for each in group]) + _REACH * np.linspace(-1, 1, _NEAR)
        places, some = np.clip(places, low, high), None
        found = list[tuple[float, Valley]]()
        for _ in range(_ROUNDS):
            if self.squares:
                values = self._values(places.ravel(), direction, sense).reshape(places.shape)
            else:
                errors, jumps = self._errors(places.ravel(), direction, sense, _FINE, some)
                values = self._allowed(errors.max(axis=(0, -1)), places.ravel(), direction)
                values = values.reshape(places.shape)
                if not jumps:
                    counts = _that_count(errors.reshape(2, *places.shape, -1), places, values)
                    some = np.flatnonzero(counts) if some is None else some[counts]
            known = min(known, float(values.min()))
            kept = _least_between(values) <= known * SAME + NOTHING * self.task.output_unit
            lowest = np.take_along_axis(places, values.argmin(axis=1)[:, None], axis=1)[kept, 0]
            group = [valley for valley, is_kept in zip(group, kept, strict=True) if is_kept]
            places = closer(places[kept], values[kept])
            close = np.ptp(places, axis=1) <= _CLOSE
            found += [(lowest[k], group[k]) for k in np.flatnonzero(close)]
            group, places, lowest = [group[k] for k in np.flatnonzero(~close)], places[~close], lowest[~close]
            if not group:
                break
        return [(float(at), valley) for at, valley in [*found, *zip(lowest, group, strict=True)]]

    def _newton(self, at: float, direction: int, sense: int) -> float:
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
            off = _from_first(self.task, output - sense * self.task.outputs)
            off, rate = off - share @ off, way * (rate - share @ rate)
            curvature = float(share @ rate**2)
            if not curvature > 0:
                break
            moved = at - float(share @ (off * rate)) / curvature
            if not self._value(moved, direction, sense) < self._value(at, direction, sense):
                break
            at = moved
        return at


def _that_count(crests: FloatArray, places: FloatArray, values: FloatArray) -> BoolArray:
    """Which of K curves (2, V, S, K) may be the greatest about the lowest of S places, by values (V, S)."""
    near = five(places, values.argmin(axis=1)[:, None])[None, :, 1:4, None]
    crests = np.take_along_axis(crests, near, axis=2)
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
