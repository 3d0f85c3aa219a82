"""Limits of several numbers of one quantity by their names, such as ratios of links."""

from __future__ import annotations

from abc import abstractmethod
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self, cast

from grashof.problems.values import checks
from grashof.problems.values.arrays import Limits
from grashof.problems.values.errors import ProblemError, shown_key, wrong_value


@dataclass(frozen=True, slots=True)
class NamedLimits(Mapping[str, Limits]):
    """Limits by name; read-only."""

    example: ClassVar[str]  # a table in a file
    allowed: ClassVar[Limits]  # the least and the greatest value

    rows: tuple[tuple[str, Limits], ...] = ()

    @classmethod
    def checked(cls, value: Any, where: str) -> Self:
        """From a mapping to numbers or (lo, hi); ProblemError with a line for each error."""
        if isinstance(value, cls):
            return value
        if not isinstance(value, Mapping) or not value:
            raise wrong_value(where, value, cls.example)
        rows = checks.each_checked(tuple(value.items()), where, cls._row)
        for name, count in Counter(name for name, _ in rows).items():
            if count > 1:
                raise ProblemError(f"{where} has {name} twice; give it once")
        return cls(tuple(rows))

    @classmethod
    def _row(cls, row: tuple[Any, Any], where: str) -> tuple[str, Limits]:
        given, value = row
        place = where.rpartition("[")[0]
        name = cls.kept_name(given, place)
        both = value if isinstance(value, tuple | list) else (value, value)
        least, most = cls.allowed
        place = f"{place}.{shown_key(given)}"
        return name, checks.limits(cast("Limits", tuple(both)), place, least=least, most=most)

    @classmethod
    @abstractmethod
    def kept_name(cls, name: Any, where: str) -> str:
        """The name as it is kept; ProblemError for one that has no meaning."""

    @classmethod
    @abstractmethod
    def kinds_with(cls, name: str) -> Sequence[str]:
        """The kinds of linkages that have it."""

    def __getitem__(self, name: str) -> Limits:
        return dict(self.rows)[name]

    def __iter__(self) -> Iterator[str]:
        return iter(dict(self.rows))

    def __len__(self) -> int:
        return len(self.rows)

    def where(self, kept: Callable[[str], bool]) -> Self:
        """Those whose names are kept."""
        return replace(self, rows=tuple(row for row in self.rows if kept(row[0])))

    def for_kind(self, kind: str) -> Self | None:
        """Those that apply to a kind of linkage; None where none does."""
        return self.where(lambda name: kind in self.kinds_with(name)) or None

    def over(self, length: float) -> Self:
        """The same in another unit."""
        return replace(
            self, rows=tuple((name, (low / length, high / length)) for name, (low, high) in self.rows)
        )
