"""Linkages of any mechanism that come near points, angles and outputs: many at once, by rows of `MECHANISMS`.

A linkage is a shape (see `shapes`) and its driver angles at the targets. P = z0 + z1 Q + z2 e, with the origin
Q and direction e of the link that carries it, is linear in z0, z1, z2, which are solved for exactly (variable
projection, see `loop_search`). Loops close by construction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

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
from grashof.synth.starts.six_bars.shapes import ENDS, Made, Shapes

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


@dataclass(frozen=True, slots=True)
class Carried:
    """The link that carries P, and the last one, at every target; derivatives by all unknowns."""

    made: Made  # dimensions
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
        width = shapes.width
        theta2 = driver_angles(target, batch.unknowns[:, width:], batch.direction)
        by_angle = by_angles(target, batch, width)
        ends = np.array([0, -1])
        order = np.where(batch.direction[:, None] < 0, ends[::-1], ends)
        rows = np.arange(len(batch))[:, None]
        made = shapes.made(batch.unknowns[:, :width], batch.longer_driver, batch.assembly, theta2[rows, order])
        at = Dual(theta2, np.eye(made.columns)[-1][None, None])
        driver = Vector(np.cos(at), np.sin(at))
        chain = chained(shapes.mechanism, made.given, driver, list(batch.assembly.T[..., None]))
        row, frames = shapes.mechanism, chain.frames
        vectors = (*frames[row.carries], frames[row.loops[-1].links[1]].along)
        by_ends = by_angle[rows, order]
        values, slopes = zip(*(_by_all(each, by_angle, by_ends) for each in vectors), strict=True)
        closes = np.isfinite(np.concatenate(values, axis=1)).all(axis=1)
        return cls(made, *values, *slopes, batch.direction, closes)


def _by_all(vector: Vector, by_angle: FloatArray, by_ends: FloatArray) -> tuple[ComplexArray, ComplexArray]:
    """A vector as complex numbers (n, N), and their derivatives by all unknowns (n, N, M)."""
    places = by_angle.shape[:2]
    if not isinstance(vector.x, Dual):  # a slide stands still
        return np.full(places, as_complex(vector)), np.zeros(by_angle.shape, dtype=np.complex128)
    value = as_complex(Vector(vector.x.value, vector.y.value))
    slope = vector.x.slope + 1j * vector.y.slope
    width = slope.shape[-1] - ENDS - 1
    by_every = slope[..., -1:] * by_angle
    by_every[..., :width] += slope[..., :width]
    by_every += slope[..., width : width + ENDS] @ by_ends
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
