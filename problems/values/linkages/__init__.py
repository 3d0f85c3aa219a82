"""Linkages as values: their parts, not their motion."""
