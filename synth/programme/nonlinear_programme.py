"""The nonlinear programme of a four-bar: built once for each form, solved by Ipopt from a start."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from grashof.analysis.judge.design import Constraint
from grashof.problems import Box, Rotatability
from grashof.problems.values.arrays import ComplexArray, FloatArray, Limits
from grashof.synth.programme.constraints import (
    ANGLES,
    Rows,
    close_at_points,
    close_at_poses,
    diagonal,
    require_all,
    require_limits,
    require_own,
    square,
)
from grashof.synth.programme.drive_torque import loads, torque_bound, torque_peaks
from grashof.synth.programme.one_at_a_time import one_at_a_time
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.screening import GROUPS
from grashof.synth.programme.start import LENGTHS, Start
from grashof.synth.programme.structure import ADDED, Form, Given, Unknowns

MOST_ITERATIONS = 150
PATIENCE = (250, 400)  # iterations where the error is bounded: of what a list offers, and where that is asked
FAR = 1e3  # sizes: stands for "no limit"
INSET = 1e-8  # sizes, rad: limits are tightened by this much, so that the polished design keeps them
MOST_ZONE = 0.5  # sizes, rad: greater ones leave the solver astray
ZONE_INSET = 1e-7  # share of a zone that the programme leaves to the judge
LEAST_STEP = 1e-4  # rad, of the driver between two targets that are both met
LEAST_TRANSMISSION = 1e-3  # rad: keeps the motion away from dead positions
SLIGHT = 1e-6  # weight of the error beside the slack
LEAST_SQUARE = 1e-8  # sizes squared: scales the squared distances to about 1


@dataclass(frozen=True, slots=True)
class Solve:
    """What came of one solve; the solver's word is recorded, not believed.

    Parameters
    ----------
    points : tuple of complex
        O2, O4, and A, B, P at the first target, in the frame of the search.
    theta2, theta3 : tuple of float, rad
        Driver and coupler angles in the order of visit.
    body_angle : float, rad
        See `Start`.
    status : str
        Ipopt's return status.
    iterations : int
    torque : float
        The greatest that the programme knows of, in reference torques; NaN where it has no part.
    """

    points: tuple[complex, complex, complex, complex, complex]
    theta2: tuple[float, ...]
    theta3: tuple[float, ...]
    body_angle: float
    status: str
    iterations: int
    torque: float = np.nan


@one_at_a_time
def solve(scaled: ScaledProblem, start: Start, max_iter: int | None = None) -> Solve:
    """Run Ipopt from one start.

    Parameters
    ----------
    scaled : ScaledProblem
    start : Start
    max_iter : int, optional
        More than usual by default where the error is bounded.

    Returns
    -------
    Solve
    """
    patience = PATIENCE[scaled.bounded] if start.bounded else MOST_ITERATIONS
    most = patience if max_iter is None else max_iter
    programme = _programme(Form.of(scaled, start), most, scaled.constraints)
    form = programme.form
    guess = _guess(form, scaled, start)
    lbx, ubx = _unknown_limits(form, scaled, start)
    lbg, ubg = _constraint_limits(programme, scaled, start)
    fixed = np.count_nonzero(lbx == ubx) + np.count_nonzero(lbg == ubg)
    if (lbx > ubx).any() or fixed > len(lbx):  # the limits leave nothing to solve for
        points = (start.o2, start.o4, start.a, start.b, start.p)
        return Solve(points, start.theta2, start.theta3, start.body_angle, "Contradictory_Limits", 0)
    parameters = _parameters(form, scaled, start)
    answer = programme.solver(x0=np.clip(guess, lbx, ubx), lbx=lbx, ubx=ubx, lbg=lbg, ubg=ubg, p=parameters)
    stats = programme.solver.stats()
    x = np.asarray(answer["x"]).ravel()
    o2, o4, a, b = (complex(*pair) for pair in x[:8].reshape(4, 2))
    n, p, theta3, body_angle = form.targets, complex(scaled.targets[0]), start.theta3, start.body_angle
    if not form.poses:
        theta3, arm = tuple(x[14 + n : 14 + 2 * n].tolist()), complex(*x[14 + 2 * n : 16 + 2 * n])
        p = a + arm * np.exp(1j * theta3[start.visit.index(0)])
    if any(form.angles) and not form.poses:
        body_angle = float(x[16 + 2 * n])
    return Solve(
        points=(o2, o4, a, b, p),
        theta2=tuple(x[13 : 13 + n].tolist()),
        theta3=theta3,
        body_angle=body_angle,
        status=str(stats["return_status"]),
        iterations=int(stats["iter_count"]),
        torque=float(x[-1]) * _torque(form, scaled, start) if form.torque else np.nan,
    )


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
def _programme(form: Form, max_iter: int, constraints: tuple[Constraint, ...]) -> _Programme:
    unknown, given = Unknowns.of(form), Given.of(form)
    rows = Rows(unknown["slack"] if form.elastic else None, given.relaxed)
    if form.poses:
        places = close_at_poses(rows, given, unknown)
    else:
        places = close_at_points(rows, form, given, unknown)
    require_all(rows, form, given, unknown, places)
    require_own(rows, given, unknown, places, constraints)
    cost = -given.weights[0] * unknown["tau"] / (np.pi / 2)
    if form.compact:
        cost += given.weights[1] * diagonal(rows, unknown, places)
    if form.torque:
        cost += given.weights[2] * torque_bound(rows, form, given, unknown, places)
    if form.fits:  # the error comes first; the rest only settles what the error leaves open
        cost = given.error_scale * square(form, given, unknown, places) - 1e-8 * unknown["tau"]
    if form.stay:
        moved = ca.vertcat(*(unknown[name] for name in ("o2", "o4", "a", "b"))) - given.start
        cost = ca.sumsqr(moved)
    if form.elastic:
        require_limits(rows, given, unknown)
        cost = unknown["slack"]
        if not form.exact:  # of equal slack the smaller error
            cost += SLIGHT * given.error_scale * square(form, given, unknown, places)
    programme = {"x": unknown.vector, "p": given.vector, "f": cost, "g": ca.vertcat(*rows.expressions)}
    options: dict[str, Any] = {
        "print_time": False,
        "show_eval_warnings": False,
        "calc_lam_p": False,
        "ipopt": {**_IPOPT, "max_iter": max_iter},
    }
    solver = ca.nlpsol("four_bar", "ipopt", programme, options)
    return _Programme(form, solver, tuple(rows.names))


def _parameters(form: Form, scaled: ScaledProblem, start: Start) -> FloatArray:
    wanted, visit = scaled.wanted, list(start.visit)
    r1, r2, _, _ = start.lengths
    torque, best = _torque(form, scaled, start), start.objective
    weights = np.array([best.transmission, best.compactness, best.torque * torque])
    longer = {Rotatability.CRANK_ROCKER: 1.0, Rotatability.DOUBLE_CRANK: -1.0}
    none = np.zeros(form.targets, dtype=np.complex128)
    corners = []
    for box in (wanted.o2, wanted.o4, wanted.a, wanted.b):
        x, y = _near((box or Box()).x), _near((box or Box()).y)
        corners += [x[0], y[0], x[1], y[1]]
    return np.concatenate([
        _interleaved(none if scaled.motion is None else scaled.motion.rotation[visit]),
        _interleaved(none if scaled.motion is None else scaled.motion.shift[visit]),
        _interleaved(scaled.targets[visit]),
        _turns(scaled, start),
        scaled.weights[visit],
        scaled.turn_weights[visit],
        scaled.timing[visit],
        [float(target == 0) for target in visit],
        _interleaved(scaled.targets[:1]),
        [start.direction, start.assembly],
        [longer.get(wanted.rotatability, 1.0 if r1 > r2 else -1.0)],
        [wanted.rotatability_margin + INSET, wanted.link_ratio_max],
        [np.radians(wanted.transmission_min_deg)],
        weights / weights.sum(),
        loads(scaled.problem, torque),
        np.pad(start.torque_at, (0, ADDED - len(start.torque_at))),
        [1.0 / max(_square(scaled, start), LEAST_SQUARE)],
        _inset(wanted.coupler_arms or (0.0, FAR)),
        np.array(wanted.link_lengths).T.ravel(),
        _interleaved(start.points[:4]),
        [_lifted(wanted.ground_angle_deg, start.theta1)],
        [_lifted(wanted.theta2_start_deg, start.theta2[visit.index(0)])],
        [float(group in start.relaxed) for group in GROUPS],
        [min(start.most_error, FAR) ** 2 * form.targets],
        _zones(scaled)[:, visit].ravel(),
        [scaled.frame.origin.real, scaled.frame.origin.imag, scaled.frame.scale],
        _planes(form, scaled, start),
        corners,
    ])  # fmt: skip


def _zones(scaled: ScaledProblem) -> FloatArray:
    """How far each target may be missed, drawn in a little: sizes, and rad; shape (2, N)."""
    zones = np.full((2, len(scaled.targets)), FAR) if scaled.zones is None else scaled.zones
    return np.minimum(zones, MOST_ZONE) * (1 - ZONE_INSET)


def _planes(form: Form, scaled: ScaledProblem, start: Start) -> FloatArray:
    """Half-planes of the free regions about the points that keep out of areas."""
    if not form.keep_out:
        return np.zeros(0)
    from grashof.synth.programme.free_region import free_regions

    planes = free_regions(scaled.wanted, start, form.keep_out)
    planes[..., 2] += INSET
    return planes.ravel()


def _guess(form: Form, scaled: ScaledProblem, start: Start) -> FloatArray:
    guess = [*_interleaved(start.points[:4]), *start.lengths, start.theta1, *start.theta2, 0.0]
    if not form.poses:
        arm = start.arm
        guess += [*start.theta3, arm.real, arm.imag]
    if any(form.angles) and not form.poses:
        guess += [start.body_angle]
    if form.compact:
        every = np.concatenate([start.points, start.track.ravel(), scaled.targets])
        guess += [every.real.min(), every.imag.min(), every.real.max(), every.imag.max()]
    if form.torque:
        guess += [1.0]
    if form.elastic:
        guess += [1.0]
    return np.array(guess)


def _torque(form: Form, scaled: ScaledProblem, start: Start) -> float:
    """Unit of the programme's torque: its peak at the start, in reference torques."""
    if not form.torque:
        return 1.0
    way, sense, sign = (np.array([each]) for each in (start.theta2, start.direction, start.assembly))
    peak = float(torque_peaks(scaled.problem, start.points[None], way, sense, sign, form.torque)[0])
    return peak if 1e-9 < peak < np.inf else 1.0


def _square(scaled: ScaledProblem, start: Start) -> float:
    """Weighted squares that the start misses its targets by."""
    order = np.argsort(start.visit)
    turned = np.array(start.theta3)[order] + start.body_angle
    return float(scaled.missed(start.track[2][order], turned)) ** 2 * len(order)


def _turns(scaled: ScaledProblem, start: Start) -> FloatArray:
    """Angles of the body in the order of visit, moved by whole turns to be nearest to the start."""
    turned = np.array(start.theta3) + start.body_angle
    off = scaled.turns[list(start.visit)] - turned
    nearest: FloatArray = turned + np.angle(np.exp(1j * off))
    return nearest


def _unknown_limits(form: Form, scaled: ScaledProblem, start: Start) -> tuple[FloatArray, FloatArray]:
    wanted, limits = scaled.wanted, list[Limits]()
    boxed = (
        ("o2", start.o2, wanted.o2 or Box()),
        ("o4", start.o4, wanted.o4 or Box()),
        ("a", start.a, None),
        ("b", start.b, None),
    )
    for name, point, box in boxed:
        for axis, middle in (("x", point.real), ("y", point.imag)):
            loose = box is None or (form.elastic and not start.holds(f"{name}.{axis}"))
            low, high = _near(_inset((-FAR, FAR) if loose else getattr(box, axis)))
            limits.append((max(low, middle - start.radius), min(high, middle + start.radius)))
    for name, (low, high) in zip(LENGTHS, wanted.link_lengths, strict=True):
        loose = form.elastic and not start.holds(name)
        limits.append((1e-6, FAR) if loose else _inset((max(low, 1e-6), min(high, FAR))))
    ground, first = (None if key in start.relaxed else getattr(wanted, key) for key in ANGLES)
    limits.append(_turned(ground, start.theta1))
    for k, target in enumerate(start.visit):
        limits.append(_turned(first if target == 0 else None, start.theta2[k]))
    least = np.radians(wanted.transmission_min_deg) + INSET + start.more_transmission
    least = 0.0 if form.elastic else min(least, np.pi / 2 - INSET)
    limits.append((max(LEAST_TRANSMISSION, least), np.pi / 2))
    if not form.poses:
        limits += [(-100.0, 100.0)] * form.targets + [(-FAR, FAR)] * 2
        limits += [(-100.0, 100.0)] * any(form.angles)
    limits += [(-FAR, FAR)] * (4 * form.compact) + [(0.0, np.inf)] * (form.torque > 0)
    limits += [(0.0, FAR)] * form.elastic
    low_high = np.array(limits)
    return low_high[:, 0], low_high[:, 1]


def _constraint_limits(
    programme: _Programme, scaled: ScaledProblem, start: Start
) -> tuple[FloatArray, FloatArray]:
    first, last = start.half_turns
    low, high = min(first, last) + 1, max(first, last)
    passed = {number % 2 for number in range(low, high + 1)}
    cycle = not programme.form.over_task
    free = (-np.inf, np.inf)
    # Where only the error counts, a crank may start and end in any half turn.
    bare = programme.form.fits and programme.form.crank and scaled.wanted.transmission_min_deg == 0
    limits = {
        "zero": (0.0, 0.0),
        "nonnegative": (0.0, np.inf),
        "step": (LEAST_STEP if programme.form.exact else 0.0, np.inf),
        "turn": (0.0, 2 * np.pi),
        "folded": (0.0, np.inf) if cycle or (0 in passed and not bare) else free,
        "stretched": (0.0, np.inf) if cycle or (1 in passed and not bare) else free,
        "first": free if bare else (first * np.pi, (first + 1) * np.pi),
        "last": free if bare else (last * np.pi, (last + 1) * np.pi),
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


def _interleaved(points: ComplexArray) -> FloatArray:
    return np.stack([points.real, points.imag], axis=-1).ravel()
