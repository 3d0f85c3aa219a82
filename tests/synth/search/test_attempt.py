"""An attempt: solved, made exact, judged; what cannot be judged is data, not an error."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from grashof.problems import Box, FourBar
from grashof.problems.values.arrays import FloatArray
from grashof.synth.programme import nonlinear_programme
from grashof.synth.programme.nonlinear_programme import Solve
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import attempt
from grashof.synth.search.finder import finder_for

SetupOf = Callable[..., ScaledProblem]


@pytest.fixture(scope="module")
def scaled(luggage_scaled: SetupOf) -> ScaledProblem:
    return luggage_scaled()


@pytest.fixture(scope="module")
def starts(scaled: ScaledProblem) -> list[Start]:
    return list(finder_for(scaled).round(0, 50, np.random.default_rng(0), 1).starts)


def off_circles(linkage: FourBar, scaled: ScaledProblem) -> float:
    """Largest change of a dyad's length over the poses, from the coupler placed in each of them."""
    task = scaled.problem.task
    turn = np.exp(1j * (task.angles - float(linkage.body_angle)))
    a = task.positions @ np.array([1, 1j]) - complex(*linkage.coupler_point) * turn
    b = a + float(linkage.r3) * turn

    def spread(distance: FloatArray, length: float) -> float:
        return float(np.abs(distance - length).max())

    return max(
        spread(np.abs(a - complex(*linkage.o2)), float(linkage.r2)),
        spread(np.abs(b - complex(*linkage.o4)), float(linkage.r4)),
    )


def test_a_candidate_is_exact_beyond_the_solver(scaled: ScaledProblem, starts: list[Start]) -> None:
    for number, start in enumerate(starts[:10]):
        candidate = attempt(scaled, start, number).candidate
        assert candidate is not None
        assert candidate.verdict.ok
        assert candidate.start == number
        assert candidate.iterations > 0
        assert off_circles(candidate.linkage, scaled) < 1e-13 * scaled.frame.scale
        assert candidate.verdict.error_max < 1e-12 * scaled.frame.scale


def test_a_design_with_defects_is_kept_with_them(luggage_scaled: SetupOf, starts: list[Start]) -> None:
    scaled = luggage_scaled(o2=Box((50, 60), (50, 60)))
    candidate = attempt(scaled, starts[0], 0).candidate
    assert candidate is not None
    assert not candidate.verdict.ok


@pytest.mark.parametrize("relaxed", [("order",), ("link_length", "same_branch")])
def test_discrete_requirements_are_not_solved_for(
    scaled: ScaledProblem, starts: list[Start], relaxed: tuple[str, ...]
) -> None:
    start = starts[0].under(relaxed=relaxed)
    result = attempt(scaled, start, 3)
    assert result.status == "Not_Solved"
    assert result.candidate is not None
    assert result.candidate.iterations == 0
    np.testing.assert_allclose(
        result.candidate.linkage.o2, scaled.frame.outward(np.array(start.o2)), rtol=1e-9
    )


def test_coinciding_pivots_are_no_linkage(scaled: ScaledProblem, starts: list[Start]) -> None:
    start = starts[0]
    # Both dyads the same: exact, so that polishing does not part them.
    same = replace(start, o4=start.o2, b=start.a).under(relaxed=("order",))
    assert attempt(scaled, same, 0).candidate is None


def test_numbers_that_are_not_finite_are_no_linkage(
    scaled: ScaledProblem, starts: list[Start], monkeypatch: pytest.MonkeyPatch
) -> None:
    start = starts[0]
    broken = Solve(
        (complex("nan"), start.o4, start.a, start.b, start.p),
        start.theta2,
        start.theta3,
        start.body_angle,
        "Invalid_Number_Detected",
        7,
    )
    monkeypatch.setattr(nonlinear_programme, "solve", lambda *_: broken)
    result = attempt(scaled, start, 0)
    assert (result.status, result.candidate) == ("Invalid_Number_Detected", None)


def test_the_solver_is_not_believed(
    scaled: ScaledProblem, starts: list[Start], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A solve that says it succeeded, but ended somewhere else, is judged by where it ended."""
    start = starts[0]
    moved = (start.o2 + 2, start.o4 - 3j, start.a, start.b, start.p)
    ended = Solve(moved, start.theta2, start.theta3, start.body_angle, "Solve_Succeeded", 7)
    monkeypatch.setattr(nonlinear_programme, "solve", lambda *_: ended)
    candidate = attempt(scaled, start, 0).candidate
    assert candidate is None or not candidate.verdict.ok
