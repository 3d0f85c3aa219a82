"""Pumping units: the API's own formulas, its catalogue figures, and inverse dynamics without masses."""

from dataclasses import replace

import numpy as np
import pytest

from grashof.analysis import (
    WEIGHTLESS,
    AppliedMoment,
    Body,
    Loads,
    Masses,
    crank_angle,
    driver_angle,
    inverse_dynamics,
    reducer_torque,
    rod_load,
    rod_motion,
    solve_kinematics,
)
from grashof.problems import FourBar, ProblemError
from grashof.problems.values.dynamics.pumping_unit import PumpingUnitSpec

TURN = 2 * np.pi
# Lufkin C-912D-427-144, inches.
R, P, C, A, I, H, G = 47.0, 148.5, 120.03, 180.0, 120.0, 262.0, 111.0  # noqa: E741
LUFKIN = FourBar(o2=(0, 0), o4=(I, H - G), r2=R, r3=P, r4=C)
MIRRORED = FourBar(o2=(0, 0), o4=(-I, H - G), r2=R, r3=P, r4=C, assembly=-1)
CRANK = np.linspace(0, TURN, 73)
UP_AND_DOWN = ((0, 9e3), (20, 9e3), (45, 20e3), (170, 20e3), (200, 9e3), (360, 9e3))


def api_11e(crank: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Position and torque factor by API Specification 11E for such units."""
    k, phi = np.hypot(H - G, I), np.arctan2(I, H - G)
    turned = crank - phi
    beta = np.arccos((C**2 + P**2 - k**2 - R**2 + 2 * k * R * np.cos(turned)) / (2 * C * P))
    j = np.sqrt(k**2 + R**2 - 2 * k * R * np.cos(turned))
    chi = np.arccos((C**2 + j**2 - P**2) / (2 * C * j))
    psi = chi - np.arcsin(R * np.sin(turned) / j)
    alpha = beta + psi - turned
    lowest = np.arccos((C**2 + k**2 - (P + R) ** 2) / (2 * C * k))
    highest = np.arccos((C**2 + k**2 - (P - R) ** 2) / (2 * C * k))
    return (lowest - psi) / (lowest - highest), A * R / C * np.sin(alpha) / np.sin(beta)


def test_position_and_torque_factor_are_those_of_the_api() -> None:
    position, factor = api_11e(CRANK)
    found = rod_motion(LUFKIN, CRANK, A, PumpingUnitSpec())
    np.testing.assert_allclose(found.position, position, atol=1e-12)
    np.testing.assert_allclose(found.torque_factor, factor, atol=1e-10)
    assert found.torque_factor[18] == pytest.approx(68.825284325162193145, rel=1e-12)
    assert found.torque_factor[9] == pytest.approx(64.972291463768882899, rel=1e-12)


def test_a_unit_seen_from_behind_is_the_same() -> None:
    left = PumpingUnitSpec(well="left", crank="counter-clockwise")
    mine = rod_motion(MIRRORED, CRANK, A, left)
    other = rod_motion(LUFKIN, CRANK, A, PumpingUnitSpec(crank="counter-clockwise"))
    np.testing.assert_allclose(mine.position, other.position, atol=1e-12)
    np.testing.assert_allclose(mine.torque_factor, other.torque_factor, atol=1e-10)
    forward = rod_motion(LUFKIN, CRANK, A, PumpingUnitSpec())
    np.testing.assert_allclose(other.torque_factor, -forward.torque_factor)


@pytest.mark.parametrize("well", ["right", "left"])
def test_crank_angles_there_and_back(well: str) -> None:
    unit = PumpingUnitSpec(well=well)
    theta2 = np.linspace(-5, 5, 11)
    back = driver_angle(crank_angle(theta2, unit), unit)
    np.testing.assert_allclose(np.exp(1j * back), np.exp(1j * theta2), atol=1e-14)
    assert crank_angle(np.pi / 2, unit) == 0
    assert np.degrees(crank_angle(0.0 if well == "right" else np.pi, unit)) == pytest.approx(90)


@pytest.mark.parametrize("well", ["right", "left"])
@pytest.mark.parametrize("crank", ["clockwise", "counter-clockwise"])
def test_the_torque_is_that_of_the_dynamics_without_masses(well: str, crank: str) -> None:
    """Load of the rod as a moment on the beam, the counterbalance as a weight on the crank."""
    unit = PumpingUnitSpec(
        well=well, crank=crank, structural_unbalance=-2.9e3, counterbalance=3e5, counterbalance_phase_deg=8.0,
        values=UP_AND_DOWN,
    )  # fmt: skip
    linkage = LUFKIN if well == "right" else MIRRORED
    angles = np.linspace(0, TURN, 721)
    motion, load = rod_motion(linkage, angles, A, unit), rod_load(unit)
    assert load is not None
    found = reducer_torque(unit, angles, motion.torque_factor, load(angles, motion))
    theta2, drawn = driver_angle(angles, unit), -unit.side * unit.sense
    pull = -unit.side * A * found.net_load
    lag = -unit.side * np.radians(8.0)
    weight = Body(3e5 / 9.81 / 10, 0.0, (10 * np.cos(lag), 10 * np.sin(lag)))
    loads = Loads(gravity=(0, -9.81), moments=(AppliedMoment(4, pull),))
    state = solve_kinematics(linkage, theta2, drawn * 0.5)
    masses = Masses(weight, WEIGHTLESS.coupler, WEIGHTLESS.output)
    torque = inverse_dynamics(state, masses, loads).torque * drawn
    np.testing.assert_allclose(found.torque, torque, atol=1e-9 * np.abs(torque).max())


def test_the_permissible_load_is_that_of_the_rating() -> None:
    unit = PumpingUnitSpec(structural_unbalance=-2e3, counterbalance=4e5, rating=2e5)
    factor = rod_motion(LUFKIN, CRANK, A, unit).torque_factor
    permissible = reducer_torque(unit, CRANK, factor, 0.0).permissible_load
    np.testing.assert_allclose(reducer_torque(unit, CRANK, factor, permissible).torque, 2e5, rtol=1e-9)
    assert np.isnan(reducer_torque(replace(unit, rating=None), 1.0, 2.0, 3.0).permissible_load)


def test_loads_over_the_position_are_of_each_stroke() -> None:
    unit = PumpingUnitSpec(values=((0, 12e3, 9e3), (0.5, 20e3, 8e3), (1, 21e3, 10e3)), over="position")
    motion, load = rod_motion(LUFKIN, CRANK, A, unit), rod_load(unit)
    assert load is not None
    pull = load(CRANK, motion)
    assert pull[motion.torque_factor > 0].min() >= 12e3
    assert pull[motion.torque_factor < 0].max() <= 10e3
    assert rod_load(PumpingUnitSpec()) is None
    constant = rod_load(PumpingUnitSpec(rod_load=5.0))
    assert constant is not None
    np.testing.assert_array_equal(constant(CRANK, motion), 5.0)


def test_a_crank_that_swings_and_a_beam_that_turns_are_refused() -> None:
    for linkage in (FourBar((0, 0), (4, 0), 2, 2, 3), FourBar((0, 0), (1, 0), 3, 2.5, 3)):
        with pytest.raises(ProblemError, match="pumping_unit: the crank does not turn fully while"):
            rod_motion(linkage, CRANK, A, PumpingUnitSpec())
