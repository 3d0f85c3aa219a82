"""Enclosures of judged designs: none contradicts the judge, and what is not so is not verified."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from grashof.analysis import solve_position, verify
from grashof.analysis.judge.enclosed import enclose
from grashof.analysis.judge.planted import planted_function, planted_motion, planted_path
from grashof.analysis.judge.verdict import Enclosure, Verdict
from grashof.problems import Box, FourBar, Linkage, PathTask, Requirements, Task, load

# Limits of dimensions, which do not depend on the driver angle.
OF_DESIGN = {"link_length", "link_ratio_max", "coupler_arms", "rotatability"}
LOOSE = Requirements(rotatability="any")  # type: ignore[arg-type]


def judged(linkage: Linkage, task: Task, wanted: Requirements) -> tuple[Verdict, Enclosure]:
    verdict = verify(linkage, task, wanted)
    return verdict, enclose([linkage], task, wanted, [verdict])[0]


@pytest.mark.parametrize("mechanism", ["four-bar", "slider-crank", "inverted-slider-crank"])
@pytest.mark.parametrize("plant", [planted_motion, planted_path], ids=lambda plant: plant.__name__)
def test_planted_designs_are_verified(plant, mechanism: str) -> None:  # type: ignore[no-untyped-def]
    for seed in range(1, 3):
        task, linkage = plant(np.random.default_rng(seed), 4, mechanism=mechanism)
        verdict, shown = judged(linkage, task, Requirements())
        assert verdict.ok
        assert (shown.holds, shown.why, shown.contradicts) == (True, "", False)
        least, most = shown.transmission
        assert least - 1e-14 <= verdict.transmission_min_task <= most + 1e-14
        assert np.degrees(most - least) < 1e-6


def test_functions_are_verified_but_for_their_outputs() -> None:
    for seed in range(3):
        task, linkage, _ = planted_function(np.random.default_rng(seed), 4)
        verdict, shown = judged(linkage, task, LOOSE)
        assert verdict.ok <= shown.holds
        assert not shown.contradicts


def test_a_batch_of_kinds_is_as_each_by_itself() -> None:
    task, first = planted_motion(np.random.default_rng(0), 3)
    others = [first.changed(r2=first.r2 * share) for share in (1.0, 1.0 + 1e-9, 1.01)]
    verdicts = [verify(each, task, Requirements()) for each in others]
    together = enclose(others, task, Requirements(), verdicts)
    alone = [enclose([a], task, Requirements(), [v])[0] for a, v in zip(others, verdicts, strict=True)]
    assert list(together) == alone


def test_random_linkages_contradict_no_verdict() -> None:
    """Whatever the judge accepts at random limits, of linkages near and at their limits."""
    rng, accepted = np.random.default_rng(7), 0
    for seed in range(8):
        task, linkage = planted_motion(np.random.default_rng(seed), 3)
        verdict = verify(linkage, task, Requirements())
        at = np.degrees(verdict.transmission_min_task)
        limit = max(0.0, at + rng.choice([0.0, 1e-9, -1e-9, 1e-8, 1e-7, -0.1]))
        wanted = Requirements(transmission_min_deg=limit)
        verdict, shown = judged(linkage, task, wanted)
        accepted += verdict.ok
        if verdict.ok:
            assert not shown.contradicts
        if shown.holds:
            assert {defect.requirement for defect in verdict.defects} <= OF_DESIGN
    assert accepted > 3


# The crank is 1e-10 too long to turn: open for 1e-5 rad about 180 deg, between the targets at 2.9 and 3.4.
DEAD = FourBar((0, 0), (4, 0), 1, 3, 2 - 1e-10, coupler_point=(1, 0.5))


def test_a_dead_position_between_targets_is_not_verified() -> None:
    angle = np.array([2.9, 3.0, 3.3, 3.4])
    task, good = PathTask(solve_position(DEAD, angle).p), DEAD.changed(r3=3.1)
    before = verify(good, PathTask(solve_position(good, angle).p), LOOSE)
    forged = replace(before, theta2=angle, branch_ok=True, direction=1, defects=())
    shown = enclose([DEAD], task, LOOSE, [forged])[0]
    assert not shown.holds
    assert "dead position over the task motion" in shown.why


def test_a_plainly_wrong_verdict_is_contradicted() -> None:
    task, linkage = planted_motion(np.random.default_rng(3), 4)
    wanted = Requirements()
    verdict = verify(linkage, task, wanted)
    too_much = Requirements(transmission_min_deg=np.degrees(verdict.transmission_min_task) + 1e-4)
    turned_back = replace(verdict, theta2=verdict.theta2[[0, 2, 1, 3]])
    moved = replace(verdict, theta2=verdict.theta2 + 1e-4)
    away = Requirements(a=Box(x=(float(linkage.o2[0] + 2 * linkage.r2), np.inf)))
    opened = linkage.changed(r3=linkage.r3 * 3)
    for one, asked, judgement, what in (
        (linkage, too_much, verdict, "transmission"),
        (linkage, wanted, turned_back, "order"),
        (linkage, wanted, moved, "positions"),
        (linkage, away, verdict, "box of A"),
        (opened, wanted, verdict, "closure"),
    ):
        shown = enclose([one], task, asked, [judgement])[0]
        assert not shown.holds
        assert shown.contradicts, what
        assert what in shown.why


def test_a_limit_within_the_slack_of_the_judge_is_undecided() -> None:
    task, linkage = planted_motion(np.random.default_rng(3), 4)
    verdict = verify(linkage, task, Requirements())
    # The judge grants 1e-9 rad: exactly at that limit the enclosure of 2e-10 rad cannot decide.
    limit = float(np.degrees(verdict.transmission_min_task + 1e-9))
    shown = enclose([linkage], task, Requirements(transmission_min_deg=limit), [verdict])[0]
    assert (shown.holds, shown.contradicts) == (False, False)
    assert shown.why == "the transmission angle at its limit"


def test_the_turn_is_shown_where_a_full_crank_is_required() -> None:
    """A linkage whose task is fine and whose turn is not: verified with any rotatability alone."""
    angle = np.array([0.5, 0.9, 1.3])
    task = PathTask(solve_position(DEAD, angle).p)
    assert judged(DEAD, task, LOOSE)[1].holds
    verdict = verify(DEAD, task, LOOSE)
    shown = enclose([DEAD], task, Requirements(rotatability_margin=0.0), [verdict])[0]
    assert shown.why == "closure without a dead position over the turn"


def test_listed_luggage_designs_are_verified() -> None:
    from grashof import synthesize

    found = synthesize(load("luggage"), enough=3)
    problem, designs = found.problem, found.candidates
    linkages, verdicts = ([getattr(each, name) for each in designs] for name in ("linkage", "verdict"))
    shown = enclose(linkages, problem.task, problem.requirements, verdicts)
    assert all(each.holds for each in shown)
