"""Search for dwell linkages: many six-bars at once, whose last link stands still over part of a turn.

A four-bar with O2 = 0 and r1 = 1, a point C of its coupler, and a dyad C-E-D on the ground (Stephenson III).
While C follows an arc about E, link 6 or the slide stands still (Norton, *Design of Machinery*, sec. 3.9).
Both loops close all round the turn, with a transmission angle, by construction. Four-bars whose coupler curve
has such an arc are drawn; Levenberg-Marquardt then makes the output even, and its swing as wanted.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import NamedTuple

import numpy as np
from scipy.special import expit, logit

from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray
from grashof.problems.values.linkages.mechanism import DyadKind
from grashof.synth.loop.chain import DYADS
from grashof.synth.loop.dyad import Bars, as_complex, as_vector, root_or_zero
from grashof.synth.loop.feasible import Demand, bars_between, feasible, shares_of_bars
from grashof.synth.loop.vector import Vector
from grashof.synth.starts.closed_loop import Batch
from grashof.synth.starts.loop_search import Model, improve

DRAWN, ARCS, BEGUN = 20_000, 400, 600  # four-bars, those with the best arcs, and starts from these
STAGES = ((600, 8), (200, 12), (60, 25), (20, 60))  # numbers of the best that continue, and their steps
LONGER, SPREAD = 0.2, 1.2  # share of drivers longer than the ground link; of C, over r3
RADII = (0.05, 10.0)  # of arcs
DIRECTIONS = np.arange(16) * TURN / 16  # from E to D, or along the slide
LENGTHS = np.array([0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0, 2.8, 4.0])  # of link 6, over what the swing needs
OF_ONE, ARC_COUNTS = 4, 0.3  # starts from one four-bar; weight of the score of an arc
ARC, WITHIN, ROUND, FINE = 11, 25, 48, 720  # driver angles on the arc, in the dwell, and in the turn
STEP = 1e-7  # of differences
SHORT = 2e-3  # share by which samples of the turn understate how far C reaches
SWING = 10.0  # weight of the swing at last; before that 1
OUTSIDE, INFEASIBLE = 0.3, 0.5  # weights: of link ratios beyond limits, of lengths that must change
NO_ERROR = 1e-24  # rad squared


@dataclass(frozen=True, slots=True)
class DwellAim:
    """The dwell, rad, the swing, rad (0 of a slide), and what the loops and the link ratio have to meet."""

    kind: DyadKind
    dwell: float
    swing: float
    demand: Demand
    ratio: float

    @property
    def slides(self) -> bool:
        """Whether the output is a slide."""
        return self.kind is DyadKind.RRP


@dataclass(frozen=True, slots=True)
class DwellLinkages:
    """Six-bars (...), r1 = 1; of a slide D is the unit vector across it, to its left, and r6 its offset."""

    r2: FloatArray
    r3: FloatArray
    r4: FloatArray
    c: ComplexArray
    side: FloatArray
    d: ComplexArray
    r5: FloatArray
    r6: FloatArray
    side_2: FloatArray

    def outputs(self, kind: DyadKind, c: ComplexArray) -> ComplexArray:
        """D-E, or the travel of the slide, where C is in `c` (..., K)."""
        d, (r5, r6, side) = self.d[..., None], (each[..., None] for each in (self.r5, self.r6, self.side_2))
        closed = DYADS[kind].closed(as_vector(d), as_vector(c), r5, r6, side, root_or_zero)
        if kind is DyadKind.RRR:
            return as_complex(closed.across)
        return np.asarray(((c + as_complex(closed.along)) * (1j * d.conj())).real, dtype=np.complex128)

    def ratios(self, kind: DyadKind) -> FloatArray:
        """Longest to shortest link."""
        bars = (self.r5, self.r6) if kind is DyadKind.RRR else (self.r5,)
        lengths = np.stack([np.ones_like(self.r2), self.r2, self.r3, self.r4, *bars])
        ratios: FloatArray = lengths.max(axis=0) / lengths.min(axis=0)
        return ratios


def curve(
    lengths: tuple[FloatArray, ...], c: ComplexArray, side: FloatArray, theta2: FloatArray
) -> ComplexArray:
    """C at driver angles (..., K), of four-bars r2, r3, r4 (...) with C at `c` on the coupler."""
    r2, r3, r4 = (each[..., None] for each in lengths)
    a = r2 * np.exp(1j * theta2)
    loop = Bars().closed(Vector(1.0, 0.0), as_vector(a), r3, r4, side[..., None], root_or_zero)
    placed: ComplexArray = a + c[..., None] * as_complex(loop.along) / r3
    return placed


def linkages(aim: DwellAim, batch: Batch, round_: int = ROUND) -> tuple[DwellLinkages, ComplexArray]:
    """The six-bars of a batch, and C at even driver angles round the turn."""
    x = np.moveaxis(batch.unknowns, -1, 0)
    first = feasible(Bars(), expit(batch.unknowns[..., :3]), batch.longer_driver, aim.demand)
    c, (side, side_2) = x[3] + 1j * x[4], np.moveaxis(batch.assembly, -1, 0)
    lengths = first.r2, first.r3, first.r4
    path = curve(lengths, c, side, np.broadcast_to(np.arange(round_) * TURN / round_, (*c.shape, round_)))
    short = SHORT * (ROUND / round_) ** 2
    if aim.slides:
        d = np.exp(1j * x[6])
        shortest = _slide_limits(aim, path, d, np.ones_like(x[7]), short)[0]
        r5 = shortest * (1 + np.exp(x[7]))
        _, least, most = _slide_limits(aim, path, d, r5, short)
        r6 = least + expit(x[8]) * (most - least)
    else:
        d = x[6] + 1j * x[7]
        near, far = _reach(path, d)
        r5, r6 = bars_between(
            near * (1 - short), far * (1 + short), expit(batch.unknowns[..., 8:]), aim.demand
        )
    return DwellLinkages(*lengths, c, side, d, r5, r6, side_2), path


def _slide_limits(
    aim: DwellAim, path: ComplexArray, across: ComplexArray, r5: FloatArray, short: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The shortest r5, and the least and greatest offset of the slide for an r5.

    |offset - h| <= cos(mu) r5 for all distances h of C from the line through O2, to its left.
    """
    height, cosine = (path * across[..., None].conj()).real, np.cos(aim.demand.transmission)
    low, high = height.min(axis=-1), height.max(axis=-1)
    slack = short * (high - low)
    low, high = low - slack, high + slack
    return (high - low) / (2 * cosine), high - cosine * r5, low + cosine * r5


def _reach(path: ComplexArray, d: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Least and greatest distance C-D."""
    distance = np.abs(path - d[..., None])
    return distance.min(axis=-1), distance.max(axis=-1)


def _residuals(aim: DwellAim, batch: Batch, round_: int, weight: float) -> FloatArray:
    """The output within the dwell from its mean, its swing beyond the wanted one, and lengths beyond limits.

    The travel of a slide counts as a share of its stroke.
    """
    made, path = linkages(aim, batch, round_)
    theta2 = batch.unknowns[..., 5, None] + np.linspace(0, aim.dwell, WITHIN)
    dwell = made.outputs(aim.kind, curve((made.r2, made.r3, made.r4), made.c, made.side, theta2))
    turn = made.outputs(aim.kind, path)
    if aim.slides:
        still, way = dwell.real, turn.real
    else:
        middle = dwell[..., WITHIN // 2, None].conj()
        still, way = np.angle(dwell * middle), np.angle(turn * middle)
    swing = _highest(way) + _highest(-way)
    unit = swing if aim.slides else np.ones_like(swing)
    rows = [(still - still.mean(axis=-1, keepdims=True)) / unit[..., None]]
    if not aim.slides:
        rows.append(weight * (swing - aim.swing)[..., None])
    rows.append(OUTSIDE * np.maximum(np.log(made.ratios(aim.kind) / (0.98 * aim.ratio)), 0.0)[..., None])
    return np.concatenate(rows, axis=-1)


def _highest(values: FloatArray) -> FloatArray:
    """The greatest of even samples of a period, by a parabola."""
    top = values.argmax(axis=-1)[..., None] + np.arange(-1, 2)
    before, at, after = np.moveaxis(np.take_along_axis(values, top % values.shape[-1], axis=-1), -1, 0)
    bend = before - 2 * at + after
    share = np.clip(np.divide(before - after, 2 * bend, out=np.zeros_like(bend), where=bend < 0), -0.5, 0.5)
    highest: FloatArray = at - 0.25 * (before - after) * share
    return highest


def _model(aim: DwellAim, round_: int, weight: float) -> Model:
    """The model for `improve`, with derivatives by differences."""

    def model(batch: Batch) -> tuple[FloatArray, FloatArray, FloatArray]:
        width = batch.unknowns.shape[1]
        steps = np.concatenate([np.zeros((1, width)), STEP * np.eye(width)])
        beside = Batch(
            batch.unknowns[:, None] + steps,
            np.repeat(batch.longer_driver[:, None], width + 1, axis=1),
            np.repeat(batch.assembly[:, None], width + 1, axis=1),
            np.repeat(batch.direction[:, None], width + 1, axis=1),
        )
        with np.errstate(all="ignore"):
            rows = _residuals(aim, beside, round_, weight)
            slope = np.swapaxes(rows[:, 1:] - rows[:, :1], 1, 2) / STEP
            error = (rows[:, 0] ** 2).sum(axis=1)
        sound = np.isfinite(error) & np.isfinite(slope).all(axis=(1, 2))
        return np.where(sound, error, np.inf), rows[:, 0], slope

    return model


def fitted(aim: DwellAim, batch: Batch, share: float = 1.0) -> tuple[Batch, FloatArray]:
    """The best of a batch improved, best first, and the root mean square of their residuals.

    With a `share` of the usual numbers.
    """
    model = _model(aim, ROUND, 1.0)
    error = model(batch)[0]
    for keep, steps in STAGES:
        best = np.argsort(error, kind="stable")[: ceil(share * keep)]
        batch, error = improve(model, batch[best], steps, NO_ERROR, len(best))
    batch, error = improve(_model(aim, FINE, SWING), batch, 15, NO_ERROR, len(batch))
    kept = np.flatnonzero(np.isfinite(error))
    order = kept[np.argsort(error[kept], kind="stable")]
    return batch[order], np.sqrt(error[order] / WITHIN)


class Arcs(NamedTuple):
    """Coupler curves (n) with an arc within the dwell."""

    score: FloatArray  # deviation from the arc, as a share of how far C leaves its circle in the turn
    away: FloatArray  # that distance
    e: ComplexArray  # centre
    radius: FloatArray
    path: ComplexArray  # (n, ROUND), C round the turn
    middle: ComplexArray  # C in the middle of the arc

    @classmethod
    def of(cls, arc: ComplexArray, path: ComplexArray) -> Arcs:
        """The circles that fit C within the dwell (n, K) best (Kasa 1976), and C round the turn."""
        rows = np.stack([arc.real, arc.imag, np.ones(arc.shape)], axis=-1)
        normal = np.swapaxes(rows, 1, 2) @ rows + 1e-14 * np.eye(3)
        found = np.linalg.solve(normal, np.swapaxes(rows, 1, 2) @ (np.abs(arc) ** 2)[..., None])[..., 0]
        e = (found[:, 0] + 1j * found[:, 1]) / 2
        radius = np.sqrt(np.maximum(found[:, 2] + np.abs(e) ** 2, 0.0))
        off, away = (np.abs(np.abs(c - e[:, None]) - radius[:, None]).max(axis=1) for c in (arc, path))
        usable = (radius > RADII[0]) & (radius < RADII[1])
        return cls(np.where(usable, off / away, np.inf), away, e, radius, path, arc[:, arc.shape[1] // 2])

    def taken(self, index: IntArray) -> Arcs:
        """Some of them."""
        score, away, e, radius, path, middle = self
        return Arcs(score[index], away[index], e[index], radius[index], path[index], middle[index])


class Dyads(NamedTuple):
    """Dyads (n, M) on n arcs: how far from what is wanted, the last unknowns, and their assemblies."""

    cost: FloatArray
    unknowns: FloatArray  # (n, M, K)
    side: FloatArray


def drawn(aim: DwellAim, rng: np.random.Generator) -> Batch:
    """Starts from four-bars whose coupler curves have arcs."""
    shares = rng.random((DRAWN, 3))
    longer, at = rng.random(DRAWN) < LONGER, rng.uniform(0, TURN, DRAWN)
    first = feasible(Bars(), shares, longer, aim.demand)
    c = (rng.normal(0.5, SPREAD, DRAWN) + 1j * rng.normal(0, SPREAD, DRAWN)) * first.r3
    sizes = np.stack([np.ones(DRAWN), first.r2, first.r3, first.r4])
    kept = np.flatnonzero(sizes.max(axis=0) < aim.ratio * sizes.min(axis=0))
    lengths, side = tuple(sizes[1:, kept]), np.ones(len(kept))  # the others are mirror images
    within = at[kept, None] + np.linspace(0, aim.dwell, ARC)
    round_turn = np.broadcast_to(np.arange(ROUND) * TURN / ROUND, (len(kept), ROUND))
    arcs = Arcs.of(*(curve(lengths, c[kept], side, theta2) for theta2 in (within, round_turn)))
    best = np.argsort(arcs.score, kind="stable")[:ARCS]
    arcs, kept = arcs.taken(best), kept[best]
    dyads = (_sliders if aim.slides else _rockers)(aim, arcs)
    cost = dyads.cost + ARC_COUNTS * np.log10(arcs.score)[:, None]
    of, which = np.unravel_index(np.argsort(cost, axis=None, kind="stable"), cost.shape)
    few = _first_of_each(of[np.isfinite(cost[of, which])], OF_ONE)[:BEGUN]
    of, which = of[few], which[few]
    four_bar = np.column_stack([logit(shares), c.real, c.imag, at])[kept[of]]
    return Batch(
        unknowns=np.concatenate([four_bar, dyads.unknowns[of, which]], axis=1),
        longer_driver=longer[kept[of]],
        assembly=np.column_stack([np.ones(len(of)), dyads.side[of, which]]),
        direction=np.ones(len(of)),
    )


def _first_of_each(groups: IntArray, most: int) -> IntArray:
    """Indices of the first `most` of each group, in their order."""
    order = np.argsort(groups, kind="stable")
    _, begin, count = np.unique(groups[order], return_index=True, return_counts=True)
    rank = np.empty(len(groups), dtype=np.int64)
    rank[order] = np.arange(len(groups)) - np.repeat(begin, count)
    return np.flatnonzero(rank < most)


def _rockers(aim: DwellAim, arcs: Arcs) -> Dyads:
    """Links 6 of several lengths in all directions from E."""
    needed = arcs.away / (2 * np.sin(min(aim.swing, 0.9 * np.pi) / 2))
    r6 = np.repeat(needed[:, None] * LENGTHS, len(DIRECTIONS), axis=1)
    e, middle, path = arcs.e[:, None], arcs.middle[:, None], arcs.path[:, None]
    d = e + r6 * np.tile(np.exp(1j * DIRECTIONS), len(LENGTHS))
    r5 = np.broadcast_to(arcs.radius[:, None], d.shape)
    side = np.sign(((d - middle).conj() * (e - middle)).imag)
    near, far = _reach(path, d)
    with np.errstate(all="ignore"):
        shares = shares_of_bars(near * (1 - SHORT), far * (1 + SHORT), (r5, r6), aim.demand)
        able = np.isfinite(bars_between(near, far, np.full((*d.shape, 2), 0.5), aim.demand)[0])
        bars = r5[..., None], r6[..., None], side[..., None]
        loop = Bars().closed(as_vector(d[..., None]), as_vector(path), *bars)
        way = np.angle(as_complex(loop.across) * (e - d).conj()[..., None])
        sound = ((shares > 0) & (shares < 1)).all(axis=-1)
        cost = np.abs(np.log(np.ptp(way, axis=-1) / aim.swing)) + INFEASIBLE * ~sound
    places = np.stack([d.real, d.imag], axis=-1)
    return Dyads(
        _finite(np.where(able, cost, np.inf)), np.concatenate([places, _inner(shares)], axis=-1), side
    )


def _sliders(aim: DwellAim, arcs: Arcs) -> Dyads:
    """Slides through E in all directions."""
    e, middle, path = arcs.e[:, None], arcs.middle[:, None], arcs.path[:, None]
    across = np.broadcast_to(1j * np.exp(1j * DIRECTIONS), (len(e), len(DIRECTIONS)))
    r5, offset = np.broadcast_to(arcs.radius[:, None], across.shape), (e * across.conj()).real
    shortest, least, most = _slide_limits(aim, path, across, r5, SHORT)
    spare, share = r5 / shortest - 1, (offset - least) / (most - least)
    sound = (spare > 0) & (share > 0) & (share < 1)
    cost = np.where(sound, 0.0, INFEASIBLE - np.minimum(spare, 0.0))
    numbers = np.log(np.maximum(spare, 0.02))[..., None]
    unknowns = np.concatenate([np.angle(across)[..., None], numbers, _inner(share)[..., None]], axis=-1)
    return Dyads(_finite(cost), unknowns, np.sign(((e - middle) * (-1j * across).conj()).real))


def _inner(shares: FloatArray) -> FloatArray:
    """Unknowns of shares, away from the ends."""
    inner: FloatArray = logit(np.clip(np.nan_to_num(shares, nan=0.5), 0.02, 0.98))
    return inner


def _finite(cost: FloatArray) -> FloatArray:
    return np.where(np.isnan(cost), np.inf, cost)
