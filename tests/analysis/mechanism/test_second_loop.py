"""Ranges, circuits and transmission of six-bars against the judge in body coordinates and closed forms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from body_coordinates import circuit, margins, reach, start
from body_plans import Array, Plan, plan_of
from random_linkages import six_bars, swinging_six_bars

from grashof.analysis import (
    branch_index,
    circuit_index,
    dead_ends,
    driver_ranges,
    even_motion,
    extremes,
    full_rotation,
    solve_position,
    transmission_angle,
    transmission_extremes,
    worst_transmission,
    worst_transmission_cycle,
)
from grashof.analysis.mechanism.mobility import passes_change_point, range_index
from grashof.analysis.mechanism.stroke import link_stroke
from grashof.analysis.mechanism.transmission import quality
from grashof.problems import FourBar, InvertedSliderCrank, ProblemError, SixBar

TURN = 2 * np.pi
COUNT = 10  # of each kind and row
FEW = ("pins 2 4", "pins 3 1", "slide 4 1")  # all hosts, with and without a slide


@dataclass
class Judged:
    """Six-bars with a position of each by the judge."""

    linkage: SixBar
    theta: Array
    plan: Plan
    q: Array


@pytest.fixture(scope="module", params=FEW)
def judged(request: pytest.FixtureRequest) -> Judged:
    """Six-bars of which some are stopped by the second loop alone."""
    rng = np.random.default_rng(FEW.index(request.param))
    swinging, theta = swinging_six_bars(request.param, COUNT, rng)
    turning = six_bars(request.param, COUNT, rng, turning=False)
    names = [row.name for row in swinging.mechanism.parameters]
    both = {name: np.concatenate([getattr(swinging, name), getattr(turning, name)]) for name in names}
    linkage = SixBar(**both, hosts=swinging.mechanism.dyads[1].hosts)
    plan, theta = plan_of(linkage), np.concatenate([theta, np.zeros(COUNT)])
    q = start(plan, theta, guesses=60)
    found = np.isfinite(q).all(axis=-1)
    index, _ = zip(*(range_index(linkage[k], theta[k]) for k in range(2 * COUNT)), strict=True)
    assert ((np.array(index) >= 0) | ~found).all()
    assert found.sum() > 1.4 * COUNT
    return Judged(linkage[found], theta[found], plan.taken(found), q[found])


def own_range(linkage: Any, theta: float) -> Array:
    """The range of an angle, moved by full turns to include it."""
    index, inside = range_index(linkage, theta)
    found: Array = driver_ranges(linkage)[int(index)] - inside + theta
    return found


def test_the_driver_stops_where_the_judge_does(judged: Judged) -> None:
    dead = reach(judged.plan, judged.q, judged.theta)
    turns = full_rotation(judged.linkage)
    np.testing.assert_array_equal(turns, np.isinf(dead).all(axis=0))
    for k in np.flatnonzero(~turns):
        # The judge is off by some 1e-7 where both loops are nearly dead.
        ends = own_range(judged.linkage[k], judged.theta[k])
        np.testing.assert_allclose(ends, dead[:, k], rtol=0, atol=5e-7)


def test_it_closes_over_its_range_and_not_beyond(judged: Judged) -> None:
    for k, theta in enumerate(judged.theta[::3]):
        linkage = judged.linkage[3 * k]
        low, high = own_range(linkage, float(theta)).tolist()
        motion = even_motion(linkage, *dead_ends(linkage, low, high))
        share = np.linspace(0, 1, 60)
        state = solve_position(linkage, motion.theta2(share))
        assert np.isfinite(state.margins).all()
        np.testing.assert_allclose(motion.share(motion.theta2(share[1:-1])), share[1:-1], atol=1e-6)
        if not full_rotation(linkage):
            assert np.abs(np.array(state.margins)[:, [0, -1]]).min(axis=0).max() < 1e-7
            beyond = solve_position(linkage, np.array([low - 1e-6, high + 1e-6]))
            assert np.isnan(beyond.margins).any(axis=0).all() or np.ptp([low, high]) > TURN - 1e-5


def test_motion_through_dead_positions_stays_on_a_circuit(judged: Judged) -> None:
    """The judge follows each circuit without a driver; it passes all branches of it, and no other."""
    some = np.arange(0, len(judged.theta), 2)
    plan = judged.plan.taken(some)
    passed, back = circuit(plan, judged.q[some])
    signed = margins(plan, passed)
    assert back.mean() > 0.9
    for k, linkage in enumerate(judged.linkage[n] for n in some):
        clear = np.isfinite(passed[:, k, 0]) & (np.abs(signed[:, k]) > 1e-4).all(axis=-1)
        place = (passed[clear, k, 2], *np.sign(signed[clear, k]).T)
        (own,) = set(circuit_index(linkage, *place).tolist())
        if back[k]:
            assert _branches_of(linkage, own) <= set(branch_index(linkage, *place).tolist())


def _branches_of(linkage: Any, own: int) -> set[int]:
    """All branches of a circuit, without the shortest ranges."""
    found = set()
    for assembly, second in np.ndindex(2, 2):
        place = (1 - 2 * assembly, 1 - 2 * second)
        for low, high in driver_ranges(linkage.changed(assembly=place[0])).tolist():
            middle = (low + high) / 2
            if high - low > 1e-2 and circuit_index(linkage, middle, *place) == own:
                found.add(int(branch_index(linkage, middle, *place)))
    return found


def test_a_batch_has_the_ranges_of_its_linkages(judged: Judged) -> None:
    ranges = driver_ranges(judged.linkage)
    for k in range(0, len(ranges), 5):
        own = driver_ranges(judged.linkage[k])
        np.testing.assert_array_equal(ranges[k, : len(own)], own)
        assert np.isnan(ranges[k, len(own) :]).all()


# --- Watt II with both dyads on the driver: two four-bars with one crank, each in closed form


def twins(count: int, seed: int) -> tuple[SixBar, FourBar, FourBar, Array]:
    """Six-bars, their four-bars, and how far the second one's crank is ahead of the driver."""
    rng = np.random.default_rng(seed)
    arm, ahead = rng.uniform(0.3, 2, count), rng.uniform(-np.pi, np.pi, count)
    o4, d = 1.5 * rng.normal(size=(2, count, 2))
    c = np.stack([arm * np.cos(ahead), arm * np.sin(ahead)], axis=-1)
    r2, r3, r4, r5, r6 = rng.uniform(0.4, 2.5, (5, count))
    signs = rng.choice([-1, 1], (2, count))
    linkage = SixBar(
        (0, 0), o4, r2, r3, r4, c=c, d=d, r5=r5, r6=r6, hosts=(2, 1), assembly=signs[0], assembly_2=signs[1]
    )
    first = FourBar((0, 0), o4, r2, r3, r4, assembly=signs[0])
    return linkage, first, FourBar((0, 0), d, arm, r5, r6, assembly=signs[1]), ahead


def intersection(one: Array, other: Array) -> list[tuple[float, float]]:
    """Intersections of two sets of ranges modulo a turn; a full turn may have any ends."""
    found = []
    for low, high in one[np.isfinite(one[:, 0])]:
        for least, most in other[np.isfinite(other[:, 0])]:
            if high - low > TURN - 1e-9 and most - least < TURN - 1e-9:
                found.append((least, most))
                continue
            for turn in range(-3, 4):
                begin, end = max(low, least + TURN * turn), min(high, most + TURN * turn)
                if most - least > TURN - 1e-9:
                    begin, end = (low, high) if turn == 0 else (0.0, 0.0)
                if end > begin:
                    found.append((begin, end))
    return sorted((low - TURN * np.round((low + high) / 2 / TURN), high - low) for low, high in found)


@pytest.mark.parametrize("limit", [0.0, 0.4])
def test_ranges_of_two_four_bars_on_one_crank(limit: float) -> None:
    linkage, first, second, ahead = twins(24, 5)
    counts = set()
    for k in range(24):
        own = driver_ranges(linkage[k], limit)
        both = intersection(driver_ranges(first[k], limit), driver_ranges(second[k], limit) - ahead[k])
        own = own[np.isfinite(own[:, 0])]
        mine = sorted((low, high - low) for low, high in own.tolist())
        np.testing.assert_allclose(np.reshape(mine, (-1, 2)), np.reshape(both, (-1, 2)), atol=1e-11)
        counts.add(len(mine))
    assert counts >= {0, 1, 2}
    turns = full_rotation(first) & full_rotation(second)
    np.testing.assert_array_equal(full_rotation(linkage), turns)
    worst = np.where(turns, np.minimum(worst_transmission_cycle(first), worst_transmission_cycle(second)), 0)
    np.testing.assert_allclose(worst_transmission_cycle(linkage), worst, atol=1e-12)


def test_transmission_of_two_four_bars_on_one_crank() -> None:
    linkage, first, second, ahead = twins(12, 6)
    theta2 = np.linspace(0, TURN, 50)[:, None]
    both = [transmission_angle(first, theta2), transmission_angle(second, theta2 + ahead)]
    np.testing.assert_allclose(transmission_angle(linkage, theta2), both[0], atol=1e-12)
    np.testing.assert_allclose(transmission_angle(linkage, theta2, loop=2), both[1], atol=1e-9)
    start_, end = np.array([[-0.3], [0.2]]), np.array([[0.4], [1.5]])
    worst = np.minimum(
        worst_transmission(first, start_, end), worst_transmission(second, start_ + ahead, end + ahead)
    )
    np.testing.assert_allclose(worst_transmission(linkage, start_, end), worst, atol=1e-9)
    with pytest.raises(ProblemError, match="loop is 3; it must be 1 or 2"):
        transmission_angle(linkage, 0.0, loop=3)
    with pytest.raises(ProblemError, match="loop is 2; it must be 1"):
        transmission_angle(first, 0.0, loop=2)


def test_least_and_largest_transmission_angles_are_those_of_dense_samples() -> None:
    for row in FEW:
        linkage = six_bars(row, 4, np.random.default_rng(2), turning=False)[1]
        low, high = driver_ranges(linkage)[0].tolist()
        theta2 = even_motion(linkage, low, high).theta2(np.linspace(0, 1, 4001))
        for loop in (1, 2):
            mu, found = (
                transmission_angle(linkage, theta2, loop),
                transmission_extremes(linkage, low, high, loop),
            )
            np.testing.assert_allclose([found.low, found.high], [mu.min(), mu.max()], atol=1e-5)
        both = transmission_extremes(linkage, low, high)
        worst = worst_transmission(linkage, low, high)
        assert quality([both.low, both.high]).min() == pytest.approx(worst, abs=1e-7)


# --- Adverse cases


def test_the_second_loop_alone_makes_several_ranges_of_one_turn() -> None:
    linkage = SixBar((0, 0), (4, 0), 1, 4, 3, c=(1, 0), d=(1.2, 0), r5=1.2, r6=0.5, hosts=(2, 1))
    ranges = driver_ranges(linkage)
    alone = driver_ranges(FourBar((0, 0), (1.2, 0), 1, 1.2, 0.5))
    np.testing.assert_allclose(np.sort(ranges, axis=0), np.sort(alone, axis=0), atol=1e-12)
    assert full_rotation(FourBar((0, 0), (4, 0), 1, 4, 3))
    first, other = np.sort(ranges, axis=0).mean(axis=-1)
    assert circuit_index(linkage, first, [1, 1, -1, -1], [1, -1, 1, -1]).tolist() == [0, 0, 2, 2]
    assert circuit_index(linkage, other, [1, 1, -1, -1], [1, -1, 1, -1]).tolist() == [1, 1, 3, 3]


@pytest.mark.parametrize("side", [1, -1])
def test_a_circuit_continues_through_a_dead_position_of_the_first_loop(side: int) -> None:
    """A second loop that always closes: one circuit for each of its assemblies, with both of the first."""
    linkage = SixBar((0, 0), (4, 0), 2, 2, 3, c=(1, 0), d=(2, 0), r5=6, r6=5.99, hosts=(3, 1), assembly=side)
    np.testing.assert_allclose(
        driver_ranges(linkage), driver_ranges(FourBar((0, 0), (4, 0), 2, 2, 3)), atol=1e-12
    )
    assert circuit_index(linkage, 0.5, [1, -1, 1, -1], [1, 1, -1, -1]).tolist() == [0, 0, 1, 1]
    assert branch_index(linkage, 0.5, [1, -1, 1, -1], [1, 1, -1, -1]).tolist() == [0, 2, 1, 3]


@pytest.mark.parametrize(
    ("hosts", "d", "far"), [((3, 1), (5, 1), True), ((4, 1), (1, -3), False), ((3, 1), (-2, 2), False)]
)
def test_both_loops_dead_together(hosts: tuple[int, int], d: tuple[float, float], far: bool) -> None:
    """The second loop is just stretched or folded where the first one stops: one assembly reaches it."""
    four = FourBar((0, 0), (4, 0), 2, 2, 3)
    _, high = dead_ends(four, *driver_ranges(four)[0])
    state = solve_position(four, high)
    origin, angle = (state.a, state.theta3) if hosts[0] == 3 else (four.o4, state.theta4)
    c = np.array([0.7, 0.9])
    turned = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    apart = float(np.linalg.norm(origin + turned @ c - d))
    r5, r6 = (0.6 * apart, 0.4 * apart) if far else (1.7 * apart, 0.7 * apart)
    linkage = SixBar((0, 0), (4, 0), 2, 2, 3, c=c, d=d, r5=r5, r6=r6, hosts=hosts)
    reaching = [side for side in (1, -1) if _last_end(linkage.changed(assembly=side)) > high - 1e-9]
    assert len(reaching) == 1  # the other one would have to pass a dead position of the second loop
    own = linkage.changed(assembly=reaching[0])
    assert _last_end(own) == pytest.approx(high, abs=1e-12)
    assert len(set(circuit_index(own, high - 1e-3, reaching[0], [1, -1]).tolist())) == 1
    plan = plan_of(own)
    theta = np.array([high - 1e-2])
    passed, (back,) = circuit(plan, start(plan, theta))
    signed = margins(plan, passed)[:, 0]
    clear = np.isfinite(passed[:, 0, 0]) & (np.abs(signed) > 1e-3).all(axis=-1)
    assert back
    assert len(set(circuit_index(own, passed[clear, 0, 2], *np.sign(signed[clear]).T).tolist())) == 1


def _last_end(linkage: Any) -> float:
    return float(np.nan_to_num(driver_ranges(linkage), nan=-np.inf).max())


def test_two_intervals_of_one_circuit() -> None:
    """From one to the other through the first loop's other assembly."""
    joined = SixBar(
        (1.524, -1.525), (3.471, -2.323), 0.7215, 1.402, 1.1308, c=(0.1236, 1.5784), d=(-0.8381, 0.6784),
        r5=1.4879, r6=3.4342, hosts=(3, 4), assembly=-1, assembly_2=-1,
    )  # fmt: skip
    ranges = driver_ranges(joined)
    assert np.isfinite(ranges).sum() >= 4
    middles = ranges[:2].mean(axis=-1)
    assert len(set(circuit_index(joined, middles, joined.assembly).tolist())) == 1
    assert len(set(branch_index(joined, middles, joined.assembly).tolist())) == 2


def test_a_driver_of_half_a_turn() -> None:
    """r1^2 + r2^2 = (r3 + r4)^2: the diagonal is longest where the driver is perpendicular to the ground."""
    linkage = SixBar((0, 0), (3, 0), 4, 2.5, 2.5, c=(1, 0), d=(9, 0), r5=9, r6=6, hosts=(3, 1))
    np.testing.assert_allclose(driver_ranges(linkage)[0], [-np.pi / 2, np.pi / 2], atol=1e-12)
    assert not full_rotation(linkage)


def test_parallelograms_have_change_points_in_either_loop() -> None:
    both = SixBar((0, 0), (4, 0), 1, 4, 1, c=(1, 0), d=(8, 0), r5=4, r6=1, hosts=(4, 1))
    second = SixBar((0, 0), (4, 0), 1, 4, 3, c=(1, 0), d=(4, 0), r5=4, r6=1, hosts=(2, 1))
    through = SixBar((0, 0), (4, 0), 1, 4, 3, c=(1, 0), d=(1, 0), r5=2, r6=2, hosts=(2, 1))  # C meets D
    for linkage in (both, second, through):
        np.testing.assert_allclose(driver_ranges(linkage)[0], [-np.pi, np.pi], atol=1e-9)
        assert not full_rotation(linkage)
        assert worst_transmission_cycle(linkage) == 0
        assert passes_change_point(linkage, -0.1, 0.1)
        assert passes_change_point(linkage, 6.3, 6.2)
        assert not passes_change_point(linkage, 0.1, 3.1)
        assert passes_change_point(linkage, 3, 3.2) == (linkage is not through)
        places = circuit_index(linkage, 1.0, [1, 1, -1, -1], [1, -1, 1, -1])
        assert sorted(places.tolist()) == [0, 1, 2, 3]


def test_nearly_a_change_point_is_two_dead_positions() -> None:
    """A gap of the second loop far narrower than the samples is found, as is a range between two gaps."""
    for short in (1e-9, -1e-9):
        linkage = SixBar(
            (0, 0), (4, 0), 1, 4, 3, c=(1, 0), d=(4, 0), r5=4 - short, r6=1 - short / 3, hosts=(2, 1)
        )
        alone = driver_ranges(FourBar((0, 0), (4, 0), 1, 4 - short, 1 - short / 3))
        found = driver_ranges(linkage)
        np.testing.assert_allclose(
            np.sort(found[np.isfinite(found)]), np.sort(alone[np.isfinite(alone)]), atol=1e-11
        )


def test_a_through_o4_of_an_inverted_slider_crank() -> None:
    """No offset and r2 = r1: A meets O4 where the driver points there, and the rod is free to turn."""
    linkage = InvertedSliderCrank((0, 0), (2, 0), 2, 0)
    np.testing.assert_allclose(np.ptp(driver_ranges(linkage)[0]), TURN)
    assert not full_rotation(linkage)
    assert passes_change_point(linkage, -0.1, 0.1)
    assert not passes_change_point(linkage, 0.1, 6.2)
    state = solve_position(linkage, np.array([-1e-3, 1e-3, 2.0]))
    np.testing.assert_allclose(state.travel, 4 * np.abs(np.sin([5e-4, 5e-4, 1.0])))


# --- Limit positions


def test_limit_positions_are_those_of_the_closed_form() -> None:
    linkage = six_bars("pins 4 1", 4, np.random.default_rng(8))
    for k in range(4):
        first = FourBar(*linkage[k].parameters[:5], assembly=linkage[k].assembly)
        found, known = link_stroke(linkage[k], 4), link_stroke(first)
        np.testing.assert_allclose(found.theta2, known.theta2, atol=1e-10)
        assert found.stroke == pytest.approx(known.stroke, abs=1e-10)
        assert found.time_ratio == pytest.approx(known.time_ratio, abs=1e-9)


@pytest.mark.filterwarnings("ignore:dead position")
@pytest.mark.parametrize("row", ["pins 3 1", "slide 3 1"])
def test_strokes_of_link_6_are_its_extremes(row: str) -> None:
    for turning in (True, False):
        linkage = six_bars(row, 3, np.random.default_rng(4), turning)
        for k in range(3):
            found = link_stroke(linkage[k])
            if np.isnan(found.stroke):
                continue
            slides = "slide" in row
            most = extremes(
                linkage[k],
                (lambda state: state.slide.travel) if slides else (lambda state: state.theta6),
                period=None if slides else TURN,
            )
            assert found.stroke == pytest.approx(most.stroke, abs=1e-9)
            state = solve_position(linkage[k], np.asarray(found.theta2))
            value = state.travel if slides else state.theta6
            away = (value - found.value + np.pi) % TURN - np.pi
            np.testing.assert_allclose(away, 0, atol=1e-12)
