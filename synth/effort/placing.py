"""Parts of an effort: their sizes and places."""

from __future__ import annotations

from dataclasses import replace

from grashof.analysis.effort.case import EffortCase
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.effort import EffortSpec
from grashof.problems.values.dynamics.struts import EffortPlace, PartSpec
from grashof.synth.effort.aim import Aim
from grashof.synth.effort.search import best_by_search


def placed(case: EffortCase, seed: int = 0) -> EffortSpec | None:
    """The effort with the best size of each part at the best places; None without enough stroke.

    Parameters
    ----------
    case : EffortCase
        A linkage with its loads over its travel.
    seed : int

    Returns
    -------
    EffortSpec or None
        The parts have a single size each, and points in place of areas. The greatest excess of the effort
        over its limits is the least found: the best of several thousand random places and sizes are refined
        by random steps, then by linear programmes. None where no size has enough stroke for the travel.
    """
    spec = case.spec
    if spec.is_placed:
        return spec
    aim = Aim.of(case)
    found = best_by_search(aim, seed)
    if found is None:
        return None
    x, rows = found
    parts, first = [], 0
    for part, known, row in zip(spec.parts, aim.parts, rows.tolist(), strict=True):
        parts.append(_placed(part, x[first : first + known.unknowns], row))
        first += known.unknowns
    return replace(spec, parts=tuple(parts))


def _placed(part: PartSpec, x: FloatArray, row: int) -> PartSpec:
    chosen = replace(part, sizes=(part.sizes[row],))
    if part.free_angle_deg is not None:
        low, high = part.free_angle_deg
        angle = float(low + (high - low) * x[0])
        return replace(chosen, free_angle_deg=(angle, angle))
    first, second = (_at(place, x[2 * k : 2 * k + 2]) for k, place in enumerate(part.places))
    return replace(chosen, between=(first, second))


def _at(place: EffortPlace, x: FloatArray) -> EffortPlace:
    corner, along, across = place.spanned
    found = corner + along * x[0] + across * x[1]
    return place.placed(float(found.real), float(found.imag))
