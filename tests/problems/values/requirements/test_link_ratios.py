"""Limits of ratios of links: their values and contradictions."""

from typing import Any

import pytest

from grashof import load
from grashof.problems import Problem, ProblemError, Requirements
from grashof.problems.values.requirements.link_ratios import LinkRatios, contradictions

EXAMPLE = 'a table such as { "r3/r2" = [2, 2.5] }'
TWO = 'it must be two of r1 to r6, such as "r3/r2"'


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({}, f"link_ratios is {{}}; it must be {EXAMPLE}"),
        (2.5, f"link_ratios is 2.5; it must be {EXAMPLE}"),
        ({"r3": 2}, f"link_ratios has 'r3'; {TWO}"),
        ({"r2/r2": 1}, f"link_ratios has 'r2/r2'; {TWO}"),
        ({"r7/r2": 1}, f"link_ratios has 'r7/r2'; {TWO}"),
        ({"r3/r2": 0}, 'link_ratios."r3/r2" is [0, 0]'),
        ({"r3/r2": (3, 2)}, 'link_ratios."r3/r2" is [3, 2]: lo exceeds hi'),
    ],
)
def test_wrong_ratios_are_refused_in_a_line(given: Any, line: str) -> None:
    with pytest.raises(ProblemError) as refused:
        LinkRatios.checked(given, "link_ratios")
    assert str(refused.value).startswith(line)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("ratios", "lengths", "allowed"),
    [
        ({"r3/r2": 2, "r2/r3": 0.5}, {}, None),
        ({"r3/r2": 2, "r4/r3": 3, "r4/r2": (5, 7)}, {}, None),
        ({"r3/r2": 2, "r4/r3": 3, "r4/r2": (7, 8)}, {}, "[6, 6]"),
        ({"r3/r2": 2}, {"r2": (1, 2), "r3": (5, 6)}, "[2.5, 6]"),
        ({"r3/r2": 30}, {}, "[0.05, 20]"),
    ],
)
def test_contradictions_with_other_limits_are_named(ratios: Any, lengths: Any, allowed: str | None) -> None:
    wrong = contradictions(LinkRatios.checked(ratios, ""), lengths, 20.0)
    assert any(allowed in line for line in wrong) if allowed else not wrong


def test_ratios_of_links_that_no_kind_has_are_refused() -> None:
    task = load("luggage").task
    with pytest.raises(ProblemError, match=r'requirements.link_ratios."r5/r2" .* four-bar'):
        Problem(task=task, requirements=Requirements(link_ratios={"r5/r2": 1}))
    both = Requirements(link_ratios={"r4/r2": 1, "r3/r2": 2})
    alone = Problem(task=task, requirements=both, mechanism=["four-bar", "slider-crank"]).for_kind(
        "slider-crank"
    )
    assert alone.requirements.link_ratios == LinkRatios.checked({"r3/r2": 2}, "")
