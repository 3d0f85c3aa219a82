"""The luggage problem stated in Python: copy this file and change it.

A box has to be lifted over a staircase through four poses. Writes luggage.csv and a drawing (PNG and
SVG) of each of the best designs into the folder given as the first argument, or into the current one.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from grashof import synthesize
from grashof.figures import draw_design, save
from grashof.problems import (
    DynamicsSpec,
    MotionTask,
    Problem,
    Requirements,
    Rotatability,
    TransmissionOver,
)


def luggage() -> Problem:
    """The problem: poses [x, y, angle in degrees], what is carried, what a design must satisfy, masses."""
    task = MotionTask.from_degrees(
        [[5, 4, 0], [3.5, 4, -5], [2, 3, -5], [1, 0, 0]],
        body=[[0, 0], [1, 0], [1, 1], [0, 1]],
    )
    requirements = Requirements(
        rotatability=Rotatability.FULL_CRANK,
        transmission_min_deg=15,
        transmission_over=TransmissionOver.TASK,
        link_length=(0.3, 8),
        coupler_arms=(0.3, 8),
    )
    dynamics = DynamicsSpec(
        masses=(0.3764, 0.4762, 0.4308),  # kg: links 2, 3 and 4
        inertias=(0.3282, 0.6646, 0.4920),  # kg m2, about their centres
        gravity=(0, -9.81),
    )
    return Problem(
        name="luggage",
        title="Luggage over a staircase",
        length_unit="m",
        task=task,
        requirements=requirements,
        dynamics=dynamics,
        outlines=(np.array([[0, 0], [5, 0], [5, 4], [8, 4]]),),
    )


def main(argv: Sequence[str] | None = None) -> int:
    """Solve, write, and print the best design; 1 when there is none."""
    arguments = sys.argv[1:] if argv is None else argv
    folder = Path(arguments[0] if arguments else ".")
    folder.mkdir(parents=True, exist_ok=True)

    result = synthesize(luggage(), seed=0)
    if not result.candidates:
        print(result.note)
        return 1

    result.to_csv(folder / "luggage.csv")
    for rank, candidate in enumerate(result.candidates[:3], start=1):
        figure = draw_design(result.problem, candidate, rank)
        save(figure, [folder / f"luggage-{rank}.png", folder / f"luggage-{rank}.svg"])

    best = result.best.linkage
    print(f"{len(result)} designs in {folder / 'luggage.csv'}; the best has r1..r4 =", best.lengths.round(4))
    return 0


if __name__ == "__main__":
    sys.exit(main())
