"""The programme of six-bars: starts, limits that bind, goals, beside other solvers and the judge."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import least_squares

from grashof import load, synthesize
from grashof.analysis import solve_position, verify
from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.problems import (
    Box,
    PathTask,
    Problem,
    Requirements,
    Rotatability,
    SixBar,
    Task,
    TransmissionOver,
    load_linkage,
)  # fmt: skip
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import in_step
from grashof.synth.programme.nonlinear_programme import Solve
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import attempt, polished_and_judged

HOSTS = [(3, 1), (2, 4), (2, 3), (3, 4)]
WORDS = dict(zip(HOSTS, ("stephenson-3", "stephenson-1", "watt-1", "watt-1"), strict=True))
FREE: dict[str, Any] = dict.fromkeys(("link_length", "coupler_arms"), (0.0, 1e3))


def begun(task: Task, linkage: SixBar, **wanted: Any) -> tuple[ScaledProblem, Start]:
    """A problem, and a start at a linkage."""
    requirements = Requirements(**(FREE | wanted))
    scaled = ScaledProblem.of(Problem(task=task, mechanism=linkage.mechanism.word, requirements=requirements))
    return scaled, Start.of_linkage(scaled, linkage, verify(linkage, task, requirements))


def solved(task: Task, linkage: SixBar, **wanted: Any) -> Candidate:
    """The design of a solve that begins at a linkage."""
    candidate = attempt(*begun(task, linkage, **wanted), 0).candidate
    assert candidate is not None
    assert candidate.verdict.ok, candidate.verdict.defects
    return candidate


def linkage_of(hosts: tuple[int, int], link: int) -> SixBar:
    """A six-bar that turns fully, its P on a link."""
    for seed in range(50):
        _, made = planted_motion(np.random.default_rng(seed), 5, mechanism=WORDS[hosts])
        if made.mechanism.dyads[1].hosts == hosts:
            break
    given = {row.name: getattr(made, row.name) for row in made.mechanism.parameters}
    return SixBar(**given, hosts=hosts, point_link=link)


@pytest.mark.parametrize(
    ("hosts", "link"), [(hosts, 5) for hosts in HOSTS] + [(hosts, 6) for hosts in HOSTS[1:]]
)
def test_start_is_its_linkage(hosts: tuple[int, int], link: int) -> None:
    linkage = linkage_of(hosts, link)
    state = solve_position(linkage, np.linspace(0.2, 2.0, 7))
    task = PathTask(state.p)
    scaled, start = begun(task, linkage, exact=True)
    assert np.abs(start.track[2] - scaled.targets[list(start.visit)]).max() < 1e-12
    found = in_step(scaled, [polished_and_judged(scaled, start, Solve.unchanged(start, ""), 0)])[0].candidate
    assert found is not None
    assert found.verdict.ok
    for row in linkage.mechanism.parameters:
        assert np.allclose(
            getattr(found.linkage, row.name), getattr(linkage, row.name), rtol=1e-12, atol=1e-12
        )


def foot() -> tuple[PathTask, SixBar]:
    leg = load_linkage("klann")
    return PathTask(solve_position(leg, np.linspace(0, 2 * np.pi, 24, endpoint=False)).p, closed=True), leg


@pytest.mark.slow
def test_least_squares_with_a_fixed_length_as_another_solver_has_them() -> None:
    task, leg = foot()
    found = solved(task, leg, r2=(0.28, 0.28))
    assert found.linkage.r2 == pytest.approx(0.28, abs=1e-7)
    names = [
        row.name
        for row in leg.mechanism.parameters
        if row.kind != "sign" and row.name not in ("r2", "body_angle")
    ]
    sizes = [np.size(getattr(leg, name)) for name in names]

    def made(numbers: Any) -> SixBar:
        parts = np.split(numbers, np.cumsum(sizes)[:-1])
        given = {
            name: part if size > 1 else part[0] for name, part, size in zip(names, parts, sizes, strict=True)
        }
        return leg.changed(r2=0.28, **given)

    def missed(numbers: Any) -> Any:
        p = solve_position(made(numbers[len(task) :]), numbers[: len(task)]).p
        return np.nan_to_num((p - task.positions).ravel(), nan=1.0)

    start = np.concatenate([np.ravel(getattr(leg, name)) for name in names])
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    other = least_squares(missed, np.concatenate([angles, start]), xtol=1e-12, ftol=1e-12, max_nfev=300)
    rms = np.sqrt(2 * other.cost / len(task))
    assert rms > 1e-5 * task.size
    assert found.verdict.error_rms <= 1.001 * rms


@pytest.mark.quick("cycle")
@pytest.mark.parametrize("over", TransmissionOver)
def test_transmission_that_is_required_binds(over: TransmissionOver) -> None:
    task, leg = foot()
    before = verify(leg, task, Requirements(**FREE)).transmission_min_cycle
    wanted = float(np.degrees(before)) + 4
    found = solved(task, leg, transmission_min_deg=wanted, transmission_over=over)
    assert np.degrees(found.verdict.transmission_min_cycle) == pytest.approx(wanted, abs=0.02)


def test_places_and_areas_bind() -> None:
    task, leg = foot()
    (x, y), side = leg.o4, 0.02
    square = np.array(
        [[x - side, y - side], [x + side, y - side], [x + side, y + side], [x - side, y + side]]
    )
    boxed = Box((leg.o2[0] + 0.05, leg.o2[0] + 0.2), (-1.0, 2.0))
    found = solved(task, leg, keep_out=(square,), o2=boxed)
    assert found.linkage.o2[0] == pytest.approx(leg.o2[0] + 0.05, abs=1e-6)
    assert np.abs(found.linkage.o4 - leg.o4).max() >= side


@pytest.mark.parametrize(("make", "count"), [(planted_path, 9), (planted_motion, 5)])
def test_transmission_is_maximised_through_exact_targets(make: Any, count: int) -> None:
    task, linkage = make(np.random.default_rng([7, 1]), count, mechanism="stephenson-3")
    found = solved(task, linkage, exact=True)
    before = verify(linkage, task, Requirements(**FREE)).transmission_min_task
    assert np.degrees(found.verdict.transmission_min_task - before) > 10
    assert found.verdict.error_max < 1e-8 * task.size


def test_second_loop_turns_between_its_instants() -> None:
    task, leg = foot()
    found = solved(task, leg, rotatability=Rotatability.FULL_CRANK, r5=(0.5, 0.5), coupler_arms=(0.0, 1.6))
    assert found.linkage.r5 == pytest.approx(0.5, abs=1e-6)


@pytest.mark.study
def test_search_continues_from_its_best_finds() -> None:
    problem = load("klann-leg").for_kind("stephenson-3")
    best = synthesize(problem, seed=0).best
    assert best.verdict.error_rms < 1e-4 * problem.task.size  # 7e-4 without the programme
    fixed = replace(problem, requirements=replace(problem.requirements, r2=(0.3, 0.3)))
    assert synthesize(fixed, seed=0).best.linkage.r2 == pytest.approx(0.3, abs=1e-7)  # none without it
