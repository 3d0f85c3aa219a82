"""Study files, read and refused, and their combinations: problems as from problem files."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from refusals import refusal, rows

from grashof.problems import ProblemError, load, problem_text
from grashof.problems.files.problem_file import problem_of
from grashof.problems.files.problem_writing import problem_toml
from grashof.sweep import load_study
from grashof.sweep.combinations import combinations
from grashof.sweep.study import SearchOptions, StudyFile

Write = Callable[..., Path]


def test_lists_and_ranges(write: Write) -> None:
    study = load_study(
        write(
            'problem = "base.toml"\n[vary]\n"search.seed" = { from = 0, to = 4, steps = 3 }\n'
            '"requirements.o2.x" = { from = 0.0, to = 0.3, steps = 4 }\nrequirements.order = [true, false]\n'
        )
    )
    assert study.vary == {
        "search.seed": [0, 2, 4],
        "requirements.o2.x": [0.0, 0.1, 0.2, 0.3],
        "requirements.order": [True, False],
    }
    assert all(isinstance(seed, int) for seed in study.vary["search.seed"])
    assert study.axes == (("search.seed",), ("requirements.o2.x",), ("requirements.order",))


def test_keys_in_step_are_one_axis(write: Write) -> None:
    study = load_study(
        write('problem = "luggage"\ntogether = [["a.b", "e"]]\n[vary]\na.b = [1, 2]\nc = [1]\ne = [3, 4]\n')
    )
    assert study.axes == (("a.b", "e"), ("c",))


WRONG = rows(r"""
# | a study needs problem\nvary is missing
problem = "luggage" | vary is missing
problem = "luggage"\nproblems = "."\n[vary]\na=[1] | it must have one of them
problem = "lugage"\n[vary]\na=[1] | 'lugage' is neither a problem of the catalogue nor a file
problems = "none" | none: is not a folder
problem = "luggage"\n[vary]\na = 1 | vary.a is 1; it must be a list of values or { from
problem = "luggage"\n[vary]\na = [] | vary.a is []; it must be a list of values or { from
problem = "luggage"\n[vary]\na = {from = 1, to = 2, steps = 1} | vary.a.steps is 1; it must be
problem = "luggage"\n[vary]\na = {from = 1, to = 2, step = 1} | vary.a is {
problem = "luggage"\n[vary]\n"a b" = [1] | vary: a key is 'a b'
problem = "luggage"\n[vary]\n"a" = [1]\n"a[0]" = [1] | vary has a key and another one within it
problem = "luggage"\ntogether = [["a", "c"]]\n[vary]\na = [1]\nb = [1] |
    together[0] has c, which is not in vary
problem = "luggage"\ntogether = [["a", "b"]]\n[vary]\na = [1]\nb = [1, 2] |
    together[0] has keys with different numbers of values: a 1, b 2
problem = "luggage"\nsteps = 3\ndesigns = 0\n[search]\nseed = -1\ntime_limit = 0\n[vary]\na = [1] |
    designs is 0\nsearch.seed is -1\nsearch.time_limit is 0\nsteps is unknown
""")


@pytest.mark.parametrize(("text", "lines"), WRONG)
def test_all_that_is_wrong_is_stated(write: Write, text: str, lines: str) -> None:
    stated = refusal(load_study, write(text)).splitlines()
    for line, words in zip(stated, lines.splitlines(), strict=True):
        assert words in line


def test_the_studies_of_the_documentation(write: Write) -> None:
    root = Path(__file__).parents[3]
    section = (root / "docs" / "howto" / "sweeps.md").read_text(encoding="utf-8")
    first, full = re.findall(r"^```toml\n(.*?)^```", section, re.MULTILINE | re.DOTALL)
    assert (root / "docs" / "longer-links.toml").read_text(encoding="utf-8").endswith(first)
    assert len(combinations(load_study(write(first)))) == 25
    write(problem_text("luggage"), "mine.toml")
    study = load_study(write(full))
    made = combinations(study)
    assert len(made) == 6
    assert not any(one.wrong for one in made)
    options = {"time_limit", *SearchOptions.model_fields, *StudyFile.model_fields} - {"title"}
    assert [name for name in options if not re.search(rf"\b{name}\b", full)] == []


def test_problems_of_a_folder_are_sorted(write: Write) -> None:
    write('kind = "path"', "many/b.toml")
    write("no TOML", "many/a.toml")
    sources = load_study(write('problems = "many"')).sources
    assert [source.name for source in sources] == ["a", "b"]
    assert sources[0].wrong.startswith("a.toml: is not TOML")
    assert sources[1].document == {"kind": "path"}


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


def test_the_number_of_points_on_a_drawn_curve_varies(write: Write) -> None:
    study = write('problem = "base.toml"\n[vary]\n"path.count" = [4, 1, 8]\n')
    (study.parent / "base.toml").write_text('kind = "path"\n[path]\npoints = "ring.svg"\n')
    ring = '<svg xmlns="http://www.w3.org/2000/svg"><circle r="5"/></svg>'
    (study.parent / "ring.svg").write_text(ring)
    four, one, eight = combinations(load_study(study))
    assert one.wrong == ("path.points: count is 1; it must be a whole number from 2 to 10000",)
    for found, count in ((four, 4), (eight, 8)):
        task = problem_of(found.text, "written", "written").task  # without the drawing
        assert len(task) == count
        assert abs(np.hypot(*task.positions.T) - 5).max() < 1e-9


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
    assert refusal(combinations, load_study(write(study))).splitlines() == [
        "study: in every combination, motion.poses[7] is missing; motion.poses ends with [3]",
        "study: in every combination, requirements.transmision_min_deg is unknown; did you mean "
        "transmission_min_deg?",
    ]


def test_too_many_are_refused(write: Write) -> None:
    many = "{ from = 0, to = 1, steps = 400 }"
    study = f'problem = "luggage"\n[vary]\na = {many}\nb = {many}\n'
    with pytest.raises(ProblemError, match="has 160000 combinations; it must have at most 100000"):
        combinations(load_study(write(study)))
