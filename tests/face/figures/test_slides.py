"""Drawings of linkages with a slide: blocks and rods where the motion has them, guides over the travel."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from linkages_of_rows import SIX_BARS
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from grashof.analysis import solve_position
from grashof.drawing.scene import CORNERS
from grashof.figures.animation import animate, save_animation
from grashof.figures.curves import plot_dynamics, plot_kinematics
from grashof.figures.linkage import plot_linkage
from grashof.figures.subject import Subject
from grashof.problems import (
    DynamicsSpec,
    FourBar,
    InvertedSliderCrank,
    Linkage,
    LinkageSpec,
    ProblemError,
    SliderCrank,
)
from grashof.problems.values.linkages.mechanism import LOOP_POINTS

SLIDER = SliderCrank((0.5, -1), 1, 3, 0.4, 0.6, (1, 0.7), -1)
INVERTED = InvertedSliderCrank((0, 0), (2, 1), 1, -0.3, (3, 0.5))
SWINGING = InvertedSliderCrank((0, 0), (2, 0), 1.5, 1.0, (-1, -0.8), -1)
PRESSES = [linkage for linkage in SIX_BARS.values() if linkage.mechanism.slides]


def axes() -> Axes:
    return Figure().subplots()


@pytest.mark.parametrize("linkage", [SLIDER, INVERTED, SWINGING, *PRESSES])
@settings(max_examples=25, deadline=None)
@given(share=st.floats(0.01, 0.99))
def test_blocks_sit_on_their_slides_and_rods_pass_them(linkage: Linkage, share: float) -> None:
    subject = Subject.of(linkage)
    low, high = subject.sweep.ranges[0]
    theta2 = np.array([low + (high - low) * share])
    state = solve_position(linkage, theta2)
    points = {name: complex(*place[0]) for name, place in subject.scene.places(state).items()}
    corners = np.array([points[name] for name in CORNERS[:4]])
    ((_, block),) = linkage.mechanism.slides
    pin = points[LOOP_POINTS[block // 2 - 2][2]]
    np.testing.assert_allclose(corners.mean(), pin, atol=1e-12)
    flat = (corners - pin) * np.exp(-1j * (state.angles[block][0] - np.pi / 2))
    assert np.ptp(flat.real) > np.ptp(flat.imag) > 0
    np.testing.assert_allclose(np.abs(flat), np.abs(flat[0]), rtol=1e-12)
    if isinstance(linkage, InvertedSliderCrank):
        way = np.exp(1j * state.theta3[0])
        ends = [((points[name] - points["a"]) / way) for name in ("rod1", "rod2", "foot")]
        np.testing.assert_allclose([end.imag for end in ends], 0, atol=1e-12)
        block = ((points["b"] - points["a"]) / way).real
        assert ends[0].real <= min(0, block, ends[2].real) <= max(0, block, ends[2].real) <= ends[1].real
        np.testing.assert_allclose(abs((points["p"] - points["foot"]) / way), abs(linkage.coupler_point[1]))


@pytest.mark.parametrize("linkage", [SLIDER, *PRESSES])
def test_the_guide_covers_the_travel(linkage: Linkage) -> None:
    ax = plot_linkage(linkage, ax=axes())
    theta2 = np.linspace(0, 2 * np.pi, 3601)
    state, ending = solve_position(linkage, theta2), "_2" if linkage in PRESSES else ""
    b = state.point("e" if ending else "b") @ np.array([1, 1j])
    angle, offset = (float(getattr(linkage, f"{name}{ending}")) for name in ("slide_angle", "offset"))
    turn = np.exp(1j * angle)
    lines = [np.asarray(line.get_xydata()) @ np.array([1, 1j]) for line in ax.lines]
    straight = [(line - complex(*linkage.o2)) / turn for line in lines if len(line) == 2]
    along = ((b - complex(*linkage.o2)) / turn).real
    guides = [
        line
        for line in straight
        if np.ptp(line.imag) < 1e-9 and line.real.min() < along.min() and line.real.max() > along.max()
    ]
    assert len(guides) == 1
    assert guides[0].imag.mean() < offset


def test_travel_is_that_of_all_ranges() -> None:
    scene = Subject.of(SLIDER).scene
    far, near = np.sqrt(16 - 0.4**2), np.sqrt(4 - 0.4**2)
    (slide,) = scene.slides
    assert scene.reach(slide) == pytest.approx((-far, -near), abs=1e-3)
    assert Subject.of(FourBar((0, 0), (4, 0), 1, 4, 3)).scene.slides == ()


@pytest.mark.parametrize("linkage", [INVERTED, PRESSES[0]])
def test_an_animation_moves_the_block(linkage: Linkage, tmp_path: Path) -> None:
    ax = axes()
    moving = animate(linkage, seconds=1, fps=4, annotated=True, ax=ax)
    blocks = [patch for patch in ax.patches if isinstance(patch, Polygon) and len(patch.get_xy()) == 5]
    assert blocks
    seen = []
    for frame in range(4):
        moving._func(frame)  # type: ignore[attr-defined]
        seen.append(blocks[-1].get_xy()[:4].mean(axis=0))
    theta2 = Subject.of(linkage).sweep
    assert np.isfinite(seen).all()
    assert len({tuple(place.round(6)) for place in seen}) > (1 if theta2.turns else 0)
    save_animation(moving, tmp_path / "moving.gif")
    assert (tmp_path / "moving.gif").read_bytes()[:3] == b"GIF"


def test_curves_of_a_slide() -> None:
    panels = plot_kinematics(
        SLIDER, quantities=("angle", "slide travel", "slide velocity"), ax=Figure().subplots(3)
    )
    assert [panel.get_ylabel() for panel in panels] == [
        "angle (deg)",
        "slide (length)",
        "slide velocity (length/s)",
    ]
    assert [line.get_label() for line in panels[0].lines[:2]] == ["theta3", "transmission angle mu"]
    with pytest.raises(ProblemError, match="quantity 'slide travel' is unknown"):
        plot_kinematics(FourBar((0, 0), (4, 0), 1, 4, 3), quantities="slide travel")
    masses = DynamicsSpec(masses=(1, 1, 1), inertias=(1, 1, 1), speed_rpm=60)
    spec = LinkageSpec(INVERTED, "inverted", length_unit="mm", dynamics=masses)
    (panel,) = plot_dynamics(spec, quantities="joint force", ax=axes())
    assert {"O2", "A", "slide", "O4"} <= {str(line.get_label()) for line in panel.lines}
