"""Linkages that pass as many points as leave no freedom."""
