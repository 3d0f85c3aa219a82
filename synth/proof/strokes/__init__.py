"""Strokes: one-parameter families, covered by intervals."""
