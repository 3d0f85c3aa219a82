"""Shaking force of engines: the series of textbooks, and what a counterweight on the crank makes of it."""

import numpy as np
import pytest

from grashof.analysis import (
    Body,
    Masses,
    balance_reciprocating,
    inverse_dynamics,
    shaking_harmonics,
    solve_kinematics,
)
from grashof.problems import AssemblyError, FourBar, ProblemError, SliderCrank

R, LENGTH, OMEGA, PISTON = 0.05, 0.2, 120.0, 0.7


@pytest.mark.parametrize("slide_angle", [0.0, 2.1])
def test_harmonics_are_those_of_the_series_in_r_over_l(slide_angle: float) -> None:
    """cos t + A2 cos 2t - A4 cos 4t + ..., A2 = q + q^3/4 + 15 q^5/128, A4 = q^3/4 + 3 q^5/16."""
    engine = SliderCrank((0.3, -1), R, LENGTH, slide_angle=slide_angle)
    found = shaking_harmonics(engine, Masses(Body(0), Body(0), Body(PISTON)), OMEGA, 4)
    force, q = PISTON * R * OMEGA**2, R / LENGTH
    expected = force * np.array([1, q + q**3 / 4 + 15 * q**5 / 128, 0, -(q**3) / 4 - 3 * q**5 / 16])
    np.testing.assert_allclose(found[:, 0].real, expected, rtol=0, atol=0.5 * q**7 * force)
    np.testing.assert_allclose(found[:, 0].imag, 0, atol=1e-9 * force)
    np.testing.assert_allclose(found[:, 1], 0, atol=1e-9 * force)


@pytest.mark.parametrize(
    ("share", "along", "across"), [(0.0, 1.0, 0.0), (0.5, 0.5, 0.5), (2 / 3, 1 / 3, 2 / 3)]
)
def test_a_share_of_the_primary_force_goes_across(share: float, along: float, across: float) -> None:
    engine = SliderCrank((0, 0), R, LENGTH, slide_angle=0.4)
    rod = Body(0.6, 0.0, (0.0, 0.0)) + Body(0.2, 0.0, (LENGTH, 0.0))
    masses = Masses(Body(0.5, 0.01, (0.01, -0.02)), rod, Body(PISTON))
    found = balance_reciprocating(engine, masses, share, radius=0.04)
    assert float(found.rotating) == pytest.approx(0.6)
    assert float(found.reciprocating) == pytest.approx(0.2 + PISTON)
    assert np.linalg.norm(found.crank_weight.centre) == pytest.approx(0.04)
    force = (0.2 + PISTON) * R * OMEGA**2
    primary = shaking_harmonics(engine, found.masses, OMEGA, 1)[0]
    np.testing.assert_allclose(np.abs(primary), [along * force, across * force], rtol=1e-9, atol=1e-9 * force)


def test_the_secondary_force_is_not_changed_and_the_series_is_the_force() -> None:
    engine = SliderCrank((0, 0), R, LENGTH, offset=0.03)
    masses = Masses(Body(0.5, 0.01, (0.01, 0.0)), Body(0.8, 0.004, (0.07, 0.01)), Body(PISTON))
    before = shaking_harmonics(engine, masses, OMEGA, 30)
    after = shaking_harmonics(engine, balance_reciprocating(engine, masses).masses, OMEGA, 30)
    np.testing.assert_allclose(after[1:], before[1:], rtol=0, atol=1e-11 * np.abs(before).max())
    theta = np.linspace(0, 6, 31)
    waves = np.exp(1j * np.outer(theta, np.arange(1, 31)))
    shaking = inverse_dynamics(solve_kinematics(engine, theta, OMEGA), masses).shaking_force
    np.testing.assert_allclose((waves @ before).real, shaking, rtol=0, atol=1e-11 * np.abs(shaking).max())


def test_a_linkage_without_harmonics_is_refused() -> None:
    none = Masses(Body(0), Body(0), Body(1))
    with pytest.raises(AssemblyError, match="does not turn fully"):
        shaking_harmonics(SliderCrank((0, 0), 2, 1), none, 1.0)
    with pytest.raises(ProblemError, match=r"^linkage is .*; it must be a SliderCrank$"):
        balance_reciprocating(FourBar((0, 0), (4, 0), 1, 4, 3), none)  # type: ignore[arg-type]
    with pytest.raises(ProblemError, match=r"^share is 1.5"):
        balance_reciprocating(SliderCrank((0, 0), 1, 2), none, 1.5)
