"""The stroke of the output link: its limit positions, swing and time ratio, in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis.mechanism.first_loop import first_loop
from grashof.analysis.mechanism.mobility import full_rotation
from grashof.analysis.mechanism.position import solve_position
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class OutputStroke:
    """The two toggle positions in which the output link turns back: O2, A and B lie in one line.

    Parameters
    ----------
    theta2 : ndarray, shape (..., 2), rad
        Driver angle in [0, 2 pi) with the links 2 and 3 stretched, and with them folded; NaN where
        there is no such position, as for an output that turns fully.
    theta4 : ndarray, shape (..., 2), rad
        Output angle there, the second within half a turn of the first.
    b : ndarray, shape (..., 2, 2), length
        B there.
    swing : ndarray, shape (...), rad
        Angle between the two.
    time_ratio : ndarray, shape (...)
        Time of the slow stroke over that of the quick one, with a steady driver; NaN where the
        driver does not turn fully.
    """

    theta2: FloatArray
    theta4: FloatArray
    b: FloatArray
    swing: FloatArray
    time_ratio: FloatArray

    @property
    def chord(self) -> FloatArray:
        """Distance between the two positions of B, shape (...), length."""
        way = self.b[..., 1, :] - self.b[..., 0, :]
        return np.hypot(way[..., 0], way[..., 1])


def output_stroke(linkage: Linkage) -> OutputStroke:
    """Limit positions of the output link on the linkage's own assembly.

    Parameters
    ----------
    linkage : Linkage

    Returns
    -------
    OutputStroke

    Notes
    -----
    Triangles O2-B-O4 with the side O2B = r2 + r3 or |r2 - r3| (Norton, *Design of Machinery*,
    secs. 3.2, 3.4). The toggle positions of the driver, with links 3 and 4 in one line, are the
    ends of `driver_ranges`.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> stroke = output_stroke(norton)
    >>> np.degrees(stroke.theta2).round(4).tolist(), float(np.degrees(stroke.swing).round(4))
    ([24.1468, 231.3178], 73.7818)
    >>> float(stroke.time_ratio.round(6))
    1.355573
    """
    theta2 = first_loop(linkage).limits(linkage) % (2 * np.pi)
    state = solve_position(linkage[..., None], theta2)
    turned = (np.diff(state.theta4, axis=-1)[..., 0] + np.pi) % (2 * np.pi) - np.pi
    theta4 = state.theta4[..., :1] + np.stack([np.zeros_like(turned), turned], axis=-1)
    between = np.diff(theta2, axis=-1)[..., 0] % (2 * np.pi)
    ratio = np.maximum(between, 2 * np.pi - between) / np.minimum(between, 2 * np.pi - between)
    return OutputStroke(
        theta2=theta2,
        theta4=theta4,
        b=state.b,
        swing=np.abs(turned),
        time_ratio=np.where(full_rotation(linkage), ratio, np.nan)[()],
    )
