"""Bounds of the best: published figures, planted limits, budgets, interruptions, refusals."""

from dataclasses import replace
from itertools import count

import numpy as np
import pytest
from proof_problems import STAIRS, TRANSLATIONS, luggage, planted_limits, rotation, with_links

from grashof import load
from grashof.problems import Box, FourBar, MotionTask, Objective, Problem, ProblemError, Requirements
from grashof.synth import Claim, prove
from grashof.synth.proof.claims.bounds import Bounds, Proving
from grashof.synth.proof.curve.required import Required
from grashof.synth.proof.curve.table import Table
from grashof.synth.proof.poses.branch_and_bound import Search
from grashof.synth.proof.provers import bounds_of
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.stopping import stopping


def bounds(problem: Problem, **options: float) -> Bounds:
    made = bounds_of(ScaledProblem.of(problem), Proving(**options))  # type: ignore[arg-type]
    assert made is not None
    return made


# Best transmission angles, deg, by an independent prover and by search (luggage, and with other limits).
BEST = [
    (luggage(), 27.33255),
    (with_links(5, transmission_over="cycle"), 13.4412),
    (with_links(8, transmission_over="cycle"), 22.6984),
    (with_links(12, transmission_over="cycle"), 30.1742),
    (with_links(5, rotatability="any"), 23.7524),
    (with_links(8, rotatability="any", keep_out=(STAIRS,)), 13.42467),  # both ground pivots outside
]


@pytest.mark.parametrize(
    ("problem", "best"), BEST, ids=lambda each: "" if isinstance(each, Problem) else each
)
def test_bounds_close_about_the_best_known(problem: Problem, best: float) -> None:
    made = bounds(problem)
    lower, upper = np.degrees(made.lower), np.degrees(made.upper)
    assert made.closed
    assert lower <= best + 5e-5
    assert best - 5e-5 <= upper <= lower + 0.01 + 1e-9


def test_what_exceeds_the_gap_is_not_dropped() -> None:
    # Of a bound that is 1.5 gaps below the best, the pairs that hold the best have to be left.
    required, gap = Required.of(ScaledProblem.of(luggage())), np.radians(0.1)
    search = Search(required, gap, 20_000, lower=np.radians(27.33255) - 1.5 * gap)
    search.run(Table.covering(required), lambda _table, _pairs, _least: 0.0)
    assert not search.done
    assert search.upper >= np.radians(27.33255)


def fixed(point: np.ndarray) -> Box:
    x, y = (float(each) for each in point)
    return Box((x, x), (y, y))


def test_limits_of_no_width_are_met_by_designs() -> None:
    linkage = bounds(luggage()).found.linkage  # type: ignore[union-attr]
    assert isinstance(linkage, FourBar)
    length, on_line = (float(linkage.r2),) * 2, Box((-50, 50), (0.0, 0.0))
    best = 27.33255
    for limits, most in (
        ({"o2": fixed(linkage.o2)}, best),
        ({"r2": length, "r4": (float(linkage.r4),) * 2}, best),
        ({"o2": on_line}, 21.8713),
        ({"o2": Box((-50, 50), (-3.0, -3.0)), "o4": Box((-50, 50), (2.0, 2.0))}, 25.6440),
    ):
        made = bounds(luggage(**limits))
        assert made.closed, limits
        assert np.degrees(made.lower) <= most + 1e-3
        assert most - 2e-2 <= np.degrees(made.upper) <= most + 0.011
        assert made.pairs < 10_000


@pytest.mark.quick("0", "1", "2", "3")
@pytest.mark.parametrize("seed", range(200))
def test_limits_that_just_hold_a_linkage_have_it(seed: int) -> None:
    task, lengths, boxes = planted_limits(seed, 4)
    which = {0: lengths, 1: boxes, 2: {**lengths, **boxes}}[seed % 3]
    made = bounds(Problem(task=task, requirements=Requirements(rotatability="any", **which)))  # type: ignore[arg-type]
    assert not made.none
    assert made.closed
    assert made.found is not None or seed >= 12


def test_none_is_proven_where_a_length_is_out_of_reach() -> None:
    made = bounds(luggage(link_length=(0.3, 2.0), coupler_arms=(0.3, 2.0)))
    assert made.none
    assert np.degrees(made.upper) == pytest.approx(0.01)


def test_more_than_the_best_is_proven_to_be_impossible() -> None:
    at_least = 27.35
    demanded = prove(luggage(transmission_min_deg=at_least))
    for proof in (prove(load("luggage"), at_least=at_least), demanded):
        assert (proof.claim, proof.complete, proof.lower) == (Claim.NONE, True, None)
        assert proof.upper == pytest.approx(at_least)


def test_a_budget_leaves_a_bound_that_holds() -> None:
    best = bounds(luggage())
    for most in (1, 2800):
        made = bounds(luggage(), most_pairs=most)
        assert not made.closed
        assert made.why == f"the budget of {most} pairs ended"
        assert made.upper >= best.lower
        assert made.pairs <= most


def test_a_search_that_is_stopped_leaves_a_bound_that_holds() -> None:
    best = bounds(luggage()).lower
    for most in (0, 3):
        required = count()
        with stopping(lambda: next(required) >= most):  # noqa: B023  (called within the loop)
            made = bounds(luggage())
        assert not made.closed
        assert made.why == "it was stopped"
        assert made.upper >= best


def test_requirements_without_a_form_leave_a_bound() -> None:
    problem = luggage(size=(0.0, 12.5))
    proof = prove(problem)
    assert proof.left_out == ("size",)
    assert proof.claim is Claim.BOUND
    assert proof.upper == pytest.approx(27.34, abs=0.01)
    wanted = replace(problem.requirements, link_length=(0.3, 2.0), coupler_arms=(0.3, 2.0))
    never = prove(replace(problem, requirements=wanted))
    assert never.claim is Claim.NONE
    own = prove(load("luggage"), constraints=[lambda design: design.r1 - design.r3])
    assert own.left_out == ("constraints",)
    assert own.upper == pytest.approx(27.34, abs=0.01)


def test_a_plane_of_dyads_is_refused() -> None:
    for task in (rotation(0.0, 0.4, 0.9, 1.7), MotionTask.from_degrees(TRANSLATIONS)):
        made = bounds(Problem(task=task))
        assert made.refused
        assert "plane of dyads" in made.why


def test_other_objectives_and_tasks_are_refused_in_words() -> None:
    problem = replace(load("luggage"), objective=Objective(transmission=1.0, compactness=0.2))
    for other, why in (
        (problem, "the objective has no forms; transmission alone has"),
        (load("straight-line"), "there are proofs of three to five whole poses"),
    ):
        proof = prove(other)
        assert (proof.claim, proof.upper) == (Claim.REFUSED, None)
        assert proof.why.startswith(why)


IMPOSSIBLE = {"at_least": (-1.0, 91.0, np.nan), "gap": (0.0, -1.0, 100.0, np.inf)}


@pytest.mark.parametrize(
    ("name", "value"), [(name, value) for name, values in IMPOSSIBLE.items() for value in values]
)
def test_an_angle_or_a_gap_that_cannot_be_is_refused(name: str, value: float) -> None:
    with pytest.raises(ProblemError, match=name):
        prove(load("luggage"), **{name: value})


def test_scale_and_place_change_nothing() -> None:
    task, scale = load("luggage").task, 1e6
    lengths = (0.3 * scale, 8 * scale)
    far = Problem(
        task=MotionTask(task.positions * scale + 3 * scale, task.angles),
        requirements=Requirements(link_length=lengths, coupler_arms=lengths),
    )
    made = bounds(far)
    assert made.closed
    assert np.degrees(made.lower) == pytest.approx(27.33, abs=0.01)
