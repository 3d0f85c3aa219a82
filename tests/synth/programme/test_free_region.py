"""Free regions hold their point and nothing of the areas near it."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

from grashof.problems import Requirements
from grashof.problems.values.areas import solid
from grashof.synth.programme.structure import PLANES
from grashof.synth.quantities.convex import half_planes
from grashof.synth.quantities.screening import keep_out_violation, points_kept_out

STAIRS = np.array([[0, -9], [0, 0], [5, 0], [5, 4], [9, 4], [9, -9]], dtype=float)
TWO = (np.array([[-1.0, 0], [1, 0], [0, 2]]), np.array([[2.0, 0], [4, 0], [3, 2]]))


def crossings(polygon: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Whether points lie inside, by the crossings of a ray."""
    begin, end = polygon, np.roll(polygon, -1, axis=0)
    x, y = points[:, :1], points[:, 1:]
    spans = (begin[:, 1] > y) != (end[:, 1] > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = begin[:, 0] + (y - begin[:, 1]) * (end - begin)[:, 0] / (end - begin)[:, 1]
    return (spans & (x < at)).sum(axis=1) % 2 == 1


def held(planes: np.ndarray, points: np.ndarray, slack: float = 0.0) -> np.ndarray:
    return (points @ planes[:, :2].T >= planes[:, 2] - slack).all(axis=1)


@pytest.mark.parametrize("areas", [(STAIRS,), TWO, (*TWO, np.array([[1.2, 3.0], [2.5, 3.5], [1.0, 5.0]]))])
def test_a_free_region_holds_its_point_and_nothing_of_the_areas(areas: tuple[np.ndarray, ...]) -> None:
    rng, area = np.random.default_rng(3), solid(areas)
    grid = rng.uniform(-12, 14, (40_000, 2))
    within = np.any([crossings(polygon, grid) for polygon in areas], axis=0)
    assert within.sum() > 200
    for point in rng.uniform(-3, 10, (60, 2)):
        planes = half_planes(area, complex(*point), PLANES)
        if np.any([crossings(polygon, point[None]) for polygon in areas]):
            assert not held(planes, point[None]).any()
        else:
            assert held(planes, point[None]).all()
        assert not held(planes, grid[within], slack=-1e-9).any()


def test_on_the_boundary_a_point_may_slide_along_it() -> None:
    for point, along in ((2 + 0j, 1), (5 + 2j, 1j), (7 + 4j, 1), (5 + 0j, 0), (0 - 3j, 1j)):
        planes = half_planes(solid([STAIRS]), point, PLANES)
        for step in (-0.5, 0.5):
            place = point + step * along
            assert held(planes, np.array([[place.real, place.imag]]), slack=1e-12).all()


def test_from_inside_the_nearest_boundary_is_taken() -> None:
    planes = half_planes(solid([STAIRS]), 5.5 + 1j, PLANES)  # half a unit from the wall
    np.testing.assert_allclose(planes[0], [-1, 0, -5], atol=1e-12)
    assert held(planes, np.array([[4.9, 1.0]])).all()


def test_named_points_and_ends_of_links_keep_out() -> None:
    square = [[[0, 0], [4, 0], [4, 4], [0, 4]]]
    assert points_kept_out(Requirements()) == ()
    for names, expected in ((("b", "o2"), ("o2", "b")), (("links",), ("o2", "o4", "a", "b", "p"))):
        wanted = Requirements(keep_out=square, keep_out_for=names)  # type: ignore[arg-type]
        assert points_kept_out(wanted) == expected
        for name in ("o2", "o4", "a", "b", "p"):
            found = keep_out_violation(name, np.array([[1 + 2j], [5 + 5j], [4 + 0j]]), wanted)
            assert found.tolist() == [1.0 if name in expected else 0.0, 0.0, 0.0]


def test_depth_against_a_triangulation() -> None:
    triangle = np.array([[0.0, 0], [3, 1], [1, 4]])
    points = np.random.default_rng(0).uniform(-1, 5, (500, 2))
    inside = Delaunay(triangle).find_simplex(points) >= 0
    found = keep_out_violation("o2", points @ np.array([[1], [1j]]), Requirements(keep_out=(triangle,)))
    assert ((found > 0) == inside).all()
