"""Fourier series of closed curves: known harmonics, Parseval, the coupler curve reconstructed."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad_vec

from grashof.analysis import solve_position
from grashof.analysis.curves.fourier import coupler_fourier, coupler_harmonics, fourier_series
from grashof.analysis.judge.planted import random_full_crank
from grashof.problems import FourBar, ProblemError


@given(count=st.integers(3, 24), seed=st.integers(0, 2**16))
def test_it_passes_through_its_samples_and_errors_are_those_of_the_truncated_series(
    count: int, seed: int
) -> None:
    points = np.random.default_rng(seed).normal(size=(count, 2))
    series = fourier_series(points)
    angle = np.arange(count) * 2 * np.pi / count
    np.testing.assert_allclose(series(angle), points, atol=1e-12)
    assert series.harmonics.tolist() == list(range(-(count // 2), count // 2 + 1))
    assert series.content.sum() == pytest.approx(1)
    for up_to in range(count // 2 + 1):
        miss = np.linalg.norm(series(angle, up_to) - points, axis=-1)
        assert series.error_max[up_to] == pytest.approx(miss.max(), abs=1e-12)
        assert series.error_rms[up_to] == pytest.approx(np.sqrt((miss**2).mean()), abs=1e-12)
        left = series.coefficients[np.abs(series.harmonics) > up_to]
        if up_to < count // 2 - 1:  # the shared highest harmonic of an even number adds up otherwise
            top = series.coefficients[0] if count % 2 == 0 else 0.0
            parseval = (np.abs(left) ** 2).sum() + 2 * abs(top) ** 2
            assert series.error_rms[up_to] ** 2 == pytest.approx(parseval, abs=1e-12)


def test_known_harmonics_are_found() -> None:
    known = {-3: 0.2j, -1: 1.0, 0: 2 - 1j, 1: -3.0, 4: 0.5 + 0.1j}
    angle = np.arange(11) * 2 * np.pi / 11
    z = sum(c * np.exp(1j * k * angle) for k, c in known.items())
    series = fourier_series(np.stack([z.real, z.imag], axis=-1))
    for k, c in zip(series.harmonics, series.coefficients, strict=True):
        assert c == pytest.approx(known.get(int(k), 0), abs=1e-14)
    power = np.array([1 + 9, 0, 0.04, 0.26, 0])
    np.testing.assert_allclose(series.content, power / power.sum(), atol=1e-14)


NEARLY_DEAD = FourBar((0, 0), (4, 0), 2, 4.5, 2.501, (2, 1))
CRANKS = [random_full_crank(np.random.default_rng(seed)) for seed in range(3)]


@pytest.mark.quick("linkage0", "linkage3")
@pytest.mark.parametrize("linkage", [NEARLY_DEAD, *CRANKS])
def test_first_harmonics_are_those_of_the_curve_itself(linkage: FourBar) -> None:
    """Near a change point too: compared with adaptive quadrature and a dense search."""
    first = coupler_harmonics(linkage, top=4)
    theta1, harmonics = float(linkage.theta1), np.arange(-4, 5)

    def moments(theta2: float) -> np.ndarray:
        z = complex(*(solve_position(linkage, theta2).p - linkage.o2))
        return np.append(z * np.exp(-1j * harmonics * theta2), abs(z) ** 2) / (2 * np.pi)

    integral = quad_vec(
        moments, theta1, theta1 + 2 * np.pi, epsabs=1e-12, epsrel=1e-12, points=[theta1 + np.pi]
    )[0]
    expected, square = integral[:-1], integral[-1].real
    size = np.sqrt(square)
    shifted = expected + np.where(harmonics == 0, complex(*linkage.o2), 0.0)
    np.testing.assert_allclose(first.coefficients, shifted, rtol=0, atol=1e-11 * size)
    power = np.abs(expected) ** 2
    both = power[5:] + power[:4][::-1]
    np.testing.assert_allclose(first.content, both / (square - power[4]), rtol=1e-9)
    near = np.concatenate([sign * np.logspace(-7, 0.5, 6000) for sign in (-1, 1)])
    dense = theta1 + np.concatenate([np.linspace(0, 2 * np.pi, 100_001), near, np.pi + near])
    p = solve_position(linkage, dense).p
    for up_to in range(5):
        miss = np.hypot(*(first(dense, up_to) - p).T)
        assert miss.max() <= first.error_max[up_to] * (1 + 1e-9)
        assert first.error_max[up_to] == pytest.approx(miss.max(), rel=1e-5)
        left = square - power[np.abs(harmonics) <= up_to].sum()
        assert first.error_rms[up_to] == pytest.approx(np.sqrt(left), rel=1e-8)


def test_first_harmonics_of_the_crank_pin() -> None:
    first = coupler_harmonics(FourBar(o2=(1, 2), o4=(5, 2), r2=1.5, r3=4, r4=3.2))
    assert first.content.tolist() == [pytest.approx(1), 0, 0, 0, 0]
    assert first.error_max.tolist() == [pytest.approx(1.5), 0, 0, 0, 0, 0]


def test_bad_input_is_refused() -> None:
    with pytest.raises(ProblemError, match="top is 0"):
        coupler_harmonics(NEARLY_DEAD, top=0)
    with pytest.raises(ProblemError, match="does not turn fully"):
        coupler_harmonics(FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3))
    with pytest.raises(ProblemError, match="there are 2 points"):
        fourier_series([[0, 0], [1, 1]])
    with pytest.raises(ProblemError, match="does not turn fully"):
        coupler_fourier(FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3))
