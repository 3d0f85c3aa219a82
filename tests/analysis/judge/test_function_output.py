"""The judge of functions against the judge in body coordinates and dense search."""

from itertools import product

import numpy as np
import pytest
from body_coordinates import follow, start
from body_plans import plan_of
from scipy.optimize import minimize_scalar

from grashof.analysis import function_curves, solve_position, verify
from grashof.analysis.judge.planted import planted_function
from grashof.analysis.mechanism.transmission import worst_transmission
from grashof.problems import FourBar, FunctionTask, Linkage, Problem, ProblemError, Requirements, SliderCrank
from grashof.problems.values.arrays import FloatArray

SLIDING = ("slider-crank", "inverted-slider-crank")
WIDE = {"four-bar": {}} | {kind: {"link_length": (1e-4, 1e4)} for kind in SLIDING}


def followed(linkage: Linkage, theta2: FloatArray) -> FloatArray:
    """Travel of the slide, or direction of link 4 counted on, by the judge in body coordinates."""
    plan = plan_of(linkage)
    link_4 = follow(plan, start(plan, theta2[0]), theta2[0], theta2)[:, 0, 6:9]
    if not isinstance(linkage, SliderCrank):
        return np.unwrap(link_4[:, 2])
    along = np.array([np.cos(linkage.slide_angle), np.sin(linkage.slide_angle)])
    return np.asarray((link_4[:, :2] - linkage.o2) @ along)


@pytest.mark.quick(
    *(f"{case}-four-bar" for case in ("3-1", "9--1")),
    "5--1-slider-crank", "9--1-inverted-slider-crank",
)  # fmt: skip
@pytest.mark.parametrize("mechanism", WIDE)
@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("pairs", [3, 4, 5, 9])
def test_planted_functions_are_accepted(mechanism: str, pairs: int, direction: int) -> None:
    rng = np.random.default_rng([pairs, direction + 1])
    for _ in range(3):
        task, linkage, begun = planted_function(rng, pairs, mechanism=mechanism)
        if direction < 0:  # the mirror image turns its driver clockwise
            side = "assembly" if mechanism == "four-bar" else "offset"
            linkage = linkage.changed(**{side: -getattr(linkage, side)})
        verdict = verify(linkage, task, Requirements(exact=True, **WIDE[mechanism]))  # type: ignore[arg-type]
        assert verdict.ok, verdict.defects
        assert verdict.output_error.max() < 1e-9 * task.output_unit
        assert np.isnan(verdict.error_max)
        if pairs > 4:
            assert verdict.direction == direction
            assert abs(np.exp(1j * (verdict.theta2[0] - direction * begun)) - 1) < 1e-6


@pytest.mark.slow
@pytest.mark.quick("rms-slider-crank-1e-06")
@pytest.mark.parametrize(("mechanism", "size"), [("four-bar", 1.0), *product(SLIDING, (1e-6, 1.0, 1e5))])
@pytest.mark.parametrize("norm", ["rms", "max"])
def test_structural_error_is_that_of_dense_continuation(norm: str, mechanism: str, size: float) -> None:
    rng = np.random.default_rng(11)
    for _ in range(4):
        task, linkage, _ = planted_function(rng, 5, mechanism=mechanism)
        scale = size if task.travels else 1.0
        outputs = task.outputs * 1.03 * scale
        task = FunctionTask(task.inputs, outputs, norm=norm, travels=task.travels)
        other = linkage.scaled(size, np.zeros(2))
        verdict = verify(other, task, Requirements(exact=False, tolerance=1.0))
        turned = np.unique(np.concatenate([task.inputs, np.linspace(0, task.inputs[-1], 3001)]))
        moved = followed(linkage, float(verdict.theta2[0]) + verdict.direction * turned) * scale
        off = moved * (1 if task.travels else verdict.direction) - task.output(turned)
        zero = off[np.searchsorted(turned, task.inputs)].mean()
        if norm == "max":
            zero = (off.max() + off.min()) / 2
        assert abs(np.abs(off - zero).max() - verdict.structural_error_max) < 1e-6 * scale
        rms = np.sqrt(np.trapezoid((off - zero) ** 2, turned) / turned[-1])
        assert abs(rms - verdict.structural_error_rms) < 1e-5 * scale
        if norm == "max" and mechanism == "four-bar":  # no other start angle does better
            starts = np.linspace(-np.pi, np.pi, 181)[:, None]
            for direction in (1, -1):
                theta4 = solve_position(linkage, starts + direction * turned[::20]).theta4
                gap = direction * np.unwrap(theta4) - task.output(turned[::20])
                assert (
                    verdict.structural_error_max <= np.nanmin(np.ptp(gap, axis=1), initial=np.inf) / 2 * 1.001
                )


COUPLERS = pytest.mark.parametrize("mechanism", ["four-bar", "inverted-slider-crank"])


@COUPLERS
@pytest.mark.parametrize("direction", [1, -1])
def test_planted_coupler_functions_are_accepted(mechanism: str, direction: int) -> None:
    rng = np.random.default_rng(direction + 1)
    for pairs in (4, 6, 9):
        task, linkage, _ = planted_function(rng, pairs, mechanism=mechanism, link="coupler")
        if direction < 0:
            side = "assembly" if mechanism == "four-bar" else "offset"
            linkage = linkage.changed(**{side: -getattr(linkage, side)})
        verdict = verify(linkage, task, Requirements(exact=True, link_length=(1e-4, 1e4)))
        assert verdict.ok, verdict.defects
        assert verdict.output_error.max() < 1e-9
        opposite = FunctionTask(task.inputs, -task.outputs, link="coupler")
        assert not verify(linkage, opposite, Requirements(exact=True, link_length=(1e-4, 1e4))).ok


@COUPLERS
@pytest.mark.parametrize("norm", ["rms", "max"])
def test_structural_error_of_a_coupler_is_that_of_dense_continuation(norm: str, mechanism: str) -> None:
    rng = np.random.default_rng(12)
    for _ in range(2):
        task, linkage, _ = planted_function(rng, 6, mechanism=mechanism, link="coupler")
        task = FunctionTask(task.inputs, task.outputs * 1.04, norm=norm, link="coupler")
        verdict = verify(linkage, task, Requirements(exact=False, tolerance=1.0))
        turned = np.unique(np.concatenate([task.inputs, np.linspace(0, task.inputs[-1], 2001)]))
        theta2 = float(verdict.theta2[0]) + verdict.direction * turned
        plan = plan_of(linkage)
        theta3 = np.unwrap(follow(plan, start(plan, theta2[0]), theta2[0], theta2)[:, 0, 5])
        off = theta3 * verdict.direction - task.output(turned)
        zero = off[np.searchsorted(turned, task.inputs)].mean()
        if norm == "max":
            zero = (off.max() + off.min()) / 2
        assert abs(np.abs(off - zero).max() - verdict.structural_error_max) < 1e-6
        rms = np.sqrt(np.trapezoid((off - zero) ** 2, turned) / turned[-1])
        assert abs(rms - verdict.structural_error_rms) < 1e-5


def test_a_coupler_of_other_kinds_is_refused() -> None:
    task = FunctionTask([0, 0.5, 1.0], [0, 0.1, 0.3], link="coupler")
    with pytest.raises(ProblemError, match='link is "coupler"; mechanism must be four-bar or inverted'):
        verify(SliderCrank((0, 0), 1, 3), task, Requirements(exact=False))


@pytest.mark.parametrize("norm", ["rms", "max"])
def test_a_function_begins_where_it_errs_least_among_the_starts_that_transmit(norm: str) -> None:
    rng = np.random.default_rng(4)
    limited = 0
    for _ in range(3):
        task, linkage, _ = planted_function(rng, 7)
        task = FunctionTask(task.inputs, task.outputs * 1.1, norm=norm)
        free = verify(linkage, task, Requirements(exact=False, transmission_min_deg=0))
        least = np.degrees(free.transmission_min_task) + 2.0
        wanted = Requirements(exact=False, tolerance=1.0, transmission_min_deg=least)
        verdict = verify(linkage, task, wanted)
        turned = task.inputs if norm == "rms" else np.linspace(0, task.inputs[-1], 61)
        best = np.inf
        for direction in (1, -1):
            starts = np.linspace(-np.pi, np.pi, 2001)
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
        assert 0.9 * best <= found <= best * (1 + share)  # the starts are 0.18 deg apart
    assert limited > 1


@pytest.mark.parametrize("seed", range(2))
def test_the_greatest_error_is_least_to_all_its_digits(seed: int) -> None:
    """Samples pass by its extremes, so that those of a coarse grid have their least at another start."""
    task, linkage, _ = planted_function(np.random.default_rng(seed), 6)
    task = FunctionTask(task.inputs, task.outputs * 1.05, norm="max")
    verdict = verify(linkage, task, Requirements(exact=False, transmission_min_deg=0))
    turned = np.linspace(0, task.inputs[-1], 4001)
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


@pytest.mark.parametrize("linkage", [FourBar((0, 0), (4, 0), 3, 1.5, 1.5), SliderCrank((0, 0), 3, 1.5)])
def test_a_range_that_the_driver_cannot_cover_is_a_defect(linkage: Linkage) -> None:
    """Both drivers swing."""
    travels = isinstance(linkage, SliderCrank)
    task = FunctionTask([0, 1.0, 2.0, 3.0], [0, 0.5, 1.0, 1.5], travels=travels)
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


@pytest.mark.parametrize(
    ("mechanism", "key", "unit"),
    [
        ("four-bar", "structural_error_max_deg", np.degrees(1.0)),
        ("slider-crank", "structural_error_max", 1.0),
    ],
)
def test_limits_of_the_structural_error(mechanism: str, key: str, unit: float) -> None:
    task, linkage, _ = planted_function(np.random.default_rng(8), 5, mechanism=mechanism)
    problem = Problem(task=task, mechanism=mechanism)
    most = unit * verify(linkage, task, Requirements(), problem=problem).structural_error_max
    within, beyond = (Requirements(**{key: (0, share * most)}) for share in (1.01, 0.99))  # type: ignore[arg-type]
    assert verify(linkage, task, within, problem=problem).ok
    (defect,) = verify(linkage, task, beyond, problem=problem).defects
    assert (defect.requirement, defect.found) == (key, pytest.approx(most))


def test_an_output_of_the_wrong_kind_is_refused() -> None:
    task, linkage, _ = planted_function(np.random.default_rng(8), 5, mechanism="slider-crank")
    turning = FunctionTask(task.inputs, task.outputs)
    with pytest.raises(ProblemError, match="mechanism slider-crank has no output that turns"):
        verify(linkage, turning, Requirements())
