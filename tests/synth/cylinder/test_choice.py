"""The best cylinder of every kind: closed forms, limits in all combinations, an independent search."""

from typing import NamedTuple

import numpy as np
import pytest
from scipy.optimize import differential_evolution

from grashof.analysis import driver_ranges
from grashof.analysis.cylinder.lengths import CylinderFigures, cylinder_figures
from grashof.analysis.cylinder.travel import Travel, travel
from grashof.problems import Box, Cylinder, CylinderSpec, FourBar, InvertedSliderCrank, Linkage, SliderCrank
from grashof.problems.values.arrays import ComplexArray, FloatArray, Limits
from grashof.synth.cylinder.choice import best_cylinder
from grashof.synth.cylinder.planes import planes_of

LINKS = ("driver", "coupler", "output")
KINDS = (FourBar, SliderCrank, InvertedSliderCrank)
BARS = FourBar((0, 0), (3, 0), 1.6, 2.2, 2.4, (1, 0.5))
ENGINE = SliderCrank((0.3, -0.2), 1, 3, 0.4, 0.7, (1.5, 0.6))
SHAPER = InvertedSliderCrank((0.3, -0.2), (3, 0.5), 1.1, 0.3, (2.5, 0.6))
# A linkage, between which driver angles in deg it moves, and the greatest ratio that is asked of it.
MOVED = [(BARS, (55, 110), 1.3), (ENGINE, (95, 145), 1.5), (SHAPER, (95, 145), 1.5)]


# Which of three limits are active.
COMBINED = [(True, True, True), (False, False, False), (True, False, False)]


def at_random(rng: np.random.Generator, kind: type[Linkage]) -> Linkage:
    if kind is FourBar:
        r1, r2, r3, r4 = rng.uniform(0.3, 3, 4)
        return FourBar((0, 0), (r1, 0), r2, r3, r4, rng.uniform(-1, 1, 2) * r3, rng.choice([-1, 1]))
    r1, r2, r3 = rng.uniform(0.3, 3, 3)
    offset, p, sign = rng.uniform(-0.7, 0.7), rng.uniform(-1, 1, 2) * r3, rng.choice([-1, 1])
    if kind is SliderCrank:
        return SliderCrank((0, 0), r2, r3, offset, rng.uniform(-3, 3), p, sign)
    return InvertedSliderCrank((0, 0), (r1, 0.3), r2, offset, p, sign)


def drawn(rng: np.random.Generator, kind: type[Linkage]) -> Travel:
    """A linkage whose driver covers 30 to 140 deg between its dead positions, in either sense."""
    while True:
        linkage = at_random(rng, kind)
        (low, high), wide = driver_ranges(linkage)[0], np.radians(rng.uniform(30, 140))
        if not high - low > 1.05 * wide:
            continue
        start = rng.uniform(low + 0.02 * wide, high - 1.02 * wide)
        ends = np.array([start, start + wide])[:: rng.choice([-1, 1])]
        found = travel(linkage, ends, np.array([int(linkage.assembly)] * 2))
        if found is not None:
            return found


def moved(linkage: Linkage, *theta2_deg: float) -> Travel:
    found = travel(linkage, np.radians(theta2_deg), np.ones(len(theta2_deg), dtype=int))
    assert found is not None
    return found


def chosen(
    way: Travel, spec: CylinderSpec, rate: Limits = (0.0, np.inf)
) -> tuple[Cylinder, CylinderFigures] | None:
    share = (1 - np.cos(np.linspace(0, np.pi, 129))) / 2
    at = way.at(way.start + (way.end - way.start) * share)
    found = best_cylinder(way.linkage, (at.theta2, at.theta3, at.theta4), spec, rate=rate)
    return None if found is None else (found, cylinder_figures(found, way))


def angle_of(way: Travel, spec: CylinderSpec) -> float:
    """The worst lever angle of the best cylinder, deg; 0 where there is none."""
    found = chosen(way, spec)
    return 0.0 if found is None else float(np.degrees(found[1].angle_min))


@pytest.mark.parametrize("kind", KINDS)
def test_on_link_2_the_worst_angle_is_90_deg_less_half_the_range(kind: type[Linkage]) -> None:
    rng = np.random.default_rng(3)
    for _ in range(8):
        way = drawn(rng, kind)
        found = chosen(way, CylinderSpec(on=["driver"]))
        assert found is not None
        assert found[1].monotone
        theta2 = way.at([way.start, way.end]).theta2
        expected = 90 - np.degrees(abs(theta2[1] - theta2[0])) / 2
        assert np.degrees(found[1].angle_min) == pytest.approx(expected, abs=1e-5)
        assert found[1].ratio <= 1.6


@pytest.mark.study
def test_some_link_has_a_cylinder_of_30_deg_or_more() -> None:
    rng = np.random.default_rng(2)
    angles = [angle_of(drawn(rng, FourBar), CylinderSpec()) for _ in range(60)]
    assert sum(angle >= 30 for angle in angles) >= 59
    assert np.median(angles) > 75


def test_on_a_slider_it_is_in_line_with_the_slide_wherever_that_moves_one_way() -> None:
    rng = np.random.default_rng(4)
    driven = 0
    for _ in range(20):
        way = drawn(rng, SliderCrank)
        angle = float(way.linkage.slide_angle)  # type: ignore[attr-defined]
        along = np.array([np.cos(angle), np.sin(angle)])
        step = np.diff(way.at(way.places).b @ along)
        found = chosen(way, CylinderSpec(on=["output"]))
        if not ((step > 0).all() or (step < 0).all()):
            assert found is None
            continue
        assert found is not None
        driven += 1
        assert np.degrees(found[1].angle_min) == pytest.approx(90, abs=1e-5)
        assert found[1].stroke == pytest.approx(abs(step.sum()), rel=1e-9)
        assert found[0].point == (0, 0)  # nothing keeps it from B
    assert driven > 4
    found = chosen(moved(ENGINE, 60, 150), CylinderSpec())  # of all links the slider is driven at 90 deg
    assert found is not None
    assert found[0].on == "output"


def test_a_base_beside_the_slide_has_its_pivot_as_far_beside_b() -> None:
    way = moved(SliderCrank((0, 0), 1, 3), 20, 140)
    beside = chosen(way, CylinderSpec(on=["output"], base=Box((-4, 8), (0.5, 0.5))))
    assert beside is not None
    assert beside[0].point == pytest.approx((0, 0.5), abs=1e-8)
    assert np.degrees(beside[1].angle_min) == pytest.approx(90, abs=1e-5)
    beyond = chosen(way, CylinderSpec(on=["output"], base=Box((-9, 12), (1.5, 1.5))))  # beyond its reach
    assert beyond is not None
    assert beyond[0].point[1] == pytest.approx(1, abs=0.02)
    assert 60 < np.degrees(beyond[1].angle_min) < 89


@pytest.mark.parametrize("case", MOVED)
@pytest.mark.parametrize("on", LINKS)
def test_limits_are_kept_in_all_combinations(
    case: tuple[Linkage, tuple[float, float], float], on: str
) -> None:
    linkage, ends, ratio_max = case
    limited = {"closed": (1.5, 2.5), "ratio_max": ratio_max, "base": Box((-3.0, 0.5), (-2.0, -0.2))}
    for active in COMBINED if (on, linkage) == ("coupler", BARS) else COMBINED[:1]:
        limits = {key: value for (key, value), given in zip(limited.items(), active, strict=True) if given}
        spec = CylinderSpec(on=[on], **limits)  # type: ignore[arg-type]
        found = chosen(moved(linkage, *ends), spec)
        assert found is not None, limits
        cylinder, figures = found
        assert figures.monotone, limits
        assert figures.ratio <= spec.ratio_max
        low, high = spec.closed or (0.0, np.inf)
        assert low <= figures.closed <= high
        box = spec.base or Box()
        assert box.x[0] <= cylinder.base[0] <= box.x[1]
        assert box.y[0] <= cylinder.base[1] <= box.y[1]


def test_there_is_none_whose_base_is_beyond_its_length() -> None:
    far = CylinderSpec(closed=(0.1, 0.2), base=Box((50, 51), (50, 51)), on=["output"])
    assert chosen(moved(ENGINE, 95, 145), far) is None


@pytest.mark.parametrize("linkage", [ENGINE, SHAPER])
@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_it_is_the_same_in_every_unit(linkage: Linkage, scale: float) -> None:
    for on in ("driver", "output"):
        spec = CylinderSpec(on=[on])
        one = chosen(moved(linkage, 95, 145), spec)
        other = chosen(moved(linkage.scaled(scale, np.zeros(2)), 95, 145), spec)
        assert one is not None
        assert other is not None
        assert other[1].angle_min == pytest.approx(one[1].angle_min, abs=1e-7)


class Carried(NamedTuple):
    """Where the pivot on a link may be in its frame, and how the link moves."""

    middle: complex
    reach: float
    origin: ComplexArray
    axis: ComplexArray


def carried(way: Travel, on: str) -> Carried:
    """Of a four-bar by its own angles."""
    linkage, at = way.linkage, way.at(np.linspace(way.start, way.end, 81))
    if not isinstance(linkage, FourBar):
        plane = planes_of(linkage, *map(np.unwrap, (at.theta2, at.theta3, at.theta4)), None)[on]
        return Carried(complex(plane.middle), plane.reach, plane.origin, plane.axis)
    p, r3 = complex(*linkage.coupler_point), float(linkage.r3)
    if on == "coupler":
        return Carried(r3 / 2, max(r3, abs(p), abs(p - r3)), at.a @ [1, 1j], np.exp(1j * at.theta3))
    pivot, length, angle = {
        "driver": (linkage.o2, linkage.r2, at.theta2), "output": (linkage.o4, linkage.r4, at.theta4)
    }[on]  # fmt: skip
    return Carried(0j, float(length), np.full(81, complex(*pivot)), np.exp(1j * angle))


def searched(way: Travel, spec: CylinderSpec, on: str, seed: int) -> float:
    """The worst lever angle of what differential evolution finds by differences of places, judged, deg."""
    assert spec.base is not None
    link = carried(way, on)
    low, high = spec.closed or (0.0, np.inf)

    def pivot(x: FloatArray) -> complex:
        return complex(link.middle + x[0] * np.exp(1j * x[1]))

    def cost(x: FloatArray) -> float:
        places = link.origin + pivot(x) * link.axis
        out, way_of = places - complex(x[2], x[3]), np.gradient(places)
        lever = (np.real(np.conj(out) * way_of) / np.abs(out) / np.maximum(np.abs(way_of), 1e-12))[1:-1]
        least, closed = max(lever.min(), (-lever).min()), np.abs(out).min()
        over = max(np.abs(out).max() / max(closed, 1e-9) - spec.ratio_max, 0)
        return float(-least + 100 * (over + max(low - closed, 0) + max(closed - high, 0)))

    bounds = [(0, link.reach), (-np.pi, np.pi), spec.base.x, spec.base.y]
    best = differential_evolution(cost, bounds, seed=seed, popsize=24, maxiter=260, tol=1e-10, polish=False)
    if best.fun >= 0:
        return 0.0
    q, base = pivot(best.x), (float(best.x[2]), float(best.x[3]))
    return float(np.degrees(cylinder_figures(Cylinder(on, base, (q.real, q.imag)), way).angle_min))


@pytest.mark.study
@pytest.mark.parametrize(
    ("kind", "seed"),
    [(kind, seed) for kind in KINDS for seed in range(6 if kind is FourBar else 12)],
)
def test_an_independent_search_of_great_effort_finds_no_better_one(kind: type[Linkage], seed: int) -> None:
    way = drawn(np.random.default_rng(100 + seed), kind)
    for links in [LINKS] if kind is FourBar else [(on,) for on in LINKS]:
        spec = CylinderSpec(closed=(1.0, 4.0), ratio_max=1.5, base=Box((-4, 5), (-4, 0)), on=[*links])
        assert angle_of(way, spec) > max(searched(way, spec, on, seed) for on in links) - 0.1


RATED = [(BARS, (55, 110)), (SHAPER, (95, 145))]


@pytest.mark.quick("driver-case1", "coupler-case0")
@pytest.mark.parametrize("case", RATED)
@pytest.mark.parametrize("on", LINKS)
def test_limits_of_the_rate_are_kept_at_the_cost_of_the_lever_angle(
    case: tuple[Linkage, tuple[float, float]], on: str
) -> None:
    linkage, ends = case
    way, spec = moved(linkage, *ends), CylinderSpec(on=[on])
    free = chosen(way, spec)
    assert free is not None
    least, most = free[1].rate_min, free[1].rate_max
    wide = chosen(way, spec, (least / 2, 2 * most))
    assert wide is not None
    assert wide[1].angle_min >= free[1].angle_min - 1e-6
    for limits in ((0.0, 0.9 * most), (1.05 * least, 1e9)):
        held = chosen(way, spec, limits)
        if held is None:  # the longest arm has no more
            assert limits[0] > 0
            continue
        assert limits[0] <= held[1].rate_min
        assert held[1].rate_max <= limits[1]
        assert held[1].monotone
        assert held[1].angle_min <= free[1].angle_min + 1e-6
    if on == "driver":
        assert chosen(way, spec, (1e5, 1e9)) is None
