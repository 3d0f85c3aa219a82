"""Coupler angles over the driver angle: planted ones, lists of the exchange and limits, by circles."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from circles import closed

from grashof import load, synthesize, track
from grashof.analysis.judge.planted import planted_function
from grashof.problems import Box, FunctionTask, Problem, Requirements
from grashof.problems.values.arrays import FloatArray
from grashof.synth import Candidate

DEG = float(np.degrees(1.0))


def turns(design: Candidate, turned: FloatArray) -> FloatArray:
    """Rotation of the coupler from the first place, in the sense of the driver, by circles about A and O4."""
    one, verdict = design.linkage, design.verdict
    theta2 = float(verdict.theta2[0]) + verdict.direction * turned
    numbers = np.array([*one.o2, *one.o4, *one.lengths[1:], 0.0, 0.0])
    a, b, _ = closed(numbers, theta2, float(one.assembly))
    theta3: FloatArray = verdict.direction * np.unwrap(np.angle(b - a))
    return theta3 - theta3[0]


@pytest.mark.slow
@pytest.mark.quick("4", "5")
@pytest.mark.parametrize("pairs", [3, 4, 5])
def test_planted_coupler_angles_are_met(pairs: int) -> None:
    rng = np.random.default_rng(pairs)
    for _ in range(3):
        task, planted, _ = planted_function(rng, pairs, link="coupler")
        result = synthesize(Problem(task=task), enough=8)
        assert len(result)
        for each in result.candidates:
            assert each.verdict.ok
            assert np.abs(turns(each, task.inputs) - task.outputs).max() < 1e-8
        if pairs == 5:
            lengths = np.array([each.linkage.lengths for each in result.candidates])
            assert np.abs(lengths - planted.lengths).max(axis=1).min() < 1e-6


def test_the_rod_of_an_inverted_slider_crank_turns_as_its_block() -> None:
    task, planted, _ = planted_function(
        np.random.default_rng(4), 4, mechanism="inverted-slider-crank", link="coupler"
    )
    wanted = Requirements(exact=True, link_length=(1e-3, 1e3))
    both = [
        synthesize(Problem(task=each, requirements=wanted, mechanism="inverted-slider-crank"))
        for each in (task, replace(task, link="output"))
    ]
    lengths = np.array([each.linkage.lengths for each in both[0].candidates])
    assert np.abs(lengths - planted.lengths).max(axis=1).min() < 1e-6 * planted.lengths.max()
    assert [each.id for each in both[0].candidates] == [each.id for each in both[1].candidates]


@pytest.mark.slow
def test_the_practice_problem_is_solved_as_well_as_by_an_independent_search() -> None:
    """Reference: `scipy.optimize.least_squares` over r2 to r4, both starts and the zero, from many starts."""
    problem = load("coupler-angle")
    best = synthesize(problem).best
    task = problem.task
    errors = turns(best, task.inputs) - task.outputs
    assert np.std(errors) * DEG < 1.02 * 0.17138
    dense = np.linspace(0, np.pi, 4001)
    errors = turns(best, dense) - task.output(dense) - errors.mean()
    assert np.abs(errors).max() * DEG == pytest.approx(best.verdict.structural_error_max * DEG, abs=1e-4)
    assert np.sqrt(np.trapezoid(errors**2, dense) / np.pi) * DEG < 0.146
    assert best.verdict.structural_error_rms * DEG < 0.146


@pytest.mark.slow
def test_the_greatest_error_of_a_law_is_that_of_an_output() -> None:
    """By the exchange, of limits that do not know links 3 and 4 apart; 0.05011 deg as of the output."""
    task = FunctionTask.from_degrees(
        law="log10", x=(1, 2), input_range_deg=60, output_range_deg=90, sense="either", norm="max",
        link="coupler",
    )  # fmt: skip
    wanted = Requirements(link_ratio_max=10, transmission_min_deg=40)
    best = synthesize(Problem(task=task, requirements=wanted)).best
    dense = np.linspace(*task.span, 2001)
    found = turns(best, dense - dense[0])
    error = min(float(np.ptp(found - way * task.output(dense))) / 2 for way in (1, -1)) * DEG
    assert error <= 1.005 * 0.05011
    assert error == pytest.approx(best.verdict.structural_error_max * DEG, abs=1e-6)


PAIRS = FunctionTask.from_degrees([0, 45, 90], [0, 15, 40], link="coupler")
DATA = FunctionTask.from_degrees([0, 30, 60, 90, 120, 150], [0, 5, 14, 26, 37, 44], link="coupler")
LIMITS: list[dict[str, Any]] = [
    {"r3": (2.0, 2.5), "r4": (0.5, 0.9), "exact": True},
    {"rotatability": "crank-rocker", "r3": (1.4, 3.0), "transmission_min_deg": 20, "exact": False},
    {"rotatability": "double-crank", "r4": (2.0, 4.0), "exact": False, "driver_sense": "cw"},
    {"theta2_start_deg": 40.0, "r3": (1.5, 2.0), "exact": False},
    {"link_ratios": {"r4/r2": 1, "r3/r1": (1.2, 3.0)}, "exact": False},
]


@pytest.mark.slow
@pytest.mark.quick("1", "4")
@pytest.mark.parametrize("row", range(len(LIMITS)))
def test_limits_are_those_of_the_linkage_and_the_list_is_exchanged(row: int) -> None:
    """The output with the limits of r3 and r4 exchanged has the same designs, r3 and r4 exchanged."""
    wanted = Requirements(**LIMITS[row])
    task = PAIRS if wanted.exact else DATA
    result = synthesize(Problem(task=task, requirements=wanted), enough=6)
    assert len(result)
    for each in result.candidates:
        assert each.verdict.ok
        lengths = dict(zip(each.linkage.mechanism.lengths, each.linkage.lengths.tolist(), strict=True))
        for name in ("r3", "r4"):
            low, high = getattr(wanted, name) or (0.0, np.inf)
            assert low - 1e-6 <= lengths[name] <= high + 1e-6
        for name, (low, high) in wanted.ranges("link_ratios").items():
            assert low - 1e-6 <= lengths[name[:2]] / lengths[name[3:]] <= high + 1e-6
        if row in (1, 2):
            assert each.verdict.grashof_class == wanted.rotatability
            swing = np.ptp(turns(each, np.linspace(0, 2 * np.pi, 721)))
            assert (swing > 6) == (row == 2)
    names = str.maketrans("34", "43")
    ratios = {name.translate(names): limits for name, limits in wanted.ranges("link_ratios").items()}
    other = replace(wanted, r3=wanted.r4, r4=wanted.r3, link_ratios=ratios or None)
    output = synthesize(Problem(task=replace(task, link="output"), requirements=other), enough=6)
    np.testing.assert_allclose(
        result.best.linkage.lengths, output.best.linkage.lengths[[0, 1, 3, 2]], rtol=1e-4
    )


@pytest.mark.slow
def test_a_place_of_b_is_judged_on_the_linkage() -> None:
    box = Box((-0.5, 3.0), (-1.0, 3.0))
    result = synthesize(Problem(task=PAIRS, requirements=Requirements(b=box)), enough=4)
    assert len(result)
    for each in result.candidates:
        one = each.linkage
        numbers = np.array([*one.o2, *one.o4, *one.lengths[1:], 0.0, 0.0])
        _, b, _ = closed(numbers, each.verdict.theta2, float(one.assembly))
        assert (np.abs(b - (1.25 + 1j)) < 3).all()
        assert (b.real >= -0.5 - 1e-6).all()
        assert (b.imag >= -1 - 1e-6).all()


def test_designs_follow_a_moved_coupler_angle() -> None:
    designs = synthesize(Problem(task=DATA)).candidates[:2]
    outputs = DATA.outputs.copy()
    outputs[2] += 0.004
    there = Problem(task=replace(DATA, outputs=outputs))
    for before, after in zip(designs, track(designs, there), strict=True):
        assert after.verdict.ok
        assert 0 < np.abs(after.linkage.lengths - before.linkage.lengths).max() < 0.2
        errors = turns(after, there.task.inputs) - outputs
        assert np.abs(errors - errors.mean()).max() == pytest.approx(np.abs(after.verdict.output_error).max())
