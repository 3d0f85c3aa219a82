"""Proofs about lists of linkages through points that leave no freedom."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from grashof.analysis import solve_position
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.problems.values.text import counted
from grashof.synth.designs.candidate import Candidate
from grashof.synth.proof.claims.proof import Claim, Proof, best_listed, quantity_of
from grashof.synth.proof.points.boxes import boxes
from grashof.synth.proof.points.equations import PointEquations, enough_points
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.finder import finder_for
from grashof.synth.starts.precision_points import FOLLOWED, THROUGH, EveryLinkage
from grashof.synth.theory.point_families import INVERTED_SLIDER_CRANKS

NEAR = 1e-6  # sizes: a linkage farther from the exact one does not count as enclosed
ROUNDING = "doubles, enclosures widened for rounding; points as stored"


@dataclass(frozen=True, slots=True)
class Enclosed:
    """Linkages, each beside one that passes all points exactly; NaN where none is proven."""

    middle: FloatArray  # (n, K): with `radius`, a box that holds exactly one solution of `PointEquations`
    radius: FloatArray  # (n, K)
    within: FloatArray  # (n,), sizes and rad: greatest difference of an unknown from that solution at most

    @classmethod
    def of(cls, passing: PointEquations, unknowns: FloatArray) -> Enclosed:
        """Enclose the solutions near linkages, given by their unknowns."""
        middle, radius = boxes(passing, unknowns)
        within = np.max(np.abs(unknowns - middle) + radius, axis=1, initial=0.0)
        return cls(middle, radius, np.where(within <= NEAR, within, np.nan))

    def words(self, kind: str) -> str:
        """The number of enclosed linkages of a kind, and their distance, in words.

        >>> box = np.zeros((2, 16))
        >>> Enclosed(box, box, np.array([3.2e-12, np.nan])).words("four-bar")
        '1 of 2 listed four-bars enclosed, within 4e-12 sizes of an exact one'
        """
        proven = self.within[np.isfinite(self.within)]
        if not len(self.within):
            return f"no {kind} is listed"
        said = f"{len(proven)} of {counted(len(self.within), f'listed {kind}')} enclosed"
        return f"{said}, within {_up(float(proven.max()))} sizes of an exact one" if len(proven) else said


def proof_of_points(
    scaled: ScaledProblem,
    designs: Sequence[Candidate],
    counts: Mapping[str, int],
    *,
    stopped: bool,
    whole: bool,
    enough: bool = False,
) -> Proof | None:
    """The proof about a list where finitely many linkages pass the points exactly; None for other problems.

    `counts` are those of the search. It may have been `stopped`, may have tried all that it found (`whole`),
    and may have found as many designs as requested (`enough`).
    """
    if not _leaves_no_freedom(scaled):
        return None
    since, problem = perf_counter(), scaled.problem
    enclosed = enclosed_designs(scaled, designs)
    finder = finder_for(scaled)
    known = finder.solutions if isinstance(finder, EveryLinkage) else INVERTED_SLIDER_CRANKS.count
    if not isinstance(finder, EveryLinkage):
        why = f"the search does not follow the {known} solutions that are known"
    else:
        why = _why_not_all(known, counts, stopped=stopped, whole=whole or enough)
    claim = Claim.REFUSED if why else Claim.FOLLOWED
    said = why or f"{known} of {known} known solutions"
    said += "; as many designs as requested are listed, not all" * (enough and not why)
    return Proof(
        claim=claim,
        mechanism=scaled.kind.mechanism,
        quantity=quantity_of(problem).column,
        lower=best_listed(problem, designs),
        pieces=(len(designs), 0),
        seconds=round(perf_counter() - since, 4),
        rounding=ROUNDING,
        why=f"{said}; {enclosed.words(scaled.kind.mechanism)}",
    )


def enclosed_designs(scaled: ScaledProblem, designs: Sequence[Candidate]) -> Enclosed:
    """Designs of one kind that pass all points of a problem, each beside an exact one."""
    points = _points(scaled)
    size = scaled.problem.task.size
    exact = np.asarray(points, np.clongdouble)
    passing = PointEquations((exact - exact[0]) / size, scaled.kind.mechanism)
    unknowns = [unknowns_of(one, points, size) for one in designs]
    return Enclosed.of(passing, np.array(unknowns).reshape(len(unknowns), 2 * (len(points) - 1)))


def unknowns_of(design: Candidate, points: ComplexArray, size: float) -> FloatArray:
    """A design in the unknowns of `PointEquations.rows` (K,); `points` (N,) and `size` are in length."""
    linkage, count = design.linkage, len(points)
    at = solve_position(linkage, design.verdict.theta2[:count], design.verdict.assembly[:count])
    a, b = (_z(joint[0] - at.p[0]) / size for joint in (at.a, at.b))
    turns = (at.theta3 - at.theta3[0])[1:].tolist()
    loop = linkage.mechanism.loops[0]
    joints = [(_z(linkage.o2) - points[0]) / size, a]
    joints += [(_z(linkage.o4) - points[0]) / size] if loop.pinned else []
    joints += [b] if loop.bars else []
    angle = [float(linkage.slide_angle)] if loop.slide_angle else []
    angle += [] if loop.bars else [float(at.theta3[0])]
    return np.array([part for z in joints for part in (z.real, z.imag)] + angle + turns)


def _leaves_no_freedom(scaled: ScaledProblem) -> bool:
    """Whether finitely many linkages meet the targets exactly: distinct points without timing."""
    problem = scaled.problem
    if not scaled.exact or scaled.bounded or scaled.timed or problem.driver is not None:
        return False
    points = _points(scaled)
    if not problem.task.only_points or len(points) != enough_points(scaled.kind.mechanism):
        return False
    apart = np.abs(points[:, None] - points) / problem.task.size + np.eye(len(points))
    return bool(apart.min() > 1e-9)


def _points(scaled: ScaledProblem) -> ComplexArray:
    """The points, length, without a last one that repeats the first."""
    task = scaled.problem.task
    points: ComplexArray = task.positions[: -1 if task.returns else None] @ np.array([1, 1j])
    return points


def _why_not_all(known: int, counts: Mapping[str, int], *, stopped: bool, whole: bool) -> str:
    """Why the list lacks some of the linkages that are known numerically; empty where it is complete."""
    if THROUGH not in counts:
        ended = "was stopped" if stopped else "ended"
        return f"the search {ended} before the {known} known solutions were followed"
    if stopped or not whole:
        return "not all linkages that pass the points were tried"
    found = counts.get(FOLLOWED, 0)
    if found < known:
        return f"of {known} known solutions {known - found} were lost on the way"
    return "" if found == known else f"{found} solutions came up where {known} are known"


def _z(pair: FloatArray) -> complex:
    return complex(pair[0], pair[1])


def _up(value: float) -> str:
    """A small number with one digit, rounded up."""
    power = np.floor(np.log10(value))
    return f"{np.ceil(value / 10**power - 1e-9) * 10**power:.0e}"
