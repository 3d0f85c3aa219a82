"""The moving plane of the coupler: its centrodes, and the circles of points on straight or even paths."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.four_bar.instant_centres import instant_centres
from grashof.analysis.mechanism.kinematics import PointMotion, solve_kinematics
from grashof.analysis.mechanism.position import solve_position
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray

_FAR = 1e12  # lengths of link 2


@dataclass(frozen=True, slots=True, eq=False)
class Centrodes:
    """The two curves that roll on each other while the coupler moves; each of shape (..., 2), length.

    Parameters
    ----------
    fixed : ndarray
        The instant centre I13 in global axes.
    moving : ndarray
        The same in the coupler's frame: (u, v) from A, u along AB.
    """

    fixed: FloatArray
    moving: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class CouplerCircles:
    """Where points of the coupler have no normal, no tangential, no acceleration at all.

    Parameters
    ----------
    pole : ndarray, shape (..., 2), length
        Instant centre I13, on both circles.
    inflection, bresse : ndarray, shape (..., 2), length
        Centres of the inflection circle, whose points pass an inflection of their paths (no normal
        acceleration), and of Bresse's circle, whose points have no tangential acceleration while the
        driver turns steadily.
    inflection_diameter, bresse_diameter : ndarray, shape (...), length
    acceleration_pole : ndarray, shape (..., 2), length
        Where the circles meet again: no acceleration.
    """

    pole: FloatArray
    inflection: FloatArray
    inflection_diameter: FloatArray
    bresse: FloatArray
    bresse_diameter: FloatArray
    acceleration_pole: FloatArray


def centrodes(linkage: Linkage, theta2: npt.ArrayLike) -> Centrodes:
    """Fixed and moving centrode of the coupler at given driver angles.

    Parameters
    ----------
    linkage : Linkage
    theta2 : array_like, shape (...), rad

    Returns
    -------
    Centrodes
        Not finite where the coupler does not turn, and where the linkage cannot close.

    Notes
    -----
    Norton, *Design of Machinery*, sec. 6.5.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> crossed = FourBar(o2=(0, 0), o4=(2, 0), r2=3, r3=2, r4=3, assembly=-1)    # rolling ellipses
    >>> found = centrodes(crossed, [1.0, 2.0])
    >>> (np.hypot(*found.fixed.T) + np.hypot(*(found.fixed - crossed.o4).T)).round(9).tolist()
    [3.0, 3.0]
    """
    state = solve_position(linkage, theta2)
    fixed = instant_centres(linkage, theta2).i13
    with np.errstate(invalid="ignore"):
        from_a = _unless_far(fixed - state.a, linkage)
        along = np.stack([np.cos(state.theta3), np.sin(state.theta3)], axis=-1)
        moving = np.stack([(from_a * axis).sum(axis=-1) for axis in (along, _across(along))], axis=-1)
    return Centrodes(state.a + from_a, moving)


def coupler_circles(linkage: Linkage, theta2: npt.ArrayLike) -> CouplerCircles:
    """Inflection circle, Bresse's circle and acceleration pole of the coupler.

    Parameters
    ----------
    linkage : Linkage
    theta2 : array_like, shape (...), rad

    Returns
    -------
    CouplerCircles
        Not finite where the coupler does not turn, in dead positions, and where the linkage cannot
        close.

    Notes
    -----
    The point of the coupler in the pole has an acceleration a; at r from the pole that is
    a + alpha k x r - omega^2 r beside a velocity omega k x r. It has no normal part where
    r . r = r . a / omega^2, no tangential part where r . r = r . (k x a) / alpha: circles through the
    pole with these two vectors as diameters (Bresse 1853; Bottema & Roth, *Theoretical Kinematics*,
    ch. 8).

    Examples
    --------
    In Norton's linkage, the curvature of a path on the inflection circle:

    >>> from grashof.problems import FourBar
    >>> from dataclasses import replace
    >>> from grashof.analysis.curves.curvature import curvature
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> found = coupler_circles(norton, 1.0)
    >>> top = found.inflection + found.inflection_diameter / 2 * np.array([0.0, 1.0])
    >>> state = solve_position(norton, 1.0)
    >>> turn, arm = np.exp(-1j * state.theta3), complex(*(top - state.a))
    >>> there = replace(norton, coupler_point=((arm * turn).real, (arm * turn).imag))
    >>> bool(abs(curvature(there, 1.0)) < 1e-12)
    True
    """
    state = solve_kinematics(linkage, theta2)
    omega, alpha = (np.asarray(rate)[..., None] for rate in (state.omega3, state.alpha3))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        arm = _unless_far(_across(state.a.velocity) / omega, linkage)
        there = _pole_acceleration(state.a, arm, omega, alpha)
        pole = state.a.position + arm
        normal, tangential = there / omega**2, _across(there) / alpha
        # a + alpha k x r - omega^2 r = 0
        still = (omega**2 * there + alpha * _across(there)) / (omega**4 + alpha**2)
        return CouplerCircles(
            pole=pole,
            inflection=pole + normal / 2,
            inflection_diameter=np.hypot(normal[..., 0], normal[..., 1]),
            bresse=pole + tangential / 2,
            bresse_diameter=np.hypot(tangential[..., 0], tangential[..., 1]),
            acceleration_pole=pole + still,
        )


def _pole_acceleration(a: PointMotion, arm: FloatArray, omega: FloatArray, alpha: FloatArray) -> FloatArray:
    acceleration: FloatArray = a.acceleration + alpha * _across(arm) - omega**2 * arm
    return acceleration


def _unless_far(arm: FloatArray, linkage: Linkage) -> FloatArray:
    """From A to the pole; NaN where it is at infinity but for rounding."""
    far = np.hypot(arm[..., 0], arm[..., 1]) > _FAR * linkage.r2
    return np.where(far[..., None], np.nan, arm)


def _across(vector: FloatArray) -> FloatArray:
    """K x vector: a quarter turn counter-clockwise."""
    return np.stack([-vector[..., 1], vector[..., 0]], axis=-1)
