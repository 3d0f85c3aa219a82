"""The sections of an analysis, one file each. A new one is a row of `SECTIONS`."""

from __future__ import annotations

from collections.abc import Callable

from grashof.problems import ProblemError
from grashof.problems.values.linkages.mechanism import ONE_LOOP, Mechanism
from grashof.problems.values.linkages.mechanisms import not_had
from grashof.sections.coupler_plane import coupler_plane
from grashof.sections.cylinder import cylinder
from grashof.sections.differences import differences
from grashof.sections.dwell import dwell_section
from grashof.sections.fits import fits
from grashof.sections.function import function_section
from grashof.sections.hodographs import hodographs
from grashof.sections.loads.balancing import balancing
from grashof.sections.loads.energies import energy_section
from grashof.sections.loads.equations import equations
from grashof.sections.loads.equilibrium import equilibrium
from grashof.sections.loads.flywheel import flywheel
from grashof.sections.loads.motor import motor
from grashof.sections.loads.over_time import over_time
from grashof.sections.loads.pin_forces import pin_forces
from grashof.sections.loads.pumping_unit import pumping_unit
from grashof.sections.loads.release import release
from grashof.sections.loads.strength import strength
from grashof.sections.mass_centres import mass_centres
from grashof.sections.mechanical_advantage import mechanical_advantage
from grashof.sections.newton_raphson import newton_raphson
from grashof.sections.positions import positions
from grashof.sections.tolerance import tolerance
from grashof.study.asked import ON_REQUEST
from grashof.study.kinds import output_turns, plain
from grashof.study.section import Section
from grashof.study.study import LinkageStudy

# In the order in which they are reported. None where the file has no data for it, or nobody asked for it.
SECTIONS: tuple[Callable[[LinkageStudy], Section | None], ...] = (
    function_section,
    mass_centres,
    over_time,
    positions,
    fits,
    newton_raphson,
    differences,
    mechanical_advantage,
    cylinder,
    pin_forces,
    equations,
    hodographs,
    coupler_plane,
    dwell_section,
    tolerance,
    energy_section,
    motor,
    balancing,
    flywheel,
    equilibrium,
    release,
    strength,
    pumping_unit,
)
# Those that only some kinds of linkages have, with which these are and what asks for them.
_ONLY: dict[Callable[[LinkageStudy], Section | None], tuple[Callable[[Mechanism], bool], str]] = {
    newton_raphson: (plain, "newton-raphson"),
    pumping_unit: (plain, ""),
    mechanical_advantage: (output_turns, ""),
    dwell_section: (output_turns, "dwell_deg"),
}


def sections_of(study: LinkageStudy) -> tuple[Section, ...]:
    """The sections that a linkage has; `ProblemError` where one is asked for that its kind has not."""
    kind, asked = study.linkage.mechanism, study.asked
    named = () if set(asked.sections) == set(ON_REQUEST) else asked.sections
    suited = [make for make in SECTIONS if make not in _ONLY or _ONLY[make][0](kind)]
    for make, (have, word) in _ONLY.items():
        if make not in suited and (word in named or getattr(asked, word, None)):
            if have is output_turns and len(kind.dyads) > 1:
                raise ProblemError(f"{word} does not go with a {kind.word} whose link 6 slides")
            kinds = [name for name, row in ONE_LOOP.items() if have(row)]
            raise ProblemError(not_had(word, (kind.word,), kinds))
    return tuple(section for make in suited if (section := make(study)) is not None)
