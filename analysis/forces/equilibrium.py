"""Equilibrium positions of a linkage, their stability, and the frequency of small swings about them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.polynomial import Chebyshev

from grashof.analysis.forces.free_response import generalised_inertia
from grashof.analysis.forces.loads import Loads
from grashof.analysis.forces.mass import Masses
from grashof.analysis.forces.statics import load_power, virtual_power
from grashof.analysis.mechanism.kinematics import virtual_motion
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, FloatArray

_SAMPLES = 721
_NOTHING = 1e-12  # share of the greatest power of the loads: no torque
_WINDOW = 0.02  # rad, about an equilibrium, in which the torque is a polynomial
_DEGREE = 10
_SAME = 1e-9  # rad: roots closer than this are one
Curve = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True, slots=True, eq=False)
class Equilibria:
    """Driver angles at which weights, springs and loads are in balance.

    Parameters
    ----------
    theta2 : ndarray, shape (N,), rad
        Rising.
    stiffness : ndarray, shape (N,), N length/rad
        By which the torque that brings the driver back grows; negative where it moves away.
    inertia : ndarray, shape (N,), kg length^2
        That the driver feels.
    everywhere : bool
        All angles are, and none is named.
    """

    theta2: FloatArray
    stiffness: FloatArray
    inertia: FloatArray
    everywhere: bool = False

    @property
    def frequency(self) -> FloatArray:
        """Natural frequency of small swings, shape (N,), Hz; NaN where it is unstable."""
        with np.errstate(invalid="ignore", divide="ignore"):
            found = np.sqrt(self.stiffness / self.inertia) / (2 * np.pi)
        return np.where(np.isfinite(found) & (self.stiffness > 0), found, np.nan)


def equilibria(
    linkage: Linkage, masses: Masses, loads: Loads, start: float, end: float, *, closed: bool = False
) -> Equilibria:
    """Equilibrium positions of a linkage whose driver is free.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    masses : Masses
    loads : Loads
        Its friction is left out.
    start, end : float, rad
        Driver angles between which they are sought; dead positions may lie at the ends.
    closed : bool
        The end is the start of the next turn.

    Returns
    -------
    Equilibria

    Notes
    -----
    The roots of the virtual power of `virtual_motion`, between samples that lie closer towards the
    ends; two roots between neighbours are not seen. Small swings: I alpha2 = -k (theta2 - theta2e),
    k the slope of the holding torque.

    Examples
    --------
    A pendulum as the crank, 1 m long: it hangs still and stands upright.

    >>> from grashof.analysis import Body
    >>> from grashof.problems import FourBar
    >>> linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    >>> pendulum = Masses(Body(2.0, 0.0, (1.0, 0.0)), Body(0), Body(0))
    >>> found = equilibria(linkage, pendulum, Loads(gravity=(0, -9.81)), 0.0, 2 * np.pi, closed=True)
    >>> np.degrees(found.theta2).round(9).tolist(), (found.frequency * 2 * np.pi).round(6).tolist()
    ([90.0, 270.0], [nan, 3.132092])
    """
    share = np.linspace(0, 1, _SAMPLES)
    share = np.append(share, 1 + share[1]) if closed else (1 - np.cos(np.pi * share)) / 2
    places = start + (end - start) * share

    def power(theta2: FloatArray) -> FloatArray:
        virtual, rest = virtual_motion(linkage, theta2)
        return virtual_power(virtual, rest, masses, loads)

    values, empty = power(places), np.zeros(0)
    known = np.isfinite(values)
    if not np.abs(values[known]).max(initial=0.0) > _NOTHING * _work(linkage, masses, loads, places):
        return Equilibria(empty, empty, empty, everywhere=bool(known.any()))
    roots = _roots(power, places, values)
    if closed:  # the places go a step beyond the turn, so that a root at its end is seen
        roots = np.sort(np.where(roots >= end - _SAME, roots - TURN, roots))
    roots = roots[np.diff(roots, prepend=-np.inf) > _SAME]
    low, high = (-np.inf, np.inf) if closed else (start, end)
    slopes = np.array([_slope(power, root, low, high) for root in roots])
    virtual, _ = virtual_motion(linkage, roots)
    with np.errstate(divide="ignore", invalid="ignore"):
        return Equilibria(roots, -slopes / virtual.omega2, generalised_inertia(linkage, roots, masses))


def _work(linkage: Linkage, masses: Masses, loads: Loads, places: FloatArray) -> float:
    """Greatest power of all loads if their parts did not balance each other."""
    virtual, rest = virtual_motion(linkage, places)
    gravity = float(np.hypot(*loads.gravity_vector()))
    parts = [
        body.mass * gravity * virtual.point(link, body.centre).speed
        for link, body in masses.by_link(linkage).items()
    ]
    for kind in ("forces", "moments", "springs", "torsion_springs"):
        for each in getattr(loads, kind):
            alone: dict[str, Any] = {kind: (each,)}
            parts.append(np.abs(load_power(virtual, rest, Loads(**alone))))
    return float(np.nanmax(np.sum(parts, axis=0), initial=0.0))


def _roots(power: Curve, places: FloatArray, values: FloatArray) -> FloatArray:
    """Where the power changes its sign."""
    above = values >= 0
    known = np.isfinite(values[:-1]) & np.isfinite(values[1:])
    changes = np.flatnonzero(known & (above[:-1] != above[1:]))

    def at(angle: float) -> float:
        return float(power(np.array([angle]))[0])

    found = [scipy.optimize.brentq(at, places[k], places[k + 1], xtol=1e-14) for k in changes]
    return np.array(found, dtype=np.float64)


def _slope(power: Curve, root: float, low: float, high: float) -> float:
    """Rate of the power by the driver angle, from a polynomial about a root."""
    window = max(low, root - _WINDOW), min(high, root + _WINDOW)
    return float(Chebyshev.interpolate(power, _DEGREE, window).deriv()(root))
