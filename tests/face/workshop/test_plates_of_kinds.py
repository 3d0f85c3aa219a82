"""Plates of every kind of linkage: pins in holes and slots, clearance, no collision.

The linkages are moved here by equations of the tests: lines and circles, or the bodies of their own judge.
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
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from linkages_of_rows import SIX_BARS
from random_linkages import six_bars
from refusals import refusal

from grashof.drawing.scene import bodies_of
from grashof.problems import (
    FourBar,
    InvertedSliderCrank,
    Linkage,
    ProblemError,
    SixBar,
    SliderCrank,
    load_linkage,
)
from grashof.problems.values.arrays import FloatArray
from grashof.workshop import Plan, PlateSizes, plan_parts, write_dxf

SIZES = PlateSizes(width=20, hole=6, thickness=5, clearance=1)
SCALE = 60.0  # mm per unit, of six-bars
ONE_LOOP: dict[str, Linkage] = {
    "pumpjack": load_linkage("pumpjack").scaled(50.0, np.zeros(2)),
    "drag link, P far off": FourBar((3, 4), (57, 30), 100, 110, 90, (200, 300)),
    "tiny crank, P on AB": FourBar((0, 0), (160, 10), 14, 110, 90, (250, 0)),
    "P at A": FourBar((0, 0), (100, 0), 30, 90, 80, (1, 2), -1),
    "P to the right": FourBar((0, 0), (100, 0), 30, 90, 80, (40, -60), -1),
    "double rocker": FourBar((0, 0), (400, 0), 300, 100, 300, (50, 100)),
    "triple rocker": FourBar((0, 0), (400, 0), 200, 200, 300, (100, 100)),
    "kite": FourBar((0, 0), (100, 0), 100, 150, 150, (50, 40)),
    "parallelogram": FourBar((0, 0), (100, 0), 70, 100, 70, (50, 40)),
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
Frames = dict[str, tuple[FloatArray, FloatArray]]  # origin (complex) and angle by name


def one_loop(linkage: Linkage, theta2: FloatArray) -> Frames:
    """Origin (complex) and angle of the plates, from O2, by lines and circles; NaN where they do not meet."""
    a, zero = float(linkage.r2) * np.exp(1j * theta2), np.zeros_like(theta2)
    sign, output = float(linkage.assembly), Frames()
    if isinstance(linkage, FourBar):
        o4, r3, r4 = complex(*(linkage.o4 - linkage.o2)), float(linkage.r3), float(linkage.r4)
        far = np.abs(o4 - a)
        along = (far**2 + r3**2 - r4**2) / (2 * far)
        b = a + (along + 1j * sign * np.sqrt(r3**2 - along**2)) * (o4 - a) / far
        theta3, base = np.angle(b - a), float(np.angle(o4))
        output = {"output": (zero + o4, np.angle(b - o4)), "O4": (zero + o4, zero)}
    elif isinstance(linkage, SliderCrank):
        offset = float(linkage.offset)
        turn = np.exp(1j * float(linkage.slide_angle))
        flat = a / turn
        roots = np.sqrt(float(linkage.r3) ** 2 - (offset - flat.imag) ** 2)
        b = (flat.real + sign * roots + 1j * offset) * turn
        theta3, base = np.angle(b - a), float(linkage.slide_angle)
    else:
        assert isinstance(linkage, InvertedSliderCrank)
        o4, offset = complex(*(linkage.o4 - linkage.o2)), float(linkage.offset)
        b, base = np.full(a.shape, o4), float(np.angle(o4))
        far = np.abs(o4 - a)
        theta3 = np.angle(o4 - a) + np.arctan2(offset, sign * np.sqrt(far**2 - offset**2))
    return {
        "base": (zero + 0j, zero + base),
        "driver": (zero + 0j, theta2),
        "coupler": (a, theta3),
        "O2": (zero + 0j, zero),
        "A": (a, zero),
        ("O4" if isinstance(linkage, InvertedSliderCrank) else "B"): (b, zero),
        **output,
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
    theta2 = np.radians(np.arange(1e-6, 360, 0.002))  # not where A meets O4
    with np.errstate(invalid="ignore"):
        closes = np.isfinite(one_loop(linkage, theta2)["coupler"][1])
    return one_loop(linkage, theta2[closes])


class Made(NamedTuple):
    name: str
    linkage: Linkage
    plan: Plan
    frames: Frames
    first: Frames  # in the assembly


@cache
def planned(name: str) -> Plan:
    if name in ONE_LOOP:
        return plan_parts(ONE_LOOP[name], SIZES)
    return plan_parts(TWO_LOOPS[name], SIZES, SCALE)


@pytest.fixture(scope="module", params=[*ONE_LOOP, *TWO_LOOPS])
def made(request: pytest.FixtureRequest) -> Made:
    name = request.param
    linkage, plan = (ONE_LOOP | TWO_LOOPS)[name], planned(name)
    frames = frames_of(linkage, plan)
    first = frames if name in TWO_LOOPS else one_loop(linkage, np.array([plan.theta2]))
    return Made(name, linkage, plan, frames, first)


def test_the_assembly_is_the_linkage_at_its_driver_angle(made: Made) -> None:
    plan, first = made.plan, {name: (z[0], angle[0]) for name, (z, angle) in made.first.items()}
    near, base = 1e-6 if made.name in TWO_LOOPS else 1e-9, plan.parts[0].plate
    rings = [z + np.exp(1j * turn) * complex(*hole) for z, turn in [first["base"]] for hole in base.holes]
    for name, place in plan.joints.items():
        rings.append(complex(*place))
        assert name not in first or rings[-1] == pytest.approx(first[name][0], abs=near)
    for part in plan.parts:
        for x, y, angle in part.places.tolist():
            if part.plate.name == "spacer":
                assert min(abs(complex(x, y) - ring) for ring in rings) < 1e-9
            else:
                z, turn = first[part.plate.name]
                assert complex(x, y) == pytest.approx(z, abs=near)
                assert np.exp(1j * angle) == pytest.approx(np.exp(1j * turn), abs=near)


def test_pins_stay_in_their_holes_and_slots(made: Made) -> None:
    name, linkage, plan, frames, _ = made
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
        assert sum(len(plate.slots) for plate in plates) == len(linkage.mechanism.slides)


def least_gap(plan: Plan, frames: Frames) -> float:
    """Least distance of two parts on one layer."""
    gaps = [np.inf]
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
            gaps.append(float(shapely.distance(*shapes).min()) - SIZES.width)
    return min(gaps)


def test_nothing_meets_in_motion(made: Made) -> None:
    every = 1 if isinstance(made.linkage, SixBar) else 250
    frames = {name: (origin[::every], angle[::every]) for name, (origin, angle) in made.frames.items()}
    assert least_gap(made.plan, frames) >= 0.9 * SIZES.gap


lengths = st.floats(15, 300)


@pytest.mark.study
@settings(max_examples=15)
@given(r=st.tuples(lengths, lengths, lengths, lengths), u=st.floats(-200, 300), v=st.floats(-200, 200),
       assembly=st.sampled_from([1, -1]), ground=st.floats(0, 6.28))  # fmt: skip
def test_any_four_bar_moves_freely_or_is_refused(
    r: tuple[float, ...], u: float, v: float, assembly: int, ground: float
) -> None:
    o4 = (r[0] * np.cos(ground), r[0] * np.sin(ground))
    linkage = FourBar((0, 0), o4, r[1], r[2], r[3], (u, v), assembly)
    shortest, p, q, longest = sorted(r)
    if longest > 0.999 * (shortest + p + q):
        if longest > shortest + p + q:
            with pytest.raises(ProblemError, match="cannot be assembled"):
                plan_parts(linkage, SIZES)
        return
    assume(abs(p + q - shortest - longest) > 1e-3 * longest)  # there the sweep here has no digits
    plan = plan_parts(linkage, SIZES)
    frames = frames_of(linkage, plan)
    assert least_gap(plan, {name: (z[::250], angle[::250]) for name, (z, angle) in frames.items()}) > 0


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
    plan = plan_parts(FourBar((0, 0), (100, 0), 30, 90, 80, (88, 3)), PlateSizes(hole=5))
    assert plan.parts[2].plate.joints == ("A", "B")
    said = "the coupler has no hole for P: it lies 3.606 mm from B, and holes are at least 12.5 mm apart"
    assert said in plan.notes
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
    (line,) = refusal(plan_parts, linkage, SIZES, scale).splitlines()
    assert said in line


def test_plates_that_cannot_pass_are_refused_in_one_line() -> None:
    linkage = six_bars("pins 3 4", 1, np.random.default_rng(6))[0]
    sizes = PlateSizes(width=20, hole=3, clearance=5)
    (line,) = refusal(plan_parts, linkage, sizes, 100 / float(linkage.r1)).splitlines()
    assert line.startswith("no order of the layers lets the plates of the watt-1 pass")
    assert "on one base driver and output meet at theta2 = 312.9 deg" in line
