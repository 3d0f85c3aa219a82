"""Figures are right, are drawn in the given axes, and have no side effects."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.path import Path as Line

from grashof import load, plot_coupler_curve, plot_design_space, plot_dynamics, plot_kinematics, plot_linkage
from grashof.analysis import (
    Loads,
    driver_ranges,
    given_masses,
    solve_kinematics,
    solve_position,
    virtual_work_torque,
)
from grashof.analysis.judge.planted import planted_path
from grashof.figures import parts, plot_task
from grashof.figures.files import save
from grashof.problems import (
    AssemblyError,
    FourBar,
    LinkageSpec,
    MotionTask,
    NoSolutionError,
    Problem,
    ProblemError,
    load_linkage_spec,
)
from grashof.survey import report_on
from grashof.synth import Result

CRANK_ROCKER = FourBar((0, 0), (4, 1), 1, 4, 3, (2, 1), assembly=-1)
DOUBLE_ROCKER = FourBar((0, 0), (4, 0), 3, 1, 3, (0.5, 1))


@pytest.fixture(autouse=True)
def _nothing_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    for shows in (plt, Figure):
        monkeypatch.setattr(shows, "show", lambda *_, **__: pytest.fail("a figure was shown"))


def axes() -> Axes:
    return Figure().subplots()


def lines(ax: Axes, colour: str) -> list[Any]:
    return [line.get_xydata() for line in ax.lines if to_hex(line.get_color()) == colour]


def test_links_have_their_lengths_at_the_given_angles() -> None:
    theta2 = np.radians([10, 130, 250])
    ax = plot_linkage(CRANK_ROCKER, theta2=theta2, ax=axes())
    drivers, outputs, couplers = (lines(ax, c) for c in (parts.DRIVER, parts.OUTPUT, parts.COUPLER))
    assert [len(each) for each in (drivers, outputs, couplers)] == [3, 3, 3]
    for angle, (o2, a), (o4, b), coupler in zip(theta2, drivers, outputs, couplers, strict=True):
        np.testing.assert_array_equal([o2, o4], [(0, 0), (4, 1)])
        np.testing.assert_allclose(a, [np.cos(angle), np.sin(angle)], atol=1e-12)
        np.testing.assert_allclose(coupler[[0, 1, 3]], [a, b, a])
        assert np.hypot(*(b - a)) == pytest.approx(4)
        assert np.hypot(*(b - o4)) == pytest.approx(3)
        to_o4, to_b = o4 - a, b - a
        assert to_o4[0] * to_b[1] - to_o4[1] * to_b[0] < 0  # assembly -1: B right of A->O4
        along = (b - a) / 4
        p = a + 2 * along + 1 * np.array([-along[1], along[0]])
        np.testing.assert_allclose(coupler[2], p, atol=1e-12)


def test_without_a_unit_none_is_named_and_p_in_a_joint_is_not_named() -> None:
    ax = plot_linkage(FourBar((0, 0), (4, 0), 1, 4, 3), ax=axes())
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_aspect()) == ("x", "y", 1)
    assert {text.get_text() for text in ax.texts} == {"O2", "O4", "A", "B"}


@pytest.mark.slow
def test_a_linkage_with_a_problem_is_drawn_as_its_design_is(few: Result) -> None:
    best = few.best
    design = plot_linkage(best, few.problem, ax=axes())
    for other in (best.linkage, LinkageSpec(best.linkage, "mine", length_unit="mm")):
        ax = plot_linkage(other, few.problem, ax=axes())
        assert ax.get_xlabel() == "x (m)"
        assert len(ax.lines) == len(design.lines)
        for mine, its in zip(ax.lines, design.lines, strict=True):
            np.testing.assert_allclose(mine.get_xydata(), its.get_xydata(), atol=1e-9)


def test_the_path_of_a_driver_with_limits_ends_where_it_must() -> None:
    ax = plot_coupler_curve(DOUBLE_ROCKER, ax=axes())
    curves = [line.get_xydata() for line in ax.lines if line.get_linestyle() == "-"]
    ends = [solve_position(DOUBLE_ROCKER, limits).p for limits in driver_ranges(DOUBLE_ROCKER)]
    np.testing.assert_allclose([curve[[0, -1]] for curve in curves], ends)
    assert np.isfinite(curves).all()


def test_dots_are_ten_degrees_of_the_driver_apart() -> None:
    ax = plot_coupler_curve(CRANK_ROCKER, ax=axes())
    (dots,) = [line.get_xydata() for line in ax.lines if "10 deg" in str(line.get_label())]
    assert len(dots) == 36
    np.testing.assert_allclose(dots, solve_position(CRANK_ROCKER, np.radians(np.arange(0, 360, 10))).p)


@pytest.mark.parametrize("count", [5, 30])
def test_the_points_of_a_path_are_marked_on_its_curve(count: int) -> None:
    task, linkage = planted_path(np.random.default_rng(count), count)
    ax = plot_coupler_curve(linkage, Problem(task=task), ax=axes())
    (marked,) = [line.get_xydata() for line in ax.lines if line.get_label() == "target points"]
    np.testing.assert_array_equal(marked, task.points)
    (way,) = [line.get_xydata() for line in ax.lines if "first to last" in str(line.get_label())]
    for point in task.points:
        assert np.hypot(*(way - point).T).min() < 0.02 * task.size


def test_rates_are_the_slopes_of_the_angles_and_places_drawn() -> None:
    spec, step = load_linkage_spec("pumpjack"), 1e-5
    angle, rate, speed = plot_kinematics(
        spec, quantities=("angle", "angular velocity", "speed"), ax=Figure().subplots(3)
    )
    theta2 = np.radians(angle.lines[0].get_xdata())
    omega2 = 20 * np.pi / 30
    before, after = (solve_position(spec.linkage, theta2 + shift) for shift in (-step, step))
    for line, name in zip(rate.lines, ("theta3", "theta4"), strict=False):
        turn = np.angle(np.exp(1j * (getattr(after, name) - getattr(before, name))))
        np.testing.assert_allclose(line.get_ydata(), omega2 * turn / (2 * step), atol=1e-8)
    way = np.hypot(*(after.p - before.p).T)
    np.testing.assert_allclose(speed.lines[2].get_ydata(), omega2 * way / (2 * step), atol=1e-8)
    labels = ["angle (deg)", "angular velocity (rad/s)", "speed (m/s)"]
    assert [panel.get_ylabel() for panel in (angle, rate, speed)] == labels
    assert speed.get_xlabel() == "driver angle theta2 (deg), driver at 20 rpm"


def test_torque_of_a_design_is_that_of_virtual_work(few: Result) -> None:
    (ax,) = plot_dynamics(few.best, few.problem, quantities="torque", ax=axes())
    given, linkage = few.problem.dynamics, few.best.linkage
    assert given is not None
    assert given.masses is not None
    assert given.inertias is not None
    curve = ax.lines[0].get_xydata()
    state = solve_kinematics(linkage, np.radians(curve[:, 0]), given.omega2)
    masses = given_masses(linkage, given.masses, given.inertias)
    torque = virtual_work_torque(state, masses, Loads(gravity=given.gravity), np.zeros((4, len(curve))))
    np.testing.assert_allclose(curve[:, 1], torque, atol=1e-9)
    assert ax.get_ylabel() == "drive torque (N m)"


def test_a_design_is_driven_in_the_sense_of_its_task(few: Result) -> None:
    (ax,) = plot_kinematics(few.best, few.problem, quantities=("angular velocity",), ax=axes())
    rpm = few.best.verdict.direction * 30 / np.pi
    assert f"driver at {rpm:.4g} rpm" in ax.get_xlabel()
    twice = {"quantities": "angular velocity", "speed_rpm": 2 * rpm}
    (faster,) = plot_kinematics(few.best, few.problem, **twice, ax=axes())
    np.testing.assert_allclose(faster.lines[0].get_ydata(), 2 * np.asarray(ax.lines[0].get_ydata()))


def test_between_limits_ranges_are_apart_and_dead_positions_dotted() -> None:
    (ax,) = plot_kinematics(DOUBLE_ROCKER, quantities=("angular velocity",), ax=axes())
    report = report_on(LinkageSpec(DOUBLE_ROCKER, "rocker"))
    ends = sorted(float(np.degrees(end)) for each in report.sweep.ranges for end in each)
    dotted = sorted(float(line.get_xdata()[0]) for line in ax.lines if line.get_linestyle() == ":")
    assert dotted == pytest.approx(ends)
    assert np.isnan(ax.lines[0].get_xydata()).any(axis=1).sum() >= 1
    assert "dotted: dead positions" in ax.get_xlabel()


def test_the_design_space_is_the_table(few: Result) -> None:
    ax = plot_design_space(few, ax=axes())
    table = few.to_frame()
    dots, rings = ax.collections
    expected = table[["size", "transmission_min_task_deg"]].to_numpy()
    np.testing.assert_allclose(dots.get_offsets(), expected)
    np.testing.assert_allclose(np.asarray(dots.get_array()), table["torque_peak"], rtol=1e-9)
    np.testing.assert_allclose(rings.get_offsets(), expected[table["pareto"]])
    ranks = [int(text.get_text()) for text in ax.texts]
    assert ranks[0] == 1
    assert set(ranks) <= set(range(1, 11))
    assert [text.xy for text in ax.texts] == [tuple(expected[rank - 1]) for rank in ranks]
    assert ax.get_xlabel() == "size (m)"
    assert ax.get_ylabel() == "worst transmission angle over the task (deg)"
    assert [each.get_ylabel() for each in ax.figure.axes[1:]] == ["peak torque (N m)"]


def test_names_and_numbers_stand_apart(few: Result) -> None:
    close = plot_linkage(FourBar((0, 0), (1, 0), 0.95, 1.3, 1.32, (1, 1)), theta2=np.radians(8), ax=axes())
    twice = [each for each in few.candidates for _ in range(2)]
    crowded = plot_design_space(replace(few, candidates=tuple(twice)), ax=axes())
    assert len(close.texts) == 5
    assert 2 <= len(crowded.texts) <= 5
    for ax in (close, crowded):
        ax.figure.draw_without_rendering()
        boxes = [text.get_window_extent() for text in ax.texts]
        assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))


@pytest.mark.slow
def test_names_stand_off_the_lines() -> None:
    """At every tenth degree of the pumpjack no letter lies on a bar, and few on the path of P."""
    jack = load_linkage_spec("pumpjack")
    covered = 0
    for angle in np.radians(np.arange(0, 360, 10)):
        ax = plot_linkage(jack, theta2=angle, ax=axes())
        ax.figure.draw_without_rendering()
        lines = [line for line in ax.lines if line.get_linestyle() != "None"]
        paths = [ax.transData.transform(np.asarray(line.get_xydata())) for line in lines]
        for text in ax.texts:
            box = text.get_window_extent().shrunk(0.6, 0.6)
            covered += any(Line(path).intersects_bbox(box, filled=False) for path in paths)
    assert covered <= 5


def test_a_task_alone_is_drawn_with_what_it_states() -> None:
    luggage = load("luggage")
    ax = plot_task(luggage, ax=axes())
    assert [text.get_text() for text in ax.texts if text.get_text()] == ["1", "2", "3", "4"]
    corners = [patch.get_xy() for patch in ax.patches if isinstance(patch, Polygon)]
    assert len(corners) == 8  # a face and an outline each
    np.testing.assert_allclose(corners[0][0], [5, 4], atol=1e-12)
    points = plot_task(load("path-vertical-line"), ax=axes())
    assert points.lines[0].get_xydata().tolist() == load("path-vertical-line").task.positions.tolist()
    free = MotionTask([[0, 0], [np.nan, np.nan], [2, 1]], [0.0, 0.5, np.nan])
    some = plot_task(Problem(task=free), ax=axes())
    assert [text.get_text() for text in some.texts if text.get_text()] == ["1", "3"]


def test_without_dynamics_the_colour_shows_nothing_or_the_error(few: Result) -> None:
    plain = replace(few.problem, dynamics=None)
    ax = plot_design_space(replace(few, problem=plain), ax=axes())
    assert len(ax.figure.axes) == 1
    loose = replace(plain, requirements=replace(plain.requirements, exact=False))
    ax = plot_design_space(replace(few, problem=loose), ax=axes())
    assert ax.figure.axes[1].get_ylabel() == "error rms (m)"
    with pytest.raises(NoSolutionError, match="too narrow"):
        plot_design_space(replace(few, candidates=(), note="too narrow"))
    assert plt.get_fignums() == []


EACH: dict[str, Callable[..., Any]] = {
    "linkage": lambda result, ax: plot_linkage(result.best, result.problem, ax=ax),
    "curve": lambda result, ax: plot_coupler_curve(result.best, result.problem, ax=ax),
    "kinematics": lambda result, ax: plot_kinematics(result.best, result.problem, ("angle",), ax=ax)[0],
    "dynamics": lambda result, ax: plot_dynamics(result.best, result.problem, ("torque",), ax=ax)[0],
    "space": lambda result, ax: plot_design_space(result, ax=ax),
}


@pytest.mark.parametrize("name", EACH)
def test_axes_given_are_used_and_else_a_figure_is_made(few: Result, name: str) -> None:
    mine = axes()
    assert EACH[name](few, mine) is mine
    assert plt.get_fignums() == []
    made = EACH[name](few, None)
    assert isinstance(made, Axes)
    assert plt.get_fignums() == [made.figure.number]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: plot_linkage(3), "linkage is 3; it must be a Linkage, a LinkageSpec or a Candidate"),
        (lambda: plot_linkage(FourBar((0, 0), (4, 0), [1, 2], 4, 3)), r"batch of shape \(2,\)"),
        (lambda: plot_linkage(FourBar((0, 0), (9, 0), 1, 1, 1)), "closes at no driver angle"),
        (lambda: plot_kinematics(CRANK_ROCKER, quantities=("jerk",)), "'jerk' is unknown; it must be one"),
        (lambda: plot_linkage(CRANK_ROCKER, theta2=[]), "theta2 is empty"),
        (lambda: plot_kinematics(CRANK_ROCKER, quantities=()), "quantities names none; it must name"),
        (lambda: plot_kinematics(CRANK_ROCKER, ax=axes()), "ax has 1 axes; it must have 5"),
        (lambda: plot_dynamics(load_linkage_spec("pumpjack"), ax=axes()), "ax has 1 axes; it must have 3"),
        (lambda: plot_dynamics(CRANK_ROCKER), "has no masses"),
    ],
)  # fmt: skip
def test_bad_input_is_named_and_leaves_no_figure(call: Callable[[], object], message: str) -> None:
    with pytest.raises(ProblemError, match=message):
        call()
    assert plt.get_fignums() == []


def test_an_angle_at_which_it_cannot_close() -> None:
    with pytest.raises(AssemblyError, match="cannot close at theta2 = 180 deg"):
        plot_linkage(FourBar((0, 0), (4, 0), 2, 2, 3), theta2=np.pi, ax=axes())


@pytest.mark.quick("svg")
@pytest.mark.parametrize("kind", ["svg", "pdf", "png"])
def test_same_bytes_and_text_as_text(few: Result, tmp_path: Path, kind: str) -> None:
    problem = replace(few.problem, length_unit="$<m>$", dynamics=None)
    for name in ("one", "two"):
        figure = Figure()
        plot_linkage(few.best, problem, ax=figure.subplots())
        save(figure, [tmp_path / f"{name}.{kind}"])
    one, two = ((tmp_path / f"{name}.{kind}").read_bytes() for name in ("one", "two"))
    assert one == two
    if kind == "svg":
        assert "x ($&lt;m&gt;$)</text>" in one.decode()


def seen(colour: str, matrix: Any) -> Any:
    """CIELAB of a colour as a dichromat sees it; Machado, Oliveira & Fernandes (2009), severity 1."""
    rgb = np.array(to_rgb(colour))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    linear = np.clip(np.array(matrix) @ linear, 0, 1)
    to_xyz = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    xyz = to_xyz @ linear / np.array([0.9505, 1.0, 1.089])
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


SIGHT = {
    "all": np.eye(3),
    "deuteranope": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "protanope": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
}


@pytest.mark.parametrize("who", SIGHT)
def test_colours_are_distinguishable(who: str) -> None:
    colours = (*parts.COLOURS.values(), parts.PATH, parts.TARGET)
    for one, other in combinations(dict.fromkeys(colours), 2):
        assert np.linalg.norm(seen(one, SIGHT[who]) - seen(other, SIGHT[who])) > 15, (one, other)
