"""Limits of the joints and the coupler of function generators, at single pairs, all pairs or in between.

A function states no place: where limits of places leave O2, the scale or the direction of the ground line
free, these are numbers of the search.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from grashof.analysis.judge.design import Design
from grashof.problems import Box, Problem, Requirements, TargetLimits
from grashof.problems.values.arrays import FloatArray, Limits
from grashof.problems.values.box import ANYWHERE
from grashof.problems.values.requirements.function_ground import FunctionGround
from grashof.synth.loop.dual import Dual
from grashof.synth.loop.vector import Vector
from grashof.synth.quantities.formulas import Part, View, parts_of, range_of
from grashof.synth.quantities.kind import Kind
from grashof.synth.quantities.regions import hull_parts, pairs_of
from grashof.synth.quantities.target_constraints import AtTarget, design_of, side_of_line, target_constraints
from grashof.synth.theory.functions.limits import joined_rows
from grashof.synth.theory.functions.output import Generators
from grashof.synth.theory.functions.placed import NUMBERS, PLACED, Placed

INSIDE = 4e-8  # sizes: margin by which lengths are kept, so that rounding misses none
ALONG = 25  # inputs at which what is limited over the motion is computed, beside its extremes
CLOSER = 20.0  # by how much an extreme is bracketed more closely in a second look
AT_PAIRS = ("a", "b", "distances")  # limited at every pair
OVER_MOTION = ("coupler_angle_deg", "coupler_rate", "mechanical_advantage_min")
PLACES = frozenset({"a", "b", "instant_centre"})
LENGTHS = PLACES | {"distances"}
DIRECTED = PLACES | {"coupler_angle_deg"}  # by which mirror images differ
TURNS, STEPS = 8, 6  # directions in which a place is looked for, and steps of each
FEW = 7  # pairs that count in these


@dataclass(frozen=True, slots=True)
class PlaceLimits:
    """Limits of joints and links in their places, zero or positive where they are kept."""

    kind: Kind
    inputs: FloatArray  # (N,): those of the pairs, from the first
    unit: float  # the usual unit of lengths, in that of the problem
    usual: FloatArray  # (4,): the usual place, see `placed`
    free: FloatArray  # (4,): 1 for every number of it that may change, 0 for one that stays
    lengths: tuple[Limits, ...]  # of `Generators.lengths`, where the scale is free
    offset: Limits | None  # of a block, likewise
    parts: tuple[tuple[Part, Limits], ...]  # at all pairs, or of pivots
    at: tuple[AtTarget, ...]
    along: tuple[AtTarget, ...]  # at every input of the range, which is their only target
    driver: int = 1

    @classmethod
    def of(cls, problem: Problem, kind: Kind, wanted: Requirements, unit: float | None) -> PlaceLimits | None:
        """Those of a function; None where nothing of the kind is limited.

        `wanted` are resolved; `unit` is the length of outputs that are travel.
        """
        task, stated = problem.task, problem.requirements
        at = target_constraints(problem)
        named = {name for name in AT_PAIRS if name in stated.limited}
        along = {name: getattr(stated, name) for name in OVER_MOTION if getattr(stated, name) is not None}
        if not (at or named or along):
            return None
        moving = {each.name for each in at} | named | set(along)
        ground = FunctionGround.of(wanted)
        length = ground.length if unit is None else unit
        theta1 = ground.theta1 if unit is None else wanted.angle_of("slide_angle_deg") or 0.0
        o2 = np.array(ground.placed(ground.length if unit is None else 0.0)[0]) / length
        free = _free(wanted, moving, pinned=kind.dyad.pinned)
        if task.lengthens or task.mirror is not None or not moving & (LENGTHS | DIRECTED):
            free = np.zeros(4)
        placed = named | ({"o2", "o4"} & stated.limited.keys() if free.any() else set[str]())
        parts = [
            (part, range_of(stated, name, part)) for name, part in parts_of(sorted(placed), kind.formulas)
        ]
        for name, region, x, y in pairs_of(stated, kind.formulas):
            parts += hull_parts(name, region, x, y) if name in placed else []
        single = TargetLimits(targets=[1], **along) if along else None
        return cls(
            kind,
            task.inputs - task.span[0],
            length,
            np.array([*o2, 0.0, theta1]),
            free,
            (),
            wanted.offset if free[2] else None,
            tuple((part, limits) for part, limits in parts if limits != (-np.inf, np.inf)),
            at,
            () if single is None else tuple(AtTarget(single, name, 0) for name in along),
        )

    def settled(self, wanted: Requirements) -> Requirements:
        """Requirements with the usual length of the ground where places depend on it, and it is not free."""
        names = {part.name.partition(".")[0] for part, _ in self.parts} | {each.name for each in self.at}
        if self.free[2] or not self.kind.dyad.pinned or names.isdisjoint(LENGTHS):
            return wanted
        return replace(wanted, r1=(self.unit, self.unit))

    def with_sizes(self, sizes: Sequence[Limits]) -> PlaceLimits:
        """The same with limits of `Generators.lengths`, which count where the scale is free."""
        return replace(self, lengths=tuple(sizes)) if self.free[2] else self

    @property
    def directed(self) -> bool:
        """Whether mirror images differ."""
        named = {part.name.split(".")[0] for part, _ in self.parts}
        return not DIRECTED.isdisjoint(named | {each.name for each in (*self.at, *self.along)})

    def placed(self, batch: Generators) -> Generators:
        """Generators in the places where they miss the limits by least, nearly."""
        if not self.free.any():
            return batch
        some = np.unique(np.linspace(0, len(self.inputs) - 1, FEW).round().astype(int))
        rough = replace(self, inputs=self.inputs[some]) if not self.at else self
        made = PLACED[type(batch)].of(batch, self.usual)
        turns = np.linspace(0, 2 * np.pi, TURNS, endpoint=False) if self.free[3] else np.zeros(1)
        rigid, least = _Rigid(made), np.full(len(batch), np.inf)
        best = rigid.shape
        for turn in turns:
            there, missed = rough._moved(rigid.at(rigid.shape + np.array([0.0, 0.0, 0.0, turn])))
            better = missed < least
            least, best = np.where(better, missed, least), np.where(better[:, None], there, best)
        shape = made.shape.copy()
        shape[:, made.PLACE] = best
        return made.changed(shape)

    def _moved(self, rigid: _Rigid) -> tuple[FloatArray, FloatArray]:
        """Places after steps of Gauss and Newton, and their squared misses."""
        square = np.full(len(rigid), np.inf)
        for _ in range(STEPS):
            rows = self.rows(rigid)
            short = np.nan_to_num(np.minimum(rows.value, 0.0), nan=-1e3)
            square = (short**2).sum(axis=1)
            slope = np.nan_to_num(rows.slope * (short < 0)[..., None])
            normal = slope.swapaxes(1, 2) @ slope
            scale = np.einsum("mii->mi", normal).max(axis=1)
            normal = normal + (1e-6 * scale + 1e-12)[:, None, None] * np.eye(4)
            step = np.linalg.solve(normal, (slope.swapaxes(1, 2) @ short[..., None]))[..., 0]
            step = np.clip(step, [-np.inf, -np.inf, -1.0, -1.0], [np.inf, np.inf, 1.0, 1.0])
            rigid = rigid.at(rigid.shape - step * self.free)
        return rigid.shape, square

    def of_linkage(self, batch: Generators, linkage: Any) -> Generators:
        """A generator where its linkage lies."""
        if not self.free.any():
            return batch
        pinned = self.kind.dyad.pinned
        size = float(linkage.lengths[0]) / self.unit if pinned else 1.0
        angle = float(linkage.theta1 if pinned else linkage.slide_angle)
        place = [*(np.asarray(linkage.o2) / self.unit), np.log(size), angle]
        return PLACED[type(batch)].of(batch, np.where(self.free > 0, place, self.usual))

    def standing(self, batch: Generators, wanted: Requirements) -> Requirements:
        """Requirements by which a generator is placed where it lies."""
        if not isinstance(batch, Placed):
            return wanted
        x, y, log, angle = batch.shape[0, batch.PLACE].tolist()
        o2 = _inside(wanted.o2, self.unit * x, self.unit * y)
        if not self.kind.dyad.pinned:
            return replace(wanted, o2=o2, slide_angle_deg=float(np.degrees(angle)))
        length = self.unit * np.exp(log)
        o4 = _inside(wanted.o4, o2.x[0] + length * np.cos(angle), o2.y[0] + length * np.sin(angle))
        return replace(wanted, o2=o2, o4=o4)

    def rows(self, batch: Generators | _Rigid) -> Dual:
        """All of them (M, L), in usual units or rad."""
        with np.errstate(all="ignore"):
            found = self._rows(batch)

        def slope() -> FloatArray:
            with np.errstate(all="ignore"):
                return found.slope

        return Dual(found.value, slope)

    def _rows(self, batch: Generators | _Rigid) -> Dual:
        found = list[Dual]()
        number = {k: row for row, k in enumerate(self._numbers)}
        if self.parts or self.at:
            view = _InPlace(self, batch, self.inputs[list(number)])
            for part, limits in self.parts:
                value = np.sqrt(part.of(view)) if part.squared else part.of(view)
                found += self._sides(value, limits)
            if self.at:
                design = view.design(number)
                for each in self.at:
                    found += self._of_target(each, design, self._sense(each, batch))
        for each in self.along:
            found += self._over_motion(each, batch)
        found += self._of_scale(batch)
        return joined_rows(found)

    @property
    def _numbers(self) -> list[int]:
        """The pairs that count."""
        if self.parts:
            return [*range(len(self.inputs))]
        return sorted({each.k for each in self.at})

    def place(self, batch: Generators | _Rigid) -> tuple[Any, ...]:
        """The numbers of the place: with derivatives where they are free."""
        if not batch.PLACE.stop:
            return tuple(self.usual.tolist())
        columns = range(*batch.PLACE.indices(batch.UNKNOWNS))
        every = np.eye(batch.UNKNOWNS)[:, None]
        each = [
            Dual(
                batch.shape[:, [column]],
                np.broadcast_to(free * every[column], (len(batch), 1, batch.UNKNOWNS)),
            )
            for column, free in zip(columns, self.free, strict=True)
        ]
        return tuple(each)

    def _sides(self, value: Any, limits: Limits) -> list[Dual]:
        """Room of a length on both sides, a little less than there is."""
        low, high = limits
        inside = min(INSIDE * self.unit, (high - low) / 2)
        found = [value - (low + inside)] * bool(np.isfinite(low))
        found += [(high - inside) - value] * bool(np.isfinite(high))
        return [row / self.unit for row in found]

    def _sense(self, limit: AtTarget, batch: Generators | _Rigid) -> FloatArray | None:
        """On which side of the line of driver and coupler the motion to a toggle begins, (M, 1)."""
        if limit.name != "past_deg":
            return None
        end = float(self.inputs[limit.k])
        between = np.linspace(float(self.inputs[0 if limit.k else -1]), end, ALONG)
        a, b = (_values(each) for each in batch.joints(between))
        return side_of_line(np.unwrap(self.driver * a.angle_to(b - a), axis=1))

    def _of_target(self, limit: AtTarget, design: Design, sense: FloatArray | None = None) -> Iterator[Dual]:
        if limit.name in LENGTHS:
            for value, limits in limit.numbers(design):
                yield from self._sides(value, limits)
            return
        yield from (-row for row in limit.residuals(design, sense))

    def _over_motion(self, limit: AtTarget, batch: Generators | _Rigid) -> Iterator[Dual]:
        """A limit at inputs of the range, and where it is kept by least in between."""

        def rows(inputs: FloatArray) -> list[Dual]:
            return list(self._of_target(limit, _InPlace(self, batch, inputs).design()))

        inputs = np.linspace(0.0, float(self.inputs[-1]), ALONG)
        every = rows(inputs)
        yield from every
        for number, row in enumerate(every):
            at = _lowest(inputs, row.value)
            step, last = float(inputs[1]) / CLOSER, float(inputs[-1])
            near = np.clip(at, step, last - step) + step * np.array([-1.0, 0.0, 1.0])
            yield rows(_vertex(near, rows(near)[number].value, last))[number]

    def _of_scale(self, batch: Generators | _Rigid) -> Iterator[Dual]:
        """Lengths within their limits, where the scale is free."""
        if not self.lengths:
            return
        _, _, log, _ = self.place(batch)
        lengths = [0.0, *batch.numbers[: batch.LINKS]]
        for length, limits in zip(lengths, self.lengths, strict=True):
            full = log + length + float(np.log(self.unit))
            for sign, edge in zip((1.0, -1.0), limits, strict=True):
                if 0 < edge < np.inf:
                    inside = INSIDE if limits[0] < limits[1] * (1 - 2 * INSIDE) else 0.0
                    yield sign * (full - float(np.log(edge))) - inside
        if self.offset is not None:
            offset = self.driver * self.unit * np.exp(log) * batch.sizes_of(batch.numbers)[3]
            yield from self._sides(offset, self.offset)


class _Rigid:
    """Generators that move as rigid bodies: their places alone have derivatives."""

    PLACE, UNKNOWNS = slice(0, NUMBERS), NUMBERS

    def __init__(self, batch: Placed) -> None:
        self._batch, self._known = batch, dict[bytes, tuple[Vector, Vector]]()
        self.shape, self.numbers = batch.shape[:, batch.PLACE], batch.columns
        self.LINKS, self.sizes_of = batch.LINKS, batch.sizes_of

    def __len__(self) -> int:
        return len(self.shape)

    def at(self, shape: FloatArray) -> _Rigid:
        """The same in other places (M, 4)."""
        moved = copy(self)
        moved.shape = shape
        return moved

    def joints(self, inputs: FloatArray) -> tuple[Vector, Vector]:
        """Those of the generators, of inputs for all (N,) computed once."""
        key = inputs.tobytes()
        found = self._known.get(key)
        if found is None:
            a, b = (_values(each) for each in self._batch.joints(inputs))
            found = a, b
            if inputs.ndim == 1:
                self._known[key] = found
        return found


def _values(at: Vector) -> Vector:
    """A vector without derivatives."""
    x, y = (each.value if isinstance(each, Dual) else each for each in (at.x, at.y))
    return Vector(x, y)


class _InPlace(View):
    """Generators at some inputs, in the unit of the problem, with derivatives by the shape."""

    def __init__(self, limits: PlaceLimits, batch: Generators | _Rigid, inputs: FloatArray) -> None:
        x, y, log, self.angle = limits.place(batch)
        a, b = batch.joints(inputs)
        unit, self.kind = limits.unit * np.exp(log), limits.kind
        cosine, sine = np.cos(self.angle), np.sin(self.angle)

        def placed(at: Vector) -> Vector:
            beside = limits.driver * at.y
            return Vector(
                limits.unit * x + unit * (at.x * cosine - beside * sine),
                limits.unit * y + unit * (at.x * sine + beside * cosine),
            )

        none = np.zeros((len(batch), 1))
        still = Dual(none, np.zeros((len(batch), 1, batch.UNKNOWNS)))
        self.o2, self.a, self.b = placed(Vector(still, still)), placed(a), placed(b)
        if self.kind.dyad.pinned:
            self.o4 = placed(Vector(still + 1.0, still))

    def design(self, columns: Mapping[int, int] | None = None) -> Design:
        """For limits at single targets, by the column of each; by default a target at every input."""
        tracks = list[list[Any]]()
        for at in (self.a, self.b):
            track: list[Any] = [(at.x, at.y)] if columns is None else [None] * (max(columns) + 1)
            for target, column in (columns or {}).items():
                track[target] = at.x.column(column), at.y.column(column)
            tracks.append(track)
        o2, o4 = ((at.x, at.y) for at in (self.o2, self.o4 if self.kind.dyad.pinned else self.o2))
        return design_of(self.kind.dyad, o2, o4, self.angle, *tracks)


def _free(wanted: Requirements, moving: set[str], *, pinned: bool) -> FloatArray:
    """Which numbers of a place may change, 1 or 0, (4,): those that limits depend on and do not fix."""
    o2, o4 = wanted.o2 or ANYWHERE, wanted.o4 or ANYWHERE
    by_place = bool(moving & PLACES) or (pinned and (o2 is not ANYWHERE or o4 is not ANYWHERE))
    turns = by_place or "coupler_angle_deg" in moving
    grows = pinned and (by_place or "distances" in moving)
    both = pinned and not any(map(_wide, (o2.x, o2.y, o4.x, o4.y)))
    angle = wanted.ground_angle_deg if pinned else wanted.slide_angle_deg
    held = both or angle is not None or wanted.theta2_start_deg is not None
    fixed = both or (wanted.r1 is not None and not _wide(wanted.r1))
    free = [by_place and _wide(o2.x), by_place and _wide(o2.y), grows and not fixed, turns and not held]
    return np.array(free, dtype=np.float64)


def _wide(limits: Limits) -> bool:
    return limits[0] < limits[1]


def _inside(box: Box | None, x: float, y: float) -> Box:
    """A place of a pivot, moved into its box by what rounding left outside."""
    x, y = (
        float(np.clip(at, *side))
        for at, side in zip((x, y), ((box or ANYWHERE).x, (box or ANYWHERE).y), strict=True)
    )
    return Box(x=(x, x), y=(y, y))


def _lowest(inputs: FloatArray, values: FloatArray) -> FloatArray:
    """Where a parabola about the least of some values (M, N) is least, (M, 1)."""
    k = np.clip(np.nan_to_num(values, nan=np.inf).argmin(axis=1), 1, len(inputs) - 2)[:, None] + [-1, 0, 1]
    return _vertex(inputs[k], np.take_along_axis(values, k, axis=1), float(inputs[-1]))


def _vertex(at: FloatArray, values: FloatArray, most: float) -> FloatArray:
    """The least place of parabolas through three values (M, 3) each at even inputs, up to a last one."""
    left, middle, right = values.T
    bend = left - 2 * middle + right
    with np.errstate(divide="ignore", invalid="ignore"):
        moved = np.where(bend > 0, (left - right) / (2 * bend), np.sign(left - right))
    moved = np.clip(np.nan_to_num(moved), -1.0, 1.0)
    found: FloatArray = np.clip(at[:, 1] + moved * (at[:, 2] - at[:, 1]), 0.0, most)[:, None]
    return found
