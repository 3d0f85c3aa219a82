"""Check a certificate of `grashof prove PROBLEM --certificate FILE`, with mathematics of its own.

Nothing of Grashof is used. Quantities are polynomials of degree 3 in two parameters of [-1, 1], and a radius
that holds all terms left out and all rounding: of each operation at most 8 units of the last place (2**-52)
of the sum of the magnitudes that go into it. Square roots and the four operations are taken as IEEE 754 has
them, sines and cosines as right to 2e-16. Where an enclosure is too wide for a claim, its part is quartered,
up to six times.
"""

from __future__ import annotations

import argparse
import json
import sys
import tomllib
from itertools import combinations, pairwise
from math import cos, inf, radians, sin
from pathlib import Path

import numpy as np

UNIT, HAIR, DEPTH = 2.0**-52, 1e-300, 6
NEXT = 4 * UNIT  # by which parts overlap: no gaps between them by rounding
TERMS = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3)]
AT, DEGREE = {term: k for k, term in enumerate(TERMS)}, [i + j for i, j in TERMS]
PRODUCTS = [(a, b, AT[p[0] + q[0], p[1] + q[1]]) for a, p in enumerate(TERMS) for b, q in enumerate(TERMS)
            if sum(p) + sum(q) <= 3]  # fmt: skip


class Poly:
    """Polynomials, arrays of shape (10, n), and what they may be off by, shape (n,)."""

    def __init__(self, c, r):
        self.c, self.r = c, r * (1 + 64 * UNIT) + HAIR

    @classmethod
    def of(cls, value, s=0.0, t=0.0, r=0.0):
        """A value + s_slope s + t_slope t, and what it may be off by."""
        value, s, t, r = np.broadcast_arrays(value, s, t, r)
        c = np.zeros((10, len(value)))
        c[0], c[1], c[2] = value, s, t
        return cls(c, np.array(r, float))

    @property
    def size(self):
        """Greatest magnitude, the radius aside."""
        return np.abs(self.c).sum(axis=0)

    def __neg__(self):
        return Poly(-self.c, self.r)

    def __add__(self, other):
        if not isinstance(other, Poly):
            value = np.full(self.c.shape[1], other)
            other = Poly.of(value, r=4 * UNIT * np.abs(value))
        return Poly(self.c + other.c, self.r + other.r + UNIT * (self.size + other.size))

    def __sub__(self, other):
        return self + (-other)

    def __mul__(self, other):
        if not isinstance(other, Poly):
            return Poly(self.c * other, (self.r + 8 * UNIT * self.size) * np.abs(other))
        c = np.zeros_like(self.c)
        for a, b, k in PRODUCTS:
            c[k] += self.c[a] * other.c[b]
        mine, its = (
            [sum(np.abs(one.c[k]) for k in range(10) if DEGREE[k] == d) for d in range(4)]
            for one in (self, other)
        )
        over = sum(mine[a] * its[b] for a in range(4) for b in range(4) if a + b > 3)
        size, more = self.size, other.size
        return Poly(c, over + self.r * (more + other.r) + size * (other.r + 8 * UNIT * more))

    def series(self, first, factors, tail):
        """First * (1 + f1 u + f2 u^2 + f3 u^3), u = self / centre - 1; unbounded where |u| may reach 0.9."""
        good = np.abs(self.c[0]) > HAIR
        centre = np.where(good, self.c[0], 1.0)
        u = Poly(self.c.copy(), self.r) * (1 / centre)
        u.c[0], u.r = 0.0, u.r + 4 * UNIT
        w = u.size + u.r
        good &= w < 0.9
        square, w = u * u, np.where(good, w, 0.0)
        made = u * factors[0] + square * factors[1] + square * u * factors[2] + 1.0
        made.r = made.r + tail(w)
        made = made * first(centre)
        return Poly(np.where(good, made.c, 0.0), np.where(good, made.r + 4 * UNIT * made.size, inf))

    def inverse(self):
        """One over it."""
        return self.series(lambda v: 1 / v, (-1, 1, -1), lambda w: w**4 / (1 - w))

    def root(self):
        """Square root; between zero and the root of the greatest value where it may vanish."""
        made = self.series(
            lambda v: np.sqrt(np.abs(v)), (0.5, -0.125, 0.0625), lambda w: 0.0391 * w**4 / (1 - w) ** 3.5
        )
        most = np.sqrt(self.size + self.r) * (1 + 1e-12)
        plain = ~(made.r + made.size < 1.5 * most) | (self.c[0] <= 0)
        coarse = Poly.of(most / 2, r=most / 2)
        return chosen(plain, coarse, made)


def chosen(which, yes, no):
    """One or the other, entry by entry."""
    return Poly(np.where(which, yes.c, no.c), np.where(which, yes.r, no.r))


def square(v):
    """Squared length."""
    return v[0] * v[0] + v[1] * v[1]


def minus(v, w):
    """From w to v."""
    return v[0] - w[0], v[1] - w[1]


def cross(v, w):
    """Signed area."""
    return v[0] * w[1] - v[1] * w[0]


def dot(v, w):
    """Scalar product."""
    return v[0] * w[0] + v[1] * w[1]


def turned(v, re, im):
    """V times a complex number."""
    return v[0] * re - v[1] * im, v[0] * im + v[1] * re


def ranges(box, term):
    """Bounds of a power product in a box."""
    made = None
    for (low, high), power in zip(box, term, strict=True):
        if power:
            a, b = low**power, high**power
            ends = np.minimum(a, b), np.maximum(a, b)
            if power == 2:
                ends = np.where((low < 0) & (high > 0), 0.0, ends[0]), ends[1]
            every = ends if made is None else [x * y for x in made for y in ends]
            made = np.minimum.reduce(every), np.maximum.reduce(every)
    return made


def most(g, box, without=0):
    """Greatest value of g in a box, perhaps without its linear term in one parameter."""
    total = g.c[0] + g.r + 64 * UNIT * g.size
    for k, double, (low, high) in ((1, 3, box[0]), (2, 5, box[1])):
        line, bend = g.c[k] if k != without else 0.0 * g.r, g.c[double]
        with np.errstate(all="ignore"):
            top = -line / (2 * bend)
        top = np.where((bend < 0) & (top > low) & (top < high), top, low)
        total = total + np.maximum.reduce([line * x + bend * x * x for x in (low, high, top)])
    for k in (4, 6, 7, 8, 9):
        if g.c[k].any():
            low, high = ranges(box, TERMS[k])
            total = total + np.maximum(g.c[k] * low, g.c[k] * high)
    return np.where(np.isnan(total), inf, total)


def empty(forms):
    """Where not all forms can be zero or greater at one point of the square."""
    n = len(forms[0].r)
    box = [[-np.ones(n), np.ones(n)] for _ in range(2)]
    gone = np.zeros(n, bool)
    for _ in range(3):
        for g in forms:
            for k in (1, 2):
                slope, rest = g.c[k], most(g, box, k)
                root = -rest / np.where(slope == 0, 1.0, slope)
                low, high = box[k - 1]
                gone |= (slope == 0) & (rest < 0)
                root, usable = np.where(np.isfinite(root), root, 0.0), np.isfinite(root)
                low = np.where((slope > 0) & usable, np.maximum(low, root - 1e-12 * (1 + abs(root))), low)
                high = np.where((slope < 0) & usable, np.minimum(high, root + 1e-12 * (1 + abs(root))), high)
                gone |= low > high
                box[k - 1] = [np.minimum(low, high), np.maximum(low, high)]
    return gone


class Checker:
    """The proof of a certificate, in a frame with its origin at the first pose and lengths in sizes."""

    def __init__(self, data):
        self.data, limits, size = data, data["limits"], data["size"]
        poses = np.array(data["poses"], float)
        self.poses, self.turned = [], []
        for x, y, angle in poses:
            turn = radians(angle - poses[0, 2])
            place = (complex(x, y) - complex(*poses[0, :2])) / size
            self.poses.append((complex(cos(turn), sin(turn)), place))
            self.turned.append(UNIT * (2 + 3 * abs(radians(angle)) + 3 * abs(radians(poses[0, 2]))))
        self.first = radians(poses[0, 2])
        self.links = {name: [end / size for end in limits[name]] for name in ("r1", "r2", "r3", "r4")}
        self.arms = [end / size for end in limits["coupler_arms"]]
        self.longest = max(self.links["r2"][1], self.links["r4"][1]) * (1 + 1e-15)
        self.reach = min(self.arms[1], 1e6)
        self.limits, self.upper = limits, radians(data["upper_deg"])
        at = poses[0, :2]
        self.boxes = {
            name: [[(end - (0 if "body" in name else at[k])) / size for end in limits[name][axis]]
                   for k, axis in enumerate("xy")]
            for name in ("o2", "o4", "a", "b", "a_on_body", "b_on_body") if name in limits
        }  # fmt: skip
        cycle = limits["transmission_over"] == "cycle"
        self.cycle, self.turns = cycle, cycle or limits["rotatability"] != "any"
        self.margin = 0.0 if limits["rotatability"] == "any" else limits["rotatability_margin"]
        self.signs = {"crank-rocker": (1,), "double-crank": (-1,)}.get(limits["rotatability"], (1, -1))
        self.senses = (1, -1) if limits["order"] else (0,)
        boxes = np.array(data["rectangles"], float)
        self.rect = boxes[:, 0] + 1j * boxes[:, 1], boxes[:, 2] + 1j * boxes[:, 3], boxes[:, 4], boxes[:, 5]
        none = [0.0] * 4 + [1.0, 0.0, 0.0]
        tubes = np.array([none if tube is None else tube for tube in data["tubes"]], float)
        self.tube = (tubes[:, 0] + 1j * tubes[:, 1], tubes[:, 2] + 1j * tubes[:, 3], *tubes[:, 4:].T)
        self.fates, self.parents = np.array(data["fates"]), np.array(data["parents"])
        if not (np.isfinite(boxes).all() and np.isfinite(tubes).all() and self.upper >= 0):
            raise ValueError("numbers that are not finite")
        if not len(self.fates) == len(self.parents) == len(boxes) == len(tubes):
            raise ValueError("lists of unequal length")

    def moved(self, z, j):
        """A point of the body at a pose."""
        rho, place = self.poses[j]
        x, y = turned(z, rho.real, rho.imag)
        off = self.turned[j] * (x.size + y.size) + 4 * UNIT * abs(place)
        return Poly((x + place.real).c, x.r + off), Poly((y + place.imag).c, y.r + off)

    def rows(self, z):
        """Of poses 2 to 4: z_j - z and (|z_j|^2 - |z|^2) / 2, which a centre c makes (z_j - z) . c."""
        rows = []
        for j in (1, 2, 3):
            w, place = self.moved(z, j), self.poses[j][1]
            half = w[0] * place.real + w[1] * place.imag
            off = 8 * UNIT * abs(place) * (abs(place) + w[0].size + w[1].size)
            rows.append((*minus(w, z), Poly((half + -(abs(place) ** 2) / 2).c, half.r + off)))
        return rows

    def cubic(self, z):
        """Zero where four positions of z lie on a circle (or a line)."""
        rows = self.rows(z)
        (a, b, c), (d, e, f), (g, h, i) = rows
        return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)

    def centre(self, z):
        """Where the centre of the circle is; no farther than the longest dyad where that is not known."""
        x, y = z
        best = [Poly(x.c, x.r + self.longest), Poly(y.c, y.r + self.longest)]
        for (*a, k), (*b, m) in combinations(self.rows(z), 2):
            over = cross(a, b).inverse()
            found = (k * b[1] - m * a[1]) * over, (m * a[0] - k * b[0]) * over
            better = found[0].r + found[1].r < best[0].r + best[1].r
            best = [chosen(better, new, old) for new, old in zip(found, best, strict=True)]
        return best

    def on_tube(self, which, s, e):
        """Z of tubes where their parameters are polynomials."""
        m, u, half, tilt, bow = (part[which] for part in self.tube)
        w = s * half, s * tilt + (s * s + (-0.5)) * bow + e
        x, y = turned(w, u.real, u.imag)
        return x + Poly.of(m.real), y + Poly.of(m.imag)

    def quartered(self, name, which, test):
        """Parts of things that a test leaves, quartered until nothing is left; else those are a fault."""
        n = len(which)
        parts = [which, np.zeros(n), np.ones(n), np.zeros(n), np.ones(n)]
        for _ in range(DEPTH + 1):
            good = np.concatenate(
                [test(*(part[k : k + 4096] for part in parts)) for k in range(0, len(parts[0]), 4096)]
                or [np.ones(0, bool)]
            )
            which, s, ds, t, dt = (part[~good] for part in parts)
            if not len(which):
                return
            ds, dt = ds / 2, dt / 2
            steps = [(a, b) for a in (-1, 1) for b in (-1, 1)]
            parts = [np.tile(which, 4), np.concatenate([s + a * ds for a, _ in steps]), np.tile(ds, 4),
                     np.concatenate([t + b * dt for _, b in steps]), np.tile(dt, 4)]  # fmt: skip
        raise ValueError(f"{name}: {len(set(which.tolist()))} not confirmed, such as number {which[0]}")

    def within(self, z, k):
        """Places as shares of the halves of rectangles k."""
        p, v, half, side = (part[k] for part in self.rect)
        x, y = turned((z[0] - Poly.of(p.real), z[1] - Poly.of(p.imag)), v.real, -v.imag)
        return x * (1 / (np.abs(v) ** 2 * half)), y * (1 / (np.abs(v) ** 2 * side))

    def root(self):
        """The first rectangles cover every place that the arms reach."""
        p, v, half, side = (part[self.parents == -1] for part in self.rect)
        if not np.all(v == 1):
            raise ValueError("first rectangles are turned")
        ends = [(p.real - half, p.real + half), (p.imag - side, p.imag + side)]
        held = []
        for low, high in ends:
            cuts = np.unique(
                np.concatenate([low, high, [-self.reach, self.reach]]).clip(-self.reach, self.reach)
            )
            held.append((low[:, None] <= cuts[:-1]) & (high[:, None] >= cuts[1:]))
        if not (held[0].T.astype(int) @ held[1].astype(int)).all():
            raise ValueError("the first rectangles do not cover every place that the arms reach")

    def zero_free(self, f):
        """Where a polynomial is of one sign."""
        square_ = [[-1.0, 1.0]] * 2
        return (most(f, square_) < 0) | (most(-f, square_) < 0)

    def missed(self, k, s, ds, t, dt):
        """The curve is nowhere in parts of rectangles."""
        p, v, half, side = (part[k] for part in self.rect)
        x, y = turned(
            (Poly.of(half * s, half * (ds + NEXT)), Poly.of(side * t, 0.0, side * (dt + NEXT))),
            v.real,
            v.imag,
        )
        return self.zero_free(self.cubic((x + Poly.of(p.real), y + Poly.of(p.imag))))

    def narrowed(self, k, low, high, e, rounds=5):
        """How far from the middle of tubes the curve can be, where it is no farther than e."""
        s = Poly.of((low + high) / 2, (high - low) / 2 + NEXT * (1 + np.abs(low) + np.abs(high)))
        for _ in range(rounds):
            f = self.cubic(self.on_tube(k, s, Poly.of(0.0 * e, 0.0, e)))
            level = np.abs(f.c[[0, 1, 3, 6]]).sum(axis=0) + f.r + UNIT * f.size
            slope = np.abs(f.c[2]) - np.abs(f.c[[4, 5, 7, 8, 9]]).sum(axis=0) - UNIT * f.size
            with np.errstate(all="ignore"):
                e = np.where(slope > 0, np.minimum(e, e * level / slope * (1 + 1e-12) + 1e-15), e)
        return e

    def contained(self, k, s, ds, t, dt):
        """The curve in parts of rectangles is in the tube; how far from its middle is noted."""
        p, v, half, side = (part[k] for part in self.rect)
        x, y = turned(
            (Poly.of(half * s, half * (ds + NEXT)), Poly.of(side * t, 0.0, side * (dt + NEXT))),
            v.real,
            v.imag,
        )
        z = x + Poly.of(p.real), y + Poly.of(p.imag)
        good = self.zero_free(self.cubic(z))
        m, u, length, tilt, bow = (part[k] for part in self.tube)
        a, b = turned((z[0] - Poly.of(m.real), z[1] - Poly.of(m.imag)), u.real, -u.imag)
        a, b = a * (1 / (np.abs(u) ** 2 * length)), b * (1 / np.abs(u) ** 2)
        off = b - a * tilt - (a * a + (-0.5)) * bow
        box = [[-1.0, 1.0]] * 2
        low, high, e = -most(-a, box), most(a, box), np.maximum(most(off, box), most(-off, box))
        e = self.narrowed(k, low, high, e)
        end, held = self.ends[k], np.ones(len(k), bool)
        for begin, finish in ((np.maximum(low, end), high), (low, np.minimum(high, -end))):
            there = finish > begin
            first, last = np.where(there, begin, 0.0), np.where(there, finish, 0.0)
            place = self.on_tube(
                k,
                Poly.of((first + last) / 2, (last - first) / 2 + NEXT * (1 + np.abs(first) + np.abs(last))),
                Poly.of(0.0 * e, 0.0, e),
            )
            out = self.zero_free(self.cubic(place))
            for c, at, reach in zip(self.within(place, k), (s, t), (ds, dt), strict=True):
                out |= (most(c + Poly.of(-at - reach), box) < 0) | (most(-c + Poly.of(at - reach), box) < 0)
            held &= ~there | out
        inside = (low < end) & (high > -end) & ~good
        cuts = np.linspace(np.clip(low, -end, end), np.clip(high, -end, end), 13)
        rest = np.maximum.reduce([self.narrowed(k, *cut, e) for cut in pairwise(cuts)])
        rows = good | held
        np.maximum.at(self.rest, k[rows & inside], rest[rows & inside])
        return rows

    def place(self, k, s, ds, t, dt):
        """Points z in parts of tubes."""
        end = self.ends[k]
        rest = self.narrowed(k, (s - ds) * end, (s + ds) * end, self.rest[k], 2)
        return self.on_tube(
            k, Poly.of(s * end, (ds + NEXT) * end), Poly.of(t * rest, 0.0, (dt + NEXT) * rest)
        )

    def children(self, k, s, ds, t, dt):
        """Parts of tubes lie in one of two rectangles."""
        z, good, box = self.place(k, s, ds, t, dt), np.zeros(len(k), bool), [[-1.0, 1.0]] * 2
        for one in self.halves[k].T:
            x, y = self.within(z, one)
            good |= np.all([most(c + (-1.0), box) <= 0 for c in (x, -x, y, -y)], axis=0)
        return good

    def dyad(self, z, c, ground, moving, link):
        """What one dyad has to meet, zero or greater."""
        far = square(z)
        forms = [far * -1.0 + self.arms[1] ** 2] if self.arms[1] < inf else []
        forms += [far + -(self.arms[0] ** 2)]
        if c is None:
            w = [self.moved(z, j) for j in range(4)]
            for i, j, k in combinations(range(4), 3):
                a, b = minus(w[j], w[i]), minus(w[k], w[i])
                area = cross(a, b)
                forms.append(
                    area * area * (4 * self.longest**2) - square(a) * square(b) * square(minus(a, b))
                )
            return forms
        r2 = square(minus(z, c))
        forms += [r2 * -1.0 + link[1] ** 2, r2 + -(link[0] ** 2)]
        there = [(c, ground)] + [(self.moved(z, j), moving) for j in range(4)]
        there.append((turned(z, cos(self.first), -sin(self.first)), moving + "_on_body"))
        for point, name in there:
            for part, (low, high) in zip(point, self.boxes.get(name, [(-inf, inf)] * 2), strict=True):
                forms += [part + -low] * (low > -inf) + [part * -1.0 + high] * (high < inf)
        return forms

    def order(self, z, sense):
        """Four points of a circle follow each other where the triangles 123 and 134 have one sense."""
        a = [minus(self.moved(z, j), z) for j in (1, 2, 3)]
        return [cross(a[0], a[1]) * sense, cross(a[1], a[2]) * sense] if sense else []

    def far(self, *part):
        """No arm is so long, or no link."""
        return empty(self.dyad(self.place(*part), None, "", "", ()))

    def no_driver(self, *part):
        """No driver is in parts of tubes."""
        z = self.place(*part)
        forms = self.dyad(z, self.centre(z), "o2", "a", self.links["r2"])
        return np.all([empty(forms + self.order(z, sense)) for sense in self.senses], axis=0)

    def no_driven(self, *part):
        """No driven dyad is in parts of tubes."""
        z = self.place(*part)
        return empty(self.dyad(z, self.centre(z), "o4", "b", self.links["r4"]))

    def side(self, k, s, ds, other):
        """Z and c of a piece, as polynomials of the first parameter or the other."""
        z = self.place(k, s, ds, 0 * s, 1 + 0 * s)
        made = []
        for one in (*z, *self.centre(z)):
            c = one.c * np.array([float(j == 0) for _, j in TERMS])[:, None]
            r = one.r + np.abs(one.c - c).sum(axis=0)
            made.append(Poly(c[[AT[j, i] for i, j in TERMS]] if other else c, r))
        return made[:2], made[2:]

    def pair(self, reason):
        """The test of pairs of pieces by lengths alone, by what they transmit, or by both."""

        def test(n, s, ds, t, dt):
            (za, ca), (zb, cb) = (
                self.side(self.now[n, 0], s, ds, False),
                self.side(self.now[n, 1], t, dt, True),
            )
            r1, r2, r3, r4 = (
                square(minus(*ends)).root() for ends in ((cb, ca), (za, ca), (zb, za), (zb, cb))
            )
            total = (r1 + r2 + r3 + r4) * self.margin
            links, by_sign = [], [[]]
            for r, (low, high) in zip((r1, r2, r3, r4), self.links.values(), strict=True):
                links += [r + -low, r * -1.0 + high]
            links += [
                a * self.limits["link_ratio_max"] - b
                for a in (r1, r2, r3, r4)
                for b in (r1, r2, r3, r4)
                if a is not b
            ]
            if self.turns:
                links.append(r3 + r4 - r1 - r2 - total)
                by_sign = [
                    [(r1 - r2) * sign - (r3 - r4) * other - total for other in (1, -1)] for sign in self.signs
                ]
            if reason == "lengths":
                return np.all([empty(links + more) for more in by_sign], axis=0)
            product, squares = r3 * r4, square(minus(zb, za)) + square(minus(zb, cb))
            sine, cosine = sin(self.upper), cos(self.upper)
            arms = []
            for j in range(4):
                rho, _ = self.poses[j]
                u = turned(minus(zb, za), rho.real, rho.imag)
                arms.append((u, minus(self.moved(zb, j), cb)))
            slack = [product * (cosine + 2e-15) + dot(*arm) * sign for arm in arms for sign in (1, -1)]
            ends = [product * (2 * cosine + 4e-15) - (square_ - squares) * sign for square_, sign in
                    (((r1 + r2) * (r1 + r2), 1), ((r1 - r2) * (r1 - r2), -1))]  # fmt: skip
            gone = np.ones(len(n), bool)
            one_branch = self.limits["same_branch"] or not self.cycle
            for more in by_sign:
                for sense in self.senses:
                    forms = slack + (links + more + self.order(za, sense) if reason == "together" else [])
                    if self.cycle:
                        forms += ends
                    elif sense:
                        forms += self.passed(za, ca, cb, r1, r2, ends, sense)
                    for sigma in (1, -1) if one_branch else (0,):
                        at = [cross(*arm) * sigma - product * (sine - 2e-15) for arm in arms] if sigma else []
                        gone &= empty(forms + at)
            return gone

        return test

    def passed(self, za, ca, cb, r1, r2, ends, sense):
        """Of a task: the ends of the turn that the driver surely passes on its way from pose 1 to pose 4."""
        last, made = minus(self.moved(za, 3), za), []
        for sign, end in ((-1, ends[0]), (1, ends[1])):
            there = (cross(minus(cb, ca), last) * r2 * sign - cross(minus(za, ca), last) * r1) * sense
            surely = most(-there, [[-1.0, 1.0]] * 2) < 0
            made.append(chosen(surely, end, Poly.of(np.ones(len(surely)))))
        return made

    def check(self):
        """Raise ValueError unless the certificate proves what it claims."""
        n = len(self.fates)
        nodes = np.arange(n)
        m, _, half, _, _ = self.tube
        self.rest = np.zeros(n)
        self.ends = 1 + 2e-13 * (np.abs(m) + half) / np.maximum(half, HAIR)
        self.root()
        kept = ~np.isin(self.fates, ["missed", "far", "barred"])
        if not np.isin(self.fates, ["missed", "far", "barred", "either", "driver", "driven"]).all():
            raise ValueError("an unknown fate")
        if (self.parents >= nodes).any() or (self.parents < -1).any():
            raise ValueError("a child before its parent")
        count = np.bincount(self.parents[self.parents >= 0], minlength=n)
        first = np.zeros(n, bool)
        first[self.data["first"]] = True
        if not np.isin(count, [0, 2]).all() or (kept & ~first & (count == 0) & ~self.below(first)).any():
            raise ValueError("a rectangle that is neither dropped, nor kept, nor halved")
        order = np.argsort(self.parents, kind="stable")[(self.parents == -1).sum() :]
        self.halves = np.zeros((n, 2), int)
        self.halves[self.parents[order[::2]]] = order.reshape(-1, 2)
        self.quartered("missed rectangles", nodes[self.fates == "missed"], self.missed)
        self.quartered("tubes", nodes[self.fates != "missed"], self.contained)
        self.quartered("rectangles out of reach", nodes[self.fates == "far"], self.far)
        self.quartered(
            "pieces without drivers", nodes[np.isin(self.fates, ["driven", "barred"])], self.no_driver
        )
        self.quartered(
            "pieces without driven dyads", nodes[np.isin(self.fates, ["driver", "barred"])], self.no_driven
        )
        self.quartered("halves", nodes[kept & (count == 2)], self.children)
        driver, driven = np.isin(self.fates, ["either", "driver"]), np.isin(self.fates, ["either", "driven"])
        due = {(i, j) for i in nodes[first & driver].tolist() for j in nodes[first & driven].tolist()}
        for level in self.data["pairs"]:
            halved = {tuple(pair) for pair in level["halved"]}
            found = set(halved)
            for reason in ("lengths", "transmission", "together"):
                self.now = np.array(level[reason], int).reshape(-1, 2)
                found |= {tuple(pair) for pair in self.now.tolist()}
                self.quartered(f"pairs dropped by {reason}", np.arange(len(self.now)), self.pair(reason))
            if due - found:
                raise ValueError(f"pairs without a reason: {len(due - found)}, such as {min(due - found)}")
            if any(count[i] != 2 or count[j] != 2 for i, j in halved):
                raise ValueError("a pair is halved, and a piece of it is not")
            due = {
                (int(a), int(b))
                for i, j in halved
                for a in self.halves[i]
                for b in self.halves[j]
                if driver[a] and driven[b]
            }
        if due:
            raise ValueError(f"pairs without a reason: {len(due)}")

    def below(self, first):
        """Which rectangles are parts of pieces that pairs began with."""
        made = first.copy()
        for k, parent in enumerate(self.parents):
            made[k] |= parent >= 0 and made[parent]
        return made


def differences(data, path):
    """What a certificate states otherwise than a problem file."""
    with Path(path).open("rb") as file:
        problem = tomllib.load(file)
    stated, limits, found = problem.get("requirements", {}), data["limits"], []
    if not np.allclose(problem["motion"]["poses"], data["poses"], rtol=0, atol=1e-9 * data["size"]):
        found.append("poses")
    wanted = {name: stated["link_length"] for name in ("r1", "r2", "r3", "r4") if "link_length" in stated}
    for name, value in {**wanted, **{k: v for k, v in stated.items() if k in limits}}.items():
        box = isinstance(limits[name], dict)
        if box and isinstance(value, dict):
            same = all(np.allclose(limits[name][axis], value.get(axis, [-inf, inf])) for axis in "xy")
        elif isinstance(value, (str, bool)) or box:
            same = limits[name] == value
        else:
            same = np.allclose(limits[name], value, rtol=1e-9)
        found += [] if same else [name]
    return found


def main(argv=None):
    """Print what a certificate proves; return 0 where it does, 1 where it does not."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("certificate")
    parser.add_argument("problem", nargs="?", help="the problem file that it should be about")
    options = parser.parse_args(argv)
    try:
        with Path(options.certificate).open(encoding="utf-8") as file:
            data = json.load(file)
        unlike = differences(data, options.problem) if options.problem else []
        if unlike:
            raise ValueError(f"it is about another problem: {', '.join(unlike)}")
        with np.errstate(all="ignore"):
            Checker(data).check()
    except (ValueError, KeyError, IndexError, TypeError, OSError) as error:
        print(f"not confirmed: {error}")
        return 1
    for pose in data["poses"]:
        print("pose", *pose)
    for name, value in data["limits"].items():
        print(name, value)
    print(f"confirmed: no four-bar within these limits transmits more than {data['upper_deg']} deg")
    return 0


if __name__ == "__main__":
    sys.exit(main())
