"""Bounds of three and four poses: published figures, planted limits, budgets, interruptions, refusals."""

from dataclasses import replace
from functools import cache
from itertools import count

import numpy as np
import pytest
from proof_problems import (
    STAIRS,
    TRANSLATIONS,
    bonnet,
    luggage,
    of_three,
    planted_limits,
    rotation,
    with_links,
)

from grashof import load, synthesize
from grashof.problems import Box, FourBar, MotionTask, Objective, Problem, ProblemError, Requirements
from grashof.synth import Claim, prove
from grashof.synth.proof.claims.bounds import Bounds, Proving
from grashof.synth.proof.curve.required import Required
from grashof.synth.proof.curve.table import Table
from grashof.synth.proof.poses.branch_and_bound import Search
from grashof.synth.proof.poses.three_poses import bounds_of_three
from grashof.synth.proof.provers import bounds_before, bounds_of
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.stopping import stopping
from grashof.wording.proof import bound_line

WALL, INSIDE = Box((-1.2, -0.06), (0.3, 2.1)), Box((-1.0, 1.0), (0.04, 0.2))


def garage_door() -> Problem:
    """The gallery's garage door, without its lintel."""
    limits = {"o2": WALL, "o4": WALL, "a_on_body": INSIDE, "b_on_body": INSIDE}
    wanted = Requirements(rotatability="any", link_length=(0.2, 1.6), **limits)  # type: ignore[arg-type]
    return Problem(
        task=MotionTask.from_degrees([[0, 1.06, 90], [-0.15, 1.36, 130], [-0.75, 2.08, 180]]),
        requirements=wanted,
    )


# Problem; its best transmission angle, deg, by search and by an independent prover, and its last digit; gap.
KNOWN: dict[str, tuple[Problem, float, float, float]] = {
    "luggage": (luggage(), 27.33255, 5e-5, 0.01),
    "links to 5 over the turn": (with_links(5, transmission_over="cycle"), 13.4412, 5e-5, 0.01),
    "links to 8 over the turn": (with_links(8, transmission_over="cycle"), 22.6984, 5e-5, 0.01),
    "links to 12 over the turn": (with_links(12, transmission_over="cycle"), 30.1742, 5e-5, 0.01),
    "any rotatability": (with_links(5, rotatability="any"), 23.7524, 5e-5, 0.01),
    # Both ground pivots are outside.
    "area kept out": (with_links(8, rotatability="any", keep_out=(STAIRS,)), 13.42467, 5e-5, 0.01),
    "bonnet": (bonnet(), 53.3964, 0.01, 0.1),
    "garage door": (garage_door(), 79.353, 0.01, 0.1),
    # Poses 1, 2 and 4, with practical limits: 25.984 to 26.084 by the independent prover.
    "three of the luggage": (
        of_three(with_links(5, 1, coupler_arms=(0.5, 5), link_ratio_max=8, transmission_over="cycle")),
        25.99, 0.01, 1.0,
    ),
}  # fmt: skip
BEST = KNOWN["bonnet"][1]


def bounds(problem: Problem, **options: float) -> Bounds:
    made = bounds_of(ScaledProblem.of(problem), Proving(**options, minutes=True))  # type: ignore[arg-type]
    assert made is not None
    return made


@cache
def known(name: str) -> Bounds:
    """Bounds of a problem whose best is known."""
    problem, *_, gap = KNOWN[name]
    return bounds(problem, gap=gap)


@pytest.mark.quick(*(set(KNOWN) - {"garage door", "three of the luggage"}))
@pytest.mark.parametrize("name", KNOWN)
def test_bounds_close_about_the_best_known(name: str) -> None:
    _, best, digit, gap = KNOWN[name]
    made = known(name)
    lower, upper = np.degrees(made.lower), np.degrees(made.upper)
    assert made.closed
    assert lower <= best + digit
    assert best - digit <= upper <= lower + gap + 1e-9


@pytest.mark.parametrize(
    ("name", "budgets", "last"), [("luggage", (1, 2800), 90.0), ("bonnet", (1, 8_000, 14_000), 60.0)]
)
def test_a_larger_budget_leaves_a_closer_bound(name: str, budgets: tuple[int, ...], last: float) -> None:
    problem, best, digit, gap = KNOWN[name]
    before = 90.0
    for most in budgets:
        made = bounds(problem, gap=gap, most_pairs=most)
        assert not made.closed
        assert made.why == f"the budget of {most} pairs ended"
        assert made.pairs <= most
        assert best - digit <= np.degrees(made.upper) <= before
        before = float(np.degrees(made.upper))
    assert before <= last


@pytest.mark.parametrize(("name", "steps"), [("luggage", (0, 3)), ("bonnet", (0, 1, 3, 6))])
def test_a_search_that_is_stopped_leaves_a_bound_that_holds(name: str, steps: tuple[int, ...]) -> None:
    for most in steps:
        required = count()
        with stopping(lambda: next(required) >= most):  # noqa: B023  (called within the loop)
            made = bounds(KNOWN[name][0])
        assert not made.closed
        assert made.why == "it was stopped"
        assert np.degrees(made.upper) >= KNOWN[name][1]


def test_what_exceeds_the_gap_is_not_dropped() -> None:
    # Of a bound that is 1.5 gaps below the best, the pairs that hold the best have to be left.
    required, gap = Required.of(ScaledProblem.of(luggage())), np.radians(0.1)
    search = Search(required, gap, 20_000, lower=np.radians(27.33255) - 1.5 * gap)
    search.run(Table.covering(required), lambda _table, _pairs, _least: 0.0)
    assert not search.done
    assert search.upper >= np.radians(27.33255)


def box(x: float, y: float, half: float = 0.0) -> Box:
    return Box((float(x) - half, float(x) + half), (float(y) - half, float(y) + half))


def test_limits_of_no_width_are_met_by_designs() -> None:
    linkage = known("luggage").found.linkage  # type: ignore[union-attr]
    assert isinstance(linkage, FourBar)
    length, on_line = (float(linkage.r2),) * 2, Box((-50, 50), (0.0, 0.0))
    best = 27.33255
    for limits, most in (
        ({"o2": box(*linkage.o2)}, best),
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
def test_limits_that_just_hold_a_linkage_of_four_poses_have_it(seed: int) -> None:
    task, lengths, boxes = planted_limits(seed, 4)
    which = {0: lengths, 1: boxes, 2: {**lengths, **boxes}}[seed % 3]
    made = bounds(Problem(task=task, requirements=Requirements(rotatability="any", **which)))  # type: ignore[arg-type]
    assert not made.none
    assert made.closed
    assert made.found is not None or seed >= 12


@pytest.mark.quick("0", "1", "2")
@pytest.mark.parametrize("seed", range(100))
def test_limits_that_just_hold_a_linkage_of_three_poses_have_it(seed: int) -> None:
    task, lengths, boxes = planted_limits(seed, 3)
    which = {0: boxes, 1: {**lengths, **boxes}, 2: {**lengths, "o2": boxes["o2"]}}[seed % 3]
    problem = Problem(task=task, requirements=Requirements(rotatability="any", **which))  # type: ignore[arg-type]
    assert not bounds(problem, gap=1.0, most_pairs=40_000 if seed < 9 else 200_000).none


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


def test_one_design_decides_what_is_possible() -> None:
    proof = prove(bonnet(), at_least=50.0)
    assert proof.lower is not None
    assert proof.lower >= 50.0
    never = prove(bonnet(), at_least=53.6)
    assert (never.claim, never.upper) == (Claim.NONE, pytest.approx(53.6))


def test_a_design_that_is_known_counts() -> None:
    scaled, lower = ScaledProblem.of(bonnet()), float(np.radians(BEST - 1e-3))
    made = bounds_of_three(scaled, Proving(gap=0.1, minutes=True), lower=lower)
    assert made is not None
    assert made.closed
    assert made.upper == pytest.approx(max(made.lower, lower) + np.radians(0.1))
    assert made.pairs < known("bonnet").pairs


@pytest.mark.slow
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
    of_three_poses = prove(bonnet(size=(0.0, 2000.0)), gap=5.0)
    assert of_three_poses.left_out == ("size",)
    assert of_three_poses.upper is not None
    assert of_three_poses.upper >= BEST - 0.01


NO_DRIVER = bonnet(o2=box(-55, -255, 5))
NO_DRIVEN = bonnet(o4=box(-55, -255, 5))


@pytest.mark.parametrize(("problem", "side"), [(NO_DRIVER, "link 2"), (NO_DRIVEN, "link 4")])
def test_a_side_without_dyads_is_named_before_any_search(problem: Problem, side: str) -> None:
    made = bounds_before(ScaledProblem.of(problem), Proving())
    assert made is not None
    assert made.none
    assert made.why.startswith(side)
    proof = prove(problem)
    assert (proof.claim, proof.complete) == (Claim.NONE, True)
    assert bound_line(proof).startswith(f"Proven: no four-bar meets these requirements, as {side}, with O")


def test_a_side_without_dyads_needs_no_form_of_the_objective() -> None:
    compact = Objective(compactness=1.0)
    assert prove(replace(NO_DRIVEN, objective=compact)).claim is Claim.NONE
    for problem in (bonnet(), replace(bonnet(), objective=compact)):  # most are searched at once
        assert bounds_before(ScaledProblem.of(problem), Proving()) is None


def test_pivots_that_are_given_are_decided_at_once() -> None:
    found = known("bonnet").found
    assert found is not None
    design = found.linkage
    assert isinstance(design, FourBar)

    def given(off: float) -> ScaledProblem:
        """The bonnet with the pivots of the design, moved up."""
        (x2, y2), (x4, y4) = design.o2, design.o4
        return ScaledProblem.of(bonnet(o2=box(x2, y2 + off), o4=box(x4, y4 + off)))

    made = bounds_before(given(0.0), Proving())
    assert made is not None
    assert made.closed
    assert made.pairs <= 100
    assert made.lower == pytest.approx(known("bonnet").lower, abs=1e-6)
    far = bounds_before(given(60.0), Proving())
    assert far is not None
    assert far.none


@pytest.mark.slow
def test_a_list_and_its_bound_agree() -> None:
    result = synthesize(bonnet(), enough=10, prove=True, gap=0.1)
    proof = result.proof
    assert proof is not None
    assert proof.claim is Claim.BEST
    assert proof.lower is not None
    assert proof.upper is not None
    assert proof.lower <= BEST + 0.01 <= proof.upper + 0.01
    assert synthesize(bonnet(), enough=5).proof is None


def test_a_plane_of_dyads_is_refused() -> None:
    for task in (rotation(0.0, 0.4, 0.9, 1.7), MotionTask.from_degrees(TRANSLATIONS)):
        made = bounds(Problem(task=task))
        assert made.refused
        assert "plane of dyads" in made.why


@pytest.mark.parametrize(
    ("problem", "why"),
    [
        (Problem(task=rotation(0.0, 0.4, 1.7)), "the poses are a rotation about one point"),
        (Problem(task=MotionTask.from_degrees(TRANSLATIONS[:3])), "the poses are translations"),
        (bonnet(same_branch=False), "same_branch = false allows designs that transmit nothing"),
        (load("straight-line"), "there are proofs of three to five whole poses"),
        *(
            (
                replace(problem, objective=Objective(transmission=1.0, compactness=0.2)),
                "the objective has no forms; transmission alone has",
            )
            for problem in (bonnet(), load("luggage"))
        ),
    ],
)
def test_what_has_no_proof_is_refused_in_words(problem: Problem, why: str) -> None:
    proof = prove(problem)
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
