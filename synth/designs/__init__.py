"""Designs: judged, ranked, sorted into families, listed in tables."""
