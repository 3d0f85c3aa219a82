"""Loads, drives and strength of a linkage, as stated in files."""
