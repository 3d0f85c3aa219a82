"""How far designs are apart, in words of their own."""

import numpy as np

from grashof.problems import FourBar, Task


def share_apart(task: Task, one: FourBar, other: FourBar) -> float:
    """As DESIGN section 2 words it, seen from the middle of the task; above 0.01 for distinct designs."""
    middle = task.positions.mean(axis=0)
    x, y = (
        np.array([*(a.o2 - middle), *(a.o4 - middle), a.r2, a.r3, a.r4, *a.coupler_point])
        for a in (one, other)
    )
    return float(np.abs(x - y).max() / np.abs([x, y]).max())
