"""Where something is greatest along a bar, and deflections: closed forms and a second way."""

from itertools import pairwise

import numpy as np
import numpy.typing as npt
import pytest

from grashof.analysis import (
    AppliedForce,
    AppliedMoment,
    BarForces,
    Body,
    Loads,
    Masses,
    section_forces,
    solve_kinematics,
    uniform_bar,
)
from grashof.analysis.strength.along_bar import (
    deflection,
    greatest,
    greatest_deflection,
    greatest_of,
    greatest_size,
)
from grashof.analysis.strength.section_forces import polynomial
from grashof.problems import FourBar

Floats = npt.NDArray[np.float64]
PORTAL = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=1)
STIFFNESS = 70.0


def portal(loads: Loads, coupler: Body | None = None) -> BarForces:
    """The coupler of a portal at rest: a level beam on two supports, four long."""
    state = solve_kinematics(PORTAL, np.pi / 2, 0.0)
    return section_forces(state, Masses(Body(0), coupler or Body(0), Body(0)), loads)[3]


def random_bars() -> BarForces:
    """A bar with loads of all kinds on it and beyond its joints, in 30 positions."""
    rng = np.random.default_rng(11)
    linkage = FourBar(o2=(0, 0), o4=(4, 1), r2=1, r3=4, r4=3)
    state = solve_kinematics(linkage, np.linspace(0, 6.2, 30), 2.0, 1.0)
    masses = Masses(Body(0), uniform_bar(4.0, 3.0) + Body(2.0, 0.5, (1.0, 0.3)), uniform_bar(3.0, 2.0))
    forces = tuple(AppliedForce(3, (float(u), 0.1), 20 * rng.normal(size=2)) for u in (-1.5, 0.7, 2.2, 5.0))
    moments = (AppliedMoment(3, 20.0, at=(3.0, 0.0)),)
    return section_forces(state, masses, Loads(gravity=(1, -9.8), forces=forces, moments=moments))[3]


def values(bar: BarForces, terms: Floats, count: int = 2001) -> Floats:
    """Of polynomials at many places of every span, shape (..., spans, count)."""
    return polynomial(terms, bar.spans[..., None] * np.linspace(0, 1, count))


def test_a_bar_under_its_weight_sags_as_in_the_books() -> None:
    bar = portal(Loads(gravity=(0, -10)), uniform_bar(4.0, 3.0))
    sag = greatest_deflection(bar, deflection(bar, STIFFNESS))
    assert float(sag.value) == pytest.approx(5 * 30 * 4**4 / (384 * STIFFNESS), rel=1e-13)
    assert float(sag.at) == pytest.approx(2, abs=1e-7)
    peak = greatest_size(bar, bar.moment)
    assert (float(peak.value), float(peak.at)) == (pytest.approx(30 * 4**2 / 8), pytest.approx(2))


@pytest.mark.parametrize("place", [0.5, 1.0, 2.0, 3.3])
def test_a_single_load_between_the_joints(place: float) -> None:
    bar = portal(Loads(forces=(AppliedForce(3, (place, 0), (0, -6.0)),)))
    moment = greatest_size(bar, bar.moment)
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
        (greatest(bar, -bar.normal, bar.between_joints), inner),
        (greatest_size(bar, bar.moment), np.abs(moment)),
        (greatest_size(bar, stress + bar.moment, stress - bar.moment), np.abs(normal / 3) + np.abs(moment)),
        (greatest_size(bar, stress - bar.moment), np.abs(both)),
        (greatest_deflection(bar, bow), np.abs(values(bar, bow))),
        (greatest_of(bar, size, bar.normal, bar.moment), size(normal, moment)),
    ):
        highest = np.where(real, dense, -np.inf).max(axis=(-2, -1))
        assert (found.value >= highest - 1e-11 * np.abs(highest).max()).all()
        np.testing.assert_allclose(found.value, highest, rtol=1e-5)


def test_the_place_is_where_the_value_is() -> None:
    bar = random_bars()
    found = greatest_size(bar, bar.moment)
    sides = [np.abs(bar.at(found.at[:, None], before=before).moment[:, 0]) for before in (True, False)]
    np.testing.assert_allclose(np.max(sides, axis=0), found.value, rtol=1e-9)
    lifted = greatest(bar, bar.normal)
    sides = [bar.at(lifted.at[:, None], before=before).normal[:, 0] for before in (True, False)]
    np.testing.assert_allclose(np.max(sides, axis=0), lifted.value, rtol=1e-9)


def test_loads_at_one_place_are_not_seen_one_by_one() -> None:
    """Opposite forces on a joint are nothing to the bar."""
    pair = (AppliedForce(3, (0, 0), (0.0, -900.0)), AppliedForce(3, (1e-13, 0), (0.0, 900.0)))
    bar = portal(Loads(forces=(*pair, AppliedForce(3, (2, 0), (0, -6.0)))))
    assert float(greatest_size(bar, bar.shear).value) == pytest.approx(3)
    np.testing.assert_allclose(bar.at([0.0, 4.0]).shear, [3, -3])
    np.testing.assert_allclose(bar.at([0.0, 4.0], before=True).shear, [3, -3])
