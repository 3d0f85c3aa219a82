"""Burmester's curve in pieces, and what is asked of one dyad."""
