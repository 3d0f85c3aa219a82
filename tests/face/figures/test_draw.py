"""Drawings of designs show the linkage where it really is, and paths of any number of points."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex

from grashof import synthesize
from grashof.analysis import solve_position, verify
from grashof.analysis.judge.planted import planted_path, random_full_crank
from grashof.figures import draw_design, save, save_animation
from grashof.figures.files import draw_motion
from grashof.figures.parts import BODY, DRIVER, PATH, TARGET, missing_glyphs_unwarned
from grashof.figures.section_plots import plots
from grashof.problems import FourBar, LinkageSpec, MotionTask, PathTask, Problem, load
from grashof.problems.files.published import published
from grashof.survey import report_on
from grashof.synth import Candidate, Result


@pytest.fixture
def axes(few: Result) -> Axes:
    """The first design, drawn as number 7."""
    return draw_design(few.problem, few.candidates[0], 7).axes[0]


def test_drivers_end_on_circles_about_o2_and_axes_are_equal(few: Result, axes: Axes) -> None:
    candidate = few.candidates[0]
    drivers = [line.get_xydata() for line in axes.lines if to_hex(line.get_color()) == DRIVER]
    assert len(drivers) == 4
    for ends in drivers:
        np.testing.assert_allclose(ends[0], candidate.linkage.o2)
        np.testing.assert_allclose(np.hypot(*(ends[1] - ends[0])), candidate.linkage.r2)
    assert (axes.get_aspect(), axes.get_xlabel()) == (1, "x (m)")
    assert "design 7" in axes.get_title()
    assert f"{np.degrees(candidate.verdict.transmission_min_task):.1f} deg" in axes.get_title()
    assert {to_hex(text.get_color()) for text in axes.texts if text.get_text() in set("1234")} == {PATH}


def test_path_of_p_passes_the_poses_and_bodies_stand_there(few: Result, axes: Axes) -> None:
    candidate, task = few.candidates[0], few.problem.task
    path = next(line.get_xydata() for line in axes.lines if "first to last" in str(line.get_label()))
    for position in task.positions:
        assert np.hypot(*(path - position).T).min() < 0.02 * task.size
    np.testing.assert_allclose(
        path[[0, -1]][:: candidate.verdict.direction], task.positions[[0, -1]], atol=1e-9
    )
    bodies = [patch for patch in axes.patches if to_hex(patch.get_edgecolor()) == BODY]
    assert len(bodies) == 4
    np.testing.assert_allclose([body.get_xy()[0] for body in bodies], task.positions)


def test_names_legend_and_sense_of_the_driver(few: Result, axes: Axes) -> None:
    candidate = few.candidates[0]
    named = {text.get_text(): text.xy for text in axes.texts}
    assert {"O2", "O4", "A", "B", "P"} <= set(named)
    np.testing.assert_allclose(named["P"], few.problem.task.positions[-1], atol=1e-9)
    legend = axes.get_legend()
    assert legend is not None
    assert legend.get_title().get_text() == "light to dark: first to last target"
    assert "body" in {text.get_text() for text in legend.get_texts()}
    arrow = next(t for t in axes.texts if t.arrow_patch and to_hex(t.arrow_patch.get_edgecolor()) == DRIVER)
    tail, head = np.array(arrow.xyann) - candidate.linkage.o2, np.array(arrow.xy) - candidate.linkage.o2
    assert np.sign(tail[0] * head[1] - tail[1] * head[0]) == candidate.verdict.direction


@pytest.mark.parametrize("circuit_ok", [True, False])
def test_a_defect_is_stated_and_no_motion_is_drawn(few: Result, axes: Axes, circuit_ok: bool) -> None:
    verdict = replace(few.candidates[0].verdict, branch_ok=False, circuit_ok=circuit_ok)
    wrong = draw_design(few.problem, replace(few.candidates[0], verdict=verdict), 1).axes[0]
    assert f"{'branch' if circuit_ok else 'circuit'} defect" in wrong.get_title()
    assert not any("first to last" in str(line.get_label()) for line in wrong.lines)
    assert "defect" not in axes.get_title()


def test_areas_kept_out_are_hatched_where_they_are(few: Result, axes: Axes) -> None:
    areas = ([[0, -9], [0, 0], [5, 0], [5, -9]], [[8, 8], [9, 8], [9, 9]])
    wanted = replace(few.problem.requirements, keep_out=areas, keep_out_for=("o2", "links"))
    kept = draw_design(replace(few.problem, requirements=wanted), few.candidates[0], 1).axes[0]
    hatched = [patch for patch in kept.patches if patch.get_hatch()]
    assert [patch.get_xy()[:-1].tolist() for patch in hatched] == list(areas)
    legend = kept.get_legend()
    assert legend is not None
    assert "kept out: O2, links" in {text.get_text() for text in legend.get_texts()}
    assert not any(patch.get_hatch() for patch in axes.patches)


SIGN = "\N{CJK UNIFIED IDEOGRAPH-4F38}"


@pytest.mark.parametrize("title", [r"$\nonsense{ for 5$", pytest.param(SIGN, marks=pytest.mark.slow)])
def test_dollars_and_backslashes_and_signs_that_the_font_lacks_are_plain_text(
    few: Result, tmp_path: Path, title: str
) -> None:
    problem = replace(few.problem, title=title, length_unit="$^$", dynamics=None)
    figure = draw_design(problem, few.candidates[0], 1)
    save(figure, [tmp_path / "d.png", tmp_path / "d.svg"])  # warnings are errors here
    assert figure.axes[0].get_title().startswith(f"{title}: design 1")
    assert title in (tmp_path / "d.svg").read_text(encoding="utf-8")
    save_animation(draw_motion(few.candidates[0], problem, seconds=0.2, fps=10), tmp_path / "d.gif")


@pytest.mark.slow
@pytest.mark.quick("title0")
@pytest.mark.parametrize("title", ["Luggage over a staircase, carried " * 8, "W" * 500, "title", "階 " * 99])
def test_no_title_is_cut_at_the_edge_of_the_picture(few: Result, title: str) -> None:
    problem = replace(few.problem, title=title, dynamics=None)
    drawn = draw_design(problem, few.candidates[0], 1)
    spec = LinkageSpec(few.best.linkage, "mine", title=title)
    moving = draw_motion(spec, seconds=0.2)
    moving._draw_was_started = True  # else matplotlib warns that it was never seen
    report = plots(report_on(spec))
    for figure in (drawn, moving._fig, next(report)[1], next(report)[1]):
        with missing_glyphs_unwarned():
            figure.draw_without_rendering()
            edges = figure.axes[0].title.get_window_extent()
        assert 0 <= edges.x0 < edges.x1 <= figure.bbox.width
        assert edges.y1 <= figure.bbox.height
        assert edges.y0 >= figure.axes[0].get_window_extent().y1
        assert figure.axes[0].get_window_extent().height > 0.25 * figure.bbox.height
    assert "design 1" in drawn.axes[0].get_title()


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
    assert "path of P, full turn" in labels


@pytest.mark.study
def test_least_squares_states_its_error_in_the_heading(tmp_path: Path) -> None:
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
