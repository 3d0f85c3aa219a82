"""Polishing of designs onto places, angles, or both: quadratically, with a closure of our own."""

import numpy as np
import pytest

from grashof.analysis.judge.planted import random_full_crank, uneven_driver_angles
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.synth.loop.dimensions import FOUR_BAR_CLOSURE as BARS
from grashof.synth.theory import polish as path_polish
from grashof.synth.theory.polish import ExactTargets, Polished, polish_path

# How many targets, which have no place, which no angle; fewer equations than unknowns or as many.
CASES: dict[str, tuple[int, list[int], list[int]]] = {
    "five whole": (5, [], []),
    "seven, four angles free": (7, [], [1, 2, 4, 5]),
    "six, two places free": (6, [1, 3], []),
    "mixed": (6, [2], [0, 4]),
    "angles but for one place": (7, [1, 2, 3, 4, 5, 6], []),
}


def circles_meet(
    o2: complex, o4: complex, lengths: FloatArray, theta2: FloatArray, side: FloatArray
) -> tuple[ComplexArray, ComplexArray]:
    """A and B by circle intersection."""
    r2, r3, r4 = lengths
    a = o2 + r2 * np.exp(1j * theta2)
    distance = np.abs(o4 - a)
    foot = (distance**2 + r3**2 - r4**2) / (2 * distance)
    return a, a + (foot + 1j * side * np.sqrt(r3**2 - foot**2)) * (o4 - a) / distance


class Planted:
    """A linkage of one size or so, the poses it takes, and one that is a little off."""

    def __init__(self, seed: int, case: str, off: float = 1e-4) -> None:
        count, places, angles = CASES[case]
        rng = np.random.default_rng([61, seed])
        linkage = random_full_crank(rng)
        scale = float(linkage.r3)
        ground = complex(*(linkage.o4 - linkage.o2)) / scale
        lengths = np.array([linkage.r2, linkage.r3, linkage.r4], dtype=float) / scale
        arm, self.body_angle = complex(*linkage.coupler_point) / scale, float(linkage.body_angle)
        self.theta2, self.side = uneven_driver_angles(rng, count), np.full(count, float(linkage.assembly))
        a, b = circles_meet(0j, ground, lengths, self.theta2, self.side)
        e3 = (b - a) / lengths[1]
        points, turns = a + arm * e3, np.angle(e3) + self.body_angle + 2 * np.pi * rng.integers(-1, 2, count)
        has_point, has_turn = np.ones(count, dtype=bool), np.ones(count, dtype=bool)
        has_point[places], has_turn[angles] = False, False
        self.targets = ExactTargets(
            np.where(has_point, points, 0),
            has_point,
            np.where(has_turn, turns, 0),
            has_turn,
            False,
            BARS,
        )
        near = lengths + rng.normal(0, off, 3)
        o2, o4, near_arm = (z + complex(*rng.normal(0, off, 2)) for z in (0j, ground, arm))
        self.near_angles, self.near_body = self.theta2 + rng.normal(0, off, count), self.body_angle + off
        a, b = circles_meet(o2, o4, near, self.near_angles, self.side)
        self.near = np.array([o2, o4, a[0], b[0], a[0] + near_arm * (b[0] - a[0]) / near[1]])

    def polished(self) -> Polished:
        return polish_path(self.near, self.near_angles, self.near_body, self.side, self.targets)


def missed(polished: Polished, side: FloatArray, targets: ExactTargets) -> tuple[float, float]:
    """Greatest miss of places and of angles, from what was polished alone."""
    o2, o4, a, b, p = polished.points
    lengths = np.abs(np.array([a - o2, b - a, b - o4]))
    at_a, at_b = circles_meet(complex(o2), complex(o4), lengths, polished.theta2, side)
    e3 = (at_b - at_a) / lengths[1]
    at_p = at_a + (p - a) / (b - a) * lengths[1] * e3
    turned = np.angle(e3 * np.exp(1j * (polished.body_angle - targets.turns)))
    places: BoolArray = targets.has_point
    return float(np.abs(at_p - targets.points)[places].max()), float(np.abs(turned[targets.has_turn]).max())


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("seed", range(4))
def test_it_ends_on_what_is_wished(case: str, seed: int) -> None:
    planted = Planted(seed, case)
    polished = planted.polished()
    assert polished.error < 1e-12
    assert max(missed(polished, planted.side, planted.targets)) < 1e-11
    o2, o4, a, b, _ = polished.points
    lengths = np.abs(np.array([a - o2, b - a, b - o4]))
    at_a, at_b = circles_meet(complex(o2), complex(o4), lengths, polished.theta2, planted.side)
    np.testing.assert_allclose(polished.coupler, at_b - at_a, atol=1e-11)
    # No farther than it has to: the planted one is within a hundred times what was put off.
    assert np.abs(polished.points - planted.near).max() < 1e-2


@pytest.mark.parametrize("case", CASES)
def test_errors_fall_quadratically(case: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for seed in range(4):
        planted, errors = Planted(seed, case), []
        for steps in range(5):
            monkeypatch.setattr(path_polish, "STEPS", steps)
            monkeypatch.setattr(path_polish, "MORE", 0)
            errors.append(planted.polished().error)
        assert errors[0] > 1e-5
        assert errors[1] < 0.1 * errors[0]
        assert errors[3] < max(1e5 * errors[2] ** 2, 1e-13)
        assert errors[4] < max(1e5 * errors[3] ** 2, 1e-13)
        assert errors[4] < 1e-13


def test_what_is_free_does_not_pull(monkeypatch: pytest.MonkeyPatch) -> None:
    """Other numbers where nothing is wished lead to the same design."""
    planted = Planted(1, "mixed")
    targets = planted.targets
    other = ExactTargets(
        np.where(targets.has_point, targets.points, 5 - 3j),
        targets.has_point,
        np.where(targets.has_turn, targets.turns, 1.0),
        targets.has_turn,
        False,
        BARS,
    )
    here = planted.polished()
    there = polish_path(planted.near, planted.near_angles, planted.near_body, planted.side, other)
    np.testing.assert_array_equal(here.points, there.points)
    assert here.body_angle == there.body_angle


def test_turns_of_a_whole_turn_more_are_the_same() -> None:
    planted = Planted(2, "five whole")
    targets = planted.targets
    more = ExactTargets(
        targets.points, targets.has_point, targets.turns + 2 * np.pi, targets.has_turn, False, BARS
    )
    there = polish_path(planted.near, planted.near_angles, planted.near_body, planted.side, more)
    np.testing.assert_allclose(there.points, planted.polished().points, atol=1e-12)


def test_timed_poses_keep_the_gaps_of_the_driver() -> None:
    """Three whole poses and prescribed gaps: nine equations, eleven unknowns."""
    for seed in range(4):
        planted = Planted(seed, "five whole")
        targets = planted.targets
        three = ExactTargets(
            targets.points[:3], targets.has_point[:3], targets.turns[:3], targets.has_turn[:3], True, BARS
        )
        angles = planted.theta2[:3] + 1e-4
        polished = polish_path(planted.near, angles, planted.near_body, planted.side[:3], three)
        assert max(missed(polished, planted.side[:3], three)) < 1e-11
        np.testing.assert_allclose(np.diff(polished.theta2), np.diff(angles), atol=1e-14)
