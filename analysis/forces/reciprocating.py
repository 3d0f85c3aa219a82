"""The shaking force of a slider-crank by its harmonics, and the counterweight on the crank against it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.balancing import counterweight
from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.joints import slide_direction, slide_normal
from grashof.analysis.forces.mass import Body, Masses
from grashof.analysis.mechanism.kinematics import solve_kinematics
from grashof.analysis.mechanism.mobility import full_rotation
from grashof.problems import AssemblyError, Linkage
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray
from grashof.problems.values.checks import number_within
from grashof.problems.values.errors import wrong_value

_FEWEST, _MOST = 128, 2**16  # driver angles
_SETTLED = 1e-13  # share of the greatest force


@dataclass(frozen=True, slots=True, eq=False)
class ReciprocatingBalance:
    """A counterweight on the crank of a slider-crank.

    Parameters
    ----------
    crank_weight : Body
        A point mass.
    masses : Masses
        The links with it.
    rotating, reciprocating : ndarray, shape (...), kg
        Masses that move with A and with B: that of the rod is shared by its centre of mass.
    """

    crank_weight: Body
    masses: Masses
    rotating: FloatArray
    reciprocating: FloatArray


def balance_reciprocating(
    linkage: Linkage, masses: Masses, share: float = 0.5, radius: npt.ArrayLike | None = None
) -> ReciprocatingBalance:
    """A counterweight on the crank against the rotating mass and a share of the reciprocating mass.

    Parameters
    ----------
    linkage : SliderCrank
    masses : Masses
    share : float
        Of the reciprocating mass, from 0 to 1; textbooks take from a half to two thirds.
    radius : array_like, shape (...), length, optional
        Distance of the counterweight from O2; r2 by default.

    Returns
    -------
    ReciprocatingBalance

    Notes
    -----
    With the rod as two point masses, m3 u / r3 at B and the rest at A, the shaking force has the primary
    part m r2 omega2^2 cos(theta) of the reciprocating mass m along the slide; a weight on the crank takes
    `share` of it away there and puts as much across the slide. A half makes the primary force least, and
    equally great in all directions (Norton, *Design of Machinery*, secs. 13.10 and 14.5).

    Examples
    --------
    >>> from grashof.problems import SliderCrank
    >>> engine = SliderCrank(o2=(0, 0), r2=0.05, r3=0.2)
    >>> masses = Masses(Body(0), Body(0.6, 0.003, (0.05, 0.0)), Body(0.35))
    >>> found = balance_reciprocating(engine, masses, share=0.5)
    >>> float(found.rotating.round(9)), float(found.reciprocating.round(9))
    (0.45, 0.5)
    >>> float(found.crank_weight.mass.round(9)), float(found.crank_weight.centre[0].round(9))
    (0.7, -0.05)
    """
    _check_kind(linkage)
    share = number_within(share, 0.0, 1.0, "share")
    at_b = masses.coupler.mass * masses.coupler.centre[..., 0] / linkage.r3
    rotating, reciprocating = masses.coupler.mass - at_b, at_b + masses.output.mass
    own = masses.crank.mass * (masses.crank.centre @ np.array([1, 1j]))
    moment = -(own + linkage.r2 * (rotating + share * reciprocating))
    weight = counterweight(moment, linkage.r2 if radius is None else radius)
    return ReciprocatingBalance(
        weight, masses.with_body(2, weight), np.asarray(rotating), np.asarray(reciprocating)
    )


def shaking_harmonics(linkage: Linkage, masses: Masses, omega2: float, orders: int = 2) -> ComplexArray:
    """Harmonics of the shaking force of a slider-crank whose driver turns steadily: primary, secondary, ...

    Parameters
    ----------
    linkage : SliderCrank
        A single linkage whose driver turns fully.
    masses : Masses
    omega2 : float, rad/s
    orders : int
        How many, from the primary on.

    Returns
    -------
    ndarray of complex, shape (orders, 2), N
        c of the parts Re(c e^(i n phi)), phi = theta2 - slide_angle, along the slide and across it, to
        its left.

    Raises
    ------
    AssemblyError
        The driver does not turn fully.

    Examples
    --------
    >>> from grashof.problems import SliderCrank
    >>> engine = SliderCrank(o2=(0, 0), r2=0.05, r3=0.2)
    >>> found = shaking_harmonics(engine, Masses(Body(0), Body(0), Body(2.0)), 100.0)
    >>> np.abs(found[:, 0]).round(3).tolist()  # m r omega^2, and nearly r2 / r3 of it
    [1000.0, 254.025]
    """
    _check_kind(linkage)
    if not full_rotation(linkage):
        raise AssemblyError("the driver does not turn fully, so the shaking force has no harmonics")
    count = max(_FEWEST, 4 * int(orders))
    found = _harmonics(linkage, masses, omega2, orders, count)
    while count < _MOST:
        count *= 2
        before, found = found, _harmonics(linkage, masses, omega2, orders, count)
        if np.abs(found - before).max() <= _SETTLED * np.abs(found).max():
            break
    return found


def _harmonics(linkage: Linkage, masses: Masses, omega2: float, orders: int, count: int) -> ComplexArray:
    """From equal steps of the driver, as the force is smooth and periodic."""
    phi = np.arange(count) * TURN / count
    state = solve_kinematics(linkage, phi + float(linkage.slide_angle), omega2)
    force = inverse_dynamics(state, masses).shaking_force
    parts = [(force * axis).sum(axis=-1) for axis in (slide_direction(state), slide_normal(state))]
    terms = np.fft.rfft(np.stack(parts, axis=-1), axis=0) * 2 / count
    return np.asarray(terms[1 : orders + 1])


def _check_kind(linkage: Linkage) -> None:
    if not (isinstance(linkage, Linkage) and linkage.mechanism.loops[0].slide_angle):
        raise wrong_value("linkage", linkage, "a SliderCrank")
