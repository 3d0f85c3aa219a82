"""Starts: the discrete choices that they carry."""

import pickle
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.problems import Objective
from grashof.synth.programme.start import Start, Terms
from grashof.synth.quantities.kinds import FOUR_BAR
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Screened

bounded = settings(max_examples=25)
angle = st.floats(-3, 3)


def start_with(theta1: float, theta2: tuple[float, ...]) -> Start:
    o2, a = 0.5 - 0.2j, 0.5 - 0.2j + 0.7 * np.exp(1j * theta2[0])
    return Start(
        o2=o2,
        o4=o2 + 2 * complex(np.exp(1j * theta1)),
        a=complex(a),
        b=complex(a + 1.5),
        p=complex(a + 0.6 + 0.4j),
        visit=tuple(range(len(theta2))),
        theta2=theta2,
        theta3=tuple(0.3 * angle for angle in theta2),
        direction=1 if theta2[-1] > theta2[0] else -1,
        assembly=1,
        kind=FOUR_BAR,
    )


def test_lengths_and_directions() -> None:
    start = start_with(0.4, (0.1, 0.5))
    assert start.theta1 == pytest.approx(0.4, abs=1e-12)
    r4 = abs(start.b - start.o4)
    assert start.lengths == pytest.approx((2, 0.7, 1.5, r4), rel=1e-12)
    assert start.points.tolist() == [start.o2, start.o4, start.a, start.b, start.p]


@bounded
@given(angle, angle, st.floats(-6.2, 6.2))
def test_half_turns_tell_how_often_the_driver_lies_along_the_ground(
    theta1: float, begin: float, sweep: float
) -> None:
    first, last = start_with(theta1, (begin, begin + sweep)).half_turns
    way = begin - theta1 + np.linspace(0, sweep, 20_001)
    if np.abs(np.sin(way[[0, -1]])).min() > 1e-3:
        crossed = np.diff(np.sign(np.sin(way))) != 0
        towards = np.cos(way[:-1][crossed]) > 0
        passed = range(min(first, last) + 1, max(first, last) + 1)
        assert len(passed) == crossed.sum()
        # Even numbers are passed with O2A towards O4.
        assert sum(number % 2 == 0 for number in passed) == towards.sum()


def test_a_start_of_a_pair_is_that_pair(
    luggage_scaled: Callable[..., ScaledProblem], feasible_pairs: Callable[[ScaledProblem], Screened]
) -> None:
    scaled = luggage_scaled()
    pairs = feasible_pairs(scaled)
    objective = Objective(transmission=0.5, compactness=2)
    for index in range(0, len(pairs), max(1, len(pairs) // 10)):
        start = Start.of_screened(pairs, index, objective)
        assert start.points.tobytes() == pairs.points[index].tobytes()
        assert start.terms == Terms(objective)
        places = scaled.motion.apply(np.array([start.a]))[0][list(start.visit)]
        arms = places - start.o2
        np.testing.assert_allclose(np.exp(1j * np.array(start.theta2)), arms / np.abs(arms), atol=1e-9)
        assert (start.direction * np.diff(start.theta2) > 0).all()
        assert abs(start.theta2[-1] - start.theta2[0]) < 2 * np.pi


def test_a_start_pickles() -> None:
    start = start_with(0.4, (0.1, 0.5))
    assert pickle.loads(pickle.dumps(start)) == start
