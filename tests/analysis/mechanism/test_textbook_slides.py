"""Textbook figures of slider-cranks, and consequences of their triangles."""

from __future__ import annotations

import numpy as np
import pytest

from grashof.analysis import (
    driver_ranges,
    output_stroke,
    rotatability,
    solve_kinematics,
    solve_position,
    worst_transmission_cycle,
)
from grashof.problems import InvertedSliderCrank, SliderCrank


def test_nortons_offset_slider_crank() -> None:
    """Norton, *Design of Machinery*, ch. 4: r2 = 40, r3 = 120, offset -20 mm, theta2 = 60 deg.

    His theta3 = 152.91 deg is the rod's direction from the slider; d = r2 cos(theta2) - r3 cos(theta3).
    """
    linkage = SliderCrank(o2=(0, 0), r2=40, r3=120, offset=-20)
    state = solve_kinematics(linkage, np.radians(60))
    assert np.degrees(state.theta3) + 180 == pytest.approx(152.91, abs=5e-3)
    assert state.slide.travel == pytest.approx(126.84, abs=5e-3)
    crossed = solve_kinematics(linkage, np.radians(60), assembly=-1)
    assert crossed.slide.travel == pytest.approx(-86.84, abs=5e-3)


def test_the_acceleration_of_a_piston_has_the_textbook_harmonics() -> None:
    """Over r2 omega^2 it is cos(t) + A2 cos(2 t) - A4 cos(4 t) ..., by Taylor's series in r2 / r3."""
    ratio, omega2 = 0.1, 7.0
    theta2 = 2 * np.pi * np.arange(64) / 64
    state = solve_kinematics(SliderCrank(o2=(0, 0), r2=2, r3=20), theta2, omega2)
    terms = np.fft.rfft(-state.slide.acceleration / (2 * omega2**2)).real / 32
    a2, a4 = ratio + ratio**3 / 4 + 15 * ratio**5 / 128, ratio**3 / 4 + 3 * ratio**5 / 16
    assert terms[1:6] == pytest.approx([1, a2, 0, -a4, 0], abs=1e-7)
    across = np.abs(state.point(4, (0.5, -0.3)).acceleration[:, 1])  # the slider stays on its line
    assert across.max() < 1e-10


@pytest.mark.parametrize("swing", [20.0, 60.0, 120.0])
def test_a_crank_shaper_has_the_textbook_ratio(swing: float) -> None:
    shaper = InvertedSliderCrank(o2=(1, 2), o4=(1, -3), r2=5 * np.sin(np.radians(swing / 2)))
    stroke = output_stroke(shaper)
    assert np.degrees(stroke.swing) == pytest.approx(swing, abs=1e-12)
    assert stroke.time_ratio == pytest.approx((180 + swing) / (180 - swing), rel=1e-13)
    assert np.degrees(worst_transmission_cycle(shaper)) == pytest.approx(90)


def test_a_centric_slider_crank_has_twice_its_crank_as_stroke() -> None:
    stroke = output_stroke(SliderCrank(o2=(3, 1), r2=40, r3=120, slide_angle=0.7, assembly=-1))
    assert stroke.chord == pytest.approx(80, rel=1e-14)
    assert stroke.time_ratio == pytest.approx(1, rel=1e-14)


def test_an_offset_slider_crank_has_the_stroke_of_its_two_triangles() -> None:
    linkage = SliderCrank(o2=(0, 0), r2=2, r3=7, offset=3)
    assert output_stroke(linkage).chord == pytest.approx(np.sqrt(81 - 9) - np.sqrt(25 - 9), rel=1e-14)
    cosine = 5 / 7  # the worst transmission angle over a turn: cos mu = (r2 + |offset|) / r3
    assert np.cos(worst_transmission_cycle(linkage)) == pytest.approx(cosine, rel=1e-14)


def test_rotatability_of_slides_is_their_clearance() -> None:
    assert rotatability(SliderCrank(o2=(0, 0), r2=2, r3=7, offset=3)) == pytest.approx([2 / 12, 8 / 12])
    inverted = InvertedSliderCrank(o2=(0, 0), o4=(0, 5), r2=2, offset=-1)
    assert rotatability(inverted) == pytest.approx([1, 2 / 8])


def test_an_inverted_slider_crank_that_never_closes_has_no_range() -> None:
    far = InvertedSliderCrank(o2=(0, 0), o4=(0, 5), r2=2, offset=8)
    assert np.isnan(driver_ranges(far)).all()
    assert np.isnan(solve_position(far, [0.0, 1.0]).b).all()
    away = SliderCrank(o2=(0, 0), r2=2, r3=1, offset=-4)
    assert np.isnan(driver_ranges(away)).all()
    assert np.isnan(solve_position(away, [0.0, 1.0]).p).all()
