"""The frame of the search, a shift and a scale, and the way back from pivots to linkages."""

from collections.abc import Callable
from dataclasses import fields

import numpy as np
import pytest
from circles import pivots_of
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import solve_position
from grashof.analysis.judge.planted import planted_motion
from grashof.problems import Box, FourBar, MotionTask, ProblemError, Requirements
from grashof.synth.quantities.frame import Frame
from grashof.synth.quantities.scaled_problem import ScaledProblem

bounded = settings(max_examples=25)
point = st.tuples(st.floats(-50, 50), st.floats(-50, 50))


def luggage_task() -> MotionTask:
    return MotionTask.from_degrees([[5, 4, 0], [3.5, 4, -5], [2, 3, -5], [1, 0, 0]])


@pytest.mark.parametrize("seed", range(5))
def test_the_targets_have_size_one_about_the_origin(seed: int) -> None:
    task, _ = planted_motion(np.random.default_rng(seed), poses=4)
    placed = Frame.of(task).inward(task.positions)
    assert abs(placed.mean()) < 1e-12
    assert np.abs(placed[:, None] - placed).max() == pytest.approx(1, rel=1e-12)


def test_a_pure_rotation_is_scaled_by_its_angle_length() -> None:
    task = MotionTask.from_degrees([[3, 1, a] for a in (0, 20, 50, 90)], angle_length=2.5)
    frame = Frame.of(task)
    assert frame == Frame(3 + 1j, 2.5)


@bounded
@given(st.lists(point, min_size=1, max_size=5))
def test_outward_undoes_inward(points: list[tuple[float, float]]) -> None:
    frame, places = Frame(3 - 7j, 0.4), np.array(points)
    np.testing.assert_allclose(frame.outward(frame.inward(places)), places, atol=1e-12)
    turned = np.array([[places]])
    assert frame.inward(turned).shape == (1, 1, len(points))
    assert frame.outward(frame.inward(turned)).shape == turned.shape


@bounded
@given(point, point, point)
def test_a_box_holds_the_same_points_in_the_frame(
    place: tuple[float, float], corner: tuple[float, float], other: tuple[float, float]
) -> None:
    frame = Frame.of(luggage_task())
    (x0, x1), (y0, y1) = (sorted(pair) for pair in zip(corner, other, strict=True))
    wanted = frame.requirements(Requirements(o2=Box((x0, x1), (y0, y1)), b=Box(x=(x0, np.inf))))
    inside = frame.inward(np.array(place))
    assert wanted.o2 is not None
    assert wanted.b is not None
    margin = min(abs(place[0] - x0), abs(place[0] - x1), abs(place[1] - y0), abs(place[1] - y1))
    if margin > 1e-9:
        held = x0 < place[0] < x1 and y0 < place[1] < y1
        (low_x, high_x), (low_y, high_y) = wanted.o2.x, wanted.o2.y
        assert held == (low_x < inside.real < high_x and low_y < inside.imag < high_y)
        assert (place[0] > x0) == (inside.real > wanted.b.x[0])
    assert wanted.b.x[1] == np.inf
    assert wanted.b.y == (-np.inf, np.inf)


def test_lengths_become_sizes_and_the_rest_stays() -> None:
    task = luggage_task()
    given_ = Requirements(
        link_length=(0.3, 8), r3=(1, 2), coupler_arms=(0.5, 4), transmission_min_deg=12, ground_angle_deg=-30
    )
    wanted = Frame.of(task).requirements(given_)
    size = np.sqrt(32)
    assert wanted.link_lengths[0] == pytest.approx((0.3 / size, 8 / size), rel=1e-14)
    assert wanted.link_lengths[2] == pytest.approx((1 / size, 2 / size), rel=1e-14)
    assert wanted.coupler_arms == pytest.approx((0.5 / size, 4 / size), rel=1e-14)
    assert (wanted.transmission_min_deg, wanted.ground_angle_deg) == (12, -30)


def test_defaults_are_filled_in_sizes() -> None:
    wanted = Frame.of(luggage_task()).requirements(Requirements())
    assert wanted.link_length == pytest.approx((0.01, 20), rel=1e-14)
    assert wanted.coupler_arms == pytest.approx((0, 30), rel=1e-14)
    assert wanted.o2 == wanted.b == Box()


PlantedSetup = Callable[..., tuple[ScaledProblem, FourBar]]


@pytest.mark.parametrize("seed", range(5))
def test_displacements_carry_the_body_and_the_dyads(planted_scaled: PlantedSetup, seed: int) -> None:
    scaled, linkage = planted_scaled(seed)
    targets = scaled.frame.inward(scaled.problem.task.positions)
    np.testing.assert_allclose(scaled.motion.apply(np.array([scaled.targets[0]]))[0], targets, atol=1e-12)
    o2, _, a, b, _ = pivots_of(scaled, linkage)
    places = scaled.motion.apply(np.array([a, b]))
    theta2 = np.angle(places[0] - o2)
    state = solve_position(linkage, theta2)
    np.testing.assert_allclose(scaled.frame.inward(state.a), places[0], atol=1e-9)
    np.testing.assert_allclose(scaled.frame.inward(state.b), places[1], atol=1e-9)


def test_a_batch_is_its_members(planted_scaled: PlantedSetup) -> None:
    scaled, linkage = planted_scaled(0)
    one = pivots_of(scaled, linkage)
    other = one + np.array([0.1, -0.2j, 0.3, 0.1j, 0.2])
    batch = scaled.linkages(np.array([one, other]), np.array([1.0, -1.0]))
    assert batch.shape == (2,)
    for member, points, assembly in ((batch[0], one, 1.0), (batch[1], other, -1.0)):
        alone = scaled.linkages(points, np.array(assembly))
        # NumPy rounds complex products of arrays and of single numbers differently.
        for field in fields(FourBar):
            np.testing.assert_allclose(getattr(member, field.name), getattr(alone, field.name), rtol=1e-13)


def test_coinciding_joints_are_refused(planted_scaled: PlantedSetup) -> None:
    scaled, linkage = planted_scaled(0)
    points = pivots_of(scaled, linkage)
    points[2] = points[0]
    with pytest.raises(ProblemError, match="r2"):
        scaled.linkages(points, np.array(1.0))
