"""The best cylinder of a linkage, of the greatest worst lever angle: in closed form or by search."""

from __future__ import annotations

from typing import Any

import numpy as np

from grashof.problems import Cylinder, CylinderSpec, Linkage
from grashof.problems.values.arrays import ComplexArray, FloatArray, Limits
from grashof.synth.cylinder.planes import Plane, Room, performance, planes_of
from grashof.synth.cylinder.search import best_by_search

_GREATEST = 1 - 1e-12  # sine of a lever angle of 90 deg, but for rounding: no other link has a better one
_GRID = 65  # bases along each side of their box
_AT_B = 1e-12  # share of the reach within which a pivot is B


def best_cylinder(
    linkage: Linkage,
    angles: tuple[FloatArray, FloatArray, FloatArray],
    spec: CylinderSpec,
    *,
    power: FloatArray | None = None,
    force: float = np.inf,
    rate: Limits = (0.0, np.inf),
    one_branch: bool = True,
) -> Cylinder | None:
    """The cylinder of the greatest worst lever angle within limits; None where none was found.

    For a single linkage whose theta2, theta3 and theta4 (M,) are samples of the task motion. A limit of the
    force, N, needs the power (M,) of a driver of link 2 at 1 rad/s, N length; limits of the rate are lengths
    for a radian of link 4. Without `one_branch` link 2 passes a dead position, so that it cannot be driven.
    """
    theta2, theta3, theta4 = map(np.unwrap, angles)
    limited, given = rate != (0.0, np.inf), power if np.isfinite(force) else None
    planes = planes_of(linkage, theta2, theta3, theta4, given, rates=limited)
    coupler = planes["coupler"]
    corners = [coupler.origin + c * coupler.axis for c in coupler.joints]
    around = np.concatenate([planes["driver"].origin, planes["output"].origin, *corners])
    theta = {"driver": theta2, "output": theta4}
    allowed = [on for on in spec.on if one_branch or on != "driver"]
    rooms = {on: Room.of(planes[on], spec, around, force, rate) for on in allowed}
    found = {on: _in_closed_form(planes[on], rooms[on], theta[on]) for on in allowed if on in theta}
    best = max((each[2] for each in found.values() if each is not None), default=0.0)
    for number, on in enumerate(spec.on):
        drives = on in allowed and (on not in theta or not _reverses(planes[on]))
        if drives and found.get(on) is None and best < _GREATEST:
            found[on] = best_by_search(planes[on], rooms[on], number)
    ranked = [(each[2], on, each) for on in allowed if (each := found.get(on)) is not None]
    if not ranked:
        return None
    _, on, (point, base, _) = max(ranked, key=lambda each: each[0])
    return Cylinder(on, (base.real, base.imag), (point.real, point.imag))


def _reverses(plane: Plane) -> bool:
    """Whether a link with a pivot or a slide on the ground reverses, and with it all cylinders on it."""
    way = plane.turn if plane.turn.any() else np.real(np.conj(plane.axis) * plane.slide)
    return bool(way.min() < 0 < way.max())


def _in_closed_form(plane: Plane, room: Room, theta: FloatArray) -> tuple[complex, complex, float] | None:
    """On link 2 or 4: the longest arm of the best angle; on a slider the point nearest to B."""
    along = np.real(np.conj(plane.axis[0]) * plane.origin)
    slides = not plane.turn.any()
    step = np.diff(along if slides else theta)
    if not ((step > 0).all() or (step < 0).all()):
        return None
    ends = complex(plane.origin[0]), complex(plane.origin[-1])
    pivots = (
        best_on_slide(*ends, complex(plane.axis[0]), room)
        if slides
        else best_on_arm(ends[0], float(theta[0]), float(theta[-1]), room)
    )
    if pivots is None:
        return None
    points, bases = room.kept(pivots[0] * (1 - 1e-9), pivots[1])  # rounding puts none beyond its limits
    found = performance(plane, points, bases)
    fine = np.flatnonzero((room.beyond(found) <= 0) & (found.least > 0))
    if not len(fine):
        return None
    first = fine[0]
    return complex(points[first]), complex(bases[first]), float(found.least[first])


def best_on_arm(
    pivot: complex, start: float, end: float, room: Room
) -> tuple[ComplexArray, ComplexArray] | None:
    """Points (K,) of a link about a pivot, and bases (K,), of cylinders of the best possible lever angle.

    Those of the longest arm come first; None where the limits allow none. The link turns from start to end,
    rad. Over a range R of the arm the worst angle between cylinder and arm is at most 90 deg - R / 2, reached
    by every base C on the line through the ends of the way of the point Q, outside them: the angle in
    between is greater. With d = |O2 C|, the arm q and s = sin(R / 2) the closed length L follows from
    d^2 = L^2 + 2 L q s + q^2, and the stroke is 2 q s.
    """
    half = abs(end - start) / 2
    sine, cosine = np.sin(half), np.cos(half)
    if not 0 < half < np.pi / 2:
        return None
    base = _bases(room)
    far = np.abs(base - pivot)
    per_stroke = 2 * sine / (room.ratio - 1)
    most = np.minimum(far / np.sqrt(1 + per_stroke**2 + 2 * per_stroke * sine), room.reach)
    most = np.minimum(most, _arm(far, room.closed[0], sine, cosine))
    longest = min(room.closed[1], float(far.max()))
    least = np.where(far > longest, _arm(far, longest, sine, cosine), 0.0)
    fine = (most >= least) & (most > 1e-6 * room.reach)
    if not fine.any():
        return None
    arm, base, far = most[fine], base[fine], far[fine]
    order = np.lexsort((far, -np.round(arm / room.reach, 9)))[:8]
    arm, base, far = arm[order], base[order], far[order]
    sense = np.sign(end - start)
    along = np.sqrt(np.maximum(far**2 - (arm * cosine) ** 2, 0.0))
    points, bases = [], []
    for side in (1, -1):  # lengthens, shortens from start to end
        middle = np.angle(base - pivot) + side * sense * np.arctan2(along, arm * cosine)
        points.append(arm * np.exp(1j * (middle - (start + end) / 2)))
        bases.append(base)
    return np.concatenate(points), np.concatenate(bases)


def best_on_slide(
    first: complex, last: complex, along: complex, room: Room
) -> tuple[ComplexArray, ComplexArray] | None:
    """Points (K,) of a slider and bases (K,) of cylinders in line with its slide: the lever angle is 90 deg.

    Those come first whose cylinder passes closest to B, and of those the shortest; None where the limits
    allow none. B goes from first to last; `along` is the unit vector of the slide, and of u of the slider.
    The stroke S is that of the slider, so that a closed length L opens to (L + S) / L. A base beside the line
    of B has the point as far beside B; along the slide the point is where L needs it, at best in B.
    """
    low, high = sorted((_along(along, first), _along(along, last)))
    least, most = max(room.closed[0], (high - low) / (room.ratio - 1)), room.closed[1]
    if least > most:
        return None
    base = np.concatenate([_bases(room), _on_line(first, along, (low, high), least, room)])
    at, beside = _along(along, base), np.imag(np.conj(along) * (base - first))
    behind, ahead = np.clip(low - at, least, most), np.clip(at - high, least, most)
    shifts = np.concatenate([at + behind - low, at - ahead - high])
    points = shifts + 1j * np.tile(beside, 2)
    length = np.concatenate([behind, ahead])
    fine = np.flatnonzero(np.abs(points) <= room.reach)
    if not len(fine):
        return None
    order = fine[np.lexsort((length[fine], np.round(np.abs(points[fine]) / room.reach, 9)))[:8]]
    points = points[order]
    return np.where(np.abs(points) > _AT_B * room.reach, points, 0.0), np.tile(base, 2)[order]


def _bases(room: Room) -> ComplexArray:
    """A grid of bases over their box."""
    sides = zip(room.low, room.high, strict=True)
    axes = [np.linspace(low, high, _GRID if high > low else 1) for low, high in sides]
    base: ComplexArray = np.add.outer(axes[0], 1j * axes[1]).ravel()
    return base


def _on_line(
    first: complex, along: complex, travel: tuple[float, float], least: float, room: Room
) -> ComplexArray:
    """Bases in their box on the line of B: all over it, and those of the shortest cylinders at B."""
    start, end = -np.inf, np.inf
    for low, high, place, slope in zip(
        room.low, room.high, (first.real, first.imag), (along.real, along.imag), strict=True
    ):
        if slope != 0:
            one, other = sorted(((low - place) / slope, (high - place) / slope))
            start, end = max(start, one), min(end, other)
        elif not low <= place <= high:
            end = -np.inf
    if not start <= end:
        return np.zeros(0, dtype=complex)
    from_first = np.array([travel[0] - least, travel[1] + least]) - _along(along, first)
    nearest = np.clip(from_first, start, end)
    line: ComplexArray = first + along * np.concatenate([np.linspace(start, end, _GRID), nearest])
    return line


def _along(along: complex, place: Any) -> Any:
    """Coordinates of places along a direction."""
    return np.real(np.conj(along) * place)


def _arm(far: FloatArray, length: float, sine: float, cosine: float) -> FloatArray:
    """The arm at which a closed cylinder has a given length; negative where there is none."""
    square = (far - length * cosine) * (far + length * cosine)
    return np.where(square >= 0, np.sqrt(np.maximum(square, 0.0)) - length * sine, -1.0)
