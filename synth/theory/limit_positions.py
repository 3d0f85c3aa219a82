"""Linkages by the limit positions of their output, where driver and coupler are in line.

All crank-rockers with a swing and time ratio, and slider-cranks with a stroke and time ratio, are
one-parameter families in r2 / r3. Transmission is best somewhere in between, or where a limit ends the
family.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, TypeAlias

import numpy as np

from grashof.problems import FourBar, SliderCrank, Task
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.tasks.stroke_task import EVEN

# Shares r2 / r3 at which a family is examined, close where one of the two vanishes beside the other.
_GRID = np.unique(
    np.concatenate([
        np.geomspace(1e-6, 0.02, 160), np.linspace(0.02, 0.98, 1200), 1 - np.geomspace(0.02, 1e-6, 80),
    ])
)  # fmt: skip
_HALVINGS = 60
_GOLDEN, _SECTIONS = (np.sqrt(5) - 1) / 2, 72  # to rounding, from neighbours of the grid
_ROUNDING = 1e-12  # margins down to that are zero


@dataclass(frozen=True, slots=True)
class StrokeLinkages:
    """Linkages of a family; arrays (n,), angles in rad."""

    share: FloatArray  # r2 / r3
    # (n, k): r1 (1), r2, r3, r4 of crank-rockers; r2, r3, offset, in strokes, of slider-cranks
    lengths: FloatArray
    transmission: FloatArray  # worst min(mu, pi - mu) over the turn
    margin: FloatArray  # positive where the driver turns fully and both limit positions lie on one assembly
    # `first` and `last` are driver angles from O2O4, or from the slide's direction, at which the slow stroke
    # begins and ends when the driver turns counter-clockwise; the other way round when it turns clockwise
    first: FloatArray
    last: FloatArray
    assembly: FloatArray

    def __getitem__(self, index: Any) -> StrokeLinkages:
        return StrokeLinkages(*(getattr(self, name)[index] for name in self.__slots__))

    def __len__(self) -> int:
        return len(self.share)

    @property
    def mirrored(self) -> StrokeLinkages:
        """Their mirror images, in which the driver turns the other way.

        Of strokes that take equally long, the one from the stretched position counts as the slow one.
        """
        even = self.last - self.first <= np.pi + EVEN
        first, last = np.where(even, [-self.first, TURN - self.last], [-self.last, -self.first])
        return replace(self, first=first, last=last, assembly=-self.assembly)


_LEAST_SHARE = float(_GRID[0])
Family: TypeAlias = Callable[[FloatArray], StrokeLinkages]
# Margins of members to limits, (n,): negative outside.
Allowed: TypeAlias = Callable[[StrokeLinkages], FloatArray]


def lag_of(time_ratio: float) -> float:
    """Angle by which the driver turns more than half a turn in the slow stroke, rad.

    >>> round(float(np.degrees(lag_of(1.5))), 12)
    36.0
    """
    return float(np.pi * (time_ratio - 1) / (time_ratio + 1))


def crank_rockers(swing: float, lag: float | FloatArray, share: FloatArray) -> StrokeLinkages:
    """The crank-rockers with a swing of link 4 (rad, below pi) and a time ratio, O2O4 = 1.

    `lag`, rad (see `lag_of`), one or (n,), is negative where link 4 swings the other way while driver and
    coupler go from stretched to folded; `share` (n,) is r2 / r3, between 0 and 1. In the triangles O2-B1-B2
    and O4-B1-B2 of the two limit positions, O2B1 = r3 + r2, O2B2 = r3 - r2, the angles at O2 and O4 are lag
    and swing (Alt's problem):

        r4² sin²(swing/2) = r2² cos²(lag/2) + r3² sin²(lag/2)
        r1² sin²(swing/2) = r2² cos²((swing − lag)/2) + r3² sin²((swing − lag)/2)

    These hold for any two points B; both are on one assembly where they lie on the same side of their
    coupler's line, O2B, as seen from O4.
    """
    r2, r3, sine = share, np.ones_like(share), np.sin(swing / 2)
    r4 = np.hypot(r2 * np.cos(lag / 2), r3 * np.sin(lag / 2)) / sine
    r1 = np.hypot(r2 * np.cos((swing - lag) / 2), r3 * np.sin((swing - lag) / 2)) / sine
    b1, b2, turned = r3 + r2, (r3 - r2) * np.exp(1j * lag), np.exp(1j * swing)
    o4 = (b2 - b1 * turned) / (1 - turned)
    side = (b1 - o4).imag
    sides = side * ((b2 - o4) * np.exp(-1j * lag)).imag / r4**2
    stretched = -np.angle(o4)
    folded, slow = stretched + lag + np.pi, np.asarray(lag) >= 0
    turns = np.min([r3 + r4 - r1 - r2, np.abs(r1 - r2) - np.abs(r3 - r4), r1 - r2], axis=0)
    return StrokeLinkages(
        share=share,
        lengths=np.stack([r1, r2, r3, r4], axis=-1) / r1[:, None],
        transmission=worst_between(r3, r4, r1 - r2, r1 + r2),
        margin=np.minimum(sides, turns / (r1 + r2 + r3 + r4)),
        first=np.where(slow, stretched, folded),
        last=np.where(slow, folded, stretched + 2 * np.pi),
        assembly=np.where(side > 0, 1.0, -1.0),
    )


def worst_between(one: FloatArray, other: FloatArray, near: FloatArray, far: FloatArray) -> FloatArray:
    """Worst transmission angle of two bars over diagonals from `near` to `far`; 0 where they do not close."""
    ends = np.stack([near, far])
    cosine = np.clip((one**2 + other**2 - ends**2) / (2 * one * other), -1.0, 1.0)
    angle: FloatArray = np.arccos(np.abs(cosine)).min(axis=0)
    return angle


def slider_cranks(lag: float, share: FloatArray) -> StrokeLinkages:
    """The slider-cranks with a time ratio, of stroke 1.

    `lag`, rad (see `lag_of`), is negative where the slide lies to the right of O2; `share` (n,) is r2 / r3,
    between 0 and 1. In the triangle O2-B1-B2 of the two limit positions with the sides r3 + r2, r3 - r2 and
    the stroke S:

        S² = (r3 + r2)² + (r3 − r2)² − 2 (r3² − r2²) cos lag        offset = (r3² − r2²) sin(lag) / S

    Both are on one assembly where B1 and B2 lie on one side of the foot of O2 on the slide, that is where the
    angle at B2 is obtuse. The worst transmission angle has cos mu = (r2 + |offset|) / r3.
    """
    r3 = 0.5 / np.hypot(np.sin(lag / 2), share * np.cos(lag / 2))
    r2 = share * r3
    offset = (r3**2 - r2**2) * np.sin(lag)
    beside = np.abs(offset)
    stretched = np.arcsin(np.clip(offset / (r3 + r2), -1.0, 1.0))
    turns = (r3 - r2 - beside) / (r3 + r2 + beside)
    return StrokeLinkages(
        share=share,
        lengths=np.stack([r2, r3, offset], axis=-1),
        transmission=np.arccos(np.clip((r2 + beside) / r3, 0.0, 1.0)),
        margin=np.minimum(4 * r2 * r3 - 1, turns),
        first=stretched if lag >= 0 else stretched + lag + np.pi,
        last=stretched + lag + np.pi if lag >= 0 else stretched + 2 * np.pi,
        assembly=np.ones_like(share),
    )


def crank_shapers(swing: float, side: float, share: FloatArray) -> StrokeLinkages:
    """The inverted slider-cranks with a swing of the block, O2O4 = 1; their time ratio follows from it.

    The swing, rad, is below pi; `side` is the sign of the offset. `share` (n,), between 0 and 1, is the
    offset over the greatest that a full turn allows; the least of the grid counts as none. The lengths are r1
    (1), r2 and the offset.

    The crank is perpendicular to the rod in both limit positions, in which the rod has the directions
    -asin(r2 − offset) and asin(r2 + offset) from the ground line. With p between 0 and 90° − swing/2

        r2 = sin(swing/2) cos p        offset = cos(swing/2) sin p

    The slow stroke turns the crank by 180° + swing; at worst cos mu = |offset| / (1 − r2).

    >>> found = crank_shapers(np.radians(60), 1, np.array([0.0, 0.5]))
    >>> found.lengths.round(4).tolist(), np.degrees(found.transmission).round(3).tolist()
    ([[1.0, 0.5, 0.0], [1.0, 0.433, 0.433]], [90.0, 40.208])
    """
    p = (np.pi - swing) / 2 * np.maximum(share - _LEAST_SHARE, 0.0)
    r2, offset = np.sin(swing / 2) * np.cos(p), side * np.cos(swing / 2) * np.sin(p)
    room = 1 - np.sin(swing / 2 + p)  # 1 - r2 - |offset|
    return StrokeLinkages(
        share=share,
        lengths=np.stack([np.ones_like(r2), r2, offset], axis=-1),
        transmission=np.arccos(np.clip(np.abs(offset) / (1 - r2), 0.0, 1.0)),
        margin=room / (1 + r2 + np.abs(offset)),
        first=np.pi / 2 - np.arcsin(r2 - offset),
        last=3 * np.pi / 2 + np.arcsin(r2 + offset),
        assembly=np.ones_like(share),
    )


def linkages_of(task: Task, members: StrokeLinkages) -> FourBar | SliderCrank:
    """Members of a family as linkages, shape (n,): O2 the origin, O4 (1, 0) or the slide along x, P in A.

    >>> from grashof.problems import StrokeTask
    >>> task = StrokeTask(stroke=100.0, time_ratio=1.2)
    >>> slides = linkages_of(task, slider_cranks(lag_of(1.2), np.array([0.36781])))
    >>> slides.offset.round(2).tolist()
    [39.86]
    """
    if task.stroke is not None:
        r2, r3, offset = task.stroke * members.lengths.T
        return SliderCrank((0.0, 0.0), r2, r3, offset, assembly=members.assembly)
    r1, r2, r3, r4 = members.lengths.T
    o4 = np.stack([r1, np.zeros_like(r1)], axis=-1)
    return FourBar((0.0, 0.0), o4, r2, r3, r4, assembly=members.assembly)


def greatest_time_ratio(swing: float) -> float:
    """Upper limit of the time ratio of crank-rockers with a swing (rad).

    Their limit positions are on one assembly and the driver turns fully only where the driver's angle between
    them lies between 90 deg + swing/2 and 270 deg + swing/2.

    >>> round(greatest_time_ratio(np.radians(80)), 3)
    6.2
    """
    return float((3 * np.pi + swing) / (np.pi - swing))


def families_of(swing: float | None, time_ratio: float) -> list[Family]:
    """All crank-rockers with a swing (rad) and a time ratio; for None, all slider-cranks of stroke 1."""
    lag = lag_of(time_ratio)
    if swing is None:
        return [partial(slider_cranks, lag)]
    return [partial(crank_rockers, swing, sign) for sign in ([lag, -lag] if lag else [0.0])]


def mirrored(family: Family, share: FloatArray) -> StrokeLinkages:
    """Members of the family of the mirror images."""
    return family(share).mirrored


def everywhere(members: StrokeLinkages) -> FloatArray:
    """No limit: every member is far inside."""
    return np.ones(len(members.share))


def _margin(family: Family, allowed: Allowed) -> Callable[[FloatArray], FloatArray]:
    def margin(share: FloatArray) -> FloatArray:
        found = family(share)
        return np.minimum(found.margin, allowed(found))

    return margin


def stretches(family: Family, allowed: Allowed = everywhere) -> list[tuple[float, float]]:
    """Where members of a family are usable and allowed: stretches of r2 / r3, ends included.

    Between neighbours of a grid the ends are found by halving; stretches too narrow for the grid where the
    margin is greatest between its points.
    """
    margin = _margin(family, allowed)
    at_grid = margin(_GRID)
    peaks = _peaks(margin, at_grid)
    share = np.concatenate([_GRID, peaks])
    order = np.argsort(share)
    share, inside = share[order], (np.concatenate([at_grid, margin(peaks)]) >= -_ROUNDING)[order]
    first = np.flatnonzero(inside & ~np.concatenate([[False], inside[:-1]]))
    last = np.flatnonzero(inside & ~np.concatenate([inside[1:], [False]]))
    low, high = np.maximum(first - 1, 0), np.minimum(last + 1, len(share) - 1)
    begin = _edge(margin, share[low], share[first])
    end = _edge(margin, share[high], share[last])
    return list(zip(begin.tolist(), end.tolist(), strict=True))


def _peaks(margin: Callable[[FloatArray], FloatArray], at_grid: FloatArray) -> FloatArray:
    """Where a margin that is negative on the grid is greatest between its points."""
    padded = np.pad(at_grid, 1, constant_values=-np.inf)
    peak = (at_grid >= padded[:-2]) & (at_grid >= padded[2:]) & (at_grid < 0) & np.isfinite(at_grid)
    index = np.flatnonzero(peak)
    return _highest(margin, _GRID[np.maximum(index - 1, 0)], _GRID[np.minimum(index + 1, len(_GRID) - 1)])


def highest(value: Callable[[FloatArray], FloatArray], low: float, high: float) -> float:
    """Where a function of shares (n,) is greatest between two of them, if it has one maximum there."""
    return float(_highest(value, np.array([low]), np.array([high]))[0])


def _highest(value: Callable[[FloatArray], FloatArray], low: FloatArray, high: FloatArray) -> FloatArray:
    """The same between each of some shares (m,) and others, all at once.

    Golden section: limits meet in kinks, at which methods that fit parabolas lose half of the digits.
    """
    for _ in range(_SECTIONS if len(low) else 0):
        before, behind = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        left, right = np.split(value(np.concatenate([before, behind])), 2)
        is_left = left >= right
        low, high = np.where(is_left, low, before), np.where(is_left, behind, high)
    return (low + high) / 2


def _edge(margin: Callable[[FloatArray], FloatArray], outside: FloatArray, inside: FloatArray) -> FloatArray:
    """The last places inside on the way to places outside; shape (m,)."""
    for _ in range(_HALVINGS):
        middle = (outside + inside) / 2
        is_in = margin(middle) >= -_ROUNDING
        outside, inside = np.where(is_in, outside, middle), np.where(is_in, middle, inside)
    return inside


def best_of(family: Family, within: list[tuple[float, float]]) -> list[float]:
    """Where the transmission is best in each stretch of a family; no better one lies beside it."""

    def transmission(share: FloatArray) -> FloatArray:
        return family(share).transmission

    best = []
    for low, high in within:
        looked_at = np.concatenate([[low], _GRID[(low < _GRID) & (high > _GRID)], [high]])
        k = int(np.argmax(transmission(looked_at)))
        near = looked_at[max(k - 1, 0)], looked_at[min(k + 1, len(looked_at) - 1)]
        tried = np.array([looked_at[k], highest(transmission, *near) if near[0] < near[1] else low])
        best.append(float(tried[np.argmax(transmission(tried))]))
    return best


def best_transmission(swing: float | None, time_ratio: float, allowed: Allowed = everywhere) -> float:
    """The best worst transmission angle over the turn for a swing (None: a slide), rad; NaN without any."""
    found = [
        family(np.array(best_of(family, within))).transmission.max()
        for family in families_of(swing, time_ratio)
        if (within := stretches(family, allowed))
    ]
    return float(max(found, default=np.nan))
