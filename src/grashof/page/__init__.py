"""Pages to decide by: what a search found and how a linkage moves, each one self-contained HTML file."""

from grashof.page.analysis import analysis_page
from grashof.page.search import search_page

__all__ = ["analysis_page", "search_page"]
