"""Enclosures of a linkage's motion over intervals of its driver angle, with outward rounding."""
