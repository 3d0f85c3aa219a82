"""The judge of functions against a residual solver and dense search."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from grashof.analysis import function_curves, solve_position, verify
from grashof.analysis.judge.planted import planted_function
from grashof.analysis.mechanism.transmission import worst_transmission
from grashof.problems import (
    FourBar,
    FunctionTask,
    InvertedSliderCrank,
    Linkage,
    Problem,
    ProblemError,
    Requirements,
    SliderCrank,
)
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


@pytest.mark.quick("3-1", "3--1", "4--1", "5-1", "9-1", "9--1")
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


@pytest.mark.study
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


@pytest.mark.parametrize("norm", ["rms", "max"])
def test_a_function_begins_where_it_errs_least_among_the_starts_that_transmit(norm: str) -> None:
    rng = np.random.default_rng(4)
    limited = 0
    for _ in range(5):
        task, linkage, _ = planted_function(rng, 7)
        task = FunctionTask(task.inputs, task.outputs * 1.1, norm=norm)
        free = verify(linkage, task, Requirements(exact=False, transmission_min_deg=0))
        least = np.degrees(free.transmission_min_task) + 2.0
        wanted = Requirements(exact=False, tolerance=1.0, transmission_min_deg=least)
        verdict = verify(linkage, task, wanted)
        turned = task.inputs if norm == "rms" else np.linspace(0, task.inputs[-1], 301)
        best = np.inf
        for direction in (1, -1):
            starts = np.linspace(-np.pi, np.pi, 4001)
            ends = starts + direction * task.span[0], starts + direction * task.span[1]
            starts = starts[worst_transmission(linkage, *ends) >= np.radians(least)]
            theta4 = solve_position(linkage, starts[:, None] + direction * turned).theta4
            off = direction * np.unwrap(theta4) - task.output(turned)
            errors = np.std(off, axis=1) if norm == "rms" else np.ptp(off, axis=1) / 2
            best = min(best, float(errors.min(initial=np.inf)))
        if not np.isfinite(best):
            continue
        limited += 1
        assert verdict.transmission_min_task >= np.radians(least) - 1e-8
        found = np.sqrt(verdict.square / len(task)) if norm == "rms" else verdict.structural_error_max
        share = 1e-6 if norm == "rms" else 1e-3
        assert 0.9 * best <= found <= best * (1 + share)  # the starts are 0.09 deg apart
    assert limited > 2


@pytest.mark.parametrize("seed", range(3))
def test_the_greatest_error_is_least_to_all_its_digits(seed: int) -> None:
    """Samples pass by its extremes, so that those of a coarse grid have their least at another start."""
    task, linkage, _ = planted_function(np.random.default_rng(seed), 6)
    task = FunctionTask(task.inputs, task.outputs * 1.05, norm="max")
    verdict = verify(linkage, task, Requirements(exact=False, transmission_min_deg=0))
    turned = np.linspace(0, task.inputs[-1], 8001)
    begun, direction = float(verdict.theta2[0]), verdict.direction

    def error(start: float) -> float:
        theta4 = solve_position(linkage, start + direction * turned).theta4
        return float(np.ptp(direction * np.unwrap(theta4) - task.output(turned))) / 2

    near = (begun - 0.01, begun + 0.01)
    found = minimize_scalar(error, bounds=near, method="bounded", options={"xatol": 1e-12})
    assert verdict.structural_error_max <= found.fun * (1 + 1e-6)


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


def followed(linkage: Linkage, theta2: FloatArray) -> FloatArray:
    """Travel of the slide or direction of the rod: B by Newton's method on two conditions, step by step."""
    state = solve_position(linkage, theta2[0])
    b, found = state.b.astype(np.float64), []
    e = np.array([np.cos(float(linkage.theta1) - np.pi / 2), np.sin(float(linkage.theta1) - np.pi / 2)])
    n = np.array([-e[1], e[0]])
    for angle in theta2:
        a = linkage.o2 + float(linkage.r2) * np.array([np.cos(angle), np.sin(angle)])
        for _ in range(30):
            if isinstance(linkage, SliderCrank):  # |AB| = r3, and B on the line
                rest = np.array([(b - a) @ (b - a) - linkage.r3**2, n @ (b - linkage.o2) - linkage.offset])
                slope = np.array([2 * (b - a), n])
            else:  # |O4B| = |offset|, and AB square to it
                arm = b - linkage.o4  # type: ignore[attr-defined]
                offset = float(linkage.offset)  # type: ignore[attr-defined]
                rest, slope = np.array([arm @ arm - offset**2, arm @ (b - a)]), np.array([2 * arm, 2 * b - a])
                slope[1] -= linkage.o4  # type: ignore[attr-defined]
            step = np.linalg.solve(slope, rest)
            b = b - step
            if np.abs(step).max() < 1e-13 * np.abs(a - b).max():
                break
        along = (b - a) if isinstance(linkage, InvertedSliderCrank) else e
        found.append(float(e @ (b - linkage.o2)) if along is e else float(np.arctan2(along[1], along[0])))
    values = np.array(found)
    return values if isinstance(linkage, SliderCrank) else np.unwrap(values)


SLIDING = pytest.mark.parametrize("mechanism", ["slider-crank", "inverted-slider-crank"])


@pytest.mark.quick("4-1-slider-crank", "5--1-slider-crank", "9--1-inverted-slider-crank")
@SLIDING
@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("pairs", [4, 5, 9])
def test_planted_functions_of_slides_are_accepted(mechanism: str, pairs: int, direction: int) -> None:
    rng = np.random.default_rng([pairs, direction + 1])
    for _ in range(5):
        task, linkage, start = planted_function(rng, pairs, mechanism=mechanism)
        if direction < 0:  # the mirror image turns its driver clockwise
            linkage = linkage.changed(offset=-linkage.offset)
        verdict = verify(linkage, task, Requirements(exact=True, link_length=(1e-4, 1e4)))
        assert verdict.ok, verdict.defects
        assert verdict.output_error.max() < 1e-9 * task.output_unit
        if pairs > 4:
            assert verdict.direction == direction
            assert abs(np.exp(1j * (verdict.theta2[0] - direction * start)) - 1) < 1e-6


@pytest.mark.slow
@pytest.mark.quick("1e-06-rms-slider-crank")
@SLIDING
@pytest.mark.parametrize("norm", ["rms", "max"])
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e5])
def test_structural_error_of_slides_is_that_of_dense_continuation(
    mechanism: str, norm: str, size: float
) -> None:
    rng = np.random.default_rng(11)
    for _ in range(3):
        task, linkage, _ = planted_function(rng, 5, mechanism=mechanism)
        scale = size if task.travels else 1.0
        numbers = {
            row.name: getattr(linkage, row.name) * size
            for row in linkage.mechanism.parameters
            if row.in_length
        }
        linkage = linkage.changed(**numbers)
        outputs = task.outputs * 1.03 * scale
        task = FunctionTask(task.inputs, outputs, norm=norm, travels=task.travels)
        verdict = verify(linkage, task, Requirements(exact=False, tolerance=1.0))
        turned = np.unique(np.concatenate([task.inputs, np.linspace(0, task.inputs[-1], 2001)]))
        moved = followed(linkage, float(verdict.theta2[0]) + verdict.direction * turned)
        off = moved * (1 if task.travels else verdict.direction) - task.output(turned)
        zero = off[np.searchsorted(turned, task.inputs)].mean()
        if norm == "max":
            zero = (off.max() + off.min()) / 2
        assert abs(np.abs(off - zero).max() - verdict.structural_error_max) < 1e-6 * scale
        rms = np.sqrt(np.trapezoid((off - zero) ** 2, turned) / turned[-1])
        assert abs(rms - verdict.structural_error_rms) < 1e-5 * scale


def test_limits_of_the_structural_error_of_a_slide() -> None:
    task, linkage, _ = planted_function(np.random.default_rng(8), 5, mechanism="slider-crank")
    problem = Problem(task=task, mechanism="slider-crank")
    most = verify(linkage, task, Requirements(), problem=problem).structural_error_max
    wanted = Requirements(structural_error_max=(0, 1.01 * most))
    assert verify(linkage, task, wanted, problem=problem).ok
    wanted = Requirements(structural_error_max=(0, 0.99 * most))
    (defect,) = verify(linkage, task, wanted, problem=problem).defects
    assert defect.requirement == "structural_error_max"
    assert defect.found == pytest.approx(most)


def test_an_output_of_the_wrong_kind_is_refused() -> None:
    task, linkage, _ = planted_function(np.random.default_rng(8), 5, mechanism="slider-crank")
    turning = FunctionTask(task.inputs, task.outputs)
    with pytest.raises(ProblemError, match="mechanism slider-crank has no output that turns"):
        verify(linkage, turning, Requirements())


def test_a_slide_that_the_crank_cannot_push_far_enough_is_a_defect() -> None:
    linkage = SliderCrank((0, 0), 3, 1.5)  # its driver swings
    task = FunctionTask([0, 1.0, 2.0, 3.0], [0, 0.5, 1.0, 1.5], travels=True)
    verdict = verify(linkage, task, Requirements(exact=False))
    assert not verdict.ok
    assert np.isnan(verdict.structural_error_max)
    assert function_curves(linkage, task, verdict) is None
