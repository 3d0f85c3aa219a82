"""The motion that a given drive torque makes."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from grashof.analysis.forces.energy import mechanical_energy
from grashof.analysis.forces.loads import Loads
from grashof.analysis.forces.mass import Masses
from grashof.analysis.forces.statics import load_power
from grashof.analysis.four_bar.kinematics import Kinematics, solve_kinematics
from grashof.analysis.four_bar.position import solve_position
from grashof.problems import AssemblyError, DeadPositionWarning, FourBar, ProblemError, SolverError
from grashof.problems.values.arrays import FloatArray

Drive = float | Callable[[float, float, float], float]

# sin(theta4 - theta3) at which a motion towards a dead position ends: beyond it the driver angle no
# longer shows how the linkage moves on.
_DEAD_END = 1e-3


class Ending(StrEnum):
    """Why a free motion ended."""

    TIME = "the time asked for is over"
    DEAD_POSITION = "the driver came to a dead position"
    AT_REST = "friction brought the driver to rest"


@dataclass(frozen=True, slots=True, eq=False)
class FreeResponse:
    """A motion under given forces.

    Parameters
    ----------
    time : ndarray, shape (N,), s
        The times asked for, as far as the motion went.
    state : Kinematics
        Of shape (N,).
    energy : ndarray, shape (N,), N length
        `mechanical_energy`.
    ending : Ending
    """

    time: FloatArray
    state: Kinematics
    energy: FloatArray
    ending: Ending


def free_response(
    linkage: FourBar,
    masses: Masses,
    time: npt.ArrayLike,
    theta2: float,
    omega2: float,
    torque: Drive = 0.0,
    loads: Loads | None = None,
    tolerance: float = 1e-9,
) -> FreeResponse:
    """Motion of a linkage that a drive torque, weights and springs are left to move.

    Parameters
    ----------
    linkage : FourBar
        A single linkage.
    masses : Masses
    time : array_like, shape (N,), s
        Rising; the motion starts at the first.
    theta2, omega2 : float, rad and rad/s
        At the start.
    torque : float or callable, N length
        Of the drive; a function of time, theta2 and omega2.
    loads : Loads, optional
        Constant friction ends the motion where the driver comes to rest. Friction in proportion to
        the joint forces is not possible here.
    tolerance : float
        Relative, of each step.

    Returns
    -------
    FreeResponse

    Raises
    ------
    AssemblyError
        The linkage cannot close at the start, or stands in a dead position.
    ProblemError
        The links have no inertia, the times do not rise, or the loads are not possible.

    Notes
    -----
    One degree of freedom: with velocities per unit of omega2, virtual work gives
    T = I(theta2) alpha2 + T0(theta2, omega2), where T0 is the torque without driver acceleration.
    Integrated by the Runge-Kutta method of order 8 of Dormand and Prince.

    Examples
    --------
    >>> from grashof.analysis.forces.mass import uniform_bars
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    >>> free = free_response(crank_rocker, uniform_bars(crank_rocker, 2.0), [0, 1, 2], 0.0, 5.0)
    >>> bool(np.ptp(free.energy) < 1e-7 * free.energy[0]), str(free.ending)
    (True, 'the time asked for is over')
    """
    loads = Loads() if loads is None else loads
    at = np.asarray(time, dtype=np.float64)
    if at.ndim != 1 or len(at) < 2 or not (np.diff(at) > 0).all():
        raise ProblemError("time is not a rising sequence of two or more numbers")
    if loads.friction.each("radius").any():
        raise ProblemError("friction in proportion to joint forces is not possible in a free response")
    _check_start(linkage, masses, theta2)
    drive = torque if callable(torque) else _steady(torque)

    def rates(now: float, y: FloatArray) -> list[float]:
        unit = solve_kinematics(linkage, np.array([y[0]]))
        inertia, still = _equation_of_motion(unit, float(y[1]), masses, loads)
        return [float(y[1]), (drive(now, float(y[0]), float(y[1])) - still) / inertia]

    with warnings.catch_warnings():
        # A step that is tried may meet a dead position, before an event ends the motion there.
        warnings.simplefilter("ignore", DeadPositionWarning)
        done = scipy.integrate.solve_ivp(
            rates, (at[0], at[-1]), [theta2, omega2], method="DOP853", t_eval=at, rtol=tolerance,
            atol=tolerance * 1e-2, events=_endings(linkage, loads), max_step=_longest_step(at, omega2),
        )  # fmt: skip
    if done.status < 0:
        raise SolverError(f"the motion could not be integrated: {done.message}")
    alpha2 = np.array([rates(now, y)[1] for now, y in zip(done.t, done.y.T, strict=True)])
    state = solve_kinematics(linkage, done.y[0], done.y[1], alpha2)
    ending = Ending.TIME
    if done.status == 1:
        ending = Ending.DEAD_POSITION if done.t_events and len(done.t_events[0]) else Ending.AT_REST
    return FreeResponse(done.t, state, mechanical_energy(state, masses, loads), ending)


def _equation_of_motion(unit: Kinematics, omega2: float, masses: Masses, loads: Loads) -> tuple[float, float]:
    """Inertia felt by the driver, and the torque that keeps its speed, by virtual work.

    `unit` is the position with the driver at a steady 1 rad/s; accelerations go with omega2^2.
    """
    state = Kinematics(
        unit.linkage, unit.theta2, unit.theta3, unit.theta4,
        *(omega2 * rate for rate in (unit.omega2, unit.omega3, unit.omega4)),
        *(omega2**2 * rate for rate in (unit.alpha2, unit.alpha3, unit.alpha4)),
        *(omega2**3 * rate for rate in (unit.jerk2, unit.jerk3, unit.jerk4)),
    )  # fmt: skip
    gravity = loads.gravity_vector()
    inertia, still = np.zeros(1), -load_power(unit, state, loads)
    for link in (2, 3, 4):
        body, (_, omega, alpha, _) = masses.of(link), unit.angular(link)
        centre = unit.point(link, body.centre)
        inertia = inertia + body.mass * (centre.velocity**2).sum(axis=-1) + body.inertia * omega**2
        push = omega2**2 * centre.acceleration - gravity
        still = still + body.mass * (push * centre.velocity).sum(axis=-1)
        still = still + omega2**2 * body.inertia * alpha * omega
    return float(inertia[0]), float(still[0])


def _check_start(linkage: FourBar, masses: Masses, theta2: float) -> None:
    start = solve_kinematics(linkage, theta2)  # names an angle at which the linkage cannot close
    if not abs(np.sin(start.theta4 - start.theta3)) > _DEAD_END:
        raise AssemblyError(
            f"the linkage stands in a dead position at driver angle {np.degrees(theta2):.6g} deg"
        )
    if not any(np.any(masses.of(link).mass > 0) or np.any(masses.of(link).inertia > 0) for link in (2, 3, 4)):
        raise ProblemError("the links have no inertia, so no torque gives them a motion")


def _steady(torque: float) -> Callable[[float, float, float], float]:
    return lambda now, theta2, omega2: torque  # noqa: ARG005


def _endings(linkage: FourBar, loads: Loads) -> list[Callable[[float, FloatArray], float]]:
    """Events that end a motion: a dead position, and rest where friction may hold."""

    def near_dead(now: float, y: FloatArray) -> float:  # noqa: ARG001
        state = solve_position(linkage, y[0])
        sine = float(linkage.assembly * np.sin(state.theta4 - state.theta3))
        return sine - _DEAD_END if np.isfinite(sine) else -1.0

    def at_rest(now: float, y: FloatArray) -> float:  # noqa: ARG001
        return float(y[1])

    events: list[Any] = [near_dead]
    if loads.friction.each("coulomb").any():
        events.append(at_rest)
    for event in events:
        event.terminal = True
    return events


def _longest_step(time: FloatArray, omega2: float) -> float:
    """A step in which no event is passed over: at most a tenth of a turn at the starting speed."""
    span = float(time[-1] - time[0])
    return min(span, 0.2 * np.pi / abs(omega2)) if omega2 else span / 20
