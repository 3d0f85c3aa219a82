"""Masses and loads as files state them: units, tables, and the drive torque of everything at once."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import scipy

from grashof.analysis import (
    DriverLaw,
    inverse_dynamics,
    solve_kinematics,
    stated_loads,
    stated_masses,
    virtual_work_torque,
)
from grashof.analysis.forces.from_spec import curve_through
from grashof.analysis.forces.loads import wrenches
from grashof.problems import DynamicsSpec, FourBar, InvertedSliderCrank, SliderCrank
from grashof.problems.values.dynamics import load_specs as specs
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.problems.values.dynamics.strength import SectionSpec
from grashof.problems.values.linkages.linkage import Linkage

CARD = ((0, -9), (90, -20), (180, -20), (250, -11), (360, -9))
INCH = 0.0254
Maker = Callable[..., list[Linkage]]
Specs = dict[type[Linkage], DynamicsSpec]


@pytest.mark.quick("30.0-profile0-FourBar", "30.0-profile0-SliderCrank", "-30.0-profile2-InvertedSliderCrank")
@pytest.mark.parametrize("kind", [FourBar, SliderCrank, InvertedSliderCrank])
@pytest.mark.parametrize("profile", [MotorSpec(), MotorSpec("trapezoid"), MotorSpec("cycloid")])
@pytest.mark.parametrize("speed", [30.0, -30.0])
def test_the_torque_of_everything_at_once_is_virtual_work(
    profile: MotorSpec, speed: float, kind: type[Linkage], everything: Specs, made: Maker
) -> None:
    spec = everything[kind]
    for linkage in made(kind, 6):
        omega2 = speed * np.pi / 30
        law = DriverLaw(0.0, np.copysign(2 * np.pi, omega2), omega2, profile)
        time = np.linspace(0.001, 0.999, 173) * law.duration
        state = solve_kinematics(linkage, *law.at_time(time))
        masses = stated_masses(linkage, spec)
        loads = stated_loads(spec, 1.0, lambda _, now=time: now)
        found = inverse_dynamics(state, masses, loads)
        work = virtual_work_torque(state, masses, loads, found.joint_moments)
        peak = np.abs(found.torque).max()
        np.testing.assert_allclose(found.torque, work, rtol=0, atol=1e-9 * peak)
        np.testing.assert_allclose(found.power, found.torque * state.omega2)


def test_newtons_are_newtons_in_every_length_unit(everything: Specs, made: Maker) -> None:
    def in_inches(place: specs.Place) -> specs.Place:
        return specs.Place(place.link, tuple(each / INCH for each in place.at))

    spec = everything[FourBar]
    small = replace(
        spec,
        section=SectionSpec(0.05 / INCH, 0.02 / INCH),
        loads=tuple(replace(load, at=tuple(np.array(load.at) / INCH)) for load in spec.loads),
        springs=tuple(
            specs.SpringSpec(tuple(map(in_inches, each.between)), each.stiffness, each.free_length / INCH)
            for each in spec.springs
        ),
        dampers=tuple(
            specs.DamperSpec(tuple(map(in_inches, each.between)), each.damping) for each in spec.dampers
        ),
        counterweights=(specs.CounterweightSpec(2, 3.0, (-0.4 / INCH, 0.1 / INCH)),),
        friction=specs.FrictionSpec(
            0.1, tuple(np.array([0.01, 0.02, 0.01, 0.03]) / INCH), 0.1, (0, 0.1, 0, 0)
        ),
    )
    theta2 = np.linspace(0, 6, 50)
    for linkage in made(FourBar, 5):
        shrunk = linkage.scaled(1 / INCH, np.zeros(2))
        torques = []
        for bar, given, metre in ((linkage, spec, 1.0), (shrunk, small, INCH)):
            state = solve_kinematics(bar, theta2, 3.0)
            loads = stated_loads(given, metre, lambda at: at.theta2 / 3.0)
            found = inverse_dynamics(state, stated_masses(bar, given, metre), loads)
            torques.append(found.torque * metre**2)
        np.testing.assert_allclose(torques[1], torques[0], rtol=1e-9, atol=1e-9 * np.abs(torques[0]).max())


def test_bars_of_a_density_are_those_of_their_section(made: Maker) -> None:
    linkage = made(FourBar, 1)[0]
    masses = stated_masses(linkage, DynamicsSpec(density=7850, section=SectionSpec(20, 10)), 1e-3)
    for link in (2, 3, 4):
        length = float(getattr(linkage, f"r{link}"))
        body = masses.of(link)
        assert float(body.mass) == pytest.approx(7850 * 0.02 * 0.01 * length * 1e-3)
        assert float(body.inertia) == pytest.approx(float(body.mass) * (length**2 + 20**2) / 12)


def test_loads_and_counterweights_act_where_they_are_stated(made: Maker) -> None:
    linkage = made(FourBar, 1)[0]
    turning, varying = (
        specs.LoadSpec(4, (1, 0), (3, 4), frame="link"),
        specs.LoadSpec(2, values=((0, 1), (90, 7), (360, 1))),
    )
    weight = specs.CounterweightSpec(2, 3.0, (-0.4, 0.1))
    spec = DynamicsSpec(1e-12, loads=(turning, varying), counterweights=(weight,))
    felt = wrenches(solve_kinematics(linkage, np.pi / 2), stated_loads(spec, 1.0))
    assert felt[2].moment == pytest.approx(7)  # degrees
    assert felt[4].moment == pytest.approx(4)  # the arm of 1 times what is across it
    np.testing.assert_allclose(stated_masses(linkage, spec).crank.centre, weight.at, rtol=1e-9)


def test_centres_off_the_middle(made: Maker) -> None:
    spec = DynamicsSpec(masses=(1, 2, 3), inertias=(0, 0, 0), centres=((0.1, 0.2), (0.3, 0), (0, -1)))
    masses = stated_masses(made(FourBar, 1)[0], spec)
    assert [masses.of(link).centre.tolist() for link in (2, 3, 4)] == [[0.1, 0.2], [0.3, 0], [0, -1]]


def test_a_curve_neither_overshoots_nor_jumps() -> None:
    curve = curve_through(CARD, period=360.0)
    fine = np.linspace(-400, 800, 24001)
    values = curve(fine)[:, 0]
    assert values.min() >= -20
    assert values.max() <= -9
    np.testing.assert_allclose(values[:3601], curve(fine[:3601] + 720)[:, 0], atol=1e-12)
    assert np.abs(np.diff(values)).max() < 0.02  # nowhere steeper than three times the chord
    slopes = np.diff(values) / np.diff(fine)
    assert np.abs(np.diff(slopes)).max() < 2e-3  # its slope is continuous, over the end of the turn, too
    inner = scipy.interpolate.PchipInterpolator(*np.array(CARD).T)
    np.testing.assert_allclose(curve(np.array([120.0, 200.0]))[:, 0], inner([120, 200]), atol=1e-12)


def test_a_load_over_time_is_not_known_outside_its_rows() -> None:
    curve = curve_through([(0, 1.0), (2, 3.0)])
    assert np.isnan(curve(np.array([-0.1, 2.1]))).all()
    assert curve(np.array([1.0])).ravel().tolist() == [2.0]
