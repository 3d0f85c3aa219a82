"""Six-bars from the problem to the list: each design moved again in body coordinates, forces included."""

from collections import defaultdict
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
from body_coordinates import carried, follow, forces, margins, rates, start
from body_plans import plan_of

from grashof.analysis import inverse_dynamics, solve_kinematics, uniform_bars
from grashof.analysis.judge.planted import planted_function, planted_motion, planted_path
from grashof.problems import (
    Box,
    FunctionTask,
    MotionTask,
    PathTask,
    Problem,
    ProblemError,
    Requirements,
    Task,
)
from grashof.problems.values.linkages.linkage import Linkage
from grashof.synth import Candidate, Result, synthesize

SMOOTH = MotionTask([[0, 0], [12, 3], [22, 10], [30, 22], [32, 38]], np.radians([0, 14, 30, 52, 75]))
EIGHT = np.linspace(0, 2 * np.pi, 16, endpoint=False)
Made = Callable[[], Result]


def solved(task: Task, mechanism: Any, starts: int = 200, **wanted: Any) -> Result:
    problem = Problem(task=task, mechanism=mechanism, requirements=Requirements(**wanted))
    return synthesize(problem, enough=8, starts=starts)


def planted(make: Any, count: int, word: str, **wanted: Any) -> Result:
    return solved(make(np.random.default_rng([33, count]), count, mechanism=word)[0], word, **wanted)


LISTS: dict[str, Made] = {
    "five poses": partial(solved, SMOOTH, "watt-1", transmission_min_deg=20),
    "five poses of other kinds": partial(solved, SMOOTH, ["stephenson-1", "stephenson-3"]),
    "path": partial(planted, planted_path, 8, "stephenson-3"),
    "function": partial(planted, planted_function, 7, "watt-2", transmission_min_deg=15),
    "poses": partial(planted, planted_motion, 6, "watt-1"),
    "path of a watt-1": partial(planted, planted_path, 9, "watt-1"),
    "function of a stephenson-1": partial(planted, planted_function, 8, "stephenson-1"),
    "timed path of a watt-2": lambda: solved(
        planted_path(np.random.default_rng(3), 6, timed=True, mechanism="watt-2")[0], "watt-2"
    ),
    "closed curve": partial(
        solved, PathTask(np.stack([np.cos(EIGHT), np.sin(2 * EIGHT) / 2], axis=1), closed=True),
        ["stephenson-3", "four-bar"], starts=16,
        exact=False, transmission_min_deg=25, transmission_over="cycle",
    ),
    "law": partial(
        solved,
        FunctionTask.from_degrees(law="log10", x=(1, 10), input_range_deg=90, output_range_deg=90),
        "stephenson-3", starts=16, transmission_min_deg=30,
    ),
}  # fmt: skip
SLOW = ("five poses", "path", "function", "closed curve")


def six_bars(result: Result) -> list[Candidate]:
    return [one for one in result.candidates if len(one.linkage.mechanism.loops) > 1]


def by_row(designs: list[Candidate]) -> list[list[Candidate]]:
    """Designs that can be moved together."""
    found = defaultdict(list)
    for one in designs:
        found[one.linkage.mechanism].append(one)
    return list(found.values())


def marked(name: str) -> Any:
    return pytest.param(name, marks=pytest.mark.slow if name in SLOW else pytest.mark.study)


@pytest.fixture(scope="module", params=[marked(name) for name in LISTS])
def found(request: pytest.FixtureRequest) -> Result:
    return LISTS[request.param]()


def test_every_design_does_the_task_in_body_coordinates(found: Result) -> None:
    designs = six_bars(found)
    assert len(designs) >= 5
    task, count = found.problem.task, len(found.problem.task)
    for some in by_row(designs):
        linkages: Any = Linkage.stacked([one.linkage for one in some])
        theta2 = np.stack([one.verdict.theta2 for one in some], axis=1)
        ends = theta2[-1] + 2 * np.pi * np.array([one.verdict.direction for one in some])
        last = ends if task.closed else theta2[-1]
        way = np.linspace(theta2[0], last, 181)
        plan, carries = plan_of(linkages), some[0].linkage.mechanism.carries
        q = follow(plan, start(plan, theta2[0]), theta2[0], np.concatenate([theta2, way]))
        assert np.isfinite(q).all()
        sine = np.abs(margins(plan, q)).min(axis=(0, -1))
        worst = np.array([one.verdict.transmission_min_task for one in some])
        np.testing.assert_allclose(np.arcsin(sine), worst, atol=2e-3)
        at = q[:count]
        if task.has_output.any():
            sense = np.array([one.verdict.direction * one.verdict.output_sense for one in some])
            off = sense * np.unwrap(at[..., -1], axis=0) - task.outputs[:, None]
            off -= (task.weights @ off) / task.weights.sum()
            errors = np.abs(off)
            listed = np.stack([np.abs(one.verdict.output_error) for one in some], axis=1)
        else:
            p = carried(rates(plan, at), carries, linkages.coupler_point)[0]
            errors = np.linalg.norm(p - task.positions[:, None], axis=-1)
            listed = np.stack([one.verdict.position_error for one in some], axis=1)
        scale = 1.0 if task.has_output.any() else task.size
        np.testing.assert_allclose(errors, listed, atol=1e-9 * scale)
        if task.has_angle.any():
            turned = at[..., 3 * carries - 4] + linkages.body_angle - task.angles[:, None]
            assert np.abs(np.sin(turned / 2)).max() < 1e-9


def test_forces_and_torque_of_every_design_are_the_multipliers(found: Result) -> None:
    for some in by_row(six_bars(found)):
        linkages: Any = Linkage.stacked([one.linkage for one in some])
        theta2 = np.linspace(*(np.array([one.verdict.theta2[end] for one in some]) for end in (0, -1)), 25)
        state, masses = solve_kinematics(linkages, theta2), uniform_bars(linkages, 2.0)
        dynamics = inverse_dynamics(state, masses)
        plan = plan_of(linkages)
        motion = rates(plan, follow(plan, start(plan, theta2[0]), theta2[0], theta2))
        bodies = {k: (b.mass, b.inertia, b.centre) for k, b in masses.by_link(linkages).items()}
        expected = forces(plan, motion, bodies)
        peak = np.abs(expected["torque"]).max(axis=0)
        off = np.abs(dynamics.torque - expected["torque"]) / peak
        near = np.abs(margins(plan, motion[0])).min(axis=-1) > 0.05  # near dead positions digits are lost
        assert off[near].max() < 1e-9
        for number, joint in enumerate(linkages.mechanism.every_joint):
            sign = -1 if joint.name == "D" and joint.links[0] != 1 else 1
            force = expected[joint.name.lower()]
            most = np.abs(force).max(axis=(0, -1))
            apart = np.abs(sign * dynamics.forces[number] - force).max(axis=-1) / most
            assert apart[near].max() < 1e-9


def test_columns_are_filled(found: Result) -> None:
    frame = found.to_frame()
    frame = frame[frame["mechanism"] != "four-bar"]
    names = ["r1", "r2", "r3", "r4", "r5", "r6", "c_u", "c_v", "d_u", "d_v", "o2_x", "o4_y", "p_u", "p_v"]
    assert frame[[*names, "assembly", "assembly_2", "hosts", "point_link"]].notna().all(axis=None)
    assert frame["length_ratio"].notna().all() == found.problem.task.is_curve


@pytest.mark.slow
def test_limits_are_kept_where_they_are_active() -> None:
    task = planted_path(np.random.default_rng(8), 6, mechanism="stephenson-3")[0]
    free = solved(task, "stephenson-3").to_frame()
    x, y = np.median(free["o2_x"]), np.median(free["o2_y"])
    near = Box((x - 0.2 * task.size, x + 0.2 * task.size), (y - 0.2 * task.size, y + 0.2 * task.size))
    wanted: dict[str, Any] = {
        "o2": near, "link_ratio_max": 5.0, "coupler_arms": (0.1 * task.size, 2 * task.size),
        "link_length": (0.1 * task.size, 3 * task.size), "transmission_min_deg": 20.0,
    }  # fmt: skip
    frame = solved(task, "stephenson-3", **wanted).to_frame()
    assert len(frame) >= 5
    lengths = frame[["r1", "r2", "r3", "r4", "r5", "r6"]]
    assert (lengths.max(axis=1) / lengths.min(axis=1)).max() <= 5
    assert lengths.min(axis=None) >= 0.1 * task.size
    assert lengths.max(axis=None) <= 3 * task.size
    assert frame["o2_x"].between(*near.x).all()
    assert frame["o2_y"].between(*near.y).all()
    assert frame["transmission_min_task_deg"].min() >= 20
    assert (np.hypot(frame["p_u"], frame["p_v"]) <= 2 * task.size).all()
    assert (np.hypot(frame["p_u"] - frame["r5"], frame["p_v"]) <= 2 * task.size).all()


def test_a_watt_2_is_refused_where_a_four_bar_does_the_same() -> None:
    with pytest.raises(ProblemError, match=r"^mechanism is watt-2; without timing its P traces the coupler"):
        solved(SMOOTH, "watt-2")


@pytest.mark.slow
def test_the_same_seed_finds_the_same_designs_in_two_processes() -> None:
    problem = Problem(task=SMOOTH, mechanism="stephenson-3")
    one, two = (synthesize(problem, enough=8, workers=workers) for workers in (1, 2))
    assert [each.id for each in one.candidates] == [each.id for each in two.candidates]


@pytest.mark.study
def test_poses_that_no_six_bar_meets_end_with_a_reason() -> None:
    """Poses at random; the search is short, as its rounds are the same."""
    rng = np.random.default_rng(0)
    task = MotionTask(rng.uniform(0, 1, (8, 2)), rng.uniform(-3, 3, 8))
    result = synthesize(Problem(task=task, mechanism="stephenson-3"), time_limit=3)
    assert not len(result)
    assert result.note
