"""Search for dwell linkages: many six-bars at once, whose last link stands still over part of a turn.

A four-bar with O2 = 0 and r1 = 1, a point C of its coupler, and a dyad C-E-D on the ground (Stephenson III).
While C follows an arc about E, link 6 or the slide stands still (Norton, *Design of Machinery*, sec. 3.9).
Both loops close all round the turn, with a transmission angle, by construction. Four-bars whose coupler curve
has such an arc are drawn; Levenberg-Marquardt then makes the output even, and its swing as wanted.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil
from typing import NamedTuple

import numpy as np
import scipy

from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray
from grashof.problems.values.linkages.mechanism import DyadKind
from grashof.problems.values.tasks.dwell_task import SWING_WITHIN
from grashof.synth.loop.chain import DYADS
from grashof.synth.loop.dyad import Bars, as_complex, as_vector, root_or_zero
from grashof.synth.loop.feasible import Demand, bars_between, feasible, shares_of_bars
from grashof.synth.loop.vector import Vector
from grashof.synth.starts.closed_loop import Batch, joined
from grashof.synth.starts.loop_search import Model, improve
from grashof.synth.theory.sampled import highest

DRAWN, ARCS, BEGUN = 20_000, 400, 600  # four-bars, those with the best arcs, and starts from these
STAGES = ((600, 8), (200, 12), (60, 25))  # numbers of the best that continue, and their steps
NOMINAL, MADE = 20, 16  # of the best of these, and of those with the least bands as made
LAST, FINEST = 60, 15  # steps of these
LONGER, SPREAD = 0.2, 1.2  # share of drivers longer than the ground link; of C, over r3
RADII = (0.05, 10.0)  # of arcs
DIRECTIONS = np.arange(16) * TURN / 16  # from E to D, or along the slide
LENGTHS = np.array([0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0, 2.8, 4.0])  # of link 6, over what the swing needs
OF_ONE, ARC_COUNTS = 4, 0.3  # starts from one four-bar; weight of the score of an arc
ARC, WITHIN, ROUND, FINE = 11, 25, 48, 720  # driver angles on the arc, in the dwell, and in the turn
STEP, WIDER, FEW = 1e-7, 1e-6, 9  # of differences, by unknowns and by dimensions; angles for the latter
SHORT = 2e-3  # share by which samples of the turn understate how far C reaches
SWING = 10.0  # weight of the swing at last; before that 1
OUTSIDE, INFEASIBLE = 0.3, 0.5  # weights: of link ratios beyond limits, of lengths that must change
# Dimensions, and the ways in which they grow.
DIMENSIONS = (("r2", 1), ("r3", 1), ("r4", 1), ("r5", 1), ("r6", 1), ("c", 1), ("c", 1j), ("d", 1), ("d", 1j))
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

    def __getitem__(self, index: slice) -> DwellLinkages:
        return DwellLinkages(*(getattr(self, name)[index] for name in self.__slots__))

    def outputs(self, kind: DyadKind, c: ComplexArray) -> ComplexArray:
        """D-E, or the travel of the slide, where C is in `c` (..., K)."""
        d, (r5, r6, side) = self.d[..., None], (each[..., None] for each in (self.r5, self.r6, self.side_2))
        closed = DYADS[kind].closed(as_vector(d), as_vector(c), r5, r6, side, root_or_zero)
        if kind is DyadKind.RRR:
            return as_complex(closed.across)
        return np.asarray(((c + as_complex(closed.along)) * (1j * d.conj())).real, dtype=np.complex128)

    def within(self, aim: DwellAim, begins: FloatArray, count: int) -> ComplexArray:
        """`outputs` at even driver angles of the dwell, (..., count)."""
        theta2 = begins[..., None] + np.linspace(0, aim.dwell, count)
        return self.outputs(aim.kind, curve((self.r2, self.r3, self.r4), self.c, self.side, theta2))

    def still(self, aim: DwellAim, begins: FloatArray, count: int) -> FloatArray:
        """The same as angles from the middle of the dwell, or travels."""
        found = self.within(aim, begins, count)
        return found.real if aim.slides else np.angle(found * found[..., count // 2, None].conj())

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
    first = feasible(Bars(), scipy.special.expit(batch.unknowns[..., :3]), batch.longer_driver, aim.demand)
    c, (side, side_2) = x[3] + 1j * x[4], np.moveaxis(batch.assembly, -1, 0)
    lengths = first.r2, first.r3, first.r4
    path = curve(lengths, c, side, np.broadcast_to(np.arange(round_) * TURN / round_, (*c.shape, round_)))
    short = SHORT * (ROUND / round_) ** 2
    if aim.slides:
        d = np.exp(1j * x[6])
        shortest = _slide_limits(aim, path, d, np.ones_like(x[7]), short)[0]
        r5 = shortest * (1 + np.exp(x[7]))
        _, least, most = _slide_limits(aim, path, d, r5, short)
        r6 = least + scipy.special.expit(x[8]) * (most - least)
    else:
        d = x[6] + 1j * x[7]
        near, far = _reach(path, d)
        r5, r6 = bars_between(
            near * (1 - short), far * (1 + short), scipy.special.expit(batch.unknowns[..., 8:]), aim.demand
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


class Terms(NamedTuple):
    """Terms of a fit: samples of the turn, weight of the swing, and tolerance of dimensions over r1."""

    round_: int = ROUND
    swing: float = 1.0
    tolerance: float = 0.0


def _residuals(aim: DwellAim, batch: Batch, terms: Terms) -> FloatArray:
    """The output within the dwell from its mean, its swing beyond the wanted one, and lengths beyond limits.

    With a tolerance also the effect of each dimension on the output, from its mean. The travel of a slide
    counts as a share of its stroke.
    """
    made, path = linkages(aim, batch, terms.round_)
    begins = batch.unknowns[..., 5]
    turn = made.outputs(aim.kind, path)
    middle = made.within(aim, begins, 3)[..., 1, None]
    way = turn.real if aim.slides else np.angle(turn * middle.conj())
    swing = highest(way) + highest(-way)
    unit = swing if aim.slides else np.ones_like(swing)
    rows = [_from_mean(made.still(aim, begins, WITHIN)) / unit[..., None]]
    if not aim.slides:
        rows.append(terms.swing * (swing - aim.swing)[..., None])
    if terms.tolerance:
        rows += [terms.tolerance * each / unit[..., None] for each in _effects(aim, made, begins)]
    rows.append(OUTSIDE * np.maximum(np.log(made.ratios(aim.kind) / (0.98 * aim.ratio)), 0.0)[..., None])
    return np.concatenate(rows, axis=-1)


def _from_mean(values: FloatArray) -> FloatArray:
    rest: FloatArray = values - values.mean(axis=-1, keepdims=True)
    return rest


def _effects(aim: DwellAim, made: DwellLinkages, begins: FloatArray) -> list[FloatArray]:
    """Derivatives of the output within the dwell by each dimension, from their means, (..., FEW) each.

    The last, by r1, follows from the others: an angle does not depend on the scale, a travel grows with it.
    """
    base = made.still(aim, begins, FEW)
    found, by_scale = list[FloatArray](), base if aim.slides else 0 * base
    for name, way in DIMENSIONS:
        if name == "d" and aim.slides:
            continue
        value = getattr(made, name)
        slope = (replace(made, **{name: value + way * WIDER}).still(aim, begins, FEW) - base) / WIDER
        by_scale = by_scale - (value * np.conj(way)).real[..., None] * slope
        found.append(_from_mean(slope))
    return [*found, _from_mean(by_scale)]


def _model(aim: DwellAim, terms: Terms) -> Model:
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
            rows = _residuals(aim, beside, terms)
            slope = np.swapaxes(rows[:, 1:] - rows[:, :1], 1, 2) / STEP
            error = (rows[:, 0] ** 2).sum(axis=1)
        sound = np.isfinite(error) & np.isfinite(slope).all(axis=(1, 2))
        return np.where(sound, error, np.inf), rows[:, 0], slope

    return model


def fitted(aim: DwellAim, batch: Batch, tolerance: float, share: float = 1.0) -> Batch:
    """Of a batch those of least bands, and of least bands with a tolerance of the dimensions, over r1.

    With a `share` of the usual numbers.
    """
    model = _model(aim, Terms())
    error = model(batch)[0]
    for keep, steps in STAGES:
        best = np.argsort(error, kind="stable")[: ceil(share * keep)]
        batch, error = improve(model, batch[best], steps, NO_ERROR, len(best))
    nominal = batch[np.argsort(error, kind="stable")[: ceil(share * NOMINAL)]]
    nominal, _ = improve(model, nominal, LAST, NO_ERROR, len(nominal))
    found = [_settled(aim, nominal, Terms(FINE, SWING), FINEST)]
    model = _model(aim, Terms(tolerance=tolerance))
    made = batch[np.argsort(model(batch)[0], kind="stable")[: ceil(share * MADE)]]
    made, _ = improve(model, made, LAST, NO_ERROR, len(made))
    found.append(_settled(aim, made, Terms(FINE, SWING, tolerance), FINEST))
    return joined(*found)


def _settled(aim: DwellAim, batch: Batch, terms: Terms, steps: int) -> Batch:
    """A batch improved with fine samples of the turn; those that close, with the swing and the link ratio."""
    batch, error = improve(_model(aim, terms), batch, steps, NO_ERROR, len(batch))
    batch = batch[np.isfinite(error)]
    with np.errstate(all="ignore"):
        off = _residuals(aim, batch, Terms(FINE))[:, WITHIN]  # of a slide the ratio of links alone
        sound = (np.abs(off) < 0.9 * SWING_WITHIN) | aim.slides
        return batch[sound & (linkages(aim, batch)[0].ratios(aim.kind) <= aim.ratio)]


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
    """Dyads (n, M) on n arcs: their distance from the aim, last unknowns, and assemblies."""

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
    four_bar = np.column_stack([scipy.special.logit(shares), c.real, c.imag, at])[kept[of]]
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
    inner: FloatArray = scipy.special.logit(np.clip(np.nan_to_num(shares, nan=0.5), 0.02, 0.98))
    return inner


def _finite(cost: FloatArray) -> FloatArray:
    return np.where(np.isnan(cost), np.inf, cost)
