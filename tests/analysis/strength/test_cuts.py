"""Every cut of a bar in equilibrium: the part before it in global axes, its mass by Gauss's rule."""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof import analysis
from grashof.analysis import AppliedForce, Body, Dynamics, GrashofClass, Kinematics, Loads, Masses, Spring
from grashof.analysis.forces.loads import placed_loads
from grashof.analysis.mechanism.first_loop import FOUR_BAR_CLASSES
from grashof.problems import FourBar

Floats = npt.NDArray[np.float64]
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]
LINKS = (2, 3, 4)


def cross(first: Any, second: Any) -> Floats:
    return np.asarray(first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0])


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
    length, moments, none = (
        float(getattr(state.linkage, f"r{link}")),
        found.joint_moments,
        np.zeros(state.shape),
    )

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
    for load in placed_loads(state, loads):
        if load.link == link:
            yield pushed(load.at, load.force)._replace(couple=load.moment)


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
            *(analysis.AppliedMoment(link, float(rng.normal())) for link in LINKS),
            analysis.AppliedMoment(int(rng.integers(2, 5)), lambda state: np.sin(state.theta4), at=at()),
        ),
        springs=(
            Spring(1, at(), int(rng.integers(2, 5)), at(), 3.0, 0.3 * size, 0.5),
            Spring(2, at(), 3, at(), 1.0, 0.1),
            Spring(4, at(), 3, at(), 1.0, 0.1, 0.2),
        ),
        torsion_springs=tuple(analysis.TorsionSpring(analysis.Joint(k), 2.0, 0.3) for k in range(4)),
        friction=analysis.Friction(
            rng.random(4), rng.random(4), 0.003 * float(linkage.lengths.min()) if pins else 0.0
        ),
    )  # fmt: skip


def random_masses(rng: np.random.Generator, linkage: FourBar) -> Masses:
    """Bars, plates, point masses and bodies of any inertia, one upon the other."""
    size = float(linkage.lengths.mean())
    links = []
    for link in LINKS:
        body = analysis.uniform_bar(
            getattr(linkage, f"r{link}"), 1.0 + rng.random(), 0.2 * size * rng.random()
        )
        for _ in range(int(rng.integers(0, 4))):
            inertia = size**2 * rng.choice([0.0, 0.01, 1.0, 30.0]) * rng.random()
            body = body + Body(rng.random() * rng.choice([0.0, 1.0, 5.0]), inertia, size * rng.normal(size=2))
        links.append(body)
    plate = analysis.triangular_plate(linkage.r3, linkage.coupler_point, 0.3 / size)
    return Masses(links[0], links[1] + plate, links[2]).with_payload(2.0, linkage.coupler_point)


@pytest.mark.slow
@pytest.mark.quick("crank-rocker")
@pytest.mark.parametrize("kind", FOUR_BAR_CLASSES)
@given(data=st.data())
@settings(max_examples=12)
def test_every_cut_is_in_equilibrium(four_bars: Drawer, kind: GrashofClass, data: st.DataObject) -> None:
    linkage = data.draw(four_bars(kind))
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32)))
    low, high = analysis.driver_ranges(linkage)[0]
    theta2 = low + (high - low) * rng.uniform(0.02, 0.98, 4)
    state = analysis.solve_kinematics(linkage, theta2, rng.normal(), rng.normal())
    masses, loads = random_masses(rng, linkage), random_loads(rng, linkage, pins=bool(rng.integers(2)))
    found = analysis.inverse_dynamics(state, masses, loads)
    clear = np.isfinite(found.torque)  # pins may lock the linkage
    for link, bar in analysis.section_forces(state, masses, loads, found).items():
        first, last = bar.stations[0, 0], bar.stations[0, -1]
        cuts = np.concatenate([rng.uniform(first, last, 6), [first + 1e-6 * last, last * (1 - 1e-6)]])
        values = np.stack(bar.at(cuts))[:, clear]
        every = [cut_by_equilibrium(state, link, masses, loads, found, cut) for cut in cuts]
        expected = np.stack(every, axis=-1)[:, clear]
        along = np.stack(bar.at(np.linspace(first, last, 40)))[:, clear]
        peak = np.abs(along).max(axis=-1, keepdims=True) + 1e-12
        peak[:2] = peak[:2].max(axis=0)
        peak[2] += peak[0] * (last - first)
        assert (np.abs(values - expected) < 1e-9 * peak).all()
        # The far end, beyond which nothing is.
        assert (np.abs(np.stack(bar.rest)[:, clear]) < 1e-9 * peak[..., 0]).all()


@pytest.mark.parametrize("smallest_mu", [1e-3, 1e-5])
def test_the_far_end_closes_close_to_dead_positions(smallest_mu: float) -> None:
    rng = np.random.default_rng(5)
    for _ in range(4):
        # At theta2 = 0 the diagonal is r1 - r2, and mu little.
        r2, r3 = rng.uniform(0.5, 1.5), rng.uniform(2.5, 4.0)
        r4 = rng.uniform(2.0, 4.0)
        diagonal = np.sqrt(r3**2 + r4**2 - 2 * r3 * r4 * np.cos(smallest_mu))
        linkage = FourBar(o2=(0, 0), o4=(r2 + diagonal, 0), r2=r2, r3=r3, r4=r4, coupler_point=(1, 1))
        state = analysis.solve_kinematics(linkage, [0.0, 1e-4, 0.1], -2.0)
        masses, loads = random_masses(rng, linkage), random_loads(rng, linkage, pins=False)
        for bar in analysis.section_forces(state, masses, loads).values():
            cuts = np.linspace(bar.stations[0, 0], bar.stations[0, -1], 40)
            for value, rest, along in zip(bar.at(cuts), bar.rest, (1, 1, np.ptp(cuts)), strict=True):
                peak = np.maximum(
                    np.abs(value).max(axis=-1), along * np.abs(bar.at(cuts).normal).max(axis=-1)
                )
                assert (np.abs(rest) < 1e-9 * peak).all()
