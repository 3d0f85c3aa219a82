"""Instant centres, and the moving plane of the coupler: centrodes, inflection and Bresse circles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.loads import cross
from grashof.analysis.mechanism.kinematics import solve_kinematics
from grashof.analysis.mechanism.position import solve_position
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class InstantCentres:
    """The six instant centres, link 1 being the ground; each of shape (..., 2), length.

    Parameters
    ----------
    i12, i23, i34, i14 : ndarray
        The joints O2, A, B, O4; NaN for that of a slide, at infinity perpendicular to it.
    i13 : ndarray
        Centre of rotation of the coupler: the intersection of O2A and O4B, or their counterparts with a
        slide.
    i24 : ndarray
        Point of equal velocity of driver and output: the intersection of AB and O2O4, likewise.
    """

    i12: FloatArray
    i23: FloatArray
    i34: FloatArray
    i14: FloatArray
    i13: FloatArray
    i24: FloatArray


def instant_centres(
    linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None
) -> InstantCentres:
    """Instant centres for given driver angles.

    Parameters
    ----------
    linkage, theta2, assembly
        As for `solve_position`.

    Returns
    -------
    InstantCentres
        Not finite where the lines to a centre are parallel, and where the linkage cannot close.

    Notes
    -----
    Kennedy's rule: the centres of three links lie on a line (Norton, *Design of Machinery*, sec. 6.3).

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> instant_centres(norton, np.radians(40)).i24.round(4).tolist()
    [-38.8733, 0.0]
    """
    state = solve_position(linkage, theta2, assembly)
    o2 = np.broadcast_to(linkage.o2, state.a.shape)
    none = np.full(state.a.shape, np.nan)
    o4 = np.broadcast_to(getattr(linkage, "o4", none), state.a.shape)
    across = np.stack([np.cos(state.theta4), np.sin(state.theta4)], axis=-1)  # perpendicular to a slide
    of4 = state.b - o4, o4 - o2, state.b - state.a  # along I14-I34, I12-I14, I23-I34
    if (1, 4) in linkage.mechanism.slides:
        of4 = across, across, state.b - state.a
    if (3, 4) in linkage.mechanism.slides:
        of4 = across, o4 - o2, across
    return InstantCentres(
        i12=o2,
        i23=state.a,
        i34=none if (3, 4) in linkage.mechanism.slides else state.b,
        i14=o4,
        i13=_meeting(o2, state.a - o2, state.b if (1, 4) in linkage.mechanism.slides else o4, of4[0]),
        i24=_meeting(o2, of4[1], state.a, of4[2]),
    )


def _meeting(first: FloatArray, along: FloatArray, second: FloatArray, beside: FloatArray) -> FloatArray:
    """Intersection of two lines, each given by a point and a direction."""
    with np.errstate(divide="ignore", invalid="ignore"):
        share = cross(second - first, beside) / cross(along, beside)
        return np.asarray(first + share[..., None] * along)


_FAR = 1e12  # lengths of link 2


@dataclass(frozen=True, slots=True, eq=False)
class Centrodes:
    """The curves that roll on each other while the coupler moves; each of shape (..., 2), length.

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
    """Circles of the points of the coupler without normal or tangential acceleration.

    Parameters
    ----------
    pole : ndarray, shape (..., 2), length
        Instant centre I13, on both circles.
    inflection, bresse : ndarray, shape (..., 2), length
        Centres of the inflection circle, whose points pass inflections of their paths (no normal
        acceleration), and of Bresse's circle, whose points have no tangential acceleration under a steady
        driver.
    inflection_diameter, bresse_diameter : ndarray, shape (...), length
    acceleration_pole : ndarray, shape (..., 2), length
        The other intersection of the circles: no acceleration.
    """

    pole: FloatArray
    inflection: FloatArray
    inflection_diameter: FloatArray
    bresse: FloatArray
    bresse_diameter: FloatArray
    acceleration_pole: FloatArray


def centrodes(linkage: Linkage, theta2: npt.ArrayLike) -> Centrodes:
    """Fixed and moving centrode of the coupler at driver angles (Norton, *Design of Machinery*, sec. 6.5).

    Parameters
    ----------
    linkage : Linkage
    theta2 : array_like, shape (...), rad

    Returns
    -------
    Centrodes
        Not finite where the coupler does not turn, and where the linkage cannot close.

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
        Not finite where the coupler does not turn, in dead positions, and where the linkage cannot close.

    Notes
    -----
    With the acceleration a of the coupler's point in the pole, points at r from it have the acceleration a +
    alpha k x r - omega^2 r and the velocity omega k x r. The normal part vanishes where r . r = r . a /
    omega^2, the tangential part where r . r = r . (k x a) / alpha: circles through the pole with these two
    vectors as diameters (Bresse 1853; Bottema & Roth, *Theoretical Kinematics*, ch. 8).

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
        there = state.a.acceleration + alpha * _across(arm) - omega**2 * arm
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


def _unless_far(arm: FloatArray, linkage: Linkage) -> FloatArray:
    """From A to the pole; NaN where the pole is at infinity but for rounding."""
    far = np.hypot(arm[..., 0], arm[..., 1]) > _FAR * linkage.r2
    return np.where(far[..., None], np.nan, arm)


def _across(vector: FloatArray) -> FloatArray:
    """The vector turned a quarter turn counter-clockwise."""
    return np.stack([-vector[..., 1], vector[..., 0]], axis=-1)
