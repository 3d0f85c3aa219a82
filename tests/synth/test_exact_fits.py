"""More targets than freedoms, planted so that a linkage meets them all."""

from itertools import product

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import solve_position, verify
from grashof.analysis.judge.planted import planted_motion, planted_path
from grashof.problems import FourBar, Linkage, MotionTask, PathTask, Problem, Requirements, SliderCrank
from grashof.synth import Candidate
from grashof.synth.theory.distinct import signature

ROUNDING = 1e-11  # sizes
PLANTED = {"poses": planted_motion, "points": planted_path}
# Six points that are not timed leave freedom.
CASES = {
    f"{count}{' timed' * timed} {kind}, {seed}": (kind, count, timed, seed)
    for seed, kind, count, timed in product(range(4), PLANTED, (6, 12, 20, 40), (False, True))
    if (kind, count, timed) != ("points", 6, False)
}


def of_points(o2: complex, o4: complex, a: complex, b: complex, p: complex, body: complex) -> FourBar:
    """The linkage that stands there, with a direction of the body."""
    arm, sine = (p - a) * abs(b - a) / (b - a), ((b - a).conjugate() * (b - o4)).imag
    return FourBar(
        o2=(o2.real, o2.imag), o4=(o4.real, o4.imag), r2=abs(a - o2), r3=abs(b - a), r4=abs(b - o4),
        coupler_point=(arm.real, arm.imag), assembly=1 if sine >= 0 else -1,
        body_angle=float(np.angle(body / (b - a))),
    )  # fmt: skip


def alike(task: MotionTask | PathTask, linkage: Linkage) -> list[FourBar]:
    """All linkages that lead P, or the body, as a planted one does: as it stands at its first target.

    By Roberts' triangles: the third pivot O6 with O2-O4-O6 similar to A-B-P, and parallelograms.
    """
    turn = np.linspace(-np.pi, np.pi, 200_001)
    near = np.hypot(*(solve_position(linkage, turn).p - task.positions[0]).T)
    state = solve_position(linkage, turn[np.argmin(near)])
    pivots = (linkage.o2, linkage.o4, state.a, state.b, state.p)  # type: ignore[attr-defined]
    o2, o4, a, b, p = (complex(*each) for each in pivots)
    body = np.exp(1j * float(state.theta3 + linkage.body_angle))
    k = (p - a) / (b - a)
    o6 = o2 + (o4 - o2) * k
    found = [(o2, o4, a, b, p)]
    found += [(o6, o4, o6 + (1 - k) * (a - o2), o4 + p - b, p)] * isinstance(task, PathTask)
    if not task.is_timed:
        found += [(o2, o6, o2 + p - a, o6 + k * (b - o4), p)] * isinstance(task, PathTask)
        found += [(second, first, y, x, p) for first, second, x, y, _ in found]
    return [of_points(*each, body) for each in found]


def missing(problem: Problem, wanted: list[FourBar], found: tuple[Candidate, ...]) -> int:
    """How many of the linkages that meet the requirements are not in a list."""
    task = problem.task
    listed = np.array([signature(each.linkage, task.middle) for each in found])
    valid = [each for each in wanted if verify(each, task, problem.requirements, problem=problem).ok]
    apart = [np.abs(listed - signature(each, task.middle)).max(axis=1).min() for each in valid]
    assert valid
    return sum(each > 1e-3 * task.size for each in apart)


@pytest.mark.quick("6 timed poses, 0", "12 timed points, 0")
@pytest.mark.parametrize(("kind", "count", "timed", "seed"), CASES.values(), ids=CASES)
def test_all_linkages_that_do_it_are_listed_exactly(kind: str, count: int, timed: bool, seed: int) -> None:
    task, linkage = PLANTED[kind](np.random.default_rng([seed, count, timed]), count, timed=timed)
    problem = Problem(task=task)
    found = synthesize(problem).candidates
    assert missing(problem, alike(task, linkage), found) == 0
    for each in found:
        verdict = verify(each.linkage, task, problem.requirements, problem=problem)
        assert verdict.error_max < ROUNDING * task.size
    best = [
        each.verdict.transmission_min_task for each in found if bool(each.caution) == bool(found[0].caution)
    ]
    assert best[0] > max(best) - 1e-9


def test_of_timed_poses_the_other_pairs_of_dyads_are_listed_too() -> None:
    """Five poses leave up to four dyads; timing fixes the driver's alone.

    With the usual effort it depends on rounding which of the two comes up in the first three rounds.
    """
    task, _ = planted_motion(np.random.default_rng([2, 5, True, 5]), 5, timed=True)
    found = synthesize(Problem(task=task), effort=3).candidates
    driver = np.array([[*each.linkage.o2, each.linkage.r2] for each in found])  # type: ignore[attr-defined]
    output = np.array([[*each.linkage.o4, each.linkage.r4] for each in found])  # type: ignore[attr-defined]
    assert len(found) == 2
    assert np.ptp(driver, axis=0).max() < 1e-8
    assert np.ptp(output, axis=0).max() > 0.01


@pytest.mark.slow
def test_a_slider_crank_and_its_cognate_are_both_listed() -> None:
    """Where the cognate's rod does not become perpendicular to its slide on the way."""
    linkage = SliderCrank((0, 0), r2=1, r3=3, offset=0.3, coupler_point=(1.2, 0.8), slide_angle=0.1)
    task = PathTask(solve_position(linkage, np.radians(np.linspace(-50, 70, 12))).p)
    problem = Problem(task=task, mechanism="slider-crank", requirements=Requirements(rotatability="any"))
    found = synthesize(problem).candidates
    assert max(each.verdict.error_max for each in found) < ROUNDING * task.size
    cranks = sorted(float(each.linkage.r2) for each in found)  # type: ignore[attr-defined]
    np.testing.assert_allclose(cranks, [1, np.hypot(1.2, 0.8)], rtol=1e-8)  # the cognate's turns with A-P


@pytest.mark.slow
def test_limits_of_the_motion_are_judged_over_it() -> None:
    """A sense and a rotation of the driver leave the linkage driven from its other side in the list."""
    task, linkage = planted_motion(np.random.default_rng([0, 6, False]), 6)
    wanted = [each for each in alike(task, linkage) if verify(each, task, Requirements()).ok]
    assert len(wanted) == 2
    verdicts = [verify(each, task, Requirements()) for each in wanted]
    turned = [float(np.degrees(np.ptp(each.theta2))) for each in verdicts]
    senses = {each.direction for each in verdicts}
    limits = Requirements(
        driver_rotation_deg=(min(turned) - 1, max(turned) + 1),
        driver_sense="either" if len(senses) > 1 else {1: "ccw", -1: "cw"}[senses.pop()],
    )
    assert len(synthesize(Problem(task=task, requirements=limits)).candidates) == 2
