"""Limits at single targets, against circle intersections and finite differences."""

from typing import Any

import numpy as np
import pytest

from grashof.analysis import verify
from grashof.analysis.judge.at_targets import past_toggle
from grashof.analysis.judge.design import Design, greatest
from grashof.analysis.judge.planted import random_full_crank
from grashof.problems import (
    Box,
    FourBar,
    FunctionTask,
    MotionTask,
    PathTask,
    Problem,
    ProblemError,
    Requirements,
    TargetLimits,
)
from grashof.problems.values.arrays import FloatArray
from grashof.synth.quantities.target_constraints import AtTarget

LEG = FourBar(o2=(0, 0), o4=(4, 1), r2=1.5, r3=3.0, r4=2.5, coupler_point=(1.0, 0.7), assembly=1)


def joints(theta2: float) -> tuple[complex, complex]:
    """A and B, by the intersection of two circles."""
    a, o4 = 1.5 * np.exp(1j * theta2), 4 + 1j
    way = o4 - a
    along = (9.0 + abs(way) ** 2 - 6.25) / (2 * abs(way))
    return a, a + (along + 1j * np.sqrt(9.0 - along**2)) * way / abs(way)


def output(theta2: float) -> float:
    return float(np.angle(joints(theta2)[1] - (4 + 1j)))


def task_at(theta2: FloatArray) -> PathTask:
    places = []
    for angle in theta2.tolist():
        a, b = joints(angle)
        p = a + (1.0 + 0.7j) * (b - a) / abs(b - a)
        places.append([p.real, p.imag])
    return PathTask(np.array(places))


def in_line() -> float:
    """The driver angle at which O2, A and B are stretched out."""
    from scipy.optimize import brentq

    def bend(theta2: float) -> float:
        a, b = joints(theta2)
        return float(((b - a) * np.conj(a)).imag)

    return float(brentq(bend, -0.2, 1.2))


@pytest.mark.parametrize("past", [-0.3, 0.05, 0.4])
def test_past_toggle_is_the_bend_between_driver_and_coupler(past: float) -> None:
    line = in_line()
    theta2 = np.linspace(line - 0.9, line + past, 5)
    verdict = verify(LEG, task_at(theta2), Requirements(rotatability="any"))
    assert verdict.ok
    a, b = joints(line + past)
    bend = abs(np.angle((b - a) / a))
    assert past_toggle(LEG, verdict.theta2, verdict.assembly, 4) == pytest.approx(
        np.sign(past) * bend, abs=1e-9
    )
    back = verify(LEG, task_at(theta2[::-1]), Requirements(rotatability="any"))
    assert past_toggle(LEG, back.theta2, back.assembly, 0) == pytest.approx(np.sign(past) * bend, abs=1e-9)


def figures(theta2: float) -> dict[str, float]:
    """The values that are limited, by their names."""
    a, b = joints(theta2)
    step = 1e-5
    moved = [joints(theta2 + way) for way in (-step, step)]
    turned = np.angle((moved[1][1] - moved[1][0]) / (moved[0][1] - moved[0][0]))
    centre = a + 1j * (moved[1][0] - moved[0][0]) / turned  # where the coupler has no velocity
    rate = np.angle(np.exp(1j * (output(theta2 + step) - output(theta2 - step)))) / (2 * step)
    mu = abs(np.angle((b - a) / (b - (4 + 1j))))
    found = {
        "instant_centre": centre.real,
        "distances": abs(b),
        "coupler_angle_deg": np.degrees(np.angle(b - a)),
        "coupler_rate": turned / (2 * step),
        "a": a.real,
        "b": b.imag,
        "transmission_min_deg": np.degrees(min(mu, np.pi - mu)),
    }
    return found | {
        "mechanical_advantage_min": 1 / abs(rate),
        "past_deg": np.degrees(abs(np.angle((b - a) / a))),
    }


def limits(name: str, value: float, target: int, *, kept: bool) -> TargetLimits:
    """One limit that a value keeps, or misses narrowly."""
    by = 1e-4 if kept else -1e-4
    given: Any = {
        "a": Box(x=(-np.inf, value + by)),
        "b": Box(y=(value - by, np.inf)),
        "instant_centre": Box(x=(value - by, np.inf)),
        "past_deg": (value - 5, value + by),
        "distances": {"b-o2": (0, value + by)},
        "coupler_angle_deg": (value - 360 - 50, value - 360 + by),  # a turn less is the same
        "coupler_rate": (value - 1, value + by),
    }.get(name, value - by)
    return TargetLimits(targets=[target], **{name: given})


@pytest.mark.parametrize("kept", [True, False])
@pytest.mark.parametrize(
    "name",
    ["a", "b", "instant_centre", "distances", "past_deg", "transmission_min_deg", "mechanical_advantage_min"],
)
def test_judge_and_search_see_what_is_missed(name: str, kept: bool) -> None:
    line = in_line()
    theta2 = np.linspace(line - 0.9, line + 0.2, 4)
    task, value = task_at(theta2), figures(float(theta2[3]))[name]
    asked = limits(name, value, 4, kept=kept)
    verdict = verify(LEG, task, Requirements(rotatability="any", at=(asked,)))
    assert [each.requirement for each in verdict.defects] == ([] if kept else ["at"])
    assert all("at target 4" in each.what for each in verdict.defects)
    excess = greatest(AtTarget(asked, name, 3), Design.judged(LEG, verdict))
    assert (excess <= 0) == kept


@pytest.mark.parametrize("target", [1, 5, 9])
def test_the_search_knows_from_which_side_a_long_motion_comes(target: int) -> None:
    """Over most of a turn a driver passes one line before it comes near the other."""
    rng, seen = np.random.default_rng(target), 0
    for _ in range(300):
        linkage = random_full_crank(rng)
        theta2 = rng.uniform(-3, 3) + rng.choice([-1, 1]) * np.linspace(0, rng.uniform(2, 6), 9)
        assembly = np.full(9, int(linkage.assembly))
        past = float(np.degrees(past_toggle(linkage, theta2, assembly, target - 1)))
        if abs(past) < 40:
            at = AtTarget(
                TargetLimits(targets=[target], past_deg=(past - 1, past + 1)), "past_deg", target - 1
            )
            (excess,) = at(Design.of(linkage, theta2, assembly))
            assert excess <= 0
            seen += 1
    assert seen > 50


def test_limits_at_targets_that_cannot_be_are_refused_in_a_line() -> None:
    three = MotionTask([[0, 0], [1, 0], [2, 1]], [0, 0.2, 0.4])
    late, first = (TargetLimits(targets=[number], past_deg=(2, 5)) for number in (4, 1))
    lever = TargetLimits(targets=[1], mechanical_advantage_min=2)
    for at, order, kind, line in (
        (late, True, "four-bar", r"at\[0\].targets has 4; the last target is 3"),
        (first, False, "four-bar", "order is false; it must be true"),
        (lever, True, "slider-crank", "mechanical_advantage_min"),
    ):
        wanted = Requirements(at=(at,), order=order)
        with pytest.raises(ProblemError, match=line):
            Problem(task=three, requirements=wanted, mechanism=kind)
    of_p = TargetLimits(targets=[2], distances={"b-p": (1, 2)})
    with pytest.raises(ProblemError, match=r"at\[0\].distances.b-p does not apply to a function; remove it"):
        Problem(task=FunctionTask([0, 1, 2], [0, 1, 1.5]), requirements=Requirements(at=(of_p,)))
    for wrong, line in (
        ({"targets": [0], "past_deg": (1, 2)}, "targets"),
        ({"targets": [], "past_deg": (1, 2)}, "a list of numbers of targets"),
        ({"targets": [1]}, "targets have no limit"),
        ({"targets": [1], "links": ["coupler", "driver"]}, "targets have no limit"),
        (
            {"targets": [1], "links": ["coupler", "output"], "past_deg": (2, 5)},
            "links are coupler and output, whose toggle is a dead position of the driver; exchange o2 and o4",
        ),
        ({"targets": [1], "links": "driver", "past_deg": (2, 5)}, r"links is 'driver'; it must be \["),
        ({"targets": [1], "past_deg": (3, 3)}, "at least 0.1 apart"),
        ({"targets": [1], "past_deg": (30, 50)}, "past_deg"),
    ):
        with pytest.raises(ProblemError, match=line):
            TargetLimits(**wrong)
