"""Central differences, compared with analytic values."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.kinematics import solve_kinematics
from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray

# Weights of f(x - k h) to f(x + k h), times h or h^2, by derivative and order of accuracy.
_WEIGHTS = {
    (1, 2): (-1 / 2, 0, 1 / 2),
    (1, 4): (1 / 12, -2 / 3, 0, 2 / 3, -1 / 12),
    (2, 2): (1, -2, 1),
    (2, 4): (-1 / 12, 4 / 3, -5 / 2, 4 / 3, -1 / 12),
}


def central_differences(
    at: npt.ArrayLike, values: npt.ArrayLike, derivative: int = 1, accuracy: int = 2
) -> FloatArray:
    """First or second derivative of sampled values.

    Parameters
    ----------
    at : array_like, shape (N,)
        Sample places, in equal steps.
    values : array_like, shape (N, ...)
        Angles must not jump (``np.unwrap``).
    derivative : int
        1 or 2.
    accuracy : int
        2 (error of the order of the step squared) or 4.

    Returns
    -------
    ndarray, shape (N, ...)
        NaN at the ends, which lack neighbours on one side.

    Raises
    ------
    ProblemError
        The steps are not equal, or no such formula.

    Examples
    --------
    >>> time = np.linspace(0, 1, 5)
    >>> central_differences(time, time**2).tolist()
    [nan, 0.5, 1.0, 1.5, nan]
    """
    at, values = np.asarray(at, dtype=np.float64), np.asarray(values, dtype=np.float64)
    weights = _WEIGHTS.get((derivative, accuracy))
    if weights is None:
        raise ProblemError(
            f"derivative is {derivative!r} and accuracy {accuracy!r}; they must be 1 or 2, and 2 or 4"
        )
    count = len(at) if at.ndim == 1 else 0
    if count < len(weights) or len(values) != count:
        raise ProblemError(
            f"at has shape {at.shape}, values {values.shape}; they must have one row for each of "
            f"{len(weights)} or more places"
        )
    step = (at[-1] - at[0]) / (count - 1)
    if step == 0 or np.abs(np.diff(at) - step).max() > 1e-6 * abs(step):
        raise ProblemError("the samples are not equally spaced, as central differences require")
    reach = len(weights) // 2
    slope = np.full(values.shape, np.nan)
    slope[reach : count - reach] = sum(
        weight * values[k : count - 2 * reach + k] for k, weight in enumerate(weights)
    )
    slope /= step**derivative
    return slope


@dataclass(frozen=True, slots=True)
class Deviation:
    """Deviation of central differences of one quantity from its analytic values.

    Parameters
    ----------
    quantity : str
        "omega3", "alpha4", "velocity of B", ...
    accuracy : int
        Order of the formula, 2 or 4.
    largest : float
        Largest distance from the analytic value.
    share : float
        The same as a share of the largest analytic value.
    theta2 : float, rad
        Driver angle there.
    """

    quantity: str
    accuracy: int
    largest: float
    share: float
    theta2: float


def compare_differences(
    linkage: Linkage, theta2: npt.ArrayLike, omega2: float = 1.0, assembly: int | None = None
) -> tuple[Deviation, ...]:
    """Central differences of positions against the analytic velocities and accelerations.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    theta2 : array_like, shape (N,), rad
        In equal steps.
    omega2 : float, rad/s
        Steady.
    assembly : int, optional

    Returns
    -------
    tuple of Deviation
        For the angles of links 3 and 4 and the points B and P, by formulas of order 2 and 4.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> worst = compare_differences(norton, np.radians(np.arange(0, 361, 5.0)))[0]
    >>> worst.quantity, worst.accuracy, round(worst.share, 4), float(np.degrees(worst.theta2).round(3))
    ('omega3', 2, 0.0063, 350.0)
    """
    state = solve_kinematics(linkage, theta2, omega2, assembly=assembly)
    angles = np.asarray(state.theta2)
    time = angles / omega2
    b, p = state.b, state.p
    curves = (
        ("omega3", "alpha3", np.unwrap(state.theta3), state.omega3, state.alpha3),
        ("omega4", "alpha4", np.unwrap(state.theta4), state.omega4, state.alpha4),
        ("velocity of B", "acceleration of B", b.position, b.velocity, b.acceleration),
        ("velocity of P", "acceleration of P", p.position, p.velocity, p.acceleration),
    )
    found = []
    for first, second, positions, velocity, acceleration in curves:
        for derivative, (name, exact) in enumerate(((first, velocity), (second, acceleration)), start=1):
            for accuracy in (2, 4):
                apart, size = (
                    np.hypot(*values.T) if values.ndim == 2 else np.abs(values)
                    for values in (central_differences(time, positions, derivative, accuracy) - exact, exact)
                )
                known = np.isfinite(apart)
                if not known.any():
                    raise ProblemError("no sample has neighbours in which the linkage closes")
                worst = int(np.argmax(np.where(known, apart, -1.0)))
                largest, peak = float(apart[worst]), float(size[known].max())
                share = largest / peak if peak else 0.0
                found.append(Deviation(name, accuracy, largest, share, float(angles[worst])))
    return tuple(found)
