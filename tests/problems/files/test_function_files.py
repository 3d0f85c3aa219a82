import tomllib
from typing import Any

import numpy as np
import pytest
from refusals import message, rows

from grashof.problems import FunctionTask
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.files.problem_writing import problem_toml

PAIRS = {"input_deg": [0, 20, 45, 90], "output_deg": [0, 12, 31, 80]}
TRAVEL = {"input_deg": [0, 20, 45, 90], "output": [0, 3.1, 9, 20]}
RANGES = {"x": [1, 4], "input_range_deg": 90, "output_range_deg": 90}
LAW = {**RANGES, "law": "power", "exponent": 1.5}
LENGTHS = {"input": [0, 20.5, 41, 60], "output_deg": [0, 12, 31, 80]}


@pytest.mark.parametrize(
    "table",
    [
        {**PAIRS, "sense": "either", "norm": "max"},
        {**PAIRS, "link": "coupler"},
        {**PAIRS, "mirror_deg": 45.0, "norm": "max"},
        {**LAW, "pairs": 7, "mirror_deg": 30.0},
        {**LAW, "pairs": 5, "link": "coupler"},
        LAW,
        {**LAW, "pairs": 5},
        {**RANGES, "law": "sampled", "sampled": [0.0, 1.0, 3.0, 4.0, 6.0]},
        {**TRAVEL, "norm": "max"},
        {"law": "exp", "x": [0, 1], "input_range_deg": 60, "output_range": 80.0},
        {**LENGTHS, "rate": [[0.0, 0.25, 0.75], [55.0, 0.5, 0.5]]},
        {**LENGTHS, "link": "coupler", "sense": "either"},
        {"input": [0, 20, 45, 90], "output": [0, 3.1, 9, 20]},
        {**PAIRS, "rate": [[90.0, -1.5, 2.5]]},
    ],
)
def test_functions_come_back(table: dict[str, Any]) -> None:
    slides = "output" in table or "output_range" in table
    errors = [f"structural_error_{key}{'' if slides else '_deg'}" for key in ("max", "rms")]
    document: dict[str, Any] = {"kind": "function", "function": table}
    document["requirements"] = {errors[0]: [0, 2], errors[1]: [0, 1]}
    if "input" in table:
        document["driver"] = {"cylinder": {"ratio_max": 1.7}}
    if slides:
        document["mechanism"] = "slider-crank"
    if slides and "law" not in table:
        document["objective"] = {"maximise": {errors[0]: 1.0}}
    problem = problem_from(document, "a")
    again = problem_from(tomllib.loads(problem_toml(problem)), "a")
    assert isinstance(problem.task, FunctionTask)
    assert isinstance(again.task, FunctionTask)
    assert again.task.travels == slides
    assert again.task.lengthens == ("input" in table)
    assert np.array_equal(np.ravel(again.task.rates), np.ravel(problem.task.rates))
    assert again.task.link == problem.task.link == table.get("link", "output")
    assert np.array_equal(again.task.inputs, problem.task.inputs)
    assert np.array_equal(again.task.outputs, problem.task.outputs)
    assert again.requirements == problem.requirements
    assert problem_toml(again) == problem_toml(problem)
    if slides:
        assert [goal.column for goal, _ in problem.goals][-1:] != ["structural_error_max_deg"]


# Files of pairs, of laws and of travels, and lines added below or above.
TEXTS = {
    "PAIRS": "[function]\ninput_deg = [0, 20, 45, 90]\noutput_deg = [0, 12, 31, 80]\n",
    "LAW": '[function]\nlaw = "exp"\nx = [0, 1]\ninput_range_deg = 9\n',
    "INPUT": "[function]\ninput_deg = [0, 20, 45, 90]\n",
    "SLIDER": 'mechanism = "slider-crank"\n',
    "LENGTHS": "[function]\noutput_deg = [0, 62, 150]\ninput = [0, 150, 300]\n",
    "DRIVER": "[driver]\ncylinder = {}\n",
}
BAD = r"""
<INPUT>output = [0, 3.1, 9, 20] |
    function.output is a travel, which mechanism four-bar does not generate; it goes with slider-crank
mechanism = ["slider-crank", "inverted-slider-crank"]\n<INPUT>output = [0, 3.1, 9, 20] |
    function.output is a travel, which mechanism inverted-slider-crank does not generate;
    it goes with slider-crank
<SLIDER><PAIRS>output = [0, 1, 2, 3] | function.output_deg does not go with function.output;
    an output turns or slides, give one of them
<SLIDER><LAW>output_range_deg = 90\noutput_range = 3 |
    function.output_range_deg does not go with function.output_range;
    an output turns or slides, give one of them
<SLIDER><INPUT>output = [0, 3.1, 9, 20]\n[requirements]\nstructural_error_max_deg = [0, 1] |
    function has an output that slides, not one that turns;
    requirements.structural_error_max_deg needs it
mechanism = "four-bar"\n<PAIRS>[requirements]\nstructural_error_max = [0, 1] |
    requirements.structural_error_max does not go with mechanism four-bar; only slider-crank has it\n
    function has an output that turns, not one that slides; requirements.structural_error_max needs it
<SLIDER><INPUT>output = [0, 1, 2] |
    function.input_deg has 4 angles, function.output 3 travels; it must be as many
<SLIDER><INPUT>output = [0, 0, 0, 0] | function.output does not move; the slide must travel
<SLIDER><LAW>output_range = -8 | function.output_range is -8; it must be a number greater than zero
<SLIDER><LAW> | function.output_range_deg is missing
[function] | function.input_deg is missing\nfunction.output_deg is missing
<PAIRS>law = "sin" | function.input_deg does not go with function.law; give pairs or a law
<PAIRS>pairs = 5 | function.pairs goes with function.law only
<PAIRS>[requirements]\ncoupler_arms = [1, 2] |
    requirements.coupler_arms does not apply to a function; remove it
<PAIRS>[requirements]\na_on_body = [0, 0] | function has no angles; requirements.a_on_body needs it
<PAIRS>[requirements]\norder = false | requirements.order is false; it must be true for a function
<PAIRS>[requirements]\nkeep_out = [[[0, 0], [1, 0], [1, 1]]]\nkeep_out_for = ["p"] |
    requirements.keep_out_for has p, which does not apply to a function; remove it
<PAIRS>[objective]\nmaximise = "coupler_fit_r2" |
    objective.maximise.coupler_fit_r2 does not apply to a function; remove it
mechanism = ["four-bar", "slider-crank"]\n<PAIRS> |
    function.output_deg is a rotation, which mechanism slider-crank does not generate;
    it goes with four-bar, inverted-slider-crank, stephenson-3, stephenson-1, watt-1 and watt-2
<PAIRS>link = "rocker" | function.link is 'rocker'; it must be one of output, coupler
<PAIRS>link = 3 | function.link is 3; it must be a string
<SLIDER><INPUT>output = [0, 1, 2, 3]\nlink = "coupler" |
    function.link is "coupler", which turns; with a travel of a slide it must be "output"
<SLIDER><LAW>output_range = 80\nlink = "coupler" |
    function.link is "coupler", which turns; with a travel of a slide it must be "output"
<SLIDER><PAIRS>link = "coupler" |
    function.link is "coupler"; mechanism must be four-bar or inverted-slider-crank
mechanism = "six-bar"\n<PAIRS>link = "coupler" |
    function.link is "coupler"; mechanism must be four-bar or inverted-slider-crank
mechanism = ["four-bar", "slider-crank", "watt-1"]\n<PAIRS>link = "coupler" |
    function.link is "coupler"; mechanism must be four-bar or inverted-slider-crank
<PAIRS>[driver]\ncylinder = {}\n[requirements]\nrotatability = "crank-rocker" |
    requirements.rotatability is crank-rocker; it must be any with driver.cylinder, which turns nothing fully
<LENGTHS> | driver.cylinder is missing; function.input, its lengthening, needs it
<LENGTHS>input_deg = [0, 10, 20]\n<DRIVER> | function.input_deg does not go with function.input;
    an input is an angle or the length of a cylinder, give one of them
<LENGTHS>law = "sin"\n<DRIVER> | function.input does not go with function.law; give pairs or a law
[function]\ninput = [0, 150]\noutput_deg = [0, 62, 150]\n<DRIVER> |
    function.input has 2 lengths, function.output_deg 3 angles; it must be as many
[function]\ninput = [5, 150, 300]\noutput_deg = [0, 62, 150]\n<DRIVER> |
    function.input[0] is 5; it must be 0, at the first pair
[function]\ninput = [0, -150, -300]\noutput_deg = [0, 62, 150]\n<DRIVER> |
    function.input[1] is -150 after 0; list the pairs from the shortest cylinder to the longest
[function]\ninput = 3\noutput_deg = [0, 62, 150]\n<DRIVER> | function.input is 3; it must be a list of lengths
<LENGTHS>[driver]\ncylinder = { on = ["coupler"] } |
    driver.cylinder.on is ['coupler']; with function.input it must have driver, link 2
<LENGTHS>[driver]\ncylinder = { closed = [10, 400] } |
    driver.cylinder.closed is up to 400; it must reach 500 for a stroke of 300 with ratio_max 1.6
<LENGTHS><DRIVER>[requirements]\ntheta2_start_deg = 10 |
    requirements.theta2_start_deg does not go with function.input, which leaves link 2 free
mechanism = "watt-1"\n<LENGTHS><DRIVER> | mechanism is watt-1; with function.input, a cylinder's length,
    it must be four-bar, slider-crank or inverted-slider-crank
<LENGTHS>rate = 3\n<DRIVER> | function.rate is 3; it must be a list of rows [input, lo, hi]
<LENGTHS>rate = [[0, 1]]\n<DRIVER> | function.rate[0] is [0.0, 1.0]; it must be [input, lo, hi]
<LENGTHS>rate = [[310, 1, 2]]\n<DRIVER> |
    function.rate[0] is at 310; it must be within the inputs, 0 to 300
<PAIRS>rate = [[0, 2, 3], [91, 1, 2]] | function.rate[1] is at 91; it must be within the inputs, 0 to 90
<LENGTHS>rate = [[0, 2, 1]]\n<DRIVER> |
    function.rate[0] allows [2, 1]: lo exceeds hi; it must have lo <= hi
<PAIRS>[requirements]\ncylinder_rate = [1, 2] |
    driver.cylinder is missing; requirements.cylinder_rate needs it
"""


@pytest.mark.parametrize(("text", "said"), rows(BAD, **TEXTS))
def test_bad_files_get_lines(text: str, said: str) -> None:
    assert message(f'kind = "function"\n{text}') == said
