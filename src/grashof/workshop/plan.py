"""A linkage as parts: plates, spacers and pins, each with its layers, ready to be drawn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis import full_rotation, solve_position
from grashof.analysis.mechanism.position import places
from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import positive_number
from grashof.workshop.link_plates import Slot, base_angle, base_plate, link_plates, slots_of
from grashof.workshop.plates import Plate, PlateSizes, spacer
from grashof.workshop.stacking import GROUND, Pin, Stack, pinned, placed, poses, ranges_of_use, stack, sweep

_MOST_MET = 8  # pairs that notes name
_RETURN_CRANK = "the driver is in two plates: both are fixed to pin {}, which turns with them"


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A part cut from the sheet, and where each copy of it goes.

    Parameters
    ----------
    plate : Plate
    layers : tuple of int
        Of each copy.
    places : ndarray, shape (n, 3)
        Of each copy in the assembly: x and y of its origin in mm from O2, and its angle in rad.
    """

    plate: Plate
    layers: tuple[int, ...]
    places: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """All parts of a linkage.

    Parameters
    ----------
    sizes : PlateSizes
    parts : tuple of Part
        Base, the links that are plates, and spacers if there are any.
    pins : tuple of Pin
    layers : int
        How many, with those of the bases.
    theta2 : float, rad
        Driver angle of the assembly.
    joints : dict of str to pair of float, mm
        The points of the linkage in the assembly, from O2.
    notes : tuple of str
        Notes for the workshop.
    """

    sizes: PlateSizes
    parts: tuple[Part, ...]
    pins: tuple[Pin, ...]
    layers: int
    theta2: float
    joints: dict[str, tuple[float, float]]
    notes: tuple[str, ...]

    def pin_length(self, pin: Pin) -> float:
        """Length of a pin from the outer face of its first plate to that of its last one, mm."""
        return (pin.high - pin.low + 1) * self.sizes.thickness

    def rows(self) -> list[tuple[str, ...]]:
        """The parts list, its heading first."""
        thick, hole = f"{self.sizes.thickness:g}", self.sizes.hole
        rows: list[tuple[str, ...]] = [("part", "count", "layer", "thickness mm", "between holes mm")]
        for part in self.parts:
            layers = ", ".join(str(layer) for layer in sorted(set(part.layers)))
            distances = ", ".join(
                f"{joints} {round(length, 3):.10g}" for joints, length in part.plate.distances
            )
            rows.append((part.plate.name, str(len(part.layers)), layers, thick, distances or "-"))
        for pin in self.pins:
            about = f"diameter {hole:g}, length {self.pin_length(pin):g}"
            rows.append((pin.title, "1", f"{pin.low} to {pin.high}", "-", about))
        return rows


def plan_parts(
    linkage: Linkage,
    sizes: PlateSizes | None = None,
    mm_per_unit: float = 1.0,
    *,
    within: tuple[float, float] | None = None,
    theta2: float | None = None,
) -> Plan:
    """Parts of a linkage, on as few layers as let it move freely.

    Parameters
    ----------
    linkage : Linkage
        One linkage.
    sizes : PlateSizes, optional
    mm_per_unit : float
        Millimetres of the plates for one unit of the linkage, times the scale.
    within : pair of float, rad, optional
        Range of driver angles used; by default a full turn, or all between dead positions.
    theta2 : float, rad, optional
        Driver angle of the assembly; by default a quarter into the motion. Of a linkage with two ranges
        between dead positions, only that of this angle is used.

    Returns
    -------
    Plan

    Raises
    ------
    ProblemError
        A batch, a link too short for the width, or angles at which the linkage cannot be assembled.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(100, 0), r2=30, r3=90, r4=80)
    >>> [(part.plate.name, part.layers) for part in plan_parts(crank_rocker).parts]
    [('base', (0,)), ('driver', (1,)), ('coupler', (2,)), ('output', (1,))]
    """
    sizes = sizes or PlateSizes()
    if linkage.shape:
        raise ProblemError(f"linkage is a batch of shape {linkage.shape}; it must be a single one")
    scaled = linkage.scaled(positive_number(mm_per_unit, "mm_per_unit"), linkage.o2)
    if not scaled.mechanism.slides:
        link_plates(scaled, sizes, ())  # refuse short links before open linkages
    ranges = ranges_of_use(scaled, within, theta2)
    slots = slots_of(scaled, ranges, sizes)
    plates, without_hole = link_plates(scaled, sizes, slots)
    order = stack(plates, scaled, sweep(scaled, ranges, sizes.gap), sizes)
    low, high = ranges[0]
    if theta2 is None or (theta2 - low) % (2 * np.pi) > high - low:
        theta2 = low + (high - low) / 4
    return Plan(
        sizes=sizes,
        parts=_parts(plates, order, scaled, sizes, theta2, slots),
        pins=order.pins,
        layers=max(order.layers.values()) + len(order.bases),
        theta2=theta2,
        joints=_joints(scaled, theta2),
        notes=(
            _use(scaled, ranges, within),
            "pins end flush with their outer plates; their lengths leave nothing for heads or rings",
            *(_slot_note(scaled, slot) for slot in slots),
            *_two_bases(order, scaled),
            *([_RETURN_CRANK.format(order.crank.pin)] if order.crank is not None else []),
            *without_hole,
        ),
    )


def _parts(
    plates: dict[str, Plate],
    order: Stack,
    linkage: Linkage,
    sizes: PlateSizes,
    theta2: float,
    slots: tuple[Slot, ...],
) -> tuple[Part, ...]:
    at = poses(linkage, np.array([theta2]))
    at, plates = (order.crank.placed(at), order.crank.plates) if order.crank else (at, plates)
    where = {name: place[0] for name, place in at.items()}
    on_base = np.array([0.0, 0.0, base_angle(linkage)])
    posts = {f"post {number}": np.array([x, 0.0]) for number, x in enumerate(order.posts, start=1)}
    below = base_plate(linkage, posts, sizes, slots)
    parts = [Part(below, order.bases, np.tile(on_base, (len(order.bases), 1)))]
    where |= {name: np.append(placed(at[None], on_base)[0], 0.0) for name, at in posts.items()}
    parts += [Part(plate, (order.layers[name],), where[name][None]) for name, plate in plates.items()]
    rings = [(layer, where[pin.name]) for pin in order.pins for layer in pin.passed]
    if rings:
        layers, there = zip(*rings, strict=True)
        parts.append(Part(spacer(sizes), layers, np.array(there)))
    return tuple(parts)


def _joints(linkage: Linkage, theta2: float) -> dict[str, tuple[float, float]]:
    points = places(linkage, solve_position(linkage, theta2))
    order = dict.fromkeys((*linkage.mechanism.joints, *linkage.mechanism.points))
    return {name.upper(): (float(points[name][0]), float(points[name][1])) for name in order}


def _use(
    linkage: Linkage, ranges: tuple[tuple[float, float], ...], within: tuple[float, float] | None
) -> str:
    """The motion over which nothing meets."""
    if within is None and full_rotation(linkage):
        return "free over the full turn of the driver"
    spans = " and ".join(f"{low:.1f} to {high:.1f}" for low, high in np.degrees(ranges))
    return f"free for theta2 = {spans} deg" + ("" if within else ", between the dead positions")


def _slot_note(linkage: Linkage, slot: Slot) -> str:
    links = linkage.mechanism.links
    plate = "base" if slot.link == 1 else links[slot.link - 1].name
    long = f"{round(slot.length, 3):.10g} mm between centres"
    return f"the {links[slot.slider - 1].name} is pin {slot.pin} itself, in a slot of the {plate} {long}"


def _two_bases(order: Stack, linkage: Linkage) -> list[str]:
    if not order.posts:
        return []
    ground = [name for name, parts in pinned(linkage.mechanism).items() if GROUND in parts]
    upper = " and ".join(pin.name for pin in order.pins if pin.name in ground and pin.high == order.bases[1])
    more = len(order.met) - _MOST_MET
    return [
        f"a second base carries {upper} from the other side; on one base",
        *(f"- {pair}" for pair in order.met[:_MOST_MET]),
        *([f"- and {more} more pairs"] if more > 0 else []),
    ]
