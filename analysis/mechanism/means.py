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
    """Mean over a motion of the driver, as over time at a steady speed, and what it may be wrong by.

    The curve goes from (N,) in rad to (..., N). The error is large where it does not converge, as towards a
    dead position; what is narrower than a fiftieth of a panel may be missed.
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
    """Mean and error, as of `mean_over`, over the time that the driver takes.

    The curve is one over `DriverLaw.at_place`; at a steady speed, and at none, it is the mean over the angle.
    """
    if law.motor.steady:
        return mean_over(linkage, curve, law.start, law.start + law.rotation, panels)
    parts = [np.linspace(*ends, panels + 1)[:-1] for ends in pairwise(law.corners.tolist())]
    found = integrate(curve, np.append(np.concatenate(parts), 1.0))
    return found.total, found.error
