"""Curvature against circles through neighbours; cusps planted at instant centres."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_linkages import of_each_class
from hypothesis import assume
from hypothesis import strategies as st

from grashof.analysis import (
    GrashofClass,
    centrodes,
    curvature,
    cusps,
    driver_ranges,
    full_rotation,
    solve_position,
)
from grashof.analysis.judge.planted import random_full_crank
from grashof.problems import FourBar, ProblemError


@pytest.mark.parametrize("assembly", [1, -1])
def test_it_is_the_turn_of_the_path_by_its_length(assembly: int) -> None:
    """From chords to the neighbours on either side; positive to the left."""
    rng, h = np.random.default_rng(1), 1e-4
    for _ in range(3):
        linkage = random_full_crank(rng)
        theta2 = rng.uniform(-3, 3, 12)
        p = solve_position(linkage, theta2 + h * np.array([[-1], [0], [1]]), assembly).p @ [1, 1j]
        before, after = np.diff(p, axis=0)
        turned = np.angle(after / before) / ((np.abs(before) + np.abs(after)) / 2)
        kappa = curvature(linkage, theta2, assembly)
        np.testing.assert_allclose(kappa, turned, rtol=1e-3, atol=1e-3 * np.median(np.abs(kappa)))


def test_the_arcs_of_the_pivots() -> None:
    at_a = FourBar((0, 0), (4, 0), 1.25, 4, 3)
    np.testing.assert_allclose(curvature(at_a, np.linspace(0, 6, 7)), 0.8, rtol=1e-12)
    at_b = FourBar((0, 0), (4, 0), 1, 4, 3, coupler_point=(4, 0))
    np.testing.assert_allclose(np.abs(curvature(at_b, np.linspace(0.8, 3.5, 7))), 1 / 3, rtol=1e-9)


def test_a_batch_and_what_does_not_close() -> None:
    rocker = FourBar((0, 0), (4, 0), 2, 2, 3, coupler_point=(1, 1))
    assert np.isnan(curvature(rocker, np.pi))
    both = FourBar([(0, 0)] * 2, [(4, 0)] * 2, [1, 1], [4, 4], [3, 3], [(0, 0), (2, 1)])
    kappa = curvature(both[:, None], [0.3, 0.4, 0.5])
    assert kappa.shape == (2, 3)
    np.testing.assert_array_equal(kappa[1], curvature(both[1], [0.3, 0.4, 0.5]))


def with_cusp(linkage: FourBar, theta2: float) -> FourBar:
    """The same with P at the instant centre of the coupler: where O2A and O4B cross."""
    return replace(linkage, coupler_point=centrodes(linkage, theta2).moving)


@of_each_class(GrashofClass.DOUBLE_CRANK, GrashofClass.NON_GRASHOF, examples=4, share=st.floats(0.05, 0.95))
def test_planted_cusps_are_found(linkage: FourBar, share: float) -> None:
    low, high = driver_ranges(linkage)[0]
    theta2 = low + (high - low) * share
    state = solve_position(linkage, theta2)
    assume(abs(np.sin(state.theta4 - theta2)) > 0.05)  # the instant centre is not far away
    pointed = with_cusp(linkage, theta2)
    found = cusps(pointed)
    away = np.abs(np.angle(np.exp(1j * (found - theta2))))
    assert away.min() < 1e-8
    if not full_rotation(linkage):
        assert np.abs(found - theta2).min() < 1e-8
    assert cusps(pointed, theta2 - 0.01, theta2 + 0.01) == pytest.approx([theta2], abs=1e-8)


@pytest.mark.parametrize("theta2", [np.pi, -np.pi, 3 * np.pi])
def test_a_cusp_at_the_seam_of_a_turn_is_found_once(theta2: float) -> None:
    pointed = with_cusp(FourBar((0, 0), (4, 0), 1, 4, 3), theta2)
    assert np.abs(cusps(pointed)) == pytest.approx([np.pi])
    assert cusps(pointed, theta2, theta2 + 1) == pytest.approx([theta2])
    assert cusps(pointed, theta2, theta2 - 1) == pytest.approx([theta2])
    assert cusps(pointed, theta2 + 0.1, theta2 + 1).size == 0


def test_a_round_curve_has_none() -> None:
    assert cusps(FourBar((0, 0), (4, 0), 1, 4, 3)).size == 0
    assert cusps(FourBar((0, 0), (10, 0), 1, 2, 3)).size == 0  # cannot be assembled


def test_tolerance_is_a_share_of_the_speed_of_a() -> None:
    pointed = with_cusp(FourBar((0, 0), (4, 0), 1, 4, 3), 1.0)
    blunt = replace(pointed, coupler_point=np.add(pointed.coupler_point, [1e-4, 0]))
    assert cusps(blunt).size == 0
    assert cusps(blunt, tolerance=1e-3) == pytest.approx([1.0], abs=1e-3)


def test_bad_input_is_refused() -> None:
    linkage = FourBar((0, 0), (4, 0), 1, 4, 3)
    with pytest.raises(ProblemError, match="one end"):
        cusps(linkage, 0.0)
    with pytest.raises(ProblemError, match="tolerance"):
        cusps(linkage, tolerance=-1)
    with pytest.raises(ProblemError, match="finite"):
        cusps(linkage, 0.0, np.inf)
