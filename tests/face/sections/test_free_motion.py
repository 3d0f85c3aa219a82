"""Equilibrium and free motion as sections."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.interpolate import CubicSpline
from section_facts import JACK, ONE_RANGE, facts, in_both_units, loaded

from grashof.analysis import balance_force, stated_masses
from grashof.problems import DynamicsSpec, FourBar, LinkageSpec
from grashof.problems.values.dynamics.load_specs import CounterweightSpec, FrictionSpec

SMALL = LinkageSpec(
    FourBar((0, 1.5), (4, 4.5), 1.1938, 3.7719, 3.048762),
    "small",
    length_unit="m",
    dynamics=DynamicsSpec(2.0, gravity=(0, -9.81)),
)


def test_it_swings_about_its_equilibrium_with_its_frequency(sections: Any) -> None:
    still = sections(JACK)["equilibrium"]
    table = still.tables["equilibrium"]
    assert table["stable"].tolist() == [False, True]
    row = table.iloc[1]
    moved = sections(JACK, release_deg=row["theta2_deg"] + 0.05, seconds=4.0)["release"]
    motion = moved.tables["release"]
    # It begins at the end of a swing.
    phase = 2 * np.pi * row["frequency_hz"] * motion["time"]
    expected = row["theta2_deg"] + 0.05 * np.cos(phase)
    np.testing.assert_allclose(motion["theta2_deg"], expected, atol=1e-4)
    assert facts(moved)["release_energy_drift"] < 1e-8


@pytest.mark.slow
def test_the_way_of_a_swinging_driver_is_reported_besides_its_net_turn(sections: Any) -> None:
    moved = sections(SMALL, release_deg=30.0, seconds=5.0)["release"]
    given, table = facts(moved), moved.tables["release"]
    time = np.linspace(0, table["time"].iloc[-1], 400_001)
    speed = np.abs(CubicSpline(table["time"], table["omega2"])(time))
    way = float(np.degrees(np.trapezoid(speed, time)))
    assert given["release_way_deg"] == pytest.approx(way, rel=1e-7)
    net = table["theta2_deg"].iloc[-1] - table["theta2_deg"].iloc[0]
    assert given["release_turned_deg"] == pytest.approx(net)
    assert way > abs(net) + 90


@pytest.mark.slow
def test_frequencies_and_energies_in_every_unit(sections: Any) -> None:
    assert SMALL.dynamics is not None
    metres, inches = (
        sections(spec, release_deg=30.0, seconds=1.0) for spec in in_both_units(SMALL.linkage, SMALL.dynamics)
    )
    for key in ("equilibrium", "release"):
        one, two = inches[key].tables[key], metres[key].tables[key]
        for column in set(one) - {"p_x", "p_y", "time"}:
            np.testing.assert_allclose(one[column], two[column], rtol=1e-8, atol=1e-9)


def test_coasting_against_friction(sections: Any) -> None:
    spec = loaded(SMALL, gravity=(0, 0), friction=FrictionSpec(moment=(8.0,)))
    found = sections(spec, release_deg=10.0, release_rpm=-30.0, seconds=20.0)
    motion, given = found["release"].tables["release"], facts(found["release"])
    assert motion["omega2"].iloc[0] == pytest.approx(-np.pi)
    assert given["release_ending"] == "friction brought the driver to rest"
    assert motion["time"].iloc[-1] <= given["release_seconds"] < 20
    lost = motion["energy"].iloc[0] - motion["energy"].iloc[-1]
    assert given["release_energy_lost"] == pytest.approx(lost)
    assert "equilibrium" not in found


def test_a_balanced_linkage_rests_everywhere(sections: Any) -> None:
    assert SMALL.dynamics is not None
    balanced = balance_force(SMALL.linkage, stated_masses(SMALL.linkage, SMALL.dynamics))
    weights = tuple(
        CounterweightSpec(link, float(body.mass), tuple(body.centre.tolist()))
        for link, body in ((2, balanced.crank_weight), (4, balanced.output_weight))
    )
    rests = facts(sections(loaded(SMALL, counterweights=weights))["equilibrium"])
    assert rests == {"equilibrium_everywhere": True}


def test_a_driver_that_swings_ends_in_a_dead_position(sections: Any) -> None:
    spec = replace(ONE_RANGE, dynamics=SMALL.dynamics)
    found = sections(spec, release_deg=60.0, release_rpm=20.0)
    assert facts(found["release"])["release_ending"] == "the driver came to a dead position"
    assert found["equilibrium"].tables["equilibrium"]["theta2_deg"].abs().max() < 108.3


@pytest.mark.study
def test_options_of_the_command(grashof: Any, refused: Any, tmp_path: Path) -> None:
    options = ("--release", "100", "--release-rpm", "-2", "--seconds", "0.5", "--dwell-deg", "1")
    options = (*options, "--balance", "--flywheel", "0.05", "--tolerance", "0.01")
    done = grashof("analyse", "pumpjack", *options)
    assert done.exit_code == 0, done.output
    motion = pd.read_csv(tmp_path / "pumpjack-analysis" / "table-release.csv")
    assert motion["time"].iloc[-1] == 0.5
    assert motion["omega2"].iloc[0] == pytest.approx(-np.pi / 15)
    for name in ("balancing", "flywheel", "tolerance"):
        assert (tmp_path / "pumpjack-analysis" / f"table-{name}.csv").exists()
    stated = "grashof: release_rpm does not go without release; it is the speed at that angle\n"
    assert refused("analyse", "pumpjack", "--release-rpm", "3") == stated
