"""Plates of six-bars: holes and slots where the pins are, room round them, and nothing that meets in motion.

The linkages are moved here by the bodies and constraints of the tests' own judge.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
import shapely
from body_coordinates import follow, start
from body_plans import plan_of
from random_linkages import six_bars
from six_bar_examples import SIX_BARS

from grashof.problems import ProblemError, SixBar
from grashof.problems.values.arrays import FloatArray
from grashof.workshop import Plan, Plate, PlateSizes, plan_parts
from grashof.workshop.link_plates import plated

SIZES = PlateSizes(width=20, hole=6, thickness=5, clearance=1)
SCALE = 60.0  # mm per unit
LEG = SixBar(
    o2=(1.599, 0.750), o4=(1.009, 0.574), r2=0.268, r3=0.590, r4=0.3206, assembly=-1, hosts=(3, 1),
    c=(1.09894712, -0.11645274), d=(1.366, 1.366), r5=0.8966, r6=0.5177,
    coupler_point=(-0.77628869, -0.44862839),
)  # fmt: skip
LINKAGES = {**SIX_BARS, "leg": LEG.scaled(4.0, np.zeros(2))}


class Moved:
    """Where the parts of a plan are over a turn, from O2 in mm: complex origins and angles."""

    def __init__(self, linkage: SixBar, plan: Plan, count: int) -> None:
        batch = linkage.stacked([linkage])
        bodies = plan_of(batch)
        theta2 = plan.theta2 + np.linspace(0, 2 * np.pi, count)
        places = follow(bodies, start(bodies, plan.theta2), plan.theta2, theta2)[:, 0].reshape(count, -1, 3)
        assert np.isfinite(places).all()
        o2 = complex(*linkage.o2)
        z, angle = (places[..., 0] + 1j * places[..., 1] - o2) * SCALE, places[..., 2]
        links = linkage.mechanism.links[1:]
        self.at = {link.name: (z[:, i], angle[:, i]) for i, link in enumerate(links)}
        still = np.zeros(count)
        base = plan.parts[0]
        self.at["base"] = still + 0j, still + base.places[0, 2]
        for link in links:  # points of the linkage by the frames of the links that carry them
            length = getattr(linkage, f"r{link.number}", None)
            here = [0j] if length is None else [0j, complex(float(length))]
            for name, point in zip(link.labels, here, strict=False):
                self.at.setdefault(name, (self.carried(link.name, point * SCALE), still))
        if "return crank" in {part.plate.name for part in plan.parts}:
            self._fix_return_crank(plan)

    def carried(self, part: str, point: complex) -> FloatArray:
        origin, angle = self.at[part]
        moved: FloatArray = origin + point * np.exp(1j * angle)
        return moved

    def _fix_return_crank(self, plan: Plan) -> None:
        """As it is in the assembly, it turns with the driver."""
        (part,) = [part for part in plan.parts if part.plate.name == "return crank"]
        origin, angle = self.at["driver"]
        x, y, turned = part.places[0]
        arm = (complex(x, y) - origin[0]) * np.exp(-1j * angle[0])
        self.at["return crank"] = origin + arm * np.exp(1j * angle), angle - angle[0] + turned


@pytest.fixture(scope="module", params=LINKAGES)
def made(request: pytest.FixtureRequest) -> tuple[SixBar, Plan]:
    linkage = LINKAGES[request.param]
    return linkage, plan_parts(linkage, SIZES, SCALE)


def test_pins_stay_in_their_holes_and_slots(made: tuple[SixBar, Plan]) -> None:
    linkage, plan = made
    moved, seen = Moved(linkage, plan, 721), dict[str, int]()
    for part in plan.parts:
        plate = part.plate
        if plate.name == "spacer":
            continue
        for joint, hole in zip(plate.joints, plate.holes, strict=True):
            seen[joint] = seen.get(joint, 0) + 1
            if not joint.startswith(("post", "P")):
                found = moved.carried(plate.name, complex(*hole))
                np.testing.assert_allclose(found, moved.at[joint][0], atol=1e-7)
        for joint, ends in plate.slots:
            seen[joint] = seen.get(joint, 0) + 1
            origin, angle = moved.at[plate.name]
            inside = (moved.at[joint][0] - origin) * np.exp(-1j * angle)
            one, other = (complex(*end) for end in ends)
            along = (inside - one) / (other - one) * abs(other - one)
            np.testing.assert_allclose(along.imag, 0, atol=1e-7)
            room = np.array([along.real.min(), abs(other - one) - along.real.max()])
            assert (room >= SIZES.gap / 2 - 1e-7).all()
            assert (room <= SIZES.gap / 2 + 1e-2).all()  # the turn is sampled here
    for pin in plan.pins:
        if not pin.name.startswith("post"):
            assert seen[pin.name] == 2 + len(pin.held), pin


def test_nothing_meets_in_motion(made: tuple[SixBar, Plan]) -> None:
    linkage, plan = made
    moved = Moved(linkage, plan, 721)
    inner = set(range(plan.layers)) - set(plan.parts[0].layers)
    for layer in inner:
        there = {
            part.plate.name: part.plate.corners
            for part in plan.parts
            if layer in part.layers and part.plate.name != "spacer"
        }
        there |= {
            pin.name: np.zeros((1, 2)) for pin in plan.pins if layer in pin.passed and pin.name in moved.at
        }
        for one, other in combinations(there, 2):
            shapes = [outlined(moved, each, there[each]) for each in (one, other)]
            assert (shapely.distance(*shapes) >= SIZES.width + 0.9 * SIZES.gap).all(), (layer, one, other)


def outlined(moved: Moved, name: str, corners: FloatArray) -> object:
    at = np.stack([moved.carried(name, complex(*corner)) for corner in corners], axis=1)
    xy = np.stack([at.real, at.imag], axis=-1)
    shape = {1: lambda x: shapely.points(x[:, 0]), 2: shapely.linestrings}
    return shape.get(len(corners), shapely.polygons)(xy)


def test_every_pin_ends_in_plates_of_its_joint(made: tuple[SixBar, Plan]) -> None:
    """Spacers where it passes a layer, a plate with a hole on all others."""
    _, plan = made
    for pin in plan.pins:
        holding = {
            layer
            for part in plan.parts
            for layer in part.layers
            if pin.name in (*part.plate.joints, *(name for name, _ in part.plate.slots))
        }
        assert {pin.low, pin.high, *pin.held} <= holding | set(plan.parts[0].layers)
        assert sorted((*pin.passed, *pin.held, pin.low, pin.high)) == [*range(pin.low, pin.high + 1)]


def test_holes_and_slots_have_material_round_them(made: tuple[SixBar, Plan]) -> None:
    linkage, plan = made
    names = {"base", "spacer", "return crank", *(link.name for link in plated(linkage.mechanism))}
    for plate in (part.plate for part in plan.parts):
        assert plate.name in names
        whole = shapely.buffer(surrounded(plate), plate.width / 2, quad_segs=64)
        cut = [shapely.points(hole) for hole in plate.holes]
        cut += [shapely.linestrings(ends) for _, ends in plate.slots]
        for shape in cut:
            assert shapely.distance(shape, whole.exterior) >= 0.999 * plate.width / 2
        for one, other in combinations(cut, 2):
            assert shapely.distance(one, other) >= SIZES.least_spacing - 1e-9


def surrounded(plate: Plate) -> object:
    return shapely.convex_hull(shapely.multipoints(plate.corners))


def test_a_driver_in_two_plates_is_pointed_out() -> None:
    """The links of both crank pins would meet it otherwise."""
    plan = plan_parts(SIX_BARS["watt-2 on the driver"], SIZES, SCALE)
    (note,) = [note for note in plan.notes if "two plates" in note]
    assert note == "the driver is in two plates: both are fixed to pin A, which turns with them"
    plates = {part.plate.name: part.plate for part in plan.parts}
    c = SIX_BARS["watt-2 on the driver"].c * SCALE
    assert plates["return crank"].joints == ("A", "C")
    assert dict(plates["return crank"].distances)["A-C"] == pytest.approx(np.hypot(c[0] - SCALE, c[1]))


def test_p_on_a_slider_has_no_hole() -> None:
    plan = plan_parts(SIX_BARS["press of a watt-2"], SIZES, SCALE)
    assert "the slider-2 is a pin and has no hole for P" in plan.notes


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"c": (4.05, 0.0)}, "C comes within 3 mm of B; for width 20"),
        ({"c": (400.0, 0.0)}, "A-C is 24000 mm, over 1000 widths"),
        ({"d": (4.1, 0.0)}, "D comes within 6 mm of O4; for width 20"),
        ({"r6": 0.1}, "r6 is 6 mm; for width 20"),
    ],
)
def test_what_cannot_be_cut_is_refused_in_one_line(changed: dict[str, object], said: str) -> None:
    linkage = SIX_BARS["stephenson-3"].changed(**changed)  # type: ignore[arg-type]
    with pytest.raises(ProblemError) as refused:
        plan_parts(linkage, SIZES, SCALE)
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
