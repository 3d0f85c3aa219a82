"""What all sections have in common, on every kind of linkage: keys, shapes, facts that are known."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof.problems import DynamicsSpec, FourBar, LinkageSpec, load_linkage_spec
from grashof.problems.values.dynamics.acting import (
    DamperSpec,
    FrictionSpec,
    LoadSpec,
    Place,
    SpringSpec,
    TorsionSpringSpec,
)
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.study.asked import ON_REQUEST
from grashof.survey import Section

Sections = Callable[..., dict[str, Section]]
HEAVY = DynamicsSpec(2.0, payload=0.5, speed_rpm=-30, gravity=(0, -9.81))
LINKAGES = {
    "crank-rocker": FourBar((1, 2), (4, 3), 0.9, 3, 2.5, (1, 1)),
    "double-crank": FourBar((0, 0), (1, 0), 3, 2.5, 3, (1, 1), assembly=-1),
    "double-rocker": FourBar((0, 0), (4, 0), 3, 1, 3, (0.5, 1)),
    "rocker-crank": FourBar((0, 0), (4, 0), 3, 4, 1, (0.5, 1)),
    "triple-rocker": FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1), assembly=-1),
    "parallelogram": FourBar((0, 0), (3, 0), 2, 3, 2, (1, 1)),
    "deltoid": FourBar((0, 0), (3, 0), 3, 2, 2),
}
LOADED = DynamicsSpec(
    300.0,
    speed_rpm=-10,
    gravity=(0, -9.81),
    loads=(
        LoadSpec(4, at=(-4, 0), values=((0, 0, -9e3), (90, 0, -2e4), (200, 0, -1e4), (360, 0, -9e3))),
        LoadSpec(3, moment=50.0),
        LoadSpec(4, values=((0, 10.0), (3, -20.0), (7, 5.0)), over="time"),
    ),
    springs=(SpringSpec((Place(1, (0, 2)), Place(4, (1, 0))), 500.0, 1.2),),
    dampers=(DamperSpec((Place(1, (0, 2)), Place(4, (1, 0))), 30.0),),
    torsion_springs=(TorsionSpringSpec((2, 3), 40.0, 20.0),),
    friction=FrictionSpec(coulomb=0.1, pin_radius=0.05, viscous=2.0),
    motor=MotorSpec(profile="trapezoid", gear_ratio=30, gear_efficiency=0.9, inertia=0.02),
)
ASKED: dict[str, Any] = {"dwell_deg": 2.0, "sections": ON_REQUEST, "tolerance": 0.01}
MOVED: dict[str, Any] = {"balance": True, "flywheel": 0.1, "release_deg": 20.0, "seconds": 0.2}


@pytest.fixture(scope="module", params=[*LINKAGES, "pumpjack", "lufkin-c912d", "still", "loaded"])
def made(request: pytest.FixtureRequest, sections: Sections) -> dict[str, Section]:
    if request.param in LINKAGES:
        spec = LinkageSpec(LINKAGES[request.param], request.param, length_unit="mm", dynamics=HEAVY)
        turns = request.param in ("crank-rocker", "double-crank")
        return sections(spec, **ASKED, **(MOVED if turns else {"balance": True}))
    if request.param == "loaded":
        return sections(replace(load_linkage_spec("pumpjack"), dynamics=LOADED), **ASKED)
    if request.param == "still":
        return sections(load_linkage_spec("pumpjack"), speed_rpm=0.0, **ASKED)
    return sections(load_linkage_spec(request.param), **ASKED)


@pytest.mark.quick("triple-rocker", "still")
def test_keys_are_names_of_files_and_are_met_once(made: dict[str, Section]) -> None:
    tables = [key for section in made.values() for key in section.tables]
    plots = [plot.key for section in made.values() for plot in section.plots]
    facts = [fact.key for section in made.values() for fact in section.facts]
    for keys, allowed in ((tables, "[a-z0-9-]+"), (plots, "[a-z0-9-]+"), (facts, "[a-z0-9_]+")):
        assert [key for key, count in Counter(keys).items() if count > 1] == []
        assert all(re.fullmatch(allowed, key) for key in keys)


@pytest.mark.quick("loaded", "pumpjack")
def test_plots_are_lines_of_numbers(made: dict[str, Section]) -> None:
    for plot in (plot for section in made.values() for plot in section.plots):
        assert plot.series, plot.key
        for values in plot.series.values():
            assert not np.isinf(values).any(), plot.key
            if plot.places is None:
                assert values.ndim == 2, plot.key
                assert values.shape[1] == 2, plot.key
            else:
                assert values.shape == plot.places.shape, plot.key
            assert plot.angles is None or len(plot.angles) == len(values), plot.key
        for points in plot.points.values():
            assert points.ndim == 2, plot.key
            assert np.isfinite(points).all(), plot.key


def test_facts_are_known_and_tables_are_full(made: dict[str, Section]) -> None:
    for section in made.values():
        assert section.title
        for fact in section.facts:
            assert not isinstance(fact.value, float) or not np.isnan(fact.value), fact.key
        for name, table in section.tables.items():
            assert len(table), name
            if len(table) > 100:  # over the motion, not of extremes
                assert not np.isinf(table.select_dtypes("number").to_numpy()).any(), name
        assert not any(note.endswith(".") for note in section.notes)


def test_without_masses_there_are_no_forces(sections: Sections) -> None:
    bare = replace(load_linkage_spec("pumpjack"), dynamics=None)
    assert not {"pin-forces", "energies"} & set(sections(bare))
