"""The batched search for poses: angles of the body among the residuals, and planted motions."""

from dataclasses import replace

import numpy as np
import pytest
from batched_search import GENEROUS, differences, least_found, points_along
from scipy.optimize import minimize_scalar

from grashof.analysis.judge.planted import planted_motion
from grashof.problems import MotionTask, Problem, Requirements
from grashof.problems.values.arrays import FloatArray
from grashof.synth.quantities.kinds import FOUR_BAR
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.closed_loop import Batch, Loop, SearchTargets, body_turns
from grashof.synth.starts.coupler_search import FOUND
from grashof.synth.starts.loop_search import draw, fitting, improve, place

KINDS = [("full-crank", True, True), ("double-crank", True, False), ("any", False, True)]
N = 7


def target_of(kind: tuple[str, bool, bool], free: str, seed: int = 0) -> SearchTargets:
    """Poses at random along a curve, with weights; of some of them nothing but the place or the angle."""
    rotatability, order, branch = kind
    rng = np.random.default_rng([51, seed])
    along = np.linspace(0, 4, N)
    points = points_along(along, rng)
    weights, turn_weights = rng.uniform(0.5, 2, N), rng.uniform(0.2, 2, N)
    if free in ("angles", "both"):
        turn_weights[[1, 4]] = 0
    if free in ("places", "both"):
        weights[[0, 3]] = 0
    limits = GENEROUS | {"rotatability": rotatability, "order": order, "same_branch": branch}
    turns = 0.3 * along + rng.normal(0, 0.2, N) + 2.5  # past a half turn for some
    return SearchTargets(
        np.where(weights > 0, points, 0),
        weights,
        np.where(turn_weights > 0, turns, 0),
        turn_weights,
        np.zeros(N),
        Requirements(**limits),
        FOUR_BAR,
    )


def draws(target: SearchTargets, count: int, seed: int = 1) -> Batch:
    """Drawn linkages whose loop closes at all points, and well."""
    batch = draw(target, 40 * count, np.random.default_rng(seed))
    with np.errstate(all="ignore"):
        sound = np.isfinite(place(target, batch).error)
    return batch[np.flatnonzero(sound)[:count]]


def turned_of(target: SearchTargets, batch: Batch) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Directions of AB of placed linkages (n, N), their body angle (n,), and the error of the places (n,)."""
    placed = place(target, batch)
    coupler = np.angle(placed.b - placed.a)
    gap = (target.weights * np.abs(placed.p - target.points) ** 2).sum(axis=1)
    return coupler, placed.body_angle, gap


def missed(target: SearchTargets, coupler: FloatArray, body_angle: FloatArray) -> FloatArray:
    off = np.angle(np.exp(1j * (coupler + body_angle - target.turns)))
    square: FloatArray = (target.turn_weights * off**2).sum(axis=-1)
    return square


FREE = ["none", "angles", "places", "both"]


@pytest.mark.parametrize("free", FREE)
@pytest.mark.parametrize("kind", KINDS)
def test_the_error_is_that_of_places_and_angles_as_placed(kind: tuple[str, bool, bool], free: str) -> None:
    target = target_of(kind, free)
    batch = draws(target, 40)
    coupler, body_angle, gap = turned_of(target, batch)
    expected = gap + missed(target, coupler, body_angle[:, None])
    # Turned by nearly half a turn, an angle may be counted the longer way round.
    off = np.abs(np.angle(np.exp(1j * (coupler + body_angle[:, None] - target.turns))))
    near = (off * (target.turn_weights > 0)).max(axis=1) < 0.7 * np.pi
    assert near.mean() > 0.3
    cost, residual, _ = fitting(target)(batch)
    np.testing.assert_allclose((residual**2).sum(axis=1), cost, rtol=1e-9)
    for error in (place(target, batch).error, cost):
        assert (error >= expected * (1 - 1e-6)).all()
        np.testing.assert_allclose(error[near], expected[near], rtol=1e-6)


@pytest.mark.parametrize("free", ["none", "both"])
@pytest.mark.parametrize("kind", [KINDS[0], KINDS[-1]])
def test_no_other_body_angle_is_better(kind: tuple[str, bool, bool], free: str) -> None:
    """Where angles are missed by less than a quarter turn, the only least one; brute force about it."""
    target = target_of(kind, free)
    batch = draws(target, 300)
    coupler, body_angle, _ = turned_of(target, batch)
    scan = np.linspace(-np.pi, np.pi, 721)
    checked = 0
    for i in range(len(batch)):
        off = np.angle(np.exp(1j * (coupler[i] + body_angle[i] - target.turns)))[target.turn_weights > 0]
        if np.abs(off).max() > np.pi / 2:
            continue
        around = missed(target, coupler[i], scan[:, None])
        begin = scan[np.argmin(around)]

        def square(angle: float, i: int = i) -> float:
            return float(missed(target, coupler[i], np.array(angle)))

        best = minimize_scalar(square, bounds=(begin - 0.02, begin + 0.02), method="bounded",
                               options={"xatol": 1e-12})  # fmt: skip
        assert square(float(body_angle[i])) <= best.fun * (1 + 1e-9) + 1e-14
        assert abs(np.exp(1j * best.x) - np.exp(1j * body_angle[i])) < 1e-5
        checked += 1
    assert checked >= 20


def test_the_weighted_mean_is_taken_across_the_half_turn() -> None:
    """Angles of +179 and -179 deg lie 2 deg apart."""
    target = target_of(KINDS[0], "none")
    batch = draws(target, 5)
    loop = Loop.of(target, batch)
    about = np.angle(loop.e3[0]) + np.pi  # of the coupler of the first, turned by half a turn
    turns = np.angle(np.exp(1j * (about + 0.02 * np.arange(N))))
    residual, body_angle = body_turns(replace(target, turns=turns), loop)
    weights = target.turn_weights
    mean = 0.02 * (weights * np.arange(N)).sum() / weights.sum()
    np.testing.assert_allclose(np.exp(1j * body_angle[0]), -np.exp(1j * mean), atol=1e-12)
    expected = np.sqrt(weights) * (0.02 * np.arange(N) - mean)
    np.testing.assert_allclose(residual[0], expected, atol=1e-12)


@pytest.mark.parametrize("free", FREE)
@pytest.mark.parametrize("kind", KINDS)
def test_angles_have_the_derivatives_of_differences(kind: tuple[str, bool, bool], free: str) -> None:
    """The rows of the angles have no approximation in them; the gradient is that of the full cost."""
    target = target_of(kind, free)
    batch = draws(target, 40)
    cost, residual, jacobian = fitting(target)(batch)
    rows = slice(2 * N, 3 * N)
    expected = differences(fitting(target), batch, 1)[:, rows]
    scale = np.abs(expected).max(axis=(1, 2), keepdims=True) + 1e-3
    smooth = np.abs(expected).max(axis=(1, 2)) < 1e3  # no angle at its half turn, no loop about to open
    assert smooth.mean() > 0.8
    gap = (np.abs(jacobian[:, rows] - expected) / scale)[smooth]
    assert np.median(gap.max(axis=(1, 2))) < 1e-7
    assert (gap.max(axis=(1, 2)) < 1e-4).mean() > 0.9
    gradient = 2 * (np.swapaxes(jacobian, 1, 2) @ residual[..., None])[..., 0]
    by_difference = differences(fitting(target), batch, 0)
    size = np.abs(by_difference).max(axis=1, keepdims=True) + cost[:, None]
    near = (np.abs(gradient - by_difference) < 1e-4 * size).all(axis=1)
    assert near[smooth].mean() > 0.9
    none = np.flatnonzero(target.turn_weights == 0)
    assert (residual[:, 2 * N + none] == 0).all()
    assert (jacobian[:, 2 * N + none] == 0).all()


def test_improving_never_makes_worse_and_gains() -> None:
    for free in FREE:
        target = target_of(KINDS[0], free)
        batch = draws(target, 60)
        begun = place(target, batch).error
        after, error = improve(fitting(target), batch, 25, 0.0)
        assert (error <= begun).all()
        assert np.median(error / begun) < 0.3
        np.testing.assert_allclose(fitting(target)(after)[0], error, rtol=1e-12)


def test_steps_count_what_both_neighbours_give() -> None:
    target = target_of(KINDS[0], "both")
    heaviest = np.sqrt(target.turn_weights.max())
    for k, step in enumerate(target.steps):
        square = 0.0
        if target.weights[k] > 0 < target.weights[k + 1]:
            square += abs(target.points[k + 1] - target.points[k]) ** 2
        if target.turn_weights[k] > 0 < target.turn_weights[k + 1]:
            turned = np.angle(np.exp(1j * (target.turns[k + 1] - target.turns[k])))
            square += (heaviest * turned) ** 2
        assert step == pytest.approx(np.sqrt(square), rel=1e-12) or (square == 0 and 0 < step < 0.01)


def freed(task: MotionTask, places: list[int], angles: list[int]) -> MotionTask:
    positions, turned = task.positions.copy(), task.angles.copy()
    positions[places], turned[angles] = np.nan, np.nan
    return MotionTask(positions, turned)


@pytest.mark.parametrize(
    ("poses", "places", "angles"), [(12, [], []), (7, [], [1, 2, 4, 5]), (5, [2], []), (9, [2, 5], [1, 4])]
)
def test_planted_motions_are_found_within_a_few_rounds(
    poses: int, places: list[int], angles: list[int]
) -> None:
    task, _ = planted_motion(np.random.default_rng([52, 0]), poses)
    wanted = Requirements(exact=False, link_ratio_max=50.0)
    scaled = ScaledProblem.of(Problem(task=freed(task, places, angles), requirements=wanted))
    assert least_found(scaled, FOUND) < FOUND
