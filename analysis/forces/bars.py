"""Which links are straight bars, and where on its link each begins and ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems import FourBar, InvertedSliderCrank, SliderCrank
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.linkage import Linkage


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
    >>> shaper = InvertedSliderCrank(o2=(0, 0), o4=(0, -2), r2=1, coupler_point=(4.5, 0.2))
    >>> {link: float(bar.reach) for link, bar in bars_of(shaper).items()}
    {2: 1.0, 3: 4.5}
    """
    if isinstance(linkage, InvertedSliderCrank):
        farthest = linkage.assembly * longest_travel(linkage)
        ends = (np.zeros_like(farthest), farthest, linkage.coupler_point[..., 0])
        return {2: _from_origin(linkage.r2), 3: Bar(np.minimum.reduce(ends), np.maximum.reduce(ends))}
    if isinstance(linkage, SliderCrank):
        return {2: _from_origin(linkage.r2), 3: _from_origin(linkage.r3)}
    if isinstance(linkage, FourBar):
        return {link: _from_origin(getattr(linkage, f"r{link}")) for link in (2, 3, 4)}
    raise TypeError(f"{type(linkage).__name__} is no kind of linkage whose bars are known")


def bar_lengths(linkage: Linkage) -> dict[int, float]:
    """Lengths of the bars of a single linkage between their joints, by link.

    That of a rod which slides through a block is `longest_travel`, at which it buckles most easily.
    """
    found = {link: float(bar.reach) for link, bar in bars_of(linkage).items()}
    return found | ({3: float(longest_travel(linkage))} if isinstance(linkage, InvertedSliderCrank) else {})


def longest_travel(linkage: InvertedSliderCrank) -> FloatArray:
    """Greatest distance between A and B on the rod of an inverted slider-crank, shape (...), length.

    Notes
    -----
    sqrt(s^2 - offset^2) with the greatest distance s = r1 + r2 of A from O4, which the driver reaches
    whether it turns or swings; 0 where the linkage never closes.
    """
    farthest, beside = linkage.r1 + linkage.r2, np.abs(linkage.offset)
    return np.sqrt(np.maximum((farthest - beside) * (farthest + beside), 0.0))


def _from_origin(length: FloatArray) -> Bar:
    return Bar(np.zeros_like(length), length)
