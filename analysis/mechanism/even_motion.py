"""A variable over which a linkage moves evenly, and driver angles to sample a motion at."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.first_motion import (
    SHORT,
    SLACK,
    FirstMotion,
    first_motion,
    panel_edges,
    turns_into,
)
from grashof.analysis.mechanism.second_loop import cut, recurring
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, FloatArray, IntArray

_SAMPLES = 481
_NEAR = np.logspace(-8, -2, 31)  # rad, about positions close to a dead one


@dataclass(frozen=True, slots=True)
class EvenMotion:
    """Driver angle as a function of a share t, 0 to 1, of a motion, over which all links move evenly.

    Near a dead position or a change point the links move far while the driver hardly does. Over t they do
    not, so that a few equal steps are dense samples and quadrature converges fast. (A second loop may still
    come close to a dead position between the ends, at one of the `edges`.) Made by `even_motion`.

    Parameters
    ----------
    start, end : float, rad
        Driver angles, in either order.
    first : FirstMotion
        That of the first loop: from start to end, or over the range of a second loop that ends in a dead
        position.
    dead : pair of bool
        Whether the second loop is dead at the ends of `first`.
    begin, finish : float
        Start and end as shares of that range, over which the second loop moves evenly.
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
        """Driver angle at a share, which may exceed [0, 1] where the driver turns fully; shape (...), rad."""
        t = np.asarray(share, dtype=np.float64)
        return self.held(t, self.first.theta2(self.share_of_first(t)))

    def share_of_first(self, t: FloatArray) -> FloatArray:
        """Shares of `first` at those of the motion, shape (...)."""
        return self._bent(self.begin + (self.finish - self.begin) * t) if any(self.dead) else t

    def held(self, t: FloatArray, angle: FloatArray) -> FloatArray:
        """Driver angles at shares, held between the ends of the motion where `first` goes beyond, (...)."""
        if not any(self.dead):
            return angle
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
        """Shares at the ends of about this many panels, with the ground line and the corners among them.

        There a linkage near a change point or a dead position of its second loop may turn sharply.
        """
        low, high = sorted((self.start, self.end))
        along = self.first.ground_line()
        inside = along[(along >= low) & (along <= high)] if any(self.dead) else along
        return panel_edges(panels, np.concatenate([self.share(inside), self.corners]))

    def _bent(self, v: FloatArray) -> FloatArray:
        """Share of `first`; its rate vanishes where the second loop is dead."""
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
        Where the linkage does not close throughout, a variable that is closer towards both ends.

    Notes
    -----
    For the first loop t is the integral of d theta2 / sin mu, an elliptic integral (Darboux 1879). Near a
    dead position of the second loop it is the root of the distance from there.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> nearly_dead = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=4.5, r4=2.501)
    >>> np.degrees(even_motion(nearly_dead, 0.0, np.pi).theta2([0, 0.25, 0.5, 0.75, 1])).round(3).tolist()
    [0.0, 3.126, 16.409, 74.602, 180.0]
    """
    if len(linkage.mechanism.dyads) == 1:
        return EvenMotion(float(start), float(end), first_motion(linkage, start, end))
    found, (low, high) = cut(linkage), np.sort([start, end])
    motion = EvenMotion(float(start), float(end), FirstMotion(*np.array([start, end], dtype=np.float64)))
    for (least, most), dead in zip(found.ranges, found.dead[..., 1].tolist(), strict=True):
        turned = turns_into(least, most, low, high)
        if most - least > TURN - SLACK or (np.isfinite(turned) and not any(dead)):
            motion = replace(motion, first=first_motion(linkage, start, end))
        elif np.isfinite(turned) and most - least > SHORT:
            first = first_motion(linkage, least + turned, most + turned)
            begin, finish = _unbent(first.share([start, end]), tuple(dead)).tolist()
            motion = EvenMotion(motion.start, motion.end, first, tuple(dead), begin, finish)
    corners = motion.share(recurring(found.extremes, low, high))
    return replace(motion, corners=tuple(corners.tolist()))


def with_edges(
    linkage: Linkage, start: FloatArray, end: FloatArray, panels: int
) -> Iterator[tuple[IntArray, EvenMotion | FirstMotion, FloatArray]]:
    """The even motions (rows, 1) of linkages (n,) between driver angles (n,), and their edges (rows, M + 1).

    In groups of `rows` of the batch with as many edges.
    """
    if len(linkage.mechanism.dyads) > 1:
        for row, ends in enumerate(zip(start.tolist(), end.tolist(), strict=True)):
            motion = even_motion(linkage[row], *ends)
            yield np.array([row]), motion, motion.edges(panels)[None]
        return
    motions = first_motion(linkage[:, None], start[:, None], end[:, None])
    every = [panel_edges(panels, shares) for shares in motions.share(motions[:, 0].ground_line())]
    count = np.array([len(edges) for edges in every])
    for number in np.unique(count).tolist():
        rows = np.flatnonzero(count == number)
        yield rows, motions[rows], np.stack([every[row] for row in rows])


def angles_at_shares(
    linkage: Linkage, start: npt.ArrayLike, end: npt.ArrayLike
) -> Callable[[FloatArray], FloatArray]:
    """Driver angles at shares (..., N) of the even motions of linkages (...) between driver angles (...)."""
    if len(linkage.mechanism.dyads) == 1:
        return first_motion(linkage, start, end)[..., None].theta2
    start, end = (np.broadcast_to(each, linkage.shape).ravel() for each in (start, end))
    of_rows, members = angles_of_rows(linkage.flat, start, end), np.arange(len(start)).reshape(linkage.shape)

    def angles(share: FloatArray) -> FloatArray:
        shape = *np.broadcast_shapes(share.shape[:-1], linkage.shape), share.shape[-1]
        rows, every = np.broadcast_to(members, shape[:-1]), np.broadcast_to(share, shape)
        return of_rows(every.reshape(-1, shape[-1]), rows.ravel()).reshape(shape)

    return angles


def angles_of_rows(
    linkage: Linkage, start: FloatArray, end: FloatArray
) -> Callable[[FloatArray, IntArray], FloatArray]:
    """Driver angles at shares (K, N) of the even motions of rows (K,) of a batch (n,) between angles (n,)."""
    if len(linkage.mechanism.dyads) == 1:
        motion = first_motion(linkage, start, end)[:, None]
        return lambda share, rows: motion[rows].theta2(share)
    ends = zip(start.tolist(), end.tolist(), strict=True)
    motions = [even_motion(linkage[row], *each) for row, each in enumerate(ends)]
    first = FirstMotion.stacked([each.first for each in motions])[:, None]

    def angles(share: FloatArray, rows: IntArray) -> FloatArray:
        beyond = [(at, motions[row]) for at, row in enumerate(rows.tolist()) if any(motions[row].dead)]
        within = np.array(share)
        for at, motion in beyond:
            within[at] = motion.share_of_first(share[at])
        found = first[rows].theta2(within)
        for at, motion in beyond:
            found[at] = motion.held(share[at], found[at])
        return found

    return angles


def driver_samples(linkage: Linkage, start: float, end: float) -> FloatArray:
    """Driver angles between two ends, denser where a dead position may be near.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    start, end : float, rad
        In either order; both are among the samples.

    Returns
    -------
    ndarray, shape (N,), rad
        Ascending; denser at both ends, where O2A lies along the ground line, and where the width of a second
        loop's gap has an extreme.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> samples = driver_samples(FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3), 0.5, 6.0)
    >>> float(samples[0]), float(samples[-1]), bool((samples == np.pi).any())
    (0.5, 6.0, True)
    """
    return close_samples(linkage, start, end, _SAMPLES, second=True)


def close_samples(linkage: Linkage, start: float, end: float, count: int, *, second: bool) -> FloatArray:
    """`driver_samples` from `count` angles; those for the second loop only with `second`."""
    low, high = min(start, end), max(start, end)
    spread = closer_at_ends(low, high, count)
    spread[[0, -1]] = low, high
    aligned = ground_line(linkage, low, high)
    if second and len(linkage.mechanism.dyads) > 1:
        aligned = np.concatenate([aligned, recurring(cut(linkage).extremes, low, high)])
    near = (aligned[:, None] + np.concatenate([-_NEAR, [0.0], _NEAR])).ravel()
    return np.unique(np.concatenate([spread, near[(near > low) & (near < high)]]))


def ground_line(linkage: Linkage, low: float, high: float) -> FloatArray:
    """Driver angles between two ends at which O2A lies along the ground line, shape (N,), rad."""
    theta1 = float(linkage.theta1)
    halves = np.arange(np.ceil((low - theta1) / np.pi), np.floor((high - theta1) / np.pi) + 1)
    return np.asarray(theta1 + np.pi * halves)


def closer_at_ends(low: float | FloatArray, high: float | FloatArray, count: int) -> FloatArray:
    """Values from end to end, closer towards both, shape (count,), or (..., count) of ends (..., 1)."""
    share: FloatArray = (1 - np.cos(np.linspace(0, np.pi, count))) / 2
    return low + (high - low) * share
