"""Every figure of an analysis against independent methods, down to transmission angles of 0.05 deg.

Integrals: Gauss sums over panels that close up towards the ground line and dead positions as far as digits
go, and adaptive quadrature. Extremes: dense search, closest to these, and ever closer about the outermost.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise, product
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import quad
from section_facts import extremes, facts

from grashof.analysis import (
    driver_ranges,
    full_rotation,
    inverse_dynamics,
    solve_kinematics,
    solve_position,
    worst_transmission_cycle,
)
from grashof.problems import DynamicsSpec, FourBar, LinkageSpec, load_linkage_spec
from grashof.problems.values.dynamics.load_specs import LoadSpec
from grashof.study.quantities import Quantity, dynamic_quantities, kinematic_quantities
from grashof.study.study import Asked, LinkageStudy
from grashof.study.sweep import dead_positions_unwarned
from grashof.survey import report_on
from grashof.survey.extremes import extremes_table
from grashof.survey.facts import facts_of

TURN = 2 * np.pi
Floats = npt.NDArray[np.float64]
Curve = Callable[[Floats], Floats]
CLOSER = np.concatenate([sign * 2.0 ** -np.arange(0, 40) for sign in (-1, 1)])
NEAR = np.concatenate([sign * np.logspace(-8, 0, 700) for sign in (-1, 1)])
NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)


def about_ground_line(linkage: FourBar, low: float, high: float, steps: Floats) -> Floats:
    """Driver angles by such steps from the ground line and from both ends, between these."""
    places = np.concatenate([float(linkage.theta1) + np.pi * np.arange(-4, 7), [low, high]])
    near = (places[:, None] + steps).ravel()
    return near[(near > low) & (near < high)]


def integral(linkage: FourBar, curve: Curve, low: float, high: float) -> Floats:
    """Integral of the rows of a curve over the driver angle."""
    inside = np.concatenate([np.linspace(low, high, 33), about_ground_line(linkage, low, high, CLOSER)])
    edges = np.unique(inside)
    half = np.diff(edges)[:, None] / 2
    places = (edges[:-1, None] + half + half * NODES).ravel()
    return curve(places) @ (half * WEIGHTS).ravel()


def dense(linkage: FourBar, low: float, high: float) -> Floats:
    near = about_ground_line(linkage, low, high, NEAR)
    return np.unique(np.concatenate([np.linspace(low, high, 2001), near]))


def outermost(curve: Curve, at: Floats, sign: float) -> float:
    """Largest value of a curve times the sign, by ever closer samples about the highest few."""
    values = np.where(np.isfinite(found := sign * curve(at)), found, -np.inf)
    padded = np.concatenate([[-np.inf], values, [-np.inf]])
    summits = np.flatnonzero((values >= padded[:-2]) & (values >= padded[2:]))
    best = -np.inf
    for top in summits[np.argsort(-values[summits], kind="stable")[:2]]:
        low, high = at[max(top - 1, 0)], at[min(top + 1, len(at) - 1)]
        for _ in range(6):
            near = np.linspace(low, high, 33)
            heights = np.where(np.isfinite(found := sign * curve(near)), found, -np.inf)
            peak = int(np.argmax(heights))
            best = max(best, float(heights[peak]))
            low, high = near[max(peak - 1, 0)], near[min(peak + 1, 32)]
    return best


def random_spec(seed: int) -> LinkageSpec:
    """Of every class in turn, with bars, in m or mm, either sense; every second one near a change point."""
    rng = np.random.default_rng(seed)
    unit = 1000.0 if seed % 5 == 4 else 1.0
    nearly, turns = seed % 2 == 1, seed % 4 != 2
    while True:
        r = rng.uniform(1, 5, 4)
        if nearly:  # r4 from the law of cosines for the transmission angle on the ground line
            mu = np.radians(10 ** rng.uniform(np.log10(0.05), np.log10(2)))
            folded = rng.random() < 0.5
            side, cosine = abs(r[0] - r[1]) if folded else r[0] + r[1], np.cos(mu) * (1 if folded else -1)
            root = r[2] ** 2 * cosine**2 - r[2] ** 2 + side**2
            r[3] = r[2] * cosine + rng.choice([-1, 1]) * np.sqrt(max(root, 0.0))
            if root < 0 or not 0.3 < r[3] < 9:
                continue
        theta1, o2 = rng.uniform(-np.pi, np.pi), rng.uniform(-2, 2, 2)
        o4 = o2 + r[0] * np.array([np.cos(theta1), np.sin(theta1)])
        p, assembly = rng.uniform(-3, 3, 2), int(rng.choice([-1, 1]))
        linkage = FourBar(*(unit * np.asarray(x) for x in (o2, o4, *r[1:], p)), assembly=assembly)
        worst = np.degrees(worst_transmission_cycle(linkage))
        known = np.isfinite(driver_ranges(linkage)).any()
        if known and bool(full_rotation(linkage)) == turns and (not turns or (worst < 2.01) == nearly):
            break
    dynamics = DynamicsSpec(
        2.0 / unit, payload=rng.uniform(0, 3), speed_rpm=rng.choice([-1, 1]) * rng.uniform(5, 90),
        gravity=(0.0, -9.80665) if seed % 3 else tuple(rng.uniform(-10, 10, 2)),
    )  # fmt: skip
    length_unit = "mm" if unit > 1 else "m"
    return LinkageSpec(linkage, f"n{seed}", length_unit=length_unit, dynamics=dynamics, output_arm=2 * unit)


def checked_torque(study: LinkageStudy, found: dict[str, Any]) -> None:
    torque = next(quantity for quantity in dynamic_quantities(study) if quantity.key == "torque")

    def powers(theta2: Floats) -> Floats:
        values = torque.of(study.sweep.state(theta2))
        return np.stack([values, values**2])

    mean, square = integral(study.linkage, powers, 0.0, TURN) / TURN
    assert found["torque_rms"] == pytest.approx(np.sqrt(square), rel=1e-9)
    assert found["torque_mean"] == 0.0  # gravity does no work over a turn
    assert abs(mean) < 1e-9 * np.sqrt(square)


def checked_path(linkage: FourBar, found: dict[str, Any], low: float, high: float) -> None:
    middle = solve_position(linkage, (low + high) / 2).p

    def products(theta2: Floats) -> Floats:
        x, y = (solve_position(linkage, theta2).p - middle).T
        terms = np.polynomial.legendre.legvander((2 * theta2 - low - high) / (high - low), 8).T
        return np.concatenate([terms * x, terms * y, [x * x + y * y]])

    *sums, total = integral(linkage, products, low, high) / (high - low)
    power = (np.reshape(sums, (2, 9)) ** 2).sum(axis=0) * (2 * np.arange(9) + 1)
    for degree in (4, 8):
        expected = 1 - (total - power[: degree + 1].sum()) / (total - power[0])
        assert found[f"coupler_fit_r2_degree_{degree}"] == pytest.approx(expected, abs=1e-11)
    if "fourier_share_1" in found:
        checked_harmonics(linkage, found)


def checked_harmonics(linkage: FourBar, found: dict[str, Any]) -> None:
    harmonics = np.arange(-5, 6)

    def waves(theta2: Floats) -> npt.NDArray[np.complex128]:
        z = (solve_position(linkage, theta2).p - linkage.o2) @ np.array([1, 1j])
        return np.concatenate([z * np.exp(-1j * np.outer(harmonics, theta2)), [np.abs(z) ** 2]])

    *parts, total = (integral(linkage, lambda at: waves(at).real, 0.0, TURN)
                     + 1j * integral(linkage, lambda at: waves(at).imag, 0.0, TURN)) / TURN  # fmt: skip
    power = np.abs(parts) ** 2
    for number in range(1, 6):
        share = (power[5 + number] + power[5 - number]) / (total.real - power[5])
        assert found[f"fourier_share_{number}"] == pytest.approx(share, rel=1e-8, abs=1e-20)

    def miss(theta2: Floats) -> Floats:
        z = (solve_position(linkage, theta2).p - linkage.o2) @ np.array([1, 1j])
        return np.abs(z - np.exp(1j * np.outer(theta2, harmonics)) @ parts)

    furthest = outermost(miss, dense(linkage, 0.0, TURN), 1.0)
    assert found["fourier_error_5"] == pytest.approx(furthest, rel=1e-9)


def line_through(linkage: FourBar, theta2: Floats) -> tuple[float, float, float]:
    """Width, length and greatest distance of the line through a fine polygon, by the length of its sides."""
    p = solve_position(linkage, theta2).p @ np.array([1, 1j])
    side, middle = np.abs(np.diff(p)), (p[1:] + p[:-1]) / 2
    centre = (side * middle).sum() / side.sum()
    turned = (p - centre) * np.exp(-0.5j * np.angle((side * (middle - centre) ** 2).sum()))
    return float(np.ptp(turned.imag)), float(np.ptp(turned.real)), float(np.abs(turned.imag).max())


def checked_straight(linkage: FourBar, found: dict[str, Any], turns: bool) -> None:
    start, end = (np.radians(found[f"straight_{name}_deg"]) for name in ("from", "to"))
    values = tuple(found[f"straight_{name}"] for name in ("width", "length", "deviation"))
    # The links move with the root of the driver angle near dead positions: even steps of its arc.
    share = np.linspace(0, 1, 40_001) if turns else (1 - np.cos(np.linspace(0, np.pi, 200_001))) / 2
    inside = np.concatenate([start + (end - start) * share, about_ground_line(linkage, start, end, NEAR)])
    assert values == pytest.approx(line_through(linkage, np.unique(inside)), rel=3e-6, abs=1e-8 * values[1])
    if turns:
        assert end - start == pytest.approx(np.pi, abs=1e-14)
        every = dense(linkage, 0.0, 2 * TURN)
        for begin in np.radians(np.arange(0, 360, 6.0)):
            part = every[(every > begin) & (every < begin + np.pi)]
            width, length, _ = line_through(linkage, np.concatenate([[begin], part, [begin + np.pi]]))
            assert width / length > values[0] / values[1] * (1 - 1e-3)


def checked_extremes(study: LinkageStudy, table: Any, quantities: list[Quantity]) -> None:
    known = {quantity.key: quantity for quantity in quantities}
    for number, (low, high) in enumerate(study.sweep.ranges, start=1):
        at = dense(study.linkage, low, high)
        rows = table[table["range"] == number] if "range" in table else table
        for row in rows.to_dict("records"):
            checked_row(study, known[row["quantity"]], row, at)


def checked_row(study: LinkageStudy, quantity: Quantity, row: dict[str, Any], at: Floats) -> None:
    sampled = quantity.of(study.sweep.state(at))
    if quantity.period is not None:
        sampled = np.unwrap(sampled, period=quantity.period)
        if study.sweep.turns and abs(sampled[-1] - sampled[0]) > 180:
            assert np.isnan([row[name] for name in ("min", "max", "theta2_min_deg", "theta2_max_deg")]).all()
            assert row["what"].endswith("turns fully")
            return

    def curve(theta2: Floats) -> Floats:
        values = quantity.of(study.sweep.state(theta2))
        if quantity.period is None:
            return values
        return values - quantity.period * np.round(
            (values - np.interp(theta2, at, sampled)) / quantity.period
        )

    size = np.nanmax(np.abs(sampled[np.isfinite(sampled)]))
    for name, sign in (("min", -1.0), ("max", 1.0)):
        if np.isinf(row[name]):
            near_end = np.abs(np.degrees(at[[0, -1]]) - row[f"theta2_{name}_deg"]).min()
            assert near_end < 1e-6
            assert not study.sweep.turns
            continue
        expected = sign * outermost(curve, at, sign)
        if np.isfinite(stated := row[f"theta2_{name}_deg"]):  # a value there is met as well
            place = np.clip(np.radians(stated) + np.linspace(-1e-9, 1e-9, 65), at[0], at[-1])
            expected = sign * max(sign * expected, outermost(curve, place, sign))
        turns = 0.0 if quantity.period is None else 360 * np.round((row[name] - expected) / 360)
        # The search ends short of dead positions; near them not all digits hold, and those that do are shown.
        within = 1e-7 if quantity.key == "mu_deg" or float(f"{row[name]:.8g}") == row[name] else 2e-9
        assert row[name] - turns == pytest.approx(expected, rel=within, abs=1e-9 * size), (quantity.key, name)


def check(spec: LinkageSpec) -> None:
    study = LinkageStudy.of(spec, Asked())
    linkage, sweep = study.linkage, study.sweep
    with dead_positions_unwarned():
        quantities = kinematic_quantities(spec) + dynamic_quantities(study)
        table = extremes_table(sweep, quantities)
        found = {fact.key: fact.value for fact in facts_of(study, {"extremes": table})}
        checked_extremes(study, table, quantities)
        if sweep.turns:
            checked_torque(study, found)
        checked_path(linkage, found, *sweep.ranges[0])
        checked_straight(linkage, found, sweep.turns)
        corners = [linkage.o2, linkage.o4]
        for (low, high), point, axis, sign in product(sweep.ranges, "abp", (0, 1), (-1.0, 1.0)):

            def place(theta2: Floats, point: str = point, axis: int = axis) -> Floats:
                return getattr(solve_position(linkage, theta2), point)[:, axis]

            corner = np.full(2, np.nan)
            corner[axis] = sign * outermost(place, dense(linkage, low, high), sign)
            corners.append(corner)
    extent = np.nanmax(corners, 0) - np.nanmin(corners, 0)
    assert found["size"] == pytest.approx(np.hypot(*extent), rel=1e-9)
    for number in range(1, found["double_points"] + 1):
        angles = np.radians([found[f"double_point_{number}_theta2_{passage}_deg"] for passage in (1, 2)])
        place = [found[f"double_point_{number}_{axis}"] for axis in "xy"]
        met = solve_position(linkage, angles).p
        np.testing.assert_allclose(met, [place, place], atol=1e-10 * found["size"])


@pytest.mark.study
@pytest.mark.parametrize("tens", range(20))
def test_every_figure_of_two_hundred_linkages(tens: int) -> None:
    for seed in range(10 * tens, 10 * tens + 10):
        check(random_spec(seed))


@pytest.mark.slow
@pytest.mark.quick("2")
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_every_figure_of_a_few(seed: int) -> None:
    check(random_spec(seed))


@pytest.mark.slow
def test_torque_near_a_change_point_by_adaptive_quadrature() -> None:
    linkage = FourBar((0, 0), (4, 0), 2, 4.5, 2.501, coupler_point=(2, 1))
    dynamics = DynamicsSpec(2.0, speed_rpm=60, gravity=(0, -9.80665))
    spec = LinkageSpec(linkage, "nearly dead", length_unit="m", dynamics=dynamics)
    found = facts(report_on(spec))
    assert found["torque_rms"] == pytest.approx(6919.2, abs=0.05)
    assert found["torque_mean"] == 0.0
    study = LinkageStudy.of(spec, Asked())

    def square(theta2: float) -> float:
        state = solve_kinematics(spec.linkage, theta2, TURN)
        return float(inverse_dynamics(state, study.masses, study.loads).torque) ** 2

    ends = [0.0, 1e-3, 1e-2, 0.1, np.pi, TURN - 0.1, TURN - 1e-2, TURN - 1e-3, TURN]
    parts = [quad(square, *pair, epsrel=1e-11, limit=200)[0] for pair in pairwise(ends)]
    assert found["torque_rms"] == pytest.approx(np.sqrt(sum(parts) / TURN), rel=1e-9)


@pytest.mark.slow
def test_torque_under_a_tabled_load() -> None:
    """Curves through the rows meet there with different second derivatives: panels from row to row."""
    rows = [(0.0, 50.0), (13.7, -200.0), (101.3, -180.0), (211.9, 400.0), (214.0, -40.0), (360.0, 50.0)]
    dynamics = DynamicsSpec(
        2.0, speed_rpm=60, gravity=(0, -9.80665), loads=(LoadSpec(4, values=tuple(rows), over="theta2"),)
    )
    spec = LinkageSpec(FourBar((0, 0), (4, 0), 1, 4, 3), "loaded", length_unit="m", dynamics=dynamics)
    study, found = LinkageStudy.of(spec, Asked()), facts(report_on(spec))
    node, weight = np.polynomial.legendre.leggauss(60)
    edges = np.radians([row[0] for row in rows])
    half = np.diff(edges)[:, None] / 2
    theta2 = (edges[:-1, None] + half * (1 + node)).ravel()
    torque = inverse_dynamics(solve_kinematics(spec.linkage, theta2, TURN), study.masses, study.loads).torque
    weight = (half * weight).ravel() / TURN
    assert found["torque_mean"] == pytest.approx(weight @ torque, rel=1e-9)
    assert found["torque_rms"] == pytest.approx(np.sqrt(weight @ torque**2), rel=1e-9)
    assert abs(found["torque_mean"]) > 1.0


@pytest.mark.quick("linkage0-ends0", "linkage3-ends3")
@pytest.mark.parametrize(
    ("linkage", "ends"),
    [
        (FourBar((0, 0), (4, 0), 2, 2, 3), [(None, 180.0)]),
        (FourBar((0, 0), (4, 0), 2, 4.5, 2.499), [(0.0, None)]),
        (FourBar((0, 0), (4, 0), 3, 1, 3), [(0.0, 180.0), (0.0, 180.0)]),
        (FourBar((0, 0), (4, 0), 1, 3, 2), [(None, 180.0)]),
    ],
)
def test_mu_at_dead_positions_is_exact(
    linkage: FourBar, ends: list[tuple[float | None, float | None]]
) -> None:
    report = report_on(LinkageSpec(linkage, "swings"))
    found = report.tables["extremes"].query("quantity == 'mu_deg'")
    rows = report.tables["kinematics"]
    for index, (low, high) in enumerate(ends):
        assert low is None or found["min"].iloc[index] == low
        assert high is None or found["max"].iloc[index] == high
        part = rows[rows["range"] == index + 1] if "range" in rows else rows
        assert {part["mu_deg"].iloc[0], part["mu_deg"].iloc[-1]} <= {low, high}
    assert facts(report)["transmission_min_deg"] == 0.0


def test_dead_positions_are_met_to_rounding() -> None:
    """Links 3 and 4 in one line, and not 1e-8 beside it."""
    rocker = FourBar((0.3, 0.1), (4, 1), 2.2, 2.1, 3.3, (1, 1))
    report = report_on(LinkageSpec(rocker, "swings"))
    ends = report.tables["kinematics"].iloc[[0, -1]]
    assert np.abs(np.sin(np.radians(ends["theta4_deg"] - ends["theta3_deg"]))).max() < 1e-14
    swing = extremes(report).loc["theta4_deg"]
    for name in ("min", "max"):
        if swing[f"theta2_{name}_deg"] in np.round(ends["theta2_deg"], 9).to_numpy():
            assert np.abs(ends["theta4_deg"] - swing[name]).min() < 1e-12


@pytest.mark.study
def test_at_a_change_point_rates_are_those_that_the_motion_tends_to() -> None:
    """An antiparallelogram passes theta2 = 0 at omega4 = -(r1 + r2) / (r1 - r2) omega2, its torque finite."""
    linkage = FourBar((0, 0), (4, 0), 2, 4, 2, (1, 1), assembly=-1)
    dynamics = DynamicsSpec(2.0, speed_rpm=30, gravity=(0, -9.8))
    report = report_on(LinkageSpec(linkage, "crossed", length_unit="m", dynamics=dynamics))
    table = report.tables["extremes"]
    plain, crossed = (table[table["range"] == number].set_index("quantity") for number in (1, 2))
    assert crossed.loc["omega4", ["min", "max"]].tolist() == pytest.approx([-3 * np.pi, -np.pi / 3], rel=1e-9)
    assert plain.loc["omega4", ["min", "max"]].tolist() == pytest.approx([np.pi, np.pi], rel=1e-9)
    assert plain.loc["alpha3", ["min", "max"]].tolist() == [0, 0]
    assert crossed.loc["torque", "min"] < -600
    # Bars in one line bear any force along them.
    assert crossed.loc["f12", "max"] == np.inf


@pytest.mark.quick("swings")
@pytest.mark.parametrize(
    "linkage",
    [FourBar((0, 0), (2.4, 3.2), 2, 4.5, 2.50001, (2, 1)), FourBar((0, 0), (4, 0), 2, 3.2, 1.20001, (2, 1))],
    ids=["turns", "swings"],
)
def test_curves_are_drawn_through_narrow_peaks(linkage: FourBar) -> None:
    report = report_on(LinkageSpec(linkage, "near", length_unit="m"))
    drawn, table = report.drawn["kinematics"], report.tables["kinematics"]
    assert len(table) == 361
    assert len(drawn) > 700
    peak = extremes(report).loc["alpha4", ["min", "max"]].abs().max()
    if report.sweep.turns:  # elsewhere it has no limit
        assert 0.98 * peak < drawn["alpha4"].abs().max() < peak * (1 + 1e-9)
        assert table["alpha4"].abs().max() < 0.5 * peak
    middle = drawn["theta2_deg"].between(-90, 90) if not report.sweep.turns else slice(None)
    assert np.hypot(drawn["b_x"].diff(), drawn["b_y"].diff())[middle].max() < 0.1
    plain = report_on(load_linkage_spec("pumpjack"))
    assert plain.drawn["kinematics"] is plain.tables["kinematics"]
