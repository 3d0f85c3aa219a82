"""The base of all kinds of linkages as values: parameters, links and lengths by the rows of a mechanism."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.linkages.mechanism import Mechanism, Parameter
from grashof.problems.values.value_bases import Displayed, set_fields


class Linkage(Displayed):
    """A planar linkage, or a batch: base of `FourBar`, `SliderCrank`, `InvertedSliderCrank`, `SixBar`.

    Link 1 is the ground, link 2 (O2-A) the driver; links 3 and 4 close the first loop. A batch has
    the same leading axes on every field; index it to take linkages out or, as with arrays, to add axes:
    ``batch[:, None]``.
    """

    __slots__ = ()

    mechanism: Mechanism  # its kind; files, tables, drawings and plates loop over its rows

    o2: FloatArray
    r2: FloatArray
    coupler_point: FloatArray
    assembly: FloatArray
    body_angle: FloatArray
    # Of some kinds only, as their rows say.
    o4: FloatArray
    r3: FloatArray
    slide_angle: FloatArray

    def _keep(self, *given: npt.ArrayLike) -> None:
        """Set the fields, in the order of `Mechanism.parameters`, checked, with the same batch axes."""
        arrays = {row: row.array(value) for row, value in zip(self.mechanism.parameters, given, strict=True)}
        shapes = [array.shape[:-1] if row.paired else array.shape for row, array in arrays.items()]
        try:
            batch = np.broadcast_shapes(*shapes)
        except ValueError:
            raise ProblemError(
                f"the fields of a batch have shapes {shapes} that do not fit together"
            ) from None
        for row, array in arrays.items():
            full = (*batch, 2) if row.paired else batch
            set_fields(self, **{row.name: frozen_array(np.broadcast_to(array, full))})

    @property
    def shape(self) -> tuple[int, ...]:
        """Batch axes; () for a single linkage."""
        return np.shape(self.r2)

    @property
    def r1(self) -> FloatArray:
        """Length O2O4, shape (...)."""
        x, y = self._ground
        return np.hypot(x, y)

    @property
    def theta1(self) -> FloatArray:
        """Direction O2->O4 in rad, shape (...)."""
        x, y = self._ground
        return np.arctan2(y, x)

    @property
    def _ground(self) -> tuple[FloatArray, FloatArray]:
        """O2->O4 in x and y, each of shape (...)."""
        ground = self.o4 - self.o2
        return ground[..., 0], ground[..., 1]

    @property
    def choices(self) -> dict[str, Any]:
        """Arguments besides arrays, which choose the kind; empty for a linkage of one loop."""
        return {}

    @property
    def lengths(self) -> FloatArray:
        """Of the links, as `Mechanism.lengths` names them; shape (..., L)."""
        return np.stack([getattr(self, name) for name in self.mechanism.lengths], axis=-1)

    @property
    def parameters(self) -> tuple[FloatArray, ...]:
        """The arguments that give this value, in the order of `Mechanism.parameters`."""
        return tuple(getattr(self, row.name) for row in self.mechanism.parameters)

    @property
    def stated(self) -> dict[str, Any]:
        """The same by name, as plain numbers and lists: lossless JSON. Of a single linkage."""
        rows = zip(self.mechanism.parameters, self.parameters, strict=True)
        plain = {row.name: int(x) if row.kind == "sign" else x.tolist() for row, x in rows}
        return plain | self.choices

    @property
    def columns(self) -> dict[str, float | str]:
        """The lengths of the links and all parameters by their columns in tables. Of a single linkage."""
        found = dict(zip(self.mechanism.lengths, self.lengths.tolist(), strict=True))
        for row, value in zip(self.mechanism.parameters, self.parameters, strict=True):
            numbers = np.degrees(value) if row.kind == "angle" else value
            found |= zip(row.columns, np.ravel(numbers).tolist(), strict=True)
            if row.kind == "sign":
                found[row.name] = int(value)
        return found | {name: "-".join(map(str, np.ravel(x))) for name, x in self.choices.items()}

    @property
    def flat(self) -> Self:
        """The linkages of a batch in a row, shape (n,); a single one as a batch of one."""
        return self[None][np.unravel_index(np.arange(np.size(self.r2)), (1, *self.shape))]

    def scaled(self, factor: float, origin: FloatArray) -> Self:
        """The linkage with all lengths times a factor, its places measured from `origin`, shape (2,)."""

        def change(row: Parameter, value: FloatArray) -> FloatArray:
            moved = value - origin if row.kind in ("place", "station") else value
            return moved * factor if row.in_length else moved

        return self._with(map(change, self.mechanism.parameters, self.parameters))

    def changed(self, **parameters: npt.ArrayLike) -> Self:
        """The linkage with other values of some of its parameters."""
        return type(self)(**(self._arguments(self.parameters) | parameters))

    @classmethod
    def stacked(cls, linkages: Sequence[Self]) -> Self:
        """Linkages of one kind as a batch."""
        parameters = zip(*(linkage.parameters for linkage in linkages), strict=True)
        return linkages[0]._with(map(np.stack, parameters))

    def _with(self, parameters: Iterable[npt.ArrayLike]) -> Self:
        """A linkage of the same kind with other parameters, in their order."""
        return type(self)(**self._arguments(parameters))

    def _arguments(self, parameters: Iterable[npt.ArrayLike]) -> dict[str, Any]:
        """The arguments of the constructor for parameters in their order."""
        names = (row.name for row in self.mechanism.parameters)
        return dict(zip(names, parameters, strict=True)) | self.choices

    def __getitem__(self, index: Any) -> Self:
        index = index if isinstance(index, tuple) else (index,)
        made = object.__new__(type(self))  # its values are checked
        if "mechanism" in self.__slots__:  # of six-bars, which are of many kinds
            set_fields(made, mechanism=self.mechanism)
        for row, value in zip(self.mechanism.parameters, self.parameters, strict=True):
            some = value[(*index, slice(None)) if row.paired else index]
            if some.ndim:
                some.setflags(write=False)
            set_fields(made, **{row.name: some})
        return made

    def __repr__(self) -> str:
        """Of a single linkage: Python that makes it, in full precision."""
        if self.shape:
            return f"<{type(self).__name__}: batch of shape {self.shape}>"
        stated = {name: tuple(x) if isinstance(x, list) else x for name, x in self.stated.items()}
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in stated.items())})"

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        same = self.mechanism == other.mechanism
        return same and all(map(np.array_equal, self.parameters, other.parameters))

    def __hash__(self) -> int:
        # Adding zero turns -0.0 into 0.0, which it equals.
        return hash((self.mechanism, *((np.asarray(value) + 0.0).tobytes() for value in self.parameters)))

    def __reduce__(self) -> tuple[Any, ...]:
        # Through the constructor: arrays come out of a pickle writeable.
        return _rebuilt, (type(self), self._arguments(self.parameters))


def by_kind(linkages: Sequence[Linkage]) -> list[list[int]]:
    """Indices of the linkages of each kind in a sequence, for `Linkage.stacked`."""
    found: dict[Mechanism, list[int]] = {}
    for index, linkage in enumerate(linkages):
        found.setdefault(linkage.mechanism, []).append(index)
    return list(found.values())


def _rebuilt(kind: type[Linkage], given: dict[str, Any]) -> Linkage:
    """A linkage out of a pickle."""
    return kind(**given)
