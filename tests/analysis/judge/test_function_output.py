"""The judge of functions against a residual solver and dense search."""

import numpy as np
import pytest

from grashof.analysis import function_curves, solve_position, verify
from grashof.analysis.judge.planted import planted_function
from grashof.problems import FourBar, FunctionTask, Problem, Requirements
from grashof.problems.values.arrays import FloatArray


def continued(linkage: FourBar, start: float, sense: int, turned: FloatArray) -> FloatArray:
    """Output rotation in the sense of the driver, by Newton's method on both loop equations, step by step."""
    r1, r2, r3, r4 = linkage.lengths
    theta1 = float(linkage.theta1)
    first = solve_position(linkage, start)
    at = np.array([float(first.theta3), float(first.theta4)])
    found = []
    for turn in turned:
        driver = r2 * np.exp(1j * (start + sense * turn)) - r1 * np.exp(1j * theta1)

        for _ in range(20):
            rest = driver + r3 * np.exp(1j * at[0]) - r4 * np.exp(1j * at[1])
            slope = 1j * np.array([r3 * np.exp(1j * at[0]), -r4 * np.exp(1j * at[1])])
            at = at - np.linalg.solve([slope.real, slope.imag], [rest.real, rest.imag])
        found.append(at[1])
    return sense * (np.array(found) - found[0])


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("pairs", [3, 4, 5, 9])
def test_planted_functions_are_accepted(pairs: int, direction: int) -> None:
    rng = np.random.default_rng([pairs, direction + 1])
    for _ in range(5):
        task, linkage, start = planted_function(rng, pairs)
        if direction < 0:  # the mirror image turns its driver clockwise
            linkage = FourBar(
                linkage.o2, linkage.o4, linkage.r2, linkage.r3, linkage.r4, assembly=-linkage.assembly
            )
        verdict = verify(linkage, task, Requirements(exact=True))
        assert verdict.ok, verdict.defects
        assert verdict.output_error.max() < 1e-9
        assert np.isnan(verdict.error_max)
        if pairs > 4:
            assert verdict.direction == direction
            assert abs(np.exp(1j * (verdict.theta2[0] - direction * start)) - 1) < 1e-6


@pytest.mark.parametrize("norm", ["rms", "max"])
def test_structural_error_is_that_of_dense_continuation(norm: str) -> None:
    rng = np.random.default_rng(11)
    for _ in range(4):
        task, linkage, _ = planted_function(rng, 5)
        task = FunctionTask(task.inputs, task.outputs * 1.03, norm=norm)
        verdict = verify(linkage, task, Requirements(exact=False, tolerance=1.0))
        turned = np.unique(np.concatenate([task.inputs, np.linspace(0, task.inputs[-1], 3001)]))
        path = continued(linkage, float(verdict.theta2[0]), verdict.direction, turned)
        off = path - task.output(turned)
        zero = off[np.searchsorted(turned, task.inputs)].mean()
        if norm == "max":
            zero = (off.max() + off.min()) / 2
        assert abs(np.abs(off - zero).max() - verdict.structural_error_max) < 1e-6
        rms = np.sqrt(np.trapezoid((off - zero) ** 2, turned) / turned[-1])
        assert abs(rms - verdict.structural_error_rms) < 1e-5
        # No other start angle does better.
        best = np.inf
        for direction in (1, -1):
            for start in np.linspace(-np.pi, np.pi, 181):
                theta4 = solve_position(linkage, start + direction * turned[::20]).theta4
                if not np.isnan(theta4).any():
                    gap = direction * np.unwrap(theta4) - task.output(turned[::20])
                    best = min(best, float(np.ptp(gap)) / 2)
        if norm == "max":
            assert verdict.structural_error_max <= best * 1.001


def test_either_sense_of_the_output() -> None:
    task, linkage, _ = planted_function(np.random.default_rng(5), 6)
    opposite = FunctionTask(task.inputs, -task.outputs, sense="either")
    verdict = verify(linkage, opposite, Requirements(exact=True))
    assert verdict.ok
    assert verdict.output_sense == -1
    given = FunctionTask(task.inputs, -task.outputs)
    assert not verify(linkage, given, Requirements(exact=True)).ok


def test_pairs_on_both_sides_of_a_dead_position_are_refused() -> None:
    linkage = FourBar((0, 0), (1, 0), 1.5, 1.0, 1.2)  # its driver swings
    inputs = np.array([0.0, 1.0, 2.0])
    outputs = np.array([0.0, 0.4, 5.9])
    verdict = verify(linkage, FunctionTask(inputs, outputs), Requirements())
    assert not verdict.ok


def test_a_range_that_the_driver_cannot_cover_is_a_defect() -> None:
    linkage = FourBar((0, 0), (4, 0), 3, 1.5, 1.5)
    task = FunctionTask([0, 1.0, 2.0, 3.0], [0, 0.5, 1.0, 1.5])
    verdict = verify(linkage, task, Requirements(exact=False))
    assert not verdict.ok
    assert not verdict.circuit_ok
    assert np.isnan(verdict.structural_error_max)
    assert function_curves(linkage, task, verdict) is None


def test_curves_meet_the_pairs() -> None:
    task, linkage, _ = planted_function(np.random.default_rng(8), 5)
    problem = Problem(task=task)
    verdict = verify(linkage, task, problem.requirements, problem=problem)
    at = function_curves(linkage, task, verdict, at=task.inputs)
    assert at is not None
    assert np.abs(at.error).max() < 1e-9
    assert np.abs(at.generated - task.outputs).max() < 1e-9
    curves = function_curves(linkage, task, verdict)
    assert curves is not None
    assert abs(np.abs(curves.error).max() - verdict.structural_error_max) < 1e-4


def test_limits_of_the_structural_error() -> None:
    task, linkage, _ = planted_function(np.random.default_rng(8), 5)
    most = float(np.degrees(verify(linkage, task, Requirements()).structural_error_max))
    assert verify(linkage, task, Requirements(structural_error_max_deg=(0, 1.01 * most))).ok
    (defect,) = verify(linkage, task, Requirements(structural_error_max_deg=(0, 0.99 * most))).defects
    assert defect.requirement == "structural_error_max_deg"
