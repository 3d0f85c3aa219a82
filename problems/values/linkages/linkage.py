"""What every kind of linkage is as a value: parameters, links, lengths; all else goes through these rows."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar, Self

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.display import Displayed
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.linkages.linkage_parts import Link, Parameter, joints_of, points_of


class Linkage(Displayed, ABC):
    """A planar linkage, or a batch of them: base of `FourBar`, `SliderCrank` and `InvertedSliderCrank`.

    Link 2 (O2-A) is the driver, link 3 carries the coupler point P, link 4 closes the loop, link 1 is
    the ground. A batch has the same leading axes on every field; index it to take linkages out or, as
    with arrays, to add axes: ``batch[:, None]``.
    """

    __slots__ = ()

    # What the kind is; files, tables, drawings and plates go through these rows.
    MECHANISM: ClassVar[str]  # in files and tables
    PARAMETERS: ClassVar[tuple[Parameter, ...]]
    LINKS: ClassVar[tuple[Link, ...]]  # the ground first
    SLIDES: ClassVar[tuple[tuple[int, int], ...]] = ()  # links that slide on each other
    LENGTHS: ClassVar[tuple[str, ...]]  # of links, all positive
    DIMENSIONS: ClassVar[tuple[str, ...]]  # what is made, and may come out inexactly
    # What follows from its links.
    GROUND: ClassVar[tuple[str, ...]]  # points that stand still
    POINTS: ClassVar[tuple[str, ...]]
    MOVING: ClassVar[tuple[str, ...]]
    JOINTS: ClassVar[dict[str, tuple[int, ...]]]
    PIVOTS: ClassVar[tuple[str, ...]]  # joints with a pin

    o2: FloatArray
    r2: FloatArray
    coupler_point: FloatArray
    assembly: FloatArray
    body_angle: FloatArray

    def __init_subclass__(cls) -> None:
        cls.GROUND = cls.LINKS[0].points
        cls.POINTS = points_of(cls.LINKS)
        cls.MOVING = cls.POINTS[len(cls.GROUND) :]
        cls.JOINTS = joints_of(cls.LINKS)
        cls.PIVOTS = tuple(filter(cls.JOINTS.__contains__, cls.POINTS))

    def _keep(self, *given: npt.ArrayLike) -> None:
        """Set the fields to values in the order of `PARAMETERS`, checked, with the same batch axes."""
        arrays = {row: row.array(value) for row, value in zip(self.PARAMETERS, given, strict=True)}
        shapes = [array.shape[:-1] if row.paired else array.shape for row, array in arrays.items()]
        try:
            batch = np.broadcast_shapes(*shapes)
        except ValueError:
            raise ProblemError(
                f"the fields of a batch have shapes {shapes} that do not fit together"
            ) from None
        for row, array in arrays.items():
            full = (*batch, 2) if row.paired else batch
            object.__setattr__(self, row.name, frozen_array(np.broadcast_to(array, full)))

    @property
    def shape(self) -> tuple[int, ...]:
        """Batch axes; () for a single linkage."""
        return np.shape(self.r2)

    @property
    @abstractmethod
    def theta1(self) -> FloatArray:
        """Direction of the ground link in rad, shape (...)."""

    @property
    def lengths(self) -> FloatArray:
        """Of the links, as `LENGTHS` names them; shape (..., L)."""
        return np.stack([getattr(self, name) for name in self.LENGTHS], axis=-1)

    @property
    def parameters(self) -> tuple[FloatArray, ...]:
        """The arguments that give this value, in the order of `PARAMETERS`."""
        return tuple(getattr(self, row.name) for row in self.PARAMETERS)

    @property
    def stated(self) -> dict[str, Any]:
        """The same by name, as plain numbers and lists: lossless JSON. Of a single linkage."""
        plain = {row.name: getattr(self, row.name).tolist() for row in self.PARAMETERS}
        return plain | {"assembly": int(self.assembly)}

    @property
    def columns(self) -> dict[str, float]:
        """The lengths of the links and all parameters by their columns in tables. Of a single linkage."""
        found = dict(zip(self.LENGTHS, self.lengths.tolist(), strict=True))
        for row, value in zip(self.PARAMETERS, self.parameters, strict=True):
            numbers = np.degrees(value) if row.kind == "angle" else value
            found |= zip(row.columns, np.ravel(numbers).tolist(), strict=True)
        return found | {"assembly": int(self.assembly)}

    def scaled(self, factor: float, origin: FloatArray) -> Self:
        """The linkage with all lengths times a factor, its places measured from `origin`, shape (2,)."""

        def change(row: Parameter, value: FloatArray) -> FloatArray:
            moved = value - origin if row.kind == "place" else value
            return moved * factor if row.in_length else moved

        return type(self)(*map(change, self.PARAMETERS, self.parameters))

    def changed(self, **parameters: npt.ArrayLike) -> Self:
        """The linkage with other values of some of its parameters."""
        stated = {row.name: value for row, value in zip(self.PARAMETERS, self.parameters, strict=True)}
        return type(self)(**(stated | parameters))

    def __getitem__(self, index: Any) -> Self:
        index = index if isinstance(index, tuple) else (index,)
        rows = zip(self.PARAMETERS, self.parameters, strict=True)
        return type(self)(*(value[(*index, slice(None)) if row.paired else index] for row, value in rows))

    def __repr__(self) -> str:
        """Of a single linkage: Python that makes it, in full precision."""
        if self.shape:
            return f"<{type(self).__name__}: batch of shape {self.shape}>"
        stated = {name: tuple(x) if isinstance(x, list) else x for name, x in self.stated.items()}
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in stated.items())})"

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(map(np.array_equal, self.parameters, other.parameters))

    def __hash__(self) -> int:
        # Adding zero turns -0.0 into 0.0, which it equals.
        return hash((self.MECHANISM, *((np.asarray(value) + 0.0).tobytes() for value in self.parameters)))

    def __reduce__(self) -> tuple[Any, ...]:
        # Through the constructor: arrays come out of a pickle writeable.
        return type(self), self.parameters
