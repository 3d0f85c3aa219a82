"""Limits that just hold a planted linkage."""

import numpy as np

from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Box, MotionTask
from grashof.problems.values.arrays import Limits

INSIDE = 1e-6  # sizes, by which they hold it


def planted_limits(seed: int, poses: int) -> tuple[MotionTask, dict[str, Limits], dict[str, Box]]:
    """A planted task, and limits of the lengths and boxes of the pivots of its linkage."""
    task, linkage = planted_motion(np.random.default_rng(seed), poses)
    room, margin = 0.02 * float(task.size), INSIDE * float(task.size)
    lengths = {
        name: (float(length) - room, float(length) + margin)
        for name, length in zip(("r1", "r2", "r3", "r4"), linkage.lengths, strict=True)
    }
    boxes = {
        name: Box((float(x) - room, float(x) + margin), (float(y) - margin, float(y) + room))
        for name, (x, y) in (("o2", linkage.o2), ("o4", linkage.o4))
    }
    return task, lengths, boxes
