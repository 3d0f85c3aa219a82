"""Proofs and enclosures in the terminal, on the page, in notebooks and in run.json; `grashof prove`."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_runs import Grashof, assert_one_line
from page_parts import RECORD

from grashof import synthesize
from grashof.analysis.judge.verdict import Enclosure
from grashof.notebook import html
from grashof.output.run_files import write_run
from grashof.output.terminal import print_table
from grashof.page.search import search_page
from grashof.problems import Problem, load
from grashof.synth import Claim, Proof, Result
from grashof.synth.proof.claims.bounds import Bounds
from grashof.synth.proof.claims.proof import proof_of
from grashof.wording.proof import bound_line, enclosure_line, enclosure_record, is_decided, proof_line

LUGGAGE = "Proven: no four-bar meets these requirements with more than 27.35 deg; number 1 has 27.33 deg."
NONE = "Proven: no four-bar meets these requirements with a transmission angle of 28.00 deg or more."


def luggage(**requirements: object) -> Problem:
    problem = load("luggage")
    return replace(problem, requirements=replace(problem.requirements, **requirements))  # type: ignore[arg-type]


def test_the_best_is_proven_and_named_by_its_rank(proven: Result) -> None:
    assert proven.proof is not None
    assert proven.proof.claim is Claim.BEST
    assert proven.proof.lower == pytest.approx(27.3325519, abs=1e-6)
    assert proof_line(proven) == LUGGAGE
    behind = replace(proven, candidates=proven.candidates[::-1])
    assert proof_line(behind).endswith(f"number {len(proven)} has 27.33 deg.")


@pytest.mark.slow
def test_none_is_proven_without_a_search_and_stated_everywhere(
    proven: Result, relaxing_only: Callable[..., None]
) -> None:
    relaxing_only()
    none = synthesize(luggage(transmission_min_deg=28))
    assert not none.candidates
    assert none.seconds["solving"] == 0
    assert none.ended == ""
    assert proof_line(none) == NONE
    for result, line in ((proven, LUGGAGE), (none, NONE)):
        assert line in search_page(result, RECORD)
        assert line in html(result)


def test_the_record_has_every_part_of_the_proof(
    grashof: Grashof, tmp_path: Path, proven: Result, few: Result, monkeypatch: pytest.MonkeyPatch
) -> None:
    given: dict[str, Any] = {}

    def found(_problem: Problem, **settings: Any) -> Result:
        given.update(settings)
        return proven

    monkeypatch.setattr("grashof.synth.synthesize", found)
    options = ("--gap", "0.5", "--prove", "--starts", "7", "--seed", "3", "--time-limit", "9")
    done = grashof("solve", "luggage", "--top", "60", "--drawings", "0", *options)
    expected = {"gap": 0.5, "prove": True, "starts": 7, "seed": 3, "time_limit": 9.0, "enough": 60}
    assert {name: given[name] for name in expected} == expected
    assert done.exit_code == 0
    assert "Proven: no four-bar" in done.stdout
    proof = json.loads((tmp_path / "luggage-designs" / "run.json").read_text())["proof"]
    assert set(proof) == {
        "claim", "complete", "quantity", "lower", "upper", "pieces", "pairs", "levels", "seconds", "left_out",
        "regions", "region_size", "rounding", "why", "mechanism",
    }  # fmt: skip
    assert (proof["claim"], proof["quantity"]) == ("best", "transmission_min_task_deg")
    assert proof["lower"] <= proof["upper"] <= proof["lower"] + 0.05
    assert (proof["left_out"], proof["why"]) == ([], "")
    write_run(tmp_path / "without", few, {}, drawings=0)
    assert json.loads((tmp_path / "without" / "run.json").read_text())["proof"] is None


@pytest.mark.parametrize(
    ("arguments", "said", "code"),
    [
        (("luggage",), LUGGAGE.replace("number 1 has", "a design has"), 0),
        (("luggage", "--at-least", "28"), NONE, 0),
        (("luggage", "--at-least", "20"), "Proven: a design that the judge accepts has 2", 0),
        (("straight-line",), "Not proven: there are proofs of three to five whole poses", 1),
    ],
)
def test_prove_decides_alone(grashof: Grashof, arguments: tuple[str, ...], said: str, code: int) -> None:
    done = grashof("prove", *arguments)
    assert done.stdout.startswith(said)
    assert done.exit_code == code


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("luggage", "--at-least", "91"), "--at-least"),
        (("luggage", "--gap", "0"), "--gap"),
        (("luggage", "--time-limit", "-1"), "time_limit is -1"),
        (("no-such-problem",), "no-such-problem"),
    ],
)
def test_prove_refuses_bad_input_in_a_line(grashof: Grashof, arguments: tuple[str, ...], said: str) -> None:
    assert_one_line(grashof("prove", *arguments), 2, said)


def a_proof(**parts: Any) -> Proof:
    return Proof(**{"claim": Claim.BOUND, "quantity": "transmission_min_task_deg", "upper": 31.0, **parts})


@pytest.mark.parametrize(
    ("proof", "line"),
    [
        (
            a_proof(lower=27.3, left_out=("size", "stroke")),
            "Proven: no four-bar has more than 31.00 deg (without size and stroke); a design has 27.30 deg.",
        ),
        (
            a_proof(why="the budget of 1000 pairs ended"),
            "Proven: no four-bar has more than 31.00 deg (the budget of 1000 pairs ended).",
        ),
        (a_proof(upper=90.0, why="it was stopped"), "Not proven (it was stopped)."),
        (
            a_proof(claim=Claim.REFUSED, upper=None, why="poses 1 and 2 are equal"),
            "Not proven: poses 1 and 2 are equal.",
        ),
        (
            a_proof(claim=Claim.FOLLOWED, lower=3.0, upper=None, why="1442 of 1442 known solutions; 1 of 1"),
            "All followed, which is no proof of all: 1442 of 1442 known solutions; 1 of 1.",
        ),
    ],
)
def test_lines_of_proofs_and_failed_proofs(proof: Proof, line: str) -> None:
    assert bound_line(proof) == line
    assert not is_decided(proof)


def test_numbers_are_rounded_to_the_safe_side() -> None:
    proof = a_proof(claim=Claim.BEST, lower=27.3399, upper=27.34001)
    assert bound_line(proof).endswith("with more than 27.35 deg; a design has 27.33 deg.")


def test_a_short_list_without_the_best_names_no_number(proven: Result) -> None:
    for listed in (proven.candidates[1:], ()):
        assert proof_line(replace(proven, candidates=listed)) == f"{LUGGAGE.partition(';')[0]}."


def test_a_best_below_the_requested_angle_decides_nothing_within_the_gap() -> None:
    proof = a_proof(claim=Claim.BEST, lower=27.3314, upper=27.3414)
    assert is_decided(proof)
    assert is_decided(proof, at_least=27.33)
    assert not is_decided(proof, at_least=27.335)


def test_designs_that_transmit_next_to_nothing_are_not_called_none() -> None:
    problem = load("luggage")
    nothing_above = Bounds(upper=float(np.radians(0.01)), closed=True)
    assert proof_of(problem, nothing_above, None, 0.01).claim is Claim.NONE
    assert proof_of(problem, nothing_above, 0.004, 0.01).claim is Claim.BEST


def test_a_best_that_equals_its_bound_is_reported_as_one_of_families() -> None:
    shaper = "inverted-slider-crank"
    proof = Proof(
        claim=Claim.BEST, quantity="", mechanism=shaper, lower=90.0, upper=90.0, pieces=(64, 0), pairs=78
    )
    line = f"Proven: no {shaper} meets these requirements with more than 90.00 deg; a design has 90.00 deg."
    assert bound_line(proof) == line


def test_designs_verified_by_intervals_are_stated(proven: Result, capsys: pytest.CaptureFixture[str]) -> None:
    line = enclosure_line(proven)
    assert line == (
        f"Closure and transmission angle of {len(proven)} designs verified by intervals of the driver angle, "
        "over their full motion."
    )
    assert line in search_page(proven, RECORD)
    print_table(proven)
    assert "intervals" not in capsys.readouterr().out
    record = enclosure_record(proven)
    assert record is not None
    assert (record["designs"], record["undecided"], record["contradicted"]) == (len(proven), {}, {})
    assert record["intervals"] == sum(each.values.enclosure.intervals for each in proven.candidates)
    empty = replace(proven, candidates=())
    assert (enclosure_line(empty), enclosure_record(empty)) == ("", None)


@pytest.mark.parametrize("contradicts", [False, True])
def test_an_undecided_design_is_named_with_its_place(
    proven: Result, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, contradicts: bool
) -> None:
    undecided = Enclosure(False, (0.1, 0.2), 7, "the box of A", contradicts)
    monkeypatch.setattr(proven.best.values, "enclosure", undecided)
    line, first = enclosure_line(proven), proven.best.id
    assert f"{first} (the box of A)" in line
    assert ("contradict the judge" in line) == contradicts
    assert (f"{len(proven) - 1} of {len(proven)} designs" in line) != contradicts
    print_table(proven)
    assert line in capsys.readouterr().out
    record = enclosure_record(proven)
    assert record is not None
    assert record["contradicted" if contradicts else "undecided"] == {first: "the box of A"}
