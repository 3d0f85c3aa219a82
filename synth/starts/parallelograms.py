"""Parallelogram linkages for poses that are pure translations of each other.

With r1 = r3 and r2 = r4 the coupler keeps its angle, and every point of the body moves on a circle of
radius r2: the driver is at theta2 where P is at C + r2 exp(i theta2). So three poses or more have to lie on
one circle, whose centre C is given by them; two poses leave C free on their bisector. At theta2 = theta1 and
theta1 + pi all four joints lie on one line, the change points, past which the linkage may continue as an
antiparallelogram: the task motion has to lie between them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems import Box, Rotatability
from grashof.problems.values.arrays import (
    TURN,
    BoolArray,
    ComplexArray,
    FloatArray,
    IntArray,
    Limits,
    turned_beyond,
)
from grashof.synth.programme.start import Start
from grashof.synth.programme.whole_screening import fully_screened
from grashof.synth.quantities.driver_motion import meeting_order, shorter_way
from grashof.synth.quantities.regions import into
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import (
    GROUPS,
    Configurations,
    Screened,
    judge,
    violations_apart,
)
from grashof.synth.starts.sampled_dyads import arms, ground_pivots
from grashof.synth.starts.selection import feasible_starts, scores
from grashof.synth.theory.distinct import pick_apart

LEAST_TRANSMISSION = 1e-3  # rad: keeps the motion away from change points
STRAIGHT = 1e4  # sizes: points on a larger circle lie on a straight line
BRED, CHILDREN, GENERATIONS = 12, 100, 12  # of the best
SAMPLES, FEW = 30_000, 40
NEARBY = 5.0  # sizes: no farther away than limits demand
WIDTH, SHRINK = 0.3, 0.6  # of their variation, in sizes and shares, less and less
MOST, SPACING = 3000, 0.25  # among which the best are chosen, and their least difference
FARTHEST = 100.0  # sizes
FAULTY = 1e6  # subtracted from the score of a linkage that violates a requirement
ROUNDING = 1e-10  # sizes, rad
SHORTEST = 1e-6  # sizes, of a coupler


@dataclass(frozen=True, slots=True)
class Circle:
    """The circle on which P moves: centre, radius, and the largest distance of a target from it; sizes."""

    centre: complex
    radius: float
    off: float


def circle_through(targets: ComplexArray) -> Circle:
    """The circle nearest to three or more targets (N,), in least squares of the distances.

    A linear start (Kasa 1976: |p|^2 = 2 Re(conj(c) p) + k), then Gauss-Newton steps in centre and radius.

    >>> circle_through(4 + 5 * np.exp(1j * np.array([0.1, 0.5, 1.5, 2.0]))).off < 1e-12
    True
    """
    apart = targets - targets.mean()
    across = np.linalg.svd(np.stack([apart.real, apart.imag]), compute_uv=False)[1]
    if across < ROUNDING:
        return Circle(complex(np.nan), np.inf, float(across))
    one = np.ones(len(targets))
    given = np.stack([2 * targets.real, 2 * targets.imag, one], axis=1)
    x, y, k = np.linalg.lstsq(given, np.abs(targets) ** 2)[0]
    unknown = np.array([x, y, np.sqrt(max(k + x * x + y * y, 0.0))])
    for _ in range(20):
        arm = targets - complex(unknown[0], unknown[1])
        along = arm / np.maximum(np.abs(arm), 1e-300)
        slope = np.stack([along.real, along.imag, one], axis=1)
        step = np.linalg.lstsq(slope, np.abs(arm) - unknown[2])[0]
        unknown = unknown + step
        if not np.abs(step).max() > 1e-15 * np.abs(unknown).max():
            break
    centre, radius = complex(unknown[0], unknown[1]), float(unknown[2])
    return Circle(centre, radius, float(np.abs(np.abs(targets - centre) - radius).max()))


def parallelogram_starts(scaled: ScaledProblem, enough: int, rng: np.random.Generator) -> list[Start]:
    """Starts that are parallelogram linkages, the best first, then spread over all."""
    linkages = parallelograms(scaled, rng)
    starts = feasible_starts(scaled, linkages[linkages.feasible], enough)
    return [start.under(settled=True) for start in starts]


def parallelogram_obstacle(scaled: ScaledProblem) -> str:
    """Why three translated poses or more have no parallelogram linkage; empty where they may have."""
    poses = "the poses are pure translations of each other"
    circle = circle_through(scaled.targets)
    if circle.radius > STRAIGHT:
        return f"{poses} along a straight line, and parallelogram linkages carry a body along a circle"
    if circle.off > scaled.wanted.tolerance:
        off = f"{circle.off * scaled.frame.scale:.3g} {scaled.problem.length_unit}".strip()
        return f"{poses}, up to {off} off any one circle, along which parallelogram linkages carry a body"
    if scaled.wanted.rotatability is not Rotatability.ANY:
        return (
            f"{poses}: only parallelogram linkages carry the body through them, and their driver cannot "
            "turn fully without passing a change point"
        )
    _, half = _arc(scaled, _cranks(scaled, 1, np.random.default_rng(0)))
    if 2 * half[0] < np.pi:
        return ""
    return (
        f"{poses}, spread over {np.degrees(2 * half[0]):.4g} deg of a circle, and parallelogram linkages "
        "have less than 180 deg from one change point to the next"
    )


def parallelograms(scaled: ScaledProblem, rng: np.random.Generator) -> Screened:
    """Parallelogram linkages through translated poses: drawn, then the best varied."""
    circle = circle_through(scaled.targets) if len(scaled.targets) > 2 else Circle(0.0, 1.0, 0.0)
    off = circle.off > scaled.wanted.tolerance or circle.radius > STRAIGHT
    # none where they do not lie on a circle, or the driver has to turn fully
    if off or scaled.wanted.rotatability is not Rotatability.ANY:
        return _judged(scaled, _drawn(scaled, FEW, rng))[:0]
    drawn = _drawn(scaled, SAMPLES, rng)
    found = [_judged(scaled, drawn)]
    best, worth = _distinct_best(scaled, drawn, found[0])
    for generation in range(GENERATIONS):
        children = _varied(scaled, best, WIDTH * SHRINK**generation, rng)
        found.append(_judged(scaled, children))
        each = _worth(scaled, found[-1]).reshape(CHILDREN, len(best))
        winner, columns = each.argmax(axis=0), np.arange(len(best))
        better = each[winner, columns] > worth
        worth = np.maximum(worth, each[winner, columns])
        best = best.where(better, children[winner * len(best) + columns])
    linkages = Screened.joined(found)
    return linkages[~_short(linkages)]


@dataclass(frozen=True, slots=True)
class _Drawn:
    """Parallelograms: A at the first pose, from A to B, from O2 to A at the first pose; each (n,), sizes."""

    a: ComplexArray
    coupler: ComplexArray
    crank: ComplexArray

    def __len__(self) -> int:
        return len(self.a)

    def __getitem__(self, index: IntArray) -> _Drawn:
        return _Drawn(self.a[index], self.coupler[index], self.crank[index])

    def where(self, chosen: BoolArray, other: _Drawn) -> _Drawn:
        """These, or where chosen the other ones."""
        pairs = ((self.a, other.a), (self.coupler, other.coupler), (self.crank, other.crank))
        return _Drawn(*(np.where(chosen, new, old) for old, new in pairs))


def _drawn(scaled: ScaledProblem, samples: int, rng: np.random.Generator) -> _Drawn:
    """Random ones, one of A, B, O2 and O4 where it may be; the coupler mostly across the motion."""
    wanted, p, longest = scaled.wanted, scaled.targets[0], max(high for _, high in scaled.wanted.link_lengths)
    crank = _cranks(scaled, samples, rng)
    middle, half = _arc(scaled, crank)
    spread = np.where(rng.random(samples) < 0.5, 0.2, 1.0) * np.maximum(np.pi / 2 - half, 0.02)
    across = np.where(rng.random(samples) < 0.5, 0.5, -0.5) * np.pi
    direction = middle + across + spread * rng.uniform(-1, 1, samples)
    low, high = _both(wanted.link_lengths[0], wanted.link_lengths[2])
    low = max(low, 0.01)
    high = max(min(high, NEARBY), low)
    coupler = low * (high / low) ** rng.random(samples) * np.exp(1j * direction)
    least, most = wanted.coupler_arms or (0.0, NEARBY)
    arm = p + arms((least, max(min(most, NEARBY), least)), samples, rng)
    o2, o4 = (
        rng.choice(ground_pivots(box, longest, samples, rng), samples) for box in (wanted.o2, wanted.o4)
    )
    boxed = [number for number, box in ((2, wanted.o2), (3, wanted.o4)) if box not in (None, Box())]
    first = rng.choice([0, 1, *boxed], samples)
    a = np.choose(first, [arm, arm - coupler, o2 + crank, o4 - coupler + crank])
    return _kept(scaled, _Drawn(a, coupler, crank))


def _cranks(scaled: ScaledProblem, samples: int, rng: np.random.Generator) -> ComplexArray:
    """From O2 to A at the first pose: from the centre of the circle to the first target."""
    targets, wanted = scaled.targets, scaled.wanted
    if len(targets) > 2:
        return np.full(samples, targets[0] - circle_through(targets).centre)
    chord = targets[1] - targets[0]
    if wanted.theta2_start_deg is not None:  # one circle through both: |chord + crank| = |crank|
        toward = np.exp(1j * np.radians(wanted.theta2_start_deg))
        along = -2 * (chord.conjugate() * toward).real
        return np.full(samples, toward * abs(chord) ** 2 / along if along > 1 / STRAIGHT else np.nan)
    low, high = _both(wanted.link_lengths[1], wanted.link_lengths[3])
    low = max(low, abs(chord) / 2)
    radius = low * (max(high, low) / low) ** rng.random(samples)
    return _on_bisector(chord, radius, np.where(rng.random(samples) < 0.5, 1, -1))


def _on_bisector(chord: complex, radius: FloatArray, side: IntArray | FloatArray) -> ComplexArray:
    """From a point on the bisector of a chord, left (+1) or right (-1) of it, to the start of the chord."""
    height = np.sqrt(np.maximum(radius**2 - abs(chord) ** 2 / 4, 0.0))
    return np.asarray(-chord / 2 - 1j * side * height * chord / abs(chord), dtype=np.complex128)


def _arc(scaled: ScaledProblem, crank: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Middle and half width of the shortest arc that holds all driver angles, shape (n,), rad."""
    _, theta2, _ = meeting_order(np.angle(crank[:, None] + scaled.targets - scaled.targets[0]))
    return theta2[:, [0, -1]].mean(axis=1), (theta2[:, -1] - theta2[:, 0]) / 2


def _varied(scaled: ScaledProblem, parents: _Drawn, width: float, rng: np.random.Generator) -> _Drawn:
    """Children of each parent: as many rows of all parents."""
    shape = (CHILDREN, len(parents))
    shift, turn = ((rng.normal(size=shape) + 1j * rng.normal(size=shape)) * width for _ in range(2))
    crank = np.broadcast_to(parents.crank, shape)
    if len(scaled.targets) == 2 and scaled.wanted.theta2_start_deg is None:
        chord = scaled.targets[1] - scaled.targets[0]
        radius: FloatArray = np.maximum(
            np.abs(crank) * np.exp(width * rng.normal(size=shape)), abs(chord) / 2
        )
        crank = _on_bisector(chord, radius, np.where((crank / chord).imag > 0, -1, 1))
    a, coupler = parents.a + shift, parents.coupler * np.exp(turn)
    return _kept(scaled, _Drawn(a.ravel(), coupler.ravel(), crank.ravel()))


def _kept(scaled: ScaledProblem, drawn: _Drawn) -> _Drawn:
    """Moved into the boxes of the ground pivots, the ground line turned as it has to be."""
    wanted, coupler = scaled.wanted, drawn.coupler
    if wanted.ground_angle_deg is not None:
        (allowed,) = wanted.ranges("ground_angle_deg").values()
        angle = np.angle(coupler)
        coupler = np.abs(coupler) * np.exp(1j * (angle - turned_beyond(angle, allowed)))
    o2 = into(wanted.o2, drawn.a - drawn.crank)
    o4 = into(wanted.o4, o2 + coupler)
    if wanted.ground_angle_deg is None:
        coupler = o4 - o2
    else:
        o2 = o4 - coupler
    return _Drawn(o2 + drawn.crank, coupler, drawn.crank)


def _judged(scaled: ScaledProblem, drawn: _Drawn) -> Screened:
    """The violations of each; a motion up to a change point leaves the branch."""
    wanted, count = scaled.wanted, len(drawn)
    moved = scaled.targets - scaled.targets[0]
    a, b = drawn.a[:, None] + moved, (drawn.a + drawn.coupler)[:, None] + moved
    o2 = drawn.a - drawn.crank
    o4, p = o2 + drawn.coupler, np.full(count, scaled.targets[0])
    angle = np.angle(a - o2[:, None])
    visit = np.broadcast_to(np.arange(len(moved)), angle.shape)
    if wanted.order:
        theta2, direction = shorter_way(angle)
    else:
        visit, theta2, direction = meeting_order(angle)
    found = Configurations(o2, o4, a, b, visit, theta2, direction, scaled.kind)
    violations = violations_apart(found, p, np.broadcast_to(scaled.targets, a.shape), wanted)
    violations[:, GROUPS.index("order")] += np.maximum(np.ptp(theta2, axis=1) - TURN, 0)
    first_turn = np.full(count, scaled.turns[0])
    linkages = judge(found, p, np.zeros(count), violations, wanted, first_turn=first_turn)
    if wanted.same_branch:
        near = np.maximum(LEAST_TRANSMISSION - linkages.transmission, 0.0)
        linkages.violations[:, GROUPS.index("same_branch")] += near
    linkages.violations[linkages.violations < ROUNDING] = 0.0
    return fully_screened(scaled, linkages)


def _distinct_best(scaled: ScaledProblem, drawn: _Drawn, found: Screened) -> tuple[_Drawn, FloatArray]:
    """The best that differ, to be varied, and their worth."""
    worth = _worth(scaled, found)
    points = np.concatenate([found.points[:, :3].real, found.points[:, :3].imag], axis=1)
    top = np.argsort(-worth, kind="stable")[:MOST]
    best = top[pick_apart(points[top], worth[top], SPACING, BRED)]
    return drawn[best], worth[best]


def _worth(scaled: ScaledProblem, found: Screened) -> FloatArray:
    """Scores of linkages without violations; below all of them, those with some."""
    lacking = found.violations.sum(axis=1)
    worth: FloatArray = np.where(lacking > 0, -FAULTY - lacking, scores(scaled, found))
    return np.where(_short(found), -np.inf, np.nan_to_num(worth, nan=-np.inf))


def _short(found: Screened) -> BoolArray:
    """Those without a coupler, as where both pivots were moved into the same corner."""
    _, _, a, b, _ = found.points.T
    return np.asarray(np.abs(a - b) < SHORTEST)


def _both(first: Limits, second: Limits) -> Limits:
    """The limits that two links of equal length keep."""
    return max(first[0], second[0]), min(first[1], second[1], FARTHEST)
