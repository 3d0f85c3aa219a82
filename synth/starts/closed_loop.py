"""Linkages of a search as unknowns: the closed loop at every target, and its derivatives.

The unknowns make linkages feasible by construction; the loop is in the frame of its kind (`Kind`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from grashof.problems import Requirements, Rotatability, TransmissionOver
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray, IntArray, Limits
from grashof.synth.quantities.formulas import Formulas, Part, parts_of, range_of
from grashof.synth.quantities.frame import Frame
from grashof.synth.quantities.kind import Kind
from grashof.synth.quantities.regions import hull_parts, pairs_of
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.target_constraints import AtTarget
from grashof.synth.quantities.wanted_torque import WantedCurve

PROPORTIONS = 3  # unknowns of every kind; of slider kinds the last one does nothing
STEEPEST = 80.0  # deg, the greatest transmission angle by construction: beyond, cranks are too short
SHORTEST = 1e-3  # of the longest step between targets: no step counts as less


@dataclass(frozen=True, slots=True)
class SearchTargets:
    """N targets of the coupler, lengths in sizes, angles in rad."""

    points: ComplexArray  # (N,), without a last one that repeats the first
    weights: FloatArray  # (N,), of the squared distances; zero where the position is free
    turns: FloatArray  # (N,), angles of the body
    turn_weights: FloatArray  # (N,), sizes^2; of the squared turns from there; zero where the angle is free
    timing: FloatArray  # (N,), driver rotation from the first point; all zero where it is free
    wanted: Requirements  # in the frame of the points; its limits draw the search inwards
    kind: Kind
    closed: bool = False  # the task motion is a full turn
    exact: bool = False  # all are to be met; otherwise least squares
    # (N,), rad: rotation of the last link from the first target, in the driver's sense
    outputs: FloatArray | None = None
    formulas: Formulas | None = None  # by default those of the kind
    spare: float = 0.0  # share by which limits are narrower here
    torque: WantedCurve | None = None  # wanted, where the deviation from it counts as an error
    count: int = 0  # number of targets of the task, for the weight of the torque
    at: tuple[AtTarget, ...] = ()  # limits at single targets of these
    frame: Frame | None = None  # in which lengths are sizes
    # field, part and range of all that is limited and has a formula
    limited: tuple[tuple[str, Part, Limits], ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        formulas = self.kind.formulas if self.formulas is None else self.formulas
        rows = [
            (name, part, range_of(self.wanted, name, part))
            for name, part in parts_of(self.wanted.limited, formulas)
        ]
        rows += [
            (name, *side)
            for name, region, x, y in pairs_of(self.wanted, formulas)
            for side in hull_parts(name, region, x, y)
        ]
        kept = tuple((name, part, narrowed(limits, self.spare)) for name, part, limits in rows)
        object.__setattr__(self, "limited", kept)

    @classmethod
    def of(cls, scaled: ScaledProblem) -> SearchTargets:
        """The targets of a problem; a last point that repeats the first counts as its second half."""
        last = -1 if scaled.problem.task.returns else None
        curve = scaled.wanted_torque
        weights, turn_weights = scaled.weights[:last].copy(), scaled.turn_weights[:last].copy()
        if last:
            weights[0] += scaled.weights[-1]
            turn_weights[0] += scaled.turn_weights[-1]
        return cls(
            points=scaled.targets[:last],
            weights=weights,
            turns=scaled.turns[:last],
            turn_weights=turn_weights,
            timing=scaled.timing[:last],
            wanted=scaled.wanted,
            closed=scaled.closed,
            exact=scaled.exact,
            kind=scaled.kind,
            torque=curve if curve is not None and curve.weight else None,
            count=len(scaled.targets),
            at=tuple(replace(limit, k=limit.k % len(weights)) for limit in scaled.at_targets),
            frame=scaled.frame,
        )

    @property
    def timed(self) -> bool:
        """Whether the driver rotations are prescribed."""
        return bool(self.timing.any())

    @property
    def transmitting(self) -> bool:
        """Whether loops have the required transmission angle by construction: all round the turn.

        Of least squares alone: where all targets are met, the search gains no time, and finds fewer designs.
        """
        wanted = self.wanted
        turning = wanted.rotatability is not Rotatability.ANY
        over_turn = self.closed or wanted.transmission_over is TransmissionOver.CYCLE
        possible = 0 < wanted.transmission_min_deg <= STEEPEST
        return turning and over_turn and possible and not self.exact

    @property
    def has_angles(self) -> bool:
        """Whether any target has an angle."""
        return bool(self.turn_weights.any())

    @property
    def jumbled(self) -> bool:
        """Whether the driver may meet the targets in any order."""
        return not self.timed and not self.wanted.order

    @property
    def steps(self) -> FloatArray:
        """Distance from each target to the next, shape (N - 1,), sizes; never quite zero."""
        given = self.weights > 0
        step = np.abs(np.diff(self.points)) * (given[1:] & given[:-1])
        given = self.turn_weights > 0
        turned = np.abs(np.angle(np.exp(1j * np.diff(self.turns)))) * (given[1:] & given[:-1])
        step = np.hypot(step, np.sqrt(self.turn_weights.max()) * turned)
        steps: FloatArray = np.maximum(step, SHORTEST * max(step.max(), SHORTEST))
        return steps

    @property
    def unknowns(self) -> int:
        """Proportions, and driver angles or the numbers that they are made of."""
        if self.timed:
            return self.kind.proportions + 1
        return self.kind.proportions + len(self.points) + self.wanted.order


def narrowed(limits: Limits, share: float) -> Limits:
    """Limits that are narrower by a share of themselves, but by no more than that share of their width."""
    low, high = limits
    less, more = (share * min(abs(limit), high - low) if np.isfinite(limit) else 0.0 for limit in limits)
    return low + less, high - more


@dataclass(frozen=True, slots=True)
class Batch:
    """Linkages of a search."""

    # (n, M): proportions, then the first driver angle and the logarithms of the gaps between the driver
    # angles and of the rest of the turn (ordered), or all driver angles
    unknowns: FloatArray
    longer_driver: BoolArray  # (n,), r2 > r1: among full cranks a double-crank
    assembly: FloatArray  # (n, N)
    direction: FloatArray  # (n,), sense of the driver

    def __len__(self) -> int:
        return len(self.unknowns)

    def __getitem__(self, index: IntArray | BoolArray | slice) -> Batch:
        return Batch(*(getattr(self, name)[index] for name in self.__slots__))


def joined(first: Batch, second: Batch) -> Batch:
    """Two batches as one."""
    return Batch(
        *(np.concatenate([getattr(batch, name) for batch in (first, second)]) for name in Batch.__slots__)
    )


class Leading(Protocol):
    """The link that leads P at every target; z0 + z1 origin + z2 along is P."""

    @property
    def origin(self) -> ComplexArray:
        """Its origin, (n, N)."""

    @property
    def along(self) -> ComplexArray:
        """Its direction, (n, N)."""

    @property
    def closes(self) -> BoolArray:
        """Whether the loops close everywhere, (n,)."""


@dataclass(frozen=True)
class Loop:
    """The closed loop in the frame of its kind, at every point; derivatives by the unknowns."""

    r2: FloatArray
    r3: FloatArray
    r4: FloatArray
    slopes: FloatArray | Callable[[], FloatArray]  # as `by_lengths`, or a function that gives them
    theta2: FloatArray
    e2: ComplexArray
    e3: ComplexArray
    e4: ComplexArray
    rod: FloatArray  # r3, (n, N) or (n, 1)
    closes: BoolArray

    @cached_property
    def by_lengths(self) -> FloatArray:
        """Derivatives of r2, r3, r4 by the proportions, (n, 3, 3)."""
        return self.slopes() if callable(self.slopes) else self.slopes

    @property
    def origin(self) -> ComplexArray:
        """That of the coupler in A, for a crank of length 1."""
        return self.e2

    @property
    def along(self) -> ComplexArray:
        """That of the coupler."""
        return self.e3

    @classmethod
    def of(cls, target: SearchTargets, batch: Batch) -> Loop:
        """Close the loop of every linkage at every target."""
        proportions = batch.unknowns[:, :PROPORTIONS]
        shape = target.kind.transmitting if target.transmitting else target.kind.lengths
        lengths, slopes = shape(proportions, batch.longer_driver, target.wanted)
        theta2 = driver_angles(target, batch.unknowns[:, PROPORTIONS:], batch.direction)
        e2 = np.exp(1j * theta2)
        e3, e4, rod, closes = target.kind.closed(lengths, e2, batch.assembly)
        return cls(*lengths, slopes, theta2, e2, e3, e4, rod, closes)


def driver_angles(target: SearchTargets, unknowns: FloatArray, direction: FloatArray) -> FloatArray:
    """Driver angles (n, N) from the unknowns that they are made of, (n, K)."""
    sense = direction[:, None]
    if target.timed:
        return unknowns[:, :1] + sense * target.timing
    if target.jumbled:
        return unknowns
    _, gone = shares_of_turn(unknowns[:, 1:])
    return unknowns[:, :1] + TURN * sense * gone


def by_angles(target: SearchTargets, batch: Batch, before: int = PROPORTIONS, places: int = 0) -> FloatArray:
    """Derivative of the driver angles, (n, N, M), by all unknowns.

    `before` them are those of the shape, after them a number of `places`.
    """
    n, first, end = len(target.points), before + 1, batch.unknowns.shape[1] - places
    slope = np.zeros((len(batch), n, end + places))
    if target.jumbled:
        slope[:, :, before:end] = np.eye(n)
        return slope
    slope[:, :, before] = 1
    if not target.timed:
        share, gone = shares_of_turn(batch.unknowns[:, first:end])
        np.subtract(np.tril(np.ones((n, n)), -1), gone[:, :, None], out=slope[:, :, first:end])
        slope[:, :, first:end] *= (TURN * batch.direction[:, None] * share)[:, None]
    return slope


def shares_of_turn(log_gaps: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Shares of a turn: gaps between N driver angles and the rest, and the way to each angle; (n, N)."""
    share = np.exp(log_gaps - log_gaps.max(axis=1, keepdims=True))
    share /= share.sum(axis=1, keepdims=True)
    return share, np.concatenate([np.zeros((len(share), 1)), np.cumsum(share[:, :-1], axis=1)], axis=1)


def body_turns(target: SearchTargets, at: Leading) -> tuple[FloatArray, FloatArray]:
    """Angles of the body missed, weighted (n, N), and the best angle from the coupler in the loop (n,)."""
    if not target.has_angles:
        return np.zeros((len(at.along), 0)), np.zeros(len(at.along))  # no target has an angle
    weights = target.turn_weights
    off = np.exp(1j * target.turns) * at.along.conj()
    middle = np.angle((weights * off).sum(axis=1))  # how the body sits on the coupler is solved for exactly
    missed = np.angle(off * np.exp(-1j * middle)[:, None])
    mean = (weights * missed).sum(axis=1) / weights.sum()
    return np.sqrt(weights) * (missed - mean[:, None]), middle + mean


def by_body_turns(target: SearchTargets, by_theta3: FloatArray) -> FloatArray:
    """Derivative of `body_turns` by the unknowns, (n, N, M) or (n, 0, M)."""
    if not target.has_angles:
        return by_theta3[:, :0]
    weights = target.turn_weights
    mean = np.einsum("i,sim->sm", weights, by_theta3) / weights.sum()
    slope: FloatArray = np.sqrt(weights)[:, None] * (mean[:, None] - by_theta3)
    return slope


def by_theta3_of(loop: Loop, by_theta2: FloatArray) -> FloatArray:
    """Derivative of theta3 by the unknowns, (n, N, M), from the loop equation projected on O4B."""
    driver, coupler = loop.e2 * loop.e4.conj(), loop.e3 * loop.e4.conj()
    below = loop.rod * coupler.imag
    slope = (-(loop.r2[:, None] * driver.imag) / below)[..., None] * by_theta2
    by_r2, by_r3, by_r4 = (loop.by_lengths[:, None, i] for i in range(3))
    lengths = driver.real[..., None] * by_r2 + coupler.real[..., None] * by_r3 - by_r4
    slope[:, :, :3] += lengths / below[..., None]
    return slope
