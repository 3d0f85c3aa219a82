"""Paths of solutions: to known roots, and to infinity."""

import numpy as np

from grashof.synth.theory.homotopy import follow


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
