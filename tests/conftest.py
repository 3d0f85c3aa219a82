"""Settings of every test, and small searches for tests of anything but the best designs."""

import gc
import os
from collections.abc import Callable, Generator
from importlib import import_module
from typing import Any

# The tests run in one process a core: threads of NumPy's own would only compete.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest
from hypothesis import settings

# The same examples each time, and no limit of time: machines differ, and are busy.
# `HYPOTHESIS_PROFILE=thorough pytest` tries several times as many, and others each time.
settings.register_profile("here", derandomize=True, deadline=None, max_examples=25)
settings.register_profile("thorough", deadline=None, max_examples=200)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "here"))

# How finely curves are traced, how many pairs are judged, rounds gone through, starts solved.
SMALL: dict[str, dict[str, Any]] = {
    "grashof.synth.starts.exact_poses": {
        "LINES": 300, "CELL": 0.02, "PAIRS": 200_000, "SAMPLED_PAIRS": 50_000, "NEAR_PAIRS": 30_000,
    },
    "grashof.synth.starts.precision_points": {"BARREN": 2, "SEARCHES": 1},
    "grashof.synth.results.relaxations": {"SOLVES": 2},
    "grashof.synth.results.choice": {"SEEDS": 4},
    "grashof.synth.results.explain": {"NEAR_EFFORT": 0.2},
}  # fmt: skip


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Without the garbage collector, which would go through all modules and tests so far many times."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Studies are slow; cases that a `quick` test does not name are studies; tests in a browser are extra."""
    known: dict[str, set[str]] = {}
    named: dict[str, set[str]] = {}
    for item in items:
        if item.get_closest_marker("study"):
            item.add_marker(pytest.mark.slow)
        if "browser" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.extra)
        test, _, case = item.nodeid.removesuffix("]").partition("[")
        for mark in item.iter_markers("quick"):
            known.setdefault(test, set()).add(case)
            named[test] = set(mark.args)
            if case and case not in mark.args:  # it repeats what those do
                item.add_marker(pytest.mark.slow)
                item.add_marker(pytest.mark.study)
    for test, cases in known.items():
        if len(cases) > 1 and not named[test] <= cases:  # not where one case alone is collected
            raise pytest.UsageError(f"{test}: no cases {named[test] - cases}, which `quick` names")


@pytest.fixture
def small_search(monkeypatch: pytest.MonkeyPatch) -> None:
    """Searches and explanations several times as fast."""
    for module, sizes in SMALL.items():
        for name, size in sizes.items():
            monkeypatch.setattr(import_module(module), name, size)


@pytest.fixture
def relaxing_only(monkeypatch: pytest.MonkeyPatch, small_search: None) -> Callable[..., None]:
    """Small explanations that look at some requirements alone: each takes a search of its own."""

    def of(*keys: str) -> None:
        module = import_module("grashof.synth.results.relaxations")
        monkeypatch.setattr(module, "limiting", lambda *_: list(keys))

    return of
