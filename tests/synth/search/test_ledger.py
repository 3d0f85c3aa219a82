"""Ledgers: what a search keeps is bounded, and is the best of all designs ranked at once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import grashof.synth.search.ledger as ledger_module
from grashof import load
from grashof.problems import Problem
from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.synth import Candidate
from grashof.synth.designs.judging import judged, judged_again
from grashof.synth.designs.ranking import BLOCK, _beaten, ranked
from grashof.synth.programme.start import Round
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import Attempt
from grashof.synth.search.chunks import arguments, chunk
from grashof.synth.search.finder import finder_for
from grashof.synth.search.ledger import Chunk, Leaders, Ledger, Tally, nearest_of_kinds


@pytest.fixture(scope="module")
def scaled() -> ScaledProblem:
    return ScaledProblem.of(load("luggage"))


@pytest.fixture(scope="module")
def attempts(scaled: ScaledProblem) -> list[Attempt]:
    """Designs of many kinds, each as if it had been solved for."""
    found = finder_for(scaled).near(np.random.default_rng(0))
    picked = np.linspace(0, len(found) - 1, 240).astype(int).tolist()
    made = (
        judged(scaled, found.points[k], int(found.assembly[k]), 0.0, start=k, iterations=0) for k in picked
    )
    return [Attempt("Solve_Succeeded", one) for one in made if one is not None]


def filled(scaled: ScaledProblem, attempts: list[Attempt]) -> Ledger:
    ledger = Ledger(scaled, replace(scaled.problem.search, enough=5), "")
    ledger._errors.append(np.inf)
    for begin in range(0, len(attempts), 16):
        ledger.take(attempts[begin : begin + 16])
        ledger.rank()
    return ledger


@pytest.mark.parametrize(
    ("enough", "rounds", "ends"),
    [
        (1, [(2.0, 0), (2.0, 0)], [False, True]),  # two rounds agree
        (1, [(2.0, 8)], [True]),  # or draws of one
        (1, [(2.0, 0), (3.0, 20), (2.0, 0)], [False, False, True]),  # unless they agree on a worse one
        (1, [(np.inf, 20), (2.0, 1)], [False, False]),
        (20, [(2.0, 20), (2.0, 20), (2.0, 20)], [False, False, True]),
    ],
)
def test_a_search_ends_once_the_least_error_stands(
    attempts: list[Attempt], enough: int, rounds: list[tuple[float, int]], ends: list[bool]
) -> None:
    """Of rounds with a least error and a number of draws that led to it."""
    problem, best = load("path-ellipse"), attempts[0].candidate
    assert best is not None
    ledger = Ledger(ScaledProblem.of(problem), replace(problem.search, enough=enough), "")
    for (error, reached), ended in zip(rounds, ends, strict=True):
        ledger.begin(Round([], {}, reached=reached))
        ledger._errors[-1] = error
        ledger.best = (best,) if ledger.least < np.inf else ()
        assert ledger.ended is ended


@pytest.mark.slow
def test_the_best_stay_of_very_many(
    scaled: ScaledProblem, attempts: list[Attempt], monkeypatch: pytest.MonkeyPatch
) -> None:
    every = filled(scaled, attempts)
    monkeypatch.setattr(ledger_module, "MOST_KEPT", 20)
    some = filled(scaled, attempts)
    assert len(every.best) > 60
    assert len(some.verified) <= 2 * 20 + 16 < len(every.verified)
    assert [one.id for one in some.best[:20]] == [one.id for one in every.best[:20]]
    assert some.tally == every.tally


@pytest.mark.study
def test_misses_are_bounded_by_kind(
    scaled: ScaledProblem, attempts: list[Attempt], monkeypatch: pytest.MonkeyPatch
) -> None:
    strict = replace(scaled.problem.requirements, transmission_min_deg=27.25, r1=(1.0, 7.0))
    asked = scaled.of_problem(replace(scaled.problem, requirements=strict))
    designs = [judged_again(asked, one.candidate) for one in attempts if one.candidate is not None]
    missed = [Attempt("", one) for one in designs if not one.verdict.ok]
    kinds = {frozenset(each.requirement for each in one.verdict.defects) for one in designs} - {frozenset()}
    kept = nearest_of_kinds([*missed, Attempt("Infeasible_Problem_Detected", None)])
    assert len(kinds) > 1
    assert len(kinds) < len(kept) <= 8 * len(kinds) < len(missed)
    for kind in kinds:
        of_kind = [
            one
            for one in missed
            if one.candidate and kind == {d.requirement for d in one.candidate.verdict.defects}
        ]
        nearest = min(of_kind, key=lambda one: sum(d.miss for d in one.candidate.verdict.defects))
        assert nearest in kept
    monkeypatch.setattr(ledger_module, "MOST_KEPT", 20)
    assert len(filled(asked, missed).rejected) <= 2 * 20 + 16


@pytest.mark.slow
def test_chunks_add_up(scaled: ScaledProblem) -> None:
    search = scaled.problem.search
    some = [chunk(scaled, number, *arguments(search, 5)) for number in range(3)]
    ledger = Ledger(scaled, search, "")
    for one in some:
        ledger.absorb(one)
    whole = ledger.chunk
    assert isinstance(whole, Chunk)
    assert whole.solved == 15
    assert whole.size == 3
    assert whole.tally.statuses == sum(
        (one.tally.statuses for one in some), start=type(whole.tally.statuses)()
    )
    assert {each.id for each in whole.designs} <= {each.id for one in some for each in one.designs}
    assert sorted(each.start for each in ledger.verified)[-1] >= 10


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


def test_starts_are_numbered_on_from_chunk_to_chunk(scaled: ScaledProblem, designs: list[Candidate]) -> None:
    ledger = Ledger(scaled, scaled.problem.search, "")
    for _ in range(3):
        ledger.absorb(Chunk(Tally(), (replace(designs[0], start=2),), (), solved=5, size=1))
    assert [one.start for one in ledger.verified] == [2, 7, 12]


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
