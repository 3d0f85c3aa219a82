"""Dyads: how two links close the gap between two others, and how they move.

A dyad closes the gap w from C to D. It has two unknowns q and two equations gap(q) = w, with the matrix J of
the derivatives of the gap: J dq = dw, and so on. The determinant of J over its size is the margin, the sine
of the transmission angle with the sign of the assembly. The links are called 3 and 4 here; those of a second
dyad are 5 and 6. Each kind has the same methods:

- `close`: the dyad for a gap (x, y); `travel`: that of its slide.
- `facing`: two directions, along which vectors are resolved.
- `solve`: J^-1 of a vector times `scale`, with `inverse` = `scale` over the margin. A scale of 1 gives rates,
  the margin as scale keeps them finite in dead positions.
- `rates`: three derivatives of q from those of the gap.
- `growth`: infinite accelerations and jerks of a dead position, signed as the term that grows fastest.
- `force`: J^T f = demands. The force on link 3 by link 4 in E, and the moment of a slide on link 4 about E.
- `sizes`: derivatives of the gap by its lengths, with the sign reversed.
- `width`: the measure of the gap that decides closure; `limits`: its least and greatest values for a
  transmission angle whose cosine does not exceed a given size.
- `transmission_at`: the transmission angle in [0, pi] at a width; NaN where the dyad is open.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import DyadKind

EPS = float(np.finfo(np.float64).eps)
ROUNDING = 8 * EPS  # share of lengths
Vector: TypeAlias = tuple[FloatArray, FloatArray]
_NONE = np.zeros(())


class Closed(NamedTuple):
    """A closed dyad, each of shape (...); NaN, except the reach, where the dyad is open.

    Directions of links 3 and 4 (of a slider across its slide, to its left); the margin, which keeps its
    digits near a dead position; the length from C along link 3 to E.
    """

    cos3: FloatArray
    sin3: FloatArray
    cos4: FloatArray
    sin4: FloatArray
    margin: FloatArray
    reach: FloatArray

    @property
    def angles(self) -> Vector:
        """Directions of links 3 and 4 in [-pi, pi], rad."""
        return np.arctan2(self.sin3, self.cos3), np.arctan2(self.sin4, self.cos4)


class Solved(NamedTuple):
    """Solution of J q = vector: turns of links 3 and 4, and the travel of a slide, each of shape (...)."""

    turn3: FloatArray
    turn4: FloatArray
    travel: FloatArray


class Demands(NamedTuple):
    """Moments on link 3 about C, less that of joint C, and on link 4 about D (a slider: E); force on link 4.

    Last the actions of joints E and D on link 4: the moment of a pin, the friction along a slide.
    """

    turn3: FloatArray
    turn4: FloatArray
    force4: Vector
    in_e: FloatArray
    in_d: FloatArray


class Pins(NamedTuple):
    """RRR: bars m from C to E, n from D to E; gap m e3 - n e4. The margin is sin(theta4 - theta3)."""

    m: FloatArray
    n: FloatArray
    sign: FloatArray
    rounding: FloatArray

    def close(self, x: FloatArray, y: FloatArray) -> Closed:  # closure: RRR
        """E is an intersection of the circles about C and D (Norton, *Design of Machinery*, sec. 4.5).

        Heron's product gives its distance from C-D: m^2 - x^2 loses digits near dead positions.
        """
        m, n, sign, rounding = self
        square = x * x + y * y
        product = ((m + n) ** 2 - square) * (square - (m - n) ** 2)
        if np.any(product < 0):
            apart = np.sqrt(square)
            past = np.abs(apart - np.clip(apart, np.abs(m - n), m + n))
            product = np.where((product < 0) & (past <= rounding), 0.0, product)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            half = 0.5 / square
            root = sign * np.sqrt(product)
            along, beside = 0.5 + (m - n) * (m + n) * half, root * half
            x3, y3 = along * x - beside * y, along * y + beside * x
            return Closed(x3 / m, y3 / m, (x3 - x) / n, (y3 - y) / n, root / (2 * m * n), m)

    def travel(self, closed: Closed, x: FloatArray, y: FloatArray) -> FloatArray:  # noqa: ARG002
        """NaN: pins have no slide."""
        return np.full(np.shape(closed.margin), np.nan)

    def facing(self, closed: Closed) -> tuple[Vector, Vector]:
        """Directions e4, along which only link 3 counts, and e3, along which only link 4 does."""
        return (closed.cos4, closed.sin4), (closed.cos3, closed.sin3)

    def solve(self, closed: Closed, at: Vector, inverse: FloatArray, scale: FloatArray | float) -> Solved:  # noqa: ARG002
        """Norton, *Design of Machinery*, sec. 6.7."""
        return Solved(at[0] * inverse / self.m, at[1] * inverse / self.n, _NONE)

    def rates(self, closed: Closed, inverse: FloatArray, *gap: Vector) -> tuple[Solved, Solved, Solved]:
        """The second derivative of the gap is J q" - v3^2 m e3 + v4^2 n e4 (Norton, sec. 7.3).

        In the third one 3 v a takes the place of v^2, with third derivatives of angles less the cubes of v.
        """
        over3, over4 = inverse / self.m, inverse / self.n
        cosine = closed.cos4 * closed.cos3 + closed.sin4 * closed.sin3
        (to3, to4), (to3_2, to4_2), (to3_3, to4_3) = gap
        omega3, omega4 = to3 * over3, to4 * over4
        tip3, tip4 = self.m * omega3, self.n * omega4
        pull3, pull4 = tip3 * omega3, tip4 * omega4
        alpha3 = (to3_2 + pull3 * cosine - pull4) * over3
        alpha4 = (to4_2 + pull3 - pull4 * cosine) * over4
        pull3, pull4 = 3 * tip3 * alpha3, 3 * tip4 * alpha4
        jerk3 = (to3_3 + pull3 * cosine - pull4) * over3 + omega3 * omega3 * omega3
        jerk4 = (to4_3 + pull3 - pull4 * cosine) * over4 + omega4 * omega4 * omega4
        return Solved(omega3, omega4, _NONE), Solved(alpha3, alpha4, _NONE), Solved(jerk3, jerk4, _NONE)

    def growth(self, closed: Closed, first: Solved) -> tuple[Solved, Solved]:
        """With margin s, omega grows like 1/s, alpha like 1/s^3, the jerk like -3 s'/s^4.

        `same` is cos(theta4 - theta3) = +-1.
        """
        m, n, sign, _ = self
        same = np.sign(closed.cos4 * closed.cos3 + closed.sin4 * closed.sin3)
        bend3, bend4 = same / m - 1 / n, 1 / m - same / n
        size3, size4 = np.abs(first.turn3), np.abs(first.turn4)
        # m omega3 and n omega4 agree up to `same`; their difference decides the sign of s'.
        closing = same * np.sign(first.turn4) * (1 / n - same / m)
        second = Solved(sign * bend3 * size3, sign * bend4 * size4, _NONE)
        return second, Solved(-bend3 * closing * size3, -bend4 * closing * size4, _NONE)

    def force(self, closed: Closed, demands: Demands) -> tuple[Vector, FloatArray]:
        """Moments of link 3 about C and of link 4 about D (Norton, *Design of Machinery*, sec. 11.4)."""
        turn3, turn4, _, in_e, in_d = demands
        along3 = (turn4 - in_e - in_d) / (self.n * closed.margin)
        along4 = (turn3 + in_e) / (self.m * closed.margin)
        x, y = along3 * closed.cos3 + along4 * closed.cos4, along3 * closed.sin3 + along4 * closed.sin4
        return (x, y), np.full(np.shape(x), np.nan)

    def sizes(self, closed: Closed) -> dict[str, Vector]:
        """Derivatives by m and n, reversed: -e3 and e4."""
        return {"m": (-closed.cos3, -closed.sin3), "n": (closed.cos4, closed.sin4)}

    def width(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Distance of C from D."""
        return np.hypot(x, y)

    def limits(self, cosine: float = 1.0) -> Vector:
        """Third sides of triangles C-E-D."""
        bent = 2 * self.m * self.n * (1 - cosine)
        return np.sqrt((self.m - self.n) ** 2 + bent), np.sqrt((self.m + self.n) ** 2 - bent)

    def transmission_at(self, apart: FloatArray) -> FloatArray:
        """Law of cosines in C-E-D in its half-angle form, which keeps its digits near 0 and pi."""
        least, most = np.abs(self.m - self.n), self.m + self.n
        rounding = ROUNDING * (apart + most)
        with np.errstate(invalid="ignore"):
            near, far = _from_zero(apart - least, rounding), _from_zero(most - apart, rounding)
            return 2 * np.arctan2(np.sqrt(near * (apart + least)), np.sqrt(far * (most + apart)))


class Slider(NamedTuple):
    """RRP: a bar m from C to E, which slides along e at an offset from D.

    Gap m e3 - (s + i offset) e, margin cos(theta3 - slide).
    """

    m: FloatArray
    offset: FloatArray
    ex: FloatArray
    ey: FloatArray
    sign: FloatArray
    rounding: FloatArray

    def close(self, x: FloatArray, y: FloatArray) -> Closed:  # closure: RRP
        """With h from C to the slide, to its left, m sin(theta3 - slide) = h (Norton, sec. 4.6).

        The cosine comes from the product (m - h)(m + h), which keeps its digits near the dead positions.
        """
        m, _, ex, ey, sign, rounding = self
        h = self.width(x, y)
        product = (m - h) * (m + h)
        if np.any(product < 0):
            past = np.abs(h) - m
            product = np.where((product < 0) & (past <= rounding), 0.0, product)
        with np.errstate(invalid="ignore"):
            margin = sign * np.sqrt(product) / m
            beside = np.where(np.isnan(margin), np.nan, h / m)
            cos3, sin3 = margin * ex - beside * ey, margin * ey + beside * ex
            open_ = np.isnan(margin)
            return Closed(cos3, sin3, np.where(open_, np.nan, -ey), np.where(open_, np.nan, ex), margin, m)

    def travel(self, closed: Closed, x: FloatArray, y: FloatArray) -> FloatArray:
        """Distance of E along the slide from the foot of D."""
        return np.asarray(self.m * closed.margin - (x * self.ex + y * self.ey))

    def facing(self, closed: Closed) -> tuple[Vector, Vector]:  # noqa: ARG002
        """Across the slide, to its left, and along it."""
        return (-self.ey, self.ex), (self.ex, self.ey)

    def solve(self, closed: Closed, at: Vector, inverse: FloatArray, scale: FloatArray | float) -> Solved:
        """The component across the slide leaves the turn of the bar."""
        turn = at[0] * inverse / self.m
        return Solved(turn, self._still(closed), -at[1] * scale - self.m * self._sine(closed) * turn)

    def rates(self, closed: Closed, inverse: FloatArray, *gap: Vector) -> tuple[Solved, Solved, Solved]:
        """The second derivative of the gap is J q" - v^2 m e3, the third has -3 v a m e3."""
        m, over, cosine, still = self.m, inverse / self.m, closed.margin, self._still(closed)
        rise = m * self._sine(closed)
        (across, along), (across_2, along_2), (across_3, along_3) = gap
        omega = across * over
        square = omega * omega
        alpha = (across_2 + rise * square) * over
        mixed = 3 * omega * alpha
        turn = (across_3 + rise * mixed) * over
        return (
            Solved(omega, still, -along - rise * omega),
            Solved(alpha, still, -along_2 - rise * alpha - m * cosine * square),
            Solved(turn + square * omega, still, -along_3 - rise * turn - m * cosine * mixed),
        )

    def growth(self, closed: Closed, first: Solved) -> tuple[Solved, Solved]:
        """With margin c and S = sin(theta3 - slide) = +-1: omega is like 1/c, alpha S/c^3, the jerk 3/c^5.

        Those of the slider grow like -S/c, -1/c^3 and -3 S/c^5.
        """
        size, side = np.abs(first.turn3), np.sign(self._sine(closed))
        second = Solved(self.sign * side * size, first.turn4, -self.sign * size)
        return second, Solved(first.turn3, first.turn4, -side * first.turn3)

    def force(self, closed: Closed, demands: Demands) -> tuple[Vector, FloatArray]:
        """Moments of the bar about C, and forces on the slider along its slide (Norton, sec. 11.5)."""
        turn3, turn4, (x, y), in_e, in_d = demands
        pull = in_d - (x * self.ex + y * self.ey)
        across = ((turn3 + in_e) / self.m + pull * self._sine(closed)) / closed.margin
        return (pull * self.ex - across * self.ey, pull * self.ey + across * self.ex), turn4 - in_e

    def sizes(self, closed: Closed) -> dict[str, Vector]:
        """Derivatives by m and the offset, reversed: -e3 and i e."""
        return {"m": (-closed.cos3, -closed.sin3), "offset": (-self.ey, self.ex)}

    def width(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Distance from C to the slide, positive to its left."""
        return np.asarray(self.offset + (y * self.ex - x * self.ey))

    def limits(self, cosine: float = 1.0) -> Vector:
        """The bar's length to either side."""
        return -self.m * cosine, self.m * cosine

    def transmission_at(self, apart: FloatArray) -> FloatArray:
        """Between the bar and the normal of the slide to its left, where D would be at infinity."""
        rounding = ROUNDING * (np.abs(apart) + self.m)
        with np.errstate(invalid="ignore"):
            near, far = _from_zero(self.m + apart, rounding), _from_zero(self.m - apart, rounding)
            return 2 * np.arctan2(np.sqrt(near), np.sqrt(far))

    def _still(self, closed: Closed) -> FloatArray:
        """The turn of a slider: 0, NaN where the dyad is open."""
        return np.where(np.isnan(closed.margin), np.nan, 0.0)

    def _sine(self, closed: Closed) -> FloatArray:
        """Sine of theta3 - slide."""
        return np.asarray(closed.sin3 * self.ex - closed.cos3 * self.ey)


class Block(NamedTuple):
    """RPR: a rod from C through a block pinned in D, at an offset; E is the foot of D on the rod.

    Gap (l - i offset) e3, margin l over the width of the gap.
    """

    offset: FloatArray
    sign: FloatArray
    rounding: FloatArray

    def close(self, x: FloatArray, y: FloatArray) -> Closed:  # closure: RPR
        """The length l from C along the rod to E (Norton, sec. 4.7).

        With s = |D - C| it comes from (s - |offset|)(s + |offset|), which keeps its digits near dead
        positions.
        """
        offset, sign, rounding = self
        apart, away = np.hypot(x, y), np.abs(offset)
        product = (apart - away) * (apart + away)
        if np.any(product < 0):
            product = np.where((product < 0) & (away - apart <= rounding), 0.0, product)
        with np.errstate(invalid="ignore", divide="ignore"):
            reach = sign * np.sqrt(product)
            cosine, sine = reach / apart, offset / apart
            x, y = x / apart, y / apart
            cos3, sin3 = x * cosine - y * sine, y * cosine + x * sine
            return Closed(cos3, sin3, -sin3, cos3, cosine, reach)

    def travel(self, closed: Closed, x: FloatArray, y: FloatArray) -> FloatArray:  # noqa: ARG002
        """Distance of E from C: travel of the rod through the block."""
        return closed.reach

    def facing(self, closed: Closed) -> tuple[Vector, Vector]:
        """Across the rod, to its left, and along it."""
        return (-closed.sin3, closed.cos3), (closed.cos3, closed.sin3)

    def solve(self, closed: Closed, at: Vector, inverse: FloatArray, scale: FloatArray | float) -> Solved:
        """The component across the rod leaves its turn."""
        turn = at[0] * inverse / np.hypot(closed.reach, self.offset)
        return Solved(turn, turn, at[1] * scale - self.offset * turn)

    def rates(self, closed: Closed, inverse: FloatArray, *gap: Vector) -> tuple[Solved, Solved, Solved]:
        """With z = (l - i offset) e3 the second derivative of the gap is J q" + 2 i l' v e3 - v^2 z.

        The third has (3 i l" v + 3 l' (i a - v^2)) e3 - 3 v a z, with third derivatives less the cube of v.
        """
        reach, offset = closed.reach, self.offset
        over = inverse / np.hypot(reach, offset)
        (across, along), (across_2, along_2), (across_3, along_3) = gap
        omega = across * over
        square, velocity = omega * omega, along - offset * omega
        alpha = (across_2 - offset * square - 2 * omega * velocity) * over
        acceleration, mixed = along_2 + reach * square - offset * alpha, omega * alpha
        turn = (across_3 - 3 * (offset * mixed + alpha * velocity + omega * acceleration)) * over
        jerk, third = along_3 - offset * turn + 3 * (reach * mixed + square * velocity), turn + square * omega
        return (
            Solved(omega, omega, velocity),
            Solved(alpha, alpha, acceleration),
            Solved(third, third, jerk),
        )

    def growth(self, closed: Closed, first: Solved) -> tuple[Solved, Solved]:  # noqa: ARG002
        """Omega grows like 1/l, alpha like offset / l^3, the jerk like 3 offset^2 / l^5.

        Those of the rod grow like -offset / l, -offset^2 / l^3 and -3 offset^3 / l^5.
        """
        turn, size, side = first.turn3, np.abs(first.turn3), np.sign(self.offset)
        bend = self.sign * side * size
        return Solved(bend, bend, -self.sign * size), Solved(turn, turn, -side * turn)

    def force(self, closed: Closed, demands: Demands) -> tuple[Vector, FloatArray]:
        """Moments of the rod about C and of the block about D; along the rod there is friction alone."""
        turn3, turn4, _, in_e, in_d = demands
        moment = turn4 - in_d + in_e * self.offset
        across = (turn3 + moment) / closed.reach
        return (-in_e * closed.cos3 - across * closed.sin3, across * closed.cos3 - in_e * closed.sin3), moment

    def sizes(self, closed: Closed) -> dict[str, Vector]:
        """Derivative by the offset, reversed: i e3."""
        return {"offset": (-closed.sin3, closed.cos3)}

    def width(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Distance of C from D."""
        return np.hypot(x, y)

    def limits(self, cosine: float = 1.0) -> Vector:
        """The offset; nothing limits the width above."""
        away = np.abs(self.offset) / cosine
        return away, np.full_like(away, np.inf)

    def transmission_at(self, apart: FloatArray) -> FloatArray:
        """Up to pi/2: its sine is l over the width of the gap, by its half angle."""
        away = np.abs(self.offset)
        with np.errstate(invalid="ignore"):
            near = _from_zero(apart - away, ROUNDING * (apart + away))
            return 2 * np.arctan2(np.sqrt(near), np.sqrt(apart + away))


DyadSizes: TypeAlias = Pins | Slider | Block
DYADS: dict[DyadKind, type[Pins] | type[Slider] | type[Block]] = {
    DyadKind.RRR: Pins,
    DyadKind.RRP: Slider,
    DyadKind.RPR: Block,
}


def _from_zero(gap: FloatArray, rounding: FloatArray) -> FloatArray:
    """The gap; 0, a dead position, where only rounding makes it negative."""
    return np.where((gap < 0) & (gap >= -rounding), 0.0, gap)
