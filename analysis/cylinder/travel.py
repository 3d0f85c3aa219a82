"""The motion that a cylinder gives a linkage, over a parameter that has no dead position."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism import mobility
from grashof.analysis.mechanism.even_motion import closer_at_ends, driver_samples
from grashof.analysis.mechanism.position import Position, solve_position
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, FloatArray, IntArray

_STEADY = 1e-9  # rad: a smaller step counts as none
_SAMPLES = 361


@dataclass(frozen=True, slots=True, eq=False)
class Travel:
    """The motion of a linkage from its first target to its last, whatever drives it.

    Its places are driver angles where link 2 turns fully. Otherwise they are angles phi with
    theta2 = middle - half cos(phi) on the assembly sign(sin(phi)): a turn of phi goes once around the
    circuit, and the linkage moves smoothly with it through the dead positions of link 2 at its multiples
    of pi. `start`, `end`, in either order, and `targets` (N,) are places; `middle` and `half` of the range of
    link 2 are NaN where it turns fully, and `assembly` counts only there.
    """

    linkage: Linkage
    start: float
    end: float
    targets: FloatArray
    middle: float
    half: float
    assembly: int

    @property
    def turns(self) -> bool:
        """Whether link 2 turns fully."""
        return bool(np.isnan(self.middle))

    @property
    def places(self) -> FloatArray:
        """Ascending samples from end to end, close where the linkage may change quickly."""
        if self.turns:
            return driver_samples(self.linkage, self.start, self.end)
        return closer_at_ends(min(self.start, self.end), max(self.start, self.end), _SAMPLES)

    @property
    def dead(self) -> FloatArray:
        """Places between the ends at which link 2 is in a dead position, shape (K,)."""
        if self.turns:
            return np.zeros(0)
        low, high = sorted((self.start, self.end))
        places: FloatArray = np.pi * np.arange(np.ceil(low / np.pi), np.floor(high / np.pi) + 1)
        return places[(places > low + _STEADY) & (places < high - _STEADY)]

    def at(self, places: npt.ArrayLike) -> Position:
        """The linkage at some places, shape (...)."""
        place = np.asarray(places, dtype=np.float64)
        if self.turns:
            return solve_position(self.linkage, place, self.assembly)
        theta2 = self.middle - self.half * np.cos(place)
        return solve_position(self.linkage, theta2, np.where(np.sin(place) >= 0, 1, -1))


def travel(
    linkage: Linkage, theta2: FloatArray, assembly: IntArray, ends: tuple[float, float] | None = None
) -> Travel | None:
    """The motion through targets in their order, also through dead positions; None where none joins them so.

    theta2 (N,), unwrapped where link 2 turns fully, and assembly (N,) are those of a single linkage at its
    targets; `ends` the driver angles at which a motion on one branch begins and ends, if not at targets.
    """
    circuits = mobility.circuit_index(linkage, theta2, assembly)
    if circuits[0] < 0 or (circuits != circuits[0]).any():
        return None
    sign = int(assembly[0])
    if mobility.full_rotation(linkage):
        start, end = (theta2[0], theta2[-1]) if ends is None else ends
        if (assembly != sign).any() or (ends is None and not _one_way(theta2)):
            return None
        return Travel(linkage, float(start), float(end), theta2, np.nan, np.nan, sign)
    index, inside = mobility.range_index(linkage, theta2)
    if (index != index[0]).any():
        return None
    low, high = mobility.dead_ends(linkage, *mobility.driver_ranges(linkage)[int(index[0])])
    middle, half = (low + high) / 2, (high - low) / 2

    def phases(angles: FloatArray, sides: IntArray | int) -> FloatArray:
        return np.asarray(sides * np.arccos(np.clip((middle - angles) / half, -1, 1)), dtype=np.float64)

    targets = phases(inside, assembly)
    if ends is not None:
        start, end = phases(mobility.range_index(linkage, np.array(ends))[1], sign)
        return Travel(linkage, float(start), float(end), targets, middle, half, sign)
    around = [found for way in (1, -1) if (found := _in_order(targets, way)) is not None]
    if not around:
        return None
    shortest = min(around, key=lambda found: abs(found[-1] - found[0]))
    return Travel(linkage, float(shortest[0]), float(shortest[-1]), shortest, middle, half, sign)


def _one_way(theta2: FloatArray) -> bool:
    step = np.diff(theta2)
    within = abs(theta2[-1] - theta2[0]) <= TURN + _STEADY
    return bool(within and ((step >= -_STEADY).all() or (step <= _STEADY).all()))


def _in_order(phases: FloatArray, way: int) -> FloatArray | None:
    """Phases unwrapped in one sense, less than a turn in all; None where that cannot be."""
    step = (way * np.diff(phases) + _STEADY) % TURN - _STEADY
    if step.sum() >= TURN - _STEADY:
        return None
    return np.asarray(phases[0] + way * np.concatenate([[0.0], np.cumsum(step)]))
