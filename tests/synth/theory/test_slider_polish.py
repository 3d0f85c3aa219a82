"""Polishing of slider kinds: derivatives of the closed loop, and targets met to rounding."""

from dataclasses import replace

import numpy as np
import pytest
from as_found import as_found

from grashof.analysis import solve_position
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Problem
from grashof.problems.values.arrays import FloatArray
from grashof.synth.quantities.kinds import KINDS
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.polish import ExactTargets, _linearised, _spread, polish_path

SLIDERS = ("slider-crank", "inverted-slider-crank")


def planted(mechanism: str, seed: int, count: int = 5) -> tuple[FloatArray, FloatArray, float, ExactTargets]:
    """Points of a linkage at the first of some poses, driver angles, body angle, and the poses."""
    task, linkage = planted_motion(np.random.default_rng([11, seed]), count, mechanism=mechanism)
    linkage = as_found(linkage)
    scaled = ScaledProblem.of(Problem(task=task, mechanism=mechanism))
    kind, every = KINDS[mechanism], np.ones(count, dtype=bool)
    theta2 = _driver_angles(linkage, task.positions)
    state = solve_position(linkage, theta2)
    o2, a, b, p = (complex(scaled.frame.inward(x)) for x in (linkage.o2, state.a[0], state.b[0], state.p[0]))
    points = np.array([o2, kind.o4_of(linkage, b, scaled.frame), a, b, p])
    targets = ExactTargets(scaled.targets, every, scaled.turns, every, timed=False, closure=kind.closure)
    return points, theta2, float(linkage.body_angle), targets


def _driver_angles(linkage: object, positions: FloatArray) -> FloatArray:
    """Where a planted linkage meets its targets, by a dense look and bisection of the step."""
    grid, step = np.linspace(-np.pi, np.pi, 20_001), 2 * np.pi / 20_000
    found = grid[_miss(linkage, grid, positions).argmin(axis=1)]
    while step > 1e-16:
        near = found[:, None] + step * np.linspace(-1, 1, 21)
        found = np.take_along_axis(near, _miss(linkage, near, positions).argmin(axis=1)[:, None], 1)[:, 0]
        step /= 8
    return found


def _miss(linkage: object, theta2: FloatArray, positions: FloatArray) -> FloatArray:
    gap = solve_position(linkage, theta2).p - positions[:, None]  # type: ignore[arg-type]
    miss: FloatArray = np.hypot(gap[..., 0], gap[..., 1])
    return miss


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("mechanism", SLIDERS)
def test_derivatives(mechanism: str, seed: int) -> None:
    points, theta2, body_angle, targets = planted(mechanism, seed)
    arm = (points[4] - points[2]) * abs(points[3] - points[2]) / (points[3] - points[2])
    numbers = [*targets.closure.dimensions(points), arm.real, arm.imag, body_angle, *theta2]
    unknowns, gaps, signs = np.array(numbers), theta2 - theta2[0], np.ones(len(theta2))
    _, missed, jacobian = _linearised(unknowns, gaps, signs, targets)
    assert np.abs(missed).max() < 1e-7
    for column, slope in enumerate(_spread(jacobian, targets).T):
        step = 1e-6 * np.eye(len(unknowns))[column]
        ahead, behind = (_linearised(unknowns + s * step, gaps, signs, targets)[1] for s in (1, -1))
        np.testing.assert_allclose((ahead - behind) / 2e-6, slope, atol=1e-6 * (1 + np.abs(slope).max()))


@pytest.mark.parametrize("timed", [False, True])
@pytest.mark.parametrize("mechanism", SLIDERS)
def test_targets_are_met_to_rounding(mechanism: str, timed: bool) -> None:
    for seed in range(8):
        points, theta2, body_angle, targets = planted(mechanism, seed, 3)
        targets, rng = replace(targets, timed=timed), np.random.default_rng(seed)
        near = points + 1e-4 * (rng.normal(size=5) + 1j * rng.normal(size=5))
        moved = polish_path(near, theta2 + (0 if timed else 1e-4), body_angle, np.ones(3), targets)
        assert moved.error < 1e-13
        assert np.abs(moved.points - points).max() < 0.02
