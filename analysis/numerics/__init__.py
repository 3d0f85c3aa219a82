"""Numerical methods that know nothing of linkages."""
