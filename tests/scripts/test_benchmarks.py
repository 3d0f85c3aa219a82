"""Benchmarks: they measure what they state, and the independent search is right and independent."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from grashof.analysis import solve_position, verify
from grashof.problems import Box, FourBar, MotionTask, PathTask, Problem, Requirements
from grashof.problems.files.on_disk import document_of
from grashof.problems.files.problem_schema import problem_from

ROOT = Path(__file__).parents[2]
BENCHMARKS, DATA = ROOT / "scripts" / "benchmarks", ROOT / "tests" / "data"
PLANTED = FourBar((0, 0), (100, 0), 40, 120, 80, (60, 50))
Script = Callable[[str], ModuleType]
LIMITS: dict[str, Any] = {"exact": False, "rotatability": "crank-rocker", "transmission_min_deg": 25}


@pytest.fixture
def independent(script: Script, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    module = script("independent_search")
    monkeypatch.setattr(module, "POLISHED", 12)  # enough for easy tasks, and fast
    return module


@pytest.fixture
def run(script: Script, capsys: pytest.CaptureFixture[str]) -> Any:
    """The output of some cases of a benchmark."""

    def printed(name: str, only: str, count: int) -> str:
        assert script("run").main([name, "--only", only, "--count", str(count)]) == 0
        return capsys.readouterr().out

    return printed


def closed_path(noise: float) -> PathTask:
    points = solve_position(PLANTED, np.linspace(0, 2 * np.pi, 10, endpoint=False)).p
    return PathTask(points + np.random.default_rng(0).normal(0, noise, points.shape), closed=True)


def noisy_poses() -> MotionTask:
    state, rng = solve_position(PLANTED, np.linspace(0.5, 3, 6)), np.random.default_rng(1)
    return MotionTask(state.p + rng.normal(0, 0.5, (6, 2)), state.theta3 + rng.normal(0, 0.01, 6))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("task", "more"),
    [(closed_path(0.5), {}), pytest.param(noisy_poses(), {"o4": Box(y=(-5, 5))}, marks=pytest.mark.study)],
    ids=["path", "poses"],
)
def test_the_independent_search_is_no_worse_than_the_planted_linkage(
    independent: ModuleType, task: Any, more: dict[str, Any]
) -> None:
    problem = Problem(task=task, requirements=Requirements(**LIMITS, link_length=(30, 130), **more))
    planted = verify(PLANTED, problem.task, problem.requirements)
    found = independent.search(problem, starts=100)
    assert planted.ok
    assert found.verdict.ok
    assert found.error <= np.sqrt(planted.square / len(task))


@pytest.mark.study
def test_a_limit_that_cuts_the_planted_linkage_off_is_active(
    independent: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(independent, "POLISHED", 40)  # other minima, which machines meet or not, are near
    problem = Problem(task=closed_path(0.0), requirements=Requirements(**LIMITS, link_length=(30, 105)))
    found = independent.search(problem, starts=400)
    assert found.verdict.ok
    assert found.linkage.lengths.max() == pytest.approx(105, abs=1e-3)
    assert found.error > 0.01


def test_limits_that_no_linkage_holds_have_no_design(
    independent: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(independent, "STAGES", ((1.0, 1.0, 3),))
    wanted = Requirements(**LIMITS, r2=(100, 200), r1=(10, 50))  # no crank-rocker
    assert independent.search(Problem(task=closed_path(0.0), requirements=wanted), starts=1) is None


@pytest.mark.slow
def test_the_independent_search_shares_nothing_with_that_of_the_package() -> None:
    code = "import sys, independent_search; print([m for m in sys.modules if 'synth' in m or 'casadi' in m])"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=BENCHMARKS, check=True, capture_output=True, text=True
    )
    assert done.stdout == "[]\n"


@pytest.mark.quick("limited.json")
@pytest.mark.parametrize("file", ["limited.json", "limited_random.json"])
def test_best_designs_known_are_accepted_and_as_good_as_stated(file: str) -> None:
    tasks = json.loads((DATA / file).read_text(encoding="utf-8"))["tasks"]
    assert len(tasks) >= 12
    for task in tasks:
        if task["best"] is None:
            continue
        problem = problem_from(document_of(task["toml"], task["name"]), task["name"])
        verdict = verify(FourBar(**task["linkage"]), problem.task, problem.requirements)
        assert verdict.ok, (task["name"], verdict.defects)
        assert np.sqrt(verdict.square / len(problem.task)) == pytest.approx(task["best"], rel=1e-6, abs=1e-8)


@pytest.mark.slow
def test_the_benchmark_of_limits_measures(run: Any, script: Script, monkeypatch: pytest.MonkeyPatch) -> None:
    limited = script("limited")
    monkeypatch.setattr(limited, "synthesize", partial(limited.synthesize, effort=0.2))
    assert "1 of 1 within 2 %" in run("limited", "random", 1)


@pytest.mark.slow
def test_strokes_are_as_good_as_those_of_the_independent_search(run: Any) -> None:
    assert "1 of 1 within 2 %" in run("outputs", "swing beside an independent search: coupler", 1)
    assert "1 of 1 within 2 %" in run("outputs", "swing beside an independent search: distance", 1)


@pytest.mark.study
def test_benchmarks_of_searches_measure(run: Any) -> None:
    assert "1 of 1 solved" in run("planted", "four poses", 1)
    assert "best transmission 30.17" in run("catalogue", "limit 12", 1)


@pytest.mark.study
def test_the_benchmark_of_struts_measures(run: Any) -> None:
    """The independent search computes the effort as the judge does: both deviations are close."""
    found = re.search(r"design 1: (.*) N in .* independently (.*) N in", run("struts", "trunk", 1))
    assert found is not None
    mine, theirs = map(float, found.groups())
    assert mine <= 1.05 * theirs
    assert theirs < 1.2 * mine


def test_the_benchmark_of_kinematics_agrees_with_the_plain_form(
    run: Any, script: Script, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(script("kinematics"), "RUNS", 1)
    said = run("kinematics", "link", 500)
    assert float(said.split("largest difference ")[1].split()[0]) < 1e-12
    assert "500 linkages at 64 angles" in said


@pytest.mark.slow
def test_the_benchmark_of_the_page_measures(run: Any) -> None:
    said = run("pages", "of a search", 60)
    assert "60 designs" in said
    assert float(said.split()[-2]) < 1  # MB


def test_the_exponent_of_costs_is_that_of_a_power(script: Script) -> None:
    exponent, sizes = script("costs").exponent, (4, 40, 400)
    assert exponent(sizes, [3 * size**1.7 for size in sizes]) == pytest.approx(1.7)
    assert exponent(sizes, [0.0, 2.0, 20.0]) == pytest.approx(1.0)
    assert np.isnan(exponent(sizes, [0.0, 0.0, 1.0]))


@pytest.mark.quick("starts, luggage-100")
@pytest.mark.slow
@pytest.mark.parametrize(
    ("case", "most"), [("targets, met poses", 40), ("starts, luggage", 100), ("list, luggage", 100)]
)
def test_the_costs_of_every_size_are_measured(run: Any, case: str, most: int) -> None:
    said = run("costs", case, most)
    sizes = re.findall(rf"^{case}: (\d+), [\d.]+ s, \d+ MB$", said, flags=re.MULTILINE)
    assert max(map(int, sizes)) == most
    assert re.search(rf"^{case}: time grows with the power \S+, memory with \S+$", said, flags=re.MULTILINE)
