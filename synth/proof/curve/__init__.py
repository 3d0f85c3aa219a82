"""Burmester's curve in pieces, and the requirements on one dyad."""
