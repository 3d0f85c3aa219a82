"""Peaks of several curves at once."""

import numpy as np
import numpy.typing as npt
import pytest

from grashof.analysis.numerics.peaks import crests, greatest, peaks

Floats = npt.NDArray[np.float64]


def test_peaks_are_right_to_rounding_and_each_curve_has_its_own() -> None:
    rng = np.random.default_rng(3)
    at, waves = rng.uniform(0.1, 6.1, 20), rng.integers(1, 6, 20)

    def curves(x: Floats) -> Floats:  # sharper and sharper about a place that no sample hits
        return np.exp(waves[:, None] * (np.cos(x - at[:, None]) - 1))

    values, places = peaks(curves, [np.linspace(0, 2 * np.pi, 200)])
    np.testing.assert_allclose(values, 1, rtol=1e-14)
    np.testing.assert_allclose(places, at, atol=1e-7)


def test_a_kink_and_an_end_may_be_the_highest() -> None:
    values, places = peaks(lambda x: np.stack([-np.abs(x - 0.7654321), x**2, -x]), [np.linspace(0, 2, 50)])
    np.testing.assert_allclose(values, [0, 4, 0], atol=1e-5)
    np.testing.assert_allclose(places, [0.7654321, 2, 0], atol=1e-5)


def test_curves_are_never_evaluated_beyond_their_ends() -> None:
    rng = np.random.default_rng(0)
    beyond = 0
    for _ in range(200):
        samples = np.sort(rng.normal(size=3))
        middle, high = samples[1:]
        beyond += middle + (high - middle) > high  # by rounding

        def curves(x: Floats, samples: Floats = samples) -> Floats:
            assert ((x >= samples[0]) & (x <= samples[-1])).all()
            return np.stack([x, -x])

        np.testing.assert_allclose(peaks(curves, [samples])[0], [samples[-1], -samples[0]])
    assert beyond


def test_nan_counts_as_infinite_in_its_own_curve_alone() -> None:
    def curves(x: Floats) -> Floats:
        with np.errstate(divide="ignore"):
            return np.stack([np.where(x == 1.0, np.nan, x), np.cos(x), 1 / (x - 1.0) ** 2])

    values, places = peaks(curves, [np.linspace(0, 2, 101)])
    np.testing.assert_array_equal(values, [np.inf, 1, np.inf])
    np.testing.assert_array_equal(places, [1, 0, 1])


def test_the_highest_of_several_stretches() -> None:
    stretches = [np.linspace(0, 1, 30), np.linspace(2, 3, 30)]
    values, places = peaks(lambda x: np.stack([-np.abs(x - 1.4), -np.abs(x - 1.6)]), stretches)
    np.testing.assert_allclose(values, [-0.4, -0.4])
    np.testing.assert_allclose(places, [1, 2])


@pytest.mark.parametrize("rounds", [2, 5, 9])
def test_each_round_finds_a_kink_eight_times_as_closely(rounds: int) -> None:
    _, places = greatest(lambda x: -np.abs(x - 0.7654321), np.linspace(0, 2, 50), rounds=rounds)
    assert abs(places[0] - 0.7654321) <= 2 * (2 / 49) / 8**rounds + 1e-15


def test_kinks_are_found_almost_to_rounding_and_jumps_to_a_thousandth_of_the_spacing() -> None:
    rng = np.random.default_rng(4)
    at, rise, fall = rng.uniform(0.5, 5.5, 40), rng.uniform(0.1, 5, 40), rng.uniform(0.1, 5, 40)

    def kinks(x: Floats) -> Floats:
        away = x - at[:, None]
        return np.minimum(rise[:, None] * np.expm1(away / 2), -fall[:, None] * np.sinh(away))

    def jumps(x: Floats) -> Floats:
        away = x - at[:, None]
        return np.where(away <= 0, rise[:, None] * away, -10.0)

    dense = np.linspace(0, 6, 721)
    np.testing.assert_allclose(peaks(kinks, [dense])[0], 0, atol=1e-11)
    np.testing.assert_allclose(peaks(jumps, [dense])[1], at, atol=1e-3 * dense[1])


@pytest.mark.parametrize("count", [97, 721])
def test_places_of_smooth_peaks_have_more_than_half_of_the_digits(count: int) -> None:
    rng = np.random.default_rng(5)
    at, skew = rng.uniform(1, 5, 100)[:, None], rng.uniform(-0.3, 0.3, 100)[:, None]
    _, places = peaks(
        lambda x: np.exp(3 * np.cos(x - at)) * (1 + skew * np.sin(x - at) ** 3), [np.linspace(0, 6.28, count)]
    )
    np.testing.assert_allclose(places, at[:, 0], atol=1e-9)


def test_crests_of_infinite_and_missing_values() -> None:
    before, here, after = np.array(
        [[0, np.inf, np.inf, 0, np.nan], [1, 0, np.inf, np.inf, 0], [0, 0, 1, np.inf, 0]]
    )
    np.testing.assert_array_equal(crests(before, here, after), [1, np.inf, np.inf, np.inf, np.nan])


def test_rows_that_repeat_their_last_place_are_unchanged() -> None:
    """Three maxima, one at the end, which must not displace the others."""

    def curves(x: Floats) -> Floats:
        return np.stack([np.sin(3 * x) + x, np.cos(5 * x)])

    short, long = np.linspace(0, 4, 40), np.linspace(0, 5, 55)
    padded = np.stack([np.pad(short, (0, 15), mode="edge"), long])
    values, places = peaks(curves, [padded])
    for row, each in enumerate((short, long)):
        np.testing.assert_array_equal((values[:, row], places[:, row]), peaks(curves, [each]))
