"""The luggage linkage by hand-tuned search, as its report found it, beside `grashof.synthesize`.

    python scripts/hand_tuned_search.py

The report guesses a dyad (a link W that turns by beta with the driver, an arm Z that turns with the box),
improves the guess by a quasi-Newton method until the closure equations have no residual, does so again for
the second dyad, and examines their linkage. It says that four guesses failed and the fifth worked.
Here each of them is run and judged by `grashof.analysis.verify`, then many random guesses, each paired with
every other.
"""

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.optimize import minimize

from grashof import load, synthesize
from grashof.analysis import Verdict, verify
from grashof.problems import FourBar, Problem, Requirements, Rotatability, Task, TransmissionOver
from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.synth.starts import dyad_pairs
from grashof.synth.theory.burmester import Displacements, Dyads

STARTS, JUDGED, RESAMPLED = 600, 100, 1000
TOLERANCE = 1e-5  # of the size of the task: a quasi-Newton method ends at some 1e-6 of a root of squares
REACH, TURNED = 6.0, 300.0  # ranges of random guesses, m and deg: those of the report
APART = 1e-3  # of the size: closer dyads count as one
GOOD = 30.0  # deg: the transmission angle that textbooks require
GREAT = 1e6  # m, or a ratio of links: no limit


class Guess(NamedTuple):
    """Guesses of both dyads, (W_x, W_y, Z_x, Z_y) and three turns in deg, and the report's words."""

    name: str
    left: tuple[float, ...]
    right: tuple[float, ...]
    said: str


GUESSES = (
    Guess(
        "T2", (5.58, 3.42, 5.5, 2.5, 10, -300, -250), (0.6, 4.4, 2.5, 0.5, 25, 50, -200),
        "misses poses, not feasible beyond 180 deg",
    ),
    Guess(
        "T3", (5.58, 5.42, 5.5, 5.5, 10, -250, -250), (0.6, 4.4, 2.5, 2.5, 25, 50, -200),
        "misses poses, turns fully",
    ),
    Guess(
        "T4", (5.58, 5.42, 5.5, 5.5, 10, -250, -250), (0.6, 4.4, 2.5, -2.5, 25, 50, -200),
        "turns fully, misses poses 3 and 4",
    ),
    Guess(
        "T5", (5.58, 5.42, 5.5, 5.5, 10, -250, -250), (0.6, 4.4, 2.5, -2.5, 25, 50, -200),
        "printed as T4: turns fully, misses pose 3",
    ),
    Guess(
        "T6", (0.58, 3.42, 2.5, 2.5, 10, -250, -250), (0.6, 4.4, -2.5, 0.5, 25, 50, -200), "works"
    ),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Dyad:
    """A dyad meant to pass the poses: W and Z in the first pose, turns of W to the others (rad).

    `residual`, a length, is the root of the sum of squares of the gaps at the poses.
    """

    link: complex
    arm: complex
    turns: tuple[float, ...]
    residual: float


@dataclass(frozen=True, slots=True)
class Tried:
    """A guess with its dyads, their linkage and the verdict on it."""

    guess: Guess
    left: Dyad
    right: Dyad
    linkage: FourBar
    verdict: Verdict


def residual_of(task: Task) -> Callable[[FloatArray], float]:
    """The root of the sum of squares, a length, of the gaps of a dyad (W_x, W_y, Z_x, Z_y, turns in rad).

    At each pose W (e^(i beta) - 1) + Z (e^(i alpha) - 1) = P - P1.
    """
    place = task.positions @ np.array([1, 1j])
    way, body = place[1:] - place[0], np.exp(1j * (task.angles[1:] - task.angles[0])) - 1

    def gap(x: FloatArray) -> float:
        open_by = complex(x[0], x[1]) * (np.exp(1j * x[4:]) - 1) + complex(x[2], x[3]) * body - way
        return float(np.sqrt((np.abs(open_by) ** 2).sum()))

    return gap


def improved(task: Task, guess: Sequence[float]) -> Dyad:
    """A dyad of least residual from a guess, its turns in deg; as in the report without derivatives."""
    start = np.concatenate([guess[:4], np.radians(guess[4:])])
    found = minimize(residual_of(task), start, method="BFGS")
    x = found.x
    return Dyad(complex(x[0], x[1]), complex(x[2], x[3]), tuple(x[4:].tolist()), float(found.fun))


def linkage_of(task: Task, left: Dyad, right: Dyad) -> FourBar:
    """The linkage of two dyads, the left one driven, on the assembly of the first pose."""
    first = complex(*task.positions[0])
    a, b = first - left.arm, first - right.arm
    along = (b - a) / abs(b - a)
    p = (first - a) / along
    pivots = [(joint - dyad.link) for joint, dyad in ((a, left), (b, right))]
    o2, o4 = ((pivot.real, pivot.imag) for pivot in pivots)
    assembly = np.sign((right.link / along).imag) or 1.0
    turned = float(task.angles[0] - np.angle(along))
    return FourBar(o2, o4, abs(left.link), abs(b - a), abs(right.link), (p.real, p.imag), assembly, turned)


def tried(problem: Problem, guess: Guess) -> Tried:
    """A guess of the report run and judged."""
    left, right = (improved(problem.task, each) for each in (guess.left, guess.right))
    linkage = linkage_of(problem.task, left, right)
    wanted = replace(problem.requirements, tolerance=TOLERANCE, rotatability=Rotatability.ANY)
    return Tried(guess, left, right, linkage, verify(linkage, problem.task, wanted))


def outcome(each: Tried) -> str:
    """The behaviour of a linkage in words."""
    verdict = each.verdict
    words = [str(verdict.grashof_class)]
    if not verdict.circuit_ok:
        words.append("no motion joins the poses (circuit defect)")
    elif not verdict.branch_ok:
        words.append("a dead position lies between the poses (branch defect)")
    elif not verdict.order_ok:
        words.append("meets the poses out of order")
    else:
        words.append("passes the poses in order")
    if verdict.branch_ok:
        words.append(f"mu {np.degrees(verdict.transmission_min_task):.2f} deg on the way")
    if verdict.full_rotation:
        words.append(f"{np.degrees(verdict.transmission_min_cycle):.2f} deg over the turn")
    return ", ".join(words)


def random_dyads(task: Task, starts: int, seed: int) -> list[Dyad]:
    """Dyads from random guesses by BFGS."""
    rng = np.random.default_rng(seed)
    guesses = np.hstack([rng.uniform(-REACH, REACH, (starts, 4)), rng.uniform(-TURNED, TURNED, (starts, 3))])
    return [improved(task, guess) for guess in guesses]


@dataclass(frozen=True, slots=True, eq=False)
class Pairs:
    """The pairs of dyads, the first of each driven, that have a property; arrays of shape (N, N)."""

    exact: BoolArray
    "Both close at all poses."
    in_order: BoolArray
    "One motion without dead position meets the poses in order, besides."
    crank_rocker: BoolArray
    "That is a crank-rocker, besides."
    usable: BoolArray
    "In order, a full crank, and all else that the problem requires."
    good: BoolArray
    "A crank-rocker whose transmission angle is `GOOD` over the turn."


def judged_pairs(problem: Problem, dyads: Sequence[Dyad]) -> Pairs:
    """The properties of all pairs at once, as the search screens them; `verify` agrees on each by itself."""
    task, size = problem.task, problem.task.size
    place = task.positions @ np.array([1, 1j])
    motion = Displacements.from_poses(place, task.angles)
    moving = place[0] - np.array([dyad.arm for dyad in dyads])
    every = Dyads(moving, moving - np.array([dyad.link for dyad in dyads]))
    closed = np.array([dyad.residual for dyad in dyads]) <= TOLERANCE * size
    exact = closed[:, None] & closed & (np.abs(moving[:, None] - moving) > APART * size)
    row, column = np.nonzero(exact)
    in_order = Requirements(
        rotatability=Rotatability.ANY, rotatability_margin=0, link_ratio_max=GREAT,
        r1=(APART * size, GREAT), link_length=(0, GREAT), coupler_arms=(0, GREAT),
    )  # fmt: skip
    crank_rocker = replace(in_order, rotatability=Rotatability.CRANK_ROCKER)
    good = replace(crank_rocker, transmission_over=TransmissionOver.CYCLE, transmission_min_deg=GOOD)
    held = []
    for wanted in (in_order, crank_rocker, problem.requirements, good):
        held.append(np.zeros_like(exact))
        held[-1][exact] = dyad_pairs.judged_pairs(
            motion, place[0], every[row], every[column], wanted.resolved(size)
        ).feasible
    return Pairs(exact, *held)


def share(every: BoolArray, seed: int = 0) -> tuple[float, float, float]:
    """Share of the pairs of two starts, and its 95 % interval, the starts resampled (bootstrap)."""
    starts = len(every)
    pairs = starts * (starts - 1)
    counts = np.random.default_rng(seed).multinomial(starts, np.full(starts, 1 / starts), RESAMPLED)
    found = np.einsum("bi,ij,bj->b", counts, every.astype(np.float64), counts, optimize=True) / pairs
    low, high = np.quantile(found, [0.025, 0.975])
    return float(every.sum() / pairs), float(low), float(high)


def agreement(problem: Problem, dyads: Sequence[Dyad], pairs: Pairs, count: int, seed: int = 0) -> int:
    """Number of `count` random exact pairs on which `verify` agrees."""
    # The gaps of dyads are at most ten times those of the linkage where it comes nearest to the poses.
    wanted = replace(problem.requirements, tolerance=10 * TOLERANCE)
    chosen = np.random.default_rng(seed).choice(np.argwhere(pairs.exact), count)
    same = 0
    for i, j in chosen:
        linkage = linkage_of(problem.task, dyads[i], dyads[j])
        verdict = verify(linkage, problem.task, wanted)
        in_order = verdict.branch_ok and verdict.order_ok
        same += (in_order, verdict.ok) == (bool(pairs.in_order[i, j]), bool(pairs.usable[i, j]))
    return same


def guess_table(problem: Problem) -> Table:
    """The report's guesses and their linkages."""
    table = Table(title="The report's guesses, each dyad by BFGS", title_justify="left")
    for name in ("guess", "the report says", "residuals, m", "r1 to r4, m", "what it does"):
        table.add_column(name, no_wrap=True)
    for each in (tried(problem, guess) for guess in GUESSES):
        residuals = f"{each.left.residual:.1e}, {each.right.residual:.1e}"
        lengths = ", ".join(f"{length:.5g}" for length in each.linkage.lengths)
        table.add_row(each.guess.name, each.guess.said, residuals, lengths, outcome(each))
    return table


def main(argv: Sequence[str] | None = None) -> int:
    """Print the results of the guesses and of the package."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--starts", type=int, default=STARTS, help="random guesses")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args(argv)
    console, problem = Console(width=220, highlight=False, markup=False), load("luggage")
    console.print(guess_table(problem))
    began = time.perf_counter()
    dyads = random_dyads(problem.task, given.starts, given.seed)
    took = time.perf_counter() - began
    pairs = judged_pairs(problem, dyads)
    same = agreement(problem, dyads, pairs, JUDGED)
    console.print(
        f"{given.starts} random guesses of a dyad in {took:.1f} s, all {given.starts * (given.starts - 1)} "
        f"pairs of them, with 95 % intervals (the judge agrees on {same} of {JUDGED}):"
    )
    for label, every, audited in (
        ("exact at the poses", pairs.exact, "7.5 to 27 %"),
        ("and without defect, in order", pairs.in_order, "26 % at most"),
        ("and a crank-rocker", pairs.crank_rocker, "6.5 % [4.9, 8.4]"),
        (f"and mu at least {GOOD:g} deg over the turn", pairs.good, "0.2 %"),
        ("all that the problem requires", pairs.usable, "-"),
    ):
        found, low, high = (100 * part for part in share(every))
        console.print(f"  {label}: {found:.1f} % [{low:.1f}, {high:.1f}]; audited with fminunc: {audited}")
    began = time.perf_counter()
    result = synthesize(problem, seed=0)
    took = time.perf_counter() - began
    best = result.best.verdict
    console.print(
        f"grashof.synthesize: {len(result)} designs in {took:.1f} s, which meet all requirements; "
        f"the best has mu {np.degrees(best.transmission_min_task):.1f} deg on the way, "
        f"{np.degrees(best.transmission_min_cycle):.1f} deg over the turn"
    )
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
