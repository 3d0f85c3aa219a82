"""Strokes of problems: claims about lists, requirements left out, and none only where there is none."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof import load, synthesize
from grashof.analysis import verify
from grashof.problems import Box, InvertedSliderCrank, Problem, SliderCrank, StrokeTask
from grashof.problems.files.problem_schema import problem_from
from grashof.synth import Claim, Proof, prove
from grashof.synth.proof.claims.bounds import Bounds, Proving
from grashof.synth.proof.provers import bounds_of
from grashof.synth.proof.strokes.required import sizes_left_out
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.wording.proof import bound_line, is_decided, proof_line, work_line


def problem_of(mechanism: str | list[str], ratio: float, swing_deg: float = 0.0, **wanted: Any) -> Problem:
    objective = wanted.pop("objective", None)
    stroke = {"time_ratio": ratio, **({"swing_deg": swing_deg} if swing_deg else {"stroke": 1})}
    document = {"kind": "stroke", "mechanism": mechanism, "stroke": stroke, "requirements": wanted}
    return problem_from({**document, **({"objective": objective} if objective else {})}, "stroke")


def slide(ratio: float = 1.2, **wanted: Any) -> Problem:
    return problem_of("slider-crank", ratio, **wanted)


def proof_for(problem: Problem) -> Proof:
    found = synthesize(problem, enough=3).proof
    assert found is not None
    return found


def bounded(problem: Problem) -> Bounds:
    found = bounds_of(ScaledProblem.of(problem), Proving())
    assert found is not None
    return found


def test_the_best_of_a_list_is_proven_and_reported() -> None:
    result = synthesize(load("quick-return-slide"), enough=3)
    proof = result.proof
    assert proof is not None
    assert (proof.claim, proof.mechanism, proof.left_out) == (Claim.BEST, "slider-crank", ())
    assert proof.lower == pytest.approx(47.201, abs=5e-4)
    line = (
        "Proven: no slider-crank meets these requirements with more than 47.22 deg; number 1 has 47.20 deg."
    )
    assert proof_line(result) == line
    assert work_line(proof).startswith("64 pieces of one-parameter families, ")


def test_none_is_proven_without_a_search() -> None:
    result = synthesize(slide(transmission_min_deg=47.3))
    assert result.proof is not None
    assert (result.proof.claim, result.proof.lower) == (Claim.NONE, None)
    assert "slider-crank meets these requirements with a transmission angle of 47.30" in proof_line(result)
    assert "(without transmission_min_deg 47.22 deg at best, proven)" in result.note


@pytest.mark.parametrize(
    ("problem", "best"),
    [
        (slide(offset=[-0.3, -0.1]), 46.837),
        (problem_of("four-bar", 1.2, 80.0, r1=[1, 1], r4=[0.5, 0.55]), 29.228),
        (problem_of("inverted-slider-crank", 2.6, 80.0, r1=[1, 1], offset=[0.2, 0.3]), 58.197),
        (problem_of("inverted-slider-crank", 2.6, 80.0), 90.0),
    ],
)
def test_limits_of_sizes_are_counted(problem: Problem, best: float) -> None:
    proof = proof_for(problem)
    assert proof.claim is Claim.BEST
    assert proof.lower == pytest.approx(best, abs=1e-3)


@pytest.mark.slow
def test_of_several_kinds_the_first_is_bounded_and_its_rank_stated() -> None:
    result = synthesize(problem_of(["four-bar", "inverted-slider-crank"], 2.6, 80.0), enough=3)
    assert result.best.linkage.mechanism.word == "inverted-slider-crank"
    rank = next(k for k, one in enumerate(result.candidates, 1) if one.linkage.mechanism.word == "four-bar")
    line = f"no four-bar meets these requirements with more than 12.57 deg; number {rank} has 12.55 deg."
    assert line in proof_line(result)


def test_places_are_left_out_unless_any_linkage_can_be_put_there() -> None:
    def named(problem: Problem) -> tuple[str, ...]:
        return sizes_left_out(ScaledProblem.of(problem))

    assert named(slide(o2=[3, 4], slide_angle_deg=90, driver_sense="cw")) == ()
    assert named(slide(theta2_start_deg=30, slide_angle_deg=90)) == ("slide_angle_deg", "theta2_start_deg")
    assert named(slide(o2=[3, 4], a={"x": [0, 9]})) == ("o2", "a")
    assert named(slide(keep_out=[[[-9, -9], [9, -9], [0, 9]]])) == ("keep_out",)
    assert named(slide(size=[0, 2])) == ("size",)
    assert named(slide(at=[{"targets": [1], "b": {"x": [0, 1]}}])) == ("at",)


def test_where_places_are_in_the_way_the_bound_holds() -> None:
    problem = slide(theta2_start_deg=30, slide_angle_deg=45)
    result = synthesize(problem)
    proof = result.proof
    assert proof is not None
    assert (proof.claim, proof.lower) == (Claim.BOUND, None)
    assert proof_line(result).endswith("47.22 deg (without slide_angle_deg and theta2_start_deg).")
    assert proof_for(slide(b={"x": [0, 1], "y": [0, 0]})).claim is Claim.BEST
    bound = proof_for(slide(at=[{"targets": [2], "distances": {"b-o2": [0.9, 1.6]}}]))
    assert (bound.claim, bound.left_out) == (Claim.BOUND, ("at",))


def test_an_objective_without_the_transmission_angle_is_refused_unless_there_is_none() -> None:
    compact = {"maximise": {"compactness": 1.0}}
    assert bounded(slide(objective=compact)).refused
    assert bounded(slide(objective=compact, r2=[0.6, 0.9])).none


@pytest.mark.parametrize("seed", range(3))
def test_a_slide_under_limits_that_it_just_misses_is_not_none(seed: int) -> None:
    """By half of what the judge overlooks, in two lengths of which one grows where the other shrinks."""
    rng = np.random.default_rng(seed)
    lag = rng.uniform(0.02, 0.3)
    share = rng.uniform(np.tan(lag / 2) ** 2 + 0.05, 0.5)
    r3 = 50 / np.hypot(np.sin(lag / 2), share * np.cos(lag / 2))
    r2, offset = share * r3, (1 - share**2) * r3**2 * np.sin(lag) / 100
    design = SliderCrank((0, 0), r2, r3, offset)
    task = StrokeTask(stroke=100.0, time_ratio=(np.pi + lag) / (np.pi - lag))
    plain = Problem(task=task, mechanism="slider-crank")
    for sizes in ({"r2": r2, "r3": r3}, {"r2": r2, "offset": offset}):
        for by, some in ((0.5e-7, True), (1e-6, False)):
            wanted = {name: (size + by, size + 1) for name, size in sizes.items()}
            problem = replace(plain, requirements=replace(plain.requirements, **wanted))
            accepted = verify(design, problem.task, problem.requirements, problem=problem)
            found = bounded(problem)
            assert accepted.ok is some
            assert found.none is not some
            assert not some or found.upper >= accepted.transmission_min_cycle - 1e-9


SINE = float(np.sin(np.radians(40)))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("link_ratio_max", lambda by: (1 - by) / SINE),
        ("rotatability_margin", lambda by: (1 - SINE) / (1 + SINE) + by),
        ("r2", lambda by: (SINE + by, 1.0)),
    ],
)
def test_a_shaper_under_a_limit_that_it_just_misses_is_not_none(name: str, value: Any) -> None:
    """Without an offset r2 is longest: a linkage at the end of its family."""
    design = InvertedSliderCrank((0, 0), (1, 0), SINE, offset=0.0)
    plain = problem_of("inverted-slider-crank", 2.6, 80.0, r1=[1, 1])
    for by, some in ((0.5e-9, True), (1e-8, False)):
        problem = replace(plain, requirements=replace(plain.requirements, **{name: value(by)}))
        accepted = verify(design, problem.task, problem.requirements, problem=problem)
        assert accepted.ok is some
        assert bounded(problem).none is not some


@pytest.mark.slow
def test_prove_decides_whether_there_is_a_design() -> None:
    proof = prove(load("quick-return"))
    assert proof.claim is Claim.BEST
    assert proof.lower == pytest.approx(37.733, abs=1e-3)
    assert is_decided(prove(slide(), at_least=47.2), 47.2)
    above = prove(slide(), at_least=47.3)
    assert (above.claim, is_decided(above, 47.3)) == (Claim.NONE, True)
    assert "47.30 deg or more" in bound_line(above, 47.3)


def test_a_box_of_one_pivot_alone_changes_nothing() -> None:
    plain = load("quick-return")
    boxed = replace(plain, requirements=replace(plain.requirements, o2=Box((50, 60), (50, 60))))
    assert bounded(boxed).upper == bounded(plain).upper
    assert bounded(boxed).left_out == ()
