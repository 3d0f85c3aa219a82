"""Lists of slider-cranks and inverted ones, of several kinds, and of a kind of task that is new."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
import pytest

from grashof import load, synthesize
from grashof.analysis import output_stroke, solve_position, verify
from grashof.analysis.judge.how_met import HOW_MET
from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.problems import (
    Box,
    FourBar,
    FunctionTask,
    InvertedSliderCrank,
    Linkage,
    MotionTask,
    Objective,
    PathTask,
    Problem,
    ProblemError,
    Requirements,
    SliderCrank,
    Task,
)
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.synth.designs.ranking import ranking_key
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import attempt
from grashof.synth.search.finder import finder_for
from grashof.synth.starts.precision_points import EightPoints
from grashof.wording.problem import summary

SLIDERS = ("slider-crank", "inverted-slider-crank")


def coupler_points(linkage: Linkage, theta2: FloatArray) -> FloatArray:
    """P by the loop written out, from the parameters alone."""
    o2, r2, offset = complex(*linkage.o2), float(linkage.r2), float(linkage.offset)  # type: ignore[attr-defined]
    a, arm = o2 + r2 * np.exp(1j * theta2), complex(*linkage.coupler_point)
    if isinstance(linkage, SliderCrank):
        along = np.exp(1j * float(linkage.slide_angle))
        up = offset - ((a - o2) * np.conj(along)).imag
        e3 = (
            along
            * (int(linkage.assembly) * np.sqrt(float(linkage.r3) ** 2 - up**2) + 1j * up)
            / float(linkage.r3)
        )
    else:
        assert isinstance(linkage, InvertedSliderCrank)
        gap = complex(*linkage.o4) - a
        e3 = gap / (int(linkage.assembly) * np.sqrt(np.abs(gap) ** 2 - offset**2) - 1j * offset)
    p = a + arm * e3
    return np.column_stack([p.real, p.imag, np.angle(e3)])


@pytest.mark.quick("slider-crank-False", "inverted-slider-crank-True")
@pytest.mark.parametrize("timed", [False, True])
@pytest.mark.parametrize("mechanism", SLIDERS)
def test_planted_paths_are_met(mechanism: str, timed: bool) -> None:
    for seed in range(3):
        count = 4 if timed else 8
        task, _ = planted_path(np.random.default_rng([1, seed]), count, timed=timed, mechanism=mechanism)
        problem = Problem(task=task, mechanism=mechanism)
        best = synthesize(problem, enough=1).best
        assert mechanism == type(best.linkage).mechanism.word
        p = coupler_points(best.linkage, best.verdict.theta2)[:, :2]
        assert np.hypot(*(p - task.positions).T).max() < problem.requirements.tolerance * task.size
        assert (np.diff(best.verdict.theta2) * best.verdict.direction > 0).all()


@pytest.mark.quick("slider-crank-3")
@pytest.mark.parametrize("poses", [3, 4])
@pytest.mark.parametrize("mechanism", SLIDERS)
def test_planted_poses_are_met(mechanism: str, poses: int) -> None:
    task, _ = planted_motion(np.random.default_rng([2, poses]), poses, mechanism=mechanism)
    found = synthesize(Problem(task=task, mechanism=mechanism), enough=5)
    for each in found.candidates:
        at = coupler_points(each.linkage, each.verdict.theta2)
        assert np.hypot(*(at[:, :2] - task.positions).T).max() < 1e-8 * task.size
        turned = at[:, 2] + float(each.linkage.body_angle) - task.angles
        assert np.abs(np.angle(np.exp(1j * turned))).max() < 1e-8
    assert len(found) >= (5 if poses == 3 else 1)


@pytest.mark.parametrize("mechanism", SLIDERS)
def test_planted_least_squares_and_closed_paths(mechanism: str) -> None:
    rng = np.random.default_rng(3)
    linkage = planted_path(rng, 3, mechanism=mechanism)[1]
    theta2 = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    task = PathTask(solve_position(linkage, theta2).p, closed=True)
    found = synthesize(Problem(task=task, mechanism=mechanism), effort=0.2)
    assert found.least_error < 1e-7 * task.size
    assert all(each.verdict.full_rotation for each in found.candidates)


def test_limits_of_slides_bind() -> None:
    task, _ = planted_path(np.random.default_rng([5, 1]), 4, mechanism="slider-crank")
    size = task.size
    limits: dict[str, Any] = {
        "stroke": (0.5 * size, 0.8 * size),
        "offset": (0.0, 0.1 * size),
        "time_ratio": (1.02, 1.3),
        "transmission_min_deg": 40,
        "transmission_over": "cycle",
        "o2": Box((-3 * size, 3 * size), (-3 * size, 3 * size)),
    }
    problem = Problem(task=task, mechanism="slider-crank", requirements=Requirements(**limits))
    found = synthesize(problem, enough=3)
    assert len(found)
    for each in found.candidates:
        stroke = output_stroke(each.linkage)
        travel = float(np.hypot(*(stroke.b[1] - stroke.b[0])))
        assert 0.5 * size * (1 - 1e-9) <= travel <= 0.8 * size * (1 + 1e-9)
        assert -1e-9 <= each.linkage.offset <= 0.1 * size * (1 + 1e-9)
        assert 1.02 - 1e-9 <= float(stroke.time_ratio) <= 1.3 + 1e-9
        turn = np.linspace(0, 2 * np.pi, 4001)
        state = solve_position(each.linkage, turn)
        mu = np.abs(np.cos(state.theta3 - float(each.linkage.slide_angle)))
        assert np.degrees(np.arcsin(mu.min())) > 40 - 1e-3


@pytest.mark.slow
def test_mixed_lists_have_one_ranking() -> None:
    """Four poses in general place: all kinds in one list, by one judge and one objective."""
    task, _ = planted_motion(np.random.default_rng([2, 4]), 4, mechanism="slider-crank")
    every = ("four-bar", *SLIDERS)
    found = synthesize(Problem(task=task, mechanism=every), enough=10)
    kinds = [each.linkage.mechanism.word for each in found.candidates]
    assert {"four-bar", "slider-crank"} <= set(kinds)
    heads = [family[0] for family in found.families]
    worth = [(bool(each.caution), ranking_key(found.problem, each)) for each in heads]
    assert worth == sorted(worth)
    assert list(found.to_frame()["mechanism"]) == kinds
    alone = synthesize(Problem(task=task, mechanism="slider-crank"), enough=10)
    assert {each.id for each in alone.candidates} <= {each.id for each in found.candidates}


@pytest.mark.study
def test_a_shorter_list_has_an_equal_share_of_each_kind() -> None:
    task = MotionTask.from_degrees([[0, 0, 0], [60, 90, 15], [180, 140, 40]])
    whole = synthesize(Problem(task=task, mechanism=["slider-crank", "four-bar", "inverted-slider-crank"]))
    for most in (3, 7, 12):
        kept = whole.top(most)
        kinds = [type(family[0].linkage) for family in kept.families]
        assert len(kinds) == most
        assert all(kinds.count(kind) >= most // 3 for kind in (SliderCrank, FourBar, InvertedSliderCrank))
        assert kept.candidates == tuple(each for each in whole.candidates if each in kept.candidates)
    assert whole.top(1).families[0] == whole.families[0]
    assert whole.top(10_000) == whole


@pytest.mark.slow
def test_of_inverted_slider_cranks_without_offset_small_ones_are_found() -> None:
    """The transmission angle is 90 deg for all of them; a search for it alone finds larger ones."""
    task, _ = planted_path(np.random.default_rng(1), 5, mechanism="inverted-slider-crank")
    problem = Problem(task=task, mechanism="inverted-slider-crank")
    best = min(synthesize(problem, starts=16, enough=16).candidates, key=lambda each: each.verdict.size)
    blind = replace(problem, objective=Objective(transmission=1.0, compactness=1e-9))
    found = synthesize(blind, starts=16, enough=16).candidates
    assert np.degrees(best.verdict.transmission_min_task) == pytest.approx(90)
    assert best.verdict.size < 0.97 * min(each.verdict.size for each in found)


@pytest.mark.study
def test_a_kind_that_cannot_do_it_is_left_out() -> None:
    """The luggage poses turn back to equal angles: their slider dyads lie at infinity."""
    problem = load("luggage")
    mixed = Problem(
        task=problem.task,
        requirements=problem.requirements,
        mechanism=["slider-crank", "four-bar"],
        name="both",
    )
    found = synthesize(mixed, enough=5, effort=0.2, time_limit=20)
    assert len(found)
    assert all(each.verdict.ok for each in found.candidates)


def test_a_path_of_more_points_than_sliders_can_pass_is_least_squares() -> None:
    points = solve_position(planted_path(np.random.default_rng(0), 3)[1], np.linspace(0, 4, 9)).p
    task = PathTask(points)
    assert Problem(task=task).requirements.is_exact(task)
    for mechanism in (*SLIDERS, ["four-bar", "slider-crank"]):
        assert not Problem(task=task, mechanism=mechanism).requirements.is_exact(task)
    assert Problem(task=MotionTask(points[:4], np.arange(4) * 0.4), mechanism=SLIDERS).by_objective


def level(design: Any) -> Any:
    """The driver's pivot no higher than P at the first target; the offset at most a tenth of r2."""
    return [design.o2[1] - design.p[0][1], design.offset**2 - (0.1 * design.r2) ** 2]


def compact(design: Any) -> Any:
    return design.r2


@pytest.mark.parametrize("mechanism", SLIDERS)
def test_own_constraints_and_objectives(mechanism: str) -> None:
    task, _ = planted_motion(np.random.default_rng([2, 3]), 3, mechanism=mechanism)
    problem = Problem(task=task, mechanism=mechanism)
    found = synthesize(problem, enough=3, constraints=[level], objective=compact)
    assert len(found)
    for each in found.candidates:
        assert float(each.linkage.o2[1]) <= task.positions[0, 1] + 1e-9 * task.size
        assert abs(float(each.linkage.offset)) <= 0.1 * float(each.linkage.r2) * (1 + 1e-6)
    assert each.own_objective == pytest.approx(float(each.linkage.r2))


def has_r4(design: Any) -> Any:
    return design.r4 - 1


def test_missing_parts_of_a_kind_are_refused_in_own_functions() -> None:
    task, _ = planted_motion(np.random.default_rng([2, 3]), 3, mechanism="slider-crank")
    with pytest.raises(ProblemError, match="constraint has_r4 fails on symbols"):
        synthesize(Problem(task=task, mechanism="slider-crank"), constraints=[has_r4])


@pytest.mark.slow
def test_all_slider_cranks_through_eight_points() -> None:
    """The planted one is among the feasible ones; every start is a design already."""
    task, planted = planted_path(np.random.default_rng([1, 1]), 8, mechanism="slider-crank")
    scaled = ScaledProblem.of(Problem(task=task, mechanism="slider-crank"))
    finder = finder_for(scaled)
    assert isinstance(finder, EightPoints)
    last = finder.round(finder.rounds_a_pass - 1, 10, np.random.default_rng(0), 1)
    assert last is not None
    assert last.counts["linkages through the points"] >= 2
    assert finder.round(finder.rounds_a_pass, 10, np.random.default_rng(0), 1) is None
    found = [attempt(scaled, start, 0).candidate for start in last.starts]
    assert all(each is not None and each.verdict.ok for each in found)
    gaps = [np.abs(each.linkage.lengths - planted.lengths).max() for each in found if each is not None]
    assert min(gaps) < 1e-6 * task.size


@dataclass(frozen=True, slots=True, eq=False)
class Dwell(Task):
    """Link 4 turns by an angle while the driver turns by `rise`, and rests over `rest` more; all in rad."""

    kind: ClassVar[str] = "dwell"
    target: ClassVar[str] = "place"
    usual_rotatability: ClassVar[str] = "any"
    in_degrees: ClassVar[tuple[str, ...]] = ("turn", "rise", "rest")

    turn: float
    rise: float
    rest: float

    @property
    def timing(self) -> FloatArray:  # type: ignore[override]
        return np.linspace(0, self.rise + self.rest, 9)

    @property
    def closed(self) -> bool:  # type: ignore[override]
        return False

    @property
    def within(self) -> None:  # type: ignore[override]
        return None

    @property
    def positions(self) -> FloatArray:
        return np.full((9, 2), np.nan)

    @property
    def outputs(self) -> FloatArray:
        share = np.minimum(self.timing / self.rise, 1.0)
        return np.asarray(self.turn * (share - np.sin(2 * np.pi * share) / (2 * np.pi)))

    @property
    def angle_length(self) -> float:
        return 1.0

    def exact_for(self, freedoms: int) -> bool:
        return False

    def some(self, index: IntArray, positions: FloatArray, angles: FloatArray) -> "Dwell":
        return self


def test_a_dwell_is_searched_judged_and_described(monkeypatch: pytest.MonkeyPatch) -> None:
    assert isinstance(HOW_MET, dict)
    monkeypatch.setitem(HOW_MET, Dwell, HOW_MET[FunctionTask])
    task = Dwell(*np.radians([40, 120, 40]).tolist())
    problem = Problem(task=task, requirements=Requirements(transmission_min_deg=20))
    found = synthesize(problem, seed=0, effort=0.2, enough=3, workers=1)
    pairs = FunctionTask(task.timing, task.outputs)
    assert len(found) > 2
    for one in found.candidates:
        assert verify(one.linkage, pairs, problem.requirements).ok
        assert one.error(problem) == pytest.approx(one.error(replace(problem, task=pairs)), rel=1e-12)
    assert "turn_deg = 40.0\n" in problem_toml(problem)
    assert "dwell through 9 places" in summary(problem)[0] + summary(problem)[1]
