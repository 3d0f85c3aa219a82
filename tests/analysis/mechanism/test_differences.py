"""Central differences: their order and step, and the comparison with analytic values."""

from typing import Any

import numpy as np
import pytest

from grashof.analysis import central_differences, compare_differences
from grashof.problems import FourBar, ProblemError

NORTON = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80, coupler_point=(60, 20))


@pytest.mark.parametrize("derivative", [1, 2])
@pytest.mark.parametrize("accuracy", [2, 4])
def test_errors_fall_with_the_order_of_the_formula(derivative: int, accuracy: int) -> None:
    errors = []
    for count in (41, 81):
        time = np.linspace(0.2, 1.2, count)
        exact = (3 * np.cos(3 * time), -9 * np.sin(3 * time))[derivative - 1]
        found = central_differences(time, np.sin(3 * time), derivative, accuracy)
        assert np.isnan(found[[0, -1]]).all()
        errors.append(np.nanmax(np.abs(found - exact)))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(accuracy, abs=0.1)


def test_the_step_is_that_of_the_samples() -> None:
    # 361 deg in 76 samples: 4.8133 deg apart; the 5 deg of a rule of thumb would be 3.7 % low.
    theta2 = np.radians(np.linspace(0, 361, 76))
    for deviation in compare_differences(NORTON, theta2, 2.0):
        limit = 0.05 if deviation.accuracy == 2 else 0.005
        assert deviation.share < limit, deviation
        assert theta2[0] < deviation.theta2 < theta2[-1]


def test_the_report_finds_the_quickest_change(golden_linkages: dict[str, Any]) -> None:
    # At 8 deg of transmission angle, near theta2 = theta1, steps of 5 deg are far too coarse.
    linkage = golden_linkages["table7"]
    coarse, fine = (compare_differences(linkage, np.linspace(-3, 3, n)) for n in (73, 7201))
    by_name = {(d.quantity, d.accuracy): d for d in coarse}
    assert by_name["alpha4", 2].share > 0.1
    assert abs(by_name["alpha4", 2].theta2) < 0.3
    assert all(d.share < 2e-3 for d in fine)
    assert len(coarse) == 16


def test_vectors_are_differentiated_by_component() -> None:
    time = np.linspace(0, 1, 7)
    found = central_differences(time, np.stack([time, time**2], axis=-1), 2, 4)
    np.testing.assert_allclose(found[2:-2], [[0, 2]] * 3, atol=1e-11)


def test_bad_input_is_refused() -> None:
    with pytest.raises(ProblemError, match="not equally spaced"):
        central_differences([0, 1, 3], [0, 1, 3])
    with pytest.raises(ProblemError, match="accuracy 3"):
        central_differences([0, 1, 2], [0, 1, 3], accuracy=3)
    with pytest.raises(ProblemError, match="one row for each of 5"):
        central_differences([0, 1, 2], [0, 1, 3], accuracy=4)
    with pytest.raises(ProblemError, match="no sample"):
        compare_differences(FourBar((0, 0), (9, 0), 1, 1, 1), np.linspace(0, 1, 9))
