"""How a search runs: where, how long, in what order, with which reports."""

from collections.abc import Callable, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pandas as pd
import pytest

from grashof import load, synthesize
from grashof.analysis import verify
from grashof.problems import Box, MotionTask, Problem, ProblemError, Search, SolverError
from grashof.problems.values.text import counted
from grashof.synth import Candidate, Progress, Result
from grashof.synth.designs.ranking import ranked
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.results.explain import Explanation
from grashof.synth.results.trade_offs import Chosen
from grashof.synth.search.ledger import Ledger
from grashof.synth.search.searches import Run, nothing_to_search
from grashof.synth.search.workers import solved_there

pytestmark = pytest.mark.usefixtures("small_search")

OPTIONS: list[dict[str, Any]] = [
    {"starts": 0}, {"enough": 0}, {"seed": -1}, {"workers": 0}, {"time_limit": 0.0}, {"time_limit": -1.0},
    {"time_limit": float("nan")}, {"workers": 1.5},
]  # fmt: skip


@pytest.mark.parametrize("options", OPTIONS)
def test_options_out_of_range_are_refused(luggage: Problem, options: dict[str, Any]) -> None:
    with pytest.raises(ProblemError, match=next(iter(options))):
        synthesize(luggage, **options)


def csv_of(result: Result, folder: Path, name: str = "out.csv") -> bytes:
    result.to_csv(folder / name)
    return (folder / name).read_bytes()


@pytest.mark.slow
def test_repetition_changes_no_byte(luggage: Problem, tmp_path: Path) -> None:
    few = {"starts": 24, "enough": 40, "seed": 5}
    alone = csv_of(synthesize(luggage, **few), tmp_path)
    assert alone.count(b"\n") > 10
    assert csv_of(synthesize(luggage, **few), tmp_path) == alone
    assert csv_of(synthesize(luggage, **(few | {"seed": 6})), tmp_path) == alone  # all linkages are enclosed
    two = of_two_poses(luggage)
    drawn = [csv_of(synthesize(two, **(few | {"seed": seed})), tmp_path) for seed in (5, 5, 6)]
    assert drawn[0] == drawn[1] != drawn[2]


class Inline(Executor):
    """Runs everything at once, here, and counts the solves."""

    def __init__(self) -> None:
        self.jobs, self.closed = 0, False

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.jobs += fn is solved_there
        done: Future[Any] = Future()
        done.set_result(fn(*args, **kwargs))
        return done

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        self.closed = True


@pytest.mark.slow
def test_an_executor_does_the_work_and_stays_open(luggage: Problem, tmp_path: Path) -> None:
    executor = Inline()
    result = synthesize(luggage, starts=10, executor=executor)
    assert executor.jobs == 10
    assert not executor.closed
    assert csv_of(result, tmp_path) == csv_of(synthesize(luggage, starts=10), tmp_path)


class Broken(Executor):
    """Has lost its workers."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        raise BrokenExecutor("the scheduler is gone")


class Breaking(Inline):
    """Loses a worker in the middle of a batch."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        done = super().submit(fn, *args, **kwargs)
        if self.jobs > 3:
            done = Future()
            done.set_exception(BrokenProcessPool("a process ended abruptly"))
        return done


@pytest.mark.parametrize(
    ("executor", "why"), [(Broken(), "scheduler is gone"), (Breaking(), "ended abruptly")]
)
def test_a_lost_executor_is_an_error_of_the_surroundings(
    luggage: Problem, executor: Executor, why: str
) -> None:
    with pytest.raises(SolverError, match=why):
        synthesize(luggage, starts=10, executor=executor)


def same_designs(first: Sequence[Candidate], second: Sequence[Candidate]) -> bool:
    return [one.id for one in first] == [one.id for one in second]


@pytest.mark.slow
@pytest.mark.quick("luggage")
@pytest.mark.parametrize("name", ["luggage", "path-18-timed"])
def test_progress_has_the_designs_that_are_chosen_from(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Exact designs are all listed; of least squares a choice is made of them."""
    module, chosen_from = import_module("grashof.synth.results.conclusion"), list[tuple[Candidate, ...]]()
    choose = module.choose

    def watched(scaled: ScaledProblem, ledgers: list[Ledger], run: Run) -> Chosen:
        chosen_from.append(ledgers[-1].best)
        return choose(scaled, ledgers, run)

    monkeypatch.setattr(module, "choose", watched)
    problem, seen = load(name), list[Progress]()
    result = synthesize(problem, starts=32, effort=0.2, progress=seen.append)
    assert same_designs(seen[-1].designs, chosen_from[0])
    assert same_designs(seen[-1].designs, ranked(problem, seen[-1].designs))
    if result.problem.requirements.is_exact(problem.task):
        assert {one.id for one in seen[-1].designs} == {one.id for one in result.candidates}


@pytest.mark.slow
def test_reported_designs_of_a_stopped_search_make_a_list(luggage: Problem, tmp_path: Path) -> None:
    seen: list[Progress] = []
    stopped = synthesize(luggage, progress=seen.append, stop=lambda: len(seen) > 1)
    assert not stopped.complete
    designs = seen[1].designs
    assert len(designs) > len(seen[0].designs) == 1
    assert all(verify(one.linkage, luggage.task, luggage.requirements).ok for one in designs)
    csv_of(Result(luggage, designs), tmp_path)
    assert pd.read_csv(tmp_path / "out.csv")["id"].tolist() == [one.id for one in designs]


def test_a_design_that_a_proof_reports_is_not_lost(luggage: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the search is stopped before it has a round."""
    monkeypatch.setattr(
        import_module("grashof.synth.pipeline"),
        "searches",
        lambda scaled, run, _: nothing_to_search(scaled, run),
    )
    seen: list[Progress] = []
    stopped = synthesize(luggage, progress=seen.append, stop=lambda: bool(seen))
    assert same_designs(stopped.candidates, seen[0].designs)
    assert len(stopped) == 1


def of_two_poses(luggage: Problem) -> Problem:
    """The problem with its first two poses, so that no proof excludes designs at once."""
    task = luggage.task
    rows = np.column_stack([task.positions, np.degrees(task.angles)])[:2]
    return replace(luggage, task=MotionTask.from_degrees(rows))


def test_enough_is_enough(luggage: Problem) -> None:
    seen: list[Progress] = []
    synthesize(luggage, enough=8, progress=seen.append)
    solved, verified = [step.solved for step in seen], [step.verified for step in seen]
    assert (solved, verified) == (sorted(set(solved)), sorted(verified))
    assert solved[:3] == [0, 2, 8]  # a proof finds the first; a batch does not exceed enough
    assert verify(seen[0].designs[0].linkage, luggage.task, luggage.requirements).ok
    assert seen[-1].solved <= 16
    assert seen[-2].verified < 8 <= seen[-1].verified
    assert seen[0].starts == luggage.search.starts > 16


@pytest.mark.slow
def test_a_fruitless_search_ends(luggage: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(import_module("grashof.synth.search.ledger"), "FRUITLESS", 16)
    monkeypatch.setattr(
        import_module("grashof.synth.results.explain"), "explain", lambda *_: Explanation("none")
    )
    seen: list[Progress] = []
    far = replace(luggage.requirements, o2=Box((100, 101), (100, 101)))
    synthesize(replace(of_two_poses(luggage), requirements=far), progress=seen.append)
    assert [step.solved for step in seen] == [2, 16]
    assert seen[0].starts == luggage.search.starts > 16


@pytest.mark.parametrize("starts", [1, 17])
def test_no_more_solves_than_starts(luggage: Problem, starts: int) -> None:
    executor = Inline()
    result = synthesize(luggage, starts=starts, executor=executor)
    assert executor.jobs == starts
    solves = sum(count for name, count in result.counts.items() if name.startswith("solver: "))
    assert solves == starts
    assert (
        result.ended
        == f"the search ended after {starts} of {counted(starts, 'solve')}: starts = {starts} allows no more"
    )
    assert 1 <= len(result) <= starts
    assert {candidate.start for candidate in result.candidates} <= set(range(starts))


def test_the_problems_own_search_counts_unless_overridden(luggage: Problem) -> None:
    small = replace(luggage, search=Search(starts=3, enough=2, seed=9))
    executor = Inline()
    synthesize(small, executor=executor)
    assert executor.jobs == 3
    synthesize(small, starts=4, executor=executor)
    assert executor.jobs == 3 + 4


Options: TypeAlias = Callable[[Inline], dict[str, Any]]
ENDED: dict[str, tuple[Options, int]] = {
    "between batches": (lambda executor: {"stop": lambda: executor.jobs > 2}, 16),
    "at once": (lambda _: {"stop": lambda: True}, 2),
    "by the time limit": (lambda _: {"time_limit": 1e-6}, 2),
}


@pytest.mark.parametrize("how", ENDED)
def test_an_ended_search_lists_what_it_has_found(how: str, luggage: Problem) -> None:
    """Starts of a quick pass are tried, and no more where they give a design."""
    (options, solves), executor = ENDED[how], Inline()
    result = synthesize(luggage, executor=executor, **options(executor))
    assert executor.jobs == solves
    assert 1 <= len(result) <= solves
    assert not result.complete
    assert result.ended == f"the search ended after {solves} of 200 solves: it was stopped"


def test_stopped_after_a_quick_pass_in_vain(luggage: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    """Starts of the screening are tried, and no more."""
    monkeypatch.setattr(import_module("grashof.synth.starts.exact_poses"), "QUICK_PAIRS", 1)
    monkeypatch.setattr(import_module("grashof.synth.theory.stopping"), "GRACE", 60.0)  # on a busy machine
    executor = Inline()
    result = synthesize(luggage, stop=lambda: True, executor=executor)
    assert executor.jobs == 8
    assert 1 <= len(result) <= 8
    assert not result.complete


def test_stopped_with_nothing(luggage: Problem) -> None:
    few = replace(luggage, requirements=replace(luggage.requirements, link_length=(0.1, 0.2)))
    result = synthesize(few, stop=lambda: True)
    assert (len(result), result.complete, result.nearest) == (0, False, ())
    assert "stopped" in result.note
