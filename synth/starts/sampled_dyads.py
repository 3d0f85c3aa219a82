"""Random dyads of two and three poses, and random places for their pivots."""

from __future__ import annotations

import numpy as np

from grashof.problems import Box, Requirements
from grashof.problems.values.arrays import ComplexArray, Limits
from grashof.synth.theory.burmester import Displacements, Dyads
from grashof.synth.theory.three_poses import (
    bisector_dyads,
    bisector_dyads_of_ground,
    circle_dyads,
    circle_dyads_of_ground,
)

SAMPLES = 4000


def sampled_dyads(
    motion: Displacements,
    body: complex,
    wanted: Requirements,
    rng: np.random.Generator,
    samples: int = SAMPLES,
) -> Dyads:
    """Random dyads of two or three poses: half of them by the joint, half by the pivot.

    `body` is the guided point at the first pose, sizes.
    """
    longest = max(limits[1] for limits in wanted.link_lengths)
    moving = body + arms(wanted.coupler_arms, samples, rng)
    ground = np.concatenate([ground_pivots(box, longest, samples, rng) for box in (wanted.o2, wanted.o4)])
    if len(motion.shift) == 3:
        halves = circle_dyads(motion, moving), circle_dyads_of_ground(motion, ground)
    else:
        halves = (
            bisector_dyads(motion, moving, rng.normal(0, min(longest, 3.0), len(moving))),
            bisector_dyads_of_ground(motion, ground, rng.normal(0, min(longest, 3.0), len(ground))),
        )
    both = joined(*halves)
    return both[np.isfinite(both.moving) & np.isfinite(both.ground)]


def arms(limits: Limits | None, count: int, rng: np.random.Generator) -> ComplexArray:
    """Random arms from the coupler point to a joint, shape (count,), sizes."""
    least, most = limits or (0.0, np.inf)
    low, high = max(least, 0.01), min(max(most, 0.02), 100.0)
    radius = np.exp(rng.uniform(np.log(low), np.log(high), count))
    placed: ComplexArray = radius * np.exp(1j * rng.uniform(-np.pi, np.pi, count))
    return placed


def ground_pivots(box: Box | None, longest: float, samples: int, rng: np.random.Generator) -> ComplexArray:
    """Random places of a ground pivot inside its box, within reach of the task; few where it is fixed."""
    reach = min(3.0 + longest, 100.0)
    x, y = (
        (max(low, -reach), min(high, reach)) if low < reach and high > -reach else (low, high)
        for low, high in (((box or Box()).x), ((box or Box()).y))
    )
    count = samples // 2 if x[0] < x[1] or y[0] < y[1] else samples // 20
    wide = rng.uniform(*x, count) + 1j * rng.uniform(*y, count)
    near = np.clip(rng.normal(0, 1.5, count), *x) + 1j * np.clip(rng.normal(0, 1.5, count), *y)
    return np.where(rng.random(count) < 0.5, wide, near)


def fixed_pivots(wanted: Requirements) -> dict[str, complex]:
    """Ground pivots whose place is given, by name."""
    return {
        name: complex(box.x[0], box.y[0])
        for name, box in (("O2", wanted.o2), ("O4", wanted.o4))
        if box is not None and box.x[0] == box.x[1] and box.y[0] == box.y[1]
    }


def joined(first: Dyads, second: Dyads) -> Dyads:
    """Two lots of dyads as one."""
    return Dyads(np.concatenate([first.moving, second.moving]), np.concatenate([first.ground, second.ground]))
