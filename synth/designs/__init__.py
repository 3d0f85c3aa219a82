"""Designs: judged, ranked, told as tables."""
