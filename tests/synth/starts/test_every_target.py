"""Linkages fitted to every target of a long task: by the truth of planted tasks, and at the cost of lines."""

import tracemalloc
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.problems import MotionTask, PathTask, Problem, Requirements, Task
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.closed_loop import Batch, Loop, SearchTargets
from grashof.synth.starts.every_target import fitted_to_all
from grashof.synth.starts.loop_search import draw, fitting, improve, place, standing, with_places
from grashof.synth.starts.thinning import refined, thinned


def planted(seed: int, count: int, noise: float, *, path: bool) -> Task:
    rng = np.random.default_rng([31, seed])
    task = planted_path(rng, count)[0] if path else planted_motion(rng, count)[0]
    places = task.positions + rng.normal(0, noise * task.size, (count, 2))
    return PathTask(places) if path else MotionTask(places, task.angles + rng.normal(0, noise, count))


@cache
def begun(seed: int, count: int, noise: float, *, path: bool) -> tuple[SearchTargets, Batch]:
    """Linkages fitted to some of the targets, the best first, with driver angles at all."""
    task = planted(seed, count, noise, path=path)
    target = SearchTargets.of(ScaledProblem.of(Problem(task=task, requirements=Requirements(exact=False))))
    some, index = thinned(target, 24)
    batch = draw(some, 600, np.random.default_rng(0))
    with np.errstate(all="ignore"):
        error = place(some, batch).error
        batch, error = improve(fitting(some), batch[np.argsort(error)[:60]], 40, 0.0)
    return target, refined(target, index, batch[np.argsort(error)[:6]])


@pytest.mark.parametrize("order", [True, False])
@pytest.mark.parametrize("path", [False, True])
def test_a_task_without_noise_is_met(path: bool, order: bool) -> None:
    target, batch = begun(1, 80, 0.0, path=path)
    if not order:
        mixed = np.random.default_rng(0).permutation(80)
        angles = Loop.of(target, batch).theta2[:, mixed]
        batch = replace(batch, unknowns=np.concatenate([batch.unknowns[:, :3], angles], axis=1))
        names = ("points", "weights", "turns", "turn_weights")
        target = replace(
            target,
            wanted=replace(target.wanted, order=False),
            **{name: getattr(target, name)[mixed] for name in names},
        )
    with np.errstate(all="ignore"):
        fitted = fitted_to_all(target, batch, 200)
        error = place(target, fitted).error.min()
    assert error < 1e-12 * len(target.points)


@pytest.mark.quick("False")
@pytest.mark.slow
@pytest.mark.parametrize("path", [False, True])
def test_it_comes_as_low_as_steps_in_all_angles_at_once(path: bool) -> None:
    """On average: where points have to share driver angles, the valleys found may be others."""
    gained = []
    for seed in range(4):
        target, batch = begun(seed, 60, 0.01, path=path)
        with np.errstate(all="ignore"):
            placed = place(target, fitted_to_all(target, batch, 200))
            _, dense = improve(fitting(target), batch, 200, 0.0)
        gained.append(np.log(placed.error.min() / dense.min()))
        steps = batch.direction[:, None] * np.diff(placed.theta2, axis=1)
        assert (steps >= 0).all()
        assert (steps.sum(axis=1) <= 2 * np.pi).all()
    assert np.mean(gained) <= 1e-3


def test_limits_are_kept_where_they_weigh_much() -> None:
    task = planted(0, 60, 0.01, path=False)
    problem = Problem(task=task, requirements=Requirements(exact=False, link_ratio_max=1.7))
    target = SearchTargets.of(ScaledProblem.of(problem))
    _, batch = begun(0, 60, 0.01, path=False)
    with np.errstate(all="ignore"):
        batch = with_places(target, batch)
        for weight in (5.0, 300.0):
            batch = fitted_to_all(target, batch, 100, weight=weight, placed=True)
        placed = standing(target, batch)
    r2, r3 = np.abs(placed.a - placed.o2[:, None])[:, 0], np.abs(placed.b - placed.a)[:, 0]
    lengths = np.stack([np.abs(placed.o4 - placed.o2), r2, r3, np.abs(placed.b - placed.o4[:, None])[:, 0]])
    ratio = lengths.max(axis=0) / lengths.min(axis=0)
    assert ratio[np.isfinite(placed.error)].min() < 1.7 + 1e-6


def test_no_small_move_of_what_all_targets_share_gains() -> None:
    target, batch = begun(2, 60, 0.01, path=False)
    with np.errstate(all="ignore"):
        fitted = fitted_to_all(target, batch, 400)
        error = place(target, fitted).error
        best = fitted[np.argsort(error)[:1]]
        for column in range(3):
            for step in (-1e-3, 1e-3):
                moved = Batch(best.unknowns.copy(), best.longer_driver, best.assembly, best.direction)
                moved.unknowns[:, column] += step
                again = place(target, fitted_to_all(target, moved, 1)).error
                assert again >= error.min() * (1 - 1e-5)


@pytest.mark.slow
def test_memory_grows_with_the_targets_not_with_their_square() -> None:
    peaks = []
    for count in (200, 800):
        target, batch = begun(0, count, 0.01, path=False)
        tracemalloc.start()
        fitted_to_all(target, batch, 3)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < 5 * peaks[0]
