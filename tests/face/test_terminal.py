"""The output on the terminal."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from grashof.analysis.mechanism.mobility import GrashofClass
from grashof.output.terminal import best_rows, folded, heading, print_table, search_progress
from grashof.problems import (
    Box,
    MotionTask,
    Objective,
    PathTask,
    Problem,
    Requirements,
    Search,
    TransmissionOver,
    load,
)
from grashof.synth import Progress, Result
from grashof.synth.search.finder import finder_of
from grashof.wording.problem import ends_with_enough, error_meaning, summary


def zoned(**zones: Any) -> MotionTask:
    """Three poses, each of which may be missed."""
    return MotionTask.from_degrees([[0, 0, 0], [1, 0, 10], [2, 1, 30]], **zones)


def test_the_table_shows_the_main_quantities(few: Result, capsys: pytest.CaptureFixture[str]) -> None:
    print_table(few)
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith(f"{len(few)} distinct verified")
    best = few.candidates[0]
    row = next(line for line in lines if line.lstrip().startswith("1"))
    for angle in (best.verdict.transmission_min_task, best.verdict.transmission_min_cycle):
        assert f" {np.degrees(angle):.1f} " in row
    for length in best.linkage.lengths:
        assert f" {length:.4g} " in row
    for x, y in (best.linkage.o2, best.linkage.o4):
        assert f"{x:.3g}, {y:.3g}" in row
    assert max(map(len, lines)) < 100


def test_the_torque_is_shown_where_it_is_a_goal(few: Result, capsys: pytest.CaptureFixture[str]) -> None:
    print_table(few)
    assert "torque  " not in capsys.readouterr().out
    driven = replace(few.problem, objective=Objective(transmission=1, torque=0.5))
    sum_of = "greatest worst transmission angle over the task 1, smallest peak torque 0.5"
    assert f"  best: a weighted sum: {sum_of}" in summary(driven)
    print_table(replace(few, problem=driven))
    lines = capsys.readouterr().out.splitlines()
    row = next(line for line in lines if line.lstrip().startswith("1"))
    assert f" {few.candidates[0].values['torque_peak']:.4g} " in row
    assert any("N m" in line for line in lines)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, "greatest worst transmission angle over the task"),
        (
            {"requirements": Requirements(transmission_over=TransmissionOver.CYCLE)},
            "greatest worst transmission angle over the turn",
        ),
        ({"objective": Objective(transmission=0, compactness=2)}, "smallest size"),
        ({"objective": Objective(transmission=0, torque=1)}, "smallest peak torque"),
        (
            {"requirements": Requirements(exact=False)},
            "least error (rms; errors up to 1e-06 sizes are equal, "
            "then greatest worst transmission angle over the task); "
            "the list offers more transmission or less size within 2 times that error",
        ),
        (
            {
                "requirements": Requirements(exact=False, error_factor=1.3),
                "objective": Objective(transmission=0, compactness=2),
            },
            "smallest size, as long as the error (rms) is at most 1.3 times the least",
        ),
        (
            {"task": zoned(within=0.06, angle_within_deg=[1, 2, 3])},
            "greatest worst transmission angle over the task, "
            "as long as each target is missed by at most 0.06 m and 1 to 3 deg",
        ),
        (
            {"task": PathTask([[0, 0], [1, 0], [3, 3]], within=[0.1, 0.2, 0.3])},
            "greatest worst transmission angle over the task, "
            "as long as each target is missed by at most 0.1 to 0.3 m",
        ),
    ],
)
def test_the_summary_states_the_goal(few: Result, changes: dict[str, Any], said: str) -> None:
    assert f"  best: {said}" in summary(replace(few.problem, **changes))


@pytest.mark.parametrize("mixed", [False, True])
@pytest.mark.parametrize("columns", [40, 60, 80, 100])
def test_table_fits_the_terminal_uncut(
    few: Result,
    columns: int,
    mixed: bool,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    terminal = Console(width=columns, highlight=False, markup=False)
    monkeypatch.setattr("grashof.output.terminal.console", lambda: terminal)
    if mixed:
        first = few.candidates[0]
        other = replace(first, verdict=replace(first.verdict, grashof_class=GrashofClass.DOUBLE_CRANK))
        few = replace(few, candidates=(other, *few.candidates[1:]))
    print_table(few)
    lines = capsys.readouterr().out.splitlines()[2:]
    assert max(map(len, lines)) <= columns
    assert "…" not in "".join(lines)
    heading = " ".join(" ".join(lines[:4]).split())
    assert all(name in heading.split() for name in ("r1", "r2", "r3", "r4", "mu"))
    assert ("size" in heading) == (columns >= 60)
    assert ("O2" in heading) == (columns >= 80)
    assert ("class" in heading) == (mixed and columns >= 100)
    for candidate in few.candidates:
        lengths = [f"{length:.{4 if columns >= 100 else 3}g}" for length in candidate.linkage.lengths]
        assert any(all(length in line.split() for length in lengths) for line in lines)


def test_a_terminal_breaks_no_word(monkeypatch: pytest.MonkeyPatch) -> None:
    line = "  best: least error of a crank-rocker; the list offers more"
    assert folded([line]) == [line]  # as it is where it is piped
    monkeypatch.setattr("grashof.output.terminal.console", lambda: Console(width=36, force_terminal=True))
    monkeypatch.setattr("sys.stdout.isatty", lambda: True, raising=False)
    assert folded([line]) == ["  best: least error of a", "    crank-rocker; the list offers", "    more"]


def test_the_heading_mentions_designs_not_listed(few: Result, capsys: pytest.CaptureFixture[str]) -> None:
    print_table(few, 56)
    said = f"56 distinct designs verified, listed are the best {len(few)} (crank-rocker)"
    assert capsys.readouterr().out.startswith(said)


def test_a_long_list_is_cut_with_a_note(few: Result, capsys: pytest.CaptureFixture[str]) -> None:
    many = tuple(replace(each, family=f"d{k}") for k, each in enumerate(few.candidates * 2))
    print_table(replace(few, candidates=many))
    out = capsys.readouterr().out
    assert "The best 12" in out
    assert "\n  13" not in out


def test_the_best_of_each_family_represents_all(alike: Result, capsys: pytest.CaptureFixture[str]) -> None:
    print_table(alike)
    first, second, *lines = capsys.readouterr().out.splitlines()
    assert first.startswith("8 distinct verified crank-rocker designs in 5 families, ")
    assert second.endswith(" The best of each family:")
    assert "best at" in " ".join(lines[:3])
    rows = best_rows(alike)
    assert [row["#"].strip("* ") for row in rows] == list("12345")
    assert [row["family size"] for row in rows] == ["3", "2", "1", "1", "1"]
    assert [row["best at"] for row in rows] == ["least error", "smallest within 1.5 times", "", "", ""]
    assert any(line.endswith("3  least error") for line in lines)
    print_table(alike.top(2), 8)
    said = "8 distinct designs verified, listed are the best 5 in 2 families (crank-rocker), "
    assert capsys.readouterr().out.startswith(said)
    assert (
        set(best_rows(replace(alike, candidates=alike.candidates[2:3]))[0]) & {"family size", "best at"}
        == set()
    )


def test_only_exact_designs_are_counted_until_there_are_enough() -> None:
    problem = load("luggage")
    path = PathTask([[k, k * k] for k in range(12)])
    tried = [
        (problem, True),
        (replace(problem, task=zoned(within=1)), True),  # met exactly first
        (Problem(task=path), False),
        (Problem(task=path, requirements=Requirements(exact=True)), True),
        (Problem(task=path, requirements=Requirements(exact=True, tolerance=0.01)), False),
    ]
    for each, ends in tried:
        assert ends_with_enough(each) is ends
        assert (f"{each.search.enough} designs" in summary(each)[-1]) is ends


def test_the_summary_states_the_effort() -> None:
    problem = load("luggage")
    assert "effort" not in summary(problem)[-1]
    assert summary(replace(problem, search=Search(effort=2.5)))[-1].endswith(", effort 2.5")


@pytest.mark.parametrize(
    ("wanted", "starts", "line"),
    [
        (True, 78, "mine: 9 designs verified (50 wanted), 16 of 78 starts solved"),
        (False, 78, "mine: 9 designs verified, 16 of 78 starts solved"),
        (False, None, "mine: 9 designs verified"),
    ],
)
def test_progress_is_a_line_for_each_step(
    few: Result, capsys: pytest.CaptureFixture[str], wanted: bool, starts: int | None, line: str
) -> None:
    with search_progress("mine", wanted=wanted) as show:
        for count in (9, 56):
            show(Progress(solved=16, starts=starts, enough=50, designs=few.candidates[:1] * count))
    assert capsys.readouterr().err.splitlines() == [line, line.replace("9 designs", "56 designs")]


def test_summary_names_every_requirement_given() -> None:
    wanted = Requirements(
        o2=Box(x=(0, 1)),
        b=Box(y=(2, 3)),
        ground_angle_deg=30,
        theta2_start_deg=-20,
        r3=(1, 2),
        driver_sense="cw",
    )
    text = "\n".join(summary(replace(load("luggage"), requirements=wanted)))
    for said in (
        "place of O2: x 0 to 1 m",
        "place of B: y 2 to 3 m",
        "direction of O2O4: 30 deg",
        "driver angle at the first target: -20 deg",
        "r3: 1 to 2 m",
        "sense of the driver: cw",
    ):
        assert said in text


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("path-vertical-line", "path through 6 points, size 25; every target met within 1e-06 sizes"),
        ("path-18-timed", "closed path through 18 points timed over 340 deg, size 0.96566; least squares"),
        ("luggage", "motion through 4 poses, size 5.65685 m, angle_length 5.65685 m; every target met"),
    ],
)
def test_the_summary_states_the_task(name: str, said: str) -> None:
    assert said in summary(load(name))[1]


def test_the_heading_has_the_error_of_its_column(few: Result) -> None:
    fitted = replace(few, problem=replace(few.problem, requirements=Requirements(exact=False)))
    candidates = tuple(
        replace(each, verdict=replace(each.verdict, square=(1 + 0.1 * rank) ** 2))
        for rank, each in enumerate(few.candidates)
    )
    fitted = replace(fitted, candidates=candidates)
    assert ", smallest error rms 0.5. Lengths in m." in heading(fitted, len(few))
    assert best_rows(fitted)[0]["error rms"] == "0.5"


def test_the_meaning_of_the_error_of_poses_is_stated(few: Result) -> None:
    fitted = replace(few.problem, requirements=Requirements(exact=False))
    said = "of positions and angles together, 1 rad counted as 5.65685 m"
    assert error_meaning(fitted) == said
    assert f"\nerror rms: {said}.\n" in heading(replace(few, problem=fitted), len(few))
    points = replace(fitted, task=MotionTask.from_degrees([{"x": x, "y": x**2} for x in range(3)]))
    assert [error_meaning(each) for each in (few.problem, points, load("path-ellipse"))] == ["", "", ""]


@pytest.mark.parametrize(
    ("name", "exact", "said"),
    [
        ("luggage", None, "tracing dyads and judging pairs"),
        ("luggage", False, "searching"),
        ("path-vertical-line", None, "searching"),
    ],
)
def test_the_search_begins_with_its_first_step(name: str, exact: bool | None, said: str) -> None:
    problem = load(name)
    problem = replace(problem, requirements=replace(problem.requirements, exact=exact))
    assert finder_of(problem).beginning == said


def test_a_name_is_no_markup(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    with search_progress("[bold]mine[/x]"):
        pass
    assert "[bold]mine[/x]" in capsys.readouterr().err
