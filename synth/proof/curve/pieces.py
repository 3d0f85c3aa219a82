"""Pieces of the circle-point curve: tubes that hold all its points in a rectangle."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.proof.curve.curve import Curve, Taylor
from grashof.synth.proof.forms.forms import Span

WIDER = 1e-12  # share of all magnitudes by which enclosures are widened for rounding
LITTLE = 0.5  # a contraction that leaves more of the area of a wide rectangle is not worth its place
SLENDER = 0.15  # width over length of a tube that is no longer wide
_SPARE = 1e-9  # sizes by which halves are at most wider than need be: others may round more
_ROUNDS = 6
_LEAST = 1e-300  # divisor in place of zero


@dataclass(frozen=True, slots=True)
class Tubes:
    """Sets of points middle + direction (half s + i (tilt s + bow (s^2 - 1/2) + e)), |s| <= 1, |e| <= rest.

    In sizes, arrays (n,); the directions are unit numbers.
    """

    middle: ComplexArray
    direction: ComplexArray
    half: FloatArray
    tilt: FloatArray
    bow: FloatArray
    rest: FloatArray

    def __len__(self) -> int:
        return len(self.middle)

    def __getitem__(self, index: IntArray | BoolArray | slice) -> Tubes:
        return Tubes(*(getattr(self, name)[index] for name in _NAMES))

    @property
    def along(self) -> ComplexArray:
        """From the middle to s = 1, on the line without the bow."""
        along: ComplexArray = self.direction * (self.half + 1j * self.tilt)
        return along

    @property
    def bend(self) -> ComplexArray:
        """The factor of s^2 - 1/2."""
        bend: ComplexArray = 1j * self.direction * self.bow
        return bend

    @property
    def span(self) -> Span:
        """As a form of s alone."""
        return Span(self.middle, self.along[None], self.stray)

    @property
    def side(self) -> FloatArray:
        """Half the width of the rectangle along `direction` that holds the tube."""
        side: FloatArray = np.abs(self.tilt) + self.stray
        return side

    @property
    def stray(self) -> FloatArray:
        """Greatest distance of points from the line without the bow."""
        stray: FloatArray = np.abs(self.bow) / 2 + self.rest
        return stray

    @classmethod
    def rectangles(
        cls, middle: ComplexArray, direction: ComplexArray, half: FloatArray, side: FloatArray
    ) -> Tubes:
        """Plain rectangles of given half lengths and half widths."""
        nothing = np.zeros(len(middle))
        return cls(middle, direction, half, nothing, nothing, side)

    @classmethod
    def joined(cls, *parts: Tubes) -> Tubes:
        """Several as one."""
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in _NAMES))

    @classmethod
    def chosen(cls, which: BoolArray, yes: Tubes, no: Tubes) -> Tubes:
        """One or the other, entry by entry."""
        return cls(*(np.where(which, getattr(yes, name), getattr(no, name)) for name in _NAMES))

    @property
    def halves(self) -> Tubes:
        """Rectangles about the tubes for s <= 0, then those for s >= 0; of wide ones, both sides."""
        long = self.half >= self.side
        hair = WIDER * (np.abs(self.middle) + self.half + self.side) + np.minimum(16 * self.rest, _SPARE)
        step = np.where(long, self.along, 1j * self.direction * self.side) / 2
        half = np.where(long, self.half / 2, self.half) + hair
        side = np.where(long, np.abs(self.tilt) / 2 + self.stray, self.side / 2) + hair
        made = (
            Tubes.rectangles(self.middle + sign * step, self.direction, half, side) for sign in (-1.0, 1.0)
        )
        return Tubes.joined(*made)


_NAMES = tuple(each.name for each in fields(Tubes))


def misses_curve(curve: Curve, tubes: Tubes) -> BoolArray:
    """Which tubes the curve surely does not meet, shape (n,)."""
    taylor = curve.about(tubes.middle).turned(tubes.direction)
    slope = 2 * (np.abs(taylor.linear.real) * tubes.half + np.abs(taylor.linear.imag) * tubes.side)
    most = slope + taylor.beyond_linear(tubes.half, tubes.side) + taylor.error
    missed: BoolArray = np.abs(taylor.value) > most
    return missed


def contracted(curve: Curve, tubes: Tubes) -> tuple[Tubes, BoolArray]:
    """Tubes about the curve's points in some rectangles, and which of them may hold any.

    In a frame along the tangent at a point of the curve, the polynomial is g y + q x^2 and terms that are
    bounded over the rectangle: so its zeros lie within their sum, over g, of the parabola y = -(q / g) x^2.
    What leaves the rectangle is cut off. Tubes that do not become slender this way stay as they are.
    """
    filled = ~misses_curve(curve, tubes)
    for _ in range(2):
        made, some = _contracted(curve, tubes)
        filled &= some
        area = made.half * made.side
        worse = ~(area <= LITTLE * tubes.half * tubes.side) & ~(made.side <= SLENDER * made.half)
        tubes = Tubes.chosen(worse, tubes, made)
    return tubes, filled


def _contracted(curve: Curve, tubes: Tubes) -> tuple[Tubes, BoolArray]:
    p, half, side, old = tubes.middle, tubes.half, tubes.side, tubes.direction
    near = curve.onto(p)
    q = np.where(np.abs(near - p) > half + side, p, near)
    taylor = curve.about(q)
    slope = np.maximum(np.abs(taylor.linear), _LEAST)
    new = np.where(np.abs(taylor.linear) > _LEAST, -1j * taylor.linear.conj() / slope, old)
    taylor, steep = taylor.turned(new), 2 * slope
    away, turn = (p - q) * new.conj(), old * new.conj()
    hair = WIDER * (1.0 + np.abs(p) + half + side)
    x = np.abs(away.real) + half * np.abs(turn.real) + side * np.abs(turn.imag) + hair
    y = np.abs(away.imag) + half * np.abs(turn.imag) + side * np.abs(turn.real) + hair
    with np.errstate(over="ignore", invalid="ignore"):
        y = _narrowed(taylor, steep, x, y)
        low, high = _within(-(away * turn.conj()), turn, half, side, x, y, hair)
        filled: BoolArray = low <= high
        low, high = np.where(filled, low, 0.0), np.where(filled, high, 0.0)
        x = np.maximum(np.abs(low), np.abs(high))
        y = _narrowed(taylor, steep, x, y)
        parabola = -taylor.along_twice / steep
        rest = (_off_curve(taylor, x) + taylor.beyond_parabola(x, y)) / steep
        middle, length = (low + high) / 2, (high - low) / 2
        bow = parabola * length**2
        bent = np.abs(bow) / 2 + rest < y
    bow, tilt = np.where(bent, bow, 0.0), np.where(bent, 2 * parabola * middle * length, 0.0)
    shift = np.where(bent, parabola * middle**2 + bow / 2, 0.0)
    rest = np.where(bent, rest, y)
    return Tubes(q + new * (middle + 1j * shift), new, length, tilt, bow, rest + hair), filled


def _off_curve(taylor: Taylor, x: FloatArray) -> FloatArray:
    """The residual at a point that should be on the curve, with its tangent as the first axis."""
    off: FloatArray = np.abs(taylor.value) + taylor.error + 2 * np.abs(taylor.linear.real) * x
    return off


def _narrowed(taylor: Taylor, steep: FloatArray, x: FloatArray, y: FloatArray) -> FloatArray:
    """Greatest distance of the curve from the tangent where ``|x|`` and ``|y|`` are bounded."""
    off = _off_curve(taylor, x)
    for _ in range(_ROUNDS):
        y = np.minimum(y, (off + taylor.beyond_linear(x, y)) / steep)
    return y


def _within(
    start: ComplexArray, turn: ComplexArray, half: FloatArray, side: FloatArray, x: FloatArray, y: FloatArray,
    hair: FloatArray,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """Range of x for which start + conj(turn) (x + iy) is in the old rectangle for some possible y."""
    low, high = -x, x
    for part, step, spread, end in (
        (start.real, turn.real, np.abs(turn.imag) * y, half),
        (start.imag, -turn.imag, np.abs(turn.real) * y, side),
    ):
        reach = end + spread + hair
        level = np.abs(step) < WIDER
        slant = np.where(level, 1.0, step)
        ends = (-reach - part) / slant, (reach - part) / slant
        outside = np.abs(part) > reach + WIDER * x
        low = np.maximum(low, np.where(level, np.where(outside, np.inf, low), np.minimum(*ends)))
        high = np.minimum(high, np.where(level, high, np.maximum(*ends)))
    return low, high
