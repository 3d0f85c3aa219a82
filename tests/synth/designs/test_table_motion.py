"""The columns about the motion used, its speeds, torque and forces."""

from dataclasses import asdict, replace

import numpy as np
import pandas as pd
import pytest

from grashof.analysis import over_task
from grashof.problems import DynamicsSpec
from grashof.synth import Result
from grashof.synth.designs.table import to_frame

MOTION = ("omega4_max", "point_speed_max", "point_acceleration_max", "coupler_fit_r2")
DYNAMICS = ("torque_peak", "torque_rms", "joint_force_peak")


@pytest.fixture(scope="module")
def frame(luggage_result: Result) -> pd.DataFrame:
    return luggage_result.to_frame()


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
