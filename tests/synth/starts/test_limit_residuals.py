"""Limits at single targets as residuals of the batched search, against differences and the judge."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from batched_search import differences, points_along

from grashof.analysis.judge.at_targets import excess, figures_at
from grashof.problems import Box, PathTask, Problem, Region, Requirements, TargetLimits
from grashof.problems.values.arrays import FloatArray
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.closed_loop import Batch, SearchTargets
from grashof.synth.starts.loop_search import WithinLimits, draw, judged, standing, with_places

UNIT, MIDDLE = 40.0, 100 - 30j  # of the points, so that lengths in sizes differ from those of the problem
PLACE = Box((60, 140), (-np.inf, -30))
LIMITS: dict[str, Any] = {
    "a": PLACE,
    "b": Region(inside=((100, -30), (180, -10), (140, 50))),
    "distances": {"a-o4": (40, 60), "b-o2": 28},
    "distances of P": {"o2-p": (10, 20), "b-p": (30, 50)},
    "instant_centre": PLACE,
    "past_deg": (2, 5),
    "coupler_angle_deg": (30, 50),
    "coupler_rate": (0.2, 0.3),
    "transmission_min_deg": 50,
    "mechanical_advantage_min": 3,
}
IN_LENGTHS = ("a", "distances", "distances of P", "instant_centre")
HAD = [
    *(("four-bar", name) for name in LIMITS),
    *(("slider-crank", name) for name in ("a", "b", "past_deg", "coupler_angle_deg", "coupler_rate")),
    *(
        ("inverted-slider-crank", name)
        for name in ("a", "b", "distances", "coupler_angle_deg", "coupler_rate")
    ),
]
NEAR = 3.0  # sizes from the points: others are no linkages of interest


def stated(kind: str, name: str, target: int) -> ScaledProblem:
    places = UNIT * points_along(np.linspace(0, 4, 6), np.random.default_rng(3)) + MIDDLE
    at = (TargetLimits(targets=[target], **{name.split()[0]: LIMITS[name]}),)
    wanted = Requirements(rotatability="any", exact=False, at=at)
    task = PathTask(np.column_stack([places.real, places.imag]))
    return ScaledProblem.of(Problem(task=task, requirements=wanted, mechanism=kind))


def closed(target: SearchTargets, count: int) -> Batch:
    batch = with_places(target, draw(target, 40 * count, np.random.default_rng(0)))
    placed = standing(target, batch)
    return batch[np.flatnonzero(np.abs(placed.p - target.points).max(axis=1) < NEAR)[:count]]


def by_the_judge(scaled: ScaledProblem, target: SearchTargets, batch: Batch) -> FloatArray:
    """Sum of the squares of the excess of each linkage over its limits, lengths in sizes."""
    found = judged(scaled, target, standing(target, batch), batch.direction)
    (limits,), size = scaled.problem.requirements.at, scaled.problem.task.size
    squares = []
    for row in range(len(found)):
        linkage = scaled.linkages(found.points[row], found.assembly[row], found.body_angle[row])
        figures = figures_at(linkage, limits, found.theta2[row], np.full(6, int(linkage.assembly)), size)
        over = [excess(values, allowed) / size**unit.lengths for _, values, allowed, unit in figures]
        squares.append((np.maximum(np.concatenate(over), 0.0) ** 2).sum())
    return np.array(squares)


@pytest.mark.parametrize("number", [1, 4, 6])
@pytest.mark.parametrize(("kind", "name"), HAD)
def test_residuals_of_a_limit_at_a_target(kind: str, name: str, number: int) -> None:
    scaled = stated(kind, name, number)
    target = SearchTargets.of(scaled)
    batch = closed(target, 24)
    model, free = (WithinLimits(each, 1.0) for each in (target, replace(target, at=())))
    _, _, slopes = model(batch)
    expected = differences(model, batch, 1)
    even = np.abs(expected).max(axis=(1, 2)) < 100
    assert np.count_nonzero(even) >= 8
    np.testing.assert_allclose(slopes[even], expected[even], atol=1e-4)
    missed, over = model(batch)[0] - free(batch)[0], by_the_judge(scaled, target, batch)
    if name in IN_LENGTHS:
        np.testing.assert_allclose(missed, over, rtol=1e-6, atol=1e-9)
    elif name == "past_deg":  # the judge follows the motion, the search its targets
        assert np.mean((missed > 1e-9) == (over > 1e-9)) > 0.9
    else:
        np.testing.assert_array_equal(missed > 1e-9, over > 1e-9)
    assert (missed > 1e-9).any()
