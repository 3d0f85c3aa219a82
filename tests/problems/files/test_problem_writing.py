"""Problems written as files come back as they were."""

import numpy as np
import pytest
from same_values import check_same

from grashof.problems import (
    Box,
    DynamicsSpec,
    Manufacturing,
    MotionTask,
    Objective,
    PathTask,
    Problem,
    Region,
    Requirements,
    Search,
    catalogue,
    load,
)
from grashof.problems.files.problem_file import problem_of
from grashof.problems.files.problem_writing import problem_toml

SQUARE = np.array([[0, 0], [1, 0], [1, 1.0], [0, 1]])


def again(problem: Problem) -> Problem:
    return problem_of(problem_toml(problem), "here", problem.name)


@pytest.mark.parametrize("name", catalogue())
def test_the_catalogue_comes_back(name: str) -> None:
    check_same(again(load(name)), load(name))


def test_everything_that_python_can_state_comes_back() -> None:
    check_same(
        made := Problem(
            name="mine",
            title='A "title" \\ é 階 = [x]',
            source="#",
            length_unit="mm",
            task=MotionTask.from_degrees(
                [{"x": 1, "y": 2}, {"angle": -30.1}, [3, 4, 0.3], [1e-5, 1e20, 359]],
                weights=[1, 2, 3, 1e-9], angle_length=0.1, body=SQUARE,
                within=[1e9 / 3, 2e8, 1e20, 4e9], angle_within_deg=0.3,
            ),
            outlines=(SQUARE, SQUARE[:2]),
            requirements=Requirements(
                tolerance=0.1, rotatability="any", order=False, transmission_min_deg=1 / 3,  # type: ignore[arg-type]
                r1=(0, 1e20), coupler_arms=(0.1, 0.2), o2=Box(x=(1, 2)), b=Box((-np.inf, 3), (0, 0)),
                o4=Region(inside=[(0, 0), (1 / 3, 0), (0, 1)]), a=Region(on=[(0, 0), (1 / 3, 7)]),
                ground_angle_deg=-400.0, keep_out=(SQUARE + 7,), keep_out_for=("links", "p"),
            ),
            objective=Objective(0.1, 0.2, 0.0),
            search=Search(3, 4, 2**70, 1 / 3),
            manufacturing=Manufacturing(0.1, 0.7),
            dynamics=DynamicsSpec(2.5, payload=1.5, speed_rpm=1 / 3, gravity=(0.1, -9.8)),
        ),
        again(made),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("requirements", "objective"),
    [
        (Requirements(exact=True, error_factor=None, tolerance=0.1), Objective(0.1, 0.2)),
        (Requirements(exact=False, error_factor=1 / 0.7), Objective(0.0, 1.0)),
        (Requirements(exact=False), Objective()),
    ],
)
def test_objectives_come_back(requirements: Requirements, objective: Objective) -> None:
    task = PathTask([[0, 0], [1, 0], [3, 3]])
    made = Problem(name="here", task=task, requirements=requirements, objective=objective)
    check_same(again(made), made)


@pytest.mark.parametrize("seed", range(4))
def test_angles_of_a_file_come_back_to_the_last_bit(seed: int) -> None:
    rng = np.random.default_rng(seed)
    angles = [float(x) for x in rng.uniform(-1e4, 1e4, 8).round(seed)]
    task = MotionTask.from_degrees([[k, 0, angle] for k, angle in enumerate(angles)])
    check_same(again(Problem(task=task)).task, task)
    timing = np.cumsum(np.abs(angles) + 1) / (np.sum(np.abs(angles)) + len(angles)) * 300
    path = PathTask.from_degrees(
        [[k, 0] for k in range(len(angles) + 1)], timing_deg=[0, *timing], closed=len(angles) > 3
    )
    check_same(again(Problem(task=path)).task, path)
    poses = [[k, 0, angle] for k, angle in enumerate([0.0, *angles])]
    timed = MotionTask.from_degrees(poses, timing_deg=[0, *-timing], closed=len(angles) > 3)
    check_same(again(Problem(task=timed)).task, timed)
