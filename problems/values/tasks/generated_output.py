"""The output of a function and the variable that it depends on; for other tasks the default values."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import lru_cache
from typing import TYPE_CHECKING, Self

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.problems.values.tasks.function_law import FunctionLaw
from grashof.problems.values.units import Unit

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline


class GeneratedOutput(ABC):
    """The output of a linkage, wanted as a function of its input; base of `Task`.

    The input is the driver's rotation or the lengthening of a cylinder, each from the first target.
    """

    __slots__ = ()

    # Optional values of a task, with their defaults.
    #: The link whose rotation is the output of a function: "output", the last one, or "coupler", link 3.
    link: str = "output"
    #: Whether the output is the travel of a slide.
    travels: bool = False
    #: Whether the opposite output is accepted, too: "given" or "either".
    sense: str = "given"
    #: The error to minimise where outputs are not met exactly: "rms" or "max".
    norm: str = "rms"
    #: The law of the outputs; without one the cubic spline through them is wanted.
    law: FunctionLaw | None = None
    #: Whether the inputs of a function are lengthenings of the cylinder that drives it.
    lengthens: bool = False
    #: Limits of d(output)/d(input): rows of input, least and greatest value, shape (R, 3).
    rates: FloatArray | None = None
    #: Driver rotation from the beginning of the range, rad, at which the linkage is its own mirror image.
    mirror: float | None = None

    @abstractmethod
    def __len__(self) -> int:
        """Number of targets."""

    @property
    def driver_turns(self) -> FloatArray:
        """Driver rotation from the first target, in either sense, shape (N,), rad; NaN where free."""
        return np.full(len(self), np.nan)

    @property
    def outputs(self) -> FloatArray:
        """Rotation of the output from the first target, positive as the driver turns, shape (N,), rad."""
        return np.full(len(self), np.nan)

    @property
    def inputs(self) -> FloatArray:
        """The inputs, from the first target, shape (N,), rad or length."""
        return self.driver_turns

    def by_turns(self, turned: FloatArray) -> Self:  # noqa: ARG002
        """The same with driver rotations (N,), rad, as inputs, without limits of rates."""
        return self

    @property
    @abstractmethod
    def size(self) -> float:
        """The full travel of a slide, where that is the output."""

    def output_links(self, mechanism: Mechanism) -> tuple[int, ...]:
        """The links of a linkage whose turning is its output: the last one, none where that slides."""
        last = mechanism.loops[-1]
        return (last.links[1],) if last.pinned else ()

    def turning_link(self, mechanism: Mechanism) -> int:
        """The number of the link whose rotation is the output of a function."""
        return mechanism.loops[0].links[0] if self.link == "coupler" else mechanism.loops[-1].links[1]

    @property
    def output_unit(self) -> float:
        """The unit of output errors: 1 rad, or a travel."""
        return 1.0

    @property
    def counted_in(self) -> Unit:
        """The unit of outputs and their errors in files and tables."""
        return Unit.LENGTH if self.travels else Unit.ANGLE

    @property
    def counted_from(self) -> Unit:
        """The unit of inputs in files and tables."""
        return Unit.LENGTH if self.lengthens else Unit.ANGLE

    @property
    def input_words(self) -> str:
        """The name of the input in a sentence."""
        return "lengthening of the cylinder" if self.lengthens else "driver rotation"

    def input_axis(self, length_unit: str) -> str:
        """The label of an axis over the input.

        >>> from grashof.problems import FunctionTask
        >>> FunctionTask([0, 1, 2], [0, 1, 3]).input_axis("mm")
        'driver rotation from the first pair (deg)'
        """
        return f"{self.input_words} from the first pair ({self.counted_from.of(length_unit)})"

    @property
    def usual_ground(self) -> float:
        """Length of the ground link where nothing limits it: 1, or the stroke of a cylinder."""
        return float(self.inputs[-1]) if self.lengthens else 1.0

    @property
    def rate_unit(self) -> float:
        """Factor from rates d(output)/d(input) inside to those in files."""
        return self.counted_in.shown / self.counted_from.shown

    @property
    def output_words(self) -> str:
        """The name of the output in a sentence."""
        return "travel of the slide" if self.travels else f"{self.link} rotation"

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
        """Whether the targets sample the full range of a law, from its first x to its last."""
        return self.law is not None and abs(self.inputs[-1] - self.law.input_range) < 1e-9

    @property
    def span(self) -> tuple[float, float]:
        """First and last input of the range, from the first target, rad or length."""
        if self.law is None:
            return 0.0, float(self.inputs[-1])
        before = float(self._before)
        return 0.0 - before, self.law.input_range - before

    @property
    def mirror_turn(self) -> float:
        """Driver rotation from the first target to the mirrored position, rad; NaN without."""
        return np.nan if self.mirror is None else self.mirror + self.span[0]

    @property
    def beyond(self) -> tuple[float, float]:
        """Input within the range before the first target and after the last, rad or length."""
        if self.law is None:
            return 0.0, 0.0
        low, high = self.span
        return 0.0 - low, max(0.0, high - float(self.inputs[-1]))

    @property
    def _before(self) -> float:
        """Input from the beginning of a law to the first target."""
        if self.law is None or self.fits_range:
            return 0.0
        # Chebyshev's spacing is symmetric.
        return (self.law.input_range - float(self.inputs[-1])) / 2

    def output(self, inputs: npt.ArrayLike) -> FloatArray:
        """Wanted output at inputs from the first target: of the law, or the cubic spline.

        Examples
        --------
        >>> from grashof.problems import FunctionTask
        >>> task = FunctionTask([0, 1, 2, 3], [0, 0.1, 0.8, 2.7])
        >>> round(float(task.output(1.5)), 9)
        0.3375
        """
        at = np.asarray(inputs, dtype=np.float64)
        if self.law is None:
            found: FloatArray = _spline(self.inputs.tobytes(), self.outputs.tobytes())(at)
            return found
        before = self._before
        return self.law.output(at + before) - self.law.output(np.array(before))


@lru_cache(maxsize=16)
def _spline(places: bytes, values: bytes) -> CubicSpline:
    """The cubic spline through values at places, arrays of floats as bytes."""
    from scipy.interpolate import CubicSpline  # here: few problems need it

    return CubicSpline(np.frombuffer(places), np.frombuffer(values))
