"""Linkages of one loop as values: four-bar, slider-crank and inverted slider-crank."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
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


@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class SliderCrank(Linkage):
    """A planar slider-crank, or a batch of them: crank and dyad RRP.

    Link 2 (O2-A) is the driver, link 3 (A-B) the connecting rod, which carries the coupler point, link 4
    the slider, pinned to the rod in B, which moves along a line of the ground. A batch has the same
    leading axes on every field.

    Parameters
    ----------
    o2 : array_like, shape (..., 2), length
        Ground pivot of the driver.
    r2 : array_like, shape (...), length
        Length O2A, of the crank.
    r3 : array_like, shape (...), length
        Length AB, of the connecting rod.
    offset : array_like, shape (...), length
        Of the slide's line from O2, positive to the left of its direction.
    slide_angle : array_like, shape (...), rad
        Direction of the slide, counter-clockwise from +x.
    coupler_point : array_like, shape (..., 2), length
        P in the rod's frame: origin A, u along AB, v to its left.
    assembly : array_like, shape (...)
        Sign of cos(theta3 - slide_angle): +1 when B lies ahead of A along the slide's direction, else -1.
    body_angle : array_like, shape (...), rad
        Orientation of the guided body minus theta3.

    Raises
    ------
    ProblemError
        Values that `FourBar` would refuse.

    Notes
    -----
    Norton, *Design of Machinery*, sec. 4.6. As a four-bar whose O4 lies at infinity on the left of the
    slide it has theta1 = theta4 = slide_angle + 90 deg, so the assembly is the sign of
    sin(theta4 - theta3) here, too.

    Examples
    --------
    >>> engine = SliderCrank(o2=(0, 0), r2=40, r3=120)
    >>> float(engine.offset), engine.shape
    (0.0, ())
    """

    mechanism = ONE_LOOP["slider-crank"]

    o2: FloatArray
    r2: FloatArray
    r3: FloatArray
    offset: FloatArray
    slide_angle: FloatArray
    coupler_point: FloatArray
    assembly: FloatArray
    body_angle: FloatArray

    def __init__(
        self,
        o2: npt.ArrayLike,
        r2: npt.ArrayLike,
        r3: npt.ArrayLike,
        offset: npt.ArrayLike = 0.0,
        slide_angle: npt.ArrayLike = 0.0,
        coupler_point: npt.ArrayLike = (0.0, 0.0),
        assembly: npt.ArrayLike = 1,
        body_angle: npt.ArrayLike = 0.0,
    ) -> None:
        self._keep(o2, r2, r3, offset, slide_angle, coupler_point, assembly, body_angle)

    @property
    def theta1(self) -> FloatArray:
        """Direction across the slide, to its left, in rad, shape (...): where O4 lies, at infinity."""
        return np.asarray(self.slide_angle + np.pi / 2)


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
        Values that `FourBar` would refuse.

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
