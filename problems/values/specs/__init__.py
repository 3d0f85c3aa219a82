"""Whole files as values: a problem, or a linkage with its loads."""
