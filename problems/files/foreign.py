"""Readers of formats that others wrote: what they raise on damaged files, and how much they may expand."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from grashof.problems.values.errors import ProblemError, shown

_DEEPEST = 32  # blocks within blocks, groups within groups


@contextmanager
def read_by_others(wanted: str) -> Iterator[None]:
    """What a library raises on a file that is not `wanted`, as a `ProblemError` of one line; no warnings."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except ProblemError:
        raise
    except Exception as error:  # noqa: BLE001  (no library documents what damaged bytes make it raise)
        said = str(error).split("\n", maxsplit=1)[0].strip()
        raise ProblemError(f"is not {wanted}: {shown(said) if said else type(error).__name__}") from None


class Budget:
    """How many parts a drawing may have once what it repeats is written out.

    `part` is what they are, `level` what of them may contain others, in the plural: "entities", "blocks".
    """

    def __init__(self, most: int, part: str, level: str) -> None:
        self._most, self._part, self._level = most, part, level
        self._left = most

    def spend(self, count: int = 1) -> None:
        """Count parts; `ProblemError` when they are too many."""
        self._left -= count
        if self._left < 0:
            raise ProblemError(f"the drawing has more than {self._most} {self._part}; that is the most")

    def enter(self, depth: int) -> None:
        """`ProblemError` for parts within parts that are nested too deep."""
        if depth > _DEEPEST:
            raise ProblemError(f"{self._level} are nested more than {_DEEPEST} deep, perhaps in themselves")


def finite(values: Any, most: float) -> bool:
    """Whether all numbers within nested sequences are finite and not beyond a size."""
    if isinstance(values, int | float):
        return abs(values) <= most
    if isinstance(values, str | bytes) or not hasattr(values, "__iter__"):
        return True
    return all(finite(each, most) for each in values)
