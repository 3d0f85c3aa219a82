"""Linkages through points that leave no freedom."""
