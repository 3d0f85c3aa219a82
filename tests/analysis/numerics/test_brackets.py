"""Brackets of least values against the places where they are."""

from collections.abc import Callable

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from grashof.analysis.numerics.brackets import closer
from grashof.problems.values.arrays import FloatArray

ROUNDS = 6


def narrowed(function: Callable[[FloatArray], FloatArray], low: float, high: float) -> FloatArray:
    """The places after some rounds."""
    places = np.linspace(low, high, 17)[None]
    for _ in range(ROUNDS):
        places = closer(places, function(places))
    return places[0]


@given(
    at=st.floats(-0.9, 0.9), left=st.floats(0.01, 100), right=st.floats(0.01, 100), bend=st.floats(0, 1),
)  # fmt: skip
def test_a_kink_is_found_in_a_few_rounds(at: float, left: float, right: float, bend: float) -> None:
    def kinked(x: FloatArray) -> FloatArray:
        away = x - at
        return np.maximum(-left * away, right * away) * (1 + bend * away**2)

    places = narrowed(kinked, -1.0, 1.0)
    assert np.ptp(places) < 1e-9
    assert places[0] - 1e-12 <= at <= places[-1] + 1e-12
    assert (np.diff(places) >= 0).all()


@given(at=st.floats(-0.9, 0.9), bend=st.floats(0.01, 100))
def test_a_smooth_bottom_is_found_to_half_of_the_digits(at: float, bend: float) -> None:
    places = narrowed(lambda x: bend * (np.cosh(x - at) - 1), -1.0, 1.0)
    assert places[0] - 1e-7 <= at <= places[-1] + 1e-7
    assert np.ptp(places) < 1e-6


@given(at=st.floats(-0.9, 0.9), sense=st.sampled_from([1, -1]))
def test_a_bottom_at_the_end_of_what_is_allowed_is_kept(at: float, sense: int) -> None:
    places = narrowed(lambda x: np.where(sense * (x - at) >= 0, 1 + sense * x, np.inf), -1.0, 1.0)
    assert places[0] - 1e-12 <= at <= places[-1] + 1e-12
    assert np.ptp(places) < 1e-6


def test_rows_do_not_depend_on_each_other_and_keep_the_lowest_of_all() -> None:
    rng = np.random.default_rng(0)
    places = np.sort(rng.uniform(-1, 1, (5, 17)), axis=1)
    values = rng.uniform(0, 1, (5, 17))
    values[3, 9] = -1.0
    values[3, [8, 10]] = np.inf  # alone
    together = closer(places, values)
    for row in range(5):
        assert (together[row] == closer(places[row, None], values[row, None])[0]).all()
        assert places[row, values[row].argmin()] in together[row]
