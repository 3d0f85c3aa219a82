"""Figures of sections: the drawing agrees with the plot, in the given axes."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree as ET

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from grashof.figures.files import save
from grashof.figures.section_plots import PENS, plot_section
from grashof.study.section import Plot

THETA2 = np.arange(361.0)
TURN = np.radians(THETA2)
CIRCLE = np.column_stack([3 * np.cos(TURN), 2 * np.sin(TURN)])
HOSTILE = '</svg><script>alert(1)</script> $\\frac{1}{ "_&'


def drawn(plot: Plot) -> Axes:
    axes: Axes = Figure().subplots()
    assert plot_section(plot, axes) is axes
    axes.figure.draw_without_rendering()
    return axes


def labels(axes: Axes) -> list[str]:
    legend = axes.get_legend()
    return [] if legend is None else [text.get_text() for text in legend.get_texts()]


def test_curves_over_the_driver_angle() -> None:
    axes = drawn(Plot("a", "torque", "N m", {"one": np.sin(TURN), "two": np.cos(TURN)}, THETA2))
    for line, values in zip(axes.lines, (np.sin(TURN), np.cos(TURN)), strict=False):
        np.testing.assert_array_equal(line.get_xydata(), np.column_stack([THETA2, values]))
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("driver angle theta2 (deg)", "torque (N m)")
    assert axes.get_xlim() == (0, 360)
    assert axes.get_xticks().tolist() == list(range(0, 361, 45))
    assert labels(axes) == ["one", "two"]


def test_curves_over_time_with_points() -> None:
    time, data = np.linspace(0, 7, 50), np.array([[1.0, 2.0], [3.0, 4.0]])
    axes = drawn(Plot("a", "angle", "deg", {"fit": time}, time, "time (s)", {"data": data}))
    assert axes.get_xlabel() == "time (s)"
    np.testing.assert_array_equal(axes.lines[0].get_xydata(), np.column_stack([time, time]))
    assert labels(axes) == ["fit", "data"]
    (points,) = [line for line in axes.lines if line.get_marker() == "o"]
    np.testing.assert_array_equal(points.get_xydata(), data)
    assert points.get_linestyle() == "None"


def test_tracks_have_equal_scales() -> None:
    axes = drawn(Plot("a", "hodograph", "m/s", {"P": CIRCLE}, points={"at 0": CIRCLE[:1]}))
    assert axes.get_aspect() == 1
    assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_title()) == ("x (m/s)", "y (m/s)", "hodograph")
    np.testing.assert_array_equal(axes.lines[0].get_xydata(), CIRCLE)


def test_a_driver_that_swings_has_its_dead_positions_dotted() -> None:
    places = np.concatenate([np.linspace(30, 70, 41), [np.nan], np.linspace(-70, -30, 41)])
    inner = (np.abs(np.abs(places) - 50) / 20).clip(0, 1 - 1e-9)
    axes = drawn(Plot("a", "rate", "rad/s", {"omega3": 1 / np.sqrt(1 - inner**2)}, places))
    dotted = [float(line.get_xdata()[0]) for line in axes.lines if line.get_linestyle() == ":"]
    assert dotted == pytest.approx([-70, -30, 30, 70])
    assert "dotted: dead positions" in axes.get_xlabel()
    assert np.abs(axes.get_ylim()).max() < 20


def test_a_pole_leaves_the_frame_on_both_sides_and_is_not_crossed() -> None:
    axes = drawn(Plot("a", "advantage", "", {"ratio": 1 / np.sin(TURN + 1e-3)}, THETA2))
    low, high = axes.get_ylim()
    assert -25 < low < -5
    assert 5 < high < 25
    values = np.asarray(axes.lines[0].get_ydata())
    steps = np.abs(np.diff(values))
    assert not (steps[np.isfinite(steps)] > 1000).any()


def test_sixteen_lines_look_different() -> None:
    assert len(PENS) == 8
    axes = drawn(Plot("a", "many", "N", {f"{k}": np.sin(TURN + k) for k in range(16)}, THETA2))
    looks = [(line.get_color(), str(line._dash_pattern)) for line in axes.lines[:16]]
    assert len(set(looks)) == 16
    assert all(one != other for one, other in combinations(looks, 2))


@pytest.mark.parametrize("places", [None, THETA2])
@pytest.mark.parametrize("values", [np.nan, np.inf, 0.0])
def test_nothing_to_draw_is_no_error(places: np.ndarray | None, values: float) -> None:
    shape = (361, 2) if places is None else (361,)
    drawn(Plot("a", "a", "m", {"x": np.full(shape, values), "y": np.full(shape, np.nan)}, places))
    drawn(Plot("a", "a", "m", {}, places))


def test_text_is_text(tmp_path: Path) -> None:
    figures = [Figure() for _ in range(2)]
    plot_section(
        Plot("a", HOSTILE, HOSTILE, {HOSTILE: np.sin(TURN), "_b": TURN}, TURN, HOSTILE), figures[0].subplots()
    )
    plot_section(Plot("a", HOSTILE, HOSTILE, {HOSTILE: CIRCLE, "_": CIRCLE}), figures[1].subplots())
    for number, figure in enumerate(figures):
        path = tmp_path / f"{number}.svg"
        save(figure, [path])
        root = ET.parse(path).getroot()  # noqa: S314
        assert not {"script", "image"} & {str(node.tag).rpartition("}")[2] for node in root.iter()}
        assert any(HOSTILE in "".join(node.itertext()) for node in root.iter())
        assert labels(figure.axes[0])[0] == HOSTILE
        assert len(labels(figure.axes[0])) == 2


def test_without_axes_a_figure_is_made() -> None:
    axes = plot_section(Plot("a", "a", "", {"a": TURN}, THETA2))
    assert plt.get_fignums() == [axes.figure.number]
