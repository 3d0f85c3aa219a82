"""Common properties of all sections, on several classes of four-bars and on special ones."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from refusals import refusal
from section_facts import HEAVY, JACK, ONE_RANGE, TWO_RANGES, loaded

from grashof.problems import DynamicsSpec, FourBar, LinkageSpec
from grashof.problems.values.dynamics.load_specs import (
    DamperSpec,
    FrictionSpec,
    LoadSpec,
    Place,
    SpringSpec,
    TorsionSpringSpec,
)
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.study.on_request import ON_REQUEST
from grashof.study.section import Section
from grashof.study.sweep import Sweep

OWN = {"over-time", "positions", "mass-centres", *ON_REQUEST}
LINKAGES = {
    "crank-rocker": JACK.linkage,
    "two ranges": TWO_RANGES.linkage,
    "one range": ONE_RANGE.linkage,
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
    "double-rocker": TWO_RANGES.linkage,
    "parallelogram": FourBar((0, 0), (3, 0), 2, 3, 2, (1, 1)),
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
        spec = LinkageSpec(
            CLASSES[name], name, length_unit="mm", dynamics=replace(HEAVY, payload=0.5, speed_rpm=-30)
        )
        made = sections(spec, **ASKED, **(MOVED if name == "crank-rocker" else {"balance": True}))
    elif name == "loaded":
        made = sections(replace(JACK, dynamics=LOADED), **ASKED)
    else:
        made = sections(name, **ASKED)
    every = list(made.values())
    check(every)
    check_known(every)


BARE = replace(JACK, dynamics=None)
TIMED = LoadSpec(2, values=((0, 1), (9, 1)), over="time")
SWINGING = replace(ONE_RANGE, dynamics=HEAVY)
UNMOVED = loaded(ONE_RANGE, loads=(LoadSpec(2, moment=1.0),))


def test_sections_that_nobody_requests_are_those_of_the_file(sections: Any) -> None:
    moving = ["mass-centres", "mechanical-advantage", "hodographs", "coupler-plane"]
    assert [*sections(BARE)] == moving
    forces = {"pin-forces", "energies", "equilibrium", "strength"}
    assert {*sections(JACK)} == forces | {*moving}
    assert set(sections(JACK)["mass-centres"].tables) == {"masses", "mass-centres"}
    # Of a free motion the seconds are its own.
    assert {*sections(JACK, seconds=1, release_deg=0)} == forces | {*moving, "release"}


@pytest.mark.parametrize(
    ("spec", "asked", "message"),
    [
        (BARE, {"balance": True}, "balance needs masses; [dynamics] states none"),
        (BARE, {"flywheel": 0.1}, "flywheel needs masses or loads; the file states none"),
        (JACK, {"flywheel": 0.0}, "flywheel is 0; it must be from 1e-06 to 1"),
        (JACK, {"flywheel": np.nan}, "flywheel is nan; it must be a finite number"),
        (JACK, {"flywheel": 0.1, "speed_rpm": 0.0}, "flywheel needs a steady speed of the driver"),
        (SWINGING, {"flywheel": 0.1}, "flywheel needs a driver that turns fully; this one swings"),
        (BARE, {"release_deg": 1.0}, "release needs masses; [dynamics] states none"),
        (JACK, {"release_rpm": 1.0}, "release_rpm does not go without release"),
        (JACK, {"release_deg": np.nan}, "release is nan; it must be a finite number"),
        (JACK, {"release_deg": 1.0, "release_rpm": 1e9}, "release_rpm is 1000000000; it must be from"),
        (JACK, {"release_deg": 1.0, "seconds": 0.0}, "seconds is 0; it must be from"),
        (JACK, {"release_deg": 1.0, "seconds": 1e9}, "seconds is 1000000000; it must be from"),
        (UNMOVED, {"release_deg": 1.0}, "release: the links have no inertia, so no torque"),
        (loaded(SWINGING, loads=(TIMED,)), {"release_deg": 1.0}, "release does not go with a load over time"),
        (SWINGING, {"release_deg": 180.0}, "the linkage cannot close at driver angle 180 deg; it"),
        *((JACK, {"tolerance": each}, "tolerance is") for each in (0.0, -1.0, np.nan, 1e30)),
        *((JACK, {"dwell_deg": band}, "dwell_deg is") for band in (0.0, -1.0, 400.0, np.nan)),
        (SWINGING, {"at_deg": (0.5, 120)}, "at_deg is 120; the driver moves from -108.21 to 108.21 deg"),
        (JACK, {"at_deg": (0,) * 37}, "at_deg has 37 driver angles; it may have up to 36"),
        (JACK, {"at_deg": (0, np.nan)}, "at_deg[1] is nan"),
        (JACK, {"fit_from_deg": 1.0}, "fit_from_deg is given without fit_to_deg; give both"),
        (JACK, {"fit_to_deg": 1.0}, "fit_to_deg is given without fit_from_deg; give both"),
        (JACK, {"fit_from_deg": 1.0, "fit_to_deg": 1.0}, "are 0 deg apart"),
        (JACK, {"fit_from_deg": 0.0, "fit_to_deg": 361.0}, "are 361 deg apart"),
        (JACK, {"fit_points": 5}, "fit_points is 5"),
        (JACK, {"fit_points": 2000}, "fit_points is 2000; it must be from 6 to 1001"),
        (TWO_RANGES, {"fit_from_deg": 30, "fit_to_deg": 0}, "fit_to_deg is 0; the driver moves from 28.955"),
        (TWO_RANGES, {"fit_from_deg": 30, "fit_to_deg": -30}, "with a dead position between them"),
        (JACK, {"sections": ("fitz",)}, "sections is 'fitz'; it must be some of newton-raphson"),
        (JACK, {"seconds": 1e9}, "more than 20000 rows: make step 5e+04 or more"),
        (JACK, {"seconds": 0.01}, "seconds is 0.01; it must be at least the step, 0.05"),
        (JACK, {"seconds": -1}, "seconds is -1; it must be a number greater than zero"),
        (JACK, {"seconds": np.nan}, "seconds is nan"),
        (JACK, {"seconds": 1, "step": 0}, "step is 0"),
        (JACK, {"step": 1}, "step is given without seconds"),
        (JACK, {"start_deg": 1}, "start_deg is given without seconds"),
        (JACK, {"seconds": 1, "start_deg": np.inf}, "start_deg is inf"),
        (JACK, {"seconds": 1, "step": 0.1, "release_deg": 0}, "step is given with release"),
        (TWO_RANGES, {"seconds": 3, "start_deg": 20}, "start_deg is 20; the driver moves from 28.955 to"),
    ],
)  # fmt: skip
def test_what_is_refused(sections: Any, spec: LinkageSpec, asked: dict[str, Any], message: str) -> None:
    said = refusal(lambda: dict(sections(spec, **asked)))
    assert message in said
    assert "\n" not in said


@pytest.mark.study
def test_names_on_the_command_line(
    grashof: Any, refused: Any, tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
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
        (("--with", "fit"), "sections is 'fit'; it must be some of newton-raphson, differences, fits, equ"),
        (("--seconds", "1e9"), "seconds is 1000000000 and step 0.05; that is more than 20000 rows"),
    ):
        assert message in refused("analyse", "pumpjack", *wrong)
