"""Two outputs from one crank: linkages whose links 4 and 6 have given swings, the best and others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from grashof.problems import Linkage, ProblemError, SixBar
from grashof.problems.values.arrays import BoolArray, FloatArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.start import Proposal, Round
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.finder import ROUNDS_DONE, DesignFinder
from grashof.synth.starts.strokes.tandem_numbers import numbers_of
from grashof.synth.starts.strokes.tandem_search import (
    GENERATIONS,
    Population,
    TandemAim,
    drawn_near,
    evolved,
    searched,
)
from grashof.synth.starts.strokes.tandem_shapes import DRIVEN_BY_CRANK, Tandems
from grashof.synth.theory.distinct import pick_apart

FEW = 12  # generations where the reason for an empty list is looked for
APART, JUDGED = 0.1, 24  # between designs of a round, as `distinct` counts, and their number
NEAREST = 3
PHASES, SAME = 72, 1e-4  # angles between both arms of a crank; difference of scores that are equal
FINDS = "feasible finds"


@dataclass(frozen=True)
class TandemRockers(DesignFinder):
    """Watt II linkages with two swings, the best first."""

    beginning: ClassVar[str] = "looking for linkages with both swings"
    exhausted: ClassVar[str] = ROUNDS_DONE

    @cached_property
    def aim(self) -> TandemAim:
        """Limits and goals."""
        return TandemAim.of(self.scaled.problem)

    @property
    def rounds_a_pass(self) -> int:
        """One for each pair of hosts."""
        return len(self.aim.drives)

    def round(self, number: int, _enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """The best of one pair of hosts."""
        if number >= self.rounds_a_pass:
            return None
        hosts = self.aim.drives[number]
        for aim in dict.fromkeys((self.aim.usable, self.aim)):
            found = searched(aim, hosts, rng, generations=size * GENERATIONS)
            if (feasible := found.taken(found.missed == 0)).score.size:
                break
        starts = self._distinct(hosts, feasible, JUDGED)
        return Round(starts, {FINDS: len(starts)}, size=size, together=bool(starts))

    def relaxed(self, rng: np.random.Generator) -> Sequence[Proposal]:
        """Those that miss the limits by least."""
        found = ((hosts, searched(self.aim, hosts, rng, generations=FEW)) for hosts in self.aim.drives)
        return [each for hosts, some in found for each in self._distinct(hosts, some, NEAREST)]

    def closest_to(self, required: ScaledProblem, key: str, rng: np.random.Generator) -> Sequence[Proposal]:
        """Of those that keep these limits, the ones that miss the others by least."""
        del key
        asked, starts = TandemAim.of(required.problem), list[Proposal]()
        for hosts in self.aim.drives:

            def judged(unknowns: FloatArray, sides: BoolArray, hosts: tuple[int, int] = hosts) -> Population:
                """By these limits; those of the problem are the objective."""
                own, other = (aim.judged(hosts, unknowns, sides) for aim in (self.aim, asked))
                return own._replace(score=-other.missed)

            found = searched(self.aim, hosts, rng, judged, FEW)
            starts += self._distinct(hosts, found.taken(found.missed == 0), NEAREST)
        return starts

    def follow(self, design: Candidate) -> Sequence[Proposal]:
        """The linkage nearest to a design that does this task under these limits."""
        numbers = numbers_of(design.linkage, self.aim)
        if numbers is None:
            return []
        hosts, about, sides = numbers
        rng = np.random.default_rng(0)

        def judged(unknowns: FloatArray, sides: BoolArray) -> Population:
            """The nearest is the best."""
            found = self.aim.judged(hosts, unknowns, sides)
            return found._replace(score=-np.linalg.norm(unknowns - about, axis=1))

        begun = judged(*drawn_near(about, sides, rng))
        last, _ = evolved(judged, begun, rng, hosts, FEW)
        return self._distinct(hosts, last.taken(last.order[:1]), 1)

    def obstacle(self, _rng: np.random.Generator, counts: Mapping[str, int], /) -> str:
        """That no linkage with both swings keeps the limits, where that was looked for."""
        return "" if counts.get(FINDS) else "no linkage with both swings keeps the other limits"

    def _distinct(self, hosts: tuple[int, int], found: Population, most: int) -> list[Linkage]:
        """Linkages that differ, the best first."""
        if not len(found.score):
            return []
        found = found.taken(found.order)
        signatures = signatures_of(self.aim.made(hosts, found.unknowns, found.sides))
        picked = pick_apart(signatures, -np.arange(len(signatures), dtype=np.float64), APART, most)
        chosen = in_phase(self.aim, hosts, found.taken(picked))
        made = linkages(self.aim.made(hosts, chosen.unknowns, chosen.sides))
        return [each for each in made if each is not None]


def signatures_of(made: Tandems) -> FloatArray:
    """The numbers that distinguish linkages, (n, k), whatever the angle between both arms of a crank."""
    places = np.stack([made.o4 - made.o2, made.d - made.o2], axis=-1)
    sides = made.side, made.side_2
    largest = np.max(list(made.lengths.values()), axis=0)
    numbers = [*made.lengths.values(), np.abs(made.c), *(largest * each for each in sides)]
    return np.concatenate([np.stack(numbers, axis=-1), places.real, places.imag], axis=-1)


def in_phase(aim: TandemAim, hosts: tuple[int, int], found: Population) -> Population:
    """The same with outputs in the best synchrony, where the angle between both arms of the crank is free."""
    if hosts != DRIVEN_BY_CRANK or not len(found.score):
        return found
    unknowns = np.repeat(found.unknowns[:, None], 1 + PHASES, axis=1)
    unknowns[:, 1:, -1] = np.arange(PHASES) / PHASES
    flat, sides = unknowns.reshape(-1, unknowns.shape[-1]), np.repeat(found.sides, 1 + PHASES, axis=0)
    tried = aim.judged(hosts, flat, sides)
    apart = aim.synchrony(hosts, flat, sides)
    numbers = (tried.missed, tried.score, apart)
    missed, score, apart = (each.reshape(len(unknowns), -1) for each in numbers)
    as_good = (missed <= missed[:, :1]) & (score >= score[:, :1] - SAME)
    best = np.where(as_good, apart, np.inf).argmin(axis=1) + (1 + PHASES) * np.arange(len(unknowns))
    return tried.taken(best)


def linkages(made: Tandems) -> list[Linkage | None]:
    """Each as a linkage, P in E; None where its numbers are none of a linkage."""
    return [_linkage(made, k) for k in range(len(made))]


def _linkage(made: Tandems, k: int) -> Linkage | None:
    lengths = {name: float(getattr(made, name)[k]) for name in ("r2", "r3", "r4", "r5", "r6")}
    try:
        return SixBar(
            _xy(made.o2[k]),
            _xy(made.o4[k]),
            **lengths,
            c=_xy(made.c[k]),
            d=_xy(made.d[k]),
            assembly=int(made.side[k]),
            assembly_2=int(made.side_2[k]),
            coupler_point=(lengths["r6"], 0.0),
            hosts=made.hosts,
            point_link=6,
        )
    except ProblemError:
        return None


def _xy(z: complex) -> tuple[float, float]:
    return float(z.real), float(z.imag)
