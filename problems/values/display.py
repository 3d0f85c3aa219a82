"""Display of values in notebooks. What makes the HTML lies in a layer above and registers itself here."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar


class Displayed:
    """A value that a notebook shows as HTML."""

    __slots__ = ()
    _maker: ClassVar[Callable[[Any], str] | None] = None

    @staticmethod
    def register(maker: Callable[[Any], str]) -> None:
        """Register what makes the HTML of every such value."""
        Displayed._maker = staticmethod(maker)

    def _repr_html_(self) -> str | None:
        return None if Displayed._maker is None else Displayed._maker(self)
