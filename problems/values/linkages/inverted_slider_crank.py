"""The inverted slider-crank as a value: a rod that the crank moves through a block that swings or turns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import ONE_LOOP


@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class InvertedSliderCrank(Linkage):
    """A planar inverted slider-crank, or a batch of them: crank and dyad RPR.

    Link 2 (O2-A) is the driver, link 3 the rod, pinned to it in A, which carries the coupler point and
    slides through link 4, the block, pinned to the ground in O4. B is the foot of the perpendicular
    from O4 on the rod's line; it is a point of the block. A batch has the same leading axes on every field.

    Parameters
    ----------
    o2 : array_like, shape (..., 2), length
        Ground pivot of the driver.
    o4 : array_like, shape (..., 2), length
        Ground pivot of the block.
    r2 : array_like, shape (...), length
        Length O2A.
    offset : array_like, shape (...), length
        Of the rod's line from O4, positive to the left of the rod's direction.
    coupler_point : array_like, shape (..., 2), length
        P in the rod's frame: origin A, u along the rod, v to its left.
    assembly : array_like, shape (...)
        +1 when B lies ahead of A along the rod's direction, else -1.
    body_angle : array_like, shape (...), rad
        Orientation of the guided body minus theta3.

    Raises
    ------
    ProblemError
        A length that is not positive, an assembly other than +1 or -1, a number that is not
        finite, or shapes that do not fit together.

    Notes
    -----
    Norton, *Design of Machinery*, sec. 4.7. theta3 is the direction of the rod, theta4 = theta3 + 90 deg
    that from O4 to B where the offset is positive: B = O4 + offset e^(i theta4). With r2 less than r1 the
    block swings (crank-shaper), with r2 greater it turns (Whitworth).

    Examples
    --------
    >>> shaper = InvertedSliderCrank(o2=(0, 0), o4=(0, -2), r2=1)
    >>> float(shaper.r1), shaper.shape
    (2.0, ())
    """

    mechanism = ONE_LOOP["inverted-slider-crank"]

    o2: FloatArray
    o4: FloatArray
    r2: FloatArray
    offset: FloatArray
    coupler_point: FloatArray
    assembly: FloatArray
    body_angle: FloatArray

    def __init__(
        self,
        o2: npt.ArrayLike,
        o4: npt.ArrayLike,
        r2: npt.ArrayLike,
        offset: npt.ArrayLike = 0.0,
        coupler_point: npt.ArrayLike = (0.0, 0.0),
        assembly: npt.ArrayLike = 1,
        body_angle: npt.ArrayLike = 0.0,
    ) -> None:
        self._keep(o2, o4, r2, offset, coupler_point, assembly, body_angle)
