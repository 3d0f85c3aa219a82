"""Points whose four places lie on a circle, in rectangles and tubes, for scripts/check_certificate.py."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations, pairwise
from math import cos, inf, radians, sin
from typing import Any, TypeAlias

import numpy as np
from enclosures import HAIR, UNIT, Bools, Floats, Poly, Vector, chosen, cross, minus, most, turned, zero_free
from numpy.typing import NDArray

Ints: TypeAlias = NDArray[np.int64]
Test: TypeAlias = Callable[..., Bools]  # of parts: k, s, ds, t, dt

DEPTH, MOST = 10, 20_000  # levels of quarters, and the most parts left after one
NEXT = 4 * UNIT  # by which parts overlap: no gaps between them by rounding


class CirclePoints:
    """The curve of a certificate, in a frame at the first pose and with lengths in sizes.

    Parts are numbers k of rectangles, their tubes or pairs, and the middles and halves of ranges of two
    parameters, each an array of shape (n,).
    """

    def __init__(self, data: dict[str, Any]) -> None:
        size, poses = float(data["size"]), np.array(data["poses"], float)
        origin = complex(*poses[0, :2])
        self.poses, self.turned = [], []  # rotations and places, and error bounds of rotations
        for x, y, angle in poses:
            turn = radians(angle - poses[0, 2])
            self.poses.append((complex(cos(turn), sin(turn)), (complex(x, y) - origin) / size))
            self.turned.append(UNIT * (1 + 2 * abs(turn)))
        limits = {name: opened(value) for name, value in data["limits"].items()}
        self.limits = limits
        self.links = {name: [end / size for end in limits[name]] for name in ("r1", "r2", "r3", "r4")}
        self.arms = [end / size for end in limits["coupler_arms"]]
        self.longest = max(self.links["r2"][1], self.links["r4"][1]) * (1 + 1e-15)
        self.shortest = min(self.links["r2"][0], self.links["r4"][0]) * (1 - 1e-15)
        self.reach = min(self.arms[1], 1e6)
        boxes = np.array(data["rectangles"], float)
        self.rect = boxes[:, 0] + 1j * boxes[:, 1], boxes[:, 2] + 1j * boxes[:, 3], boxes[:, 4], boxes[:, 5]
        none = [0.0] * 4 + [1.0, 0.0, 0.0]
        tubes = np.array([none if tube is None else tube for tube in data["tubes"]], float)
        self.tube = (tubes[:, 0] + 1j * tubes[:, 1], tubes[:, 2] + 1j * tubes[:, 3], *tubes[:, 4:].T)
        middle, _, half, *_ = self.tube
        self.ends = 1 + 2e-13 * (np.abs(middle) + half) / np.maximum(half, HAIR)
        self.rest = np.zeros(len(boxes))  # greatest distance of the curve from the middle of tubes
        self.parents, self.halves = np.array(data["parents"]), np.zeros((len(boxes), 2), int)
        if not (np.isfinite(boxes).all() and np.isfinite(tubes).all() and np.isfinite(poses).all()):
            raise ValueError("numbers that are not finite")
        if not (size > 0 and len(self.parents) == len(boxes) == len(tubes)):
            raise ValueError("lists of unequal length, or no size")

    def moved(self, z: Vector, j: int) -> Vector:
        """A point of the body at a pose."""
        rho, place = self.poses[j]
        x, y = turned(z, rho.real, rho.imag)
        off = self.turned[j] * (x.size + y.size) + 4 * UNIT * abs(place)
        return Poly((x + place.real).c, x.r + off), Poly((y + place.imag).c, y.r + off)

    def rows(self, z: Vector) -> list[tuple[Poly, Poly, Poly]]:
        """Of poses 2 to 4: z_j - z and (|z_j|^2 - |z|^2) / 2, which a centre c makes (z_j - z) . c."""
        rows = []
        for j in (1, 2, 3):
            w, place = self.moved(z, j), self.poses[j][1]
            half = w[0] * place.real + w[1] * place.imag
            off = 8 * UNIT * abs(place) * (abs(place) + w[0].size + w[1].size)
            rows.append((*minus(w, z), Poly((half + -(abs(place) ** 2) / 2).c, half.r + off)))
        return rows

    def cubic(self, z: Vector) -> Poly:
        """Zero where four positions of z lie on a circle (or a line)."""
        rows = self.rows(z)
        (a, b, c), (d, e, f), (g, h, i) = rows
        return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)

    def centre(self, z: Vector) -> Vector:
        """Centre of the circle; no farther than the longest dyad where that is not known."""
        x, y = z
        best = Poly(x.c, x.r + self.longest), Poly(y.c, y.r + self.longest)
        for (ax, ay, k), (bx, by, m) in combinations(self.rows(z), 2):
            over = cross((ax, ay), (bx, by)).inverse()
            found = (k * by - m * ay) * over, (m * ax - k * bx) * over
            better = found[0].r + found[1].r < best[0].r + best[1].r
            best = chosen(better, found[0], best[0]), chosen(better, found[1], best[1])
        return best

    def on_tube(self, k: Ints, s: Poly, e: Poly) -> Vector:
        """Z of tubes where their parameters are polynomials."""
        m, u, half, tilt, bow = (part[k] for part in self.tube)
        w = s * half, s * tilt + (s * s + (-0.5)) * bow + e
        x, y = turned(w, u.real, u.imag)
        return x + Poly.of(m.real), y + Poly.of(m.imag)

    def quartered(self, name: str, which: Ints, test: Test) -> None:
        """Quarter the parts that a test leaves until none is left; ValueError where some remain."""
        none: Floats = np.zeros(len(which))
        full = none + 1
        parts, enough = (which, none, full, none, full), max(MOST, len(which))
        for _ in range(DEPTH + 1):
            if not 0 < len(which) <= enough:
                break
            begins = range(0, len(parts[0]), 4096)
            good = np.concatenate([test(*(part[k : k + 4096] for part in parts)) for k in begins])
            which, s, ds, t, dt = (part[~good] for part in parts)
            ds, dt = ds / 2, dt / 2
            corners = [(a, b) for a in (-1, 1) for b in (-1, 1)]
            firsts = np.concatenate([s + a * ds for a, _ in corners])
            others = np.concatenate([t + b * dt for _, b in corners])
            parts = np.tile(which, 4), firsts, np.tile(ds, 4), others, np.tile(dt, 4)
        if len(which):
            raise ValueError(f"{name}: {len(set(which.tolist()))} not confirmed, such as number {which[0]}")

    def within(self, z: Vector, k: Ints) -> Vector:
        """Places as shares of the halves of rectangles k."""
        p, v, half, side = (part[k] for part in self.rect)
        x, y = turned((z[0] - Poly.of(p.real), z[1] - Poly.of(p.imag)), v.real, -v.imag)
        return x * (1 / (np.abs(v) ** 2 * half)), y * (1 / (np.abs(v) ** 2 * side))

    def in_rectangle(self, k: Ints, s: Floats, ds: Floats, t: Floats, dt: Floats) -> Vector:
        """Z in parts of rectangles."""
        p, v, half, side = (part[k] for part in self.rect)
        place = Poly.of(half * s, half * (ds + NEXT)), Poly.of(side * t, 0.0, side * (dt + NEXT))
        x, y = turned(place, v.real, v.imag)
        return x + Poly.of(p.real), y + Poly.of(p.imag)

    def root(self) -> None:
        """The first rectangles cover every place that the arms reach."""
        p, v, half, side = (part[self.parents == -1] for part in self.rect)
        if not np.all(v == 1):
            raise ValueError("first rectangles are turned")
        held = []
        for low, high in ((p.real - half, p.real + half), (p.imag - side, p.imag + side)):
            cuts = np.concatenate([low, high, [-self.reach, self.reach]])
            cuts = np.unique(cuts.clip(-self.reach, self.reach))
            held.append((low[:, None] <= cuts[:-1]) & (high[:, None] >= cuts[1:]))
        if not (held[0].T.astype(int) @ held[1].astype(int)).all():
            raise ValueError("the first rectangles do not cover every place that the arms reach")

    def missed(self, *part: Any) -> Bools:
        """The curve is nowhere in parts of rectangles."""
        return zero_free(self.cubic(self.in_rectangle(*part)))

    def narrowed(self, k: Ints, low: Floats, high: Floats, e: Floats, rounds: int = 5) -> Floats:
        """Greatest distance of the curve from the middle of tubes, where it is at most e away."""
        s = Poly.of((low + high) / 2, (high - low) / 2 + NEXT * (1 + np.abs(low) + np.abs(high)))
        for _ in range(rounds):
            f = self.cubic(self.on_tube(k, s, Poly.of(0.0 * e, 0.0, e)))
            level = np.abs(f.c[[0, 1, 3, 6]]).sum(axis=0) + f.r + UNIT * f.size
            slope = np.abs(f.c[2]) - np.abs(f.c[[4, 5, 7, 8, 9]]).sum(axis=0) - UNIT * f.size
            with np.errstate(all="ignore"):
                e = np.where(slope > 0, np.minimum(e, e * level / slope * (1 + 1e-12) + 1e-15), e)
        return e

    def contained(self, k: Ints, s: Floats, ds: Floats, t: Floats, dt: Floats) -> Bools:
        """The curve in parts of rectangles is in the tube; its distance from the middle is noted."""
        z = self.in_rectangle(k, s, ds, t, dt)
        good = zero_free(self.cubic(z))
        m, u, length, tilt, bow = (part[k] for part in self.tube)
        a, b = turned((z[0] - Poly.of(m.real), z[1] - Poly.of(m.imag)), u.real, -u.imag)
        a, b = a * (1 / (np.abs(u) ** 2 * length)), b * (1 / np.abs(u) ** 2)
        off = b - a * tilt - (a * a + (-0.5)) * bow
        low, high = -most(-a), most(a)
        e = self.narrowed(k, low, high, np.maximum(most(off), most(-off)))
        end, held = self.ends[k], np.ones(len(k), bool)
        for begin, finish in ((np.maximum(low, end), high), (low, np.minimum(high, -end))):
            there = finish > begin
            first, last = np.where(there, begin, 0.0), np.where(there, finish, 0.0)
            length = (last - first) / 2 + NEXT * (1 + np.abs(first) + np.abs(last))
            place = self.on_tube(k, Poly.of((first + last) / 2, length), Poly.of(0.0 * e, 0.0, e))
            out = zero_free(self.cubic(place))
            for c, at, reach in zip(self.within(place, k), (s, t), (ds, dt), strict=True):
                out |= (most(c + (reach - at)) < 0) | (most(-c + (at + reach)) < 0)
            held &= ~there | out
        inside = (low < end) & (high > -end) & ~good
        cuts = np.linspace(np.clip(low, -end, end), np.clip(high, -end, end), 13)
        rest = np.maximum.reduce([self.narrowed(k, low, high, e) for low, high in pairwise(cuts)])
        rows: Bools = good | held
        np.maximum.at(self.rest, k[rows & inside], rest[rows & inside])
        return rows

    def place(
        self, k: Ints, s: Floats, ds: Floats, t: Floats, dt: Floats, rounds: int = 2
    ) -> tuple[Vector, Bools]:
        """Places in parts of tubes that contain all of the curve there, and which of them contain none of it.

        The cubic is c0 + c1 s + rest + e (c2 + wobble): so e is within `left` of -(c0 + c1 s) / c2.
        """
        end, gone = self.ends[k], np.zeros(len(k), bool)
        along = Poly.of(s * end, (ds + NEXT) * end)
        most_e = self.narrowed(k, (s - ds) * end, (s + ds) * end, self.rest[k], 2)
        e = Poly.of(t * most_e, 0.0, (dt + NEXT) * most_e)
        for _ in range(rounds):
            f = self.cubic(self.on_tube(k, along, e))
            rest = np.abs(f.c[[3, 6]]).sum(axis=0) + f.r + 16 * UNIT * f.size
            wobble = np.abs(f.c[[4, 5, 7, 8, 9]]).sum(axis=0) + 16 * UNIT * f.size
            slope, level = np.where(f.c[2] == 0, HAIR, f.c[2]), np.abs(f.c[0]) + np.abs(f.c[1])
            a, b, steep = -f.c[0] / slope, -f.c[1] / slope, np.abs(slope) - wobble
            left = (rest + (level + rest) * wobble / steep) / np.abs(slope)
            left = left * (1 + 1e-12) + 16 * UNIT * (np.abs(a) + np.abs(b))
            gone |= (steep > 0) & (np.abs(a) > 1 + np.abs(b) + left)
            e_slope, reach = e.c[1] + e.c[2] * b, e.c[2] * left + 4 * UNIT * (np.abs(e.c[0]) + np.abs(e.c[1]))
            e = chosen((steep > 0) & (left < 0.9), Poly.of(e.c[0] + e.c[2] * a, e_slope, reach), e)
        return self.on_tube(k, along, e), gone

    def children(self, k: Ints, s: Floats, ds: Floats, t: Floats, dt: Floats) -> Bools:
        """The curve in parts of tubes lies in one of two rectangles."""
        plain, _ = self.place(k, s, ds, t, dt, rounds=0)
        close, good = self.place(k, s, ds, t, dt)
        for one in self.halves[k].T:
            inside = np.ones(len(k), bool)
            for pair in zip(self.within(plain, one), self.within(close, one), strict=True):
                for sign in (1, -1):
                    inside &= np.any([most(c * sign + (-1.0)) <= 0 for c in pair], axis=0)
            good |= inside
        return good


def opened(value: Any) -> Any:
    """A limit, infinite where a file states null."""
    if isinstance(value, dict):
        return {axis: opened(ends) for axis, ends in value.items()}
    if isinstance(value, list):
        return [sign * inf if end is None else end for sign, end in zip((-1, 1), value, strict=True)]
    return inf if value is None else value
