"""A task stated in Python, with a constraint of one's own: ground pivots level with each other.

Copy it, change the poses and the constraint, and run it: the table and own-task.csv are yours.
"""

import sys
from collections.abc import Sequence
from typing import Any

from grashof import synthesize
from grashof.analysis import Design
from grashof.problems import MotionTask, Problem, Requirements

POSES = [[0, 0, 0], [2, 1, 20], [3, 3, 50]]  # x, y, angle in degrees


def level(design: Design) -> Any:
    """Zero or negative when O2 and O4 differ in height by no more than 0.1."""
    return (design.o2[1] - design.o4[1]) ** 2 - 0.1**2


def short_driver(design: Design) -> Any:
    """Zero or negative when the driver is no longer than a third of the coupler."""
    return design.r2 - design.r3 / 3


def main(argv: Sequence[str] | None = None) -> int:
    """Find linkages, print the best ones and write them all."""
    target = (argv if argv is not None else sys.argv[1:]) or ["own-task.csv"]
    problem = Problem(
        task=MotionTask.from_degrees(POSES),
        requirements=Requirements(transmission_min_deg=30, link_length=(0.2, 10)),
    )
    result = synthesize(problem, constraints=[level, short_driver])
    columns = ["rank", "o2_y", "o4_y", "r2", "r3", "transmission_min_task_deg", "error_max"]
    print(result.to_frame()[columns].head(10).to_string(index=False))
    result.to_csv(target[0])
    return 0


if __name__ == "__main__":
    sys.exit(main())
