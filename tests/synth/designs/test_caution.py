"""Designs that meet all requirements but are impractical: they come last, and state why."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import verify
from grashof.problems import (
    FourBar,
    MotionTask,
    Objective,
    PathTask,
    Problem,
    Requirements,
    Rotatability,
    TransmissionOver,
)
from grashof.synth import Candidate
from grashof.synth.designs.families import caution, listed

TASK = PathTask([[0.0, 0], [1, 0.5], [2, 0.5], [4, 0]])  # size 4
PROBLEM = Problem(task=TASK, requirements=Requirements(exact=True))
CRANK = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
FOLDING = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=3.99, r4=1.1)


def design(number: int = 0, linkage: FourBar = CRANK, turn: float = 90.0, **more: Any) -> Candidate:
    """As if the judge had found these; sizes in sizes of the task, angles in deg."""
    verdict = replace(
        verify(linkage, TASK, PROBLEM.requirements),
        theta2=np.linspace(0, np.radians(turn), 4),
        size=4 * more.get("size", 2.0),
        transmission_min_task=np.radians(more.get("mu", 40.0)),
        transmission_min_cycle=np.radians(more.get("cycle", 30.0)),
        position_error=np.zeros(4),
        square=0.0,
        defects=(),
    )
    moved = replace(linkage, o2=linkage.o2 + number, o4=linkage.o4 + number)
    return Candidate(moved, verdict, PROBLEM, number, 0)


def asking(**requirements: Any) -> Problem:
    return replace(PROBLEM, requirements=replace(PROBLEM.requirements, **requirements))


@pytest.mark.parametrize(
    ("odd", "said", "allowed"),
    [
        ({"size": 3.1}, "3.1 times the size of the task", {"size": (0.0, 20.0)}),
        ({"turn": 14.0}, "the driver turns by 14.0 deg alone", {"driver_rotation_deg": (1.0, 90.0)}),
        (
            {"cycle": 14.0},
            "transmission angle 14.0 deg somewhere in the turn",
            {"transmission_min_deg": 5.0, "transmission_over": TransmissionOver.CYCLE},
        ),
        ({"linkage": FOLDING}, "it nearly folds: 0.0089 left of its lengths", {"rotatability_margin": 0.002}),
    ],
)
def test_cautions_of_a_design(odd: dict[str, Any], said: str, allowed: dict[str, Any]) -> None:
    assert caution(PROBLEM, design(**odd)) == said
    assert caution(asking(**allowed), design(**odd)) == ""  # the user's own limit wins
    assert caution(replace(PROBLEM, objective=Objective(compactness=0.1)), design(**odd)) == ""


def test_a_design_that_keeps_all_has_no_caution() -> None:
    assert caution(PROBLEM, design(size=3.0, turn=15.001, cycle=15.001)) == ""
    turning = asking(rotatability=Rotatability.ANY)
    assert caution(turning, design(cycle=1.0)) == caution(turning, design(linkage=FOLDING)) == ""


def test_doubted_designs_come_last_and_the_best_by_the_objective_says_so() -> None:
    found = listed(
        PROBLEM, [design(1, mu=60, turn=5), design(10, mu=50), design(20, mu=55, size=4), design(30, mu=45)]
    )
    assert [each.start for each in found] == [10, 30, 1, 20]
    assert [bool(each.caution) for each in found] == [False, False, True, True]
    assert [each.best_at for each in found] == ["", "", "objective", ""]
    assert [each.best_at for each in listed(PROBLEM, [design(1, mu=60), design(10, mu=50, size=9)])] == [
        "",
        "",
    ]


@pytest.mark.slow
def test_inverted_slider_cranks_at_90_deg_are_ranked_by_their_leverage() -> None:
    """Their transmission angle says nothing: one whose output went 454 times as fast came third."""
    task = MotionTask.from_degrees([[0, 0, 0], [3, 1, 40], [5, 4, 90]])
    for kinds in ("inverted-slider-crank", ("inverted-slider-crank", "slider-crank")):
        found = synthesize(Problem(task=task, mechanism=kinds), starts=30, enough=20)
        upright = [
            each
            for each in found.candidates
            if each.linkage.mechanism.word == "inverted-slider-crank"
            and each.family == each.id
            and not each.caution
            and np.degrees(each.verdict.transmission_min_task) > 90 - 1e-7
        ]
        assert len(upright) > 3
        gain = [each.values["mechanical_advantage"] for each in upright]
        assert gain == sorted(gain, reverse=True)
        assert gain[0] > 1
