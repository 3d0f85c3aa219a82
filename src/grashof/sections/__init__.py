"""The sections of an analysis, one file each. A new one is a row of `SECTIONS`."""

from __future__ import annotations

from collections.abc import Callable

from grashof.sections.mass_centres import mass_centres
from grashof.sections.mechanical_advantage import mechanical_advantage
from grashof.study.section import Section
from grashof.study.study import LinkageStudy

# In the order in which they are reported. None where the file has no data for it.
SECTIONS: tuple[Callable[[LinkageStudy], Section | None], ...] = (
    mass_centres,
    mechanical_advantage,
)
