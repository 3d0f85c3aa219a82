"""Even motions: their definition and ends, means by quadrature over them, and samples of the driver."""

import numpy as np
import numpy.typing as npt
import pytest
from drawn_linkages import SMOOTH, SWINGING, of_each_class
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import ellipkinc, ellipkm1

from grashof.analysis import (
    DriverLaw,
    dead_ends,
    driver_ranges,
    driver_samples,
    even_motion,
    solve_kinematics,
    solve_position,
    transmission_angle,
)
from grashof.analysis.mechanism.driver_law import mean_in_time, mean_over
from grashof.analysis.mechanism.first_motion import FirstMotion, _landen
from grashof.analysis.mechanism.transmission import quality
from grashof.analysis.numerics.peaks import peaks
from grashof.problems import FourBar
from grashof.problems.values.dynamics.motor import MotorSpec

TURN = 2 * np.pi
NEARLY = [
    FourBar((0, 0), (4, 0), 2, 4.5, 2.501),
    FourBar((1, 2), (5, 2), 2, 4.5, 2.499),
    FourBar((0, 0), (0, 4), 2, 3, 3.0001, assembly=-1),
    FourBar((0, 0), (0, 4), 2, 3, 2.9999),
    FourBar((0, 0), (-4, 0), 2, 4.5, 2.5 + 1e-7),
]


def check_evenness(linkage: FourBar, start: float, end: float) -> None:
    """D theta2 / dt is proportional to sin mu, which makes t an elliptic integral."""
    motion, share = even_motion(linkage, start, end), np.linspace(0, 1, 41)
    theta2 = motion.theta2(share)
    assert (theta2[0], theta2[-1]) == (start, end)
    assert (np.diff(theta2) * np.sign(end - start) > 0).all()
    np.testing.assert_allclose(motion.share(theta2[1:-1]), share[1:-1], atol=1e-9)
    quotient = motion.rate(share)[1:-1] / np.sin(transmission_angle(linkage, theta2[1:-1]))
    np.testing.assert_allclose(quotient, quotient[20], rtol=2e-8)
    h = 1e-6
    slope = (motion.theta2(share[1:-1] + h) - motion.theta2(share[1:-1] - h)) / (2 * h)
    np.testing.assert_allclose(motion.rate(share)[1:-1], slope, atol=1e-6 * np.abs(slope).max())


def ranges(linkage: FourBar) -> list[tuple[float, float]]:
    return [(low, high) for low, high in driver_ranges(linkage).tolist() if low < high]


@of_each_class(*SMOOTH, part=st.tuples(st.floats(0.1, 0.4), st.floats(0.6, 0.9)))
def test_the_driver_goes_as_the_sine_of_mu(linkage: FourBar, part: tuple[float, float]) -> None:
    for low, high in ranges(linkage):
        check_evenness(linkage, low, high)
        check_evenness(linkage, high + TURN, low + TURN)
        check_evenness(linkage, *(low + (high - low) * np.array(part)).tolist())


@pytest.mark.parametrize("linkage", NEARLY)
def test_the_same_near_a_change_point(linkage: FourBar) -> None:
    for low, high in ranges(linkage):
        check_evenness(linkage, low, high)
        middle = solve_position(linkage, even_motion(linkage, low, high).theta2(np.linspace(0, 1, 1001))).b
        way = np.hypot(*np.diff(middle, axis=0).T)
        assert way.max() < 0.02 * way.sum()


@pytest.mark.parametrize("turns", [(0.3, 0.3 + 3 * TURN), (5.0, -9.0)])
def test_more_than_a_turn(turns: tuple[float, float]) -> None:
    motion = even_motion(NEARLY[0], *turns)
    around = motion.theta2(np.array([-0.1, 0.0, 1.0, 1.1]))
    assert around[1:3].tolist() == list(turns)
    assert (np.diff(around) * np.sign(turns[1] - turns[0]) > 0).all()


@pytest.mark.parametrize(
    ("linkage", "start", "end"),
    [
        (FourBar((0, 0), (4, 0), 2, 2, 3), 0.0, np.pi),  # closes to 108 deg
        (FourBar((0, 0), (9, 0), 1, 1, 1), 0.0, 1.0),  # nowhere
        (FourBar((0, 0), (4, 0), 3, 1, 3), -1.0, 1.0),  # two ranges
    ],
)
def test_where_the_linkage_does_not_close_all_the_way(linkage: FourBar, start: float, end: float) -> None:
    motion = even_motion(linkage, start, end)
    theta2 = motion.theta2(np.linspace(0, 1, 101))
    assert (theta2[0], theta2[-1]) == (start, end)
    assert (np.diff(theta2) > 0).all()
    np.testing.assert_allclose(motion.share(theta2), np.linspace(0, 1, 101), atol=1e-7)


@of_each_class(*SWINGING)
def test_links_are_in_line_at_dead_ends(linkage: FourBar) -> None:
    for low, high in ranges(linkage):
        ends = np.array(dead_ends(linkage, low, high))
        np.testing.assert_allclose(ends, [low, high], rtol=0, atol=1e-11)
        state = solve_position(linkage, ends)
        assert np.abs(np.sin(state.theta4 - state.theta3)).max() < 1e-15
        assert quality(transmission_angle(linkage, ends)).max() < 1e-7


def test_edges_of_panels_are_on_the_ground_line() -> None:
    parallelogram = FourBar((0, 0), (4, 0), 2, 4, 2)
    motion = even_motion(parallelogram, -3.0, 7.0)
    edges = motion.theta2(motion.edges(10))
    assert (np.diff(edges) > 0).all()
    for angle in (0.0, np.pi, TURN):
        assert np.abs(edges - angle).min() < 1e-12


def test_means_near_a_change_point_are_those_of_adaptive_quadrature() -> None:
    linkage, (low, high) = NEARLY[1], ranges(NEARLY[1])[0]

    def height(theta2: float) -> float:
        return float(solve_position(linkage, theta2).b[1])

    middle = (low + high) / 2
    for start, end in ((low, high), (high, low), (middle - 0.1, middle + 1.0)):
        mean, error = mean_over(linkage, lambda at: solve_position(linkage, at).b[:, 1], start, end)
        inside = [middle] if start < middle < end or end < middle < start else None
        expected = quad(height, start, end, points=inside, limit=500, epsabs=1e-11)[0] / (end - start)
        assert mean == pytest.approx(expected, abs=1e-8)
        assert error < 1e-10
    assert mean_over(linkage, np.cos, 0.3, 0.3)[0] == np.cos(np.array(0.3))


@pytest.mark.parametrize("profile", ["trapezoid", "cycloid"])
def test_means_in_time_of_a_driver_that_starts_and_stops(profile: str) -> None:
    """By symmetry the mean angle is that at half the time."""
    linkage = FourBar((0, 0), (4, 0), 1, 4, 3)
    law = DriverLaw(0.2, 1.5, 2.0, MotorSpec(profile=profile))
    (angle, speed), error = mean_in_time(linkage, law, lambda place: np.stack(law.at_place(place)[:2]))
    assert angle == pytest.approx(0.95, abs=1e-9)
    assert speed == pytest.approx(2.0, rel=1e-8)
    assert error[0] < 1e-9


@pytest.mark.parametrize(("start", "end"), [(0.0, 2 * np.pi), (1.0, 0.5), (-9.0, 4.0), (0.2, 0.2001)])
def test_samples_ascend_from_end_to_end_and_are_close_about_the_ground_line(start: float, end: float) -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 1), r2=1, r3=4, r4=3)
    samples = driver_samples(linkage, start, end)
    assert (np.diff(samples) > 0).all()
    assert (samples[0], samples[-1]) == (min(start, end), max(start, end))
    assert np.diff(samples).max() <= (abs(end - start)) * np.pi / 960 * 1.001
    for aligned in linkage.theta1 + np.array([0, np.pi]):
        if min(start, end) < aligned < max(start, end):
            assert np.abs(samples - aligned).min() == 0
            assert (np.abs(samples - aligned) < 1e-6).sum() > 5


@pytest.mark.parametrize("gap", [1e-2, 1e-6])
def test_no_peak_of_a_linkage_that_just_passes_a_dead_position_is_missed(gap: float) -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=2.5, r4=2.5 + gap)  # folded at theta2 = pi: 5 + gap

    def speed(theta2: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return np.abs([solve_kinematics(linkage, theta2).omega4])

    found = peaks(speed, [driver_samples(linkage, 0.0, 2 * np.pi)])[0]
    near = np.pi + np.concatenate([sign * np.logspace(-9, 0, 40_000) for sign in (-1, 1)])
    assert found == pytest.approx(speed(near).max(), rel=1e-8)


@pytest.mark.parametrize("modulus", [1.0, 0.999, 0.5, 1e-2, 1e-6, 1e-9])
def test_shares_are_elliptic_integrals(modulus: float) -> None:
    ratios, period = _landen(np.array(modulus))
    motion = FirstMotion(np.zeros(()), np.ones(()), ratios=ratios, period=period)
    share = motion._share_at
    psi, half = np.linspace(-4, 4, 200), 2 * ellipkm1(modulus**2)
    if modulus < 1e-3:  # F = arsinh tan psi + O(k'^2), away from the dead position
        low = np.linspace(-1, 1, 50)
        assert share(low) == pytest.approx(np.arcsinh(np.tan(low)) / half, rel=1e-11)
    else:
        assert share(psi) == pytest.approx(ellipkinc(psi, 1 - modulus**2) / half, abs=1e-13)
    # Two with k' tan psi tan other = 1 are half of it (the addition theorem), beside a dead position, too.
    close = np.pi / 2 - np.geomspace(1e-12, 1, 50)
    other = np.arctan2(np.cos(close), modulus * np.sin(close))
    lost = 2e-16 / max(modulus, 1e-12) / half  # by the rounding of psi
    assert share(close) + share(other) == pytest.approx(0.5, abs=1e-14 + 4 * lost)
    assert motion._amplitude(share(psi)) == pytest.approx(psi, abs=1e-13)
