"""Functions of a cylinder's length: pairs, lengths and rates of listed designs by circles that meet."""

from dataclasses import replace

import numpy as np
import pytest

from grashof.analysis import Verdict, driver_ranges, verify, worst_transmission
from grashof.problems import Box, Cylinder, CylinderSpec, FourBar, FunctionTask, Problem, Requirements
from grashof.problems.values.arrays import FloatArray
from grashof.synth import Candidate, synthesize
from grashof.synth.search.plain import plain, restored


def angles_at(jack: Cylinder, linkage: FourBar, theta2: float, lengths: FloatArray) -> FloatArray:
    """theta2 at which the pivot on link 2 is at a distance from the base: two circles meet in it."""
    out = complex(*jack.base) - complex(*linkage.o2)
    far, arm = abs(out), abs(complex(*jack.point))
    along = (far**2 + arm**2 - lengths**2) / (2 * far)
    both = [out / far * (along + 1j * side * np.sqrt(arm**2 - along**2)) for side in (1, -1)]
    turned = [np.unwrap(np.angle(place) - np.angle(complex(*jack.point))) for place in both]
    every = [each + 2 * np.pi * np.round((theta2 - each[0]) / (2 * np.pi)) for each in turned]
    return min(every, key=lambda each: abs(each[0] - theta2))


def theta4_of(linkage: FourBar, theta2: FloatArray) -> FloatArray:
    """theta4 of a four-bar from the circles about A and O4."""
    a = complex(*linkage.o2) + linkage.r2 * np.exp(1j * theta2)
    o4 = complex(*linkage.o4)
    far, to_o4 = np.abs(o4 - a), (o4 - a) / np.abs(o4 - a)
    foot = (far**2 + linkage.r3**2 - linkage.r4**2) / (2 * far)
    # B lies left of the directed line from A to O4 where the assembly is +1.
    b = a + to_o4 * (foot + 1j * linkage.assembly * np.sqrt(linkage.r3**2 - foot**2))
    return np.unwrap(np.angle(b - o4))


def check(each: Candidate, problem: Problem, within: float) -> None:
    """Pairs and limits of the cylinder, from the numbers of linkage and cylinder."""
    linkage, jack, spec, verdict = each.linkage, each.verdict.cylinder, problem.driver, each.verdict
    assert isinstance(linkage, FourBar)
    assert jack is not None
    assert spec is not None
    assert jack.on == "driver"
    pivot = complex(*linkage.o2) + complex(*jack.point) * np.exp(1j * verdict.theta2[0])
    first = abs(pivot - complex(*jack.base))
    theta2 = angles_at(jack, linkage, float(verdict.theta2[0]), first + problem.task.inputs)
    np.testing.assert_allclose(theta2, verdict.theta2, atol=1e-7)
    sense = np.sign(theta2[-1] - theta2[0])
    output = sense * theta4_of(linkage, theta2)
    assert np.ptp(output - problem.task.outputs) <= 2 * within
    assert each.values["cylinder_closed"] == pytest.approx(first, rel=1e-9)
    assert each.values["cylinder_stroke"] == pytest.approx(problem.task.inputs[-1], rel=1e-9)
    low, high = spec.closed or (0.0, np.inf)
    assert low * (1 - 1e-9) <= first <= high * (1 + 1e-9)
    assert first + problem.task.inputs[-1] <= spec.ratio_max * first * (1 + 1e-9)
    for place, side in zip(jack.base, (spec.base.x, spec.base.y) if spec.base else [], strict=False):
        assert side[0] - 1e-6 <= place <= side[1] + 1e-6


def planted(seed: int, count: int) -> tuple[FourBar, Cylinder, FunctionTask]:
    """A random four-bar that swings, driven by a random cylinder, and pairs of it by circles."""
    rng = np.random.default_rng(seed)
    while True:
        r1, r2, r3, r4 = rng.uniform(100, 300, 4)
        linkage = FourBar((0, 0), (r1, 0), r2, r3, r4, assembly=int(rng.choice([-1, 1])))
        low, high = driver_ranges(linkage)[0]
        sense = int(rng.choice([-1, 1]))
        if high - low < 1.2:
            continue
        turn = rng.uniform(0.8, min(2.2, high - low - 0.2))
        start = low + 0.1 + rng.uniform(0, high - low - 0.2 - turn)
        ends = [start, start + turn][::sense]
        if np.degrees(worst_transmission(linkage, *ends)) < 15:
            continue
        arm, opening = rng.uniform(0.4, 1.0) * r2, rng.uniform(0.2, np.pi - 0.2 - turn)
        base = arm * rng.uniform(1, 4) * np.exp(1j * (ends[0] - sense * opening))
        jack = Cylinder("driver", (base.real, base.imag), (arm, 0))
        first, last = (abs(arm * np.exp(1j * end) - base) for end in ends)
        lever = [
            np.degrees(np.arccos((arm**2 + length**2 - abs(base) ** 2) / (2 * arm * length)))
            for length in (first, last)
        ]
        if last > 1.65 * first or min(lever) < 15 or max(lever) > 165:
            continue
        inputs = np.linspace(0, last - first, count)
        theta4 = theta4_of(linkage, angles_at(jack, linkage, float(ends[0]), first + inputs))
        if np.ptp(theta4) > 0.3:
            return linkage, jack, FunctionTask(inputs, sense * (theta4 - theta4[0]), lengthens=True)


def problem_of(linkage: FourBar, task: FunctionTask, **limits: object) -> Problem:
    wanted = Requirements(
        rotatability="any", o2=Box((0, 0), (0, 0)), o4=Box((linkage.r1, linkage.r1), (0, 0)), **limits
    )
    return Problem(task=task, requirements=wanted, driver=CylinderSpec(ratio_max=1.7, on=["driver"]))


@pytest.mark.parametrize("seed", range(12))
def test_the_judge_accepts_planted_linkages_and_no_other_length(seed: int) -> None:
    linkage, jack, task = planted(seed, 6)
    problem = problem_of(linkage, task)
    judged = verify(linkage, task, problem.requirements, problem=problem, cylinder=jack)
    assert judged.ok
    assert judged.output_error.max() < 1e-9
    longer = replace(jack, point=(1.01 * jack.point[0], jack.point[1]))
    assert not verify(linkage, task, problem.requirements, problem=problem, cylinder=longer).ok
    for other in (None, Cylinder("output", jack.base, jack.point)):
        verdict = verify(linkage, task, problem.requirements, problem=problem, cylinder=other)
        assert any(each.requirement.startswith("driver.cylinder") for each in verdict.defects)


@pytest.mark.parametrize("seed", range(4))
def test_rates_are_quotients_of_differences(seed: int) -> None:
    linkage, jack, task = planted(seed, 401)
    slope = np.gradient(task.outputs, task.inputs)
    at = np.array([100, 300])
    for low, high, missed in ((0.999, 1.001, 0), (3.0, 4.0, 2), (0.1, 0.2, 2)):  # missed from every start
        bands = np.sort(np.outer(slope[at], [low, high]), axis=1)
        limited = replace(task, rates=np.column_stack([task.inputs[at], bands]))
        problem = problem_of(linkage, limited, exact=False)
        verdict = verify(linkage, limited, problem.requirements, problem=problem, cylinder=jack)
        assert [each.requirement for each in verdict.defects] == ["function.rate"] * missed
        found = [each.found / limited.rate_unit for each in verdict.defects]
        np.testing.assert_allclose(found, slope[at[:missed]], rtol=1e-3)


@pytest.mark.parametrize("limit", ["closed", "lever"])
def test_the_judge_begins_where_limits_of_the_cylinder_are_kept(limit: str) -> None:
    linkage, jack, task = planted(2, 12)
    noisy = replace(task, outputs=task.outputs + 0.01 * np.sin(40 * task.inputs / task.inputs[-1]))
    problem = problem_of(linkage, noisy, exact=False)
    base, arm = abs(complex(*jack.base)), abs(complex(*jack.point))

    def judged(problem: Problem) -> tuple[Verdict, float, float]:
        """The verdict, the closed length, and the least angle between cylinder and arm at both ends, deg."""
        made = verify(linkage, noisy, problem.requirements, problem=problem, cylinder=jack)
        first = abs(complex(*jack.point) * np.exp(1j * made.theta2[0]) - complex(*jack.base))
        ends = first + noisy.inputs[[0, -1]]
        lever = np.arccos((arm**2 + ends**2 - base**2) / (2 * arm * ends))
        return made, first, float(np.degrees(np.minimum(lever, np.pi - lever).min()))

    free, first, lever = judged(problem)
    assert free.ok
    if limit == "closed":
        bound = replace(problem, driver=CylinderSpec(ratio_max=1.7, closed=(1.002 * first, 2 * first)))
    else:
        wanted = replace(problem.requirements, cylinder_angle_min_deg=lever + 0.1)
        bound = replace(problem, requirements=wanted)
    kept, first_kept, lever_kept = judged(bound)
    assert kept.defects == ()
    assert kept.square > free.square
    assert first_kept / first == pytest.approx(1.002, abs=1e-8) or limit != "closed"
    assert lever_kept == pytest.approx(lever + 0.1, abs=1e-6) or limit != "lever"


@pytest.mark.slow
@pytest.mark.quick("0-5", "1-8")
@pytest.mark.parametrize("count", [3, 5, 8])
@pytest.mark.parametrize("seed", range(2))
def test_planted_functions_are_found(seed: int, count: int) -> None:
    linkage, _, task = planted(seed, count)
    problem = problem_of(linkage, task)
    found = synthesize(problem, enough=3)
    assert len(found)
    for each in found.candidates:
        check(each, problem, 1e-6)
    again = restored(plain(found.best), problem)
    assert again.verdict.cylinder == found.best.verdict.cylinder


KINDS = {
    "four-bar": ("output", [0, 20, 42]),
    "coupler of a four-bar": ("coupler", [0, -12, -20]),
    "inverted-slider-crank": ("output", [0, 20, 42]),
    "slider-crank": ("output", [0, 60, 130]),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_is_found_and_without_limits_its_size_suits_the_stroke(kind: str) -> None:
    link, outputs = KINDS[kind]
    travels = kind == "slider-crank"
    task = FunctionTask(
        [0, 50, 100], outputs if travels else np.radians(outputs), lengthens=True, link=link, travels=travels
    )
    wanted = Requirements(rotatability="any")
    problem = Problem(
        task=task, requirements=wanted, mechanism=kind.split()[-1], driver=CylinderSpec(closed=(200, 600))
    )
    found = synthesize(problem, enough=2)
    assert len(found)
    for each in found.candidates:
        assert each.verdict.output_error.max() < 1e-6 * (130 if travels else 1)
        assert 200 - 1e-6 <= each.values["cylinder_closed"] <= 600 + 1e-6
        assert 1 < np.max(each.linkage.lengths) < 1e4
