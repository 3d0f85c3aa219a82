from .analysis import analysis_page
from .search import search_page

__all__ = ["analysis_page", "search_page"]
