"""Distances of closed curves: shapes with a known answer, and the definitions on dense samples."""

import numpy as np
import numpy.typing as npt
import pytest
from scipy.spatial.distance import directed_hausdorff

from grashof.analysis import extremes_of, solve_position
from grashof.analysis.curves.curve_distance import curve_distances
from grashof.analysis.judge.planted import random_full_crank
from grashof.problems import FourBar

Array = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]
TURN = np.linspace(0, 2 * np.pi, 400, endpoint=False)
CIRCLE = np.stack([np.cos(TURN), np.sin(TURN)], axis=-1)
DISC = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)  # P is A, on a circle of radius 1


def size(points: Array) -> float:
    return float(np.hypot(*np.ptp(points, axis=0)))


def from_polygon(points: Complexes, corners: Complexes) -> Array:
    """Distance of points from a closed polygon."""
    far = np.full(len(points), np.inf)
    for a, b in zip(corners, np.roll(corners, -1), strict=True):
        share = np.clip(((points - a) * np.conj(b - a)).real / abs(b - a) ** 2, 0, 1)
        far = np.minimum(far, np.abs(points - a - share * (b - a)))
    return far


@pytest.mark.parametrize("radius", [0.5, 1.0, 2.0])
def test_a_polygon_about_or_in_a_circle(radius: float) -> None:
    """The corners are on the circle of that radius, the middles of the sides nearer to the centre."""
    hausdorff, frechet = curve_distances(DISC, radius * CIRCLE, 1)
    furthest = 1 - radius * np.cos(np.pi / 400) if radius <= 1 else radius - 1
    assert hausdorff == pytest.approx(furthest, rel=1e-12, abs=1e-15)
    assert frechet == pytest.approx(abs(radius - 1), abs=1e-3)


def test_a_circle_in_the_wrong_sense_is_near_and_yet_far() -> None:
    hausdorff, frechet = curve_distances(DISC, CIRCLE, -1)
    assert hausdorff < 2e-4
    # Two walkers in opposite senses are a quarter turn or more apart somewhere.
    assert frechet >= np.sqrt(2)


@pytest.mark.parametrize("seed", [7])
def test_a_curve_is_at_no_distance_from_itself_wherever_it_begins(seed: int) -> None:
    rng = np.random.default_rng(seed)
    linkage = random_full_crank(rng)
    for sense in (1, -1):
        points = solve_position(linkage, rng.uniform(0, 6) + sense * TURN).p
        distances = np.array(curve_distances(linkage, points, sense)) / size(points)
        assert distances[0] < 2e-3
        assert distances[1] < 2e-3
        repeated = np.concatenate([points, points[:1]])
        assert curve_distances(linkage, repeated, sense) == pytest.approx(
            tuple(distances * size(points)), abs=1e-9
        )


def test_a_corner_and_a_ridge() -> None:
    """From the corner of a square to a circle in it; from the middle of a slot to both of its sides."""
    hausdorff, frechet = curve_distances(DISC, np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]), 1)
    assert hausdorff == pytest.approx(np.sqrt(2) - 1, rel=1e-12)
    assert frechet == pytest.approx(np.sqrt(2) - 1, abs=1e-2)
    slot = np.array([[2.0, 1.0], [-0.5, 0.0], [2.0, -0.1]])
    hausdorff, _ = curve_distances(DISC, slot, 1)
    far = from_polygon(np.exp(1j * np.linspace(0, 2 * np.pi, 400_001)), slot @ [1, 1j])
    assert hausdorff == pytest.approx(max(far.max(), np.sqrt(5) - 1), rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_the_hausdorff_distance_to_nine_digits(seed: int) -> None:
    """Compared with a dense search on both curves, refined about the furthest points."""
    rng = np.random.default_rng(seed)
    linkage = random_full_crank(rng)
    corners = solve_position(linkage, np.sort(rng.uniform(0, 2 * np.pi, 5 + 3 * seed))).p
    corners = corners + 10 ** rng.uniform(-3, -1) * size(corners) * rng.normal(size=corners.shape)
    hausdorff, _ = curve_distances(linkage, corners, 1)
    loop = np.append(corners, corners[:1], axis=0) @ np.array([1, 1j])

    def p(theta2: Array) -> Complexes:
        return solve_position(linkage, theta2).p @ np.array([1, 1j])

    def q(place: Array) -> Complexes:
        return np.interp(place, np.arange(len(loop)), loop)

    dense = np.linspace(0, 2 * np.pi, 5001)

    def from_curve(place: Array) -> Array:
        points = q(place)[:, None]
        near = dense[np.abs(points - p(dense)).argmin(axis=1)]
        width = dense[1]
        for _ in range(4):
            around = near[:, None] + width * np.linspace(-1, 1, 33)
            far = np.abs(points - p(around))
            near, width = around[np.arange(len(near)), far.argmin(axis=1)], width / 12
        return far.min(axis=1)

    expected = max(
        extremes_of(lambda theta2: from_polygon(p(theta2), loop[:-1]), 0, 2 * np.pi).high,
        extremes_of(from_curve, 0, len(loop) - 1.0).high,
    )
    assert hausdorff == pytest.approx(expected, rel=1e-9)


def brute_frechet(one: Array, other: Array) -> float:
    """Discrete Frechet distance (Eiter & Mannila 1994) by recursion, for every shift of the second."""
    gap = np.hypot(*np.moveaxis(one[:, None] - other, -1, 0))
    gap = np.concatenate([gap, gap[:1]])
    least = np.inf
    for shift in range(len(other)):
        turned = np.roll(gap, -shift, axis=1)
        turned = np.concatenate([turned, turned[:, :1]], axis=1)
        leash = np.maximum.accumulate(turned[0])
        for row in turned[1:]:
            best = np.minimum(leash, np.concatenate([[np.inf], leash[:-1]]))
            fresh = np.empty_like(leash)
            walk = np.inf
            for column, step in enumerate(row):
                walk = fresh[column] = max(step, min(best[column], walk))
            leash = fresh
        least = min(least, leash[-1])
    return least


@pytest.mark.slow
@pytest.mark.quick("0")
@pytest.mark.parametrize("seed", range(2))
def test_the_definitions_on_dense_samples(seed: int) -> None:
    rng = np.random.default_rng(seed)
    linkage = random_full_crank(rng)
    curve = solve_position(linkage, np.linspace(0, 2 * np.pi, 4000)).p
    corners = solve_position(linkage, np.linspace(0, 2 * np.pi, 9)[:-1]).p
    corners = corners + 0.1 * size(curve) * rng.normal(size=corners.shape)
    share = np.linspace(0, 1, 400, endpoint=False)[:, None]
    polygon = np.concatenate(
        [a + share * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    )
    hausdorff, frechet = curve_distances(linkage, corners, 1)
    both = max(directed_hausdorff(polygon, curve)[0], directed_hausdorff(curve, polygon)[0])
    assert hausdorff == pytest.approx(both, abs=2e-3 * size(curve))
    coarse = brute_frechet(polygon[::25], curve[:-1:40])
    assert hausdorff <= frechet
    assert frechet == pytest.approx(coarse, abs=0.04 * size(curve))
    assert frechet <= coarse + 0.01 * size(curve)
