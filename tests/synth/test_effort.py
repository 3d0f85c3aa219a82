"""Costs of searches, in Ipopt's solves and iterations on fixed seeds: hardly a matter of the machine.

Processors round differently, and a solve that wanders may then take 250 iterations instead of 90. So
iterations are counted up to fifty a solve and added up over three seeds; kernels of BLAS and NumPy for
Nehalem, Haswell and Skylake-X then differ by a sixth at most: the figures below lie between them.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import pytest

from grashof.problems import Problem, load
from grashof.problems.files.on_disk import document_of, problem_text
from grashof.problems.files.problem_schema import problem_from
from grashof.synth import synthesize
from grashof.synth.programme import nonlinear_programme

MORE, LESS = 1.25, 0.6  # times the figures below
SEEDS = range(3)
COUNTED = 50  # iterations of a solve at most


class Effort(NamedTuple):
    """Of the searches of all seeds: Ipopt's solves, iterations that count, and designs found."""

    solves: int
    iterations: int
    designs: int


# Measured; update a figure where a search has become cheaper, and say why where it has become dearer.
EXPECTED = {
    "luggage": Effort(96, 943, 72),
    "luggage through zones": Effort(135, 2810, 75),
    "luggage by a slider-crank": Effort(96, 1870, 79),
    "path-8-points": Effort(68, 2800, 29),
    "path-vertical-line": Effort(96, 1560, 126),
    "path-18-timed": Effort(51, 1125, 38),
    "path-ellipse": Effort(102, 3930, 49),
    "path-ellipse through zones": Effort(74, 3110, 43),
}


def task(name: str) -> Problem:
    if " " not in name:
        return load(name)
    document = document_of(problem_text(name.split()[0]), name)
    if "zones" in name:
        document[document["kind"]]["within"] = 0.05 if document["kind"] == "motion" else 0.5
    else:
        document["mechanism"] = "slider-crank"
        document["requirements"] = {"rotatability": "any"}
        del document["motion"]["poses"][2]
    return problem_from(document, name)


def effort_of(problem: Problem, monkeypatch: pytest.MonkeyPatch) -> Effort:
    spent: list[int] = []
    solve = nonlinear_programme.solve

    def counted(*given: Any) -> Any:
        solved = solve(*given)
        spent.append(min(solved.iterations, COUNTED))
        return solved

    monkeypatch.setattr(nonlinear_programme, "solve", counted)
    designs = sum(len(synthesize(problem, seed=seed, starts=48, enough=24, effort=0.2)) for seed in SEEDS)
    return Effort(len(spent), sum(spent), designs)


@pytest.mark.slow
@pytest.mark.quick("luggage")
@pytest.mark.parametrize("name", EXPECTED)
def test_a_search_costs_no_more_than_it_did(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    found, expected = effort_of(task(name), monkeypatch), EXPECTED[name]
    for spent, before in zip(found[:2], expected[:2], strict=True):
        assert LESS * before <= spent <= MORE * before + 10, f"{name}: {found}"
    assert found.designs >= 0.8 * expected.designs, f"{name}: {found}"
