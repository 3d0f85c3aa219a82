"""Section forces: every cut in equilibrium, closed forms, a case by hand, and what must not matter."""

import warnings
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import (
    AppliedForce,
    AppliedMoment,
    BarForces,
    Body,
    Dynamics,
    Friction,
    GrashofClass,
    Joint,
    Kinematics,
    Loads,
    Masses,
    Spring,
    TorsionSpring,
    driver_ranges,
    inverse_dynamics,
    section_forces,
    solve_kinematics,
    triangular_plate,
    uniform_bar,
    uniform_bars,
)
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import DeadPositionWarning, FourBar, ProblemError

Floats = npt.NDArray[np.float64]
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]
TURN = 2 * np.pi
LINKS = (2, 3, 4)
NO_MASS = Masses(Body(0), Body(0), Body(0))
# O2A and O4B are vertical, AB is horizontal at a driver angle of 90 deg: a portal.
PORTAL = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=1)


def cross(first: Any, second: Any) -> Floats:
    return np.asarray(first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0])


# A second way: the part before a cut in global axes, its mass integrated by Gauss's rule.


class Acting(NamedTuple):
    """Something that acts on a part of a bar: where on the bar, where in the plane, force, couple."""

    foot: float
    place: Floats
    force: Floats
    couple: Floats


def foot_of(at: Floats, length: float) -> float:
    u, v = at
    if 0 <= u <= length:
        return float(u)
    joint = 0.0 if u < 0 else length
    return float(u) if abs(v) <= abs(u - joint) else joint


def stretch_of(body: Body, length: float) -> tuple[float, float]:
    """Middle and half length of the stretch over which a body is spread."""
    foot = foot_of(body.centre, length)
    if body.inertia == 0:
        return foot, 0.0
    reach = max(foot, length - foot)
    return foot, min(np.sqrt(3 * body.inertia / body.mass), reach) if body.mass > 0 else reach


def from_mass(state: Kinematics, link: int, body: Body, gravity: Floats, cut: float) -> Iterator[Acting]:
    """Inertia and weight of what lies before the cut."""
    length, alpha = float(getattr(state.linkage, f"r{link}")), state.angular(link)[2]
    foot, half = stretch_of(body, length)
    end = min(cut, foot + half)
    share = 1.0 if half == 0 else (end - (foot - half)) / (2 * half)
    if (half == 0 and foot >= cut) or share <= 0:
        return
    low = foot - half
    nodes, weights = np.polynomial.legendre.leggauss(3)
    for node, weight in zip(nodes, weights, strict=True):
        u = foot if half == 0 else low + (end - low) * (node + 1) / 2
        moved = state.point(link, body.centre + np.array([u - foot, 0.0]))
        mass = body.mass * share * weight / 2
        yield Acting(u, moved.position, -mass * (moved.acceleration - gravity), np.zeros(state.shape))
    left = body.inertia - body.mass * half**2 / 3
    nowhere = state.point(link, (0, 0)).position
    yield Acting(foot, nowhere, np.zeros((*state.shape, 2)), -left * share * alpha)


def from_loads(state: Kinematics, link: int, loads: Loads, found: Dynamics) -> Iterator[Acting]:
    linkage = state.linkage
    length = float(getattr(linkage, f"r{link}"))
    moments, still, none = found.joint_moments, np.zeros((*state.shape, 2)), np.zeros(state.shape)

    def pushed(at: Any, force: Any) -> Acting:
        place = np.asarray(at, dtype=np.float64)
        return Acting(foot_of(place, length), state.point(link, place).position, np.asarray(force), none)

    ends = {
        2: (found.f12, found.torque + moments[0], found.f32, -moments[1]),
        3: (-found.f32, moments[1], found.f43, -moments[2]),
        4: (found.f14, moments[3], -found.f43, moments[2]),
    }[link]
    yield pushed((0, 0), ends[0])._replace(couple=ends[1])
    yield pushed((length, 0), ends[2])._replace(couple=ends[3])
    for force in loads.forces:
        if force.link == link:
            value = np.asarray(force.force(state) if callable(force.force) else force.force)
            if force.turning:
                turn = np.exp(1j * state.angular(link)[0]) * (value[..., 0] + 1j * value[..., 1])
                value = np.stack([turn.real, turn.imag], axis=-1)
            yield pushed(force.at, value)
    for moment in loads.moments:
        if moment.link == link:
            at = moment.at if moment.at is not None else linkage.coupler_point if link == 3 else (0, 0)
            value = np.asarray(moment.moment(state) if callable(moment.moment) else moment.moment)
            yield pushed(at, still)._replace(couple=value)
    for spring in loads.springs:
        ends_of = [(spring.first_link, spring.first_at), (spring.second_link, spring.second_at)]
        moving = [
            (np.array(at), np.zeros(2)) if number == 1
            else (state.point(number, at).position, state.point(number, at).velocity)
            for number, at in ends_of
        ]  # fmt: skip
        way, rate = moving[1][0] - moving[0][0], moving[1][1] - moving[0][1]
        long = np.linalg.norm(way, axis=-1, keepdims=True)
        unit = way / long
        pull = unit * (spring.stiffness * (long - spring.free_length)
                       + spring.damping * (unit * rate).sum(axis=-1, keepdims=True))  # fmt: skip
        for (number, at), sign in zip(ends_of, (1, -1), strict=True):
            if number == link:
                yield pushed(at, sign * pull)


def cut_by_equilibrium(
    state: Kinematics, link: int, masses: Masses, loads: Loads, found: Dynamics, cut: float
) -> Floats:
    """Normal force, shear force and moment at a cut, from the balance of all that lies before it."""
    acting = [part for part in from_loads(state, link, loads, found) if part.foot < cut]
    for body in masses.of(link).pieces:
        acting += from_mass(state, link, body, loads.gravity_vector(), cut)
    force = sum((part.force for part in acting), np.zeros((*state.shape, 2)))
    here = state.point(link, (cut, 0)).position
    moment = sum(
        (part.couple + cross(part.place - here, part.force) for part in acting), np.zeros(state.shape)
    )
    theta = state.angular(link)[0]
    along = np.stack([np.cos(theta), np.sin(theta)], axis=-1)
    return np.stack([-(along * force).sum(axis=-1), cross(along, force), -moment])


def random_loads(rng: np.random.Generator, linkage: FourBar, pins: bool) -> Loads:
    """Several loads of every type, at points on the bars, beside them and beyond their joints."""
    size = float(linkage.lengths.mean())
    sway = rng.normal(size=2)

    def at() -> tuple[float, float]:
        u, v = size * rng.normal(size=2)
        return float(u), float(v * rng.choice([0.0, 0.2, 1.0]))

    def pair() -> tuple[float, float]:
        x, y = 5 * rng.normal(size=2)
        return float(x), float(y)

    def swaying(state: Kinematics) -> Floats:
        return np.asarray(sway * np.cos(2 * state.theta2)[..., None])

    return Loads(
        gravity=5 * rng.normal(size=2),
        forces=(
            *(AppliedForce(link, at(), pair()) for link in (2, 3, 4, *rng.integers(2, 5, 2).tolist())),
            AppliedForce(int(rng.integers(2, 5)), at(), swaying),
            AppliedForce(int(rng.integers(2, 5)), at(), pair(), turning=True),
            AppliedForce(3, (0.0, 0.0), pair()),  # on the very joint
        ),
        moments=(
            *(AppliedMoment(link, float(rng.normal())) for link in LINKS),
            AppliedMoment(int(rng.integers(2, 5)), lambda state: np.sin(state.theta4), at=at()),
        ),
        springs=(
            Spring(1, at(), int(rng.integers(2, 5)), at(), 3.0, 0.3 * size, 0.5),
            Spring(2, at(), 3, at(), 1.0, 0.1),
            Spring(4, at(), 3, at(), 1.0, 0.1, 0.2),
        ),
        torsion_springs=tuple(TorsionSpring(Joint(k), 2.0, 0.3) for k in range(4)),
        friction=Friction(
            rng.random(4), rng.random(4), 0.003 * float(linkage.lengths.min()) if pins else 0.0
        ),
    )  # fmt: skip


def random_masses(rng: np.random.Generator, linkage: FourBar) -> Masses:
    """Bars, plates, point masses and bodies of any inertia, one upon the other."""
    size = float(linkage.lengths.mean())
    links = []
    for link in LINKS:
        body = uniform_bar(getattr(linkage, f"r{link}"), 1.0 + rng.random(), 0.2 * size * rng.random())
        for _ in range(int(rng.integers(0, 4))):
            inertia = size**2 * rng.choice([0.0, 0.01, 1.0, 30.0]) * rng.random()
            body = body + Body(rng.random() * rng.choice([0.0, 1.0, 5.0]), inertia, size * rng.normal(size=2))
        links.append(body)
    plate = triangular_plate(linkage.r3, linkage.coupler_point, 0.3 / size)
    return Masses(links[0], links[1] + plate, links[2]).with_payload(2.0, linkage.coupler_point)


@pytest.mark.slow
@pytest.mark.quick("crank-rocker")
@pytest.mark.parametrize("kind", FOUR_BAR_CLASSES)
@given(data=st.data())
@settings(max_examples=12)
def test_every_cut_is_in_equilibrium(four_bars: Drawer, kind: GrashofClass, data: st.DataObject) -> None:
    linkage = data.draw(four_bars(kind))
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    low, high = driver_ranges(linkage)[0]
    theta2 = low + (high - low) * rng.uniform(0.02, 0.98, 4)
    state = solve_kinematics(linkage, theta2, rng.normal(), rng.normal())
    masses, loads = random_masses(rng, linkage), random_loads(rng, linkage, pins=bool(rng.integers(2)))
    found = inverse_dynamics(state, masses, loads)
    clear = np.isfinite(found.torque)  # pins may lock the linkage
    for link, bar in section_forces(state, masses, loads, found).items():
        first, last = bar.stations[0, 0], bar.stations[0, -1]
        cuts = np.concatenate([rng.uniform(first, last, 6), [first + 1e-6 * last, last * (1 - 1e-6)]])
        values = np.stack(bar.at(cuts))[:, clear]
        every = [cut_by_equilibrium(state, link, masses, loads, found, cut) for cut in cuts]
        expected = np.stack(every, axis=-1)[:, clear]
        whole = np.stack(bar.at(np.linspace(first, last, 40)))[:, clear]
        peak = np.abs(whole).max(axis=-1, keepdims=True) + 1e-12
        peak[:2] = peak[:2].max(axis=0)
        peak[2] += peak[0] * (last - first)
        assert (np.abs(values - expected) < 1e-9 * peak).all()
        # The far end, beyond which nothing is.
        assert (np.abs(np.stack(bar.rest)[:, clear]) < 1e-9 * peak[..., 0]).all()


@pytest.mark.parametrize("smallest_mu", [1e-3, 1e-5])
def test_the_far_end_closes_close_to_dead_positions(smallest_mu: float) -> None:
    rng = np.random.default_rng(5)
    for _ in range(20):
        # At theta2 = 0 the diagonal is r1 - r2, and mu little.
        r2, r3 = rng.uniform(0.5, 1.5), rng.uniform(2.5, 4.0)
        r4 = rng.uniform(2.0, 4.0)
        diagonal = np.sqrt(r3**2 + r4**2 - 2 * r3 * r4 * np.cos(smallest_mu))
        linkage = FourBar(o2=(0, 0), o4=(r2 + diagonal, 0), r2=r2, r3=r3, r4=r4, coupler_point=(1, 1))
        state = solve_kinematics(linkage, [0.0, 1e-4, 0.1], -2.0)
        masses, loads = random_masses(rng, linkage), random_loads(rng, linkage, pins=False)
        for bar in section_forces(state, masses, loads).values():
            cuts = np.linspace(bar.stations[0, 0], bar.stations[0, -1], 40)
            for value, rest, along in zip(bar.at(cuts), bar.rest, (1, 1, np.ptp(cuts)), strict=True):
                peak = np.maximum(
                    np.abs(value).max(axis=-1), along * np.abs(bar.at(cuts).normal).max(axis=-1)
                )
                assert (np.abs(rest) < 1e-9 * peak).all()


def test_a_simply_supported_bar_under_its_weight() -> None:
    state = solve_kinematics(PORTAL, np.pi / 2, 0.0)
    masses = Masses(Body(0), uniform_bar(4.0, 3.0), Body(0))
    bar = section_forces(state, masses, Loads(gravity=(0, -10)))[3]
    u = np.linspace(0, 4, 9)
    load, found = 30.0, bar.at(u)
    np.testing.assert_allclose(found.moment, load * u * (4 - u) / 2, atol=1e-12)
    np.testing.assert_allclose(found.shear, load * (2 - u), atol=1e-12)
    np.testing.assert_allclose(found.normal, 0, atol=1e-12)
    assert found.moment[4] == pytest.approx(load * 4**2 / 8, rel=1e-14)


@pytest.mark.parametrize("speed", [2.0, -2.0])
def test_a_rotating_bar_is_pulled_by_its_own_inertia(speed: float) -> None:
    linkage = FourBar(o2=(1, 2), o4=(5, 2), r2=1.5, r3=4, r4=3)
    masses = Masses(uniform_bar(1.5, 2.0), Body(0), Body(0))
    state = solve_kinematics(linkage, np.linspace(0, 6, 7), speed, 0.7)
    bar = section_forces(state, masses)[2]
    u = np.linspace(0, 1.5, 7)
    found, mass, gone = bar.at(u), 3.0, 1.5 - u
    pull = 2.0 * speed**2 * (1.5**2 - u**2) / 2
    np.testing.assert_allclose(found.normal, np.broadcast_to(pull, (7, 7)), atol=1e-12)
    np.testing.assert_allclose(found.normal[:, 0], mass * speed**2 * 1.5 / 2)
    # The tangential inertia of what lies beyond the cut bends it back.
    np.testing.assert_allclose(
        found.moment, np.broadcast_to(-2.0 * 0.7 * (gone**3 / 3 + u * gone**2 / 2), (7, 7)), atol=1e-12
    )


def test_a_press_by_hand() -> None:
    """Crank 2 upright, coupler 3-4-5, output 5 upright and pushed by 1000 N halfway up."""
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=5, r4=5)
    state = solve_kinematics(linkage, np.pi / 2, 0.0)
    np.testing.assert_allclose(state.b.position, (4, 5), atol=1e-14)
    loads = Loads(forces=(AppliedForce(4, (2.5, 0), (-1000.0, 0.0)),))
    bars = section_forces(state, NO_MASS, loads)
    # Moments of link 4 about O4: the coupler pushes it with 625 N along (4, 3) / 5.
    np.testing.assert_allclose(bars[3].at([0, 2, 5]).normal, -625)
    np.testing.assert_allclose(bars[3].at([0, 2, 5]).moment, 0, atol=1e-9)
    # O4 pulls link 4 down with 375 N and pushes it by 500 N, as B does.
    np.testing.assert_allclose(bars[4].at([0, 2.4, 2.6, 5]).normal, 375)
    np.testing.assert_allclose(bars[4].at([0, 2.4, 2.6, 5]).shear, [-500, -500, 500, 500])
    np.testing.assert_allclose(bars[4].at([0, 2.5, 5]).moment, [0, -1250, 0], atol=1e-9)
    # A is pushed down by 375 N, and back by 500 N, which the drive holds.
    np.testing.assert_allclose(bars[2].at([0, 2]).normal, -375)
    np.testing.assert_allclose(bars[2].at([0, 1, 2]).moment, [1000, 500, 0], atol=1e-9)


def test_a_walking_beam_bends_over_its_saddle() -> None:
    jack = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
    state = solve_kinematics(jack, np.linspace(0, 6, 13), 0.0)
    loads = Loads(forces=(AppliedForce(4, (-4.572, 0), (0.0, -20000.0)),))
    bar = section_forces(state, NO_MASS, loads)[4]
    np.testing.assert_allclose(bar.stations[:, [0, -1]], [[-4.572, 3.048762]] * 13)
    saddle = -20000 * 4.572 * np.cos(state.theta4)
    np.testing.assert_allclose(bar.at([0.0]).moment[:, 0], saddle)
    np.testing.assert_allclose(bar.at([0.0], before=True).moment[:, 0], saddle)
    np.testing.assert_allclose(bar.at([-2.286]).moment[:, 0], saddle / 2)
    np.testing.assert_allclose(bar.at([-4.572, -1]).shear, -20000 * np.cos(state.theta4)[:, None] * [1, 1])


def test_a_body_of_the_whole_beam_is_that_beam() -> None:
    """From B over O4 to the horsehead, stated by mass, centre and inertia alone."""
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=2)
    beam = uniform_bar(6.0, 2.0)
    beam = Body(beam.mass, beam.inertia, (2.0 - 3.0, 0.0))
    state = solve_kinematics(linkage, np.linspace(0, 6, 7), 0.0)
    bar = section_forces(state, Masses(Body(0), Body(0), beam), Loads(gravity=(0, -10)))[4]
    hogging = -20 * 4**2 / 2 * np.cos(state.theta4)
    np.testing.assert_allclose(bar.at([0.0]).moment[:, 0], hogging, atol=1e-12)
    assert bar.stations[0, 0] == pytest.approx(-4)


def test_wide_bars_turn_their_sections() -> None:
    """The rotary inertia of a Rayleigh beam is a couple m w^2 / 12 alpha, spread evenly."""
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1.5, r3=4, r4=3)
    state = solve_kinematics(linkage, 1.0, 0.0, 3.0)
    slender, wide = (
        section_forces(state, Masses(uniform_bar(1.5, 2.0, width), Body(0), Body(0)))[2]
        for width in (0.0, 0.5)
    )
    u = np.linspace(0, 1.5, 4)
    couple = 3.0 * 0.5**2 / 12 * 3.0 * (1.5 - u) / 1.5
    np.testing.assert_allclose(wide.at(u).moment - slender.at(u).moment, -couple, atol=1e-12)
    np.testing.assert_allclose(wide.at(u).shear, slender.at(u).shear, atol=1e-12)


def test_what_hangs_beside_a_bar_acts_through_an_arm_at_its_foot() -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=1, coupler_point=(1.0, 2.0))
    state = solve_kinematics(linkage, np.pi / 2, 0.0)
    pushed = Loads(forces=(AppliedForce(3, (1.0, 2.0), (30.0, -7.0)),))
    bar = section_forces(state, NO_MASS, pushed)[3]
    after, before = bar.at([1.0]), bar.at([1.0], before=True)
    jump = [float(new[0] - old[0]) for new, old in zip(after, before, strict=True)]
    np.testing.assert_allclose(jump, [-30, -7, 2.0 * 30], atol=1e-12)
    # The payload is a point there, too; a moment on the coupler enters at P, or where it says.
    weighted = section_forces(state, NO_MASS.with_payload(0.7, (1.0, 2.0)), Loads(gravity=(0, -10)))[3]
    assert float(weighted.at([1.0]).shear[0] - weighted.at([1.0], before=True).shear[0]) == pytest.approx(-7)
    for moment, place in ((AppliedMoment(3, 5.0), 1.0), (AppliedMoment(3, 5.0, at=(3.0, 9.0)), 3.0)):
        turned = section_forces(state, NO_MASS, Loads(moments=(moment,)))[3]
        before, after = turned.at([place], before=True), turned.at([place])
        assert float(after.moment[0] - before.moment[0]) == pytest.approx(-5)


REACHES = [((5, 0), (0, 5)), ((5, 0.9), (0, 5)), ((5, 1.1), (0, 4)), ((-2, -1), (-2, 4))]


@pytest.mark.parametrize(("at", "ends"), REACHES)
def test_the_bar_reaches_as_far_as_loads_lie_on_it(
    at: tuple[float, float], ends: tuple[float, float]
) -> None:
    state = solve_kinematics(PORTAL, 1.0, 0.0)
    bar = section_forces(state, NO_MASS, Loads(forces=(AppliedForce(3, at, (1.0, 2.0)),)))[3]
    np.testing.assert_allclose(bar.stations[[0, -1]], ends)
    assert np.isnan(bar.at([ends[0] - 0.1, ends[1] + 0.1]).moment).all()
    # Between the joints it is as if the force with its moment acted on a joint.
    joint = 4.0 if at[0] > 0 else 0.0
    turning = float(cross(np.array([at[0] - joint, at[1]]), np.array([1.0, 2.0])))
    there = AppliedForce(3, (joint, 0), (1.0, 2.0), turning=True), AppliedMoment(3, turning, at=(joint, 0))
    here = AppliedForce(3, at, (1.0, 2.0), turning=True)
    one, other = (
        section_forces(state, NO_MASS, loads)[3].at([0.1, 2.0, 3.9])
        for loads in (Loads(forces=(here,)), Loads(forces=there[:1], moments=there[1:]))
    )
    for value, expected in zip(one, other, strict=True):
        np.testing.assert_allclose(value, expected, atol=1e-12)


def test_a_beam_with_a_crank_weight_is_balanced_over_its_shaft() -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    masses = Masses(uniform_bar(1.0, 4.0) + Body(2.0, 0.0, (-1.0, 0.0)), Body(0), Body(0))
    state = solve_kinematics(linkage, np.linspace(0, 6, 7), 3.0)
    bar = section_forces(state, masses, Loads(gravity=(0, -10)))[2]
    # The weight's pull and bending on its side, the arm's on the other.
    level = np.cos(state.theta2)
    np.testing.assert_allclose(bar.at([-0.5]).moment[:, 0], -2.0 * 10 * 0.5 * level, atol=1e-12)
    pull = 2.0 * 9 + 2.0 * 10 * np.sin(state.theta2)
    np.testing.assert_allclose(bar.at([-0.5]).normal[:, 0], pull, atol=1e-12)
    np.testing.assert_allclose(bar.at([0.0]).moment[:, 0], -4.0 * 10 / 2 * level, atol=1e-12)


def of_all(bars: dict[int, BarForces]) -> Floats:
    """Values at shares of every bar's length."""
    share = np.linspace(0, 1, 7)
    found = []
    for bar in bars.values():
        low, high = bar.stations[..., :1], bar.stations[..., -1:]
        found.append(np.stack(bar.at(low + (high - low) * share)))
    return np.stack(found)


@pytest.mark.slow
@given(data=st.data())
@settings(max_examples=30)
def test_the_frame_does_not_matter(four_bars: Drawer, data: st.DataObject) -> None:
    linkage = data.draw(four_bars(GrashofClass.CRANK_ROCKER))
    turn = data.draw(st.floats(-3, 3))
    away = np.array([data.draw(st.floats(-3, 3)), 1.0])
    rng = np.random.default_rng(data.draw(st.integers(0, 999)))
    masses = random_masses(rng, linkage)
    turning = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    gravity, force, anchor = rng.normal(size=(3, 2))

    def loads(by: Floats, moved: Floats) -> Loads:
        return Loads(
            gravity=by @ gravity,
            forces=(
                AppliedForce(3, (0.5, 0.2), by @ force),
                AppliedForce(4, (-2.0, 0.1), force, turning=True),
            ),
            springs=(Spring(1, tuple(by @ anchor + moved), 4, (0.3, 0.1), 2.0, 0.5, 0.3),),
        )

    theta2 = np.array([0.3, 2.0, 5.0])
    still = section_forces(solve_kinematics(linkage, theta2, 2.0, 1.0), masses, loads(np.eye(2), np.zeros(2)))
    other = FourBar(turning @ linkage.o2 + away, turning @ linkage.o4 + away, *linkage.parameters[2:])
    moved = solve_kinematics(other, theta2 + turn, 2.0, 1.0)
    expected, found = of_all(still), of_all(section_forces(moved, masses, loads(turning, away)))
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())


def test_a_mirrored_linkage_bends_the_other_way() -> None:
    """Clockwise instead of counter-clockwise, all else mirrored in the x-axis."""
    linkage = FourBar(o2=(0, 0), o4=(4, 1), r2=1, r3=4, r4=3, coupler_point=(1, 2))
    mirrored = FourBar(o2=(0, 0), o4=(4, -1), r2=1, r3=4, r4=3, coupler_point=(1, -2), assembly=-1)
    theta2 = np.linspace(0, 6, 9)

    def bars(own: FourBar, sign: int) -> Floats:
        loads = Loads(gravity=(1, -9 * sign), forces=(AppliedForce(4, (-2, 0.3 * sign), (3.0, 4.0 * sign)),))
        state = solve_kinematics(own, sign * theta2, sign * 2.0, sign * 0.5)
        return of_all(section_forces(state, uniform_bars(own, 2.0, payload=3.0), loads))

    normal, shear, moment = np.moveaxis(bars(linkage, 1), 1, 0)
    other = np.moveaxis(bars(mirrored, -1), 1, 0)
    for own, value in zip(other, (normal, -shear, -moment), strict=True):
        np.testing.assert_allclose(own, value, atol=1e-10)


def test_batches_give_what_single_linkages_give() -> None:
    batch = FourBar(o2=(0, 0), o4=(4, 1), r2=[[1.0], [0.8]], r3=[[4.0], [3.9]], r4=3, coupler_point=(1, 2))
    loads = Loads(gravity=(0, -9.81), forces=(AppliedForce(3, (3.95, 0.0), (1.0, 2.0)),))
    theta2 = np.linspace(0, 6, 5)
    wide = [[[0.5], [2.0]], [[0.0], [1.0]]]  # one bar, one point

    def masses(own: FourBar, inertia: Any) -> Masses:
        bars = uniform_bars(own, 2.0, payload=1.0)
        return Masses(bars.crank, bars.coupler, bars.output + Body(2.0, inertia, (0.5, 0.1)))

    together = section_forces(solve_kinematics(batch, theta2), masses(batch, np.array(wide)[1]), loads)
    for index in range(2):
        own = batch[index, 0]
        state = solve_kinematics(own, theta2)
        alone = section_forces(state, masses(own, wide[1][index][0]), loads)
        for link in LINKS:
            assert together[link].stations.shape[:2] == (2, 5)
            cuts = np.linspace(0, 0.99, 7) * float(getattr(own, f"r{link}"))
            for many, one in zip(together[link].at(cuts), alone[link].at(cuts), strict=True):
                np.testing.assert_allclose(many[index], one, atol=1e-11)


def test_dead_positions_have_no_finite_section_forces() -> None:
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)
    end = driver_ranges(rocker)[0, 1]
    with pytest.warns(DeadPositionWarning):
        state = solve_kinematics(rocker, [0.0, end, 3.0])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        bars = section_forces(state, uniform_bars(rocker, 2.0), Loads(gravity=(0, -9.81)))
    for link in LINKS:
        finite = np.isfinite(bars[link].at([0.5]).moment[:, 0])
        np.testing.assert_array_equal(finite, [True, False, False])


def test_nothing_acts_in_a_linkage_without_masses_and_loads() -> None:
    state = solve_kinematics(PORTAL, np.array([0.5, 1.0]), 3.0)
    for bar in section_forces(state, NO_MASS).values():
        for value in bar.at([0.0, 0.3]):
            np.testing.assert_array_equal(value, 0)


def test_loads_on_links_that_there_are_not_are_refused() -> None:
    state = solve_kinematics(PORTAL, 1.0)
    with pytest.raises(ProblemError, match="link is 1"):
        section_forces(state, NO_MASS, Loads(forces=(AppliedForce(1, (0, 0), (1, 1)),)))
