"""What a task asks of the output link, however it is stated; nothing unless its kind says otherwise."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.read_only import ReadOnly
from grashof.problems.values.tasks.function_law import FunctionLaw
from grashof.problems.values.units import Unit


class Outputs(ReadOnly, ABC):
    """Rotations or travels of the output link over the driver rotation, or its limit positions."""

    __slots__ = ()

    @property
    @abstractmethod
    def driver_turns(self) -> FloatArray:
        """Driver rotation from the first target, in either sense, shape (N,), rad."""

    @property
    @abstractmethod
    def outputs(self) -> FloatArray:
        """Rotation, rad, or travel of the output from the first target, shape (N,); NaN where it is free."""

    @property
    def travels(self) -> bool:
        """Whether the output is the travel of a slide."""
        return False

    @property
    def sense(self) -> str:
        """Whether the opposite output will do, too: "given" or "either"."""
        return "given"

    @property
    def norm(self) -> str:
        """What is made least where outputs are not met exactly: "rms" or "max"."""
        return "rms"

    @property
    def law(self) -> FunctionLaw | None:
        """That the outputs are of; between outputs without one the cubic spline is wanted."""
        return None

    @property
    def swing(self) -> float | None:
        """Of link 4 between its limit positions, rad; None where none is asked for."""
        return None

    @property
    def stroke(self) -> float | None:
        """Of a slide between its limit positions, length; None where none is asked for."""
        return None

    @property
    def time_ratio(self) -> float:
        """Time of the slow stroke over that of the quick one; NaN where it is free."""
        return float("nan")

    @property
    def at_limits(self) -> bool:
        """Whether the targets are the limit positions of the output."""
        return not np.isnan(self.time_ratio)

    def impossible(self, mechanism: str) -> str:  # noqa: ARG002
        """Why a kind of linkage cannot do it, in one line; empty where it may."""
        return ""

    @property
    def output_unit(self) -> float:
        """What errors of the output count in: 1 rad, or a travel."""
        return 1.0

    @property
    def counted_in(self) -> Unit:
        """The unit of outputs and their errors in files and tables."""
        return Unit.LENGTH if self.travels else Unit.ANGLE

    @property
    def output_words(self) -> str:
        """What the output is called."""
        return "travel of the slide" if self.travels else "output rotation"

    @property
    def error_field(self) -> str:
        """The field of `Requirements` that limits the structural error."""
        return "structural_error_max" if self.travels else "structural_error_max_deg"

    def shown(self, output: float, length_unit: str) -> str:
        """An output or its error, with its unit, as people read it.

        Examples
        --------
        >>> from grashof.problems import FunctionTask
        >>> FunctionTask([0, 1, 2], [0, 1, 3], travels=True).shown(0.25, "mm")
        '0.25 mm'
        """
        unit = length_unit if self.travels else self.counted_in
        return f"{self.counted_in.shown * output:.3g} {unit}".strip()

    @property
    def fits_range(self) -> bool:
        """Whether the targets stand for the whole range of a law, from its first x to its last."""
        return self.law is not None and abs(self.driver_turns[-1] - self.law.input_range) < 1e-9

    @property
    def span(self) -> tuple[float, float]:
        """First and last driver rotation of the range, from the first target, rad."""
        if self.law is None:
            return 0.0, float(self.driver_turns[-1])
        before = float(self._before)
        return 0.0 - before, self.law.input_range - before

    @property
    def beyond(self) -> tuple[float, float]:
        """Driver rotation of what is asked before the first target and after the last, rad."""
        if self.law is None:
            return 0.0, 0.0
        low, high = self.span
        return 0.0 - low, max(0.0, high - float(self.driver_turns[-1]))

    @property
    def _before(self) -> float:
        """Driver rotation from the beginning of a law to the first target."""
        if self.law is None or self.fits_range:
            return 0.0
        # Chebyshev's spacing is symmetric.
        return (self.law.input_range - float(self.driver_turns[-1])) / 2

    def output(self, turned: npt.ArrayLike) -> FloatArray:
        """Wanted output at driver rotations from the first target: of the law, or the cubic spline.

        Examples
        --------
        >>> from grashof.problems import FunctionTask
        >>> task = FunctionTask([0, 1, 2, 3], [0, 0.1, 0.8, 2.7])
        >>> round(float(task.output(1.5)), 9)
        0.3375
        """
        at = np.asarray(turned, dtype=np.float64)
        if self.law is None:
            from scipy.interpolate import CubicSpline  # here: few problems need it

            found: FloatArray = CubicSpline(self.driver_turns, self.outputs)(at)
            return found
        before = self._before
        return self.law.output(at + before) - self.law.output(np.array(before))
