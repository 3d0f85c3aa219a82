"""The screen judges as analysis.verify does, pair by pair, requirement by requirement."""

from collections import Counter
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest

from grashof.analysis import Verdict, verify
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Box, Problem, Requirements, Rotatability, TransmissionOver
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import GROUPS, Screened
from grashof.synth.starts.dyad_pairs import near_misses, screen
from grashof.synth.theory.burmester import Dyads, trace_four_pose_curves

NEAR = 1e-6  # sizes, rad or ratio: so close to a limit either judgement will do
STAR = [[2, 0], [0.5, 0.5], [0, 2], [-0.5, 0.5], [-2, 0], [0, -2]]
SINGLE = ("r1", "r2", "r3", "r4")
PLACES = ("o2", "o4", "a", "b")
ANGLES = ("ground_angle_deg", "theta2_start_deg")
MODES = ("order", "same_branch", "rotatability", "keep_out")
LIMITED = ("transmission_min_deg", "link_length", "link_ratio_max", "coupler_arms", *SINGLE, *PLACES, *ANGLES)
KINDS = [
    (rotatability, order, same_branch, over)
    for rotatability in Rotatability
    for order in (True, False)
    for same_branch in (True, False)
    for over in TransmissionOver
]


def requirements(rng: np.random.Generator, size: float, kind: tuple[Any, ...]) -> Requirements:
    """Limits at random, of the sort that about half of all pairs keep."""
    rotatability, order, same_branch, over = kind
    wanted: dict[str, Any] = {
        "rotatability": rotatability,
        "order": order,
        "same_branch": same_branch,
        "transmission_over": over,
        "rotatability_margin": rng.choice([0.0, 1e-3, 0.05]),
        "transmission_min_deg": rng.uniform(0, 30),
        "link_length": (0.2 * size, rng.uniform(1, 6) * size),
        "link_ratio_max": rng.uniform(1.5, 10),
        "coupler_arms": (0.1 * size, rng.uniform(1, 5) * size),
    }
    for name in SINGLE:
        if rng.random() < 0.2:
            wanted[name] = (0.3 * size, rng.uniform(1, 2) * size)
    for name in PLACES:
        if rng.random() < 0.5:
            middle, half = rng.normal(0, size, 2), rng.uniform(0.5, 3, 2) * size
            wanted[name] = Box(*((m - h, m + h) for m, h in zip(middle, half, strict=True)))
    for name in ANGLES:
        if rng.random() < 0.3:
            wanted[name] = rng.uniform(-180, 180)
    if rng.random() < 0.5:
        corners = rng.normal(0, 2 * size, 2) + size * rng.uniform(0.5, 2) * np.array(STAR)
        wanted["keep_out"] = (corners,)
        wanted["keep_out_for"] = [("o2", "o4"), ("o2",), ("o4",)][rng.integers(3)]
    return Requirements(**wanted)


def traced(scaled: ScaledProblem) -> Dyads:
    return trace_four_pose_curves(scaled.motion, reach=5.0, lines=40, cell=0.1)


def misses(verdict: Verdict) -> dict[str, float]:
    found: dict[str, float] = {}
    for defect in verdict.defects:
        found[defect.requirement] = max(found.get(defect.requirement, 0.0), defect.miss)
    return found


@cache
def compared(number: int) -> tuple[list[str], Counter[tuple[str, bool]]]:
    """Disagreements about two dozen pairs of a random task, and how often each requirement was met."""
    rng = np.random.default_rng([7, number])
    task, _ = planted_motion(rng, poses=4)
    wanted = requirements(rng, task.size, KINDS[number])
    scaled = ScaledProblem.of(Problem(task=task, requirements=wanted))
    pairs = near_misses(scaled.motion, scaled.targets[0], traced(scaled), scaled.wanted, pairs=5000)
    pairs = pairs[np.sort(rng.choice(len(pairs), 24, replace=False))]
    linkages = scaled.linkages(pairs.points, pairs.assembly)
    wrong, seen = [], Counter[tuple[str, bool]]()
    for index in range(len(pairs)):
        verdict = verify(linkages[index], task, wanted)
        missed = misses(verdict)
        for group, lack in zip(GROUPS, pairs.violations[index], strict=True):
            seen[group, bool(lack > 0)] += 1
            if (lack > 0) != (group in missed) and max(lack, missed.get(group, 0.0)) > NEAR:
                wrong.append(f"pair {index}: {group} violations {lack}, verify says {missed.get(group)}")
        over_task = wanted.transmission_over is TransmissionOver.TASK
        judged = verdict.transmission_min_task if over_task else verdict.transmission_min_cycle
        if abs(judged - pairs.transmission[index]) > 1e-9:
            wrong.append(f"pair {index}: transmission {pairs.transmission[index]}, verify says {judged}")
        if "exact" in missed:
            wrong.append(f"pair {index}: not exact by {missed['exact']}")
    return wrong, seen


@pytest.mark.quick("10", "21", "31")
@pytest.mark.parametrize("number", range(len(KINDS)))
def test_what_pairs_lack_is_what_verify_finds(number: int) -> None:
    assert compared(number)[0] == []


@pytest.mark.study
def test_every_requirement_was_met_by_some_and_missed_by_others() -> None:
    seen = sum((compared(number)[1] for number in range(len(KINDS))), Counter[tuple[str, bool]]())
    # The user's own are for the programme, exact poses have no zones, and quantities have a test of theirs.
    screened = {*MODES, *LIMITED}
    assert all(seen[group, lacking] > 10 for group in screened for lacking in (False, True)), seen


@pytest.mark.quick("0", "12", "24")
@pytest.mark.parametrize("number", range(0, len(KINDS), 3))
def test_feasible_pairs_have_no_defect(number: int) -> None:
    rng = np.random.default_rng([8, number])
    task, _ = planted_motion(rng, poses=4)
    rotatability, order, same_branch, over = KINDS[number]
    wanted = Requirements(
        rotatability=rotatability,
        order=order,
        same_branch=same_branch,
        transmission_over=over,
        transmission_min_deg=2,
        link_length=(0.1 * task.size, 10 * task.size),
        o4=Box(x=(task.positions[0, 0] - 4 * task.size, np.inf)),
    )
    scaled = ScaledProblem.of(Problem(task=task, requirements=wanted))
    pairs = screen(scaled.motion, scaled.targets[0], traced(scaled), scaled.wanted, pairs=10**7)
    every = near_misses(scaled.motion, scaled.targets[0], traced(scaled), scaled.wanted, pairs=10**7)
    # The cheap tests lose no pair, and let none pass.
    assert points_of(pairs) == points_of(every[every.feasible])
    some = pairs[:: max(1, len(pairs) // 20)]
    linkages = scaled.linkages(some.points, some.assembly)
    for index in range(len(some)):
        assert verify(linkages[index], task, wanted).defects == ()


def points_of(pairs: Screened) -> list[bytes]:
    return sorted(row.tobytes() for row in pairs.points)


@pytest.mark.parametrize("order", [True, False])
def test_the_way_through_the_poses_is_one_that_the_driver_can_go(
    planted_scaled: Callable[..., tuple[ScaledProblem, Any]], order: bool
) -> None:
    """For drivers that cannot turn as well: from the first angle to the last the linkage closes."""
    count = 0
    for seed in range(8):
        scaled, _ = planted_scaled(seed, rotatability="any", order=order)
        pairs = screen(scaled.motion, scaled.targets[0], traced(scaled), scaled.wanted, pairs=10**6)
        for index in range(0, len(pairs), max(1, len(pairs) // 15)):
            o2, o4, a, b, _ = pairs.points[index]
            visit, theta2 = pairs.visit[index], pairs.theta2[index]
            assert sorted(visit) == [0, 1, 2, 3]
            assert not order or visit.tolist() == [0, 1, 2, 3]
            assert (pairs.direction[index] * np.diff(theta2) > 0).all()
            places = scaled.motion.apply(np.array([a]))[0][visit]
            np.testing.assert_allclose(o2 + abs(a - o2) * np.exp(1j * theta2), places, atol=1e-8)
            way = o2 + abs(a - o2) * np.exp(1j * np.linspace(theta2[0], theta2[-1], 2000))
            r3, r4 = abs(b - a), abs(b - o4)
            distance = np.abs(way - o4)
            assert ((distance > abs(r3 - r4)) & (distance < r3 + r4)).all()
            count += bool(abs(o4 - o2) + abs(a - o2) > r3 + r4)
    assert count > 20  # drivers that cannot turn were among them


def test_the_planted_pair_is_feasible(planted_scaled: Callable[..., tuple[ScaledProblem, Any]]) -> None:
    for seed in range(10):
        scaled, linkage = planted_scaled(seed, rotatability_margin=0.0, link_ratio_max=1e6)
        coupler = np.exp(1j * (scaled.problem.task.angles[0] - linkage.body_angle))
        a = complex(*scaled.problem.task.positions[0]) - complex(*linkage.coupler_point) * coupler
        moving = scaled.frame.inward(np.array([[p.real, p.imag] for p in (a, a + linkage.r3 * coupler)]))
        ground = scaled.frame.inward(np.array([linkage.o2, linkage.o4]))
        pairs = near_misses(scaled.motion, scaled.targets[0], Dyads(moving, ground), scaled.wanted, pairs=100)
        own = np.abs(pairs.points[:, 0] - ground[0]) < 1e-9
        assert pairs[own].feasible.tolist() == [True]
        assert pairs.assembly[own].tolist() == [float(linkage.assembly)]


def test_no_dyads_no_pairs(luggage_scaled: Callable[..., ScaledProblem]) -> None:
    scaled = luggage_scaled()
    none = Dyads(np.zeros(0, dtype=np.complex128), np.zeros(0, dtype=np.complex128))
    for found in (
        screen(scaled.motion, scaled.targets[0], none, scaled.wanted, pairs=100),
        near_misses(scaled.motion, scaled.targets[0], none, scaled.wanted, pairs=100),
    ):
        assert len(found) == 0
        assert found.feasible.tolist() == []
        assert found.points.shape == (0, 5)
