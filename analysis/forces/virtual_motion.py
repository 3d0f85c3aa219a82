"""Velocities that a linkage allows, with a limit in dead positions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from grashof.analysis.loops.loop import Loop
from grashof.analysis.mechanism.kinematics import Kinematics, SlideMotion
from grashof.analysis.mechanism.position import close_loop, sides
from grashof.problems import FourBar, InvertedSliderCrank, SliderCrank
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.linkage import Linkage

# Of links 3 and 4 and of the slide; a four-bar has none.
_Rates = tuple[FloatArray, FloatArray, FloatArray | None]


def virtual_motion(linkage: Linkage, theta2: npt.ArrayLike) -> tuple[Kinematics, Kinematics]:
    """Positions with velocities that the linkage allows, and the same at rest.

    Parameters
    ----------
    linkage : Linkage
    theta2 : array_like, shape (...), rad

    Returns
    -------
    moving, resting : Kinematics
        Without accelerations.

    Notes
    -----
    The driver turns counter-clockwise by the sine of the transmission angle, so that the others have a
    limit in a dead position: the rates of `solve_kinematics` times that.
    """
    loop = close_loop(sides(linkage), np.asarray(theta2, dtype=np.float64))
    theta3, theta4 = np.arctan2(loop.sin3, loop.cos3), np.arctan2(loop.sin4, loop.cos4)
    theta2 = np.broadcast_to(np.asarray(theta2, dtype=np.float64), np.shape(theta3))[()]
    none = np.zeros(np.shape(theta3))
    omega2 = linkage.assembly * loop.sine
    omega3, omega4, velocity = _RATES[type(linkage)](linkage, loop)
    moving = resting = None
    if velocity is not None:
        travel = _travel(linkage, loop)
        moving, resting = (SlideMotion(travel, rate, none, none) for rate in (velocity, none))
    higher = (none,) * 6
    return (
        Kinematics(linkage, theta2, theta3, theta4, omega2, omega3, omega4, *higher, moving),
        Kinematics(linkage, theta2, theta3, theta4, none, none, none, *higher, resting),
    )


def _four_bar(linkage: FourBar, loop: Loop) -> _Rates:
    omega3 = linkage.assembly * linkage.r2 / linkage.r3 * (loop.cos4 * loop.sin2 - loop.sin4 * loop.cos2)
    omega4 = linkage.assembly * linkage.r2 / linkage.r4 * (loop.cos3 * loop.sin2 - loop.sin3 * loop.cos2)
    return omega3, omega4, None


def _slider_crank(linkage: SliderCrank, loop: Loop) -> _Rates:
    """The derivatives of both components of the loop, along the slide (cos4, sin4 is across) and across."""
    across2 = loop.cos2 * loop.cos4 + loop.sin2 * loop.sin4
    across3 = loop.cos3 * loop.cos4 + loop.sin3 * loop.sin4
    along2 = loop.cos2 * loop.sin4 - loop.sin2 * loop.cos4
    omega3 = -linkage.assembly * linkage.r2 / linkage.r3 * along2
    velocity = -linkage.r2 * across2 * linkage.assembly * loop.sine - linkage.r3 * across3 * omega3
    return omega3, np.zeros(np.shape(omega3)), velocity


def _inverted(linkage: InvertedSliderCrank, loop: Loop) -> _Rates:
    """The derivative of e^(i theta3) (l - i offset) = O4 - A, along the rod and across."""
    along2 = loop.cos2 * loop.cos3 + loop.sin2 * loop.sin3
    across2 = loop.sin2 * loop.cos3 - loop.cos2 * loop.sin3
    apart = np.hypot(loop.ab, linkage.offset)
    omega3 = -linkage.assembly * linkage.r2 * along2 / apart
    velocity = linkage.r2 * across2 * linkage.assembly * loop.sine - linkage.offset * omega3
    return omega3, omega3, velocity


def _travel(linkage: Linkage, loop: Loop) -> FloatArray:
    """Of the slider from the foot of O2, or of the rod from A to B."""
    if isinstance(linkage, InvertedSliderCrank):
        return loop.ab
    x, y = loop.ax + loop.ab * loop.cos3, loop.ay + loop.ab * loop.sin3
    return np.asarray(x * loop.sin4 - y * loop.cos4)


_RATES: dict[type[Linkage], Callable[..., _Rates]] = {
    FourBar: _four_bar,
    SliderCrank: _slider_crank,
    InvertedSliderCrank: _inverted,
}
