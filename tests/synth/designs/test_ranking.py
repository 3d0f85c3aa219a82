"""Which of two designs is better: equal errors, the objective, and designs that are impractical."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof import synthesize
from grashof.analysis import verify
from grashof.problems import (
    FourBar,
    MotionTask,
    Objective,
    PathTask,
    Problem,
    ProblemError,
    Requirements,
    Rotatability,
    TransmissionOver,
)
from grashof.synth import Candidate
from grashof.synth.designs.families import caution, listed
from grashof.synth.designs.ranking import pareto_goals, pareto_optimal, ranked, ranking_key
from grashof.synth.designs.table import to_frame
from grashof.wording.problem import goals

POINTS = np.array([[0.0, 0], [1, 0.5], [2, 0.5], [4, 0]])  # size 4
LEAST_SQUARES = Problem(task=PathTask(POINTS), requirements=Requirements(exact=False))
EXACT = replace(LEAST_SQUARES, requirements=Requirements(exact=True))
LOOSE = replace(LEAST_SQUARES, requirements=Requirements(exact=False, tolerance=0.01))
CRANK = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
VERDICT = verify(CRANK, LEAST_SQUARES.task, LEAST_SQUARES.requirements)


def design(number: int, error: float = 0.0, mu: float = 40.0, size: float = 2.0, **more: Any) -> Candidate:
    """As if the judge had found these: error and size in sizes of the task, mu and turn in deg."""
    verdict = replace(
        VERDICT,
        position_error=np.full(4, 4 * error),
        square=4 * (4 * error) ** 2,
        transmission_min_task=np.radians(mu),
        transmission_min_cycle=np.radians(more.pop("cycle", mu)),
        size=4 * size,
        theta2=np.linspace(0, np.radians(more.pop("turn", 90.0)), 4),
        defects=(),
    )
    linkage = FourBar(o2=(0, 0), o4=(4 + number, 0), r2=1, r3=4, r4=3)
    return Candidate(linkage, verdict, LEAST_SQUARES, number, 0, **more)


def order(problem: Problem, *designs: Candidate) -> list[int]:
    """Numbers of the designs as ranked, whichever came first."""
    forth, back = (ranked(problem, each) for each in (designs, designs[::-1]))
    assert [each.start for each in forth] == [each.start for each in back]
    return [each.start for each in forth]


def test_errors_of_rounding_are_equal() -> None:
    """The better transmission angle comes first, whatever the noise."""
    assert order(LEAST_SQUARES, design(1, 1e-13, 11.8), design(2, 2e-13, 40.2)) == [2, 1]
    assert order(LEAST_SQUARES, design(1, 0.0, 11.8), design(2, 1e-6, 40.2)) == [2, 1]
    assert order(LEAST_SQUARES, design(1, 0.0, 11.8), design(2, 1.01e-6, 40.2)) == [1, 2]
    assert order(LEAST_SQUARES, design(1, 0.01, 11.8), design(2, 0.010001, 40.2)) == [1, 2]
    # At any size, as of cognates, which trace the same curve.
    assert order(LEAST_SQUARES, design(1, 0.02, 11.8), design(2, 0.02 * (1 + 1e-13), 40.2)) == [2, 1]


def test_a_greater_tolerance_makes_more_errors_equal() -> None:
    designs = design(1, 0.001, 11.8), design(2, 0.0099, 40.2), design(3, 0.0101, 60)
    assert order(LOOSE, *designs) == [2, 1, 3]
    assert order(LEAST_SQUARES, *designs) == [1, 2, 3]
    finer = replace(LOOSE, requirements=Requirements(exact=False, tolerance=1e-9))
    assert order(finer, design(1, 1e-8, 11.8), design(2, 1e-7, 40.2)) == [2, 1]


def test_exact_designs_are_ranked_by_the_objective() -> None:
    designs = design(1, 1e-12, 30, 3), design(2, 9e-7, 50, 5), design(3, 1e-9, 40, 1, cycle=5)
    assert order(EXACT, *designs) == [2, 3, 1]
    assert order(replace(EXACT, objective=Objective(0, 1)), *designs) == [3, 1, 2]
    turn = Requirements(exact=True, transmission_over="cycle")  # type: ignore[arg-type]
    assert order(replace(EXACT, requirements=turn), *designs) == [2, 1, 3]


def test_of_equal_objectives_the_smaller_design_comes_first() -> None:
    designs = design(1, 0, 40, 3), design(2, 0, 40, 2), design(3, 0, 40 + 1e-9, 4)
    for problem in (EXACT, LEAST_SQUARES):
        assert order(problem, *designs) == [2, 1, 3]


figures = st.tuples(
    st.sampled_from([0.0, 1e-13, 1e-6, 1.01e-6, 0.01, 0.0101, 0.02]),
    st.sampled_from([0.05, 30.0, 39.7, 40.0]),
    st.sampled_from([1.0, 2.0, 11.0]),
    st.sampled_from([4.0, 90.0]),
)


@settings(max_examples=25)
@given(st.lists(figures, min_size=2, max_size=8), st.permutations(range(8)), st.booleans())
def test_the_order_is_total(
    rows: list[tuple[float, float, float, float]], shuffled: list[int], exact: bool
) -> None:
    problem = EXACT if exact else LEAST_SQUARES
    some = [design(k, e * (not exact), mu, size, turn=turn) for k, (e, mu, size, turn) in enumerate(rows)]
    best_first = ranked(problem, some)
    assert ranked(problem, [some[k] for k in shuffled if k < len(some)]) == best_first
    keys = [ranking_key(problem, each) for each in best_first]
    assert keys == sorted(keys)
    assert len(set(keys)) == len(keys) == len(some)


def test_rounding_decides_nothing() -> None:
    """Results of two processors: angles apart by 1e-9 deg, sizes by 1e-12."""
    one, other = design(1, mu=40 - 7e-10, size=2 * (1 + 1e-12)), design(2, mu=40 - 3e-10, size=2)
    again = design(1, mu=40 - 3e-10, size=2), design(2, mu=40 - 7e-10, size=2 * (1 - 1e-12))
    assert order(EXACT, one, other) == order(EXACT, *again)
    assert order(EXACT, design(1, mu=40), design(2, mu=40 + 2e-6, size=3)) == [2, 1]


def test_the_pareto_mark_takes_errors_up_to_the_tolerance_as_equal() -> None:
    some = design(1, 1e-13, 11.8, 2), design(2, 9e-7, 40.2, 2), design(3, 1.1e-6, 40.2, 2)
    assert pareto_optimal(LEAST_SQUARES, some).tolist() == [False, True, False]
    assert pareto_optimal(LOOSE, (*some, design(4, 0.009, 41, 2))).tolist() == [False, False, False, True]
    assert pareto_optimal(LEAST_SQUARES, (some[0], design(4, 0.009, 11, 2))).tolist() == [True, False]


def test_the_score_of_a_search_is_the_error_that_counts() -> None:
    scores = [each.score(LEAST_SQUARES) for each in (design(1, 1e-13), design(2, 0.01))]
    assert scores == [0.0, pytest.approx(-0.01)]
    assert design(1, 0.0, 45).score(EXACT) == pytest.approx(0.5)


def test_ranking_keeps_the_strength_of_a_design() -> None:
    some = design(1, 0.01, best_at="least error"), design(2, 0.011, best_at="smallest within 1.5 times")
    told = [each.best_at for each in ranked(LEAST_SQUARES, some)]
    assert told == ["least error", "smallest within 1.5 times"]


def test_the_user_s_own_objective_ranks() -> None:
    some = design(1, mu=50), design(2, mu=40), design(3, mu=30)
    valued = [each.valued(lambda design: (design.o4[0] - design.o2[0] - 6) ** 2) for each in some]
    best_first = ranked(EXACT, valued)
    assert [each.start for each in best_first] == [2, 1, 3]
    assert [each.own_objective for each in best_first] == [0, 1, 1]
    assert [each.start for each in ranked(EXACT, best_first[::-1])] == [2, 1, 3]  # they keep it
    frame = to_frame(EXACT, best_first)
    assert frame["objective"].tolist() == [0, 1, 1]
    assert frame["pareto"].tolist() == [True, True, False]
    assert "objective" not in to_frame(EXACT, some)


def test_an_objective_without_a_value_is_the_worst() -> None:
    valued = [each.valued(lambda design: np.log(design.o4[0] - 5.5)) for each in (design(1), design(2))]
    assert [each.start for each in ranked(EXACT, valued)] == [2, 1]
    with pytest.raises(ProblemError, match="objective <lambda> gives 'short' on numbers"):
        valued[0].valued(lambda design: "short")


def test_other_goals_can_be_weighed() -> None:
    problem = replace(EXACT, objective=Objective(1, omega4_max=0.5))
    one = design(1)
    share = 0.5 * one.values["omega4_max"]
    assert one.objective(problem) == pytest.approx(40 / 90 - share)
    assert [goal.key for goal in pareto_goals(problem)] == ["transmission_min_task", "size", "omega4_max"]
    assert goals(problem) == "mu, size and omega4"


FOLDING = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=3.99, r4=1.1)


def placed(number: int = 0, linkage: FourBar = CRANK, **figures: Any) -> Candidate:
    """A design with these figures, elsewhere in the plane."""
    moved = replace(linkage, o2=linkage.o2 + number, o4=linkage.o4 + number)
    return replace(design(number, **figures), linkage=moved)


def asking(**requirements: Any) -> Problem:
    return replace(EXACT, requirements=replace(EXACT.requirements, **requirements))


@pytest.mark.parametrize(
    ("odd", "said", "allowed"),
    [
        ({"size": 3.1}, "3.1 times the size of the task", {"size": (0.0, 20.0)}),
        ({"turn": 14.0}, "the driver turns by 14.0 deg alone", {"driver_rotation_deg": (1.0, 90.0)}),
        (
            {"cycle": 14.0},
            "transmission angle 14.0 deg somewhere in the turn",
            {"transmission_min_deg": 5.0, "transmission_over": TransmissionOver.CYCLE},
        ),
        ({"linkage": FOLDING}, "it nearly folds: 0.0089 left of its lengths", {"rotatability_margin": 0.002}),
    ],
)
def test_cautions_of_a_design(odd: dict[str, Any], said: str, allowed: dict[str, Any]) -> None:
    assert caution(EXACT, placed(**odd)) == said
    assert caution(asking(**allowed), placed(**odd)) == ""  # the user's own limit wins
    assert caution(replace(EXACT, objective=Objective(compactness=0.1)), placed(**odd)) == ""


def test_a_design_that_keeps_all_has_no_caution() -> None:
    assert caution(EXACT, placed(size=3.0, turn=15.001, cycle=15.001)) == ""
    turning = asking(rotatability=Rotatability.ANY)
    assert caution(turning, placed(cycle=1.0)) == caution(turning, placed(linkage=FOLDING)) == ""


def test_doubted_designs_come_last_and_the_best_by_the_objective_says_so() -> None:
    found = listed(
        EXACT, [placed(1, mu=60, turn=5), placed(10, mu=50), placed(20, mu=55, size=4), placed(30, mu=45)]
    )
    assert [each.start for each in found] == [10, 30, 1, 20]
    assert [bool(each.caution) for each in found] == [False, False, True, True]
    assert [each.best_at for each in found] == ["", "", "objective", ""]
    assert [each.best_at for each in listed(EXACT, [placed(1, mu=60), placed(10, mu=50, size=9)])] == [
        "",
        "",
    ]


@pytest.mark.slow
def test_inverted_slider_cranks_at_90_deg_are_ranked_by_their_leverage() -> None:
    """Their transmission angle says nothing: one whose output went 454 times as fast came third."""
    task = MotionTask.from_degrees([[0, 0, 0], [3, 1, 40], [5, 4, 90]])
    for kinds in ("inverted-slider-crank", ("inverted-slider-crank", "slider-crank")):
        found = synthesize(Problem(task=task, mechanism=kinds), starts=30, enough=20)
        upright = [
            each
            for each in found.candidates
            if each.linkage.mechanism.word == "inverted-slider-crank"
            and each.family == each.id
            and not each.caution
            and np.degrees(each.verdict.transmission_min_task) > 90 - 1e-7
        ]
        assert len(upright) > 3
        gain = [each.values["mechanical_advantage"] for each in upright]
        assert gain == sorted(gain, reverse=True)
        assert gain[0] > 1
