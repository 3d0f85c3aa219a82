"""Direction and rate of the coupler, against closed forms on dense samples of the motion, for every kind."""

import cmath
from typing import Any

import numpy as np
import pytest

from grashof.analysis import verify
from grashof.analysis.judge.coupler_motion import coupler_motions
from grashof.analysis.judge.design import Design, greatest
from grashof.analysis.mechanism.position import solve_position
from grashof.problems import (
    FourBar,
    InvertedSliderCrank,
    Linkage,
    PathTask,
    Problem,
    ProblemError,
    Requirements,
    SliderCrank,
    TargetLimits,
)
from grashof.problems.values.arrays import FloatArray
from grashof.synth.quantities.target_constraints import AtTarget

LEG = FourBar(o2=(0, 0), o4=(4, 1), r2=1.5, r3=3.0, r4=2.5, coupler_point=(1.0, 0.7), assembly=1)
PRESS = SliderCrank(
    o2=(0, 0), r2=1.0, r3=2.7, offset=0.3, slide_angle=0.2, coupler_point=(1.0, 0.4), assembly=1
)
SHAPER = InvertedSliderCrank(
    o2=(0, 0), o4=(2.5, 0.5), r2=1.0, offset=0.4, coupler_point=(2.0, 0.3), assembly=1
)
RANGES = {"leg": (LEG, 0.3, 2.4), "press": (PRESS, 0.4, 3.0), "shaper": (SHAPER, -2.0, 1.9)}


def direction(linkage: Linkage, theta2: FloatArray) -> FloatArray:
    """Direction of link 3, unwrapped, by the triangle that it forms with the ground."""
    a: Any = complex(*linkage.o2) + float(linkage.r2) * np.exp(1j * theta2)
    if isinstance(linkage, FourBar):
        way = complex(*linkage.o4) - a
        cosine = (linkage.r3**2 + abs(way) ** 2 - linkage.r4**2) / (2 * linkage.r3 * abs(way))
        angle = np.angle(way) + np.arccos(cosine)
    elif isinstance(linkage, SliderCrank):
        beside = (a * cmath.exp(-1j * float(linkage.slide_angle))).imag
        angle = float(linkage.slide_angle) + np.arcsin((float(linkage.offset) - beside) / linkage.r3)
    else:
        way = complex(*linkage.o4) - a
        angle = np.angle(way) + np.arcsin(float(linkage.offset) / abs(way))
    return np.unwrap(angle)


@pytest.mark.parametrize("kind", RANGES)
def test_extremes_are_those_of_dense_samples(kind: str) -> None:
    linkage, start, end = RANGES[kind]
    dense = np.linspace(start, end, 200_001)
    theta3 = direction(linkage, dense)
    along = solve_position(linkage, dense[::40_000]).theta3  # the branch of the closed form is the linkage's
    np.testing.assert_allclose(np.exp(1j * along), np.exp(1j * theta3[::40_000]), atol=1e-12)
    task = PathTask(solve_position(linkage, np.linspace(start, end, 5)).p)
    wanted = Requirements(rotatability="any")
    problem = Problem(task=task, requirements=wanted)
    verdict = verify(linkage, task, wanted, problem=problem)
    assert verdict.ok
    (found,), rate = coupler_motions([linkage], problem, [verdict]), np.gradient(theta3, dense, edge_order=2)
    turns = 2 * np.pi * np.ceil((theta3.min() - np.pi) / (2 * np.pi))
    assert found.angle_min == pytest.approx(theta3.min() - turns, abs=1e-8)
    assert found.angle_max == pytest.approx(theta3.max() - turns, abs=1e-8)
    assert found.rate_min == pytest.approx(rate.min(), abs=1e-6)
    assert found.rate_max == pytest.approx(rate.max(), abs=1e-6)


@pytest.mark.parametrize("kept", [True, False])
@pytest.mark.parametrize("kind", RANGES)
def test_judge_and_search_see_rates_at_single_targets_of_every_kind(kind: str, kept: bool) -> None:
    linkage, start, end = RANGES[kind]
    theta2 = np.linspace(start, end, 4)
    task = PathTask(solve_position(linkage, theta2).p)
    near = theta2[2] + np.array([-1e-5, 1e-5])
    rate = float(np.diff(direction(linkage, near))[0] / 2e-5)
    asked = TargetLimits(targets=[3], coupler_rate=(rate - 1, rate + (1e-4 if kept else -1e-4)))
    wanted = Requirements(rotatability="any", at=(asked,))
    verdict = verify(
        linkage,
        task,
        wanted,
        problem=Problem(task=task, requirements=wanted, mechanism=linkage.mechanism.word),
    )
    assert [each.requirement for each in verdict.defects] == ([] if kept else ["at"])
    excess = greatest(AtTarget(asked, "coupler_rate", 2), Design.judged(linkage, verdict))
    assert (excess <= 0) == kept


def test_ranges_that_leave_no_room_are_refused() -> None:
    for given, line in (
        ({"coupler_angle_deg": (30, 30)}, r"coupler_angle_deg is \[30.0, 30.0\]; .* at least 0.1 apart"),
        ({"coupler_angle_deg": (-400, 0)}, "lo must be at least -360"),
        ({"coupler_rate": (1, 1)}, "at least 0.001 apart"),
        ({"coupler_rate": (2, 1)}, "lo exceeds hi"),
    ):
        with pytest.raises(ProblemError, match=line):
            Requirements(**given)
        with pytest.raises(ProblemError, match=line):
            TargetLimits(targets=[1], **given)
