"""Values that are written as tables of a file."""

from __future__ import annotations

from dataclasses import MISSING, fields
from typing import Any


class Stated:
    """A frozen dataclass whose fields are the keys of a table."""

    __slots__ = ()

    @property
    def stated(self) -> dict[str, Any]:
        """The keys with their values, as a file has them, but those at their defaults.

        Examples
        --------
        >>> from grashof.problems.values.dynamics.motor import MotorSpec
        >>> MotorSpec(gear_ratio=30).stated
        {'gear_ratio': 30.0}
        """
        found = {}
        for each in fields(self):  # type: ignore[arg-type]
            value = getattr(self, each.name)
            if each.default is MISSING or value != each.default:
                found[each.name] = _plain(value)
        return found


def _plain(value: Any) -> Any:
    if isinstance(value, Stated):
        return value.stated
    return [_plain(each) for each in value] if isinstance(value, tuple) else value
