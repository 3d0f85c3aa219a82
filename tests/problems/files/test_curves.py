"""Curves of drawings as points of a path: against closed forms, elliptic integrals and quadrature."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
from refusals import refusal, rows
from same_values import check_same
from scipy.integrate import quad
from scipy.interpolate import BSpline
from scipy.optimize import brentq
from scipy.special import ellipeinc

from grashof.problems import PathTask, Problem, load
from grashof.problems.files.named_files import areas_of, curve_points_of
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.arrays import FloatArray

PATH = 'kind = "path"\nlength_unit = "mm"\n[path]\n'
EXACT = {"rtol": 0, "atol": 1e-9}


def svg(folder: Path, body: str, count: int = 40, size: str = "") -> tuple[FloatArray, bool]:
    """Points on the only path of a drawing, y as in the file, and whether it is closed."""
    (folder / "a.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{body}</svg>')
    keys = curve_points_of("a.svg", folder, "mm", count)
    return np.array(keys["points"]) * [1, -1], keys["closed"]


def dxf(folder: Path, draw: Callable[[Any], object], count: int = 40) -> tuple[FloatArray, bool]:
    document = ezdxf.new("R2010", units=4)
    draw(document.modelspace())
    document.saveas(folder / "a.dxf")
    keys = curve_points_of("a.dxf", folder, "mm", count)
    return np.array(keys["points"]), keys["closed"]


def along(place: Callable[[float], Any], rate: Callable[[float], Any], count: int) -> FloatArray:
    """Places at equal distances on an open curve over [0, 1], each by quadrature and Brent's method."""

    def length(end: float) -> float:
        return quad(lambda t: float(np.hypot(*rate(t))), 0, end, epsabs=1e-13, epsrel=1e-13)[0]

    whole = length(1.0)
    inner = [brentq(lambda t, k=k: length(t) - whole * k / (count - 1), 0, 1) for k in range(1, count - 1)]
    return np.array([place(t) for t in (0.0, *inner, 1.0)])


def rational_circle(space: Any) -> None:
    corner = np.sqrt(0.5)
    places = [(5, 0), (5, 5), (0, 5), (-5, 5), (-5, 0), (-5, -5), (0, -5), (5, -5), (5, 0)]
    knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]
    space.add_rational_spline(places, [1, *[corner, 1] * 4], degree=2, knots=knots)


def two_arcs(space: Any) -> None:
    space.add_arc((3, 4), 5, 10, 100)
    space.add_arc((3, 4), 5, 100, 370)


def mirrored(space: Any) -> None:
    for start, end in ((10, 100), (100, 370)):
        space.add_arc((3, 4), 5, start, end, dxfattribs={"extrusion": (0, 0, -1)})


def two_bulges(space: Any) -> None:
    space.add_lwpolyline([(0, 0, -1), (6, 8, -1)], format="xyb", close=True)


CIRCLES: dict[str, Callable[[Path], tuple[FloatArray, bool]]] = {
    "SVG circle": lambda at: svg(at, '<circle cx="3" cy="4" r="2" transform="rotate(20) scale(2.5)"/>'),
    "SVG arcs": lambda at: svg(at, '<path d="M 6 8 A 5 5 0 1 1 6 0 A 5 5 0 0 1 6 8"/>'),
    "DXF circle": lambda at: dxf(at, lambda space: space.add_circle((3, 4), 5)),
    "DXF arcs": lambda at: dxf(at, two_arcs),
    "mirrored": lambda at: dxf(at, mirrored),
    "bulges": lambda at: dxf(at, two_bulges),
    "weights": lambda at: dxf(at, rational_circle),
}


@pytest.mark.parametrize("name", CIRCLES)
def test_points_of_a_circle_lie_at_its_radius_in_equal_arcs(tmp_path: Path, name: str) -> None:
    points, closed = CIRCLES[name](tmp_path)
    assert closed
    assert points.shape == (40, 2)
    radius = np.hypot(*(points - points.mean(axis=0)).T)
    np.testing.assert_allclose(radius, 5.0, **EXACT)
    steps = np.hypot(*(np.roll(points, -1, axis=0) - points).T)
    np.testing.assert_allclose(steps, 10 * np.sin(np.pi / 40), **EXACT)


@pytest.mark.parametrize("library", ["SVG", "DXF"])
def test_points_of_an_ellipse_are_equally_far_by_elliptic_integrals(tmp_path: Path, library: str) -> None:
    if library == "SVG":
        points, closed = svg(tmp_path, '<ellipse cx="1" cy="2" rx="3" ry="1"/>')
    else:
        points, closed = dxf(tmp_path, lambda space: space.add_ellipse((1, 2), (3, 0), 1 / 3))
    assert closed
    x, y = (points - [1, 2]).T
    np.testing.assert_allclose((x / 3) ** 2 + y**2, 1, **EXACT)
    turn = np.unwrap(np.arctan2(y, x / 3))
    share = 1 - 1 / 9
    from_start = 3 * (ellipeinc(np.pi / 2, share) - ellipeinc(np.pi / 2 - turn, share))
    whole = 12 * ellipeinc(np.pi / 2, share)
    np.testing.assert_allclose(from_start, np.arange(40) * whole / 40, **EXACT)


BEZIERS = {
    "Q": np.array([(0.0, 0), (2, 5), (6, -1)]),
    "C": np.array([(0.0, 0), (1, 4), (7, -2), (3, 3)]),
}


@pytest.mark.parametrize("letter", BEZIERS)
def test_points_of_a_bezier_curve_by_quadrature(tmp_path: Path, letter: str) -> None:
    control = BEZIERS[letter]
    text = " ".join(f"{x:g} {y:g}" for x, y in control[1:])
    points, closed = svg(tmp_path, f'<path d="M 0 0 {letter} {text}"/>', 7)
    curve = BSpline([0] * len(control) + [1] * len(control), control, len(control) - 1)
    assert not closed
    np.testing.assert_allclose(points, along(curve, curve.derivative(), 7), **EXACT)


def test_points_beyond_a_cusp(tmp_path: Path) -> None:
    """x' = 3 (1 - 2 t)^2, y' = 3 (1 - 2 t): s = (1 - (1 + w)^1.5) / 4 with w = (1 - 2 t)^2 at each side."""
    points, closed = svg(tmp_path, '<path d="M 0 0 C 1 1 0 1 1 0"/>', 9)
    assert not closed
    half = (2**1.5 - 1) / 2
    square = (1 + 2 * np.abs(np.linspace(-half, half, 9))) ** (2 / 3) - 1
    t = (1 + np.sign(np.arange(9) - 4) * np.sqrt(square)) / 2
    x, y = 3 * (1 - t) ** 2 * t + t**3, 3 * (1 - t) * t
    np.testing.assert_allclose(points, np.stack([x, y], axis=1), rtol=0, atol=1e-8)


def test_points_of_a_spline_by_quadrature(tmp_path: Path) -> None:
    control = np.array([(0.0, 0), (1, 3), (4, 1), (6, 6), (7, 2), (9, 0)])
    points, closed = dxf(tmp_path, lambda space: space.add_open_spline(control), 6)
    curve = BSpline([0, 0, 0, 0, 1 / 3, 2 / 3, 1, 1, 1, 1], control, 3)
    assert not closed
    np.testing.assert_allclose(points, along(curve, curve.derivative(), 6), **EXACT)


def test_a_skewed_arc_is_that_of_the_places_skewed(tmp_path: Path) -> None:
    body = '<path d="M 2 0 A 2 2 0 0 1 -2 0" transform="matrix(1 0.2 0.5 1 3 4)"/>'
    points, closed = svg(tmp_path, body, 5)
    matrix = np.array([(1, 0.5), (0.2, 1)])
    expected = along(
        lambda t: matrix @ (2 * np.cos(np.pi * t), 2 * np.sin(np.pi * t)) + (3, 4),
        lambda t: 2 * np.pi * matrix @ (-np.sin(np.pi * t), np.cos(np.pi * t)),
        5,
    )
    assert not closed
    np.testing.assert_allclose(points, expected, **EXACT)


def test_area_of_a_skewed_circle(tmp_path: Path) -> None:
    (tmp_path / "a.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg"><circle r="2" transform="skewX(40)"/></svg>'
    )
    (area,) = areas_of("a.svg", tmp_path, "mm")
    x, y = np.array(area).T  # within a thousandth of its size, so that 0.5 % of the area may be missing
    assert abs(np.sum(x * np.roll(y, 1) - y * np.roll(x, 1))) / 2 == pytest.approx(4 * np.pi, rel=5e-3)


@pytest.mark.parametrize(
    ("body", "closed"),
    [
        ('<line x1="0" y1="0" x2="3" y2="4"/>', False),
        ('<polyline points="0,0 3,0 3,4 0,4 0,0"/>', True),
        ('<polyline points="0,0 3,0 3,4 0,4"/>', False),
        ('<polygon points="0,0 3,0 3,4 0,4"/>', True),
        ('<rect width="3" height="4"/>', True),
        ('<path d="M 0 0 h 3 v 4 h -3 z"/>', True),
    ],
)
def test_points_of_straight_lines(tmp_path: Path, body: str, closed: bool) -> None:
    points, found = svg(tmp_path, body, 8 if closed else 6)
    assert found == closed
    if "<line " in body:
        np.testing.assert_allclose(points, np.linspace((0, 0), (3, 4), 6), **EXACT)
    elif closed:
        corners = [(0, 0), (1.75, 0), (3, 0.5), (3, 2.25), (3, 4), (1.25, 4), (0, 3.5), (0, 1.75)]
        np.testing.assert_allclose(points, corners, **EXACT)
    else:
        np.testing.assert_allclose(points, [(0, 0), (2, 0), (3, 1), (3, 3), (2, 4), (0, 4)], **EXACT)


def stadium(space: Any) -> None:
    """Two lines of length 10 and two half circles of radius 5, in disorder, each in some sense."""
    space.add_line((10, 0), (0, 0))
    space.add_arc((10, 5), 5, -90, 90)
    space.add_line((0, 10), (10, 10))
    space.add_arc((0, 5), 5, 90, 270)


def test_lines_and_arcs_of_a_layer_are_one_curve(tmp_path: Path) -> None:
    """It begins as its first line: at (10, 0), towards (0, 0), then up the left arc."""
    points, closed = dxf(tmp_path, stadium, 8)
    assert closed
    step = (20 + 10 * np.pi) / 8
    distance = step * np.arange(8)
    on_arc = (distance[1:4] - 10) / 5
    np.testing.assert_allclose(points[0], (10, 0), **EXACT)
    arc = np.stack([-5 * np.sin(on_arc), 5 - 5 * np.cos(on_arc)], axis=1)
    np.testing.assert_allclose(points[2:4], arc[1:], **EXACT)
    np.testing.assert_allclose(points[1], (10 - step, 0), **EXACT)
    np.testing.assert_allclose(points[4:], [10, 10] - points[:4], **EXACT)


def test_an_open_chain_keeps_the_sense_of_its_first_line(tmp_path: Path) -> None:
    def draw(space: Any) -> None:
        space.add_line((4, 0), (2, 0))
        space.add_line((4, 0), (4, 1e-7))  # such as many programs leave
        space.add_line((4, 2), (4, 0))
        space.add_lwpolyline([(0, 0), (2, 0)])

    points, closed = dxf(tmp_path, draw, 4)
    assert not closed
    np.testing.assert_allclose(points, [(4, 2), (4, 0), (2, 0), (0, 0)], **EXACT)


def test_bulges_either_way(tmp_path: Path) -> None:
    """A half circle to the right of a line up, then one to its left."""
    points, closed = dxf(
        tmp_path, lambda space: space.add_lwpolyline([(0, 0, 1), (0, 2, -1), (0, 4, 0)], format="xyb"), 5
    )
    assert not closed
    np.testing.assert_allclose(points, [(0, 0), (1, 1), (0, 2), (-1, 3), (0, 4)], **EXACT)


def read(folder: Path, keys: str) -> Problem:
    (folder / "task.toml").write_text(PATH + keys)
    return load(folder / "task.toml")


LEG = """<svg xmlns="http://www.w3.org/2000/svg" width="{width}" viewBox="0 0 100 50">
<path id="foot" d="M 10 20 C 12 24 40 24 42 20 C 40 5 12 5 10 20 Z"/>
<g id="one"><path id="hip" d="M 0 0 L 1 1"/></g>
<path id="two" d="M 0 0 L 1 1 M 2 2 L 3 3"/><path id="still" d="M 7 7 L 7 7"/>
<path d="M 5 5 L 1e30 1"/></svg>"""


def test_a_path_of_a_drawing_as_task(tmp_path: Path) -> None:
    """Forty points, closed, in the unit of the problem, y upwards; a file written without the drawing."""
    (tmp_path / "leg.svg").write_text(LEG.format(width="20cm"))
    problem = read(tmp_path, 'points = "leg.svg#foot"\n')
    task = problem.task
    assert isinstance(task, PathTask)
    assert (len(task), task.closed) == (40, True)
    np.testing.assert_allclose(task.points[0], (20, -40), **EXACT)
    (tmp_path / "written.toml").write_text(problem_toml(problem))
    (tmp_path / "leg.svg").unlink()
    check_same(load(tmp_path / "written.toml").task, task)


def test_what_goes_with_a_curve(tmp_path: Path) -> None:
    (tmp_path / "leg.svg").write_text(LEG.format(width="20cm"))
    task = read(
        tmp_path, 'points = "leg.svg#one"\ncount = 3\nclosed = false\ntiming_deg = [0, 9, 20]\nwithin = 1\n'
    ).task
    lined = [(0, 0), (1, -1), (2, -2)]
    check_same(task, PathTask.from_degrees(task.positions, timing_deg=[0, 9, 20], within=1.0))
    np.testing.assert_allclose(task.positions, lined, **EXACT)


REFUSED = r"""
points = "leg.svg" | path.points: leg.svg: the drawing has 5 paths; name one, such as #foot,
    #hip, #two or #still
points = "bare.svg" | path.points: bare.svg: the drawing has 2 paths; give one an id, and name it #id
points = "leg.svg#fot" | path.points: leg.svg#fot: the drawing has no group or path 'fot'
points = "leg.svg#two" | path.points: leg.svg#two: the path has 2 separate lines; it must be one
points = "leg.svg#still" | path.points: leg.svg#still: the curve has no length
points = "none.svg" | path.points: none.svg: there is no such file
points = "leg.png" | path.points is 'leg.png'; it must be a list, or a file .csv, .xlsx, .dxf or .svg
points = "leg.svg#foot"\nclosed = false |
    path.points: the curve of leg.svg#foot is closed; remove closed = false
points = "leg.svg#hip"\nclosed = true |
    path.points: the curve of leg.svg#hip is open: it does not end where it begins; remove closed = true
points = "leg.svg#hip"\nclosed = 3 | path.closed is 3; it must be true or false
points = "leg.svg#hip"\ncount = 1 | path.points: count is 1; it must be a whole number from 2 to 10000
points = "leg.svg#hip"\ncount = 2 | path.points has 2 points; it must have three or more
points = "leg.svg#hip"\ncount = 10001 | path.points: count is 10001; it must be a whole number from 2 to 10000
points = "leg.svg#hip"\ncount = 4.5 | path.points: count is 4.5; it must be a whole number from 2 to 10000
points = [[0, 0], [1, 1], [2, 0]]\ncount = 3 |
    path.count goes with the curve of a .dxf or .svg file as points; remove it
points = "points.csv"\ncount = 3 | path.count goes with the curve of a .dxf or .svg file as points; remove it
points = "leg.dxf" |
    path.points: leg.dxf: the drawing has 3 separate curves in its model space; put one on a layer of its own
    and name it, as #layer
points = "leg.dxf#LEG" |
    path.points: leg.dxf#LEG: the drawing has 2 separate curves on the layer 'LEG'; it must be one
points = "leg.dxf#TEE" |
    path.points: leg.dxf#TEE: more than two ends meet at (30, 0); a curve must not branch
points = "leg.dxf#DOT" | path.points: leg.dxf#DOT: the curve has no length
points = "leg.dxf#NONE" | path.points: leg.dxf#NONE: the drawing has no lines on the layer 'NONE'
"""


@pytest.mark.parametrize(("keys", "said"), rows(REFUSED))
def test_curves_that_are_refused(tmp_path: Path, keys: str, said: str) -> None:
    (tmp_path / "leg.svg").write_text(LEG.format(width="100mm"))
    bare = '<path d="M 0 0 L 1 1"/><path d="M 0 1 L 1 2"/>'
    (tmp_path / "bare.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg">{bare}</svg>')
    (tmp_path / "points.csv").write_text("x,y\n0,0\n1,1\n2,0\n")
    document = ezdxf.new("R2010", units=4)
    space = document.modelspace()
    for layer, lines in {
        "LEG": [[(0, 0), (1, 1)], [(5, 0), (6, 1)]],
        "TEE": [[(20, 0), (30, 0)], [(30, 0), (40, 0)], [(30, 0), (30, 5)]],
    }.items():
        for start, end in lines:
            space.add_line(start, end, dxfattribs={"layer": layer})
    if "#" in keys:
        space.add_line((3, 3), (3, 3), dxfattribs={"layer": "DOT"})
    else:
        space.delete_all_entities()
        for k in range(3):
            space.add_circle((10 * k, 0), 1)
    document.saveas(tmp_path / "leg.dxf")
    assert refusal(read, tmp_path, keys).replace(f"{tmp_path}/", "").removeprefix("task.toml: ") == said


def test_a_curve_that_is_not_finite(tmp_path: Path) -> None:
    said = "the drawing has coordinates that are not finite or beyond 1e20"
    assert said in refusal(svg, tmp_path, '<path d="M 5 5 L 1e30 1"/>')
    assert said in refusal(svg, tmp_path, '<path d="M 5 5 L 1e999 1"/>')


@pytest.mark.parametrize(
    "size", ['width="50mm"', 'height="25mm"', 'width="50mm" height="25mm"', 'width="50"']
)
def test_a_size_that_is_stated_in_part(tmp_path: Path, size: str) -> None:
    """What is left out of it follows from the viewBox, as in a browser."""
    points, _ = svg(tmp_path, '<path d="M 10 20 L 20 40"/>', 3, f'viewBox="0 0 100 50" {size}')
    np.testing.assert_allclose(points, [(5, 10), (7.5, 15), (10, 20)], **EXACT)
