"""Pages to decide by: what a search found and how a linkage moves, each one self-contained HTML file."""
