"""Find least-squares designs under limits by a second way, which shares nothing with `grashof.synth`.

Everything is an unknown: pivots, lengths, coupler point, and the driver angle at every target. The loop is
closed by the elbow formula, every limit is a residual once it is overstepped, and Levenberg-Marquardt
improves many random starts at once, with differences for derivatives. Sequential quadratic programming
(SLSQP of scipy) brings the best within their limits, and `grashof.analysis.judge.verify` judges them.

It is a plain reference. It covers free and timed points met in order, and poses with position and angle, but
neither areas kept out nor user constraints.
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from independent_geometry import HAIR, apart, elbow, past_toggle, sides
from scipy.optimize import minimize

from grashof.analysis import Verdict, verify
from grashof.problems import Box, FourBar, Problem, Region, Requirements, Rotatability
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray

STARTS, POLISHED = 800, 40
# Distance of designs from their limits, sizes and rad (the judge forgives 1e-9); step of differences.
INSIDE, NUDGE = 2e-7, 1e-7
STAGES = ((1.0, 0.3, 20), (0.6, 1.0, 30), (0.4, 10.0, 60))  # share kept, weight of a limit, steps


@dataclass(frozen=True, slots=True)
class Aim:
    """A task in its own size about its own middle; `wanted` stays in lengths of the problem."""

    size: float
    middle: complex
    points: ComplexArray
    angles: FloatArray
    root_weights: FloatArray
    angle_length: float
    timing: FloatArray
    closed: bool
    wanted: Requirements
    turned: bool  # the targets have angles
    timed: bool  # the driver rotations are prescribed
    over_turn: bool  # the transmission angle counts over the full turn
    potential: Any = None  # whose slope is wanted, see `wanted_torque.Potential`

    @classmethod
    def of(cls, problem: Problem, potential: Any = None) -> "Aim":
        """The aim of a problem."""
        task, wanted = problem.task, problem.requirements.resolved(problem.task.size)
        set_angles = (wanted.ground_angle_deg, wanted.theta2_start_deg) != (None, None)
        if wanted.keep_out or not wanted.order or not wanted.same_branch or set_angles:
            raise ValueError("areas, other branches, any order and prescribed angles are not known here")
        places = task.positions @ np.array([1, 1j])
        middle, size = complex(places.mean()), task.size
        if not (task.is_whole or task.only_points):
            raise ValueError("poses with free parts are not known here")
        return cls(
            size, middle, (places - middle) / size, task.angles, np.sqrt(task.weights),
            task.angle_length / size, task.driver_turns, task.closed, wanted,
            turned=not np.isnan(task.angles).any(), timed=not np.isnan(task.driver_turns).any(),
            over_turn=task.closed or wanted.transmission_over == "cycle",
            potential=potential,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Designs:
    """A batch of B designs being improved."""

    x: FloatArray  # (B, n): O2, O4, logarithms of r2, r3, r4, coupler point, body angle, driver angles
    elbow: FloatArray  # (B,): side of B on A-O4, +1 or -1
    sense: FloatArray  # (B,): of the driver, +1 or -1

    def __getitem__(self, rows: IntArray | slice) -> "Designs":
        return Designs(*(getattr(self, name)[rows] for name in self.__slots__))

    def nudged(self) -> "Designs":
        """Each design, and n copies with one unknown each slightly increased, all in one batch."""
        count, unknowns = self.x.shape
        many = self[np.repeat(np.arange(count), unknowns + 1)]
        nudge = NUDGE * np.vstack([np.zeros(unknowns), np.eye(unknowns)])
        return replace(many, x=many.x + np.tile(nudge, (count, 1)))


@dataclass(frozen=True, slots=True)
class Places:
    """Joints of a batch at every target: complex of shape (B, N), lengths of shape (B, 1)."""

    o2: ComplexArray
    o4: ComplexArray
    r2: FloatArray
    r3: FloatArray
    r4: FloatArray
    coupler: ComplexArray
    body: FloatArray
    theta2: FloatArray
    a: ComplexArray
    b: ComplexArray
    p: ComplexArray

    @property
    def r1(self) -> FloatArray:
        """Length O2O4, shape (B, 1)."""
        return np.abs(self.o4 - self.o2)


def places(aim: Aim, designs: Designs) -> Places:
    """All joints at all targets; where a loop does not close, links 3 and 4 are in line."""
    x = designs.x
    o2, o4, coupler = (x[:, k : k + 1] + 1j * x[:, k + 1 : k + 2] for k in (0, 2, 7))
    r2, r3, r4 = (np.exp(np.clip(x[:, k : k + 1], -20, 20)) for k in (4, 5, 6))
    theta2 = x[:, 10:]
    if aim.timed:
        theta2 = theta2 + designs.sense[:, None] * aim.timing
    a = o2 + r2 * np.exp(1j * theta2)
    b = a + elbow(o4 - a, r3, r4, designs.elbow[:, None])
    p = a + coupler * (b - a) / np.abs(b - a)
    return Places(o2, o4, r2, r3, r4, coupler, x[:, 9:10], theta2, a, b, p)


def misses(aim: Aim, designs: Designs, at: Places) -> FloatArray:
    """Terms of the sum of squares: weighted distances of points, turns of poses as lengths; shape (B, M)."""
    gap = (at.p - aim.points) * aim.root_weights
    parts = [gap.real, gap.imag]
    if aim.turned:
        turn = np.angle((at.b - at.a) * np.exp(1j * (at.body - aim.angles)))
        parts.append(turn * aim.angle_length * aim.root_weights)
    if aim.potential is not None:
        untimed = replace(aim, timed=False)

        def turned(theta2: FloatArray) -> Places:
            return places(untimed, replace(designs, x=np.concatenate([designs.x[:, :10], theta2], axis=1)))

        ends = at.theta2[:, :1], at.theta2[:, -1:]
        parts.append(np.sqrt(len(aim.points)) * aim.potential.misses(turned, *ends, designs.sense[:, None]))
    return np.concatenate(parts, axis=1)


def oversteps(aim: Aim, designs: Designs, at: Places) -> FloatArray:
    """Excess over each limit, negative inside; shape (B, K)."""
    wanted, rows = aim.wanted, list[FloatArray]()

    def within(value: FloatArray, limits: tuple[float, float], middle: float = 0.0) -> None:
        for side, limit in zip((-1, 1), limits, strict=True):
            if np.isfinite(limit):
                rows.append(side * (value - (limit - middle) / aim.size) + INSIDE)

    lengths = np.concatenate([at.r1, at.r2, at.r3, at.r4], axis=1)
    for number, limits in enumerate(wanted.link_lengths):
        within(lengths[:, number : number + 1], limits)
    ratio = lengths.max(axis=1) / lengths.min(axis=1)
    rows.append(np.log(ratio / wanted.link_ratio_max)[:, None] + INSIDE)
    for name, limits in wanted.ranges("link_ratios").items():
        one, other = (getattr(at, link) for link in name.split("/"))
        for side, limit in zip((-1, 1), limits, strict=True):
            rows.append(side * np.log(one / other / limit) + INSIDE * (limits[0] < limits[1]))
    for single, k in ((each, number - 1) for each in wanted.at for number in each.targets):
        for box, joint in ((single.a, at.a[:, [k]]), (single.b, at.b[:, [k]])):
            within(joint.real, (box or Box()).x, aim.middle.real)
            within(joint.imag, (box or Box()).y, aim.middle.imag)
        for name, limits in single.named.get("distances", {}).items():
            within(apart(at, name)[:, [k]], limits)
        if single.coupler_angle_deg is not None:
            low, high = np.radians(single.coupler_angle_deg).tolist()
            off = np.angle((at.b - at.a)[:, [k]] * np.exp(-0.5j * (low + high)))
            rows.append(np.abs(off) - (high - low) / 2 + INSIDE)
        if single.past_deg is not None:
            low, high = (aim.size * np.radians(single.past_deg)).tolist()
            within(past_toggle(at, k), (low, high))
    for name, limits in wanted.ranges("distances").items():
        within(apart(at, name), limits)
    for arm in (at.coupler, at.coupler - at.r3):
        within(np.abs(arm), wanted.coupler_arms or (0.0, np.inf))
    for name in ("o2", "o4", "a", "b"):
        box, joint = getattr(wanted, name), getattr(at, name)
        within(joint.real, box.x, aim.middle.real)
        within(joint.imag, box.y, aim.middle.imag)
        for normal, least in sides(box) if isinstance(box, Region) else ():
            middle = (aim.middle * normal.conjugate()).real
            within((joint * normal.conjugate()).real, (least, np.inf), middle)
    rows += [*turning(aim, at), *transmission(aim, at)]
    if not aim.timed:
        step = designs.sense[:, None] * np.diff(at.theta2, axis=1)
        rows += [-step, step.sum(axis=1, keepdims=True) - TURN + INSIDE]
    return np.concatenate(rows, axis=1)


def turning(aim: Aim, at: Places) -> list[FloatArray]:
    """Whether the driver turns fully: the diagonal A-O4 stays between |r3 - r4| and r3 + r4."""
    kind, margin = aim.wanted.rotatability, aim.wanted.rotatability_margin
    if kind is Rotatability.ANY:
        if not aim.closed:
            return []
        margin = 0.0
    longer = at.r2 - at.r1 if kind is Rotatability.DOUBLE_CRANK else at.r1 - at.r2
    if kind not in (Rotatability.CRANK_ROCKER, Rotatability.DOUBLE_CRANK):
        longer = np.abs(longer)
    least = margin * (at.r1 + at.r2 + at.r3 + at.r4) + INSIDE
    difference, stretched = at.r3 - at.r4, at.r3 + at.r4 - at.r1 - at.r2
    return [least - stretched, least - longer + difference, least - longer - difference]


def transmission(aim: Aim, at: Places) -> list[FloatArray]:
    """The diagonal A-O4 stays between the lengths at which mu reaches its least and its greatest value."""
    least = np.radians(aim.wanted.transmission_min_deg) + INSIDE
    square, product = at.r3**2 + at.r4**2, 2 * at.r3 * at.r4 * np.cos(least)
    shortest, longest = np.abs(at.r1 - at.r2), at.r1 + at.r2
    if not aim.over_turn:
        # Driver angles from the ground line; A passes it within the motion or not.
        around = (at.theta2 - np.angle(at.o4 - at.o2)) / TURN
        low, high = around.min(axis=1, keepdims=True), around.max(axis=1, keepdims=True)
        ends = np.abs(at.o4 - at.a)[:, [0, -1]] + HAIR
        folded, drawn = np.floor(high) > np.floor(low), np.floor(high - 0.5) > np.floor(low - 0.5)
        shortest = np.where(folded, shortest, ends.min(axis=1, keepdims=True))
        longest = np.where(drawn, longest, ends.max(axis=1, keepdims=True))
    return [np.sqrt(square - product) - shortest, longest - np.sqrt(square + product)]


def slopes(aim: Aim, at: Places) -> FloatArray:
    """Half the derivative of the squares by the driver angles on which limits depend; (B, 0) if none do.

    The judge takes the driver angles that come nearest. Where the transmission angle at the ends or the
    places of A and B are limited, a design may not gain by others.
    """
    boxed = (aim.wanted.a, aim.wanted.b) != (Box(), Box()) or bool(aim.wanted.at or aim.wanted.distances)
    if aim.over_turn and not boxed and aim.potential is None:
        return np.empty((len(at.p), 0))
    coupler, output, driver = at.b - at.a, at.b - at.o4, at.a - at.o2
    down = (coupler.conj() * output).imag
    rate3 = -(driver.conj() * output).imag / np.where(np.abs(down) < 1e-9, 1e-9, down)
    rate_p = 1j * (driver + (at.p - at.a) * rate3)
    slope = aim.root_weights**2 * ((at.p - aim.points).conj() * rate_p).real
    if aim.turned:
        turn = np.angle(coupler * np.exp(1j * (at.body - aim.angles)))
        slope = slope + (aim.root_weights * aim.angle_length) ** 2 * turn * rate3
    if aim.timed:
        slope = slope.sum(axis=1, keepdims=True)
    elif not boxed:
        slope = slope[:, [0, -1]]
    return slope


def residuals(aim: Aim, designs: Designs, weight: float) -> FloatArray:
    """Misses, and limits overstepped at this weight of their squares; shape (B, M + K)."""
    at = places(aim, designs)
    over = np.maximum(oversteps(aim, designs, at), 0.0)
    return np.concatenate([misses(aim, designs, at), np.sqrt(weight) * over], axis=1)


def improved(aim: Aim, designs: Designs, weight: float, steps: int) -> tuple[Designs, FloatArray]:
    """Designs after Levenberg-Marquardt steps, and their sums of squares, shape (B,)."""
    count, unknowns = designs.x.shape
    damping = np.full(count, 1e-2)
    cost = (residuals(aim, designs, weight) ** 2).sum(axis=1)
    for _ in range(steps):
        rows = residuals(aim, designs.nudged(), weight).reshape(count, unknowns + 1, -1)
        slope = (rows[:, 1:] - rows[:, :1]) / NUDGE
        normal = slope @ slope.swapaxes(1, 2)
        scale = damping[:, None] * (np.einsum("bii->bi", normal) + 1e-9)
        damped = normal + scale[:, :, None] * np.eye(unknowns)
        step = np.linalg.solve(damped, slope @ rows[:, 0, :, None])[..., 0]
        moved = replace(designs, x=designs.x - np.clip(step, -0.5, 0.5))
        new = (residuals(aim, moved, weight) ** 2).sum(axis=1)
        better = new < cost
        designs = replace(designs, x=np.where(better[:, None], moved.x, designs.x))
        cost = np.where(better, new, cost)
        damping = np.clip(np.where(better, damping / 4, damping * 4), 1e-12, 1e8)
    return designs, cost


def drawn(aim: Aim, count: int, rng: np.random.Generator) -> Designs:
    """Random linkages with driver angles in order, turned, scaled and moved onto the targets."""
    sense, elbow = rng.choice([-1.0, 1.0], (2, count))
    x = np.zeros((count, 10 + (len(aim.points) if not aim.timed else 1)))
    r1, r2, r3, r4 = np.exp(rng.uniform(np.log(0.1), 0, (4, count)))
    x[:, 2] = r1
    x[:, 4:7] = np.log([r2, r3, r4]).T
    wide = rng.random((count, 1)) < 0.5  # half of them far from the usual: long arms, uneven driver angles
    x[:, 7:9] = rng.normal(size=(count, 2)) * np.where(wide, np.exp(rng.uniform(-1, 1.1, (count, 1))), 0.7)
    x[:, 10:] = rng.uniform(-np.pi, np.pi, (count, 1))
    if not aim.timed:
        gaps = np.exp(rng.normal(size=(count, len(aim.points))) * np.where(wide, 0.6, 0.3))
        turn = TURN if aim.closed else rng.uniform(1, TURN, (count, 1))
        steps = turn * gaps / gaps.sum(axis=1, keepdims=True)
        x[:, 11:] += sense[:, None] * np.cumsum(steps[:, :-1], axis=1)
    designs = Designs(x, elbow, sense)
    at = places(aim, designs)
    middle = at.p.mean(axis=1, keepdims=True)
    spread = at.p - middle
    z = (spread.conj() @ aim.points / (np.abs(spread) ** 2).sum(axis=1))[:, None]  # the fit of least squares
    o2, o4 = ((z * (joint - middle))[:, 0] for joint in (at.o2, at.o4))
    x[:, 0], x[:, 1], x[:, 2], x[:, 3] = o2.real, o2.imag, o4.real, o4.imag
    x[:, 4:7] += np.log(np.abs(z))
    x[:, 7:9] *= np.abs(z)
    x[:, 10:] += np.angle(z)
    if aim.turned:
        at = places(aim, designs)
        x[:, 9] = np.angle((np.exp(1j * aim.angles) * (at.b - at.a).conj()).sum(axis=1))
    return designs


def penalised(aim: Aim, designs: Designs) -> Designs:
    """The best designs, each a basin of its own, with limits as penalties that grow from stage to stage."""
    starts = len(designs.x)
    for share, weight, steps in STAGES:
        designs, cost = improved(aim, designs, weight, steps)
        designs = distinct(aim, designs, cost)[: max(POLISHED, round(share * starts))]
    return designs[:POLISHED]


def distinct(aim: Aim, designs: Designs, cost: FloatArray) -> Designs:
    """Designs without copies, those of least cost first."""
    designs = designs[np.argsort(cost, kind="stable")]
    at = places(aim, designs)
    joints = np.concatenate([at.a, at.b, at.p], axis=1)
    kept: list[int] = []
    for row, joint in enumerate(joints):
        if not kept or np.abs(joints[kept] - joint).max(axis=1).min() > 0.01:
            kept.append(row)
    return designs[np.array(kept)]


def polished(aim: Aim, design: Designs, steady: bool) -> tuple[Designs, float]:
    """A design brought within its limits, and its sum of squares; infinite where that fails.

    `steady` requires the driver angles nearest to their targets where limits depend on them.
    """

    @lru_cache(maxsize=1)
    def batch(key: bytes) -> tuple[FloatArray, FloatArray, FloatArray]:
        designs = replace(design, x=np.frombuffer(key)[None]).nudged()
        at = places(aim, designs)
        return misses(aim, designs, at), -oversteps(aim, designs, at), slopes(aim, at)

    def value(x: FloatArray, part: int) -> FloatArray:
        found: FloatArray = batch(x.tobytes())[part][0]
        return found

    def change(x: FloatArray, part: int) -> FloatArray:
        found: FloatArray = (batch(x.tobytes())[part][1:] - value(x, part)).T / NUDGE
        return found

    def square(x: FloatArray) -> float:
        return float((value(x, 0) ** 2).sum()) / unit

    def square_change(x: FloatArray) -> FloatArray:
        return 2 * value(x, 0) @ change(x, 0) / unit

    unit = float((value(design.x[0], 0) ** 2).sum()) + 1e-12
    held = (("ineq", 1), ("eq", 2)) if steady else (("ineq", 1),)
    limits: list[Any] = [{"type": kind, "fun": value, "jac": change, "args": (part,)} for kind, part in held]
    least: Any = {"maxiter": 300, "ftol": 1e-10}
    x = minimize(square, design.x[0], jac=square_change, constraints=limits, method="SLSQP", options=least).x
    if not np.isfinite(x).all() or value(x, 1).min() < -INSIDE:
        return design, np.inf
    return replace(design, x=x[None]), square(x) * unit


def linkage_of(aim: Aim, design: Designs) -> FourBar:
    """A design as a linkage, in lengths of the problem."""
    at = places(aim, design)
    o2, o4 = (pivot[0, 0] * aim.size + aim.middle for pivot in (at.o2, at.o4))
    r2, r3, r4 = (float(length[0, 0]) * aim.size for length in (at.r2, at.r3, at.r4))
    point = at.coupler[0, 0] * aim.size
    return FourBar(
        (o2.real, o2.imag), (o4.real, o4.imag), r2, r3, r4, (point.real, point.imag),
        int(design.elbow[0]), float(at.body[0, 0]) if aim.turned else 0.0,
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Best:
    """The best design found that the judge accepts; `error` is sqrt(square / targets), length."""

    linkage: FourBar
    verdict: Verdict
    error: float


def search(problem: Problem, starts: int = STARTS, seed: int = 0, potential: Any = None) -> Best | None:
    """The best design of a least-squares problem from random starts; None where the judge accepts none.

    ValueError: the problem has a requirement that this search does not know.
    """
    aim = Aim.of(problem, potential)
    designs = penalised(aim, drawn(aim, starts, np.random.default_rng(seed)))
    found = [polished(aim, designs[row : row + 1], steady=False) for row in range(len(designs.x))]
    if slopes(aim, places(aim, designs)).size:
        found += [polished(aim, design, steady=True) for design, _ in found]
    best: Best | None = None
    for design, square in sorted(found, key=lambda item: item[1]):
        if square == np.inf or (best and square * aim.size**2 >= best.verdict.square):
            break
        linkage = linkage_of(aim, design)
        verdict = verify(linkage, problem.task, problem.requirements, problem=problem)
        if verdict.ok and (best is None or verdict.square < best.verdict.square):
            best = Best(linkage, verdict, float(np.sqrt(verdict.square / len(problem.task))))
    return best
