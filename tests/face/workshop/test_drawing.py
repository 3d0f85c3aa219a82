"""DXF and SVG files, read back: the parts of the plan, to cut and in their places, and texts."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cache
from io import StringIO
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree as ET

import ezdxf
import ezdxf.path
import numpy as np
import pytest
import shapely

from grashof.problems import FourBar, Linkage, load_linkage
from grashof.problems.values.arrays import FloatArray
from grashof.workshop import Plan, PlateSizes, plan_parts, write_dxf, write_svg
from grashof.workshop.formats import dxf, svg
from grashof.workshop.sheet import sheet

SIZES = PlateSizes(width=20, hole=6, thickness=5, clearance=1)
LINKAGES: dict[str, Linkage] = {
    "pumpjack": load_linkage("pumpjack").scaled(50.0, np.zeros(2)),
    "P at A": FourBar((0, 0), (100, 0), 30, 90, 80, (1, 2), -1),
    "drag link on two bases": FourBar((3, 4), (63, 4), 100, 110, 90, (200, 300)),
}


@cache
def plan_of(name: str) -> Plan:
    return plan_parts(LINKAGES[name], SIZES)


@dataclass
class Layer:
    """Outlines as polygons and circles as (x, y, radius)."""

    outlines: list[FloatArray] = field(default_factory=list)
    circles: list[tuple[float, float, float]] = field(default_factory=list)


def read_dxf(text: str) -> dict[str, Layer]:
    document = ezdxf.read(StringIO(text))
    assert document.units == ezdxf.units.MM
    audit = document.audit()
    assert not audit.errors
    assert not audit.fixes
    layers: dict[str, Layer] = {}
    for entity in document.modelspace():
        layer = layers.setdefault(entity.dxf.layer, Layer())
        assert entity.dxf.layer in document.layers
        if entity.dxftype() == "LWPOLYLINE":
            assert entity.closed
            path = ezdxf.path.make_path(entity)
            layer.outlines.append(np.array([(p.x, p.y) for p in path.flattening(0.01)]))
        elif entity.dxftype() == "CIRCLE":
            layer.circles.append((entity.dxf.center.x, entity.dxf.center.y, entity.dxf.radius))
        else:
            assert entity.dxftype() == "TEXT"
    return layers


def read_svg(text: str) -> dict[str, Layer]:
    name = "{http://www.w3.org/2000/svg}"
    root = ET.fromstring(text)  # noqa: S314  # our own file
    width, height = (float(part) for part in root.attrib["viewBox"].split()[2:])
    assert (root.attrib["width"], root.attrib["height"]) == (f"{width:.15g}mm", f"{height:.15g}mm")
    layers = {}
    for group in root.findall(f"{name}g"):
        layer = layers[group.attrib["id"]] = Layer()
        layer.outlines = [flattened(path.attrib["d"], height) for path in group.findall(f"{name}path")]
        for circle in group.findall(f"{name}circle"):
            x, y, r = (float(circle.attrib[key]) for key in ("cx", "cy", "r"))
            layer.circles.append((x, height - y, r))
    return layers


def flattened(data: str, height: float) -> FloatArray:
    """Path data of straight lines and short counter-clockwise arcs as a polygon, y up."""
    start, *commands = re.findall(r"([MLAZ])([^MLAZ]*)", data)
    points = [complex(*(float(part) for part in start[1].split()))]
    for command, arguments in commands[:-1]:
        *arc, x, y = (float(part) for part in arguments.split())
        end = complex(x, y)
        if command == "A":
            assert arc[0] == arc[1]
            assert arc[2:] == [0, 0, 0]
            chord, r = end - points[-1], arc[0]
            apart = np.sqrt(max(r**2 - abs(chord / 2) ** 2, 0))
            centre = points[-1] + chord / 2 - 1j * chord / abs(chord) * apart  # y is down here
            turn = np.angle((end - centre) / (points[-1] - centre))
            turn = -abs(turn)
            points += list(centre + (points[-1] - centre) * np.exp(1j * np.linspace(0, turn, 48)[1:]))
        else:
            points.append(end)
    assert commands[-1][0] == "Z"
    assert points[-1] == pytest.approx(points[0], abs=1e-9)
    return np.array([(p.real, height - p.imag) for p in points])


READERS = {"dxf": (dxf, read_dxf), "svg": (svg, read_svg)}


def drawn(plan: Plan, kind: str) -> dict[str, Layer]:
    write, read = READERS[kind]
    return read(write(sheet(plan, "A title")))


def parts_of(layer: Layer) -> list[tuple[shapely.Polygon, list[complex]]]:
    """Each outline with the centres of the circles inside."""
    found = []
    for outline in layer.outlines:
        polygon = shapely.Polygon(outline)
        assert polygon.is_valid
        assert polygon.exterior.is_ccw
        holes = [complex(x, y) for x, y, _ in layer.circles if polygon.contains(shapely.Point(x, y))]
        found.append((polygon, holes))
    return found


def distances(holes: Iterable[complex]) -> list[float]:
    return sorted(abs(one - other) for one, other in combinations(holes, 2))


@pytest.mark.parametrize("kind", READERS)
@pytest.mark.parametrize("name", LINKAGES)
def test_the_file_has_every_part_of_the_plan_to_cut_and_in_its_place(name: str, kind: str) -> None:
    plan, across = plan_of(name), np.array([1, 1j])
    layers = drawn(plan, kind)
    pins = layers.pop("ASSEMBLY_PINS").circles
    places = [complex(*plan.joints[pin.name]) for pin in plan.pins if pin.name in plan.joints]
    corner = complex(*pins[0][:2]) - places[0]
    assert [complex(x, y) - corner for x, y, _ in pins] == pytest.approx(places, abs=1e-9)
    assert {radius for layer in layers.values() for *_, radius in layer.circles} == {SIZES.hole / 2}
    left = {name: parts_of(layer) for name, layer in layers.items()}
    for part in plan.parts:
        core = shapely.MultiPoint(part.plate.corners).convex_hull
        shape, holes = shapely.buffer(core, part.plate.width / 2, quad_segs=64), part.plate.holes @ across
        for level, (x, y, angle) in zip(part.layers, part.places.tolist(), strict=True):
            turn, origin = np.exp(1j * angle), corner + complex(x, y)
            middle = origin + turn * complex(*shapely.get_coordinates(shape.centroid)[0])
            placed, cut = left[f"ASSEMBLY_{level}"], left["CUT"]
            here = (
                (polygon, found)
                for polygon, found in placed
                if found == pytest.approx((origin + turn * holes).tolist(), abs=1e-9)
                and polygon.centroid.distance(shapely.Point(middle.real, middle.imag)) < 0.01
                and polygon.area == pytest.approx(shape.area, rel=3e-3)
            )
            placed.remove(next(here))
            apart = (
                (polygon, found)
                for polygon, found in cut
                if distances(found) == pytest.approx(distances(holes), abs=1e-9)
                and polygon.area == pytest.approx(shape.area, rel=3e-3)
            )
            cut.remove(next(apart))
    assert not any(left.values())


@pytest.mark.parametrize("kind", READERS)
def test_parts_to_cut_lie_apart_and_bars_have_the_area_of_the_formula(kind: str) -> None:
    plan = plan_parts(FourBar((0, 0), (100, 0), 30, 90, 80), SIZES)
    parts = parts_of(drawn(plan, kind)["CUT"])
    for one, other in combinations([polygon for polygon, _ in parts], 2):
        assert one.distance(other) >= 9.99
    areas = sorted(polygon.area - len(holes) * np.pi * 9 for polygon, holes in parts if len(holes) == 2)
    bars = [20 * length + np.pi * 100 - 2 * np.pi * 9 for length in (30, 80, 90)]
    assert areas == pytest.approx([*bars, 40 * 100 + np.pi * 400 - 2 * np.pi * 9], rel=3e-3)


def test_arcs_are_true_arcs() -> None:
    plan = plan_of("pumpjack")
    drawing = sheet(plan)
    document = ezdxf.read(StringIO(dxf(drawing)))
    bulges = sorted(len(line) for line in document.modelspace().query("LWPOLYLINE[layer=='CUT']"))
    assert bulges == [4, 4, 4, 6]
    radii = [float(r) for r in re.findall(r"A (\S+) \S+ 0 0 0 ", svg(drawing))]
    assert sorted(radii) == pytest.approx(2 * (2 + 2 + 3) * [10.0] + 4 * [20.0])


def test_files_say_the_same_every_time(tmp_path: Path) -> None:
    plan = plan_of("pumpjack")
    for write, kind in ((write_dxf, "dxf"), (write_svg, "svg")):
        first, second = tmp_path / f"one.{kind}", tmp_path / f"two.{kind}"
        write(first, plan, "Jack")
        write(second, plan, "Jack")
        assert first.read_bytes() == second.read_bytes()
        assert b"Jack" in first.read_bytes()


def test_titles_are_only_text() -> None:
    plan = plan_of("pumpjack")
    drawing = sheet(plan, "<script>\n0\nEOF\x07 ünïcode " + "x" * 500)
    texts = [entity.dxf.text for entity in ezdxf.read(StringIO(dxf(drawing))).modelspace().query("TEXT")]
    assert drawing.title in texts
    assert drawing.title.startswith("<script> 0 EOF ünïcode xxx")
    root = ET.fromstring(svg(drawing))  # noqa: S314  # our own file
    assert not [element for element in root.iter() if "script" in element.tag]


def test_the_parts_list_is_in_the_drawing() -> None:
    plan = plan_of("pumpjack")
    texts = [e.dxf.text for e in ezdxf.read(StringIO(dxf(sheet(plan)))).modelspace().query("TEXT")]
    assert all(cell in texts for row in plan.rows() for cell in row)
    assert "Assembly at theta2 = -53.13 deg, layer 0 (the base) farthest from the eye" in texts
    assert "driver O2-A t5" in texts
