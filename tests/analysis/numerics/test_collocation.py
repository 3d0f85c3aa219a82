"""Motions of one unknown: closed forms, jumps, stiff damping, events, and no motion at all."""

import numpy as np
import pytest
from scipy.special import ellipk

from grashof.analysis.numerics.collocation import integrate_motion
from grashof.problems import SolverError

TIME = np.linspace(0, 30, 301)


def test_a_spring() -> None:
    path = integrate_motion(lambda t, x, v, a: -4 * x, 0.0, 30.0, 1.0, 3.0)
    place, speed, acceleration = path.at(TIME)
    exact = np.cos(2 * TIME) + 1.5 * np.sin(2 * TIME)
    np.testing.assert_allclose(place, exact, atol=1e-12)
    np.testing.assert_allclose(acceleration, -4 * exact, atol=1e-11)
    np.testing.assert_allclose(speed**2 + 4 * place**2, 13, rtol=1e-13)


def test_the_period_of_a_pendulum() -> None:
    start = 2.5
    path = integrate_motion(
        lambda t, x, v, a: -np.sin(x), 0.0, 100.0, start, 0.0, events=lambda x, v: x[None]
    )
    assert path.event == 0
    assert path.end == pytest.approx(ellipk(np.sin(start / 2) ** 2), rel=1e-13)


def test_an_acceleration_that_depends_on_itself() -> None:
    """x" = -x + 0.3 x", with the guess iterated."""
    path = integrate_motion(lambda t, x, v, a: -x + 0.3 * a, 0.0, 10.0, 1.0, 0.0)
    time = TIME[TIME <= 10]
    np.testing.assert_allclose(path.at(time)[0], np.cos(time / np.sqrt(0.7)), atol=1e-11)


def test_jumps_and_kinks() -> None:
    path = integrate_motion(lambda t, x, v, a: np.where(x < 2, 1.0, -1.0), 0.0, 4.0, 0.0, 1.0)
    hit = np.sqrt(5) - 1  # t + t^2 / 2 = 2
    top = np.sqrt(5)  # speed there
    time = np.linspace(0, 4, 41)
    late = np.maximum(time - hit, 0)
    exact = np.where(time < hit, time + time**2 / 2, 2 + top * late - late**2 / 2)
    np.testing.assert_allclose(path.at(time)[0], exact, atol=1e-9)
    bent = integrate_motion(lambda t, x, v, a: np.abs(np.sin(3 * t)), 0.0, 4.0, 0.0, 0.0)
    half = np.pi / 3
    speed = 2 / 3 * np.floor(time / half) + (1 - np.cos(3 * (time % half))) / 3
    np.testing.assert_allclose(bent.at(time)[1], speed, atol=1e-10)


def test_strong_damping() -> None:
    path = integrate_motion(lambda t, x, v, a: -1e4 * v, 0.0, 1.0, 0.0, 1.0)
    assert path.at(np.array([1.0]))[0] == pytest.approx(1e-4, rel=1e-9)
    assert len(path.panels) < 60


def test_events_count_once_they_have_been_above() -> None:
    """Thrown up from the ground: it counts when it comes back, not at the start."""
    path = integrate_motion(
        lambda t, x, v, a: np.full(t.shape, -2.0), 1.0, 9.0, 0.0, 3.0, events=lambda x, v: x[None]
    )
    assert path.end == pytest.approx(4.0, rel=1e-13)
    place, speed = path.panels[-1].last()
    assert abs(place) < 1e-13
    assert speed == pytest.approx(-3.0, rel=1e-13)
    over = integrate_motion(lambda t, x, v, a: 0 * t, 0.0, 1.0, 0.0, 0.0, events=lambda x, v: x[None])
    assert (over.event, over.end) == (None, 1.0)


def test_where_there_is_no_motion() -> None:
    with pytest.raises(SolverError, match="no acceleration at its start"):
        integrate_motion(lambda t, x, v, a: np.full(t.shape, np.nan), 0.0, 1.0, 0.0, 1.0)
    with pytest.raises(SolverError, match="could not be integrated"):
        integrate_motion(lambda t, x, v, a: np.where(x < 0.5, 1.0, np.nan), 0.0, 9.0, 0.0, 1.0)
    # An event before that place ends it in time.
    path = integrate_motion(
        lambda t, x, v, a: np.where(x < 0.5, 0.0, np.nan), 0.0, 9.0, 0.0, 1.0,
        events=lambda x, v: 0.49 - x[None],
    )  # fmt: skip
    assert path.end == pytest.approx(0.49, rel=1e-12)
