"""Velocities, accelerations and jerks of all links and of any point on them, in closed form."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.closing import Rotation, close, closed_at, move, operands_of, virtual_rates
from grashof.analysis.mechanism.dyad import Solved
from grashof.analysis.mechanism.mobility import driver_ranges
from grashof.analysis.numerics.blockwise import in_blocks
from grashof.problems import AssemblyError, DeadPositionWarning, Linkage, ProblemError
from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.problems.values.errors import wrong_value
from grashof.problems.values.linkages.mechanism import DyadKind, Mechanism


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
        Of the slider along its slide, from the foot of O2; or of the rod through its block, from A to B.
    velocity, acceleration, jerk : ndarray, shape (...), length over s to s^3
    """

    travel: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    jerk: FloatArray


class Turning(NamedTuple):
    """Angle of a link and its derivatives, each of shape (...), rad over s^0 to s^3."""

    theta: FloatArray
    omega: FloatArray
    alpha: FloatArray
    jerk: FloatArray


class _AngleOf:
    """An angle of a link, or one of its rates, as an attribute: theta2, omega3, ..."""

    def __init__(self, link: int, order: int) -> None:
        self.link, self.order = link, order

    def __get__(self, state: Kinematics | None, _: object = None) -> FloatArray:
        if state is None:
            raise AttributeError("a state has angles, its class has none")
        return state.angular(self.link)[self.order]


@dataclass(frozen=True, slots=True, eq=False)
class Kinematics:
    """Angles and rates of all links at driver angles; NaN where the linkage cannot close.

    At a dead position the rates of its loop are infinite; NaN where their sign is undetermined, as with a
    driver at rest, or in a second loop that depends on the first.

    Parameters
    ----------
    linkage : Linkage
    turning : tuple of Turning
        Of links 2, 3, ...: directions, velocities, accelerations and jerks, also as attributes: theta2 to
        theta6 (directions of O2->A, A->B, O4->B, C->E, D->E; all but theta2 in [-pi, pi]), omega2, alpha2,
        jerk2 and so on. Theta of a slider is the direction across its slide, to its left.
    slides : tuple of SlideMotion or None
        One for each loop.
    margins : tuple of ndarray, shape (...)
        Sine of the transmission angle of each loop, with the sign of the assembly; 0 in dead positions.
    """

    linkage: Linkage
    turning: tuple[Turning, ...]
    slides: tuple[SlideMotion | None, ...]
    margins: tuple[FloatArray, ...]

    theta2, omega2, alpha2, jerk2 = _AngleOf(2, 0), _AngleOf(2, 1), _AngleOf(2, 2), _AngleOf(2, 3)
    theta3, omega3, alpha3, jerk3 = _AngleOf(3, 0), _AngleOf(3, 1), _AngleOf(3, 2), _AngleOf(3, 3)
    theta4, omega4, alpha4, jerk4 = _AngleOf(4, 0), _AngleOf(4, 1), _AngleOf(4, 2), _AngleOf(4, 3)
    theta5, omega5, alpha5, jerk5 = _AngleOf(5, 0), _AngleOf(5, 1), _AngleOf(5, 2), _AngleOf(5, 3)
    theta6, omega6, alpha6, jerk6 = _AngleOf(6, 0), _AngleOf(6, 1), _AngleOf(6, 2), _AngleOf(6, 3)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the linkages broadcast with the driver angles."""
        return np.shape(self.theta3)

    @property
    def slide(self) -> SlideMotion | None:
        """Motion of the first slide; None without one."""
        return next((slide for slide in self.slides if slide is not None), None)

    @property
    def a(self) -> PointMotion:
        """Joint A."""
        return self.point(2, _along(self.linkage.r2))

    @property
    def b(self) -> PointMotion:
        """B, as a point of link 4."""
        return self._end(4)

    @property
    def c(self) -> PointMotion:
        """Joint C of a six-bar."""
        return self.origin(5)

    @property
    def d(self) -> PointMotion:
        """Joint D of a six-bar without a slide."""
        return self.origin(6)

    @property
    def e(self) -> PointMotion:
        """Joint E of a six-bar."""
        return self._end(6)

    @property
    def p(self) -> PointMotion:
        """Coupler point P."""
        return self.point(self.linkage.mechanism.carries, self.linkage.coupler_point)

    def angular(self, link: int) -> Turning:
        """Angle, velocity, acceleration and jerk of a moving link."""
        if not 2 <= link < 2 + len(self.turning):
            names = [f"{each.number} ({each.name})" for each in self.linkage.mechanism.links[1:]]
            raise wrong_value("link", link, f"{', '.join(names[:-1])} or {names[-1]}")
        return self.turning[link - 2]

    def frame_angle(self, link: int) -> FloatArray:
        """Direction of the u-axis of a link's frame, shape (...), rad; for a slider along its slide."""
        theta = self.angular(link).theta
        return theta - np.pi / 2 if is_slider(self.linkage, link) else theta

    def point(self, link: int, at: npt.ArrayLike) -> PointMotion:
        """Motion of a point carried by a link.

        Parameters
        ----------
        link : int
            1 (the ground, with the global frame) to 4, of a six-bar to 6.
        at : array_like, shape (..., 2), length
            (u, v) in the link's frame: origin O2, A, O4, C or D, u towards A, B, B, E or E, v to the left.
            A slider's frame has its origin in B or E, u along the slide; a block's in O4, u along theta4.

        Returns
        -------
        PointMotion

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
        return PointMotion(*self._carried(link, at))

    def _carried(self, link: int, at: FloatArray) -> FloatArray:
        """A point and its three derivatives, shape (4, ..., 2)."""
        if link == 1:
            return np.stack([at, *(np.zeros(at.shape) for _ in range(3))])
        turning = self.angular(link)
        carried = _arm(at, (self.frame_angle(link), *turning[1:]))
        host, origin = self._begins(link)
        if host == 1:
            carried[0] += origin
            return carried
        return carried + self._carried(host, origin)

    def _begins(self, link: int) -> tuple[int, FloatArray]:
        """The link that carries the origin of a link's frame, and its coordinates there."""
        linkage = self.linkage
        if link == 2:
            return 1, linkage.o2
        if link == 3:
            return 2, _along(linkage.r2)
        loop = linkage.mechanism.loops[(link - 3) // 2]
        if link % 2:
            return loop.dyad.hosts[0], getattr(linkage, loop.c)
        if not loop.pinned:
            return link - 1, _along(getattr(linkage, loop.bars[0]))
        return loop.dyad.hosts[1], getattr(linkage, loop.d)

    def origin(self, link: int) -> PointMotion:
        """Motion of the origin of a link's frame; of O2 for the ground."""
        return self.point(1, self.linkage.o2) if link == 1 else self.point(*self._begins(link))

    def _end(self, link: int) -> PointMotion:
        """B or E, as a point of the second link of a dyad."""
        loop = self.linkage.mechanism.loops[link // 2 - 2]
        name = {DyadKind.RRR: loop.bars[-1:], DyadKind.RPR: (loop.offset,)}.get(loop.dyad.kind, ())
        return self.point(link, _along(getattr(self.linkage, *name) if name else np.zeros(())))


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
    linkage, assembly
        As for `solve_position`.
    theta2, omega2, alpha2, jerk2 : array_like, shape (...), rad over s^0 to s^3
        The driver; by default it turns steadily at 1 rad/s. See also `driver_motion`.

    Returns
    -------
    Kinematics

    Raises
    ------
    AssemblyError
        A single linkage cannot close at the single angle given. (Arrays have NaN there.)

    Warns
    -----
    DeadPositionWarning
        The transmission angle is 0 or 180 deg, so that rates are infinite.

    Notes
    -----
    The differentiated loop equations are two linear ones for each derivative; points on links follow from
    r'' = alpha x r - omega^2 r, and so on (Norton, *Design of Machinery*, secs. 6.7, 7.3).

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> state = solve_kinematics(norton, np.radians(40), omega2=25, alpha2=15)
    >>> [float(value.round(6)) for value in (state.omega3, state.omega4, state.alpha3, state.alpha4)]
    [-4.120914, 6.997985, 296.089193, 470.13353]
    """
    driver = [np.asarray(value, dtype=np.float64) for value in (theta2, omega2, alpha2, jerk2)]
    kind = linkage.mechanism
    slides = [dyad.slides for dyad in kind.dyads]
    rows = 10 * len(slides) + 4 * sum(slides)
    solved = in_blocks(partial(_solution, kind), [*operands_of(linkage, assembly), *driver], rows)
    shape = solved.shape[1:]
    theta2, omega2, alpha2, jerk2 = (
        (value if value.shape == shape else np.broadcast_to(value, shape))[()] for value in driver
    )
    turning, motions, margins, row = [Turning(theta2, omega2, alpha2, jerk2)], [], [], iter(solved)
    for has_slide, dyad in zip(slides, kind.dyads, strict=True):
        three, four = (Turning(*(next(row)[()] for _ in range(4))) for _ in range(2))
        dead = next(row) > 0
        margins.append(next(row)[()])
        turning += [three, four]
        motions.append(SlideMotion(*(next(row)[()] for _ in range(4))) if has_slide else None)
        if not shape and np.isnan(three.theta):
            given = linkage if assembly is None else linkage.changed(assembly=assembly)
            open_at = f"the linkage cannot close at driver angle {np.degrees(theta2):.6g} deg"
            ranges = np.degrees(driver_ranges(given))
            ends = " and from ".join(f"{low:.6g} to {high:.6g}" for low, high in ranges if np.isfinite(low))
            raise AssemblyError(open_at + (f"; it closes from {ends} deg" if ends else " or at any other"))
        if dead.any():
            _warn_of_dead_positions(theta2, dead, _WHY_DEAD[len(motions), dyad.kind])
    return Kinematics(linkage, tuple(turning), tuple(motions), tuple(margins))


_WHY_DEAD = {
    (1, DyadKind.RRR): "coupler and output lie in one line",
    (1, DyadKind.RRP): "the rod is perpendicular to the slide",
    (1, DyadKind.RPR): "the block is at A",
    (2, DyadKind.RRR): "links 5 and 6 lie in one line",
    (2, DyadKind.RRP): "link 5 is perpendicular to the slide",
}


def _solution(kind: Mechanism, *operands: FloatArray) -> list[FloatArray]:
    """For each loop: angles and rates of its links, 1 where dead, its margin; travel and rates of a slide."""
    *sizes, theta2, omega2, alpha2, jerk2 = operands
    loops, _ = close(kind, sizes, theta2)
    found: list[FloatArray] = []
    for loop, moved in zip(loops, move(loops, (omega2, alpha2, jerk2))[0], strict=True):
        orders, (theta3, theta4) = moved.orders, loop.closed.angles
        found += [theta3, *(order.turn3 for order in orders)]
        found += [theta4, *(order.turn4 for order in orders)]
        found += [moved.dead.astype(np.float64), loop.closed.margin]
        if loop.dyad.row.slides:
            found += [loop.travel, *(order.travel for order in orders)]
    return found


def _arm(at: FloatArray, angular: tuple[FloatArray, ...]) -> FloatArray:
    """A vector fixed in a link, and its first three derivatives; shape (4, ..., 2)."""
    operands = [np.asarray(operand) for operand in (at[..., 0], at[..., 1], *angular)]
    arms = in_blocks(_turned, operands, 8)
    return np.moveaxis(arms.reshape(4, 2, *arms.shape[1:]), 1, -1)


def _turned(
    u: FloatArray, v: FloatArray, theta: FloatArray, omega: FloatArray, alpha: FloatArray, jerk: FloatArray
) -> tuple[FloatArray, ...]:
    cosine, sine = np.cos(theta), np.sin(theta)
    arm = x, y = u * cosine - v * sine, u * sine + v * cosine
    with np.errstate(invalid="ignore", over="ignore"):
        arms = (x, y, *chain.from_iterable(Rotation.of(omega, alpha, jerk).moved(arm)))
        dead = ~np.isfinite(jerk) & np.isfinite(theta)
        if np.any(dead):  # the fastest growing terms alone, and zero without an arm
            leading = (-alpha * y, alpha * x, -jerk * y, jerk * x)
            fastest = [np.where(dead, *pair) for pair in zip(leading, arms[4:], strict=True)]
            return tuple(np.where((u == 0) & (v == 0), 0.0, arm) for arm in (*arms[:4], *fastest))
    return arms


def _along(length: FloatArray) -> FloatArray:
    return np.stack([length, np.zeros_like(length)], axis=-1)


def is_slider(linkage: Linkage, link: int) -> bool:
    """Whether a link is the slider of its dyad."""
    return link % 2 == 0 and link > 2 and linkage.mechanism.dyads[link // 2 - 2].kind is DyadKind.RRP


def _warn_of_dead_positions(theta2: FloatArray, dead: BoolArray, why: str) -> None:
    angles = np.degrees(np.broadcast_to(theta2, dead.shape)[dead])
    named = ", ".join(f"{angle:.6g}" for angle in angles[:3]) + (", ..." if len(angles) > 3 else "")
    warnings.warn(
        f"dead position at driver angle {named} deg: {why}, their rates are infinite",
        DeadPositionWarning,
        stacklevel=3,
    )


def virtual_motion(
    linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None
) -> tuple[Kinematics, Kinematics]:
    """Virtual velocities that stay finite in dead positions, and the same positions at rest.

    The speed of the driver is the product of the sines of all transmission angles.
    """
    angle, (loops, _) = np.asarray(theta2, dtype=np.float64), closed_at(linkage, theta2, assembly)
    margins = tuple(loop.closed.margin for loop in loops)
    shape = np.shape(margins[-1])
    none = np.zeros(shape)

    def state(omega2: FloatArray, rates: Sequence[Solved]) -> Kinematics:
        turning, slides = [Turning(np.broadcast_to(angle, shape)[()], omega2, none, none)], []
        for loop, solved in zip(loops, rates, strict=True):
            turns = solved.turn3, np.broadcast_to(solved.turn4, shape)[()]
            turning += [Turning(*each, none, none) for each in zip(loop.closed.angles, turns, strict=True)]
            has_slide = loop.dyad.row.slides
            slides.append(SlideMotion(loop.travel, solved.travel, none, none) if has_slide else None)
        return Kinematics(linkage, tuple(turning), tuple(slides), margins)

    return state(*virtual_rates(loops)), state(none, [Solved(none, none, none)] * len(loops))
