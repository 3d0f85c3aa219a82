"""Torque of a pumping unit's gear reducer by the torque factors of the American Petroleum Institute."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.from_spec import curve_through
from grashof.analysis.forces.statics import advantage
from grashof.analysis.mechanism.mobility import full_rotation
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.mechanism.stroke import output_stroke
from grashof.problems import FourBar, ProblemError
from grashof.problems.values.arrays import TURN, FloatArray, turned_from
from grashof.problems.values.dynamics.pumping_unit import CRANK, PumpingUnitSpec

_ROCKS = 1e-9  # rad: least swing of a rocking beam


@dataclass(frozen=True, slots=True, eq=False)
class RodMotion:
    """Motion of the polished rod with the crank; each of shape (...).

    Parameters
    ----------
    position : ndarray
        Share of the stroke from its lower end.
    torque_factor : ndarray, length
        Rise of the rod per radian of the crank: positive on the up stroke.
    """

    position: FloatArray
    torque_factor: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class ReducerTorque:
    """Loads and torques at crank angles, each of shape (...); torques in the sense in which the crank turns.

    Parameters
    ----------
    net_load : ndarray, N
        On the polished rod, less the structural unbalance.
    counterbalance : ndarray, N m
        Torque of the counterbalance.
    torque : ndarray, N m
        Torque of the reducer.
    permissible_load : ndarray, N
        On the polished rod at the reducer's rating: the most on the up stroke, the least on the down stroke.
        NaN without a rating.
    """

    net_load: FloatArray
    counterbalance: FloatArray
    torque: FloatArray
    permissible_load: FloatArray


def crank_angle(theta2: npt.ArrayLike, unit: PumpingUnitSpec) -> FloatArray:
    """Crank angle of the API at driver angles, shape (...), rad, in [0, 2 pi).

    Notes
    -----
    Clockwise from 12 o'clock, seen with the well to the right (from behind if it is drawn on the left).

    Examples
    --------
    >>> float(np.degrees(crank_angle(0.0, PumpingUnitSpec())))
    90.0
    """
    angle: FloatArray = (unit.side * (np.pi / 2 - np.asarray(theta2, dtype=np.float64))) % TURN
    return angle


def driver_angle(crank: npt.ArrayLike, unit: PumpingUnitSpec) -> FloatArray:
    """Driver angle theta2 at crank angles of the API, shape (...), rad."""
    angle: FloatArray = np.pi / 2 - unit.side * np.asarray(crank, dtype=np.float64)
    return angle


def beam_limits(linkage: FourBar) -> FloatArray:
    """Angles theta4 at both ends of the stroke of a pumping unit's beam, shape (2,), rad.

    Raises
    ------
    ProblemError
        The crank does not turn fully, or the beam does.
    """
    limits = output_stroke(linkage).theta4
    if not (full_rotation(linkage) and np.ptp(limits) > _ROCKS):
        raise ProblemError("pumping_unit: the crank does not turn fully while the beam rocks")
    return limits


def rod_motion(
    linkage: FourBar,
    crank: npt.ArrayLike,
    arm: float,
    unit: PumpingUnitSpec,
    limits: FloatArray | None = None,
) -> RodMotion:
    """Position and torque factor of the polished rod at crank angles of the API.

    Parameters
    ----------
    linkage : FourBar
        A single linkage whose crank turns fully.
    crank : array_like, shape (...), rad
    arm : float, length
        From O4 to the horsehead: the wireline leaves its arc tangentially.
    unit : PumpingUnitSpec
    limits : ndarray, shape (2,), rad, optional
        Known `beam_limits`.

    Returns
    -------
    RodMotion

    Raises
    ------
    ProblemError
        The crank does not turn fully, or the beam does.

    Notes
    -----
    The torque factor arm * omega4 / omega2 equals A R sin(alpha) / (C sin(beta)) of API Specification 11E.

    Examples
    --------
    The Lufkin C-912D-427-144, whose maker states 68.82 in at 90 deg:

    >>> unit = FourBar(o2=(0, 0), o4=(120, 151), r2=47, r3=148.5, r4=120.03)
    >>> rod_motion(unit, np.radians(90), 180.0, PumpingUnitSpec()).torque_factor.round(3)
    np.float64(68.825)
    """
    limits = beam_limits(linkage) if limits is None else limits
    theta2 = driver_angle(crank, unit)
    theta4, middle = solve_position(linkage, theta2).theta4, limits.mean()
    beyond = turned_from(theta4, middle)
    ratio = advantage(linkage, theta2).velocity_ratio
    return RodMotion(
        position=np.asarray(0.5 + unit.side * beyond / np.ptp(limits))[()],
        torque_factor=np.asarray(-unit.sense * arm * ratio)[()],
    )


def rod_load(unit: PumpingUnitSpec) -> Callable[[FloatArray, RodMotion], FloatArray] | None:
    """The load on the polished rod, N, as a function of crank angle and rod motion; None if not stated."""
    if unit.rod_load is not None:
        constant = unit.rod_load
        return lambda crank, motion: np.full(np.shape(crank), constant)  # noqa: ARG005
    if unit.values is None:
        return None
    if unit.over == CRANK:
        over_crank = curve_through(unit.values, period=360.0)
        return lambda crank, motion: over_crank(np.degrees(crank))[..., 0]  # noqa: ARG005
    over_position = curve_through(unit.values)

    def load(crank: FloatArray, motion: RodMotion) -> FloatArray:  # noqa: ARG001
        both = over_position(np.clip(motion.position, 0.0, 1.0))
        return np.where(motion.torque_factor >= 0, both[..., 0], both[..., 1])

    return load


def reducer_torque(
    unit: PumpingUnitSpec, crank: npt.ArrayLike, torque_factor: npt.ArrayLike, load: npt.ArrayLike
) -> ReducerTorque:
    """Torque of the gear reducer from the load on the polished rod.

    Parameters
    ----------
    unit : PumpingUnitSpec
    crank : array_like, shape (...), rad
        Of the API.
    torque_factor : array_like, shape (...), m
    load : array_like, shape (...), N

    Returns
    -------
    ReducerTorque

    Notes
    -----
    API Specification 11E: T = TF (W - B) - M sin(theta + tau), with the torque factor TF, the load W, the
    structural unbalance B, the greatest moment M of the counterbalance, its phase tau and the crank angle
    theta. Inertia is neglected.

    Examples
    --------
    >>> unit = PumpingUnitSpec(structural_unbalance=-2e3, counterbalance=3e4, rating=1e4)
    >>> found = reducer_torque(unit, np.radians(90), 1.75, 20e3)
    >>> float(found.torque), round(float(found.permissible_load), 6)
    (8500.0, 20857.142857)
    """
    factor, net = np.asarray(torque_factor), np.asarray(load) - unit.structural_unbalance
    phase = np.asarray(crank) + np.radians(unit.counterbalance_phase_deg)
    counterbalance = unit.sense * unit.counterbalance * np.sin(phase)
    rating = np.nan if unit.rating is None else unit.rating
    with np.errstate(divide="ignore", invalid="ignore"):
        permissible = (rating + counterbalance) / factor + unit.structural_unbalance
    return ReducerTorque(net, counterbalance, factor * net - counterbalance, permissible)
