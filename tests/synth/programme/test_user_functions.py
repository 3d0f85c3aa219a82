"""The user's own constraints: held by every design, refused where unusable, named where they prevent it."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
import pytest

from grashof import load, synthesize
from grashof.analysis import Design
from grashof.analysis.judge.design import greatest as greatest_of
from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.problems import MotionTask, PathTask, Problem, ProblemError, Requirements
from grashof.synth import Result
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import GROUPS
from grashof.synth.starts.coupler_search import search

pytestmark = pytest.mark.usefixtures("small_search")

LIMITS: dict[str, Any] = {"link_length": (0.2, 10), "transmission_min_deg": 20}
THREE = Problem(
    task=MotionTask.from_degrees([[0, 0, 0], [2, 1, 20], [3, 3, 50]]), requirements=Requirements(**LIMITS)
)
HELD = 1e-9


def level(design: Design) -> Any:
    return (design.o2[1] - design.o4[1]) ** 2 - 0.1**2


def short_driver(design: Design) -> Any:
    return design.r2 - design.r3 / 3


def a_stays_low(design: Design) -> Any:
    return [place[1] - 1.0 for place in design.a]


def pivots_in_a_disc(design: Design) -> Any:
    return ca.vertcat(
        (design.o2[0] - 1) ** 2 + design.o2[1] ** 2 - 16, (design.o4[0] - 1) ** 2 + design.o4[1] ** 2 - 16
    )


def impossible(design: Design) -> Any:
    return design.r2 + design.r4 + 1.0


def places(candidate: Any, task: MotionTask) -> tuple[Any, Any]:
    """A and B at the poses, from the body's place and the coupler's numbers."""
    linkage = candidate.linkage
    coupler = np.exp(1j * (task.angles - float(linkage.body_angle)))
    a = task.positions @ np.array([1, 1j]) - complex(*linkage.coupler_point) * coupler
    return a, a + float(linkage.r3) * coupler


def worst(name: str, result: Result) -> float:
    """The greatest value of a constraint over all designs, from the linkages alone."""
    values = []
    for candidate in result.candidates:
        linkage = candidate.linkage
        if name == "level":
            values.append(abs(float(linkage.o2[1] - linkage.o4[1])) - 0.1)
        elif name == "short_driver":
            values.append(float(linkage.r2 - linkage.r3 / 3))
        elif name == "a_stays_low":
            task = result.problem.task
            assert isinstance(task, MotionTask)
            a, _ = places(candidate, task)
            values.append(float(a.imag.max()) - 1.0)
        else:
            off = [np.hypot(pivot[0] - 1, pivot[1]) - 4 for pivot in (linkage.o2, linkage.o4)]
            values.append(float(max(off)))
    return max(values)


KINDS: dict[str, Callable[[Design], Any]] = {
    "level": level,
    "short_driver": short_driver,
    "a_stays_low": a_stays_low,
    "pivots_in_a_disc": pivots_in_a_disc,
}


@pytest.fixture(scope="module")
def without() -> Result:
    return synthesize(THREE, enough=10)


@pytest.mark.quick("pivots_in_a_disc")
@pytest.mark.parametrize("kind", KINDS)
def test_every_design_holds_the_constraint(kind: str, without: Result) -> None:
    assert worst(kind, without) > 0.01  # or it would say nothing
    result = synthesize(THREE, constraints=[KINDS[kind]], enough=6)
    assert len(result) >= 6
    assert worst(kind, result) <= HELD
    assert all(candidate.verdict.ok for candidate in result.candidates)
    assert {candidate.id for candidate in result.candidates} != {found.id for found in without.candidates}


@pytest.mark.slow
def test_two_at_once_hold_both() -> None:
    result = synthesize(THREE, constraints=[level, short_driver], enough=6)
    assert len(result) >= 6
    assert worst("level", result) <= HELD
    assert worst("short_driver", result) <= HELD


def mixed(design: Design) -> Any:
    """Something of every part of a design."""
    far = [(b[0] - a[0]) * p[1] - theta2 for a, b, p, theta2 in zip(*every(design), strict=True)]
    u, v = design.coupler_point[0], design.coupler_point[1]
    return [u - v + design.r1 * design.r4, design.theta1 + design.o4[0] - design.r3, *far]


def every(design: Design) -> tuple[Any, Any, Any, list[Any]]:
    return design.a, design.b, design.p, [design.theta2[i] for i in range(len(design.a))]


def test_screening_finds_the_violations_of_the_judge() -> None:
    task, _ = planted_path(np.random.default_rng([82, 3]), 5)
    scaled = ScaledProblem.of(Problem(task=task), [mixed])
    finds = search(scaled, 20, np.random.default_rng(0))[:50]
    violations = finds.violations[:, GROUPS.index("constraints")]
    for index in range(len(finds)):
        linkage = scaled.linkages(finds.points[index], finds.assembly[index])
        assembly = np.full(len(task), int(finds.assembly[index]))
        design = Design.of(linkage, finds.theta2[index], assembly)
        amounts = np.array([float(amount) for amount in mixed(design)])
        expected = np.maximum(amounts, 0).sum()
        np.testing.assert_allclose(violations[index], expected, rtol=1e-7, atol=1e-7)
    assert (violations > 0).any()


@pytest.mark.slow
def test_the_search_looks_for_designs_that_hold_it() -> None:
    """Two metres between the pivots, sideways: a few of the feasible pairs, most of which are wider."""
    result = synthesize(load("luggage"), constraints=[lambda d: (d.o2[0] - d.o4[0]) ** 2 - 4.0])
    assert len(result) >= 50
    assert all(abs(c.linkage.o2[0] - c.linkage.o4[0]) <= 2 + HELD for c in result.candidates)


@pytest.mark.slow
def test_an_impossible_constraint_is_named(relaxing_only: Callable[..., None]) -> None:
    relaxing_only("constraints")
    result = synthesize(THREE, constraints=[impossible], enough=2, starts=2)
    assert len(result) == 0
    assert "this alone would do: constraint impossible up to " in result.note
    assert result.note.endswith(" instead of 0")
    defects = result.nearest[0].verdict.defects
    assert [(defect.requirement, defect.what) for defect in defects] == [("constraints", "impossible")]
    linkage = result.nearest[0].linkage
    assert defects[0].found == pytest.approx(float(linkage.r2 + linkage.r4) + 1.0, rel=1e-12)


@pytest.mark.study
def test_least_squares_keeps_it_at_a_price(least_error: Callable[..., Result]) -> None:
    rng = np.random.default_rng([81, 0])
    task, _ = planted_motion(rng, 7)
    noise = rng.normal(0, 0.01, (7, 3))
    near = MotionTask(task.positions + task.size * noise[:, :2], task.angles + noise[:, 2])
    problem = Problem(task=near, requirements=Requirements(exact=False))
    free = least_error(problem)
    most = 0.97 * float(free.best.linkage.r2)
    held = least_error(problem, constraints=[lambda design: design.r2 - most])
    assert float(held.best.linkage.r2) <= most + HELD
    others = [c.verdict.square for c in free.candidates if float(c.linkage.r2) <= most]
    assert held.best.verdict.square >= free.best.verdict.square * (1 - 1e-6)
    assert held.best.verdict.square <= min(others, default=np.inf) * (1 + 1e-6)


def test_paths_hold_it_and_so_do_their_cognates() -> None:
    task, _ = planted_path(np.random.default_rng([82, 1]), 5)
    assert isinstance(task, PathTask)
    height = float(task.points[:, 1].mean())

    def below(design: Design) -> Any:
        return [design.o2[1] - height, design.o4[1] - height]

    result = synthesize(Problem(task=task), constraints=[below], enough=4)
    assert len(result) >= 2
    for candidate in result.candidates:
        assert max(candidate.linkage.o2[1], candidate.linkage.o4[1]) <= height + HELD


def short_root(design: Design) -> Any:
    """No number where r1 is below 2; a complex one of Python's if r1 were a float of Python's."""
    return (design.r1 - 2) ** 0.5 - 3


def test_where_a_constraint_has_no_value_it_is_missed() -> None:
    result = synthesize(THREE, starts=16, enough=3, constraints=[short_root])
    assert result.candidates
    assert all(2 <= candidate.linkage.r1 <= 11 + 1e-6 for candidate in result.candidates)
    short = replace(result.best.linkage, o4=result.best.linkage.o2 + np.array([1.0, 0.0]))
    design = Design.of(short, result.best.verdict.theta2, result.best.verdict.assembly)
    assert np.isnan(greatest_of(short_root, design))


def near_ground(design: Design) -> Any:
    return np.hypot(design.o2[0] - design.o4[0], design.o2[1] - design.o4[1]) - 2.0


def slight(design: Design) -> Any:
    return [np.sin(design.theta2[0]) - 0.9, np.sqrt(design.r2) - 1.5, np.exp(-design.r4) - 0.5]


@pytest.mark.slow
def test_numpy_functions_do_not_warn() -> None:
    """Warnings are errors here."""
    result = synthesize(THREE, constraints=[near_ground, slight], enough=4)
    assert len(result) >= 4
    for candidate in result.candidates:
        linkage = candidate.linkage
        assert linkage.r1 <= 2 + HELD
        assert np.sin(candidate.verdict.theta2[0]) <= 0.9 + HELD
        assert linkage.r2 <= 1.5**2 + HELD
    assert max(float(candidate.linkage.r1) for candidate in synthesize(THREE, enough=4).candidates) > 2


@pytest.mark.parametrize("mode", [0, -1])
def test_the_mode_of_numpy_is_left_as_it_was(mode: int) -> None:
    ca.GlobalOptions.setNumpyMode(mode)
    try:
        synthesize(THREE, constraints=[near_ground], enough=1, starts=2)
        assert ca.GlobalOptions.getNumpyMode() == mode
    finally:
        ca.GlobalOptions.setNumpyMode(0)


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
        (lambda: 0.0, "fails on symbols: .*positional argument"),
        (lambda design: float(design.r2) - 3, "fails on symbols: .* that works on CasADi symbols$"),
        (lambda _: 1 / 0, "fails on symbols: division by zero; it must be made of arithmetic"),
        (lambda design: ca.SX.ones(2, 2) * design.r1, "gives SX.* on numbers; it must give"),
    ],
)
def test_unusable_amounts_are_refused_in_one_line(constraint: Any, said: str) -> None:
    with pytest.raises(ProblemError, match=f"constraint <lambda> {said}") as caught:
        synthesize(THREE, constraints=[constraint])
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"constraints": [5]}, r"^constraints has 5; they must be functions of a design$"),
        (
            {"constraints": [lambda design: design.r2 - 1], "workers": 2},
            "<lambda> cannot be sent to other processes.*with workers it must be a function of a module",
        ),
        *(
            ({"constraints": given}, r"constraints is .*; it must be a list of functions of a design")
            for given in (lambda design: design.r2 - 1, None, 5, "r2")
        ),
        ({"time_limit": "a"}, "time_limit is 'a'; it must be a finite number"),
        ({"time_limit": True}, "time_limit is True; it must be a finite number"),
        ({"problem": "luggage"}, "problem is a str; it must be a Problem, such as load gives"),
    ],
)
def test_what_is_of_the_wrong_kind_is_named(options: dict[str, Any], said: str) -> None:
    with pytest.raises(ProblemError, match=said):
        synthesize(**{"problem": THREE, "starts": 4} | options)
