"""The hand-tuned search: the report's guesses; pairs judged at once as one by one."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from grashof import load
from grashof.analysis import Verdict, solve_position, verify
from grashof.problems import Problem


@pytest.fixture(scope="module")
def hand(script: Callable[[str], ModuleType]) -> ModuleType:
    return script("hand_tuned_search")


@pytest.fixture(scope="module")
def luggage() -> Problem:
    return load("luggage")


@pytest.fixture(scope="module")
def few(hand: ModuleType, luggage: Problem) -> tuple[list[Any], Any]:
    """Thirty dyads from random guesses, and what their pairs do."""
    dyads = hand.random_dyads(luggage.task, 30, seed=3)
    return dyads, hand.judged_pairs(luggage, dyads)


def test_the_guess_that_works_leads_to_the_linkage_of_the_report(hand: ModuleType, luggage: Problem) -> None:
    found = hand.tried(luggage, hand.GUESSES[4])
    assert max(found.left.residual, found.right.residual) < 1e-5
    assert found.linkage.lengths == pytest.approx([3.91882993, 3.23490430, 4.09244415, 3.70202612], abs=5e-3)
    assert np.degrees(found.verdict.transmission_min_cycle) == pytest.approx(8.27, abs=0.01)
    said = hand.outcome(found)
    assert said.startswith("crank-rocker, passes the poses in order, mu 22.2")


def test_a_dyad_closes_where_its_residual_says(hand: ModuleType, luggage: Problem) -> None:
    """And a linkage of two dyads passes the first pose."""
    found = hand.tried(luggage, hand.GUESSES[0])
    task = luggage.task
    for dyad in (found.left, found.right):
        turns = np.array([0.0, *dyad.turns])
        body = np.exp(1j * (task.angles - task.angles[0]))
        place = task.positions @ np.array([1, 1j])
        gap = dyad.link * (np.exp(1j * turns) - 1) + dyad.arm * (body - 1) - (place - place[0])
        assert np.sqrt((np.abs(gap) ** 2).sum()) == pytest.approx(dyad.residual)
    state = solve_position(found.linkage, np.angle(found.left.link))
    np.testing.assert_allclose(state.p, task.positions[0], atol=1e-12)
    assert state.theta3 + found.linkage.body_angle == pytest.approx(0, abs=1e-12)


def test_defects_are_named_in_the_outcome(hand: ModuleType, luggage: Problem) -> None:
    each = hand.tried(luggage, hand.GUESSES[4])

    def described(**changed: bool) -> str:
        verdict: Verdict = replace(each.verdict, **changed)
        return str(hand.outcome(replace(each, verdict=verdict)))

    assert "circuit defect" in described(circuit_ok=False, branch_ok=False)
    assert "branch defect" in described(branch_ok=False)
    assert "out of order" in described(order_ok=False)
    assert "over the turn" not in described(full_rotation=False)


@pytest.mark.study
def test_pairs_are_judged_as_by_the_judge(hand: ModuleType, luggage: Problem, few: tuple[Any, Any]) -> None:
    dyads, pairs = few
    assert pairs.exact.sum() > 300
    assert pairs.good.sum() <= pairs.crank_rocker.sum() < pairs.in_order.sum() < pairs.exact.sum()
    assert (pairs.usable <= pairs.in_order).all()
    assert hand.agreement(luggage, dyads, pairs, 60) == 60
    for i, j in np.argwhere(pairs.crank_rocker)[:3]:
        verdict = verify(
            hand.linkage_of(luggage.task, dyads[i], dyads[j]), luggage.task, luggage.requirements
        )
        assert verdict.full_rotation
        assert str(verdict.grashof_class) == "crank-rocker"


def test_shares_and_their_intervals(hand: ModuleType) -> None:
    every = np.zeros((40, 40), dtype=bool)
    every[:10] = True
    np.fill_diagonal(every, val=False)
    found, low, high = hand.share(every)
    assert found == pytest.approx(0.25)
    # Ten of forty drivers: the interval is about that of a share of forty.
    assert low == pytest.approx(0.12, abs=0.04)
    assert high == pytest.approx(0.39, abs=0.04)


@pytest.mark.study
def test_it_prints_what_guesses_come_to(hand: ModuleType, capsys: pytest.CaptureFixture[str]) -> None:
    assert hand.main(["--starts", "40"]) == 0
    said = capsys.readouterr().out
    assert all(f"│ T{number} " in said for number in range(2, 7))
    assert "all 1560 pairs" in said.replace("\n", " ")
    assert "agrees on 100 of 100" in said
    assert re.search(r"grashof.synthesize: \d\d designs", said)
