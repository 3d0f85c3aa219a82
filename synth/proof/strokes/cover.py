"""Branch and bound over the parameter of a family: an upper bound for all its members."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from time import perf_counter

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.proof.claims.bounds import Bounds, Proving
from grashof.synth.proof.strokes.members import Family, MemberBounds
from grashof.synth.proof.strokes.ranges import Range
from grashof.synth.proof.strokes.required import (
    families_of_stroke,
    floor_of,
    refusal_of_stroke,
    sizes_left_out,
)
from grashof.synth.quantities.scaled_problem import ScaledProblem

_BEGUN = 64  # pieces of each family
_MOST_LEVELS = 60
_MOST_LEFT = 20_000
_OFF = 1e-14  # rad: more than the rounding of an angle


@dataclass(frozen=True, slots=True)
class Cover:
    """Bounds of the greatest transmission angle in families."""

    lower: float = 0.0  # rad, of a member that is allowed and counts; 0 where none is known
    upper: float = np.pi / 2  # rad; no member has more
    closed: bool = True  # whether the bounds have met, or no member is left
    begun: int = 0  # pieces to begin with
    bounded: int = 0  # pieces in all
    levels: int = 0  # number of times that the remaining pieces were halved


def bounds_of_stroke(scaled: ScaledProblem, proving: Proving, at_least: float | None = None) -> Bounds | None:
    """Bounds of the best design; None for other tasks. `at_least` is in deg."""
    if not scaled.problem.task.at_limits:
        return None
    since = perf_counter()
    cover = covered(families_of_stroke(scaled), float(np.radians(proving.gap)), floor_of(scaled, at_least))
    made = Bounds(
        lower=cover.lower,
        upper=cover.upper,
        closed=cover.closed,
        pieces=(cover.begun, 0),
        pairs=cover.bounded,
        levels=cover.levels,
        seconds=perf_counter() - since,
        left_out=sizes_left_out(scaled),
        why="" if cover.closed else "pieces of families stay open, as small as rounding or too many",
    )
    why = refusal_of_stroke(scaled)
    return Bounds(why=why, refused=True) if why and not made.none else made


def covered(families: Sequence[Family], gap: float, floor: float) -> Cover:
    """Bounds of the greatest transmission angle of all members of families.

    They are brought together up to `gap`, rad; members that transmit less than `floor`, rad, do not count.
    """
    cover, open_bounds = Cover(), [0.0]
    for family in families:
        cover, left = _family(family, cover, gap, floor)
        open_bounds.append(left)
    threshold, left = _threshold(cover, gap, floor), max(open_bounds)
    return replace(cover, upper=float(min(max(threshold, left), np.pi / 2)), closed=bool(left <= threshold))


def _threshold(cover: Cover, gap: float, floor: float) -> float:
    return max(cover.lower + gap if cover.lower else 0.0, floor)


def _family(family: Family, cover: Cover, gap: float, floor: float) -> tuple[Cover, float]:
    """The cover with one more family, and the greatest bound of its open pieces, or 0."""
    low, high = _first(family)
    cover = replace(cover, begun=cover.begun + len(low))
    for level in range(_MOST_LEVELS + 1):
        piece, middle = Range(low, high), (low + high) / 2
        at_middle = family.members(Range.of(middle))
        bound = _bounds(family.members(piece), piece - Range.of(middle), at_middle)
        found = float(_sure(at_middle).max(initial=0.0))
        lower = max(cover.lower, found if found > floor else 0.0)
        cover = replace(cover, lower=lower, bounded=cover.bounded + len(low), levels=max(cover.levels, level))
        left = bound > _threshold(cover, gap, floor)
        low, high, middle, bound = low[left], high[left], middle[left], bound[left]
        halves = (low < middle) & (middle < high)
        if not len(low) or len(low) > _MOST_LEFT or not halves.all():
            break
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    return cover, float(bound.max(initial=0.0))


def _first(family: Family) -> tuple[FloatArray, FloatArray]:
    """First pieces; for a parameter that cannot be zero they are shares of it."""
    if family.low > family.high:
        return np.zeros(0), np.zeros(0)
    spaced = np.geomspace if family.low > 0 else np.linspace
    edges = spaced(family.low, family.high, _BEGUN + 1)
    edges[[0, -1]] = family.low, family.high
    return edges[:-1], edges[1:]


def _bounds(members: MemberBounds, from_middle: Range, middle: MemberBounds) -> FloatArray:
    """The greatest transmission angle of pieces, rad; nothing where no member of them is allowed.

    The cosine changes from the middle of a piece by no more than its slope does.
    """
    possible = np.ones(members.cosine.low.shape, dtype=bool)
    for some, most in members.conditions:
        possible &= ~(some.low > most.high)
    by_slope = middle.cosine + members.slope * from_middle
    cosine = np.nan_to_num(np.fmax(members.cosine.low, by_slope.low), nan=0.0)
    return np.where(possible, np.arccos(np.clip(cosine, 0.0, 1.0)) + _OFF, 0.0)


def _sure(members: MemberBounds) -> FloatArray:
    """The least transmission angle of members, rad; nothing where they may be ruled out."""
    allowed = np.ones(members.cosine.low.shape, dtype=bool)
    for some, most in members.conditions:
        allowed &= some.high <= most.low
    return np.where(allowed, np.arccos(np.clip(members.cosine.high, 0.0, 1.0)), 0.0)
