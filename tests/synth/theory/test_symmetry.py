"""Which rotations and reflections a task allows, and what they make of a linkage."""

from __future__ import annotations

import tracemalloc
from typing import Any

import numpy as np
import pytest

from grashof.analysis import verify
from grashof.analysis.judge.planted import random_full_crank
from grashof.problems import FourBar, MotionTask, PathTask, Requirements, Task, load
from grashof.synth.theory.distinct import signature
from grashof.synth.theory.symmetry import symmetries

TURN = np.linspace(0, 2 * np.pi, 8, endpoint=False)
ELLIPSE = np.column_stack([3 + 4 * np.cos(TURN), 1 + 2 * np.sin(TURN)])
BOW = np.array([[-3.0, 0], [-1, 1], [1, 1], [3, 0]])  # mirrored in the y axis


def closed(points: Any, **timing: Any) -> PathTask:
    return PathTask(points, closed=True, **timing)


@pytest.mark.parametrize(
    ("task", "count"),
    [
        (PathTask(BOW), 2),
        (PathTask(BOW @ np.array([[0.6, 0.8], [-0.8, 0.6]]) + [50, -70]), 2),
        (PathTask(BOW[[0, 2, 1, 3]]), 2),  # visited otherwise, as even
        (PathTask(BOW[[1, 0, 2, 3]]), 1),  # the order is not even
        (PathTask([[-3, 0], [-1, 1], [1, 1.1], [3, 0]]), 1),
        (PathTask([[0, 0], [1, 0], [3, 0]]), 2),  # on a line, unevenly
        (PathTask([[0, 0], [1, 1], [2, 2]]), 4),
        (closed(ELLIPSE), 4),
        (closed([*ELLIPSE, ELLIPSE[0]]), 4),  # the last point is the first again
        (PathTask(ELLIPSE), 1),  # the gap is at one end of an axis, between two points
        (closed(np.column_stack([np.cos(TURN), np.sin(TURN)])), 16),
        (closed([[0, 0], [4, 0], [1, 2]]), 1),
        (PathTask(BOW, timing=[0, 1, 2, 3]), 2),
        (PathTask(BOW, timing=[0, 1, 2.5, 3]), 1),
        (closed(ELLIPSE, timing=TURN), 4),
        (closed(ELLIPSE, timing=np.sort(TURN**2 / 7)), 1),
        (MotionTask(BOW, [0.3, 0.1, -0.1, -0.3]), 2),
        (MotionTask(BOW, [1.3, 1.1, 0.9, 0.7]), 2),  # the body may sit on the coupler as it likes
        (MotionTask(BOW, [0.3, 0.1, 0.1, 0.3]), 1),
        (MotionTask(BOW, [0.3, 0.1, -0.1, -0.3], weights=[1, 1, 1, 2]), 1),
        (MotionTask(BOW, [0.3, np.nan, np.nan, -0.3]), 2),
        (MotionTask(BOW, [0.3, np.nan, -0.1, -0.3]), 1),
        (MotionTask([[1, 2], [1, 2], [1, 2]], [0.0, 0.2, 0.4], angle_length=1), 1),
        (load("luggage").task, 1),
        (load("path-ellipse").task, 2),  # nine points round it
        (load("path-vertical-line").task, 4),
    ],
)  # fmt: skip
def test_symmetries_are_counted(task: Task, count: int) -> None:
    found = symmetries(task)
    assert (found[0].turn, found[0].mirrored) == (1, False)
    distinct = {(round(each.turn.real, 6), round(each.turn.imag, 6), each.mirrored) for each in found}
    assert len(distinct) == count


@pytest.mark.parametrize("seed", range(4))
def test_a_mirrored_linkage_does_the_mirrored_task(seed: int) -> None:
    """By the judge: what a symmetry makes of a design meets the points as well as the design does."""
    linkage = random_full_crank(np.random.default_rng(seed))
    task = closed(load("path-ellipse").task.positions[:-1])
    wanted = Requirements(exact=False, rotatability_margin=0, transmission_min_deg=0)
    middle = task.positions.mean(axis=0)
    verdict = verify(linkage, task, wanted)
    for each in symmetries(task):
        made = each.of(signature(linkage, middle)[None])[0]
        other = FourBar(
            o2=made[:2] + middle, o4=made[2:4] + middle, r2=made[4], r3=made[5], r4=made[6],
            coupler_point=made[7:], assembly=-linkage.assembly if each.mirrored else linkage.assembly,
        )  # fmt: skip
        np.testing.assert_allclose(other.lengths, linkage.lengths, rtol=1e-12)
        again = verify(other, task, wanted)
        assert again.error_sse == pytest.approx(verdict.error_sse, rel=1e-3)
        assert again.transmission_min_cycle == pytest.approx(verdict.transmission_min_cycle)


@pytest.mark.quick("1")
@pytest.mark.slow
@pytest.mark.parametrize("sides", [1, 2, 3, 12])
def test_symmetries_of_long_closed_paths_take_no_square_of_their_points(sides: int) -> None:
    """A star with n points has n rotations, each with a reflection; 2.3 GB of orders else."""
    count = 12_000
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    radius = 1 + 0.3 * np.cos(sides * angle)
    shift = 0.2 * np.exp(2j * angle) if sides == 1 else 0.0  # the star with one point is mirrored alone
    points = radius * np.exp(1j * angle) + shift
    tracemalloc.start()
    found = symmetries(closed(np.column_stack([points.real, points.imag])))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    turns = {(round(each.turn.real, 1), round(each.turn.imag, 1), each.mirrored) for each in found}
    assert len(turns) == 2 * sides
    assert peak < 50e6
