"""Strokes under limits at single limit positions: kept, and the best there are."""

from typing import Any

import numpy as np
import pytest
from stroke_results import found, worst

from grashof.analysis import verify
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.values.arrays import FloatArray
from grashof.synth import synthesize


def turned(pivot: complex, a: complex, b: complex) -> float:
    """The direction of AB as seen along the ground line O2O4, O2 the origin; deg."""
    return float(np.degrees(np.angle((b - a) / pivot)))


def rockers(swing: float, ratio: float) -> list[tuple[complex, FloatArray, FloatArray, float]]:
    """Crank-rockers, O2 the origin: O4, A and B as the slow stroke begins and ends, and mu, deg.

    The rod is 1, in a dense grid; A and B are drawn in both limit positions, O4 is the tip of the triangle.
    """
    found, lag = list[tuple[complex, FloatArray, FloatArray, float]](), np.pi * (ratio - 1) / (ratio + 1)
    for sign, side in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        for r2 in np.linspace(0.002, 0.998, 4000).tolist():
            ahead = np.exp([0, 1j * sign * lag])
            a, b = ahead * [r2, -r2], ahead * [1 + r2, 1 - r2]
            o4 = complex(b.mean() + 0.5j * side * (b[1] - b[0]) / np.tan(np.radians(swing) / 2))
            r1, r4 = abs(o4), abs(b[0] - o4)
            least = 1e-3 * (1 + r1 + r2 + r4)  # of full rotation
            sides = ((b - a).conj() * (b - o4)).imag
            if min(1 + r4 - r1 - r2, r1 - r2 - abs(1 - r4)) < least or sides.prod() <= 0:
                continue
            cosine = max(abs(1 + r4**2 - (r1 + way * r2) ** 2) / (2 * r4) for way in (-1, 1))
            found.append((o4, a[::sign], b[::sign], float(np.degrees(np.arccos(cosine)))))
    return found


@pytest.mark.slow
@pytest.mark.quick("1-distance")
@pytest.mark.parametrize("name", ["distance", "coupler", "box"])
@pytest.mark.parametrize("target", [1, 2])
def test_no_crank_rocker_keeps_a_limit_at_a_limit_position_and_does_better(target: int, name: str) -> None:
    """Both pivots are fixed, so that nothing but the proportions is left, which a grid has all."""
    every = rockers(70, 1.12)
    k, best = target - 1, max(mu for *_, mu in every)
    apart = [abs(a[k] - o4) / abs(o4) for o4, a, _, _ in every]
    heading = [turned(o4, a[k], b[k]) for o4, a, b, _ in every]
    tip = [(a[k] / o4).imag for o4, a, _, _ in every]
    row = {"distance": apart, "coupler": heading, "box": tip}[name]
    as_good = [value for (*_, mu), value in zip(every, row, strict=True) if mu > best - 1e-3]  # mirrored, too
    least = max(as_good) + {"distance": 0.05, "coupler": 4.0, "box": 0.05}[name]
    limit: dict[str, Any] = {
        "distance": {"distances": {"a-o4": [least, 9]}},
        "coupler": {"coupler_angle_deg": [least, least + 90]},
        "box": {"a": {"y": [least, 9]}},
    }[name]
    result = found(70, 1.12, o2=[0, 0], o4=[1, 0], at=[{"targets": [target], **limit}])
    most = least + 90 if name == "coupler" else 9
    known = max(each[3] for each, value in zip(every, row, strict=True) if least <= value <= most)
    assert known < best - 0.1
    assert worst(result).max() == pytest.approx(known, abs=0.05)
    for each in result.candidates:
        assert verify(each.linkage, result.problem.task, result.problem.requirements).ok


@pytest.mark.slow
def test_no_crank_rocker_keeps_a_rate_of_the_coupler_and_does_better() -> None:
    """The rate over the turn is a matter of proportions alone; by the loop, in small steps."""
    turn, known = np.exp(1j * np.linspace(0, 2 * np.pi, 721)), 0.0
    for o4, a, b, mu in rockers(80, 10 / 9):
        side, r4 = np.sign(((b - a).conj() * (b - o4)).imag)[0], abs(b[0] - o4)
        crank = abs(a[0]) * turn
        way = o4 - crank
        along = (np.abs(way) ** 2 + 1 - r4**2) / (2 * np.abs(way))
        coupler = (along + 1j * side * np.sqrt(1 - along**2)) * way / np.abs(way)
        output = coupler - way
        rate = (crank.conj() * output).imag / (coupler.conj() * output).imag
        known = max(known, mu if np.abs(rate).max() <= 0.5 else 0.0)
    assert 30 < known < 37.7
    assert worst(found(80, 10 / 9, coupler_rate=[-0.5, 0.5])).max() == pytest.approx(known, abs=0.05)


@pytest.mark.slow
@pytest.mark.quick("slider-crank")
@pytest.mark.parametrize("mechanism", ["slider-crank", "inverted-slider-crank"])
def test_limits_at_limit_positions_of_slider_kinds_are_kept(mechanism: str) -> None:
    slides = mechanism == "slider-crank"
    stroke = {"stroke": 1.0, "time_ratio": 1.2} if slides else {"swing_deg": 80, "time_ratio": 2.6}
    single = {"distances": {"b-o2": [0.9, 2]}} if slides else {"distances": {"a-o4": [2, 2.5]}}
    at = [{"targets": [1], "a": {"x": [3, 3.2], "y": [1, 1.1]}}, {"targets": [2], **single}]
    document = {"kind": "stroke", "mechanism": mechanism, "stroke": stroke}
    result = synthesize(problem_from({**document, "requirements": {"o2": {"x": [2, 5]}, "at": at}}, "at"))
    assert len(result) > 3
    for each in result.candidates:
        linkage, begun = each.linkage, each.verdict.theta2
        o2, crank = complex(*linkage.o2), linkage.r2 * np.exp(1j * begun)
        first, last = (o2 + crank).tolist()
        assert 3 - 1e-8 <= first.real <= 3.2 + 1e-8
        assert 1 - 1e-8 <= first.imag <= 1.1 + 1e-8
        if slides:  # in line: O2B is r3 + r2 or r3 - r2
            ahead = np.abs(linkage.r3 + np.array([1, -1]) * linkage.r2)
            assert (np.abs(ahead - np.clip(ahead, 0.9, 2)) < 1e-8).any()
        else:
            assert 2 - 1e-8 <= abs(last - complex(*linkage.o4)) <= 2.5 + 1e-8
    assert "crank-shapers with" not in result.note


@pytest.mark.parametrize("limit", [{"theta2_start_deg": 30}, {"at": [{"targets": [1], "b": {"y": [2, 3]}}]}])
def test_both_senses_of_a_driver_are_alike_where_strokes_take_equally_long(limit: dict[str, Any]) -> None:
    ccw, cw = (found(60, 1.0, driver_sense=sense, **limit) for sense in ("ccw", "cw"))
    assert min(len(ccw), len(cw)) >= 8
    assert worst(cw)[0] == pytest.approx(worst(ccw)[0], abs=1e-3)


@pytest.mark.slow
def test_limits_at_limit_positions_are_kept_alike_in_every_unit_of_length() -> None:
    def best(unit: float) -> float:
        at = [
            {"targets": [1], "a": {"x": [20 * unit, 30 * unit]}},
            {"targets": [2], "distances": {"a-o4": [100 * unit, 115 * unit]}},
        ]
        o4 = {"x": [90 * unit, 110 * unit], "y": [-10 * unit, 10 * unit]}
        return float(worst(found(80, 1.11, o2=[0, 0], o4=o4, at=at))[0])

    # by SLSQP from the best of a million random crank-rockers
    assert [best(unit) for unit in (1e-9, 1.0, 1e9)] == pytest.approx(3 * [36.44385], abs=1e-4)
