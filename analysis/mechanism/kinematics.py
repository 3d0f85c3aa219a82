"""Velocities, accelerations and jerks of every link and of any point carried by one, in closed form."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from grashof.analysis.loops.kinds import kind_of, way_to
from grashof.analysis.loops.loop import Sides
from grashof.analysis.mechanism.mobility import driver_ranges
from grashof.analysis.mechanism.position import sides
from grashof.analysis.numerics.blockwise import in_blocks
from grashof.problems import AssemblyError, DeadPositionWarning, Linkage, ProblemError
from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.problems.values.errors import wrong_value

# Below this sine of the transmission angle its digits are rounding: one unit in the last place of the driver
# angle or of a length changes the velocities by more than a tenth.
_DEAD = 1e-7


@dataclass(frozen=True, slots=True)
class PointMotion:
    """How a point moves, in global axes.

    Parameters
    ----------
    position, velocity, acceleration, jerk : ndarray, shape (..., 2), length over s^0 to s^3
    """

    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    jerk: FloatArray

    @property
    def speed(self) -> FloatArray:
        """Magnitude of the velocity, shape (...)."""
        return np.hypot(self.velocity[..., 0], self.velocity[..., 1])

    @property
    def acceleration_magnitude(self) -> FloatArray:
        """Magnitude of the acceleration, shape (...)."""
        return np.hypot(self.acceleration[..., 0], self.acceleration[..., 1])


@dataclass(frozen=True, slots=True, eq=False)
class SlideMotion:
    """How far a slide has gone, and its rates.

    Parameters
    ----------
    travel : ndarray, shape (...), length
        Of the slider along its slide, from where O2 is nearest to it; or of the rod through its block: B
        from A, along the rod.
    velocity, acceleration, jerk : ndarray, shape (...), length over s to s^3
    """

    travel: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    jerk: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Kinematics:
    """How every link turns, for each driver angle; NaN where the linkage cannot close.

    At a dead position the rates of links 3 and 4 are infinite; NaN where even their sign is open,
    as with a driver at rest.

    Parameters
    ----------
    linkage : Linkage
    theta2, theta3, theta4 : ndarray, shape (...), rad
        Directions of links 2, 3 and 4, of a four-bar O2->A, A->B, O4->B; theta3 and theta4 in [-pi, pi].
    omega2, omega3, omega4 : ndarray, shape (...), rad/s
    alpha2, alpha3, alpha4 : ndarray, shape (...), rad/s^2
    jerk2, jerk3, jerk4 : ndarray, shape (...), rad/s^3
    slide : SlideMotion, optional
        None of a linkage without a slide.
    """

    linkage: Linkage
    theta2: FloatArray
    theta3: FloatArray
    theta4: FloatArray
    omega2: FloatArray
    omega3: FloatArray
    omega4: FloatArray
    alpha2: FloatArray
    alpha3: FloatArray
    alpha4: FloatArray
    jerk2: FloatArray
    jerk3: FloatArray
    jerk4: FloatArray
    slide: SlideMotion | None = None

    @property
    def shape(self) -> tuple[int, ...]:
        """Axes of the linkages and driver angles together."""
        return np.shape(self.theta3)

    @property
    def a(self) -> PointMotion:
        """Joint A."""
        return self.point(2, _along(self.linkage.r2))

    @property
    def b(self) -> PointMotion:
        """B, as a point of link 4."""
        return self.point(4, _along(kind_of(self.linkage).b_from(self.linkage)))

    @property
    def p(self) -> PointMotion:
        """Coupler point P."""
        return self.point(3, self.linkage.coupler_point)

    def angular(self, link: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Angle of link 2, 3 or 4, its velocity, acceleration and jerk, each of shape (...)."""
        _check_link(link)
        return (
            getattr(self, f"theta{link}"),
            getattr(self, f"omega{link}"),
            getattr(self, f"alpha{link}"),
            getattr(self, f"jerk{link}"),
        )

    def point(self, link: int, at: npt.ArrayLike) -> PointMotion:
        """Motion of a point carried by a link.

        Parameters
        ----------
        link : int
            2, 3 or 4.
        at : array_like, shape (..., 2), length
            (u, v) in the link's frame: origin O2, A or O4, u towards A, B or B, v to its left. The frame of
            a slider begins in B, u along its slide; that of a block in O4, u along theta4.

        Returns
        -------
        PointMotion

        Notes
        -----
        r'' = alpha x r - omega^2 r, and so on, from the point that the frame starts in (Norton,
        *Design of Machinery*, secs. 6.7 and 7.3).

        Examples
        --------
        >>> from grashof.problems import FourBar
        >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
        >>> state = solve_kinematics(norton, np.radians(40), omega2=25, alpha2=15)
        >>> state.point(4, (80, 0)).velocity.round(3).tolist()
        [-471.242, 302.243]
        """
        at = np.asarray(at, dtype=np.float64)
        if at.shape[-1:] != (2,):
            raise ProblemError(f"at has shape {at.shape}; it must be (..., 2)")
        turning = self.angular(link)
        if link == 4:
            turning = (kind_of(self.linkage).direction4(self.linkage, self.theta4), *turning[1:])
        carried = _carried(at, turning)
        pivot, way = way_to(self.linkage, link)
        for before, length in way:
            carried = carried + _carried(_along(length), self.angular(before))
        carried[0] += pivot
        return PointMotion(*carried)


def solve_kinematics(
    linkage: Linkage,
    theta2: npt.ArrayLike,
    omega2: npt.ArrayLike = 1.0,
    alpha2: npt.ArrayLike = 0.0,
    jerk2: npt.ArrayLike = 0.0,
    assembly: npt.ArrayLike | None = None,
) -> Kinematics:
    """Angles, velocities, accelerations and jerks of all links.

    Parameters
    ----------
    linkage : Linkage
        One, or a batch whose axes broadcast against the driver's (``batch[:, None]`` for all
        linkages at all angles).
    theta2, omega2, alpha2, jerk2 : array_like, shape (...), rad over s^0 to s^3
        The driver; by default it turns steadily at 1 rad/s. `driver_motion` finds all four from a
        function of time.
    assembly : array_like, shape (...), optional
        +1 or -1; the linkage's own by default.

    Returns
    -------
    Kinematics

    Raises
    ------
    AssemblyError
        A single linkage cannot close at the single angle asked for. (In arrays it is NaN there.)

    Warns
    -----
    DeadPositionWarning
        The transmission angle is 0 or 180 deg at an angle named, so that rates are infinite.

    Notes
    -----
    The equations of the loop, differentiated, are two linear ones for each derivative; their formulas are
    in `grashof.analysis.loops`, a file each kind (Norton, *Design of Machinery*, secs. 6.7, 7.3).

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> state = solve_kinematics(norton, np.radians(40), omega2=25, alpha2=15)
    >>> [float(value.round(6)) for value in (state.omega3, state.omega4, state.alpha3, state.alpha4)]
    [-4.120914, 6.997985, 296.089193, 470.13353]
    """
    driver = [np.asarray(value, dtype=np.float64) for value in (theta2, omega2, alpha2, jerk2)]
    loop_sides = sides(linkage, assembly)
    slides = kind_of(linkage).slides
    solved = in_blocks(_solution(type(loop_sides)), [*map(np.asarray, loop_sides), *driver], 9 + 4 * slides)
    *rates, dead = solved
    shape = dead.shape
    theta2, omega2, alpha2, jerk2 = (np.broadcast_to(value, shape)[()] for value in driver)
    if not shape and np.isnan(rates[0]):
        raise AssemblyError(_cannot_close(linkage, float(theta2)))
    if dead.any():
        _warn_of(theta2, dead > 0, kind_of(linkage).dead)
    theta3, theta4, omega3, omega4, alpha3, alpha4, jerk3, jerk4, *slide = (rate[()] for rate in rates)
    return Kinematics(
        linkage, theta2, theta3, theta4, omega2, omega3, omega4, alpha2, alpha3, alpha4, jerk2, jerk3, jerk4,
        SlideMotion(*slide) if slides else None,
    )  # fmt: skip


def _solution(kind: type[Any]) -> Callable[..., tuple[FloatArray, ...]]:
    """Angles, velocities, accelerations, jerks of links 3 and 4, those of a slide, and 1 where it is dead."""
    parts = len(kind._fields)

    def solve(*operands: FloatArray) -> tuple[FloatArray, ...]:
        loop_sides: Sides = kind(*operands[:parts])
        theta2, *driver = operands[parts:]
        loop = loop_sides.close(theta2)
        dead = np.abs(loop.sine) <= _DEAD
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            rates = loop_sides.rates(loop, dead, *driver)
        theta3, theta4 = np.arctan2(loop.sin3, loop.cos3), np.arctan2(loop.sin4, loop.cos4)
        return theta3, theta4, *rates, dead.astype(np.float64)

    return solve


def _carried(at: FloatArray, angular: tuple[FloatArray, ...]) -> FloatArray:
    """A vector fixed in a link, and its first three derivatives; shape (4, ..., 2)."""
    operands = [np.asarray(operand) for operand in (at[..., 0], at[..., 1], *angular)]
    arms = in_blocks(_turned, operands, 8)
    return np.moveaxis(arms.reshape(4, 2, *arms.shape[1:]), 1, -1)


def _turned(
    u: FloatArray, v: FloatArray, theta: FloatArray, omega: FloatArray, alpha: FloatArray, jerk: FloatArray
) -> tuple[FloatArray, ...]:
    cosine, sine = np.cos(theta), np.sin(theta)
    x, y = u * cosine - v * sine, u * sine + v * cosine
    square = omega * omega
    with np.errstate(invalid="ignore", over="ignore"):
        turn, pull = jerk - square * omega, 3 * omega * alpha
        arms = (
            x, y, -omega * y, omega * x, -alpha * y - square * x, alpha * x - square * y,
            -turn * y - pull * x, turn * x - pull * y,
        )  # fmt: skip
        dead = ~np.isfinite(jerk) & np.isfinite(theta)
        if np.any(dead):  # the fastest growing terms alone, and nothing where there is no arm
            leading = (-alpha * y, alpha * x, -jerk * y, jerk * x)
            fastest = [np.where(dead, *pair) for pair in zip(leading, arms[4:], strict=True)]
            return tuple(np.where((u == 0) & (v == 0), 0.0, arm) for arm in (*arms[:4], *fastest))
    return arms


def _along(length: FloatArray) -> FloatArray:
    return np.stack([length, np.zeros_like(length)], axis=-1)


def _check_link(link: int) -> None:
    if link not in (2, 3, 4):
        raise wrong_value("link", link, "2 (driver), 3 (coupler) or 4 (output)")


def _warn_of(theta2: FloatArray, dead: BoolArray, why: str) -> None:
    angles = np.degrees(np.broadcast_to(theta2, dead.shape)[dead])
    named = ", ".join(f"{angle:.6g}" for angle in angles[:3]) + (", ..." if len(angles) > 3 else "")
    warnings.warn(
        f"dead position at driver angle {named} deg: {why}, their rates are infinite",
        DeadPositionWarning,
        stacklevel=3,
    )


def _cannot_close(linkage: Linkage, theta2: float) -> str:
    ranges = driver_ranges(linkage)
    open_at = f"the linkage cannot close at driver angle {np.degrees(theta2):.6g} deg"
    ends = [f"{low:.6g} to {high:.6g}" for low, high in np.degrees(ranges) if np.isfinite(low)]
    return (
        f"{open_at}; it closes from {' and from '.join(ends)} deg" if ends else f"{open_at} or at any other"
    )
