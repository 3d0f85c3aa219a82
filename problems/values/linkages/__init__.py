"""Linkages as values: what they are made of, not how they move."""
