"""A kind of linkage in the search: the functions that depend on its loop closure.

The loop is taken in a frame in which the ground line lies along the real axis: with r1 = 1, or of a
slider-crank, whose O4 lies there at infinity, with r3 = 1. With e4 = e^(i theta4), across what slides,
all kinds have one equation, Re(e4* (r2 e2 + r3 e3)) = const, so that all share its derivatives. For an
inverted slider-crank r3 is there the variable length from A along the rod to B.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self, TypeAlias, cast

import numpy as np

from grashof.problems import Linkage, Requirements
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.synth.loop.dyad import ClosingDyad, PlacedLoop, as_complex, as_vector, direction_of
from grashof.synth.loop.instant import Instant
from grashof.synth.loop.vector import Vector
from grashof.synth.quantities.formulas import Formulas
from grashof.synth.quantities.frame import Frame
from grashof.synth.theory.functions.output import Generators

# r2, r3, r4 (n,) of loops, and their derivatives (n, 3 lengths, 3 proportions), perhaps as a function.
Shapes: TypeAlias = tuple[tuple[FloatArray, FloatArray, FloatArray], FloatArray | Callable[[], FloatArray]]
# e3, e4 (n, N), r3 (n, N) or (n, 1), and whether the loop closes everywhere (n,).
LoopAt: TypeAlias = tuple[ComplexArray, ComplexArray, FloatArray, BoolArray]
Directions: TypeAlias = tuple[ComplexArray, ComplexArray]  # e3 and e4 (n, N)


LENGTHS = ("r1", "r2", "r3", "r4")
_ONLY: dict[type, Any] = {}  # the one instance of each kind


@dataclass(frozen=True, slots=True)
class Kind(ABC):
    """A kind of linkage; a value without fields, so that it travels to workers."""

    linkage: ClassVar[type[Linkage]]
    proportions: ClassVar[int]  # numbers that are neither place nor size
    formulas: ClassVar[Formulas]
    instant: ClassVar[type[Instant]]
    generators: ClassVar[Mapping[str, type[Generators]]]  # of functions, by the link that follows them

    def __new__(cls) -> Self:
        """The only instance, so that kinds are compared by identity, in every process."""
        if cls not in _ONLY:
            _ONLY[cls] = object.__new__(cls)
        return cast("Self", _ONLY[cls])

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), ()

    @property
    def mechanism(self) -> str:
        """Name of the kind in files."""
        return self.linkage.mechanism.word

    @abstractmethod
    def lengths(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        """Lengths of loops from free numbers (n, 3): full cranks with their margin, unless any will do."""

    def transmitting(self, proportions: FloatArray, longer_driver: BoolArray, wanted: Requirements) -> Shapes:
        """The same of full cranks that have the required transmission angle all round the turn.

        Of kinds without such lengths those of `lengths`; their angle is a limit like others.
        """
        return self.lengths(proportions, longer_driver, wanted)

    def placed(
        self, o2: ComplexArray, ground: ComplexArray, a: ComplexArray, directions: Directions, r4: FloatArray
    ) -> tuple[ComplexArray, ComplexArray]:
        """O4 (n,), and B at every target (n, N), of loops whose frame is turned and scaled by `ground`.

        Of a slider-crank, in place of O4, the point of the slide's line that lies r3 ahead of B at the first
        target. `r4` or the offset is (n,).
        """
        o4, (_, e4) = o2 + ground, directions
        return o4, o4[:, None] + (ground * r4)[:, None] * e4

    @abstractmethod
    def sine(self, d: Any, o4: ComplexArray, a: ComplexArray, b: ComplexArray) -> FloatArray:
        """Signed sin mu (n, N) of a `Many`; sets the way of its output from the first target to the last."""

    def arguments(self, points: ComplexArray) -> dict[str, Any]:
        """Arguments of its value besides coupler point, assembly and body angle, from points (..., 5).

        Places as complex numbers, all lengths in the unit of the points.
        """
        o2, o4, a, b, _ = np.moveaxis(points, -1, 0)
        found = dict(zip(LENGTHS, self.dyad.lengths_of(o2, o4, a, b), strict=True))
        found |= {"o2": o2, "o4": o4, "offset": found["r4"], "slide_angle": np.angle(direction_of(o4 - b))}
        return {row.name: found[row.name] for row in self.linkage.mechanism.parameters if row.name in found}

    def sides(self, points: ComplexArray) -> tuple[ComplexArray, tuple[Any, ...], ComplexArray]:
        """Arguments of `Instant`, from points (..., 5): ground, lengths, and P in the coupler's frame."""
        o2, o4, a, b, p = np.moveaxis(points, -1, 0)
        arm = (p - a) * np.abs(b - a) / (b - a) if self.dyad.bars else (p - a) / direction_of(b - a)
        return self.dyad.ground_of(o2, o4, b), self.dyad.lengths_of(o2, o4, a, b), arm

    def completed(
        self, pivots: Mapping[str, complex], turned: complex, found: Mapping[str, float]
    ) -> dict[str, complex]:
        """O4 and B where the programme has no unknowns for them, from the unknowns `found` and e3."""
        return {}

    @property
    def dyad(self) -> ClosingDyad:
        """Links 3 and 4."""
        return self.instant.dyad

    def closed(
        self, lengths: tuple[FloatArray, FloatArray, FloatArray], e2: ComplexArray, assembly: FloatArray
    ) -> LoopAt:
        """The loop closed at driver directions e2 (n, N), with numbers also where it is open."""
        r2, r3, r4 = (each[:, None] for each in lengths)
        loop = self.dyad.closed(Vector(1.0, 0.0), as_vector(r2 * e2), r3, r4, assembly, _root_of_any)
        e3, e4 = (as_complex(each) for each in self.dyad.directions(loop, r3, r4))
        closes: BoolArray = np.all(loop.square > 1e-12, axis=1)
        return e3, np.broadcast_to(e4, e2.shape), loop.rod, closes

    def alike(self, points: ComplexArray, *, timed: bool, body: bool) -> list[ComplexArray]:
        """Other linkages of the kind, each (5,), that lead P along the same curve, or the body as this does.

        From points (5,) at one position; `timed` leaves those in which P follows the driver as before.
        """
        return []

    def named(self, lengths: Iterable[Any], theta1: Any) -> dict[str, Any]:
        """Fields of a `Design` from r1, r2, r3, r4, or the offset there, and the ground's direction."""
        names, every = self.linkage.mechanism.lengths, dict(zip(LENGTHS, lengths, strict=True))
        found = {name: length if name in names else None for name, length in every.items()}
        offset = None if "r4" in names else every["r4"]
        slide = theta1 - np.pi / 2 if "slide_angle" in self.formulas else None
        return {
            **found, "theta1": theta1, "offset": offset, "slide_angle": slide, "mechanism": self.mechanism
        }  # fmt: skip

    def o4_of(self, linkage: Linkage, b: complex, frame: Frame) -> complex:
        """O4 in a frame, of a linkage whose B is there at the first target."""
        return complex(frame.inward(linkage.o4))

    def theta1_of(self, o2: Any, o4: Any, _b: Any) -> Any:
        """Direction of the ground line by complex numbers, or arrays of them, rad."""
        return np.angle(o4 - o2)

    def b_of(
        self, lengths: tuple[float, ...], o4: complex, a: ComplexArray, turned: ComplexArray
    ) -> ComplexArray:
        """B where A and the direction of the coupler are known, shape (...)."""
        at = PlacedLoop()
        at.o4, at.r3, at.offset = as_vector(np.asarray(o4)), *lengths[2:]
        return as_complex(self.dyad.b(at, as_vector(a), as_vector(turned)))

    def drawn(self, rng: np.random.Generator, count: int, *, anything: bool) -> FloatArray:
        """Random free numbers of `lengths`, shape (count, 3)."""
        of_cranks = rng.normal(size=(count, 3)) * (1.2, 1.5, 1.0) - (0.0, 1.0, 0.0)
        return rng.normal(0.0, 0.7, (count, 3)) if anything else of_cranks


def _root_of_any(square: FloatArray) -> FloatArray:
    """The root; 1 where the square is not positive, so that open loops have numbers, too."""
    root: FloatArray = np.sqrt(np.where(square > 0, square, 1.0))
    return root
