"""Conic intersections: four points on both conics, whatever way they meet."""

import numpy as np
import pytest

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.theory.conics import conic_intersections, nearest_real

CIRCLE = np.diag([1.0, 1.0, -1.0])


def plane(points: ComplexArray) -> ComplexArray:
    return points[:, :2] / points[:, 2:]


def ellipse(a: float, b: float, x: float = 0.0) -> FloatArray:
    """(X - x)^2 / a^2 + Y^2 / b^2 = 1."""
    return np.array([[1 / a**2, 0, -x / a**2], [0, 1 / b**2, 0], [-x / a**2, 0, x**2 / a**2 - 1]])


def test_random_conics_meet_in_four_different_points() -> None:
    rng = np.random.default_rng(5)
    first, second = (conics + conics.transpose(0, 2, 1) for conics in rng.normal(size=(2, 2000, 3, 3)))
    points = conic_intersections(first, second)
    for conic in (first, second):
        values = np.einsum("mki,mij,mkj->mk", points, conic, points)
        assert np.abs(values).max() < 1e-14 * np.abs(conic).max()
    np.testing.assert_allclose(np.linalg.norm(points, axis=-1), 1)
    for i in range(4):
        for j in range(i):
            parallel = np.abs((points[:, i].conj() * points[:, j]).sum(axis=-1))
            assert parallel.max() < 1 - 1e-9


def test_points_that_meet_the_axes_are_found() -> None:
    """Two and two with one abscissa and one ordinate: the elimination alone could not distinguish them."""
    found = plane(conic_intersections(CIRCLE[None], ellipse(2, 0.5)[None])[0])
    x, y = np.sqrt(0.8), np.sqrt(0.2)  # x^2 + y^2 = 1 and x^2 / 4 + 4 y^2 = 1
    assert {(round(a * 1e9), round(b * 1e9)) for a, b in found.real} == {
        (round(s * x * 1e9), round(t * y * 1e9)) for s in (-1, 1) for t in (-1, 1)
    }
    assert np.abs(found.imag).max() < 1e-12


def test_circles_meet_in_the_circular_points() -> None:
    points = conic_intersections(CIRCLE[None], ellipse(1, 1, x=1.0)[None])[0]
    points = points[np.argsort(np.abs(points[:, 2]))]
    np.testing.assert_allclose(points[:2, 2], 0, atol=1e-12)
    np.testing.assert_allclose(points[:2, 0] ** 2, -(points[:2, 1] ** 2), atol=1e-12)
    found = plane(points[2:])
    np.testing.assert_allclose(found[:, 0], 0.5)
    np.testing.assert_allclose(np.sort(found[:, 1].real), [-np.sqrt(0.75), np.sqrt(0.75)])


def test_conics_that_touch_meet_twice_there() -> None:
    found = plane(conic_intersections(CIRCLE[None], ellipse(2, 0.5, x=-1.0)[None])[0])
    assert np.sort(np.abs(found - [1, 0]).max(axis=1))[1] < 1e-6


@pytest.mark.parametrize("other", [CIRCLE, np.zeros((3, 3)), np.diag([1.0, 0, 0])])
def test_conics_without_four_points_do_no_harm(other: FloatArray) -> None:
    points = conic_intersections(CIRCLE[None], other[None])
    assert points.shape == (1, 4, 3)
    assert np.isfinite(points).all()


def test_no_conics() -> None:
    assert conic_intersections(np.empty((0, 3, 3)), np.empty((0, 3, 3))).shape == (0, 4, 3)


def test_nearest_real_sees_through_a_phase() -> None:
    rng = np.random.default_rng(2)
    real = rng.normal(size=(50, 3))
    real /= np.linalg.norm(real, axis=-1, keepdims=True)
    turned = real * np.exp(1j * rng.uniform(-np.pi, np.pi, (50, 1)))
    found, imaginary = nearest_real(turned)
    np.testing.assert_allclose(np.abs((found * real).sum(axis=-1)), 1)
    assert imaginary.max() < 1e-14
    assert nearest_real(np.array([1, 1j, 0]) / np.sqrt(2))[1] == pytest.approx(np.sqrt(0.5))
