"""Cognates: the same coupler curve from other pivots, and the timed one turns with the driver."""

import numpy as np
import pytest
from circles import closed, meeting_points, numbers_of

from grashof.analysis.judge.planted import random_full_crank, random_slider_crank
from grashof.problems import FourBar
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.theory.cognates import cognate_points, driven_at_o4, same_curve, slider_crank_cognate
from grashof.synth.theory.distinct import signature


def positions(linkage: FourBar, theta2: FloatArray) -> ComplexArray:
    """O2, O4, A, B, P at driver angles, shape (n, 5), by circle intersection."""
    a, b, p = closed(signature(linkage), theta2, float(linkage.assembly))
    o2, o4 = (np.full_like(a, complex(*pivot)) for pivot in (linkage.o2, linkage.o4))
    return np.stack([o2, o4, a, b, p], axis=1)


def linkages(count: int) -> list[tuple[FourBar, FloatArray]]:
    rng = np.random.default_rng(17)
    turn = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    return [(random_full_crank(rng), rng.uniform(-3, 3) + turn) for _ in range(count)]


CASES = linkages(6)


def same(one: ComplexArray, other: ComplexArray) -> bool:
    return bool(np.abs(one - other).max() < 1e-9 * np.abs(other - other[0]).max())


@pytest.mark.parametrize("case", range(len(CASES)))
@pytest.mark.parametrize("timed", [False, True])
def test_a_cognate_is_one_linkage_all_the_way_and_carries_the_same_point(case: int, timed: bool) -> None:
    """Its pivots at ground stand still and its links keep their lengths while the linkage turns."""
    way = positions(*CASES[case])
    each = np.array([cognate_points(place, timed) for place in way])
    assert each.shape == (60, 1 if timed else 4, 5)
    scale = np.abs(np.diff(each[0])).max()
    for cognate in np.swapaxes(each, 0, 1):
        o2, o4, a, b, p = cognate.T
        for constant in (o2, o4, np.abs(a - o2), np.abs(b - a), np.abs(b - o4), (p - a) / (b - a)):
            assert np.abs(constant - constant[0]).max() < 1e-9 * scale
        np.testing.assert_array_equal(p, way[:, 4])


@pytest.mark.parametrize("case", range(len(CASES)))
def test_the_timed_cognate_turns_with_the_driver(case: int) -> None:
    linkage, theta2 = CASES[case]
    way = positions(linkage, theta2)
    (first,) = cognate_points(way[0], timed=True)
    o2, o4, a, b, p = first
    places = o2 + (a - o2) * np.exp(1j * (theta2 - theta2[0]))
    both = np.stack(meeting_points(places, complex(o4), abs(b - a), abs(b - o4)))
    sign = ((both - places).conj() * (both - o4)).imag
    assert (np.sign(sign) == np.array([[-1], [1]])).all() or (np.sign(sign) == np.array([[1], [-1]])).all()
    mine = both[0 if sign[0, 0] * ((b - a).conjugate() * (b - o4)).imag > 0 else 1]
    traced = places + (p - a) / (b - a) * (mine - places)
    np.testing.assert_allclose(traced, way[:, 4], atol=1e-8 * abs(o4 - o2) + 1e-9)


@pytest.mark.parametrize("case", range(len(CASES)))
def test_the_cognate_of_a_cognate_comes_back(case: int) -> None:
    first = positions(*CASES[case])[0]
    family = [first, driven_at_o4(first), *cognate_points(first, timed=False)]
    for cognate in family[2:]:
        own = [cognate, driven_at_o4(cognate), *cognate_points(cognate, timed=False)]
        for member in family:  # three linkages, either link at ground driving
            assert sum(same(member, other) for other in own) == 1
    (timed,) = cognate_points(first, timed=True)
    (back,) = cognate_points(timed, timed=True)
    assert same(back, first)


def test_a_coupler_point_on_a_joint_leaves_one_cognate() -> None:
    """At A, the third pivot falls on O2: the other has a ground of no length, without an error."""
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    points = positions(linkage, np.array([0.7]))[0]
    right, left, *_ = cognate_points(points, timed=False)
    np.testing.assert_allclose(np.abs(right[[1, 2, 3, 3]] - right[[0, 0, 2, 1]]), [4, 1, 3, 4], atol=1e-12)
    assert abs(left[1] - left[0]) < 1e-12


@pytest.mark.parametrize("case", range(len(CASES)))
def test_linkages_of_the_same_curve_are_the_cognates_from_numbers_alone(case: int) -> None:
    linkage, theta2 = CASES[case]
    place = positions(linkage, theta2[:1])[0]
    for timed in (False, True):
        expected = [place, *([] if timed else [driven_at_o4(place)]), *cognate_points(place, timed)]
        found = same_curve(signature(linkage), timed)
        assert len(found) == len(expected) == (2 if timed else 6)
        np.testing.assert_allclose(found[0], signature(linkage), rtol=1e-13)
        for points in expected:
            gaps = np.abs(found - numbers_of(points)).max(axis=1)
            assert np.count_nonzero(gaps < 1e-9 * np.abs(numbers_of(points)).max()) == 1


@pytest.mark.parametrize(("u", "count"), [(0.0, 4), (4.0, 4)])
def test_a_linkage_with_p_on_a_joint_has_fewer_of_its_curve(u: float, count: int) -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(u, 0))
    found = same_curve(signature(linkage), timed=False)
    assert np.isfinite(found).all()
    assert len(found) <= count


@pytest.mark.parametrize("seed", range(3))
def test_the_cognate_of_a_slider_crank(seed: int) -> None:
    """Its B keeps to the line, its links keep their lengths, and its own cognate is the first again."""
    linkage = random_slider_crank(np.random.default_rng(seed))
    along = np.exp(1j * float(linkage.slide_angle))
    a = complex(*linkage.o2) + float(linkage.r2) * np.exp(1j * np.linspace(0, 6, 60))
    across = float(linkage.offset) - ((a - complex(*linkage.o2)) / along).imag
    b = a + along * (linkage.assembly * np.sqrt(float(linkage.r3) ** 2 - across**2) + 1j * across)
    p = a + complex(*linkage.coupler_point) * (b - a) / float(linkage.r3)
    ahead = b + float(linkage.r3) * along
    way = np.stack([np.full_like(a, complex(*linkage.o2)), ahead, a, b, p], axis=1)
    each = np.array([slider_crank_cognate(points) for points in way])
    o2, ahead, a2, b2, p2 = each.T
    scale = np.abs(p2 - o2).max()
    np.testing.assert_array_equal(p2, p)
    for constant in (o2, np.abs(a2 - o2), np.abs(b2 - a2), (p2 - a2) / (b2 - a2)):
        assert np.abs(constant - constant[0]).max() < 1e-9 * scale
    line = (b2 - b2[0]) / (ahead[0] - b2[0])
    assert np.abs(line.imag).max() < 1e-9
    assert np.ptp(line.real) > 0.01
    assert same(slider_crank_cognate(each[0])[[0, 2, 3, 4]], way[0, [0, 2, 3, 4]])
