"""Problems from practice have verified designs, whose key figures hold by formulas of their own."""

from functools import cache

import numpy as np
import pytest
import shapely

from grashof import load, synthesize
from grashof.synth import Candidate, Result

QUICK = ["toggle-clamp"]
SLOW = [
    "bus-wiper", "container-lid", "drag-brace", "folding-table", "garage-door-track", "greenhouse-door",
    "jewellery-box-lid", "outboard-flap", "robot-intake", "steering", "tool-chest-lid", "trunk-lid",
    "twelve-timed", "wall-bed-shelf",
]  # fmt: skip


@cache
def solved(name: str) -> Result:
    return synthesize(load(name), seed=0, enough=4)


def poses(design: Candidate, samples: int = 0) -> np.ndarray:
    """O2, A, B, O4 at the targets, or samples of the motion, by the law of cosines, complex, shape (4, N)."""
    linkage, theta2 = design.linkage, design.verdict.theta2
    sign = np.asarray(design.verdict.assembly)
    if samples:
        theta2, sign = np.linspace(theta2[0], theta2[-1], samples), sign[0]
    o2, o4 = complex(*linkage.o2), complex(*linkage.o4)
    a = o2 + linkage.r2 * np.exp(1j * theta2)
    s = np.abs(o4 - a)
    at_a = np.arccos((s**2 + linkage.r3**2 - linkage.r4**2) / (2 * s * linkage.r3))
    b = a + linkage.r3 * (o4 - a) / s * np.exp(1j * sign * at_a)
    return np.stack([np.full_like(a, o2), a, b, np.full_like(a, o4)])


@pytest.mark.parametrize("name", [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in SLOW)])
def test_there_are_verified_designs(name: str) -> None:
    result = solved(name)
    assert len(result) > 0
    assert all(each.verdict.ok for each in result.candidates)


@pytest.mark.parametrize(
    "name",
    [
        "toggle-clamp",
        *(pytest.param(name, marks=pytest.mark.slow) for name in ("drag-brace", "folding-table")),
    ],
)
def test_locks_are_2_to_5_deg_past_their_line(name: str) -> None:
    for each in solved(name).candidates:
        o2, a, b, _ = poses(each)
        bend = np.degrees(np.angle((b - a)[-1] / (a - o2)[-1]))
        past = min(abs(bend), 180 - abs(bend))
        assert 2 - 1e-6 <= past <= 5 + 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("name", ["drag-brace", "folding-table"])
def test_the_brace_joins_the_leg_near_p(name: str) -> None:
    design = solved(name).best
    u, v = design.linkage.coupler_point
    assert np.hypot(u - design.linkage.r3, v) < 10  # mm, of 900 and 350


@pytest.mark.slow
def test_the_bus_wiper_swings_as_far_both_ways_alike() -> None:
    for each in solved("bus-wiper").candidates:
        r1, r2, r3, r4 = each.linkage.lengths
        far, near = (
            np.arccos((r1**2 + r4**2 - reach**2) / (2 * r1 * r4)) for reach in (r3 + r2, abs(r3 - r2))
        )
        assert np.degrees(far - near) == pytest.approx(84, abs=1e-6)
        assert r1**2 + r2**2 == pytest.approx(r3**2 + r4**2, rel=1e-8)  # time ratio 1


@pytest.mark.slow
def test_the_garage_door_hangs_on_its_track() -> None:
    for each in solved("garage-door-track").candidates:
        one = each.linkage
        a = complex(*one.o2) + one.r2 * np.exp(1j * each.verdict.theta2)
        arm = complex(*one.coupler_point)
        rod = (load("garage-door-track").task.positions @ [1, 1j] - a) / arm
        b = a + one.r3 * rod / np.abs(rod) * 1.0
        assert np.ptp(b.imag) < 1e-6
        assert 2 - 1e-9 <= b.imag[0] <= 2.2 + 1e-9
        assert (np.diff(b.real) < 0).all()


@pytest.mark.slow
def test_the_steering_is_a_symmetric_trapezium_that_keeps_to_the_law_of_ackermann() -> None:
    for each in solved("steering").candidates:
        linkage = each.linkage
        assert linkage.r2 == pytest.approx(linkage.r4, abs=1e-6)
        out = np.cos(each.verdict.theta2[1]) * linkage.r2  # of A from the king pin, straight ahead
        assert linkage.r3 == pytest.approx(1250 - 2 * out, abs=1e-3)
        o2, a, b, o4 = poses(each)
        left, right = (np.degrees(np.unwrap(np.angle(arm))) for arm in (a - o2, b - o4))
        to_left = left[0] - left[1], right[0] - right[1]  # inner and outer wheel
        to_right = right[1] - right[2], left[1] - left[2]
        for turned in (to_left, to_right):
            inner, outer = 1 / np.tan(np.radians(turned))
            assert outer - inner == pytest.approx(0.5, abs=1e-4)


@pytest.mark.slow
def test_the_shelf_of_the_wall_bed_stays_level_by_equal_arms() -> None:
    for each in solved("wall-bed-shelf").candidates:
        one = each.linkage
        assert one.r2 == pytest.approx(one.r4, rel=1e-9)
        assert one.r1 == pytest.approx(one.r3, rel=1e-9)
        _, a, b, _ = poses(each)
        assert np.ptp(np.angle(b - a)) < 1e-9


@pytest.mark.slow
def test_all_pivots_of_the_flap_are_within_the_profile() -> None:
    problem = load("outboard-flap")
    wing, flap = (shapely.Polygon(getattr(problem.requirements, key).corners) for key in ("o2", "a_on_body"))
    for each in solved("outboard-flap").candidates:
        o2, a, b, o4 = poses(each)
        at = problem.task.positions @ [1, 1j]
        on_flap = (np.array([a, b]) - at) * np.exp(-1j * problem.task.angles)
        assert np.ptp(on_flap, axis=1).max() < 1e-6
        for area, place in ((wing, o2[0]), (wing, o4[0]), (flap, on_flap[0, 0]), (flap, on_flap[1, 0])):
            assert shapely.distance(area, shapely.Point(place.real, place.imag)) < 1e-6


@pytest.mark.slow
def test_the_lid_of_the_tool_chest_clears_the_handle_on_links_that_cross() -> None:
    problem = load("tool-chest-lid")
    (kept_out,), lid = problem.requirements.keep_out, problem.task.body @ [1, 1j]
    area, crossing = shapely.Polygon(kept_out).buffer(-1e-6), []
    for each in solved("tool-chest-lid").candidates:
        one = each.linkage
        _, a, b, o4 = poses(each, 500)
        links = [(one.o2 @ [1, 1j], a), (o4[0], b)]
        crossing.append(any(crossed(links, k) for k in range(500)))
        turned = (b - a) / np.abs(b - a)
        p = a + turned * complex(*one.coupler_point)
        for corner in (p[:, None] + lid * (turned * np.exp(1j * one.body_angle))[:, None]).tolist():
            assert not shapely.Polygon([(z.real, z.imag) for z in corner]).intersects(area)
    assert any(crossing)


def crossed(links: list[tuple[complex, np.ndarray]], k: int) -> bool:
    """Whether two links cross at sample k."""
    one, other = (shapely.LineString([(o.real, o.imag), (e[k].real, e[k].imag)]) for o, e in links)
    return bool(shapely.crosses(one, other))
