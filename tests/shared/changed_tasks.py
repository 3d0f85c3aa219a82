"""Motion tasks with parts left free, or with noise."""

from typing import Any

import numpy as np

from grashof.problems import MotionTask


def freed(task: MotionTask, places: Any, angles: Any, **rest: Any) -> MotionTask:
    """The task without the positions and angles at given indices."""
    positions, turned = task.positions.copy(), task.angles.copy()
    positions[places], turned[angles] = np.nan, np.nan
    return MotionTask(positions, turned, **rest)


def perturbed(task: MotionTask, rng: np.random.Generator, share: float, **rest: Any) -> MotionTask:
    """The task with normal noise, a share of its size and as much in rad."""
    noise = rng.normal(0, share, (len(task), 3))
    return MotionTask(task.positions + task.size * noise[:, :2], task.angles + noise[:, 2], **rest)
