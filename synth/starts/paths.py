"""Starts for paths, and for poses in least squares or with free parts: rounds of a search.

It goes over linkages that are feasible by construction; exact paths through nine points have it
followed by all linkages that there are.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from grashof.problems import Requirements
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.screening import Screened, follow
from grashof.synth.programme.start import Round, Start
from grashof.synth.starts import least_squares
from grashof.synth.starts.closed_loop import PathTarget
from grashof.synth.starts.loop_search import Placed, draw, fitting, improve, place
from grashof.synth.starts.path_screening import entries_of, judged, path_target
from grashof.synth.starts.selection import feasible_starts, mended_starts
from grashof.synth.starts.selection import relaxed_starts as relaxed
from grashof.synth.starts.thinning import refined, thinned
from grashof.synth.theory.cognates import cognate_points
from grashof.synth.theory.nine_points import coupler_turns, linkages_through

# Draws, and how many of the best go on for how many steps: few solutions, or a whole family.
ISOLATED = (4000, ((300, 8), (80, 12), (20, 50)))
FAMILY = (6000, ((1500, 10), (800, 10)))
TIMED = (600, ((60, 6), (20, 60)))
FEW_POINTS = 48  # of a longer path decide which finds are worth the rest
BARREN = 12  # so many rounds on end without a start end the search
EXACT = 1e-16  # sizes squared: such an error is left to the solver
SEARCHES = 6  # rounds of the search before all linkages through nine points are computed
FOUND = 1e-5  # sizes: rms error of a start for an exact task


def degenerate(scaled: ScaledProblem) -> str:
    """Why poses with parts left free, or of least squares, need no linkage; empty when they need one."""
    placed = scaled.targets[scaled.weights > 0]
    if np.abs(placed - placed[0]).max() > 0:
        return ""
    x, y = scaled.frame.outward(placed[0])
    return f"all positions are at ({x:.6g}, {y:.6g}): a single pivot there does the job"


def rounds(scaled: ScaledProblem, enough: int, rng: np.random.Generator, size: int = 1) -> Iterator[Round]:
    """Rounds of starts; later ones only when more are needed.

    Parameters
    ----------
    scaled : ScaledProblem
    enough : int
        Distinct designs wanted.
    rng : numpy.random.Generator
    size : int
        Of least squares: how many times the usual number of linkages to draw.

    Yields
    ------
    Round
    """
    if not scaled.exact:
        yield from least_squares.rounds(scaled, rng, size)
    if _has_nine_points(scaled):
        # All linkages can be had, but for points in order the search is most often there sooner.
        for _ in range(SEARCHES if scaled.wanted.order else 0):
            yield _search_round(scaled, enough, rng)
        yield _all_round(scaled, rng)
        return
    barren = 0
    while barren < BARREN:
        found = _search_round(scaled, enough, rng)
        barren = 0 if found.starts else barren + 1
        yield found


def _search_round(scaled: ScaledProblem, enough: int, rng: np.random.Generator) -> Round:
    finds, family = search(scaled, enough, rng), _family(scaled, path_target(scaled))
    feasible = finds[finds.feasible]
    starts = feasible_starts(scaled, feasible, enough)
    if len(starts) < enough:
        starts += mended_starts(scaled, finds, enough)
    # Without freedom a find is the design already.
    return Round(
        [replace(start, settled=not family) for start in starts], {"feasible linkages": len(feasible)}
    )


def _all_round(scaled: ScaledProblem, rng: np.random.Generator) -> Round:
    """Of every triplet of cognates through nine points the first feasible one; the others follow."""
    target = path_target(scaled)
    linkages = linkages_through(target.points, rng)
    every = _from_every_side(linkages).reshape(-1, 5)
    finds = judged(scaled, target, *_as_found(every, target))
    feasible = finds.feasible.reshape(-1, 3, 2)
    usable = feasible.any(axis=2)
    first = usable & (np.cumsum(usable, axis=1) == 1)
    chosen = np.flatnonzero(feasible & first[..., None])
    starts = [
        replace(Start.of_find(finds, int(index), scaled.problem.objective), settled=True) for index in chosen
    ]
    counts = {"feasible linkages": int(feasible.sum()), "linkages through the points": 3 * len(linkages)}
    return Round(starts, counts)


def _from_every_side(linkages: ComplexArray) -> ComplexArray:
    """Linkages (n, 5), their cognates, and all of them driven from the other side; (n, 3, 2, 5)."""
    swap = [1, 0, 3, 2, 4]
    cognates = cognate_points(linkages.T, timed=False)
    one_side = [linkages.T, *cognates[:2]]
    other_side = [linkages.T[swap], *cognates[2:]]
    return np.stack([one_side, other_side]).transpose(3, 1, 0, 2)


def _as_found(points: ComplexArray, target: PathTarget) -> tuple[Placed, FloatArray]:
    """Linkages (n, 5) that pass all points: where they stand there, and the shorter sense of the driver."""
    o2, _, a, b, p = (column[:, None] for column in points.T)
    turns = coupler_turns(points, target.points)
    a, b = target.points + (a - p) * turns, target.points + (b - p) * turns
    theta2 = np.angle(a - o2)
    forth, back = (follow(theta2, np.full(len(points), sense)) for sense in (1.0, -1.0))
    shorter = np.abs(forth[:, -1] - theta2[:, 0]) <= np.abs(back[:, -1] - theta2[:, 0])
    theta2 = np.where(shorter[:, None], forth, back)
    p = np.broadcast_to(target.points, a.shape)
    none = np.zeros(len(points))
    placed = Placed(none, points[:, 0], points[:, 1], a, b, p, theta2, body_angle=none)
    return placed, np.where(shorter, 1.0, -1.0)


def relaxed_starts(scaled: ScaledProblem, rng: np.random.Generator) -> list[Start]:
    """Starts that may miss what stands in the way."""
    drawn, free = search(scaled, 1, rng), search(scaled, 1, rng, to_boxes=False)
    return relaxed(scaled, drawn) or relaxed(scaled, free)


def search(
    scaled: ScaledProblem, enough: int, rng: np.random.Generator, *, to_boxes: bool = True
) -> Screened:
    """One round of the search, drawn towards the pivots' boxes or not, its finds judged."""
    target = path_target(scaled)
    if not to_boxes:
        target = replace(target, wanted=replace(target.wanted, o2=None, o4=None))
    draws, (*stages, (keep, steps)) = _effort(scaled, target)
    some, index = thinned(target, FEW_POINTS)
    batch = draw(some, draws, rng)
    with np.errstate(all="ignore"):
        error = place(some, batch).error
        for keep_now, steps_now in stages:
            best = np.argsort(error, kind="stable")[:keep_now]
            batch, error = improve(fitting(some), batch[best], steps_now, EXACT, until=min(enough, keep_now))
        batch = refined(target, index, batch[np.argsort(error, kind="stable")[:keep]])
        batch, _ = improve(fitting(target), batch, steps, EXACT, until=min(enough, keep))
        placed = place(target, batch)
    sound = np.isfinite(placed.error)
    if scaled.exact:
        sound &= placed.error <= len(target.points) * FOUND**2
    return judged(scaled, target, entries_of(placed, sound), batch.direction[sound])


def _effort(scaled: ScaledProblem, target: PathTarget) -> tuple[int, tuple[tuple[int, int], ...]]:
    if _family(scaled, target):
        return FAMILY
    if target.timed:
        return TIMED
    return ISOLATED


def _family(scaled: ScaledProblem, target: PathTarget) -> bool:
    """Whether exact designs have freedom left: more unknowns than equations."""
    unknowns = target.unknowns + 6 + target.has_angles - (target.wanted.order and not target.timed)
    equations = 2 * np.count_nonzero(target.weights) + np.count_nonzero(target.turn_weights)
    equations += _equalities(scaled.wanted)
    return bool(scaled.exact and unknowns > equations)


def _equalities(wanted: Requirements) -> int:
    """How many numbers the requirements fix: coordinates of pivots, and angles."""
    sides = [side for box in (wanted.o2, wanted.o4) if box is not None for side in (box.x, box.y)]
    fixed = [wanted.ground_angle_deg is not None, wanted.theta2_start_deg is not None]
    return sum(low == high for low, high in sides) + sum(fixed)


def _has_nine_points(scaled: ScaledProblem) -> bool:
    """Whether the task is exact passage of nine distinct points without timing: finitely many linkages."""
    if not scaled.problem.task.only_points:
        return False
    points = path_target(scaled).points
    apart = np.abs(points[:, None] - points) + np.eye(len(points))
    return scaled.exact and not scaled.timed and len(points) == 9 and bool(apart.min() > 1e-9)
