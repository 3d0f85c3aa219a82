"""Double points in closed form, compared with crossings of the sampled curve and with geometry."""

import numpy as np
import pytest
from drawn_linkages import SMOOTH, of_each_class
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from grashof.analysis import DoublePoints, all_double_points, double_points, driver_ranges, solve_position
from grashof.analysis.judge.planted import random_full_crank
from grashof.problems import FourBar, ProblemError


def crossings(theta2: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Pairs of parameters at which the polygon z crosses itself, shape (K, 2)."""
    start, side = z[:-1], np.diff(z)
    i, j = np.triu_indices(len(side), k=2)
    if np.isclose(z[0], z[-1], rtol=0, atol=1e-9):  # a closed curve: its ends meet, they do not cross
        apart = j - i < len(side) - 1
        i, j = i[apart], j[apart]
    across = (side[i].conj() * side[j]).imag
    gap = start[j] - start[i]
    with np.errstate(divide="ignore", invalid="ignore"):
        s, u = (gap.conj() * side[j]).imag / across, (gap.conj() * side[i]).imag / across
    hit = (s > 0) & (s < 1) & (u > 0) & (u < 1)
    step = np.diff(theta2)
    return np.stack([theta2[i] + s * step[i], theta2[j] + u * step[j]], axis=-1)[hit]


def assert_double(linkage: FourBar, found: DoublePoints) -> None:
    """P is there at both driver angles, to rounding."""
    size = max(np.abs(linkage.lengths).max(), np.abs(linkage.coupler_point).max(), np.abs(linkage.o2).max())
    for point, theta2, assembly in zip(found.points, found.theta2, found.assembly, strict=True):
        p = solve_position(linkage, theta2, assembly).p
        np.testing.assert_allclose(p, [point, point], rtol=0, atol=3e-12 * size)


def test_one_turn_has_those_of_the_sampled_curve() -> None:
    counts = []
    for seed in range(12):
        linkage = random_full_crank(np.random.default_rng(1000 + seed))
        theta2 = 0.1 + np.linspace(0, 2 * np.pi, 1201)
        sampled = crossings(theta2, solve_position(linkage, theta2).p @ [1, 1j])
        found = double_points(linkage, theta2[0], theta2[-1])
        assert_double(linkage, found)
        assert len(found) == len(sampled)
        counts.append(len(found))
        for pair in sampled:
            assert np.abs(found.theta2 - pair).max(axis=1).min() < 2e-2
    assert min(counts) == 0
    assert sum(counts) >= 3


@of_each_class(*SMOOTH)
def test_every_range_of_every_class(linkage: FourBar) -> None:
    found = double_points(linkage)
    assert_double(linkage, found)
    assert (found.assembly == linkage.assembly).all()
    assert (found.theta2[:, 0] < found.theta2[:, 1]).all()
    sampled = [np.empty((0, 2))]
    for low, high in driver_ranges(linkage):
        if high > low:
            theta2 = low + (high - low) * (1 - np.cos(np.linspace(0, np.pi, 401))) / 2
            hits = crossings(theta2, solve_position(linkage, theta2).p @ [1, 1j])
            seam = np.abs(hits - [low, high]).max(axis=1) < 1e-6  # where a closed curve ends
            sampled.append(hits[~seam])
    for pair in np.concatenate(sampled):  # small loops hide between samples; no sampled crossing is missed
        p = solve_position(linkage, pair).p.mean(axis=0)
        assert len(found)
        assert np.hypot(*(found.points - p).T).min() < 2e-2 * linkage.lengths.max()


@of_each_class(*SMOOTH)
def test_o2_o4_subtends_the_angle_of_a_b_at_p(linkage: FourBar) -> None:
    every = all_double_points(linkage)
    assert_double(linkage, every)
    assert len(every) <= 3
    w = complex(*linkage.coupler_point)
    assume(min(abs(w), abs(w - linkage.r3)) > 1e-6 * linkage.r3)  # beside A or B the angle at P has no digits
    for point in every.points @ [1, 1j]:
        seen = (point - complex(*linkage.o4)) / (point - complex(*linkage.o2))
        turn = seen * w / (w - linkage.r3)  # real: the angles are equal up to half a turn
        assert abs(turn.imag) < 1e-7 * abs(turn)


@pytest.mark.parametrize("side", [1, -1])
def test_a_double_point_in_o2(side: int) -> None:
    """A-P as long as the crank: P passes O2 whenever the coupler's angle at A allows, twice or never."""
    linkage = FourBar(o2=(0, 0), o4=(2, 0), r2=1, r3=2.5, r4=2.5, coupler_point=(-0.6, side * 0.8))
    every = all_double_points(linkage)
    at_o2 = np.hypot(*every.points.T) < 1e-12
    assert at_o2.sum() == 1
    assert_double(linkage, every)


def test_part_of_the_motion() -> None:
    linkage = FourBar(o2=(0, 0), o4=(2, 0), r2=1, r3=2.5, r4=2.5, coupler_point=(1, -2))
    for start, end, count in ((-2, 2, 1), (2, -2, 1), (-np.pi / 2, np.pi / 2, 1), (-1, 2, 0)):
        assert len(double_points(linkage, start, end)) == count
    counted_on = double_points(linkage, 4, 10)
    np.testing.assert_allclose(counted_on.theta2, [[1.5 * np.pi, 2.5 * np.pi]], atol=1e-13)
    with pytest.raises(ProblemError, match="one end"):
        double_points(linkage, theta2_end=1)


def test_arcs_have_none() -> None:
    for point in ((0, 0), (4, 0)):
        assert len(all_double_points(FourBar((0, 0), (4, 0), 1, 4, 3, coupler_point=point))) == 0
    assert len(all_double_points(FourBar((0, 0), (10, 0), 1, 2, 3, coupler_point=(1, 1)))) == 0


@settings(max_examples=6)
@given(turn=st.floats(-3, 3), scale=st.floats(0.01, 100), shift=st.floats(-5, 5))
def test_they_move_with_the_linkage(turn: float, scale: float, shift: float) -> None:
    plain = FourBar((0, 0), (4, 0), 2, 4, 3, coupler_point=(2, -3))
    o4 = 4 * scale * np.array([np.cos(turn), np.sin(turn)]) + shift
    moved = FourBar((shift, shift), o4, 2 * scale, 4 * scale, 3 * scale, (2 * scale, -3 * scale))
    before, after = double_points(plain), double_points(moved, turn - np.pi, turn + np.pi)
    z = (before.points @ [1, 1j]) * scale * np.exp(1j * turn) + shift * (1 + 1j)
    np.testing.assert_allclose(after.points @ [1, 1j], z, atol=1e-11 * (scale + abs(shift)))
    np.testing.assert_allclose(after.theta2, before.theta2 + turn, atol=1e-9)
