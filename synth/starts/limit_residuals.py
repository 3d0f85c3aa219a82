"""Limits as residuals of the batched search: the excess over each, and its derivative."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property, partial
from typing import Any

import numpy as np

from grashof.problems import Rotatability, TransmissionOver
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, Limits, turned_beyond
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.loop.dual import Dual
from grashof.synth.loop.dyad import Sizes
from grashof.synth.loop.vector import Vector
from grashof.synth.quantities.formulas import LOGARITHMIC, View
from grashof.synth.quantities.target_constraints import AtTarget, design_of, side_of_line
from grashof.synth.starts.closed_loop import Loop, SearchTargets, body_turns

LEAST_TRANSMISSION = 1e-3  # rad: keeps the motion away from dead positions
LEAST_LENGTH = 1e-9  # sizes


class Relative(View):
    """Linkages of a batch in the frame of their kind, their lengths and driver angles with derivatives."""

    def __init__(self, loop: Loop, by_theta2: FloatArray) -> None:
        self.r1, self.theta2, self.double_crank = 1.0, Dual(loop.theta2, by_theta2), loop.r2[:, None] > 1
        lengths = []
        for number, length in enumerate((loop.r2, loop.r3, loop.r4)):
            lengths.append(Dual(length[:, None], partial(_by_length, loop, number, by_theta2.shape[2])))
        self.r2, self.r3, self.r4 = lengths
        self.offset = self.r4  # as slider kinds have it


def _by_length(loop: Loop, number: int, unknowns: int) -> FloatArray:
    """Derivatives of a length of loops by the unknowns, (n, 1, M)."""
    slope = np.zeros((len(loop.r2), 1, unknowns))
    slope[:, 0, :3] = loop.by_lengths[:, number]
    return slope


class Placement(View):
    """Linkages of a batch where they stand, with derivatives by the M unknowns.

    A = z0 + z1 e2, B = z0 + g (r2 e2 + r3 e3), O4 = z0 + g, P = A + z2 e3 with the frame of the loop turned
    and scaled by g = z1 / r2; z is (n, 3) in sizes, by_z (n, 3, M), by_theta2 and by_theta3 (n, N, M).
    """

    def __init__(
        self,
        target: SearchTargets,
        loop: Loop,
        by_theta2: FloatArray,
        by_theta3: FloatArray,
        z: ComplexArray,
        by_z: ComplexArray,
    ) -> None:
        self._target, self.loop, self.by_theta3 = target, loop, by_theta3
        self.relative = Relative(loop, by_theta2)
        self.o2, self._crank, self.ap = (
            Vector(Dual(place.real, slope.real), Dual(place.imag, slope.imag))
            for place, slope in ((z[:, k, None], by_z[:, k, None]) for k in range(3))
        )
        ground = self._ground = self._crank / self.relative.r2
        self.o4, self.bp = self.o2 + ground, self.ap - self.relative.r3 * ground
        self.r1 = np.hypot(ground.x, ground.y)
        self.r2, self.r3, self.r4 = (self.r1 * getattr(self.relative, name) for name in ("r2", "r3", "r4"))
        self.lengths, self.offset = (self.r1, self.r2, self.r3, self.r4), self.r4
        self.theta1 = np.arctan2(ground.y, ground.x)
        theta2 = self.relative.theta2
        first, last = theta2.column(0), theta2.column(-1)
        self.theta2_start, self.direction = self.theta1 + first, np.sign(last.value - first.value)
        self.driver_turn, self.double_crank = np.abs(last - first), self.relative.double_crank
        required = target.wanted.rotatability is not Rotatability.ANY
        lengths = (each[:, None] for each in (np.ones_like(loop.r2), loop.r2, loop.r3, loop.r4))
        self.turns = required | target.kind.dyad.turns_fully(Sizes(*lengths))

    @property
    def normal(self) -> Vector:  # type: ignore[override]
        """The unit vector along the ground line, or across a slide."""
        along: Vector = self._ground / self.r1
        return along

    @cached_property
    def a(self) -> Vector:  # type: ignore[override]
        """A at every target."""
        return self.o2 + self._crank.turned(self.relative.theta2)

    @cached_property
    def b(self) -> Vector:  # type: ignore[override]
        """B at every target."""
        return self._target.kind.dyad.b(self, self.a, self._coupler / self.r1)

    def points_at(self, k: int) -> tuple[Vector, Vector, Vector]:
        """A, B and P at one target, which take less time than those at every one."""
        a = self.o2 + self._crank.turned(self.relative.theta2.column(k))
        theta3 = Dual(np.angle(self.loop.e3[:, [k]]), self.by_theta3[:, [k]])
        b = self._target.kind.dyad.b(self, a, self._ground.turned(theta3) / self.r1)
        return a, b, a + self.ap.turned(theta3)

    @cached_property
    def _coupler(self) -> Vector:
        """Of length r1, along the coupler."""
        turned: Vector = self._ground.turned(Dual(np.angle(self.loop.e3), self.by_theta3))
        return turned

    @cached_property
    def output_turn(self) -> Dual:
        """Rotation of the output link from the first target to the last."""
        dyad = self._target.kind.dyad
        first, last = (dyad.across(self, self.column("b", k), self.column("_coupler", k)) for k in (0, -1))
        turned: Dual = first.angle_to(last)
        return turned

    @cached_property
    def output_travel(self) -> Dual:
        """Travel of a slide from the first target to the last."""
        first, last = (self.column("b", k) for k in (0, -1))
        travel: Dual = (last - first).dot(-self._ground.left) / self.r1
        return travel

    def column(self, name: str, k: int) -> Vector:
        """A point, or the coupler, at one target."""
        each = getattr(self, name)
        return Vector(each.x.column(k), each.y.column(k))

    @cached_property
    def body_turn(self) -> Dual:
        """From the coupler of the loop to the body."""
        weights = self._target.turn_weights
        slope = np.einsum("i,sim->sm", weights, self.by_theta3) / weights.sum()
        return Dual(body_turns(self._target, self.loop)[1][:, None], -slope[:, None])


def oversteps(target: SearchTargets, at: Placement) -> tuple[FloatArray, FloatArray]:
    """Excess over every limit, (n, L), and its derivative by the unknowns, (n, L, M).

    Lengths of links and their ratio by their logarithms, places and coupler arms in sizes, angles in rad, the
    transmission by |cos mu|.
    """
    rows = [*limit_rows(target, at), *_rows_at(target, at), *_transmission_rows(target, at.relative)]
    over = np.concatenate([row.value for row in rows], axis=1)
    return over, slopes_of(rows, over.shape[1], at.by_theta3.shape[2])


def slopes_of(rows: Sequence[Dual], width: int, unknowns: int) -> FloatArray:
    """Derivatives of rows (n, width, unknowns); those without a value have none."""
    slopes, first = np.zeros((len(rows[0].value), width, unknowns)), 0
    for row in rows:
        last = first + row.value.shape[1]
        if row.value.any():
            slopes[:, first:last] = row.slope
        first = last
    return slopes


def limit_rows(target: SearchTargets, at: View) -> Iterator[Dual]:
    """Excess over limits that have a formula, of what is named by `SearchTargets.limited`."""
    for name, part, (low, high) in target.limited:
        if part.fixed:
            continue
        value = np.sqrt(part.of(at)) if part.squared else part.of(at)
        if LIMITS[name].kind.is_angle:
            yield _turned(value, (low, high), target.wanted.period(LIMITS[name].quantity.key))
        elif LIMITS[name].quantity.key in LOGARITHMIC:
            value = np.log(value if part.per is None else value / part.per(at))
            least = LEAST_LENGTH if part.per is None else 1.0
            yield _outside(value, (np.log(max(low, least)), np.log(high)))
        elif (low, high) != (-np.inf, np.inf):
            yield _outside(value, (low, high))


def _rows_at(target: SearchTargets, at: Placement) -> Iterator[Dual]:
    """Excess over limits at single targets."""
    if target.frame is None or not target.at:
        return
    origin, scale = target.frame.origin, target.frame.scale

    def outward(place: Vector) -> tuple[Dual, Dual]:
        return scale * place.x + origin.real, scale * place.y + origin.imag

    tracks: list[list[Any]] = [[None] * len(target.points) for _ in range(3)]
    for k in {limit.k for limit in target.at}:
        for track, place in zip(tracks, at.points_at(k), strict=True):
            track[k] = outward(place)
    pivots = outward(at.o2), outward(at.o4)
    design = design_of(target.kind.dyad, *pivots, at.theta1 - np.pi / 2, *tracks)
    for limit in target.at:
        for row in limit.residuals(design, _sense(at.loop, limit)):
            yield _outside(row, (-np.inf, 0.0))


def _sense(loop: Loop, limit: AtTarget) -> FloatArray | None:
    """On which side of the line of driver and coupler the motion to a toggle begins, (n, 1)."""
    if limit.name != "past_deg":
        return None
    way = slice(limit.k + 1) if limit.k else slice(None, None, -1)
    turned = np.unwrap(np.angle(loop.e3[:, way]), axis=1) - loop.theta2[:, way]
    return side_of_line(turned)


def _outside(row: Dual, limits: Limits) -> Dual:
    """Signed amount by which values lie above (positive) or below (negative) limits."""
    low, high = limits
    over = np.maximum(row.value - high, 0.0) - np.maximum(low - row.value, 0.0)
    return Dual(over, lambda: np.where((over != 0)[..., None], row.slope, 0.0))


def _turned(row: Dual, limits: Limits, period: float) -> Dual:
    """Amount by which angles exceed a range, within half a period."""
    over = turned_beyond(row.value, limits, period)
    fixed = limits[0] == limits[1]
    return Dual(over, lambda: row.slope if fixed else np.where((over != 0)[..., None], row.slope, 0.0))


def _where(rows: BoolArray, row: Dual) -> Dual:
    """Zero where `rows` are false."""
    return Dual(np.where(rows, row.value, 0.0), lambda: np.where(rows[..., None], row.slope, 0.0))


def _transmission_rows(target: SearchTargets, loop: Relative) -> Iterator[Dual]:
    """Excess of |cos mu| over its limit: with O2A along the ground line, and at the ends."""
    wanted, theta2 = target.wanted, loop.theta2
    least = np.radians(wanted.transmission_min_deg)
    if least <= 0 and wanted.rotatability is not Rotatability.ANY:
        return  # a full crank has no dead position
    most = np.cos(max(least, LEAST_TRANSMISSION))
    dyad = target.kind.dyad
    for reach, passes in zip(dyad.along_ground(loop), passed(target, theta2.value), strict=True):
        yield _where(passes[:, None], _outside(dyad.cos_mu(loop, reach), (-most, most)))
    if wanted.transmission_over is TransmissionOver.TASK and not target.closed:
        ends = slice(None) if target.jumbled else [0, -1]
        angle = Dual(theta2.value[:, ends], lambda: theta2.slope[:, ends])
        yield _outside(dyad.cos_mu(loop, dyad.reach(loop, angle)), (-most, most))


def passed(target: SearchTargets, theta2: FloatArray) -> tuple[BoolArray, BoolArray]:
    """Whether the task motion passes O2A folded over the ground line, and stretched along it; (n,) each."""
    every = np.ones(len(theta2), dtype=bool)
    if target.wanted.transmission_over is TransmissionOver.CYCLE or target.closed:
        return every, every
    if target.jumbled:
        return ~every, ~every
    half = np.floor(np.sort(theta2[:, [0, -1]], axis=1) / np.pi)
    low, high = half[:, 0] + 1, half[:, 1]  # multiples of pi in between
    count = high - low + 1
    return (count > 1) | ((count == 1) & (low % 2 == 0)), (count > 1) | ((count == 1) & (low % 2 == 1))
