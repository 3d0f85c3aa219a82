"""Slides as slots: the pin of a slider runs in the base, that of a block in the rod."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
import shapely

from grashof.analysis import output_stroke, solve_position
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, ProblemError, SliderCrank
from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.errors import wrong_value
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.workshop.plates import Plate, PlateSizes, bar, link_plates, refuse_length, with_point

_SAMPLES = 361


def slot_ends(linkage: Linkage, ranges: Iterable[tuple[float, float]], sizes: PlateSizes) -> FloatArray:
    """First and last place of a pin in its slot, mm, shape (2,), half a clearance beyond its travel.

    Along the slide from O2, or along the rod from A.
    """
    turns = np.ravel(output_stroke(linkage).theta2) if isinstance(linkage, SliderCrank) else linkage.theta1
    found = []
    for low, high in ranges:
        inside = low + (np.ravel([turns, np.asarray(turns) + np.pi]) - low) % (2 * np.pi)
        theta2 = np.append(np.linspace(low, high, _SAMPLES), inside[inside <= high])
        found.append(solve_position(linkage, theta2).travel)
    every = np.concatenate(found)
    return np.array([np.nanmin(every) - sizes.gap / 2, np.nanmax(every) + sizes.gap / 2])


def moving_plates(linkage: Linkage, sizes: PlateSizes, slot: FloatArray) -> tuple[dict[str, Plate], str]:
    """Plates of the links that have one, and a note on P; see `link_plates`.

    Parameters
    ----------
    linkage : Linkage
        In mm.
    sizes : PlateSizes
    slot : ndarray, shape (2,), mm
        Of `slot_ends`.
    """
    if isinstance(linkage, SliderCrank):
        return _of_slider_crank(linkage, sizes)
    if isinstance(linkage, InvertedSliderCrank):
        return _of_inverted(linkage, sizes, slot)
    if isinstance(linkage, FourBar):
        return link_plates(linkage, sizes)
    raise wrong_value("linkage", linkage, f"one of {', '.join(ONE_LOOP)}")


def _of_slider_crank(linkage: SliderCrank, sizes: PlateSizes) -> tuple[dict[str, Plate], str]:
    u, v = linkage.coupler_point.tolist()
    r2, r3 = float(linkage.r2), float(linkage.r3)
    for name, length in (("r2", r2), ("r3", r3), ("A-P", max(abs(u), abs(u - r3), abs(v)))):
        refuse_length(name, length, sizes)
    driver, coupler = linkage.mechanism.links[1:3]
    rod, note = with_point(coupler, r3, u, v, sizes)
    return {driver.name: bar(driver.name, driver.labels, (0.0, r2), sizes), coupler.name: rod}, note


def _of_inverted(
    linkage: InvertedSliderCrank, sizes: PlateSizes, slot: FloatArray
) -> tuple[dict[str, Plate], str]:
    u, v = linkage.coupler_point.tolist()
    r2 = float(linkage.r2)
    ends = np.column_stack([slot, np.full(2, -float(linkage.offset))])
    reach = float(np.abs([u, v, *ends.ravel()]).max())
    for name, length in (("r1", float(linkage.r1)), ("r2", r2), ("A-P", reach)):
        refuse_length(name, length, sizes)
    driver, coupler = linkage.mechanism.links[1:3]
    _refuse_near("A", np.zeros(2), "the slot of O4", ends, sizes)
    near = min(float(np.hypot(u, v)), _distance(np.array([u, v]), ends))
    holes, note = {"A": np.zeros(2), "P": np.array([u, v])}, ""
    if near < sizes.least_spacing:
        note = f"the {coupler.name} has no hole for P: it lies {near:.4g} mm from A or the slot of O4, and "
        note += f"holes are at least {sizes.least_spacing:g} mm apart"
        del holes["P"]
    rod = slotted(coupler.name, holes, {"O4": ends}, sizes)
    return {driver.name: bar(driver.name, driver.labels, (0.0, r2), sizes), coupler.name: rod}, note


def guide(linkage: SliderCrank, along: Mapping[str, float], sizes: PlateSizes, slot: FloatArray) -> Plate:
    """The base of a slider-crank, x along its slide from O2: holes along x, and the slot of B."""
    ends = np.column_stack([slot, np.full(2, float(linkage.offset))])
    holes = {name: np.array([x, 0.0]) for name, x in along.items()}
    for name, hole in holes.items():
        _refuse_near(name, hole, "the slot of B", ends, sizes)
    return replace(slotted("base", holes, {"B": ends}, sizes), width=2 * sizes.width)


def slotted(
    name: str, holes: Mapping[str, FloatArray], slots: Mapping[str, FloatArray], sizes: PlateSizes
) -> Plate:
    """A plate round holes (x, y) and slots, each from one centre to another, shape (2, 2), mm."""
    centres = np.array(list(holes.values()))
    every = np.concatenate([centres, *slots.values()])
    return Plate(
        name,
        tuple(holes),
        frozen_array(centres),
        frozen_array(_hull(every)),
        sizes.width,
        sizes.hole,
        tuple((joint, frozen_array(ends)) for joint, ends in slots.items()),
    )


def _hull(points: FloatArray) -> FloatArray:
    """Corners of what surrounds points, counter-clockwise, shape (1, 2 or more, 2)."""
    hull = shapely.convex_hull(shapely.multipoints(points))
    corners: FloatArray = shapely.get_coordinates(shapely.orient_polygons(hull))
    return corners[:-1] if shapely.get_dimensions(hull) == 2 else corners


def _refuse_near(name: str, hole: FloatArray, what: str, ends: FloatArray, sizes: PlateSizes) -> None:
    near = _distance(hole, ends)
    if near < sizes.least_spacing:
        raise ProblemError(
            f"{name} comes within {near:.4g} mm of {what}; for width {sizes.width:g} and hole {sizes.hole:g} "
            f"mm it must stay at least {sizes.least_spacing:g} mm off"
        )


def _distance(point: FloatArray, ends: FloatArray) -> float:
    return float(shapely.distance(shapely.points(point), shapely.linestrings(ends)))
