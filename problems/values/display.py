"""Display of values in notebooks."""

from __future__ import annotations

from importlib import import_module

# Lies in a layer above, and is loaded where a notebook asks for it: hence its name instead of an import.
_MAKER = "grashof.notebook"


class Displayed:
    """A value that a notebook shows as HTML."""

    __slots__ = ()

    def _repr_html_(self) -> str:
        made: str = import_module(_MAKER).html(self)
        return made
