"""Taylor terms of the curve's polynomial: each is bounded, and each bound is reached."""

import numpy as np
import pytest

from grashof.problems.values.arrays import FloatArray
from grashof.synth.proof.curve.curve import Taylor

X, Y = 0.7, 0.4


def taylor(cubic: complex = 0, square: complex = 0, both: float = 0) -> Taylor:
    nothing = np.zeros(1)
    complexes = np.array([[cubic], [square], [0]], dtype=np.complex128)
    return Taylor(complexes[0], complexes[1], nothing + both, complexes[2], nothing, nothing)


def greatest(one: Taylor, *, parabola: bool) -> FloatArray:
    """Of the terms on a grid with its corners, with or without that of x^2."""
    x, y = np.meshgrid(np.linspace(-X, X, 41), np.linspace(-Y, Y, 41))
    w = x + 1j * y
    f = 2 * (one.cubic * w).real * np.abs(w) ** 2 + 2 * (one.square * w**2).real + one.both * np.abs(w) ** 2
    if not parabola:
        f = f - (one.both + 2 * one.square.real) * x**2
    most: FloatArray = np.abs(f).max()
    return most


@pytest.mark.parametrize(
    "one",
    [
        taylor(cubic=1),
        taylor(cubic=1j),
        taylor(square=1j),
        taylor(square=0.5, both=1),
        taylor(square=-0.5, both=1),
    ],
)
def test_bounds_of_single_terms_are_reached(one: Taylor) -> None:
    x, y = np.array([X]), np.array([Y])
    assert one.beyond_linear(x, y) == pytest.approx(greatest(one, parabola=True), rel=1e-12)
    assert one.beyond_parabola(x, y) == pytest.approx(greatest(one, parabola=False), rel=1e-12)


def test_bounds_hold_all_terms_together() -> None:
    rng = np.random.default_rng(0)
    x, y = np.array([X]), np.array([Y])
    for _ in range(200):
        cubic, square = (complex(*rng.normal(size=2)) for _ in range(2))
        one = taylor(cubic, square, float(rng.normal()))
        assert one.beyond_linear(x, y) >= greatest(one, parabola=True) * (1 - 1e-12)
        assert one.beyond_parabola(x, y) >= greatest(one, parabola=False) * (1 - 1e-12)
