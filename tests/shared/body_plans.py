"""The bodies of a linkage and what joins them, for the judge in `body_coordinates`.

`plan_of` alone knows the value types of the package.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]
Point = tuple[int, Any]  # a link, and u + iv in its frame


@dataclass(frozen=True)
class Plan:
    """Joints between the bodies; pins, slots and sides refer to points and angles by index."""

    bodies: tuple[int, ...]  # of each point
    at: Complexes  # (K, points), in the frame of its body
    angles: Array  # (K, angles)
    pins: tuple[tuple[str, int, int], ...]  # two points; the force is that on the first body
    slots: tuple[tuple[str, int, int, int], ...]  # a point, one of the line, the line's angle in its body
    turned: tuple[tuple[str, int, int, int], ...]  # two bodies, the angle of the first less the second's
    sides: tuple[tuple[int, int, int, int], ...]  # of the loops' assemblies, see `margins`
    signs: Array  # (K, loops)
    size: Array  # (K,), length

    @property
    def moving(self) -> int:
        """Number of moving bodies."""
        return max(self.bodies) - 1

    def taken(self, index: Any) -> Plan:
        """Some of the batch."""
        names = ("at", "angles", "signs", "size")
        return replace(self, **{name: getattr(self, name)[index] for name in names})


class _Sketch:
    """A plan in the making: what every loop is put together from."""

    def __init__(self) -> None:
        self.points: list[Point] = []
        self.angles: list[Any] = []
        self.pins: list[tuple[str, int, int]] = []
        self.slots: list[tuple[str, int, int, int]] = []
        self.turned: list[tuple[str, int, int, int]] = []
        self.sides: list[tuple[int, int, int, int]] = []
        self.signs: list[Any] = []

    def point(self, body: int, at: Any) -> int:
        self.points.append((body, at))
        return len(self.points) - 1

    def pin(self, name: str, first: Point, second: Point) -> tuple[int, int]:
        self.pins.append((name, self.point(*first), self.point(*second)))
        return self.pins[-1][1:]

    def slot(self, name: str, point: int, line: Point, angle: Any, turn: Any) -> int:
        """A point on a line, and its body at an angle to that of the line."""
        self.angles += [angle, turn]
        self.slots.append((name, point, self.point(*line), len(self.angles) - 2))
        self.turned.append((f"{name} moment", self.points[point][0], line[0], len(self.angles) - 1))
        return len(self.slots) - 1

    def rrr(self, names: str, links: tuple[int, int], tail: Point, tip: Point, m: Any, n: Any) -> None:
        (first, second), (c, e, d) = links, names.split()
        start, _ = self.pin(c, tail, (first, 0.0))
        joint, _ = self.pin(e, (first, m), (second, n))
        _, end = self.pin(d, (second, 0.0), tip)
        self.sides.append((-1, start, end, joint))

    def rrp(self, names: str, links: tuple[int, int], tail: Point, line: Point, angle: Any, m: Any) -> None:
        (first, second), (c, e) = links, names.split()
        start, _ = self.pin(c, tail, (first, 0.0))
        _, joint = self.pin(e, (first, m), (second, 0.0))
        self.sides.append(
            (self.slot("slide" if first == 3 else "slide 2", joint, line, angle, angle), start, joint, joint)
        )

    def rpr(self, tail: Point, tip: Point, offset: Any) -> None:
        start, _ = self.pin("a", tail, (3, 0.0))
        _, end = self.pin("o4", (4, 0.0), tip)
        foot = self.point(4, offset)
        self.sides.append((self.slot("slide", foot, (3, 0.0), 0.0, np.pi / 2), start, end, foot))


def plan_of(linkage: Any) -> Plan:
    """The bodies of a linkage of the package, from its public fields alone."""
    made, crank, kind = _Sketch(), (2, linkage.r2), type(linkage).__name__
    o2 = complex_of(linkage.o2)
    made.pin("o2", (2, 0.0), (1, o2))
    sizes = [linkage.r2]
    if kind == "SliderCrank":
        line = o2 + 1j * linkage.offset * np.exp(1j * np.asarray(linkage.slide_angle))
        made.rrp("a b", (3, 4), crank, (1, line), linkage.slide_angle, linkage.r3)
        sizes.append(linkage.r3)
    elif kind == "InvertedSliderCrank":
        made.rpr(crank, (1, complex_of(linkage.o4)), linkage.offset)
        sizes.append(np.abs(complex_of(linkage.o4) - o2))
    else:
        made.rrr("a b o4", (3, 4), crank, (1, complex_of(linkage.o4)), linkage.r3, linkage.r4)
        sizes += [linkage.r3, linkage.r4]
    made.signs.append(linkage.assembly)
    if kind == "SixBar":
        (i, j), c = linkage.choices["hosts"], complex_of(linkage.c)
        angle = getattr(linkage, "slide_angle_2", None)
        if angle is None:
            made.rrr("c e d", (5, 6), (i, c), (j, complex_of(linkage.d)), linkage.r5, linkage.r6)
        else:
            line = o2 + 1j * linkage.offset_2 * np.exp(1j * np.asarray(angle))
            made.rrp("c e", (5, 6), (i, c), (j, line), angle, linkage.r5)
        made.signs.append(linkage.assembly_2)
    places = [np.asarray(at) for _, at in made.points]
    batch = np.broadcast_shapes((1,), *(place.shape for place in places))
    return Plan(
        tuple(body for body, _ in made.points), _columns(places, batch), _columns(made.angles, batch),
        tuple(made.pins), tuple(made.slots), tuple(made.turned), tuple(made.sides),
        _columns(made.signs, batch), _columns(sizes, batch).sum(axis=-1),
    )  # fmt: skip


def complex_of(pair: Any) -> Any:
    """A pair (..., 2) as complex numbers."""
    pair = np.asarray(pair, dtype=float)
    return pair[..., 0] + 1j * pair[..., 1]


def _columns(values: Sequence[Any], batch: tuple[int, ...]) -> Any:
    return np.stack([np.broadcast_to(value, batch) for value in values] or [np.zeros(batch)], axis=-1)
