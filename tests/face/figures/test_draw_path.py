"""Drawings of paths: the points are visible, the linkage is not drawn at a hundred of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex

from grashof import synthesize
from grashof.analysis import solve_position, verify
from grashof.analysis.judge.planted import planted_path, random_full_crank
from grashof.figures import draw_design, save
from grashof.figures.parts import DRIVER, PATH, TARGET
from grashof.problems import FourBar, MotionTask, PathTask, Problem, load
from grashof.problems.files.published import published
from grashof.synth import Candidate


def drawn(linkage: FourBar, problem: Problem) -> Axes:
    verdict = verify(linkage, problem.task, problem.requirements)
    return draw_design(problem, Candidate(linkage, verdict, problem, 0, 0), 1).axes[0]


def planted(count: int, *, closed: bool = False) -> tuple[Problem, FourBar]:
    if not closed:
        task, linkage = planted_path(np.random.default_rng(count), count)
        return Problem(task=task), linkage
    linkage = random_full_crank(np.random.default_rng(count))
    points = solve_position(linkage, np.linspace(0, 2 * np.pi, count)).p
    points[-1] = points[0]
    return Problem(task=PathTask(points, closed=True)), linkage


@pytest.mark.parametrize(
    ("count", "shown"), [(3, [0, 1, 2]), (6, list(range(6))), (7, [0, 3, 6]), (100, [0, 50, 99])]
)
def test_linkage_at_all_points_or_at_first_middle_and_last(count: int, shown: list[int]) -> None:
    problem, linkage = planted(count)
    verdict = verify(linkage, problem.task, problem.requirements)
    axes = drawn(linkage, problem)
    drivers = [line.get_xydata() for line in axes.lines if to_hex(line.get_color()) == DRIVER]
    a = solve_position(linkage, verdict.theta2[shown]).a
    np.testing.assert_allclose([ends[1] for ends in drivers], a, atol=1e-9)


@pytest.mark.parametrize(("count", "numbers"), [(5, [1, 2, 3, 4, 5]), (24, list(range(1, 25)))])
def test_every_point_is_marked_and_numbered(count: int, numbers: list[int]) -> None:
    problem, linkage = planted(count)
    axes = drawn(linkage, problem)
    (marked,) = [line for line in axes.lines if line.get_label() == "target points"]
    np.testing.assert_array_equal(marked.get_xydata(), problem.task.positions)
    assert to_hex(marked.get_markeredgecolor()) == TARGET
    written = {int(text.get_text()): text.xy for text in axes.texts if text.get_text().isdigit()}
    assert sorted(written) == numbers
    for number, place in written.items():
        np.testing.assert_array_equal(place, problem.task.positions[number - 1])


def test_of_a_hundred_points_about_a_dozen_are_numbered() -> None:
    axes = drawn(*reversed(planted(100)))
    assert 10 <= sum(text.get_text().isdigit() for text in axes.texts) <= 15


def test_a_closed_path_is_drawn_closed_and_its_repeated_point_once() -> None:
    problem, linkage = planted(6, closed=True)
    axes = drawn(linkage, problem)
    (path,) = [line.get_xydata() for line in axes.lines if str(line.get_label()).startswith("path")]
    np.testing.assert_allclose(path[0], path[-1], atol=1e-9)
    for point in problem.task.positions:
        assert np.hypot(*(path - point).T).min() < 0.02 * problem.task.size
    drivers = [line for line in axes.lines if to_hex(line.get_color()) == DRIVER]
    assert len(drivers) == 5
    assert {text.get_text() for text in axes.texts if to_hex(text.get_color()) == PATH} == set("12345")
    assert "over the task" not in axes.get_title()


def test_an_open_path_shows_the_part_used() -> None:
    problem, linkage = planted(5)
    axes = drawn(linkage, problem)
    labels = [str(line.get_label()) for line in axes.lines]
    assert "path of P, first to last target" in labels
    assert "path of P, whole turn" in labels


@pytest.mark.study
def test_least_squares_tells_its_error_in_the_heading(tmp_path: Path) -> None:
    problem, design = load("path-18-timed"), published("path-18-timed")[0]
    axes = drawn(design.linkage, problem)
    assert "error rms 0.0225" in axes.get_title()
    save(axes.figure, [tmp_path / "path.png", tmp_path / "path.svg"])  # type: ignore[arg-type]
    assert {path.suffix for path in tmp_path.iterdir()} == {".png", ".svg"}
    poses = MotionTask.from_degrees([[0, 0, 0], [2, 1, 20], [3, 3, 50], [3, 4, 40], [2, 5, 90], [0, 5, 95]])
    result = synthesize(Problem(task=poses), starts=8, effort=0.2)
    (heading,) = (axes.get_title() for axes in draw_design(result.problem, result.best, 1).axes)
    error = result.best.error(result.problem) * poses.size  # of places and angles, as the list has it
    assert abs(error / result.best.verdict.error_rms - 1) > 0.01
    assert f"error rms {error:.3g}" in heading
    exact, linkage = planted(5)
    assert "rms" not in drawn(linkage, exact).get_title()
