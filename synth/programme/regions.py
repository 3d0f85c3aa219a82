"""Rows of the programme that keep joints in their regions."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import casadi as ca
import numpy as np

from grashof.problems import Region
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.programme.builder import Builder
from grashof.synth.programme.constraints import Positions, Symbols
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import MOST_SIDES, Form
from grashof.synth.programme.unknowns import INSET, Unknowns
from grashof.synth.quantities.convex import piece_about
from grashof.synth.quantities.regions import hull_rows
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.target_constraints import AtTarget


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


def require_pieces(build: Builder, places: Positions, limits: Sequence[AtTarget]) -> None:
    """A joint lies in a convex piece of its polygon at a single target, where that is concave."""
    for limit in limits:
        if (region := limit.concave) is not None:
            count = min(len(region.corners), MOST_SIDES)
            planes = build.parameter(partial(_piece, limit, region, count), 3 * count)
            at = getattr(places, limit.name)[limit.k]
            for plane in ca.vertsplit(planes, 3):
                build.require((limit.group,), plane[0] * at[0] + plane[1] * at[1] - plane[2])


def _piece(limit: AtTarget, region: Region, count: int, scaled: ScaledProblem, start: Start) -> FloatArray:
    """Half-planes about a joint at one target of a start."""
    here = region.moved(scaled.frame.origin, scaled.frame.scale)
    place = start.track["ab".index(limit.name)][limit.k]
    return _inset(piece_about(here, complex(place), count)).ravel()


def _inset(planes: FloatArray) -> FloatArray:
    """Half-planes moved inwards, so that rounding leaves no joint outside."""
    planes[..., 2] += np.where(planes[..., :2].any(axis=-1), INSET, 0.0)
    return planes


def _planes(name: str, count: int, scaled: ScaledProblem, start: Start) -> FloatArray:
    """Half-planes (nx, ny, c) about the places of a joint at a start, or the line of its segment."""
    region = scaled.wanted.regions[name]
    places = _at(name, scaled, start).tolist()
    if not count:
        rows = [(normal.real, normal.imag, limits[0]) for normal, limits in hull_rows(region)]
        return np.ravel(rows * len(places))
    return _inset(np.array([piece_about(region, each, count) for each in places])).ravel()


def _at(name: str, scaled: ScaledProblem, start: Start) -> ComplexArray:
    """Places of a joint at a start; for a moving one at the targets in the order of visit."""
    joint, _, on_body = name.partition("_")
    if on_body:
        first = start.carrying[start.visit.index(0)] + start.body_angle
        turn = first if scaled.motion is None else scaled.motion.first_turn
        return np.array([(getattr(start, joint) - start.p) * np.exp(-1j * turn)])
    track = dict(zip("ab", start.track[:2], strict=True))
    return track[joint] if joint in track else np.array([complex(getattr(start, joint))])
