"""Counterweights: no shaking force, the most even torque, the reciprocating mass of slider-cranks."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from loaded_linkages import JACK, ROCKER, TURN, WEIGHT

from grashof import analysis
from grashof.analysis import Body, Masses, inverse_dynamics, shaking_harmonics, solve_kinematics
from grashof.analysis.mechanism.driver_law import mean_over
from grashof.problems import AssemblyError, FourBar, ProblemError, SliderCrank
from grashof.problems.values.arrays import FloatArray

CHECKED = settings(max_examples=10)
Drawer = Callable[[analysis.GrashofClass], st.SearchStrategy[FourBar]]


@given(data=st.data())
@CHECKED
def test_no_shaking_force_is_left(four_bars: Drawer, data: st.DataObject) -> None:
    linkage = data.draw(four_bars(analysis.GrashofClass.CRANK_ROCKER))
    place = st.tuples(st.floats(-2, 2), st.floats(-2, 2))
    masses = Masses(*(Body(data.draw(st.floats(0.1, 5)), 0.3, data.draw(place)) for _ in range(3)))
    state = solve_kinematics(linkage, np.linspace(0, TURN, 60), 2.0, 0.5)
    before = inverse_dynamics(state, masses).shaking_force
    balanced = analysis.balance_force(linkage, masses, crank_radius=0.7)
    after = inverse_dynamics(state, balanced.masses).shaking_force
    assert np.abs(after).max() < 1e-9 * np.abs(before).max()
    assert np.hypot(*balanced.crank_weight.centre) == pytest.approx(0.7)
    assert np.hypot(*balanced.output_weight.centre) == pytest.approx(float(linkage.r4))


def test_batches_are_balanced_at_once() -> None:
    batch = FourBar(o2=(0, 0), o4=(4, 1), r2=[[1.0], [0.8]], r3=4, r4=3)
    bars = analysis.uniform_bars(batch, 2.0)
    state = solve_kinematics(batch, np.linspace(0, 6, 9))
    before = inverse_dynamics(state, bars).shaking_force
    after = inverse_dynamics(state, analysis.balance_force(batch, bars).masses).shaking_force
    assert np.abs(after).max() < 1e-12 * np.abs(before).max()


@pytest.mark.parametrize("measure", ["rms", "peak"])
def test_no_counterweight_beside_it_makes_the_torque_more_even(measure: str) -> None:
    """Of samples, and of a turn between them, too: its load jumps where the beam turns back."""

    def rods(state: analysis.Kinematics) -> FloatArray:
        """Polished rod load, larger on the upstroke, across the beam."""
        load = np.where(state.omega4 > 0, 9000.0, 4000.0)
        return np.stack([np.zeros_like(load), load], axis=-1)

    loads = replace(WEIGHT, forces=(analysis.AppliedForce(4, (-4.572, 0), rods, turning=True),))
    bars, speed = analysis.uniform_bars(JACK, (312, 312, 314)), TURN / 3
    toggles = analysis.output_stroke(JACK).theta2
    beside = np.concatenate([np.linspace(0, TURN, 5_001), toggles - 1e-9, toggles + 1e-9])
    state = solve_kinematics(JACK, np.radians(np.arange(361)), speed)
    for found, places in (
        (analysis.balance_torque(state, bars, loads, 1.0, measure), state.theta2),
        (analysis.balance_turn(JACK, bars, speed, loads, 1.0, measure), beside),
    ):

        def size(moment: FloatArray, at: FloatArray = places) -> float:
            mass = float(np.hypot(*moment))
            heavier = bars.with_body(2, Body(mass, 0.0, moment / mass))

            def torque(theta2: FloatArray) -> FloatArray:
                return inverse_dynamics(solve_kinematics(JACK, theta2, speed), heavier, loads).torque

            if measure == "peak":
                return float(np.abs(torque(at)).max())
            if at is beside:
                return float(np.sqrt(mean_over(JACK, lambda each: torque(each) ** 2, 0.0, TURN)[0]))
            return float(np.sqrt(np.mean(torque(at) ** 2)))

        chosen = found.crank_weight.mass * found.crank_weight.centre
        least = size(chosen)
        for angle in np.arange(0, TURN, TURN / 12):
            for far in (3.0, 100.0):
                other = chosen + far * np.array([np.cos(angle), np.sin(angle)])
                assert size(other) >= least * (1 - 3e-8)
        after = inverse_dynamics(state, found.masses, loads).torque
        np.testing.assert_allclose(found.torque_after, after, rtol=1e-9, atol=1e-6)
        assert np.abs(found.torque_after).max() < 0.6 * np.abs(found.torque_before).max()
        assert np.hypot(*found.crank_weight.centre) == pytest.approx(1.0)


def test_bad_input_is_reported() -> None:
    bars, state = analysis.uniform_bars(JACK, 300.0), solve_kinematics(JACK, np.linspace(0, 6, 20))
    uneven = solve_kinematics(JACK, [0.0, 1.0], 1.0, 2.0)
    for act, message in (
        (lambda: analysis.balance_torque(state, bars, analysis.Loads(), 1.0), "gravity is zero"),
        (lambda: analysis.balance_torque(uneven, bars, WEIGHT, 1.0), "steady speed"),
        (lambda: analysis.balance_torque(state, bars, WEIGHT, 1.0, "mean"), "measure is 'mean'"),
        (lambda: analysis.balance_turn(JACK, bars, 1.0, WEIGHT, 1.0, "mean"), "measure is 'mean'"),
        (lambda: analysis.balance_force(JACK, bars, crank_radius=0.0), "radius"),
    ):
        with pytest.raises(ProblemError, match=message):
            act()
    with pytest.raises(AssemblyError, match="turn fully"):
        analysis.balance_turn(ROCKER, bars, 1.0, WEIGHT, 1.0)


R, LENGTH, OMEGA, PISTON = 0.05, 0.2, 120.0, 0.7


@pytest.mark.parametrize("slide_angle", [0.0, 2.1])
def test_harmonics_are_those_of_the_series_in_r_over_l(slide_angle: float) -> None:
    """cos t + A2 cos 2t - A4 cos 4t + ..., A2 = q + q^3/4 + 15 q^5/128, A4 = q^3/4 + 3 q^5/16."""
    engine = SliderCrank((0.3, -1), R, LENGTH, slide_angle=slide_angle)
    found = shaking_harmonics(engine, Masses(Body(0), Body(0), Body(PISTON)), OMEGA, 4)
    force, q = PISTON * R * OMEGA**2, R / LENGTH
    expected = force * np.array([1, q + q**3 / 4 + 15 * q**5 / 128, 0, -(q**3) / 4 - 3 * q**5 / 16])
    np.testing.assert_allclose(found[:, 0].real, expected, rtol=0, atol=0.5 * q**7 * force)
    np.testing.assert_allclose(found[:, 0].imag, 0, atol=1e-9 * force)
    np.testing.assert_allclose(found[:, 1], 0, atol=1e-9 * force)


@pytest.mark.parametrize(
    ("share", "along", "across"), [(0.0, 1.0, 0.0), (0.5, 0.5, 0.5), (2 / 3, 1 / 3, 2 / 3)]
)
def test_a_share_of_the_primary_force_goes_across(share: float, along: float, across: float) -> None:
    engine = SliderCrank((0, 0), R, LENGTH, slide_angle=0.4)
    rod = Body(0.6, 0.0, (0.0, 0.0)) + Body(0.2, 0.0, (LENGTH, 0.0))
    masses = Masses(Body(0.5, 0.01, (0.01, -0.02)), rod, Body(PISTON))
    found = analysis.balance_reciprocating(engine, masses, share, radius=0.04)
    assert float(found.rotating) == pytest.approx(0.6)
    assert float(found.reciprocating) == pytest.approx(0.2 + PISTON)
    assert np.linalg.norm(found.crank_weight.centre) == pytest.approx(0.04)
    force = (0.2 + PISTON) * R * OMEGA**2
    primary = shaking_harmonics(engine, found.masses, OMEGA, 1)[0]
    np.testing.assert_allclose(np.abs(primary), [along * force, across * force], rtol=1e-9, atol=1e-9 * force)


def test_the_secondary_force_is_not_changed_and_the_series_is_the_force() -> None:
    engine = SliderCrank((0, 0), R, LENGTH, offset=0.03)
    masses = Masses(Body(0.5, 0.01, (0.01, 0.0)), Body(0.8, 0.004, (0.07, 0.01)), Body(PISTON))
    before = shaking_harmonics(engine, masses, OMEGA, 30)
    after = shaking_harmonics(engine, analysis.balance_reciprocating(engine, masses).masses, OMEGA, 30)
    np.testing.assert_allclose(after[1:], before[1:], rtol=0, atol=1e-11 * np.abs(before).max())
    theta = np.linspace(0, 6, 31)
    waves = np.exp(1j * np.outer(theta, np.arange(1, 31)))
    shaking = inverse_dynamics(solve_kinematics(engine, theta, OMEGA), masses).shaking_force
    np.testing.assert_allclose((waves @ before).real, shaking, rtol=0, atol=1e-11 * np.abs(shaking).max())


def test_a_linkage_without_harmonics_is_refused() -> None:
    none = Masses(Body(0), Body(0), Body(1))
    with pytest.raises(AssemblyError, match="does not turn fully"):
        shaking_harmonics(SliderCrank((0, 0), 2, 1), none, 1.0)
    with pytest.raises(ProblemError, match=r"^linkage is .*; it must be a SliderCrank$"):
        analysis.balance_reciprocating(FourBar((0, 0), (4, 0), 1, 4, 3), none)  # type: ignore[arg-type]
    with pytest.raises(ProblemError, match=r"^share is 1.5"):
        analysis.balance_reciprocating(SliderCrank((0, 0), 1, 2), none, 1.5)
