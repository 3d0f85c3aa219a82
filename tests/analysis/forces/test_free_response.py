"""Free motions: energy kept, driven motions recovered, and endings named."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from grashof.analysis import (
    Body,
    Ending,
    Friction,
    Joint,
    Loads,
    Masses,
    Spring,
    TorsionSpring,
    driver_motion,
    free_response,
    inverse_dynamics,
    mechanical_energy,
    solve_kinematics,
    uniform_bars,
)
from grashof.problems import AssemblyError, FourBar, ProblemError

TURN = 2 * np.pi
JACK = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762, coupler_point=(1.7, 0.7))
BARS = uniform_bars(JACK, 2.0, payload=3.0)
SPRUNG = Loads(
    gravity=(0, -9.81),
    springs=(Spring(1, (2, 0), 4, (1, 0.2), 20, 1.0),),
    torsion_springs=(TorsionSpring(Joint.B, 5.0, 1.0),),
)


@pytest.mark.quick("loads0-2")
@pytest.mark.parametrize(("loads", "turns"), [(Loads(), 2), (SPRUNG, 10)])
def test_free_motion_keeps_its_energy(loads: Loads, turns: int) -> None:
    free = free_response(JACK, BARS, np.linspace(0, 0.7 * turns, 100), 0.3, 10.0, loads=loads)
    assert free.ending is Ending.TIME
    assert free.state.theta2[-1] - free.state.theta2[0] > turns * TURN
    kinetic = mechanical_energy(free.state, BARS)
    assert np.ptp(kinetic) > 0 if loads is SPRUNG else True
    assert np.ptp(free.energy) <= 1e-6 * kinetic.max()


def test_the_torque_of_a_motion_makes_that_motion() -> None:
    def theta2(time: float) -> float:
        return 2 * time + 0.2 * np.sin(3 * time)

    friction = Friction(viscous=0.4, coulomb=0.3)
    loads = Loads(SPRUNG.gravity, springs=SPRUNG.springs, friction=friction)

    def torque(time: float, *_: float) -> float:
        state = solve_kinematics(JACK, *driver_motion(theta2, time))
        return float(inverse_dynamics(state, BARS, loads).torque)

    time = np.linspace(0, 3, 31)
    free = free_response(JACK, BARS, time, 0.0, 2.6, torque, loads)
    np.testing.assert_allclose(free.state.theta2, theta2(time), atol=1e-6)
    motion = driver_motion(theta2, time)
    np.testing.assert_allclose(free.state.alpha2, motion.alpha2, atol=1e-5)


def test_a_pendulum() -> None:
    """Nothing but the crank has mass: it swings like a rod."""
    rod = Masses(Body(3.0, 0.2, (0.5, 0.0)), Body(0), Body(0))
    time = np.linspace(0, 4, 41)
    free = free_response(JACK, rod, time, -1.0, 0.0, loads=Loads(gravity=(0, -9.81)))
    moment = 0.2 + 3 * 0.5**2
    exact = solve_ivp(
        lambda _, y: [y[1], -3 * 9.81 * 0.5 * np.cos(y[0]) / moment],
        (0, 4), [-1.0, 0.0], t_eval=time, rtol=1e-11, atol=1e-12,
    ).y[0]  # fmt: skip
    np.testing.assert_allclose(free.state.theta2, exact, atol=1e-7)


def test_endings_are_named() -> None:
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)
    stopped = free_response(rocker, uniform_bars(rocker, 1.0), np.linspace(0, 20, 400), 0.0, 1.0)
    assert stopped.ending is Ending.DEAD_POSITION
    assert 1.5 < stopped.state.theta2[-1] < np.radians(108.21)
    braked = Loads(friction=Friction(coulomb=2.0))
    rested = free_response(JACK, BARS, np.linspace(0, 60, 600), 0.0, 2.0, loads=braked)
    assert rested.ending is Ending.AT_REST
    assert 0 <= rested.state.omega2[-1] < 0.3
    assert (np.diff(rested.energy) < 0).all()


def test_bad_input_is_said() -> None:
    nothing = Masses(Body(0), Body(0), Body(0))
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)
    with pytest.raises(ProblemError, match="time is"):
        free_response(JACK, BARS, [0, 0], 0.0, 1.0)
    with pytest.raises(ProblemError, match="joint forces"):
        free_response(JACK, BARS, [0, 1], 0.0, 1.0, loads=Loads(friction=Friction(radius=0.1)))
    with pytest.raises(ProblemError, match="no inertia"):
        free_response(JACK, nothing, [0, 1], 0.0, 1.0)
    with pytest.raises(AssemblyError, match="cannot close"):
        free_response(rocker, uniform_bars(rocker, 1.0), [0, 1], np.pi, 1.0)
    with pytest.raises(AssemblyError, match="dead position"):
        free_response(rocker, uniform_bars(rocker, 1.0), [0, 1], 1.88862, 1.0)
