"""Assignment of targets to the parts of a coupler curve, where they must be met in order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from grashof.analysis.curves.coupler_curve import Track
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray

_KEPT = 4
_STRIDE, _MOST_CUTS = 5, 72  # pieces from cut to cut; more of them where there are very many pieces
_DECIDE = 64  # targets, evenly spread, that decide where a turn is cut
_THINNED = (32, 8, 1)  # every so many of these bound the sums of cuts, before all count
_SAGITTA = 5e-4  # of the length of the curve: no piece bulges farther from its chord
_NEAR = 0.1  # rad: guesses closer than this lead to the same place
_ALIKE = 1e-6  # assignments whose costs differ by a smaller share are the same one


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


def ordered_guesses(
    track: Track,
    targets: ComplexArray,
    weights: FloatArray,
    slack: float,
    least: float = np.inf,
    *,
    middles: bool = False,
) -> list[Guess]:
    """Assignments of targets (N,) to pieces that do not go back within one turn, the best first.

    By dynamic programming; with `middles` distances are from the middle of a piece, otherwise from its chord,
    which is closer but allows targets on one piece in any order. None is missing whose distance exceeds the
    best one's, or `least`, by less than twice the `slack`.
    """
    by_side = _distances(track, targets, middles)
    side = np.argmin(by_side[0], axis=1)
    squared, share = (np.take_along_axis(each, side[:, None], axis=1)[:, 0] for each in by_side)
    squared = weights[:, None] * squared
    if not track.cyclic:
        chosen, costs = assigned(squared[:, :, None])
        return [_guess(track, chosen[:, 0], share, side, float(costs[0]))] if np.isfinite(costs[0]) else []
    slack += middles * float(_chords(track).max()) / 2 * len(targets) ** 0.5
    chosen, costs, cuts = assigned_around(squared, lambda cost: (cost**0.5 + 2 * slack) ** 2, least**2)
    guesses: list[Guess] = []
    for number, cut in enumerate(cuts):
        guess = _guess(track, chosen[:, number] + cut, share, side, float(costs[number]))
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
    squared, share = (each.swapaxes(0, 1) for each in _distances(track, targets))
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


def _distances(track: Track, targets: ComplexArray, middles: bool = False) -> tuple[FloatArray, FloatArray]:
    """Squared distance from each piece on each assembly, and the place on it; each shape (N, S, M)."""
    chord = track.end - track.start
    offset = targets[:, None, None] - track.start
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (offset * chord.conj()).real / np.abs(chord) ** 2
    share = np.full_like(share, 0.5) if middles else np.clip(np.nan_to_num(share), 0.0, 1.0)
    gap = offset - share * chord
    return np.nan_to_num(gap.real**2 + gap.imag**2, nan=np.inf), share


def _least_costs(around: FloatArray, cuts: IntArray, length: int) -> FloatArray:
    """Least sums over pieces that never go back, `length` of them from each cut (C,) on; shape (C,).

    `around`, shape (N, L), holds the costs of N targets on the pieces of two turns or more.
    """
    places = cuts + np.arange(length)[:, None]
    total = around[0][places]
    for squared in around[1:]:
        np.minimum.accumulate(total, axis=0, out=total)
        total += squared[places]
    least: FloatArray = total.min(axis=0)
    return least


def assigned(windows: FloatArray) -> tuple[IntArray, FloatArray]:
    """Pieces (N, C), never going back, and least sums (C,) of costs (N, L, C) of N targets on L pieces."""
    if not windows.size:
        return np.empty((len(windows), 0), dtype=np.int64), np.empty(0)
    totals = np.empty(windows.shape)
    totals[0] = windows[0]
    for index, squared in enumerate(windows[1:], start=1):
        totals[index] = np.minimum.accumulate(totals[index - 1], axis=0) + squared
    place = np.arange(windows.shape[1])[:, None]
    chosen = np.empty((len(windows), windows.shape[2]), dtype=np.int64)
    last = np.full(windows.shape[2], windows.shape[1])
    for index in range(len(windows) - 1, -1, -1):
        last = np.argmin(np.where(place <= last, totals[index], np.inf), axis=0)
        chosen[index] = last
    return chosen, totals[-1].min(axis=0)


def assigned_around(
    squared: FloatArray, most: Callable[[float], float], least: float = np.inf
) -> tuple[IntArray, FloatArray, IntArray]:
    """The best assignments of N targets to the M pieces of a turn, which is cut open somewhere.

    Pieces (N, C), counted from the cut on up to M, which is the first one again; their sums (C,), the least
    first; and the cuts (C,). Up to sums of `most` of the least one, or of a `least` known from elsewhere,
    others may be missing. A turn is cut first at every few pieces, all at once, then at every piece after the
    best; of many targets some decide where.
    """
    count, some = squared.shape[1], np.unique(np.linspace(0, len(squared) - 1, _DECIDE).round().astype(int))
    stride = max(_STRIDE, count // _MOST_CUTS)
    around = np.concatenate([squared, squared, squared[:, :stride]], axis=1)
    # One piece more than the turn has: the last target may repeat the first.
    sums = _Sums(around[some], count + 1, float(np.delete(squared, some, axis=0).min(axis=1).sum()), most)
    cuts, least = sums.best(np.arange(0, count, stride), stride - 1, least)
    cuts, _ = sums.best(np.unique((cuts[:, None] + np.arange(stride)) % count), 0, least)
    chosen, costs = assigned(around[:, cuts + np.arange(count + 1)[:, None]])
    order = np.argsort(costs, kind="stable")
    return chosen[:, order], costs[order], cuts[order]


@dataclass(frozen=True, slots=True)
class _Sums:
    """Least sums of costs from cuts on."""

    around: FloatArray  # (N, L): costs of the targets that decide, on the pieces of two turns and more
    turn: int  # pieces from a cut on
    rest: float  # least costs of the other targets
    most: Callable[[float], float]  # sum that is wanted, of the least one

    def best(self, cuts: IntArray, wider: int, least: float) -> tuple[IntArray, float]:
        """The cuts with the least sums, one for each sum, the best first; and the least sum of a turn.

        Sums from some pieces more than a turn are lower bounds for that many cuts that follow, too; so are
        those of fewer targets. Cuts are left out as soon as their bounds exceed what is wanted.
        """
        nearest, costs = self.around.min(axis=1), np.empty(0)
        for step in _THINNED:
            if not cuts.size:
                break
            left = self.rest + float(np.delete(nearest, slice(None, None, step)).sum())
            costs = _least_costs(self.around[::step], cuts, self.turn + wider) + left
            best = cuts[np.argmin(costs)][None]
            least = min(least, float(_least_costs(self.around, best, self.turn)[0]) + self.rest)
            near = np.isfinite(costs) & (costs <= self.most(least))
            cuts, costs = cuts[near], costs[near]
        order = np.argsort(costs, kind="stable")
        ranked = costs[order]
        new = np.diff(ranked, prepend=-np.inf) > _ALIKE * (ranked + ranked[:1])
        return cuts[order][new][:_KEPT], least


def _guess(track: Track, chosen: IntArray, share: FloatArray, side: IntArray, cost: float) -> Guess:
    turns, piece = np.divmod(chosen, len(track.low))
    target = np.arange(len(chosen))
    part = share[target, piece]
    theta2 = track.low[piece] + part * (track.high - track.low)[piece] + TURN * turns
    # Within a piece the targets may be in the wrong order.
    ordered = np.minimum(np.maximum.accumulate(theta2), theta2[0] + TURN)
    assembly = track.signs[side[target, piece]]
    floor, ceiling = (bound[piece] + TURN * turns for bound in (track.floor, track.ceiling))
    crowded = bool((ordered != theta2).any())
    return Guess(ordered, floor, ceiling, assembly, cost**0.5, crowded)
