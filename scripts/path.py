"""A path stated in Python: solved, compared with a published design, drawn. Copy and change it.

Six points of a vertical line (Cabrera et al. 2002), to be passed in order by a crank-rocker. Writes
path.csv and a drawing (PNG and SVG) of the best designs into the folder given as the first argument,
or into the current one.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from grashof import synthesize
from grashof.analysis import verify
from grashof.figures import draw_design, save
from grashof.problems import Box, FourBar, PathTask, Problem, Requirements, Rotatability


def vertical_line() -> Problem:
    """The problem: points in order, no timing, and the limits it was published with."""
    around = Box(x=(-60, 60), y=(-60, 60))
    return Problem(
        name="path",
        title="Six points of a vertical line",
        task=PathTask([[20, 20], [20, 25], [20, 30], [20, 35], [20, 40], [20, 45]]),
        requirements=Requirements(
            rotatability=Rotatability.CRANK_ROCKER, link_length=(5, 60), o2=around, o4=around
        ),
    )


def published() -> FourBar:
    """The design of Cabrera et al. (2002), found by a genetic algorithm."""
    o2, theta0 = np.array([29.7225, 23.4545]), 6.20163
    return FourBar(
        o2=o2,
        o4=o2 + 39.46629 * np.array([np.cos(theta0), np.sin(theta0)]),
        r2=8.56291,
        r3=19.09486,
        r4=47.83886,
        coupler_point=(13.38556, 12.21961),
        assembly=1,
    )


def main(argv: Sequence[str] | None = None) -> int:
    """Solve, write, and compare; 1 when there is no design."""
    arguments = sys.argv[1:] if argv is None else argv
    folder = Path(arguments[0] if arguments else ".")
    folder.mkdir(parents=True, exist_ok=True)

    problem = vertical_line()
    result = synthesize(problem, seed=0)
    if not result.candidates:
        print(result.note)
        return 1

    result.to_csv(folder / "path.csv")
    for rank, candidate in enumerate(result.candidates[:3], start=1):
        figure = draw_design(problem, candidate, rank)
        save(figure, [folder / f"path-{rank}.png", folder / f"path-{rank}.svg"])

    theirs = verify(published(), problem.task, problem.requirements)
    best = result.best.verdict
    print(f"{len(result)} designs in {folder / 'path.csv'}")
    for name, verdict in (("published", theirs), ("best of the list", best)):
        angle = np.degrees(verdict.transmission_min_task)
        print(f"{name}: SSE {verdict.error_sse:.3g}, worst transmission angle over the task {angle:.1f} deg")
    return 0


if __name__ == "__main__":
    sys.exit(main())
