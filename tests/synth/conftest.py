"""Shared by the tests of the synthesis: luggage problems, and a judge that shares no code with Grashof."""

import json
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import dataclass
from importlib import import_module
from multiprocessing import get_context
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pytest
from circles import meeting_points

import grashof.synth.search.workers as workers_module
from grashof import load, synthesize
from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.problems import FourBar, MotionTask, PathTask, Problem, Requirements
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth import Candidate, Result
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Screened
from grashof.synth.starts.dyad_pairs import near_misses, screen
from grashof.synth.theory.burmester import trace_four_pose_curves

STEPS = 3000  # of the driver between two targets; three times as many over the turn


@dataclass(frozen=True)
class Findings:
    """Findings of the independent judge: errors in sizes and rad, transmission in deg."""

    errors: FloatArray  # of positions, at the targets
    in_order: bool
    on_one_branch: bool
    turns: bool
    transmission_task: float
    transmission_cycle: float
    lengths: FloatArray
    arms: FloatArray
    angle_error: float = 0.0

    @property
    def position_error(self) -> float:
        """The greatest, sizes."""
        return float(self.errors.max())

    @property
    def exact(self) -> bool:
        """Whether all targets are met, in order, on one branch."""
        met = self.position_error < 1e-9 and self.angle_error < 1e-9
        return met and self.in_order and self.on_one_branch

    def check_limits(self, candidate: Candidate, over_task: float, over_cycle: float) -> None:
        """Lengths and arms keep their limits, and transmission angles are those of the verdict.

        The sampled angle over the task is no smaller, and greater by no more than `over_task`, deg; that over
        the cycle is as near as `over_cycle`.
        """
        task, verdict = candidate.problem.task, candidate.verdict
        whole, slack = candidate.problem.requirements.resolved(task.size), 1e-8 * task.size
        for length, (low, high) in zip(self.lengths, whole.link_lengths, strict=True):
            assert low - slack <= length <= high + slack
        assert whole.coupler_arms is not None
        assert whole.coupler_arms[0] - slack <= self.arms.min()
        assert self.arms.max() <= whole.coupler_arms[1] + slack
        exact = np.degrees(verdict.transmission_min_task)
        assert exact - 1e-6 <= self.transmission_task <= exact + over_task
        if self.turns:
            exact = np.degrees(verdict.transmission_min_cycle)
            assert self.transmission_cycle == pytest.approx(exact, abs=over_cycle)


Judge: TypeAlias = Callable[[FourBar, MotionTask], Findings]


def complex_point(point: FloatArray) -> complex:
    return complex(float(point[0]), float(point[1]))


def folded_angle(a: ComplexArray, b: ComplexArray, o4: complex) -> FloatArray:
    """Angle in deg between AB and O4B, 0 to 90."""
    coupler, output = b - a, b - o4
    cosine = np.abs((coupler.conj() * output).real) / (np.abs(coupler) * np.abs(output))
    return np.degrees(np.arccos(np.minimum(cosine, 1.0)))


class Loop:
    """A linkage in complex numbers, its loop closed by two circles about A and O4."""

    def __init__(self, linkage: FourBar) -> None:
        self.o2, self.o4, self.p = map(complex_point, (linkage.o2, linkage.o4, linkage.coupler_point))
        self.r2, self.r3, self.r4 = float(linkage.r2), float(linkage.r3), float(linkage.r4)
        self.side = int(linkage.assembly)
        self.lengths = np.array([abs(self.o4 - self.o2), self.r2, self.r3, self.r4])
        self.arms = np.array([abs(self.p), abs(self.p - self.r3)])

    def at(self, theta2: FloatArray) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """A, B, and B of the other assembly."""
        a = self.o2 + self.r2 * np.exp(1j * theta2)
        left, right = meeting_points(a, self.o4, self.r3, self.r4)
        return (a, left, right) if self.side > 0 else (a, right, left)

    def transmission(self, theta2: FloatArray) -> tuple[bool, float]:
        """Whether the loop closes at all angles, and the worst transmission angle, deg, else 0."""
        a, b, _ = self.at(theta2)
        closes = bool(np.isfinite(b).all())
        return closes, float(folded_angle(a, b, self.o4).min()) if closes else 0.0

    def over_the_turn(self) -> tuple[bool, float]:
        """The same over the turn, with the driver along the ground line as well, where the extremes lie."""
        return self.transmission(np.angle(self.o4 - self.o2) + np.linspace(0, 2 * np.pi, 3 * STEPS + 1))


def judge(linkage: FourBar, task: MotionTask) -> Findings:
    loop = Loop(linkage)
    targets = task.positions[:, 0] + 1j * task.positions[:, 1]
    direction3 = np.exp(1j * (task.angles - float(linkage.body_angle)))
    theta2 = np.angle(targets - loop.p * direction3 - loop.o2)
    a, b, _ = loop.at(theta2)
    coupler = (b - a) / loop.r3

    in_order = on_one_branch = False
    transmission_task = 0.0
    for sense in (1, -1):
        steps = (sense * np.diff(theta2)) % (2 * np.pi)
        if steps.sum() > 2 * np.pi + 1e-9:
            continue
        in_order = True
        on_way = np.concatenate([
            begin + sense * np.linspace(0, step, STEPS)
            for begin, step in zip(theta2[:-1], steps, strict=True)
        ])  # fmt: skip
        _, way, other = loop.at(on_way)
        # Continuity: the next place of B on this assembly is nearer than that on the other one.
        followed = np.abs(np.diff(way)) < np.abs(other[1:] - way[:-1])
        if np.isfinite(way).all() and followed.all():
            on_one_branch = True
            transmission_task = loop.transmission(on_way)[1]
    turns, transmission_cycle = loop.over_the_turn()
    return Findings(
        errors=np.abs(a + loop.p * coupler - targets) / task.size,
        in_order=in_order,
        on_one_branch=on_one_branch,
        turns=turns,
        transmission_task=transmission_task,
        transmission_cycle=transmission_cycle,
        lengths=loop.lengths,
        arms=loop.arms,
        angle_error=float(np.abs(np.angle(coupler / direction3)).max()),
    )


PathJudge: TypeAlias = Callable[[FourBar, FloatArray, PathTask], Findings]


def judge_path(linkage: FourBar, theta2: FloatArray, task: PathTask) -> Findings:
    """At the driver angles of a verdict."""
    loop = Loop(linkage)
    a, b, _ = loop.at(theta2)
    targets = task.points[:, 0] + 1j * task.points[:, 1]
    steps, sense = np.diff(theta2), np.sign(theta2[-1] - theta2[0])
    gone = 2 * np.pi if task.closed else abs(theta2[-1] - theta2[0])
    closes, worst = loop.transmission(theta2[0] + sense * np.linspace(0, gone, 3 * STEPS))
    turns, least = loop.over_the_turn()
    return Findings(
        errors=np.abs(a + loop.p * (b - a) / loop.r3 - targets) / task.size,
        in_order=bool((sense * steps >= -1e-9).all() and gone <= 2 * np.pi + 1e-9),
        on_one_branch=closes,
        turns=turns,
        transmission_task=worst,
        transmission_cycle=least,
        lengths=loop.lengths,
        arms=loop.arms,
    )


@pytest.fixture(scope="session")
def independent_judge() -> Judge:
    return judge


@pytest.fixture(scope="session")
def golden() -> dict[str, Any]:
    path = Path(__file__).parents[1] / "data" / "golden.json"
    contents: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return contents


@pytest.fixture(scope="session")
def luggage() -> Problem:
    return load("luggage")


@pytest.fixture(scope="session")
def luggage_result(luggage: Problem) -> Result:
    return synthesize(luggage)


@pytest.fixture(scope="session")
def luggage_designs(luggage_result: Result) -> tuple[Candidate, ...]:
    return luggage_result.candidates


SetupOf: TypeAlias = Callable[..., ScaledProblem]


@pytest.fixture(scope="session")
def luggage_scaled(luggage: Problem) -> SetupOf:
    """The luggage task under other requirements: links and arms 0.3 to 8 unless said otherwise."""

    def of(**wanted: Any) -> ScaledProblem:
        limits = {"link_length": (0.3, 8.0), "coupler_arms": (0.3, 8.0)}
        return ScaledProblem.of(Problem(task=luggage.task, requirements=Requirements(**(limits | wanted))))

    return of


@pytest.fixture(scope="session")
def planted_scaled() -> Callable[..., tuple[ScaledProblem, FourBar]]:
    """ScaledProblem of a planted task, and the linkage that does it."""

    def of(seed: int, **wanted: Any) -> tuple[ScaledProblem, FourBar]:
        task, linkage = planted_motion(np.random.default_rng(seed), poses=4)
        return ScaledProblem.of(Problem(task=task, requirements=Requirements(**wanted))), linkage

    return of


@pytest.fixture(scope="session")
def path_judge() -> PathJudge:
    return judge_path


@pytest.fixture(scope="session")
def path_scaled() -> Callable[..., tuple[ScaledProblem, FourBar]]:
    """ScaledProblem of a planted path task, and the linkage that does it."""

    def of(seed: int, points: int, timed: bool = False, **wanted: Any) -> tuple[ScaledProblem, FourBar]:
        task, linkage = planted_path(np.random.default_rng(seed), points, timed=timed)
        return ScaledProblem.of(Problem(task=task, requirements=Requirements(**wanted))), linkage

    return of


PairsOf: TypeAlias = Callable[[ScaledProblem], Screened]


def pairs_of(judged: Callable[..., Screened], reach: float, lines: int, cell: float, pairs: int) -> PairsOf:
    """Pairs of traced dyads, judged once for a task and its requirements."""
    known: dict[tuple[bytes, str], Screened] = {}

    def found(scaled: ScaledProblem) -> Screened:
        key = scaled.targets.tobytes() + scaled.turns.tobytes(), repr(scaled.wanted)
        if key not in known:
            dyads = trace_four_pose_curves(scaled.motion, reach=reach, lines=lines, cell=cell)
            known[key] = judged(scaled.motion, scaled.targets[0], dyads, scaled.wanted, pairs=pairs)
        return known[key]

    return found


@pytest.fixture(scope="session")
def feasible_pairs() -> PairsOf:
    return pairs_of(screen, reach=6.0, lines=200, cell=0.03, pairs=60_000)


@pytest.fixture(scope="session")
def all_pairs() -> PairsOf:
    return pairs_of(near_misses, reach=5.0, lines=40, cell=0.1, pairs=20_000)


LeastError: TypeAlias = Callable[..., Result]


@pytest.fixture(scope="session")
def least_error() -> LeastError:
    """`synthesize` for the least error alone: what more error buys takes most of the time."""

    def of(problem: Problem, **options: Any) -> Result:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(import_module("grashof.synth.results.trade_offs"), "SEEDS", 0)
            return synthesize(problem, **options)

    return of


@pytest.fixture(scope="session")
def other_process() -> Iterator[Executor]:
    """A worker process that all tests share: to start one takes longer than a small search."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        yield pool


class Killed(BaseException):
    """As if the process had been killed."""


class Mortal:
    """How many attempts the process lives for; as many as there are, at first."""

    killed = Killed

    def __init__(self) -> None:
        self.left = 10**9
        self._attempts = workers_module.attempts

    def attempts(self, scaled: Any, starts: Any, first: int) -> Any:
        """Attempts, or the end."""
        self.left -= len(starts)
        if self.left < 0:
            raise Killed
        return self._attempts(scaled, starts, first)


@pytest.fixture
def mortal(monkeypatch: pytest.MonkeyPatch) -> Mortal:
    made = Mortal()
    monkeypatch.setattr(workers_module, "attempts", made.attempts)
    return made
