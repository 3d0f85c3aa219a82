"""The layer of each plate, so that no plate or pin hits another one while the linkage moves.

The base is layer 0. A pin joins two plates and passes all layers between, on each of them inside a spacer as
wide as a link's end, which blocks every other part. Links that share a pin lie on different layers, which
leaves eight orders of a four-bar on one base. Empty layers would only make pins longer.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import combinations, product
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt
import shapely

from grashof.analysis import driver_ranges, full_rotation, solve_position
from grashof.analysis.mechanism.mobility import range_index
from grashof.analysis.mechanism.position import places
from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.workshop.link_plates import base_angle
from grashof.workshop.plates import Plate, PlateSizes, bar, plate_of

GeometryArray: TypeAlias = npt.NDArray[np.object_]
_SAMPLES = 721
GROUND, DRIVER, RETURN_CRANK = "ground", "driver", "return crank"
_SHORTEST_STEP = 1e-9  # rad; a step across the jump at a change point is never short enough


def pinned(kind: Mechanism) -> dict[str, tuple[str, ...]]:
    """The plates on each pin, with the base for links without one; the pin of a slide runs in a slot.

    >>> from grashof.problems import SliderCrank
    >>> pinned(SliderCrank.mechanism)
    {'O2': ('ground', 'driver'), 'A': ('driver', 'coupler'), 'B': ('coupler', 'ground')}
    """
    beside = {other: one for one, other in kind.slides}
    return {
        joint.upper(): tuple(kind.links[beside.get(number, number) - 1].name for number in numbers)
        for joint, numbers in kind.joints.items()
    }


@dataclass(frozen=True, slots=True)
class Pin:
    """A pin through the layers `low` to `high`, both in plates with a hole for it, as are those `held`."""

    name: str
    low: int
    high: int
    held: tuple[int, ...] = field(default=(), repr=False)

    @property
    def title(self) -> str:
        """Its name in the parts list: of a joint after "pin"."""
        return self.name if self.name.startswith("post") else f"pin {self.name}"

    @property
    def passed(self) -> tuple[int, ...]:
        """Layers between, where it runs in spacers."""
        return tuple(layer for layer in range(self.low + 1, self.high) if layer not in self.held)


class ReturnCrank(NamedTuple):
    """A driver in two plates on `pin`; its return crank, `turned` (rad), carries `far`."""

    pin: str
    far: str
    turned: float
    plates: dict[str, Plate]

    def pinned(self, joints: Mapping[str, tuple[str, ...]]) -> dict[str, tuple[str, ...]]:
        """The plates on each pin then."""
        found = dict(joints)
        found[self.pin] = (*joints[self.pin], RETURN_CRANK)
        found[self.far] = tuple(RETURN_CRANK if part == DRIVER else part for part in joints[self.far])
        return found

    def placed(self, places: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
        """The places of links and pins, with that of the return crank."""
        angle = places[DRIVER][:, 2] + self.turned
        return {**places, RETURN_CRANK: np.column_stack([places[self.pin][:, :2], angle])}


@dataclass(frozen=True, slots=True)
class Stack:
    """Layers of the links that are plates, the base on 0, the pins of the joints and between two bases.

    `posts` are the places of the posts of a second base, mm along the base from O2; `met` names two parts too
    close, and where, for each order tried before on one base; `crank` divides the driver.
    """

    layers: Mapping[str, int]
    pins: tuple[Pin, ...]
    posts: tuple[float, ...] = ()
    met: tuple[str, ...] = ()
    crank: ReturnCrank | None = None

    @property
    def bases(self) -> tuple[int, ...]:
        """Layers of the bases."""
        return (0, max(self.layers.values()) + 1) if self.posts else (0,)


@dataclass(frozen=True, slots=True)
class Motion:
    """A linkage at `theta2` (n,), rad; `places` of the plates of links and pins (n, 3), mm, mm and rad."""

    theta2: FloatArray
    places: Mapping[str, FloatArray]


def ranges_of_use(
    linkage: Linkage, within: tuple[float, float] | None = None, at: float | None = None
) -> tuple[tuple[float, float], ...]:
    """Driver angles, rad, of the plates' motion: `within`, or a full turn, or all between dead positions.

    Of two ranges between dead positions only the one with the angle `at` counts, if it is given. ProblemError
    where the linkage cannot be assembled on `within`, or at all.
    """
    ends = driver_ranges(linkage)
    every = tuple((float(low), float(high)) for low, high in ends if np.isfinite(low))
    if not every:
        raise ProblemError("the linkage cannot be assembled at any driver angle; change its lengths")
    if within is None:
        number = -1 if at is None else int(range_index(linkage, at)[0])
        return every if number < 0 else (every[number],)
    low, high = within
    index, inside = range_index(linkage, low)
    room, wanted = 2 * np.pi, "at most a turn"
    if not full_rotation(linkage):
        room = every[int(index)][1] - float(inside) if index >= 0 else 0.0
        wanted = "within " + " or ".join(f"{a:.6g} to {b:.6g} deg" for a, b in np.degrees(every))
    if not 0 < high - low <= room + 1e-9:
        given = f"{np.degrees(low):.6g} to {np.degrees(high):.6g}"
        raise ProblemError(f"theta2 is {given} deg; it must be {wanted}, the lesser first")
    return ((low, high),)


def sweep(linkage: Linkage, ranges: tuple[tuple[float, float], ...], step: float) -> Motion:
    """One linkage, mm, at angles of `ranges`, rad, between which no joint moves farther than `step`, mm."""
    # Denser towards the ends, where at a dead position links move fast relative to their driver.
    share = (1 - np.cos(np.linspace(0, np.pi, _SAMPLES))) / 2
    theta2 = np.concatenate([_fine(linkage, low + (high - low) * share, step) for low, high in ranges])
    return Motion(theta2, poses(linkage, theta2))


def poses(linkage: Linkage, theta2: FloatArray) -> dict[str, FloatArray]:
    """Origin (mm) and angle (rad) of each link's plate, and of each pin, shape (n, 3)."""
    state = solve_position(linkage, theta2)
    points, still = places(linkage, state), np.zeros_like(theta2)
    placed = {
        link.name: (link.points[0], getattr(state, f"theta{link.number}"))
        for link in linkage.mechanism.links[1:]
    }
    placed |= {joint.upper(): (joint, still) for joint in linkage.mechanism.joints}
    return {name: np.column_stack([points[at], angle]) for name, (at, angle) in placed.items()}


def placed(points: FloatArray, place: FloatArray) -> FloatArray:
    """Points (m, 2) of a plate where the plate is, shape (..., m, 2), for places (..., 3)."""
    cos, sin = np.cos(place[..., 2])[..., None], np.sin(place[..., 2])[..., None]
    x, y = points[:, 0], points[:, 1]
    moved = np.stack([cos * x - sin * y, sin * x + cos * y], axis=-1)
    result: FloatArray = moved + place[..., None, :2]
    return result


def stack(plates: Mapping[str, Plate], linkage: Linkage, motion: Motion, sizes: PlateSizes) -> Stack:
    """The least number of layers on which nothing meets, lengths in mm; ProblemError if no order is free.

    The motion has steps of at most the clearance, so that no collision falls between two of them. Where no
    order on one base is free, a second base, joined by posts outside the reach of the links, carries some of
    the ground pivots from the other side; where that does not help, the driver has a return crank.
    """
    joints, met = pinned(linkage.mechanism), dict[str, None]()
    tried = _Bench(plates, joints, motion, sizes)
    if (found := tried.free(linkage, met)) is not None:
        return found
    for crank in return_cranks(plates, sizes):
        moving = Motion(motion.theta2, crank.placed(motion.places))
        found = _Bench(crank.plates, crank.pinned(joints), moving, sizes).free(linkage, {})
        if found is not None:
            return replace(found, met=tuple(met), crank=crank)
    raise ProblemError(
        f"no order of the layers lets the plates of the {linkage.mechanism.word} pass each other; on one "
        f"base {next(iter(met))}"
    )


def return_cranks(plates: Mapping[str, Plate], sizes: PlateSizes) -> Iterator[ReturnCrank]:
    """The two ways to divide a driver that has two crank pins, A and C; none of others."""
    driver = plates[DRIVER]
    if not {"A", "C"} <= {*driver.joints}:
        return
    for pin, far in (("A", "C"), ("C", "A")):
        holes = dict(zip(driver.joints, driver.holes, strict=True))
        x, y = holes.pop(far) - holes[pin]
        crank = bar(RETURN_CRANK, (pin, far), (0.0, float(np.hypot(x, y))), sizes)
        divided = {DRIVER: plate_of(DRIVER, holes, sizes), RETURN_CRANK: crank}
        yield ReturnCrank(pin, far, float(np.arctan2(y, x)), {**plates, **divided})


class _Bench:
    """Parts whose orders are tried: plates, the plates on each pin, and their motion."""

    def __init__(
        self,
        plates: Mapping[str, Plate],
        joints: Mapping[str, tuple[str, ...]],
        motion: Motion,
        sizes: PlateSizes,
    ) -> None:
        self.plates, self.joints, self.motion, self.sizes = plates, joints, motion, sizes
        self.cores, self.gap = cache(self._cores), cache(self._gap)

    def free(self, linkage: Linkage, met: dict[str, None]) -> Stack | None:
        """The first order in which nothing meets, on one base or two; `met` gets pairs that meet on one."""
        layings = _layings(tuple(self.plates), self.joints)
        for order in _orders(layings, self.joints, [()]):
            if (pair := self._meeting(order)) is None:
                return Stack(*order, met=tuple(met))
            met[self._words(*pair)] = None
        pivots = [name for name, parts in self.joints.items() if GROUND in parts]
        above = [some for count in range(1, len(pivots)) for some in combinations(pivots, count)]
        orders = _orders(layings, self.joints, above)
        found = next((order for order in orders if self._meeting(order) is None), None)
        if found is None:
            return None
        posts, top = _posts(self.plates, linkage, self.motion, self.sizes), max(found.layers.values()) + 1
        pins = (*found.pins, *(Pin(f"post {i}", 0, top) for i in range(1, len(posts) + 1)))
        return Stack(found.layers, pins, posts, tuple(met))

    def _meeting(self, order: Order) -> tuple[str, str] | None:
        """The first two parts that come too close, if any do."""
        return next((pair for pair in _passing(order) if self.gap(*pair)[0] < self.sizes.gap), None)

    def _gap(self, one: str, other: str) -> tuple[float, float]:
        """Least gap between two parts over the motion, and the driver angle there."""
        gaps = shapely.distance(self.cores(one), self.cores(other)) - self.sizes.width
        worst = int(np.argmin(gaps))
        return float(gaps[worst]), float(self.motion.theta2[worst])

    def _cores(self, name: str) -> GeometryArray:
        """The core of a part, half a width inside its outline, at every angle: geometries, shape (n,)."""
        corners = self.plates[name].corners if name in self.plates else np.zeros((1, 2))
        at = placed(corners, self.motion.places[name])
        if len(corners) == 1:
            return np.asarray(shapely.points(at[:, 0]))
        return np.asarray(shapely.linestrings(at) if len(corners) == 2 else shapely.polygons(at))

    def _words(self, one: str, other: str) -> str:
        gap, theta2 = self.gap(one, other)
        one, other = (name if name in self.plates else f"pin {name}" for name in (one, other))
        how = "meet" if gap <= 0 else f"come within {gap:.2g} mm"
        return f"{one} and {other} {how} at theta2 = {round(np.degrees(theta2), 1) % 360:.1f} deg"


class Order(NamedTuple):
    """Layers of the links, and the pins that follow from them."""

    layers: dict[str, int]
    pins: tuple[Pin, ...]


def _layings(links: tuple[str, ...], joints: Mapping[str, tuple[str, ...]]) -> list[dict[str, int]]:
    """The ways to lay the links in layers, none of them empty, and no pin joins two links on one."""
    levels = range(1, len(links) + 1)
    places = [[links.index(part) for part in parts if part in links] for parts in joints.values()]
    pairs = [pair for each in places for pair in combinations(each, 2)]
    return [
        dict(zip(links, each, strict=True))
        for each in product(levels, repeat=len(links))
        if all(each[one] != each[other] for one, other in pairs) and len(set(each)) == max(each)
    ]


def _orders(
    layings: Sequence[dict[str, int]],
    joints: Mapping[str, tuple[str, ...]],
    above: Sequence[tuple[str, ...]],
) -> list[Order]:
    """Layings with their pins: fewest layers first, fewest spacers, the driver lowest.

    `above` has the choices of ground pivots that a second base carries.
    """

    def cost(order: Order) -> tuple[int, int, int]:
        spacers = sum(pin.high - pin.low - 1 - len(pin.held) for pin in order.pins)
        return max(order.layers.values()), spacers, order.layers["driver"]

    return sorted((Order(each, _pins(joints, each, some)) for each in layings for some in above), key=cost)


def _pins(
    joints: Mapping[str, tuple[str, ...]], layers: Mapping[str, int], above: tuple[str, ...]
) -> tuple[Pin, ...]:
    """The pins, those of the pivots `above` from the base over all layers."""
    top, pins = max(layers.values()) + 1, list[Pin]()
    for name, parts in joints.items():
        low, *held, high = sorted(layers.get(part, top if name in above else 0) for part in parts)
        pins.append(Pin(name, low, high, tuple(held)))
    return tuple(pins)


def _passing(order: Order) -> Iterator[tuple[str, str]]:
    """Pairs of parts that are on the same layer somewhere."""
    layers, pins = order
    for layer in range(1, max(layers.values()) + 1):
        there = [name for name in layers if layers[name] == layer]
        there += [pin.name for pin in pins if layer in pin.passed]
        yield from combinations(there, 2)


def _posts(
    plates: Mapping[str, Plate], linkage: Linkage, motion: Motion, sizes: PlateSizes
) -> tuple[float, float]:
    """Positions along the base from O2 that no link reaches."""
    angle = base_angle(linkage)
    along = np.array([np.cos(angle), np.sin(angle)])
    corners = (placed(plate.corners, motion.places[name]) for name, plate in plates.items())
    reached = np.concatenate([((at - linkage.o2) @ along).ravel() for at in corners])
    apart = sizes.width + 2 * sizes.gap
    return float(reached.min() - apart), float(reached.max() + apart)


def _fine(linkage: Linkage, theta2: FloatArray, step: float) -> FloatArray:
    """Driver angles with others between them, until no point makes a longer step."""
    while True:
        points = np.stack(list(places(linkage, solve_position(linkage, theta2)).values()), axis=1)
        moved = np.diff(points, axis=0)  # NaN, and so never too long, beside a place where the loop is open
        too_far = np.hypot(moved[..., 0], moved[..., 1]).max(axis=1) > step
        long = np.flatnonzero(too_far & (np.diff(theta2) > _SHORTEST_STEP))
        if not long.size:
            return theta2[np.isfinite(points).all(axis=(1, 2))]
        theta2 = np.insert(theta2, long + 1, (theta2[long] + theta2[long + 1]) / 2)
