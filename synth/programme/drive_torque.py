"""Drive torque as CasADi symbols, by the power that the links' inertia and weight take."""

from __future__ import annotations

from functools import lru_cache

import casadi as ca
import numpy as np

from grashof.problems import Problem
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray
from grashof.problems.values.dynamics_spec import metres
from grashof.synth.programme.constraints import Places, Rows, cross, unit
from grashof.synth.programme.structure import ADDED, LOADS, Form, Given, Unknowns

SCREENED = 25  # driver angles where many linkages are compared
LOOKED_AT = 30 * SCREENED  # driver angles where one linkage is looked at
AGREES = 2e-3  # share of its bound by which a torque may exceed it


def loads(problem: Problem, scale: float) -> FloatArray:
    """What drives the torque, shape (LOADS,); `scale`, in reference torques, is what the torque comes in.

    Acceleration of a point one size from O2 in a steady turn and gravity (x, y), m/s2; then, over
    that torque: mass of a bar one size long, of links 2, 3, 4 besides, inertia of links 3 and 4,
    payload.
    """
    spec = problem.dynamics
    if spec is None:
        return np.zeros(LOADS)
    size = problem.task.size
    radius = size * metres(problem.length_unit)
    masses, inertias = spec.masses or (0.0, 0.0, 0.0), spec.inertias or (0.0, 0.0, 0.0)
    bar = (spec.mass_per_length or 0.0) * size
    moved = np.array([bar, *masses, *(np.array(inertias[1:]) / size**2), spec.payload])
    per_torque = radius / (problem.reference_torque * scale)
    return np.concatenate([[spec.omega2**2 * radius], spec.gravity, moved * per_torque])


def torque_bound(rows: Rows, form: Form, given: Given, unknown: Unknowns, places: Places) -> ca.SX:
    """What the torque does not exceed at any driver angle of an even grid, and at those added to it."""
    arm, coupler = places.p[0] - places.a[0], places.b[0] - places.a[0]
    r, theta2 = unknown["r"], unknown["theta2"]
    at_coupler = ca.vertcat(ca.dot(coupler, arm), cross(coupler, arm)) / r[2]
    ground = unknown["o4"] - unknown["o2"]
    last = theta2[0] + given.direction * TURN if form.closed else theta2[form.targets - 1]
    shares = [*np.linspace(0, 1, form.torque), *ca.vertsplit(given.torque_at)]
    for angle in (theta2[0] + share * (last - theta2[0]) for share in shares):
        torque = drive_torque(ground, r, at_coupler, given.assembly, angle, given.load)
        rows.add("nonnegative", unknown["peak"] - torque, unknown["peak"] + torque)
    return unknown["peak"]


def drive_torque(
    ground: ca.SX, lengths: ca.SX, arm: ca.SX, assembly: ca.SX, theta2: ca.SX, load: ca.SX
) -> ca.SX:
    """Torque at one driver angle.

    Parameters
    ----------
    ground : SX, shape (2,), sizes
        From O2 to O4.
    lengths : SX, shape (4,), sizes
    arm : SX, shape (2,), sizes
        The coupler point (u, v).
    assembly : SX
    theta2 : SX, rad
    load : SX, shape (LOADS,)
        See `loads`.

    Notes
    -----
    T omega2 = sum of m (a - g) . v + I alpha omega (d'Alembert's principle; Norton, *Design of
    Machinery*, the method of virtual work). With a steady driver every rate is a derivative by
    theta2 times omega2, and those follow from the loop equation. Where the loop does not close the
    torque is not a number, and Ipopt shortens its step.
    """
    r2, r3, r4 = lengths[1], lengths[2], lengths[3]
    inertia, gravity, bar = load[0], load[1:3], load[3]
    crank = r2 * unit(theta2)
    diagonal = ground - crank
    square = ca.sumsqr(diagonal)
    along = (r3**2 - r4**2 + square) / (2 * square)
    coupler = along * diagonal + assembly * ca.sqrt(r3**2 / square - along**2) * _left(diagonal)
    output = coupler - diagonal
    sine = cross(coupler, output)
    speed3, speed4 = (-ca.dot(_left(crank), link) / sine for link in (output, coupler))
    bend = -crank - speed3**2 * coupler + speed4**2 * output
    rate3, rate4 = (-ca.dot(bend, link) / sine for link in (output, coupler))

    def power(mass: ca.SX, on_coupler: ca.SX) -> ca.SX:
        """Of a mass that moves with the coupler, at a place from A."""
        velocity = _left(crank) + speed3 * _left(on_coupler)
        acceleration = -crank + rate3 * _left(on_coupler) - speed3**2 * on_coupler
        return mass * ca.dot(inertia * acceleration - gravity, velocity)

    mass2, mass3, mass4 = (load[4 + k] + bar * length for k, length in enumerate((r2, r3, r4)))
    inertia3 = load[7] + bar * r3**3 / 12
    inertia4 = load[8] + bar * r4**3 / 12 + mass4 * r4**2 / 4  # about O4
    return (
        -mass2 * ca.dot(gravity, _left(crank)) / 2
        + power(mass3, coupler / 2)
        + power(load[9], (arm[0] * coupler + arm[1] * _left(coupler)) / r3)
        - mass4 * speed4 * ca.dot(gravity, _left(output)) / 2
        + inertia * (inertia3 * speed3 * rate3 + inertia4 * speed4 * rate4)
    )


def torque_peaks(
    problem: Problem,
    points: ComplexArray,
    theta2: FloatArray,
    direction: FloatArray,
    assembly: FloatArray,
    count: int,
) -> FloatArray:
    """Greatest magnitude at an even grid over the motion that each linkage is used in.

    Parameters
    ----------
    problem : Problem
    points : ndarray of complex, shape (n, 5), sizes
    theta2 : ndarray, shape (n, N), rad
        In the order of visit.
    direction, assembly : ndarray, shape (n,)
    count : int
        Driver angles that are looked at.

    Returns
    -------
    ndarray, shape (n,)
        In reference torques; infinite where a linkage does not close.
    """
    peaks: FloatArray = _curves(problem, points, theta2, direction, assembly, count).max(axis=1)
    return peaks


def overlooked(
    problem: Problem, points: ComplexArray, theta2: FloatArray, direction: int, assembly: int, bound: float
) -> list[float]:
    """Where a linkage's torque has peaks above a bound, as shares of the motion; the worst few.

    Parameters
    ----------
    problem : Problem
    points : ndarray of complex, shape (5,), sizes
    theta2 : ndarray, shape (N,), rad
        In the order of visit.
    direction, assembly : int
    bound : float
        In reference torques.
    """
    sense, sign = np.array([direction]), np.array([assembly])
    (curve,) = _curves(problem, points[None], theta2[None], sense, sign, LOOKED_AT)
    beside = np.concatenate([[-np.inf], curve, [-np.inf]])
    peaks = np.flatnonzero((curve >= beside[:-2]) & (curve > beside[2:]) & (curve > bound * (1 + AGREES)))
    worst = peaks[np.argsort(-curve[peaks], kind="stable")][: ADDED // 2]
    return [float(peak) / (LOOKED_AT - 1) for peak in worst]


def _curves(
    problem: Problem,
    points: ComplexArray,
    theta2: FloatArray,
    direction: FloatArray,
    assembly: FloatArray,
    count: int,
) -> FloatArray:
    """Magnitudes in reference torques, shape (n, count)."""
    o2, o4, a, b, p = points.T
    coupler, last = b - a, theta2[:, -1]
    if problem.task.closed:
        last = theta2[:, 0] + direction * TURN
    arm = (p - a) * np.abs(coupler) / coupler
    shape = np.array([
        (o4 - o2).real, (o4 - o2).imag, np.abs(o4 - o2), np.abs(a - o2), np.abs(coupler), np.abs(b - o4),
        arm.real, arm.imag, assembly,
    ])  # fmt: skip
    angles = np.linspace(theta2[:, 0], last, count, axis=1)
    at_once = SCREENED if count % SCREENED == 0 else count
    given = np.repeat(shape, count // at_once, axis=1), angles.reshape(-1, at_once).T, loads(problem, 1.0)
    torque = np.asarray(_torque(at_once)(*given)).T.reshape(angles.shape)
    sizes: FloatArray = np.nan_to_num(np.abs(torque), nan=np.inf)
    return sizes


@lru_cache(maxsize=4)
def _torque(count: int) -> ca.Function:
    """Torque of one linkage at so many driver angles: a call for each would take three times as long."""
    shape, theta2, load = ca.SX.sym("shape", 9), ca.SX.sym("theta2", count), ca.SX.sym("load", LOADS)
    torque = [
        drive_torque(shape[:2], shape[2:6], shape[6:8], shape[8], theta2[k], load) for k in range(count)
    ]
    return ca.Function("drive_torque", [shape, theta2, load], [ca.vertcat(*torque)])


def _left(vector: ca.SX) -> ca.SX:
    return ca.vertcat(-vector[1], vector[0])
