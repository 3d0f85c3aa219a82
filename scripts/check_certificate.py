"""Check a certificate of `grashof prove PROBLEM --certificate FILE`, with mathematics of its own.

Nothing of Grashof is used. Quantities are polynomials with remainders, see enclosures.py. Square roots and
the four operations are taken as IEEE 754 has them, sines and cosines as right to 2e-16. Where an enclosure
is too wide for a claim, its part is quartered, up to ten times.
"""

from __future__ import annotations

import argparse
import json
import sys
import tomllib
from collections.abc import Callable, Sequence
from itertools import combinations, pairwise
from math import cos, inf, radians, sin
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from enclosures import (
    AT,
    HAIR,
    TERMS,
    UNIT,
    Bools,
    Floats,
    Poly,
    Vector,
    chosen,
    cross,
    dot,
    empty,
    minus,
    most,
    square,
    turned,
    zero_free,
)
from numpy.typing import NDArray

Ints: TypeAlias = NDArray[np.int64]
Test: TypeAlias = Callable[[Ints, Floats, Floats, Floats, Floats], Bools]

DEPTH, MOST = 10, 20_000  # levels of quarters, and how many parts may be left after one
NEXT = 4 * UNIT  # by which parts overlap: no gaps between them by rounding
DROPPED, KEPT = ["missed", "far", "barred"], ["either", "driver", "driven"]


class Checker:
    """The proof of a certificate, in a frame with its origin at the first pose and lengths in sizes."""

    def __init__(self, data: dict[str, Any]) -> None:
        self.data, size = data, float(data["size"])
        self.limits = limits = {name: opened(value) for name, value in data["limits"].items()}
        poses = np.array(data["poses"], float)
        origin = complex(*poses[0, :2])
        self.poses, self.turned = [], []  # rotations and places, and what rotations may be off by
        for x, y, angle in poses:
            turn = radians(angle - poses[0, 2])
            self.poses.append((complex(cos(turn), sin(turn)), (complex(x, y) - origin) / size))
            self.turned.append(UNIT * (1 + 2 * abs(turn)))
        self.first = radians(poses[0, 2])
        self.links = {name: [end / size for end in limits[name]] for name in ("r1", "r2", "r3", "r4")}
        self.arms = [end / size for end in limits["coupler_arms"]]
        self.longest = max(self.links["r2"][1], self.links["r4"][1]) * (1 + 1e-15)
        self.shortest = min(self.links["r2"][0], self.links["r4"][0]) * (1 - 1e-15)
        self.reach = min(self.arms[1], 1e6)
        self.upper = radians(data["upper_deg"])
        at = poses[0, :2]
        self.boxes = {
            name: [
                [(end - (0 if "body" in name else at[k])) / size for end in limits[name][axis]]
                for k, axis in enumerate("xy")
            ]
            for name in ("o2", "o4", "a", "b", "a_on_body", "b_on_body")
            if name in limits
        }
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
        self.first_pieces = np.zeros(len(boxes), bool)
        self.first_pieces[data["first"]] = True
        self.halves = np.zeros((len(boxes), 2), int)
        self.rest = np.zeros(len(boxes))  # how far from the middle of tubes the curve can be
        middle, _, half, *_ = self.tube
        self.ends = 1 + 2e-13 * (np.abs(middle) + half) / np.maximum(half, HAIR)
        if not (np.isfinite(boxes).all() and np.isfinite(tubes).all() and np.isfinite(poses).all()):
            raise ValueError("numbers that are not finite")
        if not (size > 0 and 0 <= data["upper_deg"] <= 90):
            raise ValueError("a size or a bound that none can be")
        if not len(self.fates) == len(self.parents) == len(boxes) == len(tubes):
            raise ValueError("lists of unequal length")

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
        """Where the centre of the circle is; no farther than the longest dyad where that is not known."""
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
        """Parts of things that a test leaves, quartered until nothing is left; else those are a fault."""
        none, whole = np.zeros(len(which)), np.ones(len(which))
        parts, enough = (which, none, whole, none, whole), max(MOST, len(which))
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
        """How far from the middle of tubes the curve can be, where it is no farther than e."""
        s = Poly.of((low + high) / 2, (high - low) / 2 + NEXT * (1 + np.abs(low) + np.abs(high)))
        for _ in range(rounds):
            f = self.cubic(self.on_tube(k, s, Poly.of(0.0 * e, 0.0, e)))
            level = np.abs(f.c[[0, 1, 3, 6]]).sum(axis=0) + f.r + UNIT * f.size
            slope = np.abs(f.c[2]) - np.abs(f.c[[4, 5, 7, 8, 9]]).sum(axis=0) - UNIT * f.size
            with np.errstate(all="ignore"):
                e = np.where(slope > 0, np.minimum(e, e * level / slope * (1 + 1e-12) + 1e-15), e)
        return e

    def contained(self, k: Ints, s: Floats, ds: Floats, t: Floats, dt: Floats) -> Bools:
        """The curve in parts of rectangles is in the tube; how far from its middle is noted."""
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
                out |= (most(c + (-at - reach)) < 0) | (most(-c + (at - reach)) < 0)
            held &= ~there | out
        inside = (low < end) & (high > -end) & ~good
        cuts = np.linspace(np.clip(low, -end, end), np.clip(high, -end, end), 13)
        rest = np.maximum.reduce([self.narrowed(k, low, high, e) for low, high in pairwise(cuts)])
        rows: Bools = good | held
        np.maximum.at(self.rest, k[rows & inside], rest[rows & inside])
        return rows

    def place(self, k: Ints, s: Floats, ds: Floats, t: Floats, dt: Floats, rounds: int = 2) -> tuple[Vector, Bools]:
        """Places in parts of tubes that hold all of the curve there; and which of them hold nothing of it.

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

    def far(self, *part: Any) -> Bools:
        """No arm is so long or so short, and no circle through three places."""
        z, gone = self.place(*part)
        w = [self.moved(z, j) for j in range(4)]
        forms = self.arm(z)
        for i, j, k in combinations(range(4), 3):
            a, b = minus(w[j], w[i]), minus(w[k], w[i])
            area, sides = cross(a, b), square(a) * square(b) * square(minus(a, b))
            forms.append(area * area * (4 * self.longest**2) - sides)
            forms.append(sides - area * area * (4 * self.shortest**2))
        return gone | empty(forms)

    def arm(self, z: Vector) -> list[Poly]:
        """What an arm has to meet, zero or greater."""
        far = square(z)
        return [far + -(self.arms[0] ** 2), far * -1.0 + min(self.arms[1] ** 2, 1e300)]

    def dyad(self, z: Vector, ground: str, moving: str, link: str) -> list[Poly]:
        """What a dyad has to meet, zero or greater."""
        c, (shortest, longest) = self.centre(z), self.links[link]
        r2 = square(minus(z, c))
        forms = [*self.arm(z), r2 * -1.0 + longest**2, r2 + -(shortest**2)]
        there = [(c, ground)] + [(self.moved(z, j), moving) for j in range(4)]
        there.append((turned(z, cos(self.first), -sin(self.first)), moving + "_on_body"))
        for point, name in there:
            for part, (low, high) in zip(point, self.boxes.get(name, ()), strict=False):
                forms += [part + -low] * bool(low > -inf) + [part * -1.0 + high] * bool(high < inf)
        return forms

    def order(self, z: Vector, sense: int) -> list[Poly]:
        """Four points of a circle follow each other where the triangles 123 and 134 have one sense."""
        a = [minus(self.moved(z, j), z) for j in (1, 2, 3)]
        return [cross(a[0], a[1]) * sense, cross(a[1], a[2]) * sense] if sense else []

    def no_driver(self, *part: Any) -> Bools:
        """No driver is in parts of tubes."""
        z, gone = self.place(*part)
        forms = self.dyad(z, "o2", "a", "r2")
        return gone | np.all([empty(forms + self.order(z, sense)) for sense in self.senses], axis=0)

    def no_driven(self, *part: Any) -> Bools:
        """No driven dyad is in parts of tubes."""
        z, gone = self.place(*part)
        return gone | empty(self.dyad(z, "o4", "b", "r4"))

    def side(self, k: Ints, s: Floats, ds: Floats, *, other: bool) -> tuple[Vector, Vector, Bools]:
        """Z and c of a piece, as polynomials of the first parameter or the other; where it holds nothing."""
        z, gone = self.place(k, s, ds, 0 * s, 1 + 0 * s)
        made = []
        for one in (*z, *self.centre(z)):
            c = one.c * np.array([float(j == 0) for _, j in TERMS])[:, None]
            r = one.r + np.abs(one.c - c).sum(axis=0)
            made.append(Poly(c[[AT[j, i] for i, j in TERMS]] if other else c, r))
        return (made[0], made[1]), (made[2], made[3]), gone

    def pair(self, pairs: Ints, reason: str) -> Test:
        """The test of pairs of pieces by lengths alone, by what they transmit, or by both."""

        def test(n: Ints, s: Floats, ds: Floats, t: Floats, dt: Floats) -> Bools:
            za, ca, gone = self.side(pairs[n, 0], s, ds, other=False)
            zb, cb, gone_too = self.side(pairs[n, 1], t, dt, other=True)
            sides = (cb, ca), (za, ca), (zb, za), (zb, cb)
            r1, r2, r3, r4 = links = [square(minus(*ends)).root() for ends in sides]
            lengths, by_sign = self.lengths(links)
            if reason == "lengths":
                return gone | gone_too | np.all([empty(lengths + more) for more in by_sign], axis=0)
            product, squares = r3 * r4, square(minus(zb, za)) + square(minus(zb, cb))
            arms = []
            for j in range(4):
                rho, _ = self.poses[j]
                arms.append((turned(minus(zb, za), rho.real, rho.imag), minus(self.moved(zb, j), cb)))
            slack = product * (cos(self.upper) + 2e-15)
            always = [slack + dot(*arm) * sign for arm in arms for sign in (1, -1)]
            turns = ((r1 + r2) * (r1 + r2), 1), ((r1 - r2) * (r1 - r2), -1)
            ends = [slack * 2 - (reached - squares) * sign for reached, sign in turns]
            bend = product * (sin(self.upper) - 2e-15)
            one_branch = self.limits["same_branch"] or not self.cycle
            branches = [[cross(*arm) * sigma - bend for arm in arms] for sigma in (1, -1)]
            none = np.ones(len(n), bool)
            for more in by_sign:
                for sense in self.senses:
                    forms = always + (lengths + more + self.order(za, sense)) * (reason == "together")
                    if self.cycle:
                        forms = forms + ends
                    elif sense:
                        forms = forms + self.passed(za, ca, cb, r1, r2, ends, sense)
                    for branch in branches if one_branch else [[]]:
                        none &= empty(forms + branch)
            return gone | gone_too | none

        return test

    def lengths(self, links: list[Poly]) -> tuple[list[Poly], list[list[Poly]]]:
        """What lengths have to meet; and what more, for one kind of linkage or another."""
        forms: list[Poly] = []
        for r, (low, high) in zip(links, self.links.values(), strict=True):
            forms += [r + -low, r * -1.0 + high]
        ratio = self.limits["link_ratio_max"]
        forms += [a * ratio - b for a in links for b in links if a is not b]
        if not self.turns:
            return forms, [[]]
        r1, r2, r3, r4 = links
        total = (r1 + r2 + r3 + r4) * self.margin
        forms.append(r3 + r4 - r1 - r2 - total)
        return forms, [
            [(r1 - r2) * sign - (r3 - r4) * other - total for other in (1, -1)] for sign in self.signs
        ]

    def passed(
        self, za: Vector, ca: Vector, cb: Vector, r1: Poly, r2: Poly, ends: Sequence[Poly], sense: int
    ) -> list[Poly]:
        """Of a task: the ends of the turn that the driver surely passes on its way from pose 1 to pose 4."""
        last, made = minus(self.moved(za, 3), za), []
        for sign, end in ((-1, ends[0]), (1, ends[1])):
            there = (cross(minus(cb, ca), last) * r2 * sign - cross(minus(za, ca), last) * r1) * sense
            surely = most(-there) < 0
            made.append(chosen(surely, end, Poly.of(np.ones(len(surely)))))
        return made

    def check(self) -> None:
        """Raise ValueError unless the certificate proves what it claims."""
        self.root()
        self.tree()
        self.check_pairs()

    def tree(self) -> None:
        """Rectangles, tubes and halves are what they are said to be."""
        nodes, fates, parents = np.arange(len(self.fates)), self.fates, self.parents
        if not np.isin(fates, DROPPED + KEPT).all():
            raise ValueError("an unknown fate")
        if (parents >= nodes).any() or (parents < -1).any():
            raise ValueError("a child before its parent")
        count, kept = np.bincount(parents[parents >= 0], minlength=len(nodes)), np.isin(fates, KEPT)
        open_ = kept & (count == 0) & ~self.below()
        if not np.isin(count, [0, 2]).all() or open_.any():
            raise ValueError("a rectangle that is neither dropped, nor kept, nor halved")
        order = np.argsort(parents, kind="stable")[(parents == -1).sum() :]
        self.halves[parents[order[::2]]] = order.reshape(-1, 2)
        self.halved = count == 2
        self.quartered("missed rectangles", nodes[fates == "missed"], self.missed)
        self.quartered("tubes", nodes[fates != "missed"], self.contained)
        self.quartered("rectangles out of reach", nodes[fates == "far"], self.far)
        no_driver, no_driven = np.isin(fates, ["driven", "barred"]), np.isin(fates, ["driver", "barred"])
        self.quartered("pieces without drivers", nodes[no_driver], self.no_driver)
        self.quartered("pieces without driven dyads", nodes[no_driven], self.no_driven)
        self.quartered("halves", nodes[kept & self.halved], self.children)

    def check_pairs(self) -> None:
        """Every pair of pieces is dropped, with its reason, or halved."""
        driver, driven = np.isin(self.fates, ["either", "driver"]), np.isin(self.fates, ["either", "driven"])
        drivers, others = (
            np.flatnonzero(self.first_pieces & driver),
            np.flatnonzero(self.first_pieces & driven),
        )
        due = {(i, j) for i in drivers.tolist() for j in others.tolist()}
        for level in [*self.data["pairs"], {"halved": [], "lengths": [], "transmission": [], "together": []}]:
            halved = {(int(i), int(j)) for i, j in level["halved"]}
            found = set(halved)
            for reason in ("lengths", "transmission", "together"):
                pairs = np.array(level[reason], int).reshape(-1, 2)
                found |= {(int(i), int(j)) for i, j in pairs}
                self.quartered(f"pairs dropped by {reason}", np.arange(len(pairs)), self.pair(pairs, reason))
            if due - found:
                raise ValueError(f"pairs without a reason: {len(due - found)}, such as {min(due - found)}")
            if not all(self.halved[i] and self.halved[j] for i, j in halved):
                raise ValueError("a pair is halved, and a piece of it is not")
            due = {
                (int(a), int(b))
                for i, j in halved
                for a in self.halves[i]
                for b in self.halves[j]
                if driver[a] and driven[b]
            }

    def below(self) -> Bools:
        """Which rectangles are those that pairs begin with, or parts of them."""
        made = self.first_pieces.copy()
        for k, parent in enumerate(self.parents):
            made[k] |= parent >= 0 and made[parent]
        return made


def opened(value: Any) -> Any:
    """A limit, infinite where a file states null."""
    if isinstance(value, dict):
        return {axis: opened(ends) for axis, ends in value.items()}
    if isinstance(value, list):
        return [sign * inf if end is None else end for sign, end in zip((-1, 1), value, strict=True)]
    return inf if value is None else value


def differences(data: dict[str, Any], path: str) -> list[str]:
    """What a certificate states otherwise than a problem file."""
    with Path(path).open("rb") as file:
        problem = tomllib.load(file)
    stated, found = problem.get("requirements", {}), []
    limits = {name: opened(value) for name, value in data["limits"].items()}
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


def refused(name: str) -> None:
    """Raise ValueError: a number is none of JSON."""
    raise ValueError(f"{name} is not a number")


def main(argv: Sequence[str] | None = None) -> int:
    """Print what a certificate proves; return 0 where it does, 1 where it does not."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("certificate")
    parser.add_argument("problem", nargs="?", help="the problem file that it should be about")
    options = parser.parse_args(argv)
    try:
        with Path(options.certificate).open(encoding="utf-8") as file:
            data = json.load(file, parse_constant=refused)
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
