"""Forces along a bar, where they are greatest, deflections, stress: closed forms, second ways."""

import warnings
from itertools import pairwise

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from loaded_linkages import JACK, ROCKER, WEIGHT, closed_dead_and_open

from grashof import analysis
from grashof.analysis import WEIGHTLESS, AppliedForce, Body, Loads, section_forces, solve_kinematics
from grashof.analysis.strength.along_bar import deflection, greatest, greatest_deflection, greatest_of
from grashof.analysis.strength.section_forces import polynomial
from grashof.analysis.strength.strength import von_mises
from grashof.problems import FourBar, ProblemError

Floats = npt.NDArray[np.float64]
LINKS = (2, 3, 4)
# O2A and O4B are vertical, AB is horizontal at a driver angle of 90 deg: a portal.
PORTAL = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=1)
STIFFNESS = 70.0


def portal(loads: Loads, coupler: Body | None = None) -> analysis.BarForces:
    """The coupler of a portal at rest: a level beam on two supports, four long."""
    state = solve_kinematics(PORTAL, np.pi / 2, 0.0)
    return section_forces(state, analysis.Masses(Body(0), coupler or Body(0), Body(0)), loads)[3]


def random_bars() -> analysis.BarForces:
    """A bar with loads of all kinds on it and beyond its joints, in 30 positions."""
    rng = np.random.default_rng(11)
    linkage = FourBar(o2=(0, 0), o4=(4, 1), r2=1, r3=4, r4=3)
    state = solve_kinematics(linkage, np.linspace(0, 6.2, 30), 2.0, 1.0)
    masses = analysis.Masses(
        Body(0), analysis.uniform_bar(4.0, 3.0) + Body(2.0, 0.5, (1.0, 0.3)), analysis.uniform_bar(3.0, 2.0)
    )
    forces = tuple(AppliedForce(3, (float(u), 0.1), 20 * rng.normal(size=2)) for u in (-1.5, 0.7, 2.2, 5.0))
    moments = (analysis.AppliedMoment(3, 20.0, at=(3.0, 0.0)),)
    return section_forces(state, masses, Loads(gravity=(1, -9.8), forces=forces, moments=moments))[3]


def values(bar: analysis.BarForces, terms: Floats, count: int = 2001) -> Floats:
    """Of polynomials at many places of every span, shape (..., spans, count)."""
    return polynomial(terms, bar.spans[..., None] * np.linspace(0, 1, count))


def test_a_bar_under_its_weight_sags_as_in_the_books() -> None:
    bar = portal(Loads(gravity=(0, -10)), analysis.uniform_bar(4.0, 3.0))
    u = np.linspace(0, 4, 9)
    found, load = bar.at(u), 30.0
    np.testing.assert_allclose(found.moment, load * u * (4 - u) / 2, atol=1e-12)
    np.testing.assert_allclose(found.shear, load * (2 - u), atol=1e-12)
    np.testing.assert_allclose(found.normal, 0, atol=1e-12)
    assert found.moment[4] == pytest.approx(load * 4**2 / 8, rel=1e-14)
    peak = greatest(bar, bar.moment, size=True)
    assert (float(peak.value), float(peak.at)) == (pytest.approx(load * 4**2 / 8), pytest.approx(2))
    sag = greatest_deflection(bar, deflection(bar, STIFFNESS))
    assert float(sag.value) == pytest.approx(5 * load * 4**4 / (384 * STIFFNESS), rel=1e-13)
    assert float(sag.at) == pytest.approx(2, abs=1e-7)


@pytest.mark.parametrize("place", [0.5, 1.0, 2.0, 3.3])
def test_a_single_load_between_the_joints(place: float) -> None:
    bar = portal(Loads(forces=(AppliedForce(3, (place, 0), (0, -6.0)),)))
    moment = greatest(bar, bar.moment, size=True)
    assert float(moment.value) == pytest.approx(6 * place * (4 - place) / 4)
    assert float(moment.at) == pytest.approx(place)
    # Timoshenko; Shigley, table A-9, case 6: b is the shorter part, the deepest place in the longer one.
    b = min(place, 4 - place)
    sag = greatest_deflection(bar, deflection(bar, STIFFNESS))
    deepest = 6 * b * (16 - b**2) ** 1.5 / (9 * np.sqrt(3) * 4 * STIFFNESS)
    assert float(sag.value) == pytest.approx(deepest, rel=1e-12)
    from_far_end = np.sqrt((16 - b**2) / 3)
    assert float(sag.at) == pytest.approx(4 - from_far_end if place < 2 else from_far_end, abs=1e-6)


@pytest.mark.parametrize("over", [1.5, 0.2])
def test_an_overhang_dips_and_lifts_the_bar(over: float) -> None:
    """Shigley, table A-9, case 10."""
    bar = portal(Loads(forces=(AppliedForce(3, (4 + over, 0), (0, -6.0)),)))
    bow = deflection(bar, STIFFNESS)
    tip = values(bar, bow)[-1, -1]
    assert tip == pytest.approx(-6 * over**2 * (4 + over) / (3 * STIFFNESS), rel=1e-12)
    between = values(bar, bow)[bar.between_joints].max()
    assert between == pytest.approx(6 * over * 4**2 / (9 * np.sqrt(3) * STIFFNESS), rel=1e-6)
    assert float(greatest_deflection(bar, bow).value) == pytest.approx(max(-tip, between), rel=1e-6)


def test_deflections_are_those_of_unit_loads() -> None:
    """The method of virtual work (Mohr), by quadrature."""
    bar = random_bars()
    bow = deflection(bar, STIFFNESS)
    stations = bar.stations[0]
    nodes, weights = np.polynomial.legendre.leggauss(8)
    for place in (-1.2, 0.4, 1.9, 3.7, 4.6):
        span = np.flatnonzero((stations[:-1] <= place) & bar.real[0])[-1]
        inside = np.full((30, 1), place - stations[span])
        found = polynomial(bow[:, span], inside)[:, 0]
        work = np.zeros(30)
        ends = np.unique(np.concatenate([stations, [place]]))
        for low, high in pairwise(ends):
            u = (low + high) / 2 + (high - low) / 2 * nodes
            # Moment of a unit load downwards, supported in 0 and 4.
            first, last = (4 - place) / 4, place / 4
            unit = (
                np.where(u > place, -(u - place), 0) + first * np.maximum(u, 0) + last * np.maximum(u - 4, 0)
            )
            work += (high - low) / 2 * (bar.at(u).moment * unit) @ weights / STIFFNESS
        np.testing.assert_allclose(found, -work, atol=1e-11 * np.abs(work).max())


def test_the_greatest_is_that_of_dense_samples() -> None:
    bar = random_bars()
    stress = np.concatenate([bar.normal, np.zeros((*bar.normal.shape[:-1], 1))], axis=-1) / 3
    bow = deflection(bar, STIFFNESS)

    def size(a: Floats, b: Floats) -> Floats:
        return np.asarray(np.hypot(a, b))

    real = bar.real[..., None]
    inner = np.where(bar.between_joints[..., None], -values(bar, bar.normal), -1e9)
    normal, moment, both = values(bar, bar.normal), values(bar, bar.moment), values(bar, stress - bar.moment)
    for found, dense in (
        (greatest(bar, bar.normal), normal),
        (greatest(bar, -bar.normal, spans=bar.between_joints), inner),
        (greatest(bar, bar.moment, size=True), np.abs(moment)),
        (
            greatest(bar, stress + bar.moment, stress - bar.moment, size=True),
            np.abs(normal / 3) + np.abs(moment),
        ),
        (greatest(bar, stress - bar.moment, size=True), np.abs(both)),
        (greatest_deflection(bar, bow), np.abs(values(bar, bow))),
        (greatest_of(bar, size, bar.normal, bar.moment), size(normal, moment)),
    ):
        highest = np.where(real, dense, -np.inf).max(axis=(-2, -1))
        assert (found.value >= highest - 1e-11 * np.abs(highest).max()).all()
        np.testing.assert_allclose(found.value, highest, rtol=1e-5)


def test_the_place_is_where_the_value_is() -> None:
    bar = random_bars()
    found = greatest(bar, bar.moment, size=True)
    sides = [np.abs(bar.at(found.at[:, None], before=before).moment[:, 0]) for before in (True, False)]
    np.testing.assert_allclose(np.max(sides, axis=0), found.value, rtol=1e-9)
    lifted = greatest(bar, bar.normal)
    sides = [bar.at(lifted.at[:, None], before=before).normal[:, 0] for before in (True, False)]
    np.testing.assert_allclose(np.max(sides, axis=0), lifted.value, rtol=1e-9)


def test_loads_at_one_place_are_not_seen_one_by_one() -> None:
    """Opposite forces on a joint are nothing to the bar."""
    pair = (AppliedForce(3, (0, 0), (0.0, -900.0)), AppliedForce(3, (1e-13, 0), (0.0, 900.0)))
    bar = portal(Loads(forces=(*pair, AppliedForce(3, (2, 0), (0, -6.0)))))
    assert float(greatest(bar, bar.shear, size=True).value) == pytest.approx(3)
    np.testing.assert_allclose(bar.at([0.0, 4.0]).shear, [3, -3])
    np.testing.assert_allclose(bar.at([0.0, 4.0], before=True).shear, [3, -3])


def test_a_walking_beam_bends_over_its_saddle() -> None:
    state = solve_kinematics(JACK, np.linspace(0, 6, 13), 0.0)
    loads = Loads(forces=(AppliedForce(4, (-4.572, 0), (0.0, -20000.0)),))
    bar = section_forces(state, WEIGHTLESS, loads)[4]
    np.testing.assert_allclose(bar.stations[:, [0, -1]], [[-4.572, 3.048762]] * 13)
    saddle = -20000 * 4.572 * np.cos(state.theta4)
    np.testing.assert_allclose(bar.at([0.0]).moment[:, 0], saddle)
    np.testing.assert_allclose(bar.at([0.0], before=True).moment[:, 0], saddle)
    np.testing.assert_allclose(bar.at([-2.286]).moment[:, 0], saddle / 2)
    np.testing.assert_allclose(bar.at([-4.572, -1]).shear, -20000 * np.cos(state.theta4)[:, None] * [1, 1])


def test_a_load_beside_a_bar_acts_through_an_arm_at_its_foot() -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=1, coupler_point=(1.0, 2.0))
    state = solve_kinematics(linkage, np.pi / 2, 0.0)
    pushed = Loads(forces=(AppliedForce(3, (1.0, 2.0), (30.0, -7.0)),))
    bar = section_forces(state, WEIGHTLESS, pushed)[3]
    after, before = bar.at([1.0]), bar.at([1.0], before=True)
    jump = [float(new[0] - old[0]) for new, old in zip(after, before, strict=True)]
    np.testing.assert_allclose(jump, [-30, -7, 2.0 * 30], atol=1e-12)
    # The payload is a point there, too; a moment on the coupler enters at P, or where it says.
    weighted = section_forces(state, WEIGHTLESS.with_payload(0.7, (1.0, 2.0)), Loads(gravity=(0, -10)))[3]
    assert float(weighted.at([1.0]).shear[0] - weighted.at([1.0], before=True).shear[0]) == pytest.approx(-7)
    for moment, place in (
        (analysis.AppliedMoment(3, 5.0), 1.0),
        (analysis.AppliedMoment(3, 5.0, at=(3.0, 9.0)), 3.0),
    ):
        turned = section_forces(state, WEIGHTLESS, Loads(moments=(moment,)))[3]
        before, after = turned.at([place], before=True), turned.at([place])
        assert float(after.moment[0] - before.moment[0]) == pytest.approx(-5)


@pytest.mark.parametrize(
    ("at", "ends"), [((5, 0), (0, 5)), ((5, 0.9), (0, 5)), ((5, 1.1), (0, 4)), ((-2, -1), (-2, 4))]
)
def test_the_bar_reaches_as_far_as_loads_lie_on_it(
    at: tuple[float, float], ends: tuple[float, float]
) -> None:
    state = solve_kinematics(PORTAL, 1.0, 0.0)
    bar = section_forces(state, WEIGHTLESS, Loads(forces=(AppliedForce(3, at, (1.0, 2.0)),)))[3]
    np.testing.assert_allclose(bar.stations[[0, -1]], ends)
    assert np.isnan(bar.at([ends[0] - 0.1, ends[1] + 0.1]).moment).all()


def test_dead_positions_have_no_finite_section_forces() -> None:
    state = closed_dead_and_open()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        bars = section_forces(state, analysis.uniform_bars(ROCKER, 2.0), WEIGHT)
    for link in LINKS:
        finite = np.isfinite(bars[link].at([0.5]).moment[:, 0])
        np.testing.assert_array_equal(finite, [True, False, False])


def test_loads_on_links_that_there_are_not_are_refused() -> None:
    state = solve_kinematics(PORTAL, 1.0)
    with pytest.raises(ProblemError, match="link is 1"):
        section_forces(state, WEIGHTLESS, Loads(forces=(AppliedForce(1, (0, 0), (1, 1)),)))


SIZE = st.floats(0, 1e9) | st.just(0.0) | st.floats(1e-12, 1)


@given(SIZE, SIZE, SIZE)
@example(2.0, 0.0, 0.0)
@example(0.0, 3.0, 0.0)
@example(0.0, 0.0, 1.0)
@example(1.0, 1.0, 1.0)  # worst in between, at 2.05 (Norton and Shigley look at both ends alone, at 2)
def test_the_equivalent_stress_is_the_greatest_of_all_fibres(
    axial: float, bending: float, shear: float
) -> None:
    y = np.linspace(0, 1, 20001)
    every = np.sqrt((axial + bending * y) ** 2 + 3 * (shear * (1 - y**2)) ** 2)
    found = float(von_mises(*map(np.float64, (axial, bending, shear))))
    assert every.max() * (1 - 1e-14) <= found <= every.max() * (1 + 1e-7)
