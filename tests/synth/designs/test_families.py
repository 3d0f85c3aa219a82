"""Families: alike are designs close to each other, mirrored ones and cognates; nothing is chained on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import solve_position, verify
from grashof.analysis.judge.planted import random_full_crank
from grashof.problems import Box, FourBar, MotionTask, Objective, PathTask, Problem, Requirements, load
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth import Candidate, Result
from grashof.synth.designs.families import best_alike, caution, listed
from grashof.synth.designs.ranking import ranked
from grashof.synth.theory.cognates import cognate_points, driven_at_o4
from grashof.synth.theory.distinct import signature

Designs = tuple[Candidate, ...]
UNEVEN = PathTask([[0, 0], [1, 0.3], [2, -0.4], [4, 0.2]])  # no rotation or reflection maps it onto itself


def share_apart(one: FloatArray, other: FloatArray) -> float:
    largest = max(max(abs(value) for value in one), max(abs(value) for value in other))
    return float(max(abs(x - y) for x, y in zip(one, other, strict=True)) / largest)


def rows(*designs: tuple[float, ...]) -> FloatArray:
    """Signatures that are those of one linkage but for a few numbers: r2, r3, ..."""
    plain = np.array([-10.0, 0, 10, 0, 4, 5, 6, 1, 2])
    return np.array([plain + np.array([0, 0, 0, 0, *each, *[0] * (5 - len(each))]) for each in designs])


def of_points(points: ComplexArray) -> FourBar:
    o2, o4, a, b, p = points
    arm = (p - a) / (b - a) * abs(b - a)
    return FourBar(
        (o2.real, o2.imag), (o4.real, o4.imag), abs(a - o2), abs(b - a), abs(b - o4), (arm.real, arm.imag),
        assembly=1 if ((b - a).conjugate() * (b - o4)).imag >= 0 else -1,
    )  # fmt: skip


def test_designs_less_than_five_percent_apart_are_alike() -> None:
    assert best_alike(UNEVEN, rows((0,), (0.49,), (0.51,))).tolist() == [0, 0, 2]
    assert best_alike(UNEVEN, rows((0, 0.4, 0.4, 0.4, 0.4), (0,))).tolist() == [0, 0]
    assert best_alike(UNEVEN, rows((0,), (0, 0.51))).tolist() == [0, 1]
    assert best_alike(UNEVEN, np.empty((0, 9))).tolist() == []


def test_nothing_is_chained_on() -> None:
    """Each one is like the one before; a member has to be like the best of its family."""
    chain = rows(*((0.3 * k,) for k in range(8)))
    assert best_alike(UNEVEN, chain).tolist() == [0, 0, 2, 2, 4, 4, 6, 6]
    assert best_alike(UNEVEN, chain[[1, 0, 2, 3, 4, 5, 6, 7]]).tolist() == [0, 0, 0, 3, 3, 5, 5, 7]


@pytest.mark.slow
def test_families_are_those_of_brute_force(luggage_result: Result, luggage: Problem) -> None:
    """Of the luggage problem, which has no symmetry: each design with the first that is near enough."""
    middle = np.mean(luggage.task.positions, axis=0)
    ordered = sorted(
        ranked(luggage, luggage_result.candidates), key=lambda each: bool(caution(luggage, each))
    )
    like: list[Candidate] = []
    akin: list[Candidate] = []
    family: dict[str, str] = {}
    for candidate in ordered:
        mine = signature(candidate.linkage, middle)
        near = [each for each in like if share_apart(mine, signature(each.linkage, middle)) < 0.05]
        if near:
            family[candidate.id] = family[near[0].id]
            continue
        like.append(candidate)
        kin = [each for each in akin if are_akin(each, candidate, luggage.task.size)]
        akin += [] if kin else [candidate]
        family[candidate.id] = (kin[0] if kin else candidate).id
    assert {each.id: each.family for each in luggage_result.candidates} == family
    assert 1 < len(akin) < len(like) < len(luggage_result)
    assert sum(map(len, luggage_result.families)) == len(luggage_result)


def are_akin(one: Candidate, other: Candidate, size: float) -> bool:
    """Both dyads in nearly the same place, by driver or output; or one dyad in common, and the angle."""

    def dyads(each: Candidate) -> list[list[float]]:
        at = solve_position(each.linkage, each.verdict.theta2[0], each.verdict.assembly[0])
        assert isinstance(each.linkage, FourBar)
        return [[*each.linkage.o2, *at.a], [*each.linkage.o4, *at.b]]

    mu = [np.degrees(each.verdict.transmission_min_task) for each in (one, other)]
    first, second = dyads(one)
    for exchanged in (dyads(other), dyads(other)[::-1]):
        off = [
            np.abs(np.subtract(*pair)).max() / size for pair in zip((first, second), exchanged, strict=True)
        ]
        if max(off) < 0.15 or (min(off) < 0.03 and abs(mu[0] - mu[1]) < 1):
            return True
    return False


@pytest.mark.slow
def test_a_dyad_in_common_is_a_family_where_the_transmission_angle_is(luggage: Problem) -> None:
    """Hinges of a hood: the first six rows shared O4, B and mu (the angle is that of their output dyad)."""
    task = MotionTask.from_degrees([[0, 0, 0], [-20, 60, 20], [-60, 130, 55]])
    pivots = Box((-150, 250), (-200, -60))
    wanted = Requirements(
        rotatability="any",
        o2=pivots,
        o4=pivots,
        link_length=(60, 350),
        coupler_arms=(30, 300),
        transmission_min_deg=25,
    )
    rows = [
        family[0] for family in synthesize(Problem(task=task, requirements=wanted), starts=60).families[:6]
    ]
    for k, one in enumerate(rows):
        assert not any(are_akin(one, other, task.size) for other in rows[:k])


@pytest.mark.parametrize("seed", range(5))
def test_cognates_of_a_path_are_alike(seed: int) -> None:
    """All six linkages of a curve, by their pivots in one position; of a timed path only two."""
    linkage = random_full_crank(np.random.default_rng(seed))
    at = solve_position(linkage, 0.7)
    place = np.array([complex(*each) for each in (linkage.o2, linkage.o4, at.a, at.b, at.p)])
    every = [place, driven_at_o4(place), *cognate_points(place, timed=False)]
    signatures = np.array([signature(of_points(points)) for points in every])
    assert best_alike(UNEVEN, signatures).tolist() == [0] * 6
    timed = PathTask(UNEVEN.points, timing=[0.0, 1, 2, 4])
    assert best_alike(timed, signatures).tolist() == [0, 1, 0, 3, 3, 1]
    motion = MotionTask(UNEVEN.points, [0.0, 0.3, 0.1, 0.2])
    assert best_alike(motion, signatures).tolist() == list(range(6))  # a cognate turns the body otherwise


@pytest.mark.slow
def test_the_best_of_each_family_comes_first_then_the_others(luggage_result: Result) -> None:
    families = luggage_result.families
    heads = {family[0].id for family in families}
    sound = [each for each in luggage_result.candidates if not each.caution]
    assert sound == list(luggage_result.candidates[: len(sound)])
    for some in (sound, luggage_result.candidates[len(sound) :]):
        first = [each for each in some if each.id in heads]
        assert list(some[: len(first)]) == first
        for part in (first, some[len(first) :]):
            assert list(part) == [
                c for c in ranked(luggage_result.problem, luggage_result.candidates) if c in part
            ]
    for family in families:
        assert {each.family for each in family} == {family[0].id}


def test_the_top_is_of_families_with_all_their_members(luggage_result: Result) -> None:
    two = luggage_result.top(2)
    assert two.families == luggage_result.families[:2]
    assert len(two) == sum(len(family) for family in two.families) > 2
    assert two.problem is luggage_result.problem
    assert luggage_result.top(1000).candidates == luggage_result.candidates


def test_ranked_otherwise_the_families_are_named_anew(luggage_result: Result, luggage: Problem) -> None:
    small = replace(luggage, objective=Objective(transmission=0, compactness=1))
    result = Result(small, listed(small, luggage_result.candidates))
    assert {each.id for each in result.candidates} == {each.id for each in luggage_result.candidates}
    for family in result.families:
        assert family[0].verdict.size == min(each.verdict.size for each in family)
        assert family[0].family == family[0].id
    assert listed(small, ()) == ()


def test_designs_without_families_are_their_own_family(luggage_result: Result) -> None:
    plain = tuple(replace(each, family="") for each in luggage_result.candidates)
    assert len(replace(luggage_result, candidates=plain).families) == len(plain)


@pytest.mark.study
def test_mirrored_designs_and_cognates_of_a_symmetric_closed_path() -> None:
    """Designs for the ellipse, their cognates and the mirror images of all, each judged anew."""
    loaded = load("path-ellipse")
    wanted = Requirements(link_length=(2, 120), link_ratio_max=40)
    task = PathTask(loaded.task.positions, closed=True, within=0.5)  # zones keep what others dominate
    problem = replace(loaded, task=task, requirements=wanted)
    some = synthesize(problem, effort=0.35).candidates
    pairs = [(each, design) for each in some if (design := mirrored(each, problem)) is not None]
    result = Result(problem, listed(problem, [each for pair in pairs for each in pair]))
    family_of = {each.id: each.family for each in result.candidates}
    kept = [(one, other) for one, other in pairs if {one.id, other.id} <= set(family_of)]
    assert len(kept) >= 3
    for one, other in kept:
        assert other.verdict.error_rms == pytest.approx(one.verdict.error_rms, rel=0.1)
        assert family_of[one.id] == family_of[other.id]
    named = [each for each in result.candidates if each.cognate_of in family_of]
    assert named
    assert all(each.family == family_of[each.cognate_of] for each in named)
    assert all(len(family) >= 2 for family in result.families if family[0].id in {a.id for a, _ in kept})


def mirrored(design: Candidate, problem: Problem) -> Candidate | None:
    """The design in the mirror at the ellipse's long axis, y = 10, as the judge sees it."""
    linkage = design.linkage
    flipped = FourBar(
        o2=linkage.o2 * [1, -1] + [0, 20], o4=linkage.o4 * [1, -1] + [0, 20], r2=linkage.r2, r3=linkage.r3,
        r4=linkage.r4, coupler_point=linkage.coupler_point * [1, -1], assembly=-linkage.assembly,
    )  # fmt: skip
    verdict = verify(flipped, problem.task, problem.requirements)
    return replace(design, linkage=flipped, verdict=verdict) if verdict.ok else None
