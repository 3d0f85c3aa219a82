import tomllib
from typing import Any

import numpy as np
import pytest
from refusals import refusal

from grashof.problems import FunctionTask, ProblemError
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml

PAIRS = {"input_deg": [0, 20, 45, 90], "output_deg": [0, 12, 31, 80]}
BESIDE = "function.input_deg does not go with function.law; give pairs or a law"
UNKNOWN = "function.input_dg is unknown; did you mean input_deg?"
CORNERS = [[0, 0], [1, 0], [1, 1]]
TRAVEL = {"input_deg": [0, 20, 45, 90], "output": [0, 3.1, 9, 20]}
LAW = {"law": "power", "exponent": 1.5, "x": [1, 4], "input_range_deg": 90, "output_range_deg": 90}


@pytest.mark.parametrize(
    "table",
    [
        {**PAIRS, "sense": "either", "norm": "max"},
        LAW,
        {**LAW, "pairs": 5},
        {**LAW, "law": "sampled", "exponent": None, "sampled": [0.0, 1.0, 3.0, 4.0, 6.0]},
    ],
)
def test_what_is_written_comes_back(table: dict[str, Any]) -> None:
    table = {key: value for key, value in table.items() if value is not None}
    wanted = {"structural_error_max_deg": [0, 2], "structural_error_rms_deg": [0, 1]}
    document = {"kind": "function", "function": table, "requirements": wanted}
    problem = problem_from(document, "a")
    again = problem_from(tomllib.loads(problem_toml(problem)), "a")
    assert np.array_equal(again.task.inputs, problem.task.inputs)  # type: ignore[attr-defined]
    assert np.array_equal(again.task.outputs, problem.task.outputs)
    assert again.requirements == problem.requirements
    assert problem_toml(again) == problem_toml(problem)


@pytest.mark.parametrize(
    "table",
    [
        {**TRAVEL, "norm": "max"},
        {"law": "exp", "x": [0, 1], "input_range_deg": 60, "output_range": 80.0},
        {
            "law": "sampled",
            "x": [0, 1],
            "sampled": [0, 1, 3, 4.0],
            "input_range_deg": 60,
            "output_range": 1e-3,
        },
    ],
)
def test_what_is_written_of_a_slide_comes_back(table: dict[str, Any]) -> None:
    wanted = {"structural_error_max": [0, 2], "structural_error_rms": [0, 1]}
    document = {
        "kind": "function", "mechanism": "slider-crank", "function": table, "requirements": wanted,
        "objective": {"maximise": {"structural_error_max": 1.0}},
    }  # fmt: skip
    if "law" in table:
        del document["objective"]
    problem = problem_from(document, "a")
    again = problem_from(tomllib.loads(problem_toml(problem)), "a")
    assert isinstance(again.task, FunctionTask)
    assert again.task.travels
    assert np.array_equal(again.task.outputs, problem.task.outputs)
    assert again.requirements == problem.requirements
    assert problem_toml(again) == problem_toml(problem)
    assert [goal.column for goal, _ in problem.goals][-1:] != ["structural_error_max_deg"]


SLIDER = {"mechanism": "slider-crank"}


@pytest.mark.parametrize(
    ("document", "message"),
    [
        (
            {"function": TRAVEL},
            "function.output is a travel, which mechanism four-bar does not put out; "
            "it goes with slider-crank",
        ),
        (
            {"function": TRAVEL, "mechanism": ["slider-crank", "inverted-slider-crank"]},
            "function.output is a travel, which mechanism inverted-slider-crank does not put out; "
            "it goes with slider-crank",
        ),
        (
            {"function": {**PAIRS, "output": [0, 1, 2, 3]}, **SLIDER},
            "function.output_deg does not go with function.output; an output turns or slides, "
            "give one of them",
        ),
        (
            {"function": {**LAW, "output_range": 3}, **SLIDER},
            "function.output_range_deg does not go with function.output_range; an output turns or slides, "
            "give one of them",
        ),
        (
            {"function": TRAVEL, **SLIDER, "requirements": {"structural_error_max_deg": [0, 1]}},
            "function has an output that slides, not one that turns; "
            "requirements.structural_error_max_deg needs it",
        ),
        (
            {"function": PAIRS, "requirements": {"structural_error_max": [0, 1]}, "mechanism": "four-bar"},
            "requirements.structural_error_max does not go with mechanism four-bar; "
            "only slider-crank has it\n"
            "function has an output that turns, not one that slides; "
            "requirements.structural_error_max needs it",
        ),
        (
            {"function": {**TRAVEL, "output": [0, 1, 2]}, **SLIDER},
            "function.input_deg has 4 angles, function.output 3 travels; it must be as many",
        ),
        (
            {"function": {**TRAVEL, "output": [0, 0, 0, 0]}, **SLIDER},
            "function.output does not move; the slide must travel",
        ),
        (
            {"function": {**TRAVEL, "output": [1, 2, 3, 4]}, **SLIDER},
            "function.output[0] is 1; it must be 0, at the first pair",
        ),
        (
            {"function": {**TRAVEL, "output": 3}, **SLIDER},
            "function.output is 3; it must be a list of lengths",
        ),
        (
            {"function": {"law": "exp", "x": [0, 1], "input_range_deg": 9, "output_range": -8}, **SLIDER},
            "function.output_range is -8; it must be a number greater than zero",
        ),
        (
            {"function": {"law": "exp", "x": [0, 1], "input_range_deg": 9}, **SLIDER},
            "function.output_range_deg is missing",
        ),
    ],
)
def test_bad_files_of_slides_get_lines(document: dict[str, Any], message: str) -> None:
    assert refusal(problem_from, {"kind": "function", **document}, "a") == message


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ({"function": {}}, "function.input_deg is missing\nfunction.output_deg is missing"),
        (
            {"function": {**PAIRS, "law": "sin"}},
            "function.input_deg does not go with function.law; give pairs or a law",
        ),
        (
            {"function": {"input_dg": [0, 1, 2], **PAIRS}},
            "function.input_dg is unknown; did you mean input_deg?",
        ),
        ({"function": {**PAIRS, "pairs": 5}}, "function.pairs goes with function.law only"),
        (
            {"function": PAIRS, "requirements": {"coupler_arms": [1, 2]}},
            "requirements.coupler_arms means nothing for a function; leave it out",
        ),
        (
            {"function": PAIRS, "requirements": {"a_on_body": [0, 0]}},
            "function has no angles; requirements.a_on_body needs it",
        ),
        (
            {"function": PAIRS, "requirements": {"order": False}},
            "requirements.order is false; it must be true for a function",
        ),
        (
            {
                "function": PAIRS,
                "requirements": {"keep_out": [[[0, 0], [1, 0], [1, 1]]], "keep_out_for": ["p"]},
            },
            "requirements.keep_out_for has p, which means nothing for a function; leave it out",
        ),
        (
            {"function": PAIRS, "objective": {"maximise": "coupler_fit_r2"}},
            "objective.maximise.coupler_fit_r2 means nothing for a function; leave it out",
        ),
        (
            {"function": PAIRS, "mechanism": ["four-bar", "slider-crank"]},
            "function.output_deg is a rotation, which mechanism slider-crank does not put out; "
            "it goes with four-bar and inverted-slider-crank",
        ),
        (
            {"function": PAIRS, "driver": {"cylinder": {}}},
            "driver.cylinder does not go with function, whose driver is link 2",
        ),
        ({"function": PAIRS, "path": {"points": [[0, 0]]}}, None),
    ],
)
def test_bad_files_get_lines(document: dict[str, Any], message: str | None) -> None:
    with pytest.raises(ProblemError) as caught:
        problem_from({"kind": "function", **document}, "a")
    if message is None:
        assert 'path does not belong to kind = "function"' in str(caught.value)
    else:
        assert str(caught.value) == message


def test_a_path_has_no_structural_error() -> None:
    document = {"kind": "path", "path": {"points": [[0, 0], [1, 0], [2, 1]]}}
    with pytest.raises(ProblemError, match=r"path asks for no output; kind = \"function\" does"):
        problem_from({**document, "requirements": {"structural_error_max_deg": [0, 1]}}, "a")
