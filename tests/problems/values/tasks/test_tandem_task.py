"""Two outputs from one crank: stated, written and read back; impossible ones are refused in a line."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from refusals import message, problem, rows

from grashof.problems import LinkSwing, Objective, Problem, ProblemError, Requirements, TandemTask, load
from grashof.problems.files.problem_writing import problem_toml

WIPER = TandemTask([LinkSwing.from_degrees(link=6, swing_deg=85, time_ratio=1.1), LinkSwing(4, np.pi / 2)])


def test_outputs_are_kept_in_the_order_of_links() -> None:
    assert [each.link for each in WIPER.strokes] == [4, 6]
    np.testing.assert_allclose(np.degrees(WIPER.swings), [90, 85], rtol=1e-14)
    assert WIPER.time_ratios == (None, 1.1)
    assert (len(WIPER), WIPER.closed, WIPER.scale_free, WIPER.at_limits) == (2, True, True, False)
    assert Problem(task=WIPER).mechanism == Problem(task=WIPER, mechanism="six-bar").mechanism == ("watt-2",)


def test_pivots_give_the_size() -> None:
    there: dict[str, Any] = {"o2": [3, 0], "o4": [0, 4], "d": [50, 0]}
    text = 'kind = "stroke"\n[[stroke]]\nlink = 4\nswing_deg = 90\n[[stroke]]\nlink = 6\nswing_deg = 85\n'
    given = problem(text + "[requirements]\n" + "\n".join(f"{key} = {at}" for key, at in there.items()))
    assert given.task.size == 5
    assert given.requirements.d is not None
    assert given.requirements.d.x == (50, 50)


def test_a_file_keeps_it(tmp_path: Any) -> None:
    weights = Objective(transmission=0, output_acceleration_max=1, synchrony_error=0.5)
    stated = Problem(task=WIPER, requirements=Requirements(synchrony_error=(0, 0.2)), objective=weights)
    (file := tmp_path / "wiper.toml").write_text(problem_toml(stated))
    read = load(str(file))
    assert isinstance(read.task, TandemTask)
    assert read.task.strokes == WIPER.strokes
    assert (read.requirements, read.objective) == (stated.requirements, weights)


TWO = "[[stroke]]\nlink = 4\nswing_deg = 90\n[[stroke]]\nlink = 6\nswing_deg = 85\n"
ONE = "[[stroke]]\nlink = 4\nswing_deg = 90\n"
SECOND = "[[stroke]]\nlink = 6\n"
BAD = """
<ONE> | stroke has 1 table [[stroke]]; it must have two, of links 4 and 6, or be one table [stroke]
<TWO><ONE> | stroke has 3 tables [[stroke]]; it must have two, of links 4 and 6, or be one table [stroke]
<ONE><ONE> | stroke has link 4 twice; it must have one table for link 4 and one for link 6
<ONE>[[stroke]]\\nlink = 5\\nswing_deg = 85 | stroke[1].link is 5; it must be 4 or 6, the links that swing
<ONE>[[stroke]]\\nlink = true\\nswing_deg = 85 | stroke[1].link is true; it must be a whole number
<ONE><SECOND>swing_deg = 0 | stroke[1].swing_deg is 0; it must be from 0.0573 to less than 180, as a
    rocker swings
<ONE><SECOND>swing_deg = 180 | stroke[1].swing_deg is 180; it must be from 0.0573 to less than 180, as a
    rocker swings
<ONE><SECOND>swing_deg = nan | stroke[1].swing_deg is nan; it must be a finite number
<ONE><SECOND>stroke = 80 | stroke[1].stroke is of a slide; links 4 and 6 of two outputs have a swing,
    swing_deg
<ONE><SECOND>swing = 80 | stroke[1].swing is unknown; did you mean swing_deg?*
<ONE><SECOND>time_ratio = 1.1 | stroke[1].swing_deg is missing
<ONE><SECOND>swing_deg = 80\\ntime_ratio = 0.9 | stroke[1].time_ratio is 0.9; it must be at least 1, the
    slow stroke over the quick one
<ONE><SECOND>swing_deg = 80\\ntime_ratio = 7.1 | stroke.time_ratio of link 6 is 7.1; it must be below 7
stroke = 3 | stroke is 3; it must be a table [stroke], or two tables [[stroke]]
[stroke]\\nlink = 4\\nswing_deg = 80\\ntime_ratio = 1 | stroke.link is unknown; it goes into tables
    [[stroke]]
mechanism = "four-bar"\\n<TWO> | mechanism is four-bar; of kind = "stroke" with two outputs it must be watt-2
mechanism = ["watt-2", "stephenson-3"]\\n<TWO> | mechanism is stephenson-3; of kind = "stroke" with two
    outputs it must be watt-2
<TWO>[requirements]\\nexact = false | requirements.exact is false; with stroke it must be true: the swings
    are always met
<TWO>[requirements]\\nrotatability = "double-crank" | requirements.rotatability is "double-crank", whose
    output does not swing; with stroke it must be full-crank or crank-rocker
<TWO>[requirements]\\ncoupler_arms = [0, 3] | requirements.coupler_arms does not apply to a stroke; remove it
<TWO>[driver]\\ncylinder = {} | driver.cylinder does not go with stroke, whose driver turns all round
<TWO>[objective]\\nmaximise = "swing_4" | objective.maximise is 'swing_4'; it must be *
"""


@pytest.mark.parametrize(("text", "line"), rows(BAD, ONE=ONE, TWO=TWO, SECOND=SECOND))
def test_impossible_outputs_are_refused(text: str, line: str) -> None:
    said = message(f'kind = "stroke"\n{text}')
    assert said.startswith(line.removesuffix("*")) if line.endswith("*") else said == line


def test_quantities_of_two_outputs_need_two() -> None:
    one = 'kind = "stroke"\n[stroke]\nswing_deg = 80\ntime_ratio = 1\n[requirements]\n'
    assert message(one + "synchrony_error = [0, 1]") == (
        "stroke states no two outputs; two tables [[stroke]] do; requirements.synchrony_error needs it"
    )
    place = 'kind = "dwell"\n[dwell]\ndwell_deg = 60\nswing_deg = 30\n[requirements]\nd = [0, 0]\n'
    assert message(place) == "requirements.d does not apply to a dwell; remove it"
    assert message(one + "d = [0, 0]").startswith("requirements.d does not go with mechanism four-bar; only ")


def test_in_python_too() -> None:
    with pytest.raises(ProblemError, match=r"^link is 5; it must be 4 or 6, the links that swing$"):
        LinkSwing(5, 1.0)
    with pytest.raises(ProblemError, match=r"^stroke has link 6 twice; "):
        TandemTask([replace(WIPER.strokes[1]), WIPER.strokes[1]])
    with pytest.raises(ProblemError, match=r"^stroke has 0 tables "):
        TandemTask([])
    with pytest.raises(
        ProblemError, match=r"^stroke is \[4, 6\]; it must be two LinkSwing, of links 4 and 6$"
    ):
        TandemTask([4, 6])  # type: ignore[list-item]
