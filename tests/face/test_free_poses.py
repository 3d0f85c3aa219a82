"""What a run writes and draws of poses with parts left free, and of many poses."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.colors import to_hex

from grashof import synthesize
from grashof.analysis.judge.planted import planted_motion
from grashof.figures.files import draw_design
from grashof.figures.parts import BODY, COUPLER, DRIVER
from grashof.problems import MotionTask, Problem, Requirements
from grashof.synth import Result

FREE = """
kind = "motion"
[motion]
poses = [[0, 0, 0], { x = 2, y = 1 }, { angle = 30 }, [6, 2, 45]]
body = [[0, 0], [1, 0], [1, 0.5]]
"""
ANGLES_FREE = """
kind = "motion"
[motion]
poses = [{ x = 0, y = 0 }, { x = 1, y = 0 }, { x = 2, y = 1 }, { x = 3, y = 3 }]
body = [[0, 0], [1, 0], [1, 0.5]]
"""


@pytest.mark.study
@pytest.mark.parametrize(
    ("text", "no_position", "no_angle"), [(FREE, [2], [1]), (ANGLES_FREE, [], [0, 1, 2, 3])]
)
def test_errors_of_free_parts_are_null(
    grashof: Callable[..., Any], tmp_path: Path, text: str, no_position: list[int], no_angle: list[int]
) -> None:
    (tmp_path / "free.toml").write_text(text, encoding="utf-8")
    outcome = grashof("solve", "free.toml", "--starts", 16, "--drawings", 1)
    assert outcome.exit_code == 0, outcome.output
    made = json.loads((tmp_path / "free-designs/candidates.json").read_text(), parse_constant=pytest.fail)
    for design in made["designs"]:
        for name, free in (("position_error", no_position), ("angle_error", no_angle)):
            assert [i for i, error in enumerate(design.get(name, [None] * 4)) if error is None] == free
    assert (tmp_path / "free-designs/design-01.png").exists()


def free() -> Result:
    poses = [[0, 0, 0], {"x": 2, "y": 1}, {"angle": 30}, [6, 2, 45]]
    task = MotionTask.from_degrees(poses, body=[[0, 0], [1, 0], [1, 0.5]])
    return synthesize(Problem(task=task), enough=1, starts=32)


def test_the_body_stands_where_the_design_has_it() -> None:
    result = free()
    figure = draw_design(result.problem, result.best, 1)
    bodies = [patch for patch in figure.axes[0].patches if to_hex(patch.get_edgecolor()) == BODY]
    assert [body.get_linestyle() for body in bodies] == ["solid", "dashed", "dashed", "solid"]
    linkage, placed = result.best.linkage, np.array([body.get_xy()[0] for body in bodies])
    np.testing.assert_allclose(placed[[0, 1, 3]], result.problem.task.positions[[0, 1, 3]], atol=1e-9)
    a = linkage.o2 + linkage.r2 * np.array(
        [np.cos(result.best.verdict.theta2[2]), np.sin(result.best.verdict.theta2[2])]
    )
    assert np.hypot(*(placed[2] - a)) == pytest.approx(np.hypot(*linkage.coupler_point))


def test_of_many_poses_some_are_drawn() -> None:
    task, _ = planted_motion(np.random.default_rng(3), poses=60)
    task = MotionTask(task.positions, task.angles, body=[[0, 0], [1, 0], [1, 1]])
    wanted = Requirements(exact=True, rotatability_margin=0)
    result = synthesize(Problem(task=task, requirements=wanted), enough=1)
    axes = draw_design(result.problem, result.best, 1).axes[0]
    colours = [to_hex(line.get_color()) for line in axes.lines]
    assert colours.count(DRIVER) == 3
    assert COUPLER in colours
    assert sum(to_hex(patch.get_edgecolor()) == BODY for patch in axes.patches) == 12
