"""Designs driven by a cylinder: every one has its best, and the judge needs the pivots alone."""

from dataclasses import replace

import numpy as np
import pytest

from grashof.analysis import Verdict, driver_ranges, solve_position, verify
from grashof.analysis.cylinder.lengths import cylinder_state
from grashof.analysis.judge.cylinder_drive import cylinder_forces
from grashof.problems import (
    Box,
    Cylinder,
    CylinderSpec,
    DynamicsSpec,
    FourBar,
    InvertedSliderCrank,
    Linkage,
    MotionTask,
    Problem,
    ProblemError,
    Requirements,
    SliderCrank,
    load,
)
from grashof.problems.files.problem_file import problem_of
from grashof.problems.files.problem_writing import problem_toml
from grashof.synth import Candidate, Result, synthesize
from grashof.synth.designs.driving import cylinder_for
from grashof.synth.search.plain import plain, restored

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def problem() -> Problem:
    return load("lifting-arm")


@pytest.fixture(scope="module")
def result(problem: Problem) -> Result:
    return synthesize(problem, enough=5, starts=16)


@pytest.mark.study
def test_every_design_has_a_cylinder_within_its_limits(problem: Problem, result: Result) -> None:
    assert len(result) >= 5
    frame = result.to_frame()
    assert frame["cylinder_on"].isin(["driver", "coupler", "output"]).all()
    assert frame["cylinder_base_x"].between(-300, 500).all()
    assert frame["cylinder_base_y"].between(0, 300).all()
    assert frame["cylinder_closed"].between(300, 700).all()
    assert (frame["cylinder_stroke"] <= 0.6 * frame["cylinder_closed"]).all()
    assert frame["cylinder_angle_min_deg"].between(25, 90).all()
    assert (frame["cylinder_force_max"] > 1000).all()
    assert problem.driver is not None


def check_by_pivots(each: Candidate, problem: Problem) -> None:
    """The judge needs the linkage and the pivots alone; its figures are those of dense samples."""
    stated = Cylinder(**each.verdict.cylinder.stated)  # type: ignore[union-attr]
    again = verify(each.linkage, problem.task, problem.requirements, problem=problem, cylinder=stated)
    assert again.ok
    at = solve_position(each.linkage, np.linspace(*again.theta2[[0, -1]], 2001), again.assembly[0])
    dense = cylinder_state(stated, each.linkage, at)
    least = float(dense.angle.min())
    assert each.values["cylinder_closed"] == pytest.approx(dense.length.min(), rel=1e-9)
    assert each.values["cylinder_stroke"] == pytest.approx(np.ptp(dense.length), rel=1e-9)
    assert each.values["cylinder_angle_min"] == pytest.approx(least, abs=1e-6 * min(least, 1.0))
    forces = cylinder_forces(each.linkage, problem, again)
    assert np.abs(forces).max() <= each.values["cylinder_force_max"] * (1 + 1e-12)


def test_the_judge_needs_the_linkage_and_the_pivots_alone(problem: Problem, result: Result) -> None:
    for each in result.candidates[:3]:
        check_by_pivots(each, problem)


def test_a_cylinder_that_is_missing_or_beyond_its_limits_is_a_defect(
    problem: Problem, result: Result
) -> None:
    linkage, asked = result.best.linkage, (problem.task, problem.requirements)

    def missed(cylinder: Cylinder | None, of: Problem = problem) -> set[str]:
        return {each.requirement for each in verify(linkage, *asked, problem=of, cylinder=cylinder).defects}

    good = result.best.verdict.cylinder
    assert good is not None
    assert missed(None) == {"driver.cylinder"}
    assert missed(good) == set()
    assert "driver.cylinder.base" in missed(replace(good, base=(-301.0, good.base[1])))
    assert missed(replace(good, point=(0.0, 0.0))) >= {"driver.cylinder"}
    strict = replace(problem, driver=replace(problem.driver, closed=(1, 2), ratio_max=1.01))
    assert missed(good, strict) == {"driver.cylinder.closed", "driver.cylinder.ratio_max"}
    other = [name for name in ("driver", "coupler", "output") if name != good.on]
    assert missed(good, replace(problem, driver=replace(problem.driver, on=other))) == {"driver.cylinder.on"}


@pytest.mark.study
def test_limits_of_angle_and_force_are_kept(problem: Problem, result: Result) -> None:
    least, most = 40.0, 2750.0
    wanted = replace(problem.requirements, cylinder_angle_min_deg=least, cylinder_force_max=(0.0, most))
    found = synthesize(replace(problem, requirements=wanted), enough=3, starts=32)
    frame = found.to_frame()
    assert len(frame)
    assert (frame["cylinder_angle_min_deg"] >= least).all()
    assert (frame["cylinder_force_max"] <= most).all()


@pytest.mark.study
def test_limits_of_the_rate_are_kept(problem: Problem, result: Result) -> None:
    """By a force on the cylinder that turns link 4 with this arm at least, and at most."""
    free = result.to_frame()
    low, high = float(free["cylinder_rate_min"].median()), 2 * float(free["cylinder_rate_max"].median())
    found = synthesize(
        replace(problem, requirements=replace(problem.requirements, cylinder_rate=(low, high))),
        enough=3,
        starts=16,
    )
    frame = found.to_frame()
    assert len(frame)
    assert (frame["cylinder_rate_min"] >= low * (1 - 1e-9)).all()
    assert (frame["cylinder_rate_max"] <= high * (1 + 1e-9)).all()
    ends = frame[["cylinder_rate_start", "cylinder_rate_end"]]
    assert (ends.min(axis=1) >= frame["cylinder_rate_min"] * (1 - 1e-9)).all()
    assert (ends.max(axis=1) <= frame["cylinder_rate_max"] * (1 + 1e-9)).all()


def test_designs_are_found_again_from_plain_text(problem: Problem, result: Result) -> None:
    assert problem_of(problem_toml(problem), "text", problem.name).driver == problem.driver
    again = restored(plain(result.best), problem)
    assert again.verdict.cylinder == result.best.verdict.cylinder
    assert dict(again.values) == pytest.approx(dict(result.best.values), nan_ok=True)


def driven_problem(linkage: Linkage, theta2: np.ndarray, assembly: np.ndarray, spec: CylinderSpec) -> Problem:
    at = solve_position(linkage, theta2, assembly)
    task = MotionTask(at.p, at.theta3)
    return Problem(task=task, requirements=Requirements(rotatability="any"), driver=spec)


ENGINE = SliderCrank((0, 0), 1, 3, 0.4, 0.3, (1.5, 0.7))
SHAPER = InvertedSliderCrank((0, 0), (3, 0.4), 1.2, 0.3, (1.5, 0.7))


@pytest.mark.quick("linkage0")
@pytest.mark.parametrize("linkage", [ENGINE, SHAPER])
def test_slider_kinds_are_driven_and_judged_from_the_pivots_alone(linkage: Linkage) -> None:
    spec = CylinderSpec(base=Box((-6, 6), (-6, 0)))
    of = driven_problem(linkage, np.radians([75.0, 95.0, 115.0, 135.0]), np.ones(4, dtype=int), spec)
    loaded = DynamicsSpec(speed_rpm=30, mass_per_length=2.0)
    wanted = replace(of.requirements, cylinder_angle_min_deg=20)
    of = replace(of, mechanism=linkage.mechanism.word, dynamics=loaded, length_unit="m", requirements=wanted)
    found = synthesize(of, enough=3, starts=16)
    assert len(found)
    for each in found.candidates:
        assert type(each.linkage) is type(linkage)
        check_by_pivots(each, of)
    restored_ = restored(plain(found.best), of)
    assert restored_.verdict.cylinder == found.best.verdict.cylinder


def test_kinds_together_give_one_list_of_driven_designs() -> None:
    kinds = ("four-bar", "slider-crank", "inverted-slider-crank")
    of = driven_problem(ENGINE, np.radians([60.0, 90.0, 120.0]), np.ones(3, dtype=int), CylinderSpec())
    frame = synthesize(replace(of, mechanism=kinds), enough=1, starts=4).to_frame()
    assert set(frame["mechanism"]) == set(kinds)
    assert frame["cylinder_on"].notna().all()
    assert (frame["cylinder_stroke"] <= 0.6 * frame["cylinder_closed"] * (1 + 1e-9)).all()
    assert frame["cylinder_angle_min_deg"].gt(0).all()


@pytest.mark.parametrize(
    "linkage",
    [
        FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2.5, r4=3, coupler_point=(1, 1)),
        SliderCrank((0, 0), 2, 1.5, 0.2, 0.7, (1, 0.6)),
        InvertedSliderCrank((0, 0), (2, 0.5), 1.5, 0.9, (2, 0.6)),
    ],
)
@pytest.mark.parametrize("on", ["coupler", "output"])
@pytest.mark.parametrize("sense", [1, -1])
def test_a_dead_position_of_link_2_is_none_for_a_cylinder_on_another(
    linkage: Linkage, on: str, sense: int
) -> None:
    """Poses on both sides of it, whichever comes first."""
    high = float(driver_ranges(linkage)[0, 1])
    theta2, assembly = high - np.array([0.3, 0.1, 0.2])[::sense], np.array([1, 1, -1])[::sense]
    problem = driven_problem(linkage, theta2, assembly, CylinderSpec(on=[on]))
    problem = replace(problem, mechanism=linkage.mechanism.word)
    used = linkage.changed(assembly=float(assembly[0]))

    def judged(cylinder: Cylinder | None, of: Problem = problem) -> Verdict:
        return verify(used, of.task, of.requirements, problem=of, cylinder=cylinder)

    without = judged(None)
    assert {each.requirement for each in without.defects} >= {"same_branch", "driver.cylinder"}
    cylinder = cylinder_for(problem, used, without)
    assert cylinder is not None
    assert judged(cylinder).ok
    on_link_2 = replace(problem, driver=CylinderSpec(on=["driver"]))
    assert cylinder_for(on_link_2, used, without) is None
    missed = {each.requirement for each in judged(replace(cylinder, on="driver"), on_link_2).defects}
    assert "same_branch" in missed


def test_a_cylinder_needs_a_driver_that_need_not_turn() -> None:
    task = MotionTask([[0, 0], [3, 4]], [0, 1])
    with pytest.raises(ProblemError, match=r"^requirements.rotatability is full-crank; it must be any with"):
        Problem(task=task, driver=CylinderSpec())
    assert Problem(task=task).driver is None
