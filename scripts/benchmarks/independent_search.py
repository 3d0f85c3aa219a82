"""Find least-squares designs under limits by a second way, which shares nothing with `grashof.synth`.

Everything is an unknown: pivots, lengths, coupler point, and the driver angle at every target. The loop is
closed by the elbow formula, every limit is a residual once it is overstepped, and Levenberg-Marquardt
improves many random starts at once, with differences for derivatives. Sequential quadratic programming
(SLSQP of scipy) brings the best within their limits, and `grashof.analysis.judge.verify` judges them.

It is a plain reference. It covers free and timed points met in order, poses with position and angle, and
functions of links that turn, by the driver's angle or the length of a cylinder on it, but neither areas kept
out nor user constraints.
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from independent_limits import INSIDE, NUDGE, Aim, Designs, misses, oversteps, places, slopes
from scipy.optimize import minimize

from grashof.analysis import Verdict, verify
from grashof.problems import Cylinder, FourBar, Problem
from grashof.problems.values.arrays import TURN, FloatArray

STARTS, POLISHED = 800, 40
STAGES = ((1.0, 0.3, 20), (0.6, 1.0, 30), (0.4, 10.0, 60))  # share kept, weight of a limit, steps


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
    triangles = (
        np.empty((count, 0)) if aim.lengthening is None else cylinders(aim.lengthening[-1], count, rng)
    )
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
    if not aim.placed:
        x[:, 4:7] -= np.log(r1)[:, None]
        scale, turn = np.exp(0.5 * rng.normal(size=count)), rng.uniform(-np.pi, np.pi, count)
        if aim.anywhere:
            x[:, :2] = rng.normal(size=(count, 2))
            x[:, 2:4] = x[:, :2] + scale[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
            x[:, 4:7] += np.log(scale)[:, None]
        x[:, 10] += turn
    designs = Designs(np.concatenate([x, triangles], axis=1), elbow, sense)
    if aim.placed:
        at = places(aim, designs)
        middle = at.p.mean(axis=1, keepdims=True)
        spread = at.p - middle
        z = (spread.conj() @ aim.points / (np.abs(spread) ** 2).sum(axis=1))[:, None]  # of least squares
        o2, o4 = ((z * (joint - middle))[:, 0] for joint in (at.o2, at.o4))
        x[:, 0], x[:, 1], x[:, 2], x[:, 3] = o2.real, o2.imag, o4.real, o4.imag
        x[:, 4:7] += np.log(np.abs(z))
        x[:, 7:9] *= np.abs(z)
        x[:, 10:] += np.angle(z)
    if aim.turned:
        at = places(aim, designs)
        side = 1.0 if aim.placed else sense[:, None]
        designs.x[:, 9] = np.angle(
            (np.exp(1j * side * aim.angles) * (at.b - at.of(aim.link)).conj()).sum(axis=1)
        )
    return designs


def cylinders(stroke: float, count: int, rng: np.random.Generator) -> FloatArray:
    """Logarithms (count, 3) of base, arm and closed length of cylinders that turn a driver by a stroke."""
    closed, arm = stroke * np.exp(rng.uniform([0.5, -1.0], [2.0, 1.5], (16 * count, 2))).T
    first = rng.uniform(0.2, 2.8, 16 * count)  # angle between base and arm
    base = arm * np.cos(first) + np.sqrt(np.maximum(closed**2 - (arm * np.sin(first)) ** 2, 0))
    turns = (closed > arm * np.sin(first)) & (base > 0) & (base + arm > 1.02 * (closed + stroke))
    return np.asarray(np.log(np.column_stack([base, arm, closed])[turns][:count]))


def penalised(aim: Aim, designs: Designs, kept: int = POLISHED) -> Designs:
    """The best designs, each a basin of its own, with limits as penalties that grow from stage to stage."""
    starts = len(designs.x)
    for share, weight, steps in STAGES:
        designs, cost = improved(aim, designs, weight, steps)
        designs = distinct(aim, designs, cost)[: max(kept, round(share * starts))]
    return designs[:kept]


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


def cylinder_of(aim: Aim, design: Designs) -> Cylinder | None:
    """The cylinder of a design, with its pivot on O2A."""
    if aim.lengthening is None:
        return None
    zero, base, arm = design.x[0, 10], *(aim.size * np.exp(design.x[0, 11:13]))
    foot = linkage_of(aim, design).o2 + base * np.array([np.cos(zero), np.sin(zero)])
    return Cylinder("driver", (float(foot[0]), float(foot[1])), (float(arm), 0.0))


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


def search(
    problem: Problem, starts: int = STARTS, seed: int = 0, potential: Any = None, kept: int = POLISHED
) -> Best | None:
    """The best design of a least-squares problem from random starts; None where the judge accepts none.

    Of the starts the `kept` best are polished.

    ValueError: the problem has a requirement that this search does not know.
    """
    aim = Aim.of(problem, potential)
    designs = penalised(aim, drawn(aim, starts, np.random.default_rng(seed)), kept)
    found = [polished(aim, designs[row : row + 1], steady=False) for row in range(len(designs.x))]
    if slopes(aim, places(aim, designs)).size:
        found += [polished(aim, design, steady=True) for design, _ in found]
    best: Best | None = None
    for design, square in sorted(found, key=lambda item: item[1]):
        if square == np.inf or (best and square * aim.size**2 >= best.verdict.square):
            break
        linkage, cylinder = linkage_of(aim, design), cylinder_of(aim, design)
        verdict = verify(linkage, problem.task, problem.requirements, problem=problem, cylinder=cylinder)
        if verdict.ok and (best is None or verdict.square < best.verdict.square):
            best = Best(linkage, verdict, float(np.sqrt(verdict.square / len(problem.task))))
    return best
