"""Check a certificate of `grashof prove PROBLEM --certificate FILE`, with mathematics of its own.

Nothing of Grashof is used. Quantities are polynomials with remainders (`enclosures.py`) over tubes about the
circle-point curve (`circle_points.py`). The four operations and square roots are rounded as IEEE 754 rounds
them; sines and cosines are taken to be right within 2e-16. Where an enclosure is too wide for a claim, its
part is quartered, up to ten times.
"""

from __future__ import annotations

import argparse
import json
import sys
import tomllib
from collections.abc import Sequence
from itertools import combinations
from math import cos, inf, radians, sin
from pathlib import Path
from typing import Any

import numpy as np
from circle_points import CirclePoints, Ints, Test, opened
from enclosures import (
    AT,
    TERMS,
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
)

DROPPED, KEPT = ["missed", "far", "barred"], ["either", "driver", "driven"]


class Checker(CirclePoints):
    """The proof of a certificate."""

    def __init__(self, data: dict[str, Any]) -> None:
        super().__init__(data)
        limits, size, (*at, angle) = self.limits, float(data["size"]), data["poses"][0]
        self.pairs, self.fates, self.first = data["pairs"], np.array(data["fates"]), radians(angle)
        self.upper = radians(data["upper_deg"])
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
        self.first_pieces = np.zeros(len(self.fates), bool)
        self.first_pieces[data["first"]] = True
        if not (len(self.fates) == len(self.parents) and 0 <= data["upper_deg"] <= 90):
            raise ValueError("lists of unequal length, or an impossible bound")

    def far(self, *part: Any) -> Bools:
        """Arms, or circles through three places, are too long or too short everywhere in parts of tubes."""
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
        """Conditions of an arm, each zero or greater."""
        far = square(z)
        return [far + -(self.arms[0] ** 2), far * -1.0 + min(self.arms[1] ** 2, 1e300)]

    def dyad(self, z: Vector, ground: str, moving: str, link: str) -> list[Poly]:
        """Conditions of a dyad, each zero or greater."""
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
        for_senses = [empty(forms + self.order(z, sense)) for sense in self.senses]
        none: Bools = np.logical_and.reduce(for_senses)
        return gone | none

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
        """The test of pairs of pieces by lengths alone, by transmission, or by both."""

        def test(n: Ints, s: Floats, ds: Floats, t: Floats, dt: Floats) -> Bools:
            za, ca, gone = self.side(pairs[n, 0], s, ds, other=False)
            zb, cb, gone_too = self.side(pairs[n, 1], t, dt, other=True)
            sides = (cb, ca), (za, ca), (zb, za), (zb, cb)
            r1, r2, r3, r4 = links = [square(minus(*ends)).root() for ends in sides]
            lengths, by_sign = self.lengths(links)
            if reason == "lengths":
                short: Bools = np.logical_and.reduce([empty(lengths + more) for more in by_sign])
                return gone | gone_too | short
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
            none, every = np.ones(len(n), bool), reason == "together" or bool(ds[0] < 1)
            for more in by_sign:
                for sense in self.senses:
                    forms = always + (lengths + more + self.order(za, sense)) * every
                    if self.cycle:
                        forms = forms + ends
                    elif sense:
                        forms = forms + self.passed(za, ca, cb, r1, r2, ends, sense)
                    for branch in branches if one_branch else [[]]:
                        none &= empty(forms + branch)
            return gone | gone_too | none

        return test

    def lengths(self, links: list[Poly]) -> tuple[list[Poly], list[list[Poly]]]:
        """Conditions of the lengths; and more of them for each kind of linkage."""
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
        """Rectangles, tubes and halves are as stated."""
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
        one, other = np.flatnonzero(self.first_pieces & driver), np.flatnonzero(self.first_pieces & driven)
        due, dropped = {(i, j) for i in one.tolist() for j in other.tolist()}, []
        for level in self.pairs:
            halved = {(int(i), int(j)) for i, j in level["halved"]}
            found = set(halved)
            for reason in ("lengths", "transmission", "together"):
                pairs = np.array(level[reason], int).reshape(-1, 2)
                found |= {(int(i), int(j)) for i, j in pairs}
                dropped.append((reason, pairs))
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
        if due:
            raise ValueError(f"pairs without a reason: {len(due)}, such as {min(due)}")
        for reason, pairs in dropped:
            self.quartered(f"pairs dropped by {reason}", np.arange(len(pairs)), self.pair(pairs, reason))

    def below(self) -> Bools:
        """Mask of the rectangles that pairs begin with, or that are parts of such ones."""
        made = self.first_pieces.copy()
        for k, parent in enumerate(self.parents):
            made[k] |= parent >= 0 and made[parent]
        return made


def differences(data: dict[str, Any], path: str) -> list[str]:
    """Parts in which a certificate differs from a problem file."""
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
    """Raise ValueError: a number is not valid in JSON."""
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
