"""Strokes: families of one number, covered by intervals."""
