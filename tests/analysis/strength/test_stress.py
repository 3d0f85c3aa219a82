"""The equivalent stress of a section, fibre by fibre."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from grashof.analysis.strength.strength import von_mises

SIZE = st.floats(0, 1e9) | st.just(0.0) | st.floats(1e-12, 1)


@given(SIZE, SIZE, SIZE)
def test_the_greatest_of_all_fibres(axial: float, bending: float, shear: float) -> None:
    y = np.linspace(0, 1, 20001)
    every = np.sqrt((axial + bending * y) ** 2 + 3 * (shear * (1 - y**2)) ** 2)
    found = float(von_mises(*map(np.float64, (axial, bending, shear))))
    assert every.max() * (1 - 1e-14) <= found <= every.max() * (1 + 1e-7)


def test_single_stresses() -> None:
    axial, bending, shear = np.array([[2.0, 0, 0], [0, 3.0, 0], [0, 0, 1.0]])
    np.testing.assert_allclose(von_mises(axial, bending, shear), [2, 3, np.sqrt(3)])


def test_a_fibre_in_between_may_be_worst() -> None:
    # At y = 0: 2, at y = 1: 2, in between more (Norton and Shigley look at these two alone).
    assert float(von_mises(*map(np.float64, (1.0, 1.0, 1.0)))) > 2.05
