"""The batched search of slider kinds: right derivatives, limits kept, linkages as the judge has them."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from batched_search import differences

from grashof.analysis import solve_position
from grashof.analysis.mechanism.mobility import rotatability
from grashof.problems import Box, MotionTask, PathTask, Problem, Requirements
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.closed_loop import SearchTargets
from grashof.synth.starts.every_target import fitted_to_all
from grashof.synth.starts.loop_search import (
    WithinLimits,
    draw,
    fitting,
    improve,
    judged,
    place,
    with_places,
)

SLIDERS = ("slider-crank", "inverted-slider-crank")
LIMITS: dict[str, Any] = {
    "transmission_min_deg": 50,
    "link_length": (0.3, 1.5),
    "coupler_arms": (0.2, 1.0),
    "o2": Box((-0.2, 0.1), (0.3, 0.4)),
    "offset": (0.05, 0.2),
    "theta2_start_deg": 30,
    "time_ratio": (1.2, 1.4),
}
POINTS = np.array([[0, 0], [1, 0.2], [1.6, 0.9], [1.5, 1.8], [0.7, 2.2], [-0.2, 1.6]])


def scaled_of(mechanism: str, *, poses: bool = False, timed: bool = False, **wanted: Any) -> ScaledProblem:
    timing = np.array([0, 0.5, 0.9, 1.5, 2.3, 3.1]) if timed else None
    if poses:
        task: Any = MotionTask(POINTS, np.linspace(0, 2.1, 6) ** 1.2, timing=timing)
    else:
        task = PathTask(POINTS, timing=timing)
    wanted = {"exact": False} | wanted
    return ScaledProblem.of(Problem(task=task, mechanism=mechanism, requirements=Requirements(**wanted)))


@pytest.mark.quick("slider-crank-False-False-full-crank", "inverted-slider-crank-True-True-any")
@pytest.mark.parametrize("rotatability", ["full-crank", "any"])
@pytest.mark.parametrize("timed", [False, True])
@pytest.mark.parametrize("poses", [False, True])
@pytest.mark.parametrize("mechanism", SLIDERS)
def test_derivatives_under_limits(mechanism: str, poses: bool, timed: bool, rotatability: str) -> None:
    own = {"stroke": (0.2, 0.5)} if mechanism == "slider-crank" else {"output_swing_deg": (10, 30)}
    stated = {"poses": poses, "timed": timed, "rotatability": rotatability}
    target = SearchTargets.of(scaled_of(mechanism, **stated, **LIMITS, **own))
    batch = with_places(target, draw(target, 300, np.random.default_rng(3)))
    model = WithinLimits(target, 0.7)
    cost, residual, jacobian = model(batch)
    sound = (
        np.isfinite(cost) & (np.abs(residual).max(axis=1) < 20) & (np.abs(jacobian).max(axis=(1, 2)) < 200)
    )
    batch = batch[sound]
    assert len(batch) > 20
    analytic, numeric = model(batch)[2], differences(model, batch, 1)
    # Where a limit begins to be overstepped there is a kink: all but a few numbers agree.
    off = np.abs(analytic - numeric) > 1e-4 * (1 + np.abs(numeric))
    assert off.mean() < 2e-3
    np.testing.assert_allclose(cost, (residual**2).sum(axis=1), rtol=1e-9)


@pytest.mark.parametrize("mechanism", SLIDERS)
def test_the_search_ends_at_a_minimum_over_all_its_unknowns(mechanism: str) -> None:
    target = SearchTargets.of(scaled_of(mechanism))
    with np.errstate(all="ignore"):
        batch, error = improve(fitting(target), draw(target, 400, np.random.default_rng(1)), 60, 0.0)
        best = batch[np.argsort(error)[:5]]
        cost = fitting(target)(best)[0]
        for seed in range(20):
            moved = np.random.default_rng(seed).normal(size=best.unknowns.shape) * 1e-4
            assert (
                fitting(target)(replace(best, unknowns=best.unknowns + moved))[0] > cost * (1 - 1e-5)
            ).all()


@pytest.mark.parametrize("rotatability", ["full-crank", "any"])
@pytest.mark.parametrize("mechanism", SLIDERS)
def test_placed_linkages_are_where_the_analysis_has_them(mechanism: str, rotatability: str) -> None:
    scaled = scaled_of(mechanism, rotatability=rotatability)
    target = SearchTargets.of(scaled)
    with np.errstate(all="ignore"):
        batch = draw(target, 400, np.random.default_rng(2))
        placed = place(target, batch)
    sound = np.flatnonzero(np.isfinite(placed.error))[:40]
    linkages = judged(scaled, target, placed[sound], batch.direction[sound])
    values = scaled.linkages(linkages.points, np.ones(len(sound)))
    state = solve_position(values[:, None], linkages.theta2)
    for name, at in (("a", placed.a), ("b", placed.b), ("p", placed.p)):
        np.testing.assert_allclose(scaled.frame.inward(getattr(state, name)), at[sound], atol=1e-9)
    np.testing.assert_allclose(linkages.track, np.stack([placed.a, placed.b, placed.p])[:, sound], atol=1e-9)


@pytest.mark.parametrize("mechanism", SLIDERS)
def test_full_cranks_keep_their_margin_by_construction(mechanism: str) -> None:
    scaled = scaled_of(mechanism, rotatability_margin=0.02)
    target = SearchTargets.of(scaled)
    batch = draw(target, 3000, np.random.default_rng(7))
    with np.errstate(all="ignore"):
        placed = place(target, batch)
    sound = np.isfinite(placed.error)
    linkages = judged(scaled, target, placed[sound], batch.direction[sound])
    values = scaled.linkages(linkages.points, np.ones(len(linkages)))
    first, second = values.lengths.T
    longer, offset = np.abs(second - first), np.abs(values.offset)  # type: ignore[attr-defined]
    share = (longer - offset) / (first + second + offset)
    # Two nearly equal links have no such margin.
    assert (share > np.minimum(0.02, longer / (first + second)) - 1e-9).all()
    np.testing.assert_allclose(share, rotatability(values).min(axis=-1), atol=1e-12)
    assert sound.mean() > 0.9


@pytest.mark.slow
@pytest.mark.quick("slider-crank")
@pytest.mark.parametrize("mechanism", SLIDERS)
def test_many_targets_are_fitted_one_driver_angle_each(mechanism: str) -> None:
    along = np.linspace(0, 5, 60)
    points = np.column_stack([np.cos(along) * (1 + 0.1 * along), 0.6 * np.sin(along)])
    problem = Problem(task=PathTask(points), mechanism=mechanism)
    target = SearchTargets.of(ScaledProblem.of(problem))
    with np.errstate(all="ignore"):
        batch, error = improve(fitting(target), draw(target, 200, np.random.default_rng(0)), 25, 0.0)
        few = batch[np.argsort(error)[:4]]
        again = fitted_to_all(target, few, 100)
        before, after = place(target, few).error, place(target, again).error
    assert (after <= before * (1 + 1e-6)).all()
