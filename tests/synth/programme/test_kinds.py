"""Kinds of linkage and starts in the search against the analysis, which shares no formula with them."""

import pickle
from collections.abc import Callable

import numpy as np
import pytest
from circles import points_of
from hypothesis import given, settings
from hypothesis import strategies as st
from known_designs import as_found

from grashof.analysis import output_stroke, solve_position, transmission_angle, verify
from grashof.analysis.judge.planted import RANDOM
from grashof.analysis.mechanism.mobility import full_rotation
from grashof.problems import Linkage, Objective, PathTask, Problem
from grashof.synth.loop.dimensions import dimensions_of, sized_loop
from grashof.synth.programme.start import Start, Terms
from grashof.synth.quantities.kinds import FOUR_BAR, KINDS
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Many, Screened

EVERY = tuple(KINDS)
SLIDERS = EVERY[1:]


def scaled_of(mechanism: str) -> ScaledProblem:
    points = [[0, 0], [1, 0.2], [1.6, 0.9], [1.5, 1.8]]
    return ScaledProblem.of(Problem(task=PathTask(points), mechanism=mechanism))


def drawn(mechanism: str, rng: np.random.Generator) -> tuple[ScaledProblem, Linkage, float, Many]:
    """A linkage at a driver angle, and as the search sees it."""
    scaled, linkage = scaled_of(mechanism), as_found(RANDOM[mechanism](rng))
    theta2 = float(rng.uniform(-3, 3))
    o2, o4, a, b, p = points_of(scaled, linkage, theta2)[:, None]
    view = Many(p, o2, a[:, None], o4, b[:, None], np.array([[theta2]]), kind=scaled.kind)
    return scaled, linkage, theta2, view


@pytest.mark.parametrize("mechanism", EVERY)
def test_a_linkage_comes_back_from_its_points(mechanism: str) -> None:
    scaled, rng = scaled_of(mechanism), np.random.default_rng(4)
    for _ in range(30):
        linkage = as_found(RANDOM[mechanism](rng))
        points = points_of(scaled, linkage, float(rng.uniform(-3, 3)))
        back = scaled.linkages(points, linkage.assembly, linkage.body_angle)
        for row, one, other in zip(
            linkage.mechanism.parameters, linkage.parameters, back.parameters, strict=True
        ):
            turned = np.angle(np.exp(1j * (one - other))) if row.kind == "angle" else one - other
            np.testing.assert_allclose(turned, 0, atol=1e-9, err_msg=row.name)
        dyad, e2 = scaled.kind.dyad, np.exp(1j * np.angle(points[2:3] - points[0]))
        loop = sized_loop(dyad, dimensions_of(dyad, points), e2, np.array([linkage.assembly]))
        assert abs(loop.coupler[0] - (points[3] - points[2])) < 1e-9
        assert abs(loop.o4 - points[1]) < 1e-9


@pytest.mark.parametrize("mechanism", EVERY)
def test_transmission_and_rotatability(mechanism: str) -> None:
    kind, rng = KINDS[mechanism], np.random.default_rng(8)
    for _ in range(40):
        _, linkage, theta2, view = drawn(mechanism, rng)
        cosine = kind.dyad.cos_mu(view, kind.dyad.reach(view, theta2 - view.theta1))
        mu = float(transmission_angle(linkage, theta2))
        assert abs(float(cosine[0, 0])) == pytest.approx(abs(np.cos(mu)), abs=1e-9)
        assert abs(float(view.sine[0, 0])) == pytest.approx(np.sin(mu), abs=1e-9)
        for reach, turned in zip(kind.dyad.along_ground(view), (0.0, np.pi), strict=True):
            there = float(kind.dyad.reach(view, np.array([[turned]]))[0, 0])
            assert float(reach[0, 0]) == pytest.approx(there, abs=1e-9)
        assert bool(kind.dyad.turns_fully(view)[0, 0]) == bool(full_rotation(linkage))


@pytest.mark.parametrize("mechanism", SLIDERS)
def test_strokes_swings_and_time_ratios(mechanism: str) -> None:
    kind, rng = KINDS[mechanism], np.random.default_rng(5)
    for _ in range(60):
        scaled, linkage, _, view = drawn(mechanism, rng)
        if not view.turns[0, 0] or view.double_crank[0, 0]:
            continue
        stroke = output_stroke(linkage)
        travel = np.hypot(*(stroke.b[1] - stroke.b[0])) / scaled.frame.scale
        way = {"stroke": travel} if mechanism == "slider-crank" else {"output_swing": stroke.swing}
        for key, expected in {"time_ratio": stroke.time_ratio, **way}.items():
            (part,) = kind.formulas[key]
            assert float(part.of(view)[0, 0]) == pytest.approx(float(expected), rel=1e-9)


@pytest.mark.parametrize("mechanism", EVERY)
def test_a_start_is_its_linkage(mechanism: str) -> None:
    scaled, rng = scaled_of(mechanism), np.random.default_rng(9)
    linkage = as_found(RANDOM[mechanism](rng))
    verdict = verify(linkage, scaled.problem.task, scaled.problem.requirements)
    start = Start.of_linkage(scaled, linkage, verdict)
    state = solve_position(linkage, np.array(start.theta2), verdict.assembly[list(start.visit)])
    track = np.stack([scaled.frame.inward(each) for each in (state.a, state.b, state.p)])
    np.testing.assert_allclose(start.track, track, atol=1e-9)
    assert np.exp(1j * start.theta1) == pytest.approx(complex(np.exp(1j * float(linkage.theta1))), abs=1e-9)


@pytest.mark.parametrize("mechanism", EVERY)
def test_a_kind_is_the_same_object_wherever_it_is_sent(mechanism: str) -> None:
    scaled = scaled_of(mechanism)
    assert pickle.loads(pickle.dumps(scaled)).kind is scaled.kind


def test_a_rod_whose_block_is_at_a_has_no_direction() -> None:
    """A start in such a dead position fails; it ends no search."""
    lengths = KINDS["inverted-slider-crank"].dyad.lengths_of(0j, 3 + 0j, 1 + 0j, 1 + 0j)
    assert lengths[:3] == (3, 1, 0)
    assert np.isnan(lengths[3])


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
