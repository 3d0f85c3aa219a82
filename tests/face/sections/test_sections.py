"""Common properties of all sections, on several classes of four-bars and on special ones."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof.problems import DynamicsSpec, FourBar, LinkageSpec, load_linkage, load_linkage_spec
from grashof.problems.values.dynamics.load_specs import (
    DamperSpec,
    FrictionSpec,
    LoadSpec,
    Place,
    SpringSpec,
    TorsionSpringSpec,
)
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.problems.values.dynamics.strength import SectionSpec
from grashof.study.asked import ON_REQUEST
from grashof.study.section import Section
from grashof.study.sweep import Sweep

OWN = {"over-time", "positions", "mass-centres", *ON_REQUEST}
LINKAGES = {
    "crank-rocker": load_linkage("pumpjack"),
    "two ranges": FourBar((0, 0), (4, 0), 3, 1, 3, (0.5, 1)),
    "one range": FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1)),
    "parallelogram": FourBar((0, 0), (4, 0), 1, 4, 1, (1, 1)),
    "kite": FourBar((0, 0), (4, 0), 4, 2, 2, (1, 1)),
    "antiparallelogram": FourBar((0, 0), (4, 0), 2, 4, 2, (1, 1), -1),
    "change point": FourBar((0, 0), (4, 0), 1, 3, 2, (1, 1)),
    "P in A": FourBar((0, 0), (4, 0), 1, 4, 3),
    "minute": FourBar((0, 0), (4e-9, 0), 1e-9, 4e-9, 3e-9, (1e-9, 1e-9)),
    "huge": FourBar((1e9, 0), (4e12, 0), 1e12, 4e12, 3e12, (1e12, 1e12)),
    "all but a change point": FourBar((0, 0), (4, 0), 1, 4, 1.0000001, (1, 1)),
}
DYNAMICS = {
    "none": ("m", None),
    "clockwise, a link without mass": (
        "mm", DynamicsSpec(masses=(1, 0, 2), inertias=(0, 0, 0.1), gravity=(0, -9.81), speed_rpm=-30)
    ),
    "at rest": ("in", DynamicsSpec(mass_per_length=2.0, speed_rpm=0.0)),
    "payload alone": ("m", DynamicsSpec(payload=3.0)),
}  # fmt: skip
CLASSES = {
    "crank-rocker": FourBar((1, 2), (4, 3), 0.9, 3, 2.5, (1, 1)),
    "double-rocker": FourBar((0, 0), (4, 0), 3, 1, 3, (0.5, 1)),
    "parallelogram": FourBar((0, 0), (3, 0), 2, 3, 2, (1, 1)),
}
HEAVY = DynamicsSpec(2.0, payload=0.5, speed_rpm=-30, gravity=(0, -9.81))
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


@pytest.mark.quick("crank-rocker-none", "minute-none")
@pytest.mark.parametrize("dynamics", DYNAMICS)
@pytest.mark.parametrize("name", LINKAGES)
def test_all_is_finite_or_empty_and_nothing_warns(sections: Any, name: str, dynamics: str) -> None:
    unit, given = DYNAMICS[dynamics]
    spec = LinkageSpec(LINKAGES[name], name, length_unit=unit, dynamics=given)
    low, high = np.degrees(Sweep.of(spec).ranges[0])
    some = {
        "at_deg": (low, (low + high) / 2, high),
        "fit_from_deg": low + 1e-3,
        "fit_to_deg": (low + high) / 2,
    }
    for asked in ({"seconds": 0.1}, {"seconds": 3.0}, some):
        found = sections(spec, sections=ON_REQUEST, **asked)
        own = [found[key] for key in OWN if key in found]
        assert len(own) > 3
        check(own)
        check_finite(own)


def check(made: Iterable[Section]) -> None:
    """Keys are names of files and met once, plots are lines of numbers."""
    every = list(made)
    plots = [plot for section in every for plot in section.plots]
    facts = [fact for section in every for fact in section.facts]
    tables = [(name, table) for section in every for name, table in section.tables.items()]
    for keys, allowed in (
        ([name for name, _ in tables], "[a-z0-9-]+"),
        ([plot.key for plot in plots], "[a-z0-9-]+"),
        ([fact.key for fact in facts], "[a-z0-9_]+"),
    ):
        assert [key for key, count in Counter(keys).items() if count > 1] == []
        assert all(re.fullmatch(allowed, key) for key in keys)
    for plot in plots:
        assert plot.series, plot.key
        for label, values in plot.series.items():
            assert not np.isinf(values).any(), (plot.key, label)
            assert values.shape == ((len(values), 2) if plot.places is None else plot.places.shape), plot.key
            assert plot.angles is None or len(plot.angles) == len(values), plot.key


def check_known(made: Iterable[Section]) -> None:
    """Facts and points of plots are known, tables are full."""
    for section in made:
        assert section.title
        assert not any(note.endswith(".") for note in section.notes)
        for points in (points for plot in section.plots for points in plot.points.values()):
            assert points.ndim == 2, section.key
            assert np.isfinite(points).all(), section.key
        for fact in section.facts:
            assert not isinstance(fact.value, float) or not np.isnan(fact.value), fact.key
        for name, table in section.tables.items():
            assert len(table), name
            if len(table) > 100:  # over the motion, not of extremes
                assert not np.isinf(table.select_dtypes("number").to_numpy(dtype=float)).any(), name


def check_finite(made: Iterable[Section]) -> None:
    """No fact and no entry of any table is infinite."""
    for section in made:
        for table in section.tables.values():
            assert not np.isinf(table.select_dtypes("number").to_numpy(dtype=float)).any(), section.key
        for fact in section.facts:
            assert not isinstance(fact.value, float) or np.isfinite(fact.value), fact


@pytest.mark.parametrize("name", [*CLASSES, "lufkin-c912d", "loaded"])
def test_every_section_is_sound(sections: Any, name: str) -> None:
    if name in CLASSES:
        spec = LinkageSpec(CLASSES[name], name, length_unit="mm", dynamics=HEAVY)
        made = sections(spec, **ASKED, **(MOVED if name == "crank-rocker" else {"balance": True}))
    elif name == "loaded":
        made = sections(replace(load_linkage_spec("pumpjack"), dynamics=LOADED), **ASKED)
    else:
        made = sections(name, **ASKED)
    every = list(made.values())
    check(every)
    check_known(every)


def test_without_masses_there_are_no_forces(sections: Any) -> None:
    bare = replace(load_linkage_spec("pumpjack"), dynamics=None)
    assert not {"pin-forces", "energies"} & set(sections(bare))


def test_tables_of_masses(sections: Any) -> None:
    table = sections("pumpjack")["mass-centres"].tables["masses"].set_index("link")
    assert table["mass"].tolist() == pytest.approx([372.4656, 1176.8328, 957.311268, 2506.609668])
    assert table.loc["3, coupler", ["centre_u", "centre_v"]].tolist() == [3.7719 / 2, 0]
    assert table.loc["4, output", "inertia_kg_m2"] == pytest.approx(741.513342879474)
    loaded = LinkageSpec(
        FourBar((0, 0), (4, 0), 1, 4, 3, (2, 1)), "x", length_unit="m", dynamics=DynamicsSpec(payload=5.0)
    )
    table = sections(loaded)["mass-centres"].tables["masses"].set_index("link")
    assert table.loc["3, coupler", ["centre_u", "centre_v"]].tolist() == [2, 1]
    assert table["mass"].tolist() == [0, 5, 0, 5]


def test_volumes_of_bars_of_stated_density(sections: Any) -> None:
    inch = 0.0254
    dynamics = DynamicsSpec(density=7800, section=SectionSpec(0.2 / inch, 0.1 / inch), payload=7.0)
    spec = LinkageSpec(
        FourBar((0, 0), (50, 0), 10, 45, 40, (1, 1)), "bars", length_unit="in", dynamics=dynamics
    )
    table = sections(spec)["mass-centres"].tables["masses"].set_index("link")
    volumes = [0.02 * length * inch for length in (10, 45, 40)]
    assert table["volume_m3"].iloc[:3].tolist() == pytest.approx(volumes)
    masses = [7800 * volume for volume in volumes]
    assert table["mass"].tolist() == pytest.approx([masses[0], masses[1] + 7, masses[2], sum(masses) + 7])


@pytest.mark.study
def test_names_on_the_command_line(grashof: Any, tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("grashof.figures.files.save", lambda _, paths: [path.touch() for path in paths])
    asked = ("--all", "--seconds", "1", "--at", " 0, -90 ", "--fit-from-deg", "0", "--fit-to-deg", "90")
    done = grashof("analyse", "pumpjack", *asked)
    assert done.exit_code == 0, done.output
    folder = tmp_path / "pumpjack-analysis"
    names = {
        "over-time", "positions", "masses", "mass-centres", "mass-centres-over-time", "fits",
        "fits-coefficients", "fits-points", "newton-raphson", "differences", "differences-deviations",
        "equations",
    }  # fmt: skip
    written = {path.stem.removeprefix("table-") for path in folder.glob("table-*.csv")}
    assert names <= written
    some = grashof("analyse", "pumpjack", "--with", "equations, fits")
    assert some.exit_code == 0
    left = {"masses", "mass-centres", "fits", "fits-coefficients", "fits-points", "equations"}
    written -= {path.stem.removeprefix("table-") for path in folder.glob("table-*.csv")}
    assert written == names - left
    for wrong, message in (
        (("--at", "0;90"), "--at is '0;90'; it must be numbers with commas between them, such as 0,90,180"),
        (
            ("--with", "fit"),
            "sections is 'fit'; it must be some of newton-raphson, differences, fits, equations",
        ),
        (("--seconds", "1e9"), "seconds is 1000000000 and step 0.05; that is more than 20000 rows"),
    ):
        refused = grashof("analyse", "pumpjack", *wrong)
        assert refused.exit_code == 2
        assert message in refused.stderr
        assert refused.stderr.count("\n") == 1
