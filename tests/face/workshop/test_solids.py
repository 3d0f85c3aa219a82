"""Solids read back have the volumes of the plan, piece by piece, and lie where it has them."""

import math
from typing import Any

import numpy as np
import pytest
import shapely

from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank
from grashof.workshop import Plan, PlateSizes, plan_parts
from grashof.workshop.plates import Plate
from grashof.workshop.solids import TOLERANCE, step, stl

pytestmark = pytest.mark.extra

LINKAGES = [
    FourBar(o2=(0, 0), o4=(100, 0), r2=30, r3=90, r4=80, coupler_point=(60, 40)),
    SliderCrank(o2=(3, 4), r2=40, r3=120, offset=10, slide_angle=0.4),
    InvertedSliderCrank(o2=(0, 0), o4=(0, -150), r2=50, offset=0, coupler_point=(300, 20)),
]


@pytest.fixture(scope="module")
def cad() -> Any:
    """The kernel, which takes seconds to import: not where tests are collected, in every process."""
    return pytest.importorskip("build123d")


@pytest.fixture(params=LINKAGES, ids=lambda linkage: linkage.mechanism.word, scope="module")
def plan(request: pytest.FixtureRequest, cad: Any) -> Plan:
    linkage: Linkage = request.param
    return plan_parts(linkage, PlateSizes(width=18, hole=5, thickness=4))


@pytest.fixture(scope="module")
def found(plan: Plan, cad: Any, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The STEP file, read back."""
    path = tmp_path_factory.mktemp("solids") / "linkage.step"
    path.write_bytes(step(plan))
    return cad.import_step(path)


def area(plate: Plate) -> float:
    """Of a plate by a second way: a buffered polygon less its holes and slots, with 4 000 flats a circle."""
    flats = 1000
    shape = shapely.multipoints(plate.corners).convex_hull.buffer(plate.width / 2, quad_segs=flats)
    holes = shapely.multipoints(plate.holes).buffer(plate.hole / 2, quad_segs=flats)
    slots = [shapely.linestrings(ends).buffer(plate.hole / 2, quad_segs=flats) for _, ends in plate.slots]
    return float(shapely.difference(shape, shapely.union_all([holes, *slots])).area)


def volumes(plan: Plan) -> list[float]:
    thick = plan.sizes.thickness
    plates = [area(part.plate) * thick for part in plan.parts for _ in part.layers]
    return plates + [math.pi * plan.sizes.hole**2 / 4 * plan.pin_length(pin) for pin in plan.pins]


def test_a_step_file_has_every_part_and_pin(plan: Plan, found: Any) -> None:
    solids = found.solids()
    assert [solid.volume for solid in solids] == pytest.approx(volumes(plan), rel=1e-5)
    assert all(solid.is_valid for solid in solids)
    names = [child.label.replace("_", " ") for child in found.children]
    assert names[: len(plan.parts[0].layers)] == ["base"] * len(plan.parts[0].layers)
    assert {f"pin {pin.name}" for pin in plan.pins if not pin.name.startswith("post")} <= set(names)
    box = found.bounding_box()
    assert pytest.approx((0, plan.layers * plan.sizes.thickness), abs=1e-6) == (box.min.Z, box.max.Z)


def test_pins_go_through_their_holes(plan: Plan, found: Any) -> None:
    """A pin and a plate meet on the wall of a hole only."""
    solids = found.solids()
    count = sum(len(part.layers) for part in plan.parts)
    for pin in solids[count:]:
        for plate in solids[:count]:
            common = pin.intersect(plate)
            assert common is None or sum(each.volume for each in common.solids()) < 1e-6


def test_an_stl_file_has_the_same_volume(plan: Plan) -> None:
    content = stl(plan)
    assert stl(plan) == content
    count = int.from_bytes(content[80:84], "little")
    assert len(content) == 84 + 50 * count
    rows = np.frombuffer(content[84:], dtype=np.dtype([("numbers", "<f4", (4, 3)), ("rest", "<u2")]))
    corners = rows["numbers"][:, 1:].astype(float)
    signed = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    walls = (
        sum(len(part.layers) for part in plan.parts) * 2 * math.pi * plan.sizes.width * plan.sizes.thickness
    )
    assert abs(signed.sum() - sum(volumes(plan))) < 3 * TOLERANCE * walls
