"""Regions as pages draw them: every place that a problem states, in words, where it is."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from grashof.page.regions import regions_of
from grashof.problems.files.on_disk import document_of
from grashof.problems.files.problem_schema import problem_from

STATED = """
kind = "motion"
mechanism = ["four-bar", "slider-crank"]
length_unit = "mm"
[motion]
poses = [{first}, [3, 1, 20], [5, 4, 50]]
[requirements]
o2 = [1, 2]
a = [1, 2]
o4 = {{ inside = [[0, 0], [4, 0], [1, 2]] }}
b = {{ x = [1, 2] }}
a_on_body = {{ x = [0, 2], y = [0, 1] }}
b_on_body = {{ y = [0, 1] }}
at = [
  {{ targets = [2], a = {{ on = [[0, 0], [1, 1]] }} }},
  {{ targets = [1, 3], instant_centre = {{ y = 3 }} }},
]
[dynamics]
payload = 1
[effort]
on = {{ link = "body", at = [1, 0] }}
band = [-5, 5]
parts = [{{ kind = "gas", between = [
  {{ link = 1, at = {{ inside = [[0, -1], [2, -1], [1, 0]] }} }},
  {{ link = "body", at = {{ x = [1, 2], y = 0.5 }} }},
] }}]
[driver]
cylinder = {{ base = {{ x = [0, 4], y = [-2, 0] }} }}
"""


def drawn(first: str) -> dict[str, dict[str, Any]]:
    found = regions_of(problem_from(document_of(STATED.format(first=first), "x"), "x"))
    return {each.pop("name"): each for each in found}


def test_every_region_is_drawn_once_with_its_open_sides() -> None:
    found = drawn("[0, 0, 30]")
    corners = [[0, 0], [4, 0], [1, 2]]
    assert found == {
        "O2, A region": {"x": [1, 1], "y": [2, 2]},
        "O4 region": {"x": [0, 4], "y": [0, 2], "corners": corners},
        "B region": {"x": [1, 2], "y": [None, None]},
        "A region at target 2": {"x": [0, 1], "y": [0, 1], "corners": [[0, 0], [1, 1]]},
        "instant centre region at targets 1, 3": {"x": [None, None], "y": [3, 3]},
        "A region on the body": found["A region on the body"],  # that of B has an open side
        "region of end 1 of part 1": {"x": [0, 2], "y": [-1, 0], "corners": [[0, -1], [2, -1], [1, 0]]},
        "region of end 2 of part 1": found["region of end 2 of part 1"],
        "region of the cylinder's base": {"x": [0, 4], "y": [-2, 0]},
    }


def test_regions_on_the_body_stand_where_the_first_pose_has_it() -> None:
    found = drawn("[7, -3, 30]")["A region on the body"]
    c, s = np.sqrt(3) / 2, 0.5
    expected = [[7, -3], [7 + 2 * c, -3 + 2 * s], [7 + 2 * c - s, -3 + 2 * s + c], [7 - s, -3 + c]]
    assert np.array(found["corners"]) == pytest.approx(np.array(expected))
    assert (found["x"], found["y"]) == (pytest.approx([7 - s, 7 + 2 * c]), pytest.approx([-3, -2 + c]))
    end = np.array(drawn("[7, -3, 30]")["region of end 2 of part 1"]["corners"])
    assert end[:2] == pytest.approx(np.array([[7 + u * c - 0.5 * s, -3 + u * s + 0.5 * c] for u in (1, 2)]))
    assert not {"A region on the body", "region of end 2 of part 1"} & set(drawn("{ x = 7, y = -3 }"))
    assert "A region on the body" not in drawn("{ angle = 30 }")
