"""Linkages of any mechanism that come near points and angles: many at once, by the rows of `MECHANISMS`.

With O2 = 0 and r1 = 1 (of a slide in the first loop r3 = 1) a linkage is a shape and its driver angles at the
targets. P = z0 + z1 Q + z2 e, with the origin Q and direction e of the link that carries it, is linear in
z0, z1, z2, which are solved for exactly (variable projection, see `loop_search`). The first loop of a drawn
shape closes by construction; shapes with another loop that does not are left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray
from grashof.problems.values.linkages.mechanism import Mechanism, Parameter
from grashof.problems.values.linkages.mechanisms import linkage_of
from grashof.synth.loop.chain import DYADS, Chain, chained
from grashof.synth.loop.dual import Dual
from grashof.synth.loop.dyad import as_complex
from grashof.synth.loop.feasible import Demand, feasible
from grashof.synth.loop.vector import Vector
from grashof.synth.starts.closed_loop import (
    Batch,
    SearchTargets,
    body_turns,
    by_angles,
    by_body_turns,
    driver_angles,
)
from grashof.synth.starts.loop_search import drawn_gaps, improve, project

FEW, ROUND = 3, 24  # positions of the driver at which a drawn shape has to close
LONGER = 0.4  # share of drivers longer than the ground link
SPREAD = 1.0  # of logarithms of lengths, over r1
NO_ERROR = 1e-20  # sizes squared
STAGES = ((400, 8), (100, 15), (30, 150))  # numbers of the best that continue, and their steps


@dataclass(frozen=True, slots=True)
class Shapes:
    """The shapes of a mechanism as columns of numbers."""

    mechanism: Mechanism

    @property
    def rows(self) -> list[Parameter]:
        """The parameters that shape a linkage."""
        apart = {"o2", "o4", "coupler_point", "body_angle", *self.unit}
        return [row for row in self.mechanism.parameters if row.name not in apart and row.kind != "sign"]

    @property
    def unit(self) -> tuple[str, ...]:
        """The length that is 1 in the search, where it is not r1."""
        return () if self.mechanism.loops[0].pinned else ("r3", "slide_angle")

    @property
    def width(self) -> int:
        """Number of columns."""
        return sum(1 + row.paired for row in self.rows)

    def given(self, columns: Sequence[Any]) -> dict[str, Any]:
        """Arguments of `chained` from a number for each column, lengths by their logarithms."""
        rest = list(columns)
        made: dict[str, Any] = {"o4": Vector(1.0, 0.0), "r3": 1.0, "slide_angle": 0.0}
        for row in self.rows:
            if row.paired:
                made[row.name] = Vector(rest.pop(0), rest.pop(0))
            else:
                value = rest.pop(0)
                made[row.name] = np.exp(value) if row.kind == "length" else value
        return made

    def drawn(self, rng: np.random.Generator, count: int, transmission: float) -> FloatArray:
        """Random shapes, (count, width); first loops are full cranks with mu from `transmission` up, rad."""
        loop = self.mechanism.loops[0]
        longer, shares = rng.random(count) < LONGER, rng.random((count, 3))
        sizes = feasible(DYADS[loop.dyad.kind], shares, longer, Demand.turning(transmission))
        first = {"r2": sizes.r2, "r3": sizes.r3, "r4": sizes.r4, loop.offset: sizes.offset}
        columns = []
        for row in self.rows:
            draw = rng.uniform(-np.pi, np.pi, count) if row.kind == "angle" else rng.normal(0, SPREAD, count)
            if row.name in first:
                draw = np.log(first[row.name]) if row.kind == "length" else first[row.name]
            columns += [draw, rng.normal(0, SPREAD, count)] if row.paired else [draw]
        return np.stack(columns, axis=1)


def draw(target: SearchTargets, shapes: Shapes, count: int, rng: np.random.Generator) -> Batch:
    """Random linkages whose loops close all round the turn, out of `count` tried."""
    drawn = shapes.drawn(rng, count, float(np.radians(target.wanted.transmission_min_deg)))
    sides = rng.choice([-1.0, 1.0], (count, len(shapes.mechanism.loops)))
    for positions in (FEW, ROUND):  # most that close in a few close in all
        closes = _closes(shapes, drawn, sides, np.arange(positions) * TURN / positions)
        drawn, sides = drawn[closes], sides[closes]
    number = len(drawn)
    first = rng.uniform(-np.pi, np.pi, (number, 1))
    angles = [first]
    if not target.timed:  # the last gap is the rest of the turn
        gaps = drawn_gaps(target, number, rng)
        gaps -= np.log(np.exp(gaps).sum(axis=1, keepdims=True))
        angles += [gaps, np.log(rng.uniform(0.03, 4, (number, 1)))]
    return Batch(
        unknowns=np.concatenate([drawn, *angles], axis=1),
        longer_driver=np.zeros(number, dtype=bool),
        assembly=sides,
        direction=rng.choice([-1.0, 1.0], number),
    )


def _closes(shapes: Shapes, drawn: FloatArray, sides: FloatArray, theta2: FloatArray) -> BoolArray:
    """Which shapes close at driver angles."""
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        chain = _chain(shapes, list(drawn.T[..., None]), theta2[None], sides)
        closed: BoolArray = np.logical_and.reduce([np.all(each > 0, axis=1) for each in chain.squares])
    return closed


def _chain(shapes: Shapes, columns: Sequence[Any], theta2: Any, sides: FloatArray) -> Chain:
    driver = Vector(np.cos(theta2), np.sin(theta2))
    return chained(shapes.mechanism, shapes.given(columns), driver, list(sides.T[..., None]))


@dataclass(frozen=True, slots=True)
class Carried:
    """The link that carries P, and the last one, at every target; derivatives by all unknowns."""

    origin: ComplexArray  # (n, N)
    along: ComplexArray  # (n, N)
    output: ComplexArray  # (n, N), direction of the last link
    by_origin: ComplexArray  # (n, N, M)
    by_along: ComplexArray
    by_output: ComplexArray
    direction: FloatArray  # (n,), sense of the driver
    closes: BoolArray  # (n,)

    @classmethod
    def of(cls, target: SearchTargets, shapes: Shapes, batch: Batch) -> Carried:
        """Close the loops of every linkage at every target."""
        width, unknowns = shapes.width, batch.unknowns
        theta2 = driver_angles(target, unknowns[:, width:], batch.direction)
        one = np.eye(width + 1)  # by the shape, and last by the driver angle at the target
        columns = [Dual(unknowns[:, [k]], one[k][None, None]) for k in range(width)]
        chain = _chain(shapes, columns, Dual(theta2, one[width][None, None]), batch.assembly)
        by_angle = by_angles(target, batch, width)
        row, frames = shapes.mechanism, chain.frames
        vectors = (*frames[row.carries], frames[row.loops[-1].links[1]].along)
        values, slopes = zip(*(_by_all(each, by_angle) for each in vectors), strict=True)
        closes = np.isfinite(np.concatenate(values, axis=1)).all(axis=1)
        (origin, along, output), (by_origin, by_along, by_output) = values, slopes
        every = origin, along, output, by_origin, by_along, by_output
        return cls(*every, batch.direction, closes)


def _by_all(vector: Vector, by_angle: FloatArray) -> tuple[ComplexArray, ComplexArray]:
    """A vector as complex numbers (n, N), and their derivatives by all unknowns (n, N, M)."""
    places = by_angle.shape[:2]
    if not isinstance(vector.x, Dual):  # a slide stands still
        return np.full(places, as_complex(vector)), np.zeros(by_angle.shape, dtype=np.complex128)
    value = as_complex(Vector(vector.x.value, vector.y.value))
    slope = vector.x.slope + 1j * vector.y.slope
    by_every = slope[..., -1:] * by_angle
    by_every[..., : slope.shape[-1] - 1] += slope[..., :-1]
    return np.broadcast_to(value, places), by_every


def fitted(target: SearchTargets, shapes: Shapes, batch: Batch, until: int) -> tuple[Batch, FloatArray]:
    """The best of a batch improved, best first, and their errors (n,), sizes squared.

    The errors are those of positions, angles of the body and outputs, where the targets have them.
    """

    def model(some: Batch) -> tuple[FloatArray, FloatArray, FloatArray]:
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            at = Carried.of(target, shapes, some)
            rows = [part for each in (_places, _turns, _outputs) if (part := each(target, at)) is not None]
        residual, slope = (np.concatenate(each, axis=1) for each in zip(*rows, strict=True))
        error = np.where(at.closes, (residual**2).sum(axis=1), np.inf)
        return np.where(np.isfinite(error), error, np.inf), residual, slope

    error = model(batch)[0]
    for keep, steps in STAGES:
        best = np.argsort(error, kind="stable")[:keep]
        batch, error = improve(model, batch[best], steps, NO_ERROR, until)
    order = np.argsort(error, kind="stable")
    return batch[order], error[order]


def _places(target: SearchTargets, at: Carried) -> tuple[FloatArray, FloatArray] | None:
    """From P to the points, weighted (n, 2N), with derivatives (Kaufman's); None without points."""
    if not target.weights.any():
        return None
    root = np.sqrt(target.weights)
    z, q, *_ = project(target, at)
    missed = (target.points - z[:, :1] - z[:, 1:2] * at.origin - z[:, 2:] * at.along) * root
    slope = (z[:, 1:2, None] * at.by_origin + z[:, 2:, None] * at.by_along) * root[:, None]
    slope -= q @ (np.swapaxes(q.conj(), 1, 2) @ slope)
    return (
        np.concatenate([missed.real, missed.imag], axis=1),
        -np.concatenate([slope.real, slope.imag], axis=1),
    )


def _turns(target: SearchTargets, at: Carried) -> tuple[FloatArray, FloatArray] | None:
    """Angles of the body missed, weighted (n, N), with derivatives; None where none is given."""
    if not target.has_angles:
        return None
    by_turn = (at.along.conj()[..., None] * at.by_along).imag
    return body_turns(target, at)[0], by_body_turns(target, by_turn)


def _outputs(target: SearchTargets, at: Carried) -> tuple[FloatArray, FloatArray] | None:
    """Outputs missed with the best zero (n, N), with derivatives; None where the targets have none."""
    if target.outputs is None:
        return None
    sense = at.direction[:, None]
    off = sense * np.unwrap(np.angle(at.output), axis=1) - target.outputs
    slope = sense[..., None] * (at.output.conj()[..., None] * at.by_output).imag
    return off - off.mean(axis=1, keepdims=True), slope - slope.mean(axis=1, keepdims=True)


def linkages(target: SearchTargets, shapes: Shapes, batch: Batch) -> list[Linkage]:
    """Linkages of a batch where they fit best, in the frame of the targets."""
    with np.errstate(divide="ignore", invalid="ignore"):
        at = Carried.of(target, shapes, batch)
        z = project(target, at)[0] if target.weights.any() else np.tile([0j, 1, 0], (len(batch), 1))
        body_angle = body_turns(target, at)[1]
    made = list[Linkage]()
    for k in np.flatnonzero(at.closes):
        shape = batch.unknowns[k, : shapes.width].tolist()
        linkage = _linkage(shapes, shape, batch.assembly[k].tolist(), z[k], float(body_angle[k]))
        if linkage is not None:
            made.append(linkage)
    return made


def _linkage(
    shapes: Shapes, shape: list[float], sides: list[float], z: ComplexArray, body_angle: float
) -> Linkage | None:
    """One linkage; None where its numbers make none."""
    (z0, z1, z2), row = z, shapes.mechanism
    scale, turned = abs(z1), float(np.angle(z1))
    given, stated = shapes.given(shape), dict[str, Any]()
    for parameter in row.parameters:
        name, kind = parameter.name, parameter.kind
        value: Any = given.get(name)
        if name == "o2":
            stated[name] = _xy(z0)
        elif name == "coupler_point":
            stated[name] = _xy(scale * z2 / z1)
        elif name == "body_angle":
            stated[name] = body_angle - turned
        elif kind in ("place", "station"):
            stated[name] = _xy(z0 + z1 * complex(value.x, value.y))
        elif kind == "arm":
            stated[name] = _xy(scale * complex(value.x, value.y))
        elif kind == "angle":
            stated[name] = value + turned
        elif kind != "sign":
            stated[name] = scale * value
    stated |= {loop.assembly: side for loop, side in zip(row.loops, sides, strict=True)}
    if len(row.loops) > 1:
        stated |= {"hosts": row.dyads[1].hosts, "point_link": row.carries}
    try:
        return linkage_of(row.word, stated)
    except ProblemError:
        return None


def _xy(z: complex) -> list[float]:
    return [float(z.real), float(z.imag)]
