"""Slider-cranks through four poses: those that meet a problem are in its pieces, and no bound is too low."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import proof_problems
import pytest
from piece_descent import Descent, descent, of_table
from scipy.optimize import least_squares

from grashof.analysis import verify
from grashof.problems import Box, Problem, SliderCrank
from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.synth import Claim, prove
from grashof.synth.proof.curve.sliding import Slide
from grashof.synth.proof.curve.table import Table
from grashof.synth.proof.poses.cranks import Cranks
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.burmester import Displacements, Dyads, trace_four_pose_curves

planted = partial(proof_problems.planted, mechanism="slider-crank")
random_poses = partial(proof_problems.random_poses, poses=4, turned=90, mechanism="slider-crank")


def motion_of(problem: Problem) -> Displacements:
    """Of the poses, in the problem's unit."""
    task = problem.task
    return Displacements.from_poses(task.positions @ [1, 1j], task.angles)


def sliding_point(motion: Displacements, reach: float) -> complex:
    """The point of the body whose four places lie on a line, by least squares from many starts."""

    def misses(at: FloatArray) -> FloatArray:
        z = motion.apply(np.array([complex(*at)]))[0]
        a = z[1:] - z[0]
        return np.array([(a[i].conj() * a[j]).imag for i, j in ((0, 1), (0, 2), (1, 2))]) / reach**2

    rng = np.random.default_rng(0)
    found = [
        least_squares(misses, rng.normal(0, reach, 2), xtol=1e-15, ftol=1e-15, gtol=1e-15) for _ in range(8)
    ]
    best = min(found, key=lambda one: float(one.cost))
    assert best.cost < 1e-20
    return complex(*best.x)


def slider_cranks(problem: Problem, most: int, seed: int = 0) -> list[SliderCrank]:
    """Slider-cranks through four poses, from cranks of traced curves; not judged."""
    motion, size = motion_of(problem), problem.task.size
    b = motion.apply(np.array([sliding_point(motion, 3 * size)]))[0]
    along = max(b - b[0], key=abs)
    along = along / abs(along)
    dyads = trace_four_pose_curves(motion, 20 * size, 200, 0.02 * size)
    order = np.random.default_rng(seed).permutation(len(dyads))[:most]
    p = problem.task.positions[0] @ [1, 1j]
    made = []
    for a, o2 in zip(dyads.moving[order], dyads.ground[order], strict=True):
        rod = b[0] - a
        arm = (p - a) * abs(rod) / rod
        made.append(
            SliderCrank(
                o2=(o2.real, o2.imag),
                r2=abs(a - o2),
                r3=abs(rod),
                offset=(along.conjugate() * (b[0] - o2)).imag,
                slide_angle=np.angle(along),
                coupler_point=(arm.real, arm.imag),
                assembly=1 if (along.conjugate() * rod).real > 0 else -1,
                body_angle=problem.task.angles[0] - np.angle(rod),
            )
        )
    return made


@dataclass(frozen=True)
class Designs:
    """Cranks of linkages that the judge accepts, in the frame of a proof, and what they transmit, rad."""

    dyads: Dyads
    transmission: FloatArray
    linkages: tuple[SliderCrank, ...]


def accepted(problem: Problem, linkages: list[SliderCrank]) -> Designs:
    """The linkages that the judge accepts."""
    scaled = ScaledProblem.of(problem)
    size, begin = scaled.frame.scale, problem.task.positions[0] @ [1, 1j]
    found: list[tuple[complex, complex, float, SliderCrank]] = []
    for one in linkages:
        verdict = verify(one, problem.task, problem.requirements, problem=problem)
        key = problem.requirements.transmission_over
        transmitted = float(getattr(verdict, f"transmission_min_{key}"))
        if verdict.ok and transmitted > 2e-4:
            o2 = complex(*one.o2)
            a = o2 + complex(one.r2) * np.exp(1j * verdict.theta2[0])
            found.append(((a - begin) / size, (o2 - begin) / size, transmitted, one))
    a, o2, least = (np.array([each[k] for each in found]) for k in range(3))
    return Designs(Dyads(a, o2), least, tuple(each[3] for each in found))


def cranks_of(problem: Problem) -> Cranks:
    scaled = ScaledProblem.of(problem)
    scaled = replace(scaled, motion=Displacements.from_poses(scaled.targets, scaled.turns))
    curve = Cranks.curve_of(scaled)
    slide = Slide.of(curve)
    assert slide is not None
    return Cranks.of(scaled, slide)


def followed(problem: Problem, designs: Designs, levels: int = 10) -> Descent:
    """Follow designs down halves of pieces, each with its own transmission angle as the threshold."""
    cranks = cranks_of(problem)
    assert cranks.may_slide
    table = Table.covering(cranks.required)

    def left(pieces: list[IntArray], least: FloatArray) -> tuple[IntArray, FloatArray]:
        some = table.pieces[pieces[0]]
        return cranks.rows_left(some.tubes.span, some.centres.span, some.sense, least)

    cover = of_table(table, table.pieces.driver, designs.dyads, (1e-8, 1e-11, 1e-9))
    return descent([cover], designs.transmission, left, levels)


CASES = {
    "planted": planted(0),
    "over the turn": planted(1, transmission_over="cycle"),
    "any rotatability": planted(2, rotatability="any"),
    "any order": planted(3, rotatability="any", order=False),
    "any order and branch": planted(4, order=False, same_branch=False, transmission_over="cycle"),
    "a wide margin": planted(6, rotatability_margin=0.03),
    "sense and rotation": planted(7, driver_sense="ccw", driver_rotation_deg=(30, 300)),
    "random": random_poses(2, rotatability="any", order=False),
}


@pytest.mark.quick("any order and branch", "sense and rotation")
@pytest.mark.parametrize("name", CASES)
def test_no_linkage_is_lost_or_bounded_too_low(name: str) -> None:
    problem = CASES[name]
    designs = accepted(problem, slider_cranks(problem, 100))
    assert len(designs.dyads) > 4
    descent = followed(problem, designs)
    assert (descent.lost, descent.excluded) == (0, 0)
    assert descent.nearest < np.radians(0.1)  # sharp: a bound that is 0.1 deg too low would show


@pytest.mark.slow
@pytest.mark.quick("2012")
@pytest.mark.parametrize("seed", [11, 12, 2012])
def test_no_linkage_of_a_dense_sampling_exceeds_the_bound(seed: int) -> None:
    problem = planted(seed) if seed < 100 else random_poses(seed, rotatability="any")
    proof = prove(problem)
    designs = accepted(problem, slider_cranks(problem, 200, seed=1))
    assert proof.upper is not None
    assert np.degrees(designs.transmission.max(initial=0.0)) <= proof.upper + 1e-6
    assert (proof.claim is Claim.NONE) == (not len(designs.dyads))
    if proof.lower is not None:
        assert proof.upper <= proof.lower + 0.01 + 1e-9


def around(value: float, off: float = 1e-6) -> tuple[float, float]:
    return max(value - off, 0.0), value + off


def limits_of(designs: Designs, k: int, problem: Problem) -> list[dict[str, object]]:
    """Limits that a design is within by 1e-6 of their unit."""
    one, motion = designs.linkages[k], motion_of(problem)
    verdict = verify(one, problem.task, problem.requirements, problem=problem)
    o2, size = complex(*one.o2), problem.task.size
    theta = verdict.theta2
    a = o2 + complex(one.r2) * np.exp(1j * theta)
    b = motion.apply(np.array([sliding_point(motion, 3 * size)]))[0]
    place = (a[0] - problem.task.positions[0] @ [1, 1j]) * np.exp(-1j * problem.task.angles[0])
    arms = abs(complex(*one.coupler_point)), abs(b[0] - problem.task.positions[0] @ [1, 1j])
    lengths = float(one.r2), float(one.r3)
    offset = float(one.offset)
    sense = "ccw" if theta[-1] > theta[0] else "cw"
    turned = abs(float(np.degrees(theta[-1] - theta[0])))

    def box(*points: complex) -> Box:
        x, y = np.real(points), np.imag(points)
        return Box((x.min() - 1e-6, x.max() + 1e-6), (y.min() - 1e-6, y.max() + 1e-6))

    return [
        {
            "r2": around(lengths[0]), "r3": around(lengths[1]), "o2": box(o2),
            "link_ratio_max": max(lengths) / min(lengths) + 1e-6,
            "coupler_arms": (min(arms) - 1e-6, max(arms) + 1e-6),
        },
        {"offset": (offset - 1e-6, offset + 1e-6), "a": box(*a), "b": box(*b), "a_on_body": box(place)},
        {"slide_angle_deg": float(np.degrees(one.slide_angle)), "offset": (offset - 1e-6, offset + 1e-6)},
        {"slide_angle_deg": (float(np.degrees(one.slide_angle)) + 179, np.degrees(one.slide_angle) + 190)},
        {"driver_sense": sense, "driver_rotation_deg": around(turned)},
        {
            "theta2_start_deg": float(np.degrees(theta[0])),
            "transmission_min_deg": float(np.degrees(designs.transmission[k])) - 1e-6,
        },
    ]  # fmt: skip


@pytest.mark.slow
@pytest.mark.quick("0")
@pytest.mark.parametrize("seed", [0, 1, 4])
def test_limits_that_include_a_design_are_never_proven_to_have_none(seed: int) -> None:
    problem = planted(seed)
    designs = accepted(problem, slider_cranks(problem, 100))
    for number, limits in enumerate(limits_of(designs, seed, problem)):
        required = replace(problem, requirements=replace(problem.requirements, **limits))  # type: ignore[arg-type]
        proof = prove(required)
        assert proof.claim in (Claim.BEST, Claim.BOUND), (number, limits, proof)
        assert proof.upper is not None
        assert np.degrees(designs.transmission[seed]) <= proof.upper + 1e-6, limits
