"""Linkages of any mechanism that come near points, angles and outputs: many at once, by rows of `MECHANISMS`.

A linkage is a shape (see `shapes`) and its driver angles at the targets. P = z0 + z1 Q + z2 e, with the origin
Q and direction e of the link that carries it, is linear in z0, z1, z2, which are solved for exactly (variable
projection, see `loop_search`). Loops close by construction.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.problems.values.linkages.mechanisms import linkage_of
from grashof.synth.loop.chain import chained
from grashof.synth.loop.dual import Dual
from grashof.synth.loop.dyad import as_complex
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
from grashof.synth.starts.six_bars.shapes import ENDS, Shapes

LONGER = 0.4  # share of drivers longer than the ground link
NO_ERROR = 1e-20  # sizes squared
STAGES = ((400, 8), (100, 15), (30, 150))  # numbers of the best that continue, and their steps


def draw(target: SearchTargets, shapes: Shapes, count: int, rng: np.random.Generator) -> Batch:
    """Random linkages."""
    first = rng.uniform(-np.pi, np.pi, (count, 1))
    angles = [first]
    if not target.timed:  # the last gap is the rest of the turn
        gaps = drawn_gaps(target, count, rng)
        gaps -= np.log(np.exp(gaps).sum(axis=1, keepdims=True))
        low = 0.03 if shapes.turning else 0.3
        angles += [gaps, np.log(rng.uniform(low, 4, (count, 1)))]
    return Batch(
        unknowns=np.concatenate([shapes.drawn(rng, count), *angles], axis=1),
        longer_driver=rng.random(count) < LONGER,
        assembly=rng.choice([-1.0, 1.0], (count, len(shapes.mechanism.loops))),
        direction=rng.choice([-1.0, 1.0], count),
    )


class Along:
    """A vector of a link at every target as complex numbers, and its derivatives by all unknowns."""

    def __init__(self, vector: Vector, angles: _Angles) -> None:
        self._vector, self._angles = vector, angles

    @cached_property
    def value(self) -> ComplexArray:
        """Shape (n, N)."""
        x, y = self._vector.x, self._vector.y
        return np.broadcast_to(as_complex(Vector(_value(x), _value(y))), self._angles.shape)

    @cached_property
    def slope(self) -> ComplexArray:
        """Shape (n, N, M)."""
        by_angle, by_ends = self._angles.slopes
        if not isinstance(self._vector.x, Dual):  # a slide stands still
            return np.zeros(by_angle.shape, dtype=np.complex128)
        slope = self._vector.x.slope + 1j * self._vector.y.slope
        width = slope.shape[-1] - ENDS - 1
        by_every = slope[..., -1:] * by_angle
        by_every[..., :width] += slope[..., :width]
        if by_ends is not None:
            by_every += slope[..., width : width + ENDS] @ by_ends
        return by_every


def _value(each: Any) -> Any:
    return each.value if isinstance(each, Dual) else each


class _Angles:
    """The driver angles of a batch (n, N), and those at the ends of the task motion (n, 2), ascending."""

    def __init__(self, target: SearchTargets, shapes: Shapes, batch: Batch) -> None:
        self._target, self._shapes, self._batch = target, shapes, batch
        self.theta2 = driver_angles(target, batch.unknowns[:, shapes.width :], batch.direction)
        self._at_ends = np.where(batch.direction[:, None] < 0, [-1, 0], [0, -1])
        self.ends = np.take_along_axis(self.theta2, self._at_ends, axis=1)
        self.shape = self.theta2.shape

    @cached_property
    def slopes(self) -> tuple[FloatArray, FloatArray | None]:
        """Their derivatives by all unknowns, (n, N, M), and those of the ends where shapes depend on these."""
        by_angle = by_angles(self._target, self._batch, self._shapes.width)
        by_ends = np.take_along_axis(by_angle, self._at_ends[..., None], axis=1)
        return by_angle, by_ends if self._shapes.by_ends else None


class Carried:
    """The link that carries P, and the last one, at every target."""

    def __init__(self, target: SearchTargets, shapes: Shapes, batch: Batch) -> None:
        """Close the loops of every linkage at every target."""
        angles, row = _Angles(target, shapes, batch), shapes.mechanism
        free = batch.unknowns[:, : shapes.width]
        self.made = shapes.made(free, batch.longer_driver, batch.assembly, angles.ends)
        theta2 = Dual(angles.theta2, np.eye(self.made.columns)[-1][None, None])
        driver = Vector(np.cos(theta2), np.sin(theta2))
        frames = chained(row, self.made.given, driver, list(batch.assembly.T[..., None])).frames
        vectors = *frames[row.carries], frames[row.loops[-1].links[1]].along
        self.by_origin, self.by_along, self.by_output = (Along(vector, angles) for vector in vectors)
        self.direction = batch.direction  # (n,), sense of the driver
        self.origin, self.along, self.output = (each.value for each in (self.by_origin, self.by_along, self.by_output))
        self.closes: BoolArray = np.isfinite(self.origin * self.along * self.output).all(axis=1)


def fitted(target: SearchTargets, shapes: Shapes, batch: Batch, until: int) -> tuple[Batch, FloatArray]:
    """The best of a batch improved, best first, and their errors (n,), sizes squared."""
    model = Fitting(target, shapes)
    error = model.errors(batch)
    for keep, steps in STAGES:
        best = np.argsort(error, kind="stable")[:keep]
        batch, error = improve(model, batch[best], steps, NO_ERROR, until, missed=model.missed)
    order = np.argsort(error, kind="stable")
    return batch[order], error[order]


@dataclass(frozen=True, slots=True)
class Fitting:
    """The model of a search: errors of positions, angles of the body and outputs, where targets have them."""

    target: SearchTargets
    shapes: Shapes

    def __call__(self, batch: Batch) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Squared errors (n,), misses (n, R) and their derivatives (n, R, M)."""
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            parts = self._parts(Carried(self.target, self.shapes, batch))
            missed = np.concatenate([part.missed for part in parts], axis=1)
            slope = np.concatenate([part.slope() for part in parts], axis=1)
            return _squared(missed), missed, slope

    def errors(self, batch: Batch) -> FloatArray:
        """Squared errors alone."""
        return _squared(self.missed(batch))

    def missed(self, batch: Batch) -> FloatArray:
        """The misses alone."""
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            parts = self._parts(Carried(self.target, self.shapes, batch))
            return np.concatenate([part.missed for part in parts], axis=1)

    def _parts(self, at: Carried) -> list[_Part]:
        target = self.target
        given = (target.weights.any(), _places), (target.has_angles, _turns), (target.outputs is not None, _outputs)
        return [part(target, at) for asked, part in given if asked]


def _squared(missed: FloatArray) -> FloatArray:
    """Sums of squares (n,), infinite where loops are open."""
    return np.nan_to_num((missed**2).sum(axis=1), nan=np.inf, posinf=np.inf)


class _Part(NamedTuple):
    """Some misses (n, R), and what gives their derivatives (n, R, M)."""

    missed: FloatArray
    slope: Callable[[], FloatArray]


def _places(target: SearchTargets, at: Carried) -> _Part:
    """From P to the points, weighted, with derivatives of Kaufman's."""
    root = np.sqrt(target.weights)
    z, q, *_ = project(target, at)
    missed = (target.points - z[:, :1] - z[:, 1:2] * at.origin - z[:, 2:] * at.along) * root

    def slope() -> FloatArray:
        moved = (z[:, 1:2, None] * at.by_origin.slope + z[:, 2:, None] * at.by_along.slope) * root[:, None]
        moved -= q @ (np.swapaxes(q.conj(), 1, 2) @ moved)
        return -np.concatenate([moved.real, moved.imag], axis=1)

    return _Part(np.concatenate([missed.real, missed.imag], axis=1), slope)


def _turns(target: SearchTargets, at: Carried) -> _Part:
    """Angles of the body missed, weighted."""

    def slope() -> FloatArray:
        return by_body_turns(target, (at.along.conj()[..., None] * at.by_along.slope).imag)

    return _Part(body_turns(target, at)[0], slope)


def _outputs(target: SearchTargets, at: Carried) -> _Part:
    """Outputs missed with the best zero."""
    sense = at.direction[:, None]
    off = sense * np.unwrap(np.angle(at.output), axis=1) - target.outputs

    def slope() -> FloatArray:
        turned = sense[..., None] * (at.output.conj()[..., None] * at.by_output.slope).imag
        centred: FloatArray = turned - turned.mean(axis=1, keepdims=True)
        return centred

    return _Part(off - off.mean(axis=1, keepdims=True), slope)


def linkages(target: SearchTargets, shapes: Shapes, batch: Batch) -> list[Linkage]:
    """Linkages of a batch where they fit best, in the frame of the targets."""
    with np.errstate(divide="ignore", invalid="ignore"):
        at = Carried(target, shapes, batch)
        z = project(target, at)[0] if target.weights.any() else np.tile([0j, 1, 0], (len(batch), 1))
        body_angle = body_turns(target, at)[1]
    made = list[Linkage]()
    for k in np.flatnonzero(at.closes):
        given = {name: _number(each, k) for name, each in at.made.given.items()}
        linkage = _linkage(shapes, given, batch.assembly[k].tolist(), z[k], float(body_angle[k]))
        if linkage is not None:
            made.append(linkage)
    return made


def _number(each: Any, k: int) -> Any:
    """A dimension of one linkage: a number, of a place a complex one."""
    if isinstance(each, Vector):
        return complex(_number(each.x, k), _number(each.y, k))
    return float(each.value[k, 0]) if isinstance(each, Dual) else each


def _linkage(
    shapes: Shapes, given: dict[str, Any], sides: list[float], z: ComplexArray, body_angle: float
) -> Linkage | None:
    """One linkage; None where its numbers make none."""
    (z0, z1, z2), row = z, shapes.mechanism
    scale, turned = abs(z1), float(np.angle(z1))
    stated = dict[str, Any]()
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
            stated[name] = _xy(z0 + z1 * value)
        elif kind == "arm":
            stated[name] = _xy(scale * value)
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
