"""The table: the columns of the contract, figures of the motion, and numbers that survive CSV."""

import csv
from collections import Counter
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from grashof.analysis import over_task
from grashof.analysis.judge.tolerance import robustness
from grashof.problems import DynamicsSpec, Manufacturing, Problem
from grashof.problems.values.requirements.quantities import MEASURED
from grashof.synth import Result
from grashof.synth.designs.table import LISTED, NAMES, to_frame

# The columns in their order, which programs of users rely on.
CONTRACT = """
rank, id, mechanism, family, region, grashof_class, direction, assembly, o2_x, o2_y, o4_x, o4_y,
r1, r2, r3, r4, p_u, p_v, body_angle_deg, theta2_start_deg, theta2_end_deg, error, error_max, error_rms,
error_sse, angle_error_max_deg, angle_error_rms_deg, transmission_min_task_deg,
transmission_min_cycle_deg, circuit_ok,
branch_ok, order_ok, full_rotation, omega4_max, point_speed_max, point_acceleration_max, torque_peak,
torque_rms, joint_force_peak, coupler_fit_r2, size, pareto, cognate_of, start, iterations, best_at,
caution, hausdorff, frechet, move_r1, move_r2, move_r3, move_r4, move_u, move_v, worst_move,
share_within_linear, share_within_made, offset, slide_angle_deg,
assembly_2, hosts, point_link, r5, r6, c_u, c_v, d_u, d_v, offset_2, slide_angle_2_deg, dwell_from_deg,
dwell_to_deg, band_deg, band, band_made_deg, band_made, swing_deg, length_ratio, output_acceleration_max,
swing_4_deg, swing_6_deg, time_ratio_4, time_ratio_6, synchrony_error, move_r5, move_r6,
move_offset, move_c_u, move_c_v, move_d_u, move_d_v, move_offset_2,
torque_deviation, torque_deviation_max, cylinder_on, cylinder_base_x,
cylinder_base_y, cylinder_u, cylinder_v, cylinder_closed, cylinder_stroke, cylinder_angle_min_deg,
cylinder_force_max, cylinder_rate_start, cylinder_rate_end, cylinder_rate_min, cylinder_rate_max,
coupler_angle_min_deg, coupler_angle_max_deg, coupler_rate_min, coupler_rate_max, part_sizes,
effort_deviation
"""
FIRST = [name.strip() for name in CONTRACT.split(",")]
# Quantities that a requirement declares follow.
COLUMNS = FIRST + [each.column for each in LISTED if each.key not in MEASURED]
OF_FUNCTIONS = [
    *(f"structural_error_{name}_deg" for name in ("max", "rms", "at")),
    *(f"structural_error_{name}" for name in ("max", "rms")),  # of slides
]
WITHOUT_MEANING = [
    "error", "cognate_of", "best_at", "caution", "hausdorff", "frechet", "stroke",
    *(
        name
        for name in FIRST[FIRST.index("move_r1") :]
        if name != "output_acceleration_max" and not name.startswith("coupler_")
    ),
    *OF_FUNCTIONS,
]  # fmt: skip


@pytest.fixture(scope="module")
def frame(luggage_result: Result) -> pd.DataFrame:
    return luggage_result.to_frame()


def test_columns_are_the_contract(frame: pd.DataFrame) -> None:
    assert list(frame.columns) == COLUMNS


def test_one_row_a_design_best_first(frame: pd.DataFrame, luggage_result: Result) -> None:
    assert frame["rank"].tolist() == list(range(1, len(luggage_result) + 1))
    assert frame["id"].tolist() == [candidate.id for candidate in luggage_result.candidates]
    sound, heads = frame["caution"].isna(), frame["family"] == frame["id"]
    best, others = frame[heads & sound], frame[~heads & sound]
    assert best["rank"].tolist() == list(range(1, len(best) + 1))
    assert not (frame["rank"][~sound] < frame["rank"][sound].max()).any()
    assert len(others) > 1
    assert set(others["family"]) <= set(best["id"])
    for rows in (best, others):
        assert rows["transmission_min_task_deg"].is_monotonic_decreasing
    assert set(frame["mechanism"]) == {"four-bar"}


def test_rows_describe_linkages_that_meet_the_first_and_last_pose(
    frame: pd.DataFrame, luggage: Problem
) -> None:
    """From the numbers of the table alone."""
    task = luggage.task
    for row in frame.itertuples():
        o2, o4 = complex(row.o2_x, row.o2_y), complex(row.o4_x, row.o4_y)
        assert abs(o4 - o2) == pytest.approx(row.r1, rel=1e-12)
        swept = row.theta2_end_deg - row.theta2_start_deg
        assert 0 < row.direction * swept <= 360
        for theta2, pose in ((row.theta2_start_deg, 0), (row.theta2_end_deg, -1)):
            a = o2 + row.r2 * np.exp(1j * np.radians(theta2))
            coupler = np.exp(1j * (task.angles[pose] - np.radians(row.body_angle_deg)))
            place = a + complex(row.p_u, row.p_v) * coupler
            assert abs(place - complex(*task.positions[pose])) < 1e-9
            b = a + row.r3 * coupler
            assert abs(b - o4) == pytest.approx(row.r4, rel=1e-9)
            left = (np.conj(o4 - a) * (b - a)).imag
            assert np.sign(left) == row.assembly


def test_figures_are_the_verdicts(frame: pd.DataFrame, luggage_result: Result) -> None:
    for row, candidate in zip(frame.itertuples(), luggage_result.candidates, strict=True):
        verdict = candidate.verdict
        assert row.grashof_class == str(verdict.grashof_class)
        assert row.size == verdict.size
        assert row.error_max == np.max(verdict.position_error)
        assert row.error_sse == pytest.approx(4 * row.error_rms**2, rel=1e-12)
        assert row.error_max < 1e-9 * np.sqrt(32)
        assert row.angle_error_max_deg == np.degrees(np.max(verdict.angle_error))
        assert row.angle_error_rms_deg <= row.angle_error_max_deg
        assert row.transmission_min_cycle_deg == np.degrees(verdict.transmission_min_cycle)
        assert row.transmission_min_cycle_deg <= row.transmission_min_task_deg
        assert row.circuit_ok is row.branch_ok is row.order_ok is row.full_rotation is True
        assert (row.start, row.iterations) == (candidate.start, candidate.iterations)


def test_pareto_marks(frame: pd.DataFrame) -> None:
    for row in frame.itertuples():
        better = (
            (frame["transmission_min_task_deg"] >= row.transmission_min_task_deg)
            & (frame["size"] <= row.size)
            & (frame["torque_peak"] <= row.torque_peak)
            & (frame["id"] != row.id)
        )
        assert row.pareto == (not better.any())


def test_meaningless_columns_stay_empty(frame: pd.DataFrame) -> None:
    assert frame[[name for name in WITHOUT_MEANING if name != "caution"]].isna().all(axis=None)
    assert frame.drop(columns=WITHOUT_MEANING).notna().all(axis=None)


def test_the_strength_of_a_design_is_listed(luggage_result: Result, luggage: Problem) -> None:
    first, second = luggage_result.candidates[:2]
    told = to_frame(luggage, (replace(first, best_at="least error"), second))["best_at"]
    assert told[0] == "least error"
    assert pd.isna(told[1])


def test_csv_keeps_every_digit(frame: pd.DataFrame, luggage_result: Result, tmp_path: Path) -> None:
    path = tmp_path / "candidates.csv"
    luggage_result.to_csv(path)
    text = path.read_bytes()
    assert b"\r" not in text
    rows = list(csv.DictReader(text.decode().splitlines()))
    assert len(rows) == len(luggage_result)
    assert list(rows[0]) == COLUMNS
    for name in COLUMNS:
        written, held = [row[name] for row in rows], frame[name].tolist()
        if name == "caution":
            assert written == [each.caution for each in luggage_result.candidates]
        elif name in WITHOUT_MEANING:
            assert set(written) == {""}
        elif isinstance(held[0], float):
            assert [float(value) for value in written] == held
        else:
            assert written == [str(value) for value in held]


def test_an_empty_result_has_all_columns(luggage: Problem, tmp_path: Path) -> None:
    empty = Result(luggage, note="no design")
    assert list(empty.to_frame().columns) == COLUMNS
    assert len(empty.to_frame()) == 0
    empty.to_csv(tmp_path / "none.csv")
    assert (tmp_path / "none.csv").read_text() == ",".join(COLUMNS) + "\n"
    assert to_frame(luggage, ()).shape == (0, len(COLUMNS))


@pytest.mark.quick("-2.0", "3.0")
@pytest.mark.parametrize("turns", [-2.0, 1.0, 3.0])
def test_the_driver_starts_within_half_a_turn_and_is_never_wrapped(
    luggage_result: Result, turns: float
) -> None:
    whole = [
        replace(each, verdict=replace(each.verdict, theta2=each.verdict.theta2 + 2 * np.pi * turns))
        for each in luggage_result.candidates[:12]
    ]
    frame = to_frame(luggage_result.problem, tuple(whole))
    assert ((frame["theta2_start_deg"] > -180) & (frame["theta2_start_deg"] <= 180)).all()
    for row, candidate in zip(frame.itertuples(), whole, strict=True):
        first, last = np.degrees(candidate.verdict.theta2[[0, -1]])
        assert row.theta2_end_deg - row.theta2_start_deg == pytest.approx(last - first, abs=1e-9)
        assert np.sin(np.radians(row.theta2_start_deg - first)) == pytest.approx(0, abs=1e-9)


def test_every_column_has_a_name_in_words() -> None:
    """Of all kinds of tasks and linkages: no key, and nothing that only code says."""
    for column in (*COLUMNS, "objective"):
        name = NAMES[column]
        assert "_" not in name
        assert name == name.strip() != ""
        assert name[:1].islower() or name.startswith(
            ("O2", "O4", "P ", "C ", "D ", "R2", "Grashof", "Hausdorff", "Fréchet", "Pareto")
        )
    assert NAMES["o2_x"] == "O2, x"
    assert NAMES["transmission_min_task_deg"] == "worst transmission angle over the task"
    assert NAMES["cylinder_closed"] == "cylinder, closed length"
    counts = Counter(NAMES[column] for column in COLUMNS)
    of_both = {  # turning or sliding
        "greatest structural error", "structural error (root mean square)", "output band in the dwell",
        "output band in the dwell, with tolerances",
    }  # fmt: skip
    assert {name for name, count in counts.items() if count > 1} == of_both


MOTION = (
    *("omega4_max", "point_speed_max", "point_acceleration_max", "output_acceleration_max"),
    "coupler_fit_r2",
)
DYNAMICS = ("torque_peak", "torque_rms", "joint_force_peak")


@pytest.mark.slow
def test_figures_are_the_analysis(frame: pd.DataFrame, luggage_result: Result) -> None:
    for row, candidate in zip(
        frame[[*MOTION, *DYNAMICS]].itertuples(), luggage_result.candidates, strict=True
    ):
        found = asdict(over_task(candidate.linkage, luggage_result.problem, candidate.verdict))
        assert {name: getattr(row, name) for name in found} == found


def test_figures_make_sense(frame: pd.DataFrame, luggage_result: Result) -> None:
    """On the way from (5, 4) to (1, 0) P goes 1.5 + 1.8 + 3.2 at least, in the time the driver takes."""
    way = 1.5 + np.hypot(1.5, 1) + np.hypot(1, 3)
    seconds = np.radians(frame["theta2_end_deg"] - frame["theta2_start_deg"]).abs()
    assert (frame["point_speed_max"] >= way / seconds).all()
    assert (frame["torque_peak"] >= frame["torque_rms"]).all()
    # O2 and O4 carry all links, and the system's centre is not in free fall all the way.
    assert (frame["joint_force_peak"] > 1.0).all()
    assert frame["coupler_fit_r2"].between(0.99, 1).all()


def test_without_dynamics_the_columns_of_torque_are_empty(luggage_result: Result) -> None:
    problem = replace(luggage_result.problem, dynamics=None)
    bare = replace(luggage_result.top(4), problem=problem).to_frame()[:4]
    assert bare[list(DYNAMICS)].isna().all(axis=None)
    np.testing.assert_allclose(bare[list(MOTION)], luggage_result.to_frame()[list(MOTION)][:4], rtol=1e-12)


def test_the_driver_s_speed_is_that_of_the_problem(luggage_result: Result) -> None:
    few = luggage_result.top(4)
    specs = (DynamicsSpec(2.0, speed_rpm=rpm) for rpm in (10.0, 20.0))
    slow, fast = (replace(few, problem=replace(few.problem, dynamics=spec)).to_frame() for spec in specs)
    for name, power in {"omega4_max": 1, "point_speed_max": 1, "point_acceleration_max": 2}.items():
        np.testing.assert_allclose(fast[name], 2**power * slow[name], rtol=1e-12)
    for name in DYNAMICS:  # no gravity: all is inertia
        np.testing.assert_allclose(fast[name], 4 * slow[name], rtol=1e-9)


def test_a_miss_without_a_motion_has_no_figures(luggage_result: Result) -> None:
    first = luggage_result.candidates[0]
    torn = replace(first, verdict=replace(first.verdict, branch_ok=False))
    row = to_frame(luggage_result.problem, (torn,))
    assert row[[*MOTION, *DYNAMICS]].isna().all(axis=None)


MANUFACTURING = (
    *("move_r1", "move_r2", "move_r3", "move_r4", "move_u", "move_v"),
    *("worst_move", "share_within_linear", "share_within_made"),
)

MADE = Manufacturing(0.02, band=0.03)


@pytest.fixture(scope="module")
def made_frame(luggage_result: Result) -> pd.DataFrame:
    problem = replace(luggage_result.problem, manufacturing=MADE)
    return replace(luggage_result, problem=problem).to_frame()


@pytest.mark.study
def test_figures_of_made_linkages_are_the_analysis(made_frame: pd.DataFrame, luggage_result: Result) -> None:
    for row, candidate in zip(
        made_frame[list(MANUFACTURING)].to_numpy(), luggage_result.candidates, strict=True
    ):
        found = robustness(candidate.linkage, luggage_result.problem.task, candidate.verdict, MADE)
        figures = [*found.moves, found.worst_move, found.share_linear, found.share_made]
        assert row.tolist() == figures


@pytest.mark.slow
def test_figures_of_made_linkages_make_sense(made_frame: pd.DataFrame) -> None:
    moves = made_frame[list(MANUFACTURING[:6])].to_numpy()
    np.testing.assert_allclose(made_frame[["move_u", "move_v"]], 1, rtol=1e-12)
    assert (0.02 * moves.max(axis=1) <= made_frame["worst_move"]).all()
    assert (made_frame["worst_move"] <= 0.02 * moves.sum(axis=1) * (1 + 1e-12)).all()
    assert made_frame["share_within_made"].between(0.01, 0.999).all()
    np.testing.assert_allclose(made_frame["share_within_linear"], made_frame["share_within_made"], atol=0.02)
