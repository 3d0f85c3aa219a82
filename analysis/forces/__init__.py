"""Masses and loads: the drive of a linkage, and the forces in its joints and frame."""
