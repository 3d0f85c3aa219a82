"""Targets out of tables, areas and outlines out of drawings, as a problem file names them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import openpyxl
import pytest
import shapely
from refusals import refusal, rows
from same_values import check_same

from grashof.problems import MotionTask, PathTask, Problem, ProblemError, load
from grashof.problems.files.named_files import areas_of

POSES = "x,y,angle_deg\n0,0,10\n1,,\n"
HEAD = 'kind = "motion"\nlength_unit = "mm"\n[motion]\n'
MOTION = HEAD + 'poses = "{}"\n'
PATH = 'kind = "path"\nlength_unit = "{}"\n[path]\npoints = "{}"\n'
POINTS = [[0.0, 0.0], [10.0, 5.0], [20.0, 3.0]]
AREAS = (
    'kind = "path"\nlength_unit = "{}"\n[path]\npoints = [[0, 0], [1, 1], [2, 0]]\n'
    '[requirements]\nkeep_out = "{}"\n'
)
MISSED = "its first line must be x,y,angle_deg or x,y,angle_deg,timing_deg"


def written(folder: Path, text: str, **files: str | bytes) -> Problem:
    for name, content in files.items():
        path = folder / name.replace("__", ".")
        path.write_bytes(content.encode() if isinstance(content, str) else content)
    (folder / "task.toml").write_text(text)
    return load(folder / "task.toml")


def refused(folder: Path, text: str, **files: str | bytes) -> str:
    return refusal(written, folder, text, **files).replace(f"{folder}/", "")


def test_poses_of_a_table_are_those_of_the_list(tmp_path: Path) -> None:
    table = "x, y, angle_deg\n0,0,10\n3.5,1e1,-20\n7,8,\n,,45\n"
    task = written(tmp_path, MOTION.format("poses.csv"), poses__csv=table).task
    listed = MotionTask.from_degrees([[0, 0, 10], [3.5, 10, -20], {"x": 7, "y": 8}, {"angle": 45}])
    check_same(task, listed)


def test_timing_of_a_table(tmp_path: Path) -> None:
    table = "\ufeffX,Y,Timing_deg\n0,0,0\n10,5,30\n20,3,60\n"
    task = written(tmp_path, PATH.format("mm", "points.csv"), points__csv=table).task
    check_same(task, PathTask.from_degrees(POINTS, timing_deg=[0, 30, 60]))


def test_a_sheet_of_a_workbook(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    first, second = book.active, book.create_sheet("mine")
    assert first is not None
    first.append(["nothing"])
    for row in (["x", "y"], *POINTS, [None, None]):
        second.append(row)
    book.save(tmp_path / "points.xlsx")
    task = written(tmp_path, PATH.format("mm", "points.xlsx#mine")).task
    check_same(task, PathTask(points=POINTS))
    said = "has no sheet 'other'; it has Sheet, mine"
    assert said in refused(tmp_path, PATH.format("mm", "points.xlsx#other"))
    said = "has the columns 'nothing'; its first line must be x,y"
    assert said in refused(tmp_path, PATH.format("mm", "points.xlsx"))


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("", f"poses.csv: is empty; {MISSED}"),
        ("x,y,angle\n1,2,a\n", "poses.csv: row 1 is '1,2,a'; it must be numbers"),
        ("x,y,angle\n1,,3\n", "poses.csv: row 1 has one of x and y; it must have both or neither"),
        ("x,y,angle\n1,2,3,4\n", "poses.csv: row 1 has 4 cells; it must have 3"),
        (
            "x,y,angle,timing_deg\n1,2,3,4\n5,6,7,\n",
            "poses.csv: row 2 has no timing_deg; all rows must have it",
        ),
    ],
)
def test_a_bad_table_is_refused_in_a_line(tmp_path: Path, table: str, said: str) -> None:
    text = MOTION.format("poses.csv")
    assert refused(tmp_path, text, poses__csv=table) == f"task.toml: motion.poses: {said}"


NAMES = r"""
<MOTION>poses = "poses.json" | motion.poses is 'poses.json'; it must be a list, or a file .csv or .xlsx
<MOTION>poses = "none.csv"\nbody = "none.dxf"\n[scene]\noutlines = "none.svg" |
    motion.poses: none.csv: there is no such file\n
    motion.body: none.dxf: there is no such file\n
    scene.outlines: none.svg: there is no such file
<PATH>points = "points.csv"\ntiming_deg = [0, 1, 2] |
    path.points: points.csv has timing_deg, which is given besides; give one of them
<PATH>points = "gaps.csv" | path.points: gaps.csv: row 2 has an empty cell; it must be numbers
"""


@pytest.mark.parametrize(("text", "said"), rows(NAMES, MOTION=HEAD, PATH=HEAD.replace("motion", "path")))
def test_bad_names_of_files(tmp_path: Path, text: str, said: str) -> None:
    files = {"points__csv": "x,y,timing_deg\n0,0,0\n1,1,9\n2,0,30\n", "gaps__csv": "x,y\n0,0\n1,\n2,0\n"}
    assert refused(tmp_path, text, **files).replace("task.toml: ", "") == said


def drawing(path: Path, units: int = 4) -> None:
    """A square of four lines, a circle, a slot with bulges, all in mm; and a line on a layer of its own."""
    document = ezdxf.new("R2010", units=units)
    space = document.modelspace()
    corners = [(0, 0), (10, 0), (10, 10), (0, 10)]
    for one, other in zip(corners, [*corners[1:], corners[0]], strict=True):
        space.add_line(one, other, dxfattribs={"layer": "AREA"})
    space.add_circle((30, 0), 5, dxfattribs={"layer": "AREA"})
    slot = [(50, 0, 0), (60, 0, 1), (60, 4, 0), (50, 4, 1)]
    space.add_lwpolyline(slot, format="xyb", close=True, dxfattribs={"layer": "AREA"})
    space.add_lwpolyline([(0, -20), (5, -25), (9, -20)], dxfattribs={"layer": "OPEN"})
    document.saveas(path)


@pytest.mark.parametrize(("unit", "factor"), [("in", 1 / 25.4), ("", 1.0)])
def test_areas_of_a_layer(tmp_path: Path, unit: str, factor: float) -> None:
    drawing(tmp_path / "machine.dxf")
    problem = written(tmp_path, AREAS.format(unit, "machine.dxf#area"))
    found = sorted(shapely.polygons(area).area / factor**2 for area in problem.requirements.keep_out)
    expected = sorted([100, np.pi * 25, 40 + np.pi * 4])
    assert found == pytest.approx(expected, rel=0.02)
    box = np.concatenate(problem.requirements.keep_out) / factor
    np.testing.assert_allclose(box.min(axis=0), [0, -5], atol=0.07)
    np.testing.assert_allclose(box.max(axis=0), [62, 10], atol=0.07)


def test_open_lines_may_be_outlines_but_not_areas(tmp_path: Path) -> None:
    drawing(tmp_path / "machine.dxf")
    said = "machine.dxf: the line that begins at (0, -20) is open; it must be closed"
    assert said in refused(tmp_path, AREAS.format("mm", "machine.dxf"))
    text = MOTION.format("poses.csv") + '[scene]\noutlines = "machine.dxf#OPEN"\n'
    (outline,) = written(tmp_path, text, poses__csv="x,y,angle\n0,0,0\n5,5,30\n").outlines
    np.testing.assert_allclose(outline, [(0, -20), (5, -25), (9, -20)])
    assert "has no lines on the layer 'NONE'" in refused(tmp_path, AREAS.format("mm", "machine.dxf#NONE"))


def test_a_drawing_with_its_own_unit_is_converted(tmp_path: Path) -> None:
    drawing(tmp_path / "mils.dxf", units=9)
    said = "the drawing is in unit 9 of DXF; it must be one of in, ft, yd, mm"
    assert said in refused(tmp_path, AREAS.format("mm", "mils.dxf#AREA"))
    drawing(tmp_path / "inches.dxf", units=1)
    problem = written(tmp_path, AREAS.format("mm", "inches.dxf#AREA"))
    assert np.concatenate(problem.requirements.keep_out).max() == pytest.approx(62 * 25.4, rel=1e-3)


TWICE = 'width="200mm" height="100mm"'
SVG = """<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="0 0 100 50">
<g id="area"><rect x="10" y="10" width="20" height="5"/>
<path d="M 50 20 C 50 10 70 10 70 20 L 70 30 L 50 30 Z"/></g>
<polyline id="open" points="0,0 5,5 9,0" fill="none"/></svg>"""


@pytest.mark.parametrize(
    ("size", "unit", "factor"), [("", "mm", 1.0), (TWICE, "mm", 2.0), (TWICE, "m", 2e-3)]
)
def test_areas_of_an_svg(tmp_path: Path, size: str, unit: str, factor: float) -> None:
    """y runs upwards in a problem, and downwards in the file."""
    problem = written(tmp_path, AREAS.format(unit, "machine.svg#area"), machine__svg=SVG.format(size=size))
    rectangle, arch = (shapely.polygons(area / factor) for area in problem.requirements.keep_out)
    assert rectangle.area == pytest.approx(100, rel=1e-6)
    t = np.linspace(0, 1, 100_001)
    x, y = 50 + 60 * (1 - t) * t**2 + 20 * t**3, 30 * t * (1 - t)
    assert arch.area == pytest.approx(20 * 10 + np.trapezoid(y, x), rel=0.005)
    assert arch.bounds == pytest.approx((50, -30, 70, -12.5), abs=0.1)


def test_bad_svg_files_and_open_lines(tmp_path: Path) -> None:
    assert "is not an SVG file" in refused(tmp_path, AREAS.format("mm", "a.svg"), a__svg="no")
    assert "is not an Excel workbook" in refused(tmp_path, MOTION.format("a.xlsx"), a__xlsx="no")
    said = refused(tmp_path, AREAS.format("mm", "b.svg"), b__svg=SVG.format(size=""))
    assert "b.svg: the line that begins at" in said
    said = refused(tmp_path, AREAS.format("mm", "b.svg#none"))
    assert said == "task.toml: requirements.keep_out: b.svg#none: the drawing has no group or path 'none'"


def test_a_body_is_one_area(tmp_path: Path) -> None:
    text = MOTION.format("poses.csv") + 'body = "body.svg"\n'
    files: dict[str, Any] = {"poses__csv": "x,y,angle\n0,0,0\n5,5,30\n"}
    one = '<svg xmlns="http://www.w3.org/2000/svg"><rect x="0" y="0" width="2" height="1"/></svg>'
    task = written(tmp_path, text, body__svg=one, **files).task
    assert shapely.polygons(task.body).area == pytest.approx(2)
    two = one.replace("<rect", '<rect x="5" y="5" width="1" height="1"/><rect')
    said = "task.toml: motion.body: body.svg: has 2 closed lines; a body must be one"
    assert refused(tmp_path, text, body__svg=two) == said


def test_a_place_inside_a_drawing(tmp_path: Path) -> None:
    head, poses = 'kind = "motion"\nlength_unit = "mm"\n', "[motion]\nposes = [[0, 0, 0], [5, 5, 30]]\n"
    text = head + poses + '[requirements]\no4 = { inside = "wing.svg#spar" }\n'
    spar = '<path id="spar" d="M 0 0 L 9 0 L 4 -3 Z"/>'
    wing = f'<svg xmlns="http://www.w3.org/2000/svg" width="100mm" viewBox="0 0 50 50">{spar}</svg>'
    region = written(tmp_path, text, wing__svg=wing).requirements.regions["o4"]
    assert shapely.Polygon(region.corners).area == pytest.approx(4 * 9 * 3 / 2)
    assert region.y == pytest.approx((0, 6))
    both = '<g id="spar"><rect width="1" height="1"/><rect x="5" width="1" height="1"/></g>'
    said = refused(tmp_path, text, wing__svg=wing.replace(spar, both))
    assert said.endswith("requirements.o4.inside: wing.svg#spar: has 2 closed lines; a region must be one")
    said = refused(tmp_path, text.replace(".svg#spar", ".csv"))
    assert said.endswith("requirements.o4.inside is 'wing.csv'; it must be a list, or a file .dxf or .svg")


def svg_areas(folder: Path, body: str, width: str = "100mm") -> list[list[list[float]]]:
    head = f'xmlns="http://www.w3.org/2000/svg" width="{width}" height="100mm" viewBox="0 0 100 100"'
    (folder / "a.svg").write_text(f"<svg {head}>{body}</svg>")
    return areas_of("a.svg", folder, "mm")


def test_a_turned_rectangle_of_an_svg(tmp_path: Path) -> None:
    turned = '<g transform="translate(5 5) rotate(90)"><rect width="10" height="20"/></g>'
    area = shapely.Polygon(svg_areas(tmp_path, turned)[0])
    assert area.symmetric_difference(shapely.box(-15, -15, 5, -5)).area == pytest.approx(0, abs=1e-9)


def test_a_long_arc_of_an_svg_is_kept_to_a_thousandth(tmp_path: Path) -> None:
    arc = '<path d="M 90 50 A 40 40 0 1 1 90 49.9 Z"/>'
    centre = np.array([50, 49.95])  # between the ends, 40 away from both
    points = np.array(svg_areas(tmp_path, arc)[0]) * [1, -1] - centre
    between = (points + np.roll(points, -1, axis=0)) / 2
    assert 40 - np.hypot(*between.T).min() <= 1e-3 * 80


@pytest.mark.quick("no-width", "negative", "no-area")
@pytest.mark.parametrize(
    ("body", "width", "said"),
    [
        ('<rect width="9" height="9"/>', "0mm", "it must be positive"),
        ('<rect width="9" height="9"/>', "-5mm", "it must be positive"),
        ('<path d="M0 0 L10 0 Z"/>', "9mm", "encloses nothing"),
        (
            "<path d='M0 0" + "".join(f"L{i % 100} {i * 7 % 97}" for i in range(20_001)) + "Z'/>",
            "9mm",
            "at most",
        ),
    ],
    ids=["no-width", "negative", "no-area", "too-many"],
)
def test_a_bad_svg_is_refused_in_a_line(tmp_path: Path, body: str, width: str, said: str) -> None:
    with pytest.raises(ProblemError, match=said) as caught:
        svg_areas(tmp_path, body, width)
    assert "\n" not in str(caught.value)
