"""The subject of a drawing: a linkage alone, one with its file, or a design with its problem."""

from __future__ import annotations

import reprlib
from dataclasses import dataclass

from grashof.analysis import Verdict, verify
from grashof.drawing.scene import Scene
from grashof.problems import Cylinder, DynamicsSpec, LinkageSpec, Problem, ProblemError
from grashof.problems import Linkage as AnyKind
from grashof.problems.values.dynamics.struts import PartSpec
from grashof.study.sweep import Sweep
from grashof.synth import Candidate

Linkage = AnyKind | LinkageSpec | Candidate


@dataclass(frozen=True, slots=True, eq=False)
class Subject:
    """A linkage with its unit and masses and, where there is a problem, the verdict on it.

    With a problem `spec` is on the assembly that meets the first target, with the problem's unit and masses.
    """

    spec: LinkageSpec
    problem: Problem | None = None
    verdict: Verdict | None = None

    @classmethod
    def of(cls, linkage: Linkage, problem: Problem | None = None) -> Subject:
        """A single linkage (or ProblemError), judged for the given problem or that of its file."""
        if isinstance(linkage, LinkageSpec):
            spec, problem = linkage, linkage.problem if problem is None else problem
        elif isinstance(linkage, AnyKind):
            spec = LinkageSpec(linkage, "linkage")
        elif isinstance(linkage, Candidate):
            spec = LinkageSpec(linkage.linkage, linkage.id)
        else:
            raise ProblemError(
                f"linkage is {reprlib.repr(linkage)}; it must be a Linkage, a LinkageSpec or a Candidate"
            )
        if spec.linkage.shape:
            raise ProblemError(f"linkage is a batch of shape {spec.linkage.shape}; it must be a single one")
        if problem is None:
            return cls(spec)
        if isinstance(linkage, Candidate):
            verdict = linkage.verdict
        else:
            asked = problem.task, problem.requirements
            verdict = verify(spec.linkage, *asked, problem=problem, cylinder=spec.cylinder)
        return cls(_posed(spec, problem, verdict), problem, verdict)

    @property
    def linkage(self) -> AnyKind:
        """The linkage itself."""
        return self.spec.linkage

    @property
    def scene(self) -> Scene:
        """Its drawn elements over the entire motion of the driver."""
        return Scene(self.linkage, tuple(self.sweep.angles()))

    @property
    def cylinder(self) -> Cylinder | None:
        """The cylinder that drives it, if any."""
        return None if self.verdict is None else self.verdict.cylinder

    @property
    def struts(self) -> tuple[PartSpec, ...]:
        """Its struts and straight springs, once they are placed."""
        dynamics = self.spec.dynamics
        of_file = None if dynamics is None else dynamics.effort
        effort = of_file if self.verdict is None or self.verdict.effort is None else self.verdict.effort
        if effort is None or not effort.is_placed:
            return ()
        return tuple(part for part in effort.parts if part.places)

    @property
    def sweep(self) -> Sweep:
        """The entire motion of its driver; `ProblemError` where it closes at no driver angle."""
        return Sweep.of(self.spec)


def _posed(spec: LinkageSpec, problem: Problem, verdict: Verdict) -> LinkageSpec:
    """The linkage with the unit and masses that its problem states."""
    linkage = spec.linkage.changed(assembly=verdict.assembly[0])
    dynamics = (problem.dynamics or DynamicsSpec()).turning(verdict.direction)
    title = spec.title if problem is spec.problem else problem.title or problem.name
    return LinkageSpec(linkage, spec.name, title, length_unit=problem.length_unit, dynamics=dynamics)
