"""Positions of a linkage in closed form, on either assembly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.closing import close, operands_of
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import LOOP_POINTS


class _Angle:
    """The angle of a link as an attribute: theta2, theta3, ..."""

    def __init__(self, link: int) -> None:
        self.link = link

    def __get__(self, state: Position | None, _: object = None) -> FloatArray:
        if state is None or self.link - 2 >= len(state.angles):
            raise AttributeError(f"there is no theta{self.link}")
        return state.angles[self.link - 2]


class _Point:
    """A moving point as an attribute: a, b, ..."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __get__(self, state: Position | None, _: object = None) -> FloatArray:
        if state is None or self.name not in state.points:
            raise AttributeError(f"no point {self.name} moves")
        return state.points[self.name]


@dataclass(frozen=True, slots=True)
class Position:
    """Where a linkage stands, for each driver angle; NaN where it cannot close.

    Parameters
    ----------
    angles : tuple of ndarray, shape (...), rad
        Directions of links 2, 3, ..., also as theta2 to theta6: of a four-bar O2->A, A->B, O4->B; all but
        theta2 in [-pi, pi]. Of a slider the direction across its slide, to its left.
    points : dict of str to ndarray, shape (..., 2), length
        The points that move, also as attributes a to e and p. B of an inverted slider-crank is the foot of O4
        on the rod.
    margins : tuple of ndarray, shape (...)
        Of each loop the sine of its transmission angle with the sign of the assembly; 0 in dead positions.
    travel : ndarray, shape (...), length
        Of the first slide, as `SlideMotion` has it, also in dead positions; NaN without a slide.
    """

    angles: tuple[FloatArray, ...]
    points: dict[str, FloatArray]
    margins: tuple[FloatArray, ...]
    travel: FloatArray

    theta2, theta3, theta4, theta5, theta6 = _Angle(2), _Angle(3), _Angle(4), _Angle(5), _Angle(6)
    a, b, c, d, e, p = _Point("a"), _Point("b"), _Point("c"), _Point("d"), _Point("e"), _Point("p")


def solve_position(
    linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None
) -> Position:
    """Position of every link for given driver angles.

    Parameters
    ----------
    linkage : Linkage
        One, or a batch whose axes broadcast against `theta2` (``batch[:, None]`` for all
        linkages at all angles).
    theta2 : array_like, shape (...), rad
        Driver angle, global.
    assembly : array_like, shape (...), optional
        +1 or -1; the linkage's own by default.

    Returns
    -------
    Position

    Notes
    -----
    How a loop closes is in `grashof.analysis.mechanism.dyad`, a class for each kind of dyad.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> state = solve_position(norton, np.radians(40))
    >>> np.degrees([state.theta3, state.theta4]).round(6).tolist()
    [20.297883, 57.32488]
    """
    angle, kind = np.asarray(theta2, dtype=np.float64), linkage.mechanism
    loops, frames = close(kind, operands_of(linkage, assembly), angle)
    ox, oy = linkage.o2[..., 0], linkage.o2[..., 1]
    found = {"p": frames[kind.carries].point((linkage.coupler_point[..., 0], linkage.coupler_point[..., 1]))}
    for names, loop in zip(LOOP_POINTS, loops, strict=False):
        found |= zip(names, (loop.c, loop.d, loop.e), strict=True)
    points = {}
    for name in kind.moving:
        x, y = found[name]
        points[name] = np.stack(np.broadcast_arrays(ox + x, oy + y), axis=-1)
    slide = next((loop for loop in loops if loop.placed.row.slides), loops[0])
    theta2 = np.broadcast_to(angle, np.shape(loops[0].closed.cos3))
    return Position(
        (theta2, *(each for loop in loops for each in loop.angles)),
        points,
        tuple(loop.closed.margin for loop in loops),
        slide.placed.sizes.travel(slide.closed, *slide.gap),
    )


def places(linkage: Linkage, state: Position) -> dict[str, FloatArray]:
    """Where the points of a linkage are in some of its positions, each of shape (..., 2), by their names."""
    kind = linkage.mechanism
    ground = {name: np.broadcast_to(getattr(linkage, name), state.a.shape) for name in kind.ground}
    return {name: (ground | state.points)[name] for name in kind.points}
