"""The effort of a hand by virtual work: with it, forces on every link are in balance without a drive."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from linkages_of_rows import SIX_BARS

from grashof.analysis import AppliedForce, AppliedMoment, solve_kinematics, stated_loads, stated_masses
from grashof.analysis.cylinder.travel import travel
from grashof.analysis.effort.case import EffortCase, EffortState
from grashof.analysis.effort.deviation import effort_curves, effort_figures
from grashof.analysis.effort.parts import place_on
from grashof.analysis.forces.system_of_equations import system_of_equations
from grashof.problems import Box, DynamicsSpec, FourBar, InvertedSliderCrank, Linkage, SliderCrank
from grashof.problems.values.dynamics.effort import EffortSpec
from grashof.problems.values.dynamics.load_specs import FrictionSpec
from grashof.problems.values.dynamics.struts import EffortPlace, PartSize, PartSpec

ROCKER = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2.5, r4=3, coupler_point=(1, 1), body_angle=0.4)
ENGINE = SliderCrank((0, 0), 2, 5, 0.4, 0.3, (1, 1))
SHAPER = InvertedSliderCrank((0, 0), (4, 0.3), 1.5, 0.3, (2, 1))
LINKAGES = [ROCKER, ENGINE, SHAPER, *SIX_BARS.values()]
GAS = PartSize("", 9.0, 8.0, 300.0, 420.0, friction=20.0)
PULL = PartSize("", 12.0, 11.0, 80.0, 5.0)
COIL = PartSize("", moment=0.05, turn_deg=170.0, friction=0.002)
every = pytest.mark.parametrize("linkage", LINKAGES, ids=lambda each: each.mechanism.word)


def at(link: int | str, u: float, v: float) -> EffortPlace:
    return EffortPlace(link, Box((u, u), (v, v)))


def case_of(linkage: Linkage, *, metre: float = 1e-2, **given: object) -> EffortCase:
    """Gravity, two gas struts, a tension spring and a torsion spring, over a part of the driver's range."""
    parts = (
        PartSpec("gas", (at(1, -3, -2.5), at(3, 0.5, 0.8)), (GAS,), count=2),
        PartSpec("tension", (at(2, 0.3, -0.2), at("body", 0.4, -0.7)), (PULL,)),
    )
    spec = EffortSpec(on=at(3, 1.4, 0.9), band=(0, 1), temperatures_c=(-10.0, 20.0, 40.0), parts=parts)
    links = len(linkage.mechanism.links) - 1
    dynamics = DynamicsSpec(
        masses=tuple(np.arange(1.0, links + 1)),
        inertias=(0.0,) * links,
        gravity=(1.0, -9.81),
        effort=replace(spec, **given),
    )
    ends = np.array([0.5, 1.2]) if linkage is ROCKER else np.array([1.5, 2.4])
    assembly = np.full(2, int(linkage.assembly))
    moved = travel(linkage, ends, assembly, (float(ends[0]), float(ends[1])))
    assert moved is not None
    return EffortCase(linkage, dynamics, metre, moved)


def torque_left(case: EffortCase, places: np.ndarray, state: EffortState, row: int) -> np.ndarray:
    """Torque that the driver needs, by the equations of all links, as a share of that without the hand."""
    linkage, spec = case.linkage, case.spec
    at_rest = solve_kinematics(linkage, case.travel.at(places).theta2, 0.0)
    way = solve_kinematics(linkage, at_rest.theta2, np.sign(case.travel.end - case.travel.start))
    loads, masses = stated_loads(case.dynamics, case.metre), stated_masses(linkage, case.dynamics, case.metre)
    link, point = place_on(linkage, spec.on)
    velocity = way.point(link, point).velocity
    unit = velocity / np.hypot(*velocity.T)[:, None]
    if spec.direction != "square":
        unit = np.broadcast_to(np.array(spec.direction) / np.hypot(*spec.direction), unit.shape)
    pushes, moments = [AppliedForce(link, point, state.effort[row][:, None] * unit / case.metre)], []
    for part, known in zip(spec.parts, state.parts, strict=True):
        force = known.force * part.warmth(spec.temperatures_c[row]) / case.metre
        if part.turns:
            first, second = part.joint
            moments += [AppliedMoment(second, force), *([AppliedMoment(first, -force)] if first > 1 else [])]
            continue
        out = (known.ends[1] - known.ends[0]) / known.length[:, None]
        for sign, place in zip((-1, 1), part.places, strict=True):
            on, where = place_on(linkage, place)
            if on > 1:
                pushes.append(AppliedForce(on, where, sign * force[:, None] * out))
    weight = np.abs(system_of_equations(at_rest, masses, loads).solution[:, -1]).max()
    given = replace(loads, forces=tuple(pushes), moments=tuple(moments))
    return np.asarray(system_of_equations(at_rest, masses, given).solution[:, -1] / weight)


@every
def test_forces_are_in_balance_at_each_temperature(linkage: Linkage) -> None:
    case = case_of(linkage)
    places, state = effort_curves(case, 15)
    for row in range(3):
        assert np.abs(torque_left(case, places, state, row)).max() < 1e-9


@pytest.mark.parametrize("given", [{"direction": (0.3, -1.0)}, {"over": "driver"}], ids=str)
def test_a_fixed_direction_balances_too(given: dict[str, object]) -> None:
    case = case_of(ROCKER, **given)
    places, state = effort_curves(case, 15)
    assert np.abs(torque_left(case, places, state, 0)).max() < 1e-9
    assert (np.diff(state.angle_deg) > 0).all()


def test_a_coil_balances() -> None:
    coil = PartSpec("torsion", (1, 4), (COIL,), count=3, free_angle_deg=(20.0, 20.0))
    case = case_of(ROCKER, parts=(coil,))
    places, state = effort_curves(case, 15)
    assert np.abs(torque_left(case, places, state, 1)).max() < 1e-9
    assert (state.effort[0] == state.effort[2]).all()  # without gas, independent of temperature


def test_gas_follows_the_absolute_temperature() -> None:
    case = case_of(ROCKER, parts=case_of(ROCKER).spec.parts[:1])
    _, state = effort_curves(case, 9)
    gained = state.effort - state.without
    np.testing.assert_allclose(gained[0] / gained[1], 263.15 / 293.15, rtol=1e-12)


@every
def test_the_effort_is_the_slope_of_the_potential_energy(linkage: Linkage) -> None:
    """Between two close places the work of the hand is the energy that weights and parts gain."""
    case = case_of(linkage)
    _, state = effort_curves(case, 601)
    places, _ = effort_curves(case, 601)
    masses, spec = stated_masses(linkage, case.dynamics, case.metre), case.spec
    at_rest = solve_kinematics(linkage, case.travel.at(places).theta2, 0.0)
    energy = np.zeros(len(places))
    for link, body in masses.by_link(linkage).items():
        energy -= body.mass * at_rest.point(link, body.centre).position @ np.array([1.0, -9.81])
    hand = at_rest.point(*place_on(linkage, spec.on)).position
    steps = np.hypot(*np.diff(hand, axis=0).T)
    for part, known in zip(spec.parts, state.parts, strict=True):
        size, length = part.sizes[0], known.length
        slope = (size.force_extended - size.force_compressed) / size.stroke
        pushed = size.force_extended * length + slope * (length - size.extended) ** 2 / 2
        energy -= part.count * part.sense * pushed
    work = (state.effort[1][:-1] + state.effort[1][1:]) / 2 * steps
    np.testing.assert_allclose(np.cumsum(work), energy[1:] - energy[0], atol=2e-4 * np.ptp(energy))


def test_friction_is_that_of_struts_and_joints() -> None:
    case = case_of(ROCKER)
    rubbed = replace(case.dynamics, friction=FrictionSpec(moment=(0.0, 0.0, 0.0, 0.03)))
    _, bare = effort_curves(case, 9)
    _, state = effort_curves(EffortCase(case.linkage, rubbed, case.metre, case.travel), 9)
    np.testing.assert_allclose(state.effort, bare.effort, rtol=1e-12)
    places, _ = effort_curves(case, 9)
    moving = solve_kinematics(ROCKER, case.travel.at(places).theta2)
    speed = moving.point(3, (1.4, 0.9)).speed
    np.testing.assert_allclose(
        state.friction - bare.friction, 0.03 / case.metre * np.abs(moving.omega4) / speed, rtol=1e-9
    )
    np.testing.assert_allclose(bare.friction, 2 * 20.0 * np.abs(bare.parts[0].rate) / _speed(case, places))


def _speed(case: EffortCase, places: np.ndarray) -> np.ndarray:
    virtual, _, _ = case.motion(places)
    return virtual.point(*place_on(case.linkage, case.spec.on)).speed


def test_the_sense_follows_the_travel_through_a_dead_position() -> None:
    """The hand moves on where link 2 turns back."""
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=3, r3=2.0, r4=2.5)
    assembly = np.array([1, -1])
    moved = travel(rocker, np.radians([38.0, 38.0]), assembly)
    assert moved is not None
    assert len(moved.dead) == 1
    spec = EffortSpec(at(4, 2.5, 0), band=(0, 1))
    case = EffortCase(rocker, DynamicsSpec(payload=1.0, gravity=(0, -9.81), effort=spec), 1.0, moved)
    places, state = effort_curves(case, 41)
    virtual, _, sense = case.motion(places)
    hand = virtual.point(4, (2.5, 0.0))
    for (one, other), velocity in zip(
        pairwise(hand.position), (sense[:, None] * hand.velocity)[:-1], strict=True
    ):
        assert (other - one) @ velocity > 0
    assert case.rises
    assert (np.diff(state.angle_deg) > 0).all()
    assert np.isfinite(state.without).all()


def test_the_direction_of_travel_turns_the_effort_round() -> None:
    case = case_of(ROCKER)
    ends = (case.travel.end, case.travel.start)
    back = travel(
        ROCKER, case.travel.at(np.array(ends)).theta2, np.array([1, 1]), tuple(np.array([1.2, 0.5]))
    )
    assert back is not None
    _, state = effort_curves(case, 9)
    _, other = effort_curves(EffortCase(case.linkage, case.dynamics, case.metre, back), 9)
    np.testing.assert_allclose(state.without, -other.without[::-1], rtol=1e-9)


def test_an_angle_is_found_again() -> None:
    case = case_of(ROCKER)
    for angle in (0.1, 3.0, 0.9 * case.total_deg):
        assert case.angle_deg([case.place_at(angle)])[0] == pytest.approx(angle, abs=1e-9)


def test_each_deviation_is_the_greatest_of_dense_samples() -> None:
    case = case_of(ROCKER)
    total = case.total_deg
    _, state = effort_curves(case, 20001)
    wanted = ((0.0, 500.0), (0.4 * total, 900.0), (0.9 * total, 300.0))
    line = np.interp(state.angle_deg, *np.array(wanted).T)
    inside = state.angle_deg <= 0.9 * total
    expected = {
        "wanted": np.abs(state.effort - line)[:, inside].max(),
        "band": np.maximum(state.effort - 700, -300 - state.effort).max(),
        "stays_deg": (np.abs(state.opening) - state.friction)[
            :, inside & (state.angle_deg >= 0.2 * total)
        ].max(),
        "closes_below_deg": (state.friction - state.opening)[:, state.angle_deg <= 0.3 * total].max(),
    }
    given = {
        "wanted": wanted,
        "band": (-300.0, 700.0),
        "stays_deg": (0.2 * total, 0.9 * total),
        "closes_below_deg": 0.3 * total,
    }
    for name, value in given.items():
        found = effort_figures(case_of(ROCKER, **{"band": None, name: value})).deviation
        assert 0 <= found.excess - expected[name] < 1e-4 * abs(expected[name])  # at ends between two samples


def test_a_stroke_that_ends_inside_the_travel_is_named() -> None:
    part = case_of(ROCKER).spec.parts[0]
    least, most = effort_figures(case_of(ROCKER)).lengths[0]
    assert not effort_figures(case_of(ROCKER)).misses
    for key, size in (
        ("extended", replace(GAS, extended=most - 0.1, stroke=most - 0.2 - 0.5 * least)),
        ("compressed", replace(GAS, extended=most + 1, stroke=most + 1 - least - 0.1)),
    ):
        (miss,) = effort_figures(case_of(ROCKER, parts=(replace(part, sizes=(size,)),))).misses
        assert miss.key == "effort.parts[0]"
        assert key in miss.what
        assert abs(miss.found - (most if key == "extended" else least)) < 1e-9


def test_a_coil_turned_too_far_and_angles_beyond_the_travel_are_named() -> None:
    coil = PartSpec("torsion", (1, 4), (replace(COIL, turn_deg=5.0),), free_angle_deg=(20.0, 20.0))
    case = case_of(ROCKER, parts=(coil,), stays_deg=(1.0, 300.0))
    assert [miss.key for miss in effort_figures(case).misses] == ["effort.stays_deg", "effort.parts[0]"]


def test_the_effort_is_the_same_in_every_unit() -> None:
    """A linkage in centimetres and in metres, with friction and the moment of a torsion spring."""

    def in_metres(place: EffortPlace) -> EffortPlace:
        return place.placed(*(0.01 * x for x in place.point))

    coil = PartSpec(
        "torsion", (1, 4), (replace(COIL, moment=3.0, friction=0.5),), free_angle_deg=(20.0, 20.0)
    )
    case = case_of(ROCKER, parts=(case_of(ROCKER).spec.parts[0], coil))
    strut, _ = case.spec.parts
    small = FourBar((0, 0), (0.04, 0), 0.02, 0.025, 0.03, (0.01, 0.01), 1, 0.4)
    size = replace(GAS, extended=0.01 * GAS.extended, stroke=0.01 * GAS.stroke)
    first, second = (in_metres(place) for place in strut.places)
    parts = (replace(strut, between=(first, second), sizes=(size,)), coil)
    effort = replace(case.spec, on=in_metres(case.spec.on), parts=parts)
    friction = FrictionSpec(moment=(0.0, 0.2, 0.0, 0.03))
    moved = travel(small, case.travel.targets, np.array([1, 1]), (0.5, 1.2))
    assert moved is not None
    other = EffortCase(small, replace(case.dynamics, effort=effort, friction=friction), 1.0, moved)
    case = replace(case, dynamics=replace(case.dynamics, friction=friction))
    # gravity is in m/s2 in both
    (_, one), (_, two) = effort_curves(case, 9), effort_curves(other, 9)
    for name in ("angle_deg", "without", "effort", "friction"):
        np.testing.assert_allclose(getattr(one, name), getattr(two, name), rtol=1e-9, atol=1e-9)
