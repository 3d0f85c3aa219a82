"""A variable over which a linkage moves evenly, wherever it runs away from its driver."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.first_motion import FirstMotion, first_motion, panel_edges
from grashof.analysis.mechanism.second_loop import cut, recurring
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, FloatArray

_SLACK = 1e-9  # rad: so far past the end of a range rounding may lie
_SHORT = 1e-6  # rad: a range below it has no room for more than its ends


@dataclass(frozen=True, slots=True)
class EvenMotion:
    """Driver angle as a function of a share t, 0 to 1, of a motion with which all links move evenly.

    Near a dead position, and about the ground line near a change point, the links move far while the
    driver hardly does. Over t nothing is narrow: few equal steps are dense samples, and quadrature
    converges fast. (A second loop may still come close to a dead position between the ends; `edges` has
    these places.) Made by `even_motion`.

    Parameters
    ----------
    start, end : float, rad
        Driver angles of the motion, in either order.
    first : FirstMotion
        Of the first loop, from start to end; where the second loop has dead positions over its whole range.
    dead : pair of bool
        Whether the second loop is dead at the ends of `first`.
    begin, finish : float
        Where between these ends the motion begins and finishes, as a share over which the second loop
        moves evenly.
    corners : tuple of float
        Shares of the motion at which the width of the second loop has an extreme.
    """

    start: float
    end: float
    first: FirstMotion
    dead: tuple[bool, bool] = (False, False)
    begin: float = 0.0
    finish: float = 1.0
    corners: tuple[float, ...] = ()

    def theta2(self, share: npt.ArrayLike) -> FloatArray:
        """Driver angle at a share of the motion, shape (...), rad.

        Where the driver turns fully the share may lie beyond 0 and 1.
        """
        t = np.asarray(share, dtype=np.float64)
        if not any(self.dead):
            return self.first.theta2(t)
        angle = self.first.theta2(self._bent(self.begin + (self.finish - self.begin) * t))
        angle = np.clip(angle, min(self.start, self.end), max(self.start, self.end))
        return np.where(t == 0, self.start, np.where(t == 1, self.end, angle))

    def rate(self, share: npt.ArrayLike) -> FloatArray:
        """Derivative of `theta2` by the share, shape (...), rad; 0 in dead positions."""
        t = np.asarray(share, dtype=np.float64)
        if not any(self.dead):
            return self.first.rate(t)
        v = self.begin + (self.finish - self.begin) * t
        at_low, at_high = self.dead
        bend = np.pi / 2 * np.sin(np.pi * v) if at_low and at_high else 2 * v if at_low else 2 * (1 - v)
        return np.asarray(self.first.rate(self._bent(v)) * bend * (self.finish - self.begin))

    def share(self, theta2: npt.ArrayLike) -> FloatArray:
        """Share of the motion at driver angles between its ends, shape (...)."""
        share = self.first.share(theta2)
        if not any(self.dead):
            return share
        return np.asarray((_unbent(share, self.dead) - self.begin) / (self.finish - self.begin))

    def edges(self, panels: int) -> FloatArray:
        """Shares that part the motion into panels, about as many, none of which goes across the ground line.

        There a linkage with a change point may turn sharply. Nor does one go across an extreme of the second
        loop's width.
        """
        low, high = sorted((self.start, self.end))
        along = self.first.ground_line()
        inside = along[(along >= low) & (along <= high)] if any(self.dead) else along
        return panel_edges(panels, np.concatenate([self.share(inside), self.corners]))

    def _bent(self, v: FloatArray) -> FloatArray:
        """Share of the first loop's motion; its rate vanishes where the second loop is dead."""
        at_low, at_high = self.dead
        if at_low and at_high:
            return np.asarray(np.sin(np.pi / 2 * v) ** 2)
        return v**2 if at_low else v * (2 - v)


def _unbent(share: FloatArray, dead: tuple[bool, bool]) -> FloatArray:
    """Inverse of `EvenMotion._bent`."""
    at_low, at_high = dead
    share = np.clip(share, 0, 1)
    if at_low and at_high:
        return np.asarray(2 / np.pi * np.arcsin(np.sqrt(share)))
    return np.sqrt(share) if at_low else 1 - np.sqrt(1 - share)


def even_motion(linkage: Linkage, start: float, end: float) -> EvenMotion:
    """A variable over which a linkage moves evenly between two driver angles.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    start, end : float, rad
        Driver angles, in either order; more than a turn apart where the driver turns fully.

    Returns
    -------
    EvenMotion
        Where the linkage does not close all the way, one that is closer towards both ends.

    Notes
    -----
    Of the first loop in closed form, see `first_motion`. Where a range ends in a dead position of the
    second loop, of the root of the distance from there.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> nearly_dead = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=4.5, r4=2.501)
    >>> np.degrees(even_motion(nearly_dead, 0.0, np.pi).theta2([0, 0.25, 0.5, 0.75, 1])).round(3).tolist()
    [0.0, 3.126, 16.409, 74.602, 180.0]
    """
    start, end = float(start), float(end)
    if len(linkage.mechanism.dyads) == 1:
        return EvenMotion(start, end, first_motion(linkage, start, end))
    found, (low, high) = cut(linkage), sorted((start, end))
    motion = EvenMotion(start, end, FirstMotion(start, end))
    for (least, most), dead in zip(found.ranges.tolist(), found.dead[..., 1].tolist(), strict=True):
        turned = TURN * np.round((low + high - least - most) / (2 * TURN))
        inside = least + turned - _SLACK <= low <= high <= most + turned + _SLACK
        if most - least > TURN - _SLACK or (inside and not any(dead)):
            motion = replace(motion, first=first_motion(linkage, start, end))
        elif inside and most - least > _SHORT:
            first = first_motion(linkage, least + turned, most + turned)
            begin, finish = _unbent(first.share([start, end]), tuple(dead)).tolist()
            motion = EvenMotion(start, end, first, tuple(dead), begin, finish)
    corners = motion.share(recurring(found.extremes, low, high))
    return replace(motion, corners=tuple(corners.tolist()))
