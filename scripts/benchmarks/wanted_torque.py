"""Wanted torques against independent searches with ten times the time, which share nothing with `synth`.

Three poses are met by circles through three places of each joint, and the joints move by a simplex search;
points and torques together are fitted by `independent_search.py`. Their torque is the slope of a potential.
Both values are the judge's.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from time import process_time
from types import SimpleNamespace
from typing import Any

import numpy as np
from independent_limits import elbow
from independent_search import STARTS, search
from measuring import Case
from scipy.optimize import minimize

from grashof import synthesize
from grashof.analysis import verify
from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import (
    DynamicsSpec,
    FourBar,
    PathTask,
    Problem,
    ProblemError,
    Requirements,
    WantedTorque,
)
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray
from grashof.problems.values.dynamics.load_specs import LoadSpec, Place, SpringSpec

EFFORT = 10  # multiple of the time of `synthesize`
SLOW = 1e-3  # rpm: negligible inertia
ROWS, POINTS, NOISE, WEIGHT = 6, 8, 0.03, 0.1
DRAWS, BEST, STEPS = 20_000, 12, 800
SIMPLEX: Any = {"maxiter": STEPS, "maxfev": STEPS, "xatol": 1e-9, "fatol": 1e-12}
MISSED = 1e6
STEP = 1e-4  # rad
WITHIN = 1.02


def loaded(rng: np.random.Generator, count: int) -> Problem:
    """Poses of a linkage with bars, a payload, a force and a spring, and a torque wanted at random."""
    task, _ = planted_motion(rng, count)
    size = task.size
    places = [tuple(rng.uniform(-far * size, far * size, 2).tolist()) for far in (2, 1, 0.5)]
    spec = DynamicsSpec(
        mass_per_length=float(rng.uniform(0.5, 3)), payload=float(rng.uniform(5, 40)), speed_rpm=SLOW,
        gravity=(0, -9.80665),
        loads=(LoadSpec(3, at=places[2], force=tuple(rng.uniform(-200, 200, 2).tolist())),),
        springs=(
            SpringSpec((Place(1, places[0]), Place(3, places[1])), float(rng.uniform(50, 500)), 0.3 * size),
        ),
    )  # fmt: skip
    torques = 100 * size * (rng.normal() + np.cumsum(0.4 * rng.normal(size=ROWS)))
    rows = tuple(zip(np.linspace(0, 1, ROWS).tolist(), torques.tolist(), strict=True))
    return Problem(task=task, length_unit="m", dynamics=spec, torque=WantedTorque(rows, "share"))


@dataclass(frozen=True, slots=True)
class Potential:
    """Lengths in sizes of the task, as the middle of its points; energies in N m.

    `places` of joints, given to `energy`, have o2, o4, a, b, p (complex) and the lengths r2, r3, r4.
    """

    size: float  # m
    middle: complex  # m
    shares: FloatArray
    torques: FloatArray  # N m, at these shares of the motion
    weight: float  # sizes of the position error for 1 N m of the deviation (rms)
    gravity: complex
    per_length: float  # kg/m of bars
    payload: float
    forces: tuple[tuple[complex, complex], ...]  # on the coupler: its point (m, from A along AB), and N
    springs: tuple[tuple[complex, complex, float, float], ...]  # from the ground to the coupler, N/m and m

    @classmethod
    def of(cls, problem: Problem) -> "Potential":
        """The potential of a problem in metres, whose forces and springs act on the coupler."""
        spec, torque = problem.dynamics, problem.torque
        if spec is None or torque is None or torque.over != "share" or problem.length_unit != "m":
            raise ValueError("only a wanted torque over shares, in metres, is supported here")
        placed = problem.task.positions @ np.array([1, 1j])
        return cls(
            size=problem.task.size,
            middle=complex(placed.mean()),
            shares=torque.places,
            torques=torque.torques,
            weight=(torque.weight or 1.0) / torque.greatest / np.sqrt(len(torque.wanted)),
            gravity=complex(*spec.gravity),
            per_length=spec.mass_per_length or 0.0,
            payload=spec.payload,
            forces=tuple((complex(*load.at), complex(*(load.force or (0, 0)))) for load in spec.loads),
            springs=tuple(
                (
                    complex(*spring.between[0].at),
                    complex(*spring.between[1].at),
                    spring.stiffness,
                    spring.free_length,
                )
                for spring in spec.springs
            ),
        )

    def energy(self, places: Any) -> FloatArray:
        """The potential of linkages at their places, (B, K)."""
        a, b, p, o2, o4 = (
            self.size * each + self.middle for each in (places.a, places.b, places.p, places.o2, places.o4)
        )
        along = (b - a) / np.abs(b - a)
        total = self._falls(self.payload, p)
        for length, one, other in ((places.r2, o2, a), (places.r3, a, b), (places.r4, o4, b)):
            total = total + self._falls(self.per_length * self.size * length, (one + other) / 2)
        for at, force in self.forces:
            total = total - ((a + at * along) * force.conjugate()).real
        for ground, at, stiffness, free in self.springs:
            total = total + stiffness * (np.abs(a + at * along - ground) - free) ** 2 / 2
        return np.asarray(total)

    def misses(
        self, places: Callable[[FloatArray], Any], first: FloatArray, last: FloatArray, sense: FloatArray
    ) -> FloatArray:
        """Weighted slopes minus the wanted torques (B, K), from the driver's angles at the ends and sense."""
        theta2 = first + self.shares * (last - first)
        rise = self.energy(places(theta2 + STEP)) - self.energy(places(theta2 - STEP))
        return np.asarray(self.weight * (sense * rise / (2 * STEP) - self.torques))

    def _falls(self, mass: Any, at: ComplexArray) -> Any:
        return -mass * (at * self.gravity.conjugate()).real


@dataclass(frozen=True, slots=True)
class Circles:
    """Linkages through three poses, from A and B at the first (B, 4), in sizes about the middle."""

    problem: Problem
    potential: Potential
    points: ComplexArray
    turns: ComplexArray

    @classmethod
    def of(cls, problem: Problem) -> "Circles":
        """The circles of a problem."""
        task, potential = problem.task, Potential.of(problem)
        points = (task.positions @ np.array([1, 1j]) - potential.middle) / potential.size
        return cls(problem, potential, points, np.exp(1j * task.angles))

    def at_poses(self, joint: ComplexArray) -> ComplexArray:
        """A joint (B,) at every pose, (B, 3)."""
        turned: ComplexArray = (joint - self.points[0])[:, None] * self.turns / self.turns[0]
        return turned + self.points

    def deviations(self, x: FloatArray, sense: int) -> FloatArray:
        """Deviations (rms) as shares of the greatest wanted torque, infinite where limits are missed."""
        a, b = (self.at_poses(x[:, k] + 1j * x[:, k + 1]) for k in (0, 2))
        with np.errstate(all="ignore"):
            o2, o4 = centre(a), centre(b)
            r1, r2, r3, r4 = (
                np.abs(each) for each in (o4 - o2, a[:, 0] - o2, b[:, 0] - a[:, 0], b[:, 0] - o4)
            )
            side = np.sign(((o4[:, None] - a).conj() * (b - a)).imag)
            theta2 = np.angle(a - o2[:, None])
            steps = (sense * np.diff(theta2, axis=1)) % TURN
            theta2 = theta2[:, :1] + sense * np.concatenate(
                [0 * steps[:, :1], np.cumsum(steps, axis=1)], axis=1
            )
            lengths = np.stack([r1, r2, r3, r4], axis=1)
            margin = 1.001e-3 * lengths.sum(axis=1)
            arms = np.abs(np.stack([x[:, 0] + 1j * x[:, 1], x[:, 2] + 1j * x[:, 3]], axis=1) - self.points[0])
            sound = (
                (side == side[:, :1]).all(axis=1) & (steps.sum(axis=1) < TURN) & (lengths > 0.01).all(axis=1)
                & (lengths < 20).all(axis=1) & (lengths.max(axis=1) < 20 * lengths.min(axis=1))
                & (r3 + r4 - r1 - r2 > margin) & (np.abs(r1 - r2) - np.abs(r3 - r4) > margin)
                & (arms < 30).all(axis=1)
            )  # fmt: skip
            arm = (self.points[0] - a[:, :1]) / (b - a)[:, :1] * r3[:, None]

            def places(theta2: FloatArray) -> SimpleNamespace:
                at_a = o2[:, None] + r2[:, None] * np.exp(1j * theta2)
                along = elbow(o4[:, None] - at_a, r3[:, None], r4[:, None], side[:, :1])
                at_p, fixed = at_a + arm * along / r3[:, None], (o2, o4, r2, r3, r4)
                names = dict(
                    zip(("o2", "o4", "r2", "r3", "r4"), (each[:, None] for each in fixed), strict=True)
                )
                return SimpleNamespace(a=at_a, b=at_a + along, p=at_p, **names)

            misses = self.potential.misses(places, theta2[:, :1], theta2[:, -1:], np.array(sense))
            missed = np.sqrt((misses**2).sum(axis=1))
        return np.where(sound & np.isfinite(missed), missed, np.inf)

    @property
    def unit(self) -> float:
        """The greatest wanted torque, N m."""
        return float(np.abs(self.potential.torques).max())

    @property
    def first(self) -> FloatArray:
        """The guided point at the first pose, twice."""
        return np.array([self.points[0].real, self.points[0].imag] * 2)

    def deviation(self, x: FloatArray, sense: int) -> float:
        """The deviation of a single linkage, large where limits are missed."""
        return float(min(self.deviations(x[None], sense)[0], MISSED))

    def judged(self, x: FloatArray) -> float:
        """The deviation of a single linkage by the judge, N m; infinite where it is rejected."""
        try:
            linkage = self.linkage(x)
        except ProblemError:
            return np.inf
        problem = self.problem
        verdict = verify(linkage, problem.task, problem.requirements, problem=problem)
        return Values(linkage, verdict, problem)["torque_deviation"] if verdict.ok else np.inf

    def linkage(self, x: FloatArray) -> FourBar:
        """A single linkage, in metres."""
        a, b = (self.at_poses(x[None, k] + 1j * x[None, k + 1]) for k in (0, 2))
        o2, o4 = centre(a)[0], centre(b)[0]
        along = (b - a)[0, 0]
        arm = (self.points[0] - a[0, 0]) * abs(along) / along * self.potential.size
        size, middle = self.potential.size, self.potential.middle
        pivots = [((each * size + middle).real, (each * size + middle).imag) for each in (o2, o4)]
        assembly = int(np.sign(((o4 - a[0, 0]).conjugate() * along).imag))
        r2, r3, r4 = (float(size * abs(each)) for each in (a[0, 0] - o2, along, b[0, 0] - o4))
        turn = float(np.angle(self.turns[0] / along))
        return FourBar(pivots[0], pivots[1], r2, r3, r4, (arm.real, arm.imag), assembly, turn)


def centre(places: ComplexArray) -> ComplexArray:
    """Centre of the circle through three places (B, 3)."""
    one, two = places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]
    found: ComplexArray = places[:, 0] - 1j * (np.abs(one) ** 2 * two - np.abs(two) ** 2 * one) / (
        2 * (one.conj() * two).imag
    )
    return found


def by_circles(problem: Problem, seconds: float, seed: int) -> float:
    """The least deviation of a simplex search of that time, as the judge has it; N m."""
    circles, rng, least = Circles.of(problem), np.random.default_rng(seed), np.inf
    until = process_time() + seconds
    while process_time() < until:
        sense = int(rng.choice([-1, 1]))
        x = np.exp(rng.uniform(-2.5, 1.5, (DRAWS, 1))) * rng.normal(size=(DRAWS, 4)) + circles.first
        values = circles.deviations(x, sense)
        best = np.argsort(values)[:BEST]
        for start in x[best[np.isfinite(values[best])]]:
            found = minimize(circles.deviation, start, (sense,), method="Nelder-Mead", options=SIMPLEX)
            if found.fun * circles.unit < least:
                least = min(least, circles.judged(found.x))
    return float(least)


def by_points(problem: Problem, seconds: float) -> float:
    """The least error of rounds of the independent search in that time, m."""
    until, least, tried, potential = process_time() + seconds, np.inf, 0, Potential.of(problem)
    while process_time() < until or not tried:
        found = search(problem, STARTS, tried, potential)
        least, tried = min(least, np.inf if found is None else found.error), tried + 1
    return float(least)


def fitted(rng: np.random.Generator) -> Problem:
    """Random points and a random torque, fitted together."""
    stated = loaded(rng, POINTS)
    off = NOISE * stated.task.size * rng.normal(size=(POINTS, 2))
    torque = WantedTorque(() if stated.torque is None else stated.torque.wanted, "share", WEIGHT)
    task, wanted = PathTask(stated.task.positions + off), Requirements(exact=False)
    return Problem(task=task, requirements=wanted, length_unit="m", dynamics=stated.dynamics, torque=torque)


def compared(
    count: int,
    seed: int,
    draw: Callable[[np.random.Generator], Problem],
    key: str,
    other: Callable[[Problem, float, int], float],
) -> Iterator[str]:
    """The least value of each task, and that of another search with ten times the time."""
    worst = 0.0
    for number in range(count):
        problem = draw(np.random.default_rng([seed, number]))
        begun = process_time()
        result = synthesize(problem)
        seconds = process_time() - begun
        # the first of a list may be another one, where the best is impractical
        ours = min((each.values[key] for each in result.candidates), default=np.inf)
        theirs = other(problem, EFFORT * seconds, number)
        worst = max(worst, ours / theirs)
        yield f"task {number}: {ours:.6g} in {seconds:.1f} s, independent {theirs:.6g}, {ours / theirs:.4f}"
    yield f"greatest ratio {worst:.4f}{' !' if worst > WITHIN else ''}"


def poses(count: int, seed: int) -> Iterator[str]:
    """Three poses met, and a random torque."""
    yield from compared(count, seed, lambda rng: loaded(rng, 3), "torque_deviation", by_circles)


def points(count: int, seed: int) -> Iterator[str]:
    """Points and torques fitted together."""
    yield from compared(count, seed, fitted, "error", lambda problem, seconds, _: by_points(problem, seconds))


CASES = [Case("poses", 10, poses), Case("points", 10, points)]
