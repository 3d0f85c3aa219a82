"""Links that are straight bars, and the ends of each on its link."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis.mechanism.closing import dyad_of
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import DyadKind


@dataclass(frozen=True, slots=True, eq=False)
class Bar:
    """A straight bar along its link: u in the link's frame where it begins and ends, each of shape (...)."""

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
    """The moving links that are bars, by their numbers, from joint to joint; sliders and blocks are none.

    The rod of an inverted slider-crank reaches from A to the farthest place of B on it, `longest_travel`, and
    to P where that lies farther out or on the other side of A.
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
    """Lengths between joints by link; of a rod through a block `longest_travel`, where it buckles first."""
    found = {link: float(bar.reach) for link, bar in bars_of(linkage).items()}
    is_rod = linkage.mechanism.dyads[0].kind is DyadKind.RPR
    return found | ({3: float(longest_travel(linkage))} if is_rod else {})


def longest_travel(linkage: Linkage) -> FloatArray:
    """Greatest distance between A and B on the rod of an inverted slider-crank, shape (...).

    A lies up to r1 + r2 from O4 whether the driver turns or swings; 0 where the linkage never closes.
    """
    farthest = linkage.r1 + linkage.r2
    return np.nan_to_num(np.abs(dyad_of(linkage).close(farthest, np.zeros_like(farthest)).reach))


def _from_origin(length: FloatArray) -> Bar:
    return Bar(np.zeros_like(length), length)
