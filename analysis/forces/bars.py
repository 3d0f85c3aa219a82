"""Which links are straight bars, and where on its link each begins and ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis.mechanism.closing import dyad_of
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import DyadKind


@dataclass(frozen=True, slots=True, eq=False)
class Bar:
    """A straight bar along the u-axis of its link.

    Parameters
    ----------
    low, high : ndarray, shape (...), length
        Where it begins and ends, u in the link's frame.
    """

    low: FloatArray
    high: FloatArray

    @property
    def reach(self) -> FloatArray:
        """From end to end, shape (...), length."""
        reach: FloatArray = self.high - self.low
        return reach

    @property
    def middle(self) -> FloatArray:
        """Halfway, shape (..., 2), length."""
        half = self.low + self.reach / 2
        return np.stack([half, np.zeros_like(half)], axis=-1)


def bars_of(linkage: Linkage) -> dict[int, Bar]:
    """The moving links that are bars, by their numbers; sliders and blocks are none.

    Parameters
    ----------
    linkage : Linkage

    Notes
    -----
    Bars reach from joint to joint. The rod of an inverted slider-crank reaches from A to the farthest
    place of B on it, `longest_travel`, and to P where that lies farther out or on the other side of A.

    Examples
    --------
    >>> from grashof.problems import InvertedSliderCrank
    >>> shaper = InvertedSliderCrank(o2=(0, 0), o4=(0, -2), r2=1, coupler_point=(4.5, 0.2))
    >>> {link: float(bar.reach) for link, bar in bars_of(shaper).items()}
    {2: 1.0, 3: 4.5}
    """
    found = {2: _from_origin(linkage.r2)}
    for loop, dyad in enumerate(linkage.mechanism.dyads):
        first = 2 * loop + 3
        if dyad.kind is DyadKind.RPR:
            farthest = linkage.assembly * longest_travel(linkage)
            ends = (np.zeros_like(farthest), farthest, linkage.coupler_point[..., 0])
            found[first] = Bar(np.minimum.reduce(ends), np.maximum.reduce(ends))
            continue
        for link in (first, first + 1) if dyad.kind is DyadKind.RRR else (first,):
            found[link] = _from_origin(getattr(linkage, f"r{link}"))
    return found


def bar_lengths(linkage: Linkage) -> dict[int, float]:
    """Lengths of the bars of a single linkage between their joints, by link.

    That of a rod which slides through a block is `longest_travel`, at which it buckles most easily.
    """
    found = {link: float(bar.reach) for link, bar in bars_of(linkage).items()}
    is_rod = linkage.mechanism.dyads[0].kind is DyadKind.RPR
    return found | ({3: float(longest_travel(linkage))} if is_rod else {})


def longest_travel(linkage: Linkage) -> FloatArray:
    """Greatest distance between A and B on the rod of an inverted slider-crank, shape (...), length.

    Notes
    -----
    sqrt(s^2 - offset^2) with the greatest distance s = r1 + r2 of A from O4, which the driver reaches
    whether it turns or swings; 0 where the linkage never closes.
    """
    farthest = linkage.r1 + linkage.r2
    return np.nan_to_num(np.abs(dyad_of(linkage).place(farthest, np.zeros_like(farthest)).reach))


def _from_origin(length: FloatArray) -> Bar:
    return Bar(np.zeros_like(length), length)
