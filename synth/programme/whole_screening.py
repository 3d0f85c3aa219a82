"""Violations that need the full problem: areas and limits of the motion, the user's constraints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.loop.dyad import coupler_of
from grashof.synth.programme.user_functions import FAR, own_violations
from grashof.synth.quantities.along_motion import ALONG, allowed_along, along_motion, unit_along
from grashof.synth.quantities.kind import Kind
from grashof.synth.quantities.regions import outside
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import GROUPS, Screened, depth_in, inside, points_kept_out
from grashof.synth.quantities.target_constraints import design_of
from grashof.synth.quantities.wanted_torque import DEVIATIONS

# Driver angles, the targets' ends among them, and places along a link or a side of the body: of all linkages,
# and of those that seem to be clear. A narrow area may lie between samples.
_COARSE = 13, np.linspace(0, 1, 6)[1:-1]
_FINE = 61, np.linspace(0, 1, 13)[1:-1]
_ROWS = 4000  # linkages at a time


def fully_screened(scaled: ScaledProblem, linkages: Screened) -> Screened:
    """Screened linkages with these violations added."""
    wanted = scaled.wanted
    along = [name for name in wanted.limited if LIMITS[name].quantity.key in (*ALONG, *DEVIATIONS)]
    if not len(linkages) or not (along or wanted.size or scaled.every_constraint or wanted.keep_out):
        return linkages
    violations = linkages.violations.copy()
    if wanted.keep_out:
        sound = linkages.feasible  # the others need no closer look
        violations[sound, GROUPS.index("keep_out")] = depth_on_the_way(scaled, linkages[sound])
    if wanted.size is not None:
        size = _sizes(linkages, len(scaled.kind.linkage.mechanism.ground))
        low, high = wanted.size
        violations[:, GROUPS.index("size")] = np.maximum(np.maximum(low - size, size - high), 0.0)
    for name in along:
        violations[:, GROUPS.index(name)] = _beyond(scaled, linkages, name)
    if scaled.constraints:
        violations[:, GROUPS.index("constraints")] += own_violations(scaled, linkages, scaled.constraints)
    if scaled.at_targets:
        violations[:, GROUPS.index("at")] += _missed_at(scaled, linkages)
    return replace(linkages, violations=violations)


def _missed_at(scaled: ScaledProblem, linkages: Screened) -> FloatArray:
    """Excess over limits at single targets, (n,)."""
    o2, o4, _, b, _ = linkages.points.T
    at_o2, at_o4 = (scaled.frame.outward(pivot).T for pivot in (o2, o4))
    a, at_b, p = (list(track.transpose(1, 2, 0)) for track in scaled.frame.outward(linkages.track))
    slide = scaled.kind.theta1_of(o2, o4, b) - np.pi / 2
    with np.errstate(all="ignore"):
        design = design_of(scaled.kind.dyad, at_o2, at_o4, slide, a, at_b, p, linkages.theta2.T)
        over = [row for limit in scaled.at_targets for row in limit(design)]
        over += [
            outside(region, *getattr(design, limit.name)[limit.k]) / limit.size
            for limit in scaled.at_targets
            if (region := limit.concave) is not None
        ]
    missed: FloatArray = np.minimum(np.nan_to_num(np.maximum(over, 0.0), nan=1.0), FAR).sum(axis=0)
    return missed


def _sizes(linkages: Screened, ground: int) -> FloatArray:
    """Diagonals of boxes around the pivots and the coupler point at all targets, shape (n,), sizes."""
    places = np.concatenate([linkages.points[:, :ground], *linkages.track], axis=1)
    diagonal: FloatArray = np.hypot(np.ptp(places.real, axis=1), np.ptp(places.imag, axis=1))
    return diagonal


def _beyond(scaled: ScaledProblem, linkages: Screened, name: str) -> FloatArray:
    """Excess of the greatest magnitude over its limit, as a share of it; (n,)."""
    quantity = LIMITS[name].quantity
    low, high = allowed_along(scaled.wanted, quantity.key)
    ways = linkages.theta2, linkages.direction, linkages.assembly
    value = along_motion(scaled, quantity.key, linkages.points, *ways) * unit_along(scaled, quantity.key)
    share = np.maximum(low - value, value - high) / (high if np.isfinite(high) else max(low, 1.0))
    amount: FloatArray = np.maximum(np.nan_to_num(share, posinf=FAR), 0.0)
    return amount


def depth_on_the_way(scaled: ScaledProblem, linkages: Screened) -> FloatArray:
    """Greatest depth (n,), sizes, inside areas kept out, over sampled angles; the judge is more precise."""
    deepest = _depth(scaled, linkages, *_COARSE)
    clear = deepest == 0
    deepest[clear] = _depth(scaled, linkages[clear], *_FINE)
    return deepest


def _depth(scaled: ScaledProblem, linkages: Screened, samples: int, along: FloatArray) -> FloatArray:
    """The same over a number of driver angles, at these shares of links and of the sides of the body."""
    wanted = scaled.wanted
    kind = scaled.kind.linkage.mechanism
    names = [name for name in points_kept_out(wanted) if name in kind.moving]
    links, body = "links" in wanted.keep_out_for, _body(scaled)
    deepest = np.zeros(len(linkages))
    for begin in range(0, len(linkages) if names or len(body) else 0, _ROWS):
        rows = slice(begin, begin + _ROWS)
        places = _places(scaled.kind, linkages[rows], samples)
        tracks = [places[name] for name in names]
        if links:
            for one, other in (line for link in kind.links[1:] for line in link.lines):
                tracks += [places[one] + share * (places[other] - places[one]) for share in along]
        if len(body):
            turned = (places["b"] - places["a"]) * np.exp(1j * _from_coupler(scaled, linkages[rows]))[:, None]
            with np.errstate(invalid="ignore"):
                turned /= np.abs(turned)
            tracks += [places["p"] + turned * point for point in _around(body, along)]
        track = np.concatenate(tracks, axis=1)
        deepest[rows] = _deepest(partial(inside, wanted), track)
        if len(body):
            corners = np.concatenate(wanted.keep_out) @ np.array([1, 1j])
            seen = [(corner - places["p"]) * turned.conj() for corner in corners]  # from the body
            within = _deepest(partial(_inside_body, body), np.concatenate(seen, axis=1))
            deepest[rows] = np.maximum(deepest[rows], within)
    return deepest


def _deepest(depth: Callable[[ComplexArray], FloatArray], track: ComplexArray) -> FloatArray:
    """Greatest depth (n,) of places (n, k), without those where a linkage does not close."""
    closed = np.isfinite(track)
    greatest: FloatArray = np.where(closed, depth(np.where(closed, track, 0.0)), 0.0).max(axis=1)
    return greatest


def _inside_body(body: ComplexArray, points: ComplexArray) -> FloatArray:
    """Depth of points (...) inside the body, in its frame."""
    from grashof.problems.values.areas import shape  # imports shapely, as few problems need it

    return depth_in(shape(np.column_stack([body.real, body.imag]), is_line=False), points)


def _body(scaled: ScaledProblem) -> ComplexArray:
    """Corners of the body, in its frame, where it must keep out of areas; else none."""
    outline = scaled.problem.task.body
    if "body" not in scaled.wanted.keep_out_for or outline is None:
        return np.zeros(0, dtype=np.complex128)
    corners: ComplexArray = outline @ np.array([1, 1j]) / scaled.frame.scale
    return corners


def _around(body: ComplexArray, along: FloatArray) -> ComplexArray:
    """Corners of the body, and points at these shares of its sides."""
    side = np.roll(body, -1) - body
    points: ComplexArray = (body[:, None] + np.append(0.0, along) * side[:, None]).ravel()
    return points


def _from_coupler(scaled: ScaledProblem, linkages: Screened) -> FloatArray:
    """From the direction of AB to that of the body, shape (n,), rad."""
    if scaled.motion is None:
        return linkages.body_angle
    _, _, a, b, _ = linkages.points.T
    turn: FloatArray = scaled.motion.first_turn - np.angle(b - a)
    return turn


def _places(kind: Kind, linkages: Screened, samples: int) -> dict[str, ComplexArray]:
    """Pivots and coupler point at sampled driver angles, each shape (n, samples)."""
    o2, o4 = linkages.points.T[:2, :, None]
    ground, lengths, arm = kind.sides(linkages.points[:, None])
    theta2, assembly = linkages.theta2, linkages.assembly
    share = (1 - np.cos(np.linspace(0, np.pi, samples))) / 2  # closer towards the ends, which touch areas
    angle = theta2[:, :1] + (theta2[:, -1:] - theta2[:, :1]) * share
    crank = lengths[1] * np.exp(1j * angle)
    _, _, r3, r4 = lengths
    coupler, along = coupler_of(kind.dyad, ground, crank, r3, r4, assembly[:, None])
    at_a, fixed = o2 + crank, np.ones_like(crank)
    return {"o2": o2 * fixed, "o4": o4 * fixed, "a": at_a, "b": at_a + coupler, "p": at_a + arm * along}
