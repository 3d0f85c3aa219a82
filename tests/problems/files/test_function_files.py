import tomllib
from typing import Any

import numpy as np
import pytest

from grashof.problems import ProblemError
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml

PAIRS = {"input_deg": [0, 20, 45, 90], "output_deg": [0, 12, 31, 80]}
BESIDE = "function.input_deg does not go with function.law; give pairs or a law"
UNKNOWN = "function.input_dg is unknown; did you mean input_deg?"
CORNERS = [[0, 0], [1, 0], [1, 1]]
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
