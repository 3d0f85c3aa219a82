"""Functions: generators through all pairs, or of least error and a choice of those that transmit better."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from typing import ClassVar

import numpy as np

from grashof.problems import Linkage, ProblemError
from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.start import DrivenLinkage, Proposal, Round
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.finder import DesignFinder
from grashof.synth.starts.functions.aims import FunctionAims
from grashof.synth.starts.functions.exact import exact_functions
from grashof.synth.starts.functions.optima import Optima, optima
from grashof.synth.starts.functions.pairs import KNOWN
from grashof.synth.theory.functions.fit import fitted
from grashof.synth.theory.functions.optima import refined
from grashof.synth.theory.functions.output import Generators

LEVELS = tuple(np.arange(10.0, 61.0, 10.0).tolist())  # deg: transmission angles at which a choice is offered
FINE = tuple(np.arange(5.0, 86.0, 5.0).tolist())  # where an error is allowed
OFFERED = 1e-6  # miss of an angle at which a choice is offered
WORSE = 10.0  # times the least error: a sense of output and driver in which no choice is offered
SPARE = 10  # exact designs more than enough: the judge refuses some, and some are alike
FINDS = "feasible finds"
CLOSE = 8  # of the designs that miss a requirement
NEAR_EFFORT = 0.35  # for these, of the usual one under many cylinders


class Functions(DesignFinder):
    """Linkages that generate a function.

    Round 0 looks for those through all pairs, or those of least error; another one, with the number of the
    first transmission angle that these do not have, for those of least error at each angle from there on.
    """

    beginning: ClassVar[str] = "looking for linkages that generate the function"

    @cached_property
    def aims(self) -> FunctionAims:
        """The aims of the search."""
        return FunctionAims.of(self.scaled)

    @property
    def exhausted(self) -> str:
        """Why the list has ended."""
        if self.aims.obstacle:
            return self.aims.obstacle
        if not self.aims.exact:
            return "least errors were looked for at every transmission angle"
        count, kind = len(self.aims.task), self.aims.kind
        if self.aims.triangle is not None:
            return f"{self.aims.kinds} through the {count} pairs were looked for under many cylinders"
        if count >= kind.EXACT:
            have = "most sets of five have one, or three" if kind.EXACT == 5 else "most sets of four have one"
            return f"all {self.aims.kinds} through the {count} pairs were looked at; {have}"
        return f"no more distinct {self.aims.kinds} go through the pairs under these requirements"

    @cached_property
    def levels(self) -> tuple[float, ...]:
        """Transmission angles that designs are made for, deg; closer where the objective decides."""
        wanted = self.scaled.problem.requirements
        if self.aims.exact:
            return ()
        if wanted.error_factor is None:
            return tuple(level for level in LEVELS if level > wanted.transmission_min_deg + 1)
        return tuple(level for level in FINE if level > wanted.transmission_min_deg)

    @property
    def rounds_a_pass(self) -> int:
        """One, and one for each angle."""
        return 1 + len(self.levels)

    def quick_pass(self, _rng: np.random.Generator) -> Round | None:
        """A design of small error from few starts."""
        if self.aims.exact or self.aims.obstacle:
            return None
        search = Optima.each(self.aims)[0]
        found = search.quick_pass()
        return Round(self._designs([(found, search.driver)] if len(found) else []), {}, size=0)

    def round(self, number: int, enough: int, rng: np.random.Generator, size: int, /) -> Round | None:
        """Exact designs at once; least errors, and then those at every transmission angle."""
        alone = enough == 1 and self.scaled.problem.requirements.error_factor is None
        if number >= (1 if alone else self.rounds_a_pass) or self.aims.obstacle:
            return None
        if self.aims.exact:
            batch = exact_functions(self.aims, rng, max(enough, 8) + SPARE, size)
            return self._round(batch, together=not self._in_order)
        if number:
            rough = [search.rough(rng, 1) for search in Optima.each(self.aims)]
            begun = [each for level in self.levels[number - 1 :] for each in self._begun_at(level, rough)]
            found = optima(begun, few=True, missed=OFFERED)
            skip = len(self.levels) - number
        else:
            begun = [(search, search.starts(search.rough(rng, size))) for search in Optima.each(self.aims)]
            found = optima(begun, few=False)
            best = min(found, key=lambda each: each.error, default=None)
            cosine = 1.0 if best is None else best.generator.worst_cosine(self.aims.limits.span)[0]
            skip = sum(level <= np.degrees(np.arccos(cosine)) for level in self.levels)
        return self._round([(each.generator, each.search.driver) for each in found], skip=skip)

    def _begun_at(
        self, level: float, rough: Sequence[Sequence[tuple[Generators, float]]]
    ) -> Iterator[tuple[Optima, Generators]]:
        """Searches with at least a transmission angle, deg, that are not hopeless, and their starts."""
        searches = Optima.each(self.aims, float(np.radians(level)))
        begun = [(search, search.starts(each)) for search, each in zip(searches, rough, strict=True)]
        errors = [float(search.aim().error(starts[:1]).min(initial=np.inf)) for search, starts in begun]
        return (each for each, error in zip(begun, errors, strict=True) if error <= WORSE * min(errors))

    def onward(
        self, designs: Sequence[Candidate], _misses: Sequence[Candidate] = (), /
    ) -> list[Linkage | DrivenLinkage]:
        """The least errors that designs for some transmission angle lead to; the best to all its digits."""
        if self.aims.exact or not designs:
            return []
        found = sorted(optima(self._again(designs), few=True), key=lambda each: each.error)
        batches = [(each.generator, each.search.driver) for each in found]
        batches += [(each.search.settled(each), each.search.driver) for each in found[:1]]
        return self._designs(batches)

    def follow(self, design: Candidate) -> list[Linkage | DrivenLinkage]:
        """The generator that a design leads to: through all pairs, or of least error nearby."""
        found = list[tuple[Generators, int]]()
        for search, batch in self._again([design]):
            if self.aims.exact:
                pairs, held = self.aims.pairs(search.sense), search.first is not None
                found.append((fitted(pairs, batch, search.limits.of, held=held)[0], search.driver))
            else:
                found.append((refined(search.aim(), batch).generators, search.driver))
        return self._designs([each for each in found if len(each[0])])

    def _again(self, designs: Sequence[Candidate]) -> Iterator[tuple[Optima, Generators]]:
        """The generators of designs, by senses of output and driver."""
        every = Optima.each(self.aims)
        mine = list[list[Generators]]([] for _ in every)
        for one in designs:
            driver, batch = one.verdict.direction, self.aims.generator(one)
            if batch is None:
                continue
            fit = [
                float(search.aim().error(batch)[0])
                if self.aims.mirrored or driver == search.driver
                else np.inf
                for search in every
            ]
            mine[int(np.argmin(np.nan_to_num(fit, nan=np.inf)))].append(batch)
        for search, several in zip(every, mine, strict=True):
            if several:
                yield search, self.aims.made.joined(several)

    @property
    def _in_order(self) -> bool:
        """Whether exact designs are in the order of the goals, all of which are known here."""
        known = KNOWN if self.scaled.own_objective is None else set[str]()
        return all(goal.key in known for goal, _ in self.scaled.problem.goals)

    def closest_to(self, required: ScaledProblem, key: str, rng: np.random.Generator) -> list[Proposal]:
        """Of exact ones the few most promising; of least errors those at every transmission angle."""
        del required, key
        if self.aims.triangle is not None and self.aims.exact and not self.aims.obstacle:
            return [*self._designs(exact_functions(self.aims, rng, CLOSE + SPARE, NEAR_EFFORT))]
        number, proposals = 0, list[Proposal]()
        while (found := self.round(number, CLOSE, rng, 1)) is not None:
            proposals += found.starts
            number += 1 + found.skip
        return proposals

    def obstacle(self, _rng: np.random.Generator, counts: Mapping[str, int], /) -> str:
        """Limits that contradict each other; pairs that no linkage goes through."""
        if self.aims.obstacle or not self.aims.exact or counts.get(FINDS):
            return self.aims.obstacle
        pairs = f"through the {len(self.aims.task)} pairs on one branch under these requirements"
        not_all = self.aims.triangle is not None or self.aims.places is not None  # of cylinders, of places
        return f"no {self.aims.kinds[:-1]} {'was found' if not_all else 'goes'} {pairs}"

    def _round(
        self, batch: Sequence[tuple[Generators, int]], *, skip: int = 0, together: bool = False
    ) -> Round:
        designs = self._designs(batch)
        return Round(designs, {FINDS: len(designs)}, skip=skip, together=together)

    def _designs(self, batch: Sequence[tuple[Generators, int]]) -> list[Linkage | DrivenLinkage]:
        """Generators as designs, but for pivots that coincide and lengths beyond the floats."""
        found = list[Linkage | DrivenLinkage | None]()
        for one, driver in batch:
            with suppress(ProblemError):
                found.append(self.aims.design(one, driver))
        return [each for each in found if each is not None]
