"""The sections of an analysis, one file each. A new one is a row of `SECTIONS`."""

from __future__ import annotations

from collections.abc import Callable

from grashof.sections.coupler_plane import coupler_plane
from grashof.sections.dwell import dwell_section
from grashof.sections.energies import energy_section
from grashof.sections.equilibrium import equilibrium
from grashof.sections.hodographs import hodographs
from grashof.sections.mass_centres import mass_centres
from grashof.sections.mechanical_advantage import mechanical_advantage
from grashof.sections.pin_forces import pin_forces
from grashof.sections.pumping_unit import pumping_unit
from grashof.sections.release import release
from grashof.sections.strength import strength
from grashof.study.section import Section
from grashof.study.study import LinkageStudy

# In the order in which they are reported. None where the file has no data for it.
SECTIONS: tuple[Callable[[LinkageStudy], Section | None], ...] = (
    mass_centres,
    mechanical_advantage,
    pin_forces,
    hodographs,
    coupler_plane,
    dwell_section,
    energy_section,
    equilibrium,
    release,
    strength,
    pumping_unit,
)
