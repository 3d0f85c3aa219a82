"""The plate of each link: its holes, its slots, and what is refused because they do not fit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import combinations

import numpy as np
import shapely

from grashof.drawing.scene import Scene
from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import Link
from grashof.workshop.plates import Plate, PlateSizes, plate_of
from grashof.workshop.slots import Slot, base_angle, rotated

# A link longer than so many widths is a slip in the unit, and no plate.
_SLENDEREST = 1000
_P = "P"


def link_plates(
    linkage: Linkage, sizes: PlateSizes, slots: tuple[Slot, ...]
) -> tuple[dict[str, Plate], list[str]]:
    """Plates of the moving links of one linkage, in mm, by name, and a note where P has no hole.

    ProblemError for a link too short or too long for its width, or holes and slots too near to each other.
    """
    kind, scene = linkage.mechanism, Scene(linkage)
    for name, length in zip(kind.lengths, linkage.lengths.tolist(), strict=True):
        _refuse_length(name, length, sizes)
        if length < sizes.least_spacing:
            raise ProblemError(
                f"{name} is {length:.4g} mm; for width {sizes.width:g} and hole {sizes.hole:g} mm it must be "
                f"at least {sizes.least_spacing:g} mm: as much between two holes as beside them"
            )
    plates, notes = dict[str, Plate](), list[str]()
    for link in (body.link for body in scene.bodies if not body.slides):  # else a pin in a slot
        holes = {name.upper(): at for name, at in scene.frame(link).items()}
        cut = {slot.pin: slot.ends for slot in slots if slot.link == link.number}
        spots = np.concatenate([np.array(list(holes.values())), *cut.values()])
        farthest = max(link.labels[2:] or link.labels[1:], key=lambda name: float(np.hypot(*holes[name])))
        _refuse_length(f"{link.labels[0]}-{farthest}", float(np.ptp(spots, axis=0).max()), sizes)
        if note := _without_room(link, holes, cut, sizes):
            notes.append(note)
            del holes[_P]
        _refuse_near({name: at for name, at in holes.items() if name != _P}, cut, sizes)
        plates[link.name] = plate_of(link.name, holes, sizes, cut)
    if (carrier := kind.links[kind.carries - 1].name) not in plates:
        notes.append(f"the {carrier} is a pin and has no hole for P")
    return plates, notes


def base_plate(
    linkage: Linkage, posts: dict[str, FloatArray], sizes: PlateSizes, slots: tuple[Slot, ...]
) -> Plate:
    """The base, twice as wide as the links, x along it from O2: holes for the ground pivots, and slots.

    The linkage is in mm with O2 at the origin; `posts` (2,) are other holes, the last after the pivots'.
    """
    angle = -base_angle(linkage)
    holes = {name.upper(): rotated(at[None], angle)[0] for name, at in Scene(linkage).ground.items()}
    cut = {slot.pin: slot.ends for slot in slots if slot.link == 1}
    for name, at in holes.items():
        _refuse_length(f"O2-{name}", float(np.hypot(*at)), sizes)
    names = list(posts)
    holes = {name: (holes | posts)[name] for name in (*names[:-1], *holes, *names[-1:])}
    _refuse_near(holes, cut, sizes)
    return replace(plate_of("base", holes, sizes, cut), width=2 * sizes.width)


def _without_room(
    link: Link, holes: Mapping[str, FloatArray], slots: Mapping[str, FloatArray], sizes: PlateSizes
) -> str:
    """Why P has no hole in its link; empty where it has one, or is elsewhere."""
    if _P not in holes:
        return ""
    apart = {name: float(np.hypot(*(holes[_P] - at))) for name, at in holes.items() if name != _P}
    apart |= {f"the slot of {pin}": _distance(holes[_P], ends) for pin, ends in slots.items()}
    near = {name: length for name, length in apart.items() if length < sizes.least_spacing}
    if not near:
        return ""
    where, length = next(iter(near.items()))
    if slots:
        where, length = " or ".join(apart), min(near.values())
    return (
        f"the {link.name} has no hole for {_P}: it lies {length:.4g} mm from {where}, and holes are at least "
        f"{sizes.least_spacing:g} mm apart"
    )


def _refuse_near(holes: Mapping[str, FloatArray], slots: Mapping[str, FloatArray], sizes: PlateSizes) -> None:
    """Refuse holes of a plate without material between them, and slots beside them."""
    pairs = [
        (name, other, float(np.hypot(*(at - to))))
        for (other, to), (name, at) in combinations(holes.items(), 2)
    ]
    pairs += [
        (name, f"the slot of {pin}", _distance(at, ends))
        for pin, ends in slots.items()
        for name, at in holes.items()
    ]
    for name, other, near in pairs:
        if near < sizes.least_spacing:
            raise ProblemError(
                f"{name} comes within {near:.4g} mm of {other}; for width {sizes.width:g} and hole "
                f"{sizes.hole:g} mm it must stay at least {sizes.least_spacing:g} mm off"
            )


def _refuse_length(name: str, length: float, sizes: PlateSizes) -> None:
    """Refuse a length in mm that is too long for its width."""
    if length > _SLENDEREST * sizes.width:
        raise ProblemError(
            f"{name} is {length:.6g} mm, over {_SLENDEREST} widths of {sizes.width:g} mm; choose a "
            f"width from {length / _SLENDEREST:.4g} mm, or a smaller scale"
        )


def _distance(point: FloatArray, ends: FloatArray) -> float:
    return float(shapely.distance(shapely.points(point), shapely.linestrings(ends)))
