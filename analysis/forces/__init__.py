"""Masses and loads: what drives a linkage, and what it does to its joints and frame."""
