"""Values written as JSON come back to the last bit."""

import json
from dataclasses import replace

import numpy as np
import pytest

from grashof import load
from grashof.analysis.judge.planted import planted_path
from grashof.problems import Problem
from grashof.problems.values.linkages.mechanism import MECHANISMS
from grashof.synth import Candidate, Result
from grashof.synth.designs.table import to_frame
from grashof.synth.programme.second_loop import SecondLoop
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.search.attempt import Attempt, attempt
from grashof.synth.search.finder import finder_for
from grashof.synth.search.plain import plain, restored


def back(value: object, name: str = "luggage") -> object:
    return restored(json.loads(json.dumps(plain(value))), load(name))


@pytest.mark.parametrize(
    "value",
    [None, True, 3, -0.0, 1e-308, "text", (1, (2.5, "a")), [1, 2], {"a": 1, 2: (3,)}, 1 - 2j, float("inf")],
)
def test_values_come_back(value: object) -> None:
    assert repr(back(value)) == repr(value)


@pytest.mark.parametrize("dtype", [np.float64, np.float32, np.int64, np.bool_, np.complex128])
@pytest.mark.parametrize("shape", [(), (0,), (3,), (2, 2)])
def test_arrays_come_back(dtype: type, shape: tuple[int, ...]) -> None:
    numbers = np.random.default_rng(0).normal(size=(2, *shape))
    array = np.asarray(numbers[0] + (1j * numbers[1] if dtype is np.complex128 else 0)).astype(dtype)
    found = back(array)
    assert isinstance(found, np.ndarray)
    assert (found.dtype, found.shape) == (array.dtype, array.shape)
    assert found.tobytes() == array.tobytes()
    assert not found.flags.writeable


def test_a_scalar_is_not_an_array() -> None:
    assert type(back(np.float64(0.1))) is np.float64


def test_designs_come_back(luggage_result: Result) -> None:
    some = luggage_result.candidates[:5]
    found = back(tuple(Attempt("Solve_Succeeded", each) for each in some))
    again = tuple(one.candidate for one in found)  # type: ignore[attr-defined]
    assert all(isinstance(each, Candidate) for each in again)
    problem = luggage_result.problem
    assert to_frame(problem, again).to_csv() == to_frame(problem, some).to_csv()


@pytest.mark.parametrize("name", ["luggage", "path-ellipse"])
def test_rounds_come_back(name: str) -> None:
    scaled = ScaledProblem.of(load(name))
    made = finder_for(scaled).round(0, 5, np.random.default_rng(0), 1)
    assert repr(back(made, name)) == repr(made)


@pytest.mark.parametrize(
    "text",
    [
        '{"eval": ["1"]}',
        '{"array": ["O", [1], [1]]}',
        '{"Start": {}}',
        '{"word": ["os", 1]}',
        '{"a": 1, "b": 2}',
        '{"Chunk": []}',
        '{"Tally": {"found": {"counter": [[1, "two"]]}}}',
        '{"array": ["<i8", [1], [1e999]]}',
        '{"array": ["<i8", [1], [99999999999999999999]]}',
        '{"Attempt": {"status": 1, "candidate": null, "cognates": []}}',
        "[" * 900 + "]" * 900,
    ],
)
def test_malformed_values_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match="no plain form"):
        restored(json.loads(text), load("luggage"))


@pytest.mark.parametrize("mechanism", ["slider-crank", "inverted-slider-crank"])
def test_searches_of_slider_kinds_come_back(mechanism: str) -> None:
    task, _ = planted_path(np.random.default_rng([1, 1]), 4, timed=True, mechanism=mechanism)
    problem = Problem(task=task, mechanism=mechanism)
    scaled = ScaledProblem.of(problem)
    made = finder_for(scaled).round(0, 2, np.random.default_rng(0), 1)
    assert made is not None
    assert restored(json.loads(json.dumps(plain(made.starts))), problem) == made.starts
    one = attempt(scaled, made.starts[0], 0)
    again = restored(json.loads(json.dumps(plain(one))), problem)
    assert json.dumps(plain(again)) == json.dumps(plain(one))
    assert again.candidate.linkage == one.candidate.linkage


def test_second_loops_of_six_bars_come_back() -> None:
    row = replace(next(row for row in MECHANISMS if row.word == "stephenson-3"), carries=6)
    loop = SecondLoop(row, 0.5 + 1j, 2 - 1j, (1.5, 2.5), 0.25j, -1, (0.1, 0.2, np.pi))
    assert back(loop) == loop
