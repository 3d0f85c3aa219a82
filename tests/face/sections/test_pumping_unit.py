"""The pumping-unit view: the maker's figures, and loads of the file against the drive torque."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from section_facts import INCH, facts

from grashof.problems import DynamicsSpec, ProblemError, load_linkage_spec
from grashof.problems.values.dynamics.load_specs import LoadSpec
from grashof.problems.values.dynamics.pumping_unit import PumpingUnitSpec
from grashof.survey import report_on

LUFKIN = load_linkage_spec("lufkin-c912d")
# Polished-rod loads with rounded corners: 20 kN up, 9 kN down.
ROD = [(0, 9e3), (20, 9e3), (35, 20e3), (165, 20e3), (195, 9e3), (360, 9e3)]


def test_the_figures_of_the_maker(sections: Any) -> None:
    found = sections(LUFKIN)["pumping-unit"]
    given = facts(found)
    assert given["api_k"] == pytest.approx(192.875608, abs=5e-7)
    assert given["api_k_angle_deg"] == pytest.approx(51.525764, abs=5e-7)
    assert given["rod_stroke"] == pytest.approx(145.556, abs=5e-4)  # catalogue: 144
    assert given["torque_factor_at_crank_90_deg"] == pytest.approx(68.825, abs=5e-4)  # catalogue: 68.82
    table = found.tables["pumping-unit"].set_index("crank_deg")
    assert table.index.tolist() == list(range(0, 360, 15))
    assert table.loc[90, "torque_factor"] == pytest.approx(68.825284325162193145)
    assert table.loc[90, "theta2_deg"] == 0
    way = np.roll(table["position"], -1) - table["position"]
    assert (np.sign(table["torque_factor"]) == np.sign(way))[1:11].all()
    assert table["permissible_load"].loc[90] == pytest.approx(103042.2 / 68.825284325162193145 / INCH)
    assert "gearbox_torque" not in table
    assert any("no load on the polished rod" in note for note in found.notes)


@pytest.mark.slow
def test_rod_loads_by_torque_factors_and_by_dynamics(sections: Any) -> None:
    """The same load as the API's table, and as a moment on the beam of links without mass."""
    assert LUFKIN.pumping_unit is not None
    unit = replace(LUFKIN.pumping_unit, values=tuple(ROD))
    by_api = sections(replace(LUFKIN, pumping_unit=unit))["pumping-unit"]
    moments = sorted((90.0 - crank, -load * 180 * INCH) for crank, load in ROD)
    dynamics = DynamicsSpec(speed_rpm=-6, loads=(LoadSpec(4, values=tuple(moments)),))
    loaded = replace(LUFKIN, dynamics=dynamics)
    by_file = sections(loaded)["pumping-unit"]
    table = report_on(loaded).tables["dynamics"].set_index("theta2_deg")
    rows = by_api.tables["pumping-unit"]
    torque = -table.loc[rows["theta2_deg"], "torque"].to_numpy()
    peak = facts(by_api)["gearbox_torque_largest"]
    np.testing.assert_allclose(rows["gearbox_torque"], torque, atol=1e-9 * peak)
    by_load = by_file.tables["pumping-unit"]["gearbox_torque"]
    np.testing.assert_allclose(by_load, torque, atol=1e-9 * peak)
    for key, value in facts(by_api).items():
        assert facts(by_file)[key] == pytest.approx(value, rel=1e-8, abs=1e-6), key


def test_means_and_the_even_counterbalance(sections: Any) -> None:
    assert LUFKIN.pumping_unit is not None
    unit = replace(LUFKIN.pumping_unit, values=tuple(ROD), counterbalance=1e4, counterbalance_phase_deg=5)
    found = sections(replace(LUFKIN, pumping_unit=unit))["pumping-unit"]
    given = facts(found)
    torque = next(plot for plot in found.plots if plot.key == "gearbox-torque").series["gearbox"]
    assert given["gearbox_torque_mean"] == pytest.approx(torque[:-1].mean(), rel=1e-3)
    assert given["gearbox_torque_largest"] >= torque.max()
    assert given["cyclic_load_factor"] > 1
    even = replace(unit, counterbalance=given["counterbalance_even"])
    evened = facts(sections(replace(LUFKIN, pumping_unit=even))["pumping-unit"])
    assert evened["gearbox_torque_largest"] == pytest.approx(given["gearbox_torque_even"], rel=1e-8)
    for share in (0.99, 1.01):
        other = replace(unit, counterbalance=share * given["counterbalance_even"])
        worse = facts(sections(replace(LUFKIN, pumping_unit=other))["pumping-unit"])
        peak = max(worse["gearbox_torque_largest"], -worse["gearbox_torque_least"])
        assert peak > given["gearbox_torque_even"]
    assert evened["gearbox_torque_mean"] == pytest.approx(given["gearbox_torque_mean"], rel=1e-9)


def test_a_crank_that_turns_the_other_way_is_noted(sections: Any) -> None:
    for speed in (6, -6):
        turning = replace(LUFKIN, dynamics=DynamicsSpec(speed_rpm=speed))
        assert ("the other way" in " ".join(sections(turning)["pumping-unit"].notes)) == (speed > 0)


def test_files_say_it_with_a_table_of_loads(tmp_path: Path) -> None:
    text = "o2 = [0, 0]\no4 = [120, 151]\nr2 = 47\nr3 = 148.5\nr4 = 120.03\n"
    path = tmp_path / "unit.toml"
    full = f'length_unit = "in"\noutput_arm = 180\n{text}[pumping_unit]\ntable = "rods.csv"\n'
    path.write_text(full, encoding="utf-8")
    rows = "\n".join(f"{crank},{load}" for crank, load in ROD)
    (tmp_path / "rods.csv").write_text(f"crank_deg,load_N\n{rows}\n", encoding="utf-8")
    assert load_linkage_spec(path).pumping_unit == PumpingUnitSpec(values=tuple(ROD))
    both = full.replace('table = "rods.csv"', 'over = "position"\ntable = "rods.csv"')
    for wrong, message in (
        (both, "rods.csv: has the columns 'crank_deg,load_n'; its first line must be position,up_n,down_n"),
        (
            full.replace('"in"', '"inch"'),
            "length_unit is 'inch'; it must be one of mm, cm, m, in, ft with pumping_unit",
        ),
        (full.replace("output_arm = 180\n", ""), "output_arm is missing; pumping_unit needs"),
        (full.replace("table =", "tables ="), "pumping_unit.tables is unknown; did you mean table?"),
        (full + "values = [[0, 1], [360, 1]]\n", "table is given besides values"),
        (full.replace("[pumping_unit]", '[pumping_unit]\nwell = "up"'), "pumping_unit.well is 'up'"),
    ):
        path.write_text(wrong, encoding="utf-8")
        with pytest.raises(ProblemError) as error:
            load_linkage_spec(path)
        assert message in str(error.value)
        assert "\n" not in str(error.value)
