"""Combinations of a study: problems as from problem files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from grashof.problems import ProblemError, load
from grashof.problems.files.problem_file import problem_of
from grashof.problems.files.problem_writing import problem_toml
from grashof.sweep import load_study
from grashof.sweep.combinations import combinations

Write = Callable[..., Path]


def test_the_full_product_with_keys_in_step(write: Write) -> None:
    text = (
        'problem = "base.toml"\ntogether = [["search.seed", "search.starts"]]\n[vary]\n'
        '"search.seed" = [1, 2]\n'
        '"path.points[0].x" = [0, 0.5, 1]\n"search.starts" = [3, 4]\n'
    )
    found = combinations(load_study(write(text)))
    values = [tuple(one.cells.values()) for one in found]
    assert list(found[0].cells) == ["search.seed", "path.points[0].x", "search.starts"]
    assert values == [(1, 0, 3), (1, 0.5, 3), (1, 1, 3), (2, 0, 4), (2, 0.5, 4), (2, 1, 4)]
    assert found[1].label == "search.seed = 1, path.points[0].x = 0.5, search.starts = 3"


def test_a_combination_is_the_problem_of_the_file_with_this_value(write: Write) -> None:
    study = (
        'problem = "luggage"\n[search]\nseed = 3\n[vary]\n"requirements.transmission_min_deg" = [15, 25]\n'
    )
    one, other = combinations(load_study(write(study)))
    by_hand = problem_toml(load("luggage")).replace("seed = 0", "seed = 3")
    assert one.text == by_hand
    assert other.text == by_hand.replace("transmission_min_deg = 15.0", "transmission_min_deg = 25.0")
    assert problem_toml(problem_of(other.text, "", other.name)) == other.text


def test_one_that_is_no_problem_does_not_end_the_others(write: Write) -> None:
    study = 'problem = "luggage"\n[vary]\n"requirements.transmission_min_deg" = [15, 95]\n'
    one, other = combinations(load_study(write(study)))
    assert one.text
    assert not one.wrong
    assert not other.text
    assert other.wrong == ("requirements.transmission_min_deg is 95; it must be from 0 to 90",)


def test_an_error_in_all_combinations_is_one_of_the_study(write: Write) -> None:
    study = (
        'problem = "luggage"\n[vary]\nrequirements.transmision_min_deg = [1, 2]\n"motion.poses[7].x" = [1]\n'
    )
    with pytest.raises(ProblemError) as refused:
        combinations(load_study(write(study)))
    assert str(refused.value).splitlines() == [
        "study: in every combination, motion.poses[7] is missing; motion.poses ends with [3]",
        "study: in every combination, requirements.transmision_min_deg is unknown; did you mean "
        "transmission_min_deg?",
    ]


def test_too_many_are_refused(write: Write) -> None:
    many = "{ from = 0, to = 1, steps = 400 }"
    study = f'problem = "luggage"\n[vary]\na = {many}\nb = {many}\n'
    with pytest.raises(ProblemError, match="has 160000 combinations; it must have at most 100000"):
        combinations(load_study(write(study)))
