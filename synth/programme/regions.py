"""Rows of the programme that keep joints in their regions."""

from __future__ import annotations

from functools import lru_cache, partial

import casadi as ca
import numpy as np
import shapely

from grashof.problems import Region
from grashof.problems.values.areas import shape
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.programme.builder import Builder
from grashof.synth.programme.constraints import Positions, Symbols
from grashof.synth.programme.free_region import EVERY_PLANE, half_planes
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import Form
from grashof.synth.programme.unknowns import INSET, Unknowns
from grashof.synth.quantities.regions import hull_rows, nearest
from grashof.synth.quantities.scaled_problem import ScaledProblem


def require_regions(build: Builder, form: Form, x: Unknowns, places: Positions) -> None:
    """Each joint, at every target, lies in a convex piece of its polygon, or on its line.

    A segment is a row with one value, and the bounds of the box around it.
    """
    design = Symbols(form, x, places)
    for name, count in form.regions:
        across, up = (ca.vec(ca.SX(part.of(design))) for part in form.formulas[LIMITS[name].quantity.key])
        lines = max(count, 1)
        planes = build.parameter(partial(_planes, name, count), 3 * lines * across.numel())
        for k, plane in enumerate(ca.vertsplit(planes, 3)):
            beyond = plane[0] * across[k // lines] + plane[1] * up[k // lines] - plane[2]
            if count:
                build.require((name,), beyond)
            elif build.slack is None:
                build.zero(beyond)
            else:
                build.require((name,), beyond, -beyond)


def _planes(name: str, count: int, scaled: ScaledProblem, start: Start) -> FloatArray:
    """Half-planes (nx, ny, c) about the places of a joint at a start, or the line of its segment."""
    region = scaled.wanted.regions[name]
    found = [plane for each in _at(name, scaled, start).tolist() for plane in _about(region, each, count)]
    return np.ravel(found)


def _about(region: Region, point: complex, count: int) -> FloatArray:
    """Half-planes (`count`, 3) about a point whose intersection is a convex piece of a polygon."""
    rows = [(normal.real, normal.imag, limits[0]) for normal, limits in hull_rows(region)]
    if not count:
        return np.array(rows)
    planes = np.tile(EVERY_PLANE, (count, 1))
    if is_convex(region):
        planes[: len(rows)] = rows[:count]
    else:
        inside = nearest(region, np.array(point)).item()
        planes = half_planes(_beyond(region), inside, count)
    more = np.where(planes[:, :2].any(axis=1), INSET, 0.0)
    planes[:, 2] += more
    return planes


@lru_cache(maxsize=64)
def is_convex(region: Region) -> bool:
    """Whether a polygon is its own convex hull."""
    made = shape(region.corners, is_line=region.on is not None)
    area, around = shapely.area(made), shapely.area(shapely.convex_hull(made))
    return bool(around - area <= 1e-12 * around)


@lru_cache(maxsize=64)
def _beyond(region: Region) -> shapely.Geometry:
    """The enlarged box around a region, less the region."""
    (left, right), (low, high) = region.x, region.y
    room = max(right - left, high - low)
    around = shapely.box(left - room, low - room, right + room, high + room)
    left_over = shapely.difference(around, shape(region.corners, is_line=region.on is not None))
    shapely.prepare(left_over)
    return left_over


def _at(name: str, scaled: ScaledProblem, start: Start) -> ComplexArray:
    """Places of a joint at a start; for a moving one at the targets in the order of visit."""
    joint, _, on_body = name.partition("_")
    if on_body:
        first = start.carrying[start.visit.index(0)] + start.body_angle
        turn = first if scaled.motion is None else scaled.motion.first_turn
        return np.array([(getattr(start, joint) - start.p) * np.exp(-1j * turn)])
    track = dict(zip("ab", start.track[:2], strict=True))
    return track[joint] if joint in track else np.array([complex(getattr(start, joint))])
