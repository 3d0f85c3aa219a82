"""The judge on areas kept out, against a winding number, distances and brute force without shapely."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from grashof.analysis import Verdict, solve_position, verify
from grashof.analysis.judge.keep_out import Area, depth, segment_depth
from grashof.problems import FourBar, MotionTask, PathTask, Requirements

Points = npt.NDArray[np.float64]
STAIRS = np.array([[0, -9], [0, 0], [5, 0], [5, 4], [9, 4], [9, -9]], dtype=float)
SPIRAL = np.array(
    [[0, 0], [6, 0], [6, 5], [2, 5], [2, 2], [4, 2], [4, 3], [3, 3], [3, 4], [5, 4], [5, 1], [0, 1]]
)
LINKAGE = FourBar(
    o2=(0.5, -1), o4=(4.2, 0.3), r2=1.1, r3=3.2, r4=2.6, coupler_point=(1.5, 0.8), body_angle=0.3
)
DEGREES = (20.0, 60.0, 110.0, 150.0)
STATE = solve_position(LINKAGE, np.radians(DEGREES))
TASK = MotionTask(STATE.p, STATE.theta3 + 0.3)
WAY = solve_position(LINKAGE, np.radians(np.linspace(20, 150, 20001)))
LINES = {
    "link O2A": ("o2", "a"), "link AB": ("a", "b"), "link O4B": ("o4", "b"), "line AP": ("a", "p"),
    "line BP": ("b", "p"),
}  # fmt: skip


def inside(polygon: Points, points: Points) -> npt.NDArray[np.bool_]:
    """Whether the polygon winds about points (..., 2)."""
    towards = (polygon - points[..., None, :]) @ np.array([1, 1j])
    with np.errstate(invalid="ignore"):  # a point may be a corner
        turns = np.angle(np.roll(towards, -1, axis=-1) * towards.conj())
    return np.asarray(np.abs(turns.sum(axis=-1)) > np.pi)


def from_sides(polygon: Points, points: Points) -> Points:
    along = np.roll(polygon, -1, axis=0) - polygon
    off = points[..., None, :] - polygon
    share = np.clip((off * along).sum(-1) / (along**2).sum(-1), 0, 1)
    gap = off - share[..., None] * along
    return np.asarray(np.hypot(gap[..., 0], gap[..., 1]).min(axis=-1))


def signed(polygon: Points, points: Points) -> Points:
    return from_sides(polygon, points) * np.where(inside(polygon, points), 1, -1)


def box(x: float, y: float, half: float = 0.2) -> list[list[float]]:
    return [[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]]


def judged(areas: Any, *names: str, **keys: Any) -> Verdict:
    return verify(LINKAGE, TASK, Requirements(keep_out=areas, keep_out_for=names, **keys))


def depths(verdict: Verdict) -> dict[str, float]:
    assert {defect.requirement for defect in verdict.defects} <= {"keep_out"}
    return {
        defect.what.split("depth of ")[1].removesuffix(" inside"): defect.found for defect in verdict.defects
    }


@pytest.mark.parametrize("polygon", [STAIRS, SPIRAL])
def test_depth_of_points(polygon: Points) -> None:
    points = np.random.default_rng(1).uniform(-2, 10, (400, 2))
    expected = signed(polygon, points)
    assert expected.min() < 0 < expected.max()
    np.testing.assert_allclose(depth(Area.of([polygon]), points), expected, atol=1e-12)
    np.testing.assert_allclose(depth(Area.of([polygon]), polygon), 0, atol=1e-15)


@pytest.mark.parametrize("polygon", [STAIRS, SPIRAL])
def test_depth_of_segments(polygon: Points) -> None:
    begin, end = np.random.default_rng(2).uniform(-2, 10, (2, 30, 2))
    end[:5] = begin[:5]
    shares = np.linspace(0, 1, 501)[:, None, None]
    expected = signed(polygon, begin + shares * (end - begin)).max(axis=0)
    found = segment_depth(Area.of([polygon]), begin, end)
    assert (found >= expected - 1e-9).all()
    np.testing.assert_allclose(found, expected, atol=0.02)


def test_a_segment_along_a_side_lies_outside() -> None:
    area = Area.of([STAIRS])
    begin, end = np.array([[-3.0, 0], [5, 1], [4, 4]]), np.array([[5.0, 0], [5, 9], [12, 4]])
    np.testing.assert_allclose(segment_depth(area, begin, end), 0, atol=1e-12)
    np.testing.assert_allclose(
        segment_depth(area, begin - [0, 1e-6], end - [0, 1e-6])[[0, 2]], 1e-6, atol=1e-12
    )


@pytest.mark.parametrize("name", ["o2", "o4"])
def test_ground_pivots(name: str) -> None:
    x, y = getattr(LINKAGE, name)
    assert depths(judged([box(x, y)], name)) == {name.upper(): pytest.approx(0.2)}
    other = {"o2": "o4", "o4": "o2"}[name]
    assert judged([box(x, y)], other).ok
    assert judged([box(x + 0.2, y)], name).ok  # on the boundary
    found = judged([box(x + 0.2 - 1e-6, y)], name).defects[0]
    assert found.miss == pytest.approx(1e-6 / TASK.size, rel=1e-3)
    assert str(found).startswith(f"keep_out: the depth of {name.upper()} inside is 1e-06, allowed: 0")


@pytest.mark.parametrize("name", ["a", "b", "p"])
def test_moving_points_between_the_targets(name: str) -> None:
    track = getattr(WAY, name)
    polygon = np.array(box(*track[9000], half=0.05))
    expected = signed(polygon, track[8000:10000]).max()
    assert expected > 0.03
    targets = getattr(STATE, name)
    assert not inside(polygon, targets).any()
    assert depths(judged([polygon], name)) == {name.upper(): pytest.approx(expected, abs=1e-5)}
    assert judged([polygon], *({"a", "b", "p"} - {name})).ok


def test_the_motion_ends_at_the_first_and_the_last_target() -> None:
    for degrees in (17.0, 153.0):
        place = solve_position(LINKAGE, np.radians(degrees)).a
        assert judged([box(*place, half=0.02)], "a").ok
        assert depths(judged([box(*place, half=0.06)], "a"))["A"] > 0


def test_a_corner_clipped_between_two_samples_is_found() -> None:
    """A touches a thin wedge for a thousandth of a degree."""
    out = np.array([np.cos(np.radians(77.77)), np.sin(np.radians(77.77))])
    across = np.array([-out[1], out[0]])
    a = LINKAGE.o2 + 1.1 * out
    for deep in (1e-8, -1e-8):
        tip = a - deep * out
        wedge = [tip, tip + 0.5 * out + 0.5 * across, tip + 0.5 * out - 0.5 * across]
        assert depths(judged([wedge], "a")) == (
            {"A": pytest.approx(deep / np.sqrt(2), rel=1e-2)} if deep > 0 else {}
        )


def test_links_between_the_targets() -> None:
    a, b, p = (getattr(WAY, name)[9000] for name in ("a", "b", "p"))
    ends = {"o2": LINKAGE.o2, "o4": LINKAGE.o4, "a": a, "b": b, "p": p}
    for link, (one, other) in LINES.items():
        inside_it = box(*(0.4 * ends[one] + 0.6 * ends[other]), half=0.01)
        found = depths(judged([inside_it], "links"))
        assert found[link] == pytest.approx(0.01, abs=3e-3)
        assert judged([inside_it], "o2", "o4").ok
    assert judged([box(2.4, -3)], "links").ok


def test_links_against_brute_force() -> None:
    polygon = np.array([[1.0, 0.6], [2.4, 0.2], [2.0, 1.4]])
    expected: dict[str, float] = {}
    state = solve_position(LINKAGE, np.radians(np.linspace(20, 150, 261)))
    places = {"a": state.a, "b": state.b, "p": state.p}
    places |= {name: np.broadcast_to(getattr(LINKAGE, name), state.a.shape) for name in ("o2", "o4")}
    for link, (one, other) in LINES.items():
        shares = np.linspace(0, 1, 61)[:, None, None]
        deep = signed(polygon, places[one] + shares * (places[other] - places[one])).max()
        if deep > 0.01:
            expected[link] = deep
    found = depths(judged([polygon], "links"))
    assert {link for link, deep in found.items() if deep > 0.01} == set(expected)
    assert len(expected) >= 2
    for link, deep in expected.items():
        assert found[link] == pytest.approx(deep, abs=0.02)
        assert found[link] >= deep - 1e-4


def test_where_no_motion_joins_the_targets_they_alone_are_judged() -> None:
    both = [solve_position(LINKAGE, np.radians(60), sign).p for sign in (1, -1)]
    far = [solve_position(LINKAGE, np.radians(60), sign).theta3 + 0.3 for sign in (1, -1)]
    task = MotionTask(np.array(both), np.array(far))
    b = solve_position(LINKAGE, np.radians(60), -1).b
    wanted = {"same_branch": False, "order": False, "keep_out_for": ("b",)}
    verdict = verify(LINKAGE, task, Requirements(keep_out=(np.array(box(*b)),), **wanted))  # type: ignore[arg-type]
    assert [str(defect.what) for defect in verdict.defects] == ["the depth of B inside"]
    assert verify(LINKAGE, task, Requirements(keep_out=(np.array(box(9, 9)),), **wanted)).ok  # type: ignore[arg-type]


def test_a_closed_path_is_judged_over_the_full_turn() -> None:
    rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(2, 1))
    angles = np.radians([0, 60, 120])
    back = solve_position(rocker, np.radians(240))
    for closed in (False, True):
        task = PathTask(solve_position(rocker, angles).p, closed=closed)
        wanted = Requirements(exact=True, keep_out=(np.array(box(*back.a)),), keep_out_for=("a",))
        assert verify(rocker, task, wanted).ok is not closed


def test_areas_that_share_a_side_leave_no_gap() -> None:
    x, y = LINKAGE.o2
    halves = [
        [[x - 1, y - 1], [x, y - 1], [x, y + 1], [x - 1, y + 1]],
        [[x, y - 1], [x + 1, y - 1], [x + 1, y + 1], [x, y + 1]],
    ]
    assert depths(judged(halves, "o2")) == {"O2": pytest.approx(1.0)}
    assert judged(halves[:1], "o2").ok


def test_a_segment_as_short_as_rounding_is_a_point() -> None:
    """The part cut out of it may be an empty line."""
    square = Area.of([np.array([[2.0, 0.0], [3.0, 0.0], [3.0, 1.0], [2.0, 1.0]])])
    begin = 2.0 + np.random.default_rng(0).uniform(0, 1, (400, 2)) - [0, 2]
    end = begin + np.random.default_rng(1).choice([0.0, 4e-16, -4e-16], (400, 2))
    assert segment_depth(square, begin, end) == pytest.approx(depth(square, begin), abs=1e-14)
