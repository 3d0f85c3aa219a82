"""Dwell tasks: stated, written and read back; impossible ones are refused in a line."""

import numpy as np
import pytest
from refusals import rows

from grashof.problems import DwellTask, Objective, PathTask, Problem, ProblemError, load
from grashof.problems.files.problem_writing import problem_toml


def test_a_dwell_has_two_ends_without_a_place() -> None:
    task = DwellTask.from_degrees(dwell_deg=90, swing_deg=45)
    assert (len(task), task.closed, task.scale_free, task.size) == (2, True, True, 1.0)
    assert np.isnan(task.positions).all()
    assert np.degrees([task.dwell, task.output_size, task.most_band]).round(9).tolist() == [90, 45, 2.25]


def test_the_stroke_of_a_slide_is_the_size() -> None:
    task = DwellTask.from_degrees(dwell_deg=60, stroke=80, band=0.5)
    assert (task.size, task.scale_free, task.most_band, task.output_size) == (80.0, False, 0.5, 80.0)


def test_by_default_the_band_with_tolerances_is_made_least() -> None:
    of_link = Problem(task=DwellTask.from_degrees(dwell_deg=90, swing_deg=45))
    of_slide = Problem(task=DwellTask.from_degrees(dwell_deg=90, stroke=45))
    assert of_link.objective == Objective(transmission=0, band_made=1)
    assert of_slide.objective == of_link.objective
    assert [[goal.column for goal, _ in each.goals] for each in (of_link, of_slide)] == [
        ["band_made_deg"],
        ["band_made"],
    ]
    stated = Problem(task=of_link.task, objective=Objective())
    assert stated.objective == stated.for_kind("stephenson-3").objective == Objective()


@pytest.mark.parametrize("given", [{"swing_deg": 45.5, "band_deg": 0.05}, {"stroke": 80.0, "band": 0.1}])
def test_a_file_keeps_it(given: dict[str, float], tmp_path: object) -> None:
    stated = DwellTask.from_degrees(dwell_deg=100 / 3, **given)
    (file := tmp_path / "dwell.toml").write_text(problem_toml(Problem(task=stated)))  # type: ignore[operator]
    read = load(str(file)).task
    assert isinstance(read, DwellTask)
    for name in ("dwell", "swing", "stroke", "band"):
        assert getattr(read, name) == getattr(stated, name)


BAD = """
dwell_deg = 0 | dwell.dwell_deg is 0; it must be from 1 to 350
dwell_deg = 400 | dwell.dwell_deg is 400; it must be from 1 to 350
dwell_deg = 90 | dwell has neither swing_deg nor stroke; it must be one of the
    two: swing_deg for a rocker, stroke for a slide
dwell_deg = 90\\nswing_deg = 20\\nstroke = 3 | dwell has both swing_deg and stroke; it must
    be one of the two: swing_deg for a rocker, stroke for a slide
dwell_deg = 90\\nswing_deg = 0 | dwell.swing_deg is 0; it must be from 0.1 to 179
dwell_deg = 90\\nswing_deg = 40\\nband_deg = 25 | dwell.band_deg is 25; it must be from 4e-08 to 20
dwell_deg = 90\\nswing_deg = 40\\nband = 1 | dwell.band does not go with swing_deg; use band_deg
dwell_deg = 90\\nstroke = 40\\nband_deg = 1 | dwell.band_deg does not go with stroke; use band
dwell_deg = nan\\nswing_deg = 40 | dwell.dwell_deg is nan; it must be a finite number
"""


@pytest.mark.parametrize(("text", "line"), rows(BAD))
def test_impossible_dwells_are_refused(text: str, line: str, tmp_path: object) -> None:
    (file := tmp_path / "bad.toml").write_text(f'kind = "dwell"\n[dwell]\n{text}\n')  # type: ignore[operator]
    with pytest.raises(ProblemError) as refused:
        load(str(file))
    assert line in str(refused.value)


def test_six_bar_stands_for_the_kinds_that_the_task_suits() -> None:
    task = DwellTask.from_degrees(dwell_deg=90, swing_deg=45)
    assert (
        Problem(task=task).mechanism == Problem(task=task, mechanism="six-bar").mechanism == ("stephenson-3",)
    )
    with pytest.raises(
        ProblemError, match=r'^mechanism is four-bar; of kind = "dwell" it must be stephenson-3$'
    ):
        Problem(task=task, mechanism="four-bar")
    line = PathTask([[0, 0], [1, 0], [2, 1]])
    assert Problem(task=line, mechanism="six-bar").mechanism == ("stephenson-3", "stephenson-1", "watt-1")


def test_a_slide_has_no_angular_acceleration(tmp_path: object) -> None:
    dwell = 'kind = "dwell"\n[dwell]\ndwell_deg = 90\nstroke = 80\n[objective]\n'
    (file := tmp_path / "bad.toml").write_text(dwell + 'maximise = "output_acceleration_max"\n')  # type: ignore[operator]
    with pytest.raises(
        ProblemError, match=r"maximise.output_acceleration_max does not apply to a dwell of a slide"
    ):
        load(str(file))


REFUSED = """
exact = false | requirements.exact is false; with dwell it must be true: the swing or stroke is always met
stroke = [70, 90] | requirements.stroke does not go with dwell.swing_deg, whose output does not slide;
    remove it
theta2_start_deg = 70 | requirements.theta2_start_deg does not apply to a dwell; remove it
output_swing_deg = [40, 50] | requirements.output_swing_deg does not go with mechanism stephenson-3; only
    four-bar and inverted-slider-crank have it
"""


@pytest.mark.parametrize(("text", "line"), rows(REFUSED))
def test_requirements_that_do_not_apply_are_refused(text: str, line: str, tmp_path: object) -> None:
    dwell = 'kind = "dwell"\n[dwell]\ndwell_deg = 90\nswing_deg = 45\n[requirements]\n'
    (file := tmp_path / "bad.toml").write_text(dwell + text + "\n")  # type: ignore[operator]
    with pytest.raises(ProblemError) as refused:
        load(str(file))
    assert str(refused.value).splitlines() == [f"{file}: {line}"]
