"""The nonlinear programme of four-bar motion generation: every requirement as a constraint.

Unknowns are the pivots (moving ones at the first pose), the link lengths, the ground direction,
the driver angle at every pose and the worst transmission angle. Angles are lifted, so order is a
linear constraint and no square root or arc function is differentiated.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from grashof.problems import Box, Requirements, Rotatability, TransmissionOver
from grashof.problems.checks import FloatArray, Limits
from grashof.synth.burmester import Displacements
from grashof.synth.screen import GROUPS
from grashof.synth.start import Start

FAR = 1e3  # sizes: stands for "no limit"
INSET = 1e-8  # sizes, rad: limits are tightened by this much, so that the polished design keeps them
LEAST_STEP = 1e-4  # rad, of the driver between two targets
ANGLES = ("ground_angle_deg", "theta2_start_deg")  # equalities: fixed unknowns unless they are relaxed
LEAST_TRANSMISSION = 1e-3  # rad: keeps the motion away from dead positions


@dataclass(frozen=True, slots=True)
class Form:
    """What the programme contains; one is built, and kept, for each form.

    Parameters
    ----------
    poses : int
    crank : bool
        The driver turns fully.
    same_branch : bool
    over_task : bool
        Transmission is judged over the task, not over the turn.
    ratio, box_a, box_b, compact : bool
        Whether these requirements, and the size, have a part in it.
    stay : bool
        The distance from the start is the objective.
    elastic : bool
        Requirements may be missed; how far is the objective.
    """

    poses: int
    crank: bool
    same_branch: bool
    over_task: bool
    ratio: bool
    box_a: bool
    box_b: bool
    compact: bool
    stay: bool
    elastic: bool

    @classmethod
    def of(cls, wanted: Requirements, start: Start) -> Form:
        """The form that requirements (in the frame of the search) and a start call for."""
        low = min(limits[0] for limits in wanted.link_lengths)
        high = max(limits[1] for limits in wanted.link_lengths)
        return cls(
            poses=len(start.visit),
            crank=wanted.rotatability is not Rotatability.ANY,
            same_branch=wanted.same_branch,
            over_task=wanted.transmission_over is TransmissionOver.TASK,
            ratio=bool(start.relaxed) or high > low * wanted.link_ratio_max,
            box_a=wanted.a != Box() and wanted.a is not None,
            box_b=wanted.b != Box() and wanted.b is not None,
            compact=start.objective.compactness > 0 and not start.stay,
            stay=start.stay,
            elastic=bool(start.relaxed),
        )


@dataclass(frozen=True, slots=True)
class Solve:
    """What came of one solve; the solver's word is recorded, not believed.

    Parameters
    ----------
    points : tuple of complex
        O2, O4, and A, B at the first pose, in the frame of the search.
    status : str
        Ipopt's return status.
    iterations : int
    """

    points: tuple[complex, complex, complex, complex]
    status: str
    iterations: int


def solve(
    motion: Displacements,
    body: complex,
    wanted: Requirements,
    start: Start,
    max_iter: int = 150,
) -> Solve:
    """Run Ipopt from one start.

    Parameters
    ----------
    motion : Displacements
    body : complex
        The guided point at the first pose.
    wanted : Requirements
        In the frame of the search.
    start : Start
    max_iter : int

    Returns
    -------
    Solve
    """
    programme = _programme(Form.of(wanted, start), max_iter)
    guess = _guess(programme.form, motion, body, start)
    lbx, ubx = _unknown_limits(programme.form, wanted, start)
    lbg, ubg = _constraint_limits(programme, start)
    parameters = _parameters(motion, body, wanted, start)
    answer = programme.solver(x0=np.clip(guess, lbx, ubx), lbx=lbx, ubx=ubx, lbg=lbg, ubg=ubg, p=parameters)
    stats = programme.solver.stats()
    found = np.asarray(answer["x"]).ravel()[:8]
    o2, o4, a, b = (complex(x, y) for x, y in found.reshape(4, 2))
    return Solve((o2, o4, a, b), str(stats["return_status"]), int(stats["iter_count"]))


@dataclass(slots=True)
class _Rows:
    """Constraints as they are collected: expressions, and the name that their limits go by."""

    slack: ca.SX | None
    relaxed: ca.SX
    expressions: list[ca.SX] = field(default_factory=list)
    names: list[str] = field(default_factory=list)

    def add(self, name: str, *expressions: ca.SX) -> None:
        for expression in expressions:
            self.expressions.append(expression)
            self.names += [name] * expression.numel()

    def require(self, group: str, *expressions: ca.SX, name: str = "nonnegative") -> None:
        """Expressions that must not be negative, but by the slack where the group is relaxed."""
        give = 0.0 if self.slack is None else self.slack * self.relaxed[GROUPS.index(group)]
        self.add(name, *(expression + give for expression in expressions))


@dataclass(frozen=True, slots=True)
class _Programme:
    form: Form
    solver: ca.Function
    names: tuple[str, ...]


_IPOPT = {
    "print_level": 0,
    "sb": "yes",
    "tol": 1e-8,
    "constr_viol_tol": 1e-10,
    "acceptable_iter": 5,
    "acceptable_tol": 1e-6,
    "acceptable_constr_viol_tol": 1e-9,
    "bound_relax_factor": 0.0,
    "bound_push": 1e-6,
    "bound_frac": 1e-6,
    "mu_init": 1e-3,
    "mumps_pivot_order": 0,
    "max_wall_time": 10.0,
}


@lru_cache(maxsize=32)
def _programme(form: Form, max_iter: int) -> _Programme:
    n = form.poses
    x, unknown = _unknowns(form)
    given = _Given.symbols(n)
    rows = _Rows(unknown.get("slack"), given.relaxed)
    o2, o4, a, b, r = (unknown[name] for name in ("o2", "o4", "a", "b", "r"))
    theta2, tau = unknown["theta2"], unknown["tau"]
    places = [(given.displaced(a, k), given.displaced(b, k)) for k in range(n)]
    _closure(rows, unknown, places)
    for k in range(n - 1):
        rows.add("step", given.direction * (theta2[k + 1] - theta2[k]))
    rows.add("turn", given.direction * (theta2[n - 1] - theta2[0]))
    if form.same_branch:
        for at_a, at_b in places:
            sine = _cross(at_b - at_a, at_b - o4) / (r[2] * r[3])
            rows.require("same_branch", given.assembly * sine - 1e-6)
    if form.crank:
        margin = given.margin * ca.sum1(r)
        longer = given.longer * (r[0] - r[1])
        rows.require(
            "rotatability",
            r[2] + r[3] - r[0] - r[1] - margin,
            longer - (r[2] - r[3]) - margin,
            longer + (r[2] - r[3]) - margin,
        )
    _transmission(rows, form, unknown, places)
    for point in (a, b):
        arm2 = ca.sumsqr(point - given.body)
        rows.require("coupler_arms", arm2 - given.arms[0] ** 2, given.arms[1] ** 2 - arm2)
    if form.ratio:
        pairs = [(i, j) for i in range(4) for j in range(4) if i != j]
        rows.require("link_ratio_max", *(r[i] - r[j] / given.ratio for i, j in pairs))
    for wished, name, which in ((form.box_a, "a", 0), (form.box_b, "b", 1)):
        if wished:
            for place in places:
                rows.require(name, place[which] - given.box[name][0], given.box[name][1] - place[which])
    cost = -given.weights[0] * tau / (np.pi / 2)
    if form.compact:
        cost += given.weights[1] * _diagonal(rows, given, unknown, places)
    if form.stay:
        cost = ca.sumsqr(ca.vertcat(o2, o4, a, b) - given.start)
    if form.elastic:
        rows.require("link_length", r - given.lengths[:4], given.lengths[4:] - r)
        rows.require("o2", o2 - given.box["o2"][0], given.box["o2"][1] - o2)
        rows.require("o4", o4 - given.box["o4"][0], given.box["o4"][1] - o4)
        rows.require("transmission_min_deg", tau - given.least_transmission)
        at_first = ca.dot(given.at_first, theta2)
        for i, (key, angle) in enumerate(zip(ANGLES, (unknown["theta1"], at_first), strict=True)):
            rows.require(key, angle - given.angles[i], given.angles[i] - angle, name=key)
        cost = unknown["slack"]
    programme = {"x": x, "p": given.vector, "f": cost, "g": ca.vertcat(*rows.expressions)}
    options: dict[str, Any] = {
        "print_time": False,
        "show_eval_warnings": False,
        "ipopt": {**_IPOPT, "max_iter": max_iter},
    }
    solver = ca.nlpsol("four_bar_motion", "ipopt", programme, options)
    return _Programme(form, solver, tuple(rows.names))


def _unknowns(form: Form) -> tuple[ca.SX, dict[str, ca.SX]]:
    sizes = {"o2": 2, "o4": 2, "a": 2, "b": 2, "r": 4, "theta1": 1, "theta2": form.poses, "tau": 1}
    if form.compact:
        sizes |= {"low": 2, "high": 2}
    if form.elastic:
        sizes |= {"slack": 1}
    unknown = {name: ca.SX.sym(name, size) for name, size in sizes.items()}
    return ca.vertcat(*unknown.values()), unknown


def _closure(rows: _Rows, unknown: dict[str, ca.SX], places: list[tuple[ca.SX, ca.SX]]) -> None:
    o2, o4, r, theta1, theta2 = (unknown[name] for name in ("o2", "o4", "r", "theta1", "theta2"))
    for k, (at_a, at_b) in enumerate(places):
        rows.add("zero", at_a - o2 - r[1] * _unit(theta2[k]), (ca.sumsqr(at_b - o4) - r[3] ** 2) / 2)
    rows.add("zero", o4 - o2 - r[0] * _unit(theta1))
    rows.add("zero", (ca.sumsqr(unknown["b"] - unknown["a"]) - r[2] ** 2) / 2)


def _transmission(
    rows: _Rows, form: Form, unknown: dict[str, ca.SX], places: list[tuple[ca.SX, ca.SX]]
) -> None:
    """cos(tau) bounds |cos(mu)|, which is monotone between the ends of the way and the ground line."""
    r, o4, tau = unknown["r"], unknown["o4"], unknown["tau"]

    def bound(diagonal2: ca.SX) -> tuple[ca.SX, ca.SX]:
        cos_mu = (r[2] ** 2 + r[3] ** 2 - diagonal2) / (2 * r[2] * r[3])
        return ca.cos(tau) - cos_mu, ca.cos(tau) + cos_mu

    rows.add("folded", *bound((r[0] - r[1]) ** 2))
    rows.add("stretched", *bound((r[0] + r[1]) ** 2))
    if form.over_task:
        for at_a, _ in (places[0], places[-1]):
            rows.add("nonnegative", *bound(ca.sumsqr(at_a - o4)))
        rows.add("first", unknown["theta2"][0] - unknown["theta1"])
        rows.add("last", unknown["theta2"][form.poses - 1] - unknown["theta1"])


def _diagonal(
    rows: _Rows, given: _Given, unknown: dict[str, ca.SX], places: list[tuple[ca.SX, ca.SX]]
) -> ca.SX:
    """Diagonal of a box around the pivots at all poses."""
    corners = [unknown["o2"], unknown["o4"], *(point for pair in places for point in pair)]
    corners += [given.displaced(given.body, k) for k in range(len(places))]
    for point in corners:
        rows.add("nonnegative", point - unknown["low"], unknown["high"] - point)
    return ca.sqrt(ca.sumsqr(unknown["high"] - unknown["low"]) + 1e-12)


@dataclass(frozen=True, slots=True)
class _Given:
    """The parameters of the programme, cut from one vector; `_parameters` fills it."""

    vector: ca.SX
    rotation: ca.SX
    shift: ca.SX
    body: ca.SX
    direction: ca.SX
    assembly: ca.SX
    longer: ca.SX
    margin: ca.SX
    ratio: ca.SX
    least_transmission: ca.SX
    weights: ca.SX
    arms: ca.SX
    lengths: ca.SX
    start: ca.SX
    angles: ca.SX
    at_first: ca.SX
    box: dict[str, tuple[ca.SX, ca.SX]]
    relaxed: ca.SX

    @classmethod
    def symbols(cls, poses: int) -> _Given:
        sizes = {
            "rotation": 2 * poses, "shift": 2 * poses, "body": 2, "direction": 1, "assembly": 1, "longer": 1,
            "margin": 1, "ratio": 1, "least_transmission": 1, "weights": 2, "arms": 2, "lengths": 8,
            "start": 8, "angles": 2, "at_first": poses, "boxes": 16, "relaxed": len(GROUPS),
        }  # fmt: skip
        parts = {name: ca.SX.sym(name, size) for name, size in sizes.items()}
        vector = ca.vertcat(*parts.values())
        boxes = ca.reshape(parts.pop("boxes"), 2, 8)
        box = {name: (boxes[:, 2 * i], boxes[:, 2 * i + 1]) for i, name in enumerate(("o2", "o4", "a", "b"))}
        return cls(vector=vector, box=box, **parts)

    def displaced(self, point: ca.SX, pose: int) -> ca.SX:
        cos, sin = self.rotation[2 * pose], self.rotation[2 * pose + 1]
        turned = ca.vertcat(cos * point[0] - sin * point[1], sin * point[0] + cos * point[1])
        return turned + self.shift[2 * pose : 2 * pose + 2]


def _parameters(
    motion: Displacements,
    body: complex,
    wanted: Requirements,
    start: Start,
) -> FloatArray:
    visit = list(start.visit)
    r1, r2, _, _ = start.lengths
    longer = {Rotatability.CRANK_ROCKER: 1.0, Rotatability.DOUBLE_CRANK: -1.0}
    lengths = np.array(wanted.link_lengths)
    corners = []
    for box in (wanted.o2, wanted.o4, wanted.a, wanted.b):
        x, y = _near((box or Box()).x), _near((box or Box()).y)
        corners += [x[0], y[0], x[1], y[1]]
    return np.concatenate([
        _interleaved(motion.rotation[visit]),
        _interleaved(motion.shift[visit]),
        [body.real, body.imag, start.direction, start.assembly],
        [longer.get(wanted.rotatability, 1.0 if r1 > r2 else -1.0)],
        [wanted.rotatability_margin + INSET, wanted.link_ratio_max],
        [np.radians(wanted.transmission_min_deg)],
        [start.objective.transmission, start.objective.compactness],
        _inset(wanted.coupler_arms or (0.0, FAR)),
        lengths.T.ravel(),
        _interleaved(start.points),
        [_lifted(wanted.ground_angle_deg, start.theta1)],
        [_lifted(wanted.theta2_start_deg, start.theta2[visit.index(0)])],
        [float(pose == 0) for pose in visit],
        corners,
        [float(group in start.relaxed) for group in GROUPS],
    ])  # fmt: skip


def _guess(form: Form, motion: Displacements, body: complex, start: Start) -> FloatArray:
    points = start.points
    guess = [*_interleaved(points), *start.lengths, start.theta1, *start.theta2, 0.0]
    if form.compact:
        places = motion.apply(np.array([start.a, start.b, body])).ravel()
        every = np.concatenate([points[:2], places])
        guess += [every.real.min(), every.imag.min(), every.real.max(), every.imag.max()]
    if form.elastic:
        guess += [1.0]
    return np.array(guess)


def _unknown_limits(form: Form, wanted: Requirements, start: Start) -> tuple[FloatArray, FloatArray]:
    limits: list[Limits] = []
    for point, box in ((start.o2, wanted.o2), (start.o4, wanted.o4), (start.a, None), (start.b, None)):
        sides = (box.x, box.y) if box is not None and not form.elastic else ((-FAR, FAR), (-FAR, FAR))
        for middle, side in zip((point.real, point.imag), sides, strict=True):
            low, high = _near(_inset(side))
            limits.append((max(low, middle - start.radius), min(high, middle + start.radius)))
    for low, high in wanted.link_lengths:
        limits.append((1e-6, FAR) if form.elastic else _inset((max(low, 1e-6), min(high, FAR))))
    ground, first = (None if key in start.relaxed else getattr(wanted, key) for key in ANGLES)
    limits.append(_turned(ground, start.theta1))
    for k, pose in enumerate(start.visit):
        limits.append(_turned(first if pose == 0 else None, start.theta2[k]))
    least = 0.0 if form.elastic else np.radians(wanted.transmission_min_deg) + INSET
    limits.append((max(LEAST_TRANSMISSION, least), np.pi / 2))
    limits += [(-FAR, FAR)] * (4 * form.compact) + [(0.0, FAR)] * form.elastic
    low_high = np.array(limits)
    return low_high[:, 0], low_high[:, 1]


def _constraint_limits(programme: _Programme, start: Start) -> tuple[FloatArray, FloatArray]:
    first, last = start.half_turns
    low, high = min(first, last) + 1, max(first, last)
    passed = {number % 2 for number in range(low, high + 1)}
    cycle = not programme.form.over_task
    free = (-np.inf, np.inf)
    limits = {
        "zero": (0.0, 0.0),
        "nonnegative": (0.0, np.inf),
        "step": (LEAST_STEP, np.inf),
        "turn": (0.0, 2 * np.pi),
        "folded": (0.0, np.inf) if cycle or 0 in passed else free,
        "stretched": (0.0, np.inf) if cycle or 1 in passed else free,
        "first": (first * np.pi, (first + 1) * np.pi),
        "last": (last * np.pi, (last + 1) * np.pi),
        **{key: (0.0, np.inf) if key in start.relaxed else free for key in ANGLES},
    }
    both = np.array([limits[name] for name in programme.names])
    return both[:, 0], both[:, 1]


def _turned(required_deg: float | None, start: float) -> Limits:
    """Limits of a lifted angle: fixed at the required angle, or free."""
    if required_deg is None:
        return -10 * np.pi, 10 * np.pi
    return _lifted(required_deg, start), _lifted(required_deg, start)


def _lifted(required_deg: float | None, start: float) -> float:
    """The required angle (0 where none is) in rad, moved by whole turns to be nearest to `start`."""
    off = (np.radians(required_deg or 0.0) - start + np.pi) % (2 * np.pi) - np.pi
    return float(start + off)


def _inset(limits: Limits) -> Limits:
    low, high = limits
    return (low + INSET, high - INSET) if high - low > 4 * INSET else limits


def _near(limits: Limits) -> Limits:
    return max(limits[0], -FAR), min(limits[1], FAR)


def _interleaved(points: np.ndarray) -> FloatArray:
    return np.stack([points.real, points.imag], axis=-1).ravel()


def _unit(angle: ca.SX) -> ca.SX:
    return ca.vertcat(ca.cos(angle), ca.sin(angle))


def _cross(first: ca.SX, second: ca.SX) -> ca.SX:
    return first[0] * second[1] - first[1] * second[0]
