"""Rounds of starts for path generation: reproducible, feasible, on their targets where that is required."""

from collections.abc import Callable
from itertools import islice
from typing import Any

import numpy as np
import pytest

from grashof.problems import Box, FourBar, PathTask, Problem, Requirements
from grashof.synth.programme.start import Round, Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import GROUPS, Screened
from grashof.synth.search.finder import finder_for, rounds
from grashof.synth.starts import coupler_search
from grashof.synth.starts.closed_loop import SearchTargets
from grashof.synth.starts.coupler_search import search

PathSetup = Callable[..., tuple[ScaledProblem, FourBar]]

ELLIPSE = [
    [20, 10], [17.66, 15.142], [11.736, 17.878], [5, 16.928], [0.60307, 12.736], [0.60307, 7.2638],
    [5, 3.0718], [11.736, 2.1215], [17.66, 4.8577],
]  # fmt: skip
LINE = [[20.0, 20 + 5.0 * k] for k in range(6)]


def setup_of(
    points: list[list[float]], closed: bool = False, timing: Any = None, **wanted: Any
) -> ScaledProblem:
    task = PathTask.from_degrees(points, closed=closed, timing_deg=timing)
    return ScaledProblem.of(Problem(task=task, requirements=Requirements(**wanted)))


def first_rounds(scaled: ScaledProblem, count: int, enough: int = 5, seed: int = 0) -> list[Round]:
    finder, rng = finder_for(scaled), np.random.default_rng(seed)
    return list(islice(rounds(finder, lambda number: finder.round(number, enough, rng, 1)), count))


def finds_of(scaled: ScaledProblem, enough: int = 5, seed: int = 0) -> Screened:
    return search(scaled, enough, np.random.default_rng(seed))


def check_tracks(scaled: ScaledProblem, starts: list[Start], error: float) -> None:
    """Points and angles of starts belong together, and lead past the targets."""
    for start in starts:
        a, b, p = start.track
        at_first = start.visit.index(0)
        np.testing.assert_allclose([a[at_first], b[at_first], p[at_first]], start.points[2:], atol=1e-6)
        np.testing.assert_allclose(np.abs(b - start.o4), start.lengths[3], atol=1e-6)
        off = np.abs(p - scaled.targets[list(start.visit)])
        assert np.sqrt(np.mean(off**2)) < error
        assert np.abs(np.diff(start.theta3)).max() < np.pi


def test_a_family_has_feasible_starts_that_are_apart() -> None:
    scaled = setup_of(LINE, link_length=(5, 60), rotatability="crank-rocker")
    (first,) = first_rounds(scaled, 1, enough=20)
    starts = first.starts
    assert first.counts["feasible finds"] >= len(starts) > 20
    assert not any(start.terms.settled for start in starts)
    check_tracks(scaled, starts, 1e-5)
    scale = scaled.frame.scale
    for start in starts:
        r2 = start.lengths[1]
        assert 5 <= min(start.lengths) * scale <= max(start.lengths) * scale <= 60
        assert r2 == min(start.lengths)
        assert r2 + max(start.lengths) < sum(start.lengths) / 2
        steps = start.direction * np.diff(start.theta2)
        assert (steps > 0).all()
        assert steps.sum() < 2 * np.pi
    spread = [start for start in starts if start.terms.radius < np.inf]
    assert len(spread) >= 20
    points = np.array([start.points for start in spread])
    gaps = np.abs(points[:, None] - points).max(axis=2) + 10 * np.eye(len(points))
    assert gaps.min() > 1e-3


@pytest.mark.quick("0", "3")
@pytest.mark.parametrize("seed", range(4))
def test_nine_points_settle_their_designs(path_scaled: PathSetup, seed: int) -> None:
    scaled, _ = path_scaled([1, seed], 9)
    starts = [start for found in first_rounds(scaled, 4, enough=1) for start in found.starts]
    assert starts
    assert all(start.terms.settled for start in starts)
    check_tracks(scaled, starts, 1e-5)


@pytest.mark.parametrize("points", [3, 5, 12])
@pytest.mark.parametrize("any_driver", [False, True])
def test_prescribed_rotations_are_kept(path_scaled: PathSetup, points: int, any_driver: bool) -> None:
    wanted = {"rotatability": "any"} if any_driver else {}
    scaled, _ = path_scaled(3, points, timed=True, **wanted)
    finds = finds_of(scaled)
    assert len(finds)
    turned = finds.direction[:, None] * (finds.theta2 - finds.theta2[:, :1])
    np.testing.assert_allclose(turned, np.tile(scaled.timing, (len(finds), 1)), atol=1e-9)
    check_tracks(scaled, first_rounds(scaled, 1)[0].starts[:10], 1e-5 if scaled.exact else 1.0)


@pytest.mark.quick("True")
@pytest.mark.parametrize("exact", [True, False])
def test_a_last_point_that_repeats_the_first_is_met_after_a_turn(exact: bool) -> None:
    points = [*LINE[:3], [24.0, 24.0]] if exact else ELLIPSE
    scaled = setup_of([*points, points[0]])
    target = SearchTargets.of(scaled)
    assert len(target.points) == len(points)
    assert target.weights.tolist() == [2.0] + [1.0] * (len(points) - 1)
    finds = finds_of(scaled)
    assert len(finds)
    turn = finds.theta2[:, -1] - finds.theta2[:, 0]
    np.testing.assert_allclose(turn, 2 * np.pi * finds.direction, atol=1e-12)
    assert finds.theta2.shape == (len(finds), len(points) + 1)
    starts = first_rounds(scaled, 1)[0].starts
    check_tracks(scaled, starts, 1e-5 if exact else 0.5)


def test_an_unrepeated_path_is_taken_as_it_is() -> None:
    target = SearchTargets.of(setup_of(ELLIPSE))
    assert target.weights.tolist() == [1.0] * 9
    assert not target.timed
    timed = SearchTargets.of(setup_of(LINE, timing=[0, -10, -20, -30, -40, -50]))
    np.testing.assert_allclose(np.degrees(timed.timing), [0, 10, 20, 30, 40, 50])


def test_the_rms_error_is_over_all_targets() -> None:
    scaled = setup_of([*ELLIPSE, ELLIPSE[0]])
    finds = finds_of(scaled)
    starts = [Start.of_screened(finds, index, scaled.problem.objective) for index in range(len(finds))]
    for start, error in zip(starts, finds.error, strict=True):
        off = np.abs(start.track[2] - scaled.targets[list(start.visit)])
        assert error == pytest.approx(np.sqrt(np.mean(off**2)), rel=1e-6)


def closes_on_the_way(start: Start) -> bool:
    r1, r2, r3, r4 = start.lengths
    way = np.linspace(start.theta2[0], start.theta2[-1], 4000) - start.theta1
    diagonal = np.abs(r1 - r2 * np.exp(1j * way))
    return bool(((diagonal < r3 + r4) & (diagonal > abs(r3 - r4))).all())


@pytest.mark.parametrize("order", [True, False])
def test_any_driver_covers_the_points(order: bool) -> None:
    scaled = setup_of(LINE[:5], rotatability="any", order=order)
    finds = finds_of(scaled)
    feasible = finds[finds.feasible]
    assert len(feasible) > 10
    rocking = 0
    for index in range(0, len(feasible), len(feasible) // 10):
        start = Start.of_screened(feasible, index, scaled.problem.objective)
        assert closes_on_the_way(start)
        assert not order or start.visit == (0, 1, 2, 3, 4)
        r1, r2, r3, r4 = start.lengths
        rocking += r1 + r2 > r3 + r4 or abs(r1 - r2) < abs(r3 - r4)
    assert rocking > 0


def test_without_order_points_are_met_as_they_come() -> None:
    scaled = setup_of([LINE[k] for k in (0, 3, 1, 4, 2)], order=False)
    finds = finds_of(scaled)
    feasible = finds[finds.feasible]
    assert len(feasible) > 20
    assert (np.sort(feasible.visit, axis=1) == np.arange(5)).all()
    assert len(np.unique(feasible.visit, axis=0)) > 1
    steps = feasible.direction[:, None] * np.diff(feasible.theta2, axis=1)
    assert (steps >= 0).all()
    assert (steps.sum(axis=1) < 2 * np.pi).all()
    starts = [Start.of_screened(feasible, i, scaled.problem.objective) for i in range(0, len(feasible), 20)]
    check_tracks(scaled, starts, 1e-5)


def test_interpolation_mixes_assemblies() -> None:
    scaled = setup_of(LINE, order=False, same_branch=False)
    finds = finds_of(scaled)
    feasible = finds[finds.feasible]
    assert len(feasible)
    sides = []
    for index in range(len(feasible)):
        start = Start.of_screened(feasible, index, scaled.problem.objective)
        a, b, _ = start.track
        sides.append(np.sign(((b - a).conj() * (b - start.o4)).imag))
    assert any(np.ptp(side) > 0 for side in sides)


@pytest.mark.parametrize("wanted", [{"o2": Box((0, 0), (0, 0))}, {"ground_angle_deg": 0.0}])
def test_an_equality_leaves_near_misses_to_start_from(wanted: dict[str, Any]) -> None:
    scaled = setup_of(LINE[:4], link_length=(5, 60), **wanted)
    (first,) = first_rounds(scaled, 1, enough=10)
    assert first.counts["feasible finds"] < 10
    assert len(first.starts) >= 10


@pytest.mark.slow
def test_relaxed_starts_miss_one_requirement() -> None:
    scaled = setup_of(LINE, transmission_min_deg=85, transmission_over="cycle")
    relaxed = finder_for(scaled).relaxed(np.random.default_rng(0))
    assert relaxed
    for start in relaxed:
        assert 1 <= len(start.terms.relaxed) <= 2
        assert set(start.terms.relaxed) <= set(GROUPS)
    assert "transmission_min_deg" in relaxed[0].terms.relaxed


def test_rounds_without_a_start_end(monkeypatch: pytest.MonkeyPatch) -> None:
    scaled = setup_of(LINE)
    none = finds_of(scaled)[:0]
    monkeypatch.setattr(coupler_search, "search", lambda *_: none)
    found = first_rounds(scaled, 1000)
    assert 1 < len(found) < 100
    assert all(not each.starts for each in found)
