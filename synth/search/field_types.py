"""Whether values are of the types that the fields of value types state: for what is read from a file."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

import numpy as np

# Numbers, by how NumPy's kinds of them begin: a whole number is a real one, too, but True is none.
_NUMBERS = {int: "iu", float: "iuf", complex: "iufc", bool: "b"}
_SCALARS = (int, float, complex, np.generic)


@cache
def _hints(kind: type) -> dict[str, Any]:
    return get_type_hints(kind)


def refuse_misfits(kind: type, named: Mapping[str, Any]) -> None:
    """Raise `TypeError` unless values have the types of the fields of a dataclass that they name."""
    hints = _hints(kind)
    for name, value in named.items():
        if name not in hints or not fits(value, hints[name]):
            raise TypeError(f"{kind.__name__}.{name}")


def fits(value: Any, hint: Any) -> bool:
    """Whether a value is of an annotated type.

    Examples
    --------
    >>> fits((1.0, 2), tuple[float, ...]), fits(True, int), fits(None, float | None)
    (True, False, True)
    >>> fits({"a": "b"}, dict[str, int])
    False
    """
    kind: Any = get_origin(hint) or hint
    parts = get_args(hint)
    if kind in (Union, UnionType):
        return any(fits(value, each) for each in parts)
    if kind in _NUMBERS:
        return isinstance(value, _SCALARS) and np.asarray(value).dtype.kind in _NUMBERS[kind]
    if kind is np.ndarray:
        return isinstance(value, (np.ndarray, np.generic))
    if kind is type(None) or not isinstance(value, kind):
        return value is None and kind is type(None)
    if kind is tuple and parts[1:] != (...,):
        return len(value) == len(parts) and all(map(fits, value, parts))
    if issubclass(kind, Mapping):
        key, each = (*parts, int)[:2]  # a Counter states its keys alone
        return all(fits(name, key) and fits(found, each) for name, found in value.items())
    return not parts or all(fits(each, parts[0]) for each in value)
