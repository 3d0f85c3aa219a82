"""The four-bar linkage as a value: what it is made of, not how it moves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import ONE_LOOP


@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class FourBar(Linkage):
    """A planar four-bar linkage, or a batch of them.

    Link 2 (O2-A) is the driver, link 3 (A-B) the coupler, link 4 (O4-B) the output, link 1
    (O2-O4) the ground. A batch has the same leading axes on every field; index it to take
    linkages out or, as with arrays, to add axes: ``batch[:, None]``.

    Parameters
    ----------
    o2 : array_like, shape (..., 2), length
        Ground pivot of the driver.
    o4 : array_like, shape (..., 2), length
        Ground pivot of the output.
    r2 : array_like, shape (...), length
        Length O2A, of the driver.
    r3 : array_like, shape (...), length
        Length AB, of the coupler.
    r4 : array_like, shape (...), length
        Length O4B, of the output.
    coupler_point : array_like, shape (..., 2), length
        P in the coupler's frame: origin A, u along AB, v to its left.
    assembly : array_like, shape (...)
        Sign of sin(theta4 - theta3): +1 when B lies left of the directed line A->O4, else -1.
    body_angle : array_like, shape (...), rad
        Orientation of the guided body minus theta3.

    Raises
    ------
    ProblemError
        A length that is not positive, an assembly other than +1 or -1, a number that is not
        finite, or shapes that do not fit together.

    Examples
    --------
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    >>> float(crank_rocker.r1), crank_rocker.shape
    (4.0, ())
    """

    mechanism = ONE_LOOP["four-bar"]

    o2: FloatArray
    o4: FloatArray
    r2: FloatArray
    r3: FloatArray
    r4: FloatArray
    coupler_point: FloatArray
    assembly: FloatArray
    body_angle: FloatArray

    def __init__(
        self,
        o2: npt.ArrayLike,
        o4: npt.ArrayLike,
        r2: npt.ArrayLike,
        r3: npt.ArrayLike,
        r4: npt.ArrayLike,
        coupler_point: npt.ArrayLike = (0.0, 0.0),
        assembly: npt.ArrayLike = 1,
        body_angle: npt.ArrayLike = 0.0,
    ) -> None:
        self._keep(o2, o4, r2, r3, r4, coupler_point, assembly, body_angle)
