"""The plate of each link: its holes, its slots for slides, and the refusal of those that do not fit.

The pin of a slider runs in a slot of the base, that of a block in one of the rod.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple

import numpy as np
import shapely

from grashof.analysis import solve_position
from grashof.analysis.mechanism.extremes import dense_samples, refined
from grashof.drawing.scene import Scene, Slide
from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import Link
from grashof.workshop.plates import Plate, PlateSizes, plate_of

# Widths; a longer link is a slip in the unit, not a plate.
_SLENDEREST = 1000
_P = "P"


class Slot(NamedTuple):
    """A slide: the pin of its slider or block and the slot in another link, `ends` (2, 2) in its plate, mm.

    `slider` and `link` are numbers of links, 1 the base.
    """

    pin: str
    slider: int
    link: int
    ends: FloatArray

    @property
    def length(self) -> float:
        """Between the centres of its ends, mm."""
        return float(np.hypot(*(self.ends[1] - self.ends[0])))


def slots_of(linkage: Linkage, ranges: Iterable[tuple[float, float]], sizes: PlateSizes) -> tuple[Slot, ...]:
    """Slots, mm, half a clearance longer at either end than the travel over `ranges` of theta2, rad."""
    ranges, found = tuple(ranges), []
    for slide in Scene(linkage).slides:
        along = _travel(linkage, slide, ranges) + np.array([-sizes.gap, sizes.gap]) / 2
        ends = np.column_stack([along, np.full(2, slide.offset)])
        turned = slide.angle - (0.0 if slide.carried else base_angle(linkage))
        found.append(Slot(slide.pin.upper(), slide.slider, slide.guide, rotated(ends, turned)))
    return tuple(found)


def base_angle(linkage: Linkage) -> float:
    """Direction of the base, rad: from O2 to O4, or along the slide."""
    return float(getattr(linkage, "slide_angle", linkage.theta1))


def rotated(points: FloatArray, angle: float) -> FloatArray:
    """Points of shape (n, 2), turned about the origin."""
    cos, sin = np.cos(angle), np.sin(angle)
    turned: FloatArray = points @ np.array([[cos, sin], [-sin, cos]])
    return turned


def _travel(linkage: Linkage, slide: Slide, ranges: Iterable[tuple[float, float]]) -> FloatArray:
    """Least and largest travel of a slide, shape (2,), mm."""

    def travel(theta2: FloatArray) -> FloatArray:
        return slide.travel(solve_position(linkage, theta2))

    ends = []
    for low, high in ranges:
        theta2 = dense_samples(low, high, closed=False)
        values = travel(theta2)
        closes = np.isfinite(values)  # not at a dead position that rounding opens
        found = refined(travel, theta2[closes], values[closes])
        ends += [found.low, found.high]
    return np.array([min(ends), max(ends)])


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
        if any(
            name != _P and np.allclose(at, holes.get(_P, np.inf), atol=1e-9) for name, at in holes.items()
        ):
            del holes[_P]  # P is one of the joints
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
        (name, other, np.hypot(*(at - to))) for (other, to), (name, at) in combinations(holes.items(), 2)
    ]
    for pin, ends in slots.items():
        pairs += [(name, f"the slot of {pin}", _distance(at, ends)) for name, at in holes.items()]
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
