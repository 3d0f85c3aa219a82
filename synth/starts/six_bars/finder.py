"""Paths, poses and functions with six-bars: whole linkages, round by round, for every row of a kind."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import permutations
from typing import ClassVar

import numpy as np

from grashof.problems import Linkage, ProblemError, Requirements, Rotatability, TransmissionOver
from grashof.problems.values.arrays import BoolArray, ComplexArray, IntArray
from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.problems.values.tasks.closed_curve import even_places, spline_length
from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.start import Proposal, Round, Start
from grashof.synth.quantities.formulas import of_six_bars
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.closed_loop import Batch, SearchTargets
from grashof.synth.starts.coupler_search import refuse_few, single_position
from grashof.synth.starts.exact_poses import pure_rotation, refuse_equal
from grashof.synth.starts.finder import ROUNDS_DONE, DesignFinder
from grashof.synth.starts.loop_search import project
from grashof.synth.starts.six_bars.carried import Carried, around
from grashof.synth.starts.six_bars.chains import FIRST_STAGES, QUICK_STAGES, STAGES, draw, fitted, linkages
from grashof.synth.starts.six_bars.every_target import fitted_to_all
from grashof.synth.starts.six_bars.placing import place_of
from grashof.synth.starts.six_bars.shapes import Shapes
from grashof.synth.starts.thinning import thinned
from grashof.synth.theory.burmester import Displacements
from grashof.synth.theory.distinct import pick_apart, signatures
from grashof.synth.theory.six_bars.five_poses import six_bars_through
from grashof.synth.theory.six_bars.link_motions import POSES

# Fewer where the reason for an empty list is looked for, among fewer rows.
DRAWS, QUICK_DRAWS, QUICK_ROWS = 3000, 600, 2
FEW_TARGETS = 16  # of a longer untimed task, among which linkages are found first
CLOSED_TARGETS = 48  # places on a closed path, so that no curve fits the points alone
ROUND = 512  # driver angles for the length of a curve
FINDS = "feasible finds"
LEAST_ROUNDS = 6  # of least squares under the required transmission angle, if there are no more rows
EXACT_PASSES = 2  # of exact designs through all transmission angles, likewise
LEVELS = (20.0, 35.0, 50.0)  # deg: transmission angles that designs are made for, too
MET = 1e-9  # sizes, or rad: a greater error of an exact design is none
JUDGED, EXACT_JUDGED, POSES_JUDGED = 8, 24, 60  # designs of a round
CLOSE = 3  # designs of each row that miss a requirement
CONTINUED, EXACT_CONTINUED = 8, 4  # designs, and misses, from which a programme is solved
WORSE = 3.0  # times the least error of a round
APART = 0.03  # between designs of a round, as `distinct` counts
# Beyond what is required, for peaks between samples: deg of transmission angle; share of the margin.
SPARE_DEG, SPARE = 0.05, 1e-3
LIMIT_SPARE = 2e-3  # share by which other limits are narrower


@dataclass(frozen=True)
class SixBars(DesignFinder):
    """Six-bars through targets, or of least error."""

    beginning: ClassVar[str] = "looking for six-bars"
    searches_near: ClassVar[float] = 2
    exhausted: ClassVar[str] = ROUNDS_DONE

    @cached_property
    def wanted(self) -> Requirements:
        """Resolved, in the problem's unit."""
        task = self.scaled.problem.task
        return self.scaled.problem.requirements.resolved(task.size, scale_free=task.scale_free)

    @cached_property
    def rows(self) -> list[Mechanism]:
        """The rows of the kind, with P on each link that may carry it."""
        return list(self.scaled.problem.task.rows(self.scaled.problem.mechanism[0]))

    @cached_property
    def plan(self) -> list[tuple[Mechanism, float]]:
        """The row and the transmission angle, deg, of every round: the required one, and greater ones."""
        least = self.wanted.transmission_min_deg
        greater = [level for level in LEVELS if level > least + 1]
        rows = max(1, len(self.rows))
        levels = [least] * max(1, LEAST_ROUNDS // rows) + greater
        if self.scaled.exact:
            levels = [least, *greater] * max(1, EXACT_PASSES // rows)
        return [(row, level) for level in levels for row in self.rows]

    @property
    def rounds_a_pass(self) -> int:
        """One for each row and transmission angle, or more."""
        return 0 if self.contradiction else len(self.plan) + self.by_theory

    @cached_property
    def contradiction(self) -> str:
        """Two lengths whose limits leave no ratio that is allowed; empty where there are none."""
        wanted, names = self.wanted, self.rows[0].lengths if self.rows else ()
        limits = {name: getattr(wanted, name) or wanted.link_length or (0.0, np.inf) for name in names}
        for (one, (least, _)), (other, (_, most)) in permutations(limits.items(), 2):
            if least > wanted.link_ratio_max * most:
                return f"limits of {one} and {other} contradict the greatest link ratio"
        return ""

    def refuse(self) -> None:
        """Raise `ProblemError` for kinds whose P moves as that of a four-bar, for few or equal targets."""
        task = self.scaled.problem.task
        if said := task.needless(self.scaled.problem.mechanism[0]):
            raise ProblemError(said)
        if task.in_plane:
            refuse_few(self.scaled)
        if self.motion is not None:
            refuse_equal(self.scaled, self.motion)

    def degenerate(self) -> str:
        """Why a single position, or a pure rotation, needs no linkage; empty for other targets."""
        if not self.scaled.problem.task.in_plane:
            return ""
        rotation = "" if self.motion is None else pure_rotation(self.scaled, self.motion)
        return rotation or single_position(self.scaled)

    @property
    def motion(self) -> Displacements | None:
        """Of complete poses that are met exactly, untimed."""
        scaled = self.scaled
        whole = scaled.exact and scaled.problem.task.is_whole and not scaled.timed
        return Displacements.from_poses(scaled.targets, scaled.turns) if whole else None

    def round(self, number: int, _enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """The best of some thousand linkages of one row, for one transmission angle."""
        if number >= self.rounds_a_pass:
            return None
        if self.by_theory and not number:
            return self._through_five_poses(rng)
        found = self._found(*self.plan[number - self.by_theory], rng, size)
        return Round(found, {FINDS: len(found)}, size=size)

    @property
    def by_theory(self) -> bool:
        """Whether theory gives designs, in a round before the others: through five complete poses."""
        return self.motion is not None and len(self.scaled.targets) == POSES

    def _through_five_poses(self, rng: np.random.Generator) -> Round:
        """The most different of the best six-bars through five poses."""
        scaled = self.scaled
        found = six_bars_through(scaled.targets, scaled.turns, scaled.wanted, self.rows, rng)
        made = [self._outward(each) for each in found]
        chosen = [made[k] for k in self._apart(made, POSES_JUDGED)]
        return Round(chosen, {FINDS: len(made)})

    def onward(self, designs: Sequence[Candidate], misses: Sequence[Candidate] = (), /) -> Sequence[Start]:
        """Starts at different designs and misses, the best first, where the programme covers the task."""
        scaled = self.scaled
        overdetermined = scaled.exact and scaled.has_angles and len(scaled.targets) > POSES
        if overdetermined or not scaled.has_programme:
            return []
        every = [each for each in (*designs, *misses) if np.isfinite(each.verdict.theta2).all()]
        chosen = self._apart([each.linkage for each in every], EXACT_CONTINUED if scaled.exact else CONTINUED)
        return [Start.of_linkage(scaled, every[k].linkage, every[k].verdict) for k in chosen]

    def follow(self, design: Candidate) -> Sequence[Proposal]:
        """The design itself."""
        return [design.linkage]

    def closest_to(self, required: ScaledProblem, key: str, rng: np.random.Generator) -> Sequence[Proposal]:
        """The best of a quick round for the first rows."""
        del required, key
        return [
            each
            for row, level in self.plan[: min(len(self.rows), QUICK_ROWS)]
            for each in self._found(row, level, rng, 1, quick=True)[:CLOSE]
        ]

    def obstacle(self, _rng: np.random.Generator, counts: Mapping[str, int], /) -> str:
        """Contradictory limits; that no linkage came through all targets, where that was looked for."""
        if self.contradiction or not self.scaled.exact or counts.get(FINDS):
            return self.contradiction
        return f"no {self.scaled.problem.mechanism[0]} came through all targets"

    def _found(
        self, row: Mechanism, level: float, rng: np.random.Generator, size: int, *, quick: bool = False
    ) -> list[Linkage]:
        """Distinct linkages of a row, best first, in the problem's unit."""
        target, shapes, exact = self.target(row), self._shapes(row, level), self.scaled.exact
        with np.errstate(all="ignore"):
            every = target.timed or target.jumbled
            some, index = thinned(target, len(target.points) if every else FEW_TARGETS)
            stages = QUICK_STAGES if quick else STAGES if some is target else FIRST_STAGES
            batch = draw(some, shapes, size * (QUICK_DRAWS if quick else DRAWS), rng)
            batch, error = fitted(some, shapes, batch, EXACT_JUDGED if exact else 1, stages)
            if some is target:
                at = Carried(target, shapes, batch)
                z = self._places(at) if target.outputs is not None else project(target, at)[0]
            else:
                batch, z, error = fitted_to_all(target, some, shapes, batch, index)
                target = replace(target, wanted=replace(target.wanted, order=False))
            root = np.sqrt(error / len(target.points))
            good = self._kept(shapes, batch, z) & (root <= MET if exact else np.isfinite(root))
            good &= root <= WORSE * root[good].min(initial=np.inf) if not exact else True
            made = self._linkages(target, shapes, batch[good], z[good])
        return [made[k] for k in self._apart(made, EXACT_JUDGED if exact else JUDGED)]

    def _apart(self, made: Sequence[Linkage], most: int) -> IntArray:
        """Indices of distinct linkages, of those alike the first."""
        if not made:
            return np.zeros(0, dtype=np.int64)
        score = -np.arange(len(made), dtype=np.float64)
        return pick_apart(signatures(self.scaled.problem.task, made), score, APART, most)

    def _kept(self, shapes: Shapes, batch: Batch, z: ComplexArray) -> BoolArray:
        """Linkages whose curve of P does not stray between the points, (n,)."""
        most = self.scaled.problem.task.most_length_ratio(shapes.mechanism)
        if not np.isfinite(most):
            return np.ones(len(batch), dtype=bool)
        p, wanted = around(shapes, batch, z, ROUND), spline_length(self.scaled.problem.task.once_round)
        length = np.abs(np.diff(p, axis=1, append=p[:, :1])).sum(axis=1)
        kept: BoolArray = length <= most * wanted / self.scaled.frame.scale
        return kept

    def target(self, row: Mechanism) -> SearchTargets:
        """The targets of the search for a row, in its frame."""
        task, formulas = self.scaled.problem.task, of_six_bars(row.lengths)
        target = replace(SearchTargets.of(self.scaled), spare=LIMIT_SPARE)
        if not task.in_plane:  # the scale is free
            of_ratio = {key: formulas[key] for key in ("link_ratio", "link_ratios")}
            return replace(target, formulas=of_ratio, outputs=task.outputs)
        if task.is_curve and not self.scaled.exact:
            places = self.scaled.frame.inward(
                even_places(task.once_round, max(CLOSED_TARGETS, len(target.points)))
            )
            free = np.zeros(len(places))
            target = replace(target, turns=free, turn_weights=free, timing=free)
            target = replace(target, points=places, weights=np.ones(len(places)))
        return replace(target, formulas=formulas)

    def _shapes(self, row: Mechanism, level: float) -> Shapes:
        """Loops that close and transmit where they have to."""
        wanted = self.wanted
        round_turn = self.scaled.closed
        turning = round_turn or wanted.rotatability is not Rotatability.ANY
        over_turn = round_turn or wanted.transmission_over is TransmissionOver.CYCLE
        return Shapes(
            row,
            turning=turning,
            margin=wanted.rotatability_margin * (1 + SPARE) if turning else 0.0,
            transmission=float(np.radians(level + SPARE_DEG)) if level else 0.0,
            over_turn=turning and over_turn,
        )

    def _linkages(
        self, target: SearchTargets, shapes: Shapes, batch: Batch, z: ComplexArray
    ) -> list[Linkage]:
        made = linkages(target, shapes, batch, z)
        return [self._outward(each) for each in made] if self.scaled.problem.task.in_plane else made

    def _outward(self, linkage: Linkage) -> Linkage:
        """A linkage of the frame of the search in the problem's unit."""
        frame = self.scaled.frame
        origin = -np.array([frame.origin.real, frame.origin.imag]) / frame.scale
        return linkage.scaled(frame.scale, origin)

    def _places(self, at: Carried) -> ComplexArray:
        """Places by the limits, (n, 3)."""
        return np.array([self._place(at, k) for k in range(len(at.closes))]).reshape(-1, 3)

    def _place(self, at: Carried, k: int) -> tuple[complex, complex, complex]:
        row = at.made.shapes.mechanism
        lengths = {"r1": 1.0} | {name: float(at.made.given[name].value[k, 0]) for name in row.lengths[1:]}
        scale, turn, o2 = place_of(self.wanted, lengths, at.reached[k], self.scaled.problem.task.size)
        return o2, scale * turn, 0j
