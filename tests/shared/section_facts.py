"""Shared by tests of analyses: facts by their keys, and the same linkage in two units."""

from dataclasses import replace
from typing import Any

import numpy as np

from grashof.problems import DynamicsSpec, FourBar, LinkageSpec
from grashof.survey import LinkageReport, Section

INCH = 0.0254  # m


def facts(section: Section | LinkageReport) -> dict[str, Any]:
    return {fact.key: fact.value for fact in section.facts}


def in_inches(linkage: FourBar) -> FourBar:
    """A linkage that is given in metres."""
    return linkage.scaled(1 / INCH, np.zeros(2))


def in_both_units(linkage: FourBar, dynamics: DynamicsSpec) -> tuple[LinkageSpec, LinkageSpec]:
    """A linkage of bars, given in metres, and the same one in inches."""
    light = replace(dynamics, mass_per_length=dynamics.mass_per_length * INCH)  # type: ignore[operator]
    return (
        LinkageSpec(linkage, "it", length_unit="m", dynamics=dynamics),
        LinkageSpec(in_inches(linkage), "it", length_unit="in", dynamics=light),
    )
