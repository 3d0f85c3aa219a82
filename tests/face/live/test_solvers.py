"""Solver processes: interruptible, replaced when they are lost; the lists they report, whose keys stay."""

from __future__ import annotations

import asyncio
import json
import os
import signal
from collections.abc import Callable, Coroutine, Iterator
from io import StringIO
from multiprocessing import Pipe, current_process
from time import monotonic
from typing import Any

import ezdxf
import pytest

from grashof import load, synthesize
from grashof.live.requests import Job, Line
from grashof.live.requests import job_of as job_from
from grashof.live.solvers import GRACE, MOST_PAGES, TRIES, Sessions, Solver, Solvers, State
from grashof.live.work import ABSENT, TRACKED, Shown, lines
from grashof.problems import problem_text
from grashof.problems.files.on_disk import document_of
from grashof.synth import Result

Run = Callable[[Coroutine[Any, Any, Any]], Any]


def job_of(name: str, what: str = "search") -> Job:
    return Job(what, document_of(problem_text(name), name), name)


@pytest.fixture(scope="module")
def solvers() -> Iterator[Solvers]:
    started = Solvers()
    started.start()
    yield started
    started.end()


async def kinds(solvers: Solvers, job: Job, left: Any = lambda: False) -> list[str]:
    return [json.loads(line.text)["kind"] async for line in solvers.lines(job, left)]


@pytest.mark.study
def test_a_job_that_nobody_waits_for_ends_and_its_solver_is_used_again(solvers: Solvers, run: Run) -> None:
    async def tried() -> list[int | None]:
        since = monotonic()
        assert "done" not in await kinds(solvers, job_of("nine-points"), lambda: monotonic() > since + 1)
        assert monotonic() < since + 1.5
        assert (await kinds(solvers, job_of("luggage")))[-1] == "done"
        await asyncio.sleep(GRACE)
        assert (await kinds(solvers, job_of("luggage")))[-1] == "done"
        return [each.process.pid for each in solvers.every]

    before = [each.process.pid for each in solvers.every]
    assert run(tried()) == before


@pytest.mark.study
def test_an_idle_solver_that_is_killed_is_replaced(solvers: Solvers, run: Run) -> None:
    async def tried() -> list[str]:
        await kinds(solvers, job_of("luggage"))
        for each in solvers.every:
            os.kill(each.process.pid or 0, signal.SIGKILL)
        return await kinds(solvers, job_of("luggage"))

    assert run(tried())[-1] == "done"


@pytest.mark.study
def test_a_job_that_ends_every_solver_is_reported_in_a_line(solvers: Solvers, run: Run) -> None:
    async def killing() -> None:
        killed = 0
        while killed < TRIES:
            await asyncio.sleep(0.05)
            for each in solvers.every:
                if each.state is State.WORKING:
                    os.kill(each.process.pid or 0, signal.SIGKILL)
                    each.process.join()
                    killed += 1
                    await asyncio.sleep(0.1)

    async def tried() -> list[str]:
        killer = asyncio.ensure_future(killing())
        found = [json.loads(line.text) async for line in solvers.lines(job_of("nine-points"), lambda: False)]
        await killer
        return [line for each in found if each["kind"] == "error" for line in each["lines"]]

    assert run(tried()) == ["3 solvers were lost over this; the task is left as it is"]
    assert run(kinds(solvers, job_of("luggage")))[-1] == "done"


@pytest.mark.study
def test_the_newest_job_of_a_page_wins(solvers: Solvers, run: Run) -> None:
    session = Sessions(solvers).of("one")

    async def requested(job: Job) -> list[str]:
        return [json.loads(line)["kind"] async for line in session.lines(job)]

    async def both() -> tuple[list[str], list[str]]:
        first = asyncio.ensure_future(requested(job_of("nine-points")))
        await asyncio.sleep(0.5)
        second = await requested(job_of("luggage"))
        return await asyncio.wait_for(first, 1), second

    first, second = run(both())
    assert "done" not in first
    assert second[-1] == "done"


@pytest.mark.study
def test_pages_that_were_left_long_ago_are_forgotten() -> None:
    sessions = Sessions(Solvers())
    first = sessions.of("0")
    for number in range(MOST_PAGES):
        sessions.of(str(number))
    assert sessions.of("0") is first
    sessions.of("another")
    assert "1" not in sessions.pages
    assert "0" in sessions.pages
    assert len(sessions.pages) == MOST_PAGES


@pytest.fixture(scope="module")
def result() -> Result:
    return synthesize(load("luggage")).top(50)


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    return document_of(problem_text("luggage"), "luggage")


def lists_of(job: Job) -> tuple[list[dict[str, Any]], bytes]:
    """Lists that a job reports, and the designs of the page in the end."""
    every: list[Line] = []
    lines(job, lambda: False, every.append)
    lists = [json.loads(line.text) for line in every if line.shown is not None]
    return lists, [line.shown for line in every if line.shown is not None][-1]


def answers(job: Job) -> list[dict[str, Any]]:
    every: list[Line] = []
    lines(job, lambda: False, every.append)
    return [json.loads(line.text) for line in every]


def test_a_document_that_is_not_a_task_is_refused_line_by_line(document: dict[str, Any]) -> None:
    wrong = {**document, "motion": {"poses": [[0, 0, 0]], "bodies": 1}}
    (error, _) = answers(Job("search", wrong, "luggage"))
    assert error["kind"] == "error"
    assert any("motion.bodies is unknown" in line for line in error["lines"])
    assert len(error["lines"]) == 2


def test_a_dxf_drawing_comes_back_as_polylines(document: dict[str, Any]) -> None:
    drawing, text = ezdxf.new(), StringIO()
    drawing.modelspace().add_line((1, 2), (3, 4))
    drawing.write(text)
    (found, _) = answers(Job("outline", document, "luggage", {"text": text.getvalue()}))
    assert found["polylines"] == [[[1.0, 2.0], [3.0, 4.0]]]
    (error, _) = answers(Job("outline", document, "luggage", {"text": "no drawing"}))
    assert error["lines"][0].startswith("is not a DXF file")


def test_files_of_the_machine_are_neither_read_nor_named(document: dict[str, Any]) -> None:
    named = {**document, "dynamics": {**document["dynamics"], "loads": [{"table": "/etc/passwd"}]}}
    (error, _) = answers(Job("search", named, "luggage"))
    assert error["kind"] == "error"
    assert "root" not in json.dumps(error)
    request = {"what": "file", "document": document, "name": "../../x", "file": "problem"}
    (file, _) = answers(job_from(request))
    assert file["name"] == "x.toml"


def keys(found: dict[str, Any]) -> list[int]:
    return [design["key"] for design in found["designs"]]


@pytest.mark.slow
def test_a_design_that_comes_back_keeps_its_key(result: Result) -> None:
    designs = result.candidates
    before = Shown().matched(designs[:12], result)
    partial = before.matched(designs[3:4]).matched(designs[20:22])
    assert list(partial.designs) == [13, 14]
    after = partial.matched([designs[2], designs[20], designs[30]], result)
    assert list(after.designs) == [3, 13, 15]
    assert not after.absent
    assert list(after.matched([designs[0]]).designs) == [16]


@pytest.mark.slow
def test_lost_designs_are_named_with_their_defects_and_return(
    result: Result, document: dict[str, Any]
) -> None:
    shown = Shown().matched(result.candidates, result).written()
    strict = {**document, "requirements": {**document["requirements"], "size": [0, 5]}}
    (lost,), shown = lists_of(Job("track", strict, "luggage", shown=shown))
    assert lost["designs"] == []
    assert len(lost["lost"]) == TRACKED
    assert all("size" in each["why"] for each in lost["lost"])
    (back,), _ = lists_of(Job("track", document, "luggage", shown=shown))
    assert len(back["designs"]) == TRACKED


def test_a_solver_that_another_job_replaced_is_lost() -> None:
    ours, _theirs = Pipe()
    solver = Solver(current_process(), ours)
    ours.close()
    with pytest.raises(EOFError):
        solver.received()


@pytest.mark.slow
def test_few_that_are_absent_are_kept(result: Result) -> None:
    shown = Shown()
    for k, design in enumerate(result.candidates * 5):
        shown = Shown({k: design}, shown.absent, next_key=k + 1).matched(())
    assert len(shown.absent) == ABSENT


@pytest.mark.study
def test_designs_that_are_not_followed_keep_their_keys_too(document: dict[str, Any]) -> None:
    (*_, found), shown = lists_of(Job("search", document, "luggage"))
    assert len(keys(found)) > TRACKED
    (followed,), shown = lists_of(Job("track", document, "luggage", shown=shown))
    assert keys(followed) == keys(found)[:TRACKED]
    (*_, again), _ = lists_of(Job("search", document, "luggage", shown=shown))
    assert keys(again) == keys(found)


@pytest.mark.study
def test_the_keys_of_misses_are_not_those_of_designs_to_come(document: dict[str, Any]) -> None:
    limits = {**document.get("requirements", {}), "transmission_min_deg": 60}
    (*_, found), shown = lists_of(Job("search", {**document, "requirements": limits}, "luggage"))
    assert not found["found"]
    assert keys(found)
    (*_, again), _ = lists_of(Job("search", document, "luggage", shown=shown))
    assert again["found"]
    assert not set(keys(again)) & set(keys(found))


@pytest.mark.parametrize(
    ("name", "kind", "changed"),
    [
        ("function-five-pairs", "function", {"output_deg": [0, 12.01, 31, 55, 80.02]}),
        pytest.param("quick-return", "stroke", {"swing_deg": 80.5}, marks=pytest.mark.study),
    ],
)
def test_designs_of_functions_and_strokes_follow(name: str, kind: str, changed: dict[str, Any]) -> None:
    document = document_of(problem_text(name), name)
    (*_, found), shown = lists_of(Job("search", document, name))
    (followed,), _ = lists_of(
        Job("track", {**document, kind: {**document[kind], **changed}}, name, shown=shown)
    )
    assert keys(followed) == keys(found)[:TRACKED]
    before = {design["key"]: design["linkage"]["r2"] for design in found["designs"]}
    for design in followed["designs"]:
        assert design["linkage"]["r2"] == pytest.approx(before[design["key"]], rel=0.05)
        assert design["linkage"]["r2"] != before[design["key"]]
