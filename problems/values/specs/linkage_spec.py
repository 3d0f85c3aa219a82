"""A linkage with the other contents of its file, or of the list it comes from."""

from __future__ import annotations

from dataclasses import dataclass, field

from grashof.problems.values.checks import refuse
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.dynamics.pumping_unit import PumpingUnitSpec
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.linkages.cylinder import Cylinder
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.one_loop import FourBar
from grashof.problems.values.specs.dynamics_of_kind import misplaced
from grashof.problems.values.specs.problem import Problem
from grashof.problems.values.text import plain_text
from grashof.problems.values.value_bases import Displayed, check_fields


@dataclass(frozen=True, slots=True)
class LinkageSpec(Displayed):
    """A linkage with the other contents of its file.

    Parameters
    ----------
    linkage : Linkage
    name, title, source, length_unit : str
    output_arm : float, length, optional
        Radius about O4 of the part that the output link drives, such as a horsehead: its stroke and torque
        factor are reported.
    dynamics : DynamicsSpec, optional
        Masses, speed, gravity and other loads; it need not have masses.
    pumping_unit : PumpingUnitSpec, optional
        Where the linkage is one; `output_arm` is then that of its horsehead.
    problem : Problem, optional
        Of a design out of a list: the task it was found for.
    cylinder : Cylinder, optional
        That drives it.
    """

    linkage: Linkage
    name: str
    title: str = ""
    source: str = ""
    length_unit: str = ""
    output_arm: float | None = None
    dynamics: DynamicsSpec | None = None
    pumping_unit: PumpingUnitSpec | None = None
    problem: Problem | None = field(default=None, compare=False, repr=False)
    cylinder: Cylinder | None = None

    def __post_init__(self) -> None:
        check_fields(self, **dict.fromkeys(("name", "title", "source", "length_unit"), plain_text))
        if self.pumping_unit is not None and self.output_arm is None:
            raise ProblemError("output_arm is missing; pumping_unit needs that of the horsehead")
        if self.pumping_unit is not None and not isinstance(self.linkage, FourBar):
            raise ProblemError(
                f"pumping_unit does not go with mechanism {self.linkage.mechanism.word}; only four-bar has it"
            )
        if self.dynamics is not None:
            refuse(misplaced(self.dynamics, self.linkage.mechanism))

    @property
    def four_bar(self) -> FourBar:
        """The linkage, which has to be a four-bar."""
        if not isinstance(self.linkage, FourBar):
            raise ProblemError(f"{self.name} is a {self.linkage.mechanism.word}; it must be a four-bar")
        return self.linkage

    @property
    def unit(self) -> str:
        """The length unit, or the word length where the file names none."""
        return self.length_unit or "length"


@dataclass(frozen=True, slots=True)
class ListedDesign:
    """A design of a candidates list, with the list's data on its targets."""

    spec: LinkageSpec
    rank: int
    id: str
    theta2: tuple[float, ...]  # rad, driver angle at each target
    assembly: tuple[int, ...]  # of the linkage at each target
    position_error: tuple[float | None, ...]  # distance from each target; None where it has no position
    angle_error: tuple[float | None, ...]  # rad, the same of its angle; empty for a path

    def __post_init__(self) -> None:
        counts = {len(self.theta2), len(self.assembly), len(self.position_error)}
        counts |= {len(self.angle_error)} if self.angle_error else set()
        if len(counts) > 1 or 0 in counts or any(sign not in (1, -1) for sign in self.assembly):
            raise ProblemError("theta2, assembly and errors have different numbers of targets")
