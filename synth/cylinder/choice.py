"""The best cylinder of a linkage: that of the greatest worst lever angle on any link that it may act on."""

from __future__ import annotations

import numpy as np

from grashof.problems import Cylinder, CylinderSpec, Linkage
from grashof.problems.values.arrays import FloatArray
from grashof.synth.cylinder.closed_form import best_on_arm, best_on_slide
from grashof.synth.cylinder.planes import Plane, Room, performance, planes_of
from grashof.synth.cylinder.search import best_by_search

_GREATEST = 1 - 1e-12  # sine of a lever angle of 90 deg, but for rounding: no other link has a better one


def best_cylinder(
    linkage: Linkage,
    angles: tuple[FloatArray, FloatArray, FloatArray],
    spec: CylinderSpec,
    *,
    power: FloatArray | None = None,
    force: float = np.inf,
    one_branch: bool = True,
    effort: float = 1.0,
) -> Cylinder | None:
    """The cylinder of the greatest worst lever angle within limits; None where none was found.

    Of a single linkage whose theta2, theta3 and theta4 (M,) are samples of the task motion. A limit of the
    force, N, needs the power (M,) of a driver of link 2 at 1 rad/s, N length. Without `one_branch` link 2
    passes a dead position, so that it cannot be driven. The effort multiplies the samples of a search.
    """
    theta2, theta3, theta4 = map(np.unwrap, angles)
    planes = planes_of(linkage, theta2, theta3, theta4, power if np.isfinite(force) else None)
    coupler = planes["coupler"]
    corners = [coupler.origin + c * coupler.axis for c in coupler.joints]
    around = np.concatenate([planes["driver"].origin, planes["output"].origin, *corners])
    theta = {"driver": theta2, "output": theta4}
    allowed = [on for on in spec.on if one_branch or on != "driver"]
    rooms = {on: Room.of(planes[on], spec, around, force) for on in allowed}
    found = {on: _in_closed_form(planes[on], rooms[on], theta[on]) for on in allowed if on in theta}
    best = max((each[2] for each in found.values() if each is not None), default=0.0)
    for number, on in enumerate(spec.on):
        drives = on in allowed and (on not in theta or not _reverses(planes[on]))
        if drives and found.get(on) is None and best < _GREATEST:
            found[on] = best_by_search(planes[on], rooms[on], number, effort)
    ranked = [(each[2], on, each) for on in allowed if (each := found.get(on)) is not None]
    if not ranked:
        return None
    _, on, (point, base, _) = max(ranked, key=lambda each: each[0])
    return Cylinder(on, (base.real, base.imag), (point.real, point.imag))


def _reverses(plane: Plane) -> bool:
    """Whether a link with a pivot or a slide on the ground turns back, and with it all cylinders on it."""
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
