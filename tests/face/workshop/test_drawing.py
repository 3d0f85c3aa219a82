"""The content of DXF and SVG files: hole distances, outlines, and parts that never collide in motion.

The files are read back, and the linkage is moved here by a circle intersection of its own.
"""

from __future__ import annotations

import re
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
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from grashof.problems import FourBar, ProblemError, load_linkage
from grashof.problems.values.arrays import FloatArray
from grashof.synth import Result
from grashof.workshop import Plan, PlateSizes, plan_parts, write_dxf, write_svg
from grashof.workshop.formats import dxf, svg
from grashof.workshop.sheet import sheet

SIZES = PlateSizes(width=20, hole=6, thickness=5, clearance=1)
LINKAGES = {
    "pumpjack": (load_linkage("pumpjack"), 50.0),
    "drag link, P far off": (FourBar((3, 4), (63, 4), 100, 110, 90, (200, 300)), 1.0),
    "tiny crank, P on AB": (FourBar((0, 0), (160, 10), 14, 110, 90, (250, 0)), 1.0),
    "P at A": (FourBar((0, 0), (100, 0), 30, 90, 80, (1, 2), -1), 1.0),
    "P to the right": (FourBar((0, 0), (100, 0), 30, 90, 80, (40, -60), -1), 1.0),
    "double rocker": (FourBar((0, 0), (400, 0), 300, 100, 300, (50, 100)), 1.0),
    "triple rocker": (FourBar((0, 0), (400, 0), 200, 200, 300, (100, 100)), 1.0),
    "kite": (FourBar((0, 0), (100, 0), 100, 150, 150, (50, 40)), 1.0),
    "parallelogram": (FourBar((0, 0), (100, 0), 70, 100, 70, (50, 40)), 1.0),
}


@cache
def plan_of(name: str) -> Plan:
    linkage, scale = LINKAGES[name]
    return plan_parts(linkage, SIZES, scale)


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


def joints_at(linkage: FourBar, scale: float, theta2: FloatArray) -> dict[str, FloatArray]:
    """Joints as complex numbers from O2, by the intersection of two circles; NaN where they do not meet."""
    r2, r3, r4 = (scale * float(r) for r in (linkage.r2, linkage.r3, linkage.r4))
    o4 = complex(*(linkage.o4 - linkage.o2)) * scale
    a = r2 * np.exp(1j * theta2)
    s = np.abs(o4 - a)
    along = (s**2 + r3**2 - r4**2) / (2 * s)
    with np.errstate(invalid="ignore"):
        beside = np.sqrt(r3**2 - along**2)
    b = a + (along + 1j * float(linkage.assembly) * beside) * (o4 - a) / s
    still = np.ones_like(a)
    return {"O2": 0 * still, "A": a, "B": b, "O4": o4 * still}


def least_gap(linkage: FourBar, scale: float, layers: dict[str, Layer]) -> float:
    """Least distance of two parts on one level over 720 driver angles; every pin must find its holes."""
    pins = [complex(x, y) for x, y, _ in layers["ASSEMBLY_PINS"].circles]
    origin = pins[0]
    theta2 = np.angle(pins[1] - origin)
    here = {name: complex(z[0]) for name, z in joints_at(linkage, scale, np.array([theta2])).items()}
    for name, pin in zip(("O2", "A", "B", "O4"), pins, strict=True):
        assert pin - origin == pytest.approx(here[name], abs=1e-9 * scale * float(linkage.lengths.max()))
    moving = joints_at(linkage, scale, np.linspace(0, 2 * np.pi, 720, endpoint=False) + 0.001)
    closes = np.isfinite(moving["B"])
    moving = {name: z[closes] for name, z in moving.items()}
    holes_at: dict[str, set[int]] = {name: set() for name in here}
    gaps, own_level = [np.inf], {}
    levels = sorted(name for name in layers if re.fullmatch(r"ASSEMBLY_\d", name))
    for level, name in enumerate(levels):
        shapes = []
        for polygon, holes in parts_of(layers[name]):
            known = [n for z in holes for n, at in here.items() if abs(z - origin - at) < 1e-6]
            for joint in known:
                holes_at[joint].add(level)
            if len(known) > 1:
                own_level.setdefault("".join(sorted(known)[:2]), level)
            shapes.append(moved(polygon, origin, known, here, moving))
        gaps += [shapely.distance(one, other).min() for one, other in combinations(shapes, 2)]
    for joint, (one, other) in {"A": ("AO2", "AB"), "B": ("AB", "BO4")}.items():
        between = range(*sorted((own_level[one], own_level[other])))
        assert set(between) <= holes_at[joint]
    for joint, link in {"O2": "AO2", "O4": "BO4"}.items():
        level, top = own_level[link], len(levels) - 1
        below = set(range(level)) <= holes_at[joint]
        assert below or (len(parts_of(layers["ASSEMBLY_0"])[0][1]) == 4 and level + 1 == top)
    return float(min(gaps))


def moved(
    polygon: shapely.Polygon,
    origin: complex,
    known: list[str],
    here: dict[str, complex],
    moving: dict[str, FloatArray],
) -> object:
    """A part at all driver angles: carried by two joints, by one, or standing still."""
    z = np.array(polygon.exterior.coords) @ np.array([1, 1j]) - origin
    count = len(moving["A"])
    if not known:
        path = np.tile(z, (count, 1))
    else:
        first = known[0]
        turn = np.ones(count)
        if len(known) > 1:
            turn = (moving[known[1]] - moving[first]) / (here[known[1]] - here[first])
        path = moving[first][:, None] + turn[:, None] * (z - here[first])
    return shapely.polygons(np.stack([path.real, path.imag], axis=-1))


@pytest.mark.quick("pumpjack-dxf", "parallelogram-svg")
@pytest.mark.parametrize("kind", READERS)
@pytest.mark.parametrize("name", LINKAGES)
def test_nothing_meets_in_motion(name: str, kind: str) -> None:
    linkage, scale = LINKAGES[name]
    layers = drawn(plan_of(name), kind)
    assert least_gap(linkage, scale, layers) > 0.9 * SIZES.gap


@pytest.mark.parametrize("kind", READERS)
@pytest.mark.parametrize("name", ["pumpjack", "drag link, P far off", "P at A", "double rocker", "kite"])
def test_holes_are_as_far_apart_as_the_joints(name: str, kind: str) -> None:
    (linkage, scale), plan = LINKAGES[name], plan_of(name)
    parts = parts_of(drawn(plan, kind)["CUT"])
    assert len(parts) == sum(len(part.layers) for part in plan.parts)
    r1, r2, r3, r4 = (float(r) * scale for r in linkage.lengths)
    u, v = linkage.coupler_point * scale
    wanted = {
        "base": {r1}, "driver": {r2}, "output": {r4}, "spacer": set(),
        "coupler": {r3, float(np.hypot(u, v)), float(np.hypot(u - r3, v))},
    }  # fmt: skip
    left = list(parts)
    for part in plan.parts:
        for _ in part.layers:
            polygon, holes = next(p for p in left if len(p[1]) == len(part.plate.holes) and fits(p[0], part))
            left.remove((polygon, holes))
            found = [abs(a - b) for a, b in combinations(holes, 2)]
            expected = wanted[part.plate.name] if len(holes) > 2 or part.plate.name != "coupler" else {r3}
            for length in expected:
                assert min(abs(length - distance) for distance in found) < 1e-9
    assert not left


def fits(polygon: shapely.Polygon, part: object) -> bool:
    """Whether an outline has the area of a part: hull, its perimeter times half the width, and a circle."""
    plate = part.plate  # type: ignore[attr-defined]
    hull = shapely.MultiPoint(plate.holes).convex_hull
    perimeter = hull.length * (2 if hull.geom_type == "LineString" else 1)
    w = plate.width
    return bool(np.isclose(polygon.area, hull.area + perimeter * w / 2 + np.pi * w**2 / 4, rtol=3e-3))


@pytest.mark.parametrize("kind", READERS)
def test_parts_to_cut_lie_apart_and_bars_have_the_area_of_the_formula(kind: str) -> None:
    plan = plan_parts(FourBar((0, 0), (100, 0), 30, 90, 80), SIZES)
    layer = drawn(plan, kind)["CUT"]
    parts = parts_of(layer)
    for one, other in combinations([polygon for polygon, _ in parts], 2):
        assert one.distance(other) >= 9.99
    areas = sorted(polygon.area - len(holes) * np.pi * 9 for polygon, holes in parts if len(holes) == 2)
    bars = [20 * length + np.pi * 100 - 2 * np.pi * 9 for length in (30, 80, 90)]
    assert areas == pytest.approx([*bars, 40 * 100 + np.pi * 400 - 2 * np.pi * 9], rel=3e-3)
    assert {r for _, _, r in layer.circles} == {3.0}


def test_arcs_are_true_arcs() -> None:
    plan = plan_of("pumpjack")
    drawing = sheet(plan)
    document = ezdxf.read(StringIO(dxf(drawing)))
    bulges = sorted(len(line) for line in document.modelspace().query("LWPOLYLINE[layer=='CUT']"))
    assert bulges == [4, 4, 4, 6]
    radii = [float(r) for r in re.findall(r"A (\S+) \S+ 0 0 0 ", svg(drawing))]
    assert sorted(radii) == pytest.approx(2 * (2 + 2 + 3) * [10.0] + 4 * [20.0])


def test_all_joints_of_luggage_designs(few: Result) -> None:
    for candidate in few.candidates[:2]:
        layers = drawn(plan_parts(candidate.linkage, SIZES, 50.0), "svg")
        assert least_gap(candidate.linkage, 50.0, layers) > 0.9 * SIZES.gap


lengths = st.floats(15, 300)


@pytest.mark.study
@settings(max_examples=15)
@given(r=st.tuples(lengths, lengths, lengths, lengths), u=st.floats(-200, 300), v=st.floats(-200, 200),
       assembly=st.sampled_from([1, -1]), ground=st.floats(0, 6.28))  # fmt: skip
def test_any_linkage_moves_freely_or_is_refused(
    r: tuple[float, ...], u: float, v: float, assembly: int, ground: float
) -> None:
    o4 = (r[0] * np.cos(ground), r[0] * np.sin(ground))
    linkage = FourBar((0, 0), o4, r[1], r[2], r[3], (u, v), assembly)
    longest = max(r)
    if longest > 0.999 * (sum(r) - longest):
        if longest > sum(r) - longest:
            with pytest.raises(ProblemError, match="cannot be assembled"):
                plan_parts(linkage, SIZES)
        return
    shortest, p, q, longest = sorted(r)
    assume(abs(p + q - shortest - longest) > 1e-3 * longest)  # there the sweep here has no digits
    layers = drawn(plan_parts(linkage, SIZES), "svg")
    assert least_gap(linkage, 1.0, layers) > 0


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
