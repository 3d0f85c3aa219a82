"""What searches cost, in Ipopt's solves and iterations on fixed seeds: it does not depend on the machine."""

from __future__ import annotations

from typing import Any, NamedTuple

import pytest

from grashof.problems import Problem, load
from grashof.problems.files.problem_file import problem_text
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.toml_file import document_of
from grashof.synth import synthesize
from grashof.synth.programme import exchange

MORE, LESS = 1.25, 0.6  # times the figures below


class Effort(NamedTuple):
    """Of a search: Ipopt's solves and iterations, and the designs found."""

    solves: int
    iterations: int
    designs: int


# Measured; update a figure where a search has become cheaper, and say why where it has become dearer.
EXPECTED = {
    "luggage": Effort(32, 314, 24),
    "luggage through zones": Effort(44, 1376, 25),
    "luggage by a slider-crank": Effort(32, 624, 26),
    "path-8-points": Effort(27, 2094, 11),
    "path-vertical-line": Effort(32, 493, 42),
    "path-18-timed": Effort(17, 631, 12),
    "path-ellipse": Effort(34, 1778, 15),
    "path-ellipse through zones": Effort(26, 1821, 16),
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
    solve = exchange.solve

    def counted(*given: Any) -> Any:
        solved = solve(*given)
        spent.append(solved.iterations)
        return solved

    monkeypatch.setattr(exchange, "solve", counted)
    found = synthesize(problem, seed=0, starts=48, enough=24, effort=0.2)
    return Effort(len(spent), sum(spent), len(found))


@pytest.mark.parametrize("name", EXPECTED)
def test_a_search_costs_no_more_than_it_did(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    found, expected = effort_of(task(name), monkeypatch), EXPECTED[name]
    for spent, before in zip(found[:2], expected[:2], strict=True):
        assert LESS * before <= spent <= MORE * before + 10, f"{name}: {found}"
    assert found.designs >= 0.8 * expected.designs, f"{name}: {found}"
