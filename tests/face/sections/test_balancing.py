"""Balancing as a section: before and after, and in every unit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from section_facts import HEAVY, JACK, ONE_RANGE, facts, in_both_units, loaded

from grashof.analysis import inverse_dynamics
from grashof.problems import DynamicsSpec, InvertedSliderCrank, LinkageSpec, SliderCrank
from grashof.problems.values.dynamics.load_specs import CounterweightSpec
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.study.study import LinkageStudy
from grashof.survey import Asked, report_on


@pytest.mark.study
def test_before_is_the_linkage_as_it_is_and_after_with_its_weights_in_the_file(sections: Any) -> None:
    found = sections(JACK, balance=True)["balancing"]
    rows = found.tables["balancing"].set_index("aim")
    assert rows.index.tolist() == ["as it is", "shaking force", "torque, rms", "torque, peak"]
    for aim, links in (
        ("as it is", ()), ("shaking force", (2, 4)), ("torque, rms", (2,)), ("torque, peak", (2,)),
    ):  # fmt: skip
        row = rows.loc[aim]
        places = [(link, row[f"mass_{link}"], (row[f"u_{link}"], row[f"v_{link}"])) for link in links]
        spec = loaded(JACK, counterweights=tuple(CounterweightSpec(*place) for place in places))
        report = report_on(spec)
        summary = facts(report)
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


def test_counterweights_of_slider_kinds(sections: Any) -> None:
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
def test_weights_are_the_same_in_every_unit(sections: Any) -> None:
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
def test_what_cannot_be_balanced_is_said(sections: Any) -> None:
    found = sections(replace(JACK, dynamics=DynamicsSpec(300.0)), balance=True)["balancing"]
    assert len(found.tables["balancing"]) == 2
    assert "gravity is zero, so no counterweight evens out the torque" in found.notes
    found = sections(replace(ONE_RANGE, dynamics=HEAVY), balance=True)["balancing"]
    assert "torque_peak" not in found.tables["balancing"]
    assert any("does not turn fully" in note for note in found.notes)
    starting = replace(JACK, dynamics=replace(HEAVY, motor=MotorSpec(profile="cycloid")))
    found = sections(starting, balance=True)["balancing"]
    assert any("starts and stops" in note for note in found.notes)
