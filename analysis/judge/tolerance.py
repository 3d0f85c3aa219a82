"""Effect of inexact dimensions on a design.

O2, the direction of the ground line or slide and the driver's angle are held: a motor turns the driver to the
nominal angles, measured from the frame. The `DIMENSIONS` of the linkage vary: of a four-bar r1 (which moves
O4 along the ground line), r2, r3, r4, u and v.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from grashof.analysis.judge.verdict import Verdict
from grashof.analysis.mechanism.even_motion import ground_line
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.mechanism.sensitivity import sensitivity, turn_sensitivity
from grashof.analysis.mechanism.transmission import transmission_angle
from grashof.problems import Linkage, Manufacturing, Task
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray, turned_from

AnyKind = TypeVar("AnyKind", bound=Linkage)

SAMPLES = 20_000  # made linkages: a share has a standard error of at most 0.0036
_POSITIONS = 200_000  # most positions solved for a design: long paths get fewer samples, ...
_FEWEST = 1_000  # ... but at least these (0.016)
_ARMS = {"_u": np.array([1.0, 0.0]), "_v": np.array([0.0, 1.0])}
_AT_ONCE = 20_000  # positions solved in one piece, which stays in the processor's cache


@dataclass(frozen=True, slots=True)
class Robustness:
    """How a design takes inexact dimensions.

    Parameters
    ----------
    moves : ndarray, shape (D,), length per length
        How far the worst target moves per unit of change of each of the `DIMENSIONS`.
    worst_move : float, length
        How far the worst target moves, linearised, when all dimensions are off by the tolerance in
        the worst combination of senses.
    share_linear, share_made : float
        Share of made linkages that stay within the band: linearised, and by exact positions.
    """

    moves: FloatArray
    worst_move: float
    share_linear: float
    share_made: float


def robustness(linkage: Linkage, task: Task, verdict: Verdict, manufacturing: Manufacturing) -> Robustness:
    """Effect of inexact dimensions on a single design; every call gives the same values.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    task : Task
    verdict : Verdict
        Of `verify`: the driver angle and assembly at every target.
    manufacturing : Manufacturing

    Returns
    -------
    Robustness

    Notes
    -----
    The move of a target is the distance of P from where the nominal linkage has it; for a pose
    sqrt(|dp|^2 + (angle_length * dangle)^2), the measure that the fit of poses uses too.

    Examples
    --------
    >>> from grashof.analysis import verify
    >>> from grashof.analysis.judge.planted import planted_motion
    >>> from grashof.problems import Requirements
    >>> task, linkage = planted_motion(np.random.default_rng(0), poses=4)
    >>> verdict = verify(linkage, task, Requirements())
    >>> made = robustness(linkage, task, verdict, Manufacturing(1e-3 * task.size))
    >>> made.moves.round(2).tolist()
    [3.56, 2.67, 3.59, 4.97, 1.0, 1.0]
    """
    samples = min(SAMPLES, max(_FEWEST, _POSITIONS // len(task)))
    dimensions = len(linkage.mechanism.dimensions)
    errors = dimension_errors(manufacturing, samples, np.random.default_rng(0), dimensions)
    slope = measured_sensitivity(linkage, task, verdict)
    senses = list(product((1.0, -1.0), repeat=dimensions))
    return Robustness(
        moves=np.sqrt((slope**2).sum(axis=1)).max(axis=0),
        worst_move=float(_linear_moves(slope, manufacturing.length_tolerance * np.array(senses)).max()),
        share_linear=yield_linear(slope, manufacturing.band, errors),
        share_made=yield_monte_carlo(linkage, task, verdict, manufacturing.band, errors),
    )


def dimension_errors(
    manufacturing: Manufacturing, samples: int, rng: np.random.Generator, dimensions: int = 6
) -> FloatArray:
    """Random deviations of the dimensions of a linkage, six of a four-bar, shape (samples, D), length."""
    return manufacturing.deviation * rng.standard_normal((samples, dimensions))


def measured_sensitivity(linkage: Linkage, task: Task, verdict: Verdict) -> FloatArray:
    """Sensitivity at each target, shape (N, 3, D), with angles as the lengths they count as."""
    counts = np.array([1.0, 1.0, task.angle_length if task.has_angle.any() else 0.0])
    return counts[:, None] * sensitivity(linkage, verdict.theta2, verdict.assembly)


def yield_linear(slope: FloatArray, band: float, errors: FloatArray) -> float:
    """Share of made linkages whose worst target moves by at most `band` (length), linearised.

    `slope` (N, 3, D) is of `measured_sensitivity`, `errors` (S, D) are lengths.
    """
    return float(np.mean(_linear_moves(slope, errors).max(axis=0) <= band))


def yield_monte_carlo(
    linkage: Linkage, task: Task, verdict: Verdict, band: float, errors: FloatArray
) -> float:
    """Share of made linkages whose worst target moves by at most `band` (length), by exact positions.

    Outside count those that cannot be assembled at a target or, when the nominal one passes from first to
    last, in between.
    """
    theta2, assembly = verdict.theta2[:, None], verdict.assembly[:, None]
    nominal = solve_position(linkage, theta2, assembly)
    between = _nearest_to_dead(linkage, task, verdict) if verdict.branch_ok else np.empty(0)
    piece = max(1, _AT_ONCE // len(task))
    within = 0
    for begin in range(0, len(errors), piece):
        made, possible = made_linkages(linkage, errors[begin : begin + piece])
        possible &= np.isfinite(transmission_angle(made, between[:, None])).all(axis=0)
        state = solve_position(made, theta2, assembly)
        shift = state.p - nominal.p
        moves2 = shift[..., 0] ** 2 + shift[..., 1] ** 2
        if task.has_angle.any():
            turned = turned_from(state.carrying, nominal.carrying)
            moves2 += (task.angle_length * turned) ** 2
        within += int(np.count_nonzero(possible & (moves2.max(axis=0) <= band**2)))  # NaN is not within
    return within / len(errors)


def made_linkages(linkage: AnyKind, errors: FloatArray) -> tuple[AnyKind, BoolArray]:
    """Linkages that deviate by errors (S, D) in length, and which of them there can be.

    All lengths must be above zero; an impossible one is the nominal one.
    """
    count = len(linkage.mechanism.lengths)  # which come first among the dimensions
    possible: BoolArray = np.all(linkage.lengths + errors[:, :count] > 0, axis=1)
    errors = np.where(possible[:, None], errors, 0.0)
    made = {"coupler_point": linkage.coupler_point + errors[:, -2:]}
    for column, name in enumerate(linkage.mechanism.dimensions[:-2]):
        error = errors[:, column]
        if name == "r1":
            along = np.array([np.cos(linkage.theta1), np.sin(linkage.theta1)])
            made["o4"] = linkage.o4 + error[:, None] * along
        elif name[-2:] in _ARMS:
            arm = name[0]
            made[arm] = made.get(arm, getattr(linkage, arm)) + error[:, None] * _ARMS[name[-2:]]
        else:
            made[name] = getattr(linkage, name) + error
    return linkage.changed(**made), possible


def _linear_moves(slope: FloatArray, errors: FloatArray) -> FloatArray:
    """Moves of N targets for S deviations, shape (N, S)."""
    with np.errstate(invalid="ignore"):
        moved = (slope.reshape(-1, slope.shape[-1]) @ errors.T).reshape(len(slope), 3, -1)
    moves: FloatArray = np.sqrt(moved[:, 0] ** 2 + moved[:, 1] ** 2 + moved[:, 2] ** 2)
    return moves


def _nearest_to_dead(linkage: Linkage, task: Task, verdict: Verdict) -> FloatArray:
    """Driver angles (rad) of the task motion where O2A lies along theta1.

    There, or at its ends, a linkage of any lengths is nearest to a dead position.
    """
    start = float(verdict.theta2.min())
    end = start + TURN if task.closed else float(verdict.theta2.max())
    return ground_line(linkage, start, end)[:2]


@dataclass(frozen=True, slots=True, eq=False)
class MadeMoves:
    """How far P and the output link are off, linearised, where dimensions are off by a tolerance.

    Parameters
    ----------
    point : ndarray, shape (..., D), length
        Distance of P where one of the `DIMENSIONS` is off.
    theta4 : ndarray, shape (..., D), rad
        The same of the angle of the output link, signed: of link 4, of a six-bar link 6.
    point_worst, theta4_worst : ndarray, shape (...), length and rad
        All dimensions off, in the worst combination of senses.
    point_rms, theta4_rms : ndarray, shape (...), length and rad
        Root of the sum of squares: all off independently; the tolerance and these are the same multiple of
        the standard deviations of a dimension and of the result.
    """

    point: FloatArray
    theta4: FloatArray
    point_worst: FloatArray
    theta4_worst: FloatArray
    point_rms: FloatArray
    theta4_rms: FloatArray


def made_moves(linkage: Linkage, theta2: npt.ArrayLike, tolerance: float) -> MadeMoves:
    """Moves of P and of the output link at held driver angles, where dimensions are off by a tolerance.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    theta2 : array_like, shape (...), rad
    tolerance : float, length
        Of each dimension.

    Returns
    -------
    MadeMoves
        NaN where the linkage cannot close, without bound towards a dead position.

    Notes
    -----
    O2 and the direction of the ground line are held, as in `sensitivity`. The worst combination of senses
    is one of the corners of the box of deviations, as distance is convex.

    Examples
    --------
    A square, P at B: a longer output link lifts P by as much, and link 4 stays upright.

    >>> from grashof.problems import FourBar
    >>> square = FourBar(o2=(0, 0), o4=(2, 0), r2=2, r3=2, r4=2, coupler_point=(2, 0), assembly=1)
    >>> moves = made_moves(square, np.pi / 2, 0.1)
    >>> float(moves.point[3].round(9)), float(moves.theta4_worst.round(9))
    (0.1, 0.1)
    """
    slope = sensitivity(linkage, theta2) * tolerance
    turns = turn_sensitivity(linkage, theta2, linkage.mechanism.links[-1].number) * tolerance
    senses = np.array(list(product((1.0, -1.0), repeat=len(linkage.mechanism.dimensions) - 1)))
    senses = np.concatenate([np.ones((len(senses), 1)), senses], axis=1)  # the others are their opposites
    with np.errstate(invalid="ignore", over="ignore"):
        moved = slope[..., :2, :] @ senses.T
        point = np.hypot(slope[..., 0, :], slope[..., 1, :])
        return MadeMoves(
            point=point,
            theta4=turns,
            point_worst=np.hypot(moved[..., 0, :], moved[..., 1, :]).max(axis=-1),
            theta4_worst=np.abs(turns).sum(axis=-1),
            point_rms=np.sqrt((point**2).sum(axis=-1)),
            theta4_rms=np.sqrt((turns**2).sum(axis=-1)),
        )


def output_sensitivity(linkage: Linkage, theta2: npt.ArrayLike) -> FloatArray:
    """Derivatives of theta4 by the dimensions, of a four-bar r1, r2, r3, r4, u, v, at held driver angles.

    Parameters
    ----------
    linkage : Linkage
        One, or a batch whose axes broadcast against `theta2`.
    theta2 : array_like, shape (...), rad

    Returns
    -------
    ndarray, shape (..., D), rad/length

    Notes
    -----
    See `sensitivity`; zeros of a slider-crank, whose link 4 does not turn.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> square = FourBar(o2=(0, 0), o4=(2, 0), r2=2, r3=2, r4=2, assembly=1)
    >>> (output_sensitivity(square, np.pi / 2).round(9) + 0.0).tolist()
    [0.5, 0.0, -0.5, 0.0, 0.0, 0.0]
    """
    return turn_sensitivity(linkage, theta2, 4)
