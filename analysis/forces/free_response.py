"""The motion of a linkage under a given drive torque."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.dynamics import equation_of_motion, friction_and_springs
from grashof.analysis.forces.energy import mechanical_energy
from grashof.analysis.forces.joints import joint_motion, joints_of
from grashof.analysis.forces.loads import Loads
from grashof.analysis.forces.mass import Masses
from grashof.analysis.mechanism.kinematics import Kinematics, SlideMotion, Turning, solve_kinematics
from grashof.analysis.numerics.collocation import Acceleration, Events, Panel, Path, integrate_motion
from grashof.problems import AssemblyError, DeadPositionWarning, Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray

Drive = float | Callable[[float, float, float], float]

# Margin of a loop at which a motion towards a dead position ends: beyond it the driver angle no
# longer shows how the linkage moves on.
_DEAD_END = 1e-3
_AHEAD = 1e-6  # rad of the driver, by which to look ahead for the sense in which a joint is about to turn
_PARTS = 10_000  # of a motion with friction, between which a joint changes its sense
_ROUNDS = 50  # of friction that depends on the acceleration, where a driver sets off


class Ending(StrEnum):
    """Why a free motion ended."""

    TIME = "the requested time is over"
    DEAD_POSITION = "the driver came to a dead position"
    AT_REST = "friction brought the driver to rest"


@dataclass(frozen=True, slots=True, eq=False)
class FreeResponse:
    """A motion under given forces.

    Parameters
    ----------
    time : ndarray, shape (N,), s
        The requested times that the motion reached.
    state : Kinematics
        Of shape (N,).
    energy : ndarray, shape (N,), N length
        `mechanical_energy`.
    ending : Ending
    end : float, s
        When it ended.
    """

    time: FloatArray
    state: Kinematics
    energy: FloatArray
    ending: Ending
    end: float


def free_response(
    linkage: Linkage,
    masses: Masses,
    time: npt.ArrayLike,
    theta2: float,
    omega2: float,
    torque: Drive = 0.0,
    loads: Loads | None = None,
    tolerance: float = 1e-10,
) -> FreeResponse:
    """Motion of a linkage under a drive torque, weights, springs and friction.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    masses : Masses
    time : array_like, shape (N,), s
        Rising; the motion starts at the first.
    theta2, omega2 : float, rad and rad/s
        At the start.
    torque : float or callable, N length
        Of the drive; a function of time, theta2 and omega2.
    loads : Loads, optional
        Friction ends the motion where it keeps the driver at rest.
    tolerance : float
        Relative, of each step.

    Returns
    -------
    FreeResponse

    Raises
    ------
    AssemblyError
        The linkage cannot close at the start, or is in a dead position.
    ProblemError
        The links have no inertia, or the times do not rise.
    SolverError
        The motion has no acceleration, as where friction locks the linkage.

    Notes
    -----
    One degree of freedom: with velocities per unit of omega2, virtual work gives
    T = I(theta2) alpha2 + T0(theta2, omega2), where T0 is the torque without driver acceleration.
    Friction in proportion to the joint forces, which depend on alpha2, is found along with it.
    Integrated by collocation at 16 points of each step; while the driver turns one way friction has
    one sign, so that steps end where it stops.

    Examples
    --------
    >>> from grashof.analysis import uniform_bars
    >>> from grashof.problems import FourBar
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    >>> free = free_response(crank_rocker, uniform_bars(crank_rocker, 2.0), [0, 1, 2], 0.0, 5.0)
    >>> bool(np.ptp(free.energy) < 1e-7 * free.energy[0]), str(free.ending)
    (True, 'the requested time is over')
    """
    loads = Loads() if loads is None else loads
    at = np.asarray(time, dtype=np.float64)
    if at.ndim != 1 or len(at) < 2 or not (np.diff(at) > 0).all():
        raise ProblemError("time is not a rising sequence of two or more numbers")
    _check_start(linkage, masses, theta2)

    def given(now: FloatArray, angle: FloatArray, rate: FloatArray) -> FloatArray:
        if not callable(torque):
            return np.full(now.shape, float(torque))
        states = zip(now.tolist(), angle.tolist(), rate.tolist(), strict=True)
        return np.array([float(torque(*each)) for each in states])

    def rates(senses: FloatArray | None) -> Acceleration:
        def alpha2(now: FloatArray, angle: FloatArray, rate: FloatArray, guess: FloatArray) -> FloatArray:
            unit = solve_kinematics(linkage, angle)
            steady = _scaled(unit, rate, np.zeros(rate.shape))
            # Friction is that of joints that turn in `senses`, and of a driver with about this acceleration.
            in_joints = friction_and_springs(_scaled(unit, rate, guess), masses, loads, senses)
            inertia, still = equation_of_motion(unit, steady, masses, loads, in_joints)
            return (given(now, angle, rate) - still) / inertia

        return alpha2

    with warnings.catch_warnings(action="ignore", category=DeadPositionWarning), np.errstate(all="ignore"):
        # A step that is tried may meet a dead position, before an event ends the motion there.
        path, ending = _moved(rates, at, theta2, omega2, tolerance, _Rubbing.of(linkage, loads))
        end = path[-1].end
        reached = at if ending is Ending.TIME else at[at <= end]
        joined = Path(tuple(panel for part in path for panel in part.panels), None)
        state = solve_kinematics(linkage, *joined.at(reached))
    return FreeResponse(reached, state, mechanical_energy(state, masses, loads), ending, end)


def generalised_inertia(linkage: Linkage, theta2: npt.ArrayLike, masses: Masses) -> FloatArray:
    """Inertia of all links as the driver feels it, shape (...), kg length^2.

    Notes
    -----
    Twice the kinetic energy at 1 rad/s of the driver (Norton, *Design of Machinery*, sec. 10.12).

    Examples
    --------
    >>> from grashof.analysis import Body
    >>> from grashof.problems import FourBar
    >>> rod = Masses(Body(3.0, 0.2, (0.5, 0.0)), Body(0), Body(0))
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    >>> float(generalised_inertia(crank_rocker, 1.0, rod).round(9))
    0.95
    """
    return 2 * mechanical_energy(solve_kinematics(linkage, theta2), masses)


@dataclass(frozen=True, slots=True, eq=False)
class _Rubbing:
    """Joints whose friction has the sense in which they turn, or slide, however slowly."""

    linkage: Linkage
    joints: tuple[int, ...]

    @classmethod
    def of(cls, linkage: Linkage, loads: Loads) -> _Rubbing:
        coulomb, radius = (loads.friction.of(linkage, name) for name in ("coulomb", "radius"))
        return cls(linkage, tuple(joint for joint in joints_of(linkage) if coulomb[joint] or radius[joint]))

    def senses(self, theta2: float, sense: int) -> FloatArray:
        """In which the joints are about to turn where the driver turns in a sense, shape (J,)."""
        unit = solve_kinematics(self.linkage, np.array([theta2 + sense * _AHEAD]))
        joints = joints_of(self.linkage)
        return np.array([sense * np.sign(joint_motion(unit, joint)[1][0]) for joint in joints])

    def events(self, sense: int, senses: FloatArray | None) -> Events:
        """Ends of a part of the motion: near a dead position, at rest, where a joint turns back."""

        def values(theta2: FloatArray, omega2: FloatArray) -> FloatArray:
            unit = solve_kinematics(self.linkage, theta2)
            left = np.min(np.abs(unit.margins), axis=0) - _DEAD_END
            found = [np.where(np.isfinite(left), left, -1.0)]
            if senses is not None:
                found.append(sense * omega2)
                found += [sense * senses[joint] * joint_motion(unit, joint)[1] for joint in self.joints]
            return np.stack(np.broadcast_arrays(*found))

        return values


def _moved(
    rates: Callable[[FloatArray | None], Acceleration],
    time: FloatArray,
    theta2: float,
    omega2: float,
    tolerance: float,
    rubbing: _Rubbing,
) -> tuple[list[Path], Ending]:
    """Parts of the motion, each without a change of sense in a joint with friction, and its end."""
    now, last, path = float(time[0]), float(time[-1]), list[Path]()
    fastest = abs(omega2)
    while True:
        sense, senses = int(np.sign(omega2)), None
        if rubbing.joints:
            sense = sense or _sets_off(rates, now, theta2, rubbing)
            if not sense:
                return path or [Path((Panel(now, 0.0, theta2, 0.0, np.zeros(1)),), None)], Ending.AT_REST
            senses = rubbing.senses(theta2, sense)
        events = rubbing.events(sense, senses)
        path.append(integrate_motion(rates(senses), now, last, theta2, omega2, tolerance, events, fastest))
        fastest = max(fastest, path[-1].fastest())
        if path[-1].event is None or len(path) > _PARTS:
            return path, Ending.TIME
        if path[-1].event == 0:
            return path, Ending.DEAD_POSITION
        now, (theta2, omega2) = path[-1].end, path[-1].panels[-1].last()
        omega2 = 0.0 if path[-1].event == 1 else omega2


def _sets_off(
    rates: Callable[[FloatArray | None], Acceleration], now: float, theta2: float, rubbing: _Rubbing
) -> int:
    """The sense in which a driver at rest begins to turn against friction; 0 where friction holds it."""
    for sense in (1, -1):
        alpha, state = np.zeros(1), (np.array([now]), np.array([theta2]), np.zeros(1))
        begin = rates(rubbing.senses(theta2, sense))
        for _ in range(_ROUNDS):
            before, alpha = alpha, begin(*state, alpha)
            if not abs(float((alpha - before)[0])) > 1e-14 * abs(float(alpha[0])):
                break
        if sense * float(alpha[0]) > 0:
            return sense
    return 0


def _scaled(unit: Kinematics, omega2: FloatArray, alpha2: FloatArray) -> Kinematics:
    """The same position with the driver at another speed and acceleration; without jerks."""
    none = np.zeros(omega2.shape)

    def driven(rate: FloatArray, bend: FloatArray) -> tuple[FloatArray, FloatArray]:
        return omega2 * rate, omega2**2 * bend + alpha2 * rate

    turning = tuple(Turning(each.theta, *driven(each.omega, each.alpha), none) for each in unit.turning)
    slides = tuple(
        None if each is None else SlideMotion(each.travel, *driven(each.velocity, each.acceleration), none)
        for each in unit.slides
    )
    return Kinematics(unit.linkage, turning, slides, unit.margins)


def _check_start(linkage: Linkage, masses: Masses, theta2: float) -> None:
    start = solve_kinematics(linkage, theta2)  # AssemblyError where the linkage cannot close
    if not min(map(abs, start.margins)) > _DEAD_END:
        raise AssemblyError(f"the linkage is in a dead position at driver angle {np.degrees(theta2):.6g} deg")
    bodies = masses.by_link(linkage).values()
    if not any(np.any(body.mass > 0) or np.any(body.inertia > 0) for body in bodies):
        raise ProblemError("the links have no inertia, so no torque gives them a motion")
