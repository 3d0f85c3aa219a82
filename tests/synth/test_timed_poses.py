"""Timed, closed and mixed poses from problem to list: planted ones, and limits that are active."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import verify
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Box, MotionTask, Problem, Requirements
from grashof.synth import Result

pytestmark = pytest.mark.usefixtures("small_search")

EXACT, LEAST = Requirements(exact=True), Requirements(exact=False)


def planted(seed: int, poses: int, *, timed: bool, mixed: bool = False, closed: bool = False) -> MotionTask:
    """A task whose linkage meets the default requirements itself; mixed: whole poses, points and angles."""
    rng = np.random.default_rng([61, seed])
    while True:
        task, linkage = planted_motion(rng, poses, timed=timed)
        positions, angles = task.positions.copy(), task.angles.copy()
        if mixed:
            angles[1::3], positions[2::3] = np.nan, np.nan
        made = MotionTask(positions, angles, timing=task.timing, closed=closed)
        if made.size > 0.5 * task.size and verify(linkage, made, EXACT).ok:
            return made


def noisy(seed: int, poses: int) -> MotionTask:
    task = planted(seed, poses, timed=True)
    noise = np.random.default_rng(seed).normal(0, 0.03, (poses, 3))
    places = task.positions + task.size * noise[:, :2]
    return MotionTask(places, task.angles + noise[:, 2], timing=task.timing)


@pytest.fixture(scope="module")
def free(least_error: Callable[..., Result]) -> Result:
    """Least squares without limits."""
    return least_error(Problem(task=noisy(1, 7), requirements=LEAST), starts=8)


def check_timing(result: Result) -> None:
    """Every design is judged without a defect and keeps the timing at the driver angles it is judged at."""
    assert len(result)
    task = result.problem.task
    for candidate in result.candidates:
        verdict = candidate.verdict
        assert verdict.ok
        turned = verdict.direction * (verdict.theta2 - verdict.theta2[0])
        np.testing.assert_allclose(turned, task.driver_turns, rtol=0, atol=1e-9)


@pytest.mark.quick("3-False-False", "6-True-True")
@pytest.mark.parametrize(
    ("poses", "mixed", "closed"), [(3, False, False), (5, False, False), (7, True, False), (6, True, True)]
)
def test_planted_timed_poses_are_met_exactly(poses: int, mixed: bool, closed: bool) -> None:
    task = planted(0, poses, timed=True, mixed=mixed, closed=closed)
    result = synthesize(Problem(task=task, requirements=EXACT), starts=8, enough=4)
    check_timing(result)
    for candidate in result.candidates:
        assert candidate.verdict.error_max < 1e-9 * task.size
        assert np.nanmax(candidate.verdict.angle_error) < 1e-9


@pytest.mark.quick("6-True-False")
@pytest.mark.parametrize(("poses", "mixed", "again"), [(4, False, False), (4, False, True), (6, True, False)])
def test_closed_poses_are_met_within_one_turn(poses: int, mixed: bool, again: bool) -> None:
    task = planted(0, poses, timed=False, mixed=mixed, closed=True)
    if again:
        places, angles = (np.concatenate([part, part[:1]]) for part in (task.positions, task.angles))
        task = MotionTask(places, angles, closed=True)
    wanted = Requirements(exact=True, rotatability="any", transmission_min_deg=5)  # type: ignore[arg-type]
    result = synthesize(Problem(task=task, requirements=wanted), starts=16, enough=2)
    assert len(result)
    for candidate in result.candidates:
        assert candidate.verdict.error_max < 1e-9 * task.size
        assert candidate.verdict.full_rotation
        assert np.degrees(candidate.verdict.transmission_min_cycle) >= 5 - 1e-6
    assert {"hausdorff", "frechet"} <= set(result.to_frame().columns)


@pytest.mark.slow
@pytest.mark.quick("keep_out")
@pytest.mark.parametrize(
    "limit", ["a", "transmission_min_deg", "o2", "theta2_start_deg", "keep_out", "error_factor"]
)
def test_timed_least_squares_keep_an_active_limit(
    free: Result, limit: str, least_error: Callable[..., Result]
) -> None:
    check_timing(free)
    task, best = free.problem.task, free.best
    least = best.verdict.square
    a = best.linkage.o2 + best.linkage.r2 * np.stack(
        [np.cos(best.verdict.theta2), np.sin(best.verdict.theta2)], axis=-1
    )
    low, high = np.sort(a[:, 0])[[1, -1]]  # the leftmost place of A is cut off
    corner = best.linkage.o2
    side = 0.2 * task.size
    wanted: dict[str, Any] = {
        "a": Box(x=(float(low), float(high + 2 * task.size))),
        "transmission_min_deg": min(80.0, float(np.degrees(best.verdict.transmission_min_task)) + 5),
        "o2": Box(x=(float(corner[0] + side), float(corner[0] + 10 * side))),
        "theta2_start_deg": float(np.degrees(best.verdict.theta2[0])) + 20,
        "keep_out": [(corner + side * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])).tolist()],
        "error_factor": 1.3,
    }
    limited = Requirements(exact=False, **{limit: wanted[limit]})
    result = least_error(Problem(task=task, requirements=limited), starts=8)
    check_timing(result)
    if limit == "error_factor":
        assert result.best.verdict.square <= 1.3**2 * least * (1 + 1e-6)
        assert result.best.verdict.transmission_min_task >= best.verdict.transmission_min_task - 1e-9
    else:
        assert result.best.verdict.square >= least * (1 - 1e-9)


@pytest.mark.slow
def test_timed_zones_are_kept_where_the_judge_finds_the_driver(free: Result) -> None:
    task, verdict = free.problem.task, free.best.verdict
    wide = 1.3 * float(verdict.position_error.max()), 1.3 * float(verdict.angle_error.max())
    zoned = MotionTask(task.positions, task.angles, timing=task.timing, within=wide[0], angle_within=wide[1])
    result = synthesize(Problem(task=zoned), starts=8)
    check_timing(result)
    assert result.best.verdict.transmission_min_task >= verdict.transmission_min_task - 1e-9


def test_two_timed_poses_leave_freedom() -> None:
    result = synthesize(Problem(task=planted(0, 2, timed=True)), starts=8, enough=3)
    assert len(result) >= 3
    check_timing(result)
