"""Strokes and swings: linkages by their limit positions; each is a design already."""
