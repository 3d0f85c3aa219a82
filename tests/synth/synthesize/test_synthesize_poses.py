"""Any number of poses from problem to list: planted and noisy ones, free parts, and obstacles."""

from collections.abc import Callable
from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from grashof import synthesize
from grashof.analysis import Design, verify
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Box, FourBar, MotionTask, Objective, Problem, Requirements
from grashof.synth import Candidate, Result
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import attempt

pytestmark = pytest.mark.usefixtures("small_search")

Judge = Callable[[FourBar, MotionTask], Any]
EXACT, LEAST = Requirements(exact=True), Requirements(exact=False)


def planted(seed: int, poses: int) -> tuple[MotionTask, FourBar]:
    """A task whose linkage meets the default requirements itself."""
    rng = np.random.default_rng([91, seed])
    while True:
        task, linkage = planted_motion(rng, poses)
        if verify(linkage, task, EXACT).ok:
            return task, linkage


def check_exact(result: Result, judge: Judge) -> None:
    """Every design is exact, in order, on one branch and turns, and none is there twice."""
    task = result.problem.task
    assert isinstance(task, MotionTask)
    for candidate in result.candidates:
        found = judge(candidate.linkage, task)
        assert candidate.verdict.ok
        assert found.exact
        assert found.turns
        exact = np.degrees(candidate.verdict.transmission_min_task)
        if len(task) > 2:  # two poses can be joined either way round
            assert exact - 1e-6 <= found.transmission_task <= exact + 0.05
    assert all(one.id != other.id for one, other in combinations(result.candidates, 2))


@pytest.mark.quick("0-3", "0-6", "1-12")
@pytest.mark.parametrize("poses", [2, 3, 5, 6, 8, 12])
@pytest.mark.parametrize("seed", range(2))
def test_planted_poses_are_met_exactly(poses: int, seed: int, independent_judge: Judge) -> None:
    task, linkage = planted(seed, poses)
    result = synthesize(Problem(task=task, requirements=EXACT), enough=4)
    assert len(result) >= (4 if poses < 4 else 1)
    check_exact(result, independent_judge)
    if poses > 4:  # nothing is left to choose: the planted one is among them, or its other side
        lengths = [sorted(map(float, candidate.linkage.lengths)) for candidate in result.candidates]
        gap = np.abs(np.array(lengths) - sorted(map(float, linkage.lengths))).max(axis=1)
        assert gap.min() < 1e-5 * task.size


def test_boxes_are_kept_with_three_poses(independent_judge: Judge) -> None:
    task = MotionTask.from_degrees([[0, 0, 0], [2, 1, 20], [3, 3, 50]])
    box = Box((0, 4), (-2, 1.5))
    wanted = Requirements(o2=box, link_length=(0.2, 15))
    result = synthesize(Problem(task=task, requirements=wanted), enough=4)
    assert len(result) >= 4
    check_exact(result, independent_judge)
    for candidate in result.candidates:
        assert 0 - 1e-8 <= candidate.linkage.o2[0] <= 4 + 1e-8
        assert -2 - 1e-8 <= candidate.linkage.o2[1] <= 1.5 + 1e-8


def test_two_poses_with_a_fixed_pivot(independent_judge: Judge) -> None:
    task = MotionTask.from_degrees([[0, 0, 0], [2, 1, 40]])
    wanted = Requirements(o2=Box((1, 1), (-1, -1)), link_length=(0.2, 15))
    result = synthesize(Problem(task=task, requirements=wanted), enough=4)
    assert len(result) >= 4
    check_exact(result, independent_judge)
    for candidate in result.candidates:
        np.testing.assert_allclose(candidate.linkage.o2, [1, -1], atol=1e-9)


def noisy(seed: int, poses: int, **rest: Any) -> tuple[Problem, FourBar]:
    rng = np.random.default_rng([92, seed])
    task, linkage = planted(seed, poses)
    noise = rng.normal(0, 0.01, (poses, 3))
    moved = MotionTask(task.positions + task.size * noise[:, :2], task.angles + noise[:, 2], **rest)
    return Problem(task=moved, requirements=LEAST), linkage


def polished(problem: Problem, linkage: FourBar) -> list[float]:
    """Squares of a linkage and of what the programme makes of it, where they are usable."""
    scaled, verdict = ScaledProblem.of(problem), verify(linkage, problem.task, problem.requirements)
    candidate = attempt(scaled, Start.of_linkage(scaled, linkage, verdict), 0).candidate
    found = [verdict] if candidate is None else [verdict, candidate.verdict]
    return [each.square for each in found if each.ok]


def closest_poses(candidate: Candidate, task: MotionTask) -> tuple[npt.NDArray[np.float64], ...]:
    """Misses of places and angles at the driver angles of the verdict, by circle intersection."""
    linkage, theta2 = candidate.linkage, candidate.verdict.theta2
    o2, o4, arm = (complex(*pair) for pair in (linkage.o2, linkage.o4, linkage.coupler_point))
    r2, r3, r4 = float(linkage.r2), float(linkage.r3), float(linkage.r4)
    a = o2 + r2 * np.exp(1j * theta2)
    distance = np.abs(o4 - a)
    foot = (distance**2 + r3**2 - r4**2) / (2 * distance)
    e3 = (foot + 1j * int(linkage.assembly) * np.sqrt(r3**2 - foot**2)) * (o4 - a) / (distance * r3)
    gap = np.abs(a + arm * e3 - task.positions @ np.array([1, 1j]))
    turned = np.abs(np.angle(e3 * np.exp(1j * (float(linkage.body_angle) - task.angles))))
    return gap, turned


@pytest.mark.slow
@pytest.mark.quick("0-6")
@pytest.mark.parametrize("poses", [6, 12])
@pytest.mark.parametrize("seed", range(3))
def test_noisy_poses_are_met_no_worse_than_by_the_planted_linkage(
    poses: int, seed: int, least_error: Callable[..., Result]
) -> None:
    weights = np.random.default_rng(seed).uniform(0.5, 2, poses)
    problem, linkage = noisy(seed, poses, weights=weights)
    task = problem.task
    assert isinstance(task, MotionTask)
    result = least_error(problem)
    assert result.best.verdict.square <= min(polished(problem, linkage), default=np.inf) * (1 + 1e-6)
    errors = np.sqrt([family[0].verdict.square for family in result.families])
    assert (np.maximum.accumulate(errors) <= 1.02 * errors).all()  # as near as what nobody would build counts
    for candidate in result.candidates:
        gap, turned = closest_poses(candidate, task)
        square = (weights * (gap**2 + (task.angle_length * turned) ** 2)).sum()
        assert candidate.verdict.square == pytest.approx(square, rel=1e-6)
        steps = candidate.verdict.direction * np.diff(candidate.verdict.theta2)
        assert (steps >= -1e-9).all()
        assert steps.sum() <= 2 * np.pi + 1e-9


MIXES: dict[str, tuple[int, list[int], list[int]]] = {
    "7 poses, 4 angles free": (7, [], [1, 2, 4, 5]),
    "6 poses, 2 angles free": (6, [], [1, 3]),
    "6 poses, 2 places free": (6, [1, 3], []),
    "5 poses, 1 place free": (5, [2], []),
    "4 poses, 1 angle free": (4, [], [1]),
    "3 poses, a place and an angle free": (3, [1], [2]),
}


@pytest.mark.quick("3 poses, a place and an angle free")
@pytest.mark.parametrize("mix", MIXES)
def test_poses_with_free_parts_are_met_exactly(mix: str) -> None:
    poses, places, angles = MIXES[mix]
    whole, _ = planted(0, poses)
    positions, turned = whole.positions.copy(), whole.angles.copy()
    positions[places], turned[angles] = np.nan, np.nan
    task = MotionTask(positions, turned)
    assert task.exact_by_default
    result = synthesize(Problem(task=task, requirements=replace(EXACT, link_ratio_max=50.0)), enough=2)
    assert len(result) >= 1
    for candidate in result.candidates:
        assert candidate.verdict.ok
        gap, off = closest_poses(candidate, task)
        assert np.nanmax(gap) < 1e-9 * task.size
        assert np.nanmax(off) < 1e-9
        steps = candidate.verdict.direction * np.diff(candidate.verdict.theta2)
        assert (steps > 0).all()
        assert steps.sum() <= 2 * np.pi + 1e-9


@pytest.mark.slow
def test_more_freedom_is_never_worse() -> None:
    """Three poses leave more room for transmission than four of which they are three."""
    rows = [[0.0, 0, 0], [2, 1, 20], [3, 3, 50], [2.5, 4, 80]]
    wanted = Requirements(link_length=(0.2, 12))
    best = [
        synthesize(Problem(task=MotionTask.from_degrees(rows[:count]), requirements=wanted)).best.verdict
        for count in (3, 4)
    ]
    assert best[0].transmission_min_task >= best[1].transmission_min_task - 1e-6


@pytest.mark.slow
def test_compactness_of_three_poses() -> None:
    task = MotionTask.from_degrees([[0, 0, 0], [2, 1, 20], [3, 3, 50]])
    wanted = Requirements(link_length=(0.2, 12), transmission_min_deg=15)
    sizes = [
        synthesize(Problem(task=task, requirements=wanted, objective=objective), enough=5).best.verdict.size
        for objective in (Objective(), Objective(transmission=0, compactness=1))
    ]
    assert sizes[1] < sizes[0]


@pytest.mark.slow
def test_five_poses_that_no_linkage_meets_come_with_the_closest() -> None:
    draw = np.random.default_rng([43, 4])
    for _ in range(20):
        task = MotionTask(draw.normal(size=(5, 2)), np.sort(draw.uniform(-1, 1, 5)))
        result = synthesize(Problem(task=task), starts=16)
        if not len(result) and "real dyad" in result.note:
            break
    assert result.note.startswith("no design: the 5 poses have ")
    assert result.nearest
    assert "the closest design comes within " in result.note
    assert result.note.endswith(", with exact = false")
    assert all("exact" in {d.requirement for d in near.verdict.defects} for near in result.nearest)
    assert result.ended.endswith(": the poses leave no freedom")
    assert not result.nearest[0].verdict.ok


def too_long(design: Design) -> Any:
    return design.r1 + 1e3


@pytest.mark.slow
@pytest.mark.usefixtures("small_search")
def test_a_constraint_that_the_only_linkage_breaks_is_named() -> None:
    task, _ = planted(1, 6)
    result = synthesize(Problem(task=task, requirements=EXACT), constraints=[too_long], starts=8)
    assert len(result) == 0
    assert "; this alone would do: constraint too_long up to 1010 instead of 0" in result.note
