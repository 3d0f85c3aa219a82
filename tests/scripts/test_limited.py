"""The independent search and the best designs known, against which limited least squares are measured."""

from __future__ import annotations

import importlib
import importlib.util
import json
import subprocess
import sys
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
DATA = ROOT / "tests" / "data"
PLANTED = FourBar((0, 0), (100, 0), 40, 120, 80, (60, 50))
LIMITS: dict[str, Any] = {"exact": False, "rotatability": "crank-rocker", "transmission_min_deg": 25}


@pytest.fixture(scope="module")
def independent() -> ModuleType:
    spec = importlib.util.spec_from_file_location(
        "independent_search", ROOT / "scripts" / "benchmarks" / "independent_search.py"
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.POLISHED = 12  # type: ignore[attr-defined]  # enough for easy tasks, and fast
    return module


def closed_path(noise: float) -> PathTask:
    points = solve_position(PLANTED, np.linspace(0, 2 * np.pi, 10, endpoint=False)).p
    return PathTask(points + np.random.default_rng(0).normal(0, noise, points.shape), closed=True)


@pytest.mark.slow
def test_it_finds_a_path_as_well_as_the_planted_linkage_does(independent: ModuleType) -> None:
    problem = Problem(task=closed_path(0.5), requirements=Requirements(**LIMITS, link_length=(30, 130)))
    planted = verify(PLANTED, problem.task, problem.requirements)
    found = independent.search(problem, starts=100)
    assert planted.ok
    assert found.verdict.ok
    assert found.error <= np.sqrt(planted.square / 10)


@pytest.mark.study
def test_it_finds_poses_as_well_as_the_planted_linkage_does(independent: ModuleType) -> None:
    state = solve_position(PLANTED, np.linspace(0.5, 3, 6))
    rng = np.random.default_rng(1)
    task = MotionTask(state.p + rng.normal(0, 0.5, (6, 2)), state.theta3 + rng.normal(0, 0.01, 6))
    problem = Problem(
        task=task, requirements=Requirements(**LIMITS, link_length=(30, 130), o4=Box(y=(-5, 5)))
    )
    planted = verify(PLANTED, problem.task, problem.requirements)
    found = independent.search(problem, starts=100)
    assert planted.ok
    assert found.verdict.ok
    assert found.error <= np.sqrt(planted.square / 6)


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


def test_limits_that_no_linkage_holds_have_no_design(independent: ModuleType) -> None:
    wanted = Requirements(**LIMITS, r2=(100, 200), r1=(10, 50))  # no crank-rocker
    assert independent.search(Problem(task=closed_path(0.0), requirements=wanted), starts=3) is None


@pytest.mark.slow
def test_it_shares_nothing_with_the_search_of_the_package() -> None:
    told = "import sys, independent_search; print([m for m in sys.modules if 'synth' in m or 'casadi' in m])"
    command = [sys.executable, "-c", told]
    done = subprocess.run(
        command, cwd=ROOT / "scripts" / "benchmarks", check=True, capture_output=True, text=True
    )
    assert done.stdout == "[]\n"


@pytest.mark.quick("limited.json")
@pytest.mark.parametrize("file", ["limited.json", "limited_random.json"])
def test_best_designs_known_are_accepted_and_as_good_as_said(file: str) -> None:
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
def test_benchmark_measures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(ROOT / "scripts" / "benchmarks")
    benchmark = importlib.import_module("benchmark_limited")
    monkeypatch.setattr(benchmark, "synthesize", partial(benchmark.synthesize, effort=0.2))
    assert benchmark.main(["--seeds", "0", "--random", "1"]) == 0
    assert "1 random tasks: " in capsys.readouterr().out
