"""Depth to which the parts of a linkage reach into areas that are kept out."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias, cast

import numpy as np
import shapely
from numpy.typing import NDArray

from grashof.analysis.judge.meeting.task_motion import Targets, TaskMotion
from grashof.analysis.judge.verdict import Defect
from grashof.analysis.mechanism.even_motion import closer_at_ends
from grashof.analysis.mechanism.position import places, solve_position
from grashof.problems import Linkage, Requirements, Task
from grashof.problems.values.areas import solid
from grashof.problems.values.arrays import ComplexArray, FloatArray, IntArray

_SAMPLES = 541
_ALONG = 33  # samples along the piece of a link that lies inside
_PEAKS = 3  # of the depth over the motion that are refined
_ROUNDS, _NEARBY = 18, np.linspace(-1, 1, 7)  # each three times as close
SLACK = 1e-9  # sizes: rounding
_ROUGH = 5  # rounds along a link, while looking for the driver angles where it reaches deepest

DepthAt: TypeAlias = Callable[[FloatArray, int], FloatArray]  # by driver angles (n,) and rounds


@dataclass(frozen=True, slots=True)
class Area:
    """Polygons as one solid, and the sides of its boundary from `begin` to `end`, complex, shape (E,)."""

    solid: shapely.Geometry
    begin: ComplexArray
    end: ComplexArray

    @classmethod
    def of(cls, polygons: Sequence[FloatArray]) -> Area:
        """The area that polygons cover."""
        covered = solid(polygons)
        rings = shapely.get_rings(shapely.get_parts(covered))
        corners, ring = shapely.get_coordinates(rings, return_index=True)
        corner = corners @ np.array([1, 1j])
        same = ring[:-1] == ring[1:]
        return cls(covered, corner[:-1][same], corner[1:][same])

    def from_boundary(self, points: ComplexArray) -> FloatArray:
        """Distance of complex points, shape (...), from the boundary."""
        along = self.end - self.begin
        offset = points[..., None] - self.begin
        share = np.clip((offset * along.conj()).real / np.abs(along) ** 2, 0, 1)
        nearest: FloatArray = np.abs(offset - share * along).min(axis=-1)
        return nearest


def depth(area: Area, points: FloatArray) -> FloatArray:
    """Depth (...) of points (..., 2): their distance from the boundary, less than zero outside."""
    x, y = points[..., 0], points[..., 1]
    away = area.from_boundary(x + 1j * y)
    return np.where(shapely.contains_xy(area.solid, x, y), away, 0.0 - away)


def segment_depth(area: Area, begin: FloatArray, end: FloatArray, rounds: int = 18) -> FloatArray:
    """Depth of the deepest point of each segment (n, 2) inside an area, as `depth` gives it.

    The part inside is cut out exactly, so that no shallow corner is overlooked, and sampled, in each of
    `rounds` three times as close about the deepest.
    """
    deepest: FloatArray = np.maximum(depth(area, begin), depth(area, end))
    long = np.flatnonzero((begin != end).any(axis=1))
    segment = cast("NDArray[np.object_]", shapely.linestrings(np.stack([begin, end], axis=1)[long]))
    apart = shapely.distance(area.solid, segment)
    deepest[long] = np.where(apart > 0, -apart, np.maximum(deepest[long], 0.0))
    crossing = apart == 0
    part, index = shapely.get_parts(shapely.intersection(segment[crossing], area.solid), return_index=True)
    lines = (shapely.get_type_id(part) == shapely.GeometryType.LINESTRING) & ~shapely.is_empty(part)
    ends = shapely.get_coordinates(part[lines]).reshape(-1, 2, 2) @ np.array([1, 1j])
    np.maximum.at(deepest, long[crossing][index[lines]], _deepest_along(area, ends, rounds))
    return deepest


def parts_inside(
    linkage: Linkage, task: Task, wanted: Requirements, targets: Targets, motion: TaskMotion, *, joined: bool
) -> Iterator[Defect]:
    """A defect for each part that lies in an area kept out."""
    for part, deep in intrusions(linkage, task, wanted, targets, motion, joined=joined).items():
        yield Defect("keep_out", f"the depth of {part} inside", deep, "0", deep / task.size)


def intrusions(
    linkage: Linkage,
    task: Task,
    wanted: Requirements,
    targets: Targets,
    motion: TaskMotion,
    *,
    joined: bool,
) -> dict[str, float]:
    """The greatest depth (length) of each part that reaches into an area kept out, as "O2" or "link AB".

    Over the motion, or at the targets alone where none joins them. Samples are closer towards its ends,
    where near a dead position the linkage runs away from the driver, and ever closer about the deepest, also
    where none of the first lies inside.
    """
    area, assembly = Area.of(wanted.keep_out), targets.assembly[:1] if joined else targets.assembly

    def over(at: DepthAt) -> float:
        return (
            _deepest_over(at, motion.start, motion.end)
            if joined
            else float(at(targets.theta2, _ROUNDS).max())
        )

    deepest, parts = dict[str, float](), dict[str, tuple[str, ...]]()
    for name in wanted.keep_out_for:
        if name == "body" and task.body is not None:
            deepest["the body"] = over(_body_depth(area, linkage, task.body, assembly))
        elif name == "links":
            parts |= _lines(linkage)
        elif name in linkage.mechanism.points:  # not O4 of a slider-crank
            parts[name.upper()] = (name,)
    for part, ends in parts.items():
        if set(ends) <= set(linkage.mechanism.ground):
            deepest[part] = float(depth(area, getattr(linkage, ends[0])))
        else:
            deepest[part] = over(_depth_of(area, linkage, ends, assembly))
    return {part: found for part, found in deepest.items() if found > SLACK * task.size}


def _lines(linkage: Linkage) -> dict[str, tuple[str, ...]]:
    """The links, then the lines to the coupler point, by name; the ends of each."""
    joined = {*linkage.mechanism.joints, "b"}
    named = {
        f"{'link' if joined >= set(ends) else 'line'} {''.join(ends).upper()}": ends
        for link in linkage.mechanism.links[1:]
        for ends in link.lines
    }
    if (3, 4) in linkage.mechanism.slides:  # the rod reaches to its block
        named["link AB"] = ("a", "b")
    return dict(sorted(named.items(), key=lambda part: part[0].startswith("line")))


def _depth_of(area: Area, linkage: Linkage, ends: tuple[str, ...], assembly: IntArray) -> DepthAt:
    """Depth of a point, or of the link between two, by driver angles of shape (n,) and rounds."""

    def at(theta2: FloatArray, rounds: int) -> FloatArray:
        where = places(linkage, solve_position(linkage, theta2, assembly))
        begin, end = where[ends[0]], where[ends[-1]]
        found = np.full(len(theta2), -np.inf)
        closed = np.isfinite(begin + end).all(axis=-1)
        begin, end, one = begin[closed], end[closed], len(ends) == 1
        found[closed] = depth(area, begin) if one else segment_depth(area, begin, end, rounds)
        return found

    return at


def _body_depth(area: Area, linkage: Linkage, outline: FloatArray, assembly: IntArray) -> DepthAt:
    """Depth of the body's closed outline in an area, or of an area's corners in the body."""
    corner = outline @ np.array([1, 1j])
    body = Area.of([outline]) if len(outline) > 2 else None

    def at(theta2: FloatArray, rounds: int) -> FloatArray:
        state = solve_position(linkage, theta2, assembly)
        p, turn = state.p @ np.array([1, 1j]), np.exp(1j * (state.carrying + linkage.body_angle))
        found, closed = np.full(len(theta2), -np.inf), np.isfinite(p + turn)
        p, turn = p[closed, None], turn[closed, None]
        begin = p + turn * corner
        a, b = (
            np.stack([each.real, each.imag], axis=-1).reshape(-1, 2)
            for each in (begin, np.roll(begin, -1, axis=1))
        )
        sides = segment_depth(area, a, b, rounds)
        found[closed] = sides.reshape(begin.shape).max(axis=1)
        if body is not None:  # an area may lie wholly inside the body
            held = (area.begin - p) / turn
            within = depth(body, np.stack([held.real, held.imag], axis=-1)).max(axis=1)
            found[closed] = np.maximum(found[closed], within)
        return found

    return at


def _deepest_over(at: DepthAt, start: float, end: float) -> float:
    """Greatest depth between two driver angles."""
    angle = closer_at_ends(start, end, _SAMPLES)
    found = at(angle, _ROUGH)
    around = np.pad(found, 1, constant_values=-np.inf)
    step = np.abs(np.diff(found[np.isfinite(found)])).max(initial=0.0)
    # Between samples it is hardly deeper than by a step: the others stay outside.
    peak = np.flatnonzero((found >= around[:-2]) & (found >= around[2:]) & (found > -2 * step))
    peak = peak[np.argsort(-found[peak], kind="stable")[:_PEAKS]]
    width = np.pi / 2 * abs(end - start) / _SAMPLES  # no two samples lie farther apart
    middle = angle[peak]
    for _ in range(_ROUNDS if len(peak) else 0):
        tried = np.clip(middle[:, None] + width * _NEARBY, min(start, end), max(start, end))
        chosen = np.argmax(at(tried.ravel(), _ROUGH).reshape(tried.shape), axis=1)[:, None]
        middle = np.take_along_axis(tried, chosen, axis=1)[:, 0]
        width /= 3
    return float(at(middle, _ROUNDS).max(initial=-np.inf)) if len(middle) else -np.inf


def _deepest_along(area: Area, ends: ComplexArray, rounds: int) -> FloatArray:
    """Greatest depth along each of a number of straight lines inside an area, shape (n, 2) to (n,)."""
    begin, along = ends[:, :1], ends[:, 1:] - ends[:, :1]
    share = np.broadcast_to(np.linspace(0, 1, _ALONG), (len(ends), _ALONG))
    width, best = 1 / (_ALONG - 1), np.zeros(len(ends))
    for _ in range(1 + rounds):
        value = area.from_boundary(begin + share * along)
        chosen = np.argmax(value, axis=1)[:, None]
        best = np.maximum(best, np.take_along_axis(value, chosen, axis=1)[:, 0])
        share = np.clip(np.take_along_axis(share, chosen, axis=1) + width * _NEARBY, 0, 1)
        width /= 3
    return best
