"""Integrals with a known value: smooth, narrow, with kinks, jumps and poles, and divergent ones."""

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from grashof.analysis.numerics.quadrature import gauss_legendre, held, integrate, settled_sums

Floats = npt.NDArray[np.float64]
INSIDE = st.floats(0.01, 0.99)


@given(at=INSIDE)
def test_kinks_and_jumps_wherever_they_lie(at: float) -> None:
    found = integrate(lambda x: np.stack([np.abs(x - at), np.sign(x - at), np.exp(x)]), [0.0, 0.5, 1.0])
    exact = [(at**2 + (1 - at) ** 2) / 2, 1 - 2 * at, np.e - 1]
    assert (np.abs(found.total - exact) <= found.error).all()
    assert (found.error < 1e-11).all()


@pytest.mark.parametrize("h", [1e-2, 1e-3, 1e-6])
def test_a_narrow_peak(h: float) -> None:
    """1 / ((x - 0.3)^2 + h^2) has an arctangent as integral."""
    found = integrate(lambda x: 1 / ((x - 0.3) ** 2 + h**2), [0.0, 1.0])
    exact = (np.arctan(0.7 / h) + np.arctan(0.3 / h)) / h
    assert abs(found.total - exact) <= max(found.error, 1e-14 * exact)
    assert found.error < 1e-9 * exact


def test_a_table_of_loads() -> None:
    rows = np.random.default_rng(0).normal(size=37)
    found = integrate(lambda x: np.interp(x, np.arange(37), rows), np.linspace(0, 36, 8))
    assert found.total == pytest.approx(np.trapezoid(rows), abs=float(found.error))
    assert found.error < 1e-10


def test_divergent_integrals_are_detected() -> None:
    """1 / x grows equally with each halving, 1 / sqrt(x) less and less."""
    found = integrate(lambda x: np.stack([1 / x, x**-1.5, 1 / np.sqrt(x)]), [0.0, 1.0])
    assert np.isinf(found.error[:2]).all()
    assert abs(found.total[2] - 2) <= found.error[2] < 1e-7
    assert np.isnan(held(float(found.total[0]), float(found.error[0])))
    nowhere = integrate(lambda x: np.where(x > 0.5, np.nan, x), [0, 1])
    assert np.isnan(held(float(nowhere.total), float(nowhere.error)))


def test_reversed_edges_change_the_sign() -> None:
    there, back = (integrate(np.cos, ends) for ends in ([0.0, 0.2, 1.0], [1.0, 0.2, 0.0]))
    assert there.total == pytest.approx(np.sin(1), abs=1e-15)
    assert back.total == pytest.approx(-np.sin(1), abs=1e-15)
    assert there.error == pytest.approx(back.error)


def test_sums_that_settle_at_once_are_the_integrals_and_others_are_told_apart() -> None:
    def curves(x: Floats) -> Floats:
        smooth, kinked, jump = x
        return np.stack([np.cos(3 * smooth), np.abs(kinked - 0.4), np.where(jump > 0.5005, 1.0, 0.0)])

    edges = np.array([[0.0, 0.5, 1.0], [0.0, 0.3, 1.0], [0.0, 0.5, 1.0]])
    sums, settled = settled_sums(curves, edges)
    assert settled.tolist() == [True, False, False]
    assert sums[0] == pytest.approx(np.sin(3) / 3, abs=1e-15)
    whole = integrate(lambda x: np.cos(3 * x), edges[0]).total
    assert sums[0] == pytest.approx(float(whole), abs=1e-16)
    backwards, _ = settled_sums(lambda x: np.cos(3 * x), edges[:1, ::-1])
    assert backwards == pytest.approx(-np.sin(3) / 3, abs=1e-15)


@given(st.lists(INSIDE, min_size=1, max_size=20))
def test_integrals_up_to_places_between(places: list[float]) -> None:
    def curves(x: Floats) -> Floats:
        return np.stack([np.cos(5 * x), np.abs(x - 0.4)])

    found, at = integrate(curves, [0.0, 1.0]), np.sort([0.0, *places, 1.0])
    kinked = np.where(at < 0.4, 0.08 - (0.4 - at) ** 2 / 2, 0.08 + (at - 0.4) ** 2 / 2)
    np.testing.assert_allclose(found.until(curves, at), [np.sin(5 * at) / 5, kinked], atol=1e-13)


def test_nodes_and_weights_are_exact_for_polynomials() -> None:
    place, weight = gauss_legendre(np.array([-1.0, 0.5, 2.0]))
    assert weight @ place**31 == pytest.approx((2.0**32 - 1) / 32, rel=1e-13)
