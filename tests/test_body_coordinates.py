"""The judge in body coordinates compared with textbooks, triangles and published six-bars."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from body_coordinates import carried, follow, forces, gap, jacobian, rates, reach, start
from body_plans import Array, plan_of
from random_linkages import any_linkages, six_bars

from grashof.problems import FourBar, InvertedSliderCrank, SixBar, SliderCrank


def apex(base: float, left: float, right: float) -> tuple[float, float]:
    """A triangle's apex to the left of its base, from the base's first end."""
    u = (base**2 + left**2 - right**2) / (2 * base)
    return u, np.sqrt(left**2 - u**2)


# US patent 6,260,862: lengths between its numbered points; the foot is on link 5.
KLANN = SixBar(
    o2=(1.599, 0.750), o4=(1.009, 0.574), r2=0.268, r3=0.590, r4=0.3206, assembly=-1,
    hosts=(3, 1), c=apex(0.590, 1.1051, 0.5221) * np.array([1, -1]), d=(1.366, 1.366), r5=0.8966, r6=0.5177,
    assembly_2=1, coupler_point=apex(0.8966, 0.8966, 1.732) * np.array([1, -1]), point_link=5,
)  # fmt: skip
# A course project's six-bar: the arm of 62.89 at 21.89 deg from the coupler carries C.
DWELL = SixBar(
    o2=(0, 0), o4=(46.55, 0), r2=27.33, r3=59.07, r4=61.29, assembly=1,
    hosts=(3, 1), c=62.89 * np.array([np.cos(np.radians(21.89)), np.sin(np.radians(21.89))]),
    d=(77.51, 31.26), r5=71.95, r6=45.19, assembly_2=-1,
)  # fmt: skip


@pytest.mark.parametrize("kind", [SliderCrank, InvertedSliderCrank, "pins 2 4", "slide 3 1"])
def test_the_jacobian_is_the_derivative_of_the_gap(kind: Any) -> None:
    rng = np.random.default_rng(1)
    plan = plan_of((six_bars if isinstance(kind, str) else any_linkages)(kind, 5, rng))
    q, way = rng.normal(size=(2, 5, 3 * plan.moving))
    slope = gap(plan, np.stack([q, way]), np.zeros((2, 1)))[1]
    np.testing.assert_allclose((jacobian(plan, q) @ way[..., None])[..., 0], slope, rtol=0, atol=1e-13)
    step = q + 1e-6 * way, q - 1e-6 * way  # and the gap's own series against plain differences
    difference = [gap(plan, place[None], np.zeros((1, 1)))[0] for place in step]
    np.testing.assert_allclose((difference[0] - difference[1]) / 2e-6, slope, rtol=0, atol=1e-8)


def test_a_centred_slider_crank_has_its_closed_forms() -> None:
    """x = r cos(t) + s with s^2 = l^2 - r^2 sin^2(t), differentiated; a piston's torque and side thrust."""
    r, rod, speed, push = 0.4, 1.1, 3.0, 7.0
    plan = plan_of(SliderCrank(o2=(0, 0), r2=r, r3=rod))
    t = np.linspace(0.1, 6.1, 40)
    motion = rates(plan, follow(plan, start(plan, 0.1), 0.1, t), speed)
    s = np.sqrt(rod**2 - (r * np.sin(t)) ** 2)
    s1 = -(r**2) * np.sin(2 * t) / (2 * s)
    s2 = -(r**2 * np.cos(2 * t) + s1**2) / s
    s3 = (2 * r**2 * np.sin(2 * t) - 3 * s1 * s2) / s
    by_angle = [r * np.cos(t) + s, -r * np.sin(t) + s1, -r * np.cos(t) + s2, r * np.sin(t) + s3]
    expected = [value * speed**k for k, value in enumerate(by_angle)]
    np.testing.assert_allclose(motion[:, :, 0, 6], expected, rtol=0, atol=1e-12)
    found = forces(plan, motion, {}, [(4, (0.0, 0.0), (-push, 0.0), 0.0)])
    # Virtual work, and the rod's inclination (Norton, sec. 13.7).
    np.testing.assert_allclose(found["torque"][:, 0], push * by_angle[1], atol=1e-12)
    np.testing.assert_allclose(found["slide"][:, 0], push * r * np.sin(t) / s, atol=1e-12)
    np.testing.assert_allclose(found["slide moment"], 0, atol=1e-12)


def test_a_parallelogram_carries_its_coupler_without_turning_it() -> None:
    """A mass on the coupler pulls with m omega^2 r2, which needs no torque; change points end the motion."""
    plan = plan_of(FourBar((0, 0), (3, 0), 2, 3, 2, (1.0, 0.5)))
    q, t = start(plan, 1.0), np.linspace(0.1, 3.0, 20)
    motion = rates(plan, follow(plan, q, 1.0, t), 1.5)
    np.testing.assert_allclose(motion[1:, ..., 5], 0, atol=1e-9)
    found = forces(plan, motion, {3: (2.0, 0.7, (1.0, 0.5))})
    np.testing.assert_allclose(found["torque"], 0, atol=1e-9)
    out = np.stack([np.cos(t), np.sin(t)], axis=-1)
    np.testing.assert_allclose(found["o2"][:, 0] + found["o4"][:, 0], -2 * 1.5**2 * 2 * out, atol=1e-9)
    np.testing.assert_allclose(reach(plan, q, 1.0)[:, 0], [0, np.pi], atol=1e-6)


def test_linkages_that_cannot_be_assembled_are_nan() -> None:
    plan = plan_of(FourBar((0, 0), (4, 0), [1, 1, 2], [1, 4, 2], [1, 3, 3]))
    q = start(plan, [0.0, 0.0, 0.2], guesses=40)
    assert np.isfinite(q).all(axis=-1).tolist() == [False, True, True]
    assert np.isnan(reach(plan, q, 0.0)[:, 0]).all()
    followed = follow(plan, q, [0.0, 0.0, 0.2], [-3.0, 0.5, 3.0])
    assert np.isfinite(followed).all(axis=-1).T.tolist() == [[False] * 3, [True] * 3, [False, True, False]]


def test_klanns_leg() -> None:
    """Stride and lift of the foot, and the share of the turn close to the ground."""
    plan, t = plan_of(KLANN), np.linspace(0, 2 * np.pi, 2001)[:-1]
    foot = carried(rates(plan, follow(plan, start(plan, 0.0), 0.0, t)), 5, KLANN.coupler_point)[0, :, 0]
    stride, lift = np.ptp(foot, axis=0)
    assert stride == pytest.approx(1.0087, abs=5e-5)
    assert lift == pytest.approx(0.5273, abs=5e-5)
    assert np.mean(foot[:, 1] < foot[:, 1].min() + 0.02 * lift) == pytest.approx(0.085, abs=1e-3)


def test_the_dwell_of_a_course_project() -> None:
    """Swing of link 6, and the longest rotations of the crank over which it stays within bands."""
    plan, t = plan_of(DWELL), np.linspace(0, 2 * np.pi, 1801)
    output = np.degrees(follow(plan, start(plan, 0.0), 0.0, t)[:, 0, 14])
    assert np.ptp(output) == pytest.approx(15.83, abs=5e-3)
    assert output[-1] == pytest.approx(output[0], abs=1e-10)
    twice = np.concatenate([output[:-1], output])
    for band, dwell in ((0.1, 103.0), (0.5, 138.5), (1.0, 159.8), (2.0, 185.9)):
        assert longest(twice, band) * 0.2 == pytest.approx(dwell, abs=0.25)


def longest(values: Array, band: float) -> int:
    """The most steps over which samples stay within a band, by two pointers."""
    best = first = 0
    for last in range(len(values)):
        while np.ptp(values[first : last + 1]) > band:
            first += 1
        best = max(best, last - first)
    return best
