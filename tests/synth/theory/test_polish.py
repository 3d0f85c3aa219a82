"""Polishing of designs onto points, angles, or both: quadratically, by the least change."""

from dataclasses import replace

import numpy as np
import pytest
from circles import closed, numbers_of, points_of
from known_designs import as_found

from grashof.analysis import verify
from grashof.analysis.judge.planted import (
    planted_motion,
    planted_path,
    random_full_crank,
    uneven_driver_angles,
)
from grashof.problems import Problem, Requirements
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.loop.dimensions import dimensions_of
from grashof.synth.loop.dyad import Bars
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory import polish as path_polish
from grashof.synth.theory.polish import ExactTargets, Polished, _linearised, _spread, polish_path

# How many targets, those without a point, those without an angle, whether timed, whether of both assemblies.
CASES: dict[str, tuple[int, list[int], list[int], bool, bool]] = {
    "nine points": (9, [], list(range(9)), False, False),
    "seven points on both assemblies": (7, [], list(range(7)), False, True),
    "five timed points": (5, [], list(range(5)), True, False),
    "three timed points on both assemblies": (3, [], list(range(3)), True, True),
    "five whole poses": (5, [], [], False, False),
    "three timed poses": (3, [], [], True, False),
    "seven, four angles free": (7, [], [1, 2, 4, 5], False, False),
    "points and angles free": (6, [2], [0, 4], False, False),
    "angles but for one point": (7, [1, 2, 3, 4, 5, 6], [], False, False),
}


class Planted:
    """A linkage of one size or so, the targets it meets, and one that is a little off."""

    def __init__(self, seed: int, case: str, off: float = 1e-4) -> None:
        count, no_points, no_angles, timed, mixed = CASES[case]
        rng = np.random.default_rng([61, seed])
        linkage = random_full_crank(rng)
        scale, self.body_angle = float(linkage.r3), float(linkage.body_angle)
        self.theta2, self.side = uneven_driver_angles(rng, count), np.full(count, float(linkage.assembly))
        if mixed:
            self.side[count // 2 :] *= -1
        lengths = np.array([linkage.r2, linkage.r3, linkage.r4]) / scale
        self.numbers = np.concatenate([
            [0.0, 0.0], (linkage.o4 - linkage.o2) / scale, lengths, linkage.coupler_point / scale
        ])  # fmt: skip
        a, b, points = closed(self.numbers, self.theta2, self.side)
        turns = np.angle(b - a) + self.body_angle + 2 * np.pi * rng.integers(-1, 2, count)
        has_point, has_turn = np.ones(count, dtype=bool), np.ones(count, dtype=bool)
        has_point[no_points], has_turn[no_angles] = False, False
        self.targets = ExactTargets(
            np.where(has_point, points, 5 - 3j), has_point,
            np.where(has_turn, turns, 1.0), has_turn, timed, Bars(),
        )  # fmt: skip
        self.near = self.numbers + rng.normal(0, off, 9)
        self.angles = self.theta2 + (off if timed else rng.normal(0, off, count))

    def first(self, numbers: FloatArray, theta2: FloatArray) -> ComplexArray:
        a, b, p = (each[0] for each in closed(numbers, theta2[:1], self.side[:1]))
        return np.array([complex(*numbers[:2]), complex(*numbers[2:4]), a, b, p])

    def polished(self, targets: ExactTargets | None = None) -> Polished:
        first = self.first(self.near, self.angles)
        return polish_path(first, self.angles, self.body_angle + 1e-4, self.side, targets or self.targets)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("seed", range(2))
def test_it_ends_on_its_targets(case: str, seed: int) -> None:
    planted = Planted(seed, case)
    polished, targets = planted.polished(), planted.targets
    assert polished.error < 1e-12
    a, b, p = closed(numbers_of(polished.points), polished.theta2, planted.side)
    turned = np.angle((b - a) * np.exp(1j * (polished.body_angle - targets.turns)))
    assert np.abs(p - targets.points)[targets.has_point].max() < 1e-11
    assert np.abs(turned[targets.has_turn]).max(initial=0.0) < 1e-11
    np.testing.assert_allclose(polished.coupler, b - a, atol=1e-11)
    assert np.abs(polished.points - planted.first(planted.near, planted.angles)).max() < 1e-2
    if targets.timed:
        np.testing.assert_allclose(np.diff(polished.theta2), np.diff(planted.theta2), atol=1e-14)


@pytest.mark.parametrize("case", CASES)
def test_errors_fall_quadratically(case: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for seed in range(3):
        planted, errors = Planted(seed, case), []
        for steps in range(5):
            monkeypatch.setattr(path_polish, "STEPS", steps)
            errors.append(planted.polished().error)
        assert errors[0] > 1e-5
        assert errors[1] < 0.1 * errors[0]
        assert errors[3] < max(1e5 * errors[2] ** 2, 1e-13)
        assert errors[4] < 1e-13


@pytest.mark.parametrize("case", [case for case in CASES if "points" in case and "free" not in case])
def test_a_step_is_the_least_one(case: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The pseudo-inverse of differences of other loops gives the same step."""
    monkeypatch.setattr(path_polish, "STEPS", 1)
    planted = Planted(1, case)
    targets, angles = planted.targets, planted.angles
    gaps, timed = angles - angles[0], targets.timed
    before = np.concatenate([planted.near, angles[:1] if timed else angles])

    def residual(x: FloatArray) -> FloatArray:
        off = closed(x[:9], x[9] + gaps if timed else x[9:], planted.side)[2] - targets.points
        return np.concatenate([off.real, off.imag])

    steps = 1e-6 * np.eye(len(before))
    jacobian = np.array([(residual(before + h) - residual(before - h)) / 2e-6 for h in steps]).T
    expected = before - np.linalg.pinv(jacobian, rcond=1e-8) @ residual(before)
    polished = planted.polished()
    after = np.concatenate([numbers_of(polished.points), polished.theta2[:1] if timed else polished.theta2])
    assert np.abs(expected - before).max() > 1e-5
    np.testing.assert_allclose(after, expected, atol=1e-5 * np.abs(expected - before).max() + 1e-9)


@pytest.mark.parametrize("case", ["five timed points", "five whole poses"])
def test_what_is_on_its_targets_stays(case: str) -> None:
    planted = Planted(1, case)
    first = planted.first(planted.numbers, planted.theta2)
    polished = polish_path(first, planted.theta2, planted.body_angle, planted.side, planted.targets)
    np.testing.assert_allclose(polished.points, first, atol=1e-12)
    np.testing.assert_allclose(polished.theta2, planted.theta2, atol=1e-12)


def test_a_loop_that_does_not_close_has_no_error() -> None:
    planted = Planted(0, "nine points")
    first = np.array([0, 10, 1, 2, 1 + 1j], dtype=np.complex128)
    assert np.isnan(polish_path(first, np.linspace(0, 3, 9), 0.0, planted.side, planted.targets).error)


def test_free_points_and_angles_do_not_pull() -> None:
    """Other numbers where nothing is prescribed lead to the same design."""
    planted = Planted(1, "points and angles free")
    targets = planted.targets
    other = replace(
        targets,
        points=np.where(targets.has_point, targets.points, 0),
        turns=np.where(targets.has_turn, targets.turns, -2.0),
    )
    here, there = planted.polished(), planted.polished(other)
    np.testing.assert_array_equal(here.points, there.points)
    assert here.body_angle == there.body_angle


def test_many_driver_angles_are_eliminated_without_a_difference(monkeypatch: pytest.MonkeyPatch) -> None:
    count = path_polish.MANY + 1
    rng = np.random.default_rng(count)
    task, linkage = planted_path(rng, count)
    verdict = verify(linkage, task, Requirements(exact=True))
    scaled = ScaledProblem.of(Problem(task=task))
    begin = points_of(scaled, linkage, verdict.theta2[0]) + rng.normal(0, 1e-5, 5)
    none, every = np.zeros(count, dtype=bool), np.ones(count, dtype=bool)
    targets = ExactTargets(scaled.targets, every, np.zeros(count), none, timed=False, dyad=Bars())
    found = []
    for many in (path_polish.MANY, 1000):
        monkeypatch.setattr(path_polish, "MANY", many)
        found.append(polish_path(begin, verdict.theta2, 0.0, verdict.assembly.astype(float), targets))
    assert max(one.error for one in found) < 1e-12
    np.testing.assert_allclose(found[0].points, found[1].points, atol=1e-9)


SLIDERS = ("slider-crank", "inverted-slider-crank")


def planted_slider(
    mechanism: str, seed: int, count: int = 5
) -> tuple[FloatArray, FloatArray, float, ExactTargets]:
    """Points of a linkage at the first of some poses, driver angles, body angle, and the poses."""
    task, linkage = planted_motion(np.random.default_rng([11, seed]), count, mechanism=mechanism)
    linkage = as_found(linkage)
    scaled = ScaledProblem.of(Problem(task=task, mechanism=mechanism))
    every, theta2 = np.ones(count, dtype=bool), verify(linkage, task, scaled.problem.requirements).theta2
    targets = ExactTargets(scaled.targets, every, scaled.turns, every, timed=False, dyad=scaled.kind.dyad)
    return points_of(scaled, linkage, theta2[0]), theta2, float(linkage.body_angle), targets


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("mechanism", SLIDERS)
def test_derivatives(mechanism: str, seed: int) -> None:
    points, theta2, body_angle, targets = planted_slider(mechanism, seed)
    arm = (points[4] - points[2]) * abs(points[3] - points[2]) / (points[3] - points[2])
    numbers = [*dimensions_of(targets.dyad, points), arm.real, arm.imag, body_angle, *theta2]
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
    for seed in range(4):
        points, theta2, body_angle, targets = planted_slider(mechanism, seed, 3)
        targets, rng = replace(targets, timed=timed), np.random.default_rng(seed)
        near = points + 1e-4 * (rng.normal(size=5) + 1j * rng.normal(size=5))
        moved = polish_path(near, theta2 + (0 if timed else 1e-4), body_angle, np.ones(3), targets)
        assert moved.error < 1e-13
        assert np.abs(moved.points - points).max() < 0.02
