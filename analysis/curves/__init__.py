"""Coupler curves: their shape, their special points, what approximates them."""
