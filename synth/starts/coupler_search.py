"""The search over linkages that are feasible by construction: paths, and poses with parts free or missed."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import numpy as np

from grashof.problems import ProblemError, Requirements
from grashof.problems.values.tasks.motion_task import ANGLES_ALONE
from grashof.problems.values.text import counted
from grashof.synth.programme.start import Round, Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Screened
from grashof.synth.starts.closed_loop import SearchTargets
from grashof.synth.starts.every_target import fitted_to_all
from grashof.synth.starts.finder import StartFinder
from grashof.synth.starts.loop_search import draw, fitting, improve, judged, place
from grashof.synth.starts.selection import feasible_starts, mended_starts, relaxed_starts
from grashof.synth.starts.thinning import refined, thinned

# Draws, and numbers of the best that continue and their steps: few solutions, or a family.
ISOLATED = (4000, ((300, 8), (80, 12), (20, 50)))
FAMILY = (6000, ((1500, 10), (800, 10)))
TIMED = (600, ((60, 6), (20, 60)))
FEW_POINTS = 48  # of a longer path decide which linkages are worth the rest
EXACT = 1e-16  # sizes squared: such an error is left to the solver
FOUND = 1e-5  # sizes: rms error of a start for an exact task
PLACED = 3  # targets with places, which fix the place of a linkage
ANCHORS = 6  # choices of others in a round where there are fewer
AROUND, LATER = 0.7, (0.2, 1.5)  # where they are: sizes, and rad after the last target
NEAR, NEAR_PART = 20, 2  # linkages near the requirements are enough, from this part of the draws


class CouplerSearch(StartFinder):
    """Targets that theory does not solve directly."""

    beginning: ClassVar[str] = "searching"
    cognates: ClassVar[bool] = True
    freedom: ClassVar[bool] = True

    def refuse(self) -> None:
        """Raise `ProblemError` for too few targets."""
        refuse_few(self.scaled)

    def degenerate(self) -> str:
        """Why a single position needs no linkage; empty for others."""
        return single_position(self.scaled)

    def near(self, rng: np.random.Generator, _share: float = 1.0, /) -> Screened:
        """Linkages of one round of the search."""
        return search(self.scaled, NEAR, rng, part=NEAR_PART)

    def relaxed(self, rng: np.random.Generator) -> list[Start]:
        """Starts that may miss what no linkage meets."""
        drawn, free = (
            search(self.scaled, 1, rng, to_boxes=to_boxes, part=NEAR_PART) for to_boxes in (True, False)
        )
        return relaxed_starts(self.scaled, drawn) or relaxed_starts(self.scaled, free)


def refuse_few(scaled: ScaledProblem) -> None:
    """Raise `ProblemError` for too few distinct targets, or timed angles without places."""
    task, count = scaled.problem.task, len(SearchTargets.of(scaled).points)
    if task.is_timed and (placed := int(task.has_position.sum())) < 2:
        raise ProblemError(
            f"{task.kind}.{task.target}s has {counted(placed, 'place')}; it must have x and y in two or "
            f"more: {ANGLES_ALONE}"
        )
    many = task.only_points or not scaled.exact
    if count < (3 if many else 2):
        where = " where requirements.exact is false" if many and not task.only_points else ""
        raise ProblemError(
            f"{task.kind}.{task.target}s has {counted(count, f'distinct {task.target}')}; "
            f"it must have {'three' if many else 'two'} or more{where}"
        )


def single_position(scaled: ScaledProblem) -> str:
    """Why a single position needs no linkage; empty for others."""
    placed = scaled.targets[scaled.problem.task.has_position]
    if np.abs(placed - placed[0]).max() > 0:
        return ""
    x, y = scaled.frame.outward(placed[0])
    pivot = "a single pivot there does the job"
    if scaled.problem.task.is_timed:
        pivot = 'a link on a pivot there carries the body, and kind = "function" finds its drive'
    return f"all positions are at ({x:.6g}, {y:.6g}): {pivot}"


def searched_round(scaled: ScaledProblem, enough: int, rng: np.random.Generator) -> Round:
    """The starts of one round of the search for linkages that meet the targets."""
    linkages = search(scaled, enough, rng)
    feasible = linkages[linkages.feasible]
    starts = feasible_starts(scaled, feasible, enough)
    if len(starts) < enough:
        starts += mended_starts(scaled, linkages, enough)
    settled = not has_family(scaled)  # without freedom the linkage is the design already
    starts = [start.under(settled=settled) for start in starts]
    return Round(starts, {"feasible finds": len(feasible)})


def search(
    scaled: ScaledProblem, enough: int, rng: np.random.Generator, *, to_boxes: bool = True, part: int = 1
) -> Screened:
    """One round of the search, or a `part` of it, drawn towards boxes of pivots or not, linkages judged."""
    target = SearchTargets.of(scaled)
    if not to_boxes:
        target = replace(target, wanted=replace(target.wanted, o2=None, o4=None))
    lacking = PLACED - int(np.count_nonzero(target.weights))
    if lacking <= 0:
        return _searched(scaled, target, target, enough, rng, part)
    anchored = [_anchored(target, lacking, rng) for _ in range(ANCHORS)]
    parts = part * ANCHORS
    return Screened.joined([_searched(scaled, target, each, enough, rng, parts) for each in anchored])


def _searched(
    scaled: ScaledProblem,
    target: SearchTargets,
    anchored: SearchTargets,
    enough: int,
    rng: np.random.Generator,
    parts: int = 1,
) -> Screened:
    """Linkages that pass all of `anchored`, judged at the targets; `parts` of them make a round."""
    effort = FAMILY if has_family(scaled) else TIMED if target.timed else ISOLATED
    draws, (*stages, (keep, steps)) = effort
    some, index = thinned(anchored, FEW_POINTS)
    batch = draw(some, draws // parts, rng)
    with np.errstate(all="ignore"):
        error = place(some, batch).error
        for keep_now, steps_now in stages:
            best = np.argsort(error, kind="stable")[: keep_now // parts]
            until = min(enough, keep_now // parts)
            batch, error = improve(fitting(some), batch[best], steps_now, EXACT, until)
        batch = refined(anchored, index, batch[np.argsort(error, kind="stable")[: keep // parts]])
        if len(index) < len(anchored.points) and not target.timed:
            batch = fitted_to_all(anchored, batch, steps)
        else:
            batch, _ = improve(fitting(anchored), batch, steps, EXACT, until=min(enough, keep))
        placed = place(anchored, batch).at_first(len(target.points))
    sound = np.isfinite(placed.error)
    if scaled.exact:
        sound &= placed.error <= len(target.points) * FOUND**2
    return judged(scaled, target, placed[sound], batch.direction[sound])


def _anchored(target: SearchTargets, count: int, rng: np.random.Generator) -> SearchTargets:
    """Some targets and, after them, points at random that P passes, too: these fix its place."""
    middle = (target.weights * target.points).sum() / max(target.weights.sum(), 1e-300)
    points = middle + AROUND * (rng.normal(size=count) + 1j * rng.normal(size=count))
    later = target.timing[-1] + np.cumsum(rng.uniform(*LATER, count)) if target.timed else np.zeros(count)
    ones, none = np.ones(count), np.zeros(count)
    return replace(
        target,
        points=np.concatenate([target.points, points]),
        weights=np.concatenate([target.weights, ones]),
        turns=np.concatenate([target.turns, none]),
        turn_weights=np.concatenate([target.turn_weights, none]),
        timing=np.concatenate([target.timing, later]),
    )


def has_family(scaled: ScaledProblem) -> bool:
    """Whether designs that are to meet all targets have freedom left."""
    return bool(scaled.exact) and leaves_freedom(scaled)


def leaves_freedom(scaled: ScaledProblem) -> bool:
    """Whether designs that meet all targets have more unknowns than equations."""
    target = SearchTargets.of(scaled)
    unknowns = target.unknowns + 6 + target.has_angles - (target.wanted.order and not target.timed)
    equations = 2 * np.count_nonzero(target.weights) + np.count_nonzero(target.turn_weights)
    return bool(unknowns > equations + _equalities(scaled.wanted))


def _equalities(wanted: Requirements) -> int:
    """Number of values that the requirements fix: coordinates of pivots, and angles."""
    sides = [side for box in (wanted.o2, wanted.o4) if box is not None for side in (box.x, box.y)]
    fixed = [wanted.angle_of(name) is not None for name in ("ground_angle_deg", "theta2_start_deg")]
    return sum(low == high for low, high in sides) + sum(fixed)
