"""Count planted pose tasks that a search solves, in a grid of kinds, poses, free parts and limits.

    python scripts/planted_poses.py --count 20

A task is solved where one design is verified and its coupler is at every pose. The planted linkages are
random full cranks, and meet all that is stated.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import product
from time import perf_counter
from typing import Any

import numpy as np

from grashof import synthesize
from grashof.analysis import solve_position, verify
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Box, Linkage, MotionTask, Problem, ProblemError, Requirements
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.synth.designs.candidate import Candidate

KINDS = tuple(ONE_LOOP)
STATED = ("nothing", "direction", "o2", "other pivot", "both pivots", "brackets", "direction and brackets")
ROUGH = 1e-6  # sizes and rad


@dataclass(frozen=True, slots=True)
class Cell:
    """Planted tasks of one sort.

    Parameters
    ----------
    kind : str
    poses : int
    parts : {"whole", "free"}
        Free: the angle of one pose, and of four or more also the position of another one.
    stated : str
    """

    kind: str
    poses: int
    parts: str
    stated: str

    @property
    def has_meaning(self) -> bool:
        """Whether that kind has what is stated."""
        return "o4" in ONE_LOOP[self.kind].ground or self.stated not in ("other pivot", "both pivots")


CELLS = [cell for cell in (Cell(*each) for each in product(KINDS, (2, 3, 4, 5), ("whole", "free"), STATED))
         if cell.has_meaning]  # fmt: skip


def planted(cell: Cell, rng: np.random.Generator) -> tuple[Problem, Linkage]:
    """A problem, and a linkage that meets it."""
    while True:
        task, linkage = planted_motion(rng, cell.poses, mechanism=cell.kind)
        if cell.parts == "free":
            task = with_free_parts(task, rng)
        wanted = Requirements(**limits(cell, linkage, rng))
        if verify(linkage, task, wanted).ok:
            return Problem(task=task, mechanism=(cell.kind,), requirements=wanted), linkage


def with_free_parts(task: MotionTask, rng: np.random.Generator) -> MotionTask:
    """The task with the angle of one pose free, and the position of another one of four or more."""
    positions, angles = task.positions.copy(), task.angles.copy()
    first, second = 1 + rng.permutation(max(len(task) - 2, 1))[:2] if len(task) > 3 else (1, 1)
    angles[first] = np.nan
    if len(task) > 3:
        positions[second] = np.nan
    return MotionTask(positions, angles)


def limits(cell: Cell, linkage: Linkage, rng: np.random.Generator) -> dict[str, Any]:
    """What the cell states of the planted linkage, as `Requirements` takes it."""
    found: dict[str, Any] = {}
    if "direction" in cell.stated:
        if linkage.mechanism.loops[0].slide_angle:  # 180 deg more is the same line
            angle = float(np.degrees(linkage.slide_angle)) + 180 * int(rng.integers(2))
            found["slide_angle_deg"] = angle
        else:
            found["ground_angle_deg"] = float(np.degrees(linkage.theta1))
    if cell.stated in ("o2", "both pivots"):
        found["o2"] = point(linkage.o2)
    if cell.stated in ("other pivot", "both pivots"):
        found["o4"] = point(linkage.o4)
    if "brackets" in cell.stated:
        found |= brackets(linkage)
    return found


def brackets(linkage: Linkage) -> dict[str, Box]:
    """A, and B where it has a place on the body, in the frame of the body."""
    turned = np.exp(-1j * float(linkage.body_angle))
    arm = complex(*linkage.coupler_point)
    places = {"a_on_body": -arm * turned}
    if hasattr(linkage, "r3"):
        places["b_on_body"] = (float(linkage.r3) - arm) * turned
    return {name: point((place.real, place.imag)) for name, place in places.items()}


def point(place: Any) -> Box:
    """The box that is a point."""
    x, y = (float(each) for each in place)
    return Box((x, x), (y, y))


def missed(problem: Problem, linkage: Linkage, theta2: np.ndarray) -> float:
    """Greatest distance from a target, sizes, or turn from one, rad."""
    task, state = problem.task, solve_position(linkage, theta2)
    off = np.hypot(*(state.p - task.positions).T) / task.size
    turned = np.angle(np.exp(1j * (state.theta3 + float(linkage.body_angle) - task.angles)))
    return float(np.nanmax(np.concatenate([off, np.abs(turned)])))


def run(cell: Cell, count: int, seed: int, limit: float) -> Iterator[tuple[bool, float]]:
    """Whether each planted task is solved, and the time it takes in s."""
    for number in range(count):
        problem, _ = planted(cell, np.random.default_rng([seed, number]))
        since = perf_counter()
        designs: Sequence[Candidate] = []
        with suppress(ProblemError):  # refused
            designs = synthesize(problem, enough=1, time_limit=limit).candidates
        seconds = perf_counter() - since
        yield any(missed(problem, one.linkage, one.verdict.theta2) < ROUGH for one in designs), seconds


def main(argv: Sequence[str] | None = None) -> int:
    """Measure and print; see the module."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--count", type=int, default=20, help="number of tasks of each cell")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--limit", type=float, default=20.0, help="seconds a task")
    parser.add_argument("--only", default="", help="part of the name of a cell")
    parser.add_argument("--share", type=float, default=0.95, help="share of a cell that has to be solved")
    given = parser.parse_args(argv)
    short = 0
    for cell in CELLS:
        name = f"{cell.kind}, {cell.poses} {cell.parts} poses, {cell.stated}"
        if given.only not in name:
            continue
        solved, seconds = zip(*run(cell, given.count, given.seed, given.limit), strict=True)
        lacks = sum(solved) < given.share * given.count
        short += lacks
        print(
            f"{name:62} {sum(solved):3} of {given.count}{' !' if lacks else '  '}  "
            f"median {np.median(seconds):.2f} s, longest {max(seconds):.2f} s",
            flush=True,
        )
    print(f"{short} cells with fewer than {given.share:.0%}")
    return 1 if short else 0


if __name__ == "__main__":
    sys.exit(main())
