"""Straight parts of coupler curves: Hoeken's published figures, dense samples, all half turns."""

import numpy as np
import numpy.typing as npt
import pytest

from grashof.analysis import BestLine, driver_ranges, solve_position, straightest_half_turn, straightness
from grashof.analysis.judge.planted import random_full_crank
from grashof.problems import AssemblyError, FourBar, ProblemError, load_linkage_spec

Floats = npt.NDArray[np.float64]
JACK = load_linkage_spec("pumpjack").linkage
NEARLY_DEAD = FourBar((0, 0), (4, 0), 2, 4.5, 2.501, (2, 1))
CASES = [JACK, NEARLY_DEAD, *(random_full_crank(np.random.default_rng(seed)) for seed in range(5))]

# Norton, Design of Machinery, table 3-1: range of the crank in deg, L1/L2, L3/L2 = L4/L2 = BP/L2, length
# of the straight part / L2, its deviation (from side to side) in % of the length.
HOEKEN = [
    (60, 2.900, 3.850, 1.763, 0.00027),
    (120, 2.625, 3.438, 3.238, 0.010),
    (140, 2.500, 3.250, 3.623, 0.023),
    (160, 2.350, 3.025, 3.933, 0.047),
    (180, 2.200, 2.800, 4.181, 0.096),
]


@pytest.mark.parametrize(("turn", "r1", "r3", "length", "percent"), HOEKEN)
def test_straight_line_linkages_of_hoeken_as_norton_prints_them(
    turn: float, r1: float, r3: float, length: float, percent: float
) -> None:
    hoeken = FourBar((0, 0), (r1, 0), 1, r3, r3, coupler_point=(2 * r3, 0))
    half = np.radians(turn) / 2
    line = straightness(hoeken, np.pi - half, np.pi + half)
    assert line.length == pytest.approx(length, abs=6e-4)
    assert 100 * line.width / line.length == pytest.approx(percent, rel=0.05)
    assert abs(np.sin(line.angle)) < 1e-9


def sampled(linkage: FourBar, theta2: Floats) -> tuple[float, float, float]:
    """Width, length and greatest distance of the best line through a fine polygon, by the length of sides."""
    p = solve_position(linkage, theta2).p @ np.array([1, 1j])
    side, middle = np.abs(np.diff(p)), (p[1:] + p[:-1]) / 2
    off = middle - (side * middle).sum() / side.sum()
    axes = (side * off**2).sum()  # twice its angle is that of the axis of least inertia
    turned = (p - (side * middle).sum() / side.sum()) * np.exp(-0.5j * np.angle(axes))
    return float(np.ptp(turned.imag)), float(np.ptp(turned.real)), float(np.abs(turned.imag).max())


def close_to_ground_line(linkage: FourBar, start: float, end: float, count: int = 20_001) -> Floats:
    """Driver angles in between, denser where a linkage near a change point moves fast."""
    along = float(linkage.theta1) + np.pi * np.arange(-6, 7)
    near = np.concatenate([along + sign * step for step in np.logspace(-6, 0, 2000) for sign in (-1, 1)])
    every = np.concatenate([np.linspace(start, end, count), near[(near > start) & (near < end)]])
    return np.unique(every)


@pytest.mark.parametrize("linkage", CASES[:3])
def test_a_part_is_as_straight_as_its_dense_samples(linkage: FourBar) -> None:
    for start, end in ((0.3, 2.9), (5.0, 11.0), (1.0, 1.2)):
        line = straightness(linkage, start, end)
        width, length, furthest = sampled(linkage, close_to_ground_line(linkage, start, end))
        assert (line.width, line.length, line.deviation_max) == pytest.approx(
            (width, length, furthest), rel=2e-6, abs=1e-8 * length
        )
        back = straightness(linkage, end, start)
        assert back.width == pytest.approx(line.width, rel=1e-10)
        assert np.cos(back.angle - line.angle) == pytest.approx(-1, abs=1e-12)


def ratio(line: BestLine) -> float:
    return line.width / line.length


@pytest.mark.quick("linkage1")
@pytest.mark.parametrize("linkage", CASES)
def test_no_half_turn_is_straighter(linkage: FourBar) -> None:
    start, line = straightest_half_turn(linkage)
    assert 0 <= start < 2 * np.pi
    assert ratio(line) == pytest.approx(ratio(straightness(linkage, start, start + np.pi)), rel=1e-12)
    for step in 10.0 ** np.arange(-9, 0):
        for beside in (start - step, start + step):
            assert ratio(straightness(linkage, beside, beside + np.pi)) > ratio(line) * (1 - 1e-13)
    near = close_to_ground_line(linkage, 0.0, 4 * np.pi, 4001)
    for other in np.arange(0, 360, 1.5):
        begin = np.radians(other)
        inside = near[(near > begin) & (near < begin + np.pi)]
        width, length, _ = sampled(linkage, np.concatenate([[begin], inside, [begin + np.pi]]))
        assert width / length > ratio(line) * (1 - 1e-3)


def test_the_straightest_half_turn_of_the_pumpjack() -> None:
    start, line = straightest_half_turn(JACK)
    assert np.degrees(start) == pytest.approx(270.83080434, abs=1e-7)
    assert line.deviation_max == pytest.approx(0.39612851729, abs=1e-10)


def test_all_half_turns_of_a_circle_are_equally_straight() -> None:
    start, line = straightest_half_turn(FourBar((1, 1), (5, 1), 1, 4, 3))  # P is A
    assert start == 0.0
    # The centroid of half a circle lies 2 / pi from its diameter.
    assert (line.length, line.width, line.deviation_max) == pytest.approx((2, 1, 2 / np.pi), rel=1e-12)
    # The mean of sin^2 less the square of the mean of sin.
    assert line.deviation_rms == pytest.approx(np.sqrt(0.5 - (2 / np.pi) ** 2), rel=1e-12)


def test_the_complete_range_of_a_swinging_driver() -> None:
    rocker = FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1))
    low, high = driver_ranges(rocker)[0]
    line = straightness(rocker, low, high)
    share = (1 - np.cos(np.linspace(0, np.pi, 100_001))) / 2
    _, length, furthest = sampled(rocker, low + (high - low) * share)
    assert (line.length, line.deviation_max) == pytest.approx((length, furthest), rel=1e-6)


def test_bad_input_is_refused() -> None:
    rocker = FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1))
    with pytest.raises(ProblemError, match="cannot be assembled"):
        straightness(rocker, 0, np.pi)
    with pytest.raises(ProblemError, match="all one"):
        straightness(JACK, 1.0, 1.0)
    with pytest.raises(AssemblyError, match="does not turn fully"):
        straightest_half_turn(rocker)
