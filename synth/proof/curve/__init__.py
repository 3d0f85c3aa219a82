"""Burmester's curve in pieces, and what is required of one dyad."""
