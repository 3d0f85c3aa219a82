"""Linkages of any mechanism that come near points, angles and outputs: many at once.

A linkage is a shape (see `shapes`) and its driver angles at the targets. P = z0 + z1 Q + z2 e, with the
origin Q and direction e of the link that carries it, is linear in z0, z1, z2, which are solved for exactly
(variable projection, see `loop_search`). Loops close by construction.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from grashof.problems import Linkage, ProblemError, Rotatability
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.linkages.mechanisms import linkage_of
from grashof.synth.loop.dual import Dual
from grashof.synth.loop.vector import Vector
from grashof.synth.starts.closed_loop import Batch, SearchTargets, body_turns, by_body_turns
from grashof.synth.starts.limit_residuals import limit_rows, slopes_of
from grashof.synth.starts.loop_search import drawn_gaps, improve
from grashof.synth.starts.six_bars.carried import Carried, Placing
from grashof.synth.starts.six_bars.limits import SixBarView
from grashof.synth.starts.six_bars.shapes import Shapes

LONGER = 0.4  # share of drivers longer than the ground link, where either will do
LONGER_ONES = {Rotatability.CRANK_ROCKER: 0.0, Rotatability.DOUBLE_CRANK: 1.0}
SENSES = {"ccw": [1.0], "cw": [-1.0]}
NO_ERROR = 1e-22  # sizes squared, or rad squared
# Numbers of the best that continue, their steps, and the weight of limits, in sizes.
STAGES = ((300, 8, 0.1), (60, 15, 1.0), (20, 150, 10.0))
FIRST_STAGES = ((400, 8, 0.1), (100, 12, 1.0), (30, 20, 10.0))  # where a fit to more targets follows
QUICK_STAGES = ((150, 6, 0.1), (50, 10, 1.0), (16, 30, 10.0))


def draw(target: SearchTargets, shapes: Shapes, count: int, rng: np.random.Generator) -> Batch:
    """Random linkages."""
    wanted = target.wanted
    first = rng.uniform(-np.pi, np.pi, (count, 1))
    angles = [first]
    if target.jumbled:
        angles.append(rng.uniform(-np.pi, np.pi, (count, len(target.points) - 1)))
    elif not target.timed:  # the last gap is the rest of the turn
        gaps = drawn_gaps(target, count, rng)
        gaps -= np.log(np.exp(gaps).sum(axis=1, keepdims=True))
        low = 0.03 if shapes.turning else 0.3
        angles += [gaps, np.log(rng.uniform(low, 4, (count, 1)))]
    return Batch(
        unknowns=np.concatenate([shapes.drawn(rng, count), *angles], axis=1),
        longer_driver=rng.random(count) < LONGER_ONES.get(wanted.rotatability, LONGER),
        assembly=rng.choice([-1.0, 1.0], (count, len(shapes.mechanism.loops))),
        direction=rng.choice(SENSES.get(wanted.driver_sense, [-1.0, 1.0]), count),
    )


def fitted(
    target: SearchTargets,
    shapes: Shapes,
    batch: Batch,
    until: int,
    stages: Sequence[tuple[int, int, float]] = STAGES,
) -> tuple[Batch, FloatArray]:
    """The best of a batch improved, best first, and their errors (n,), sizes squared."""
    for keep, steps, weight in stages:
        model = Fitting(target, shapes, weight)
        batch = batch[np.argsort(model.errors(batch), kind="stable")[:keep]]
        batch, error = improve(model, batch, steps, NO_ERROR, until, missed=model.missed)
    order = np.argsort(error, kind="stable")
    return batch[order], error[order]


@dataclass(frozen=True, slots=True)
class Fitting:
    """The model of a search: errors of positions, angles of the body and outputs, where targets have them."""

    target: SearchTargets
    shapes: Shapes
    weight: float = 0.0  # of limits: an excess by one unit counts as an error of so many sizes

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
        placing = Placing(target, at) if target.weights.any() else None
        parts = [] if placing is None else [_places(target, at, placing)]
        parts += [_turns(target, at)] if target.has_angles else []
        parts += [_outputs(target.outputs, at)] if target.outputs is not None else []
        rows = (
            [*limit_rows(target, SixBarView(self.shapes, at, placing))]
            if self.weight and target.limited
            else []
        )
        if rows:
            over = np.concatenate([row.value for row in rows], axis=1)
            width = at.unknowns.count
            parts.append(
                _Part(self.weight * over, lambda: self.weight * slopes_of(rows, over.shape[1], width))
            )
        return parts


def _squared(missed: FloatArray) -> FloatArray:
    """Sums of squares (n,), infinite where loops are open."""
    squared: FloatArray = np.nan_to_num((missed**2).sum(axis=1), nan=np.inf, posinf=np.inf)
    return squared


class _Part(NamedTuple):
    """Some misses (n, R), and what gives their derivatives (n, R, M)."""

    missed: FloatArray
    slope: Callable[[], FloatArray]


def _places(target: SearchTargets, at: Carried, placing: Placing) -> _Part:
    """From P to the points, weighted, with derivatives of Kaufman's."""
    z = placing.z
    missed = (target.points - z[:, :1] - z[:, 1:2] * at.origin - z[:, 2:] * at.along) * np.sqrt(
        target.weights
    )

    def slope() -> FloatArray:
        rest = placing.rest
        return -np.concatenate([rest.real, rest.imag], axis=1)

    return _Part(np.concatenate([missed.real, missed.imag], axis=1), slope)


def _turns(target: SearchTargets, at: Carried) -> _Part:
    """Angles of the body missed, weighted."""

    def slope() -> FloatArray:
        return by_body_turns(target, (at.along.conj()[..., None] * at.by_along.slope).imag)

    return _Part(body_turns(target, at)[0], slope)


def _outputs(wanted: FloatArray, at: Carried) -> _Part:
    """Outputs missed with the best zero."""
    sense = at.direction[:, None]
    off = sense * np.unwrap(np.angle(at.output), axis=1) - wanted

    def slope() -> FloatArray:
        turned = sense[..., None] * (at.output.conj()[..., None] * at.by_output.slope).imag
        centred: FloatArray = turned - turned.mean(axis=1, keepdims=True)
        return centred

    return _Part(off - off.mean(axis=1, keepdims=True), slope)


def linkages(target: SearchTargets, shapes: Shapes, batch: Batch, z: ComplexArray) -> list[Linkage]:
    """Linkages of a batch at places z0, z1, z2 (n, 3), in the frame of the targets."""
    with np.errstate(divide="ignore", invalid="ignore"):
        at = Carried(target, shapes, batch)
        body_angle = body_turns(target, at)[1]
    made = list[Linkage]()
    for k in np.flatnonzero(at.closes).tolist():
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
