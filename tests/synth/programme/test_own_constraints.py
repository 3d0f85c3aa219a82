"""The user's own constraints: unusable ones are refused before anything is solved."""

from typing import Any

import numpy as np
import pytest

from grashof import synthesize
from grashof.problems import MotionTask, Problem, ProblemError

THREE = Problem(task=MotionTask.from_degrees([[0, 0, 0], [2, 1, 20], [3, 3, 50]]))


@pytest.mark.parametrize(
    ("constraint", "said"),
    [
        (lambda design: design.r2 < 1, "gives a truth value.*a - b instead of a < b"),
        (lambda design: [design.r3 - 2, design.r2 == 1], "gives a truth value"),
        (lambda _: True, "gives a truth value"),
        (lambda _: np.bool_(False), "gives a truth value"),
        (lambda _: None, "gives None; it must give a scalar"),
        (lambda _: "r2", "gives 'r2'; it must give a scalar"),
        (lambda _: [], "gives nothing; it must give a scalar"),
        (lambda design: np.max([design.r2, design.r3]), "fails on symbols: .*CasADi"),
        (
            lambda design: max(design.r2, design.r3),
            "fails on symbols: Cannot compute the truth value of .*casadi.fmax",
        ),
        (lambda design: design.o2[5], "fails on symbols: Slice .* out of bounds"),
        (lambda design: sum(design.theta2), "fails on symbols: .*CasADi"),
        (lambda design: design.r9, "fails on symbols: .*r9"),
    ],
)
def test_unusable_amounts_are_refused_in_one_line(constraint: Any, said: str) -> None:
    with pytest.raises(ProblemError, match=f"constraint <lambda> {said}") as caught:
        synthesize(THREE, constraints=[constraint])
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("constraints", [lambda design: design.r2 - 1, None, 5, "r2"])
def test_constraints_are_a_list(constraints: Any) -> None:
    with pytest.raises(ProblemError, match=r"constraints is .*; it must be a list of functions of a design"):
        synthesize(THREE, constraints=constraints)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"time_limit": "a"}, "time_limit is 'a'; it must be a finite number"),
        ({"time_limit": True}, "time_limit is True; it must be a finite number"),
    ],
)
def test_no_time(options: dict[str, Any], said: str) -> None:
    with pytest.raises(ProblemError, match=said):
        synthesize(THREE, **options)


def test_a_name_is_not_accepted_as_a_problem() -> None:
    with pytest.raises(ProblemError, match="problem is a str; it must be a Problem, such as load gives"):
        synthesize("luggage")  # type: ignore[arg-type]
