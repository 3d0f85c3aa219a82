"""An attempt: solved, made exact, judged; what cannot be judged is data, not an error."""

import pickle
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from grashof.problems import Box, FourBar
from grashof.problems.checks import FloatArray
from grashof.synth import attempt as module
from grashof.synth.attempt import attempt
from grashof.synth.exact_poses import rounds
from grashof.synth.programme import Solve
from grashof.synth.setup import Setup
from grashof.synth.start import Start

SetupOf = Callable[..., Setup]


def first_starts(setup: Setup, count: int) -> list[Start]:
    return next(rounds(setup, 50, np.random.default_rng(0))).starts[:count]


def off_circles(linkage: FourBar, setup: Setup) -> float:
    """Largest change of a dyad's length over the poses, from the coupler placed in each of them."""
    task = setup.problem.task
    turn = np.exp(1j * (task.angles - float(linkage.body_angle)))
    a = task.positions @ np.array([1, 1j]) - complex(*linkage.coupler_point) * turn
    b = a + float(linkage.r3) * turn

    def spread(distance: FloatArray, length: float) -> float:
        return float(np.abs(distance - length).max())

    return max(
        spread(np.abs(a - complex(*linkage.o2)), float(linkage.r2)),
        spread(np.abs(b - complex(*linkage.o4)), float(linkage.r4)),
    )


def test_a_candidate_is_exact_beyond_the_solver(luggage_setup: SetupOf) -> None:
    setup = luggage_setup()
    for number, start in enumerate(first_starts(setup, 10)):
        candidate = attempt(setup, start, number).candidate
        assert candidate is not None
        assert candidate.verdict.ok
        assert candidate.start == number
        assert candidate.iterations > 0
        assert off_circles(candidate.linkage, setup) < 1e-13 * setup.frame.scale
        assert candidate.verdict.error_max < 1e-12 * setup.frame.scale


def test_a_design_with_defects_is_kept_with_them(luggage_setup: SetupOf) -> None:
    start = first_starts(luggage_setup(), 1)[0]
    setup = luggage_setup(o2=Box((50, 60), (50, 60)))
    candidate = attempt(setup, start, 0).candidate
    assert candidate is not None
    assert not candidate.verdict.ok


@pytest.mark.parametrize("relaxed", [("order",), ("link_length", "same_branch")])
def test_what_no_smooth_constraint_can_relax_is_not_solved(
    luggage_setup: SetupOf, relaxed: tuple[str, ...]
) -> None:
    setup = luggage_setup()
    start = replace(first_starts(setup, 1)[0], relaxed=relaxed)
    result = attempt(setup, start, 3)
    assert result.status == "Not_Solved"
    assert result.candidate is not None
    assert result.candidate.iterations == 0
    np.testing.assert_allclose(
        result.candidate.linkage.o2, setup.frame.outward(np.array(start.o2)), rtol=1e-9
    )


def test_coinciding_pivots_are_no_linkage(luggage_setup: SetupOf) -> None:
    setup = luggage_setup()
    start = first_starts(setup, 1)[0]
    # Both dyads the same: exact, so that polishing does not part them.
    same = replace(start, o4=start.o2, b=start.a, relaxed=("order",))
    assert attempt(setup, same, 0).candidate is None


def test_numbers_that_are_not_finite_are_no_linkage(
    luggage_setup: SetupOf, monkeypatch: pytest.MonkeyPatch
) -> None:
    setup = luggage_setup()
    start = first_starts(setup, 1)[0]
    broken = Solve(
        (complex("nan"), start.o4, start.a, start.b, start.p),
        start.theta2,
        start.theta3,
        start.body_angle,
        "Invalid_Number_Detected",
        7,
    )
    monkeypatch.setattr(module, "solve", lambda *_: broken)
    result = attempt(setup, start, 0)
    assert (result.status, result.candidate) == ("Invalid_Number_Detected", None)


def test_the_solver_is_not_believed(luggage_setup: SetupOf, monkeypatch: pytest.MonkeyPatch) -> None:
    """A solve that says it succeeded, but ended somewhere else, is judged by where it ended."""
    setup = luggage_setup()
    start = first_starts(setup, 1)[0]
    moved = (start.o2 + 2, start.o4 - 3j, start.a, start.b, start.p)
    ended = Solve(moved, start.theta2, start.theta3, start.body_angle, "Solve_Succeeded", 7)
    monkeypatch.setattr(module, "solve", lambda *_: ended)
    candidate = attempt(setup, start, 0).candidate
    assert candidate is None or not candidate.verdict.ok


def test_an_attempt_and_its_inputs_pickle(luggage_setup: SetupOf) -> None:
    setup = luggage_setup()
    start = first_starts(setup, 1)[0]
    there = attempt(*pickle.loads(pickle.dumps((setup, start, 5))))
    back = pickle.loads(pickle.dumps(there))
    here = attempt(setup, start, 5)
    assert here.candidate is not None
    assert back.candidate.linkage == there.candidate.linkage == here.candidate.linkage
    assert back.status == here.status
