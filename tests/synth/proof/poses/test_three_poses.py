"""Three poses: published figures, one side alone, pivots that are given, budgets, refusals."""

from dataclasses import replace
from itertools import count

import numpy as np
import pytest
from proof_problems import TRANSLATIONS, bonnet, of_three, planted_limits, rotation, with_links

from grashof import synthesize
from grashof.problems import Box, FourBar, MotionTask, Objective, Problem, Requirements
from grashof.synth import Claim, prove
from grashof.synth.proof.claims.bounds import Bounds, Proving
from grashof.synth.proof.provers import bounds_before, bounds_of_three
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.stopping import stopping
from grashof.wording.proof import bound_line

WALL, INSIDE = Box((-1.2, -0.06), (0.3, 2.1)), Box((-1.0, 1.0), (0.04, 0.2))
BEST = 53.3964  # deg, of the bonnet, by the search


def garage_door() -> Problem:
    """The gallery's garage door, without its lintel."""
    limits = {"o2": WALL, "o4": WALL, "a_on_body": INSIDE, "b_on_body": INSIDE}
    wanted = Requirements(rotatability="any", link_length=(0.2, 1.6), **limits)  # type: ignore[arg-type]
    return Problem(
        task=MotionTask.from_degrees([[0, 1.06, 90], [-0.15, 1.36, 130], [-0.75, 2.08, 180]]),
        requirements=wanted,
    )


def three_of_luggage() -> Problem:
    """Poses 1, 2 and 4 of the luggage task, with practical limits."""
    return of_three(with_links(5, 1, coupler_arms=(0.5, 5), link_ratio_max=8.0, transmission_over="cycle"))


@pytest.fixture(scope="module")
def of_bonnet() -> Bounds:
    return bounds(bonnet(), gap=0.1)


def bounds(problem: Problem, **options: float) -> Bounds:
    proving = Proving(**options, minutes=True)  # type: ignore[arg-type]
    made = bounds_of_three(ScaledProblem.of(problem), proving)
    assert made is not None
    return made


# Best transmission angles, deg, by the search and by an independent prover (luggage: 25.984 to 26.084).
@pytest.mark.quick("bonnet", "garage door")
@pytest.mark.parametrize("name", ["bonnet", "garage door", "luggage"])
def test_bounds_close_about_the_best_known(name: str, of_bonnet: Bounds) -> None:
    gap, best = {"bonnet": (0.1, BEST), "garage door": (0.1, 79.353), "luggage": (1.0, 25.99)}[name]
    others = {"garage door": garage_door, "luggage": three_of_luggage}
    made = bounds(others[name](), gap=gap) if name in others else of_bonnet
    lower, upper = np.degrees(made.lower), np.degrees(made.upper)
    assert made.closed
    assert lower <= best + 0.01
    assert best - 0.01 <= upper <= lower + gap + 1e-9


def test_a_design_that_is_known_counts(of_bonnet: Bounds) -> None:
    scaled, known = ScaledProblem.of(bonnet()), float(np.radians(BEST - 1e-3))
    made = bounds_of_three(scaled, Proving(gap=0.1, minutes=True), lower=known)
    assert made is not None
    assert made.closed
    assert made.upper == pytest.approx(max(made.lower, known) + np.radians(0.1))
    assert made.pairs < of_bonnet.pairs


def test_a_larger_budget_leaves_a_closer_bound() -> None:
    before = 90.0
    for most in (1, 8_000, 14_000):
        made = bounds(bonnet(), gap=0.1, most_pairs=most)
        assert not made.closed
        assert made.why == f"the budget of {most} pairs ended"
        assert made.pairs <= most
        assert BEST - 0.01 <= np.degrees(made.upper) <= before
        before = float(np.degrees(made.upper))
    assert before < 60


def test_what_is_stopped_leaves_a_bound_that_holds() -> None:
    for most in (0, 1, 3, 6):
        required = count()
        with stopping(lambda: next(required) >= most):  # noqa: B023  (called within the loop)
            made = bounds(bonnet())
        assert not made.closed
        assert made.why == "it was stopped"
        assert np.degrees(made.upper) >= BEST


def test_one_design_decides_what_is_possible() -> None:
    proof = prove(bonnet(), at_least=50.0)
    assert proof.lower is not None
    assert proof.lower >= 50.0
    never = prove(bonnet(), at_least=53.6)
    assert (never.claim, never.upper) == (Claim.NONE, pytest.approx(53.6))


def box(x: float, y: float, half: float = 0.0) -> Box:
    return Box((x - half, x + half), (y - half, y + half))


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


def given(design: FourBar, names: str, off: float = 0.0) -> Problem:
    """The bonnet with pivots of a design given."""
    places = {
        f"o{name}": box(float(x), float(y) + off) for name in names for x, y in [getattr(design, f"o{name}")]
    }
    return bonnet(**places)


def test_pivots_that_are_given_are_decided_at_once(of_bonnet: Bounds) -> None:
    assert of_bonnet.found is not None
    design = of_bonnet.found.linkage
    assert isinstance(design, FourBar)
    made = bounds_before(ScaledProblem.of(given(design, "24")), Proving())
    assert made is not None
    assert made.closed
    assert made.pairs <= 100
    assert made.lower == pytest.approx(of_bonnet.lower, abs=1e-6)
    far = bounds_before(ScaledProblem.of(given(design, "24", off=60.0)), Proving())
    assert far is not None
    assert far.none


@pytest.mark.quick("0", "1", "2")
@pytest.mark.parametrize("seed", range(100))
def test_limits_that_just_hold_a_linkage_have_it(seed: int) -> None:
    task, lengths, boxes = planted_limits(seed, 3)
    which = {0: boxes, 1: {**lengths, **boxes}, 2: {**lengths, "o2": boxes["o2"]}}[seed % 3]
    problem = Problem(task=task, requirements=Requirements(rotatability="any", **which))  # type: ignore[arg-type]
    assert not bounds(problem, gap=1.0, most_pairs=40_000 if seed < 9 else 200_000).none


def test_a_list_and_its_bound_agree() -> None:
    result = synthesize(bonnet(), enough=10, prove=True, gap=0.1)
    proof = result.proof
    assert proof is not None
    assert proof.claim is Claim.BEST
    assert proof.lower is not None
    assert proof.upper is not None
    assert proof.lower <= BEST + 0.01 <= proof.upper + 0.01
    assert synthesize(bonnet(), enough=5).proof is None


@pytest.mark.parametrize(
    ("problem", "why"),
    [
        (Problem(task=rotation(0.0, 0.4, 1.7)), "the poses are a rotation about one point"),
        (Problem(task=MotionTask.from_degrees(TRANSLATIONS[:3])), "the poses are translations"),
        (
            replace(bonnet(), objective=Objective(transmission=1.0, compactness=0.2)),
            "the objective has no forms; transmission alone has",
        ),
        (bonnet(same_branch=False), "same_branch = false allows designs that transmit nothing"),
    ],
)
def test_what_has_no_proof_is_refused_in_words(problem: Problem, why: str) -> None:
    proof = prove(problem)
    assert (proof.claim, proof.why, proof.upper) == (Claim.REFUSED, why, None)


def test_requirements_without_a_form_leave_a_bound() -> None:
    proof = prove(bonnet(size=(0.0, 2000.0)), gap=5.0)
    assert proof.left_out == ("size",)
    assert proof.upper is not None
    assert proof.upper >= BEST - 0.01
