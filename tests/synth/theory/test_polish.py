"""Polishing of path designs: onto the targets, quadratically, by the least change."""

import numpy as np
import pytest

from grashof.analysis import solve_position, verify
from grashof.analysis.judge.planted import planted_path, random_full_crank, uneven_driver_angles
from grashof.problems import Requirements
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.loop.dimensions import FOUR_BAR_CLOSURE
from grashof.synth.theory import polish as path_polish
from grashof.synth.theory.polish import ExactTargets, Polished, polish_path

CASES = [(seed, timed, mixed) for seed in range(1, 7) for timed in (False, True) for mixed in (False, True)]


def curve(unknowns: FloatArray, theta2: FloatArray, assembly: FloatArray) -> ComplexArray:
    """P at driver angles by circle intersection; unknowns o2, o4, r2, r3, r4, u, v."""
    o2, o4, arm = (complex(*unknowns[i : i + 2]) for i in (0, 2, 7))
    r2, r3, r4 = unknowns[4:7]
    a = o2 + r2 * np.exp(1j * theta2)
    distance = np.abs(o4 - a)
    foot = (distance**2 + r3**2 - r4**2) / (2 * distance)
    coupler = (foot + 1j * assembly * np.sqrt(r3**2 - foot**2)) * (o4 - a) / distance
    placed: ComplexArray = a + arm * coupler / r3
    return placed


def pivots(unknowns: FloatArray, theta2: float, assembly: float) -> ComplexArray:
    """O2, O4, A, B, P at one driver angle."""
    o2, o4 = complex(*unknowns[:2]), complex(*unknowns[2:4])
    at_b = np.concatenate([unknowns[:7], [unknowns[5], 0.0]])
    a = o2 + unknowns[4] * np.exp(1j * theta2)
    angle, sign = np.array([theta2]), np.array([assembly])
    return np.array([o2, o4, a, curve(at_b, angle, sign)[0], curve(unknowns, angle, sign)[0]])


def unknowns_of(points: ComplexArray) -> FloatArray:
    o2, o4, a, b, p = points
    arm = (p - a) * abs(b - a) / (b - a)
    return np.array([
        o2.real, o2.imag, o4.real, o4.imag, abs(a - o2), abs(b - a), abs(b - o4), arm.real, arm.imag,
    ])  # fmt: skip


def wish_of(targets: ComplexArray, timed: bool) -> ExactTargets:
    """Points only."""
    every = np.ones(len(targets), dtype=bool)
    return ExactTargets(targets, every, np.zeros(len(targets)), ~every, timed, FOUR_BAR_CLOSURE)


class Planted:
    """A linkage (one size or so) at driver angles, the points it passes, and one that is a little off."""

    def __init__(self, seed: int, count: int, mixed: bool = False, off: float = 1e-4) -> None:
        rng = np.random.default_rng([3, seed])
        linkage = random_full_crank(rng)
        scale = float(linkage.r3)
        self.theta2 = uneven_driver_angles(rng, count)
        self.assembly = np.full(count, float(linkage.assembly))
        if mixed:
            self.assembly[count // 2 :] *= -1
        self.unknowns = np.array([
            0.0, 0.0, *((linkage.o4 - linkage.o2) / scale),
            *(np.array([linkage.r2, linkage.r3, linkage.r4]) / scale), *(linkage.coupler_point / scale),
        ])  # fmt: skip
        self.targets = curve(self.unknowns, self.theta2, self.assembly)
        self.near = self.unknowns + rng.normal(0, off, 9)
        self.near_angles = self.theta2 + rng.normal(0, off, count)

    def polished(self, timed: bool) -> Polished:
        angles = self.theta2 + 1e-4 if timed else self.near_angles
        first = pivots(self.near, float(angles[0]), float(self.assembly[0]))
        return polish_path(first, angles, 0.0, self.assembly, wish_of(self.targets, timed))


def count_of(timed: bool, seed: int) -> int:
    return (5, 4, 3)[seed % 3] if timed else (9, 7, 5)[seed % 3]


@pytest.mark.parametrize(("seed", "timed", "mixed"), CASES)
def test_it_ends_on_the_targets(seed: int, timed: bool, mixed: bool) -> None:
    planted = Planted(seed, count_of(timed, seed), mixed)
    polished = planted.polished(timed)
    assert polished.error < 1e-12
    found = unknowns_of(polished.points)
    traced = curve(found, polished.theta2, planted.assembly)
    np.testing.assert_allclose(traced, planted.targets, atol=1e-11)
    # What it says of the coupler is where the circles meet.
    at_b = curve(np.concatenate([found[:7], [found[5], 0.0]]), polished.theta2, planted.assembly)
    at_a = polished.points[0] + found[4] * np.exp(1j * polished.theta2)
    np.testing.assert_allclose(polished.coupler, at_b - at_a, atol=1e-11)
    if timed:
        np.testing.assert_allclose(
            polished.theta2 - polished.theta2[0], planted.theta2 - planted.theta2[0], atol=1e-14
        )


@pytest.mark.parametrize("timed", [False, True])
def test_errors_fall_quadratically(timed: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    for seed in range(1, 7):
        planted, errors = Planted(seed, count_of(timed, seed)), []
        for steps in range(5):
            monkeypatch.setattr(path_polish, "STEPS", steps)
            monkeypatch.setattr(path_polish, "MORE", 0)
            errors.append(planted.polished(timed).error)
        assert errors[0] > 1e-4
        assert errors[1] < 1e-2 * errors[0]
        assert errors[2] < max(2e4 * errors[1] ** 2, 1e-13)
        assert errors[3] < max(2e4 * errors[2] ** 2, 1e-13)
        assert errors[4] < 1e-13


@pytest.mark.parametrize(("seed", "timed", "mixed"), CASES)
def test_a_step_is_the_least_one(
    seed: int, timed: bool, mixed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The pseudo-inverse of differences of a curve of our own gives the same step."""
    monkeypatch.setattr(path_polish, "STEPS", 1)
    monkeypatch.setattr(path_polish, "MORE", 0)
    planted = Planted(seed, count_of(timed, seed), mixed)
    angles = planted.theta2 + 1e-4 if timed else planted.near_angles
    gaps = angles - angles[0]
    before = np.concatenate([planted.near, angles[:1] if timed else angles])

    def residual(x: FloatArray) -> FloatArray:
        off = curve(x[:9], x[9] + gaps if timed else x[9:], planted.assembly) - planted.targets
        return np.concatenate([off.real, off.imag])

    steps = 1e-6 * np.eye(len(before))
    jacobian = np.array([(residual(before + h) - residual(before - h)) / 2e-6 for h in steps]).T
    expected = before - np.linalg.pinv(jacobian, rcond=1e-8) @ residual(before)
    polished = planted.polished(timed)
    after = np.concatenate([unknowns_of(polished.points), polished.theta2[:1] if timed else polished.theta2])
    assert np.abs(expected - before).max() > 1e-5
    np.testing.assert_allclose(after, expected, atol=1e-5 * np.abs(expected - before).max() + 1e-9)


@pytest.mark.parametrize("timed", [False, True])
def test_what_is_on_its_targets_stays(timed: bool) -> None:
    planted = Planted(1, 5)
    first = pivots(planted.unknowns, float(planted.theta2[0]), float(planted.assembly[0]))
    polished = polish_path(first, planted.theta2, 0.0, planted.assembly, wish_of(planted.targets, timed))
    np.testing.assert_allclose(polished.points, first, atol=1e-12)
    np.testing.assert_allclose(polished.theta2, planted.theta2, atol=1e-12)


def test_a_loop_that_does_not_close_has_no_error() -> None:
    planted = Planted(0, 5)
    first = np.array([0, 10, 1, 2, 1 + 1j], dtype=np.complex128)
    angles = np.linspace(0, 3, 5)
    assert np.isnan(polish_path(first, angles, 0.0, planted.assembly, wish_of(planted.targets, False)).error)


@pytest.mark.parametrize("count", [path_polish.MANY + 1, 400])
def test_many_driver_angles_are_eliminated_without_a_difference(
    count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(count)
    task, linkage = planted_path(rng, count)
    verdict = verify(linkage, task, Requirements(exact=True))
    points = task.positions @ np.array([1, 1j]) / task.size
    state = solve_position(linkage, verdict.theta2[:1], verdict.assembly[:1])
    places = [linkage.o2, linkage.o4, state.a[0], state.b[0], state.p[0]]
    begin = np.array(places) @ np.array([1, 1j]) / task.size + rng.normal(0, 1e-5, 5)
    none, every = np.zeros(count, dtype=bool), np.ones(count, dtype=bool)
    targets = ExactTargets(points, every, np.zeros(count), none, timed=False, closure=FOUR_BAR_CLOSURE)
    found = []
    for many in (path_polish.MANY, 1000):
        monkeypatch.setattr(path_polish, "MANY", many)
        found.append(polish_path(begin, verdict.theta2, 0.0, verdict.assembly.astype(float), targets))
    assert max(one.error for one in found) < 1e-12
    np.testing.assert_allclose(found[0].points, found[1].points, atol=1e-9)
