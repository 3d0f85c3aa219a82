"""The judge in body coordinates against textbooks, triangles, energy, and published six-bars."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from body_coordinates import carried, follow, forces, gap, jacobian, margins, rates, reach, start
from body_plans import Array, Plan, plan_of
from random_linkages import GRID, ROWS, any_linkages, crank_rockers, six_bars

from grashof.problems import FourBar, InvertedSliderCrank, SixBar, SliderCrank

NORTON = {"o2": (0, 0), "o4": (100, 0), "r2": 40, "r3": 120, "r4": 80}


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


def made(row: Any, count: int, rng: np.random.Generator) -> Any:
    """A batch of a kind of linkage, or of a row of six-bars."""
    if isinstance(row, str):
        return six_bars(row, count, rng)
    return crank_rockers(count, rng) if row is FourBar else any_linkages(row, count, rng)


def angles(motion: Array, link: int) -> Array:
    """Angle of a link and its rates, shape (4, ...)."""
    return motion[..., 3 * link - 4]


@pytest.mark.parametrize("row", GRID)
def test_the_jacobian_is_the_derivative_of_the_gap(row: Any) -> None:
    rng = np.random.default_rng(1)
    plan = plan_of(made(row, 5, rng))
    q, way = rng.normal(size=(2, 5, 3 * plan.moving))
    slope = gap(plan, np.stack([q, way]), np.zeros((2, 1)))[1]
    np.testing.assert_allclose((jacobian(plan, q) @ way[..., None])[..., 0], slope, rtol=0, atol=1e-13)
    step = q + 1e-6 * way, q - 1e-6 * way  # and the gap's own series against plain differences
    difference = [gap(plan, place[None], np.zeros((1, 1)))[0] for place in step]
    np.testing.assert_allclose((difference[0] - difference[1]) / 2e-6, slope, rtol=0, atol=1e-8)


@pytest.mark.parametrize(("assembly", "theta3", "theta4"), [(1, 20.30, 57.33), (-1, -60.98, -98.01)])
def test_nortons_four_bar(assembly: int, theta3: float, theta4: float) -> None:
    """Norton, *Design of Machinery*, example 4-1: open and crossed."""
    plan = plan_of(FourBar(**NORTON, assembly=assembly))
    q = start(plan, np.radians(40))
    found = np.degrees(q[0, [5, 8]])
    np.testing.assert_allclose((found - [theta3, theta4] + 180) % 360 - 180, 0, atol=0.01)


def test_nortons_rates() -> None:
    """The same linkage, omega2 = 25 and alpha2 = 15: examples 6-7 and 7-1."""
    plan = plan_of(FourBar(**NORTON))
    motion = rates(plan, start(plan, np.radians(40)), 25.0, 15.0)
    np.testing.assert_allclose(motion[1, 0, [5, 8]], [-4.121, 6.998], atol=5e-4)
    np.testing.assert_allclose(motion[2, 0, [5, 8]], [296.089, 470.134], atol=1e-3)


@pytest.mark.parametrize(("assembly", "travel"), [(1, 126.84), (-1, -86.84)])
def test_nortons_slider_crank(assembly: int, travel: float) -> None:
    """r2 = 40, r3 = 120, offset -20 mm, theta2 = 60 deg: *Design of Machinery*, example 4-2."""
    plan = plan_of(SliderCrank(o2=(0, 0), r2=40, r3=120, offset=-20, assembly=assembly))
    q = start(plan, np.radians(60))
    assert q[0, 6] == pytest.approx(travel, abs=5e-3)
    assert q[0, 7] == pytest.approx(-20)


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


def test_the_rod_of_a_crank_shaper_points_at_its_pivot() -> None:
    plan = plan_of(InvertedSliderCrank(o2=(1, 2), o4=(1, -3), r2=2))
    t = np.linspace(0.3, 6.5, 30)
    motion = rates(plan, follow(plan, start(plan, 0.3), 0.3, t))
    way, speed = 1 - 3j - (1 + 2j + 2 * np.exp(1j * t)), -2j * np.exp(1j * t)
    np.testing.assert_allclose(np.exp(1j * angles(motion, 3)[0, :, 0]), way / np.abs(way), atol=1e-13)
    turn = (way.conj() * speed).imag / np.abs(way) ** 2
    np.testing.assert_allclose(angles(motion, 3)[1, :, 0], turn, atol=1e-13)
    # A moment on the block is held at the drive by way of the angular velocities alone.
    torque = forces(plan, motion, {}, [(4, (0.0, 0.0), (0.0, 0.0), 5.0)])["torque"]
    np.testing.assert_allclose(torque[:, 0], -5 * turn, atol=1e-12)


def test_a_parallelogram_moves_its_coupler_in_parallel_up_to_its_change_points() -> None:
    plan = plan_of(FourBar((0, 0), (3, 0), 2, 3, 2, (1.0, 0.5)))
    q, t = start(plan, 1.0), np.linspace(0.1, 3.0, 20)
    motion = rates(plan, follow(plan, q, 1.0, t), 1.5)
    np.testing.assert_allclose(np.exp(1j * angles(motion, 3)[0]), 1, atol=1e-12)
    np.testing.assert_allclose(angles(motion, 3)[1:], 0, atol=1e-9)
    np.testing.assert_allclose(angles(motion, 4)[1], 1.5, atol=1e-9)
    # A mass on the coupler pulls with m omega^2 r2, which needs no torque.
    found = forces(plan, motion, {3: (2.0, 0.7, (1.0, 0.5))})
    np.testing.assert_allclose(found["torque"], 0, atol=1e-9)
    out = np.stack([np.cos(t), np.sin(t)], axis=-1)
    np.testing.assert_allclose(found["o2"][:, 0] + found["o4"][:, 0], -2 * 1.5**2 * 2 * out, atol=1e-9)
    np.testing.assert_allclose(reach(plan, q, 1.0)[:, 0], [0, np.pi], atol=1e-6)


def test_drivers_stop_where_triangles_do() -> None:
    """Law of cosines for a triple-rocker; a slider-rocker whose rod stands square to its slide."""
    rocker = plan_of(FourBar((0, 0), (4, 0), 2, 2, 3))
    end = np.arccos((4**2 + 2**2 - 5**2) / (2 * 4 * 2))
    np.testing.assert_allclose(reach(rocker, start(rocker, 0.2), 0.2)[:, 0], [-end, end], atol=1e-10)
    slider = plan_of(SliderCrank((0, 0), 2, 1))
    np.testing.assert_allclose(
        reach(slider, start(slider, 0.1), 0.1)[:, 0], [-np.pi / 6, np.pi / 6], atol=1e-10
    )
    block = plan_of(InvertedSliderCrank((0, 0), (0, 3), 2, 2.0))
    dead = reach(block, start(block, 0.0), 0.0)[:, 0]
    apart = np.abs(3j - 2 * np.exp(1j * dead))
    np.testing.assert_allclose(apart, 2, atol=1e-10)
    full = plan_of(FourBar((0, 0), (4, 0), 1, 4, 3))
    assert reach(full, start(full, 0.0), 0.0).tolist() == [[-np.inf], [np.inf]]


def test_what_cannot_be_assembled_is_nan() -> None:
    plan = plan_of(FourBar((0, 0), (4, 0), [1, 1, 2], [1, 4, 2], [1, 3, 3]))
    q = start(plan, [0.0, 0.0, 0.2], guesses=40)
    assert np.isfinite(q).all(axis=-1).tolist() == [False, True, True]
    assert np.isnan(reach(plan, q, 0.0)[:, 0]).all()
    followed = follow(plan, q, [0.0, 0.0, 0.2], [-3.0, 0.5, 3.0])
    assert np.isfinite(followed).all(axis=-1).T.tolist() == [[False] * 3, [True] * 3, [False, True, False]]


@pytest.mark.parametrize("row", GRID)
def test_work_is_the_change_of_energy_and_the_ground_bears_the_rest(row: Any) -> None:
    """Under an uneven driver, gravity, a force of constant direction and a constant moment on each link."""
    rng = np.random.default_rng(3)
    plan = plan_of(made(row, 6, rng))
    links = range(2, plan.moving + 2)
    count, pull = len(plan.size), np.array([0.7, -9.81])
    masses = {
        k: (rng.uniform(0.5, 2, count), rng.uniform(0.1, 1, count), rng.normal(size=(count, 2)))
        for k in links
    }
    loads = [
        (k, rng.normal(size=(count, 2)), rng.normal(size=(count, 2)), rng.normal(size=count)) for k in links
    ]
    nodes, weights = np.polynomial.legendre.leggauss(60)
    time = np.concatenate([[-0.25], 0.25 * nodes, [0.25]])
    q = follow(plan, start(plan, 0.4), 0.4, 0.4 + 2 * time + 0.3 * np.sin(time))
    driver = (2 + 0.3 * np.cos(time), -0.3 * np.sin(time), -0.3 * np.cos(time))
    motion = rates(plan, q, *(part[:, None] for part in driver))
    found = forces(plan, motion, masses, loads, pull)

    energy, push, moment = np.zeros(q.shape[:2]), np.zeros((*q.shape[:2], 2)), np.zeros(q.shape[:2])
    for k, (mass, inertia, centre) in masses.items():
        place, speed, force, _ = carried(motion, k, centre)
        force = mass[:, None] * (force - pull)
        energy += mass * ((speed**2).sum(-1) / 2 - place @ pull) + inertia * angles(motion, k)[1] ** 2 / 2
        push, moment = push + force, moment + cross(place, force) + inertia * angles(motion, k)[2]
    for k, at, force, turn in loads:
        place = carried(motion, k, at)[0]
        energy -= (place * force).sum(-1) + turn * angles(motion, k)[0]
        push, moment = push - force, moment - cross(place, force) - turn
    work = 0.25 * np.einsum("n,nk->k", weights, (found["torque"] * driver[0][:, None])[1:-1])
    good = (np.abs(margins(plan, q)) > 0.1).all(axis=(0, 2))
    assert good.sum() >= 2
    np.testing.assert_allclose(
        work[good], (energy[-1] - energy[0])[good], rtol=0, atol=1e-9 * scale(energy[:, good])
    )

    by_ground, about_origin = from_ground(plan, motion, found)
    strong = scale(found["o2"][:, good])
    np.testing.assert_allclose((push - by_ground)[:, good], 0, atol=1e-9 * strong)
    np.testing.assert_allclose((moment - about_origin - found["torque"])[:, good], 0, atol=1e-8 * strong)


def from_ground(plan: Plan, motion: Array, found: dict[str, Array]) -> tuple[Array, Array]:
    """What the ground exerts on the moving links: force, and moment about the origin."""
    force, moment = np.zeros((*motion.shape[1:-1], 2)), np.zeros(motion.shape[1:-1])
    for name, *ends in plan.pins:
        for end, sign in zip(ends, (-1, 1), strict=True):
            if plan.bodies[end] == 1:
                at = np.stack([plan.at[:, end].real, plan.at[:, end].imag], axis=-1)
                force, moment = force + sign * found[name], moment + sign * cross(at, found[name])
    for name, point, line, number in plan.slots:
        if plan.bodies[line] == 1:
            at = np.stack([plan.at[:, point].real, plan.at[:, point].imag], axis=-1)
            normal = np.stack([-np.sin(plan.angles[:, number]), np.cos(plan.angles[:, number])], axis=-1)
            across, place = found[name][..., None] * normal, carried(motion, plan.bodies[point], at)[0]
            force, moment = force + across, moment + cross(place, across) + found[f"{name} moment"]
    return force, moment


def cross(arm: Array, force: Array) -> Array:
    return np.asarray(arm[..., 0] * force[..., 1] - arm[..., 1] * force[..., 0])


def scale(values: Array) -> float:
    return float(np.abs(values).max())


@pytest.mark.parametrize("row", ROWS)
def test_six_bars_turn_and_stand_where_newton_finds_them_anew(row: Any) -> None:
    batch = six_bars(row, 20, np.random.default_rng(5))
    plan = plan_of(batch)
    q = start(plan, 0.0)
    assert np.isfinite(q).all()
    turned = 2 * np.pi * np.array([0.0, 0.2, 0.4, 0.7, 1.0])
    found = follow(plan, q, 0.0, turned)
    clear = (np.abs(margins(plan, found)) > 0.05).all(axis=(0, 2))
    assert clear.sum() >= 10
    assert np.abs(gap(plan, found[None], turned[None, :, None])[0, :, clear]).max() < 1e-11 * plan.size.max()
    for place, theta in zip(found, turned, strict=True):
        anew = start(plan, theta, seed=1) - place
        anew[:, 2::3] = (anew[:, 2::3] + np.pi) % (2 * np.pi) - np.pi
        np.testing.assert_allclose(anew[clear], 0, atol=1e-10 * plan.size.max())


@pytest.mark.parametrize("row", ROWS)
def test_six_bars_stop_where_either_loop_does(row: Any) -> None:
    """The dyad is stretched or folded there, or its rod stands square to its slide: on the four-bar alone."""
    batch = six_bars(row, 20, np.random.default_rng(6), turning=False)
    (hosts, press), plan = ROWS[row], plan_of(batch)
    q = start(plan, 0.5, guesses=40)
    first = plan_of(FourBar(batch.o2, batch.o4, batch.r2, batch.r3, batch.r4, (0, 0), batch.assembly))
    standing = start(first, 0.5)
    stopped = 0
    ends = reach(plan, q, 0.5)
    for dead in ends:
        here = np.isfinite(dead)
        at = rates(first, follow(first, standing, 0.5, np.where(here, dead, 0.5)[None]))
        c = carried(at, hosts[0], batch.c)[0, 0]
        if not press:
            apart = np.linalg.norm(carried(at, hosts[1], batch.d)[0, 0] - c, axis=-1)
            missed = np.minimum(
                np.abs(batch.r5 + batch.r6 - apart), np.abs(np.abs(batch.r5 - batch.r6) - apart)
            )
        else:
            along = np.stack([np.cos(batch.slide_angle_2), np.sin(batch.slide_angle_2)], axis=-1)
            missed = np.abs(np.abs(cross(along, c - batch.o2) - batch.offset_2) - batch.r5)
        np.testing.assert_allclose(missed[here], 0, atol=1e-8)
        stopped += here.sum()
    assert stopped >= 6
    low, high = ends
    turn = np.linspace(-2, 3, 21)[:, None]
    found = np.isfinite(follow(plan, q, 0.5, turn * np.ones(len(q)))).all(axis=-1)
    assert (found == ((turn > low) & (turn < high))).all()


def test_forces_go_through_links_without_mass() -> None:
    """A load on link 5 of a Stephenson III: link 6 bears along DE, and both ends of link 5 bear the load."""
    batch = six_bars("pins 3 1", 10, np.random.default_rng(8))
    plan = plan_of(batch)
    motion, load = rates(plan, start(plan, 1.0)), np.array([2.0, -3.0])
    found = forces(plan, motion, {}, [(5, (0.1, 0.2), load, 0.0)])
    tip = np.stack([batch.r6, 0 * batch.r6], axis=-1)
    along = carried(motion, 6, tip)[0] - carried(motion, 6, (0.0, 0.0))[0]
    np.testing.assert_allclose(cross(along, found["e"]), 0, atol=1e-11)  # on link 5 by 6
    np.testing.assert_allclose(found["d"], found["e"], atol=1e-11)  # on link 6 by the ground
    np.testing.assert_allclose(found["c"], found["e"] + load, atol=1e-11)  # on link 3 by 5


def test_klanns_leg() -> None:
    """Stride and lift of the foot, and how little of the turn it is close to the ground."""
    plan, t = plan_of(KLANN), np.linspace(0, 2 * np.pi, 2001)[:-1]
    foot = carried(rates(plan, follow(plan, start(plan, 0.0), 0.0, t)), 5, KLANN.coupler_point)[0, :, 0]
    stride, lift = np.ptp(foot, axis=0)
    assert stride == pytest.approx(1.0087, abs=5e-5)
    assert lift == pytest.approx(0.5273, abs=5e-5)
    assert np.mean(foot[:, 1] < foot[:, 1].min() + 0.02 * lift) == pytest.approx(0.085, abs=1e-3)


def test_the_dwell_of_a_course_project() -> None:
    """Swing of link 6, and the longest rotations of the crank over which it stays within bands."""
    plan, t = plan_of(DWELL), np.linspace(0, 2 * np.pi, 3601)
    output = np.degrees(follow(plan, start(plan, 0.0), 0.0, t)[:, 0, 14])
    assert np.ptp(output) == pytest.approx(15.83, abs=5e-3)
    assert output[-1] == pytest.approx(output[0], abs=1e-10)
    twice = np.concatenate([output[:-1], output])
    for band, dwell in ((0.1, 103.0), (0.5, 138.5), (1.0, 159.8), (2.0, 185.9)):
        assert longest(twice, band) * 0.1 == pytest.approx(dwell, abs=0.15)


def longest(values: Array, band: float) -> int:
    """The most steps over which samples stay within a band, by two hands."""
    best = first = 0
    for last in range(len(values)):
        while np.ptp(values[first : last + 1]) > band:
            first += 1
        best = max(best, last - first)
    return best
