"""Leaders kept up to date are those of all designs ranked at once."""

from dataclasses import replace

import numpy as np
import pytest

from grashof import load
from grashof.problems import Problem
from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.synth import Candidate
from grashof.synth.designs.judging import judged
from grashof.synth.designs.ranking import BLOCK, _beaten, ranked
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.finder import finder_for
from grashof.synth.search.ledger import Leaders


@pytest.fixture(scope="module")
def problem() -> Problem:
    return load("luggage")


@pytest.fixture(scope="module")
def designs(problem: Problem) -> list[Candidate]:
    """Some designs, and others hardly distinct from them."""
    scaled, rng = ScaledProblem.of(problem), np.random.default_rng(0)
    found = finder_for(scaled).near(rng)
    made = []
    for k in rng.permutation(len(found))[:25]:
        one = judged(scaled, found.points[k], int(found.assembly[k]), 0.0, start=int(k), iterations=0)
        assert one is not None
        made.append(one)
    made += [
        replace(one, linkage=replace(one.linkage, r2=one.linkage.r2 * (1 + step)))
        for one in made
        for step in (1e-3, 6e-3, 9e-3)
    ]
    return [made[k] for k in rng.permutation(len(made))]


@pytest.mark.quick("7", "100")
@pytest.mark.parametrize("batch", [1, 7, 100])
def test_they_are_those_ranked_at_once(problem: Problem, designs: list[Candidate], batch: int) -> None:
    leaders = Leaders(problem)
    for first in range(0, len(designs), batch):
        leaders.add(designs[first : first + batch])
        told = [one.id for one in leaders.distinct]
        assert told == [one.id for one in ranked(problem, designs[: first + batch])]
    assert len(leaders) == len(designs)
    assert len(leaders.distinct) < len(designs)


def of_all_pairs(costs: FloatArray) -> BoolArray:
    no_worse, better = (costs[:, None] <= costs).all(axis=2), (costs[:, None] < costs).any(axis=2)
    beaten: BoolArray = (no_worse & better).any(axis=0)
    return beaten


@pytest.mark.parametrize("count", [0, 1, BLOCK, 3 * BLOCK + 5])
def test_who_is_beaten_block_by_block_is_who_is_beaten_by_any(count: int) -> None:
    costs = np.random.default_rng(count).integers(0, 12, (count, 3)).astype(float)
    np.testing.assert_array_equal(_beaten(costs), of_all_pairs(costs))
