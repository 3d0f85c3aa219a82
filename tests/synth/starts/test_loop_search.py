"""The batched search: feasible by construction, placed best, and its derivatives are right."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from batched_search import GENEROUS, differences, least_found, points_along

from grashof.analysis.judge.planted import planted_path
from grashof.problems import Box, Problem, Requirements
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.quantities.kinds import FOUR_BAR
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.closed_loop import Batch, SearchTargets
from grashof.synth.starts.loop_search import PULL, Placed, draw, fitting, improve
from grashof.synth.starts.loop_search import place as place_batch

# Rotatability, order, same_branch, timed.
KINDS = [
    ("full-crank", True, True, False),
    ("full-crank", False, False, True),
    ("crank-rocker", True, False, False),
    ("crank-rocker", False, True, True),
    ("double-crank", False, True, False),
    ("double-crank", True, True, True),
    ("any", False, True, False),
    ("any", True, True, True),
    ("any", True, False, False),
]
CRANKS = [kind for kind in KINDS if kind[0] != "any"]


def target_of(kind: tuple[str, bool, bool, bool], n: int = 7, seed: int = 0, **wanted: Any) -> SearchTargets:
    """Points at random along a curve, none of them special, with weights."""
    rotatability, order, branch, timed = kind
    rng = np.random.default_rng([5, seed])
    points = points_along(np.linspace(0, 4, n), rng)
    timing = np.concatenate([[0.0], np.cumsum(rng.uniform(0.2, 0.8, n - 1))]) if timed else np.zeros(n)
    limits = GENEROUS | {"rotatability": rotatability, "order": order, "same_branch": branch} | wanted
    free = np.zeros(n)
    return SearchTargets(points, rng.uniform(0.5, 2, n), free, free, timing, Requirements(**limits), FOUR_BAR)


def place(target: SearchTargets, batch: Batch) -> Placed:
    with np.errstate(all="ignore"):  # loops that do not close
        return place_batch(target, batch)


def cost_of(target: SearchTargets, batch: Batch) -> FloatArray:
    return np.nan_to_num(fitting(target)(batch)[0], nan=np.inf)


def draws(target: SearchTargets, count: int = 60, seed: int = 1) -> Batch:
    """Drawn linkages whose loop closes at all points."""
    batch = draw(target, 20 * count, np.random.default_rng(seed))
    closing = np.flatnonzero(np.isfinite(place(target, batch).error))
    return batch[closing[:count]]


def lengths_of(target: SearchTargets, batch: Batch) -> FloatArray:
    """r1 to r4 of placed linkages, shape (4, n), from their first position."""
    placed = place(target, batch)
    a, b = placed.a[:, 0], placed.b[:, 0]
    return np.abs([placed.o4 - placed.o2, a - placed.o2, b - a, b - placed.o4])


@pytest.mark.parametrize("kind", CRANKS)
def test_draws_are_full_cranks(kind: tuple[str, bool, bool, bool]) -> None:
    target = target_of(kind)
    batch = draw(target, 300, np.random.default_rng(0))
    placed = place(target, batch)
    sound = np.isfinite(placed.error)
    assert sound.mean() > 0.95  # but for numbers at the edge of precision
    r1, r2, r3, r4 = lengths_of(target, batch)[:, sound]
    angle = np.linspace(0, 2 * np.pi, 721)[:, None]
    diagonal = np.abs(r1 - r2 * np.exp(1j * angle))
    tight = 1e-9 * (r1 + r2 + r3 + r4)
    assert (diagonal <= r3 + r4 + tight).all()
    assert (diagonal >= np.abs(r3 - r4) - tight).all()
    shortest = np.argmin([r1, r2, r3, r4], axis=0)
    only = {"crank-rocker": {1}, "double-crank": {0}}.get(kind[0], {0, 1})
    assert set(shortest.tolist()) == only


@pytest.mark.parametrize("kind", CRANKS)
def test_draws_have_the_margin_wherever_their_driver_leaves_room(kind: tuple[str, bool, bool, bool]) -> None:
    target = target_of(kind, rotatability_margin=0.02)
    r1, r2, r3, r4 = lengths_of(target, draws(target, 300))
    least = 0.02 * (r1 + r2 + r3 + r4)
    assert (r3 + r4 - r1 - r2 >= least * (1 - 1e-9)).all()
    room = np.abs(r1 - r2) > least
    assert 0.6 < room.mean() < 1
    assert (np.abs(r1 - r2) - np.abs(r3 - r4) >= least * (1 - 1e-9))[room].all()
    np.testing.assert_allclose(r3[~room], r4[~room], rtol=1e-9)


@pytest.mark.parametrize("mu", [20, 60])
@pytest.mark.parametrize("kind", CRANKS)
def test_draws_transmit_all_round_the_turn(kind: tuple[str, bool, bool, bool], mu: float) -> None:
    """By construction, and with the margin; the least angles come close to the required one."""
    target = target_of(kind, transmission_min_deg=mu, transmission_over="cycle", rotatability_margin=0.01)
    r1, r2, r3, r4 = lengths_of(target, draws(target, 300))
    diagonal = np.abs(r1 - r2 * np.exp(1j * np.linspace(0, 2 * np.pi, 721)[:, None]))
    angle = np.degrees(np.arccos((r3**2 + r4**2 - diagonal**2) / (2 * r3 * r4)))
    least = np.minimum(angle, 180 - angle).min(axis=0)
    assert least.min() == pytest.approx(mu, abs=1.0)
    assert least.min() >= mu - 1e-6
    shares = np.array([r3 + r4 - r1 - r2, np.abs(r1 - r2) - np.abs(r3 - r4)]) / (r1 + r2 + r3 + r4)
    assert shares.min() >= 0.01 - 1e-9
    assert {"crank-rocker": r2 < r1, "double-crank": r2 > r1}.get(kind[0], r2 > 0).all()


@pytest.mark.parametrize(
    ("mu", "over", "closed", "rotatability", "by_construction"),
    [
        (20, "cycle", False, "full-crank", True),
        (20, "task", True, "full-crank", True),
        (20, "task", False, "full-crank", False),
        (0, "cycle", True, "full-crank", False),
        (20, "cycle", False, "any", False),
        (89, "cycle", False, "full-crank", False),
    ],
)
def test_where_the_angle_is_by_construction(
    mu: float, over: str, closed: bool, rotatability: str, by_construction: bool
) -> None:
    """Elsewhere the same draws are the same linkages as without a required angle."""
    kind = rotatability, True, True, False
    target = replace(target_of(kind, transmission_min_deg=mu, transmission_over=over), closed=closed)
    without = target_of(kind)
    assert target.transmitting == by_construction
    assert not replace(target, exact=True).transmitting
    batch = draw(without, 50, np.random.default_rng(0))
    same = np.array_equal(lengths_of(target, batch), lengths_of(without, batch), equal_nan=True)
    assert same != by_construction


@pytest.mark.parametrize("kind", KINDS)
def test_draws_are_in_order_and_of_one_assembly(kind: tuple[str, bool, bool, bool]) -> None:
    _, order, branch, timed = kind
    target = target_of(kind)
    batch = draws(target)
    assert len(batch) == 60
    placed = place(target, batch)
    assert set(batch.direction.tolist()) == {-1.0, 1.0}
    steps = batch.direction[:, None] * np.diff(placed.theta2, axis=1)
    if order and not timed:
        assert (steps > 0).all()
        assert (steps.sum(axis=1) < 2 * np.pi).all()
    if timed:
        np.testing.assert_allclose(steps, np.tile(np.diff(target.timing), (60, 1)), atol=1e-12)
    if not order and not timed:
        assert (steps < 0).any(axis=1).mean() > 0.9
    side = np.sign(((placed.b - placed.a).conj() * (placed.b - placed.o4[:, None])).imag)
    np.testing.assert_array_equal(side, batch.assembly)
    if branch:
        assert (side == side[:, :1]).all()
    else:
        assert (side != side[:, :1]).any(axis=1).mean() > 0.9
    assert set(side.ravel().tolist()) == {-1.0, 1.0}


@pytest.mark.parametrize("kind", KINDS)
def test_placed_linkages_are_rigid_and_p_is_their_coupler_point(kind: tuple[str, bool, bool, bool]) -> None:
    target = target_of(kind)
    batch = draws(target)
    placed = place(target, batch)
    o2, o4 = placed.o2[:, None], placed.o4[:, None]
    arm = (placed.p - placed.a) / (placed.b - placed.a)
    a_arm = (placed.a - o2) / np.abs(placed.a - o2)
    for constant in (np.abs(placed.a - o2), np.abs(placed.b - placed.a), np.abs(placed.b - o4), arm):
        assert (np.abs(constant - constant[:, :1]) <= 1e-8 * np.abs(constant[:, :1])).all()
    np.testing.assert_allclose(np.exp(1j * placed.theta2), a_arm, atol=1e-8)
    off = (target.weights * np.abs(placed.p - target.points) ** 2).sum(axis=1)
    np.testing.assert_allclose(placed.error, off, rtol=1e-6)


@pytest.mark.parametrize("kind", KINDS)
def test_no_other_place_or_coupler_point_fits_better(kind: tuple[str, bool, bool, bool]) -> None:
    """Complex least squares of the points over 1, O2A and AB, as the placed linkage has them."""
    target = target_of(kind)
    batch = draws(target)
    placed, root = place(target, batch), np.sqrt(target.weights)
    for i in range(len(batch)):
        driver, coupler = placed.a[i] - placed.o2[i], placed.b[i] - placed.a[i]
        basis = np.stack([np.ones(len(driver)), driver / driver[0], coupler / coupler[0]], axis=1)
        z, *_ = np.linalg.lstsq(basis * root[:, None], target.points * root, rcond=None)
        fit: ComplexArray = basis @ z
        least = (target.weights * np.abs(fit - target.points) ** 2).sum()
        assert placed.error[i] == pytest.approx(least, rel=1e-7)
        np.testing.assert_allclose(placed.p[i], fit, atol=1e-6)


@pytest.mark.parametrize(("kind", "mu"), [*((kind, 0) for kind in KINDS), *((kind, 30) for kind in CRANKS)])
def test_the_gradient_is_that_of_differences(kind: tuple[str, bool, bool, bool], mu: float) -> None:
    """Kaufman's Jacobian leaves a term out that is orthogonal to the residual."""
    target = target_of(
        kind, rotatability_margin=0.05, transmission_min_deg=mu, transmission_over="cycle" if mu else "task"
    )
    batch = draws(target, 160)
    _, residual, _ = fitting(target)(batch)
    batch = batch[(residual[:, 2 * len(target.points) :] == 0).all(axis=1)]  # on which no pull acts
    assert len(batch) >= 25
    cost, residual, jacobian = fitting(target)(batch)
    np.testing.assert_allclose(cost, (residual**2).sum(axis=1), rtol=1e-9)
    gradient = 2 * (np.swapaxes(jacobian, 1, 2) @ residual[..., None])[..., 0]
    expected = differences(fitting(target), batch, 0)
    scale = np.abs(expected).max(axis=1, keepdims=True) + cost[:, None]
    good = (np.abs(gradient - expected) < 1e-4 * scale).all(axis=1)
    assert good.mean() > 0.9  # close to where the loop opens differences fail
    assert np.median(np.abs(gradient - expected) / scale) < 1e-7


TIGHT: dict[str, Any] = {
    "link_length": (0.5, 0.8), "link_ratio_max": 1.2, "coupler_arms": (0.0, 0.3),
    "o2": Box((3, 4), (-9, -8)), "o4": Box((-4, -3), (7, 8)),
}  # fmt: skip


@pytest.mark.parametrize("kind", [KINDS[0], KINDS[4], KINDS[7]])
def test_pulls_have_the_derivatives_of_differences_where_the_fit_is_exact(
    kind: tuple[str, bool, bool, bool],
) -> None:
    checked = 0
    for seed in range(8):
        wide, tight = target_of(kind, seed=seed), target_of(kind, seed=seed, **TIGHT)
        batch = draws(wide, 10, seed)[np.array([0])]
        mine = replace(tight, points=place(wide, batch).p[0])
        cost, residual, jacobian = fitting(mine)(batch)
        n = 2 * len(mine.points)
        assert np.abs(residual[:, :n]).max() < 1e-9
        assert (residual[:, n:] != 0).sum() >= 5
        assert cost[0] == pytest.approx((residual[:, n:] ** 2).sum(), rel=1e-6)
        expected = differences(fitting(mine), batch, 1)
        if np.abs(expected).max() < 100:
            np.testing.assert_allclose(jacobian, expected, atol=1e-5 * np.abs(expected).max())
            checked += 1
    assert checked >= 4


def test_pulls_count_what_oversteps() -> None:
    target = target_of(KINDS[0], **TIGHT)
    batch = draws(target)
    placed = place(target, batch)
    lengths = lengths_of(target, batch)
    _, residual, _ = fitting(target)(batch)
    pull = residual[:, 2 * len(target.points) :] / PULL
    over = np.maximum(np.log(lengths / 0.8), 0) - np.maximum(np.log(0.5 / lengths), 0)
    np.testing.assert_allclose(pull[:, :4], over.T, atol=1e-8)
    ratio = np.log(lengths.max(axis=0) / lengths.min(axis=0) / 1.2)
    np.testing.assert_allclose(pull[:, 6], np.maximum(ratio, 0), atol=1e-8)
    for column, pivot in zip(pull[:, 4:6].T, (placed.a, placed.b), strict=True):
        arm = np.abs(placed.p[:, 0] - pivot[:, 0]) - 0.3
        np.testing.assert_allclose(column, np.maximum(arm, 0), atol=1e-8)
    o2, o4 = placed.o2, placed.o4
    sides = ((o2.real, 3, 4), (o2.imag, -9, -8), (o4.real, -4, -3), (o4.imag, 7, 8))
    for column, (value, low, high) in zip(pull[:, 7:].T, sides, strict=True):
        np.testing.assert_allclose(
            column, np.maximum(value - high, 0) - np.maximum(low - value, 0), atol=1e-8
        )


@pytest.mark.parametrize("kind", KINDS)
def test_improving_never_makes_worse(kind: tuple[str, bool, bool, bool]) -> None:
    target = target_of(kind)
    batch = draw(target, 80, np.random.default_rng(2))
    begun, before = cost_of(target, batch), batch.unknowns.copy()
    for steps in (1, 5, 20):
        after, error = improve(fitting(target), batch, steps, 0.0)
        error = np.nan_to_num(error, nan=np.inf)
        assert (error <= begun).all()
        np.testing.assert_allclose(cost_of(target, after), error, rtol=1e-12)
        np.testing.assert_array_equal(after.assembly, batch.assembly)
    sound = np.isfinite(begun)
    assert np.median(error[sound] / begun[sound]) < (0.8 if kind[3] else 0.4)
    np.testing.assert_array_equal(before, batch.unknowns)


def test_it_stops_when_as_many_as_wanted_are_good_enough() -> None:
    target = target_of(KINDS[0], 5)
    batch = draws(target, 40)
    _, few = improve(fitting(target), batch, 60, 1e-3, until=5)
    _, many = improve(fitting(target), batch, 60, 1e-3, until=20)
    assert 5 <= np.count_nonzero(few <= 1e-3) < np.count_nonzero(many <= 1e-3)
    assert np.count_nonzero(many <= 1e-3) >= 20


@pytest.mark.parametrize(("points", "timed"), [(9, False), (6, True), (24, True)])
def test_planted_curves_are_found_within_a_few_rounds(points: int, timed: bool) -> None:
    task, _ = planted_path(np.random.default_rng([11, 0]), points, timed=timed)
    scaled = ScaledProblem.of(Problem(task=task, requirements=Requirements(link_ratio_max=50.0)))
    assert least_found(scaled, 1e-6) < 1e-6
