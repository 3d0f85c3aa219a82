"""Means over a motion of the driver: over its angle, and over its time."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from grashof.analysis.mechanism.driver_law import DriverLaw
from grashof.analysis.mechanism.even_motion import even_motion
from grashof.analysis.numerics.quadrature import Curve, integrate
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray


def mean_over(
    linkage: Linkage, curve: Curve, start: float, end: float, panels: int = 36
) -> tuple[FloatArray, FloatArray]:
    """Mean of one quantity or several over a motion of the driver, as over time at a steady speed.

    Parameters
    ----------
    linkage : Linkage
        A single linkage.
    curve : callable
        From driver angles, shape (N,), to values, shape (..., N).
    start, end : float, rad
    panels : int
        To begin with; more where it takes them. What is narrower than a fiftieth of one may be missed.

    Returns
    -------
    mean, error : ndarray, shape (...)
        The error is what the mean may be wrong by; large where it does not converge, as for what grows
        without bound towards a dead position.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> mean, error = mean_over(norton, lambda theta2: np.sin(theta2) ** 2, 0.0, np.pi)
    >>> float(mean.round(12)), bool(error < 1e-12)
    (0.5, True)
    """
    if start == end:
        at = np.asarray(curve(np.array([start])), dtype=np.float64)[..., 0]
        return at, np.zeros(at.shape)
    motion = even_motion(linkage, start, end)
    found = integrate(lambda t: curve(motion.theta2(t)) * motion.rate(t), motion.edges(panels))
    return found.total / (end - start), found.error / abs(end - start)


def mean_in_time(
    linkage: Linkage, law: DriverLaw, curve: Curve, panels: int = 36
) -> tuple[FloatArray, FloatArray]:
    """Mean over the time that the driver takes from one angle to another; parameters as for `mean_over`.

    The curve is one over the places of the law, `DriverLaw.at_place`. At a steady speed, and at none,
    it is the mean over the angle.
    """
    if law.motor.steady:
        return mean_over(linkage, curve, law.start, law.start + law.rotation, panels)
    parts = [np.linspace(*ends, panels + 1)[:-1] for ends in pairwise(law.corners.tolist())]
    found = integrate(curve, np.append(np.concatenate(parts), 1.0))
    return found.total, found.error
