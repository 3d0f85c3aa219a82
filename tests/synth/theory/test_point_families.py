"""Linkages through N points: against finite differences, cognates, the published number of solutions."""

import numpy as np
import pytest

from grashof.synth.theory.homotopy import corrected, follow
from grashof.synth.theory.point_families import FAMILIES, INVERTED_SLIDER_CRANKS, SLIDER_CRANKS, near
from grashof.synth.theory.solutions import collect, general_problem

KINDS = pytest.mark.parametrize("family", FAMILIES.values(), ids=FAMILIES)


def at(displacements, solutions):
    return np.broadcast_to(displacements, (len(solutions), len(displacements)))


def correction(family, solutions, displacements):
    """Greatest Newton correction of each solution, as a share of its greatest unknown."""
    _, moved = corrected(family.precise, solutions, at(displacements, solutions))
    return moved / np.abs(solutions).max(axis=1)


@KINDS
def test_slopes_are_those_of_finite_differences(family):
    rng = np.random.default_rng(0)
    size = family.size
    unknowns = rng.normal(size=(3, size)) + 1j * rng.normal(size=(3, size))
    displacements, change = rng.normal(size=(2, 3, 2 * size)) + 1j * rng.normal(size=(2, 3, 2 * size))
    turns = np.exp(1j * rng.uniform(0, 2 * np.pi, (3, size)))
    for system, here in (
        (family.system, unknowns),
        (family.with_turns, np.concatenate([unknowns, turns], axis=1)),
    ):
        _, jacobian, _ = system(here, displacements, change)
        for k, moved in enumerate(1e-6 * np.eye(here.shape[1])):
            ahead, back = (system(here + sign * moved, displacements, change)[0] for sign in (1, -1))
            assert np.abs((ahead - back) / 2e-6 - jacobian[:, :, k]).max() < 1e-7 * np.abs(jacobian).max()
    ahead, back = (
        family.system(unknowns, displacements + sign * 1e-6 * change, change)[0] for sign in (1, -1)
    )
    _, _, slope = family.system(unknowns, displacements, change)
    assert np.abs((ahead - back) / 2e-6 - slope).max() < 1e-7 * np.abs(slope).max()


@KINDS
@pytest.mark.parametrize("seed", range(2))
def test_a_general_problem_has_its_solution_and_so_has_what_is_turned_or_mirrored(family, seed):
    rng = np.random.default_rng(seed)
    displacements, solutions = general_problem(family, rng)
    factors = rng.normal(size=2) + 1j * rng.normal(size=2)
    swapped = np.concatenate([displacements[family.size :], displacements[: family.size]]).conj()
    for points, found in (
        (displacements, solutions),
        (displacements * np.repeat(factors, family.size), family.turned(solutions, factors)),
        (swapped, family.mirrored(solutions)),
    ):
        assert correction(family, found, points).max() < 1e-9
        turns, determined = family.turns(found, points)
        assert determined.all()
        both = np.concatenate([found, turns], axis=1)
        _, moved = corrected(family.with_turns, both, at(points, both))
        assert moved.max() < 1e-8 * np.abs(both).max()


@KINDS
def test_known_solutions_are_distinct_ones_as_many_as_published(family):
    displacements, solutions = family.known()
    assert correction(family, solutions, displacements).max() < 1e-10
    _, determined = family.turns(solutions, displacements)
    assert determined.all()
    assert len(family.distinct(solutions)) == len(solutions) == family.count


def test_slider_cranks_are_279_pairs_of_cognates_each_with_an_o2_of_its_own():
    displacements, solutions = SLIDER_CRANKS.known()
    r, rs, o2, o2s, c, cs, s = solutions.T
    a, as_, b, bs = o2 + r, o2s + rs, c / s, cs
    k, ks = a / (a - b), as_ / (as_ - bs)  # P is the origin
    b, bs, s = o2 + k * (b - o2), o2s + ks * (bs - o2s), s * ks / k
    cognates = np.stack([-a, -as_, o2, o2s, s * b, bs, s], axis=1)
    assert correction(SLIDER_CRANKS, cognates, displacements).max() < 1e-7
    assert np.abs(cognates - solutions).max(axis=1).min() > 1e-3
    assert len(SLIDER_CRANKS.distinct(np.concatenate([solutions, cognates]))) == 279
    apart = np.abs(o2[:, None] - o2) + np.abs(o2s[:, None] - o2s)
    assert (apart + np.eye(279)).min() > 1e-4
    assert 2 * SLIDER_CRANKS.count == 558  # Tari & Su 2010


@pytest.mark.slow
def test_inverted_slider_cranks_share_no_pivot():
    _, solutions = INVERTED_SLIDER_CRANKS.known()
    for pivot in (2, 4):
        places = solutions[:, pivot : pivot + 2]
        apart = np.abs(places[:, None] - places).max(axis=2)
        assert (apart + np.eye(len(apart))).min() > 1e-5


@pytest.mark.quick("slider-crank")
@pytest.mark.slow
@KINDS
def test_loops_from_one_solution_lead_to_known_ones(family):
    displacements, solutions = family.known()
    found = collect(family, displacements, solutions[:1], np.random.default_rng(5), 8)
    assert len(found) >= 8
    every = family.invariants(solutions)
    assert all(near(every, invariant).any() for invariant in family.invariants(found))


@pytest.mark.study
def test_other_points_have_as_many_slider_cranks():
    rng = np.random.default_rng(11)
    displacements, first = general_problem(SLIDER_CRANKS, rng)
    found = collect(SLIDER_CRANKS, displacements, first, rng, patience=3)
    assert len(found) == SLIDER_CRANKS.count


def cubic(s, q, dq):
    """s**3 + q0 s + q1 = 0."""
    return s**3 + q[:, :1] * s + q[:, 1:], (3 * s**2 + q[:, :1])[..., None], dq[:, :1] * s + dq[:, 1:]


def test_cubic_roots_are_all_found():
    rng = np.random.default_rng(0)
    start = np.array([0.3 - 0.2j, -1 + 0.4j])
    roots = np.roots([1, 0, *start])[:, None]
    for _ in range(20):
        target = rng.normal(size=2) + 0j
        found, reached = follow(cubic, roots, start, target)
        assert reached.all()
        expected = np.roots([1, 0, *target])
        gap = np.abs(found - expected)
        assert max(gap.min(axis=0).max(), gap.min(axis=1).max()) < 1e-6


def test_root_that_goes_to_infinity_is_not_reached():
    def line(s, q, dq):  # q s = 1
        return q * s - 1, q[..., None], dq * s

    _, reached = follow(line, np.array([[1.0 + 0j]]), np.array([1.0 + 0j]), np.array([0j]))
    assert not reached.any()


def test_path_into_a_singular_point_is_given_up():
    def square(s, q, dq):  # both roots meet half-way
        return s**2 - q, 2 * s[..., None], -dq

    _, reached = follow(square, np.array([[1.0 + 0j], [-1.0]]), np.array([1.0 + 0j]), np.array([-1.0 + 0j]))
    assert not reached.any()
