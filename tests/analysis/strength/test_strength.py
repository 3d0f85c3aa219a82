"""Stresses, pins, buckling and their peaks: by hand, in several units, and against dense search."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import strategies as st
from loaded_linkages import JACK, ROCKER, TURN, WEIGHT

from grashof import analysis
from grashof.analysis import WEIGHTLESS, AppliedForce, Joint, Loads, Structure, solve_kinematics, strength_at
from grashof.analysis.strength.strength import von_mises
from grashof.problems import AssemblyError, FourBar, ProblemError, SectionSpec, StrengthSpec
from grashof.problems.values.dynamics.dynamics_spec import metres

Floats = npt.NDArray[np.float64]
Drawer = Callable[[analysis.GrashofClass], st.SearchStrategy[FourBar]]
STEEL = StrengthSpec(235e6, 210e9, pin_diameter=0.01)
WELL = AppliedForce(4, (-4.572, 0), (0.0, -20000.0))


def over_all(structure: Structure, linkage: FourBar, omega2: float = 2.0) -> analysis.StrengthSummary:
    low, high = (0.0, TURN) if analysis.full_rotation(linkage) else analysis.driver_ranges(linkage)[0]
    motion = [analysis.driver_samples(linkage, low, high)]
    return analysis.strength_over(structure, lambda theta2: solve_kinematics(linkage, theta2, omega2), motion)


@pytest.mark.parametrize("unit", ["m", "mm", "in"])
def test_a_press_by_hand(unit: str) -> None:
    """Crank upright, coupler 3-4-5, output upright and pushed by 1000 N halfway up, in several units."""
    metre = metres(unit)
    linkage = FourBar(o2=(0, 0), o4=(4 / metre, 0), r2=2 / metre, r3=5 / metre, r4=5 / metre)
    pushed = Loads(forces=(AppliedForce(4, (2.5 / metre, 0), (-1000 / metre, 0)),))
    section = SectionSpec(width=0.04 / metre, height=0.02 / metre)
    steel = StrengthSpec(235e6, 210e9, pin_diameter=0.01 / metre)
    structure = Structure(WEIGHTLESS, pushed, section, steel, metre)
    found = strength_at(solve_kinematics(linkage, np.pi / 2, 0.0), structure)
    area, inertia, inertia_across = 0.04 * 0.02, 0.02 * 0.04**3 / 12, 0.04 * 0.02**3 / 12
    expected = {
        # Coupler: 625 N of compression, and nothing else.
        (3, "tension"): 0.0,
        (3, "compression"): 625,
        (3, "moment"): 0.0,
        (3, "stress"): 625 / area,
        (3, "deflection"): 0.0,
        (3, "utilisation"): 625 / (np.pi**2 * 210e9 * inertia_across / 5**2),
        # Output: 1250 N m in the middle with 375 N of tension.
        (4, "tension"): 375,
        (4, "compression"): 0,
        (4, "shear"): 500,
        (4, "moment"): 1250,
        (4, "normal_stress"): 375 / area + 1250 * 0.02 / inertia,
        (4, "shear_stress"): 1.5 * 500 / area,
        (4, "stress"): 375 / area + 1250 * 0.02 / inertia,
        (4, "deflection"): 1000 * 5**3 / (48 * 210e9 * inertia) / metre,
        # Crank: 1000 N m at its shaft, 500 N across, 375 N of compression.
        (2, "compression"): 375,
        (2, "thrust"): 375,
        (2, "moment"): 1000,
        (2, "stress"): 375 / area + 1000 * 0.02 / inertia,
        # Held in both ends and turned at one by M: M L^2 / (9 sqrt(3) E I).
        (2, "deflection"): 1000 * 2**2 / (9 * np.sqrt(3) * 210e9 * inertia) / metre,
    }
    for (link, key), value in expected.items():
        nothing = 1e-6 if value == 0 else 0
        assert float(found.bars[link][key].value) == pytest.approx(value, rel=1e-9, abs=nothing)
    assert float(found.bars[4]["moment"].at) == pytest.approx(2.5 / metre)
    assert float(found.worst_link) == 4
    borne = {"pin_force": 625, "pin_shear": 625 / (np.pi * 0.01**2 / 4), "bearing": 625 / (0.01 * 0.02)}
    for joint in (Joint.O2, Joint.A, Joint.B, Joint.O4):
        assert {key: float(value) for key, value in found.pins[joint].items()} == pytest.approx(borne)


def test_a_bar_that_is_only_pulled_is_not_bent_by_rounding() -> None:
    state = solve_kinematics(JACK, np.linspace(0, TURN, 100), 0.0)
    structure = Structure(WEIGHTLESS, Loads(forces=(WELL,)), SectionSpec(0.2, 0.2), STEEL)
    pitman = strength_at(state, structure).bars[3]
    for key in ("compression", "thrust", "shear", "moment", "shear_stress", "deflection"):
        np.testing.assert_array_equal(pitman[key].value, 0)
    assert (pitman["tension"].value > 1000).all()
    np.testing.assert_allclose(pitman["stress"].value, pitman["tension"].value / 0.04)


def test_pins_of_their_own_and_the_thinner_link() -> None:
    strength = StrengthSpec(
        235e6, pin_diameter=[0.01, 0.02, 0.03, 0.04], pin_thickness=[0.1, 0.2, 0.3], double_shear=True
    )
    structure = Structure(WEIGHTLESS, Loads(), SectionSpec(1, 1), strength)
    areas = [structure.pin_areas(Joint(k)) for k in range(4)]
    sheared = [2 * np.pi * d**2 / 4 for d in (0.01, 0.02, 0.03, 0.04)]
    np.testing.assert_allclose([each["pin_shear"] for each in areas], sheared)
    np.testing.assert_allclose([each["bearing"] for each in areas], [0.001, 0.002, 0.006, 0.012])


def test_unknown_measures_are_left_out() -> None:
    state = solve_kinematics(JACK, np.linspace(0, 6, 5), 2.0)
    bars = analysis.uniform_bars(JACK, 312.0)
    tube = SectionSpec(area=0.04, inertia=1e-4, extreme_fibre=0.1)
    keys, pins = (
        [measure.key for measure in each] for each in (analysis.BAR_MEASURES, analysis.PIN_MEASURES)
    )
    for section, strength, last, pin in (
        (None, None, "moment", "pin_force"),
        (tube, None, "stress", "pin_force"),
        (tube, StrengthSpec(1e8), "utilisation", "pin_force"),
        (SectionSpec(0.2, 0.2), StrengthSpec(1e8, pin_diameter=0.1), "utilisation", "bearing"),
    ):
        found = strength_at(state, Structure(bars, Loads(), section, strength))
        expected = keys[: keys.index(last) + 1]
        if "deflection" in expected and strength is not None and strength.elastic_modulus is None:
            expected.remove("deflection")
        assert list(found.bars[3]) == expected
        assert list(found.pins[Joint.A]) == pins[: pins.index(pin) + 1]
        assert set(found.worst_link) <= {2, 3, 4}
    with pytest.raises(ProblemError, match="section is missing"):
        Structure(bars, Loads(), None, StrengthSpec(1e8))


def test_slender_bars_buckle_as_euler_says() -> None:
    section = SectionSpec(width=[0.04, 0.05, 0.06], height=0.02)
    structure = Structure(WEIGHTLESS, Loads(), section, STEEL)
    loads = structure.buckling_loads(3, 5.0)
    assert loads["buckling"] == pytest.approx(np.pi**2 * 210e9 * (0.02 * 0.05**3 / 12) / 25)
    assert loads["buckling_across"] == pytest.approx(np.pi**2 * 210e9 * (0.05 * 0.02**3 / 12) / 25)
    tube = SectionSpec(area=1e-3, inertia=1e-8, extreme_fibre=0.01)
    for strength, keys in ((StrengthSpec(1e8, 1e9), ["buckling"]), (StrengthSpec(1e8), [])):
        assert list(Structure(WEIGHTLESS, Loads(), tube, strength).buckling_loads(2, 1.0)) == keys


@pytest.mark.parametrize("metre", [1.0, 1e-3])
def test_stocky_bars_buckle_as_johnson_says(metre: float) -> None:
    """Shigley, eqs. 4-45 and 4-46: with slenderness l / k up to sqrt(2 pi^2 E / Sy)."""
    width, modulus, strength = 0.05, 210e9, 235e6
    structure = Structure(WEIGHTLESS, Loads(), SectionSpec(width / metre, width / metre), STEEL, metre)
    gyration, area = width / np.sqrt(12), width**2
    limit = np.sqrt(2 * np.pi**2 * modulus / strength)
    slenderness = np.array([0.01, 20, 80, limit * 0.999, limit * 1.001, 200])
    johnson = area * (strength - (strength / (2 * np.pi) * slenderness) ** 2 / modulus)
    euler = area * np.pi**2 * modulus / slenderness**2
    found = structure.buckling_loads(2, slenderness * gyration / metre)
    expected = np.where(slenderness < limit, johnson, euler)
    np.testing.assert_allclose(found["buckling"], expected, rtol=1e-12)
    np.testing.assert_allclose(found["buckling_across"], expected, rtol=1e-12)


def test_an_overhang_in_compression_does_not_buckle_the_bar() -> None:
    """A push along the bar from beyond A to A does not compress it between the joints."""
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=5, r4=5)
    state = solve_kinematics(linkage, np.pi / 2, 0.0)
    push, hold = (AppliedForce(2, (u, 0), (n, 0.0), turning=True) for u, n in ((3.0, -80.0), (2.0, 80.0)))
    for forces, thrust in (((push,), 80), ((push, hold), 0)):
        crank = strength_at(state, Structure(WEIGHTLESS, Loads(forces=forces))).bars[2]
        assert float(crank["compression"].value) == pytest.approx(80)
        assert float(crank["thrust"].value) == pytest.approx(thrust, abs=1e-9)


def test_shear_counts_close_to_the_joint_of_a_deep_bar() -> None:
    portal = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=1)
    loads = Loads(forces=(AppliedForce(3, (0.02, 0), (0.0, -800.0)),))
    structure = Structure(WEIGHTLESS, loads, SectionSpec(width=1.0, height=0.1))
    found = strength_at(solve_kinematics(portal, np.pi / 2, 0.0), structure).bars[3]
    force = 800 * (4 - 0.02) / 4
    assert float(found["shear_stress"].value) == pytest.approx(1.5 * force / 0.1)
    assert float(found["normal_stress"].value) == pytest.approx(force * 0.02 * 0.5 / (0.1 / 12))
    assert float(found["stress"].value) == pytest.approx(np.sqrt(3) * 1.5 * force / 0.1)
    assert 0 <= float(found["stress"].at) <= 0.02


def dense(
    structure: Structure, linkage: FourBar, theta2: Floats, omega2: float
) -> dict[tuple[str, str], float]:
    """Stresses by brute force: at many driver angles, places along the bars, and fibres."""
    state = solve_kinematics(linkage, theta2, omega2)
    found = {}
    assert structure.section is not None
    for link, bar in analysis.section_forces(state, structure.masses, structure.loads).items():
        cuts = np.linspace(bar.stations[0, 0], bar.stations[0, -1], 101)
        cuts = np.unique(np.concatenate([cuts, bar.stations[0]]))
        own = structure.section.of(link)
        sides = [bar.at(cuts, before=before) for before in (True, False)]
        normal, shear, moment = (np.stack(each) * factor for each, factor in zip(
            zip(*sides, strict=True),
            (structure.in_si("N"), structure.in_si("N"), structure.in_si("N m")), strict=True))  # fmt: skip
        part, metre = f"link {link}", structure.metre
        axial = np.abs(normal) / (own.area * metre**2)
        bending = np.abs(moment) * own.extreme_fibre / (own.inertia * metre**3)
        sheared = np.abs(shear) * own.shear_factor / (own.area * metre**2)
        found |= {
            (part, "tension"): max(normal.max(), 0), (part, "compression"): max(-normal.min(), 0),
            (part, "shear"): np.abs(shear).max(), (part, "moment"): np.abs(moment).max(),
            (part, "normal_stress"): (axial + bending).max(), (part, "shear_stress"): sheared.max(),
            (part, "stress"): von_mises(axial, bending, sheared).max(),
        }  # fmt: skip
    return {key: float(value) for key, value in found.items()}


@pytest.mark.slow
@pytest.mark.quick("6")
@pytest.mark.parametrize("seed", range(8))
def test_peaks_are_those_of_a_dense_search(seed: int) -> None:
    rng = np.random.default_rng(seed)
    metre = float(rng.choice([1.0, 1e-3, 0.0254]))
    r2, r3, r4 = 1.0, rng.uniform(2.5, 4), rng.uniform(2.5, 4)
    r1 = rng.uniform(abs(r3 - r4) + 1.1, r3 + r4 - 1.1)
    size = 1 / metre
    linkage = FourBar((0, 0), (size * r1, 0), size * r2, size * r3, size * r4, (size * 1.0, size * 2.0))
    omega2 = rng.choice([-1, 1]) * rng.uniform(1, 10)
    loads = Loads(
        gravity=np.array([0, -9.81]) / metre,
        forces=(
            AppliedForce(4, (-2 * size, 0.2 * size), 300 * rng.normal(size=2) / metre),
            AppliedForce(3, (1.0 * size, 2.0 * size), 300 * rng.normal(size=2) / metre),
        ),
        moments=(analysis.AppliedMoment(4, 100.0 / metre**2),),
        friction=analysis.Friction(viscous=1.0 / metre**2),
    )
    masses = analysis.uniform_bars(linkage, 20.0 * metre, payload=5.0)
    stubby = rng.random() < 0.5  # where shear counts
    section = SectionSpec(width=(0.8 if stubby else 0.05) * size, height=0.05 * size)
    structure = Structure(masses, loads, section, StrengthSpec(235e6, 210e9), metre)
    summary = over_all(structure, linkage, omega2)
    near = np.logspace(-4, -0.5, 60)
    theta2 = np.concatenate([np.linspace(0, TURN, 501), near, np.pi - near, np.pi + near, TURN - near])
    expected = dense(structure, linkage, theta2, omega2)
    for (part, key), value in expected.items():
        peak = summary.peak(key, part)
        assert peak.value >= value * (1 - 1e-12)
        there = dense(structure, linkage, np.array([peak.place]), omega2)[part, key]
        assert there * (1 - 1e-12) <= peak.value <= there * 1.002 + 1e-9
        if peak.value > 0:
            state = solve_kinematics(linkage, np.array([peak.place]), omega2)
            own = strength_at(state, structure).bars[int(part[-1])][key]
            assert float(own.value[0]) == pytest.approx(peak.value, rel=1e-12)
            assert float(own.at[0]) == peak.at


def test_peaks_are_stationary_to_rounding() -> None:
    """The moment of the jack's beam over its saddle is greatest where the beam is level."""
    structure = Structure(WEIGHTLESS, Loads(forces=(WELL,)), SectionSpec(0.2, 0.2))
    peak = over_all(structure, JACK).peak("moment", "link 4")
    assert peak.value == pytest.approx(20000 * 4.572, rel=1e-14)
    assert peak.at == pytest.approx(0, abs=1e-12)
    assert float(np.sin(solve_kinematics(JACK, peak.place).theta4)) == pytest.approx(0, abs=1e-7)


def test_safety_factors_are_limits_over_peaks() -> None:
    strength = replace(STEEL, pin_diameter=0.1)
    loads = Loads(gravity=(0, -9.81), forces=(WELL,))
    structure = Structure(analysis.uniform_bars(JACK, 312.0), loads, SectionSpec(0.2, 0.2), strength)
    summary = over_all(structure, JACK, TURN / 3)
    by_part = {(factor.key, factor.part): factor for factor in summary.factors}
    assert len(by_part) == len(summary.factors) == 3 * 3 + 4 * 2
    stress = summary.peak("stress", "link 4")
    assert by_part["yield", "link 4"].value == pytest.approx(235e6 / stress.value)
    assert by_part["yield", "link 4"].place == stress.place
    assert by_part["buckling", "link 3"].value == np.inf  # a pitman that is pulled alone
    force = summary.peak("pin_force", "O4").value
    assert by_part["pin_shear", "O4"].value == pytest.approx(235e6 / 3**0.5 * np.pi * 0.1**2 / 4 / force)
    assert by_part["bearing", "O4"].value == pytest.approx(235e6 * 0.1 * 0.2 / force)
    assert summary.worst == by_part["yield", "link 4"]
    assert summary.worst_bar.part == "link 4"
    assert summary.worst_bar.value == pytest.approx(1 / by_part["yield", "link 4"].value)


def test_the_worst_bar_is_found_without_sections_too() -> None:
    thin = SectionSpec(width=[0.02, 0.2, 0.2], height=0.2)
    for section, *worst in ((None, "link 4", "moment"), (thin, "link 2", "stress")):
        summary = over_all(Structure(WEIGHTLESS, Loads(forces=(WELL,)), section), JACK)
        assert [summary.worst_bar.part, summary.worst_bar.key] == worst
        assert (summary.worst, summary.factors) == (None, ())


@pytest.mark.slow
@pytest.mark.quick("2.0-linkage1")
@pytest.mark.parametrize(
    "linkage",
    [
        FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3),  # a triple-rocker
        FourBar(o2=(0, 0), o4=(4, 0), r2=3, r3=1, r4=3),  # a double-rocker
        FourBar(o2=(0, 0), o4=(4, 1), r2=2, r3=17**0.5, r4=2),  # a parallelogram: change points in its turn
    ],
)
@pytest.mark.parametrize("omega2", [2.0, -2.0, 0.0])
def test_dead_positions_are_infinite(linkage: FourBar, omega2: float) -> None:
    structure = Structure(analysis.uniform_bars(linkage, 2.0), WEIGHT, SectionSpec(0.1, 0.1), STEEL)
    summary = over_all(structure, linkage, omega2)
    for peak in summary.peaks:
        assert peak.value == np.inf
        assert np.isnan(peak.at)
    assert {factor.value for factor in summary.factors} == {0.0}
    # Short of them all is finite.
    low, high = analysis.driver_ranges(linkage)[0]
    inside = [np.linspace(low + 0.1, min(high, low + 3) - 0.2, 50)]
    found = analysis.strength_over(
        structure, lambda theta2: solve_kinematics(linkage, theta2, omega2), inside
    )
    assert all(np.isfinite(peak.value) for peak in found.peaks)


def test_a_linkage_without_loads_bears_nothing() -> None:
    found = over_all(Structure(WEIGHTLESS, Loads(), SectionSpec(0.1, 0.1), STEEL), JACK)
    assert {peak.value for peak in found.peaks} == {0.0}
    assert {factor.value for factor in found.factors} == {np.inf}
    assert found.worst is not None


def test_a_motion_that_cannot_close_is_refused() -> None:
    structure, motion = Structure(WEIGHTLESS, Loads()), [np.linspace(0, 3, 50)]
    with pytest.raises(AssemblyError, match="cannot close at driver angle"):
        analysis.strength_over(structure, lambda theta2: solve_kinematics(ROCKER, theta2), motion)


def test_a_motion_over_time_may_be_uneven() -> None:
    """A crank that starts and stops: its own inertia bends it most where it speeds up most."""
    bars = analysis.Masses(analysis.uniform_bars(JACK, 5.0).crank, analysis.Body(0), analysis.Body(0))

    def motion(time: Floats) -> analysis.Kinematics:
        phase = TURN * time
        return solve_kinematics(JACK, time - np.sin(phase) / TURN, 1 - np.cos(phase), TURN * np.sin(phase))

    found = analysis.strength_over(Structure(bars, Loads()), motion, [np.linspace(0, 1, 200)])
    moment = found.peak("moment", "link 2")
    assert moment.value == pytest.approx(5 * 1.1938**3 / 3 * TURN, rel=1e-12)
    assert moment.place in (pytest.approx(0.25), pytest.approx(0.75))
