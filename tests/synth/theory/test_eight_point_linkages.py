"""All slider-cranks and inverted ones through eight points: planted ones, closed in another way."""

from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from grashof.synth.theory.eight_point_linkages import inverted_slider_cranks_through, slider_cranks_through
from grashof.synth.theory.point_families import FAMILIES, Family

pytestmark = pytest.mark.slow

SCRIPTS = Path(__file__).parents[3] / "scripts" / "benchmarks"


@pytest.fixture(scope="module")
def benchmark():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(SCRIPTS)
        yield import_module("eight_points")


@pytest.fixture(scope="module")
def planted(benchmark):
    points, linkage = benchmark.planted_points("slider-crank", np.random.default_rng(2))
    return points, linkage, slider_cranks_through(points, np.random.default_rng(1))


@pytest.fixture
def few_inverted(monkeypatch):
    """A part of the solutions of inverted slider-cranks only."""
    known = Family.known

    def part(family):
        displacements, solutions = known(family)
        return displacements, solutions[:150]

    monkeypatch.setattr(Family, "known", part)


def z(pairs):
    return pairs @ np.array([1, 1j])


def size(points):
    return np.abs(points[:, None] - points).max()


def rod_directions(linkages, theta2, points):
    """Directions exp(i theta3) in which P is at a distance from A, as the points have it, and A; (n, 8)."""
    a = z(linkages.o2)[:, None] + linkages.r2[:, None] * np.exp(1j * theta2)
    return (points - a) / z(linkages.coupler_point)[:, None], a


def assert_slider_cranks_pass(through, points):
    """The rod, laid from A through the point, has its length and ends on the slide."""
    found = through.linkages
    e3, a = rod_directions(found, through.theta2, points)
    scale = 1e-9 * size(points)
    b = a + found.r3[:, None] * e3
    line = np.exp(1j * found.slide_angle)[:, None]
    beside = ((b - z(found.o2)[:, None]) / line).imag - found.offset[:, None]
    leverage = 1 + found.r3 / np.hypot(*found.coupler_point.T)
    assert (np.abs(beside) / leverage[:, None]).max() < scale
    assert (np.abs(np.abs(e3) - 1) * np.hypot(*found.coupler_point.T)[:, None]).max() < scale
    ahead = (e3 / line).real
    clear = np.abs(ahead) > 1e-6  # of the dead positions
    assert (np.sign(ahead) == through.assembly)[clear].all()
    assert (found.assembly == through.assembly[:, 0]).all()


def assert_inverted_ones_pass(through, points):
    """The rod's line, laid from A through the point, has its distance from O4."""
    found = through.linkages
    e3, a = rod_directions(found, through.theta2, points)
    arm = np.hypot(*found.coupler_point.T)[:, None]
    block = z(found.o4)[:, None] - a
    beside = -(block / e3).imag * np.abs(e3) - found.offset[:, None]
    leverage = 1 + np.abs(block) / arm
    assert (np.abs(beside) / leverage).max() < 1e-9 * size(points)
    assert (np.abs(np.abs(e3) - 1) * arm).max() < 1e-9 * size(points)
    ahead = (block / e3).real
    clear = np.abs(ahead) > 1e-6 * np.abs(block)
    assert (np.sign(ahead) == through.assembly)[clear].all()


def test_the_planted_slider_crank_is_among_all_of_them(planted, benchmark):
    _, linkage, through = planted
    assert through.solutions == 279
    assert benchmark.missed(linkage, through) < 1e-9
    nearest = np.hypot(*(through.linkages.o2 - linkage.o2).T) + np.abs(through.linkages.r2 - linkage.r2)
    same = through.linkages[int(nearest.argmin())]
    turned = np.exp(
        1j * (same.slide_angle - linkage.slide_angle)
    ).real  # the slide's direction may be opposite
    assert turned == pytest.approx(same.assembly * linkage.assembly)
    assert same.offset == pytest.approx(turned * linkage.offset)
    assert same.coupler_point == pytest.approx(linkage.coupler_point)


def test_slider_cranks_pass_all_points_and_cognates_follow_one_another(planted):
    points, _, through = planted
    assert_slider_cranks_pass(through, points)
    found = through.linkages
    one, other = (found[part] for part in (slice(0, None, 2), slice(1, None, 2)))
    assert len(found.r2) % 2 == 0
    assert np.abs(one.o2 - other.o2).max() < 1e-9 * np.abs(found.o2).max()
    k = z(one.coupler_point) / one.r3
    assert other.r2 == pytest.approx(np.abs(k) * one.r3)
    assert other.r3 == pytest.approx(np.abs(k) * one.r2)


def test_all_slider_cranks_are_distinct(planted):
    points, _, through = planted
    found = through.linkages
    numbers = np.column_stack([found.o2, found.r2, found.r3, found.coupler_point]) / size(points)
    apart = np.abs(numbers[:, None] - numbers).max(axis=2) + np.eye(len(numbers))
    assert apart.min() > 1e-6


@pytest.mark.quick("0.001-True-False")
@pytest.mark.parametrize(
    ("factor", "mirrored", "back"), [(25.4 * np.exp(1j), False, True), (1e-3, True, False)]
)
def test_units_directions_and_the_points_order_do_not_matter(planted, factor, mirrored, back):
    points, _, through = planted
    image = points.conj() if mirrored else points
    moved = 1e3 + factor * (image[::-1] if back else image)
    again = slider_cranks_through(moved, np.random.default_rng(9))
    assert_slider_cranks_pass(again, moved)
    o2 = z(through.linkages.o2)
    expected = 1e3 + factor * (o2.conj() if mirrored else o2)
    gap = np.abs(z(again.linkages.o2)[:, None] - expected) / (size(moved) + np.abs(expected))
    assert max(gap.min(axis=0).max(), gap.min(axis=1).max()) < 1e-5


@pytest.mark.usefixtures("few_inverted")
def test_inverted_slider_cranks_pass_all_points(benchmark):
    points, _ = benchmark.planted_points("inverted-slider-crank", np.random.default_rng(3))
    through = inverted_slider_cranks_through(points, np.random.default_rng(0), runs=1)
    assert through.solutions >= 147
    assert len(through.theta2) >= 5
    assert_inverted_ones_pass(through, points)


@pytest.mark.quick("on a circle")
@pytest.mark.parametrize(
    "points",
    [
        pytest.param(np.exp(1j * np.arange(8)), id="on a circle"),
        pytest.param(np.arange(8) ** 1.5 * (1 + 1j), id="on a line"),
        pytest.param([0, 0, 1, 2j, 3, 1 + 1j, 2 + 3j, 4], id="one twice", marks=pytest.mark.slow),
    ],
)
def test_points_of_infinitely_many_or_no_linkages_give_a_list_that_is_right(points):
    points = np.array(points, dtype=complex)
    through = slider_cranks_through(points, np.random.default_rng(0), runs=1)
    assert through.theta2.shape == through.assembly.shape == (len(through.linkages.r2), 8)
    if len(through.theta2):
        assert_slider_cranks_pass(through, points)


@pytest.mark.study
@pytest.mark.parametrize("number", range(20))
def test_of_558_paths_548_arrive_and_the_planted_slider_crank_is_found(benchmark, number):
    kind = "slider-crank"
    points, _ = benchmark.planted_points(kind, np.random.default_rng([8, number]))
    assert 2 * benchmark.arrived(kind, points, np.random.default_rng([9, number])) >= 548
    through, _, gap = benchmark.measure(kind, number)
    assert FAMILIES[kind].count - 2 <= through.solutions <= FAMILIES[kind].count
    assert gap < 1e-6


@pytest.mark.study
@pytest.mark.parametrize(
    "number", [2, *(pytest.param(number, marks=pytest.mark.study) for number in range(2))]
)
def test_the_planted_inverted_slider_crank_is_found(benchmark, number):
    kind = "inverted-slider-crank"
    points, _ = benchmark.planted_points(kind, np.random.default_rng([8, number]))
    assert benchmark.arrived(kind, points, np.random.default_rng([9, number])) >= 2195
    through, _, gap = benchmark.measure(kind, number)
    assert FAMILIES[kind].count - 2 <= through.solutions <= FAMILIES[kind].count
    assert gap < 1e-6
    assert_inverted_ones_pass(through, points)
