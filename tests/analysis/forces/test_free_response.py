"""Free motions: energy kept, driven motions recovered, and endings named."""

import numpy as np
import pytest
from loaded_linkages import JACK, ROCKER, SPRUNG, TURN

from grashof import analysis
from grashof.analysis import Body, Ending, Friction, Loads, free_response, inverse_dynamics, uniform_bars
from grashof.problems import AssemblyError, ProblemError

BARS = uniform_bars(JACK, 2.0, payload=3.0)


@pytest.mark.study
@pytest.mark.parametrize("loads", [Loads(), SPRUNG])
def test_free_motion_keeps_its_energy_over_ten_turns(loads: Loads) -> None:
    free = free_response(JACK, BARS, np.linspace(0, 7, 100), 0.3, 10.0, loads=loads)
    assert free.ending is Ending.TIME
    assert free.state.theta2[-1] - free.state.theta2[0] > 10 * TURN
    kinetic = analysis.mechanical_energy(free.state, BARS)
    assert np.ptp(kinetic) > 0 if loads is SPRUNG else True
    assert np.ptp(free.energy) <= 1e-11 * kinetic.max()


@pytest.mark.quick("4.0-friction0", "0.0-friction1")
@pytest.mark.parametrize(
    "friction",
    [
        Friction(viscous=3.0),
        Friction(coulomb=(4.0, 1.0, 2.0, 3.0)),
        Friction(radius=0.05),
        Friction(1.0, 2.0, 0.02),
    ],
)
@pytest.mark.parametrize("omega2", [4.0, -4.0, 0.0])
def test_friction_is_that_of_inverse_dynamics(friction: Friction, omega2: float) -> None:
    """A motion without drive takes no torque, and loses what friction takes."""
    loads = Loads(SPRUNG.gravity, springs=SPRUNG.springs, friction=friction)
    time = np.linspace(0, 0.6, 121)
    free = free_response(JACK, BARS, time, -0.4, omega2, loads=loads)
    moving = np.abs(free.state.omega2) > 1e-6
    assert moving.sum() > 50
    dynamics = inverse_dynamics(free.state, BARS, loads)
    scale = np.abs(inverse_dynamics(analysis.solve_kinematics(JACK, 0.3, 4.0, 10.0), BARS, loads).torque)
    assert np.abs(dynamics.torque[moving]).max() < 1e-8 * scale
    lost = analysis.powers(free.state, BARS, loads).friction
    loss = np.concatenate([[0], np.cumsum((lost[1:] + lost[:-1]) / 2 * np.diff(free.time))])
    change = free.energy - free.energy[0]
    assert (np.diff(free.energy) < 1e-12 * np.ptp(free.energy)).all()
    np.testing.assert_allclose(change, loss, atol=3e-3 * np.abs(change).max())


def test_a_spring_with_constant_friction_loses_as_much_each_swing() -> None:
    """In closed form: 2 M / k each half swing, until the spring cannot overcome the friction."""
    rod, stiffness, moment = analysis.Masses(Body(3.0, 0.2, (0.5, 0.0)), Body(0), Body(0)), 7.0, 0.35
    loads = Loads(
        torsion_springs=(analysis.TorsionSpring(analysis.Joint.O2, stiffness),),
        friction=Friction(coulomb=(moment, 0, 0, 0)),
    )
    half = np.pi * np.sqrt((0.2 + 3 * 0.25) / stiffness)
    free = free_response(JACK, rod, np.linspace(0, 20, 4001), 0.62, 0.0, loads=loads)
    assert free.ending is Ending.AT_REST
    drop = 2 * moment / stiffness  # 0.1: swings of 0.62, 0.52, ..., until no more than 0.05 is left
    assert free.end == pytest.approx(6 * half, rel=1e-9)
    turns = np.interp(half * np.arange(6), free.time, free.state.theta2)
    expected = (0.62 - drop * np.arange(6)) * (-1.0) ** np.arange(6)
    np.testing.assert_allclose(turns, expected, atol=1e-4)


def test_friction_may_hold_it_from_the_start() -> None:
    held = Loads((0, -9.81), friction=Friction(coulomb=200.0))
    still = free_response(JACK, BARS, [0, 1, 2], 0.3, 0.0, loads=held)
    assert (still.ending, still.end, still.time.tolist()) == (Ending.AT_REST, 0.0, [0])
    # A drive that is stronger sets it off.
    driven = free_response(JACK, BARS, np.linspace(0, 0.1, 3), 0.3, 0.0, torque=2e3, loads=held)
    assert driven.ending is Ending.TIME
    assert driven.state.omega2[-1] > 0


@pytest.mark.study
def test_the_torque_of_a_motion_makes_that_motion() -> None:
    def theta2(time: float) -> float:
        return 2 * time + 0.2 * np.sin(3 * time)

    friction = Friction(viscous=0.4, coulomb=0.3)
    loads = Loads(SPRUNG.gravity, springs=SPRUNG.springs, friction=friction)

    def torque(time: float, *_: float) -> float:
        state = analysis.solve_kinematics(JACK, *analysis.driver_motion(theta2, time))
        return float(inverse_dynamics(state, BARS, loads).torque)

    time = np.linspace(0, 1.2, 31)
    free = free_response(JACK, BARS, time, 0.0, 2.6, torque, loads)
    np.testing.assert_allclose(free.state.theta2, theta2(time), atol=1e-8)
    motion = analysis.driver_motion(theta2, time)
    np.testing.assert_allclose(free.state.alpha2, motion.alpha2, atol=1e-6)


@pytest.mark.slow
def test_endings_are_named() -> None:
    stopped = free_response(ROCKER, uniform_bars(ROCKER, 1.0), np.linspace(0, 20, 400), 0.0, 1.0)
    assert stopped.ending is Ending.DEAD_POSITION
    assert 1.5 < stopped.state.theta2[-1] < np.radians(108.21)
    braked = Loads(friction=Friction(coulomb=2.0))
    rested = free_response(JACK, BARS, np.linspace(0, 60, 600), 0.0, 2.0, loads=braked)
    assert rested.ending is Ending.AT_REST
    assert 0 <= rested.state.omega2[-1] < 0.3
    assert (np.diff(rested.energy) < 0).all()


def test_bad_input_is_reported() -> None:
    with pytest.raises(ProblemError, match="time is"):
        free_response(JACK, BARS, [0, 0], 0.0, 1.0)
    with pytest.raises(ProblemError, match="no inertia"):
        free_response(JACK, analysis.WEIGHTLESS, [0, 1], 0.0, 1.0)
    with pytest.raises(AssemblyError, match="cannot close"):
        free_response(ROCKER, uniform_bars(ROCKER, 1.0), [0, 1], np.pi, 1.0)
    with pytest.raises(AssemblyError, match="dead position"):
        free_response(ROCKER, uniform_bars(ROCKER, 1.0), [0, 1], 1.88862, 1.0)


def test_the_inertia_that_the_driver_feels() -> None:
    """The torque that another acceleration takes, divided by that."""
    theta2 = np.linspace(0, 6, 20)
    torques = [
        inverse_dynamics(analysis.solve_kinematics(JACK, theta2, 3.0, a), BARS).torque for a in (0.0, 5.0)
    ]
    expected = (torques[1] - torques[0]) / 5
    np.testing.assert_allclose(analysis.generalised_inertia(JACK, theta2, BARS), expected, rtol=1e-9)
