"""Plates of linkages with a slide and of six-bars: pins in holes and slots, clearance, no collision.

The linkages are moved here by equations of the tests: a line and a circle, or the bodies of their own judge.
"""

from __future__ import annotations

from functools import cache
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

import ezdxf
import numpy as np
import pytest
import shapely
from body_coordinates import follow, start
from body_plans import plan_of
from random_linkages import six_bars
from six_bar_examples import SIX_BARS

from grashof.drawing.scene import bodies_of
from grashof.problems import InvertedSliderCrank, Linkage, ProblemError, SixBar, SliderCrank, load_linkage
from grashof.problems.values.arrays import FloatArray
from grashof.workshop import Plan, PlateSizes, plan_parts, write_dxf

SIZES = PlateSizes(width=20, hole=6, thickness=5, clearance=1)
SCALE = 60.0  # mm per unit, of six-bars
SLIDES: dict[str, Linkage] = {
    "engine": load_linkage("engine"),
    "behind": SliderCrank((0, 0), 40, 120, -30, 2.5, (40, -60), -1),
    "driver that swings": SliderCrank((5, 5), 90, 60, 20, 0.7, (30, 30), -1),
    "shaper": load_linkage("crank-shaper"),
    "whitworth": InvertedSliderCrank((0, 0), (60, 0), 120, 20, (250, 40), -1),
    "rod that swings in ranges": InvertedSliderCrank((0, 0), (200, 0), 150, 80, (120, -150)),
}
_PLATED = (
    "stephenson-3",
    "watt-1 on driver and coupler",
    "watt-2 on the driver",
    "press of a watt-2",
)
TWO_LOOPS: dict[str, Linkage] = {name: SIX_BARS[name] for name in _PLATED}
TWO_LOOPS["leg"] = load_linkage("klann").scaled(4.0, np.zeros(2))
Frames = dict[str, tuple[FloatArray, FloatArray]]


def slid(linkage: Linkage, theta2: FloatArray) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Origin (complex) and angle of the plates, from O2, by a line and a circle."""
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


def turned(linkage: SixBar, plan: Plan, count: int) -> Frames:
    """The same of a six-bar over a turn, mm, and of its points, by its bodies and constraints."""
    bodies = plan_of(linkage.stacked([linkage]))
    theta2 = plan.theta2 + np.linspace(0, 2 * np.pi, count)
    places = follow(bodies, start(bodies, plan.theta2), plan.theta2, theta2)[:, 0].reshape(count, -1, 3)
    assert np.isfinite(places).all()
    z, angle = (places[..., 0] + 1j * places[..., 1] - complex(*linkage.o2)) * SCALE, places[..., 2]
    links, still = linkage.mechanism.links[1:], np.zeros(count)
    at: Frames = {link.name: (z[:, i], angle[:, i]) for i, link in enumerate(links)}
    at["base"] = still + 0j, still + plan.parts[0].places[0, 2]
    for link in links:  # points of the linkage by the frames of the links that carry them
        length = getattr(linkage, f"r{link.number}", None)
        here = [0j] if length is None else [0j, complex(float(length))]
        for name, point in zip(link.labels, here, strict=False):
            at.setdefault(name, (carried(at[link.name], point * SCALE), still))
    for part in plan.parts:
        if part.plate.name == "return crank":  # as it is in the assembly, it turns with the driver
            origin, angle2 = at["driver"]
            x, y, angle_here = part.places[0]
            arm = (complex(x, y) - origin[0]) * np.exp(-1j * angle2[0])
            at["return crank"] = origin + arm * np.exp(1j * angle2), angle2 - angle2[0] + angle_here
    return at


def carried(frame: tuple[FloatArray, FloatArray], point: complex) -> FloatArray:
    origin, angle = frame
    moved: FloatArray = origin + point * np.exp(1j * angle)
    return moved


def frames_of(linkage: Linkage, plan: Plan) -> Frames:
    """Of plates and pins at driver angles 0.002 deg apart; of a six-bar 720 of a turn."""
    if isinstance(linkage, SixBar):
        return turned(linkage, plan, 721)
    theta2 = np.radians(np.arange(0, 360, 0.002))
    with np.errstate(invalid="ignore"):
        closes = np.isfinite(slid(linkage, theta2)["coupler"][1])
    return slid(linkage, theta2[closes])


class Made(NamedTuple):
    name: str
    linkage: Linkage
    plan: Plan
    frames: Frames


@cache
def planned(name: str) -> Plan:
    if name in SLIDES:
        return plan_parts(SLIDES[name], SIZES)
    return plan_parts(TWO_LOOPS[name], SIZES, SCALE)


@pytest.fixture(scope="module", params=[*SLIDES, *TWO_LOOPS])
def made(request: pytest.FixtureRequest) -> Made:
    name = request.param
    linkage = SLIDES[name] if name in SLIDES else TWO_LOOPS[name]
    plan = planned(name)
    return Made(name, linkage, plan, frames_of(linkage, plan))


def test_pins_stay_in_their_holes_and_slots(made: Made) -> None:
    name, linkage, plan, frames = made
    seen = dict[str, int]()
    six = isinstance(linkage, SixBar)
    near, sampled = (1e-7, 1e-2) if six else (1e-9, 0.5 if "swings" in name else 1e-6)
    plates = [part.plate for part in plan.parts if part.plate.name != "spacer"]
    for plate in plates:
        for joint, hole in zip(plate.joints, plate.holes, strict=True):
            seen[joint] = seen.get(joint, 0) + 1
            if joint in frames and not joint.startswith("P"):
                found = carried(frames[plate.name], complex(*hole))
                np.testing.assert_allclose(found, frames[joint][0], atol=near)
            else:
                assert joint.startswith(("post", "P"))
        for joint, ends in plate.slots:
            seen[joint] = seen.get(joint, 0) + 1
            origin, angle = frames[plate.name]
            inside = (frames[joint][0] - origin) * np.exp(-1j * angle)
            one, other = (complex(*end) for end in ends)
            along = (inside - one) / (other - one) * abs(other - one)
            np.testing.assert_allclose(along.imag, 0, atol=near)
            room = np.array([along.real.min(), abs(other - one) - along.real.max()])
            # Half of the clearance at either end; beside a dead position the pin is fast.
            assert (room >= SIZES.gap / 2 - near).all()
            assert (room <= SIZES.gap / 2 + sampled).all()
    if six:
        for pin in plan.pins:
            assert pin.name.startswith("post") or seen[pin.name] == 2 + len(pin.held), pin
    else:
        assert sum(len(plate.slots) for plate in plates) == 1


def test_nothing_meets_in_motion(made: Made) -> None:
    plan, every = made.plan, 1 if isinstance(made.linkage, SixBar) else 250
    frames = {name: (origin[::every], angle[::every]) for name, (origin, angle) in made.frames.items()}
    base = set(plan.parts[0].layers)
    assert {part.plate.name for part in plan.parts if base & set(part.layers)} <= {"base", "spacer"}
    for layer in set(range(plan.layers)) - base:
        there = {
            part.plate.name: part.plate.corners
            for part in plan.parts
            if layer in part.layers and part.plate.name != "spacer"
        }
        there |= {
            pin.name: np.zeros((1, 2)) for pin in plan.pins if layer in pin.passed and pin.name in frames
        }
        for one, other in combinations(there, 2):
            shapes = [outlined(frames[each], there[each]) for each in (one, other)]
            assert (shapely.distance(*shapes) >= SIZES.width + 0.9 * SIZES.gap).all(), (layer, one, other)


def outlined(frame: tuple[FloatArray, FloatArray], corners: FloatArray) -> object:
    at = np.stack([carried(frame, complex(*corner)) for corner in corners], axis=1)
    xy = np.stack([at.real, at.imag], axis=-1)
    shape = {1: lambda x: shapely.points(x[:, 0]), 2: shapely.linestrings}
    return shape.get(len(corners), shapely.polygons)(xy)


def test_every_pin_ends_in_plates_of_its_joint(made: Made) -> None:
    """Spacers where it passes a layer, a plate with a hole on all others."""
    plan = made.plan
    for pin in plan.pins:
        holding = {
            layer
            for part in plan.parts
            for layer in part.layers
            if pin.name in (*part.plate.joints, *(name for name, _ in part.plate.slots))
        }
        assert {pin.low, pin.high, *pin.held} <= holding | set(plan.parts[0].layers)
        assert sorted((*pin.passed, *pin.held, pin.low, pin.high)) == [*range(pin.low, pin.high + 1)]


def test_holes_and_slots_have_material_round_them(made: Made) -> None:
    plan = made.plan
    plated = (body.link.name for body in bodies_of(made.linkage.mechanism) if not body.slides)
    names = {"base", "spacer", "return crank", *plated}
    for plate in (part.plate for part in plan.parts):
        assert plate.name in names
        core = shapely.convex_hull(shapely.multipoints(plate.corners))
        outline = shapely.buffer(core, plate.width / 2, quad_segs=64)
        cut = [shapely.points(hole) for hole in plate.holes]
        cut += [shapely.linestrings(ends) for _, ends in plate.slots]
        for shape in cut:
            assert shapely.distance(shape, outline.exterior) >= 0.999 * plate.width / 2
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


def test_a_driver_in_two_plates_is_pointed_out() -> None:
    """Otherwise the links of both crank pins would meet it."""
    plan = planned("watt-2 on the driver")
    (note,) = [note for note in plan.notes if "two plates" in note]
    assert note == "the driver is in two plates: both are fixed to pin A, which turns with them"
    plates = {part.plate.name: part.plate for part in plan.parts}
    c = SIX_BARS["watt-2 on the driver"].c * SCALE
    assert plates["return crank"].joints == ("A", "C")
    assert dict(plates["return crank"].distances)["A-C"] == pytest.approx(np.hypot(c[0] - SCALE, c[1]))


def test_a_missing_hole_for_p_is_noted() -> None:
    plan = plan_parts(InvertedSliderCrank((0, 0), (200, 0), 50, 0, (145, 5)), SIZES)
    assert any("the coupler has no hole for P" in note for note in plan.notes)
    plan = planned("press of a watt-2")
    assert "the slider-2 is a pin and has no hole for P" in plan.notes


STEPHENSON = SIX_BARS["stephenson-3"]


@pytest.mark.parametrize(
    ("linkage", "scale", "said"),
    [
        (SliderCrank((0, 0), 40, 45), 1.0, "O2 comes within 4.5 mm of the slot of B"),
        (InvertedSliderCrank((0, 0), (50, 0), 40), 1.0, "A comes within 9.5 mm of the slot of O4"),
        (SliderCrank((0, 0), 5, 45), 1.0, "r2 is 5 mm; for width 20"),
        (SliderCrank((0, 0), 40, 4.5e5), 1.0, "r3 is 450000 mm, over 1000 widths"),
        (STEPHENSON.changed(c=(4.05, 0.0)), SCALE, "C comes within 3 mm of B; for width 20"),
        (STEPHENSON.changed(c=(400.0, 0.0)), SCALE, "A-C is 24000 mm, over 1000 widths"),
        (STEPHENSON.changed(d=(4.1, 0.0)), SCALE, "D comes within 6 mm of O4; for width 20"),
        (STEPHENSON.changed(r6=0.1), SCALE, "r6 is 6 mm; for width 20"),
    ],
)
def test_parts_that_cannot_be_cut_are_refused_in_one_line(linkage: Linkage, scale: float, said: str) -> None:
    with pytest.raises(ProblemError) as refused:
        plan_parts(linkage, SIZES, scale)
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


def test_plates_that_cannot_pass_are_refused_in_one_line() -> None:
    linkage = six_bars("pins 3 4", 1, np.random.default_rng(6))[0]
    sizes = PlateSizes(width=20, hole=3, clearance=5)
    with pytest.raises(
        ProblemError, match="no order of the layers lets the plates of the watt-1 pass"
    ) as refused:
        plan_parts(linkage, sizes, 100 / float(linkage.r1))
    assert "on one base driver and output meet at theta2 = 312.9 deg" in str(refused.value)
    assert "\n" not in str(refused.value)
