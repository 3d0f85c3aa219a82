"""The stroke of the output link: its limit positions, swing and time ratio, in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis.four_bar.mobility import full_rotation
from grashof.analysis.four_bar.position import solve_position
from grashof.problems import FourBar
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


def output_stroke(linkage: FourBar) -> OutputStroke:
    """Limit positions of the output link on the linkage's own assembly.

    Parameters
    ----------
    linkage : FourBar

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
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> stroke = output_stroke(norton)
    >>> np.degrees(stroke.theta2).round(4).tolist(), float(np.degrees(stroke.swing).round(4))
    ([24.1468, 231.3178], 73.7818)
    >>> float(stroke.time_ratio.round(6))
    1.355573
    """
    r1, r2, r3, r4 = np.moveaxis(linkage.lengths, -1, 0)
    reach = np.stack([r2 + r3, np.abs(r3 - r2)], axis=-1)
    r1, r4 = r1[..., None], r4[..., None]
    with np.errstate(invalid="ignore", divide="ignore"):
        half = np.arctan2(
            np.sqrt((r4 - (r1 - reach)) * (r4 + (r1 - reach))), np.sqrt((r1 + reach - r4) * (r1 + reach + r4))
        )
    # B lies left of A->O4 when it lies left of O2->O4 as seen along O2->B, unless A lies beyond B.
    side = linkage.assembly[..., None] * np.stack([np.ones_like(r2), np.sign(r3 - r2)], axis=-1)
    opposite = np.stack([np.zeros_like(r2), np.where(r3 > r2, np.pi, 0.0)], axis=-1)
    theta2 = (linkage.theta1[..., None] + 2 * side * half + opposite) % (2 * np.pi)
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
