"""Length, rate, lever angle and force of a cylinder, and their extremes over a motion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from grashof.analysis.cylinder.travel import Travel
from grashof.analysis.forces.dynamics import inverse_dynamics
from grashof.analysis.forces.loads import AppliedForce, Loads
from grashof.analysis.forces.mass import Masses
from grashof.analysis.mechanism.kinematics import Kinematics, virtual_motion
from grashof.analysis.mechanism.position import Position
from grashof.analysis.numerics.peaks import peaks
from grashof.problems import Cylinder, Linkage
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, Limits

_ROUNDS, _SECANTS, _SETTLED = 60, 30, 1e-13
_NOTHING = 1e-13  # share of the lengths about it: a shorter way is rounding


@dataclass(frozen=True, slots=True, eq=False)
class CylinderState:
    """A cylinder in some positions of its linkage.

    Parameters
    ----------
    pivot : ndarray, shape (..., 2), length
        Q, its pivot on the moving link.
    length : ndarray, shape (...), length
        From C, its pivot on the ground, to Q.
    rate : ndarray, shape (...), length
        dL/dtheta2; infinite in dead positions of link 2.
    output_rate : ndarray, shape (...), length
        dL/dtheta4, the moment arm of the cylinder's force on link 4; infinite in limit positions of
        link 4, and where it does not turn at all.
    lever : ndarray, shape (...)
        |dL| / |dQ|: the sine of the angle between cylinder and arm, signed as dL in the motion of the linkage
        around its circuit; 0 where Q is at rest or lies in C.
    """

    pivot: FloatArray
    length: FloatArray
    rate: FloatArray
    output_rate: FloatArray
    lever: FloatArray

    @property
    def angle(self) -> FloatArray:
        """Lever angle, shape (...), rad: min(beta, pi - beta) between the cylinder and the arm of Q.

        Where Q goes round no pivot of the ground, pi / 2 less the angle between the cylinder and its way.
        """
        return np.asarray(np.arcsin(np.clip(np.abs(self.lever), 0.0, 1.0)))


@dataclass(frozen=True, slots=True)
class CylinderFigures:
    """Least and greatest length over a motion, and the least lever angle, rad; 0 unless `monotone`.

    `monotone`: the length changes in one sense and is nowhere stationary, so that the cylinder drives. Rates
    are magnitudes of dL/dtheta4, at the first target and the last, and their extremes over the motion, which
    are 0 and infinite unless `monotone`.
    """

    closed: float
    open: float
    angle_min: float
    monotone: bool
    rate_start: float
    rate_end: float
    rate_min: float
    rate_max: float

    @property
    def stroke(self) -> float:
        """Greatest length less the least."""
        return self.open - self.closed

    @property
    def ratio(self) -> float:
        """Greatest length over the least."""
        return self.open / self.closed if self.closed > 0 else np.inf


def cylinder_state(cylinder: Cylinder, linkage: Linkage, at: Position | Kinematics) -> CylinderState:
    """A cylinder in some positions of a linkage.

    Parameters
    ----------
    cylinder : Cylinder
    linkage : Linkage
    at : Position or Kinematics
        Of the linkage, shape (...).

    Returns
    -------
    CylinderState

    Notes
    -----
    The links turn as the derivative of the loop allows (Norton, *Design of Machinery*, ch. 6), in
    a motion that has no infinite rates in dead positions; dL = dQ . (Q - C) / L.

    Examples
    --------
    >>> from grashof.analysis import solve_position
    >>> from grashof.problems import FourBar
    >>> linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    >>> jack = Cylinder("driver", base=(0, -2), point=(1, 0))
    >>> found = cylinder_state(jack, linkage, solve_position(linkage, [0.0, np.pi / 4]))
    >>> found.length.round(6).tolist(), np.degrees(found.angle).round(3).tolist()
    ([2.236068, 2.797933], [63.435, 30.361])
    >>> (found.rate / found.output_rate).round(6).tolist()  # d theta4 / d theta2
    [-0.333333, 0.070567]
    """
    sign = np.prod(np.copysign(1.0, at.margins), axis=0)
    moving = virtual_motion(linkage, at.theta2, np.copysign(1.0, at.margins[0]))[0]
    q = moving.point(cylinder.link, cylinder.point)
    pivot, way = _complex(q.position), sign * _complex(q.velocity)
    out = pivot - complex(*cylinder.base)
    length, speed = np.abs(out), np.abs(way)
    scale = linkage.lengths.sum(axis=-1) + np.hypot(*cylinder.point)
    with np.errstate(invalid="ignore", divide="ignore"):
        change = np.real(np.conj(out) * way) / length
        lever = np.where((length > 0) & (speed > _NOTHING * scale), change / speed, 0.0)
        rate = np.where(length > 0, change / (sign * moving.omega2), 0.0)
        output_rate = np.where(length > 0, change / (sign * moving.omega4), 0.0)
    lever = np.where(np.isnan(speed), np.nan, lever)
    return CylinderState(q.position, length, rate, output_rate, lever)


def cylinder_figures(cylinder: Cylinder, travel: Travel) -> CylinderFigures:
    """Extremes of a cylinder over a motion, right to rounding, from ever closer samples.

    The lever changes its sign where the length turns back, so its least signed value decides on `monotone`.
    The inverse of the rate, dtheta4/dL, is finite where the cylinder drives, and 0 where link 4 turns back.
    """

    def curves(places: FloatArray) -> FloatArray:
        state = cylinder_state(cylinder, travel.linkage, travel.at(places))
        with np.errstate(divide="ignore"):
            every = np.stack([state.lever, state.length, 1 / state.output_rate])
        return np.concatenate([every, -every])

    if travel.start == travel.end:
        found = curves(np.array([travel.start]))[:, 0]
    else:
        found, _ = peaks(curves, [travel.places])
    (high, longest, most), (low, shortest, least) = found[:3], -found[3:]
    lever = max(low, -high)
    driven = bool(np.isfinite([high, low, longest, shortest]).all() and lever > 0)
    angle = float(np.arcsin(min(lever, 1.0))) if driven else 0.0
    ends = cylinder_state(cylinder, travel.linkage, travel.at(travel.targets[[0, -1]]))
    first, last = np.abs(ends.output_rate).tolist()
    extremes = _rates(least, most) if driven else (0.0, np.inf)
    return CylinderFigures(float(shortest), float(longest), angle, driven, first, last, *extremes)


def _rates(least: float, most: float) -> Limits:
    """Least and greatest magnitude of a rate whose inverse is between two values."""
    quickest, slowest = float(max(-least, most)), float(max(least, -most))
    return 1 / quickest if quickest > 0 else np.inf, 1 / slowest if slowest > 0 else np.inf


def cylinder_force(state: Kinematics, cylinder: Cylinder, masses: Masses, loads: Loads) -> FloatArray:
    """Force of a cylinder without mass or friction of its own, shape (...), in newtons over the metre.

    Positive where it pushes; infinite where its length is stationary, or friction locks it. Virtual work
    (Norton, *Design of Machinery*, sec. 11.10): F dL/dtheta2 = T, the torque on link 2. Friction that grows
    with joint forces depends on the drive: there F acts on the link and is corrected until no torque is left.
    """
    found = cylinder_state(cylinder, state.linkage, state)
    out = found.pivot - np.asarray(cylinder.base)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        force: FloatArray = inverse_dynamics(state, masses, loads).torque / found.rate
        if not loads.friction.of(state.linkage, "radius").any():
            return force
        push = out / found.length[..., None]

        def step(tried: FloatArray) -> FloatArray:
            """The correction against the torque that some forces leave, with the friction there."""
            pushed = AppliedForce(cylinder.link, cylinder.point, tried[..., None] * push)
            left = inverse_dynamics(state, masses, replace(loads, forces=(*loads.forces, pushed))).torque
            return np.asarray(left / found.rate)

        for _ in range(_ROUNDS):
            before, last = force, step(force)
            force = force + last
            settled = np.abs(last) <= _SETTLED * np.abs(force)
            if settled.all():
                return force
        settled, force = _by_secants(step, settled, (before, last), force)
        return np.where(settled | np.isnan(force), force, np.inf)


def _by_secants(
    step: Callable[[FloatArray], FloatArray],
    settled: BoolArray,
    known: tuple[FloatArray, FloatArray],
    force: FloatArray,
) -> tuple[BoolArray, FloatArray]:
    """Forces where friction nearly balances the cylinder, so that single steps converge slowly.

    Friction that grows faster than the force, so that more force leaves more torque, locks.
    """
    before, last = known
    moving = ~settled
    for _ in range(_SECANTS):
        now = step(force)
        slope = (now - last) / (force - before)
        there = moving & (np.abs(now) <= _SETTLED * np.abs(force))
        settled, moving = settled | there, moving & ~there & (slope < 0)
        before, last = np.where(moving, force, before), np.where(moving, now, last)
        force = np.where(moving, force - now / slope, force)
        if not moving.any():
            break
    return settled, force


def _complex(place: FloatArray) -> ComplexArray:
    return np.asarray(place[..., 0] + 1j * place[..., 1])
