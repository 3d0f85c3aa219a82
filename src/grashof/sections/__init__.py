"""The sections of an analysis. A new one is a row of `SECTIONS`."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from grashof.problems import ProblemError
from grashof.problems.values.linkages.mechanism import ONE_LOOP, Mechanism
from grashof.problems.values.linkages.mechanisms import not_had
from grashof.sections.balancing import balancing
from grashof.sections.coupler import coupler_plane, hodographs
from grashof.sections.cylinder import cylinder
from grashof.sections.drive import energy_section, flywheel, motor
from grashof.sections.effort import effort
from grashof.sections.fits import fits
from grashof.sections.free_driver import equilibrium, release
from grashof.sections.joint_forces import equations, pin_forces
from grashof.sections.numerical import differences, newton_raphson
from grashof.sections.output import dwell_section, function_section, mechanical_advantage
from grashof.sections.over_time import over_time
from grashof.sections.places import mass_centres, positions
from grashof.sections.pumping_unit import pumping_unit
from grashof.sections.strength import strength
from grashof.sections.tolerance import tolerance
from grashof.study.kinds import output_turns, plain
from grashof.study.on_request import ON_REQUEST
from grashof.study.section import Section
from grashof.study.study import LinkageStudy


class SectionRow(NamedTuple):
    """A section: the function that makes it, the kinds of linkage that have it, the option that requires it.

    The function returns None where the file lacks its data, or the option that requires it is not set.
    """

    make: Callable[[LinkageStudy], Section | None]
    suits: Callable[[Mechanism], bool] = lambda _: True
    option: str = ""


# In the order in which they are reported.
SECTIONS = (
    SectionRow(function_section),
    SectionRow(mass_centres),
    SectionRow(over_time),
    SectionRow(positions),
    SectionRow(fits),
    SectionRow(newton_raphson, plain, "newton-raphson"),
    SectionRow(differences),
    SectionRow(mechanical_advantage, output_turns),
    SectionRow(cylinder),
    SectionRow(effort),
    SectionRow(pin_forces),
    SectionRow(equations),
    SectionRow(hodographs),
    SectionRow(coupler_plane),
    SectionRow(dwell_section, output_turns, "dwell_deg"),
    SectionRow(tolerance),
    SectionRow(energy_section),
    SectionRow(motor),
    SectionRow(balancing),
    SectionRow(flywheel),
    SectionRow(equilibrium),
    SectionRow(release),
    SectionRow(strength),
    SectionRow(pumping_unit, plain),
)


def sections_of(study: LinkageStudy) -> tuple[Section, ...]:
    """The sections of a linkage; `ProblemError` where one is requested that its kind does not have."""
    kind, options = study.linkage.mechanism, study.asked
    named = () if set(options.sections) == set(ON_REQUEST) else options.sections
    for _, suits, option in SECTIONS:
        if not suits(kind) and (option in named or getattr(options, option, None)):
            if suits is output_turns and len(kind.dyads) > 1:
                raise ProblemError(f"{option} does not go with a {kind.word} whose link 6 slides")
            kinds = [name for name, row in ONE_LOOP.items() if suits(row)]
            raise ProblemError(not_had(option, (kind.word,), kinds))
    found = (make(study) for make, suits, _ in SECTIONS if suits(kind))
    return tuple(section for section in found if section is not None)
