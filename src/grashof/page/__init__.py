"""Pages of searches and of analysed linkages, each a single self-contained HTML file."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from grashof.page.analysis import analysis_page
    from grashof.page.search import search_page

__all__ = ["analysis_page", "search_page"]


def __getattr__(name: str) -> Any:
    """Loaded on first use: a search needs no pandas."""
    if name in __all__:
        return getattr(import_module(f"grashof.page.{name.removesuffix('_page')}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
