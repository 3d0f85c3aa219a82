"""Plates of linkages with a slide: holes, slots over all of the travel, and nothing that meets in motion.

The linkage is moved here by equations of its own: complex numbers, a line and a circle.
"""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import ezdxf
import numpy as np
import pytest
import shapely

from grashof.problems import InvertedSliderCrank, Linkage, ProblemError, SliderCrank, load_linkage
from grashof.problems.values.arrays import FloatArray
from grashof.workshop import Plan, PlateSizes, plan_parts, write_dxf

SIZES = PlateSizes(width=20, hole=6, thickness=5, clearance=1)
LINKAGES: dict[str, Linkage] = {
    "engine": load_linkage("engine"),
    "P beside the rod": SliderCrank((3, 4), 40, 90, 30, 0.5, (40, 60)),
    "behind": SliderCrank((0, 0), 40, 120, -30, 2.5, (40, -60), -1),
    "driver that swings": SliderCrank((5, 5), 90, 60, 20, 0.7, (30, 30), -1),
    "P far off": SliderCrank((0, 0), 30, 150, 0, 0, (-100, 80)),
    "shaper": load_linkage("crank-shaper"),
    "whitworth": InvertedSliderCrank((0, 0), (60, 0), 120, 20, (250, 40), -1),
    "offset rod": InvertedSliderCrank((1, 2), (200, 30), 60, -30, (50, 60)),
    "rod that swings in ranges": InvertedSliderCrank((0, 0), (200, 0), 150, 80, (120, -150)),
}


def moved(linkage: Linkage, theta2: FloatArray) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Origin (complex) and angle of the plates, from O2, by equations that the program does not use."""
    a = float(linkage.r2) * np.exp(1j * theta2)
    sign, offset = float(linkage.assembly), float(linkage.offset)  # type: ignore[attr-defined]
    if isinstance(linkage, SliderCrank):
        turn = np.exp(1j * float(linkage.slide_angle))
        flat = a / turn
        roots = np.sqrt(float(linkage.r3) ** 2 - (offset - flat.imag) ** 2)
        b = (flat.real + sign * roots + 1j * offset) * turn
        theta3, base = np.angle(b - a), float(linkage.slide_angle)
    else:
        assert isinstance(linkage, InvertedSliderCrank)
        o4 = complex(*(linkage.o4 - linkage.o2))
        b, base = np.full(a.shape, o4), float(np.angle(o4))
        far = np.abs(o4 - a)
        theta3 = np.angle(o4 - a) + np.arctan2(offset, sign * np.sqrt(far**2 - offset**2))
    zero = np.zeros_like(theta2)
    return {
        "base": (zero + 0j, zero + base),
        "driver": (zero + 0j, theta2),
        "coupler": (a, theta3),
        "O2": (zero + 0j, zero),
        "A": (a, zero),
        ("B" if isinstance(linkage, SliderCrank) else "O4"): (b, zero),
    }


def angles_of(linkage: Linkage, step: float = 0.5) -> FloatArray:
    """Driver angles at which the linkage closes, rad."""
    theta2 = np.radians(np.arange(0, 360, step))
    with np.errstate(invalid="ignore"):
        places = moved(linkage, theta2)
    return theta2[np.isfinite(places["coupler"][1])]


@pytest.fixture(scope="module")
def plans() -> dict[str, Plan]:
    return {name: plan_parts(linkage, SIZES) for name, linkage in LINKAGES.items()}


@pytest.mark.parametrize("name", LINKAGES)
def test_pins_stay_in_their_holes_and_slots(plans: dict[str, Plan], name: str) -> None:
    plan, linkage = plans[name], LINKAGES[name]
    places = moved(linkage, angles_of(linkage, 0.002))
    slotted = 0
    for part in plan.parts:
        plate = part.plate
        if plate.name == "spacer":
            continue
        origin, angle = places[plate.name]
        for joint, hole in zip(plate.joints, plate.holes, strict=True):
            if joint in places:
                found = origin + complex(*hole) * np.exp(1j * angle)
                np.testing.assert_allclose(found, places[joint][0], atol=1e-9)
        for joint, ends in plate.slots:
            slotted += 1
            inside = (places[joint][0] - origin) * np.exp(-1j * angle)
            one, other = (complex(*end) for end in ends)
            along = (inside - one) / (other - one)
            np.testing.assert_allclose(along.imag * abs(other - one), 0, atol=1e-9)
            room = np.array([along.real.min(), 1 - along.real.max()]) * abs(other - one)
            # Half of the clearance at either end; beside a dead position the pin is fast.
            assert (room >= SIZES.gap / 2 - 1e-9).all()
            assert (room <= SIZES.gap / 2 + (0.5 if "swings" in name else 1e-6)).all()
    assert slotted == sum(len(part.layers) > 0 for part in plan.parts if part.plate.slots) == 1


@pytest.mark.parametrize("name", LINKAGES)
def test_nothing_meets_in_motion(plans: dict[str, Plan], name: str) -> None:
    plan, linkage = plans[name], LINKAGES[name]
    places = moved(linkage, angles_of(linkage))
    for layer in range(1, plan.layers):
        there = {
            part.plate.name: part.plate.corners
            for part in plan.parts
            if layer in part.layers and part.plate.name in ("driver", "coupler")
        }
        there |= {
            pin.name: np.zeros((1, 2)) for pin in plan.pins if layer in pin.passed and pin.name in places
        }
        for one, other in combinations(there, 2):
            shapes = []
            for each in (one, other):
                (origin, angle), corners = places[each], there[each] @ np.array([1, 1j])
                at = origin[:, None] + corners * np.exp(1j * angle)[:, None]
                xy = np.stack([at.real, at.imag], axis=-1)
                kind = {1: lambda x: shapely.points(x[:, 0]), 2: shapely.linestrings}
                shapes.append(kind.get(len(corners), shapely.polygons)(xy))
            assert (shapely.distance(*shapes) >= SIZES.width + 0.9 * SIZES.gap).all(), (one, other)


@pytest.mark.parametrize("name", LINKAGES)
def test_holes_and_slots_have_material_round_them(plans: dict[str, Plan], name: str) -> None:
    for part in plans[name].parts:
        plate = part.plate
        core = shapely.convex_hull(shapely.multipoints(plate.corners))
        whole = shapely.buffer(core, plate.width / 2, quad_segs=64)
        cut = [shapely.points(hole) for hole in plate.holes]
        cut += [shapely.linestrings(ends) for _, ends in plate.slots]
        for shape in cut:
            assert shapely.distance(shape, whole.exterior) >= 0.999 * plate.width / 2
        for one, other in combinations(cut, 2):
            assert shapely.distance(one, other) >= SIZES.least_spacing - 1e-9


def test_the_file_has_the_slot_that_the_list_states(tmp_path: Path) -> None:
    linkage = load_linkage("engine")
    plan = plan_parts(linkage, SIZES)
    stroke = np.sqrt(160**2 - 20**2) - np.sqrt(80**2 - 20**2)
    stated = dict(plan.parts[0].plate.distances)["slot B"]
    assert stated == pytest.approx(stroke + SIZES.gap, abs=1e-9)
    write_dxf(tmp_path / "engine.dxf", plan)
    cut = [
        entity
        for entity in ezdxf.readfile(tmp_path / "engine.dxf").modelspace()
        if entity.dxf.layer == "CUT" and entity.dxftype() == "LWPOLYLINE"
    ]
    extents = [np.ptp(np.array([point[:2] for point in entity.get_points()]), axis=0) for entity in cut]
    assert min(abs(x - stated) + abs(y - SIZES.hole) for x, y in extents) < 1e-9


@pytest.mark.parametrize(
    ("linkage", "said"),
    [
        (SliderCrank((0, 0), 40, 45), "O2 comes within 4.5 mm of the slot of B"),
        (InvertedSliderCrank((0, 0), (50, 0), 40), "A comes within 9.5 mm of the slot of O4"),
        (SliderCrank((0, 0), 5, 45), "r2 is 5 mm; for width 20"),
        (SliderCrank((0, 0), 40, 4.5e5), "r3 is 450000 mm, over 1000 widths"),
    ],
)
def test_what_cannot_be_cut_is_refused_in_one_line(linkage: Linkage, said: str) -> None:
    with pytest.raises(ProblemError) as refused:
        plan_parts(linkage, SIZES)
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


def test_where_p_has_no_hole_it_is_said() -> None:
    plan = plan_parts(InvertedSliderCrank((0, 0), (200, 0), 50, 0, (145, 5)), SIZES)
    assert any("the coupler has no hole for P" in note for note in plan.notes)
