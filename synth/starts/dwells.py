"""Dwells: six-bars whose last link, or slide, stands still over part of a turn, found by `dwell_search`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from grashof.problems import Linkage, ProblemError, Requirements, SixBar, Task
from grashof.problems.values.linkages.mechanism import DyadKind
from grashof.problems.values.linkages.mechanisms import ROWS
from grashof.synth.designs.candidate import Candidate
from grashof.synth.loop.feasible import Demand
from grashof.synth.programme.start import Proposal, Round
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.closed_loop import Batch
from grashof.synth.starts.dwell_search import DwellAim, DwellLinkages, drawn, fitted, linkages
from grashof.synth.starts.finder import DesignFinder

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
    exhausted: ClassVar[str] = "further rounds find the same dwells"
    rounds_a_pass: ClassVar[int] = ROUNDS

    @staticmethod
    def suits(scaled: ScaledProblem) -> bool:
        """Tasks with a dwell."""
        return scaled.problem.task.dwell is not None

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
        """What the batched search looks for."""
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
        batch, _ = fitted(self.aim, drawn(self.aim, rng))
        found = self._linkages(batch)
        return Round(found, {FINDS: len(found)})

    def follow(self, design: Candidate) -> Sequence[Proposal]:
        """The design itself: tasks of a moved problem have other dwells."""
        return [design.linkage]

    def closest_to(self, required: ScaledProblem, key: str, rng: np.random.Generator) -> Sequence[Proposal]:
        """Some of one round."""
        del required, key
        batch, _ = fitted(self.aim, drawn(self.aim, rng), FEW)
        return self._linkages(batch)

    def _linkages(self, batch: Batch) -> list[Linkage]:
        """Those of a batch as linkages of the problem."""
        with np.errstate(all="ignore"):
            found, path = linkages(self.aim, batch, 720)
            travel = found.outputs(self.aim.kind, path).real
        made = list[Linkage]()
        for k in range(len(batch)):
            scale = self._scale(found, k, float(np.ptp(travel[k])))
            try:
                made.append(self._linkage(found, k, scale))
            except ProblemError:  # numbers beyond the floats
                continue
        return made

    def _scale(self, found: DwellLinkages, k: int, stroke: float) -> float:
        """Length of r1: by the stroke, or else so that limits of lengths are met where they can be."""
        if self.task.stroke is not None:
            return self.task.stroke / stroke
        low, high = 0.0, np.inf
        for name, length in {
            "r1": 1.0,
            **{name: float(getattr(found, name)[k]) for name in _LENGTHS},
        }.items():
            limits = getattr(self.wanted, name, None) or self.wanted.link_length
            if limits is not None:
                low, high = max(low, limits[0] / length), min(high, limits[1] / length)
        return float(np.clip(self.task.size, low, max(low, high)))

    def _linkage(self, found: DwellLinkages, k: int, scale: float) -> Linkage:
        """One linkage; P is C."""
        turned = self.wanted.angle_of("ground_angle_deg") or 0.0
        turn = np.exp(1j * turned)
        o2 = self._o2
        ground = scale * turn
        row = ROWS[self.scaled.problem.mechanism[0]][0]
        c = _xy(scale * found.c[k])
        given: dict[str, Any] = {name: scale * float(getattr(found, name)[k]) for name in _LENGTHS}
        side = int(found.side_2[k])
        if self.aim.slides:  # E ahead of C: the other assembly is the same slide in the other direction
            along = side * -1j * found.d[k] * turn
            given |= {"offset_2": side * given.pop("r6"), "slide_angle_2": float(np.angle(along))}
            side = 1
        else:
            given["d"] = _xy(o2 + ground * found.d[k])
        return SixBar(
            _xy(o2),
            _xy(o2 + ground),
            c=c,
            coupler_point=c,
            assembly=int(found.side[k]),
            assembly_2=side,
            hosts=row.dyads[1].hosts,
            point_link=3,
            **given,
        )

    @property
    def _o2(self) -> complex:
        """The middle of the area for O2; the origin where it may be anywhere."""
        box = self.wanted.o2
        sides = [(0.0, 0.0)] * 2 if box is None else [box.x, box.y]
        return complex(*(sum(side) / 2 if np.isfinite(side).all() else 0.0 for side in sides))


_LENGTHS = ("r2", "r3", "r4", "r5", "r6")


def _xy(z: complex) -> tuple[float, float]:
    return float(z.real), float(z.imag)
