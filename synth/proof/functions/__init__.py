"""Linkages that generate three to five pairs of a function."""
