"""Kinds of task from the command line: strokes, functions, paths, poses with free parts, many poses."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from command_runs import Grashof
from matplotlib.colors import to_hex

from grashof import load, synthesize
from grashof.analysis import solve_position
from grashof.analysis.judge.planted import planted_motion
from grashof.figures import plot_task
from grashof.figures.files import draw_design
from grashof.figures.parts import BODY, COUPLER, DRIVER
from grashof.output.run_files import write_run
from grashof.problems import (
    FourBar,
    MotionTask,
    Problem,
    Requirements,
    catalogue,
    load_linkage_spec,
)
from grashof.sections.output import function_section
from grashof.study.asked import Asked
from grashof.study.section import Section
from grashof.study.study import LinkageStudy
from grashof.synth import Result

EXAMPLES = ("function-five-pairs", "function-log10", "function-sin", "function-dosing-slide", "coupler-angle")
STROKE = 'kind = "stroke"\n[stroke]\nswing_deg = {}\ntime_ratio = {}\n'


@pytest.fixture
def stroke(tmp_path: Path) -> Callable[[float, float], str]:
    """A file of a stroke."""

    def stated(swing_deg: float, time_ratio: float) -> str:
        path = tmp_path / "stroke.toml"
        path.write_text(STROKE.format(swing_deg, time_ratio))
        return str(path)

    return stated


def solved(grashof: Grashof, name: str) -> tuple[str, Path, pd.DataFrame]:
    """The output, the folder and the table of a search of the catalogue."""
    done = grashof("solve", name, "--drawings", "1")
    assert done.exit_code == 0, done.output
    folder = Path(f"{name}-designs")
    return done.output, folder, pd.read_csv(folder / "candidates.csv")


def function_of(folder: Path) -> Section:
    """The section of the best design of a function, by its analysis."""
    section = function_section(LinkageStudy.of(load_linkage_spec(f"{folder}/candidates.json#1"), Asked()))
    assert section is not None
    return section


@pytest.mark.slow
def test_check_states_a_stroke(grashof: Grashof) -> None:
    done = grashof("check", "quick-return")
    assert done.exit_code == 0, done.output
    assert "swing 80 deg, time ratio 1.11111, place and scale free; met within 1e-06" in done.output
    assert "r1: 120 mm" in done.output


@pytest.mark.slow
def test_a_stroke_is_listed_drawn_and_analysed(grashof: Grashof) -> None:
    output, folder, table = solved(grashof, "quick-return")
    assert "position error" not in output
    assert "37.7 deg at best" in output
    assert table["r2"][0] == pytest.approx(46.67, abs=0.005)
    assert table["output_swing_deg"].to_numpy() == pytest.approx(80)
    assert table["time_ratio"].to_numpy() == pytest.approx(10 / 9)
    page = (folder / "report.html").read_text()
    assert "six-bar" in page
    assert "body at the poses" not in page
    designs = json.loads((folder / "candidates.json").read_text())["designs"]
    assert designs[0]["theta2"] == pytest.approx([0.434062, 3.741002], abs=1e-6)
    done = grashof("analyse", f"{folder / 'candidates.json'}#1")
    assert done.exit_code == 0, done.output
    assert "swing of the output" in done.output


@pytest.mark.parametrize(
    ("swing", "ratio", "line"),
    [
        (200, 1.1, "stroke.swing_deg is 200; it must be from 0.0573 to less than 180, as a rocker swings"),
        (80, 0.9, "stroke.time_ratio is 0.9; it must be at least 1, the slow stroke over the quick one"),
        (80, 9, "stroke.time_ratio is 9; it must be less than 6.2 for a crank-rocker that swings by 80 deg"),
    ],
)
def test_an_impossible_stroke_is_refused_in_a_line(
    grashof: Grashof, stroke: Callable[[float, float], str], swing: float, ratio: float, line: str
) -> None:
    done = grashof("check", stroke(swing, ratio))
    assert done.exit_code == 2
    assert line in done.output.replace("\n", " ")
    assert "Traceback" not in done.output


@pytest.mark.slow
def test_an_empty_list_of_strokes_is_explained(
    grashof: Grashof, stroke: Callable[[float, float], str]
) -> None:
    path = Path(stroke(80, 1.1))
    path.write_text(path.read_text() + "[requirements]\ntransmission_min_deg = 50\n")
    done = grashof("solve", str(path), "--drawings", "0")
    assert done.exit_code == 1
    assert "transmission_min_deg 38.3 instead of 50" in done.output


@pytest.mark.slow
def test_a_function_is_solved_and_analysed(grashof: Grashof) -> None:
    output, folder, table = solved(grashof, "function-five-pairs")
    assert "structural error from" in output
    assert table[["error", "error_max", "error_rms", "error_sse"]].isna().all(axis=None)
    assert (table["structural_error_max_deg"] >= table["structural_error_rms_deg"]).all()
    assert table["structural_error_at_deg"].between(0, 90).all()
    designs = json.loads((folder / "candidates.json").read_text())["designs"]
    assert max(max(design["output_error"]) for design in designs) < 1e-6
    assert (folder / "design-01.png").stat().st_size > 10_000
    page = (folder / "report.html").read_text()
    for word in ("output rotation", "Structural error", "generated"):
        assert word in page
    section = function_of(folder)
    assert {plot.key for plot in section.plots} == {"function-output", "structural-error"}
    assert section.tables["function"]["error_deg"].abs().max() < 1e-6
    worst = next(fact.value for fact in section.facts if fact.key == "structural_error_max_deg")
    assert worst == pytest.approx(table["structural_error_max_deg"][0])
    done = grashof("analyse", f"{folder / 'candidates.json'}#1")
    assert done.exit_code == 0, done.output


@pytest.mark.slow
def test_a_coupler_angle_is_called_that_everywhere(grashof: Grashof) -> None:
    output, folder, table = solved(grashof, "coupler-angle")
    assert "structural error from 0.287 deg" in output
    assert table["structural_error_rms_deg"][0] < 0.146
    page = (folder / "report.html").read_text()
    assert "coupler rotation" in page
    assert "output rotation" not in page
    section = function_of(folder)
    assert [plot.title for plot in section.plots] == ["coupler rotation", "structural error"]
    (zero,) = (fact.label for fact in section.facts if fact.key == "output_zero_deg")
    assert zero == "theta3 at the wanted output zero"
    done = grashof("judge", f"{folder / 'candidates.json'}#1", "coupler-angle")
    assert done.exit_code == 0, done.output
    assert "greatest structural error: 0.287088 deg" in done.output
    done = grashof("judge", "engine", "coupler-angle")
    assert done.exit_code == 2
    assert "mechanism must be four-bar or inverted-slider-crank" in done.output.replace("\n", " ")


def test_a_coupler_angle_is_checked_and_drawn_by_its_name(grashof: Grashof) -> None:
    done = grashof("check", "coupler-angle")
    assert "driver over 180 deg; coupler in the sense of the driver" in done.output.replace("\n", " ")
    assert plot_task(load("coupler-angle")).get_ylabel() == "coupler rotation (deg)"
    done = grashof("prove", "coupler-angle")
    assert "Not proven" in done.output


@pytest.mark.study
def test_a_slide_is_listed_in_its_unit_of_length(grashof: Grashof) -> None:
    output, folder, table = solved(grashof, "function-dosing-slide")
    assert " mm. Lengths in mm" in output
    assert table[["structural_error_max_deg", "structural_error_rms_deg"]].isna().all(axis=None)
    assert (table["structural_error_max"] >= table["structural_error_rms"]).all()
    assert table["structural_error_at_deg"].between(0, 120).all()
    page = (folder / "report.html").read_text()
    assert '"title":"travel of the slide","unit":"mm"' in page.replace(": ", ":").replace(", ", ",")
    section = function_of(folder)
    assert {plot.unit for plot in section.plots} == {"mm"}
    pairs = section.tables["function"]
    assert (pairs["generated"] - pairs["wanted"] - pairs["error"]).abs().max() < 1e-9
    facts = {fact.key: fact.value for fact in section.facts}
    assert facts["structural_error_max"] == pytest.approx(table["structural_error_max"][0])
    assert pairs["error"].abs().max() == pytest.approx(facts["structural_error_max"], rel=1e-3)


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_catalogue_has_functions(grashof: Grashof, name: str) -> None:
    assert name in catalogue()
    done = grashof("check", name)
    assert done.exit_code == 0, done.output
    assert "coupler arm" not in done.output
    assert plot_task(load(name)).get_xlabel() == "driver rotation from the first pair (deg)"


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


def test_the_body_is_drawn_where_the_design_has_it() -> None:
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


@pytest.mark.slow
def test_designs_of_a_path_have_no_angle_error(tmp_path: Path) -> None:
    result = synthesize(load("path-vertical-line"), starts=8, enough=4)
    files = write_run(tmp_path, result, {}, drawings=1)
    assert {"candidates.csv", "candidates.json", "design-01.png", "design-01.svg"} <= set(files)
    designs = json.loads((tmp_path / "candidates.json").read_text(encoding="utf-8"))["designs"]
    assert len(designs) == len(result)
    for design in designs:
        assert "angle_error" not in design
        gap = solve_position(FourBar(**design["linkage"]), design["theta2"]).p - result.problem.task.positions
        np.testing.assert_allclose(gap, 0, atol=1e-6 * result.problem.task.size)
