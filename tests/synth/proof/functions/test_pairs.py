"""Three to five pairs of a function: no generator exceeds a bound, forms hold all couplers, none is lost."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import solve_position, verify
from grashof.problems import FourBar, FunctionTask, Problem, Requirements
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.synth import Claim
from grashof.synth.proof.claims.bounds import Proving
from grashof.synth.proof.curve.patches import Patches
from grashof.synth.proof.forms.forms import Span
from grashof.synth.proof.functions.couplers import ABOUT, PlaneOfCouplers
from grashof.synth.proof.functions.few_pairs import Sense, bounds_of_pairs
from grashof.synth.proof.functions.five_pairs import certified_functions
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.functions.aims import FunctionAims
from grashof.synth.starts.functions.exact import exact_functions
from grashof.synth.theory.burmester import Displacements
from grashof.synth.theory.functions.four_bar import FourBars


def function(turned: FloatArray, output: FloatArray, **wanted: Any) -> Problem:
    """Pairs of angles in deg, from the first ones on."""
    task = FunctionTask.from_degrees(turned - turned[0], output - output[0])
    return Problem(task=task, requirements=Requirements(**wanted))


def random_function(seed: int, count: int, **wanted: Any) -> Problem:
    rng = np.random.default_rng(seed)
    turned, output = np.sort(rng.uniform(0, 120, count)), np.sort(rng.uniform(0, 90, count))
    return function(turned, output * rng.choice([-1, 1]), **wanted)


def motion_of(problem: Problem) -> Displacements:
    wanted = FunctionAims.of(ScaledProblem.of(problem)).pairs(1)
    turned, output = wanted.turned - wanted.turned[0], wanted.output - wanted.output[0]
    return Displacements(np.exp(1j * (turned - output)), 1.0 - np.exp(-1j * output))


def centres(motion: Displacements, z: ComplexArray) -> ComplexArray:
    """Centre of the circle through three places, by its determinant."""
    one, two, three = motion.apply(z).T
    b, c = two - one, three - one
    double = 2 * (b.conj() * c).imag
    x = (c.imag * np.abs(b) ** 2 - b.imag * np.abs(c) ** 2) / double
    y = (b.real * np.abs(c) ** 2 - c.real * np.abs(b) ** 2) / double
    return one + x + 1j * y


def off(span: Span, s: float, t: float, points: ComplexArray) -> FloatArray:
    """Share of the rest of forms that points use."""
    used: FloatArray = np.abs(points - span.middle - span.steps[0] * s - span.steps[1] * t) / span.rest
    return used


@pytest.mark.parametrize("half", [0.3, 0.03, 0.003])
@pytest.mark.parametrize("seed", [0, 2])
def test_forms_hold_the_ground_pivot_of_every_point(seed: int, half: float) -> None:
    motion, rng, count = motion_of(random_function(seed, 3)), np.random.default_rng(seed), 4000
    middle = 3 * (rng.normal(size=count) + 1j * rng.normal(size=count))
    patches = Patches(motion, 20.0, middle, np.full(count, half))
    moving, ground = patches.spans
    most = 0.0
    for s, t in [(-1, -1), (-1, 1), (1, -1), (1, 1), (0, 1), (1, 0), *rng.uniform(-1, 1, (10, 2))]:
        z = middle + half * (s + 1j * t)
        c = centres(motion, z)
        counts = np.abs(c - z) <= 20.0
        assert np.all(off(moving, s, t, z) <= 1 + 1e-6)
        assert np.all(off(ground, s, t, c)[counts] <= 1 + 1e-9)
        assert np.all(patches.bounded[counts])
        most = max(most, float(off(ground, s, t, c)[counts].max()))
    assert most > 0.5
    far = np.abs(centres(motion, middle) - middle) > 25
    assert half > 0.003 or not far.any() or patches.bounded[far].mean() < 0.5


@pytest.mark.quick("cycle-full-crank-4")
@pytest.mark.parametrize("count", [3, 4])
@pytest.mark.parametrize(
    ("over", "rotatability"),
    [
        ("task", "any"),
        *((over, name) for over in ("task", "cycle") for name in ("full-crank", "crank-rocker")),
    ],
)
def test_no_generator_is_above_its_bound(count: int, over: str, rotatability: str) -> None:
    for seed in (0,) if count == 3 else (0, 6):
        problem = random_function(seed, count, rotatability=rotatability, transmission_over=over)
        aims = FunctionAims.of(ScaledProblem.of(problem))
        judged = []
        for made, driver in exact_functions(aims, np.random.default_rng(seed), 30, 0.5):
            linkage = aims.linkage(made, driver)
            verdict = verify(linkage, problem.task, problem.requirements, problem=problem)
            if verdict.ok:
                judged.append(
                    verdict.transmission_min_cycle if over == "cycle" else verdict.transmission_min_task
                )
        # Given the worst one as known, better ones must not be excluded.
        known = min(judged, default=0.0)
        proving = Proving(gap=0.5, most_pairs=100_000 if count == 3 else 300_000)
        bounds = bounds_of_pairs(ScaledProblem.of(problem), proving, known)
        assert bounds is not None
        assert max(judged, default=0.0) <= bounds.upper + 1e-8


@pytest.mark.quick("4-0")
@pytest.mark.parametrize(
    ("count", "seed"), [(3, 10), (4, 0), *((n, k) for n in (3, 4) for k in range(20, 60))]
)
def test_the_best_of_few_pairs_or_none_is_proven(count: int, seed: int) -> None:
    found = synthesize(random_function(seed, count))
    assert found.proof is not None
    assert found.proof.claim in (Claim.BEST, Claim.NONE)
    assert (found.proof.claim is Claim.NONE) == (not found.candidates)


@pytest.mark.slow
def test_coinciding_poles_are_said_to_be_open() -> None:
    problem = Problem(task=FunctionTask.from_degrees([0, 30, 60, 90], [0, 20, 35, 45]))
    proof = synthesize(problem, enough=5).proof
    assert proof is not None
    assert proof.claim is Claim.BOUND
    assert "centre is open" in proof.why or "budget" in proof.why


def onto_couplers(
    motion: Displacements, a: ComplexArray, b: ComplexArray
) -> tuple[ComplexArray, ComplexArray]:
    """The nearest A and B with one distance at all pairs, by Newton steps of least length."""
    turn = motion.rotation[:, None] * np.array([1, 1j])
    for _ in range(4):
        away = motion.apply(a) - b[:, None]
        by_a, by_b = (away.conj()[..., None] * turn).real, -(away.conj()[..., None] * np.array([1, 1j])).real
        slope = np.concatenate([by_a, by_b], axis=-1)
        off = np.abs(away[:, 1:]) ** 2 - np.abs(away[:, :1]) ** 2
        step = (np.linalg.pinv(slope[:, 1:] - slope[:, :1]) @ off[..., None])[..., 0] / 2
        a, b = a - step[:, 0] - 1j * step[:, 1], b - step[:, 2] - 1j * step[:, 3]
    return a, b


def holding(plane: PlaneOfCouplers, a: ComplexArray, b: ComplexArray) -> BoolArray:
    """Which squares of a plane hold which couplers, shape (squares, couplers)."""
    squares = zip((plane.of_a, plane.of_b), (a, b), (b, a), strict=True)
    found = []
    for patches, moving, ground in squares:
        along = (moving - patches.middle[:, None]) / patches.half[:, None]
        c = patches.spans[1]
        off = ground - c.middle[:, None] - c.steps[0][:, None] * along.real - c.steps[1][:, None] * along.imag
        inside = np.maximum(np.abs(along.real), np.abs(along.imag)) <= 1
        found.append(inside & (np.abs(off) <= c.rest[:, None] * (1 + 1e-9) + 1e-13))
    return np.concatenate(found)


@pytest.mark.parametrize("seed", range(3))
def test_squares_hold_every_coupler_however_near_to_poles(seed: int) -> None:
    motion, rng, count = motion_of(random_function(seed, 3)), np.random.default_rng(seed), 60
    plane = PlaneOfCouplers.of(motion, 20.0)

    def near(points: ComplexArray) -> ComplexArray:
        """Anywhere about some points, evenly by the logarithm of the distance."""
        about = rng.choice(np.append(points, 0.3 + 0.2j), count)
        away: ComplexArray = 10.0 ** rng.uniform(-6, 1, count) * np.exp(2j * np.pi * rng.random(count))
        return about + away

    a, b, c, d = near(plane.poles), near(plane.others), near(plane.poles), near(plane.others)
    a, b = np.concatenate([a, centres(motion.inverse(), b), c]), np.concatenate([centres(motion, a), b, d])
    a, b = onto_couplers(motion, a, b)
    within = (np.abs(a) < 20) & (np.abs(b - 1) < 20) & (np.abs(b - a) < 20)
    away = np.abs(motion.apply(a) - b[:, None])
    within &= np.abs(away - away[:, :1]).max(axis=1) < 1e-13 * np.abs(b)
    a, b = a[within], b[within]
    assert len(a) > 60
    discs = np.abs(a[:, None] - plane.poles).min(axis=1) < ABOUT
    discs &= np.abs(b[:, None] - plane.others).min(axis=1) < ABOUT
    for _ in range(24):
        held = holding(plane, a, b)
        assert np.all(held.any(axis=0) | discs)
        plane.divided(np.flatnonzero(held.any(axis=1)))
    assert plane.of_a.half.max(initial=0) < 1e-6


def couplers_of(made: FourBars, turned: float) -> tuple[ComplexArray, ComplexArray]:
    """A and B after a driver rotation, on the ground from 0 to 1, by triangles."""
    _, r2, r3, r4 = made.lengths.T
    a = r2 * np.exp(1j * (made.first + turned))
    d = 1 - a
    along = (np.abs(d) ** 2 + r3**2 - r4**2) / (2 * np.abs(d))
    across = made.assembly * np.sqrt(r3**2 - along**2)
    return a, a + d / np.abs(d) * (along + 1j * across)


@pytest.mark.slow
@pytest.mark.quick("0")
@pytest.mark.parametrize("seed", [0, 1, 6, 12])
def test_no_square_that_holds_a_generator_is_dropped(seed: int) -> None:
    problem = random_function(seed, 3)
    aims = FunctionAims.of(ScaledProblem.of(problem))
    found = exact_functions(aims, np.random.default_rng(seed), 12, 0.5)
    made = FourBars.joined([one for one, _ in found])
    sense = Sense.of(aims, 1, 1)
    a, b = onto_couplers(sense.motion, *couplers_of(made, sense.begun))
    worth = []
    for one, driver in found:
        verdict = verify(aims.linkage(one, driver), problem.task, problem.requirements, problem=problem)
        assert verdict.ok
        worth.append(verdict.transmission_min_task)
    plane = PlaneOfCouplers.of(sense.motion, 20.0)
    for _ in range(20):
        held = holding(plane, a, b)
        assert np.all(held.any(axis=0))
        which = np.flatnonzero(held.any(axis=1))
        least = np.where(held[which], worth, np.inf).min(axis=1) - 1e-7
        for row in which:
            mine = np.array([row])
            kept, bound = sense.rows_left(*plane.spans(mine), float(least[which == row][0]))
            assert len(kept)
            assert np.all(bound[0] >= np.where(held[row], worth, 0.0).max())
        plane.divided(which)


MORE = [pytest.param(seed, marks=pytest.mark.study) for seed in range(8, 100)]


@pytest.mark.parametrize("seed", [*range(8), *MORE])
def test_every_coupler_of_five_random_pairs_is_known(seed: int) -> None:
    made = certified_functions(ScaledProblem.of(random_function(seed, 5, link_ratio_max=50.0)))
    assert made is not None
    assert (made.complete, made.why) == (True, "")
    assert 1 <= made.within <= 3


def test_a_planted_function_is_listed_and_all_are_proven() -> None:
    linkage = FourBar(o2=(0, 0), o4=(1, 0), r2=0.4, r3=1.1, r4=0.8, assembly=1)
    theta2 = np.radians([20.0, 45.0, 70.0, 95.0, 120.0])
    theta4 = np.unwrap(solve_position(linkage, theta2, 1).theta4)
    found = synthesize(function(np.degrees(theta2), np.degrees(theta4), link_ratio_max=50.0))
    assert found.proof is not None
    assert (found.proof.claim, found.proof.complete) == (Claim.BEST, True)
    ratios = [one.linkage.lengths / one.linkage.lengths[0] for one in found.candidates]
    assert min(float(np.abs(each - [1, 0.4, 1.1, 0.8]).max()) for each in ratios) < 1e-6


@pytest.mark.slow
@pytest.mark.quick("4")
@pytest.mark.parametrize("count", [3, 4])
def test_bounds_of_couplers_are_those_of_outputs_by_the_exchange(count: int) -> None:
    """Limits of r3 and r4 change places with them; what reaches the bound is judged as a coupler."""
    for seed in range(3):
        output = random_function(seed, count, r3=(0.5, 2.0), r4=(0.8, 4.0))
        other = replace(output.requirements, r3=(0.8, 4.0), r4=(0.5, 2.0))
        coupler = Problem(task=replace(output.task, link="coupler"), requirements=other)
        both = [bounds_of_pairs(ScaledProblem.of(each), Proving.patient(0.05)) for each in (output, coupler)]
        first, second = both
        assert first is not None
        assert second is not None
        assert (first.closed, first.upper, first.lower) == (second.closed, second.upper, second.lower)
        if second.found is not None:
            assert verify(second.found.linkage, coupler.task, coupler.requirements, problem=coupler).ok
            assert not verify(second.found.linkage, output.task, output.requirements, problem=output).ok


def test_a_planted_coupler_is_listed_and_all_are_proven() -> None:
    linkage = FourBar(o2=(0, 0), o4=(1, 0), r2=0.4, r3=1.1, r4=0.8, assembly=1)
    theta2 = np.radians([20.0, 45.0, 70.0, 95.0, 120.0])
    theta3 = np.unwrap(solve_position(linkage, theta2, 1).theta3)
    task = FunctionTask(theta2 - theta2[0], theta3 - theta3[0], link="coupler")
    found = synthesize(Problem(task=task, requirements=Requirements(link_ratio_max=50.0)))
    assert found.proof is not None
    assert (found.proof.claim, found.proof.complete) == (Claim.BEST, True)
    ratios = [one.linkage.lengths / one.linkage.lengths[0] for one in found.candidates]
    assert min(float(np.abs(each - [1, 0.4, 1.1, 0.8]).max()) for each in ratios) < 1e-6
