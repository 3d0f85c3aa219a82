"""Wanted torques: invalid ones are refused in a line, valid ones are read back from a file."""

import numpy as np
import pytest
from refusals import message, problem

from grashof.problems import Objective, Problem, ProblemError, WantedTorque
from grashof.problems.files.problem_writing import problem_toml

HEAD = 'kind = "motion"\nlength_unit = "m"\n'
POSES = "[motion]\nposes = [[0, 0, 0], [1, 0.5, 30], [1.5, 1.2, 70]]\n"
DRIVEN = "[dynamics]\npayload = 20\n"
WANTED = '[torque]\nwanted = [[1, 50], [3, -10]]\nover = "target"\n'


@pytest.mark.parametrize(
    ("stated", "line"),
    [
        ("wanted = 5", "torque.wanted is 5; it must be a list of rows [place, torque in N m]"),
        ("wanted = []", "torque.wanted has 0 rows; it must have 1 to 1000"),
        ("wanted = [[1]]", "torque.wanted[0] is [1.0], 1 number; it must be [place, torque in N m]"),
        ("wanted = [[0, nan]]", "torque.wanted[0] is [0.0, nan]; all numbers must be finite"),
        ("wanted = [[0, 1e21]]", "torque.wanted[0] is [0.0, 1e+21]; its numbers must be at most 1e+20"),
        ("wanted = [[-1, 5]]", "torque.wanted[0] has driver -1 deg; it must be from 0 to 360"),
        ("wanted = [[0, 5], [400, 5]]", "torque.wanted[1] has driver 400 deg; it must be from 0 to 360"),
        ("wanted = [[9, 5], [9, 6]]", "torque.wanted[1] has driver 9 deg; it must rise from row to row"),
        (
            'over = "share"\nwanted = [[0, 5], [2, 5]]',
            "torque.wanted[1] has share 2; it must be from 0 to 1",
        ),
        (
            'over = "target"\nwanted = [[1.5, 5]]',
            "torque.wanted[0] has target 1.5; it must be a whole number from 1",
        ),
        (
            'over = "target"\nwanted = [[1, 5], [4, 5]]',
            "torque.wanted[1] has target 4; the task has 3",
        ),
        (
            'over = "time"\nwanted = [[0, 5]]',
            "torque.over is 'time'; it must be one of driver, share, target",
        ),
        (
            "wanted = [[0, 5], [90, 5]]",
            "torque.wanted[1] has driver 90 deg; requirements.driver_rotation_deg must be from 90 or more, "
            'or torque.over "share"',
        ),
        (
            'over = "share"\nwanted = [[0, 5]]\nweight = 1',
            "torque.weight is 1; it must be 0 unless targets with places or angles are met by least squares "
            "(requirements.exact = false)",
        ),
        (
            'over = "share"\nwanted = [[0, 0]]\nweight = 1',
            "torque.weight is 1; it must be 0 where every wanted torque is 0",
        ),
        ("over = 'share'\nwanted = [[0, 5]]\nweight = -1", "torque.weight is -1; it must be from 0 to 1e+06"),
        ("over = 'share'", "torque.wanted is missing"),
        ("want = [[0, 5]]\nwanted = [[0, 5]]", "torque.want is unknown; did you mean wanted?"),
    ],
)
def test_wrong_curves_are_refused_in_a_line(stated: str, line: str) -> None:
    assert message(f"{HEAD}{POSES}{DRIVEN}[torque]\n{stated}\n") == line


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (HEAD + POSES + WANTED, "dynamics is missing; torque.wanted needs it"),
        (
            HEAD + POSES + DRIVEN + '[objective]\nmaximise = "torque_deviation"\n',
            "torque.wanted is missing; objective.maximise.torque_deviation needs it",
        ),
        (
            HEAD + POSES + DRIVEN + "[requirements]\ntorque_deviation_max = [0, 2]\n",
            "torque.wanted is missing; requirements.torque_deviation_max needs it",
        ),
        (
            HEAD + POSES + DRIVEN + WANTED + "[requirements]\norder = false\n",
            'requirements.order is false; it must be true with torque.over = "target"',
        ),
        (
            HEAD + POSES + DRIVEN + WANTED + "[requirements]\nsame_branch = false\n",
            "requirements.same_branch is false; it must be true with torque.wanted",
        ),
        (
            HEAD + POSES + DRIVEN + WANTED + '[motor]\nprofile = "cycloid"\n',
            'torque.over is "target"; it must be "share" where [motor] has a profile',
        ),
        (
            HEAD + 'mechanism = "watt-1"\n' + POSES + DRIVEN + WANTED + "weight = 1\n"
            "[requirements]\nexact = false\n",
            "torque.weight is 1; it must be 0 with mechanism watt-1",
        ),
        (
            HEAD.replace("motion", "path") + DRIVEN + "[path]\npoints = "
            f"{[[k, k * k] for k in range(41)]}\n[torque]\nwanted = [[1, 5]]\nover = 'target'\nweight = 1\n",
            "torque.weight is 1; it must be 0 for more than 40 targets, and the task has 41",
        ),
        (
            HEAD.replace("motion", "path") + DRIVEN + "[path]\npoints = [[0, 0], [1, 1], [2, 0]]\n"
            "timing_deg = [0, 20, 50]\n[torque]\nwanted = [[0, 5], [60, 5]]\n",
            "torque.wanted[1] has driver 60 deg; the task turns the driver by 50 deg",
        ),
    ],
)
def test_contradictions_are_refused_in_a_line(text: str, line: str) -> None:
    assert message(text) == line


def test_the_deviation_is_the_usual_objective_where_one_decides() -> None:
    met = problem(HEAD + POSES + DRIVEN + WANTED)
    assert met.objective == Objective(0.0, torque_deviation=1.0)
    fitted = problem(HEAD + POSES + DRIVEN + WANTED + "weight = 0.5\n[requirements]\nexact = false\n")
    assert fitted.objective == Objective()
    stated = problem(HEAD + POSES + DRIVEN + WANTED + '[objective]\nmaximise = "compactness"\n')
    assert stated.objective == Objective(0.0, compactness=1.0)


def test_curves_come_back_from_files() -> None:
    text = HEAD + POSES + DRIVEN + WANTED + "weight = 0.3\n[requirements]\nexact = false\n"
    made = problem(text)
    assert made.torque == WantedTorque([(1, 50.0), (3, -10.0)], "target", 0.3)
    again = problem(problem_toml(made))
    assert isinstance(again, Problem)
    assert again.torque == made.torque


def test_places_are_counted_as_the_motion_has_them() -> None:
    np.testing.assert_allclose(WantedTorque([(0, 1), (90, 2)]).places, [0, np.pi / 2])
    assert WantedTorque([(1, 1), (3, 2)], over="target").places.tolist() == [0, 2]
    with pytest.raises(ProblemError, match=r"wanted\[0\] has share -1"):
        WantedTorque([(-1, 1)], over="share")
