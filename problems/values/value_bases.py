"""Bases of the value types: shown in notebooks, read-only when copied, written as a table of a file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, fields
from importlib import import_module
from typing import Any, ClassVar

import numpy as np

# In a layer above, and loaded when a notebook needs it: hence its name instead of an import.
_MAKER = "grashof.notebook"


class Displayed:
    """A value that a notebook shows as HTML."""

    __slots__ = ()

    def _repr_html_(self) -> str:
        made: str = import_module(_MAKER).html(self)
        return made


class ReadOnly:
    """Base of a frozen dataclass that holds arrays: pickles and copies of arrays are writeable otherwise."""

    __slots__ = ()

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuilt, (type(self), {each.name: getattr(self, each.name) for each in fields(self)})  # type: ignore[arg-type]


def _rebuilt(kind: Any, values: dict[str, Any]) -> Any:
    made = object.__new__(kind)
    set_fields(made, **{name: _read_only(value) for name, value in values.items()})
    return made


def _read_only(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        value.setflags(write=False)
    elif type(value) is tuple:
        for each in value:
            _read_only(each)
    return value


class TableValue:
    """A frozen dataclass whose fields are the keys of a table in a file."""

    __slots__ = ()

    keeps_defaults: ClassVar[bool] = False  # whether keys at their defaults are written, except None

    @property
    def stated(self) -> dict[str, Any]:
        """The keys with their values, as a file has them; those at their defaults are left out."""
        found = {}
        for each in fields(self):  # type: ignore[arg-type]
            value, default = getattr(self, each.name), None if self.keeps_defaults else each.default
            if default is MISSING or value != default:
                found[each.name] = _plain(value)
        return found


def _plain(value: Any) -> Any:
    if isinstance(value, TableValue):
        return value.stated
    return [_plain(each) for each in value] if isinstance(value, tuple) else value


def set_fields(value: object, /, **given: Any) -> None:
    """Set fields of a frozen dataclass while it is made."""
    for name, each in given.items():
        object.__setattr__(value, name, each)


def check_fields(value: Any, where: str = "", /, **checks: Callable[[Any, str], Any]) -> None:
    """Replace these fields by the results of their checks, which name them; None passes as a default."""
    defaults = {each.name: each.default for each in fields(value)}
    for name, check in checks.items():
        given = getattr(value, name)
        if given is not None or defaults[name] is not None:
            set_fields(value, **{name: check(given, where + name)})
