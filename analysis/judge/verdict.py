"""The judge's verdict on a linkage: how it does a task, and its defects."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from grashof.analysis.judge.meeting.dwell_output import DwellFigures
from grashof.analysis.judge.meeting.two_outputs import TwoOutputs
from grashof.analysis.mechanism.first_loop import GrashofClass
from grashof.problems import Cylinder
from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.problems.values.dynamics.effort import EffortSpec


@dataclass(frozen=True, slots=True)
class Defect:
    """One requirement that a design misses.

    Parameters
    ----------
    requirement : str
        Its key; "exact" for targets that are not met.
    what : str
        The quantity judged, such as "r3".
    found : float
        Its value, as tables print it (degrees for angles).
    allowed : str
    miss : float
        By how much it is missed: share of the size, rad, or ratio.
    """

    requirement: str
    what: str
    found: float
    allowed: str
    miss: float

    def __str__(self) -> str:
        return f"{self.requirement}: {self.what} is {self.found:.6g}, allowed: {self.allowed}"


@dataclass(frozen=True, slots=True)
class Verdict:
    """How a linkage does a task, and every defect.

    Parameters
    ----------
    theta2 : ndarray, shape (N,), rad
        Driver angle at each target, unwrapped along the task motion.
    assembly : ndarray of int, shape (N,)
        Assembly at each target.
    position_error : ndarray, shape (N,), length
        NaN where a target has no position.
    angle_error : ndarray, shape (N,), rad
        NaN where a target has no angle.
    square : float, length squared
        The objective of least squares: the weighted sum of |dp|^2 + (angle_length * dangle)^2, and the
        share of a wanted torque by its weight.
    direction : int
        Sense of the driver, +1 counter-clockwise.
    grashof_class : GrashofClass
    full_rotation, circuit_ok, branch_ok, order_ok : bool
    transmission_min_task, transmission_min_cycle : float, rad
        Worst min(mu, pi - mu) over the task motion and over the turn.
    size : float, length
        Diagonal of the box around the pivots and all that joints and P reach in it.
    defects : tuple of Defect
        Empty for a design that meets all requirements.
    cylinder : Cylinder, optional
        The cylinder that drives the linkage.
    effort : EffortSpec, optional
        The effort with its placed struts and springs.
    output_error : ndarray, shape (N,), rad
        Of the output of a function at its pairs; empty for other tasks.
    structural_error_max, structural_error_rms, structural_error_at : float, rad
        Over the range of a function: greatest, root mean square, and the driver rotation from the first
        pair to the greatest; NaN for other tasks, or where the motion does not cover the range.
    dwell : DwellFigures, optional
        Of a dwell: where it is, its band, and the swing; None where the driver or the output turns otherwise.
    length_ratio : float
        Length of the curve of P over that of the closed spline through the points of a path, where it is
        limited; NaN elsewhere.
    outputs : TwoOutputs, optional
        Of two outputs: their swings, time ratios and synchrony.
    output_zero : float, rad
        Direction of the link, such as theta4, at the wanted output zero.
    output_sense : int
        -1 where the output is the opposite of the wanted one.
    """

    theta2: FloatArray
    assembly: IntArray
    position_error: FloatArray
    angle_error: FloatArray
    square: float
    direction: int
    grashof_class: GrashofClass
    full_rotation: bool
    circuit_ok: bool
    branch_ok: bool
    order_ok: bool
    transmission_min_task: float
    transmission_min_cycle: float
    size: float
    defects: tuple[Defect, ...]
    cylinder: Cylinder | None = None
    output_error: FloatArray = field(default_factory=lambda: np.empty(0))
    structural_error_max: float = np.nan
    structural_error_rms: float = np.nan
    structural_error_at: float = np.nan
    output_zero: float = np.nan
    output_sense: int = 1
    dwell: DwellFigures | None = None
    length_ratio: float = np.nan
    outputs: TwoOutputs | None = None
    effort: EffortSpec | None = None

    @property
    def ok(self) -> bool:
        """Whether the linkage has no defect."""
        return not self.defects

    @property
    def error_max(self) -> float:
        """Greatest distance from a target position; NaN where the task has no position."""
        return np.nan if self._unplaced else float(np.nanmax(self.position_error))

    @property
    def error_sse(self) -> float:
        """Sum of squared distances from the target positions."""
        return np.nan if self._unplaced else float(np.nansum(self.position_error**2))

    @property
    def error_rms(self) -> float:
        """Root mean square distance from the target positions."""
        return np.nan if self._unplaced else float(np.sqrt(np.nanmean(self.position_error**2)))

    @property
    def _unplaced(self) -> bool:
        """Whether the task has no position."""
        return bool(np.isnan(self.position_error).all())


@dataclass(frozen=True, slots=True)
class Enclosure:
    """Verification of a design that the judge accepted, by intervals of the driver angle.

    `holds` if closure over the required motion on one branch without a dead position, transmission, order,
    targets and places there are proven, every rounding enclosed. `transmission` (rad) holds the least min(mu,
    pi - mu) over the required motion; `intervals` is their number, `why` the claims not shown, empty where
    all are; `contradicts` shows the judge wrong, a defect of this program.
    """

    holds: bool
    transmission: tuple[float, float]
    intervals: int
    why: str = ""
    contradicts: bool = False
