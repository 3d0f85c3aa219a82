"""Dwells: six-bars whose last link, or slide, stands still over part of a turn, found by `dwell_search`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from grashof.problems import Linkage, ProblemError, Requirements, SixBar, Task
from grashof.problems.values.arrays import ComplexArray
from grashof.problems.values.linkages.mechanism import DyadKind
from grashof.problems.values.tasks.dwell_task import DWELL_HOSTS, USUAL_TOLERANCE
from grashof.synth.designs.candidate import Candidate
from grashof.synth.loop.feasible import Demand
from grashof.synth.programme.start import Proposal, Round
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.closed_loop import Batch
from grashof.synth.starts.finder import ROUNDS_DONE, DesignFinder
from grashof.synth.starts.six_bars.dwell_search import DwellAim, DwellLinkages, drawn, fitted, linkages
from grashof.synth.starts.six_bars.placing import place_of

ROUNDS = 3
FEW = 0.25  # of the work of a round, where the reason for an empty list is looked for
FINDS = "feasible finds"
# Beyond what is required, for peaks between samples: deg of transmission angle; shares of ratio and margin.
SPARE_DEG, SPARE = 0.05, 1e-3
LEAST_DEG = 1.0


@dataclass(frozen=True)
class Dwells(DesignFinder):
    """Dwell linkages of least band, round by round from other four-bars."""

    beginning: ClassVar[str] = "looking for coupler curves with an arc"
    exhausted: ClassVar[str] = ROUNDS_DONE
    rounds_a_pass: ClassVar[int] = ROUNDS

    @property
    def task(self) -> Task:
        """The task of the problem."""
        return self.scaled.problem.task

    @cached_property
    def wanted(self) -> Requirements:
        """Resolved, in the problem's unit."""
        return self.scaled.problem.requirements.resolved(self.task.size, scale_free=self.task.scale_free)

    @cached_property
    def aim(self) -> DwellAim:
        """The aim of the batched search."""
        wanted, slides = self.wanted, self.task.swing is None
        transmission = np.radians(max(wanted.transmission_min_deg, LEAST_DEG) + SPARE_DEG)
        return DwellAim(
            kind=DyadKind.RRP if slides else DyadKind.RRR,
            dwell=self.task.dwell or 0.0,
            swing=self.task.swing or 0.0,
            demand=Demand.turning(transmission, wanted.rotatability_margin * (1 + SPARE)),
            ratio=wanted.link_ratio_max * (1 - SPARE),
        )

    def round(self, number: int, _enough: int, rng: np.random.Generator, _size: int, /) -> Round | None:
        """The best of some thousand four-bars with arcs."""
        if number >= ROUNDS:
            return None
        found = self._linkages(fitted(self.aim, drawn(self.aim, rng), self._tolerance))
        return Round(found, {FINDS: len(found)})

    def follow(self, design: Candidate) -> Sequence[Proposal]:
        """The design itself: tasks of a moved problem have other dwells."""
        return [design.linkage]

    def closest_to(self, required: ScaledProblem, key: str, rng: np.random.Generator) -> Sequence[Proposal]:
        """Some of one round."""
        del required, key
        return self._linkages(fitted(self.aim, drawn(self.aim, rng), self._tolerance, FEW))

    @property
    def _tolerance(self) -> float:
        """The tolerance of dimensions as a share of the ground link; of a slide, roughly, of its stroke."""
        made = self.scaled.problem.manufacturing
        if made is None:
            return USUAL_TOLERANCE
        lengths = self.wanted.r1
        size = self.task.size if lengths is None or self.aim.slides else lengths[1]
        return made.length_tolerance / size

    def _linkages(self, batch: Batch) -> list[Linkage]:
        """Those of a batch as linkages of the problem, best first."""
        with np.errstate(all="ignore"):
            found, path = linkages(self.aim, batch, 720)
            made = [self._placed(found, k, path[k]) for k in range(len(batch))]
        return [each for each in made if each is not None]

    def _placed(self, found: DwellLinkages, k: int, path: ComplexArray) -> Linkage | None:
        """One linkage where limits want it; P is C. None where its numbers are beyond the floats."""
        scale, turn, o2 = self._place(found, k, path)
        ground = scale * turn
        c, side = _xy(scale * found.c[k]), int(found.side_2[k])
        given: dict[str, Any] = {name: scale * float(getattr(found, name)[k]) for name in _LENGTHS}
        if self.aim.slides:  # E ahead of C: the other assembly is the same slide in the other direction
            along = side * -1j * found.d[k] * turn
            given |= {
                "offset_2": side * given.pop("r6"),
                "slide_angle_2": float(np.angle(along)),
                "assembly_2": 1,
            }
        else:
            given |= {"d": _xy(o2 + ground * found.d[k]), "assembly_2": side}
        given |= {"c": c, "coupler_point": c, "assembly": int(found.side[k]), "point_link": 3}
        try:
            return SixBar(_xy(o2), _xy(o2 + ground), **given, hosts=DWELL_HOSTS)
        except ProblemError:
            return None

    def _place(self, found: DwellLinkages, k: int, path: ComplexArray) -> tuple[float, complex, complex]:
        """Length and direction of the ground, and O2."""
        out = found[k : k + 1].outputs(self.aim.kind, path[None])[0]
        bars = _LENGTHS[:-1] if self.aim.slides else _LENGTHS
        lengths = {"r1": 1.0} | {name: float(getattr(found, name)[k]) for name in bars}
        pins = [path, [0.0, 1.0], found.r2[k] * np.array([1, 1j, -1, -1j])]
        pins += [] if self.aim.slides else [[found.d[k]], found.d[k] + out]
        scale = self.task.stroke / float(np.ptp(out.real)) if self.task.stroke else None
        return place_of(self.wanted, lengths, np.concatenate(pins), self.task.size, scale)


_LENGTHS = ("r2", "r3", "r4", "r5", "r6")


def _xy(z: complex) -> tuple[float, float]:
    return float(z.real), float(z.imag)
