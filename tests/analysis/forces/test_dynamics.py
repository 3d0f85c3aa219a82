"""Inverse dynamics: published figures, virtual work, balance of the whole, and energy."""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis import (
    AppliedForce,
    AppliedMoment,
    Body,
    Friction,
    GrashofClass,
    Joint,
    Kinematics,
    Loads,
    Masses,
    Spring,
    TorsionSpring,
    driver_ranges,
    extremes_of,
    given_masses,
    inverse_dynamics,
    solve_kinematics,
    uniform_bars,
    virtual_work_torque,
)
from grashof.analysis.forces.joints import joints_of
from grashof.problems import DeadPositionWarning, FourBar, ProblemError

CHECKED = settings(max_examples=25)
TURN = 2 * np.pi
Drawer = Callable[[GrashofClass], st.SearchStrategy[FourBar]]
JACK = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762, coupler_point=(1.7, 0.7))
FORCES = ("f12", "f32", "f43", "f14")


def assert_state(found: Any, expected: dict[str, Any], suffix: str = "") -> None:
    values = [found.torque] + [getattr(found, name) for name in FORCES]
    keys = ["T", "F12", "F32", "F43", "F14"]
    for key, value in zip(keys, values, strict=True):
        reference = np.array(expected[key + suffix], dtype=np.float64)
        np.testing.assert_allclose(value, reference, rtol=0, atol=1e-9 * np.abs(reference).max())


def test_reference_figures_of_the_pumpjack(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    given_case = golden["pumpjack_report_geometry"]["inverse_dynamics"]
    linkage = golden_linkages["pumpjack"]
    masses = given_masses(
        linkage, [float(m) for m in given_case["masses"]], [float(i) for i in given_case["inertias"]]
    )
    for case in given_case["cases"]:
        state = solve_kinematics(linkage, np.radians(case["theta2_deg"]), TURN / 3)
        assert_state(inverse_dynamics(state, masses, Loads(gravity=(0, -float(case["g"])))), case)


@pytest.mark.parametrize("name", ["bag", "table7"])
def test_reference_figures_of_the_luggage(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar], name: str
) -> None:
    bag, linkage = golden["bag_mechanism_exact"], golden_linkages[name]
    masses = given_masses(linkage, [float(m) for m in bag["masses"]], [float(i) for i in bag["inertias"]])
    states = (
        [*bag["states_at_poses"], *bag["states"]]
        if name == "bag"
        else golden["table7_lengths_theta1_0"]["states"]
    )
    checked = 0
    for expected in states:
        state = solve_kinematics(linkage, np.radians(float(expected["theta2_deg"])))
        for gravity in ("0", "9.81"):
            suffix = f"(g={gravity})"
            if "T" + suffix in expected:
                loads = Loads(gravity=(0, -float(gravity)))
                assert_state(inverse_dynamics(state, masses, loads), expected, suffix)
                checked += 1
    assert checked == {"bag": 16, "table7": 9}[name]


def test_torque_extremes_and_rms_of_the_reference_figures(
    golden: dict[str, Any], golden_linkages: dict[str, FourBar]
) -> None:
    table7, bag = golden["table7_lengths_theta1_0"], golden["bag_mechanism_exact"]
    linkage = golden_linkages["table7"]
    masses = given_masses(linkage, [float(m) for m in bag["masses"]], [float(i) for i in bag["inertias"]])

    def torque(theta2: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return inverse_dynamics(solve_kinematics(linkage, theta2), masses).torque

    found, expected = extremes_of(torque, -np.pi, np.pi, closed=True), table7["torque_extremes_g0"]
    peak = abs(found.low)
    assert found.high == pytest.approx(float(expected["max"]["T"]), abs=1e-9 * peak)
    assert found.low == pytest.approx(float(expected["min"]["T"]), abs=1e-9 * peak)
    assert np.degrees(found.at_high) == pytest.approx(float(expected["max"]["theta2_rel_deg"]), abs=1e-9)
    assert np.degrees(found.at_low) == pytest.approx(float(expected["min"]["theta2_rel_deg"]), abs=1e-9)
    for count in (720, 1440):
        values = torque(np.arange(count) * TURN / count)
        rms, mean = table7[f"torque_rms_mean_N{count}"]
        assert np.sqrt(np.mean(values**2)) == pytest.approx(float(rms), rel=1e-9)
        assert np.mean(values) == pytest.approx(float(mean), abs=1e-9 * peak)


def number(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high).map(lambda value: round(value, 3))


@st.composite
def bodies(draw: st.DrawFn) -> Masses:
    return Masses(
        *(
            Body(draw(number(0, 5)), draw(number(0, 5)), (draw(number(-2, 2)), draw(number(-2, 2))))
            for _ in range(3)
        )
    )


@st.composite
def all_loads(draw: st.DrawFn, pins: float) -> Loads:
    """One load of every type at least."""
    pair = st.tuples(number(-2, 2), number(-2, 2))
    four = st.tuples(*[number(0, 2)] * 4)
    wave = draw(number(-5, 5))
    sway = np.array(draw(pair))

    def swaying(state: Kinematics) -> npt.NDArray[np.float64]:
        return sway * np.cos(2 * state.theta2)[..., None]

    link = st.sampled_from([2, 3, 4])
    return Loads(
        gravity=draw(st.tuples(number(-10, 10), number(-10, 10))),
        forces=(
            *(AppliedForce(each, draw(pair), draw(pair)) for each in (2, 3, 4)),
            AppliedForce(draw(link), draw(pair), swaying),
            AppliedForce(draw(link), draw(pair), draw(pair), turning=True),
        ),
        moments=(
            *(AppliedMoment(each, draw(number(-5, 5))) for each in (2, 3, 4)),
            AppliedMoment(draw(link), lambda state: wave * np.sin(state.theta4)),
        ),
        springs=(
            Spring(1, draw(pair), draw(link), draw(pair), draw(number(0, 5)), 1.3, draw(number(0, 2))),
            Spring(2, draw(pair), draw(st.sampled_from([3, 4])), draw(pair), draw(number(0, 5))),
        ),
        torsion_springs=tuple(
            TorsionSpring(Joint(k), draw(number(0, 5)), draw(number(-3, 3))) for k in range(4)
        ),
        friction=Friction(draw(four), draw(four), pins),
    )  # fmt: skip


@pytest.mark.quick("double-crank")
@pytest.mark.parametrize("kind", [GrashofClass.CRANK_ROCKER, GrashofClass.DOUBLE_CRANK])
@given(data=st.data())
@CHECKED
def test_torque_is_the_virtual_work_with_every_load_on(
    four_bars: Drawer, kind: GrashofClass, data: st.DataObject
) -> None:
    linkage = data.draw(four_bars(kind))
    masses, loads = data.draw(bodies()), data.draw(all_loads(0.01 * float(linkage.lengths.min())))
    speed, acceleration = data.draw(number(-3, 3)), data.draw(number(-3, 3))
    state = solve_kinematics(linkage, np.linspace(0, TURN, 91), speed, acceleration)
    found = inverse_dynamics(state, masses, loads)
    expected = virtual_work_torque(state, masses, loads, found.joint_moments)
    clear = np.isfinite(found.torque)  # pins may lock the linkage
    assert clear.any()
    peak = np.abs(expected[clear]).max()
    np.testing.assert_allclose(found.torque[clear], expected[clear], rtol=0, atol=1e-9 * peak)
    np.testing.assert_allclose(found.power[clear], found.torque[clear] * speed)


def cross(first: npt.NDArray[np.float64], second: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]


def test_power_without_losses_is_the_rate_of_energy() -> None:
    masses = uniform_bars(JACK, 2.0, payload=3.0)
    loads = Loads(
        gravity=(0, -9.81),
        springs=(Spring(1, (2, 0), 4, (1, 0.2), 40, 1.0),),
        torsion_springs=(TorsionSpring(Joint.B, 5.0, 1.0),),
    )
    theta2 = np.linspace(0, TURN, 721)
    power = inverse_dynamics(solve_kinematics(JACK, theta2, 2.0), masses, loads).power
    # Over a turn nothing is left, at no friction; with it, all power goes there.
    assert abs(np.mean(power[:-1])) < 1e-9 * np.abs(power).max()
    lossy = Loads(gravity=(0, -9.81), friction=Friction(viscous=0.5, coulomb=(0.1, 0.2, 0.3, 0.4)))
    state = solve_kinematics(JACK, theta2, 2.0)
    found = inverse_dynamics(state, masses, lossy)
    rates = [state.omega2, state.omega3 - state.omega2, state.omega4 - state.omega3, state.omega4]
    lost = sum(-moment * rate for moment, rate in zip(found.joint_moments, rates, strict=True))
    assert (lost >= 0).all()
    assert np.mean(found.power[:-1]) == pytest.approx(np.mean(lost[:-1]), rel=1e-6)


def test_pin_friction_is_proportional_to_the_joint_force() -> None:
    masses = uniform_bars(JACK, 2.0)
    state = solve_kinematics(JACK, np.linspace(0, TURN, 90), 2.0)
    found = inverse_dynamics(state, masses, Loads(gravity=(0, -9.81), friction=Friction(radius=0.02)))
    for joint in joints_of(JACK):
        np.testing.assert_allclose(
            np.abs(found.joint_moments[joint]), 0.02 * found.joint_force(joint), rtol=1e-9, atol=1e-9
        )
    # A friction circle wider than the links locks them.
    locked = inverse_dynamics(state, masses, Loads(gravity=(0, -9.81), friction=Friction(radius=20.0)))
    assert np.isnan(locked.torque).any()


def test_the_payload_is_a_force_of_its_weight_when_at_rest() -> None:
    state = solve_kinematics(JACK, np.linspace(0, TURN, 19), 0.0)
    bare = uniform_bars(JACK, 2.0)
    loaded = bare.with_payload(7.0, JACK.coupler_point)
    weight = AppliedForce(3, tuple(JACK.coupler_point), (0.0, -7 * 9.81))
    one = inverse_dynamics(state, loaded, Loads(gravity=(0, -9.81)))
    other = inverse_dynamics(state, bare, Loads(gravity=(0, -9.81), forces=(weight,)))
    limit = 1e-10 * np.abs(one.torque).max()
    for name in ("torque", *FORCES, "shaking_moment"):
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), atol=limit)


def test_batches_give_what_single_linkages_give() -> None:
    batch = FourBar(o2=(0, 0), o4=(4, 1), r2=[[1.0], [0.8]], r3=4, r4=3, coupler_point=(1, 2))
    loads = Loads(gravity=(0, -9.81), friction=Friction(0.1, 0.1, 0.01), moments=(AppliedMoment(4, 3.0),))
    theta2 = np.linspace(0, 6, 5)
    together = inverse_dynamics(solve_kinematics(batch, theta2), uniform_bars(batch, 2.0, payload=1.0), loads)
    assert together.torque.shape == (2, 5)
    assert together.f43.shape == (2, 5, 2)
    for index in range(2):
        alone = inverse_dynamics(
            solve_kinematics(batch[index, 0], theta2), uniform_bars(batch[index, 0], 2.0, payload=1.0), loads
        )
        np.testing.assert_allclose(together.torque[index], alone.torque, rtol=1e-12)
        np.testing.assert_allclose(together.shaking_force[index], alone.shaking_force, rtol=1e-12)


def test_dead_and_open_positions_have_no_finite_forces() -> None:
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)
    end = driver_ranges(rocker)[0, 1]
    with pytest.warns(DeadPositionWarning):
        state = solve_kinematics(rocker, [0.0, end, 3.0])
    found = inverse_dynamics(state, uniform_bars(rocker, 2.0), Loads(gravity=(0, -9.81)))
    np.testing.assert_array_equal(np.isfinite(found.torque), [True, False, False])
    np.testing.assert_array_equal(np.isfinite(found.f43).all(axis=-1), [True, False, False])


def test_bad_input_is_said() -> None:
    state, masses = solve_kinematics(JACK, 0.3), uniform_bars(JACK, 2.0)
    for loads, message in (
        (Loads(gravity=(0, 0, 1)), "gravity is"),
        (Loads(friction=Friction(viscous=-1)), "viscous friction"),
        (Loads(friction=Friction(radius=(1, 2))), "radius friction"),
        (Loads(moments=(AppliedMoment(1, 2.0),)), "link is 1"),
        (Loads(forces=(AppliedForce(5, (0, 0), (1, 1)),)), "link is 5"),
    ):
        with pytest.raises(ProblemError, match=message):
            inverse_dynamics(state, masses, loads)
