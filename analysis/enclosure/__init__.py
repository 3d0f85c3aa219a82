"""Enclosures: what a linkage does over intervals of its driver angle, with outward rounding."""
