"""Searches in several threads of one process: nothing crashes, and every list is the serial one."""

import gc
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import casadi as ca
import numpy as np
import pytest

from grashof import load, synthesize
from grashof.analysis.judge.design import Design, greatest
from grashof.problems import FourBar, ProblemError

# What the scripts share: searches of every kind, small ones, and what comes out of each.
SEARCHES = """
import asyncio
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import casadi as ca

from grashof import load, synthesize
from grashof.analysis import verify
from grashof.problems import ProblemError
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.programme.user_functions import refuse_unusable

sys.setswitchinterval(1e-4)
luggage = load("luggage")
short = replace(luggage, requirements=replace(luggage.requirements, link_length=(0.1, 0.2)))


def low(design):
    return ca.fmax(design.o2[1], design.o4[1]) - 1.0


def links(design):
    return design.r2 + design.r3 + ca.fmax(design.r4, design.r1)


def undecided(design):
    return 1.0 if design.r1 > 2 else 0.0


SEARCHES = {
    "poses met": (luggage, {"starts": 8}),
    "path fitted": (load("path-18-timed"), {"effort": 0.2}),
    "path with cognates": (load("path-vertical-line"), {"starts": 8}),
    "own functions": (luggage, {"starts": 8, "constraints": [low], "objective": links}),
    "none": (short, {"effort": 0.2}),
}


def found(name, **how):
    problem, options = SEARCHES[name]
    result = synthesize(problem, **options, **how)
    return result.to_frame().to_csv() + result.note + result.ended


def serial():
    return {name: found(name) for name in SEARCHES}
"""

AS_EXECUTOR = """
alone = serial()
assert "link_length up to" in alone["none"], alone["none"]
for name in SEARCHES:
    with ThreadPoolExecutor(3) as pool:
        assert found(name, executor=pool, workers=3) == alone[name], name
"""

ASYNC = """
alone = serial()
begun, stop = threading.Event(), threading.Event()


def report(_):
    begun.set()


async def searches():
    endless = asyncio.to_thread(
        synthesize, luggage, starts=100_000, enough=50_000, stop=stop.is_set, progress=report
    )
    endless = asyncio.create_task(endless)
    limited = asyncio.create_task(
        asyncio.to_thread(synthesize, luggage, starts=100_000, enough=50_000, time_limit=3.0)
    )
    texts = await asyncio.gather(*(asyncio.to_thread(found, name) for name in SEARCHES))
    assert dict(zip(SEARCHES, texts)) == alone
    await asyncio.to_thread(begun.wait, 60)
    since = time.monotonic()
    stop.set()
    stopped, late = await endless, await limited
    assert time.monotonic() - since < 20
    return stopped, late


stopped, late = asyncio.run(searches())
assert not stopped.complete and stopped.candidates
assert not late.complete and late.candidates
"""

OWN_FUNCTIONS = """
alone = serial()
design = synthesize(luggage, starts=8).best
kept = bool(low(design.linkage) <= 0)
end, wrong, checked = time.monotonic() + 10, [], [0, 0]


def judge():
    while time.monotonic() < end:
        if verify(design.linkage, luggage.task, luggage.requirements, [low]).ok is not kept:
            wrong.append("verdict")
        checked[0] += 1


def check():
    usable = ScaledProblem.of(luggage, [low], links)
    unusable = ScaledProblem.of(luggage, [undecided])
    while time.monotonic() < end:
        refuse_unusable(usable, in_processes=False)
        try:
            refuse_unusable(unusable, in_processes=False)
            wrong.append("check")
        except ProblemError:
            checked[1] += 1


def search():
    while time.monotonic() < end:
        if found("own functions") != alone["own functions"]:
            wrong.append("list")


with ThreadPoolExecutor(4) as pool:
    for done in [pool.submit(work) for work in (judge, check, search, search)]:
        done.result()
assert not wrong, wrong
assert min(checked) > 10, checked
"""

SCRIPTS = {"as executor": AS_EXECUTOR, "async": ASYNC, "own functions": OWN_FUNCTIONS}


@pytest.mark.study
@pytest.mark.parametrize("how", SCRIPTS)
def test_threads_give_the_serial_lists(how: str, tmp_path: Path) -> None:
    (tmp_path / "threads.py").write_text(SEARCHES + SCRIPTS[how], encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-X", "faulthandler", "threads.py"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=500,
        check=False,
    )
    assert done.returncode == 0, done.stderr


def test_own_functions_of_several_threads_take_turns() -> None:
    """They may use CasADi on numbers, too."""
    linkage, inside, most = FourBar((0, 0), (4, 1), 1, 3, 3.5, (2, 1)), [0], [0]
    design = Design.of(linkage, np.array([0.3]), np.array([1]))

    def slow(_: Design) -> float:
        inside[0] += 1
        most[0] = max(most[0], inside[0])
        time.sleep(0.05)
        inside[0] -= 1
        return -1.0

    with ThreadPoolExecutor(3) as pool:
        assert list(pool.map(greatest, [slow] * 3, [design] * 3)) == [-1.0] * 3
    assert most == [1]


@pytest.mark.slow
def test_an_error_of_an_own_function_keeps_no_symbols() -> None:
    """Symbols would end with the error, in whatever thread and moment it is dropped."""

    def undecided(design: Design) -> float:
        return 1.0 if design.r1 > 2 else 0.0

    def symbols() -> int:
        gc.collect()
        return sum(isinstance(each, ca.SX) for each in gc.get_objects())

    before = symbols()
    with pytest.raises(ProblemError, match="fails on symbols") as caught:
        synthesize(load("luggage"), constraints=[undecided])
    assert caught.value.__cause__ is not None
    assert symbols() == before
