"""Dyads of whole poses: random ones of two and three, those of stated places of four, and random places."""

from __future__ import annotations

import numpy as np

from grashof.problems import Box, Requirements
from grashof.problems.values.arrays import ComplexArray, FloatArray, Limits
from grashof.synth.quantities.regions import into
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.burmester import (
    Displacements,
    Dyads,
    bisector_dyads,
    bisector_dyads_of_ground,
    circle_dyads,
    circle_dyads_of_ground,
    radius_error,
)

SAMPLES = 4000
ON_CURVE = 1e-9  # radius error in sizes
_GOLDEN = (np.sqrt(5) - 1) / 2  # steps of it, modulo 1, fill a range evenly


def sampled_dyads(
    scaled: ScaledProblem, motion: Displacements, rng: np.random.Generator, samples: int = SAMPLES
) -> Dyads:
    """Random dyads of two or three poses: half of them by the joint, half by the pivot."""
    wanted = scaled.wanted
    longest = max(limits[1] for limits in wanted.link_lengths)
    moving = _moving_joints(scaled, longest, samples, rng)
    ground = np.concatenate([ground_pivots(box, longest, samples, rng) for box in (wanted.o2, wanted.o4)])
    if len(motion.shift) == 3:
        halves = circle_dyads(motion, moving), circle_dyads_of_ground(motion, ground)
    else:
        offset = _along_ground(motion, moving, rng.normal(0, min(longest, 3.0), len(moving)), wanted)
        halves = (
            bisector_dyads(motion, moving, offset),
            bisector_dyads_of_ground(motion, ground, rng.normal(0, min(longest, 3.0), len(ground))),
        )
    both = joined(*halves)
    return both[np.isfinite(both.moving) & np.isfinite(both.ground)]


def _along_ground(
    motion: Displacements, moving: ComplexArray, offset: FloatArray, wanted: Requirements
) -> FloatArray:
    """Offsets of dyads of two poses, for grounds of the stated direction."""
    if wanted.ground_angle_deg is None:
        return offset
    half = len(moving) // 2
    ((low, high),) = wanted.ranges("ground_angle_deg").values()
    along = np.exp(-1j * (low + (high - low) * (np.arange(half) * _GOLDEN % 1)))
    middle = bisector_dyads(motion, moving, np.zeros_like(offset)).ground
    across = bisector_dyads(motion, moving, np.ones_like(offset)).ground - middle
    # each pivot of the second half in that direction from its like in the first
    first, second = slice(0, half), slice(half, 2 * half)
    apart = (middle + across * offset)[first] - middle[second]
    with np.errstate(divide="ignore", invalid="ignore"):
        offset[second] = (apart * along).imag / (across[second] * along).imag
    return offset


def stated_dyads(scaled: ScaledProblem, motion: Displacements) -> Dyads:
    """Dyads of four poses with a ground pivot, or a joint on the body, in a stated place on its curve."""
    wanted, three = scaled.wanted, Displacements(motion.rotation[:3], motion.shift[:3])
    ground = np.array(list(fixed_pivots(wanted).values()), dtype=np.complex128)
    moving = [
        _on_body(scaled, np.array([complex(box.x[0], box.y[0])]))
        for box in (wanted.a_on_body, wanted.b_on_body)
        if box is not None and is_point(box)
    ]
    of_joints = circle_dyads(three, np.concatenate(moving)) if moving else Dyads(ground[:0], ground[:0])
    both = joined(circle_dyads_of_ground(three, ground), of_joints)
    both = both[np.isfinite(both.moving) & np.isfinite(both.ground)]
    return both[radius_error(motion, both) < ON_CURVE]


def with_stated_joints(scaled: ScaledProblem, dyads: Dyads) -> Dyads:
    """Those of some dyads whose joint may be A or B, by the limits of their places on the body."""
    boxes = scaled.wanted.a_on_body, scaled.wanted.b_on_body
    places = (dyads.moving - scaled.targets[0]) * np.exp(-1j * scaled.turns[0])
    inside = [
        np.ones(len(dyads), dtype=bool)
        if box is None
        else (np.abs(places.real - np.clip(places.real, *box.x)) < ON_CURVE)
        & (np.abs(places.imag - np.clip(places.imag, *box.y)) < ON_CURVE)
        for box in boxes
    ]
    return dyads[inside[0] | inside[1]]


def _moving_joints(
    scaled: ScaledProblem, longest: float, samples: int, rng: np.random.Generator
) -> ComplexArray:
    """Random joints at the first pose: in their boxes on the body, or about the guided point."""
    wanted = scaled.wanted
    boxes = wanted.a_on_body, wanted.b_on_body
    if boxes == (None, None):
        about: ComplexArray = scaled.targets[0] + arms(wanted.coupler_arms, samples, rng)
        return about
    half = samples // 2
    each = [
        scaled.targets[0] + arms(wanted.coupler_arms, half, rng)
        if box is None
        else _on_body(scaled, ground_pivots(box, longest, half, rng))
        for box in boxes
    ]
    return np.concatenate(each)


def _on_body(scaled: ScaledProblem, places: ComplexArray) -> ComplexArray:
    """Where places on the body, from the guided point, are at the first pose."""
    at_first: ComplexArray = scaled.targets[0] + places * np.exp(1j * scaled.turns[0])
    return at_first


def arms(limits: Limits | None, count: int, rng: np.random.Generator) -> ComplexArray:
    """Random arms from the coupler point to a joint, shape (count,), sizes."""
    least, most = limits or (0.0, np.inf)
    low, high = max(least, 0.01), min(max(most, 0.02), 100.0)
    radius = np.exp(rng.uniform(np.log(low), np.log(high), count))
    placed: ComplexArray = radius * np.exp(1j * rng.uniform(-np.pi, np.pi, count))
    return placed


def ground_pivots(box: Box | None, longest: float, samples: int, rng: np.random.Generator) -> ComplexArray:
    """Random places of a ground pivot where it may be, within reach of the task; few where it is fixed."""
    reach = min(3.0 + longest, 100.0)
    x, y = (
        (max(low, -reach), min(high, reach)) if low < reach and high > -reach else (low, high)
        for low, high in (((box or Box()).x), ((box or Box()).y))
    )
    count = samples // 2 if x[0] < x[1] or y[0] < y[1] else samples // 20
    wide = rng.uniform(*x, count) + 1j * rng.uniform(*y, count)
    near = np.clip(rng.normal(0, 1.5, count), *x) + 1j * np.clip(rng.normal(0, 1.5, count), *y)
    return into(box, np.where(rng.random(count) < 0.5, wide, near))


def fixed_pivots(wanted: Requirements) -> dict[str, complex]:
    """Ground pivots whose place is given, by name."""
    return {
        name: complex(box.x[0], box.y[0])
        for name, box in (("O2", wanted.o2), ("O4", wanted.o4))
        if box is not None and is_point(box)
    }


def is_point(box: Box) -> bool:
    """Whether a box has no width."""
    return box.x[0] == box.x[1] and box.y[0] == box.y[1]


def joined(first: Dyads, second: Dyads) -> Dyads:
    """Two lots of dyads as one."""
    return Dyads(np.concatenate([first.moving, second.moving]), np.concatenate([first.ground, second.ground]))
