"""Balancing and flywheel as sections: before and after, in every unit, and input that is refused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from section_facts import facts, in_both_units

from grashof.analysis import inverse_dynamics, size_flywheel
from grashof.problems import (
    DynamicsSpec,
    FourBar,
    InvertedSliderCrank,
    LinkageSpec,
    ProblemError,
    SliderCrank,
    load_linkage_spec,
)
from grashof.problems.values.dynamics.load_specs import CounterweightSpec
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.study.study import LinkageStudy
from grashof.survey import Asked, Section, report_on

Sections = Callable[..., dict[str, Section]]
JACK = load_linkage_spec("pumpjack")
BARE = replace(JACK, dynamics=None)
ROCKER = FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1))
HEAVY = DynamicsSpec(2.0, gravity=(0, -9.81))


def weighted(spec: LinkageSpec, row: Any, links: tuple[int, ...]) -> LinkageSpec:
    """The linkage with the counterweights of a row of the table in its file."""
    assert spec.dynamics is not None
    weights = tuple(
        CounterweightSpec(link, row[f"mass_{link}"], (row[f"u_{link}"], row[f"v_{link}"])) for link in links
    )
    return replace(spec, dynamics=replace(spec.dynamics, counterweights=weights))


@pytest.mark.study
def test_before_is_the_linkage_as_it_is_and_after_with_its_weights_in_the_file(sections: Sections) -> None:
    found = sections(JACK, balance=True)["balancing"]
    rows = found.tables["balancing"].set_index("aim")
    assert rows.index.tolist() == ["as it is", "shaking force", "torque, rms", "torque, peak"]
    for aim, links in (
        ("as it is", ()), ("shaking force", (2, 4)), ("torque, rms", (2,)), ("torque, peak", (2,)),
    ):  # fmt: skip
        row = rows.loc[aim]
        spec = weighted(JACK, row, links)
        report = report_on(spec)
        summary = {fact.key: fact.value for fact in report.facts}
        extremes = report.tables["extremes"].set_index("quantity").loc["torque"]
        assert row["torque_rms"] == pytest.approx(summary["torque_rms"], rel=1e-9)
        assert row["torque_peak"] == pytest.approx(max(-extremes["min"], extremes["max"]), rel=1e-9)
        study = LinkageStudy.of(spec, Asked())
        assert study.masses is not None
        shaking = inverse_dynamics(study.sweep.state(np.linspace(0, 6.3, 2000)), study.masses).shaking_force
        assert np.hypot(*shaking.T).max() == pytest.approx(row["shaking_force_peak"], rel=1e-3, abs=1e-6)
    assert rows.loc["shaking force", "shaking_force_peak"] == 0
    assert rows["torque_rms"].idxmin() == "torque, rms"
    assert rows["torque_peak"].idxmin() == "torque, peak"


def test_counterweights_of_slider_kinds(sections: Sections) -> None:
    """Half of what goes to and fro, with the crank of an engine; all of an inverted slider-crank."""
    given = DynamicsSpec(
        masses=(0.5, 0.8, 0.6), inertias=(200, 900, 100), centres=((10, 0), (30, 0), (0, 0)), speed_rpm=600
    )
    for linkage in (SliderCrank((0, 0), 40, 120), InvertedSliderCrank((0, 0), (0, -90), 40, 10)):
        spec = LinkageSpec(linkage, "mine", length_unit="mm", dynamics=given)
        rows = sections(spec, balance=True)["balancing"].tables["balancing"].set_index("aim")
        before, after = rows["shaking_force_peak"]
        if isinstance(linkage, SliderCrank):
            product = 0.5 * 10 + 40 * (0.6 + (0.2 + 0.6) / 2)
            assert rows.loc["shaking force", "mass_times_radius_2"] == pytest.approx(product, rel=1e-12)
            assert rows.loc["shaking force", "mass_4"] == 0
            assert after < 0.5 * before
        else:
            assert after == 0 < before


@pytest.mark.slow
def test_weights_are_the_same_in_every_unit(sections: Sections) -> None:
    heavy = DynamicsSpec(300.0, speed_rpm=20, gravity=(0, -9.8))
    metres, inches = (
        sections(spec, balance=True, flywheel=0.1) for spec in in_both_units(JACK.linkage, heavy)
    )
    one, two = (each["balancing"].tables["balancing"] for each in (metres, inches))
    peaks = "shaking_force_peak", "shaking_moment_peak", "torque_peak"
    for name in ("mass_2", "mass_4", *peaks, "torque_rms"):
        np.testing.assert_allclose(one[name], two[name], rtol=1e-7, atol=1e-5)
    for key, value in facts(metres["flywheel"]).items():
        assert facts(inches["flywheel"])[key] == pytest.approx(value, rel=1e-7, abs=1e-6)


@pytest.mark.slow
def test_what_cannot_be_balanced_is_said(sections: Sections) -> None:
    floating = replace(JACK, dynamics=DynamicsSpec(300.0))
    found = sections(floating, balance=True)["balancing"]
    assert len(found.tables["balancing"]) == 2
    assert "gravity is zero, so no counterweight evens out the torque" in found.notes
    swings = LinkageSpec(ROCKER, "it", length_unit="m", dynamics=HEAVY)
    found = sections(swings, balance=True)["balancing"]
    assert "torque_peak" not in found.tables["balancing"]
    assert any("does not turn fully" in note for note in found.notes)
    starting = replace(JACK, dynamics=replace(HEAVY, motor=MotorSpec(profile="cycloid")))
    found = sections(starting, balance=True)["balancing"]
    assert any("starts and stops" in note for note in found.notes)


def test_the_flywheel_is_that_of_the_analysis(sections: Sections) -> None:
    found = sections(JACK, flywheel=0.05)["flywheel"]
    study = LinkageStudy.of(JACK, Asked())
    assert study.masses is not None
    wheel = size_flywheel(JACK.linkage, study.masses, 20 * np.pi / 30, 0.05, study.loads)
    given = facts(found)
    assert given["flywheel_inertia"] == wheel.inertia
    assert given["flywheel_energy"] == wheel.energy
    speed = found.plots[0].series["speed"]
    assert np.ptp(speed) == pytest.approx(0.05 * 20, rel=1e-3)


@pytest.mark.parametrize(
    ("spec", "asked", "message"),
    [
        (BARE, {"balance": True}, "balance needs masses; [dynamics] states none"),
        (BARE, {"flywheel": 0.1}, "flywheel needs masses or loads; the file states none"),
        (JACK, {"flywheel": 0.0}, "flywheel is 0; it must be from 1e-06 to 1"),
        (JACK, {"flywheel": np.nan}, "flywheel is nan; it must be a finite number"),
        (
            JACK,
            {"flywheel": 0.1, "speed_rpm": 0.0},
            "flywheel needs a steady speed of the driver, other than 0",
        ),
        (
            LinkageSpec(ROCKER, "it", length_unit="m", dynamics=HEAVY),
            {"flywheel": 0.1},
            "flywheel needs a driver that turns fully; this one swings",
        ),
    ],
)
def test_what_is_refused(sections: Sections, spec: LinkageSpec, asked: dict[str, Any], message: str) -> None:
    with pytest.raises(ProblemError) as error:
        dict(sections(spec, **asked))
    assert str(error.value) == message
