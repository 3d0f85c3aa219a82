"""The closed loop, against the lengths that it is made of and against the judge."""

import numpy as np
import pytest

from grashof.analysis import solve_position
from grashof.analysis.judge.planted import random_full_crank
from grashof.synth.theory.closure import coupler_of


@pytest.mark.parametrize("seed", range(20))
def test_the_loop_is_that_of_the_judge(seed: int) -> None:
    rng = np.random.default_rng(seed)
    linkage = random_full_crank(rng)
    state = solve_position(linkage, rng.uniform(-np.pi, np.pi, 50))
    diagonal = (linkage.o4 - state.a) @ [1, 1j]
    coupler = coupler_of(diagonal, linkage.r3, linkage.r4, linkage.assembly)
    np.testing.assert_allclose(coupler, (state.b - state.a) @ [1, 1j], rtol=0, atol=1e-9 * linkage.r3)


def test_where_the_loop_is_open_there_is_no_number() -> None:
    coupler = coupler_of(np.array([5.1j, 4 + 0j, 0.5]), np.float64(3), np.float64(2), np.float64(1))
    assert np.isnan(coupler).tolist() == [True, False, True]
    assert abs(coupler[1]) == pytest.approx(3)
    assert abs(coupler[1] - 4) == pytest.approx(2)
    assert coupler[1].imag > 0  # B left of the line from A to O4
