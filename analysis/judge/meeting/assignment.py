"""Assignment of targets to the parts of a coupler curve, where they must be met in order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from grashof.analysis.curves.coupler_curve import Track
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray

_KEPT = 4
_AT_ONCE = 16  # turns of which sums are computed together
_SAGITTA = 5e-4  # of the length of the curve: no piece bulges farther from its chord
_NEAR = 0.1  # rad: guesses closer than this lead to the same place


@dataclass(frozen=True, slots=True)
class Gaps:
    """Targets (N,) beside the M pieces of a track, each on the nearer assembly: arrays (N, M).

    Weighted squared distances, places on the pieces, and assemblies as rows of `track.signs`.
    """

    track: Track
    targets: ComplexArray
    weights: FloatArray
    squared: FloatArray
    share: FloatArray
    side: IntArray
    slack: float  # by which distances may exceed those from the curve, because places are middles of pieces

    @classmethod
    def of(cls, track: Track, targets: ComplexArray, weights: FloatArray, *, middles: bool = False) -> Gaps:
        """Gaps to the chords of pieces, or to their middles.

        Chords are closer, but allow targets on one piece in any order.
        """
        squared, share = _distances(track, targets, middles)
        side = np.argmin(squared, axis=1)[:, None]
        squared, share = (np.take_along_axis(each, side, axis=1)[:, 0] for each in (squared, share))
        slack = middles * float(_chords(track).max()) / 2
        return cls(track, targets, weights, weights[:, None] * squared, share, side[:, 0], slack)

    def to_middles(self) -> Gaps:
        """The same to the middles of pieces."""
        return Gaps.of(self.track, self.targets, self.weights, middles=True)

    def reversed(self) -> Gaps:
        """The same of the targets from the last to the first."""
        squared, share, side = self.squared[::-1], self.share[::-1], self.side[::-1]
        return Gaps(self.track, self.targets[::-1], self.weights[::-1], squared, share, side, self.slack)


@dataclass(frozen=True, slots=True)
class Guess:
    """Driver angles near the best, not going back, with their bounds, (N,) in rad, and assemblies.

    `distance` is the root of the weighted squares from straight pieces, wrong by at most `slack_of`, and too
    small where targets are `crowded`: in the wrong order on a piece.
    """

    theta2: FloatArray
    floor: FloatArray
    ceiling: FloatArray
    assembly: IntArray
    distance: float
    crowded: bool


def ordered_guesses(gaps: Gaps, slack: float, least: float = np.inf) -> list[Guess]:
    """Assignments to pieces that do not go back within one turn, the best first, as of `assigned`.

    Up to a distance that exceeds the least, or a `least` known from elsewhere, by twice the `slack`.
    """

    def most(cost: float) -> float:
        return float((cost**0.5 + 2 * (slack + gaps.slack)) ** 2)

    guesses: list[Guess] = []
    for chosen, cost in zip(*assigned(gaps.squared, most, least**2, cyclic=gaps.track.cyclic), strict=True):
        guess = _guess(gaps, chosen, float(cost))
        if not any(_alike(guess, other) for other in guesses):
            guesses.append(guess)
    return guesses


def slack_of(track: Track, count: int) -> float:
    """Most by which distances of a number of targets from pieces differ from those from the curve."""
    return float(_SAGITTA * _chords(track).sum() * np.sqrt(count))


def _chords(track: Track) -> FloatArray:
    lengths: FloatArray = np.nan_to_num(np.abs(track.end - track.start)).max(axis=0)
    return lengths


def _alike(one: Guess, other: Guess) -> bool:
    apart = np.abs(np.exp(1j * one.theta2) - np.exp(1j * other.theta2)).max()
    return bool(apart < _NEAR and (one.assembly == other.assembly).all())


def nearest_guess(
    track: Track, targets: ComplexArray, valleys: int
) -> tuple[FloatArray, FloatArray, FloatArray, IntArray]:
    """Driver angles in the nearest valleys of each target, bounds and assemblies, each (valleys, N)."""
    squared, share = (each.swapaxes(0, 1) for each in _distances(track, targets, middles=False))
    if track.cyclic:
        before, after = np.roll(squared, 1, axis=2), np.roll(squared, -1, axis=2)
    else:
        wall = np.full_like(squared[:, :, :1], np.inf)
        before = np.concatenate([wall, squared[:, :, :-1]], axis=2)
        after = np.concatenate([squared[:, :, 1:], wall], axis=2)
    depth = np.where((squared <= before) & (squared <= after), squared, np.inf)
    depth = depth.swapaxes(1, 2).reshape(-1, len(targets))
    lowest = np.argsort(depth, axis=0, kind="stable")[:valleys]
    sign, piece = np.divmod(lowest, squared.shape[2])
    part = share[sign, np.arange(len(targets)), piece]
    theta2 = track.low[piece] + part * (track.high - track.low)[piece]
    return theta2, track.floor[piece], track.ceiling[piece], track.signs[sign]


def _distances(track: Track, targets: ComplexArray, middles: bool) -> tuple[FloatArray, FloatArray]:
    """Squared distance from each piece on each assembly, and the place on it; each shape (N, S, M)."""
    chord = track.end - track.start
    offset = targets[:, None, None] - track.start
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (offset * chord.conj()).real / np.abs(chord) ** 2
    share = np.full_like(share, 0.5) if middles else np.clip(np.nan_to_num(share), 0.0, 1.0)
    gap = offset - share * chord
    return np.nan_to_num(gap.real**2 + gap.imag**2, nan=np.inf), share


def assigned(
    costs: FloatArray, most: Callable[[float], float], least: float = np.inf, *, cyclic: bool
) -> tuple[IntArray, FloatArray]:
    """Pieces (C, N) of targets, never going back, and sums (C,) of their costs (N, M), the least first.

    Each is the best of those whose last piece is near its own; up to sums of `most` of the least one, or of a
    `least` known from elsewhere. In a `cyclic` motion pieces are counted on, and no assignment is longer
    than a turn: the last target may repeat the first.
    """
    turn = costs.shape[1]
    chains = _Chains.of(np.concatenate([costs, costs], axis=1) if cyclic else costs)
    sums = chains.sums[-1, -turn:]
    beside = (chains.sums[-1, -turn - 1], sums[0]) if cyclic else (np.inf, np.inf)
    last = _valleys(sums, *beside)
    pieces, found = chains.up_to(last + cyclic * turn), sums[last]
    short = pieces[:, -1] - pieces[:, 0] <= turn
    own = float(found[short].min(initial=np.inf))
    least = min(least, own)
    wanted = found <= most(least)
    if (found[wanted & ~short] < own).any():
        pieces, found = _within_a_turn(costs, sums, most, least)
    else:
        pieces, found = pieces[wanted & short], found[wanted & short]
    order = np.argsort(found, kind="stable")[:_KEPT]
    return pieces[order] - pieces[order, :1] // turn * turn, found[order]


def _valleys(sums: FloatArray, before: float, after: float) -> IntArray:
    """Indices of finite sums (M,) that no neighbour is below, one of a plateau; `before` and `after` all."""
    left, right = np.append(before, sums[:-1]), np.append(sums[1:], after)
    found = np.flatnonzero((sums <= left) & (sums < right))
    return found if found.size or np.isinf(sums).all() else np.argmin(sums, keepdims=True)


def _within_a_turn(
    costs: FloatArray, bounds: FloatArray, most: Callable[[float], float], least: float
) -> tuple[IntArray, FloatArray]:
    """As `assigned`, where longer assignments cost less: `bounds` (M,) by the last piece."""
    turn, around = len(bounds), np.concatenate([costs, costs], axis=1)
    sums, order = np.full(turn, np.inf), np.argsort(bounds, kind="stable")
    for at in range(0, turn, _AT_ONCE):
        first = order[at : at + _AT_ONCE]
        first = first[bounds[first] <= most(least)]
        if not first.size or np.isinf(bounds[first[0]]):
            break
        sums[first] = _least_costs(around, first, turn + 1)
        least = min(least, float(sums[first].min()))
    first = _valleys(sums, sums[-1], sums[0])
    first = first[sums[first] <= most(least)]
    first = first[np.argsort(sums[first], kind="stable")][:_KEPT]
    chains = _Chains.of(around[:, first[:, None] + np.arange(turn + 1)])
    return chains.up_to(np.argmin(chains.sums[-1], axis=-1)) + first[:, None], sums[first]


def _least_costs(around: FloatArray, first: IntArray, length: int) -> FloatArray:
    """Least sums over pieces that never go back, `length` of them from each first one (C,) on; shape (C,).

    `around`, shape (N, L), holds the costs of N targets on the pieces of two turns.
    """
    places = first + np.arange(length)[:, None]
    total = around[0].take(places, mode="wrap")
    for costs in around[1:]:
        np.minimum.accumulate(total, axis=0, out=total)
        total += costs.take(places, mode="wrap")
    least: FloatArray = total.min(axis=0)
    return least


@dataclass(frozen=True, slots=True)
class _Chains:
    """Least sums over pieces that never go back, up to each target (N,) on each piece (L,)."""

    sums: FloatArray  # (N, ..., L)
    before: IntArray  # (N, ..., L): the piece, up to each, with the least sum of a target

    @classmethod
    def of(cls, costs: FloatArray) -> _Chains:
        """The sums of costs (N, ..., L)."""
        sums, least = np.empty_like(costs), np.empty_like(costs)
        sums[0] = costs[0]
        np.minimum.accumulate(sums[0], axis=-1, out=least[0])
        for here in range(1, len(costs)):
            np.add(least[here - 1], costs[here], out=sums[here])
            np.minimum.accumulate(sums[here], axis=-1, out=least[here])
        at_least = np.where(sums == least, np.arange(costs.shape[-1]), 0)
        return cls(sums, np.maximum.accumulate(at_least, axis=-1))

    def up_to(self, last: IntArray) -> IntArray:
        """Pieces (C, N) of the targets, the last on a given one (C,), each in its own row of several."""
        pieces = np.empty((last.size, len(self.sums)), dtype=np.int64)
        pieces[:, -1] = last
        row = () if self.sums.ndim == 2 else (np.arange(last.size),)
        for here in range(pieces.shape[1] - 2, -1, -1):
            pieces[:, here] = self.before[(here, *row, pieces[:, here + 1])]
        return pieces


def _guess(gaps: Gaps, chosen: IntArray, cost: float) -> Guess:
    track = gaps.track
    turns, piece = np.divmod(chosen, len(track.low))
    target = np.arange(len(chosen))
    part = gaps.share[target, piece]
    theta2 = track.low[piece] + part * (track.high - track.low)[piece] + TURN * turns
    # Within a piece the targets may be in the wrong order.
    ordered = np.minimum(np.maximum.accumulate(theta2), theta2[0] + TURN)
    assembly = track.signs[gaps.side[target, piece]]
    floor, ceiling = (bound[piece] + TURN * turns for bound in (track.floor, track.ceiling))
    crowded = bool((ordered != theta2).any())
    return Guess(ordered, floor, ceiling, assembly, cost**0.5, crowded)
