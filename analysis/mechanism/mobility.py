"""Mobility: Grashof class, rotatability, driver ranges, circuits and branches."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.closing import closed_at, dyad_of
from grashof.analysis.mechanism.first_loop import CHANGE, GrashofClass, first_loop, first_ranges
from grashof.analysis.mechanism.second_loop import branches, cut, recurs
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, BoolArray, FloatArray, IntArray

_OUTWARDS = np.concatenate([[0], 2.0 ** np.arange(14)]) * np.finfo(np.float64).eps  # rad: rounding of an end


def grashof_class(linkage: Linkage, tolerance: float = CHANGE) -> GrashofClass:
    """Grashof class of the first loop of a single linkage, or its counterpart with a slide.

    Parameters
    ----------
    linkage : Linkage
    tolerance : float
        Share of the lengths within which s + l equals p + q (change point), or with a slide the
        `rotatability` is zero.

    Returns
    -------
    GrashofClass

    Notes
    -----
    With shortest link s, longest l and the others p, q: s + l < p + q is Grashof, and the shortest link
    decides the kind (Grashof 1883; Norton, *Design of Machinery*, sec. 2.13). The driver of a slider-crank
    turns fully, that of a slider-rocker swings; the block of an inverted one whose driver turns fully swings
    (crank-shaper) or turns (Whitworth).

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> str(grashof_class(FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)))
    'crank-rocker'
    """
    return first_loop(linkage).class_of(tolerance)


def triple_rocker_kind(linkage: Linkage) -> str:
    """Kind of a non-Grashof linkage (Barker 1985), RRR1 to RRR4 by its longest link; '' for the others."""
    if grashof_class(linkage) is not GrashofClass.NON_GRASHOF:
        return ""
    return f"RRR{int(np.argmax(linkage.lengths[:4])) + 1}"


def rotatability(linkage: Linkage) -> FloatArray:
    """The two differences whose signs decide how the driver of the first loop turns.

    Parameters
    ----------
    linkage : Linkage

    Returns
    -------
    ndarray, shape (..., 2)
        (r3 + r4 - r1 - r2) and (|r1 - r2| - |r3 - r4|), as shares of r1 + r2 + r3 + r4; of a slider-crank
        (r3 - r2 - offset) and (r3 - r2 + offset), of r2 + r3 + |offset|; of an inverted one 1 and
        (|r1 - r2| - |offset|), of r1 + r2 + |offset|. Both positive: the driver turns fully. Both
        negative: it swings in two ranges. Otherwise it swings in one, through theta1 + pi if the first is
        positive, through theta1 if the second is.

    Notes
    -----
    The diagonal A-O4 runs from |r1 - r2| to r1 + r2 and has to stay between |r3 - r4| and r3 + r4
    (McCarthy & Soh, *Geometric Design of Linkages*, sec. 2.2).
    """
    return first_loop(linkage).shares()


def full_rotation(linkage: Linkage) -> BoolArray:
    """Whether the driver turns fully without a dead position, shape (...): not at a change point."""
    turns: BoolArray = np.all(rotatability(linkage) > CHANGE, axis=-1)
    if len(linkage.mechanism.dyads) > 1:
        turns = np.array(turns)
        for index in np.argwhere(turns).tolist():
            single = linkage[tuple(index)]
            turns[tuple(index)] = bool(closes_everywhere(single)) and not len(cut(single).touched)
    return turns[()]


def closes_everywhere(linkage: Linkage) -> BoolArray:
    """Whether the linkage closes at every driver angle, change points included, shape (...)."""
    if len(linkage.mechanism.dyads) == 1:
        return np.asarray((rotatability(linkage) >= 0).all(axis=-1))
    ranges = [cut(linkage[index]).ranges for index in np.ndindex(linkage.shape)]
    whole = [len(each) == 1 and bool(np.ptp(each) > TURN - CHANGE) for each in ranges]
    return np.array(whole).reshape(linkage.shape)


def passes_change_point(linkage: Linkage, start: npt.ArrayLike, end: npt.ArrayLike) -> BoolArray:
    """Whether the driver takes a linkage to a change point, where all joints are in line, shape (...).

    There a parallelogram may become an antiparallelogram whatever the driver does: a dead position.
    """
    stretched, folded = np.moveaxis(np.abs(rotatability(linkage)) <= CHANGE, -1, 0)
    low, high = np.minimum(start, end), np.maximum(start, end)
    first = np.ceil((low - linkage.theta1) / np.pi - CHANGE)
    last = np.floor((high - linkage.theta1) / np.pi + CHANGE)
    along, away = ((last > first) | ((last == first) & (first % 2 == odd)) for odd in (0, 1))
    passed = (folded & along) | (stretched & away)
    if len(linkage.mechanism.dyads) == 1:
        return np.asarray(passed)

    def touches(single: Linkage, least: FloatArray, most: FloatArray) -> FloatArray:
        return np.asarray(recurs(cut(single).touched, least, most).any(axis=1), dtype=np.float64)

    return np.asarray(passed | (one_by_one(touches, linkage, low, high) > 0))


def driver_ranges(linkage: Linkage, transmission: float = 0.0) -> FloatArray:
    """Driver angles at which the linkage can be assembled.

    Parameters
    ----------
    linkage : Linkage
    transmission : float, rad
        Least min(mu, pi - mu) of all loops; below pi / 2.

    Returns
    -------
    ndarray, shape (..., K, 2), rad
        Ranges [low, high] of theta2, padded with NaN; the middle of each lies within half a turn. K = 2 for
        one loop; for a six-bar, on its own assembly, at least 2. A driver that turns fully has one range of
        a full turn.

    Notes
    -----
    Of a four-bar cos(theta2 - theta1) runs between (r1^2 + r2^2 - (r3 +- r4)^2) / (2 r1 r2) (McCarthy & Soh,
    sec. 2.2.2); with a limit of the transmission angle, the diagonal A-O4 at which mu meets it replaces r3 +-
    r4. The second loop of a six-bar cuts these ranges where the width of its gap meets its limits, found by
    dense samples and halving.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> triple_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=2, r3=2, r4=3)
    >>> np.degrees(driver_ranges(triple_rocker)[0]).round(3).tolist()
    [-108.21, 108.21]
    """
    if len(linkage.mechanism.dyads) == 1:
        return first_ranges(linkage, transmission)
    found = {index: cut(linkage[index], transmission).ranges for index in np.ndindex(linkage.shape)}
    most = max([2, *map(len, found.values())])
    ranges = np.full((*linkage.shape, most, 2), np.nan)
    for index, each in found.items():
        ranges[(*index, slice(len(each)))] = each
    return ranges


def one_by_one(function: Callable[..., FloatArray], linkage: Linkage, *angles: npt.ArrayLike) -> FloatArray:
    """Values of a function of a single linkage and its driver angles (N,), over a batch; shape (...)."""
    number = np.arange(np.prod(linkage.shape, dtype=int)).reshape(linkage.shape)
    number, *at = np.broadcast_arrays(number, *angles)
    values = np.empty(number.shape)
    for k, index in enumerate(np.ndindex(linkage.shape)):
        own = number == k
        values[own] = function(linkage[index] if index else linkage, *(each[own] for each in at))
    return values


def dead_ends(linkage: Linkage, low: float, high: float) -> tuple[float, float]:
    """Ends of a driver's range, moved outwards within their rounding until they are dead positions.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    low, high : float, rad
        A range of `driver_ranges`.

    Returns
    -------
    low, high : float, rad
        There `solve_position` has a transmission angle of 0 or 180 deg; unchanged where that cannot be.
        (Links move with the root of the driver angle: an end 1e-16 inside is 1e-8 off the dead position.)
    """
    scale = max(abs(low), abs(high), 1.0)
    places = np.array([[low], [high]]) + np.array([[-scale], [scale]]) * _OUTWARDS
    loops, _ = closed_at(linkage, places)
    dead = np.any([loop.closed.margin == 0 for loop in loops], axis=0)
    first = np.where(dead.any(axis=1), dead.argmax(axis=1), 0)
    return float(places[0, first[0]]), float(places[1, first[1]])


def range_index(linkage: Linkage, theta2: npt.ArrayLike, slack: float = 1e-9) -> tuple[IntArray, FloatArray]:
    """Index of the driver range of each angle, and the angle (rad) moved into it; -1 and NaN outside all.

    Of one linkage, or of a batch that broadcasts against the angles. An angle within `slack` (rad) of an end
    is inside.
    """
    return _within(driver_ranges(linkage), np.asarray(theta2, dtype=np.float64), slack)


def _within(
    ranges: FloatArray, angle: FloatArray, slack: float = 1e-9, allowed: BoolArray | None = None
) -> tuple[IntArray, FloatArray]:
    """The first range (..., K, 2) that each angle lies in, of those that `allowed` (K, ...) admits."""
    shape = np.broadcast_shapes(ranges.shape[:-2], angle.shape if allowed is None else allowed.shape[1:])
    index, inside = np.full(shape, -1, dtype=np.int64), np.full(shape, np.nan)
    for number, (low, high) in enumerate(np.moveaxis(ranges, (-2, -1), (0, 1))):
        if np.isnan(low).all():
            continue
        moved = low + (angle - low + slack) % (2 * np.pi) - slack
        hit = (moved <= high + slack) & (index < 0)
        if allowed is not None:
            hit &= allowed[number]
        index, inside = np.where(hit, number, index), np.where(hit, moved, inside)
    return index, inside


def circuit_index(
    linkage: Linkage,
    theta2: npt.ArrayLike,
    assembly: npt.ArrayLike,
    assembly_2: npt.ArrayLike | None = None,
) -> IntArray:
    """Circuit of each position: no motion joins positions on different circuits.

    Parameters
    ----------
    linkage : Linkage
        One, or a batch that broadcasts against `theta2` (``batch[:, None]``).
    theta2 : array_like, shape (...), rad
    assembly : array_like, shape (...)
        +1 or -1.
    assembly_2 : array_like, shape (...), optional
        Of the second loop of a six-bar; the linkage's own by default.

    Returns
    -------
    ndarray of int, shape (...)
        0 or 1, of a six-bar more; -1 where the linkage cannot be assembled.

    Notes
    -----
    If the driver turns fully each assembly is a circuit; otherwise each range of the driver is one, whose two
    assemblies meet in the dead positions at its ends (Chase & Mirth 1993). In a six-bar, dead positions of
    the first loop join ranges, and those of the second loop its assemblies. Circuits that meet at a change
    point are distinguished as on the nearest Grashof linkage.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> double_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=3, r3=1, r4=3)
    >>> circuit_index(double_rocker, np.radians([60, -60]), assembly=1).tolist()
    [0, 1]
    """
    return circuits_and_branches(linkage, theta2, assembly, assembly_2)[0]


def branch_index(
    linkage: Linkage,
    theta2: npt.ArrayLike,
    assembly: npt.ArrayLike,
    assembly_2: npt.ArrayLike | None = None,
) -> IntArray:
    """Branch of each position: a dead position lies between different branches of a circuit.

    Parameters and shapes as for `circuit_index`.

    Returns
    -------
    ndarray of int, shape (...)
        0 to 3, of a six-bar more; -1 where the linkage cannot be assembled.
    """
    return circuits_and_branches(linkage, theta2, assembly, assembly_2)[1]


def circuits_and_branches(
    linkage: Linkage,
    theta2: npt.ArrayLike,
    assembly: npt.ArrayLike,
    assembly_2: npt.ArrayLike | None = None,
) -> tuple[IntArray, IntArray]:
    """Circuit and branch of each position, as of `circuit_index` and `branch_index`."""
    if len(linkage.mechanism.dyads) > 1:
        return _of_six_bars(linkage, theta2, assembly, assembly_2)
    (index, _), side = range_index(linkage, theta2), np.asarray(np.less(assembly, 0), dtype=np.int64)
    circuit = np.where(closes_everywhere(linkage), side, index)
    return np.where(index < 0, -1, circuit), np.where(index < 0, -1, 2 * index + side)


def _of_six_bars(
    linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike, assembly_2: npt.ArrayLike | None
) -> tuple[IntArray, IntArray]:
    """Circuit and branch of positions of a six-bar, or of a batch whose last axis has length 1."""
    second = dyad_of(linkage, 2).sign if assembly_2 is None else assembly_2
    at = np.broadcast_arrays(np.asarray(theta2, dtype=np.float64), assembly, second, np.empty(linkage.shape))
    shape, branch, circuit = at[0].shape, list[IntArray](), list[IntArray]()
    for row in np.ndindex(shape[:-1] if linkage.shape else ()):
        single = linkage[(*row, 0)] if linkage.shape else linkage
        branch.append(_branch_of(single, *(each[row] for each in at[:3])))
        known = branches(single).circuits.ravel()
        circuit.append(np.where(branch[-1] < 0, -1, known[branch[-1]] if len(known) else -1))
    return np.reshape(circuit, shape), np.reshape(branch, shape)


def _branch_of(linkage: Linkage, theta2: FloatArray, first: FloatArray, second: FloatArray) -> IntArray:
    """Branch of each position of a six-bar: twice the index in `branches`, 1 more on the second assembly."""
    found = branches(linkage)
    allowed = found.assembly.reshape(-1, *(1,) * first.ndim) * first > 0
    index, _ = _within(found.ranges, theta2, allowed=allowed)
    return np.where(index < 0, -1, 2 * index + (second < 0))
