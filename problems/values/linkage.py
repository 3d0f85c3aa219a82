"""The four-bar linkage as a value: what it is made of, not how it moves."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.display import Displayed
from grashof.problems.values.errors import ProblemError


@dataclass(frozen=True, slots=True, init=False, eq=False)
class FourBar(Displayed):
    """A planar four-bar linkage, or a batch of them.

    Link 2 (O2-A) is the driver, link 3 (A-B) the coupler, link 4 (O4-B) the output, link 1
    (O2-O4) the ground. A batch has the same leading axes on every field; index it to take
    linkages out or, as with arrays, to add axes: ``batch[:, None]``.

    Parameters
    ----------
    o2, o4 : array_like, shape (..., 2), length
        Ground pivots of driver and output.
    r2, r3, r4 : array_like, shape (...), length
        Lengths O2A, AB, O4B.
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
        given = {
            "o2": o2, "o4": o4, "r2": r2, "r3": r3, "r4": r4,
            "coupler_point": coupler_point, "assembly": assembly, "body_angle": body_angle,
        }  # fmt: skip
        arrays = {name: _finite(name, value) for name, value in given.items()}
        for name in _POINTS:
            if np.shape(arrays[name])[-1:] != (2,):
                raise ProblemError(f"{name} has shape {np.shape(arrays[name])}; allowed is (..., 2)")
        for name in ("r2", "r3", "r4"):
            if np.any(np.less_equal(arrays[name], 0)):
                raise ProblemError(f"{name} is {given[name]!r}; allowed are lengths greater than zero")
        if np.any(np.abs(arrays["assembly"]) != 1):
            raise ProblemError(f"assembly is {assembly!r}; allowed is +1 or -1")
        shapes = [np.shape(a)[:-1] if n in _POINTS else np.shape(a) for n, a in arrays.items()]
        try:
            batch = np.broadcast_shapes(*shapes)
        except ValueError:
            raise ProblemError(
                f"the fields of a batch have shapes {shapes} that do not fit together"
            ) from None
        for name, array in arrays.items():
            full = (*batch, 2) if name in _POINTS else batch
            object.__setattr__(self, name, frozen_array(np.broadcast_to(array, full)))

    @property
    def shape(self) -> tuple[int, ...]:
        """Batch axes; () for a single linkage."""
        return np.shape(self.r2)

    @property
    def r1(self) -> FloatArray:
        """Length O2O4, shape (...)."""
        ground = self.o4 - self.o2
        return np.hypot(ground[..., 0], ground[..., 1])

    @property
    def theta1(self) -> FloatArray:
        """Direction O2->O4 in rad, shape (...)."""
        ground = self.o4 - self.o2
        return np.arctan2(ground[..., 1], ground[..., 0])

    @property
    def lengths(self) -> FloatArray:
        """r1, r2, r3, r4; shape (..., 4)."""
        return np.stack([self.r1, self.r2, self.r3, self.r4], axis=-1)

    def __getitem__(self, index: Any) -> FourBar:
        index = index if isinstance(index, tuple) else (index,)
        taken = {}
        for field in fields(self):
            value = getattr(self, field.name)
            taken[field.name] = value[(*index, slice(None))] if field.name in _POINTS else value[index]
        return FourBar(**taken)

    def __repr__(self) -> str:
        """Of a single linkage: Python that makes it, in full precision."""
        if self.shape:
            return f"<FourBar: batch of shape {self.shape}>"
        values = {field.name: getattr(self, field.name).tolist() for field in fields(self)}
        values |= {name: tuple(values[name]) for name in _POINTS} | {"assembly": int(self.assembly)}
        return f"FourBar({', '.join(f'{name}={value!r}' for name, value in values.items())})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, FourBar):
            return NotImplemented
        return all(np.array_equal(getattr(self, f.name), getattr(other, f.name)) for f in fields(self))

    def __hash__(self) -> int:
        # Adding zero turns -0.0 into 0.0, which it equals.
        return hash(tuple((np.asarray(getattr(self, f.name)) + 0.0).tobytes() for f in fields(self)))

    def __reduce__(self) -> tuple[Any, ...]:
        # Through the constructor: arrays come out of a pickle writeable.
        return FourBar, tuple(getattr(self, f.name) for f in fields(self))


_POINTS = frozenset({"o2", "o4", "coupler_point"})


def _finite(name: str, value: npt.ArrayLike) -> FloatArray:
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ProblemError(f"{name} is {value!r}; allowed are numbers") from None
    if not np.isfinite(array).all():
        raise ProblemError(f"{name} is {value!r}; all numbers must be finite")
    return array
