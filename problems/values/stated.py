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


class Given(Stated):
    """The same, stated by all keys that are given, defaults among them."""

    __slots__ = ()

    @property
    def stated(self) -> dict[str, Any]:
        """The arguments that give this value, without those that are not given: a file's table."""
        every = {each.name: getattr(self, each.name) for each in fields(self)}  # type: ignore[arg-type]
        return {name: value for name, value in every.items() if value is not None}


def _plain(value: Any) -> Any:
    if isinstance(value, Stated):
        return value.stated
    return [_plain(each) for each in value] if isinstance(value, tuple) else value
