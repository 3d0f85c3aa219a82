"""Driver angles to sample a motion at."""

import numpy as np
import numpy.typing as npt
import pytest

from grashof.analysis import driver_samples, solve_kinematics
from grashof.analysis.numerics.peaks import peaks
from grashof.problems import FourBar


@pytest.mark.parametrize(("start", "end"), [(0.0, 2 * np.pi), (1.0, 0.5), (-9.0, 4.0), (0.2, 0.2001)])
def test_samples_ascend_from_end_to_end(start: float, end: float) -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 1), r2=1, r3=4, r4=3)
    samples = driver_samples(linkage, start, end)
    assert (np.diff(samples) > 0).all()
    assert (samples[0], samples[-1]) == (min(start, end), max(start, end))
    assert np.diff(samples).max() <= (abs(end - start)) * np.pi / 960 * 1.001


def test_the_ground_line_is_sampled_closely() -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 1), r2=1, r3=4, r4=3)
    samples = driver_samples(linkage, 0.0, 2 * np.pi)
    for aligned in linkage.theta1 + np.array([0, np.pi]):
        assert np.abs(samples - aligned).min() == 0
        assert (np.abs(samples - aligned) < 1e-6).sum() > 5


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6])
def test_no_peak_of_a_linkage_that_just_passes_a_dead_position_is_missed(gap: float) -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=2.5, r4=2.5 + gap)  # folded at theta2 = pi: 5 + gap

    def speed(theta2: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return np.abs([solve_kinematics(linkage, theta2).omega4])

    found = peaks(speed, [driver_samples(linkage, 0.0, 2 * np.pi)])[0]
    near = np.pi + np.concatenate([sign * np.logspace(-9, 0, 400_000) for sign in (-1, 1)])
    assert found == pytest.approx(speed(near).max(), rel=1e-8)
