"""Shared by tests of analyses: linkages, facts by their keys, and the same linkage in two units."""

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from grashof.problems import DynamicsSpec, FourBar, LinkageSpec, load_linkage_spec
from grashof.survey import LinkageReport, Section

INCH = 0.0254  # m
JACK = load_linkage_spec("pumpjack")
HEAVY = DynamicsSpec(2.0, gravity=(0, -9.81))
# Drivers that swing, in one range from -108.21 to 108.21 deg, and in two from 28.955 to 67.9757 deg and back.
ONE_RANGE = LinkageSpec(FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1)), "swinging", length_unit="m")
TWO_RANGES = LinkageSpec(FourBar((0, 0), (4, 0), 3, 1, 3, (0.5, 1)), "rocker")


def loaded(spec: LinkageSpec, **dynamics: Any) -> LinkageSpec:
    """A linkage with other entries in its dynamics."""
    return replace(spec, dynamics=replace(spec.dynamics or DynamicsSpec(), **dynamics))


def facts(section: Section | LinkageReport) -> dict[str, Any]:
    return {fact.key: fact.value for fact in section.facts}


def extremes(report: LinkageReport) -> pd.DataFrame:
    """The table of extremes by the keys of its quantities."""
    return report.tables["extremes"].set_index("quantity")


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
