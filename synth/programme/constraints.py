"""The constraints of the four-bar programme: each requirement as the field writes it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import casadi as ca
import numpy as np

from grashof.analysis.judge.design import Constraint, Design
from grashof.synth.programme.on_symbols import on_symbols
from grashof.synth.programme.screening import GROUPS
from grashof.synth.programme.structure import PLANES, Form, Given, Unknowns

OWN_INSET = 1e-8  # the user's constraints are tightened by so much, so that the polished design keeps them
ANGLES = ("ground_angle_deg", "theta2_start_deg")  # equalities: fixed unknowns unless they are relaxed


@dataclass(slots=True)
class Rows:
    """Constraints as they are collected: expressions, and the name that their limits go by."""

    slack: ca.SX | None
    relaxed: ca.SX
    expressions: list[ca.SX] = field(default_factory=list)
    names: list[str] = field(default_factory=list)

    def add(self, name: str, *expressions: ca.SX) -> None:
        """Add expressions with the limits `name`."""
        for expression in expressions:
            self.expressions.append(expression)
            self.names += [name] * expression.numel()

    def require(self, group: str, *expressions: ca.SX, name: str = "nonnegative") -> None:
        """Add expressions that must not be negative, but by the slack where the group is relaxed."""
        give = 0.0 if self.slack is None else self.slack * self.relaxed[GROUPS.index(group)]
        self.add(name, *(expression + give for expression in expressions))


@dataclass(frozen=True, slots=True)
class Places:
    """A, B and P at every target, in the order of visit, and the vectors from P to A and B."""

    a: list[ca.SX]
    b: list[ca.SX]
    p: list[ca.SX]
    arms: tuple[ca.SX, ca.SX]


def close_at_poses(rows: Rows, given: Given, unknown: Unknowns) -> Places:
    """Points of the body are displaced with it; A and B stay at their distances from O2 and O4."""
    a, b, n = unknown["a"], unknown["b"], unknown["theta2"].numel()
    places = Places(
        a=[given.displaced(a, k) for k in range(n)],
        b=[given.displaced(b, k) for k in range(n)],
        p=[given.displaced(given.body, k) for k in range(n)],
        arms=(a - given.body, b - given.body),
    )
    r, theta2 = unknown["r"], unknown["theta2"]
    for k in range(n):
        rows.add("zero", places.a[k] - unknown["o2"] - r[1] * unit(theta2[k]))
        rows.add("zero", (ca.sumsqr(places.b[k] - unknown["o4"]) - r[3] ** 2) / 2)
    rows.add("zero", (ca.sumsqr(b - a) - r[2] ** 2) / 2)
    return places


def close_at_points(rows: Rows, form: Form, given: Given, unknown: Unknowns) -> Places:
    """The loop O2-A-B-O4 closes at every driver angle; P is fixed to the coupler."""
    r, theta2, theta3, arm = (unknown[name] for name in ("r", "theta2", "theta3", "arm"))
    n = form.targets
    a = [unknown["o2"] + r[1] * unit(theta2[k]) for k in range(n)]
    b = [a[k] + r[2] * unit(theta3[k]) for k in range(n)]
    p = [a[k] + rotated(arm, theta3[k]) for k in range(n)]
    for k in range(n):
        rows.add("zero", (ca.sumsqr(b[k] - unknown["o4"]) - r[3] ** 2) / 2)
        if form.exact and form.positions[k]:
            rows.add("zero", p[k] - given.target(k))
        if form.exact and form.angles[k]:
            rows.add("zero", theta3[k] + unknown["body_angle"] - given.turns[k])
        if form.timed and k:
            rows.add("zero", theta2[k] - theta2[0] - given.direction * (given.timing[k] - given.timing[0]))
    for name, at in (("a", a), ("b", b)):
        first = sum((given.at_first[k] * at[k] for k in range(n)), ca.SX.zeros(2))
        rows.add("zero", unknown[name] - first)
    return Places(a, b, p, (arm, arm - ca.vertcat(r[2], 0)))


def square(form: Form, given: Given, unknown: Unknowns, places: Places) -> ca.SX:
    """Weighted sum of squared distances and turns from the targets."""
    cost = ca.SX(0)
    for k in range(form.targets):
        if form.positions[k]:
            cost += given.square_weights[k] * ca.sumsqr(places.p[k] - given.target(k))
        if form.angles[k]:
            cost += given.square_weights[form.targets + k] * _off(given, unknown, k) ** 2
    return cost


def require_all(rows: Rows, form: Form, given: Given, unknown: Unknowns, places: Places) -> None:
    """Every requirement that is no plain limit of an unknown."""
    r, o4, theta2 = unknown["r"], unknown["o4"], unknown["theta2"]
    rows.add("zero", o4 - unknown["o2"] - r[0] * unit(unknown["theta1"]))
    for k in range(form.targets - 1):
        rows.add("step", given.direction * (theta2[k + 1] - theta2[k]))
    rows.add("turn", given.direction * (theta2[form.targets - 1] - theta2[0]))
    if form.same_branch:
        for at_a, at_b in zip(places.a, places.b, strict=True):
            sine = cross(at_b - at_a, at_b - o4) / (r[2] * r[3])
            rows.require("same_branch", given.assembly * sine - 1e-6)
    if form.crank:
        _rotatability(rows, given, r)
    _nearest(rows, form, given, unknown, places)
    _error(rows, form, given, unknown, places)
    _transmission(rows, form, unknown, places)
    for arm in places.arms:
        arm2 = ca.sumsqr(arm)
        rows.require("coupler_arms", arm2 - given.arms[0] ** 2, given.arms[1] ** 2 - arm2)
    if form.ratio:
        pairs = [(i, j) for i in range(4) for j in range(4) if i != j]
        rows.require("link_ratio_max", *(r[i] - r[j] / given.ratio for i, j in pairs))
    for wished, name, at in ((form.box_a, "a", places.a), (form.box_b, "b", places.b)):
        for place in at if wished else ():
            rows.require(name, place - given.box[name][0], given.box[name][1] - place)
    _keep_out(rows, form, given, unknown, places)


def require_limits(rows: Rows, given: Given, unknown: Unknowns) -> None:
    """The plain limits of unknowns as rows, so that they can be relaxed too."""
    rows.require("link_length", unknown["r"] - given.lengths[:4], given.lengths[4:] - unknown["r"])
    for name in ("o2", "o4"):
        rows.require(name, unknown[name] - given.box[name][0], given.box[name][1] - unknown[name])
    rows.require("transmission_min_deg", unknown["tau"] - given.least_transmission)
    angles = (unknown["theta1"], ca.dot(given.at_first, unknown["theta2"]))
    for i, (key, angle) in enumerate(zip(ANGLES, angles, strict=True)):
        rows.require(key, angle - given.angles[i], given.angles[i] - angle, name=key)


def require_own(
    rows: Rows, given: Given, unknown: Unknowns, places: Places, constraints: Sequence[Constraint]
) -> None:
    """The user's own constraints, on the symbols of the design in the problem's unit."""
    if not constraints:
        return
    design = symbolic_design(given, unknown, places)
    for constraint in constraints:
        value = on_symbols(constraint, design)
        for one in value if isinstance(value, (list, tuple)) else [value]:
            rows.require("constraints", -ca.vec(ca.SX(one)) - OWN_INSET)


def symbolic_design(given: Given, unknown: Unknowns, places: Places) -> Design:
    """What a user's constraint sees of the unknowns."""
    scale, r = given.scale, unknown["r"]
    coupler, arm = places.b[0] - places.a[0], places.p[0] - places.a[0]
    along, beside = ca.dot(coupler, arm) / r[2], cross(coupler, arm) / r[2]
    r1, r2, r3, r4 = (scale * r[i] for i in range(4))
    return Design(
        o2=given.outward(unknown["o2"]),
        o4=given.outward(unknown["o4"]),
        r1=r1,
        r2=r2,
        r3=r3,
        r4=r4,
        theta1=unknown["theta1"],
        coupler_point=scale * ca.vertcat(along, beside),
        theta2=unknown["theta2"],
        a=[given.outward(point) for point in places.a],
        b=[given.outward(point) for point in places.b],
        p=[given.outward(point) for point in places.p],
    )


def diagonal(rows: Rows, unknown: Unknowns, places: Places) -> ca.SX:
    """Diagonal of a box around the pivots at all targets."""
    for point in (unknown["o2"], unknown["o4"], *places.a, *places.b, *places.p):
        rows.add("nonnegative", point - unknown["low"], unknown["high"] - point)
    return ca.sqrt(ca.sumsqr(unknown["high"] - unknown["low"]) + 1e-12)


def _nearest(rows: Rows, form: Form, given: Given, unknown: Unknowns, places: Places) -> None:
    """The derivative of a target's square by its driver angle is zero, as the judge will have it.

    With d theta3 / d theta2 = N / D from the loop projected on O4B, multiplied by D. Timed targets
    have one driver angle: the sum of their derivatives is zero.
    """
    o2, o4, total = unknown["o2"], unknown["o4"], ca.SX(0)
    for k in np.flatnonzero(form.nearest).tolist():
        a, b, p = places.a[k], places.b[k], places.p[k]
        d, n = ca.dot(b - o4, quarter_turn(b - a)), -ca.dot(b - o4, quarter_turn(a - o2))
        row = ca.SX(0)
        if form.positions[k]:
            missed = given.square_weights[k] * (p - given.target(k))
            row += d * ca.dot(missed, quarter_turn(a - o2)) + n * ca.dot(missed, quarter_turn(p - a))
        if form.angles[k]:
            row += n * given.square_weights[form.targets + k] * _off(given, unknown, k)
        if form.timed:
            total += row / d
        else:
            rows.add("zero", ca.sqrt(given.error_scale) * row)
    if form.timed and any(form.nearest):
        rows.add("zero", ca.sqrt(given.error_scale) * total)


def _error(rows: Rows, form: Form, given: Given, unknown: Unknowns, places: Places) -> None:
    """The squares as a whole, or each target's, are bounded, as shares of what is allowed."""
    if form.most_error:
        rows.add("nonnegative", 1 - square(form, given, unknown, places) / given.most_error)
    for k in range(form.targets if form.zoned else 0):
        if form.positions[k]:
            gap2 = ca.sumsqr(places.p[k] - given.target(k))
            rows.require("within", 1 - gap2 / given.zones[k] ** 2)
        if form.angles[k]:
            share = _off(given, unknown, k) / given.zones[form.targets + k]
            rows.require("within", 1 - share**2)


def _off(given: Given, unknown: Unknowns, k: int) -> ca.SX:
    """By how much the body is turned from where a pose has it."""
    return unknown["theta3"][k] + unknown["body_angle"] - given.turns[k]


def _rotatability(rows: Rows, given: Given, r: ca.SX) -> None:
    margin, longer, total = given.margin, given.longer * (r[0] - r[1]), ca.sum1(r)
    rows.require(
        "rotatability",
        (r[2] + r[3] - r[0] - r[1]) / total - margin,
        (longer - (r[2] - r[3])) / total - margin,
        (longer + (r[2] - r[3])) / total - margin,
    )


def _transmission(rows: Rows, form: Form, unknown: Unknowns, places: Places) -> None:
    """cos(tau) bounds |cos(mu)|, which is monotone between the ends of the way and the ground line."""
    r, o4, tau = unknown["r"], unknown["o4"], unknown["tau"]

    def bound(diagonal2: ca.SX) -> tuple[ca.SX, ca.SX]:
        cos_mu = (r[2] ** 2 + r[3] ** 2 - diagonal2) / (2 * r[2] * r[3])
        return ca.cos(tau) - cos_mu, ca.cos(tau) + cos_mu

    rows.add("folded", *bound((r[0] - r[1]) ** 2))
    rows.add("stretched", *bound((r[0] + r[1]) ** 2))
    if form.over_task:
        for at_a in (places.a[0], places.a[-1]):
            rows.add("nonnegative", *bound(ca.sumsqr(at_a - o4)))
        rows.add("first", unknown["theta2"][0] - unknown["theta1"])
        rows.add("last", unknown["theta2"][form.targets - 1] - unknown["theta1"])


def _keep_out(rows: Rows, form: Form, given: Given, unknown: Unknowns, places: Places) -> None:
    """Every half-plane of its free region holds each point that keeps out."""
    where = {"o2": [unknown["o2"]], "o4": [unknown["o4"]], "a": places.a, "b": places.b, "p": places.p}
    held = [place for name in form.keep_out for place in where[name]]
    planes = ca.reshape(given.planes, 3, PLANES * len(held))
    for k, place in enumerate(held):
        for plane in ca.horzsplit(planes[:, PLANES * k : PLANES * (k + 1)]):
            rows.require("keep_out", ca.dot(plane[:2], place) - plane[2])


def unit(angle: ca.SX) -> ca.SX:
    """Unit vector in a direction."""
    return ca.vertcat(ca.cos(angle), ca.sin(angle))


def rotated(vector: ca.SX, angle: ca.SX) -> ca.SX:
    """A vector turned by an angle."""
    cos, sin = ca.cos(angle), ca.sin(angle)
    return ca.vertcat(cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1])


def quarter_turn(vector: ca.SX) -> ca.SX:
    """A vector turned by 90 degrees, counter-clockwise."""
    return ca.vertcat(-vector[1], vector[0])


def cross(first: ca.SX, second: ca.SX) -> ca.SX:
    """Cross product of two plane vectors."""
    return first[0] * second[1] - first[1] * second[0]
