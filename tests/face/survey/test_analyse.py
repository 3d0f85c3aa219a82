"""`grashof analyse`: the figures of two real machines, limited ranges, ways of a driver."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from section_facts import JACK, ONE_RANGE, TWO_RANGES, extremes, facts, in_both_units, loaded

import grashof.figures.files
from grashof.analysis import (
    Loads,
    driver_ranges,
    given_masses,
    inverse_dynamics,
    output_stroke,
    solve_kinematics,
    uniform_bars,
)
from grashof.output.analysis_files import print_report
from grashof.output.run_files import write_run
from grashof.problems import DynamicsSpec, FourBar, LinkageSpec, MotionTask, ProblemError, load_linkage_spec
from grashof.survey import Asked, LinkageReport, report_on
from grashof.synth import Result, synthesize

Grashof = Callable[..., Any]
GOLDEN = json.loads((Path(__file__).parents[2] / "data" / "golden.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def jack() -> LinkageReport:
    return report_on(JACK)


def test_the_real_unit_has_the_stroke_and_torque_factor_of_its_maker() -> None:
    found = facts(report_on(load_linkage_spec("lufkin-c912d")))
    unit = GOLDEN["pumpjack_lufkin_C912D_427_144"]
    assert found["output_stroke"] == pytest.approx(float(unit["strokes"]["47"]["stroke_in"]), rel=1e-12)
    assert found["output_stroke"] == pytest.approx(145.556, abs=5e-4)
    assert "torque_factor_at_0_deg" not in found  # it is of the [pumping_unit], at the crank angle
    assert found["transmission_min_deg"] == pytest.approx(180 - float(unit["mu_max_deg"]), abs=1e-9)
    assert found["grashof_class"] == "crank-rocker"


def test_extremes_of_the_pumpjack_are_the_reference_figures(jack: LinkageReport) -> None:
    table, checked = extremes(jack), 0
    names = {"vB_mag": "b_speed", "aB_mag": "b_acceleration", "P_x": "p_x", "P_y": "p_y"}
    for key, expected in GOLDEN["pumpjack_report_geometry"]["extremes_sigma+1"].items():
        name, side = key.replace("_unwrapped", "").rsplit("_", 1)
        scale = 180 / np.pi if name.startswith("theta") else 1.0
        row = table.loc[names.get(name, f"{name}_deg" if name.startswith("theta") else name)]
        assert row[side] == pytest.approx(scale * float(expected["value"]), rel=1e-9), key
        assert row[f"theta2_{side}_deg"] == pytest.approx(float(expected["theta2_deg"]), abs=1e-4), key
        checked += 1
    assert checked == 19


def test_torque_and_forces_of_the_pumpjack_are_the_reference_figures() -> None:
    heavy = report_on(loaded(JACK, gravity=(0, -9.81)))
    rows = heavy.tables["dynamics"].set_index("theta2_deg")
    checked = 0
    for case in GOLDEN["pumpjack_report_geometry"]["inverse_dynamics"]["cases"]:
        if float(case["g"]) == 9.81:
            row = rows.loc[float(case["theta2_deg"])]
            assert row["torque"] == pytest.approx(float(case["T"]), rel=1e-9)
            for name in ("f12", "f32", "f43", "f14"):
                force = [float(part) for part in case[name.upper()]]
                assert [row[f"{name}_x"], row[f"{name}_y"]] == pytest.approx(force, rel=1e-9, abs=1e-6)
                assert row[name] == pytest.approx(np.hypot(*force), rel=1e-9)
            checked += 1
    assert checked >= 1


@pytest.mark.slow
def test_forces_are_newtons_in_every_length_unit() -> None:
    heavy = DynamicsSpec(300.0, payload=50, speed_rpm=12, gravity=(0, -9.8))
    both = in_both_units(JACK.linkage, heavy)
    metres, inches = (report_on(spec).tables["dynamics"] for spec in both)
    for name in ("torque", "f12", "f43", "shaking_force", "shaking_moment", "power"):
        np.testing.assert_allclose(inches[name], metres[name], rtol=1e-9, atol=1e-6)
    masses = uniform_bars(JACK.linkage, 300.0, 50.0)
    state = solve_kinematics(JACK.linkage, np.radians(metres["theta2_deg"]), 12 * np.pi / 30)
    torque = inverse_dynamics(state, masses, Loads(gravity=(0, -9.8))).torque
    np.testing.assert_allclose(metres["torque"], torque, rtol=1e-12, atol=1e-9)


def test_the_table_is_the_motion(jack: LinkageReport) -> None:
    table, linkage = jack.tables["kinematics"], jack.sweep.spec.linkage
    assert table["theta2_deg"].tolist() == pytest.approx(list(range(361)))
    state = solve_kinematics(linkage, np.radians(table["theta2_deg"]), 20 * np.pi / 30)
    for name, values in {
        "omega3": state.omega3, "alpha4": state.alpha4, "p_velocity_x": state.p.velocity[:, 0],
        "b_acceleration_y": state.b.acceleration[:, 1], "a_y": state.a.position[:, 1],
    }.items():  # fmt: skip
        np.testing.assert_allclose(table[name], values, rtol=1e-12, atol=1e-12)
    assert np.abs(np.diff(table["theta4_deg"])).max() < 2
    stroke = output_stroke(linkage)
    assert facts(jack)["output_swing_deg"] == pytest.approx(float(np.degrees(stroke.swing)))
    assert table["theta4_deg"].max() - table["theta4_deg"].min() == pytest.approx(46.65, abs=0.01)


def test_straightest_half_turn_of_the_pumpjack(jack: LinkageReport) -> None:
    found = facts(jack)
    assert found["straight_from_deg"] == pytest.approx(270.83080434, abs=1e-7)
    assert found["straight_deviation"] == pytest.approx(0.39612851729, abs=1e-10)
    assert found["straight_width"] / found["straight_length"] == pytest.approx(0.22186223374, abs=1e-10)


def test_constant_quantities_have_no_places_of_extremes(jack: LinkageReport) -> None:
    table = extremes(jack)
    speed = table.loc["a_speed"]
    assert speed["min"] == pytest.approx(speed["max"], rel=1e-12)
    angles = table[["theta2_min_deg", "theta2_max_deg"]].isna().all(axis=1)
    assert angles["a_speed"]
    assert not angles[["omega3", "omega4", "mu_deg"]].any()


def test_speed_scales_rates_and_the_torque_factor_has_a_sign() -> None:
    spec = load_linkage_spec("lufkin-c912d")
    speeds = (None, -60 / np.pi)
    slow, fast = (report_on(spec, Asked(speed_rpm=speed)).tables["kinematics"] for speed in speeds)
    np.testing.assert_allclose(fast["omega4"], -2 * slow["omega4"], rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(fast["alpha4"], 4 * slow["alpha4"], rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(fast["torque_factor"], slow["torque_factor"])
    np.testing.assert_allclose(np.abs(fast["torque_factor_signed"]), fast["torque_factor"], rtol=1e-14)
    step = np.gradient(fast["theta4_deg"], fast["theta2_deg"], edge_order=2) * spec.output_arm
    np.testing.assert_allclose(fast["torque_factor_signed"], step, atol=0.02)
    assert (fast["torque_factor_signed"] < 0).any()
    assert (fast["torque_factor_signed"] > 0).any()
    with pytest.raises(ProblemError, match="speed_rpm is nan"):
        report_on(spec, Asked(speed_rpm=np.nan))


def test_a_limited_range_says_so() -> None:
    report, linkage = report_on(ONE_RANGE), ONE_RANGE.linkage
    low, high = np.degrees(driver_ranges(linkage)[0])
    found, table = facts(report), extremes(report)
    assert (found["driver_low_deg"], found["driver_high_deg"]) == pytest.approx((low, high))
    assert found["transmission_min_deg"] == 0
    assert "time_ratio" not in found
    assert "fourier_share_1" not in found
    assert found["full_rotation"] is False
    assert table.loc["omega3", ["min", "max"]].tolist() == [-np.inf, np.inf]
    assert table.loc["omega4", ["theta2_min_deg", "theta2_max_deg"]].tolist() == pytest.approx([low, high])
    # One end pulls alpha3 down without limit; what it reaches between is found all the same.
    inner = np.linspace(np.radians(low) + 0.1, np.radians(high) - 0.1, 20001)
    state = solve_kinematics(linkage, inner)
    assert table.loc["alpha3", "max"] == pytest.approx(state.alpha3.max(), rel=1e-6)
    # B stands still where the output turns back, its acceleration does not vanish there or elsewhere.
    assert table.loc["b_speed", "min"] == 0
    least = state.b.acceleration_magnitude.min()
    assert table.loc["b_acceleration", "min"] == pytest.approx(least, rel=1e-6)
    assert "dead positions bound" in report.notes[0]
    assert "assembly +1" in report.notes[0]
    rows = report.tables["kinematics"]
    assert rows["theta2_deg"].iloc[[0, -1]].tolist() == pytest.approx([low, high])
    assert not np.isinf(rows.to_numpy(dtype=float)).any()
    assert rows["p_x"].notna().all()
    assert rows["omega3"].isna().sum() == 2


def test_two_ranges_are_kept_apart() -> None:
    report = report_on(TWO_RANGES)
    rows, found = report.tables["kinematics"], facts(report)
    assert rows["range"].value_counts().to_dict() == {1: 361, 2: 361}
    # The toggle positions lie on two circuits: the range between them is not a swing.
    for number in (1, 2):
        angles = rows.loc[rows["range"] == number, "theta4_deg"]
        assert found[f"output_swing_{number}_deg"] == pytest.approx(np.ptp(angles), abs=0.01)
    assert "output_swing_deg" not in found
    assert "stroke_chord" not in found


@pytest.mark.quick("kite")
@pytest.mark.parametrize(
    "linkage",
    [
        FourBar((0, 0), (4, 0), 4, 2, 2, (1, 1)),
        FourBar((0, 0), (4, 0), 2, 4, 2, (1, 1), -1),
        FourBar((0, 0), (4, 0), 1, 3, 2, (1, 1)),
    ],
    ids=["kite", "antiparallelogram", "change point"],
)
def test_change_points_give_figures_and_no_warnings(linkage: FourBar) -> None:
    check_change_point(report_on(LinkageSpec(linkage, "edge")))


def check_change_point(report: LinkageReport) -> None:
    assert facts(report)["grashof_class"] == "change-point"
    assert "either way" in report.notes[0]
    assert len(report.tables["extremes"]) > 0


@pytest.mark.slow
def test_a_parallelogram_keeps_its_speed() -> None:
    report = report_on(LinkageSpec(FourBar((0, 0), (4, 0), 1, 4, 1, (1, 1)), "parallelogram"))
    check_change_point(report)
    rows = report.tables["extremes"]
    turning = rows[(rows["quantity"] == "omega4") & (rows["range"] == 2)]
    assert turning[["min", "max"]].to_numpy().ravel().tolist() == pytest.approx([1, 1], abs=1e-6)


@pytest.mark.slow
@pytest.mark.quick("1")
@pytest.mark.parametrize("sense", [1, -1])
def test_a_design_is_analysed_as_the_list_drives_it(few: Result, tmp_path: Path, sense: int) -> None:
    """On its way from the first pose to the last it needs the torque, and the force, that the list says."""
    task, given = few.problem.task, few.problem.dynamics
    assert isinstance(task, MotionTask)
    assert given is not None
    back = replace(few.problem, task=MotionTask(task.positions[::-1], task.angles[::-1]))
    write_run(tmp_path, few if sense > 0 else synthesize(back, starts=4, enough=4), {}, 0)
    row = pd.read_csv(tmp_path / "candidates.csv").iloc[0]
    assert row["direction"] == sense
    spec = load_linkage_spec(f"{tmp_path / 'candidates.json'}#1")
    assert spec.dynamics == replace(given, speed_rpm=sense * given.speed_rpm)
    report = report_on(spec)
    every, table = extremes(report), report.tables["dynamics"]
    assert report.tables["kinematics"]["omega2"].unique() == pytest.approx([sense * given.omega2])
    way = sense * (row["theta2_end_deg"] - row["theta2_start_deg"])
    used = sense * (table["theta2_deg"] - row["theta2_start_deg"]) % 360 <= way % 360
    forces = ["f12", "f32", "f43", "f14"]
    for name, columns in (("torque_peak", ["torque"]), ("joint_force_peak", forces)):
        on_the_way = table.loc[used, columns].abs().to_numpy().max()
        assert 0.99 * row[name] < on_the_way <= row[name] * (1 + 1e-9)
        assert every.loc[columns, ["min", "max"]].abs().to_numpy().max() >= row[name] * (1 - 1e-9)


def test_given_masses_and_payload() -> None:
    linkage, given = JACK.linkage, {"masses": (1, 2, 3), "inertias": (0.1, 0.2, 0.3)}
    report = report_on(replace(JACK, dynamics=DynamicsSpec(**given, payload=5, speed_rpm=10)))
    masses = given_masses(linkage, **given).with_payload(5, linkage.coupler_point)
    state = solve_kinematics(linkage, np.arange(0, 361) * np.pi / 180, np.pi / 3)
    expected = inverse_dynamics(state, masses).torque
    np.testing.assert_allclose(report.tables["dynamics"]["torque"], expected, rtol=1e-9, atol=1e-12)
    assert facts(report)["mass"] == 11
    assert facts(report)["torque_rms"] == pytest.approx(np.sqrt(np.mean(expected[:-1] ** 2)))


@pytest.mark.slow
def test_plots_of_a_limited_range_are_made(tmp_path: Path) -> None:
    """Rates without bound are cut off, and no warning is given."""
    from grashof.figures.section_plots import plots

    made = dict(plots(report_on(replace(TWO_RANGES, length_unit="mm"))))
    files = [tmp_path / f"velocities.{kind}" for kind in ("png", "svg")]
    grashof.figures.files.save(made["velocities"], files)
    assert min(file.stat().st_size for file in files) > 10_000
    assert list(made) == ["path", "angles", "velocities", "accelerations"]
    rates, speeds = made["velocities"].axes
    assert rates.get_ylabel() == "angular velocity (rad/s)"
    assert speeds.get_ylabel() == "speed (mm/s)"
    assert np.abs(rates.get_ylim()).max() < 100
    assert {line.get_label() for line in speeds.lines} >= {"A", "B", "P"}
    assert made["path"].axes[0].get_xlabel() == "x (mm)"


def test_a_driver_at_rest() -> None:
    table = extremes(report_on(JACK, Asked(speed_rpm=0.0)))
    assert table.loc["a_speed", "max"] == 0
    # The torque holds the weight.
    assert table.loc["torque", "max"] > 1000
    assert table.loc["f12", "min"] > 0


@pytest.mark.slow
def test_one_angle_is_counted_alike_everywhere() -> None:
    """Where a rocker turns back about 180 deg, the ends of its dwell, and its extremes."""

    def rocker(turned: float) -> LinkageReport:
        o4 = 5 * np.array([np.cos(turned), np.sin(turned)])
        linkage = FourBar((0, 0), o4, 0.8, 4.2, 3.9, (1, 1))
        return report_on(LinkageSpec(linkage, "rocker"), Asked(dwell_deg=2.0))

    low, high = extremes(rocker(0.0)).loc["theta4_deg", ["min", "max"]]
    for turned in (0.0, np.pi - np.radians(low + high) / 2):
        report = rocker(turned)
        low, high = extremes(report).loc["theta4_deg", ["min", "max"]]
        found = {key: value for part in (report, *report.sections) for key, value in facts(part).items()}
        toggles = sorted(found[f"toggle_{name}_theta4_deg"] for name in ("folded", "stretched"))
        np.testing.assert_allclose(toggles, [low, high], atol=1e-6)
        assert low - 1e-6 <= found["dwell_low_theta4_deg"] < found["dwell_high_theta4_deg"] <= high + 1e-6
    assert low < 180 < high


def test_angles_that_turn_fully_have_no_extremes(capsys: pytest.CaptureFixture[str]) -> None:
    report = report_on(LinkageSpec(FourBar((0, 0), (1, 0), 3, 2.8, 3.2), "double-crank"))
    table = extremes(report)
    for link in (3, 4):
        row = table.loc[f"theta{link}_deg"]
        assert row[["min", "theta2_min_deg", "max", "theta2_max_deg"]].isna().all()
        assert row["what"].endswith(f"{link}, turns fully")
    assert table.loc["mu_deg", ["min", "max"]].notna().all()
    print_report(report)
    shown = capsys.readouterr().out
    assert shown.count("turns fully") == 3  # with the driver of the summary
    assert "nan" not in shown
