"""The four-bar linkage as a value: what it is made of, not how it moves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.display import Displayed
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.linkage_parts import Link, Parameter, joints_of, points_of


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

    # What a four-bar is; files, tables, drawings and plates go through these rows.
    PARAMETERS: ClassVar[tuple[Parameter, ...]] = (
        Parameter("o2", "place"),
        Parameter("o4", "place"),
        Parameter("r2", "length"),
        Parameter("r3", "length"),
        Parameter("r4", "length"),
        Parameter("coupler_point", "arm", column="p"),
        Parameter("assembly", "sign"),
        Parameter("body_angle", "angle"),
    )
    LINKS: ClassVar[tuple[Link, ...]] = (
        Link(1, "ground", ("o2", "o4")),
        Link(2, "driver", ("o2", "a")),
        Link(3, "coupler", ("a", "b", "p")),
        Link(4, "output", ("o4", "b")),
    )
    GROUND: ClassVar[tuple[str, ...]] = LINKS[0].points
    POINTS: ClassVar[tuple[str, ...]] = points_of(LINKS)
    MOVING: ClassVar[tuple[str, ...]] = POINTS[len(GROUND) :]
    JOINTS: ClassVar[dict[str, tuple[int, ...]]] = joints_of(LINKS)
    PIVOTS: ClassVar[tuple[str, ...]] = tuple(filter(JOINTS.__contains__, POINTS))
    LENGTHS: ClassVar[tuple[str, ...]] = tuple(f"r{link.number}" for link in LINKS)
    # What is made, and may come out inexactly.
    DIMENSIONS: ClassVar[tuple[str, ...]] = (*LENGTHS, "u", "v")

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
        given = (o2, o4, r2, r3, r4, coupler_point, assembly, body_angle)
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
        """The lengths r1, r2, ... and all parameters by their columns in tables. Of a single linkage."""
        found = dict(zip(self.LENGTHS, self.lengths.tolist(), strict=True))
        for row, value in zip(self.PARAMETERS, self.parameters, strict=True):
            numbers = np.degrees(value) if row.kind == "angle" else value
            found |= zip(row.columns, np.ravel(numbers).tolist(), strict=True)
        return found | {"assembly": int(self.assembly)}

    def scaled(self, factor: float, origin: FloatArray) -> FourBar:
        """The linkage with all lengths times a factor, its places measured from `origin`, shape (2,)."""

        def change(row: Parameter, value: FloatArray) -> FloatArray:
            moved = value - origin if row.kind == "place" else value
            return moved * factor if row.in_length else moved

        return FourBar(*map(change, self.PARAMETERS, self.parameters))

    def __getitem__(self, index: Any) -> FourBar:
        index = index if isinstance(index, tuple) else (index,)
        rows = zip(self.PARAMETERS, self.parameters, strict=True)
        return FourBar(*(value[(*index, slice(None)) if row.paired else index] for row, value in rows))

    def __repr__(self) -> str:
        """Of a single linkage: Python that makes it, in full precision."""
        if self.shape:
            return f"<FourBar: batch of shape {self.shape}>"
        stated = {name: tuple(x) if isinstance(x, list) else x for name, x in self.stated.items()}
        return f"FourBar({', '.join(f'{name}={value!r}' for name, value in stated.items())})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, FourBar):
            return NotImplemented
        return all(map(np.array_equal, self.parameters, other.parameters))

    def __hash__(self) -> int:
        # Adding zero turns -0.0 into 0.0, which it equals.
        return hash(tuple((np.asarray(value) + 0.0).tobytes() for value in self.parameters))

    def __reduce__(self) -> tuple[Any, ...]:
        # Through the constructor: arrays come out of a pickle writeable.
        return FourBar, self.parameters
