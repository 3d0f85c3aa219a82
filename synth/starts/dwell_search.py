"""Search for dwell linkages: many six-bars at once, whose last link stands still over part of a turn.

A four-bar with O2 = 0 and r1 = 1, a point C of its coupler, and a dyad C-E-D on the ground (Stephenson III).
While C follows an arc about E, link 6 or the slide stands still (Norton, *Design of Machinery*, sec. 3.9).
Both loops close all round the turn, with a transmission angle, by construction. Four-bars whose coupler curve
has such an arc are drawn; Levenberg-Marquardt then makes the output even, and its swing as wanted.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import expit, logit

from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray
from grashof.problems.values.linkages.mechanism import DyadKind
from grashof.synth.loop.chain import DYADS
from grashof.synth.loop.dyad import Bars, as_complex, as_vector
from grashof.synth.loop.feasible import Demand, bars_between, feasible, shares_of_bars
from grashof.synth.loop.vector import Vector
from grashof.synth.starts.closed_loop import Batch
from grashof.synth.starts.loop_search import improve

DRAWN, ARCS, BEGUN = 20_000, 400, 600  # four-bars, those with the best arcs, and starts from these
STAGES = ((600, 8), (200, 12), (60, 25), (20, 60))  # numbers of the best that continue, and their steps
LONGER, SPREAD = 0.2, 1.2  # share of drivers longer than the ground link; of C, over r3
RADII = (0.05, 10.0)  # of arcs
DIRECTIONS = np.arange(16) * TURN / 16  # from E to D, or along the slide
LENGTHS = np.array([0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0, 2.8, 4.0])  # of link 6, over what the swing needs
OF_ONE = 4  # starts from one four-bar
ARC, WITHIN, ROUND, FINE = 11, 25, 48, 720  # driver angles on the arc, in the dwell, and in the turn
STEP = 1e-7  # of differences
SHORT = 2e-3  # share by which samples of the turn understate how far C reaches
OUTSIDE, INFEASIBLE = 0.3, 0.5  # weights: of a ratio of links that is exceeded, of lengths that have to change
NO_ERROR = 1e-24  # rad squared


@dataclass(frozen=True, slots=True)
class DwellAim:
    """The dwell, rad, the swing, rad (0 of a slide), and limits of transmission (rad), margin and link ratio."""

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
    """Six-bars (...), r1 = 1; of a slide the unit vector across it, to its left, and its offset as D and r6."""

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
        d, r5, r6, side = (each[..., None] for each in (self.d, self.r5, self.r6, self.side_2))
        closed = DYADS[kind].closed(as_vector(d), as_vector(c), r5, r6, side, _root)
        if kind is DyadKind.RRP:
            return ((c + as_complex(closed.along)) * (1j * d.conj())).real + 0j
        return as_complex(closed.across)

    @property
    def ratios(self) -> FloatArray:
        """Longest to shortest link."""
        lengths = np.stack([np.ones_like(self.r2), self.r2, self.r3, self.r4, self.r5])
        six = self.r6 if np.isfinite(self.r6).all() else self.r5
        return np.maximum(lengths.max(axis=0), six) / np.minimum(lengths.min(axis=0), six)


def _root(square: FloatArray) -> FloatArray:
    return np.sqrt(np.maximum(square, 0.0))


def curve(lengths: tuple[FloatArray, ...], c: ComplexArray, side: FloatArray, theta2: FloatArray) -> ComplexArray:
    """C at driver angles (..., K), of four-bars r2, r3, r4 (...) with C at `c` on the coupler."""
    r2, r3, r4 = (each[..., None] for each in lengths)
    a = r2 * np.exp(1j * theta2)
    loop = Bars().closed(Vector(1.0, 0.0), as_vector(a), r3, r4, side[..., None], _root)
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
        d, cosine = np.exp(1j * x[6]), np.cos(aim.demand.transmission)
        low, high = _heights(path, d)
        slack = short * (high - low)
        r5 = (high - low + 2 * slack) / (2 * cosine) * (1 + np.exp(x[7]))
        least = high + slack - cosine * r5
        r6 = least + expit(x[8]) * (low - slack + cosine * r5 - least)
    else:
        d = x[6] + 1j * x[7]
        near, far = _reach(path, d)
        r5, r6 = bars_between(near * (1 - short), far * (1 + short), expit(batch.unknowns[..., 8:]), aim.demand)
    return DwellLinkages(*lengths, c, side, d, r5, r6, side_2), path


def _heights(path: ComplexArray, across: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Least and greatest distance of C from the line through O2, to its left."""
    height = (path * across[..., None].conj()).real
    return height.min(axis=-1), height.max(axis=-1)


def _reach(path: ComplexArray, d: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Least and greatest distance C-D."""
    distance = np.abs(path - d[..., None])
    return distance.min(axis=-1), distance.max(axis=-1)


def _residuals(aim: DwellAim, batch: Batch, round_: int) -> FloatArray:
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
        rows.append((swing - aim.swing)[..., None])
    rows.append(OUTSIDE * np.maximum(np.log(made.ratios / (0.98 * aim.ratio)), 0.0)[..., None])
    return np.concatenate(rows, axis=-1)


def _highest(values: FloatArray) -> FloatArray:
    """The greatest of even samples of a period, by a parabola."""
    top = values.argmax(axis=-1)[..., None] + np.arange(-1, 2)
    before, at, after = np.moveaxis(np.take_along_axis(values, top % values.shape[-1], axis=-1), -1, 0)
    bend = before - 2 * at + after
    share = np.clip(np.divide(before - after, 2 * bend, out=np.zeros_like(bend), where=bend < 0), -0.5, 0.5)
    highest: FloatArray = at - 0.25 * (before - after) * share
    return highest


def fitted(aim: DwellAim, batch: Batch) -> tuple[Batch, FloatArray]:
    """The best of a batch improved, and the root mean square of the output within the dwell."""

    def at(round_: int):  # type: ignore[no-untyped-def]
        def model(some: Batch) -> tuple[FloatArray, FloatArray, FloatArray]:
            count, width = some.unknowns.shape
            steps = np.concatenate([np.zeros((1, width)), STEP * np.eye(width)])
            beside = Batch(
                some.unknowns[:, None] + steps,
                *(np.repeat(each[:, None], width + 1, axis=1) for each in (some.longer_driver, some.assembly, some.direction)),
            )
            with np.errstate(all="ignore"):
                rows = _residuals(aim, beside, round_)
                slope = np.swapaxes(rows[:, 1:] - rows[:, :1], 1, 2) / STEP
                error = (rows[:, 0] ** 2).sum(axis=1)
            sound = np.isfinite(error) & np.isfinite(slope).all(axis=(1, 2))
            return np.where(sound, error, np.inf), rows[:, 0], slope

        return model

    model = at(ROUND)
    error = model(batch)[0]
    for keep, steps in STAGES:
        best = np.argsort(error, kind="stable")[:keep]
        batch, error = improve(model, batch[best], steps, NO_ERROR, keep)
    batch, error = improve(at(FINE), batch, 10, NO_ERROR, keep)
    kept = np.flatnonzero(np.isfinite(error))
    order = kept[np.argsort(error[kept], kind="stable")]
    return batch[order], np.sqrt(error[order] / WITHIN)


def drawn(aim: DwellAim, rng: np.random.Generator) -> Batch:
    """Starts from four-bars whose coupler curves have arcs."""
    shares = rng.random((DRAWN, 3))
    longer, at = rng.random(DRAWN) < LONGER, rng.uniform(0, TURN, DRAWN)
    first = feasible(Bars(), shares, longer, aim.demand)
    side = np.ones(DRAWN)  # the others are mirror images
    c = (rng.normal(0.5, SPREAD, DRAWN) + 1j * rng.normal(0, SPREAD, DRAWN)) * first.r3
    sizes = np.stack([np.ones(DRAWN), first.r2, first.r3, first.r4])
    usable = np.flatnonzero(sizes.max(axis=0) < aim.ratio * sizes.min(axis=0))
    lengths = (first.r2[usable], first.r3[usable], first.r4[usable])
    c, at, side = c[usable], at[usable], side[usable]
    arc = curve(lengths, c, side, at[:, None] + np.linspace(0, aim.dwell, ARC))
    path = curve(lengths, c, side, np.broadcast_to(np.arange(ROUND) * TURN / ROUND, (len(c), ROUND)))
    e, radius = _circles(arc)
    off, away = (np.abs(np.abs(each - e[:, None]) - radius[:, None]).max(axis=1) for each in (arc, path))
    score = np.where((radius > RADII[0]) & (radius < RADII[1]), off / away, np.inf)
    best = np.argsort(score, kind="stable")[:ARCS]
    inner = np.concatenate([logit(shares[usable]), c.real[:, None], c.imag[:, None], at[:, None]], axis=1)[best]
    e, radius, path, arc = e[best], radius[best], path[best], arc[best]
    chosen = _sliders if aim.slides else _rockers
    cost, last, side_2 = chosen(aim, e, radius, path, arc, away[best])
    of, which = np.unravel_index(np.argsort(cost + 0.3 * np.log10(score[best])[:, None], axis=None, kind="stable"), cost.shape)
    sound = np.isfinite(cost[of, which])
    of, which = of[sound], which[sound]
    first_few = _first_of_each(of, OF_ONE)[:BEGUN]
    of, which = of[first_few], which[first_few]
    return Batch(
        unknowns=np.concatenate([inner[of], last[of, which]], axis=1),
        longer_driver=longer[usable][best][of],
        assembly=np.stack([np.ones(len(of)), side_2[of, which]], axis=1),
        direction=np.ones(len(of)),
    )


def _first_of_each(groups: np.ndarray, most: int) -> np.ndarray:
    """Indices of the first `most` of each group, in their order."""
    order = np.argsort(groups, kind="stable")
    _, begin, count = np.unique(groups[order], return_index=True, return_counts=True)
    rank = np.empty(len(groups), dtype=np.int64)
    rank[order] = np.arange(len(groups)) - np.repeat(begin, count)
    return np.flatnonzero(rank < most)


def _circles(points: ComplexArray) -> tuple[ComplexArray, FloatArray]:
    """Centres and radii of circles that fit points (n, K) (Kasa 1976)."""
    rows = np.stack([points.real, points.imag, np.ones(points.shape)], axis=-1)
    normal = np.swapaxes(rows, 1, 2) @ rows + 1e-14 * np.eye(3)
    found = np.linalg.solve(normal, np.swapaxes(rows, 1, 2) @ (np.abs(points) ** 2)[..., None])[..., 0]
    centre = (found[:, 0] + 1j * found[:, 1]) / 2
    return centre, np.sqrt(np.maximum(found[:, 2] + np.abs(centre) ** 2, 0.0))


def _rockers(aim, e, radius, path, arc, away):  # type: ignore[no-untyped-def]
    """How far each D about E is from the swing, its unknowns, and the side of the dyad; (n, directions x lengths)."""
    needed = away / (2 * np.sin(min(aim.swing, 0.9 * np.pi) / 2))
    r6 = np.repeat(needed[:, None] * LENGTHS, len(DIRECTIONS), axis=1)
    d = e[:, None] + r6 * np.tile(np.exp(1j * DIRECTIONS), len(LENGTHS))
    r5 = np.broadcast_to(radius[:, None], d.shape)
    near, far = _reach(path[:, None], d)
    with np.errstate(all="ignore"):
        shares = shares_of_bars(near * (1 - SHORT), far * (1 + SHORT), (r5, r6), aim.demand)
        able = np.isfinite(bars_between(near, far, np.full((*d.shape, 2), 0.5), aim.demand)[0])
        middle = arc[:, None, ARC // 2]
        side = np.sign(((d - middle).conj() * (e[:, None] - middle)).imag)
        loop = Bars().closed(as_vector(d[..., None]), as_vector(path[:, None]), r5[..., None], r6[..., None], side[..., None])
        way = np.angle(as_complex(loop.across) * (e[:, None] - d).conj()[..., None])
        swing = way.max(axis=-1) - way.min(axis=-1)
        sound = ((shares > 0) & (shares < 1)).all(axis=-1)
        cost = np.abs(np.log(swing / aim.swing)) + INFEASIBLE * ~sound
    cost = np.where(able & np.isfinite(cost), cost, np.inf)
    shares = np.clip(np.nan_to_num(shares, nan=0.5), 0.02, 0.98)
    return cost, np.concatenate([d.real[..., None], d.imag[..., None], logit(shares)], axis=-1), side


def _sliders(aim, e, radius, path, arc, away):  # type: ignore[no-untyped-def]
    """The same for slides through E, in every direction."""
    along = np.exp(1j * DIRECTIONS)[None]
    across = np.broadcast_to(1j * along, (len(e), len(DIRECTIONS)))
    low, high = _heights(path[:, None], across)
    slack, cosine = SHORT * (high - low), np.cos(aim.demand.transmission)
    shortest = (high - low + 2 * slack) / (2 * cosine)
    r5 = np.broadcast_to(radius[:, None], across.shape)
    offset = (e[:, None] * across.conj()).real
    with np.errstate(all="ignore"):
        spare = r5 / shortest - 1
        least = high + slack - cosine * r5
        share = (offset - least) / (low - slack + cosine * r5 - least)
        sound = (spare > 0) & (share > 0) & (share < 1)
        excess = np.log(np.maximum(spare, 0.02))
        side = np.sign(((e - arc[:, ARC // 2])[:, None] * along.conj()).real)
    cost = np.where(sound, 0.0, INFEASIBLE - np.minimum(spare, 0.0))
    share = np.clip(np.nan_to_num(share, nan=0.5), 0.02, 0.98)
    return cost, np.stack([np.angle(across), excess, logit(share)], axis=-1), side
