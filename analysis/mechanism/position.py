"""Positions of a linkage in closed form, on either assembly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.closing import Frame, Loop, closed_at, closes, coupler_point
from grashof.analysis.mechanism.dyad import Vector
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray


def _derived(formula: Callable[[Position], FloatArray]) -> cached_property[FloatArray]:
    """An attribute that follows from a position."""
    return cached_property(formula)


@dataclass(frozen=True, eq=False)
class Position:
    """Positions of a linkage at driver angles; NaN where it cannot close.

    Parameters
    ----------
    linkage : Linkage
    theta2 : ndarray, shape (...), rad
    loops : tuple of Loop
        Closed dyads.
    frames : dict of int to Frame
        Frames of the links that carry joints or P.

    Notes
    -----
    Further attributes: theta3 to theta6 (rad, in [-pi, pi]; of a slider the direction across its slide, to
    its left), the points a, b, p, of a six-bar c, d, e (shape (..., 2), length; B of an inverted slider-crank
    is the foot of O4 on the rod), `margins` and `travel`.
    """

    linkage: Linkage
    theta2: FloatArray
    loops: tuple[Loop, ...]
    frames: dict[int, Frame]

    @cached_property
    def angles(self) -> dict[int, FloatArray]:
        """Directions of all moving links, each of shape (...), rad."""
        found = {2: self.theta2}
        for first, loop in zip((3, 5), self.loops, strict=False):
            found |= zip((first, first + 1), loop.closed.angles, strict=True)
        return found

    @property
    def carrying(self) -> FloatArray:
        """Direction of the link that carries P, and with it the body, shape (...), rad."""
        return self.angles[self.linkage.mechanism.carries]

    @property
    def last(self) -> FloatArray:
        """Direction of the last link, the output, shape (...), rad."""
        return self.angles[self.linkage.mechanism.loops[-1].links[1]]

    @cached_property
    def margins(self) -> tuple[FloatArray, ...]:
        """Sine of the transmission angle of each loop, with the sign of the assembly, shape (...)."""
        return tuple(loop.closed.margin for loop in self.loops)

    @cached_property
    def travel(self) -> FloatArray:
        """Travel of the first slide as in `SlideMotion`; NaN without one."""
        return next((loop for loop in self.loops if loop.dyad.row.slides), self.loops[0]).travel

    @cached_property
    def p(self) -> FloatArray:
        """The coupler point."""
        at = self._global(coupler_point(self.linkage, self.frames)[:2])
        if len(self.loops) == 1:
            return at
        return np.where(closes(self.loops)[..., None], at, np.nan)  # a loop that does not lead P may be open

    def point(self, name: str) -> FloatArray:
        """A point of the linkage by its name, shape (..., 2)."""
        if name in self.linkage.mechanism.ground:
            return np.broadcast_to(getattr(self.linkage, name), (*np.shape(self.theta2), 2))
        found: FloatArray = getattr(self, name)
        return found

    def _global(self, at: Vector) -> FloatArray:
        o2 = self.linkage.o2
        return np.stack(np.broadcast_arrays(o2[..., 0] + at[0], o2[..., 1] + at[1]), axis=-1)

    theta3 = _derived(lambda self: self.angles[3])
    theta4 = _derived(lambda self: self.angles[4])
    theta5 = _derived(lambda self: self.angles[5])
    theta6 = _derived(lambda self: self.angles[6])
    a = _derived(lambda self: self._global(self.loops[0].c[:2]))
    b = _derived(lambda self: self._global(self.loops[0].e))
    c = _derived(lambda self: self._global(self.loops[1].c[:2]))
    d = _derived(lambda self: self._global(self.loops[1].d[:2]))
    e = _derived(lambda self: self._global(self.loops[1].e))


def solve_position(
    linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None
) -> Position:
    """Positions of all links at driver angles.

    Parameters
    ----------
    linkage : Linkage
        One, or a batch that broadcasts against `theta2` (``batch[:, None]``: all linkages at all angles).
    theta2 : array_like, shape (...), rad
        Driver angle, global.
    assembly : array_like, shape (...), optional
        +1 or -1, of the first loop; the linkage's own by default. For the second loop of a six-bar use
        ``linkage.changed(assembly_2=...)``.

    Returns
    -------
    Position

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> state = solve_position(norton, np.radians(40))
    >>> np.degrees([state.theta3, state.theta4]).round(6).tolist()
    [20.297883, 57.32488]
    """
    loops, frames = closed_at(linkage, theta2, assembly)
    angle = np.asarray(theta2, dtype=np.float64)
    shape = np.broadcast_shapes(*(np.shape(loop.closed.margin) for loop in loops))
    return Position(linkage, np.broadcast_to(angle, shape), tuple(loops), frames)


def places(linkage: Linkage, state: Position) -> dict[str, FloatArray]:
    """Points of a linkage in positions of it, each of shape (..., 2), by name."""
    return {name: state.point(name) for name in linkage.mechanism.points}
