"""Inexact dimensions: derivatives against differences, shares against their exact values."""

from dataclasses import replace
from itertools import product
from math import erf, sqrt

import numpy as np
import pytest
from loaded_linkages import JACK

from grashof.analysis import Verdict, driver_ranges, made_moves, solve_position, verify
from grashof.analysis.judge.planted import (
    planted_motion,
    planted_path,
    random_full_crank,
    uneven_driver_angles,
)
from grashof.analysis.judge.tolerance import (
    SAMPLES,
    dimension_errors,
    made_linkages,
    measured_sensitivity,
    robustness,
    sensitivity,
    yield_linear,
    yield_monte_carlo,
)
from grashof.problems import FourBar, Manufacturing, MotionTask, PathTask, Requirements, Task
from grashof.problems.values.arrays import FloatArray

ANY = Requirements(
    exact=False, rotatability="any", order=False, same_branch=False,  # type: ignore[arg-type]
    link_length=(0, 1e3), coupler_arms=(0, 1e3), link_ratio_max=1e6,
)  # fmt: skip
CRANK_ROCKER = FourBar(o2=(1, 2), o4=(5, 2), r2=1, r3=4.1, r4=3, coupler_point=(2, 1), body_angle=0.4)


def made(linkage: FourBar, dimensions: FloatArray) -> FourBar:
    """The linkage with dimensions r1, r2, r3, r4, u, v of its own and all else as it is."""
    r1, r2, r3, r4, u, v = dimensions
    ground = r1 * np.array([np.cos(linkage.theta1), np.sin(linkage.theta1)])
    return FourBar(linkage.o2, linkage.o2 + ground, r2, r3, r4, (u, v), linkage.assembly, linkage.body_angle)


def nominal(linkage: FourBar) -> FloatArray:
    return np.concatenate([linkage.lengths, linkage.coupler_point])


def poses_of(
    linkage: FourBar, theta2: FloatArray, angle_length: float | None = None
) -> tuple[MotionTask, Verdict]:
    state = solve_position(linkage, theta2)
    task = MotionTask(state.p, state.theta3 + linkage.body_angle, angle_length=angle_length)
    return task, verify(linkage, task, replace(ANY, order=True, same_branch=True))


def moves_one_by_one(linkage: FourBar, task: Task, verdict: Verdict, errors: FloatArray) -> FloatArray:
    """Move of the worst target of each made linkage, shape (S,); NaN where it cannot be assembled."""
    length = task.angle_length if isinstance(task, MotionTask) else 0.0
    first = solve_position(linkage, verdict.theta2, verdict.assembly)
    worst = []
    for error in errors:
        state = solve_position(made(linkage, nominal(linkage) + error), verdict.theta2, verdict.assembly)
        turned = np.angle(np.exp(1j * (state.theta3 - first.theta3)))
        worst.append(np.hypot(np.hypot(*(state.p - first.p).T), length * turned).max())
    return np.array(worst)


def standard_error(share: float, samples: int = SAMPLES) -> float:
    return sqrt(share * (1 - share) / samples)


def test_a_square_by_hand() -> None:
    """P at B, all angles right: only r2, r4, u and v reach it; the coupler turns by (dr4 - dr2)/2."""
    square = FourBar(o2=(0, 0), o4=(2, 0), r2=2, r3=2, r4=2, coupler_point=(2, 0), assembly=1)
    expected = [
        # r1 r2 r3 r4 u v
        [0, 0, 0, 0, 1, 0],  # x: with r1 or r3, B moves along AB, but P keeps its distance from A
        [0, 0, 0, 1, 0, 1],  # y: a longer crank lifts A and turns P back
        [0, -0.5, 0, 0.5, 0, 0],
    ]
    np.testing.assert_allclose(sensitivity(square, np.pi / 2), expected, atol=1e-15)


def test_batches_are_their_linkages() -> None:
    rng = np.random.default_rng(3)
    single = [random_full_crank(rng) for _ in range(4)]
    batch = FourBar(*(np.stack([getattr(each, name) for each in single]) for name in FourBar.__slots__))
    theta2 = uneven_driver_angles(rng, 3)
    found = sensitivity(batch[:, None], theta2)
    assert found.shape == (4, 3, 3, 6)
    for each, rows in zip(single, found, strict=True):
        np.testing.assert_allclose(rows, sensitivity(each, theta2), rtol=1e-13, atol=1e-13)


def test_towards_a_dead_position_moves_have_no_bound() -> None:
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=3, r3=2, r4=2.5, coupler_point=(1, 0.5))
    dead = np.arccos((16 + 9 - 4.5**2) / 24)  # A-O4 stretched to r3 + r4
    near = np.abs(sensitivity(rocker, dead - np.array([1e-2, 1e-4, 1e-6]))).max(axis=(1, 2))
    np.testing.assert_allclose(near[1:] / near[:-1], 10, rtol=0.05)  # as 1 / sqrt(distance)
    assert np.isnan(sensitivity(rocker, dead + 0.1)[:, :4]).any()


def test_errors_have_three_deviations_in_the_tolerance() -> None:
    errors = dimension_errors(Manufacturing(0.3), 200_000, np.random.default_rng(5))
    assert errors.shape == (200_000, len(FourBar.mechanism.dimensions))
    np.testing.assert_allclose(np.cov(errors.T), 0.01 * np.eye(6), atol=2e-4)
    np.testing.assert_allclose(errors.mean(axis=0), 0, atol=1e-3)
    np.testing.assert_allclose((np.abs(errors) <= 0.3).mean(axis=0), 0.9973, atol=5e-4)


def test_made_linkages_deviate_in_their_dimensions_alone() -> None:
    errors = 0.1 * np.random.default_rng(1).standard_normal((5, 6))
    errors[4, 2] = -CRANK_ROCKER.r3 - 1
    batch, possible = made_linkages(CRANK_ROCKER, errors)
    assert possible.tolist() == [True] * 4 + [False]
    for index in range(4):
        np.testing.assert_allclose(
            nominal(batch[index]), nominal(CRANK_ROCKER) + errors[index], rtol=1e-14, atol=1e-14
        )
        assert batch[index].theta1 == pytest.approx(CRANK_ROCKER.theta1, abs=1e-15)
        assert batch[index].o2.tolist() == CRANK_ROCKER.o2.tolist()
        assert batch[index].body_angle == CRANK_ROCKER.body_angle
    assert batch[4] == CRANK_ROCKER


@pytest.mark.quick("1", "4")
@pytest.mark.parametrize("index", range(6))
def test_one_inexact_dimension(index: int) -> None:
    """The worst target moves in proportion: a share of one normal variable."""
    task, verdict = poses_of(CRANK_ROCKER, np.array([0.3, 0.9, 1.5]), angle_length=2.0)
    manufacturing = Manufacturing(1e-3)
    moves = robustness(CRANK_ROCKER, task, verdict, manufacturing).moves
    errors = dimension_errors(manufacturing, SAMPLES, np.random.default_rng(index))
    errors[:, np.arange(6) != index] = 0
    band = 1.2 * manufacturing.deviation * float(moves[index])
    share = erf(1.2 / sqrt(2))
    for found in (
        yield_linear(measured_sensitivity(CRANK_ROCKER, task, verdict), band, errors),
        yield_monte_carlo(CRANK_ROCKER, task, verdict, band, errors),
    ):
        assert found == pytest.approx(share, abs=4 * standard_error(share))


@pytest.mark.parametrize("kind", ["motion", "free path", "timed path"])
def test_shares_are_those_of_linkages_made_one_by_one(kind: str) -> None:
    rng = np.random.default_rng(11)
    task: Task
    if kind == "motion":
        task, linkage = planted_motion(rng, 4)
    else:
        task, linkage = planted_path(rng, 5, timed=kind == "timed path")
    verdict = verify(linkage, task, Requirements(rotatability_margin=0, link_length=(0, 1e3)))
    errors = dimension_errors(Manufacturing(0.02 * task.size), 150, np.random.default_rng(2))
    moves = moves_one_by_one(linkage, task, verdict, errors)
    for band in np.quantile(moves[np.isfinite(moves)], [0.2, 0.5, 0.9]):
        found = yield_monte_carlo(linkage, task, verdict, float(band), errors)
        assert found == pytest.approx(np.mean(moves <= band), abs=1.5 / 150)


@pytest.mark.parametrize(
    ("theta2", "closed"),
    [
        ([2.0, 2.5, np.pi], False),
        ([2.6, 3.6], False),
        ([2.0, 2.5], False),
        ([3.7, 4.0], False),
        ([-0.9, -0.3, 0.5, 1.0], True),
    ],
)
def test_linkages_that_cannot_be_assembled_are_outside(theta2: list[float], closed: bool) -> None:
    """In a band that holds all others; a crank that lacks 0.01 to being stretched dead at theta2 = pi.

    r3 + r4 - r1 - r2 is normal with twice a dimension's deviation.
    """
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=3, r4=2 + 0.01, coupler_point=(1, 1))
    task: Task
    task, verdict = poses_of(linkage, np.array(theta2))
    assert verdict.branch_ok
    if closed:  # a full turn
        task = PathTask(task.positions, closed=True)
        verdict = verify(linkage, task, replace(ANY, order=True, same_branch=True))
        assert verdict.ok
    errors = dimension_errors(Manufacturing(0.03), SAMPLES, np.random.default_rng(4))
    passes = closed or min(theta2) <= np.pi <= max(theta2)
    share = 0.5 * (1 + erf(0.01 / 0.02 / sqrt(2))) if passes else 1.0
    found = yield_monte_carlo(linkage, task, verdict, 1e3, errors)
    assert found == pytest.approx(share, abs=4 * standard_error(share))
    assert yield_linear(measured_sensitivity(linkage, task, verdict), 1e3, errors) == 1.0


def test_targets_on_both_assemblies() -> None:
    """Interpolation only: each target is judged on the assembly that meets it."""
    theta2, signs = np.array([0.3, 0.9, 1.5]), np.array([1, -1, 1])
    state = solve_position(CRANK_ROCKER, theta2, signs)
    task = MotionTask(state.p, state.theta3 + CRANK_ROCKER.body_angle)
    verdict = verify(CRANK_ROCKER, task, ANY)
    assert verdict.assembly.tolist() == signs.tolist()
    found = robustness(CRANK_ROCKER, task, verdict, Manufacturing(1e-4))
    assert 0.05 < found.share_linear < 1
    assert found.share_made == pytest.approx(found.share_linear, abs=1e-3)


def test_moves_are_those_of_the_worst_target() -> None:
    linkage = CRANK_ROCKER
    task, verdict = poses_of(linkage, np.array([0.3, 0.9, 1.5, 2.2]), angle_length=3.0)
    slope = sensitivity(linkage, verdict.theta2, verdict.assembly) * np.array([1, 1, 3])[:, None]
    found = robustness(linkage, task, verdict, Manufacturing(0.2))
    np.testing.assert_allclose(found.moves, np.sqrt((slope**2).sum(axis=1)).max(axis=0), rtol=1e-8)
    worst = max(
        np.linalg.norm(slope[target] @ np.array(signs)) * 0.2
        for target, signs in product(range(4), product((1, -1), repeat=6))
    )
    assert found.worst_move == pytest.approx(worst, rel=1e-8)
    assert found.moves.max() * 0.2 < found.worst_move <= found.moves.sum() * 0.2 * (1 + 1e-12)
    path = PathTask(task.positions)
    of_points = robustness(linkage, path, verdict, Manufacturing(0.2))
    np.testing.assert_allclose(
        of_points.moves, np.sqrt((slope[:, :2] ** 2).sum(axis=1)).max(axis=0), rtol=1e-8
    )
    assert of_points.share_made > found.share_made


def test_a_long_path() -> None:
    theta2 = np.linspace(0.2, 5.0, 600)
    task = PathTask(solve_position(CRANK_ROCKER, theta2).p)
    verdict = replace(poses_of(CRANK_ROCKER, theta2)[1], theta2=theta2, assembly=np.ones(600, dtype=int))
    found = robustness(CRANK_ROCKER, task, verdict, Manufacturing(0.05, band=0.08))
    assert found.share_made == pytest.approx(found.share_linear, abs=0.01)
    assert found.share_made * 1000 == pytest.approx(round(found.share_made * 1000))


def inside(linkage: FourBar) -> np.ndarray:
    low, high = driver_ranges(linkage)[0]
    return low + (high - low) * np.linspace(0.07, 0.91, 15)


def test_the_worst_is_the_worst_of_all_made_linkages() -> None:
    theta2, tolerance = inside(JACK), 1e-5
    moves = made_moves(JACK, theta2, tolerance)
    corners = tolerance * np.array(list(product((1.0, -1.0), repeat=6)))
    rng = np.random.default_rng(3)
    errors = np.concatenate([corners, rng.uniform(-tolerance, tolerance, (2000, 6))])
    made, _ = made_linkages(JACK, errors)
    states, nominal = solve_position(made[:, None], theta2), solve_position(JACK, theta2)
    way = np.hypot(*np.moveaxis(states.p - nominal.p, -1, 0))
    np.testing.assert_allclose(moves.point_worst, way.max(axis=0), rtol=1e-3)
    np.testing.assert_allclose(
        moves.theta4_worst, np.abs(states.theta4 - nominal.theta4).max(axis=0), rtol=1e-3
    )


def test_the_rms_is_that_of_independent_deviations() -> None:
    theta2, deviation = inside(JACK), 1e-5
    moves = made_moves(JACK, theta2, deviation)
    made, _ = made_linkages(JACK, np.random.default_rng(5).normal(0, deviation, (20_000, 6)))
    states, nominal = solve_position(made[:, None], theta2), solve_position(JACK, theta2)
    square = ((states.p - nominal.p) ** 2).sum(axis=-1).mean(axis=0)
    np.testing.assert_allclose(moves.point_rms, np.sqrt(square), rtol=0.03)
    turned = ((states.theta4 - nominal.theta4) ** 2).mean(axis=0)
    np.testing.assert_allclose(moves.theta4_rms, np.sqrt(turned), rtol=0.03)


def test_a_point_on_the_crank_knows_the_crank_alone() -> None:
    at_a = made_moves(replace(JACK, coupler_point=(0.0, 0.0)), [0.3, 2.0], 0.1)
    np.testing.assert_allclose(at_a.point, np.array([[0, 0.1, 0, 0, 0.1, 0.1]] * 2), atol=1e-15)
    assert np.isnan(made_moves(FourBar((0, 0), (4, 0), 2, 2, 3), np.pi, 0.1).point_worst)
    assert made_moves(JACK, 1.0, 0.2).point_rms == pytest.approx(2 * made_moves(JACK, 1.0, 0.1).point_rms)
