"""Dwells of six-bars compared with a published linkage, body coordinates and linkages made otherwise."""

import numpy as np
import pytest
from body_coordinates import follow, start
from body_plans import plan_of
from random_linkages import six_bars

from grashof.analysis import verify
from grashof.analysis.judge.meeting.dwell_output import least_band, made_band
from grashof.problems import DwellTask, Requirements, SixBar, load_linkage

GRID = 720


@pytest.mark.parametrize(("dwell_deg", "band_deg"), [(103.0, 0.1), (138.5, 0.5), (159.8, 1.0), (185.9, 2.0)])
def test_the_dwell_of_a_course_project(dwell_deg: float, band_deg: float) -> None:
    found = least_band(load_linkage("dwell-six-bar"), float(np.radians(dwell_deg)))
    assert found is not None
    assert np.degrees(found.band) == pytest.approx(band_deg, rel=1e-2)
    assert np.degrees(found.swing) == pytest.approx(15.83, abs=5e-3)


def _outputs(linkages: SixBar, theta2: np.ndarray) -> np.ndarray:
    """The angle of link 6, or the travel of the slide, by body coordinates, unwrapped; shape (N, K)."""
    plan = plan_of(linkages)
    q = follow(plan, start(plan, theta2[0]), theta2[0], theta2)
    x, y, angle = np.moveaxis(q[..., -3:], -1, 0)
    if "r6" in linkages.mechanism.lengths:
        return np.unwrap(angle, axis=0)
    return x * np.cos(linkages.slide_angle_2) + y * np.sin(linkages.slide_angle_2)


@pytest.mark.quick("pins 3 1", "slide 3 1")
@pytest.mark.parametrize("row", ["pins 3 1", "slide 3 1", "pins 4 1", "slide 4 1"])
def test_no_other_interval_has_a_smaller_band(row: str) -> None:
    linkages = six_bars(row, 8, np.random.default_rng(5))
    outputs = _outputs(linkages, np.arange(GRID * 5 // 4 + 1) * 2 * np.pi / GRID)
    windows = np.lib.stride_tricks.sliding_window_view(outputs, GRID // 4 + 1, axis=0)[:GRID]
    bands, count = np.ptp(windows, axis=-1).min(axis=0), 0
    for k, linkage in enumerate(linkages):
        found, output = least_band(linkage, np.pi / 2), outputs[: GRID + 1, k]
        if found is None:
            assert abs(output[-1] - output[0]) > 6  # link 6 turns fully
            continue
        assert found.band * (1 - 1e-4) <= bands[k] <= found.band + 1e-2 * found.swing
        assert np.ptp(output) == pytest.approx(found.swing, rel=1e-3)
        inside = _outputs(linkages[k : k + 1], np.linspace(found.start, found.end, 181))
        assert np.ptp(inside) == pytest.approx(found.band, rel=2e-3)
        count += 1
    assert count > 1


@pytest.mark.parametrize("row", ["pins 3 1", "slide 3 1"])
def test_tolerances_widen_the_band_by_the_root_of_the_sum_of_squares(row: str) -> None:
    linkage = six_bars(row, 1, np.random.default_rng(2))[0]
    found = least_band(linkage, 1.0)
    assert found is not None
    theta2, step, tolerance = np.linspace(found.start, found.end, 49), 1e-6 * float(linkage.r1), 0.01
    nominal, slopes = _outputs(linkage[None], theta2)[:, 0], []
    for name in linkage.mechanism.dimensions:
        if name in "uv":
            continue
        base, _, axis = name.partition("_")
        if name == "r1":
            along = np.array([np.cos(linkage.theta1), np.sin(linkage.theta1)])
            other = linkage.changed(o4=linkage.o4 + step * along)
        elif base in ("c", "d"):
            other = linkage.changed(
                **{base: getattr(linkage, base) + step * np.array([axis == "u", axis == "v"])}
            )
        else:
            other = linkage.changed(**{name: getattr(linkage, name) + step})
        slopes.append((_outputs(other[None], theta2)[:, 0] - nominal) / step)
    slope = np.stack(slopes, axis=1)
    off = tolerance * np.linalg.norm(slope[:, None] - slope, axis=2)
    assert made_band(linkage, found, tolerance) == pytest.approx(
        (nominal[:, None] - nominal + off).max(), rel=1e-4
    )
    usual = made_band(linkage, found)
    assert usual == pytest.approx(made_band(linkage, found, 2e-4 * float(linkage.r1)), rel=1e-12)
    assert found.band < usual < made_band(linkage, found, tolerance)


def test_a_driver_that_does_not_turn_has_no_dwell() -> None:
    stopped = load_linkage("dwell-six-bar").changed(r5=40.0)
    assert least_band(stopped, 1.0) is None


def test_the_other_kind_of_output_is_a_miss() -> None:
    task = DwellTask.from_degrees(dwell_deg=90, stroke=10)
    verdict = verify(load_linkage("dwell-six-bar"), task, Requirements())
    assert verdict.dwell is None
    assert [str(each) for each in verdict.defects] == [
        "exact: the number of slides as the last link is 0, allowed: 1"
    ]
