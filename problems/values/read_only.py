"""Frozen values whose arrays stay read-only when they are copied."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np


class ReadOnly:
    """Base of a frozen dataclass that holds arrays: from pickles and copies NumPy gives writeable ones."""

    __slots__ = ()

    def __reduce__(self) -> tuple[Any, ...]:
        values = tuple(getattr(self, field.name) for field in fields(self))  # type: ignore[arg-type]
        return _rebuilt, (type(self), values)


def _rebuilt(kind: Any, values: tuple[Any, ...]) -> Any:
    made = object.__new__(kind)
    for field, value in zip(fields(kind), values, strict=True):
        object.__setattr__(made, field.name, _read_only(value))
    return made


def _read_only(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        value.setflags(write=False)
    elif type(value) is tuple:
        for each in value:
            _read_only(each)
    return value
