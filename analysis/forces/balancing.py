"""Counterweights: against the force that shakes the ground, and for an even drive torque."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.loads import Loads, cross, turned
from grashof.analysis.forces.mass import Body, Masses
from grashof.analysis.mechanism.closing import dyad_of
from grashof.analysis.mechanism.driver_law import mean_over
from grashof.analysis.mechanism.dyad import Block, Pins
from grashof.analysis.mechanism.even_motion import even_motion
from grashof.analysis.mechanism.extremes import extremes_of
from grashof.analysis.mechanism.kinematics import Kinematics, solve_kinematics
from grashof.analysis.mechanism.mobility import full_rotation
from grashof.analysis.numerics.minimax import least_peak, least_peak_at
from grashof.analysis.numerics.peaks import Curve
from grashof.problems import AssemblyError, Linkage, ProblemError
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray
from grashof.problems.values.errors import wrong_value


@dataclass(frozen=True, slots=True, eq=False)
class ForceBalance:
    """Counterweights that keep the centre of mass of the moving links at rest.

    Parameters
    ----------
    crank_weight, output_weight : Body
        Point masses on links 2 and 4.
    masses : Masses
        The links with them.
    """

    crank_weight: Body
    output_weight: Body
    masses: Masses


@dataclass(frozen=True, slots=True, eq=False)
class TorqueBalance:
    """A counterweight on the crank that evens out the drive torque.

    Parameters
    ----------
    crank_weight : Body
    masses : Masses
        The links with it.
    torque_before, torque_after : ndarray, shape (N,), N length
        Of the drive, over the turn.
    """

    crank_weight: Body
    masses: Masses
    torque_before: FloatArray
    torque_after: FloatArray


def balance_force(
    linkage: Linkage,
    masses: Masses,
    crank_radius: npt.ArrayLike | None = None,
    output_radius: npt.ArrayLike | None = None,
) -> ForceBalance:
    """Counterweights on crank and output that remove the shaking force for every motion.

    Parameters
    ----------
    linkage : Linkage
    masses : Masses
    crank_radius, output_radius : array_like, shape (...), length, optional
        Distances of the counterweights from O2 and O4; by default r2 and r4, of an inverted slider-crank
        r2 and r2.

    Returns
    -------
    ForceBalance

    Raises
    ------
    ProblemError
        A slider-crank or a six-bar, which such weights cannot balance.

    Notes
    -----
    Linearly independent vectors (Berkof & Lowen 1969, *A new method for completely force balancing
    simple linkages*): with the coupler's direction eliminated by the loop equation, the system's
    centre of mass stays where it is when the factors of the two remaining directions vanish. The rod of
    an inverted slider-crank turns with its block, so that its direction need not be eliminated there.
    Shaking moment and drive torque usually grow.

    Examples
    --------
    >>> from grashof.analysis import solve_kinematics, system_centre, uniform_bars
    >>> from grashof.problems import FourBar
    >>> jack = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
    >>> balanced = balance_force(jack, uniform_bars(jack, 300.0))
    >>> centre = system_centre(balanced.masses, solve_kinematics(jack, np.linspace(0, 6, 7)))
    >>> bool(np.abs(centre.acceleration).max() < 1e-14)
    True
    """
    crank, output = _unbalanced(linkage, masses)
    crank_weight = counterweight(-crank, linkage.r2 if crank_radius is None else crank_radius)
    sizes = dyad_of(linkage)
    default = sizes.n if isinstance(sizes, Pins) else linkage.r2
    output_weight = counterweight(-output, default if output_radius is None else output_radius)
    return ForceBalance(
        crank_weight, output_weight, masses.with_body(2, crank_weight).with_body(4, output_weight)
    )


def _unbalanced(linkage: Linkage, masses: Masses) -> tuple[ComplexArray, ComplexArray]:
    """Factors of the directions of links 2 and 4 in the moment of all masses, in the frames of these."""
    at_crank, own, at_output = (body.centre @ np.array([1, 1j]) for body in masses.bodies[:3])
    crank, output = masses.crank.mass * at_crank, masses.output.mass * at_output
    kind = linkage.mechanism
    if len(kind.dyads) > 1:
        raise ProblemError(
            f"a {kind.word} has two loops, so counterweights on links 2 and 4 cannot keep its centre of mass "
            "at rest"
        )
    sizes = dyad_of(linkage)
    if isinstance(sizes, Pins):
        share = own / sizes.m
        crank = crank + masses.coupler.mass * linkage.r2 * (1 - share)
        return crank, output + masses.coupler.mass * sizes.n * share
    if isinstance(sizes, Block):  # theta3 is theta4 less a right angle
        return crank + masses.coupler.mass * linkage.r2, output - 1j * masses.coupler.mass * own
    raise ProblemError(
        f"a {kind.word} has no link 4 that turns about the ground, so counterweights on links 2 "
        "and 4 cannot keep its centre of mass at rest; balance_reciprocating makes its shaking force less"
    )


def balance_torque(
    state: Kinematics, masses: Masses, loads: Loads, radius: float, measure: str = "rms"
) -> TorqueBalance:
    """The counterweight on the crank that makes samples of the drive torque most even, as on a pumpjack.

    `balance_turn` does so for the torque between samples, too.

    Parameters
    ----------
    state : Kinematics
        One linkage over a turn of its driver at steady speed, in equal steps.
    masses : Masses
    loads : Loads
        With gravity, by which the counterweight works.
    radius : float, length
        Its distance from O2.
    measure : str
        "rms": least root mean square of the torque; "peak": least peak.

    Returns
    -------
    TorqueBalance

    Raises
    ------
    ProblemError
        No gravity, an uneven driver, or another measure.

    Notes
    -----
    At steady speed a weight on the crank adds -(r x m g) to the torque, linear in the two
    components of m r: least squares, or a linear programme for the peak. With friction in
    proportion to the joint forces the result is only nearly optimal.
    """
    gravity = _acting(loads)
    if np.ndim(state.theta2) != 1 or np.any(state.alpha2 != 0):
        raise ProblemError("state is not a turn of a single linkage at steady speed")
    before = inverse_dynamics(state, masses, loads).torque
    effects = _effects(gravity, state.theta2).T
    if measure == "rms":
        moment = np.asarray(np.linalg.lstsq(effects, -before, rcond=None)[0], dtype=np.float64)
    elif measure == "peak":
        moment, _ = least_peak_at(before, effects)
    else:
        raise wrong_value("measure", measure, "'rms' or 'peak'")
    return _balanced(state, masses, loads, moment, radius)


def balance_turn(
    linkage: Linkage, masses: Masses, omega2: float, loads: Loads, radius: float, measure: str = "rms"
) -> TorqueBalance:
    """The counterweight on the crank that makes the drive torque of a turn most even.

    Parameters
    ----------
    linkage : Linkage
        A single linkage whose driver turns fully.
    masses : Masses
    omega2 : float, rad/s
        Steady.
    loads, radius, measure
        As for `balance_torque`.

    Returns
    -------
    TorqueBalance
        With the torques at every degree of the driver, from 0 to 360.

    Raises
    ------
    AssemblyError
        The driver does not turn fully.
    ProblemError
        No gravity, or another measure.

    Notes
    -----
    As `balance_torque`, with integrals over the turn that are refined until they stay as they are; or for
    the peak over driver angles to which those of the peaks that are left are added until none is higher
    (an exchange method: Hettich & Kortanek 1993, *SIAM Rev.* 35(3), 380-429).

    Examples
    --------
    >>> from grashof.analysis import uniform_bars
    >>> from grashof.problems import FourBar
    >>> jack = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
    >>> bars, weight = uniform_bars(jack, (312, 312, 314)), Loads(gravity=(0, -9.81))
    >>> found = balance_turn(jack, bars, 2 * np.pi / 3, weight, radius=1.0, measure="peak")
    >>> [float(np.abs(torque).max().round()) for torque in (found.torque_before, found.torque_after)]
    [23743.0, 3534.0]
    """
    gravity = _acting(loads)
    if not full_rotation(linkage):
        raise AssemblyError("the driver does not turn fully, so no counterweight evens out a turn of it")

    def torque(theta2: FloatArray) -> FloatArray:
        return inverse_dynamics(solve_kinematics(linkage, theta2, omega2), masses, loads).torque

    def effects(theta2: FloatArray) -> FloatArray:
        return _effects(gravity, theta2)

    if measure == "rms":
        moment = _least_rms(linkage, torque, effects)
    elif measure == "peak":
        moment = _least_peak_over_turn(linkage, torque, effects)
    else:
        raise wrong_value("measure", measure, "'rms' or 'peak'")
    state = solve_kinematics(linkage, np.radians(np.arange(361)), omega2)
    return _balanced(state, masses, loads, moment, radius)


def _acting(loads: Loads) -> FloatArray:
    gravity = loads.gravity_vector()
    if not gravity.any():
        raise ProblemError("gravity is zero, so no counterweight can work against the torque")
    return gravity


def _effects(gravity: FloatArray, theta2: FloatArray) -> FloatArray:
    """Torque for a unit of each component of mass times place, shape (2, N)."""
    return np.stack([-cross(turned(np.array(unit), theta2), gravity) for unit in ((1.0, 0.0), (0.0, 1.0))])


def _balanced(
    state: Kinematics, masses: Masses, loads: Loads, moment: FloatArray, radius: float
) -> TorqueBalance:
    weight = counterweight(moment[0] + 1j * moment[1], radius)
    balanced = masses.with_body(2, weight)
    before, after = (inverse_dynamics(state, each, loads).torque for each in (masses, balanced))
    return TorqueBalance(weight, balanced, before, after)


def _least_rms(linkage: Linkage, torque: Curve, effects: Curve) -> FloatArray:
    """Moment m r with the least root mean square of torque + effects m r over the turn."""

    def products(theta2: FloatArray) -> FloatArray:
        each = effects(theta2)
        return np.concatenate([each * torque(theta2), each[:1] * each, each[1:] * each])

    (fx, fy, *square), _ = mean_over(linkage, products, 0.0, TURN)
    return np.asarray(np.linalg.solve(np.reshape(square, (2, 2)), [-fx, -fy]))


def _least_peak_over_turn(linkage: Linkage, torque: Curve, effects: Curve) -> FloatArray:
    """Moment m r with the least peak of |torque + effects m r| over the turn."""
    motion = even_motion(linkage, 0.0, TURN)

    def outermost(curve: Curve) -> tuple[float, float]:
        found = extremes_of(curve, 0.0, 1.0, closed=True)
        return found.at_low, found.at_high

    def base(share: FloatArray) -> FloatArray:
        return torque(motion.theta2(share))

    found = least_peak(base, lambda share: effects(motion.theta2(share)).T, 0.0, 1.0, outermost)
    return found.parameters


def counterweight(moment: ComplexArray, radius: npt.ArrayLike) -> Body:
    """Point mass with a given moment (mass times place) at a given radius."""
    radius, size = np.asarray(radius, dtype=np.float64), np.abs(moment)
    if not np.all(radius > 0):
        raise ProblemError(f"the counterweight's radius is {radius}; it must be greater than zero")
    place = radius * np.divide(moment, size, out=np.ones(size.shape, dtype=complex), where=size > 0)
    return Body(size / radius, 0.0, np.stack([place.real, place.imag], axis=-1))
